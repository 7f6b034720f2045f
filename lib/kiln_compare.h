/* Declares the comparison of pictures. This header is part of kiln.h, which includes it. */
#ifndef KILN_COMPARE_H
#define KILN_COMPARE_H

#include "kiln.h"

#ifdef __cplusplus
extern "C" {
#endif

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

enum { KILN_MAX_VERDICTS = 8 }; /* that later versions may have */

KILN_API const char *kiln_compare_verdict_name(enum kiln_compare_verdict verdict);

/* One frame of a comparison. Only what was measured has values: not a frame that is missing, extra
 * or unreadable, or one whose sizes or channels differ. */
struct kiln_compare_frame {
    size_t size;
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
    size_t size;
    bool same;     /* every frame is */
    bool sequence; /* not one picture against one */
    bool hdr;
    size_t column_count;
    struct kiln_compare_column columns[KILN_MAX_COLUMNS];
    uint32_t frames; /* all of them */
    uint32_t counts[KILN_MAX_VERDICTS];
    uint32_t measured;
    double worst[KILN_MAX_COLUMNS]; /* over the measured frames */
    double mean[KILN_MAX_COLUMNS];
    char worst_names[KILN_MAX_COLUMNS][256]; /* where it is worst; cut off where too long */
    char worst_frame[256];  /* of the highest score; frames without values come first; "": none */
    double flip_s, total_s; /* wall-clock time */
};
KILN_EMPTY(kiln_compare_result, kiln_compare_result_empty)

/* A rectangle, or a picture of the same size that is black where nothing is judged. */
struct kiln_compare_mask {
    size_t size;
    uint32_t x, y, width, height; /* pixels; beyond the picture's edge is no error */
    const char *picture;          /* NULL: the rectangle */
};
KILN_EMPTY(kiln_compare_mask, kiln_compare_mask_empty)

struct kiln_compare_params {
    size_t size;
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
    size_t mask_stride, mask_count; /* bytes from one to the next; of them */
    bool overwrite;
    /* Told after each frame, with the columns and what is known so far. */
    void (*frame)(void *user, const struct kiln_compare_result *result,
                  const struct kiln_compare_frame *frame);
    bool (*stop)(void *user); /* asked between frames; true ends with KILN_INTERRUPTED */
    void *user;
    const struct kiln_cancel *cancel; /* NULL: nobody cancels */
};
#define KILN_COMPARE_DEFAULT_LIMITS "flip.mean=0.01,flip.p99=0.1,window.share=0.1"
KILN_EMPTY(kiln_compare_params, kiln_compare_params_empty)

static inline struct kiln_compare_params kiln_compare_defaults(void)
{
    struct kiln_compare_params params = kiln_compare_params_empty();
    params.layer = "beauty";
    params.pixels_per_degree = 67.0206;
    params.threshold = 2;
    params.window = 32;
    return params;
}

/* Compares pictures and judges them by limits. True when the comparison took place, and the result
 * says what came out. False with KILN_USAGE when the request makes no sense, KILN_INVALID_INPUT
 * when something cannot be read (the other frames are compared all the same), KILN_IO when the
 * pictures of differences cannot be written, KILN_DEVICE_FAILED when memory is short. */
KILN_API bool kiln_compare(const struct kiln_compare_params *params,
                           struct kiln_compare_result *result, struct kiln_error *error);

#ifdef __cplusplus
}
#endif

#endif
