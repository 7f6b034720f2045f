/* Takes frames to their files: PNG, JPEG, EXR, video. There is one interface, and one row a format
 * (formats.c). */
#ifndef KILN_OUTPUT_OUTPUT_H
#define KILN_OUTPUT_OUTPUT_H

#include <stdatomic.h>

#include "base/caller.h"
#include "kiln_program.h"

enum { KILN_MAX_LAYERS = 8 };

/* A named float layer of a frame, linear, premultiplied; rows from the top. */
struct kiln_layer {
    const char *name;  /* "beauty", "depth", "fire"... static text */
    uint32_t channels; /* 1 (Z) or 4 (RGBA) */
    float *pixels;
};

/* One finished frame on the host. Nobody writes to one that others hold, too. */
struct kiln_picture {
    atomic_uint others; /* who hold it beside the first one: kiln_picture_share */
    uint32_t frame;
    uint32_t width, height;
    bool has_alpha; /* display alpha is meaningful */
    bool is_data;   /* the display pixels are no colours: files name no colour space for them */
    uint32_t bits;  /* of the display pixels: 8 or 16 */
    void *display;  /* sRGB, RGBA, not premultiplied, rows from the top, host byte order */
    struct kiln_layer layers[KILN_MAX_LAYERS]; /* only what the format asked for */
    uint32_t layer_count;
};

/* Allocates a picture whose display pixels (bits 0: none) and layers (names[i], channels[i]) are
 * ready to be filled; NULL with KILN_DEVICE_FAILED when memory is short. */
struct kiln_picture *kiln_picture_create(uint32_t width, uint32_t height, uint32_t bits,
                                         const char *const *names, const uint32_t *channels,
                                         uint32_t layer_count, struct kiln_error *error);

/* Another holder of the same picture, on any thread; each destroys its own. */
struct kiln_picture *kiln_picture_share(struct kiln_picture *picture);
void kiln_picture_destroy(struct kiln_picture **picture);

/* The float layers: none, the picture alone, or those of its parts, too, which are drawn apart. */
enum kiln_layers { KILN_LAYERS_NONE, KILN_LAYERS_BEAUTY, KILN_LAYERS_ALL };

/* What a format wants to be given for each frame. */
struct kiln_output_needs {
    uint32_t bits; /* display bits: 0 none, 8, 16 */
    enum kiln_layers layers;
};

/* A file that has its name. */
struct kiln_whole {
    const char *path;
    struct kiln_frame_range frames; /* that it holds, alone or with others in between */
    bool is_part, is_clip;          /* a part of the one file, or that; else of a frame */
    uint64_t bytes;
    char sha256[65];
};

/* Fills size and hash from the file of the path; KILN_IO. */
bool kiln_whole_measure(struct kiln_whole *whole, struct kiln_error *error);

/* Told of each file as soon as it is whole, on any thread, one call at a time. false: why not to go
 * on. NULL: nobody, and no file is read again for its hash. */
struct kiln_whole_listener {
    bool (*tell)(void *user, const struct kiln_whole *whole, struct kiln_error *error);
    void *user;
};

struct kiln_format;

struct kiln_output_params {
    const char *path;                 /* as the user gave it; of a stream, how messages call it */
    struct kiln_stream stream;        /* in place of files, unless its format is none */
    const struct kiln_format *format; /* of the path; kiln_output_complete finds it */
    uint32_t width, height;
    uint32_t fps_num, fps_den;
    bool alpha;
    const struct kiln_frame_range *ranges; /* what will be written, ascending, disjoint */
    size_t range_count;
    /* The frames of the whole output, of which `ranges` are some: their places and the names of
     * files follow from it. Count 0: there are no others. */
    const struct kiln_frame_range *clip;
    size_t clip_count;
    /* Of one file for all frames: the folder where its parts wait, each in a file, until they are
     * joined by kiln_parts_join. Ranges consist of whole parts then. NULL: no parts wait. */
    const char *parts;
    bool parts_alone; /* another process joins them: what a container needs is not opened here */
    uint32_t threads; /* encoders; at least 1 */
    bool overwrite;
    uint32_t png_bits, exr_bits, quality;
    struct kiln_flipbook flipbook; /* columns 0: none */
    const char *scene_hash; /* 64 hex digits; goes into each file with seed, frame and version.
                               "" for a clip, NULL for an encoder alone: of no scene */
    uint32_t seed;
    struct kiln_log log;
    struct kiln_whole_listener whole;
    struct kiln_budget *budget; /* NULL: no limits */
    bool durable;               /* files are on the disk before they have their names */
    struct kiln_caller
        caller; /* asked while parts are joined and the clip ends, by whoever calls */
};

struct kiln_output;

/* The parameters with what follows from them: format and clip; those that the format does not heed
 * get their defaults, so that jobs which differ in nothing else are the same. format NULL with
 * KILN_USAGE. */
struct kiln_output_params kiln_output_complete(const struct kiln_output_params *params,
                                               struct kiln_error *error);

/* The path of the one file of a clip (index 0), and those of the files beside it; an empty text
 * behind the last. */
bool kiln_output_clip_file(const struct kiln_output_params *params, uint32_t index, char *path,
                           struct kiln_error *error);

/* Whether a file is a whole PNG, JPEG or EXR image of such a scene, frame and depth (of JPEG:
 * quality), by this version: it says so itself. *reason gets KILN_DEVICE_FAILED when memory was too
 * short to look. */
bool kiln_output_carries(const struct kiln_output_params *params, const char *path, uint32_t frame,
                         struct kiln_error *reason);

/* Checks everything that can be checked before the first frame (suffix, folder writable, existing
 * files, even sizes, codec present, gaps in a video), makes missing folders, and opens the
 * temporary file of a video. Several images are numbered in their names (pattern.h); one alone
 * keeps the plain name. NULL with KILN_USAGE or KILN_IO. */
struct kiln_output *kiln_output_open(const struct kiln_output_params *params,
                                     struct kiln_error *error);
struct kiln_output_needs kiln_output_needs(const struct kiln_output *output);

/* Hands a picture over (ownership always moves, also on failure); frames come in ascending order.
 * Waits while too many are queued, so that memory stays bounded. A failure of an earlier frame is
 * reported by the next call. */
bool kiln_output_write(struct kiln_output *output, struct kiln_picture *picture,
                       struct kiln_error *error);

/* Declares the files that kiln_output_open would write with the same parameters. KILN_USAGE when
 * one of them is taken, or when the path, its suffix or the ranges make no sense. */
bool kiln_output_claim(const struct kiln_output_params *params, struct kiln_claims *claims,
                       struct kiln_error *error);

/* Waits for the encoders, completes and renames the files. Asks params.caller every now and then
 * while that takes long; with its error the file is given up. */
bool kiln_output_finish(struct kiln_output *output, struct kiln_error *error);

/* Without a finish before: whole image files stay, a video and half-written files are removed. */
void kiln_output_close(struct kiln_output **output);

/* Of complete parameters: the path of the file for a frame (the one file, for a video), and how
 * many files there will be: one a frame, one for a video, some for a flipbook. KILN_USAGE. */
bool kiln_output_file(const struct kiln_output_params *params, uint32_t frame,
                      char path[KILN_PATH_SIZE], struct kiln_error *error);
uint32_t kiln_output_file_count(const struct kiln_output_params *params);

#endif
