/* Stage 4b draws the particles as billboards (Heinz 2019, 3.2.3 to 3.2.6). All techniques make the
 * same pictures within the error of their arithmetic. */
#ifndef KILN_DRAW_SPRITES_PARTICLES_H
#define KILN_DRAW_SPRITES_PARTICLES_H

#include "asset/atlas/atlas.h"
#include "base/thread.h"
#include "draw/light/lighting.h"
#include "draw/sprites/tile.h"
#include "gpu/framebuffer.h"

enum kiln_raster_technique {
    KILN_RASTER_GEOMETRY,
    KILN_RASTER_INSTANCED,
    KILN_RASTER_TILED,
    KILN_RASTER_CPU
};

struct kiln_particles_stage;

/* Creates the stage. scene, atlas, device and threads must outlive it; device may be NULL for
 * `cpu`. Returns NULL with an error. */
struct kiln_particles_stage *
kiln_particles_create(struct kiln_device *device, const struct kiln_scene *scene,
                      struct kiln_atlas *atlas, enum kiln_raster_technique technique,
                      struct kiln_threads *threads, struct kiln_error *error);
void kiln_particles_destroy(struct kiln_particles_stage **stage);

/* Returns whether the technique takes sorted particles in order from the nearest to the farthest;
 * otherwise it takes them from the farthest to the nearest. */
bool kiln_particles_nearest_first(const struct kiln_particles_stage *stage);

/* Describes a pass: the particles, their light, and the images. */
struct kiln_particles_draw {
    const struct kiln_moment *moment; /* for `cpu`, with its particles on the host */
    struct kiln_buffer *entries;      /* draw entries in drawing order */
    uint32_t count;
    const struct kiln_view *view; /* the moment's view, for a picture of the framebuffer's size */
    const struct kiln_draw_backdrop *backdrop; /* sky, sun and lights, which light the particles */
    const struct kiln_lighting *lighting;
    struct kiln_image *depth;             /* depth of the scene, m */
    struct kiln_framebuffer *framebuffer; /* colour, and bloom if there is any; premultiplied */
    bool keep_bloom; /* true: keeps the bloom of an earlier pass; colour is always cleared first */
    /* false: blends by premultiplied `over`, in which additive particles cover nothing; true: sums
     * colours and alpha (Heinz 2019, figure 3.1, fire). */
    bool sum_alpha;
    /* true: each pixel sorts its fragments (lib/draw/sprites/fragments.h); sum_alpha and
     * fire_covers must be false. */
    bool by_fragment;
    bool fire_covers; /* true: blends by premultiplied `over`; additive particles cover, too */
    /* The gas that particles are blended with; NULL: there is none */
    const struct kiln_tile_gas *gas;
    /* NULL, or gets the colour and alpha of covering particles alone, if kiln_particles_splits */
    struct kiln_image *covering;
    /* NULL, or gets the colour of additive particles alone, as if no other particle hid them, if
     * kiln_particles_adds_apart */
    struct kiln_image *added;
};

/* Returns whether the stage can draw the covering particles of the given systems, a bit each, into
 * an image of their own while it draws a pass. */
bool kiln_particles_splits(const struct kiln_particles_stage *stage,
                           const struct kiln_particles_draw *draw, uint64_t systems);

/* Returns whether the stage can draw the additive particles into an image of their own while it
 * draws a pass. */
bool kiln_particles_adds_apart(const struct kiln_particles_stage *stage,
                               const struct kiln_particles_draw *draw);

/* Draws the particles of a pass into draw->framebuffer. */
bool kiln_particles_run(struct kiln_particles_stage *stage, const struct kiln_particles_draw *draw,
                        struct kiln_error *error);

#endif
