/* Declares the film of one procedural flipbook: its moving gas, recorded at the times of its
 * cells. */
#ifndef KILN_ASSET_ATLAS_FILM_H
#define KILN_ASSET_ATLAS_FILM_H

#include <stdbool.h>

#include "asset/atlas/fluid.h"

/* Describes how the gas starts, and what acts on it besides the flow. Time runs from 0 at a
 * particle's birth to 1 at its death. Either function may be NULL. */
struct kiln_film_gas {
    void (*start)(struct kiln_fluid *fluid);
    void (*drive)(struct kiln_fluid *fluid, float time, float dt); /* is called before each step */
};

/* The gas at the time of a cell. */
struct kiln_film_cell {
    float time;
    float heat[KILN_FLUID_SIZE];
    /* Start places as in struct kiln_fluid, times a weight that is largest for hot gas. At the rim
     * of a flame, the weighted mean of places is then continuous and does not jump to the places of
     * the air. */
    float place_x[KILN_FLUID_SIZE], place_y[KILN_FLUID_SIZE], weight[KILN_FLUID_SIZE];
    /* Motion from this cell to the next, of the gas that is at a sample halfway between the two, in
     * half edges of a cell; 0 in the last cell. */
    float motion_x[KILN_FLUID_SIZE], motion_y[KILN_FLUID_SIZE];
};

struct kiln_film {
    uint32_t cell_count;
    struct kiln_film_cell cells[];
};

/* Runs the gas and records cell_count (at least 1) cells, the first at birth and the last at death.
 * NULL when memory is short. The caller frees it with free(). Several threads may make films at
 * once. */
struct kiln_film *kiln_film_create(const struct kiln_film_gas *gas,
                                   const struct kiln_fluid_code *code, uint32_t cell_count);

/* Returns the bytes of a film. */
uint64_t kiln_film_bytes(uint32_t cell_count);

#endif
