/* A kiln_lamp_smoke holds a map for each lamp of the smoke around it: the optical depth that its
 * light has crossed in each direction and at each distance, in the layout of shared/lamp_smoke.h.
 * With it smoke dims the light of lamps and of fire on surfaces, and on the smoke itself. */
#ifndef KILN_DRAW_LIGHT_LAMP_SMOKE_H
#define KILN_DRAW_LIGHT_LAMP_SMOKE_H

#include "base/simd.h"
#include "draw/light/smoke_shadow.h"
#include "shared/draw_layout.h"

enum {
    KILN_LAMP_SMOKE_LAYER = KILN_LAMP_SMOKE_WIDTH * KILN_LAMP_SMOKE_HEIGHT, /* texels of a layer */
    KILN_LAMP_SMOKE_MAP = KILN_LAMP_SMOKE_LAYERS * KILN_LAMP_SMOKE_LAYER,   /* texels of a map */
};

struct kiln_lamp_smoke;

/* Returns NULL when memory is short. */
struct kiln_lamp_smoke *kiln_lamp_smoke_create(enum kiln_simd simd);
void kiln_lamp_smoke_destroy(struct kiln_lamp_smoke **smoke);

/* Makes the maps of the lights whose `casters.w` is 1, and sets their numbers and distances. grid:
 * a grid of the smoke with its extinction. Returns the maps, valid until the next run; *count
 * becomes their number. NULL with an error when memory is short. */
const float *kiln_lamp_smoke_run(struct kiln_lamp_smoke *smoke, const struct kiln_smoke_grid *grid,
                                 struct kiln_threads *threads, struct kiln_draw_light *lights,
                                 uint32_t light_count, uint32_t *count, struct kiln_error *error);

/* Describes the map of one lamp that is being filled. */
struct kiln_lamp_smoke_job {
    const struct kiln_smoke_grid *grid;
    struct kiln_draw_light lamp;
    float step;   /* the longest way between two samples of the extinction, m */
    float factor; /* distance of each layer to the one before, from layer 2 on */
    float *map;
};

/* Fills in a row of all layers, 0 to KILN_LAMP_SMOKE_HEIGHT - 1. */
typedef void kiln_lamp_smoke_fill(const struct kiln_lamp_smoke_job *job, uint32_t row);
KILN_SIMD_DECLARE(kiln_lamp_smoke_fill, kiln_lamp_smoke_fill);

#endif
