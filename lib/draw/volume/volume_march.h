/* Declares the march of rays through the blocks of a domain of gas. Lengths along rays are in cells
 * of the domain, from the eye on, unless they say metres. */
#ifndef KILN_DRAW_VOLUME_VOLUME_MARCH_H
#define KILN_DRAW_VOLUME_VOLUME_MARCH_H

#include "base/simd.h"
#include "draw/light/flame_colors.h"
#include "draw/volume/volume_field.h"
#include "draw/volume/volume_profile.h"
#include "shared/draw_layout.h"

/* The length of a step, cells; half of it where the finest noise is drawn. */
#define VOLUME_STEP 0.75f

/* Octaves of noise that are drawn where gas came from, and the edge of the cells of the first one's
 * lattice, cells: about the smallest eddies that the gas itself has. */
enum { VOLUME_MOST_OCTAVES = 2 };
#define VOLUME_NOISE_CELL 3.0f

/* Holds the planes of a picture of gas, four floats a pixel, rows of `pitch` pixels. */
struct kiln_volume_planes {
    float *smoke; /* scattered light and alpha, premultiplied */
    float *flame; /* light of the flames; the fourth float is not used */
    float *glow;  /* the part of it that glows; NULL: not needed */
    size_t pitch;
};

/* Holds where the gas of each pixel has become half opaque; rows of the picture's width. */
struct kiln_volume_halfway {
    float *depth_m; /* 1e9 where it has not */
    float *passed;  /* optical depth of the gas of nearer domains */
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
};

/* A tile of the picture, and the depths between which blocks lie in it. */
struct kiln_volume_tile {
    uint32_t x, y;
    float near_m, far_m;
};

struct kiln_volume_march_rows {
    /* Draws the gas of a tile over what the planes hold. */
    void (*draw)(const struct kiln_volume_march *march, const struct kiln_volume_tile *tile);
};
KILN_SIMD_DECLARE(const struct kiln_volume_march_rows, kiln_volume_march_rows);

#endif
