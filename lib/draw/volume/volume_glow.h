/* Declares the light that the flames of a domain of gas shed on its smoke. Smoke scatters it many
 * times, so it spreads as heat does: the mean radiance J in each place solves the diffusion
 * equation D laplace(J) = k J - e, with what flames emit (e) and smoke swallows (k). It is solved
 * on cells twice as large as the gas's, by multigrid (Briggs, Henson, McCormick: A Multigrid
 * Tutorial, 2nd ed., chapter 3). */
#ifndef KILN_DRAW_VOLUME_VOLUME_GLOW_H
#define KILN_DRAW_VOLUME_VOLUME_GLOW_H

#include "base/simd.h"
#include "draw/light/flame_colors.h"
#include "draw/volume/volume_field.h"

enum {
    GLOW_LEVELS = 10,
    GLOW_PAD = 16, /* floats of zeros between rows */
};

/* A level of the multigrid. Rows and planes of zeros lie around its cells. */
struct kiln_glow_level {
    struct kiln_gas_place cells;
    ptrdiff_t row, plane; /* floats to the next row and plane */
    float *light, *next;  /* J, and the next iterate; of cell (0, 0, 0), as the others */
    float *source;
    float *diagonal; /* d of: sum of six neighbours - d J = -source; 0 outside */
    float *inverse;  /* 1 / d; 0 outside */
};

struct kiln_volume_glow_rows {
    /* Writes the next iterate of Jacobi's method of planes [begin, end) to `next`. */
    void (*relax)(const struct kiln_glow_level *level, int32_t begin, int32_t end);
    /* Writes the residual of planes [begin, end) to `next`. */
    void (*find_residual)(const struct kiln_glow_level *level, int32_t begin, int32_t end);
};
KILN_SIMD_DECLARE(const struct kiln_volume_glow_rows, kiln_volume_glow_rows);

struct kiln_volume_glow {
    struct kiln_glow_level levels[GLOW_LEVELS];
    uint32_t level_count;
    float *floats;
    double *sums; /* of the planes of the finest level: luminance and colour */
    size_t room, sum_room;
    float color[3]; /* of the light; luminance 1 */
};

/* Describes what flames emit and what swallows their light. */
struct kiln_volume_fire {
    const struct kiln_flame_colors *colors;
    float thickness; /* optical depth of a cell with smoke 1 */
    float cell_m;    /* m of the world along a cell */
    float reach_m;   /* D: m */
    bool closed[6];  /* sides of the window that reflect the light: -x +x -y +y -z +z */
};

/* Computes the light of the flames of a field. *lit becomes false if nothing burns. Returns false
 * with an error when memory is short. */
bool kiln_volume_glow_run(struct kiln_volume_glow *glow, const struct kiln_volume_field *field,
                          const struct kiln_volume_fire *fire,
                          const struct kiln_volume_glow_rows *rows, struct kiln_threads *threads,
                          bool *lit, struct kiln_error *error);

/* Returns the luminance of the light at a cell of the window. */
float kiln_volume_glow_at(const struct kiln_volume_glow *glow, int32_t x, int32_t y, int32_t z);

void kiln_volume_glow_finish(struct kiln_volume_glow *glow);

/* Returns the most bytes of the glow of a domain. */
uint64_t kiln_volume_glow_bytes(struct kiln_gas_place cells);

#endif
