/*
 * cambium's tracker and predictor for C, and for all that calls C: Rust, Python, Julia, older C++. Link
 * cambium_compiled_predictor and what that needs, and the C++ library. cambium/predictor.hpp,
 * cambium/tracking/tracked_object.hpp and cambium/tracking/predicted_modes.hpp document what the functions do.
 *
 * Metres, radians, seconds, map frame; stamps in nanoseconds of any epoch. No function throws. Those that can fail
 * return 0 or a null pointer then, and cambium_error says why. A predictor is for one thread at a time.
 */
#ifndef CAMBIUM_CAMBIUM_H
#define CAMBIUM_CAMBIUM_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct cambium_predictor cambium_predictor;

typedef struct {
  uint64_t high, low;
} cambium_key;

enum {
  CAMBIUM_UNKNOWN,
  CAMBIUM_CAR,
  CAMBIUM_TRUCK,
  CAMBIUM_BUS,
  CAMBIUM_TRAILER,
  CAMBIUM_MOTORCYCLE,
  CAMBIUM_BICYCLE,
  CAMBIUM_PEDESTRIAN,
  CAMBIUM_ANIMAL,
  CAMBIUM_OBSTACLE
};                                                                            /* kind */
enum { CAMBIUM_BOX_CENTER, CAMBIUM_REAR_AXLE };                               /* point */
enum { CAMBIUM_HEADING_YES, CAMBIUM_HEADING_UP_TO_SIGN, CAMBIUM_HEADING_NO }; /* heading_known */
enum { CAMBIUM_LIGHT_OFF, CAMBIUM_LIGHT_GREEN, CAMBIUM_LIGHT_YELLOW, CAMBIUM_LIGHT_RED };

/* Begin with cambium_object_default(): what is not known keeps that value. */
typedef struct {
  cambium_key key;
  int64_t stamp;
  double x, y, heading, vx, vy, length, width, yaw_rate, acceleration, existence;
  int32_t kind, point, heading_known, is_parked;
} cambium_object;

/* Numbers of cambium::ObjectMotion and cambium::Refusal; cambium_motion_name and cambium_refusal_name say them in
   words. lane: UINT32_MAX off the lanes. */
typedef struct {
  cambium_key key;
  double probability;
  uint32_t lane;
  int32_t motion, refusal, assumed_size, assumed_heading;
} cambium_verdict;

typedef struct {
  double x, y, heading, speed;
} cambium_state;

/* maneuver: number of cambium::Maneuver. */
typedef struct {
  double probability;
  int32_t maneuver;
  uint32_t lane;
} cambium_mode;

typedef struct {
  cambium_key key;
  cambium_state const* states; /* after 1, 2, ... steps */
  size_t count;
  double probability;
} cambium_trajectory;

/* Begin with cambium_request_default(): 1 mode of 30 steps of 0.1 s, marginal, of all objects. */
typedef struct {
  size_t steps, modes;
  double step;
  int32_t joint;
  cambium_key const* objects; /* null: all */
  size_t object_count;
  cambium_trajectory const* given;
  size_t given_count;
} cambium_request;

char const* cambium_version(void);
cambium_object cambium_object_default(void);
cambium_request cambium_request_default(void);
/* The key of a name, such as a UUID or a token. */
cambium_key cambium_key_of(char const* name);
char const* cambium_motion_name(int32_t motion);
char const* cambium_refusal_name(int32_t refusal);
char const* cambium_maneuver_name(int32_t maneuver);

/* What went wrong in the last call that failed, in this thread. Valid until the next call that fails. */
char const* cambium_error(void);

/* Reads an OpenDRIVE (.xodr), Lanelet2 (.osm) or CommonRoad (.xml) map. `origin`: null, or latitude and longitude of a
   Lanelet2 map's frame in degrees. Null on failure. */
cambium_predictor* cambium_open(char const* map_file, double const* origin);
void cambium_close(cambium_predictor* predictor);

/* `verdicts` has room for `count`. 0 on failure. */
int cambium_update(cambium_predictor* predictor, int64_t stamp, cambium_object const* objects, size_t count,
                   cambium_verdict* verdicts);
/* The number of tracked objects; writes their keys where there is room. */
size_t cambium_objects(cambium_predictor const* predictor, cambium_key* keys, size_t room);
/* Fills states[mode][object][step] and modes[mode][object]; the objects are request->objects or, without, those of
   cambium_objects. 0 on failure: nothing is written then. */
int cambium_predict(cambium_predictor* predictor, cambium_request const* request, cambium_state* states,
                    size_t state_room, cambium_mode* modes, size_t mode_room);
/* Builds the roads around a point, so that no update has to. 0 on failure. */
int cambium_prepare(cambium_predictor* predictor, double x, double y, double radius);
/* What a traffic light shows from now on. 0 on failure. */
int cambium_set_light(cambium_predictor* predictor, char const* name, int32_t color);

#ifdef __cplusplus
}
#endif

#endif
