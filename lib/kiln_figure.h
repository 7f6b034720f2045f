/* Declares figures for documents. This header is part of kiln_program.h, which includes it. */
#ifndef KILN_FIGURE_H
#define KILN_FIGURE_H

#include "kiln_program.h"

/* Kinds of figures. A figure shows pictures with labels, for documents: a sheet of renders over
 * sweeps of parameters, a triptych of a reference, a result and their error map, or a strip of
 * frames of a clip. Beside FILE.png a sidecar FILE.png.figure.json is written, which records the
 * command and the inputs that made the figure. */
enum kiln_figure_kind { KILN_FIGURE_SHEET, KILN_FIGURE_TRIPTYCH, KILN_FIGURE_STRIP };

enum kiln_sweep_kind {
    KILN_SWEEP_KEY,      /* an axis of panels, one for each value */
    KILN_SWEEP_TOGETHER, /* no axis of its own: its values go along with those of the sweep before
                          */
    KILN_SWEEP_VARIANT,  /* one panel, "key=value;key=value"; adjacent variants make an axis */
};

/* A sweep "key=value,value,...". The key is one of the scene, "frame", or "time" (in s). */
struct kiln_figure_sweep {
    enum kiln_sweep_kind kind;
    const char *text;
};

/* A rectangle of every picture that is shown enlarged below the picture, in a coloured frame. */
struct kiln_figure_inset {
    double x, y, width, height;
    bool parts; /* the rectangle is in parts of the picture's size, 0 to 1; else in pixels */
};

struct kiln_figure_params {
    enum kiln_figure_kind kind;
    /* A sheet has one or more scenes, a triptych a reference and a test, a strip a scene or a clip
     * in any form that kiln_compare takes. */
    const char *const *inputs;
    size_t input_count;
    const char *output; /* .png, .jpg (of one quality, as 87 of 100), .svg or .pdf */
    bool overwrite;
    struct kiln_scene_params scene; /* applied before the sweeps */
    const struct kiln_figure_sweep *sweeps;
    size_t sweep_count;
    /* Frames to show. With range_count 0, a strip takes `strip` frames, others the middle one. */
    const struct kiln_frame_range *ranges;
    size_t range_count;
    uint32_t strip; /* number of frames, evenly over the clip, of a strip without ranges */
    const struct kiln_figure_inset *insets;
    size_t inset_count;        /* up to 4 */
    uint32_t columns;          /* columns of panels; 0: chosen by the layout */
    uint32_t width;            /* pixels of a panel; larger pictures are reduced; 0: no limit */
    double paper_width_mm;     /* width of the figure on paper, 5 to 2000; 0: as its panels need */
    uint32_t dpi;              /* pixels an inch of paper, 36 to 2400, needed with paper_width_mm;
                                  0: not recorded, and vector formats assume 96 */
    uint32_t text_size;        /* pixels, 8 to 64 */
    double text_points;        /* points, 4 to 72, in place of text_size; 0: text_size counts */
    const char *title;         /* NULL: none */
    const char *alt;           /* alternative text that describes the figure; NULL: none */
    const char *const *labels; /* of the panels, in place of the parameters */
    size_t label_count;
    bool unlabelled, dark;         /* no labels of panels; light text on a dark ground */
    bool plain;                    /* only the pictures, edge to edge */
    const char *device;            /* as kiln_device_params.wanted */
    const char *const *techniques; /* "stage=name" */
    size_t technique_count;
    uint32_t threads;           /* 0 takes one a core */
    const char *const *command; /* words of the command line, for the sidecar, by which
                                   `kiln figure --check` draws the figure again */
    size_t command_count;
    const char *check;   /* path of a sidecar: draw its figure, write nothing, and find out whether
                            the figure is stale; NULL: make a figure */
    bool update;         /* with `check`: replace a stale figure by the one that was drawn */
    const char *depfile; /* path of a makefile that lists the figure's inputs; NULL: none */
    bool (*stop)(void *user); /* true ends with KILN_INTERRUPTED */
    void *user;
    struct kiln_log log;
};
static inline struct kiln_figure_params kiln_figure_defaults(void)
{
    return (struct kiln_figure_params){.strip = 6, .text_size = 14};
}

struct kiln_figure_result {
    uint32_t width, height, panels; /* pixels; number of panels */
    bool stale;                     /* result of `check` */
    bool redrawn;                   /* with `update`: the figure was stale and has been replaced */
    char reason[KILN_MESSAGE_SIZE]; /* why it is stale; or how it was judged, if not by the hash of
                                       its pixels */
};

/* Returns whether a path has the name of a scene file; any other file is a picture or a clip. */
bool kiln_is_scene_name(const char *path);

/* Draws a figure and writes it and its sidecar, or does what `check` asks for. KILN_USAGE for a
 * request that makes no sense, and the errors of loading, rendering and comparing. */
bool kiln_figure_make(const struct kiln_figure_params *params, struct kiln_figure_result *result,
                      struct kiln_error *error);

/* Figures that were found by their sidecars. */
struct kiln_figure_list;
struct kiln_figure_entry {
    const char *sidecar, *figure; /* paths */
    const char *folder;           /* working directory of the command */
    const char *const *command;   /* words of the command line that made the figure */
    size_t command_count;
    const struct kiln_error *problem; /* why the sidecar cannot be read; NULL: it was read. With a
                                         problem, there is no command */
};

/* Lists the figures of paths. A path is a figure, a sidecar, or a folder, which stands for all
 * figures below it. A broken sidecar and a path without a figure give an entry with a problem.
 * Returns a list that the caller destroys, or NULL with KILN_DEVICE_FAILED when memory is short. */
struct kiln_figure_list *kiln_figure_list_load(const char *const *paths, size_t count,
                                               struct kiln_error *error);
void kiln_figure_list_destroy(struct kiln_figure_list **list);
/* Return the number of entries, and the entry of an index below that. Its texts belong to the list.
 */
size_t kiln_figure_list_count(const struct kiln_figure_list *list);
struct kiln_figure_entry kiln_figure_list_entry(const struct kiln_figure_list *list, size_t index);

#endif
