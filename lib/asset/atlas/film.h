/* The moving gas of one procedural flipbook, recorded at the times of its cells. */
#ifndef KILN_ASSET_ATLAS_FILM_H
#define KILN_ASSET_ATLAS_FILM_H

#include <stdbool.h>

#include "asset/atlas/fluid.h"

/* How the gas starts and what happens to it besides flowing. Time runs from 0 at a particle's birth
 * to 1 at its death. Either may be NULL. */
struct kiln_film_gas {
    void (*start)(struct kiln_fluid *fluid);
    void (*drive)(struct kiln_fluid *fluid, float time, float dt); /* before each step */
};

/* At the time of a cell. */
struct kiln_film_cell {
    float time;
    float heat[KILN_FLUID_SIZE];
    /* Places as in struct kiln_fluid, times their weight: hot gas counts most, so that at a flame's
     * rim its places go on instead of jumping to those of the air. */
    float place_x[KILN_FLUID_SIZE], place_y[KILN_FLUID_SIZE], weight[KILN_FLUID_SIZE];
    /* How far what is there halfway to the next cell moves from this one to the next; 0 in the last
     * cell. In half edges of a cell. */
    float motion_x[KILN_FLUID_SIZE], motion_y[KILN_FLUID_SIZE];
};

struct kiln_film {
    uint32_t cell_count;
    struct kiln_film_cell cells[];
};

/* Lets the gas flow and records cell_count (at least 1) cells, the first at birth and the last at
 * death. NULL when memory is short; freed with free(). Threads may make films side by side. */
struct kiln_film *kiln_film_create(const struct kiln_film_gas *gas,
                                   const struct kiln_fluid_code *code, uint32_t cell_count);

#endif
