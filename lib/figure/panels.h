/* Makes the panels of a figure, which are its pictures with a record of what each was made from. */
#ifndef KILN_FIGURE_PANELS_H
#define KILN_FIGURE_PANELS_H

#include "base/arena.h"
#include "figure/drawing.h"
#include "kiln_program.h"

struct kiln_panel {
    const char *label;
    const char *source;  /* the path of the scene or picture */
    char scene_hash[65]; /* "" without a scene */
    bool has_frame;
    uint32_t frame;
    double time_s;  /* time of the frame; below 0: unknown */
    char state[17]; /* the state hash; "" without a scene */
    char hash[65];  /* SHA-256 of the pixels */
    bool is_map;    /* an error map, which gets a colour scale */
    struct kiln_pixels pixels;
};

/* Names the device, driver and processor that rendered the panels; each is "" if nothing did. The
 * same three render the same pixels. */
struct kiln_renderer {
    char device[128], driver[272], cpu[128];
};

struct kiln_panels {
    struct kiln_arena *arena; /* holds all that follows */
    struct kiln_panel *items;
    size_t count;
    size_t columns; /* number of columns if the request gives none */
    struct kiln_renderer renderer;
    uint32_t paper;             /* 0xRRGGBB, which shows through transparent pixels */
    struct kiln_claims *claims; /* borrowed: the figure's files, and all that panels are made of */
};

/* Make the panels of a sheet, a triptych or a strip; they fail as kiln_figure_make does. */
bool kiln_panels_of_sheet(struct kiln_panels *panels, const struct kiln_figure_params *params,
                          struct kiln_error *error);
bool kiln_panels_of_triptych(struct kiln_panels *panels, const struct kiln_figure_params *params,
                             struct kiln_error *error);
bool kiln_panels_of_strip(struct kiln_panels *panels, const struct kiln_figure_params *params,
                          struct kiln_error *error);

/* Blends a picture of 8-bit RGBA with straight alpha over the paper, and stores the result and its
 * hash in the panel. */
bool kiln_panel_take_pixels(struct kiln_panels *panels, struct kiln_panel *panel, uint32_t width,
                            uint32_t height, const uint8_t *rgba, struct kiln_error *error);

#endif
