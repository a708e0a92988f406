/* Compiles as C99, tracks a car on a map of the project and predicts it. */
#include <cambium/cambium.h>
#include <stdio.h>

int main(void) {
  cambium_predictor* predictor = cambium_open(CAMBIUM_SOURCE_DIR "/maps/highway.xodr", NULL);
  if (!predictor) return fprintf(stderr, "%s\n", cambium_error()), 1;
  cambium_object car = cambium_object_default();
  car.key = cambium_key_of("car");
  car.x = 100.0;
  car.y = -1.875;
  car.heading = 0.0;
  car.vx = 20.0;
  cambium_verdict verdict;
  cambium_request request = cambium_request_default();
  cambium_state states[30];
  cambium_mode mode;
  if (!cambium_update(predictor, 1764580000000000000, &car, 1, &verdict) ||
      !cambium_predict(predictor, &request, states, 30, &mode, 1))
    return fprintf(stderr, "%s\n", cambium_error()), 1;
  printf("cambium %s: %s, %s, at %.0f m\n", cambium_version(), cambium_motion_name(verdict.motion),
         cambium_maneuver_name(mode.maneuver), states[29].x);
  cambium_close(predictor);
  return states[29].x > 155.0 && states[29].x < 165.0 ? 0 : 1;
}
