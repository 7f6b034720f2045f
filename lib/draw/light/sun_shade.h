/* This header declares the part of the sun that each particle sees past the objects of the
 * backdrop. A particle counts as a ball here, so its shade grows softly as it drifts behind an
 * edge. */
#ifndef KILN_DRAW_LIGHT_SUN_SHADE_H
#define KILN_DRAW_LIGHT_SUN_SHADE_H

#include "base/footprint.h"
#include "base/thread.h"
#include "draw/moment/appearance.h"

struct kiln_sun_shade;

/* Returns whether a system's particles are lit by the scene's lights, which objects may hide. */
bool kiln_sun_shade_concerns(const struct kiln_scene *scene, uint32_t system);

/* Returns whether the scene has lit particles and objects that could shade them. */
bool kiln_sun_shade_exists(const struct kiln_scene *scene);

/* Returns NULL with an error. The scene must outlive the result. */
struct kiln_sun_shade *kiln_sun_shade_create(const struct kiln_scene *scene,
                                             struct kiln_error *error);

/* Adds the memory of the shade. */
void kiln_sun_shade_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);
void kiln_sun_shade_destroy(struct kiln_sun_shade **shade);

/* Takes over the objects and the sun of a moment, for kiln_sun_shade_balls. */
void kiln_sun_shade_place(struct kiln_sun_shade *shade, const struct kiln_moment *moment);

struct kiln_appearance_block;

/* Computes the part of the sun that each ball of a block sees past the objects: 0 to 1, and 1 where
 * none lives. visible: KILN_LANES numbers, aligned to 64 bytes. */
void kiln_sun_shade_balls(const struct kiln_sun_shade *shade, enum kiln_simd simd,
                          const struct kiln_appearance_block *block, float *visible);

/* Computes the part of the sun that each lit particle sees. Returns 0 to 1 for each slot of the
 * pool, with room for whole rows of KILN_SUN_SHADE_ROW, valid until the next run; NULL with an
 * error. */
const float *kiln_sun_shade_run(struct kiln_sun_shade *shade, const struct kiln_moment *moment,
                                struct kiln_threads *threads, struct kiln_error *error);

#endif
