/// The room `execution`: models that turn a plan into motion, perfectly or with the errors of a controller.
///
/// `InterpolateExecution` moves the agent to the plan's state. `StanleyExecution` and `LqrExecution` track the plan in
/// a loop (`track`): several times a step, the controller compares the vehicle with its reference and commands an
/// action, which takes effect after a delay and with noise (`Actuation`):
///
///     plan --> Reference --TrackingError--> controller --command--> delay, noise --> vehicle model --> next state
///                              ^                                                          |
///                              '----------------------------------------------------------'
#pragma once

#include "cambium/execution/execution_model.hpp"
#include "cambium/execution/execution_set.hpp"
#include "cambium/execution/interpolate.hpp"
#include "cambium/execution/lqr.hpp"
#include "cambium/execution/lqr_gain.hpp"
#include "cambium/execution/stanley.hpp"
#include "cambium/execution/steering.hpp"
#include "cambium/execution/tracking.hpp"
