/* Stage 4b draws particles in a picture of half or a quarter of the frame's width and height if the
 * scene asks for it, and enlarges that picture to the frame with regard to the scene's depth. With
 * mixed resolution, particles near edges of the depth are drawn at full resolution (Heinz
 * 2019, 2.2.2). */
#ifndef KILN_DRAW_SPRITES_COARSE_H
#define KILN_DRAW_SPRITES_COARSE_H

#include "base/footprint.h"
#include "draw/sprites/particles.h"

struct kiln_coarse_stage;

struct kiln_coarse_params {
    struct kiln_particles_stage *particles; /* draws the particles of both pictures */
    /* true: GL shrinks the depth and enlarges the pictures; false: the host does. Both give the
     * same pictures to rounding; those of the host are the same to the bit on every machine. */
    bool in_gl;
    GLenum format; /* pixel format of colour and bloom */
};

/* Makes the stage. The scene's resolution must not be full. The arguments must outlive the stage;
 * device may be NULL unless in_gl. Returns NULL with an error. */
struct kiln_coarse_stage *kiln_coarse_create(struct kiln_device *device,
                                             const struct kiln_scene *scene,
                                             const struct kiln_coarse_params *params,
                                             struct kiln_threads *threads,
                                             struct kiln_error *error);

/* Adds the memory of the stage on the host; nothing if the scene has no such stage. */
void kiln_coarse_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);
void kiln_coarse_destroy(struct kiln_coarse_stage **stage);

/* Measures the depth of the scene for the next calls of kiln_coarse_run. */
bool kiln_coarse_prepare(struct kiln_coarse_stage *stage, struct kiln_image *depth,
                         struct kiln_error *error);

/* Does what kiln_particles_run does, at the coarse resolution. */
bool kiln_coarse_run(struct kiln_coarse_stage *stage, const struct kiln_particles_draw *draw,
                     struct kiln_error *error);

#endif
