/* This header declares the part of each lamp that each lit particle sees past the objects of the
 * backdrop and past solid particles. A particle counts as a ball here, as for the sun
 * (sun_shade.h). */
#ifndef KILN_DRAW_LIGHT_LAMP_SHADE_H
#define KILN_DRAW_LIGHT_LAMP_SHADE_H

#include "base/footprint.h"
#include "base/thread.h"
#include "draw/light/lamps.h"

enum { KILN_LAMP_SHADE_ONE = 255 };

struct kiln_lamp_shade;

/* Returns whether the scene has lit particles, and lamps or fire that objects or solid particles
 * may hide from them. */
bool kiln_lamp_shade_exists(const struct kiln_scene *scene);

/* Returns NULL with an error. The scene must outlive the result. */
struct kiln_lamp_shade *kiln_lamp_shade_create(const struct kiln_scene *scene,
                                               struct kiln_error *error);

/* Adds the memory of the shade. */
void kiln_lamp_shade_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);
void kiln_lamp_shade_destroy(struct kiln_lamp_shade **shade);

/* Computes the part of each light that each lit particle sees. maps: of kiln_lamp_maps_run;
 * solid_maps: texels of kiln_lamp_solids_run. Returns a plane of words for each four lights, valid
 * until the next run. A plane has a word for each slot of the pool, and room for whole rows of
 * KILN_SUN_SHADE_ROW. A word has 8 bits for each of its lights, the first light lowest, in units of
 * 1 / KILN_LAMP_SHADE_ONE. NULL with an error. */
const uint32_t *kiln_lamp_shade_run(struct kiln_lamp_shade *shade, const struct kiln_moment *moment,
                                    struct kiln_threads *threads,
                                    const struct kiln_draw_light *lights, uint32_t light_count,
                                    const uint32_t *maps, const uint32_t *solid_maps,
                                    struct kiln_error *error);

/* Returns how many words the planes of kiln_lamp_shade_run have for a pool of this many slots. */
static inline size_t kiln_lamp_shade_plane(uint32_t slot_count)
{
    return ((size_t)slot_count + KILN_SUN_SHADE_ROW - 1) / KILN_SUN_SHADE_ROW * KILN_SUN_SHADE_ROW;
}

#endif
