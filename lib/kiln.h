/* Declares the library of kiln, a headless batch renderer for particle effects. It is the one
 * header that a program includes.
 *
 * A program loads a scene, opens a device and renders a job:
 *
 *     struct kiln_error error = kiln_error_empty();
 *     struct kiln_scene *scene = kiln_scene_load("fire.yaml", NULL, &error);
 *     struct kiln_device *device = kiln_device_open(NULL, &error);
 *     struct kiln_render_params params = kiln_render_defaults();
 *     params.output = "fire.mp4";
 *     bool ok = scene && device && kiln_render(device, scene, &params, NULL, &error);
 *     kiln_device_close(&device);
 *     kiln_scene_destroy(&scene);
 *
 * Errors: a function that can fail returns false or NULL and fills the error, which is not NULL.
 * Nothing in the library prints or exits; messages go to the log callback. Threads: a device and
 * what was made with it belong to the thread that opened it. Scenes are immutable once loaded and
 * may be shared. Nothing is global.
 *
 * Structs that begin with `size` can grow at their end in later versions: fill one by the function
 * that is named after it, then change what you need. A program that was built against an older
 * version goes on with a newer library, which takes its own defaults for what the program does not
 * know. NULL for parameters stands for all defaults. Structs without `size` never change; those
 * that a caller fills have no padding at their end, where a later member would lie.
 */
#ifndef KILN_H
#define KILN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* What the shared library exports. */
#define KILN_API __attribute__((visibility("default")))

/* Defines struct TYPE FUNCTION(void): all zero but its size. */
#define KILN_EMPTY(type, function)                                                                 \
    static inline struct type function(void)                                                       \
    {                                                                                              \
        struct type empty;                                                                         \
        memset(&empty, 0, sizeof empty);                                                           \
        empty.size = sizeof empty;                                                                 \
        return empty;                                                                              \
    }

#ifdef __cplusplus
extern "C" {
#endif

#define KILN_VERSION "0.2.0"

/* The version of the library that is linked, where KILN_VERSION is that of this header. */
KILN_API const char *kiln_version(void);

/* What went wrong. The values are the program's exit codes. */
enum kiln_code {
    KILN_OK = 0,
    KILN_FRAME_FAILED = 1,   /* a frame failed, or a picture differs */
    KILN_USAGE = 2,          /* the request makes no sense, or an output is there already */
    KILN_INVALID_INPUT = 3,  /* a scene, texture or other input file is wrong */
    KILN_NO_DEVICE = 4,      /* no usable device */
    KILN_DEVICE_FAILED = 5,  /* device lost, out of memory, or a frame past its time limit */
    KILN_IO = 6,             /* reading or writing failed */
    KILN_GOLDEN_MISSING = 7, /* a golden picture does not exist */
    KILN_OVER_LIMIT = 8,     /* more than the limits of the job allow */
    KILN_READER_GONE = 9,    /* nobody reads a stream any more */
    KILN_INTERRUPTED = 130,  /* the caller asked to stop */
};

enum { KILN_MESSAGE_SIZE = 1024, KILN_PATH_SIZE = 4096 };

/* What a clip may be: pixels a side, frames, frames a second from 1 on. */
enum { KILN_MIN_EDGE = 16, KILN_MAX_EDGE = 16384, KILN_MAX_FRAMES = 1000000, KILN_MAX_RATE = 1000 };

/* An error as one complete line for a person: place, what was found, what is allowed. */
struct kiln_error {
    size_t size; /* or 0: what is here */
    enum kiln_code code;
    char message[KILN_MESSAGE_SIZE];
};
KILN_EMPTY(kiln_error, kiln_error_empty)

enum kiln_log_level { KILN_LOG_DEBUG, KILN_LOG_INFO, KILN_LOG_WARNING };

/* Receives one line without its newline. May be called from worker threads. */
struct kiln_log {
    void (*write)(void *user, enum kiln_log_level level, const char *line);
    void *user;
};

/* A request to stop, which any thread may make, and a signal handler, too. Calls that were given it
 * end with KILN_INTERRUPTED, and leave nothing half-written. Destroy it after they have ended. */
struct kiln_cancel;
KILN_API struct kiln_cancel *kiln_cancel_create(void); /* NULL when memory is short */
KILN_API void kiln_cancel_destroy(struct kiln_cancel **cancel);
KILN_API void kiln_cancel_request(struct kiln_cancel *cancel);
KILN_API bool kiln_cancel_is_requested(const struct kiln_cancel *cancel); /* NULL: false */

/* ---- Scenes ------------------------------------------------------------------------------- */

struct kiln_scene;

/* How a scene file is read. overrides are "dotted.key=value" texts, applied in order after the
 * file; a '*' names every entry of a map or list. asset_root NULL is the scene file's folder. */
struct kiln_scene_params {
    size_t size;
    const char *asset_root;
    const char *const *overrides;
    size_t override_count;
    /* Asked while a mesh is imported, now or when it is drawn, which may take seconds, for as long
     * as the scene lives; true ends with KILN_INTERRUPTED; NULL: never. */
    bool (*stop)(void *user);
    void *user;
    const struct kiln_cancel *cancel; /* NULL: nobody cancels */
    struct kiln_budget *budget; /* of the job, for as long as the scene lives; NULL: no limits */
};
KILN_EMPTY(kiln_scene_params, kiln_scene_defaults)

/* Reads, validates and returns a scene, which the caller destroys; or NULL with KILN_INVALID_INPUT,
 * also when there is no such file, KILN_USAGE for an override that is no "key=value", KILN_IO when
 * reading fails, KILN_OVER_LIMIT, or KILN_DEVICE_FAILED when memory is short. */
KILN_API struct kiln_scene *
kiln_scene_load(const char *path, const struct kiln_scene_params *params, struct kiln_error *error);

/* The same for a text in memory; name stands for the file in messages, and relative asset paths
 * start at params->asset_root or, without one, at the working directory. */
KILN_API struct kiln_scene *kiln_scene_parse(const char *text, size_t size, const char *name,
                                             const struct kiln_scene_params *params,
                                             struct kiln_error *error);
KILN_API void kiln_scene_destroy(struct kiln_scene **scene);

/* Writes the scene with every default spelled out, as a scene file that loads to the same scene. */
KILN_API bool kiln_scene_print(const struct kiln_scene *scene, FILE *out);

/* The same into memory of the caller: as much as fits into room bytes, with a zero at its end. text
 * may be NULL when room is 0. Returns the length of the whole text without that zero; 0 when memory
 * is short, and then text is empty. */
KILN_API size_t kiln_scene_text(const struct kiln_scene *scene, char *text, size_t room);

/* Facts of a scene that a caller plans with. */
struct kiln_scene_info {
    size_t size;
    uint32_t width, height; /* pixels */
    uint32_t frames;
    uint32_t fps_num, fps_den;
    uint32_t steps_per_frame;
    uint32_t warmup_steps;
    uint32_t system_count;
    uint64_t particle_capacity; /* slots over all systems */
    uint64_t steps;             /* of the whole clip */
    uint64_t memory_bytes;      /* that rendering on the device cpu is expected to take */
    char hash[65]; /* SHA-256 of the scene with every default and of its textures, in hex */
};
KILN_EMPTY(kiln_scene_info, kiln_scene_info_empty)
KILN_API void kiln_scene_get_info(const struct kiln_scene *scene, struct kiln_scene_info *info);

/* ---- Devices ------------------------------------------------------------------------------ */

struct kiln_device;

/* The name of the device that is no GL device: threads and vectors of this machine, for techniques
 * called `cpu`. Every machine has it, and all make the same pixels with it. */
#define KILN_DEVICE_CPU "cpu"

struct kiln_device_info {
    size_t size;
    uint32_t index;
    bool gl;        /* false: KILN_DEVICE_CPU */
    bool usable;    /* OpenGL 4.3 or later with all that kiln needs, or no GL */
    bool software;  /* draws on the CPU */
    bool exact;     /* passed the exactness probe: may simulate */
    char name[128]; /* GL renderer */
    char vendor[128];
    char gl_version[128];
    char platform[32]; /* "device" or "surfaceless", or "host" without GL */
    char problem[256]; /* why it is not usable, and what mends it; empty when it is */
    char vectors[16];  /* without GL: the widest ones, "avx2"; and the threads a job gets */
    uint32_t threads;
    int32_t max_work_group_invocations;
    int32_t max_shared_memory_bytes;
    int64_t max_storage_block_bytes;
    int32_t max_texture_size;
    int32_t max_array_layers;
};
KILN_EMPTY(kiln_device_info, kiln_device_info_empty)

/* wanted: NULL takes the first GPU, or else KILN_DEVICE_CPU; "N" an index from the list,
 * KILN_DEVICE_CPU that one, for which nothing of GL is loaded; "software" the first GL device that
 * draws on the CPU, anything else a part of a device's name. */
struct kiln_device_params {
    size_t size;
    const char *wanted;
    bool gl;    /* with wanted NULL: a GL device, if need be the software one; for techniques that
                 * kiln_techniques_need_gl says it of */
    bool debug; /* a GL debug context: errors are logged and fail the job */
    struct kiln_log log;
};
KILN_EMPTY(kiln_device_params, kiln_device_defaults)

/* Whether the variables of the environment that the library reads make sense: KILN_USAGE, for a
 * KILN_SIMD of vectors that the machine lacks. What needs them fails so, too, but later. */
KILN_API bool kiln_environment_check(struct kiln_error *error);

/* Fills up to capacity entries, `stride` bytes from one to the next, each with its size set; they
 * begin with KILN_DEVICE_CPU. Returns how many devices there are; *advice (may be NULL) gets what
 * this machine lacks and the package that mends it, or "". */
KILN_API size_t kiln_device_list(struct kiln_device_info *infos, size_t stride, size_t capacity,
                                 char advice[256]);

KILN_API struct kiln_device *kiln_device_open(const struct kiln_device_params *params,
                                              struct kiln_error *error);
KILN_API void kiln_device_close(struct kiln_device **device);
KILN_API const struct kiln_device_info *kiln_device_get_info(const struct kiln_device *device);

/* ---- Rendering ---------------------------------------------------------------------------- */

/* Frames first..last, both included. */
struct kiln_frame_range {
    uint32_t first, last;
};

/* The passes of a frame, in order: the names of timers, debug groups and report columns. */
#define KILN_PASSES(X)                                                                             \
    X(simulate)                                                                                    \
    X(sort)                                                                                        \
    X(lighting)                                                                                    \
    X(backdrop)                                                                                    \
    X(particles)                                                                                   \
    X(bloom)                                                                                       \
    X(composite)                                                                                   \
    X(readback)                                                                                    \
    X(output)

enum kiln_pass {
#define KILN_PASS_ID(name) KILN_PASS_##name,
    KILN_PASSES(KILN_PASS_ID)
#undef KILN_PASS_ID
        KILN_PASS_COUNT
};

enum { KILN_MAX_PASSES = 16 }; /* that later versions may have */

KILN_API const char *kiln_pass_name(enum kiln_pass pass);

/* The 64-bit state hash after a step; equal on every device and with every technique. */
struct kiln_state_hash {
    uint32_t lane[2];
};

/* Told after each frame is handed to the output. */
struct kiln_progress {
    size_t size;
    uint32_t frame;          /* its number */
    uint32_t done, total;    /* drawn frames of this job */
    double elapsed_s, eta_s; /* eta_s < 0: not known yet */
    uint64_t alive;          /* living particles at the frame */
    struct kiln_state_hash state;
    double pass_ms[KILN_MAX_PASSES];
};
KILN_EMPTY(kiln_progress, kiln_progress_empty)

/* An atlas for game engines: frames as cells of one PNG, in rows from the top, each from the left.
 * Beside FILE.png comes FILE.json, its layout, and with `motion` FILE_motion.png: where each pixel
 * of a cell goes in the next one. */
struct kiln_flipbook {
    size_t size;
    bool motion;
    bool premultiplied;     /* colours times alpha, as seen over black; else straight, with colours
                               where alpha is zero as well */
    uint32_t columns, rows; /* 1 to 64 */
    uint32_t padding;       /* pixels added on each side of a cell, 0 to 256 */
};
KILN_EMPTY(kiln_flipbook, kiln_flipbook_empty)

/* Chooses the frames of the cells, columns * rows, evenly out of ascending ranges: the k-th cell of
 * n shows the frame at k/n of them. KILN_USAGE when the ranges have fewer frames. */
KILN_API bool kiln_flipbook_sample(const struct kiln_flipbook *flipbook,
                                   const struct kiln_frame_range *ranges, size_t range_count,
                                   struct kiln_frame_range *cells, struct kiln_error *error);

/* Frames one after another into a descriptor, without a file. Of a pipe whose reader goes away,
 * with SIGPIPE ignored, rendering ends with KILN_READER_GONE. */
enum kiln_stream_format {
    KILN_STREAM_NONE,
    KILN_STREAM_Y4M,    /* YUV4MPEG2, 4:2:0, BT.709 in limited range, as in an MP4 */
    KILN_STREAM_RGB24,  /* bytes, sRGB, rows from the top */
    KILN_STREAM_RGBA,   /* the same with straight alpha */
    KILN_STREAM_RGBAF32 /* floats, little-endian, linear, premultiplied: what EXR has */
};
struct kiln_stream {
    enum kiln_stream_format format;
    int descriptor; /* stays open */
};

/* A layer of a drawn frame: "display", what a PNG has (sRGB, RGBA, alpha not premultiplied), or
 * what a layer of an EXR has in floats (linear, premultiplied): "beauty", "depth", "fire", "smoke",
 * "bloom". Rows from the top. All of it lasts until the call returns that tells of it, or as long
 * as the kiln_frame that it is of. */
enum kiln_sample_type {
    KILN_SAMPLES_UINT8,
    KILN_SAMPLES_UINT16, /* in the machine's byte order; where the output has 16 bits */
    KILN_SAMPLES_FLOAT
};
struct kiln_frame_layer {
    size_t size;
    const char *layer;
    uint32_t frame;
    uint32_t width, height, channels; /* channels: 4, of depth 1 */
    enum kiln_sample_type samples;
    size_t row_bytes; /* from one row to the next */
    const void *pixels;
};
KILN_EMPTY(kiln_frame_layer, kiln_frame_layer_empty)

/* A file of a job that is whole and has its name: an image, a part of a clip that waits to be
 * joined
 * (`resume`, `shards`), or the clip, or what lies beside it. */
enum kiln_written_kind { KILN_WRITTEN_FRAME, KILN_WRITTEN_PART, KILN_WRITTEN_CLIP };
struct kiln_written {
    size_t size;
    const char *file; /* lasts for the call */
    enum kiln_written_kind kind;
    struct kiln_frame_range frames; /* that it holds, alone or with others in between */
    uint64_t bytes;
    char sha256[65]; /* of the file, in hex */
    /* The rest is known of a frame's file alone. */
    uint32_t done, total; /* frames of this run whose files are whole, of all that it draws */
    struct kiln_state_hash state;
    uint64_t alive;
    double pass_ms[KILN_MAX_PASSES]; /* those before the output */
};

struct kiln_render_params {
    size_t size;
    const char *output; /* a file, a pattern with %d or #, or NULL to render without writing */
    struct kiln_stream stream;  /* in place of an output */
    const char *manifest;       /* a JSON file that describes the run, or NULL */
    const char *const *command; /* words of a command line, for the manifest */
    size_t command_count;
    const char
        *build; /* of the program, "0.2.0 (254e4dc)", for the manifest; NULL: kiln_version() */
    const char *states; /* a folder of kiln_bake, where the run starts if it can, or NULL */
    const struct kiln_frame_range *ranges; /* ascending; range_count 0 renders every frame */
    size_t range_count;
    const char *const *techniques; /* "stage=name" */
    size_t technique_count;
    uint32_t threads; /* worker threads; 0 takes one a core */
    uint32_t
        work_group_size; /* of kernels that leave it open; 0: what suits each. No pixel changes */
    bool overwrite;
    /* Go on with a job that was killed: files that its journal names, or PNG, JPEG and EXR files
     * that carry the scene's hash, are looked at and stay, the rest is drawn. The journal lies
     * beside the output, and a clip waits there in parts until it is whole. With overwrite, all
     * begins anew. */
    bool resume;
    /* Draw only the parts of one of several shards, which goes on with what is there of them. A
     * clip waits for kiln_join. shards 0: all parts. */
    uint32_t shard, shards; /* from 0; of so many */
    bool state_hash;        /* compute it for each drawn frame; the manifest always has it */
    bool keep_frames;       /* for kiln_rendering_take_frame: frames have the layers below, without
                               a `picture`, too */
    uint32_t png_bits;      /* 8 or 16; of APNG and MKV, too */
    uint32_t exr_bits;      /* 16 or 32 */
    uint32_t quality;       /* video, JPEG: 0 (smallest) to 100 (visually lossless) */
    /* One cell for each frame: ranges come from kiln_flipbook_sample. NULL: no flipbook. */
    const struct kiln_flipbook *flipbook;
    /* Told of each frame's layers, those named here in this order ("display" when none is), whether
     * or not an output is written. KILN_USAGE for a layer that there is not. */
    const char *const *layers;
    size_t layer_count;
    void (*picture)(void *user, const struct kiln_frame_layer *layer);
    /* Told of each frame before it is stepped to and drawn, after that, and after it was handed to
     * the output, which may wait for who reads it. */
    void (*next)(void *user, uint32_t frame);
    void (*drawn)(void *user, uint32_t frame);
    void (*progress)(void *user, const struct kiln_progress *progress);
    /* Asked between frames, steps, passes and bands of rows, and while a clip ends; true ends with
     * KILN_INTERRUPTED. */
    bool (*stop)(void *user);
    void *user;
    const struct kiln_cancel *cancel; /* NULL: nobody cancels */
    struct kiln_log log;
    /* Told of each file as soon as it is whole, on any thread, one call at a time. Files are read
     * once more then, for their hash. */
    void (*written)(void *user, const struct kiln_written *file);
};
KILN_EMPTY(kiln_render_params, kiln_render_params_empty)

static inline struct kiln_render_params kiln_render_defaults(void)
{
    struct kiln_render_params params = kiln_render_params_empty();
    params.png_bits = 8;
    params.exr_bits = 16;
    params.quality = 80;
    return params;
}

/* Which technique ran a stage, and why. */
struct kiln_technique_choice {
    const char *stage, *name; /* "sort", "cpu" */
    const char *why;          /* the automatic choice fell on it; NULL: it was asked for */
};
enum { KILN_MAX_STAGES = 8 };

/* What a job did, for reports. */
struct kiln_render_stats {
    size_t size;
    uint32_t frames;               /* drawn */
    uint32_t kept;                 /* that were there already, with kiln_render_params.resume */
    uint32_t first_part, end_part; /* of a shard: those of parts first_part to end_part - 1 */
    uint64_t steps;
    double setup_s; /* programs, textures, buffers */
    double total_s;
    double pass_ms[KILN_MAX_PASSES]; /* sums over the job */
    uint64_t alive;                  /* at the last step */
    struct kiln_state_hash state;    /* after the last step */
    uint64_t particle_bytes;         /* of records and of sorting them, on each side they are on */
    uint64_t particle_capacity;
    char techniques[256];  /* "simulate=cpu sort=cpu ..." */
    uint32_t choice_count; /* one a stage */
    struct kiln_technique_choice choices[KILN_MAX_STAGES];
    uint32_t files;                  /* images, 1 for a video; 0: nothing was to be written */
    char first_file[KILN_PATH_SIZE]; /* what was written first */
};
KILN_EMPTY(kiln_render_stats, kiln_render_stats_empty)

/* Renders the job; its callbacks may use other devices, or render on this one. Files appear under
 * their names only when whole; after an error or a stop, what was finished stays and nothing
 * half-written is left. stats may be NULL. */
KILN_API bool kiln_render(struct kiln_device *device, const struct kiln_scene *scene,
                          const struct kiln_render_params *params, struct kiln_render_stats *stats,
                          struct kiln_error *error);

/* The same for a program with a loop of its own. Each call of `next` draws a frame and hands it to
 * `picture` and the output; *drawn is false when none was left. progress may be NULL. `end` waits
 * until the outputs are whole, or gives a job up that has frames left: KILN_INTERRUPTED; in any
 * case nothing is left of it. What params point to must last until then. All on the device's
 * thread. */
struct kiln_rendering;
KILN_API struct kiln_rendering *kiln_rendering_begin(struct kiln_device *device,
                                                     const struct kiln_scene *scene,
                                                     const struct kiln_render_params *params,
                                                     struct kiln_error *error);
KILN_API bool kiln_rendering_next(struct kiln_rendering *rendering, bool *drawn,
                                  struct kiln_progress *progress, struct kiln_error *error);
KILN_API bool kiln_rendering_end(struct kiln_rendering **rendering, struct kiln_render_stats *stats,
                                 struct kiln_error *error);

/* A drawn frame that a program keeps. It has the memory that the frame was drawn into, which an
 * output may be reading at the same time: nobody writes to it. It may outlive its job, scene and
 * device, and be used and destroyed on any thread. */
struct kiln_frame;

/* Hands over the frame that kiln_rendering_next drew, of a job with `keep_frames`; the caller
 * destroys it. NULL with KILN_USAGE when there is none: each can be taken once, and until the next
 * one is drawn. */
KILN_API struct kiln_frame *kiln_rendering_take_frame(struct kiln_rendering *rendering,
                                                      struct kiln_error *error);
KILN_API void kiln_frame_destroy(struct kiln_frame **frame);

/* Fills a layer of a frame, whose size is set. KILN_USAGE for one that it does not have. */
KILN_API bool kiln_frame_get_layer(const struct kiln_frame *frame, const char *name,
                                   struct kiln_frame_layer *layer, struct kiln_error *error);

/* Writes a layer as a picture, whoever made its samples: integers, which are "display" of 4
 * channels, as a PNG, whose alpha is left out where all is opaque; floats, of 4 channels or 1, as
 * an EXR of floats with the layer's name (NULL: "beauty" or "depth"). KILN_USAGE for a layer or a
 * suffix that is neither, and for a file that exists where it must not be overwritten; or else
 * KILN_IO or KILN_DEVICE_FAILED. The file is written whole or not at all. */
KILN_API bool kiln_layer_write(const struct kiln_frame_layer *layer, const char *path,
                               bool overwrite, struct kiln_error *error);

/* Removes the temporary files of every running job, with async-signal-safe calls only: for a signal
 * handler or a watchdog that ends the process next, with _exit. */
KILN_API void kiln_abandon_outputs(void);

/* Whether any stage will need GL when a job is asked for these, "stage=name", and else takes those
 * of KILN_DEVICE_CPU. What is no technique needs none. */
KILN_API bool kiln_techniques_need_gl(const char *const *techniques, size_t count);

#ifdef __cplusplus
}
#endif

#include "kiln_compare.h"
#include "kiln_job.h"
#include "kiln_limits.h"
#include "kiln_sandbox.h"

#endif
