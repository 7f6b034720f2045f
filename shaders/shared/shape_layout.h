/* Declares what shaders of the backdrop share with the C code that feeds them: the texture units,
 * the numbers of surfaces, the sizes of shadow maps, and the uniform block kiln_draw_shapes: the
 * backdrop's objects, the sun's frame, and the floor's and the sky's images, gloss and waves.
 * lib/draw/moment/shapes.h fills it in. */
#ifndef KILN_SHARED_SHAPE_LAYOUT_H
#define KILN_SHARED_SHAPE_LAYOUT_H

#include "shared/limits.h"
#include "shared/platform.h"

/* The uniform block of shapes, and the storage block that has all shapes of a scene with more than
 * KILN_BLOCK_SHAPES (SHAPES_STORED). Solid particles are sorted after the backdrop is drawn, and
 * their shaders still read the storage block, so its binding point is none of the sort's. */
#define KILN_BIND_SHAPES        4
#define KILN_BIND_STORED_SHAPES 7
#define KILN_BLOCK_SHAPES       32

/* Texture units of the backdrop. Those that other stages use, too, are in draw_layout.h, 12 is in
 * tiled_layout.h. */
#define KILN_UNIT_SURFACES    0
#define KILN_UNIT_MESH_HITS   1 /* hits of a pixel's rays: centre, then samples */
#define KILN_UNIT_FLOOR       3
#define KILN_UNIT_SKY         6
#define KILN_UNIT_MESH_SHADOW 7  /* a layer for each mesh, as the sun sees it */
#define KILN_UNIT_SOLID_BINS  8  /* for each bin: first entry and count in the list */
#define KILN_UNIT_SOLID_LIST  9  /* the solid particles of all bins */
#define KILN_UNIT_MESH_PAINT  11 /* a layer for each mesh with paint */
#define KILN_UNIT_SOLID_TILES 13 /* for each entry of the list: its tile, if it is a mesh */
#define KILN_UNIT_SILHOUETTES 14 /* the atlas of tiles */
#define KILN_UNIT_LAMP_MAPS   15 /* six layers for each lamp that meshes may hide */
#define KILN_UNIT_LAMP_SOLIDS 18 /* six layers for each lamp that solid particles may hide */

/* Rays of a pixel at the edge of a surface. They are a rotated grid, in which no two share a row or
 * a column. KILN_EDGE_OFFSETS lists their places in the pixel; `pair` makes a value of two numbers.
 */
#define KILN_EDGE_SAMPLES 4
#define KILN_EDGE_OFFSETS(pair)                                                                    \
    pair(0.375f, 0.125f), pair(0.875f, 0.375f), pair(0.125f, 0.625f), pair(0.625f, 0.875f)

#define KILN_WAVES 8 /* number of waves of water on the floor */

/* Numbers of surfaces that a ray hits; pixels with different numbers have an edge between them. The
 * sky has -1, the floor 0. Shape i has KILN_SURFACE_SHAPE(i), to which the number of its face is
 * added (struct shape_face of shape.h). A mesh has one number out of 4. */
#define KILN_FACE_LEAST       -4
#define KILN_FACE_MOST        4
#define KILN_SURFACE_SHAPE(i) (5 + 9 * (i))
/* Returns the number of the first mesh in a scene of `count` shapes. */
#define KILN_SURFACE_MESHES(count)                                                                 \
    KILN_SURFACE_SHAPE((count) > KILN_BLOCK_SHAPES ? (count) : KILN_BLOCK_SHAPES)

/* Edge of a mesh's shadow map, texels; a mesh fills all of them but a border. */
#define KILN_SHADOW_EDGE   1024
#define KILN_SHADOW_MARGIN 0.01f /* border, as a part of the half edge */

/* Edge of the six shadow maps of a lamp, texels; and the tangent that a map shows to each side of
 * its axis, of which 1 would be a face of a cube. */
#define KILN_LAMP_EDGE  256
#define KILN_LAMP_RANGE 1.25f

/* Shadows of solid particles. The particles are listed in bins across the sun's direction. */
#define KILN_SOLID_BINS 128  /* the most bins along an edge of their square */
#define KILN_SOLID_ROW  1024 /* entries in a row of the texture of the lists */
/* A particle's shadow ends where the penumbra is this many times as wide as its sphere. */
#define KILN_SOLID_FADE       16.0f
#define KILN_SOLIDS_AT_A_TIME 4 /* entries of a list that shaders read at once */

/* Shadows of solid particles that are meshes. Each has a tile of an atlas with its silhouette
 * (lib/draw/light/instance_tiles.h). */
#define KILN_INSTANCE_ATLAS  2048 /* edge of the atlas, texels */
#define KILN_INSTANCE_LEVELS 7    /* mip levels; in the last one the largest tile is one texel */
/* The radius of the sun's penumbra decides, in parts of the radius of the mesh: up to SHARP the
 * shadow has the mesh's silhouette, from ROUND on it is a sphere's, and in between the two are
 * mixed. */
#define KILN_INSTANCE_SHARP 0.3f
#define KILN_INSTANCE_ROUND 0.7f

/* The paint of a mesh is one number: 1 + its layer of the textures of paint, plus KILN_PAINT_LAYERS
 * times the finest mip level that it has there; 0: the mesh takes no paint. */
#define KILN_PAINT_LAYERS       128
#define KILN_PAINT_LAYER(paint) (INT(paint) % KILN_PAINT_LAYERS - 1)
#define KILN_PAINT_LEVEL(paint) (INT(paint) / KILN_PAINT_LAYERS)

struct kiln_draw_mesh {
    float4 to_world[3]; /* rows */
    float4 color;       /* w: paint */
    float4 center; /* centre of its bounds in the world, m; w: radius of the sphere around them */
    /* half of the bounds, m; w: time of its animation, s. Shaders do not read the time; the host
     * compares it to see whether pictures and maps of the mesh still hold. */
    float4 half_size;
};

/* Kinds of shapes (shared/shapes.h). A sphere is a capsule of no height. */
#define SHAPE_BOX      0u
#define SHAPE_CYLINDER 1u
#define SHAPE_CAPSULE  2u
#define SHAPE_PLANE    3u
#define SHAPE_CONE     4u
#define SHAPE_KINDS    5u

/* Words of four numbers with one for each kind and one more. */
#define KILN_SHAPE_FIRSTS 2

/* A shape of the backdrop. Its frame has its axis along y. */
struct kiln_draw_shape {
    float4 center;  /* m; w: radius of its bounding sphere, m */
    float4 extent;  /* half of its size along the axes of its frame, m; w: radius around its axis */
    float4 rows[3]; /* unit vectors along the axes of its frame */
    float4 color;
    uint4 kind; /* SHAPE_*; 1 if vectors must be turned into its frame, else 0; unused */
};

struct kiln_draw_shapes {
    uint4 counts; /* shapes; number of the first mesh as a surface; meshes; bins of solids along an
                     edge, or 0 */
    float4 sun_right;       /* unit, across the sun's direction; w: tangent of the sun's radius */
    float4 sun_up;          /* unit, across sun_right and the sun's direction */
    float4 world_to_bin[2]; /* rows: world positions to bins of particles */
    float4 floor_map;       /* repetitions per metre in x and z, texels per metre in x; w: unused */
    float4 floor_gloss;     /* reflection's factor; squared roughness; slope of each wave; unused */
    /* Direction in x and z, unit; 2 pi / length, 1/m; phase at the origin, rad. */
    float4 waves[KILN_WAVES];
    float4 wave_shift[KILN_WAVES]; /* x, y: how far each wave shifts the later ones in x and z, m */
    float4 sky_map; /* turn, parts of a circle; brightness factor; texels per radian; unused */
    S(kiln_draw_mesh) meshes[KILN_MAX_MESHES];
    /* Shapes in the order of their kinds; by kind, the first one, and after the last kind the end.
     */
    uint4 first[KILN_SHAPE_FIRSTS];
#ifdef GL_core_profile
    S(kiln_draw_shape) shapes[KILN_BLOCK_SHAPES];
#else
    S(kiln_draw_shape) shapes[KILN_MAX_OBJECTS];
#endif
};

/* Returns where the shapes of a kind begin, in GLSL. */
#define KILN_SHAPES_FROM(kind) int(shapes.first[(kind) >> 2u][(kind)&3u])

#endif
