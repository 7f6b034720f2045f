/* Stage 4b draws the particles as billboards (Heinz 2019, 3.2.3 to 3.2.6). All techniques make the
 * same pictures within the error of their arithmetic. */
#ifndef KILN_DRAW_SPRITES_PARTICLES_H
#define KILN_DRAW_SPRITES_PARTICLES_H

#include "asset/atlas/atlas.h"
#include "base/thread.h"
#include "draw/light/lighting.h"
#include "gpu/framebuffer.h"

enum kiln_raster_technique {
    KILN_RASTER_GEOMETRY,
    KILN_RASTER_INSTANCED,
    KILN_RASTER_TILED,
    KILN_RASTER_CPU
};

struct kiln_particles_stage;

/* scene, atlas and threads must outlive the stage; device may be NULL for `cpu`. */
struct kiln_particles_stage *
kiln_particles_create(struct kiln_device *device, const struct kiln_scene *scene,
                      struct kiln_atlas *atlas, enum kiln_raster_technique technique,
                      struct kiln_threads *threads, struct kiln_error *error);
void kiln_particles_destroy(struct kiln_particles_stage **stage);

/* Returns whether the technique takes sorted particles from the nearest to the farthest; otherwise
 * it takes them from the farthest. */
bool kiln_particles_nearest_first(const struct kiln_particles_stage *stage);

struct kiln_particles_draw {
    const struct kiln_moment *moment; /* for `cpu`, with its particles on the host */
    struct kiln_buffer *entries;      /* draw entries in drawing order */
    uint32_t count;
    const struct kiln_view *view;              /* the moment's, for a picture of this size */
    const struct kiln_draw_backdrop *backdrop; /* what lights them */
    const struct kiln_lighting *lighting;
    struct kiln_image *depth;             /* of the scene */
    struct kiln_framebuffer *framebuffer; /* color, and bloom unless there is none: premultiplied */
    bool keep_bloom;                      /* of an earlier pass; colour is always cleared first */
    bool sum_alpha; /* false: premultiplied `over`, in which additive particles cover nothing; true:
                     * colours and alpha are summed (figure 3.1, fire) */
    bool by_fragment; /* each pixel sorts what it shows on its own (lib/draw/sprites/fragments.h);
                       * without sum_alpha and fire_covers */
    bool fire_covers; /* premultiplied `over` in which additive particles cover like others */
};

/* Draws the particles of a pass into draw->framebuffer. */
bool kiln_particles_run(struct kiln_particles_stage *stage, const struct kiln_particles_draw *draw,
                        struct kiln_error *error);

#endif
