// Moving boxes against vehicles that accelerate evenly along arcs, looked at in many moments.
#include "cambium/geometry/moving_box.hpp"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "cambium/core/distributions.hpp"
#include "cambium/core/random.hpp"

using namespace cambium;
using namespace cambium::geometry;

namespace {

double between(double low, double high, RandomStream& random) { return low + (high - low) * uniform01(random); }

/// A vehicle that drives `duration` [s] along an arc.
struct Arc {
  Shape shape;
  State from;
  double acceleration, curvature, duration;

  [[nodiscard]] State at(double time) const {
    double const way = from.speed * time + 0.5 * acceleration * time * time, turn = curvature * way;
    double const chord = std::abs(turn) < 1e-9 ? way : 2.0 * std::sin(0.5 * turn) / curvature;
    return {time, from.x + chord * std::cos(from.heading + 0.5 * turn),
            from.y + chord * std::sin(from.heading + 0.5 * turn), from.heading + turn,
            from.speed + acceleration * time};
  }
  [[nodiscard]] OrientedBox box_at(double time) const { return box_of(shape, at(time)); }
  [[nodiscard]] MovingBox motion() const { return {shape, from, at(duration)}; }
};

Arc random_arc(RandomStream& random, double duration) {
  double const speed = between(0, 15, random);
  return {uniform_index(random, 2) ? car() : truck(),
          {0, between(-12, 12, random), between(-12, 12, random), between(-4, 4, random), speed},
          between(-speed / duration, 3, random),
          between(-0.08, 0.08, random),
          duration};
}

}  // namespace

TEST_CASE("a moving box is where a vehicle on an arc is, at a step of 1 s within 15 cm") {
  double most = 0.0;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    RandomStream random(1, i, 0);
    auto const arc = random_arc(random, 1.0);
    auto const motion = arc.motion();
    if (std::abs(arc.at(1.0).heading - arc.from.heading) > 1.0) continue;
    for (double t = 0.0; t <= 1.0; t += 0.125) {
      auto const a = motion.at(t), b = arc.box_at(t);
      most = std::max(most, (a.center() - b.center()).norm());
      CHECK(motion.bounding_box().contains(a.bounding_box()));
    }
  }
  MESSAGE("farthest from the arc: " << most << " m");
  CHECK(most < 0.15);
}

TEST_CASE("moving boxes meet if and only if they share a point at one of many moments") {
  int met = 0, apart = 0;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    RandomStream random(2, i, 0);
    auto const a = random_arc(random, 1.0).motion(), b = random_arc(random, 1.0).motion();
    double least = 1e9, before = distance(a.at(1.0), b.at(1.0));
    double fastest = 0.0;
    bool is_bound = true;
    for (int k = 1000; k >= 0; --k) {
      auto const at_a = a.at(k / 1000.0), at_b = b.at(k / 1000.0);
      double const gap = separation(at_a, at_b), apart_by = distance(at_a, at_b);
      is_bound = is_bound && gap <= apart_by + 1e-9 && (gap > 0.0) == (apart_by > 0.0);
      fastest = std::max(fastest, 1000.0 * std::abs(apart_by - before));
      before = apart_by;
      least = std::min(least, gap);
    }
    CHECK(is_bound);
    CHECK(fastest <= longest_way(a, b) + 1e-6);
    bool const meet = intersects(a, b);
    if (least > 0.001) CHECK_FALSE(meet);
    if (least < -0.011) CHECK(meet);
    ++(meet ? met : apart);
  }
  CHECK(met > 300);
  CHECK(apart > 300);
}

TEST_CASE("a moving box and a polygon meet if and only if they share a point at one of many moments") {
  int met = 0, apart = 0;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    RandomStream random(3, i, 0);
    auto const a = random_arc(random, 1.0).motion();
    Point const p{between(-12, 12, random), between(-12, 12, random)};
    Point const corners[] = {p, p + Point{0.5, 0.1}, p + Point{0.4, 0.8}};
    Polygon const polygon(corners);
    double least = 1e9;
    for (int k = 0; k <= 1000; ++k) least = std::min(least, distance(a.at(k / 1000.0), polygon));
    bool const meet = intersects(a, polygon);
    if (least > 0.0) CHECK((!meet || least < 0.02));  // met between two of these moments
    if (meet != (least == 0.0)) CHECK(least < 0.02);
    ++(meet ? met : apart);
  }
  CHECK(met > 50);
  CHECK(apart > 50);
}

TEST_CASE("the deviation bounds how far a moving box is from an even motion along its chord") {
  for (std::uint32_t i = 0; i < 1000; ++i) {
    RandomStream random(4, i, 0);
    auto const arc = random_arc(random, 1.0);
    auto const to = arc.at(1.0);
    auto const motion = arc.motion();
    double const reach = std::max(arc.shape.front, arc.shape.rear) + std::max(arc.shape.left, arc.shape.right);
    double const bound = MovingBox::deviation(reach, arc.from, to);
    for (double t = 0.0; t < 1.0; t += 0.1) {
      auto const corners = motion.at(t).corners();
      auto const even = box_of(arc.shape, Pose{arc.from.x + t * (to.x - arc.from.x),
                                               arc.from.y + t * (to.y - arc.from.y), to.heading})
                            .corners();
      for (std::size_t k = 0; k < 4; ++k) CHECK((corners[k] - even[k]).norm() <= bound + 1e-9);
    }
  }
}
