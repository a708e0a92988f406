#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "cambium/behavior/behavior_model.hpp"
#include "cambium/behavior/course.hpp"
#include "cambium/behavior/drivers.hpp"
#include "cambium/behavior/law/slowing.hpp"
#include "cambium/behavior/open_loop/constant_acceleration.hpp"
#include "cambium/behavior/wrap/human_view.hpp"
#include "cambium/core/distributions.hpp"
#include "cambium/core/parameters.hpp"
#include "cambium/core/portable_math.hpp"
#include "cambium/core/random.hpp"
#include "cambium/execution/interpolate.hpp"

namespace cambium::inline v0_1 {

/// Any behaviour, driven by a human: late, on wrong estimates, at times inattentive (the Human Driver Model of Treiber,
/// Kesting, Helbing 2006, "Delays, inaccuracies and anticipation in microscopic traffic models", Physica A 360; here
/// for any law, behind one leader). The wrapper lets the nominal behaviour plan on a view with the driver's errors
/// (`HumanView`) and turns the plan's acceleration into a decision, which takes effect one reaction time later:
///
///     time       t - T'                              t
///     sees       gap, speeds, with errors
///     decides    acceleration a, for the situation expected at t
///     drives                                         a, along the course planned at t
///
/// So its acceleration at t depends on the others' motion until t - T', as in the paper.
/// - Reaction time T': decisions are interpolated where it is not a multiple of the step.
/// - Estimation errors: gap exp(V_s w_s), and the other's speed + gap r_c w_r, with two independent Wiener
///   (Ornstein-Uhlenbeck) processes w of mean 0, variance 1 and the given persistence time, for all road users alike.
/// - Temporal anticipation: the driver decides for the situation a reaction time ahead. In the paper its acceleration
///   and the approach rate stay until then. Ours knows what it has decided and not yet done, and sees how the others
///   accelerate (`HumanView`). With the paper's, drivers in town brake by more than 0.5 g ten times as often: while a
///   decision is under way, they decide on the same braking again.
/// - The driver knows in advance what does not move (bends, limits, lines to stop at, the lane's end): while it
///   looks, it never accelerates more than it would alone on the road, without delay. In the paper the free road has
///   the delay, too; the two differ only on a free road.
/// - Where ways cross in a junction it decides without delay: drivers who give way look, and move slowly. That a queue
///   fills the junction's exit it notices late.
/// - Inattention: at random times the driver looks away and keeps its last decision, so that its reaction time grows by
///   as long as it looks away (frozen controls: Yang, Peng 2010, "Development of an errorable car-following driver
///   model"). It goes on steering. It looks away only while it expects not to brake for 2 s and does not creep, and
///   looks back, after 0.4 s on average, when it should brake. Both rules are ours: without them drivers collide about
///   ten times as often.
/// - Noise of the pedals: a third such process is added to the acceleration, but never drives it over a line while it
///   looks; below 5 m/s it is the less the slower it drives. 0.21 m/s^2, correlated over 1.3 s, are those of drivers on
///   highD's motorways (Zhang, Sun 2022, "Bayesian calibration of the intelligent driver model").
///
/// Without reaction time, errors, inattention and noise it drives as the nominal behaviour, to the last bit. The
/// behaviour must keep the vehicle in lanes; it may change them, on the errors of the moment. Reaction times about as
/// long as the time headway make platoons unstable, and drivers collide; so do inattentive ones. O(1) beside
/// three plans of the nominal behaviour, four in steps in which it looks away.
template <BehaviorModel Nominal>
requires std::is_same_v<WorkspaceOf<Nominal>, NoWorkspace>
struct HumanDriver {
  Nominal nominal{};
  double reaction_time = 0.6;
  double gap_error = 0.1;
  double rate_error = 0.01;
  double persistence = 20.0;
  bool anticipates = true;
  double attentive = 10.0;
  double looks_away = 0.0;
  double noise = 0.21;
  double noise_persistence = 1.3;

  static constexpr char const* name = "human_driver";
  static constexpr char const* summary =
      "any behaviour, with a reaction time, lasting errors of estimated gaps and approach rates, anticipation, and "
      "times of inattention";
  static constexpr char const* source =
      "Treiber, Kesting, Helbing 2006; defaults: Treiber, Kesting 2013, chapter 12; inattention: Yang, Peng 2010";
  static constexpr auto parameters() {
    using P = HumanDriver;
    return parameter_list(
        parameter("nominal", &P::nominal, "the behaviour of this driver without its imperfections"),
        parameter("reaction_time", &P::reaction_time, "s", Range{0, 10}, "until a decision takes effect"),
        parameter("gap_error", &P::gap_error, "-", Range{0, 1}, "standard deviation of the gap's logarithm"),
        parameter("rate_error", &P::rate_error, "1/s", Range{0, 1},
                  "standard deviation of the approach rate, per metre of gap: of the inverse time to collision"),
        parameter("persistence", &P::persistence, "s", Range{0.01, 1e6}, "correlation time of these errors"),
        parameter("anticipates", &P::anticipates, "decides for the situation a reaction time ahead"),
        parameter("attentive", &P::attentive, "s", Range{0.1, 1e6}, "mean time until the driver looks away"),
        parameter("looks_away", &P::looks_away, "s", Range{0, 60}, "mean time for which it does; 0: never"),
        parameter("noise", &P::noise, "m/s^2", Range{0, 10}, "standard deviation of what its acceleration errs by"),
        parameter("noise_persistence", &P::noise_persistence, "s", Range{0.01, 1e6}, "its correlation time"));
  }

  /// Decisions that a driver remembers. If more steps than that make up a reaction time, it decides less often.
  static constexpr std::size_t decisions = 16;

  struct Memory {
    MemoryOf<Nominal> nominal{};
    std::array<float, decisions> decided{};    ///< accelerations, latest first [m/s^2]
    float age{};                               ///< of the latest [s]
    float gap_error{}, rate_error{}, noise{};  ///< the processes w
    bool has_begun = false;
    bool looks_away = false;

    void fell_short(double way, bool left_course) { cambium::fell_short(nominal, way, left_course); }
    void was_set() { cambium::was_set(nominal); }

    static constexpr char const* name = "human_driver_memory";
    static constexpr auto parameters() {
      using P = Memory;
      return parameter_list(parameter("nominal", &P::nominal, "the nominal driver's"),
                            parameter("decided", &P::decided, "m/s^2", any_finite, "accelerations, latest first"),
                            parameter("age", &P::age, "s", any_finite, "of the latest"),
                            parameter("gap_error", &P::gap_error, "-", any_finite, "process of the error in gaps"),
                            parameter("rate_error", &P::rate_error, "-", any_finite, "likewise in rates"),
                            parameter("has_begun", &P::has_begun, "it has driven a step"),
                            parameter("looks_away", &P::looks_away, "from the road"),
                            parameter("noise", &P::noise, "-", any_finite, "process of the error in acceleration"));
    }

    friend bool operator==(Memory const&, Memory const&) = default;
  };

  static constexpr bool looks_beside = detail::looks_beside<Nominal>();
  static constexpr bool looks_around = detail::looks_around<Nominal>();
  static constexpr bool heeds_conflicts = detail::heeds_conflicts<Nominal>();

  [[nodiscard]] double start_time() const requires requires(Nominal const behavior) { behavior.start_time(); }
  { return nominal.start_time(); }

  template <class View>
  [[nodiscard]] Plan<View> plan(View const& view, Memory& memory, double dt) const {
    bool const is_new = !memory.has_begun;
    auto estimate = perceive(view, memory, dt);
    auto const before = memory.nominal;
    auto const course = nominal.plan(HumanView<View>(view, estimate), memory.nominal, dt);
    bool const acts_now = reaction_time == 0.0 && !memory.looks_away && noise == 0.0;
    if (course.status != PlanStatus::valid || (acts_now && looks_away == 0.0)) return course;
    if (!course.trajectory.empty() && !is_finite(course.trajectory.back())) return course;
    if (memory.looks_away && start_of(view, course, dt) < static_cast<double>(memory.decided[0]) - 0.7) {
      auto random = view.random(purpose + 1);
      memory.looks_away = uniform01(random) < portable::exp(-dt / catches_eye);
    }
    double const speed = std::max(0.0, view.state().speed);
    double const alone = planned(view, before, {.alone = true}, dt);
    memory.age += static_cast<float>(dt);
    if (is_new || memory.age > interval(dt) - 0.5 * dt) {
      if (anticipates) foresee(memory, speed, alone, dt, estimate);
      double const last = memory.decided[0];
      decide(memory, memory.looks_away ? last : smoothly(decision(view, before, estimate, alone, dt), speed, last, dt),
             is_new);
    }
    if (acts_now) return course;
    double const decided = in_effect(memory, dt), error = noise * static_cast<double>(memory.noise);
    double const wanted = decided + error * std::min(1.0, speed / steady);
    double const acceleration = memory.looks_away ? wanted : std::min(wanted, alone);
    auto const motion = ConstantAcceleration{.acceleration = acceleration}.motion(speed, dt);
    cambium::fell_short(memory.nominal, detail::course_length(course, view.state()) - motion.distance, false);
    return detail::plan_along_course(view, course, motion, dt);
  }

 private:
  static constexpr std::uint32_t purpose = 0x4d44u;
  static constexpr double catches_eye = 0.4;  ///< mean time until it looks back where it should brake [s]
  static constexpr double steady = 5.0;       ///< speed above which the noise does not depend on it [m/s]

  /// Time between decisions [s], a multiple of the step.
  [[nodiscard]] double interval(double dt) const {
    return dt * std::max(1.0, std::ceil(reaction_time / (dt * static_cast<double>(decisions - 1)) - 1e-9));
  }

  /// Lets the errors drift and the attention come and go; returns the estimate of now.
  template <class View>
  [[nodiscard]] HumanEstimate perceive(View const& view, Memory& memory, double dt) const {
    bool const is_new = !memory.has_begun;
    memory.has_begun = true;
    if (gap_error == 0.0 && rate_error == 0.0 && looks_away == 0.0 && noise == 0.0) return {};
    auto random = view.random(purpose);
    auto const drift = [&](float& process, double over) {
      double const kept = is_new ? 0.0 : portable::exp(-dt / over), fresh = std::sqrt(1.0 - kept * kept);
      process = static_cast<float>(kept * static_cast<double>(process) + fresh * Normal{}(random));
    };
    drift(memory.gap_error, persistence);
    drift(memory.rate_error, persistence);
    if (noise > 0.0) drift(memory.noise, noise_persistence);
    double const mean = memory.looks_away ? looks_away : attentive;
    HumanEstimate const estimate{.gap_factor = portable::exp(gap_error * static_cast<double>(memory.gap_error)),
                                 .rate_error = rate_error * static_cast<double>(memory.rate_error)};
    bool const turns = looks_away > 0.0 && !is_new && uniform01(random) < 1.0 - portable::exp(-dt / mean);
    if (turns) memory.looks_away = !memory.looks_away && foresees_calm(view, memory, estimate, dt);
    return estimate;
  }

  /// Whether the driver, which neither creeps nor brakes or accelerates much, expects not to have to brake within the
  /// time of a long glance, if nobody changes speed.
  template <class View>
  [[nodiscard]] bool foresees_calm(View const& view, Memory const& memory, HumanEstimate estimate, double dt) const {
    constexpr double glance = 2.0, little = 0.5;  // [s], [m/s^2]
    double const speed = std::max(0.0, view.state().speed);
    bool const creeps = speed >= standing_speed && speed < steady;
    if (creeps || std::abs(static_cast<double>(memory.decided[0])) > little) return false;
    estimate.reach = glance;
    estimate.way = glance * speed;
    estimate.speed = speed;
    estimate.decides = true;
    return planned(view, memory.nominal, estimate, dt) > -2.0 * little;
  }

  /// Acceleration [m/s^2] that the nominal behaviour plans on the estimate for the next `dt` [s].
  template <class View>
  [[nodiscard]] double planned(View const& view, MemoryOf<Nominal> memory, HumanEstimate const& estimate,
                               double dt) const {
    HumanView<View> const seen(view, estimate);
    return start_of(seen, nominal.plan(seen, memory, dt), dt);
  }

  /// Acceleration [m/s^2] of a plan in the next `dt` [s]; 0 if it is too short.
  template <class View, class P>
  [[nodiscard]] static double start_of(View const& view, P const& plan, double dt) {
    auto const end = InterpolateExecution{}.execute(plan, view.state(), view.dynamics(), view.time() + dt);
    return end.valid ? (end.state.speed - std::max(0.0, view.state().speed)) / dt : 0.0;
  }

  /// The acceleration decided on an estimate of the others [m/s^2]: the one that they demand; if they demand none, the
  /// larger of 0 and the one that the driver would choose `alone` now.
  template <class View>
  [[nodiscard]] double decision(View const& view, MemoryOf<Nominal> const& memory, HumanEstimate estimate, double alone,
                                double dt) const {
    estimate.decides = true;
    double const with_others = planned(view, memory, estimate, dt);
    estimate.alone = true;
    return with_others < planned(view, memory, estimate, dt) ? with_others : std::max(0.0, alone);
  }

  /// What the nominal driver's bound on jerk, if it has one, leaves of a decision to brake [m/s^2] after `last`.
  [[nodiscard]] double smoothly(double wanted, [[maybe_unused]] double speed, [[maybe_unused]] double last,
                                [[maybe_unused]] double dt) const {
    if constexpr (requires {
                    nominal.law.comfortable_deceleration;
                    nominal.jerk;
                  })
      return std::max(wanted,
                      bounded_acceleration(wanted, speed, nominal.law.comfortable_deceleration,
                                           nominal.law.lowest_acceleration, {nominal.jerk, last}, interval(dt)));
    else
      return wanted;
  }

  /// Extends the estimate to the time at which what is decided now takes effect.
  void foresee(Memory driven, double speed, double alone, double dt, HumanEstimate& estimate) const {
    estimate.reach = reaction_time;
    estimate.speed = speed;
    for (double rest = reaction_time, each = interval(dt); rest > 1e-9; rest -= each) {
      double const step = std::min(each, rest), acceleration = std::min(in_effect(driven, dt), alone);
      auto const motion = ConstantAcceleration{.acceleration = acceleration}.motion(estimate.speed, step);
      estimate.way += motion.distance;
      estimate.speed = motion.speed;
      driven.age += static_cast<float>(step);
    }
  }

  static void decide(Memory& memory, double acceleration, bool is_first) {
    auto const a = static_cast<float>(acceleration);
    if (is_first) memory.decided.fill(a);
    std::copy_backward(memory.decided.begin(), memory.decided.end() - 1, memory.decided.end());
    memory.decided[0] = a;
    memory.age = 0.0f;
  }

  /// The acceleration decided a reaction time ago [m/s^2].
  [[nodiscard]] double in_effect(Memory const& memory, double dt) const {
    double const steps = std::max(0.0, reaction_time - static_cast<double>(memory.age)) / interval(dt);
    constexpr std::size_t last = decisions - 1;
    auto const later = steps < static_cast<double>(last) ? static_cast<std::size_t>(steps) : last,
               earlier = std::min(later + 1, last);
    double const share = steps - static_cast<double>(later);
    return (1.0 - share) * static_cast<double>(memory.decided[later]) +
           share * static_cast<double>(memory.decided[earlier]);
  }
};
static_assert(BehaviorModel<HumanDriver<IdmClassic>>);

}  // namespace cambium::inline v0_1
