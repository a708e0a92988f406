#include "cambium/behavior/behavior_set.hpp"

#include <doctest/doctest.h>

#include <type_traits>
#include <variant>

#include "cambium/cambium.hpp"

namespace cb = cambium;

namespace {

/// The little that the behaviours of this test need.
struct View {
  using State = cb::State;
  [[nodiscard]] State state() const { return {}; }
};

/// Reports its number and counts its calls.
template <int number>
struct Counter {
  struct Memory {
    int calls = 10 * number;
    friend bool operator==(Memory, Memory) = default;
  };
  double parameter = 0.0;

  template <class V>
  [[nodiscard]] cb::Plan<V> plan(V const&, Memory& memory, double dt) const {
    ++memory.calls;
    cb::Plan<V> plan;
    plan.action = {number + parameter, dt};
    return plan;
  }
};

/// Has no memory.
struct Plain {
  template <class V>
  [[nodiscard]] cb::Plan<V> plan(V const&, cb::NoMemory&, double) const {
    return {};
  }
};

using Set = cb::BehaviorSet<Counter<1>, Plain, Counter<2>, Counter<3>>;

}  // namespace

TEST_CASE("a set knows its members") {
  static_assert(Set::contains<Plain> && Set::contains<Counter<3>> && !Set::contains<Counter<4>>);
  static_assert(cb::is_behavior_set<Set> && !cb::is_behavior_set<Plain> && !cb::is_behavior_set<std::variant<Plain>>);
  static_assert(std::is_same_v<Set::Any, cb::OneOf<Counter<1>, Plain, Counter<2>, Counter<3>>>);
  static_assert(std::is_same_v<cb::MemoryOf<Plain>, cb::NoMemory> &&
                std::is_same_v<cb::MemoryOf<Counter<1>>, Counter<1>::Memory>);
  using Shipped = cb::BehaviorSet<cb::IdmClassic, cb::ConstantAcceleration, cb::ExternalInput>;
  static_assert(std::is_trivially_copyable_v<Shipped::Any> && std::is_trivially_copyable_v<Shipped::Memory>);
}

TEST_CASE("each member plans with its own parameters and its own memory") {
  Set::Any const members[] = {Counter<1>{0.1}, Plain{}, Counter<2>{0.2}, Counter<3>{0.3}};
  double const actions[] = {1.1, 0.0, 2.2, 3.3};
  for (std::size_t i = 0; i < 4; ++i) {
    auto memory = Set::initial_memory(members[i]);
    REQUIRE(memory.index() == i);
    Set::Workspaces workspaces;
    auto const plan = Set::plan(members[i], View{}, memory, 0.5, workspaces);
    CHECK(plan.action.acceleration == doctest::Approx(actions[i]));
    CHECK(memory.index() == i);
    CHECK((memory == Set::initial_memory(members[i])) == (i == 1));
  }
}
