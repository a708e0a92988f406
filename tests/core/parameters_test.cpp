#include "cambium/core/parameters.hpp"

#include <array>
#include <cstring>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <doctest/doctest.h>

using namespace cambium;

namespace {

enum class Scheme { euler, runge_kutta };

struct Window {
  double from = 1.0;
  double to = 2.0;

  static constexpr char const* name = "window";
  static constexpr auto parameters() {
    return parameter_list(parameter("from", &Window::from, "s", non_negative, "Begin."),
                          parameter("to", &Window::to, "s", positive, "End, not before the begin."));
  }
  void check(std::string const& where) const {
    if (to < from) throw ParameterError(where, "ends before it begins", "swap the two");
  }
};

struct Follower {
  double desired_speed = 15.0;
  int exponent = 4;
  bool stops = true;
  Scheme scheme = Scheme::runge_kutta;
  Window window{};

  static constexpr char const* name = "follower";
  static constexpr auto parameters() {
    return parameter_list(
        parameter("desired_speed", &Follower::desired_speed, "m/s", {0, 70}, "Speed on an empty road."),
        parameter("exponent", &Follower::exponent, "-", {1, 8}, "Sharpness of the approach to it."),
        parameter("stops", &Follower::stops, "-", {0, 1}, "Whether it stops at lights."),
        choice("scheme", &Follower::scheme, "euler|runge_kutta", "Integration scheme."),
        parameter("window", &Follower::window, "-", any_finite, "When it drives."));
  }
};

struct Timetable {
  std::array<double, 2> weights{0.5, 2.0};
  std::vector<Window> windows{{1.0, 2.0}, {3.0, 4.0}};
  std::shared_ptr<std::vector<Window> const> shared{};
  LaneId lane = none<LaneId>;

  static constexpr char const* name = "plan";
  static constexpr auto parameters() {
    return parameter_list(parameter("weights", &Timetable::weights, "kg", {0, 10}, "Of each half."),
                          parameter("windows", &Timetable::windows, "When it drives."),
                          parameter("shared", &Timetable::shared, "When others do."),
                          parameter("lane", &Timetable::lane, "Where."));
  }
};

struct Empty {
  static constexpr auto parameters() { return parameter_list(); }
};

static_assert(Described<Follower>);
static_assert(!Described<int>);

double const not_a_number = std::numeric_limits<double>::quiet_NaN();
double const infinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("a description is read in its order") {
  std::string keys;
  for_each_parameter<Follower>([&](auto const& entry) { keys += std::string(entry.name) + " "; });
  CHECK(keys == "desired_speed exponent stops scheme window ");
}

TEST_CASE("values within their ranges pass, both ends included") {
  CHECK_NOTHROW(check_parameters(Follower{}));
  CHECK_NOTHROW(check_parameters(Follower{.desired_speed = 0.0}));
  CHECK_NOTHROW(check_parameters(Follower{.desired_speed = 70.0, .exponent = 8, .scheme = Scheme::euler}));
  CHECK_NOTHROW(check_parameters(Empty{}));
}

TEST_CASE("a value out of range is an error that names the struct, the key, the value and the range") {
  CHECK_THROWS_WITH_AS(check_parameters(Follower{.desired_speed = -1.5}),
                       "follower.desired_speed: is -1.5 m/s; give a value in [0, 70] m/s", ParameterError);
  CHECK_THROWS_WITH_AS(check_parameters(Follower{.exponent = 9}, "traffic.json"),
                       "traffic.json: follower.exponent: is 9; give a value in [1, 8]", ParameterError);
  CHECK_THROWS_WITH_AS(check_parameters(Follower{.scheme = static_cast<Scheme>(7)}),
                       "follower.scheme: is 7; give one of euler, runge_kutta", ParameterError);
  CHECK_THROWS_WITH_AS(check_parameters(Follower{.window = {.from = 0.0, .to = 0.0}}),
                       "follower.window.to: is 0 s; give a value in (0, inf) s", ParameterError);
}

TEST_CASE("neither NaN nor an unwanted infinity is in any range") {
  CHECK_THROWS_AS(check_parameters(Follower{.desired_speed = not_a_number}), ParameterError);
  CHECK_THROWS_AS(check_parameters(Follower{.window = {.to = infinity}}), ParameterError);
  CHECK_THROWS_AS(check_parameters(Follower{.window = {.from = not_a_number}}), ParameterError);
  auto const value = [](double number) { return PlainValue::at(&number, type_info<double>()); };
  CHECK(value(infinity).in({0.0, infinity}));
  CHECK(!value(not_a_number).in({-infinity, infinity}));
}

TEST_CASE("a struct's own check sees relations between its fields, also when it is nested") {
  CHECK_THROWS_WITH_AS(check_parameters(Follower{.window = {.from = 5.0}}, "traffic.json"),
                       "traffic.json: follower.window: ends before it begins; swap the two", ParameterError);
}

TEST_CASE("equality and hashes see every field, nested ones too; hashes never change") {
  Follower const usual{};
  CHECK(equal_parameters(usual, Follower{}));
  CHECK(hash_parameters(usual) == hash_parameters(Follower{}));
  for (auto const& other : {Follower{.desired_speed = 15.1}, Follower{.exponent = 5}, Follower{.stops = false},
                            Follower{.scheme = Scheme::euler}, Follower{.window = {.to = 3.0}}}) {
    CHECK(!equal_parameters(usual, other));
    CHECK(hash_parameters(usual) != hash_parameters(other));
  }
  Follower const zero{.desired_speed = 0.0}, negative_zero{.desired_speed = -0.0};
  CHECK(equal_parameters(zero, negative_zero));
  CHECK(hash_parameters(zero) == hash_parameters(negative_zero));
  // Written down: files of other runs and platforms compare with it.
  CHECK(hash_parameters(Window{}) == 0x7bd30fdcbadcbb10u);
}

TEST_CASE("one line for logs has every value, with its unit, exactly") {
  CHECK(to_string(Follower{.desired_speed = 0.1}) ==
        "follower: desired_speed=0.1 m/s, exponent=4, stops=true, scheme=runge_kutta, window.from=1 s, window.to=2 s");
}

TEST_CASE("the table for the documentation has one row for each value") {
  CHECK(describe_parameters<Follower>() ==
        "| name | default | unit | range | meaning |\n"
        "|---|---|---|---|---|\n"
        "| desired_speed | 15 | m/s | [0, 70] | Speed on an empty road. |\n"
        "| exponent | 4 | - | [1, 8] | Sharpness of the approach to it. |\n"
        "| stops | true | - | - | Whether it stops at lights. |\n"
        "| scheme | runge_kutta | - | euler, runge_kutta | Integration scheme. |\n"
        "| window.from | 1 | s | [0, inf) | Begin. |\n"
        "| window.to | 2 | s | (0, inf) | End, not before the begin. |\n");
}

TEST_CASE("lists and ids are parameters like others: compared, hashed, shown and checked element by element") {
  auto const shared = [](Window const& window) {
    return std::make_shared<std::vector<Window> const>(std::vector<Window>{window});
  };
  std::vector<Timetable> const different{{},
                                         {.weights = {0.5, 2.5}},
                                         {.weights = {2.0, 0.5}},
                                         {.windows = {}},
                                         {.windows = {{1.0, 2.0}}},
                                         {.windows = {{1.0, 2.0}, {3.0, 4.0}, {3.0, 4.0}}},
                                         {.windows = {{1.0, 2.0}, {3.0, 4.5}}},
                                         {.windows = {{3.0, 4.0}, {1.0, 2.0}}},
                                         {.shared = shared({5.0, 6.0})},
                                         {.shared = shared({5.0, 7.0})},
                                         {.lane = LaneId{0}},
                                         {.lane = LaneId{7}}};
  std::set<std::uint64_t> hashes;
  std::set<std::string> lines;
  for (auto const& one : different) {
    for (auto const& other : different) CHECK(equal_parameters(one, other) == (&one == &other));
    hashes.insert(hash_parameters(one));
    lines.insert(to_string(one));
  }
  CHECK(hashes.size() == different.size());
  CHECK(lines.size() == different.size());
  Timetable const one{.shared = shared({5.0, 6.0})}, same{.shared = shared({5.0, 6.0})};
  CHECK(equal_parameters(one, same));
  CHECK(hash_parameters(one) == hash_parameters(same));
  CHECK(to_string(Timetable{}) ==
        "plan: weights[0]=0.5 kg, weights[1]=2 kg, windows[0].from=1 s, windows[0].to=2 s, windows[1].from=3 s, "
        "windows[1].to=4 s, lane=none");
  CHECK(to_string(different.back()).ends_with("lane=7"));
  CHECK_NOTHROW(check_parameters(one));
  CHECK_THROWS_WITH_AS(check_parameters(Timetable{.weights = {1.0, 11.0}}),
                       "plan.weights[1]: is 11 kg; give a value in [0, 10] kg", ParameterError);
  CHECK_THROWS_WITH_AS(check_parameters(Timetable{.windows = {{1.0, 2.0}, {-1.0, 2.0}}}),
                       "plan.windows[1].from: is -1 s; give a value in [0, inf) s", ParameterError);
  CHECK_THROWS_WITH_AS(check_parameters(Timetable{.shared = shared({5.0, 4.0})}),
                       "plan.shared[0]: ends before it begins; swap the two", ParameterError);
  CHECK(describe_parameters<Timetable>() ==
        "| name | default | unit | range | meaning |\n"
        "|---|---|---|---|---|\n"
        "| weights[] | - | kg | [0, 10] | Of each half. |\n"
        "| windows[].from | - | s | [0, inf) | Begin. |\n"
        "| windows[].to | - | s | (0, inf) | End, not before the begin. |\n"
        "| shared[].from | - | s | [0, inf) | Begin. |\n"
        "| shared[].to | - | s | (0, inf) | End, not before the begin. |\n"
        "| lane | none | - | - | Where. |\n");
}
