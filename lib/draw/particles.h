/* Stage 4b: the particles as billboards (Heinz 2019, 3.2.3 to 3.2.6), technique `geometry`. */
#ifndef KILN_DRAW_PARTICLES_H
#define KILN_DRAW_PARTICLES_H

#include "asset/atlas.h"
#include "draw/view.h"
#include "gpu/framebuffer.h"
#include "particles/pool.h"

struct kiln_particles_stage;

/* scene and atlas must outlive the stage. */
struct kiln_particles_stage *kiln_particles_create(struct kiln_device *device,
                                                   const struct kiln_scene *scene,
                                                   const struct kiln_atlas *atlas,
                                                   struct kiln_error *error);
void kiln_particles_destroy(struct kiln_particles_stage **stage);

struct kiln_particles_draw {
    struct kiln_pool *pool;
    struct kiln_buffer *entries; /* draw entries in drawing order */
    uint32_t count;
    float time_s;                               /* clip time, for the looks */
    struct kiln_image *depth;                   /* of the scene */
    const struct kiln_framebuffer *framebuffer; /* color, bloom: premultiplied */
    bool keep_bloom; /* of an earlier pass; colour is always cleared first */
    bool sum_alpha; /* false: premultiplied `over`, in which additive particles cover nothing; true:
                     * colours and alpha are summed (figure 3.1, fire) */
    bool fire_covers; /* premultiplied `over` in which additive particles cover like others */
};

/* Binds what vertex shaders read of particles (shaders/draw/record.glsl), but for the view block
 * that kiln_backdrop_draw leaves bound: for stages that draw other shapes. entries name the
 * particles. */
bool kiln_particles_bind(struct kiln_particles_stage *stage, struct kiln_pool *pool,
                         struct kiln_buffer *entries, float time_s, struct kiln_error *error);

/* Draws with the view and backdrop blocks that kiln_backdrop_draw left bound. */
bool kiln_particles_run(struct kiln_particles_stage *stage, const struct kiln_particles_draw *draw,
                        struct kiln_error *error);

#endif
