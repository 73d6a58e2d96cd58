/* pmdsim.h: the C interface of libpmdsim, a simulator of continuous-wave time-of-flight cameras.
 *
 *     pmdsim_simulator *simulator;
 *     pmdsim_frame *frame;
 *     pmdsim_channel distance = {sizeof distance};
 *     if (pmdsim_simulator_create(NULL, &simulator) || pmdsim_simulator_load(simulator, "room.json") ||
 *         pmdsim_render(simulator, 0, 0, NULL, &frame) || pmdsim_frame_find(frame, "distance_m", &distance))
 *       puts(pmdsim_error_message());
 *
 * Every function returns a pmdsim_status, PMDSIM_OK or why it did nothing: then nothing it was to write is
 * written, the objects are as they were, and the pmdsim_error_*() functions tell more. No C++ exception comes
 * out of a function, and no signal handler is installed.
 *
 * Objects. A handle is a name, not an address: it is never used twice, and one that was destroyed, or never
 * was, gives PMDSIM_BAD_HANDLE. NULL may be destroyed.
 *
 * Threads. Different simulators may be used at once on different threads. One simulator serves one call at a
 * time; another meanwhile gives PMDSIM_BUSY, but for pmdsim_simulator_cancel(). Frames are constant and may
 * be read by any thread.
 *
 * Processes. A process that is forked from one that has used the library may read its frames and exec another
 * program, and must not call the library otherwise: a fork copies no threads of the device.
 *
 * Text is UTF-8 and ends with NUL. Text and values that the library returns are its own; each function says
 * how long they live.
 *
 * Structs begin with struct_size, their sizeof at the caller. A later version may add members at the end; the
 * library takes what an older caller has not for 0, and never writes beyond the size that it is told. A size
 * of another kind is PMDSIM_BAD_ARGUMENT.
 *
 * Units are SI. Images are row-major, row 0 at the top. Frames of reference are those of docs/theory.md,
 * "Conventions": the world is glTF's (right-handed, +Y up); a camera's is x right, y down, z forward, its
 * origin at the lens.
 */
#ifndef PMDSIM_H
#define PMDSIM_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__) && defined(PMDSIM_BUILDING_LIBRARY)
#define PMDSIM_API __attribute__((visibility("default")))
#else
#define PMDSIM_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Changes where a program that was compiled with an older header no longer works. The shared library's
 * soname has it. */
#define PMDSIM_ABI 0

/* The first ones are the program's exit codes. */
typedef enum pmdsim_status {
  PMDSIM_OK = 0,
  PMDSIM_INTERNAL = 1,     /* a mistake in the library */
  PMDSIM_BAD_ARGUMENT = 2, /* an argument is wrong */
  PMDSIM_BAD_INPUT = 3, /* a setup, a scene or another file is wrong; file and place tell which and where */
  PMDSIM_NO_DEVICE = 4, /* no usable device */
  PMDSIM_OUT_OF_MEMORY = 5, /* of the host or the device */
  PMDSIM_DEVICE_LOST = 6,
  PMDSIM_BAD_OUTPUT = 7,   /* a file cannot be written */
  PMDSIM_BAD_ACCURACY = 8, /* the accuracy asked for cannot be reached */
  PMDSIM_BAD_HANDLE = 9,   /* an object was destroyed, or never was one */
  PMDSIM_BUSY = 10,        /* the simulator is in another call */
  PMDSIM_CANCELLED = 130   /* by pmdsim_simulator_cancel() */
} pmdsim_status;

typedef struct pmdsim_simulator pmdsim_simulator; /* a device and a setup */
typedef struct pmdsim_frame pmdsim_frame;         /* what one sensor measured */

/* The version of the library, as "0.6.0", and its PMDSIM_ABI. */
PMDSIM_API const char *pmdsim_version(void);
PMDSIM_API int pmdsim_abi(void);

/* Of this thread's last call that failed, until its next call. One line for people; the file that is wrong,
 * and the place in it: a JSON pointer, or "LINE:COLUMN". Empty where there is none. */
PMDSIM_API const char *pmdsim_error_message(void);
PMDSIM_API const char *pmdsim_error_file(void);
PMDSIM_API const char *pmdsim_error_place(void);

/* What there is, as JSON that lives until this thread's next call: the devices ([{"index", "name", "kind",
 * "driver", "usable", "lacks" (what a device lacks that is not usable)}, ...]), the JSON Schema of setups,
 * and the channels of frames
 * ([{"name", "unit", "about"}, ...]). No device is no error. */
PMDSIM_API pmdsim_status pmdsim_devices(const char **json);
PMDSIM_API pmdsim_status pmdsim_schema(const char **json);
PMDSIM_API pmdsim_status pmdsim_channels(const char **json);

/* A simulator without a setup on a device: an index, a part of a name, "cpu", "gpu", or "reference", the CPU
 * in double precision; NULL or "" chooses. PMDSIM_NO_DEVICE. */
PMDSIM_API pmdsim_status pmdsim_simulator_create(const char *device, pmdsim_simulator **simulator);
/* Frames that it made stay. One that is in a call is gone when that call ends. */
PMDSIM_API pmdsim_status pmdsim_simulator_destroy(pmdsim_simulator *simulator);

/* Takes a setup (docs/setup.md) in place of the one before: a file, or `length` bytes of text whose relative
 * paths start from `directory` (NULL: the process's). Paths do not follow the process to another directory
 * later. Changes that were set are gone. PMDSIM_BAD_INPUT. */
PMDSIM_API pmdsim_status pmdsim_simulator_load(pmdsim_simulator *simulator, const char *file);
PMDSIM_API pmdsim_status pmdsim_simulator_load_text(pmdsim_simulator *simulator, const char *text,
                                                    size_t length, const char *directory);

/* Triangles in place of a scene's file. */
typedef struct pmdsim_mesh {
  size_t struct_size;
  const double *positions_m; /* vertex_count x 3, world frame, metres, to 1e9 on either side */
  size_t vertex_count;
  const uint32_t *triangles; /* triangle_count x 3 vertices, counter-clockwise seen from the front */
  size_t triangle_count;
  const double *reflectivity; /* triangle_count values from 0 to 1; NULL: all 1 */
  const uint32_t *object_ids; /* triangle_count values below triangle_count; NULL: all 0 */
  int double_sided;           /* 0: the lens sees fronts alone; light is blocked by either side */
} pmdsim_mesh;

/* The same with a mesh for a scene, which is copied; the setup has no "scene" then, and no poses at nodes. */
PMDSIM_API pmdsim_status pmdsim_simulator_load_mesh(pmdsim_simulator *simulator, const char *text,
                                                    size_t length, const char *directory,
                                                    const pmdsim_mesh *mesh);

/* Changes the setup: `json` is an object of paths and values, {"sensors/0/focal_length_m": 0.02,
 * "nodes/robot/pose": {"matrix": [[...], [...], [...], [...]]}}. A path is a JSON pointer, with or without
 * its first slash, and may have the "name" of an element for its index; a number is an index. All changes
 * together are checked as a setup is, and taken or refused; they stay until the next load. Scene files are
 * not read again. PMDSIM_BAD_INPUT. */
PMDSIM_API pmdsim_status pmdsim_simulator_set(pmdsim_simulator *simulator, const char *json);

/* {"device", "driver", "setup" (as used, all defaults filled in), "sensors" (their names), "frames" (their
 * number), "objects" (the names of the scene's, by object_id), "warnings" ({"code", "place", "text"} each)},
 * as JSON that lives until the next call with the simulator. Without a setup "setup" is null, and nothing
 * follows. */
PMDSIM_API pmdsim_status pmdsim_simulator_describe(pmdsim_simulator *simulator, const char **json);

/* Ends the call that the simulator is in, soon, with PMDSIM_CANCELLED; from any thread, but from no signal
 * handler. Nothing happens where it is in none. */
PMDSIM_API pmdsim_status pmdsim_simulator_cancel(pmdsim_simulator *simulator);

/* How to measure. All 0: mode exact, all channels. */
typedef struct pmdsim_render_options {
  size_t struct_size;
  const char *mode;           /* "exact", "reduced" or "auto"; NULL: exact, or auto where an error is given */
  double max_error_m;         /* the largest error of distance; 0: the default of the mode */
  double max_amplitude_error; /* likewise of amplitude, relative; 0: any */
  const char *precision;      /* of the sum over the diodes, "fp32" or "fp64"; NULL: chosen */
  const char *samples;        /* S of S x S samples a pixel, "1" to "16", or "auto"; NULL: the setup's */
  const char *channels;       /* names, separated by commas; NULL: all but those on demand, as "all", to which
                               * "normals" and "rays" may be added. What only others need is not computed */
  uint32_t paths;             /* of the reference, for each pixel where light bounces; 0: it chooses */
  int strict;                 /* a frame some of whose pixels may be off by more is PMDSIM_BAD_ACCURACY; other
                               * warnings of the setup and of the frame are PMDSIM_BAD_INPUT */
  const char *output_precision; /* of distances, "float32" or "float64"; NULL: float32 */
} pmdsim_render_options;

/* Measures frame `frame` of the sensor with the index `sensor`, both from 0; the same bits as the program
 * `pmdsim render` writes. NULL for options: all 0. PMDSIM_BAD_ARGUMENT, also without a setup;
 * PMDSIM_BAD_INPUT; PMDSIM_OUT_OF_MEMORY; PMDSIM_DEVICE_LOST; PMDSIM_BAD_ACCURACY; PMDSIM_CANCELLED. */
PMDSIM_API pmdsim_status pmdsim_render(pmdsim_simulator *simulator, uint32_t sensor, uint32_t frame,
                                       const pmdsim_render_options *options, pmdsim_frame **result);

/* A frame from a file that `pmdsim render` wrote: .exr or .h5. It has channels alone. PMDSIM_BAD_INPUT. */
PMDSIM_API pmdsim_status pmdsim_frame_read(const char *file, pmdsim_frame **frame);

PMDSIM_API pmdsim_status pmdsim_frame_destroy(pmdsim_frame *frame);

typedef enum pmdsim_type { PMDSIM_FLOAT32 = 0, PMDSIM_UINT32 = 1, PMDSIM_FLOAT64 = 2 } pmdsim_type;

/* A view that lives as long as its frame. Floats are NaN where nothing was measured, ids 4294967295
 * (docs/outputs.md, "Channels"). */
typedef struct pmdsim_channel {
  size_t struct_size;
  const char *name; /* "distance_m"; of several frequencies "f0.distance_m" */
  const char *unit; /* "m"; "" for ids and shares */
  pmdsim_type type;
  uint32_t rows, columns;
  const void *values; /* rows x columns */
} pmdsim_channel;

/* The number of channels, one of them, and the one of that name. PMDSIM_BAD_ARGUMENT where there is none. */
PMDSIM_API pmdsim_status pmdsim_frame_channel_count(const pmdsim_frame *frame, size_t *count);
PMDSIM_API pmdsim_status pmdsim_frame_channel(const pmdsim_frame *frame, size_t index,
                                              pmdsim_channel *channel);
PMDSIM_API pmdsim_status pmdsim_frame_find(const pmdsim_frame *frame, const char *name,
                                           pmdsim_channel *channel);

/* What a manifest and a record say of the frame (docs/outputs.md, "The manifest"): sensor, frame, time_s,
 * camera, mode, errors claimed and found, frame_ms, passes_ms, warnings; JSON that lives as long as the
 * frame.
 * "{}" of a frame that was read. */
PMDSIM_API pmdsim_status pmdsim_frame_report(const pmdsim_frame *frame, const char **json);

/* The unit vectors, rows x columns x 3 values, from the lens through the centre of each pixel, in the
 * camera's frame; point_camera = distance_m * direction. `length` is the number of values that there is room
 * for. PMDSIM_BAD_ARGUMENT for less, and for a frame that was read. */
PMDSIM_API pmdsim_status pmdsim_frame_directions(const pmdsim_frame *frame, double *directions,
                                                 size_t length);

/* The page of a run that the program has written to a directory (docs/report.md), with frames as .exr or .h5.
 * `file` is the page; NULL or "" for report.html in the directory; one that is there is replaced. `max_mib`:
 * MiB that it may have, about, 1 to 1000; 0 for 10. What was made, as JSON that lives until this thread's
 * next call: {"report", "bytes", "frames", "left_out": [sentence, ...]}. PMDSIM_BAD_ARGUMENT;
 * PMDSIM_BAD_INPUT; PMDSIM_BAD_OUTPUT. */
PMDSIM_API pmdsim_status pmdsim_report(const char *directory, const char *file, double max_mib,
                                       const char **json);

/* Whether files that a scene names, its buffers and images, may lie outside of the scene's folder: 0, as at
 * first, or 1, for scenes that are trusted. Of setups that are loaded from here on. */
PMDSIM_API pmdsim_status pmdsim_simulator_allow_outside(pmdsim_simulator *simulator, int allowed);

#ifdef __cplusplus
}
#endif

#endif /* PMDSIM_H */
