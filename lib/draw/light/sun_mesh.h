/* A kiln_sun_mesh is a small height map of a mesh as the sun sees it, on the host. sun_shade.c
 * shades particles with it, which needs no fine map. */
#ifndef KILN_DRAW_LIGHT_SUN_MESH_H
#define KILN_DRAW_LIGHT_SUN_MESH_H

#include "draw/moment/shapes.h"

enum { KILN_SUN_MESH_EDGE = 128, KILN_SUN_MESH_LEVELS = 8, KILN_SUN_MESH_CELLS = 21845 };

/* Holds the levels of the map, the finest first; each has half the edge of the one before. */
struct kiln_sun_mesh {
    struct kiln_draw_mesh placed; /* the mesh that the map shows, and the sun at that time */
    struct kiln_sun_frame sun;
    bool drawn;
    float cover[KILN_SUN_MESH_CELLS];  /* part of each cell that the mesh covers */
    float height[KILN_SUN_MESH_CELLS]; /* mean height towards the sun times the cover, m */
};

/* A particle, as far as the sun is concerned. */
struct kiln_ball {
    float3 center;
    float radius; /* m */
};

/* Draws the map, unless it shows the mesh in this position and under this sun already. */
void kiln_sun_mesh_update(struct kiln_sun_mesh *map, const struct kiln_mesh *mesh,
                          const struct kiln_draw_mesh *placed, const struct kiln_sun_frame *sun);

/* Returns the part of the sun that the mesh hides from a ball, 0 to 1. */
float kiln_sun_mesh_cover(const struct kiln_sun_mesh *map, struct kiln_ball ball);

#endif
