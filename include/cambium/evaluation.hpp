#pragma once

#include "cambium/evaluation/collision.hpp"
#include "cambium/evaluation/course_end.hpp"
#include "cambium/evaluation/driving.hpp"
#include "cambium/evaluation/evaluator.hpp"
#include "cambium/evaluation/metrics/closed_loop_score.hpp"
#include "cambium/evaluation/metrics/displacement.hpp"
#include "cambium/evaluation/metrics/over_time.hpp"
#include "cambium/evaluation/metrics/per_agent.hpp"
#include "cambium/evaluation/metrics/post_encroachment_time.hpp"
#include "cambium/evaluation/metrics/rss_compliance.hpp"
#include "cambium/evaluation/off_road.hpp"
#include "cambium/evaluation/terms.hpp"
