/* Declares the comparison of pictures. This header is part of kiln.h, which includes it. */
#ifndef KILN_COMPARE_H
#define KILN_COMPARE_H

#include "kiln.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How FLIP judges light: LDR clamps it to white, HDR looks at several exposures. AUTO takes HDR
 * when one of the pictures has floats (EXR), and else LDR. */
enum kiln_compare_mode { KILN_COMPARE_AUTO, KILN_COMPARE_LDR, KILN_COMPARE_HDR };

enum { KILN_MAX_COLUMNS = 32, KILN_METRIC_NAME_SIZE = 24 };

/* A column of the result: one metric. */
struct kiln_compare_column {
    char name[KILN_METRIC_NAME_SIZE]; /* "flip.mean" */
    const char *unit;                 /* "" for a metric without a unit */
    bool higher_is_better;
    bool limited; /* the metric has a limit */
    double limit; /* the worst value that passes */
};

enum kiln_compare_verdict {
    KILN_COMPARE_SAME,       /* within all limits */
    KILN_COMPARE_DIFFERENT,  /* beyond a limit, or another size or other channels */
    KILN_COMPARE_MISSING,    /* the frame is in the reference only */
    KILN_COMPARE_EXTRA,      /* the frame is in the test only */
    KILN_COMPARE_UNREADABLE, /* a file is empty, broken, cut short or has values like NaN */
    KILN_COMPARE_VERDICT_COUNT
};

enum { KILN_MAX_VERDICTS = 8 }; /* the most verdicts of any later version */

KILN_API const char *kiln_compare_verdict_name(enum kiln_compare_verdict verdict);

/* One layer of a frame. Colours are measured and judged by the limits. Data, which hold no light,
 * are compared by their numbers. Texts are valid until the callback that gets the frame returns. */
struct kiln_compare_layer {
    size_t size;
    const char *name; /* "beauty" is the picture */
    bool data;
    /* KILN_COMPARE_MISSING: it is in the reference only, KILN_COMPARE_EXTRA: in the test only */
    enum kiln_compare_verdict verdict;
    const char *message; /* why it was not measured, or how the kinds of files differ; or "" */
    bool measured;       /* values, beyond and the places hold: it is of colours */
    bool equal;          /* no number differs */
    double values[KILN_MAX_COLUMNS];
    bool beyond[KILN_MAX_COLUMNS];
    double score; /* the largest share of a limit that a value takes up */
    uint32_t worst_x, worst_y;
    uint32_t window_x, window_y, window_width, window_height, window_differing;
    /* of data: the largest difference of two numbers, which is infinite where only one of them is
     * finite, and how many numbers differ */
    double difference;
    uint64_t differing;
};

/* One frame of a comparison. A frame that is missing, extra or unreadable, or whose sizes differ,
 * is not measured and has no values. The values of a frame with several layers are those of its
 * worst layers. Texts are valid until the callback that gets the frame returns. */
struct kiln_compare_frame {
    size_t size;
    const char *name; /* of the file, or the frame's number */
    enum kiln_compare_verdict verdict;
    const char
        *message; /* why the frame was not measured, or how the kinds of files differ; or "" */
    bool measured;
    bool equal;                      /* no sample differs */
    uint32_t width, height;          /* pixels */
    double values[KILN_MAX_COLUMNS]; /* one for each column of the result; psnr of equal pictures is
                                        infinite */
    bool beyond[KILN_MAX_COLUMNS];   /* the column's value is beyond its limit */
    double score;                    /* the largest share of a limit that a value takes up: up to 1
                                        is within all limits */
    uint32_t worst_x, worst_y;       /* a pixel of the largest difference */
    uint32_t window_x, window_y;     /* the upper left corner of the densest window */
    /* the size of that window, and the number of differing pixels in it */
    uint32_t window_width, window_height, window_differing;
    double flip_s; /* time of FLIP */
    /* Its layers, as long as the texts: one, "beauty", for all formats but EXR. There are none if
     * the frame is missing, extra or unreadable. */
    const struct kiln_compare_layer *layers;
    size_t layer_stride, layer_count; /* bytes from one layer to the next; number of layers */
};

/* The result of a comparison; during it, the result so far. */
struct kiln_compare_result {
    size_t size;
    bool same;     /* every frame is within all limits */
    bool sequence; /* false: one picture was compared with one */
    bool hdr;      /* FLIP judged by KILN_COMPARE_HDR */
    size_t column_count;
    struct kiln_compare_column columns[KILN_MAX_COLUMNS];
    uint32_t frames;                    /* number of all frames */
    uint32_t counts[KILN_MAX_VERDICTS]; /* number of frames by their verdict */
    uint32_t measured;                  /* number of measured frames */
    double worst[KILN_MAX_COLUMNS];     /* over the measured frames */
    double mean[KILN_MAX_COLUMNS];      /* over the measured frames */
    /* names of the frames with the worst values, cut off where they are too long */
    char worst_names[KILN_MAX_COLUMNS][256];
    char worst_frame[256];  /* name of the first frame that was not measured, or else of the frame
                               with the highest score; "": no frame */
    double flip_s, total_s; /* wall-clock time */
};
KILN_EMPTY(kiln_compare_result, kiln_compare_result_empty)

/* Pixels that are not judged: a rectangle, or the black pixels of a picture of the same size. */
struct kiln_compare_mask {
    size_t size;
    uint32_t x, y, width, height; /* pixels; the rectangle may reach beyond the picture's edge */
    const char *picture;          /* path; NULL: the rectangle counts */
};
KILN_EMPTY(kiln_compare_mask, kiln_compare_mask_empty)

struct kiln_compare_params {
    size_t size;
    /* Paths of the two sides. Each is a picture, a video, a folder of pictures (paired by name) or
     * a numbered pattern such as frame_%04d.png or frame_####.png (paired by number; frames of a
     * video count from 0). */
    const char *reference, *test;
    const char *const *limits; /* "metric=value", or several with commas between them */
    size_t limit_count;        /* 0 takes KILN_COMPARE_DEFAULT_LIMITS */
    const char *layer; /* name of the layer to compare, such as "beauty"; NULL: all layers */
    enum kiln_compare_mode mode;
    double pixels_per_degree; /* of the viewer's eye, 4 to 400 */
    double threshold;         /* pixels that differ by more levels (0 to 255) count as differing */
    uint32_t window;          /* edge in pixels of the window that is searched for the place with
                                 the most differing pixels */
    uint32_t threads;         /* 0 takes one a core */
    /* Path of a PNG of reference, test and error map side by side for each frame that was compared,
     * or NULL. Of several layers, the first colours that differ are drawn, or else the first data
     * that do.
     * For sequences it is a pattern, or a folder (which exists, or has a slash at its end). */
    const char *diff;
    const char *error_map; /* path, as `diff`, of a PNG of the error map alone; or NULL */
    /* Pixels that are not judged: the reference's pixels stand there in the test picture. */
    const struct kiln_compare_mask *masks;
    size_t mask_stride, mask_count; /* bytes from one mask to the next; number of masks */
    bool overwrite;                 /* replace pictures that are there */
    /* Called after each frame, with the result so far; its columns are complete. */
    void (*frame)(void *user, const struct kiln_compare_result *result,
                  const struct kiln_compare_frame *frame);
    bool (*stop)(void *user); /* called between frames; true ends with KILN_INTERRUPTED */
    void *user;
    const struct kiln_cancel *cancel; /* NULL: nobody cancels */
    double data_limit;   /* the largest difference of numbers of data that passes: 0 or more */
    struct kiln_log log; /* gets what is wrong with files that are read all the same */
};
#define KILN_COMPARE_DEFAULT_LIMITS "flip.mean=0.01,flip.p99=0.1,window.share=0.1"

static inline struct kiln_compare_params kiln_compare_defaults(void)
{
    struct kiln_compare_params params;
    memset(&params, 0, sizeof params);
    params.size = sizeof params;
    params.pixels_per_degree = 67.0206;
    params.threshold = 2;
    params.window = 32;
    return params;
}

/* Compares pictures and judges them by limits. Returns true when the comparison took place,
 * whatever its result. Returns false with KILN_USAGE when the request makes no sense,
 * KILN_INVALID_INPUT when a file cannot be read (the other frames are compared all the same),
 * KILN_IO when `diff` or `error_map` cannot be written, KILN_DEVICE_FAILED when memory is short. */
KILN_API bool kiln_compare(const struct kiln_compare_params *params,
                           struct kiln_compare_result *result, struct kiln_error *error);

#ifdef __cplusplus
}
#endif

#endif
