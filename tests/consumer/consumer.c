/* A program in C with libpmdsim: a wall 2 m away, given as triangles, is measured by 8 x 8 pixels. Prints the
 * distance that the middle sees; ends with 1 where that is not 2 m, to some millimetres. */
#include <math.h>
#include <pmdsim.h>
#include <stdio.h>
#include <string.h>

static const char setup[] =
    "{\"sensors\": [{\"name\": \"pmd\", \"resolution\": [8, 8], \"pixel_pitch_m\": [45e-6, 45e-6],"
    "  \"focal_length_m\": 0.02, \"modulation_hz\": [20e6]}],"
    " \"illuminators\": [{\"name\": \"lamp\", \"pose\": {\"sensor\": \"pmd\"},"
    "  \"diodes\": {\"rings\": [{\"radius_m\": 0.02, \"count\": 8}]}}]}";

static const double corners_m[] = {-1, -1, -2, 1, -1, -2, 1, 1, -2, -1, 1, -2};
static const uint32_t triangles[] = {0, 1, 2, 0, 2, 3};

static int failed(const char *what) {
  fprintf(stderr, "%s: %s\n", what, pmdsim_error_message());
  return 1;
}

int main(void) {
  pmdsim_mesh mesh = {0};
  mesh.struct_size = sizeof mesh;
  mesh.positions_m = corners_m;
  mesh.vertex_count = 4;
  mesh.triangles = triangles;
  mesh.triangle_count = 2;

  pmdsim_simulator *simulator = NULL;
  pmdsim_frame *frame = NULL;
  pmdsim_channel distance = {0};
  distance.struct_size = sizeof distance;
  if (pmdsim_abi() != PMDSIM_ABI)
    return failed("version");
  if (pmdsim_simulator_create(NULL, &simulator))
    return failed("create");
  if (pmdsim_simulator_load_mesh(simulator, setup, strlen(setup), NULL, &mesh))
    return failed("load");
  if (pmdsim_render(simulator, 0, 0, NULL, &frame))
    return failed("render");
  if (pmdsim_frame_find(frame, "distance_m", &distance))
    return failed("distance_m");
  const float middle_m = ((const float *)distance.values)[4 * distance.columns + 4];
  printf("C, pmdsim %s: %u x %u pixels, %.4f m\n", pmdsim_version(), distance.columns, distance.rows,
         middle_m);
  pmdsim_frame_destroy(frame);
  pmdsim_simulator_destroy(simulator);
  return fabsf(middle_m - 2) < 5e-3F ? 0 : 1;
}
