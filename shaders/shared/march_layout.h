/* Declares what the host and the kernel of technique march=gl share
 * (shaders/draw/volume/volume_march.comp). Lengths along rays are in cells of the domain, as in
 * struct kiln_volume_march. */
#ifndef KILN_SHARED_MARCH_LAYOUT_H
#define KILN_SHARED_MARCH_LAYOUT_H

#include "shared/flame_table.h"
#include "shared/gas_detail.h"
#include "shared/gas_profile.h"

/* Storage blocks. */
#define MARCH_BIND_BLOCKS 0 /* cells of blocks, two vec4 each: volume_field.h */
/* The ways of the gas in all cells, two vec4 each; then the edges of all cells, a vec4 each. */
#define MARCH_BIND_FINER    1
#define MARCH_BIND_TINTS    2 /* what coloured smoke scatters, a vec4 a cell */
#define MARCH_BIND_PLACES   3 /* the block of each cube; then the tiles, four words each */
#define MARCH_BIND_PLANES   4 /* smoke, flame and glow of each pixel, a vec4 each */
#define MARCH_BIND_HALFWAY  5 /* of each pixel: depth of half opacity; then optical depth passed */
#define MARCH_BIND_PROFILES 6 /* the profile of each pixel; then the memory of profiles */
#define MARCH_BIND_TOTALS   7 /* struct march_totals */
#define MARCH_BINDINGS      8

#define MARCH_BIND_UNIFORMS 0 /* a uniform block */
#define MARCH_UNIT_DEPTH    0 /* texture of the scene's depths */
#define MARCH_AT_TILES      0 /* location of the first tile of a dispatch, and of its end */

/* A march does some of these things. */
#define MARCH_LIGHT   1u  /* writes the planes; else only where gas is half opaque */
#define MARCH_GLOW    2u  /* writes the plane of glow, too */
#define MARCH_HALFWAY 4u  /* writes where gas is half opaque */
#define MARCH_COLORED 8u  /* smoke has colours */
#define MARCH_HAZE    16u /* there is haze before the gas */

/* Describes the march through a domain. */
struct kiln_march {
    float4 eye;   /* in the window; w: depth of the near plane, m */
    float4 right; /* cells for a metre along the axes of the view; w: m of the world along a cell */
    float4 up;    /* w: length of a step */
    float4 forward;  /* w: g of the phase function */
    float4 pixel;    /* slope of the ray for each pixel, x and y; principal point, px */
    float4 to_sun;   /* unit, in the axes of the window; w: intensity of flames */
    float4 sun;      /* radiance of a white surface that faces the sun; w: the part that glows */
    float4 albedo;   /* w: extinction, 1/m */
    float4 detail;   /* weights of the noise of both groups; octaves; absorption of flame, 1/m */
    float4 lattice;  /* corner of the window in the domain, cells; w: cells a metre of ways */
    float4 world[3]; /* rows: from directions in the window to those in the world */
    uint4 cells;     /* of the window; w: what the march does: MARCH_* */
    uint4 bricks;    /* of the window; w: width of the picture, px */
    uint4 picture; /* height; first word of tiles, and of the memory of profiles; vec4s before edges
                    */
    float4 colors[FLAME_COLORS + 1];
};

/* Counts the work of a march: words of the memory of profiles; rays that met gas; samples. */
struct march_totals {
    uint used, rays, samples, unused;
};

#endif
