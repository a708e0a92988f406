#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "../support/described.hpp"
#include "../support/error_of.hpp"
#include "cambium/core/one_of.hpp"
#include "cambium/core/parameters.hpp"

/// Described structs whose description has changed since they were saved.
namespace versions {

using namespace cambium;
using support::One, support::says;

/// A struct before and after its description got a field.
struct Before {
  double a = 1.0;
  std::vector<One<double>> list;
  static constexpr char const* name = "settings";
  static constexpr auto parameters() {
    return parameter_list(parameter("a", &Before::a, "m", any_finite, "a length"),
                          parameter("list", &Before::list, "of weights"));
  }
};
struct After {
  double a = 1.0;
  std::vector<One<double>> list;
  double added = 7.0;
  static constexpr char const* name = "settings";
  static constexpr auto parameters() {
    return parameter_list(parameter("a", &After::a, "m", any_finite, "a length"),
                          parameter("list", &After::list, "of weights"),
                          parameter("added", &After::added, "s", any_finite, "later than the others"));
  }
};
/// The same with lengths in millimetres: another version.
struct Upgraded : After {
  static constexpr unsigned version = 2;
  static constexpr auto parameters() {
    return parameter_list(parameter("a", &Upgraded::a, "mm", any_finite, "a length"),
                          parameter("list", &Upgraded::list, "of weights"));
  }
  void upgrade(unsigned from) {
    if (from < 2) a *= 1000.0;
  }
};
/// In percent, then in tenths: another version, with another range.
template <bool in_tenths>
struct Share {
  static constexpr unsigned version = in_tenths ? 1 : 0;
  int share = 0;
  static constexpr char const* name = "share";
  static constexpr auto parameters() {
    return parameter_list(parameter("share", &Share::share, "-", Range{0, in_tenths ? 10 : 100}, "of all"));
  }
  void upgrade(unsigned) { share /= 10; }
};
/// Its end stood first, then its begin.
template <bool begin_first>
struct Span {
  static constexpr unsigned version = begin_first ? 1 : 0;
  double from = 0.0, to = 0.0;
  static constexpr char const* name = "span";
  static constexpr auto parameters() {
    return parameter_list(parameter("from", &Span::from, "s", any_finite, ""),
                          parameter("to", &Span::to, "s", any_finite, ""));
  }
  void upgrade(unsigned) { std::swap(from, to); }
  void check(std::string const& where) const {
    if (begin_first && from > to) throw ParameterError(where, "ends before it begins", "swap the two");
  }
};
/// Was a share alone; the others came later.
struct MoreShares {
  Share<true> one{2}, added{3};
  std::optional<Share<true>> maybe = Share<true>{4};
  static constexpr char const* name = "more_shares";
  static constexpr auto parameters() {
    using P = MoreShares;
    return parameter_list(parameter("one", &P::one, ""), parameter("added", &P::added, ""),
                          parameter("maybe", &P::maybe, ""));
  }
};
struct OneShare {
  Share<false> one;
  static constexpr char const* name = "more_shares";
  static constexpr auto parameters() { return parameter_list(parameter("one", &OneShare::one, "")); }
};
/// 0: as it was saved; 1: two fields have changed places; 2: one is of another kind.
template <int change>
struct Ordered {
  double a = 0.0, b = 0.0;
  std::conditional_t<change == 2, float, int> c{};
  static constexpr char const* name = "ordered";
  static constexpr auto parameters() {
    auto const a = parameter("a", &Ordered::a, "m", any_finite, "");
    auto const b = parameter("b", &Ordered::b, "m", any_finite, "");
    auto const c = parameter("c", &Ordered::c, "-", Range{0, 9}, "");
    if constexpr (change == 1)
      return parameter_list(b, a, c);
    else
      return parameter_list(a, b, c);
  }
};
struct NotUpgraded : Before {
  static constexpr unsigned version = 3;
};
template <class T>
struct Nest {
  std::vector<T> list;
  OneOf<T, One<double>> one, two;
  static constexpr char const* name = "nest";
  static constexpr auto parameters() {
    return parameter_list(parameter("list", &Nest::list, ""), parameter("one", &Nest::one, ""),
                          parameter("two", &Nest::two, ""));
  }
};

/// A field that is added travels, and is at its default in what was saved before.
void check_added_fields(auto const& write, auto const& read) {
  After const now{2.0, {{1.0}, {1.0}, {3.0}}, 9.0};
  After back;
  read(write(now), back);
  CHECK(back.added == 9.0);
  CHECK(back.list[2].value == 3.0);
  Before const old{2.0, {{1.0}, {4.0}}};
  auto const bytes = write(old);
  read(bytes, back);
  CHECK(back.a == 2.0);
  CHECK(back.list[1].value == 4.0);
  CHECK(back.added == 7.0);
  Upgraded upgraded;
  read(bytes, upgraded);
  CHECK(upgraded.a == 2000.0);
  read(write(upgraded), upgraded);
  CHECK(upgraded.a == 2000.0);
  // Also where one refers to another: equal elements, and equal alternatives, are upgraded once each.
  Nest<Before> const nest{{{2.0, {}}, {2.0, {}}, {3.0, {}}}, Before{2.0, {}}, Before{2.0, {}}};
  Nest<Upgraded> raised;
  read(write(nest), raised);
  CHECK(raised.list[0].a == 2000.0);
  CHECK(raised.list[1].a == 2000.0);
  CHECK(raised.list[2].a == 3000.0);
  CHECK(std::get<Upgraded>(raised.one).a == 2000.0);
  CHECK(std::get<Upgraded>(raised.two).a == 2000.0);
  Before too_old{5.0, {}};
  says("^x: its struct 'settings' has more fields than in this program", [&] { read(write(now), too_old); });
  says("newer version", [&] { read(write(upgraded), too_old); });
  CHECK(too_old.a == 5.0);
  NotUpgraded none;
  says("of version 0, and this program knows no way from there", [&] { read(bytes, none); });
}

/// Ranges and checks count after the upgrade, in lists of each kind.
void check_ranges(auto const& write, auto const& read) {
  Share<true> alone;
  read(write(Share<false>{70}), alone);
  CHECK(alone.share == 7);
  std::vector<Share<false>> const list{{70}, {90}};
  One<std::vector<Share<true>>> now;
  read(write(One<std::vector<Share<false>>>{list}), now);
  REQUIRE(now.value.size() == 2);
  CHECK(now.value[0].share == 7);
  One<std::shared_ptr<std::vector<Share<true>> const>> shared;
  One<std::shared_ptr<std::vector<Share<false>> const>> const old{std::make_shared<decltype(list)>(list)};
  read(write(old), shared);
  REQUIRE(shared.value->size() == 2);
  CHECK((*shared.value)[1].share == 9);
  MoreShares more;  // what was added is at the default of today
  read(write(OneShare{{70}}), more);
  CHECK(more.one.share == 7);
  CHECK(more.added.share == 3);
  CHECK(more.maybe->share == 4);
  auto const wrong = write(One<std::vector<Share<false>>>{{{120}}});
  says("^x: share: is 12", [&] { read(wrong, now); });
  CHECK(now.value[0].share == 7);
  One<std::vector<Span<true>>> spans;
  read(write(One<std::vector<Span<false>>>{{{2.0, 1.0}}}), spans);
  CHECK(spans.value[0].from == 1.0);
  auto const turned = write(One<std::vector<Span<true>>>{{{2.0, 1.0}}});
  says("ends before it begins", [&] { read(turned, spans); });
}

/// Two fields that changed places are refused, as is one of another kind.
void check_order(auto const& write, auto const& read) {
  auto const bytes = write(Ordered<0>{1.0, 2.0, 3});
  std::string const sentence = "its struct 'ordered' was saved with other fields, or in another order";
  Ordered<0> same;
  Ordered<1> exchanged;
  Ordered<2> of_another_kind;
  says(sentence, [&] { read(bytes, exchanged); });
  says(sentence, [&] { read(bytes, of_another_kind); });
  read(bytes, same);
  CHECK(same.b == 2.0);
}

/// Checks all of these with `write(object)`, which returns bytes, and `read(bytes, object)`, which calls them "x".
void check(auto const& write, auto const& read) {
  check_added_fields(write, read);
  check_ranges(write, read);
  check_order(write, read);
}

}  // namespace versions
