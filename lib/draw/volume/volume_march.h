/* Declares the march of rays through the blocks of a domain of gas. Lengths along rays are in cells
 * of the domain, from the eye on, unless they say metres. */
#ifndef KILN_DRAW_VOLUME_VOLUME_MARCH_H
#define KILN_DRAW_VOLUME_VOLUME_MARCH_H

#include <stdatomic.h>

#include "base/simd.h"
#include "draw/light/flame_colors.h"
#include "draw/volume/volume_field.h"
#include "draw/volume/volume_profile.h"
#include "shared/draw_layout.h"

/* The length of a step, cells, and where the finest noise is drawn, whose lattice is 1.5 cells
 * wide. */
#define VOLUME_STEP      0.75f
#define VOLUME_FINE_STEP 0.5f

/* The floats of a ray: what it sees of a domain. */
enum {
    VOLUME_RAY_SMOKE,     /* light that smoke scatters: rgb, premultiplied */
    VOLUME_RAY_ALPHA = 3, /* part of the light behind the gas that it hides */
    VOLUME_RAY_FLAME,     /* light of flames: rgb */
    VOLUME_RAY_END = 7,   /* in the grid: kiln_volume_ray_end; else 0 */
    VOLUME_RAY,
};

/* Holds the planes of a picture of gas, four floats a pixel. */
struct kiln_volume_planes {
    float *smoke; /* scattered light and alpha, premultiplied */
    float *flame; /* light of the flames; the fourth float is not used */
    float *glow;  /* the part of it that glows; NULL: not needed */
};

/* Holds where the gas of each pixel has become half opaque; rows of the picture's width. */
struct kiln_volume_halfway {
    float *depth_m; /* 1e9 where it has not */
    float *passed;  /* optical depth of the gas of nearer domains */
};

/* Counts what a march has done. */
struct kiln_volume_counts {
    _Atomic uint64_t rays;    /* which met gas */
    _Atomic uint64_t samples; /* of them */
};

/* Describes the march through a domain. */
struct kiln_volume_march {
    const struct kiln_volume_field *field;
    float eye[3];                      /* in the window, cells */
    float right[3], up[3], forward[3]; /* cells for a metre along the axes of the view */
    float near_m;                      /* depth of the near plane, m */
    float cell_m;                      /* m of the world along a cell */
    float pixel_x, pixel_y;            /* slope of the ray for each pixel; y points down */
    float middle_x, middle_y;          /* principal point, px */
    float to_sun[3];                   /* unit, in the axes of the window */
    float sun[3];                      /* radiance of a white surface that faces the sun */
    float extinction, absorption;      /* 1/m: of smoke 1, and of flame 1 */
    float albedo[3];
    float scattering; /* g of the phase function */
    float intensity;  /* radiance a metre of flame 1, at temperature 1 */
    float bloom;
    float step;       /* cells */
    uint32_t octaves; /* of noise; 0: none */
    float weights[2]; /* of the noise of each group of GAS_CAME_FROM */
    const struct kiln_flame_colors *colors;
    const struct kiln_draw_backdrop *haze; /* its haze; NULL: there is none */
    float world[3][3];  /* rows: from directions in the window to those in the world */
    const float *depth; /* of the scene, m; rows of `width` floats */
    uint32_t width, height;
    struct kiln_volume_planes planes;    /* smoke NULL: there are none */
    struct kiln_volume_halfway halfway;  /* is written on; depth_m NULL: not needed */
    struct kiln_volume_domain *profiles; /* which are written; NULL: they are not needed */
    struct kiln_volume_counts *counts;
    /* The members below are those of a grid, which has a ray for every second pixel of every second
     * row (volume_cast.h). */
    float *grid;                     /* rays, row by row */
    uint32_t grid_across, grid_down; /* rays in a row, and rows */
    float far_m;                     /* depth behind which the domain has no gas */
};

/* Returns a ray of the grid. */
static inline float *kiln_volume_grid_ray(const struct kiln_volume_march *m, uint32_t column,
                                          uint32_t row)
{
    return m->grid + VOLUME_RAY * ((size_t)row * m->grid_across + column);
}

/* Returns the inverse of the depth at which the ray of a pixel ends, 1/m, which changes evenly
 * across a plane: at the scene, or where no more gas follows. */
static inline float kiln_volume_ray_end(const struct kiln_volume_march *m, size_t pixel)
{
    return 1.0f / (m->depth[pixel] < m->far_m ? m->depth[pixel] : m->far_m);
}

/* A tile of the picture, and the depths between which blocks lie in it. */
struct kiln_volume_tile {
    uint32_t x, y;
    float near_m, far_m;
};

struct kiln_volume_march_rows {
    /* Draws the gas of a tile over what the planes hold: a ray for each pixel. */
    void (*draw)(const struct kiln_volume_march *march, const struct kiln_volume_tile *tile);
    /* Marches the rays of a tile's grid. */
    void (*march_grid)(const struct kiln_volume_march *march, const struct kiln_volume_tile *tile);
    /* Draws the gas of a tile by the grid, and by more rays where its light changes too much. All
     * of the grid must have been marched. */
    void (*draw_between)(const struct kiln_volume_march *march,
                         const struct kiln_volume_tile *tile);
};
KILN_SIMD_DECLARE(const struct kiln_volume_march_rows, kiln_volume_march_rows);

#endif
