/* Writes frames to files or streams: PNG, JPEG, EXR, video. All formats have one interface, and one
 * row each in a table (formats.c). */
#ifndef KILN_OUTPUT_OUTPUT_H
#define KILN_OUTPUT_OUTPUT_H

#include <stdatomic.h>

#include "base/caller.h"
#include "kiln_program.h"

enum { KILN_MAX_LAYERS = 8 };

/* The one layer of a single channel that is no depth. */
#define KILN_LAYER_GAS_DENSITY "gas.density"

/* A float layer of a frame; linear, premultiplied, rows from the top. */
struct kiln_layer {
    const char *name;  /* static text: "beauty", "depth", "fire"... */
    uint32_t channels; /* 1 (a depth, Z, or KILN_LAYER_GAS_DENSITY) or 4 (RGBA) */
    float *pixels;
};

/* Holds the pixels of one finished frame on the host. Pixels are not written to once the picture is
 * shared. */
struct kiln_picture {
    atomic_uint others; /* the number of holders besides the first: kiln_picture_share */
    uint32_t frame;
    uint32_t width, height;
    bool has_alpha; /* display alpha is meaningful */
    /* the display pixels are numbers, not colours: files name no colour space for them */
    bool is_data;
    uint32_t bits; /* bits of a channel of the display pixels: 8 or 16 */
    void *display; /* sRGB, RGBA, not premultiplied, rows from the top, host byte order */
    struct kiln_layer layers[KILN_MAX_LAYERS]; /* only the layers that the format needs */
    uint32_t layer_count;
    struct kiln_spare_pictures *spares; /* where it goes when it is destroyed, or NULL */
    struct kiln_picture *next_spare;    /* while it is spare */
};

/* Allocates a picture with room for display pixels (bits 0: none) and layers (names[i],
 * channels[i]). The caller fills them. NULL with KILN_DEVICE_FAILED when memory is short. */
struct kiln_picture *kiln_picture_create(uint32_t width, uint32_t height, uint32_t bits,
                                         const char *const *names, const uint32_t *channels,
                                         uint32_t layer_count, struct kiln_error *error);

/* Adds a holder to a picture, on any thread. Each holder destroys it once. */
struct kiln_picture *kiln_picture_share(struct kiln_picture *picture);
void kiln_picture_destroy(struct kiln_picture **picture);

/* Keeps destroyed pictures, all of one shape, for those to come: the system clears all memory that
 * it gives, which takes as long as to fill it. */
struct kiln_spare_pictures;

/* Returns NULL when memory is short. */
struct kiln_spare_pictures *kiln_spare_pictures_create(void);

/* Frees the spare pictures. Those that are still in use are freed when they are destroyed. */
void kiln_spare_pictures_destroy(struct kiln_spare_pictures **spares);

/* Returns a spare picture, whose pixels are undefined, or NULL: there is none. */
struct kiln_picture *kiln_spare_pictures_take(struct kiln_spare_pictures *spares);

/* Makes a picture return to the spare ones when it is destroyed, on any thread. */
void kiln_spare_pictures_add(struct kiln_spare_pictures *spares, struct kiln_picture *picture);

/* Which float layers are needed: none, the whole picture's, or also those of its parts, which are
 * drawn separately. */
enum kiln_layers { KILN_LAYERS_NONE, KILN_LAYERS_BEAUTY, KILN_LAYERS_ALL };

/* Describes the pictures that a format takes of each frame. */
struct kiln_output_needs {
    uint32_t bits; /* bits of the display pixels: 0 (none), 8, 16 */
    enum kiln_layers layers;
    bool texture; /* colours are divided by alpha as light, not as the display's values */
};

/* A file that is complete and has its final name. */
struct kiln_finished_file {
    const char *path;
    struct kiln_frame_range frames; /* frames that the file holds; some in between may be missing */
    /* is_part: a part of a clip; is_clip: the clip, or a file beside it; neither: the file of a
     * frame */
    bool is_part, is_clip;
    uint64_t bytes;
    char sha256[65];
};

/* Fills size and hash by reading the file; KILN_IO. */
bool kiln_finished_file_measure(struct kiln_finished_file *finished, struct kiln_error *error);

/* `tell` is called with each file as soon as it is complete, on any thread, one call at a time.
 * False stops the output with the error. NULL: there is no listener, and no file is read again for
 * its hash. */
struct kiln_file_listener {
    bool (*tell)(void *user, const struct kiln_finished_file *finished, struct kiln_error *error);
    void *user;
};

struct kiln_format;

struct kiln_output_params {
    /* path as the user gave it; of a stream, its name in messages */
    const char *path;
    /* takes the frames instead of files, unless its format is none */
    struct kiln_stream stream;
    const struct kiln_format *format; /* the path's format; kiln_output_complete finds it */
    uint32_t width, height;
    uint32_t fps_num, fps_den;
    bool alpha;
    /* the frames that will be written, ascending, disjoint */
    const struct kiln_frame_range *ranges;
    size_t range_count;
    /* The frames of the whole output, to which `ranges` belong. The place of a frame and the names
     * of files depend on it. Count 0: `ranges` are the whole output. */
    const struct kiln_frame_range *clip;
    size_t clip_count;
    /* Only for one file of all frames: the folder where its parts wait in files until
     * kiln_parts_join joins them. `ranges` are whole parts then. NULL: the clip is written at
     * once. */
    const char *parts;
    /* another process joins the parts, so this one does not open libraries for containers */
    bool parts_alone;
    uint32_t threads; /* number of encoder threads; at least 1 */
    bool overwrite;
    uint32_t png_bits, exr_bits, quality;
    enum kiln_png_effort png_effort;
    struct kiln_flipbook flipbook; /* columns 0: no flipbook */
    /* 64 hex digits, written into each file with seed, frame and version; "": a clip without a
     * scene; NULL: an encoder alone, without a scene */
    const char *scene_hash;
    uint32_t seed;
    struct kiln_log log;
    struct kiln_file_listener on_finished;
    struct kiln_budget *budget; /* NULL: no limits */
    bool durable;               /* files are synced to the disk before they are renamed */
    struct kiln_caller
        caller; /* is asked by the calling thread while parts are joined and the clip is ended */
};

struct kiln_output;

/* Returns the parameters with format and clip filled in. Parameters that the format does not use
 * get their defaults, so that jobs which differ in nothing else count as the same. format is NULL,
 * with KILN_USAGE, for an unknown suffix. */
struct kiln_output_params kiln_output_complete(const struct kiln_output_params *params,
                                               struct kiln_error *error);

/* Makes the path of the one file of a clip (index 0) or of the files beside it; an empty text
 * behind the last. */
bool kiln_output_clip_file(const struct kiln_output_params *params, uint32_t index, char *path,
                           struct kiln_error *error);

/* Returns whether a file is a whole PNG, JPEG or EXR image that this version of kiln wrote for this
 * scene, frame and depth (of JPEG: quality), as its texts say. *reason gets KILN_DEVICE_FAILED when
 * memory was too short to look. */
bool kiln_output_carries(const struct kiln_output_params *params, const char *path, uint32_t frame,
                         struct kiln_error *reason);

/* Opens an output. Checks everything that can be checked before the first frame: suffix, folder
 * writable, existing files, even sizes, codec present, gaps in a video. Makes missing folders, and
 * opens the temporary file of a video. Several images have their numbers in their names
 * (base/pattern.h); a single image has the plain name. NULL with KILN_USAGE or KILN_IO. */
struct kiln_output *kiln_output_open(const struct kiln_output_params *params,
                                     struct kiln_error *error);
struct kiln_output_needs kiln_output_needs(const struct kiln_output *output);

/* Hands a picture to the output, which owns it from then on, also on failure. Frames come in
 * ascending order. Waits while too many pictures are queued, so that memory stays bounded. The
 * failure of an earlier frame is reported by the next call. */
bool kiln_output_write(struct kiln_output *output, struct kiln_picture *picture,
                       struct kiln_error *error);

/* Claims the files that kiln_output_open would write with these parameters. KILN_USAGE when one of
 * them is claimed already, or when the path, its suffix or the ranges are not valid. */
bool kiln_output_claim(const struct kiln_output_params *params, struct kiln_claims *claims,
                       struct kiln_error *error);

/* Waits for the encoders, completes the files and renames them. Meanwhile it asks params.caller
 * whether to go on; if not, the unfinished file is removed and the caller's error returned. */
bool kiln_output_finish(struct kiln_output *output, struct kiln_error *error);

/* Destroys an output. If it was not finished, whole image files stay, and a video and half-written
 * files are removed. */
void kiln_output_close(struct kiln_output **output);

/* Makes the path of the file of a frame (for a video, of the one file), and the number of files of
 * the output: one a frame, one for a video, one to three for a flipbook. The parameters are
 * complete. KILN_USAGE. */
bool kiln_output_file(const struct kiln_output_params *params, uint32_t frame,
                      char path[KILN_PATH_SIZE], struct kiln_error *error);
uint32_t kiln_output_file_count(const struct kiln_output_params *params);

#endif
