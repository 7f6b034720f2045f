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
 * Functions that destroy, close or end an object set the caller's pointer to NULL. They do nothing,
 * and succeed, for a pointer that is NULL already and for NULL.
 * Nothing in the library prints or exits; messages go to the log callback. Threads: a device and
 * what was made with it belong to the thread that opened it. Scenes are immutable once loaded and
 * may be shared. Nothing is global.
 *
 * Lifetimes: a scene and a device must outlive the jobs on them, and so must all that parameters
 * point to. A job is a call of kiln_render, kiln_bake or kiln_plan_tasks, or the time from
 * kiln_rendering_begin to kiln_rendering_end. A debug build of the library (without NDEBUG) refuses
 * a job on a scene or device that was destroyed, or on a pointer to something else, with
 * KILN_USAGE; there, destroyed scenes and devices keep a page of memory. In other builds such a job
 * is undefined behaviour.
 *
 * Structs that begin with `size` can grow at their end in later versions: fill one by the function
 * that stands below it, such as kiln_render_defaults, then change what you need. A program that was
 * built against an older version goes on with a newer library, which takes its own defaults for
 * what the program does not know. NULL for parameters stands for all defaults. Structs without
 * `size` never change; those that a caller fills have no padding at their end, where a later member
 * would lie.
 */
#ifndef KILN_H
#define KILN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* Marks a symbol that the shared library exports. */
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

/* Returns the version of the library that is linked, a static text. KILN_VERSION is the version of
 * this header. */
KILN_API const char *kiln_version(void);

/* Kinds of errors. The values are also the exit codes of the program kiln. */
enum kiln_code {
    KILN_OK = 0,
    KILN_FRAME_FAILED = 1,   /* a frame failed, or a picture differs */
    KILN_USAGE = 2,          /* the request makes no sense, or an output is there already */
    KILN_INVALID_INPUT = 3,  /* a scene, texture or other input file is wrong */
    KILN_NO_DEVICE = 4,      /* no usable device */
    KILN_DEVICE_FAILED = 5,  /* device lost, out of memory, or a frame past its time limit */
    KILN_IO = 6,             /* reading or writing failed */
    KILN_GOLDEN_MISSING = 7, /* a golden picture does not exist */
    KILN_OVER_LIMIT = 8,     /* the job takes more than its limits allow */
    KILN_READER_GONE = 9,    /* the reader of a stream has closed it */
    KILN_INTERRUPTED = 130,  /* the caller asked to stop */
};

enum { KILN_MESSAGE_SIZE = 1024, KILN_PATH_SIZE = 4096 };

/* Limits of every clip: width and height in pixels, number of frames, and frames a second (at least
 * 1). */
enum { KILN_MIN_EDGE = 16, KILN_MAX_EDGE = 16384, KILN_MAX_FRAMES = 1000000, KILN_MAX_RATE = 1000 };

/* An error. The message is one complete line for a person: the place, what was found there, and
 * what is allowed. */
struct kiln_error {
    size_t size; /* sizeof the caller's struct; 0 stands for that of this version */
    enum kiln_code code;
    char message[KILN_MESSAGE_SIZE];
    /* The place in kiln's source that detected the error, for people who change kiln: a path in the
     * tree, which nobody frees, or NULL. */
    const char *file;
    int line;
};
KILN_EMPTY(kiln_error, kiln_error_empty)

enum kiln_log_level { KILN_LOG_DEBUG, KILN_LOG_INFO, KILN_LOG_WARNING };

/* A callback that receives each message as one line without its newline. It may be called from
 * worker threads. */
struct kiln_log {
    void (*write)(void *user, enum kiln_log_level level, const char *line);
    void *user;
};

/* A request to stop. Any thread and any signal handler may make it. Calls that were given this
 * object then end with KILN_INTERRUPTED and leave nothing half-written. Destroy the object after
 * these calls have ended. */
struct kiln_cancel;
KILN_API struct kiln_cancel *kiln_cancel_create(void); /* NULL when memory is short */
KILN_API void kiln_cancel_destroy(struct kiln_cancel **cancel);
KILN_API void kiln_cancel_request(struct kiln_cancel *cancel);
KILN_API bool kiln_cancel_is_requested(const struct kiln_cancel *cancel); /* NULL: false */

/* ---- Scenes ------------------------------------------------------------------------------- */

/* A scene that was loaded. It may be destroyed, on any thread, when all jobs on it have ended. */
struct kiln_scene;

/* How a scene file is read. `overrides` are texts "dotted.key=value" that are applied in order
 * after the file; a '*' in a key names every entry of a map or list. "params.NAME=VALUE" gives a
 * parameter a value, before the others are applied. `asset_root` is the folder that relative paths
 * of assets start at; NULL stands for the scene file's folder. */
struct kiln_scene_params {
    size_t size;
    const char *asset_root;
    const char *const *overrides;
    size_t override_count;
    /* Called now and then while files of the scene are read, which may take seconds: on loading,
     * and later when the scene is drawn. So it must stay valid as long as the scene lives. When it
     * returns true, the call ends with KILN_INTERRUPTED. NULL: nobody stops. */
    bool (*stop)(void *user);
    void *user;
    const struct kiln_cancel *cancel; /* NULL: nobody cancels */
    struct kiln_budget *budget;       /* the job's; must outlive the scene; NULL: no limits */
    struct kiln_log log; /* gets warnings, which begin with the scene's file and line */
    /* Files with values of the scene's parameters, YAML or JSON: {length: 3 s, brand: "#e61e28"}.
     * They are applied in order, before overrides "params.NAME=VALUE". */
    const char *const *params_files;
    bool keep_origins; /* for kiln_scene_print_origins; takes the memory of the scene's text */
    size_t params_file_count;
};
KILN_EMPTY(kiln_scene_params, kiln_scene_defaults)

/* Reads and validates a scene file. A file whose path enters the asset root of `params` is opened
 * below the root, whatever links are there; links in other paths are followed. Returns the scene,
 * which the caller destroys, or NULL with KILN_INVALID_INPUT when the scene is wrong or the file
 * does not exist, KILN_USAGE for an override that is not "key=value", KILN_IO when reading fails,
 * KILN_OVER_LIMIT, KILN_INTERRUPTED, or KILN_DEVICE_FAILED when memory is short. */
KILN_API struct kiln_scene *
kiln_scene_load(const char *path, const struct kiln_scene_params *params, struct kiln_error *error);

/* Does what kiln_scene_load does, for a text of `size` bytes in memory. `name` stands for the file
 * in messages. Relative paths of assets start at params->asset_root or, if that is NULL, at the
 * working directory. */
KILN_API struct kiln_scene *kiln_scene_parse(const char *text, size_t size, const char *name,
                                             const struct kiln_scene_params *params,
                                             struct kiln_error *error);
KILN_API void kiln_scene_destroy(struct kiln_scene **scene);

/* Writes the scene as a scene file with every default spelled out; the file loads to the same
 * scene. Returns false when writing fails or memory is short. */
KILN_API bool kiln_scene_print(const struct kiln_scene *scene, FILE *out);

/* Copies the text that kiln_scene_print writes into the caller's memory: as much as fits into
 * `room` bytes, with a zero at its end. `text` may be NULL when room is 0. Returns the length of
 * the whole text without that zero, which may be more than room. When memory is short, the text is
 * empty and the length 0. */
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
    uint64_t steps;             /* up to the last frame of the clip, warm-up included */
    uint64_t memory_bytes;      /* expected memory of rendering on the device cpu */
    char hash[65]; /* SHA-256 of the scene with every default and of its textures, in hex */
};
KILN_EMPTY(kiln_scene_info, kiln_scene_info_empty)
KILN_API void kiln_scene_get_info(const struct kiln_scene *scene, struct kiln_scene_info *info);

/* ---- Devices ------------------------------------------------------------------------------ */

/* A device to draw on. Only the thread that opened it may begin jobs on it; on other threads they
 * fail with KILN_USAGE. It may be closed when all jobs on it have ended. */
struct kiln_device;

/* The name of the device that is not a GL device: the threads and vector units of this machine,
 * which run the techniques called `cpu`. Every machine has this device, and all machines make the
 * same pixels with it. */
#define KILN_DEVICE_CPU "cpu"

struct kiln_device_info {
    size_t size;
    uint32_t index;
    bool gl;        /* false: KILN_DEVICE_CPU */
    bool usable;    /* has OpenGL 4.3 or later with all that kiln needs, or works without GL */
    bool software;  /* draws on the CPU */
    bool exact;     /* passed the exactness probe, so it may simulate */
    char name[128]; /* GL renderer */
    char vendor[128];
    char gl_version[128];
    char platform[32]; /* "device" or "surfaceless", or "host" without GL */
    char problem[256]; /* why the device is not usable and what mends that; "" when it is usable */
    char vectors[16];  /* without GL: the widest vector instructions, such as "avx2" */
    uint32_t threads;  /* without GL: worker threads that a job gets */
    int32_t max_work_group_invocations;
    int32_t max_shared_memory_bytes;
    int64_t max_storage_block_bytes;
    int32_t max_texture_size;
    int32_t max_array_layers;
};
KILN_EMPTY(kiln_device_info, kiln_device_info_empty)

/* How a device is chosen. `wanted` is one of these:
 *   NULL             the first GPU, or KILN_DEVICE_CPU if there is none
 *   "N"              the device with this index in the list of kiln_device_list
 *   KILN_DEVICE_CPU  that device; no GL library is loaded
 *   "software"       the first GL device that draws on the CPU
 *   other texts      the one device whose name is this text or, failing that, contains it */
struct kiln_device_params {
    size_t size;
    const char *wanted;
    bool gl;    /* with wanted NULL: only a GL device will do, if need be the software one; set it
                 * where kiln_techniques_need_gl returns true */
    bool debug; /* use a GL debug context: GL errors are logged and fail the job */
    struct kiln_log log;
};
KILN_EMPTY(kiln_device_params, kiln_device_defaults)

/* Returns whether the library's environment variables make sense: false with KILN_USAGE when
 * KILN_SIMD names vector instructions that the machine lacks. Calls that use vectors make the same
 * check, but later in a job. */
KILN_API bool kiln_environment_check(struct kiln_error *error);

/* Lists the devices, KILN_DEVICE_CPU first, into up to `capacity` entries. The entries lie `stride`
 * bytes apart, and the caller sets the size of each. Returns how many devices there are, which may
 * be more than capacity. `advice` (may be NULL) gets what this machine lacks and the package that
 * mends it, or "". */
KILN_API size_t kiln_device_list(struct kiln_device_info *infos, size_t stride, size_t capacity,
                                 char advice[256]);

/* Opens a device, which the caller closes on the same thread. Returns NULL with KILN_NO_DEVICE when
 * there is no such device or it is not usable, KILN_USAGE for an empty or ambiguous name, or
 * KILN_DEVICE_FAILED. */
KILN_API struct kiln_device *kiln_device_open(const struct kiln_device_params *params,
                                              struct kiln_error *error);
KILN_API void kiln_device_close(struct kiln_device **device);
/* Returns facts of the device, valid until it is closed. */
KILN_API const struct kiln_device_info *kiln_device_get_info(const struct kiln_device *device);

/* ---- Rendering ---------------------------------------------------------------------------- */

/* Frames first..last, both included. */
struct kiln_frame_range {
    uint32_t first, last;
};

/* The passes of a frame, in order. Timers, debug groups and columns of reports have these names. */
#define KILN_PASSES(X)                                                                             \
    X(simulate)                                                                                    \
    X(sort)                                                                                        \
    X(lighting)                                                                                    \
    X(backdrop)                                                                                    \
    X(gas)                                                                                         \
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

enum { KILN_MAX_PASSES = 16 }; /* the most passes of any later version */

KILN_API const char *kiln_pass_name(enum kiln_pass pass);

/* The 64-bit hash of the simulation's state after a step. It is equal on every device and with
 * every technique. */
struct kiln_state_hash {
    uint32_t lane[2];
};

/* The progress of a job after a frame was handed to the output. */
struct kiln_progress {
    size_t size;
    uint32_t frame;                  /* number of that frame in the clip */
    uint32_t done, total;            /* frames that this job has drawn, and will have drawn */
    double elapsed_s, eta_s;         /* since the start, and to the end; eta_s < 0: not known yet */
    uint64_t alive;                  /* living particles at the frame */
    struct kiln_state_hash state;    /* zero where the job hashes no states */
    double pass_ms[KILN_MAX_PASSES]; /* wall-clock time of each pass of the frame */
};
KILN_EMPTY(kiln_progress, kiln_progress_empty)

/* An atlas for game engines: one PNG whose cells are frames, in rows from the top, each row from
 * the left. Beside FILE.png, its layout is written as FILE.json and, with `motion`, the motion
 * vectors from each cell to the next as FILE_motion.png, red to the right and green up. */
struct kiln_flipbook {
    size_t size;
    bool motion;
    bool premultiplied;     /* premultiplied alpha; else straight alpha, where transparent pixels
                               get colours of their neighbours */
    uint32_t columns, rows; /* 1 to 64 */
    uint32_t padding;       /* pixels added on each side of a cell, 0 to 256 */
    uint32_t fade;          /* how far from its border a cell with alpha fades out, in percent of
                               the frame's shorter side, 0 to 50; the pixels at the border become
                               transparent. 0: no fade, which may show the border as a cut */
    uint32_t green_down;    /* 1: green of the motion points down, as in engines whose v does */
};
KILN_EMPTY(kiln_flipbook, kiln_flipbook_empty)

/* Chooses the frames of a flipbook's n = columns * rows cells evenly out of ascending ranges: cell
 * k (from 0) shows the frame at k/n of all their frames. `cells` has room for n ranges, and each
 * gets one frame. KILN_USAGE when the ranges have fewer than n frames. */
KILN_API bool kiln_flipbook_sample(const struct kiln_flipbook *flipbook,
                                   const struct kiln_frame_range *ranges, size_t range_count,
                                   struct kiln_frame_range *cells, struct kiln_error *error);

/* Formats of a stream, into which frames are written one after another. Rows go from the top. */
enum kiln_stream_format {
    KILN_STREAM_NONE,
    KILN_STREAM_Y4M,    /* YUV4MPEG2, 4:2:0, BT.709 in limited range, as in an MP4 */
    KILN_STREAM_RGB24,  /* bytes, sRGB */
    KILN_STREAM_RGBA,   /* bytes, sRGB, straight alpha */
    KILN_STREAM_RGBAF32 /* 32-bit floats, little-endian, linear, premultiplied, as in an EXR */
};
/* A stream into an open file descriptor. When it is a pipe whose reader goes away, rendering ends
 * with KILN_READER_GONE if the caller ignores SIGPIPE. */
struct kiln_stream {
    enum kiln_stream_format format;
    int descriptor; /* the caller's; the library does not close it */
};

/* The samples of a layer. */
enum kiln_sample_type {
    KILN_SAMPLES_UINT8,
    KILN_SAMPLES_UINT16, /* in the machine's byte order; where png_bits is 16 */
    KILN_SAMPLES_FLOAT
};
/* A layer of a drawn frame. "display" has the samples of a PNG: sRGB, RGBA, straight alpha. The
 * others have those of a layer of an EXR, linear premultiplied floats: "beauty", "depth", "fire",
 * "smoke", "bloom", and of scenes with gas "gas.density", "gas.emission", "gas.depth": its opacity,
 * the light of its flames, and the depth at which it is half opaque. Rows go from the top. The
 * memory is valid during the callback that gets the layer, or as long as the kiln_frame that it was
 * taken from. */
struct kiln_frame_layer {
    size_t size;
    const char *layer;                /* its name */
    uint32_t frame;                   /* number of the frame in the clip */
    uint32_t width, height, channels; /* channels: 4; depths and "gas.density" have 1 */
    enum kiln_sample_type samples;
    size_t row_bytes; /* from one row to the next */
    const void *pixels;
};
KILN_EMPTY(kiln_frame_layer, kiln_frame_layer_empty)

/* Kinds of files of a job: an image; a part of a clip that waits to be joined (with `resume` or
 * `shards`); the clip, or a file that lies beside it. */
enum kiln_written_kind { KILN_WRITTEN_FRAME, KILN_WRITTEN_PART, KILN_WRITTEN_CLIP };
/* A file of a job that is whole and has its final name. */
struct kiln_written {
    size_t size;
    const char *file; /* lasts for the call */
    enum kiln_written_kind kind;
    struct kiln_frame_range frames; /* its first and last frame; some in between may be missing */
    uint64_t bytes;
    char sha256[65]; /* of the file, in hex */
    /* The members below are set for KILN_WRITTEN_FRAME only. */
    uint32_t done, total; /* files of frames that are whole, and that this run writes in all */
    struct kiln_state_hash state;
    uint64_t alive;                  /* living particles at the frame */
    double pass_ms[KILN_MAX_PASSES]; /* time of the passes before the output */
};

/* How PNG files are compressed. The pixels are the same. */
enum kiln_png_effort {
    KILN_PNG_FAST,
    /* Files are about a tenth smaller, and take some hundred times as long to compress. While a
     * picture is compressed, nobody is asked whether to go on. */
    KILN_PNG_SMALL
};

struct kiln_render_params {
    size_t size;
    const char *output; /* a file, a pattern with %d or #, or NULL to render without writing */
    struct kiln_stream stream;  /* a stream to write to in place of an output */
    const char *manifest;       /* a JSON file that describes the run, or NULL */
    const char *const *command; /* words of a command line, for the manifest */
    size_t command_count;
    const char *build;  /* the program's version and commit, for the manifest, "0.2.0 (254e4dc)";
                           NULL: kiln_version() */
    const char *states; /* a folder of kiln_bake; the run starts from the latest state there that
                           serves it; NULL: from step 0 */
    const struct kiln_frame_range *ranges; /* ascending; range_count 0 renders every frame */
    size_t range_count;
    const char *const *techniques; /* "stage=name" */
    size_t technique_count;
    uint32_t threads;         /* worker threads; 0 takes one a core */
    uint32_t work_group_size; /* invocations of kernels that allow any number; 0: the best for each
                                 kernel. It changes no pixel */
    bool overwrite;           /* replace files that are there */
    /* Go on with a job that was killed. Files that its journal names, and PNG, JPEG and EXR files
     * that carry the scene's hash, are checked and stay; the other frames are drawn. The journal
     * lies beside the output, and so do the parts of a clip until it is whole. With `overwrite`,
     * the job begins anew. */
    bool resume;
    /* Draw only one shard of the clip's parts, and resume it. kiln_join makes the clip of the parts
     * of all shards. shard is 0 to shards - 1; shards 0: draw all parts. */
    uint32_t shard, shards;
    bool state_hash;  /* compute the hash for each drawn frame; a manifest always has it */
    bool keep_frames; /* for kiln_rendering_take_frame: frames have `layers`, even if `picture` is
                         NULL */
    enum kiln_png_effort png_effort; /* of PNG files */
    uint32_t png_bits;               /* bits of a sample of PNG, APNG and MKV, 8 or 16 */
    uint32_t exr_bits;               /* bits of a sample of EXR, 16 or 32 */
    uint32_t quality; /* of video and JPEG, 0 (smallest) to 100 (visually lossless) */
    /* Makes the output a flipbook with one cell for each frame; `ranges` are the cells that
     * kiln_flipbook_sample chose. NULL: no flipbook. */
    const struct kiln_flipbook *flipbook;
    /* `picture` gets the layers of each frame that are named here, in this order ("display" when
     * none is named), whether or not an output is written. KILN_USAGE for an unknown name, and for
     * a layer of gas in a scene without gas. */
    const char *const *layers;
    size_t layer_count;
    void (*picture)(void *user, const struct kiln_frame_layer *layer);
    /* Called for each frame: `next` before it is stepped to and drawn, `drawn` after that, and
     * `progress` after it was handed to the output, which may wait for a reader of a stream. */
    void (*next)(void *user, uint32_t frame);
    void (*drawn)(void *user, uint32_t frame);
    void (*progress)(void *user, const struct kiln_progress *progress);
    /* Called between frames, steps, passes and bands of rows, and while a clip is finished; when it
     * returns true, the job ends with KILN_INTERRUPTED. */
    bool (*stop)(void *user);
    void *user;
    const struct kiln_cancel *cancel; /* NULL: nobody cancels */
    struct kiln_log log;
    /* Called for each file as soon as it is whole, on any thread, but never on two at a time. With
     * this callback, each file is read once more for its hash. */
    void (*written)(void *user, const struct kiln_written *file);
};

static inline struct kiln_render_params kiln_render_defaults(void)
{
    struct kiln_render_params params;
    memset(&params, 0, sizeof params);
    params.size = sizeof params;
    params.png_bits = 8;
    params.exr_bits = 16;
    params.quality = 80;
    return params;
}

/* The technique that ran a stage. */
struct kiln_technique_choice {
    const char *stage, *name; /* "sort", "cpu" */
    const char *why;          /* reason of the automatic choice; NULL: the caller asked for it */
};
enum { KILN_MAX_STAGES = 8 };

/* Numbers of a finished job, for reports. */
struct kiln_render_stats {
    size_t size;
    uint32_t frames;               /* drawn */
    uint32_t kept;                 /* frames that were there already, with `resume` */
    uint32_t first_part, end_part; /* a shard has the parts first_part to end_part - 1 */
    uint64_t steps;                /* that this run simulated */
    double setup_s;                /* time of making programs, textures and buffers */
    double total_s;
    double pass_ms[KILN_MAX_PASSES]; /* sums over the job */
    uint64_t alive;                  /* living particles after the last step; of the frame at 0 s
                                        alone, those that it shows */
    struct kiln_state_hash state;    /* after the last step */
    uint64_t particle_bytes;         /* records and sort buffers, on each side, host or device, that
                                        holds them */
    uint64_t particle_capacity;      /* slots over all systems */
    char techniques[256];            /* "simulate=cpu sort=cpu ..." */
    uint32_t choice_count;           /* one choice a stage */
    struct kiln_technique_choice choices[KILN_MAX_STAGES];
    uint32_t files;                  /* files of the output; 0 without an output file */
    char first_file[KILN_PATH_SIZE]; /* path of the first file, or of the stream */
};
KILN_EMPTY(kiln_render_stats, kiln_render_stats_empty)

/* Renders a job. Its callbacks may use other devices, or render on this one. Files appear under
 * their names only when they are whole; after an error or a stop, finished files stay and nothing
 * half-written is left. `stats` may be NULL. KILN_USAGE for a device or scene that is NULL. */
KILN_API bool kiln_render(struct kiln_device *device, const struct kiln_scene *scene,
                          const struct kiln_render_params *params, struct kiln_render_stats *stats,
                          struct kiln_error *error);

/* A job that is rendered frame by frame, for a program with a loop of its own. It belongs to the
 * thread that began it. On another thread, the calls below do nothing but fail with KILN_USAGE. */
struct kiln_rendering;

/* Begins a job, which the caller ends. The device, the scene and everything that `params` point to
 * must last until then. Returns NULL with an error of kiln_render. */
KILN_API struct kiln_rendering *kiln_rendering_begin(struct kiln_device *device,
                                                     const struct kiln_scene *scene,
                                                     const struct kiln_render_params *params,
                                                     struct kiln_error *error);

/* Draws the next frame and hands it to `picture` and the output. *drawn is false when no frame was
 * left. `progress` may be NULL. */
KILN_API bool kiln_rendering_next(struct kiln_rendering *rendering, bool *drawn,
                                  struct kiln_progress *progress, struct kiln_error *error);

/* Waits until the outputs are whole and destroys the job. A job that still has frames to draw is
 * given up with KILN_INTERRUPTED. After any error, too, the job is destroyed, but not on another
 * thread. */
KILN_API bool kiln_rendering_end(struct kiln_rendering **rendering, struct kiln_render_stats *stats,
                                 struct kiln_error *error);

/* A drawn frame that a program keeps. Its memory is the one that the frame was drawn into. An
 * output may be reading that memory at the same time, so nobody may write to it. A frame may
 * outlive its job, scene and device, and may be used and destroyed on any thread. */
struct kiln_frame;

/* Returns the frame that kiln_rendering_next drew last, for a job with `keep_frames`; the caller
 * destroys it. A frame can be taken once, and only until the next one is drawn: otherwise returns
 * NULL with KILN_USAGE. */
KILN_API struct kiln_frame *kiln_rendering_take_frame(struct kiln_rendering *rendering,
                                                      struct kiln_error *error);
KILN_API void kiln_frame_destroy(struct kiln_frame **frame);

/* Fills *layer, whose size the caller sets, with the layer of this name. KILN_USAGE when the frame
 * does not have it. */
KILN_API bool kiln_frame_get_layer(const struct kiln_frame *frame, const char *name,
                                   struct kiln_frame_layer *layer, struct kiln_error *error);

/* Writes a layer, of a frame or with the program's own samples, as a picture. Integers of 4
 * channels become a PNG, without alpha if all pixels are opaque. Floats of 4 channels or 1 become
 * an EXR of 32-bit floats with the layer's name (NULL: "beauty" or "depth"). KILN_USAGE for any
 * other layer, for a suffix that does not fit, and for a file that exists and may not be
 * overwritten; KILN_IO; KILN_DEVICE_FAILED. The file is written whole or not at all. */
KILN_API bool kiln_layer_write(const struct kiln_frame_layer *layer, const char *path,
                               bool overwrite, struct kiln_error *error);

/* Removes the temporary files of every running job. It makes async-signal-safe calls only, for a
 * signal handler or a watchdog that ends the process next with _exit. */
KILN_API void kiln_abandon_outputs(void);

/* Returns whether a job with these techniques ("stage=name"), and those of KILN_DEVICE_CPU for all
 * other stages, needs GL. Texts that name no technique are ignored. */
KILN_API bool kiln_techniques_need_gl(const char *const *techniques, size_t count);

#ifdef __cplusplus
}
#endif

#include "kiln_compare.h"
#include "kiln_job.h"
#include "kiln_limits.h"
#include "kiln_params.h"
#include "kiln_sandbox.h"

#endif
