#include "cambium/core/parameters.hpp"

#include <doctest/doctest.h>

#include <string>
#include <utility>

#include "cambium/cambium.hpp"
#include "cambium/core/distribution.hpp"

using namespace cambium;

namespace {

struct Search {
  double discount = 0.9;
  int depth = 3;
  Distribution speed = Uniform{1.0, 2.0};
  std::vector<Uniform> parts{{}, {}};

  static constexpr char const* name = "search";
  static constexpr auto parameters() {
    using P = Search;
    return parameter_list(parameter("discount", &P::discount, "-", Range{0, 1}, "of later rewards"),
                          parameter("depth", &P::depth, "-", Range{1, 9}, "of the tree"),
                          parameter("speed", &P::speed, "m/s", {}, "how it is drawn"),
                          parameter("parts", &P::parts, "a list"));
  }
};

struct Named {
  double speed = 2.5;
  std::string label = "a";

  static constexpr char const* name = "named";
  static constexpr auto parameters() {
    using P = Named;
    return parameter_list(parameter("speed", &P::speed, "m/s", {}, "desired"),
                          parameter("label", &P::label, "of the driver"));
  }
};

struct Narrow {
  float width = 1.0f;

  static constexpr char const* name = "narrow";
  static constexpr auto parameters() {
    return parameter_list(parameter("width", &Narrow::width, "m", any_finite, "in single precision"));
  }
};

static_assert(OneOf<Search, Named>::place<Search> == 0 && OneOf<Search, Named>::place<Named> == 1 &&
              OneOf<Search, Named>::place<State> == 2);

template <class T>
std::string refusal(T object, std::string_view key, double number) {
  auto const before = to_string(object);
  try {
    set_parameter(object, key, number, "f.json");
  } catch (ParameterError const& error) {
    CHECK(to_string(object) == before);
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("a line for logs names each field, a number with its unit") {
  CHECK(to_string(Named{}) == "named: speed=2.5 m/s, label=\"a\"");
  CHECK(to_string(Search{.parts = {{}}}) ==
        "search: discount=0.9, depth=3, speed=uniform, speed.uniform.low=1, speed.uniform.high=2, parts[0].low=0, "
        "parts[0].high=1");
}

TEST_CASE("a number is set by its key, and nothing else changes") {
  Mobil driver;
  set_parameter(driver, "law.desired_speed", 31.0);
  set_parameter(driver, "lateral.rule.politeness", 0.25);
  Mobil expected;
  expected.law.desired_speed = 31.0;
  expected.lateral.rule.politeness = 0.25;
  CHECK(equal_parameters(driver, expected));
  Search search;
  set_parameter(search, "speed.uniform.high", 5.0);
  CHECK(search.speed.highest() == 5.0);
  CHECK(search.speed.lowest() == 1.0);
}

TEST_CASE("the range of a number is found by its place, in structs within the struct, too") {
  Mobil const driver;
  auto const range = [&driver](double const& place) {
    auto const found = detail::range_at(type_info<Mobil>(), &driver, &place);
    return std::pair(found.low, found.high);
  };
  CHECK(range(driver.lateral.rule.politeness) == std::pair(-1.0, 10.0));
  CHECK(range(driver.law.desired_speed) == std::pair(0.1, 100.0));
  CHECK(range(driver.lateral.course.duration) != std::pair(any_finite.low, any_finite.high));
  double const elsewhere = 0.0;
  CHECK(range(elsewhere) == std::pair(any_finite.low, any_finite.high));
}

TEST_CASE("a key that names no number, or one out of range, is an error with the nearest key") {
  CHECK(refusal(Mobil{}, "law.desird_speed", 1.0) ==
        "f.json: law.desird_speed: there is no number of that key; is it desired_speed?");
  CHECK(refusal(Mobil{}, "politness", 1.0).find("is it lateral.rule.politeness?") != std::string::npos);
  CHECK(refusal(Mobil{}, "law", 1.0) == "f.json: law: there is no number of that key; name a number in it");
  CHECK(refusal(Mobil{}, "", 1.0).find("f.json: the empty key: there is no number of that key") == 0);
  CHECK(refusal(Uniform{}, "x", 1.0) == "f.json: x: there is no number of that key; give one of low, high");
  for (std::string const key : {"parts", "parts.low", "parts[0].low"})
    CHECK(refusal(Search{}, key, 0.5) ==
          "f.json: " + key + ": there is no number of that key; elements of lists have no key: set the list in a file");
  CHECK(refusal(Search{}, "discount", 1.5) == "f.json: discount: is 1.5; give a value in [0, 1]");
  CHECK(refusal(Narrow{}, "width", 1e300) == "f.json: width: is inf m; give a value in (-inf, inf) m");
  CHECK(refusal(Search{}, "depth", 4.0) == "f.json: depth: is no real number; name another parameter");
  CHECK(refusal(Search{}, "speed.truncated_normal.low", 0.5).find("give one of uniform") != std::string::npos);
  CHECK(refusal(Search{}, "speed.low", 0.5).find("give one of uniform") != std::string::npos);
}
