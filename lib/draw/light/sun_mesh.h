/* A kiln_sun_mesh is a small height map of a mesh as the sun sees it, on the host. It is for the
 * shade on particles, which needs no fine map. */
#ifndef KILN_DRAW_LIGHT_SUN_MESH_H
#define KILN_DRAW_LIGHT_SUN_MESH_H

#include "draw/light/sun_cover.h"

enum { KILN_SUN_MESH_EDGE = 128, KILN_SUN_MESH_LEVELS = 8, KILN_SUN_MESH_CELLS = 21845 };

/* Levels of half the edge each, the finest first. */
struct kiln_sun_mesh {
    struct kiln_draw_mesh placed; /* what the map shows, and under which sun */
    struct kiln_sun_frame sun;
    bool drawn;
    float cover[KILN_SUN_MESH_CELLS];  /* part of a cell that the mesh is in */
    float height[KILN_SUN_MESH_CELLS]; /* its mean there times the cover, towards the sun, m */
};

/* Draws the map, unless it shows this mesh in this place and light already. */
void kiln_sun_mesh_update(struct kiln_sun_mesh *map, const struct kiln_mesh *mesh,
                          const struct kiln_draw_mesh *placed, const struct kiln_sun_frame *sun);

/* How much of the sun the mesh hides from a ball: 0 to 1. */
float kiln_sun_mesh_cover(const struct kiln_sun_mesh *map, struct kiln_ball ball);

#endif
