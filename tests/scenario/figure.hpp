#pragma once

#include <cstddef>
#include <variant>

#include "cambium/scenario/scenario.hpp"

/// A number that changes with each place, speed, shape, driver and role of a scenario's agents.
template <class World>
double figure_of(cambium::Scenario<World> const& scenario) {
  auto const driver = [](auto const& behavior) {
    double sum = 0.0;
    if constexpr (requires { behavior.lateral.rule; })
      sum = 17.0 * behavior.lateral.rule.politeness + 19.0 * behavior.lateral.rule.bias;
    return sum + behavior.law.desired_speed + 2.0 * behavior.law.time_headway;
  };
  double sum = static_cast<double>(index_of(scenario.ego)) + 0.5 * static_cast<double>(scenario.controlled.size());
  for (std::size_t i = 0; i < scenario.agents.size(); ++i) {
    auto const& agent = scenario.agents[i];
    sum += static_cast<double>(i + 1) *
           (agent.position.x() + 3.0 * agent.position.y() + 5.0 * agent.speed + 7.0 * agent.heading.value_or(0.0) +
            11.0 * agent.shape.length() + 13.0 * std::visit(driver, agent.behavior));
  }
  return sum;
}
