/* Terrain: heights on a lattice of points over a rectangle, out of a picture or of noise. Between
 * four points lie two triangles, which meet between the first and the last of the four: where the
 * ground is for those who draw it and for those who fall on it. */
#ifndef KILN_ASSET_GEOMETRY_TERRAIN_H
#define KILN_ASSET_GEOMETRY_TERRAIN_H

#include "asset/geometry/mesh.h"

enum {
    KILN_MAX_TERRAIN_EDGE = 513, /* points along an axis */
    KILN_MAX_TERRAIN_OCTAVES = 10,
};

struct kiln_terrain_params {
    struct kiln_loader *loader; /* of the image; may be NULL */
    const char *image;          /* an absolute path, or NULL: noise */
    uint32_t samples[2];        /* along x and z: 2 to KILN_MAX_TERRAIN_EDGE */
    float position[3];          /* m: the middle, and the lowest height */
    float size[3];              /* m: above 0 */
    /* of noise: */
    float hills;     /* m: size of the largest; above 0 */
    float roughness; /* height of an octave, in parts of the one before */
    float ridges;    /* 0: round hills; 1: crests between valleys */
    uint32_t octaves, seed;
};

struct kiln_terrain_point {
    float slope_x, height, slope_z; /* m a metre, m */
    float ceiling; /* m: above all ground up to a whole cell beyond those that begin here */
};

struct kiln_terrain {
    uint32_t samples[2];
    float origin[3];                   /* m: first point, and lowest height that there may be */
    float spacing[2];                  /* m: along x and z */
    float top;                         /* m: of the highest point */
    struct kiln_terrain_point *points; /* rows along x, from low to high z */
};

/* The same bits on every machine, for the same picture. An image's top lies towards -z, its first
 * and last pixels at the edges; white is `size` above black, with what is between as it is encoded.
 * Noise reaches from the lowest to the highest height. NULL: as kiln_asset_image_load, or
 * KILN_DEVICE_FAILED when memory is short. The caller destroys it. */
struct kiln_terrain *kiln_terrain_create(const struct kiln_terrain_params *params,
                                         struct kiln_error *error);
void kiln_terrain_destroy(struct kiln_terrain **terrain);

/* The ground, and walls around it down to the lowest height, from `origin` on. NULL with
 * KILN_DEVICE_FAILED when memory is short. The caller destroys it. */
struct kiln_mesh *kiln_terrain_mesh(const struct kiln_terrain *terrain, struct kiln_error *error);

#endif
