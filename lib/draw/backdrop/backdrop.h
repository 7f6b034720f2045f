/* This header declares stage 4a, which draws the scene behind the particles and its depth (Heinz
 * 2019, 3.2.1: render scene). Techniques `gl` and `cpu` make the same pictures within the error of
 * their arithmetic; the pictures of `cpu` are the same bytes on every machine. */
#ifndef KILN_DRAW_BACKDROP_BACKDROP_H
#define KILN_DRAW_BACKDROP_BACKDROP_H

#include "base/footprint.h"
#include "base/thread.h"
#include "draw/light/lighting.h"
#include "gpu/image.h"

enum kiln_backdrop_technique { KILN_BACKDROP_CPU, KILN_BACKDROP_GL };

struct kiln_backdrop_params {
    enum kiln_backdrop_technique technique;
    struct kiln_threads *threads; /* for technique `cpu` */
    /* Targets of the scene's size: RGBA; view-space depth, m, 1e9 for the sky. */
    struct kiln_image *color, *depth;
};

struct kiln_backdrop_stage;

/* Creates the stage; NULL with an error. Moment, threads and images are the caller's and must
 * outlive the stage; the moment need not be filled yet. device may be NULL for `cpu`. */
struct kiln_backdrop_stage *kiln_backdrop_create(struct kiln_device *device,
                                                 const struct kiln_moment *moment,
                                                 const struct kiln_backdrop_params *params,
                                                 struct kiln_error *error);

/* Adds the memory of the technique `cpu`. */
void kiln_backdrop_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);
void kiln_backdrop_destroy(struct kiln_backdrop_stage **stage);

/* Draws the backdrop, unless the picture of the last call still holds. `gl` leaves the blocks and
 * textures bound that shaders/draw/backdrop/surface.glsl reads, so that shaders of other stages can
 * light surfaces in the same way. */
bool kiln_backdrop_draw(struct kiln_backdrop_stage *stage, const struct kiln_moment *moment,
                        const struct kiln_lighting *lighting, struct kiln_error *error);

/* Returns the block with the light on particles, as of the last kiln_backdrop_draw. */
const struct kiln_draw_backdrop *kiln_backdrop_block(const struct kiln_backdrop_stage *stage);

/* Returns the objects and lights that rays of technique `cpu` read, as of the last
 * kiln_backdrop_draw; NULL for `gl`. */
const struct kiln_ray_frame *kiln_backdrop_rays(const struct kiln_backdrop_stage *stage);

#endif
