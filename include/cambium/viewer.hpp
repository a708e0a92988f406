/// The room `viewer`: recordings of worlds, replays in a browser, and pictures of maps and traffic.
#pragma once

#include "cambium/viewer/html_replay.hpp"
#include "cambium/viewer/map_picture.hpp"
#include "cambium/viewer/map_picture_options.hpp"
#include "cambium/viewer/record_world.hpp"
#include "cambium/viewer/recording.hpp"
#include "cambium/viewer/svg_picture.hpp"
