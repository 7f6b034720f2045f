/* Declares terrain: heights on a lattice of points over a rectangle, from a picture or from noise.
 * A cell of four points has two triangles, which share the diagonal from its first to its last
 * point. Drawing and collision use these triangles. */
#ifndef KILN_ASSET_GEOMETRY_TERRAIN_H
#define KILN_ASSET_GEOMETRY_TERRAIN_H

#include "asset/geometry/mesh.h"

enum {
    KILN_MAX_TERRAIN_EDGE = 513, /* most points along an axis */
    KILN_MAX_TERRAIN_OCTAVES = 10,
};

struct kiln_terrain_params {
    struct kiln_loader *loader; /* opens the image; may be NULL */
    const char *image;          /* an absolute path, or NULL: noise */
    uint32_t samples[2];        /* along x and z: 2 to KILN_MAX_TERRAIN_EDGE */
    float position[3];          /* m: centre of the rectangle, and the lowest height */
    float size[3];              /* m: above 0 */
    /* of noise only: */
    float hills;     /* m: size of the largest hills; above 0 */
    float roughness; /* height of each octave, as a part of the one before */
    float ridges;    /* 0: round hills; 1: crests between valleys */
    uint32_t octaves, seed;
};

struct kiln_terrain_point {
    float slope_x, height, slope_z; /* slopes in m a metre, height in m */
    float ceiling; /* m: above all ground of the cell that begins here and of the cells around it */
};

struct kiln_terrain {
    uint32_t samples[2];
    /* m: place of the first point; y is the lowest possible height */
    float origin[3];
    float spacing[2];                  /* m: distances of points along x and z */
    float top;                         /* m: height of the highest point */
    struct kiln_terrain_point *points; /* rows along x, from low to high z */
};

/* Makes a terrain; the same picture gives the same bits on every machine. An image's top lies
 * towards -z, its first and last pixels at the edges. White is `size` above black; values between
 * are linear in the encoded value. Noise reaches from the lowest to the highest height. NULL:
 * errors of kiln_asset_image_load, or KILN_DEVICE_FAILED when memory is short. The caller destroys
 * the terrain. */
struct kiln_terrain *kiln_terrain_create(const struct kiln_terrain_params *params,
                                         struct kiln_error *error);
void kiln_terrain_destroy(struct kiln_terrain **terrain);

/* Makes a mesh of the ground and of walls around it down to the lowest height, relative to
 * `origin`. NULL with KILN_DEVICE_FAILED when memory is short. The caller destroys the mesh. */
struct kiln_mesh *kiln_terrain_mesh(const struct kiln_terrain *terrain, struct kiln_error *error);

/* Counts the vertices and triangles for which the mesh of a terrain has room. */
void kiln_terrain_mesh_count(const uint32_t samples[2], uint64_t *vertices, uint64_t *triangles);

/* Returns the bytes of a terrain. */
uint64_t kiln_terrain_bytes(const uint32_t samples[2]);

#endif
