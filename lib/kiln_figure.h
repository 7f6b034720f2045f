/* Declares figures for documents. This header is part of kiln_program.h, which includes it. */
#ifndef KILN_FIGURE_H
#define KILN_FIGURE_H

#include "kiln_program.h"

/* A figure is pictures with labels on paper, for documents: a sheet of renders over sweeps of
 * parameters, a reference with a result and their error map, a strip of the frames of a clip.
 * Beside FILE.png comes FILE.png.figure.json, which says what it was made by and from. */
enum kiln_figure_kind { KILN_FIGURE_SHEET, KILN_FIGURE_TRIPTYCH, KILN_FIGURE_STRIP };

enum kiln_sweep_kind {
    KILN_SWEEP_KEY,
    KILN_SWEEP_TOGETHER, /* no axis: changes along with the sweep before, value by value */
    KILN_SWEEP_VARIANT,  /* "key=value;key=value": a panel; neighbours make an axis */
};

/* An axis of panels, "key=value,value,...", of a key of the scene, "frame" or "time" (in s). */
struct kiln_figure_sweep {
    enum kiln_sweep_kind kind;
    const char *text;
};

/* A part of every picture that is shown enlarged below it, in a coloured frame. */
struct kiln_figure_inset {
    double x, y, width, height;
    bool parts; /* of the picture's size, 0 to 1; else pixels */
};

struct kiln_figure_params {
    enum kiln_figure_kind kind;
    const char *const *inputs; /* scenes; reference and test; a scene, or what compare takes */
    size_t input_count;
    const char *output; /* .png, .jpg (of one quality, as 87 of 100), .svg or .pdf */
    bool overwrite;
    struct kiln_scene_params scene; /* applied before what is swept */
    const struct kiln_figure_sweep *sweeps;
    size_t sweep_count;
    const struct kiln_frame_range *ranges; /* frames to show; 0: the middle one, of a strip some */
    size_t range_count;
    uint32_t strip; /* a strip without ranges: how many frames, evenly over the clip */
    const struct kiln_figure_inset *insets;
    size_t inset_count;    /* up to 4 */
    uint32_t columns;      /* 0: as many as look right */
    uint32_t width;        /* of a panel, to which larger pictures are reduced; 0: their own */
    double paper_width_mm; /* of the figure on paper, 5 to 2000; 0: what its panels take */
    uint32_t dpi;          /* pixels an inch of paper, 36 to 2400, needed with paper_width_mm; 0:
                              not said, and vectors have 96 */
    uint32_t text_size;    /* pixels, 8 to 64 */
    double text_points;    /* in place of text_size, 4 to 72; 0: text_size counts */
    const char *title;     /* NULL: none */
    const char *alt;       /* what the figure shows, for those who do not see it; NULL: not said */
    const char *const *labels; /* of the panels, in place of the parameters */
    size_t label_count;
    bool unlabelled, dark;
    bool plain;         /* nothing but the pictures, edge to edge */
    const char *device; /* as in kiln_device_params */
    const char *const *techniques;
    size_t technique_count;
    uint32_t threads;
    const char *const *command; /* what was asked for, for the sidecar and `kiln figure --check` */
    size_t command_count;
    const char *check;   /* a sidecar: draw, write nothing, and say whether its figure is stale */
    bool update;         /* of a check: write what was drawn in place of a figure that is stale */
    const char *depfile; /* where to write what the figure is made of, for make; NULL: nowhere */
    bool (*stop)(void *user);
    void *user;
    struct kiln_log log;
};
static inline struct kiln_figure_params kiln_figure_defaults(void)
{
    return (struct kiln_figure_params){.strip = 6, .text_size = 14};
}

struct kiln_figure_result {
    uint32_t width, height, panels;
    bool stale;                     /* of a check */
    bool redrawn;                   /* of a check that updates: it was stale, and is not any more */
    char reason[KILN_MESSAGE_SIZE]; /* why; or how it was judged, if not by its pixels' hash */
};

/* Whether a file is a scene by its name; else it is a picture or a clip. */
bool kiln_is_scene_name(const char *path);

/* Draws a figure and writes it and its sidecar. KILN_USAGE for a request that makes no sense,
 * otherwise what loading, rendering and comparing say. */
bool kiln_figure_make(const struct kiln_figure_params *params, struct kiln_figure_result *result,
                      struct kiln_error *error);

/* Figures by their sidecars. */
struct kiln_figure_list;
struct kiln_figure_entry {
    const char *sidecar, *figure; /* paths */
    const char *folder;           /* in which the command was given */
    const char *const *command;
    size_t command_count;
    const struct kiln_error *problem; /* why it cannot be read, and has no command; else NULL */
};

/* Figures, by themselves or by their sidecars, and all below folders, ordered by path. One that is
 * broken, or a path without any, is a problem of its entry. KILN_DEVICE_FAILED when memory is
 * short. */
struct kiln_figure_list *kiln_figure_list_load(const char *const *paths, size_t count,
                                               struct kiln_error *error);
void kiln_figure_list_destroy(struct kiln_figure_list **list);
size_t kiln_figure_list_count(const struct kiln_figure_list *list);
struct kiln_figure_entry kiln_figure_list_entry(const struct kiln_figure_list *list, size_t index);

#endif
