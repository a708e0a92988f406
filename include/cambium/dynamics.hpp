/// The room `dynamics`: vehicle models and integration schemes.
///
/// A driver's action is acceleration and steering angle, for every vehicle. A model translates it to its own input,
/// within the vehicle's limits (`input`), and gives the change of the state (`derivative`). `drive` integrates that
/// over a time step and never reverses:
///
///     Action --input--> model's input --derivative--> change of the state --RK4 or Euler--> state after dt
#pragma once

#include "cambium/dynamics/dynamic_model.hpp"
#include "cambium/dynamics/dynamic_set.hpp"
#include "cambium/dynamics/integration.hpp"
#include "cambium/dynamics/kinematic_point.hpp"
#include "cambium/dynamics/single_track.hpp"
#include "cambium/dynamics/single_track_steering.hpp"
#include "cambium/dynamics/triple_integrator.hpp"
