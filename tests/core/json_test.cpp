#include <cambium/core/binary.hpp>
#include <cambium/core/json.hpp>
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cambium/behavior/actions/macro_actions.hpp"
#include "cambium/behavior/open_loop/motion_primitives.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"
#include "cambium/core/text.hpp"
#include "../support/allocations.hpp"
#include "../support/described.hpp"
#include "../support/versions.hpp"

using namespace cambium;
using namespace support;

namespace {

/// A list of fixed length of a user's own.
struct Triple {
  double values[3]{};

  [[nodiscard]] double* data() { return values; }
  [[nodiscard]] double const* data() const { return values; }
  [[nodiscard]] std::size_t size() const { return 3; }
};
/// The message of what reading `text` throws.
template <class T = Everything>
std::string refusal(std::string const& text) {
  try {
    static_cast<void>(from_json<T>(text, "f.json"));
  } catch (ParameterError const& error) {
    return error.what();
  }
  return "accepted";
}

/// More fields than a byte has bits.
struct Ten {
  double v0 = 0, v1 = 0, v2 = 0, v3 = 0, v4 = 0, v5 = 0, v6 = 0, v7 = 0, v8 = 0, v9 = 0;

  static constexpr char const* name = "ten";
  static constexpr auto parameters() {
    using P = Ten;
    return parameter_list(
        parameter("v0", &P::v0, "-", any_finite, "a number"), parameter("v1", &P::v1, "-", any_finite, "a number"),
        parameter("v2", &P::v2, "-", any_finite, "a number"), parameter("v3", &P::v3, "-", any_finite, "a number"),
        parameter("v4", &P::v4, "-", any_finite, "a number"), parameter("v5", &P::v5, "-", any_finite, "a number"),
        parameter("v6", &P::v6, "-", any_finite, "a number"), parameter("v7", &P::v7, "-", any_finite, "a number"),
        parameter("v8", &P::v8, "-", any_finite, "a number"), parameter("v9", &P::v9, "-", any_finite, "a number"));
  }
};

/// A struct that has the name of another one.
struct AlsoStraight {
  static constexpr char const* name = "straight";
  static constexpr auto parameters() { return parameter_list(); }
};
struct Ways {
  OneOf<Straight, AlsoStraight> way{};
  std::vector<Straight> list{};
  std::optional<std::vector<double>> numbers{};

  static constexpr char const* name = "ways";
  static constexpr auto parameters() {
    using P = Ways;
    return parameter_list(parameter("way", &P::way, "one of two"), parameter("list", &P::list, "a list"),
                          parameter("numbers", &P::numbers, "-", any_finite, "perhaps some"));
  }
};

/// A struct that is large by default, on the heap.
struct Full {
  std::vector<double> numbers = std::vector<double>(1000, 1.0);

  static constexpr char const* name = "full";
  static constexpr auto parameters() {
    return parameter_list(parameter("numbers", &Full::numbers, "-", any_finite, "many"));
  }
};

struct Third {
  float share = 0.3f;

  static constexpr char const* name = "third";
  static constexpr auto parameters() {
    return parameter_list(parameter("share", &Third::share, "-", Range{0, 0.3}, "0.3 is no float"));
  }
};

enum class Mode : std::uint32_t { city, motorway };
struct Driver {
  Mode mode = Mode::city;

  static constexpr auto parameters() {
    return parameter_list(cambium::choice("mode", &Driver::mode, "city|motorway", "where it drives"));
  }
};

/// Lists and optionals whose defaults are not those of what they hold.
struct Prefilled {
  std::vector<Window> windows{{.from = -7.0}, {.to = 7.0}};
  std::optional<Window> window = Window{.to = 7.0};
  std::optional<double> number = 7.0;

  static constexpr char const* name = "prefilled";
  static constexpr auto parameters() {
    using P = Prefilled;
    return parameter_list(parameter("windows", &P::windows, "when"), parameter("window", &P::window, "when"),
                          parameter("number", &P::number, "-", any_finite, "a number"));
  }
};

}  // namespace

TEST_CASE("lists and optionals read back, whatever their defaults hold") {
  auto const survives = []<class T>(T const& object) {
    for (auto const detail : {JsonDetail::differences, JsonDetail::everything}) {
      auto const text = to_json(object, detail);
      CAPTURE(text);
      CHECK(equal_parameters(from_json<T>(text), object));
    }
    CHECK(equal_parameters(from_binary<T>(to_binary(object)), object));
  };
  CHECK(to_json(Prefilled{.windows = {}}) == "{\"windows\": []}\n");
  survives(Prefilled{});
  survives(Prefilled{.windows = {{}, {}, {}}, .window = Window{}, .number = 0.0});
  survives(Prefilled{.windows = {}, .window = {}, .number = {}});
  survives(MotionPrimitives{.primitives = {{0.0, 0.0}, {0.0, 0.1}}});
  using Kind = MacroActions::Kind;
  survives(MacroActions::of({{Kind::keep_gap}, {Kind::stay, -2.0}, {Kind::change_left}, {Kind::change_right}}));
  Prefilled read{.window = {}};
  read_json(read, R"({"window": {"from": -1}})");
  CHECK(read.window == Window{-1.0, 7.0});
}

TEST_CASE("a described struct reads back as the same bits") {
  for (auto const detail : {JsonDetail::differences, JsonDetail::everything})
    for (auto const& object : {Everything{}, unusual()}) {
      auto const text = to_json(object, detail);
      CAPTURE(text);
      auto const read = from_json<Everything>(text);
      CHECK(equal_parameters(read, object));
      CHECK(hash_parameters(read) == hash_parameters(object));
      CHECK(to_json(read, detail) == text);
    }
  CHECK(std::signbit(from_json<Everything>(to_json(unusual())).pair[1]));
  CHECK(std::signbit(from_json<Window>(to_json(Window{.from = -0.0, .to = 1.0})).from));
}

TEST_CASE("a file holds what differs from the defaults") {
  CHECK(to_json(Everything{}) == "{\"pair\": [1, 2], \"numbers\": [1]}\n");
  CHECK(to_json(Window{.to = 2.0}) == "{\"to\": 2}\n");
  CHECK(to_json(Window{.to = 2.0}, JsonDetail::everything) == "{\"from\": 0, \"to\": 2}\n");
  Everything turning{.way = Turn{}, .pair = {}};
  CHECK(to_json(turning).find("\"way\": \"turn\"") != std::string::npos);
  turning.way = Turn{.radius = 3.0};
  CHECK(to_json(turning).find("\"way\": {\"turn\": {\"radius\": 3}}") != std::string::npos);
}

TEST_CASE("what the text does not say stays") {
  Window window{.from = -5.0, .to = 5.0};
  read_json(window, R"({"to": 6})");
  CHECK(window == Window{-5.0, 6.0});
  CHECK_THROWS_AS(read_json(window, R"({"to": -6, "from": 1})"), ParameterError);
  CHECK(window == Window{-5.0, 6.0});
}

TEST_CASE("an error says where it is and what to do") {
  CHECK(refusal(R"({"nubmer": 1})") == "f.json: everything: has no field \"nubmer\"; is it number?");
  CHECK(refusal(R"({"window": {"until": 1}})") ==
        "f.json: everything.window: has no field \"until\"; give one of from, to");
  CHECK(refusal(R"({"number": "1"})") == "f.json: everything.number: is \"1\"; give a number");
  CHECK(refusal(R"({"number": null})") == "f.json: everything.number: is null; give a number");
  CHECK(refusal(R"({"number": -2000})") == "f.json: everything.number: is -2000 m; give a value in [-1000, inf] m");
  CHECK(refusal(R"({"integer": 1.5})") ==
        "f.json: everything.integer: is 1.5; give an integer without fraction or exponent, from -2147483648 to "
        "2147483647");
  CHECK(refusal(R"({"integer": 3000000000})") ==
        "f.json: everything.integer: is 3000000000; give an integer without fraction or exponent, from -2147483648 to "
        "2147483647");
  CHECK(refusal(R"({"small": 256})") ==
        "f.json: everything.small: is 256; give an integer without fraction or exponent, from 0 to 255");
  CHECK(refusal(R"({"natural": -1})") ==
        "f.json: everything.natural: is -1; give an integer without fraction or exponent, from 0 to "
        "18446744073709551615");
  CHECK(refusal(R"({"truth": 1})") == "f.json: everything.truth: is 1; give true or false");
  CHECK(refusal(R"({"mood": "callm"})") == "f.json: everything.mood: is \"callm\"; is it calm?");
  CHECK(refusal(R"({"mood": 0})") == "f.json: everything.mood: is 0; give one of calm, hasty, in quotes");
  CHECK(refusal(R"({"way": "turm"})") ==
        "f.json: everything.way: there is no \"turm\" here; is it turn? There are: straight, turn");
  CHECK(refusal(R"({"way": {"turn": {"radius": 0}}})") ==
        "f.json: everything.way.turn.radius: is 0 m; give a value in (0, inf) m");
  CHECK(refusal(R"({"way": {"turn": {}, "straight": {}}})").find("give a name, or an object with one") !=
        std::string::npos);
  CHECK(refusal(R"({"way": {"turn": 3}})") == "f.json: everything.way.turn: is 3; give an object");
  CHECK(refusal(R"({"pair": [1]})") == "f.json: everything.pair: has 1 elements; give 2");
  CHECK(refusal(R"({"windows": [{}, {"from": "x"}]})") ==
        "f.json: everything.windows[1].from: is \"x\"; give a number");
  CHECK(refusal(R"({"window": {"from": 2}})") == "f.json: everything.window: ends before it begins; swap the two");
  CHECK(refusal(R"({"text": 3})") == "f.json: everything.text: is 3; give a text, in quotes");
  CHECK(refusal("[]") == "f.json: everything: is []; give an object");
  CHECK(refusal(R"({"number": 1, "number": 2})") ==
        "f.json: the key \"number\" is there twice in one object; remove one of them");
  CHECK(refusal("{\n  \"number\": 1,\n  \"text\" 3}").find("f.json, line 3, column 10: this is no JSON") == 0);
  CHECK(refusal("{\"number\": 1").find("the text ends too early") != std::string::npos);
  CHECK(refusal("{\"number\": 1e999}").find("is too large") != std::string::npos);
  CHECK(refusal(std::string(300, '[')).find("nested deeper than 100") != std::string::npos);
  CHECK_THROWS_WITH_AS(static_cast<void>(to_json(Everything{.way = Secret{}})),
                       "way: holds a struct that is not described, or has no default: a file cannot hold it; give it "
                       "`parameters()` and `name`",
                       ParameterError);
}

TEST_CASE("no id is a word, whatever integer its enum is") {
  auto const text = to_json(LaneChange{.left = 3.0f}, JsonDetail::everything);
  CHECK(text.find("\"target\": \"none\"") != std::string::npos);
  CHECK(from_json<LaneChange>(text) == LaneChange{.left = 3.0f});
  CHECK(from_json<LaneChange>(to_json(LaneChange{.target = CorridorId{3}})) == LaneChange{.target = CorridorId{3}});
}

TEST_CASE("a choice is written by name, whatever integer its enum is") {
  CHECK(to_json(Driver{Mode::motorway}) == "{\"mode\": \"motorway\"}\n");
  CHECK(from_json<Driver>(R"({"mode": "motorway"})").mode == Mode::motorway);
}

TEST_CASE("numbers of single precision reach their bounds, and go no farther") {
  CHECK_NOTHROW(check_parameters(Third{}));
  CHECK(from_json<Third>(R"({"share": 0.3})").share == 0.3f);
  CHECK_THROWS_AS(check_parameters(Third{0.30001f}), ParameterError);
  CHECK_THROWS_AS(check_parameters(Third{-1e-30f}), ParameterError);
  CHECK_THROWS_AS(check_parameters(Third{std::nanf("")}), ParameterError);
}

TEST_CASE("unequal parameters have unequal hashes, and these are the same everywhere") {
  std::vector<Ways> const all{{},
                              {.way = AlsoStraight{}},
                              {.list = {Straight{}}},
                              {.list = {Straight{}, Straight{}}},
                              {.numbers = std::vector<double>{}},
                              {.numbers = std::vector<double>{1.0}}};
  for (auto const& a : all)
    for (auto const& b : all) CHECK((hash_parameters(a) == hash_parameters(b)) == (&a == &b));
  CHECK(hash_text(hash_parameters(Window{})) == "bbf26661d448fcb7");
  CHECK(hash_text(hash_parameters(One<std::vector<double>>{{1.0, -2.5}})) == "d7513aaa45512bc6");
  CHECK(hash_text(hash_parameters(One<std::string>{"some letters"})) == "71ef95f767f6ce73");
}

TEST_CASE("a text that JSON cannot hold is refused, not changed") {
  One<std::string> const latin{
      "B\xf6"
      "blingen"};
  CHECK_THROWS_WITH_AS(static_cast<void>(to_json(latin)), doctest::Contains("value: is no UTF-8 text"), ParameterError);
  CHECK(from_binary<One<std::string>>(to_binary(latin)).value == latin.value);
  CHECK(from_json<One<std::string>>(to_json(One<std::string>{"B\xc3\xb6"
                                                             "blingen"}))
            .value ==
        "B\xc3\xb6"
        "blingen");
}

TEST_CASE("many keys are no reason to wait, and a text takes memory by its size") {
  std::string keys = "{";
  for (int i = 0; i < 50'000; ++i) keys += "\"k" + std::to_string(i) + "\": 1, ";
  CHECK(refusal(keys + "\"k\": 1}").find("has no field \"k0\"") != std::string::npos);
  CHECK(refusal(keys + "\"k7\": 1}").find("the key \"k7\" is there twice") != std::string::npos);
  using Books = One<std::vector<One<std::array<double, 500>>>>;
  auto const books = [](std::size_t count) {
    std::string text = "{\"value\": [{}";
    for (std::size_t i = 1; i < count; ++i) text += ", {}";
    return text + "]}";
  };
  CHECK(from_json<Books>(books(1000)).value.size() == 1000);
  auto const before = support::allocated_bytes();
  CHECK(refusal<Books>(books(200'000)).find("f.json: expands to far more memory") == 0);
  std::string full = "{\"value\": [{}";
  for (int i = 1; i < 50'000; ++i) full += ", {}";
  CHECK(refusal<One<std::vector<Full>>>(full + "]}").find("expands to far more memory") != std::string::npos);
  std::string named = "{\"value\": [\"full\"";
  for (int i = 1; i < 50'000; ++i) named += ", \"full\"";
  CHECK(refusal<One<std::vector<OneOf<Straight, Full>>>>(named + "]}").find("expands to far more memory") !=
        std::string::npos);
  std::string perhaps = "{\"value\": [{\"value\": {}}";
  for (int i = 1; i < 50'000; ++i) perhaps += ", {\"value\": {}}";
  CHECK(refusal<One<std::vector<One<std::optional<Full>>>>>(perhaps + "]}").find("expands to far more memory") !=
        std::string::npos);
  CHECK(support::allocated_bytes() - before < 600'000'000);
}

TEST_CASE("damaged texts are read or refused, never worse") {
  auto const good = to_json(unusual(), JsonDetail::everything);
  RandomStream stream(1, 0, 0);
  auto const random = [&](std::size_t below) { return uniform_index(stream, static_cast<std::uint32_t>(below)); };
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    auto text = good.substr(0, i % 3 == 0 ? random(good.size()) : good.size());
    for (std::size_t k = random(4); k > 0 && !text.empty(); --k)
      text[random(text.size())] = static_cast<char>(random(256));
    try {
      static_cast<void>(from_json<Everything>(text));
    } catch (ParameterError const&) {
      ++refused;
    }
  }
  CHECK(refused > 2000);
}

TEST_CASE("a described struct travels as bytes") {
  for (auto const& object : {Everything{}, unusual()}) {
    auto const bytes = to_binary(object);
    auto const read = from_binary<Everything>(bytes);
    CHECK(equal_parameters(read, object));
    CHECK(to_binary(read) == bytes);
    CHECK(bytes.size() < to_json(object, JsonDetail::everything).size() / 2);
  }
  for (std::size_t const length : {1u, 253u, 254u, 255u, 256u, 257u}) {
    One<std::vector<double>> const list{std::vector<double>(length, 2.0)};
    CHECK(from_binary<One<std::vector<double>>>(to_binary(list)).value == list.value);
  }
  for (auto const field : {&Ten::v0, &Ten::v6, &Ten::v7, &Ten::v8, &Ten::v9}) {
    One<std::vector<Ten>> list{std::vector<Ten>(2)};
    list.value[1].*field = 1.0;
    CHECK(equal_parameters(from_binary<One<std::vector<Ten>>>(to_binary(list)), list));
  }
  CHECK(std::signbit(from_binary<Everything>(to_binary(unusual())).pair[1]));
  CHECK_THROWS_AS(static_cast<void>(to_binary(Everything{.way = Secret{}})), ParameterError);
}

TEST_CASE("structs of older versions are read") {
  versions::check([](auto const& object) { return to_binary(object); },
                  []<class T>(std::string const& bytes, T& object) {
                    T read{};
                    detail::read_binary(bytes, type_info<T>(), &read, "x");
                    object = read;
                  });
}

TEST_CASE("bytes of another kind, cut short or changed are refused") {
  auto const bytes = to_binary(unusual());
  auto const refused = [](std::string const& damaged) {
    try {
      static_cast<void>(from_binary<Everything>(damaged, "f.bin"));
    } catch (ParameterError const& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(refused("{}") == "f.bin: is no binary file of cambium; give one, or a JSON file");
  CHECK(refused(to_binary(Window{})).find("was saved with other fields") != std::string::npos);
  for (std::size_t size = 0; size < bytes.size(); ++size) CHECK_FALSE(refused(bytes.substr(0, size)).empty());
  for (std::size_t at = 0; at < bytes.size(); ++at)
    for (int bit = 0; bit < 8; ++bit) {
      auto changed = bytes;
      changed[at] = static_cast<char>(changed[at] ^ (1 << bit));
      CHECK_FALSE(refused(changed).empty());
    }
  // With a right checksum, the content is read or refused, never worse.
  auto const content = bytes.substr(24);
  RandomStream stream(7, 0, 0);
  auto const random = [&](std::size_t below) { return uniform_index(stream, static_cast<std::uint32_t>(below)); };
  for (int i = 0; i < 20000; ++i) {
    auto changed = content;
    for (std::size_t k = 0; k < 1 + random(3); ++k) changed[random(changed.size())] = static_cast<char>(random(256));
    static_cast<void>(refused(detail::sealed(changed)));
  }
}

TEST_CASE("a list whose elements repeat may be long, but not endless") {
  auto const check = []<class List>(List const& two) {
    auto const content = to_binary(two).substr(24);
    constexpr std::size_t length_at = 3;  // behind number and names of the fields
    REQUIRE(content[length_at] == 2);
    REQUIRE(content.back() == 0);  // the second element differs in nothing
    auto const with = [&](std::uint64_t elements) {
      auto longer = content.substr(0, length_at) + '\xff';
      for (int i = 0; i < 8; ++i) longer += static_cast<char>(elements >> (8 * i) & 0xffu);
      return detail::sealed(longer + content.substr(length_at + 1) + std::string(elements - 2, '\0'));
    };
    CHECK_NOTHROW(static_cast<void>(from_binary<List>(with(1000))));
    auto const before = support::allocated_bytes();
    CHECK_THROWS_WITH_AS(static_cast<void>(from_binary<List>(with(1'000'000), "f.bin")),
                         "f.bin: expands to far more memory than a file of its size should; take another copy; if this "
                         "one is sound, store lists that repeat only once",
                         ParameterError);
    CHECK(support::allocated_bytes() - before < 512'000'000);  // not 1'000'000 elements of 4 kB
  };
  using Book = One<std::array<double, 500>>;
  using Reader = One<std::shared_ptr<std::vector<double> const>>;
  Reader const reader{std::make_shared<std::vector<double> const>(500)};
  check(One<std::vector<Book>>{{Book{}, Book{}}});
  check(One<std::vector<Reader>>{{reader, reader}});
  One<std::vector<float>> const endless{std::vector<float>((std::size_t{1} << 24) + 1)};
  CHECK_THROWS_WITH_AS(static_cast<void>(to_binary(endless)),
                       doctest::Contains("a list has 16777217 elements; split it: a file holds at most 16777216"),
                       ParameterError);
}

TEST_CASE("a list of fixed length takes neither more nor fewer elements") {
  using Fixed = One<Triple>;
  using Free = One<std::vector<double>>;
  CHECK(from_json<Fixed>(R"({"value": [1, 2, 3]})").value.values[2] == 3.0);
  CHECK(from_binary<Fixed>(to_binary(Free{{1.0, 2.0, 3.0}})).value.values[2] == 3.0);
  for (std::size_t const length : {0u, 2u, 4u, 1000u}) {
    Free const other{std::vector<double>(length, 1.0)};
    CHECK_THROWS_AS(static_cast<void>(from_json<Fixed>(to_json(other, JsonDetail::everything))), ParameterError);
    CHECK_THROWS_AS(static_cast<void>(from_binary<Fixed>(to_binary(other))), ParameterError);
  }
}

TEST_CASE("writing leaves the struct alone, even one in memory that nobody may write") {
  static constexpr Window window{1.0, 2.0};
  CHECK(to_json(window) == "{\"from\": 1, \"to\": 2}\n");
  CHECK(from_binary<Window>(to_binary(window)) == window);
}
