/* kiln: a headless batch renderer for particle effects. The one header that a program includes.
 *
 * A program loads a scene, opens a device and renders a job:
 *
 *     struct kiln_error error = {0};
 *     struct kiln_scene *scene = kiln_scene_load("fire.yaml", &KILN_SCENE_DEFAULTS, &error);
 *     struct kiln_device *device = kiln_device_open(&KILN_DEVICE_DEFAULTS, &error);
 *     struct kiln_render_params params = KILN_RENDER_DEFAULTS;
 *     params.output = "fire.mp4";
 *     bool ok = scene && device && kiln_render(device, scene, &params, NULL, &error);
 *     kiln_device_close(&device);
 *     kiln_scene_destroy(&scene);
 *
 * Errors: a function that can fail returns false or NULL and fills the error, which is not NULL.
 * Nothing in the library prints or exits; messages go to the log callback. Threads: a device and
 * what was made with it belong to the thread that opened it. Scenes are immutable once loaded and
 * may be shared. Nothing is global.
 */
#ifndef KILN_H
#define KILN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "kiln_limits.h"

#ifdef __cplusplus
extern "C" {
#endif

#define KILN_VERSION "0.1.0"

/* What went wrong. The values are the program's exit codes. */
enum kiln_code {
    KILN_OK = 0,
    KILN_FRAME_FAILED = 1,   /* a frame failed, or a picture differs */
    KILN_USAGE = 2,          /* the request itself makes no sense */
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
    enum kiln_code code;
    char message[KILN_MESSAGE_SIZE];
};

enum kiln_log_level { KILN_LOG_DEBUG, KILN_LOG_INFO, KILN_LOG_WARNING };

/* The files that a call reads and those that it writes, each known by where its path leads. Whoever
 * declares all before the work begins writes nothing that is read, and nothing twice. */
struct kiln_claims;
struct kiln_claims *kiln_claims_create(void); /* NULL when memory is short */
void kiln_claims_destroy(struct kiln_claims **claims);

/* Declares a file that the call reads, or writes; `what` stands for it in messages: "a texture",
 * "--manifest". KILN_USAGE when the call writes it already, or reads what is to be written,
 * KILN_DEVICE_FAILED when memory is short. A path that leads nowhere is read by nobody. */
bool kiln_claims_read(struct kiln_claims *claims, const char *path, const char *what,
                      struct kiln_error *error);
bool kiln_claims_write(struct kiln_claims *claims, const char *path, const char *what,
                       struct kiln_error *error);

/* Receives one line without its newline. May be called from worker threads. */
struct kiln_log {
    void (*write)(void *user, enum kiln_log_level level, const char *line);
    void *user;
};

/* ---- Scenes ------------------------------------------------------------------------------- */

struct kiln_scene;

/* How a scene file is read. overrides are "dotted.key=value" texts, applied in order after the
 * file; a '*' names every entry of a map or list. asset_root NULL is the scene file's folder. */
struct kiln_scene_params {
    const char *asset_root;
    const char *const *overrides;
    size_t override_count;
    /* Asked while a mesh is imported, now or when it is drawn, which may take seconds, for as long
     * as the scene lives; true ends with KILN_INTERRUPTED; NULL: never. */
    bool (*stop)(void *user);
    void *user;
    struct kiln_budget *budget; /* of the job, for as long as the scene lives; NULL: no limits */
};
#define KILN_SCENE_DEFAULTS ((struct kiln_scene_params){.asset_root = NULL})

/* Reads, validates and returns a scene, which the caller destroys; or NULL with KILN_INVALID_INPUT,
 * also when there is no such file, KILN_USAGE for an override that is no "key=value", KILN_IO when
 * reading fails, KILN_OVER_LIMIT, or KILN_DEVICE_FAILED when memory is short. */
struct kiln_scene *kiln_scene_load(const char *path, const struct kiln_scene_params *params,
                                   struct kiln_error *error);

/* The same for a text in memory; name stands for the file in messages, and relative asset paths
 * start at params->asset_root or, without one, at the working directory. */
struct kiln_scene *kiln_scene_parse(const char *text, size_t size, const char *name,
                                    const struct kiln_scene_params *params,
                                    struct kiln_error *error);
void kiln_scene_destroy(struct kiln_scene **scene);

/* Writes the scene with every default spelled out, as a scene file that loads to the same scene. */
bool kiln_scene_print(const struct kiln_scene *scene, FILE *out);

/* The reference of every scene key, for people, and the JSON schema, for editors. */
bool kiln_scene_write_reference(FILE *out);
bool kiln_scene_write_schema(FILE *out);

/* A key of a file, in words for people. */
struct kiln_option_key {
    const char *path;     /* "systems.NAME.emit.rate"; N stands for an entry of a list */
    const char *help;     /* what it is for */
    const char *variant;  /* the word of `field` that it belongs to, or NULL */
    const char *shortcut; /* the key inside that a bare value means, or NULL */
    const char *allowed;  /* of its value; NULL when it only holds other keys */
    const char *varies;   /* "over time", or NULL */
    const char *fallback; /* the default; NULL with `allowed`: must be given */
    const char *words;    /* that its value may be, "true|false", perhaps beside others; or NULL */
    bool holds_keys;
};

/* Visits all keys in the order of the reference; texts last for a visit. False: memory is short. */
bool kiln_scene_visit_keys(void (*visit)(void *user, const struct kiln_option_key *key),
                           void *user);

/* What the reference says before the keys. */
const char *kiln_scene_introduction(void);

/* Facts of a scene that a caller plans with. */
struct kiln_scene_info {
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
struct kiln_scene_info kiln_scene_info(const struct kiln_scene *scene);

/* Visits the names of the systems in a scene file, whatever else may be wrong with it. False when
 * it cannot be read as YAML, with the error of kiln_scene_load. */
bool kiln_scene_visit_systems(const char *path, void (*visit)(void *user, const char *name),
                              void *user, struct kiln_error *error);

/* ---- Devices ------------------------------------------------------------------------------ */

struct kiln_device;

/* The name of the device that is no GL device: threads and vectors of this machine, for techniques
 * called `cpu`. Every machine has it, and all make the same pixels with it. */
#define KILN_DEVICE_CPU "cpu"

struct kiln_device_info {
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

/* wanted: NULL takes the first GPU, or else KILN_DEVICE_CPU; "N" an index from the list,
 * KILN_DEVICE_CPU that one, for which nothing of GL is loaded; "software" the first GL device that
 * draws on the CPU, anything else a part of a device's name. */
struct kiln_device_params {
    const char *wanted;
    bool gl;    /* with wanted NULL: a GL device, if need be the software one; for techniques that
                 * kiln_techniques_need_gl says it of */
    bool debug; /* a GL debug context: errors are logged and fail the job */
    struct kiln_log log;
};
#define KILN_DEVICE_DEFAULTS ((struct kiln_device_params){.wanted = NULL})

/* Whether the variables of the environment that the library reads make sense: KILN_USAGE, for a
 * KILN_SIMD of vectors that the machine lacks. What needs them fails so, too, but later. */
bool kiln_environment_check(struct kiln_error *error);

/* Fills up to capacity entries, KILN_DEVICE_CPU first, and returns how many devices there are;
 * *advice (may be NULL) gets what this machine lacks and the package that mends it, or "". */
size_t kiln_device_list(struct kiln_device_info *infos, size_t capacity, char advice[256]);

struct kiln_device *kiln_device_open(const struct kiln_device_params *params,
                                     struct kiln_error *error);
void kiln_device_close(struct kiln_device **device);
const struct kiln_device_info *kiln_device_info(const struct kiln_device *device);

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

const char *kiln_pass_name(enum kiln_pass pass);

/* The 64-bit state hash after a step; equal on every device and with every technique. */
struct kiln_state_hash {
    uint32_t lane[2];
};

/* Told after each frame is handed to the output. */
struct kiln_progress {
    uint32_t frame;          /* its number */
    uint32_t done, total;    /* drawn frames of this job */
    double elapsed_s, eta_s; /* eta_s < 0: not known yet */
    uint64_t alive;          /* living particles at the frame */
    struct kiln_state_hash state;
    double pass_ms[KILN_PASS_COUNT];
};

/* An atlas for game engines: frames as cells of one PNG, in rows from the top, each from the left.
 * Beside FILE.png comes FILE.json, its layout, and with `motion` FILE_motion.png: where each pixel
 * of a cell goes in the next one. */
struct kiln_flipbook {
    uint32_t columns, rows; /* 1 to 64; 0 and 0: no flipbook */
    uint32_t padding;       /* pixels added on each side of a cell, 0 to 256 */
    bool premultiplied;     /* colours times alpha, as seen over black; else straight, with colours
                               where alpha is zero as well */
    bool motion;
};

/* Chooses the frames of the cells, columns * rows, evenly out of ascending ranges: the k-th cell of
 * n shows the frame at k/n of them. KILN_USAGE when the ranges have fewer frames. */
bool kiln_flipbook_sample(const struct kiln_flipbook *flipbook,
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

struct kiln_render_params {
    const char *output; /* a file, a pattern with %d or #, or NULL to render without writing */
    struct kiln_stream stream;  /* in place of an output */
    const char *manifest;       /* a JSON file that describes the run, or NULL */
    const char *const *command; /* words of a command line, for the manifest */
    size_t command_count;
    const char *states; /* a folder of kiln_bake, where the run starts if it can, or NULL */
    const struct kiln_frame_range *ranges; /* ascending; range_count 0 renders every frame */
    size_t range_count;
    const char *const *techniques; /* "stage=name" */
    size_t technique_count;
    uint32_t threads; /* worker threads; 0 takes one a core */
    uint32_t
        work_group_size; /* of kernels that leave it open; 0: what suits each. No pixel changes */
    bool overwrite;
    /* Go on with a job that was killed: files that its journal names, or PNG and EXR files that
     * carry the scene's hash, are looked at and stay, the rest is drawn. The journal lies beside
     * the output, and a clip waits there in parts until it is whole. With overwrite, all begins
     * anew. */
    bool resume;
    /* Draw only the parts of one of several shards, which goes on with what is there of them. A
     * clip waits for kiln_join. shards 0: all parts. */
    uint32_t shard, shards; /* from 0; of so many */
    bool state_hash;        /* compute it for each drawn frame; the manifest always has it */
    uint32_t png_bits;      /* 8 or 16; of APNG and MKV, too */
    uint32_t exr_bits;      /* 16 or 32 */
    uint32_t quality;       /* video: 0 (smallest) to 100 (visually lossless) */
    /* One cell for each frame: ranges come from kiln_flipbook_sample. */
    struct kiln_flipbook flipbook;
    /* Told of each frame where output is NULL: 8-bit sRGB, RGBA, alpha not premultiplied, rows from
     * the top; until the call returns. */
    void (*picture)(void *user, uint32_t frame, const uint8_t *pixels);
    /* Told of each frame before it is stepped to and drawn, after that, and after it was handed to
     * the output, which may wait for who reads it. */
    void (*next)(void *user, uint32_t frame);
    void (*drawn)(void *user, uint32_t frame);
    void (*progress)(void *user, const struct kiln_progress *progress);
    /* Asked between frames, steps, passes and bands of rows, and while a clip ends; true ends with
     * KILN_INTERRUPTED. */
    bool (*stop)(void *user);
    void *user;
    struct kiln_log log;
};
#define KILN_RENDER_DEFAULTS                                                                       \
    ((struct kiln_render_params){.png_bits = 8, .exr_bits = 16, .quality = 80})

/* Which technique ran a stage, and why. */
struct kiln_technique_choice {
    const char *stage, *name; /* "sort", "cpu" */
    const char *why;          /* the automatic choice fell on it; NULL: it was asked for */
};
enum { KILN_MAX_STAGES = 8 };

/* What a job did, for reports. */
struct kiln_render_stats {
    uint32_t frames;               /* drawn */
    uint32_t kept;                 /* that were there already, with kiln_render_params.resume */
    uint32_t first_part, end_part; /* of a shard: those of parts first_part to end_part - 1 */
    uint64_t steps;
    double setup_s; /* programs, textures, buffers */
    double total_s;
    double pass_ms[KILN_PASS_COUNT]; /* sums over the job */
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

/* Declares what the job reads (the scene and its files) and writes. KILN_USAGE when a file would be
 * written that is read, or twice; also when the output is no format, or the ranges make no sense
 * for it. kiln_render does that itself, for its one job. */
bool kiln_render_claim(const struct kiln_scene *scene, const struct kiln_render_params *params,
                       struct kiln_claims *claims, struct kiln_error *error);

/* Renders the job; its callbacks may use other devices, or render on this one. Files appear under
 * their names only when whole; after an error or a stop, what was finished stays and nothing
 * half-written is left. stats may be NULL. */
bool kiln_render(struct kiln_device *device, const struct kiln_scene *scene,
                 const struct kiln_render_params *params, struct kiln_render_stats *stats,
                 struct kiln_error *error);

/* Removes the temporary files of every running job, with async-signal-safe calls only: for a signal
 * handler or a watchdog that ends the process next, with _exit. */
void kiln_abandon_outputs(void);

/* The techniques of each stage and what each is for, for people. */
bool kiln_write_techniques(FILE *out);

/* Whether any stage will need GL when a job is asked for these, "stage=name", and else takes those
 * of KILN_DEVICE_CPU. What is no technique needs none. */
bool kiln_techniques_need_gl(const char *const *techniques, size_t count);

/* Visits each as "stage=name". */
void kiln_visit_techniques(void (*visit)(void *user, const char *name, const char *help),
                           void *user);

/* The outputs that this build can write, and their options, for people. */
bool kiln_write_outputs(FILE *out);

/* ---- Comparing pictures --------------------------------------------------------------------- */

/* How light is judged by FLIP: clamped to white, or at several exposures. Automatic: by exposures
 * when both pictures are of floats (EXR); a pair of which only one is must be told. */
enum kiln_compare_mode { KILN_COMPARE_AUTO, KILN_COMPARE_LDR, KILN_COMPARE_HDR };

enum { KILN_MAX_COLUMNS = 32, KILN_METRIC_NAME_SIZE = 24 };

struct kiln_compare_column {
    char name[KILN_METRIC_NAME_SIZE]; /* "flip.mean" */
    const char *unit;                 /* "" without one */
    bool higher_is_better;
    bool limited;
    double limit; /* the worst value that passes */
};

enum kiln_compare_verdict {
    KILN_COMPARE_SAME,       /* within all limits */
    KILN_COMPARE_DIFFERENT,  /* beyond a limit, or of another size or other channels */
    KILN_COMPARE_MISSING,    /* in the reference only */
    KILN_COMPARE_EXTRA,      /* in the test only */
    KILN_COMPARE_UNREADABLE, /* a file is empty, broken, cut short or has values like NaN */
    KILN_COMPARE_VERDICT_COUNT
};

const char *kiln_compare_verdict_name(enum kiln_compare_verdict verdict);

/* One frame of a comparison. Only what was measured has values: not a frame that is missing, extra
 * or unreadable, or one whose sizes or channels differ. */
struct kiln_compare_frame {
    const char *name; /* of the file, or the frame's number; until the call returns */
    enum kiln_compare_verdict verdict;
    const char *message; /* why it has no values; "" when it has them. Until the call returns */
    bool measured;
    bool equal; /* not one value differs */
    uint32_t width, height;
    double
        values[KILN_MAX_COLUMNS]; /* by the result's columns; psnr of equal pictures is infinite */
    bool beyond[KILN_MAX_COLUMNS];
    double score;                /* the worst value by its limit: 1 is just within */
    uint32_t worst_x, worst_y;   /* a pixel of the largest difference */
    uint32_t window_x, window_y; /* the densest window's upper left corner */
    uint32_t window_width, window_height, window_differing;
    double flip_s; /* the time that FLIP took */
};

struct kiln_compare_result {
    bool same;     /* every frame is */
    bool sequence; /* not one picture against one */
    bool hdr;
    size_t column_count;
    struct kiln_compare_column columns[KILN_MAX_COLUMNS];
    uint32_t frames; /* all of them */
    uint32_t counts[KILN_COMPARE_VERDICT_COUNT];
    uint32_t measured;
    double worst[KILN_MAX_COLUMNS]; /* over the measured frames */
    double mean[KILN_MAX_COLUMNS];
    char worst_names[KILN_MAX_COLUMNS][256]; /* where it is worst; cut off where too long */
    char worst_frame[256];  /* of the highest score; frames without values come first; "": none */
    double flip_s, total_s; /* wall-clock time */
};

/* A rectangle, or a picture of the same size that is black where nothing is judged. */
struct kiln_compare_mask {
    uint32_t x, y, width, height; /* pixels; beyond the picture's edge is no error */
    const char *picture;          /* NULL: the rectangle */
};

struct kiln_compare_params {
    /* Each a picture, a video, a folder of pictures (paired by name) or a numbered pattern such as
     * frame_%04d.png or frame_####.png (paired by number; those of a video count from 0). */
    const char *reference, *test;
    const char *const *limits; /* "metric=value", or several with commas between them */
    size_t limit_count;        /* 0 takes KILN_COMPARE_DEFAULT_LIMITS */
    const char *layer;         /* of EXR files: "beauty", or another one by its name */
    enum kiln_compare_mode mode;
    double pixels_per_degree; /* of the viewer's eye, 4 to 400 */
    double threshold;         /* levels, 0 to 255: pixels that differ by more are counted */
    uint32_t window;          /* pixels; its densest place is looked for in squares of this edge */
    uint32_t threads;         /* 0 takes one a core */
    /* A PNG of reference, test and error map for each measured frame, or NULL. For sequences, a
     * pattern, or a folder (that exists, or with a slash at its end) */
    const char *diff;
    const char *error_map; /* the error map alone, as a PNG of the pictures' size; as diff */
    /* What is not judged: in the test picture it is taken from the reference. */
    const struct kiln_compare_mask *masks;
    size_t mask_count;
    bool overwrite;
    /* Told after each frame, with the columns and what is known so far. */
    void (*frame)(void *user, const struct kiln_compare_result *result,
                  const struct kiln_compare_frame *frame);
    bool (*stop)(void *user); /* asked between frames; true ends with KILN_INTERRUPTED */
    void *user;
};
#define KILN_COMPARE_DEFAULT_LIMITS "flip.mean=0.01,flip.p99=0.1,window.share=0.1"
#define KILN_COMPARE_DEFAULTS                                                                      \
    ((struct kiln_compare_params){                                                                 \
        .layer = "beauty", .pixels_per_degree = 67.0206, .threshold = 2, .window = 32})

/* Compares pictures and judges them by limits. True when the comparison took place, and the result
 * says what came out. False with KILN_USAGE when the request makes no sense, KILN_INVALID_INPUT
 * when something cannot be read (the other frames are compared all the same), KILN_IO when the
 * pictures of differences cannot be written, KILN_DEVICE_FAILED when memory is short. */
bool kiln_compare(const struct kiln_compare_params *params, struct kiln_compare_result *result,
                  struct kiln_error *error);

/* The metrics and what each is for, for people. */
bool kiln_write_metrics(FILE *out);

/* Visits those with names of their own. */
void kiln_visit_metrics(void (*visit)(void *user, const char *name, const char *help), void *user);

/* ---- Text: as kiln reads and writes it, for programs that take the same --------------------- */

/* A whole text as a decimal number, its point '.' in any locale; false when it is no finite one. */
bool kiln_text_to_double(const char *text, double *value);
bool kiln_text_to_uint64(const char *text, uint64_t *value);

/* The candidate nearest to name by edit distance (swapped neighbours count once), or NULL when
 * none is near enough to be a misspelling. */
const char *kiln_text_nearest(const char *name, const char *const *candidates, size_t count);

/* Writes a word so that a shell takes it as one. */
bool kiln_write_shell_word(FILE *out, const char *word);

/* Copies a text out of a file so that a terminal, a log or a page shows it and does nothing else:
 * controls, overrides of direction and bytes that are no UTF-8 stand as \n, \x1b or \u202e. A text
 * that was shown before stays as it is. What does not fit is left out, characters being whole. out
 * may not be text. Messages of errors and the log are shown already. */
void kiln_shown(char *out, size_t room, const char *text);

#ifdef __cplusplus
}
#endif

#include "kiln_bench.h"
#include "kiln_figure.h"
#include "kiln_job.h"
#include "kiln_json.h"
#include "kiln_sandbox.h"
#include "kiln_test.h"

#endif
