/* Declares a uniform block with the parts of the backdrop other than sky, floor and axis-aligned
 * boxes, laid out like the blocks of draw_layout.h. Scenes without such parts use shaders without
 * it. */
#ifndef KILN_SHARED_SHAPE_LAYOUT_H
#define KILN_SHARED_SHAPE_LAYOUT_H

#include "shared/limits.h"
#include "shared/platform.h"
#include "shared/sun_edges.h"

#define KILN_BIND_SHAPES 4 /* a uniform block */

/* Texture units of the backdrop. */
#define KILN_UNIT_SURFACES    0
#define KILN_UNIT_MESH_HITS   1 /* hits of a pixel's rays: centre, then samples */
#define KILN_UNIT_FLOOR       3
#define KILN_UNIT_SKY         6 /* units 4 and 5 are those of smoke */
#define KILN_UNIT_MESH_SHADOW 7 /* a layer for each mesh, as the sun sees it */
#define KILN_UNIT_SOLID_BINS  8 /* bins of solid particles */
#define KILN_UNIT_SOLID_LIST  9
#define KILN_UNIT_MESH_PAINT  11 /* a layer a mesh with paint; 10: draw_layout.h */
#define KILN_UNIT_SOLID_TILES 13 /* particles that are meshes; 12: tiled_layout.h */
#define KILN_UNIT_SILHOUETTES 14

/* Rays of a pixel at an edge: a rotated grid, in which no two share a row or a column. */
#define KILN_EDGE_SAMPLES 4
#define KILN_EDGE_OFFSETS(pair)                                                                    \
    pair(0.375f, 0.125f), pair(0.875f, 0.375f), pair(0.125f, 0.625f), pair(0.625f, 0.875f)

#define KILN_WAVES 8 /* number of waves of water on the floor */

/* Numbers of surfaces that a ray hits. The sky has -1, the floor 0. A box has 27 numbers, one for
 * each face (ray_face_number is added to the middle one), a cylinder one for its side and one for
 * each end, a mesh 4. */
#define KILN_SURFACE_BOX(first, i) ((first) + 14 + 27 * (i))
#define KILN_SURFACE_BOXES         0
#define KILN_SURFACE_SPHERES       1000
#define KILN_SURFACE_CYLINDERS     1100
#define KILN_SURFACE_ORIENTED      1200
#define KILN_SURFACE_CAPSULES      2200
#define KILN_SURFACE_PLANES        2250
#define KILN_SURFACE_MESHES        2300

/* Edge of a mesh's shadow map, texels; a mesh fills all of them but a border. */
#define KILN_SHADOW_EDGE   1024
#define KILN_SHADOW_MARGIN 0.01f /* border, as a part of the half edge */

/* Sizes of the shadow lists of solid particles: the most bins along each edge, and entries in a row
 * of the lists' texture. A shadow ends where the penumbra is this many times as wide as the
 * sphere. */
#define KILN_SOLID_BINS       128
#define KILN_SOLID_ROW        1024
#define KILN_SOLID_FADE       16.0f
#define KILN_SOLIDS_AT_A_TIME 4 /* entries of a list that shaders read at once */

/* Sizes of the shadow tiles of particles that are meshes: the edge of an atlas in texels, which has
 * levels of half the size down to the one in which the largest tile is one texel
 * (lib/draw/light/instance_tiles.h). Up to SHARP times the mesh's reach, the radius of the sun's
 * blur leaves the silhouette; from ROUND times on, the mesh throws the shadow of a sphere. */
#define KILN_INSTANCE_ATLAS  2048
#define KILN_INSTANCE_LEVELS 7
#define KILN_INSTANCE_SHARP  0.3f
#define KILN_INSTANCE_ROUND  0.7f

struct kiln_draw_mesh {
    float4 to_world[3]; /* rows */
    /* w: 1 + the mesh's layer of the textures of paint, plus 16 times the first level of its paint;
     * 0: the mesh takes no paint */
    float4 color;
    float4 center; /* centre of its bounds in the world, m; w: radius of the sphere around them */
    /* half of the bounds, m; w: time of its animation, s, by which pictures and maps of the mesh at
     * different times are told apart */
    float4 half_size;
};

/* A box that does not lie along the axes. */
struct kiln_draw_oriented_box {
    float4 center;
    float4 rows[3]; /* axes of the world in its frame */
    float4 half_size;
    float4 color;
};

struct kiln_draw_shapes {
    uint4 counts;           /* spheres, cylinders, meshes; bins of particles along an edge, or 0 */
    uint4 oriented_counts;  /* capsules, oriented boxes, planes; unused */
    float4 sun_right;       /* unit, across the sun's direction; w: tangent of the sun's radius */
    float4 sun_up;          /* unit, across sun_right and the sun's direction */
    float4 world_to_bin[2]; /* rows: world positions to bins of particles */
    float4 floor_map;       /* repetitions a metre in x and z, texels a metre in x; unused */
    float4 floor_gloss;     /* factor; roughness; slope of each wave; unused */
    /* Direction in x and z, unit; 2 pi / length, 1/m; phase at the origin, rad. */
    float4 waves[KILN_WAVES];
    float4 wave_shift[KILN_WAVES];    /* how far each shifts those after it in x and z, m; unused */
    float4 sky_map;                   /* turn, parts of a circle; factor; texels a radian; unused */
    float4 spheres[KILN_MAX_OBJECTS]; /* centre; w: radius */
    float4 sphere_color[KILN_MAX_OBJECTS];
    float4 cylinders[KILN_MAX_OBJECTS];     /* centre; w: radius */
    float4 cylinder_axis[KILN_MAX_OBJECTS]; /* unit; w: half of the height */
    float4 cylinder_color[KILN_MAX_OBJECTS];
    S(kiln_draw_mesh) meshes[KILN_MAX_MESHES];
    float4 capsules[KILN_MAX_OBJECTS];     /* centre; w: radius */
    float4 capsule_axis[KILN_MAX_OBJECTS]; /* unit; w: half of the height without the ends */
    float4 capsule_color[KILN_MAX_OBJECTS];
    float4 planes[KILN_MAX_OBJECTS]; /* unit normal; w: distance from the origin along it */
    float4 plane_color[KILN_MAX_OBJECTS];
    S(kiln_draw_oriented_box) oriented_boxes[KILN_MAX_OBJECTS];
    S(sun_edges) edges; /* of boxes along the axes */
    S(sun_edges) oriented_edges[KILN_MAX_OBJECTS];
    S(sun_band) bands[KILN_MAX_OBJECTS]; /* of cylinders */
};

#endif
