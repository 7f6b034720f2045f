/* Stage 4a draws the scene behind the particles, and its depth (Heinz 2019, 3.2.1: render scene).
 * Techniques `gl` and `cpu` make the same pictures within the error of their arithmetic; those of
 * `cpu` are the same bytes on every machine. */
#ifndef KILN_DRAW_BACKDROP_BACKDROP_H
#define KILN_DRAW_BACKDROP_BACKDROP_H

#include "base/thread.h"
#include "draw/light/lighting.h"
#include "gpu/image.h"

enum kiln_backdrop_technique { KILN_BACKDROP_CPU, KILN_BACKDROP_GL };

struct kiln_backdrop_params {
    enum kiln_backdrop_technique technique;
    struct kiln_threads *threads; /* of `cpu` */
    /* Targets of scene size: RGBA; view-space metres, 1e9 for sky. */
    struct kiln_image *color, *depth;
};

struct kiln_backdrop_stage;

/* The moment need not be filled yet; it, threads and images are the caller's and must outlive the
 * stage. device may be NULL for `cpu`. NULL with an error. */
struct kiln_backdrop_stage *kiln_backdrop_create(struct kiln_device *device,
                                                 const struct kiln_moment *moment,
                                                 const struct kiln_backdrop_params *params,
                                                 struct kiln_error *error);
void kiln_backdrop_destroy(struct kiln_backdrop_stage **stage);

/* Draws the backdrop, unless the picture of the last call still holds. `gl` leaves bound the blocks
 * and textures that shaders read to light surfaces as it does
 * (shaders/draw/backdrop/surface.glsl). */
bool kiln_backdrop_draw(struct kiln_backdrop_stage *stage, const struct kiln_moment *moment,
                        const struct kiln_lighting *lighting, struct kiln_error *error);

/* Returns the block with the light on particles, as of the last kiln_backdrop_draw. */
const struct kiln_draw_backdrop *kiln_backdrop_block(const struct kiln_backdrop_stage *stage);

/* Returns the objects and lights of technique `cpu` that rays read, as of the last
 * kiln_backdrop_draw; NULL for `gl`. */
const struct kiln_ray_frame *kiln_backdrop_rays(const struct kiln_backdrop_stage *stage);

#endif
