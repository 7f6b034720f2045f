/* Declares the uniform blocks that the drawing stages read, for C and GLSL. Every member is 16
 * bytes or a group of 16, so that std140 and C agree on the offsets. */
#ifndef KILN_SHARED_DRAW_LAYOUT_H
#define KILN_SHARED_DRAW_LAYOUT_H

#include "shared/limits.h"
#include "shared/platform.h"

/* Binding points of uniform blocks (VIEW to BACKDROP) and storage blocks (RECORDS to SPINS). */
#define KILN_BIND_VIEW     0
#define KILN_BIND_LOOKS    1
#define KILN_BIND_KEYS     2
#define KILN_BIND_BACKDROP 3
#define KILN_BIND_RECORDS  0
#define KILN_BIND_ENTRIES  1
#define KILN_BIND_CORNERS  2
#define KILN_BIND_SPINS    3

/* Texture units of several stages that draw particles. */
#define KILN_UNIT_LOOK_TABLE   0
#define KILN_UNIT_ATLAS        1
#define KILN_UNIT_SCENE_DEPTH  2
#define KILN_UNIT_ATLAS_MOTION 3
#define KILN_UNIT_SMOKE_SUN    4 /* depths of smoke towards the sun */
#define KILN_UNIT_SMOKE_SKY    5

/* Storage blocks of the kernel that computes particles within a step (shared/between.h): before the
 * step, after it, and at the time within it. The host binds each three as a row. */
#define BETWEEN_BIND_BEFORE       0
#define BETWEEN_BIND_AFTER        1
#define BETWEEN_BIND_BETWEEN      2
#define BETWEEN_BIND_SPIN_BEFORE  3
#define BETWEEN_BIND_SPIN_AFTER   4
#define BETWEEN_BIND_SPIN_BETWEEN 5

/* Locations of uniforms of this kernel. */
#define BETWEEN_AT_SYSTEM     0
#define BETWEEN_AT_BASE       1
#define BETWEEN_AT_USED       2
#define BETWEEN_AT_STEP       3
#define BETWEEN_AT_BACK       4
#define BETWEEN_AT_FIRST_SPIN 5

/* A storage block, and locations of uniforms, of the kernel that counts hidden particles. */
#define OCCLUSION_BIND_HIDDEN 2
#define OCCLUSION_AT_COUNT    0
#define OCCLUSION_AT_SPACING  1

/* Edge in pixels of the tiles in which the backdrop is antialiased. */
#define KILN_EDGE_TILE 8

/* The location of the uniform of the backdrop's program that says which of its passes runs. */
#define BACKDROP_AT_EDGES 0

/* Edges are found by a number of each pixel: four times that of the surface at its centre, plus the
 * part of the light that it gets, -1 to 1; with KILN_EDGE_MARK added where its samples show that
 * it is at an edge inside a mesh. Marks aside, the threshold is the greatest difference between
 * neighbours that is no edge. Light changes by this much a pixel in a penumbra four pixels wide. */
#define KILN_EDGE_THRESHOLD  0.25f
#define KILN_EDGE_MOST_LIGHT 2.0f /* the greatest difference on one surface */
#define KILN_EDGE_MARK       32768.0f

/* The samples of a pixel that lie on one smooth piece of surface share a colour. The least cosine
 * between normals on such a piece, and how far its points may lie off its plane, as a part of their
 * distance from each other. */
#define KILN_PIECE_COSINE 0.995f
#define KILN_PIECE_SLOPE  0.15f

/* Edge in pixels of an atlas's cells. */
#define KILN_ATLAS_CELL 128

/* Texels of a cell's strip. A long thin billboard shows it (billboard_shows_strip): a texel is the
 * mean of an eighth of the cell, from its top to its bottom. The level of detail that stands for
 * it is behind those of the cell. */
#define KILN_ATLAS_STRIP 8
#define KILN_STRIP_LEVEL 8

/* The texture unit of the strips. */
#define KILN_UNIT_STRIPS 19

/* Least edge in pixels of a billboard in a picture smaller than the frame; a smaller one would
 * flicker. */
#define KILN_COARSE_LEAST 1.5f

/* The most textures of the particles of a system. */
#define KILN_MAX_TEXTURES 8

/* Kinds of cells of an atlas. */
#define KILN_CELL_MASK  0u /* normal x, y, heat, density: coloured by the look */
#define KILN_CELL_COLOR 1u /* premultiplied colour under a square root: tinted by the look */
#define KILN_CELL_PLAIN 2u /* no texture: a rectangle... */
#define KILN_CELL_DISC  3u /* ...or a disc, whose edges are as sharp as pixels allow */

/* The texture unit of the colours of what particles are born on (shared/source.h). */
#define KILN_UNIT_SOURCES 20

/* The part of the sun that each particle sees past the backdrop (lib/draw/light/sun_shade.h), by
 * its slot: a texture unit, and the slots in a row of the texture. */
#define KILN_UNIT_SUN_SHADE 10
#define KILN_SUN_SHADE_ROW  1024

/* The parts of the lamps that each particle sees past the backdrop
 * (lib/draw/light/lamp_shade.h), in rows as for the sun: a texture unit. */
#define KILN_UNIT_LAMP_SHADE 17

/* Maps of the smoke around lamps (shared/lamp_smoke.h): a texture unit; texels along an edge of a
 * face; texels of a layer, which has six faces in two rows; layers of a map. */
#define KILN_UNIT_LAMP_SMOKE   16
#define KILN_LAMP_SMOKE_FACE   16
#define KILN_LAMP_SMOKE_WIDTH  (3 * KILN_LAMP_SMOKE_FACE)
#define KILN_LAMP_SMOKE_HEIGHT (2 * KILN_LAMP_SMOKE_FACE)
#define KILN_LAMP_SMOKE_LAYERS 24

/* The camera of a frame. World axes: metres, y up, right-handed; a view looks along its -z. Pixels
 * count from the top left corner, so y points down in clip space. */
struct kiln_view {
    float4 world_to_view[3]; /* rows */
    float4 eye;              /* world position, m; w: near plane, m */
    float4 frustum;          /* tan of half the field, x and y; width, height of the image, px */
    /* clip time, s; duration of a step, s; of a frame, s; picture's width as a part of the
     * frame's */
    float4 clock;
    uint4 clock_step; /* number of steps; seed; unused; unused */
    float4 within;    /* from the moment to the end of these steps, in steps; unused */
    float4 exposure;  /* what the composite multiplies light by; unused */
    /* The principal point, where the line of sight meets the picture: px from the top left, and the
     * tangents of its angles to the right of and above the picture's middle. */
    float4 principal;
};

/* Kinds of lamps (shared/lamp.h). */
#define KILN_LAMP_POINT     0.0f
#define KILN_LAMP_SPOT      1.0f
#define KILN_LAMP_RECTANGLE 2.0f

/* Returns whether a lamp is a rectangle. A shader defines NO_RECTANGLES where its scene has none.
 */
#ifdef NO_RECTANGLES
#define LAMP_IS_RECTANGLE(lamp) false
#else
#define LAMP_IS_RECTANGLE(lamp) ((lamp).facing.w == KILN_LAMP_RECTANGLE)
#endif

/* Bit of `casters.w` of a lamp whose light smoke does not dim. */
#define KILN_LAMP_THROUGH_SMOKE 4u

/* Bit of `casters.y` of a lamp at which the number of its maps of solids begins. */
#define KILN_LAMP_SOLID_SHIFT 8

/* A lamp, or a part of the light of fire. A rectangle has the radius of a disc of its area. */
struct kiln_draw_light {
    float4 position_radius2; /* m, m^2 */
    float4 color; /* radiance of a white surface 1 m in front, far from the lamp; w: radius, m */
    /* x: 1 if shapes may hide the light; y: 1 + number of its
     * shadow maps of meshes, and from KILN_LAMP_SOLID_SHIFT on that of its maps of solid particles;
     * z: 1 + number of its map of smoke; for all three, 0: none; w: 1: it may be hidden; 3:
     * particles have their part; with KILN_LAMP_THROUGH_SMOKE, objects alone may hide it */
    uint4 casters;
    /* A bit for each shape of kiln_draw_shapes that may hide the light. */
    uint4 hiders[KILN_MAX_OBJECTS / 128];
    /* Distance that the shadow maps of meshes reach, m; distance of the first layer of the map of
     * smoke, m; layers of it that double the distance; reach of the maps of solids, m. */
    float4 maps;
    float4 smoke_ahead, smoke_right; /* of the map of smoke (shared/lamp_smoke.h) */
    float4 facing;                   /* unit, where a spot or a rectangle shines; w: KILN_LAMP_* */
    float4 right; /* from a rectangle's centre to its side, m; w: cosine of a spot's outer cone */
    float4 up;    /* to its upper edge, m; w: 1 / (cosine of the inner cone - of the outer) */
};

/* The most lights of a picture: lamps of the scene, and those of fire. */
#define KILN_MOST_LAMPS (KILN_MAX_LIGHTS + KILN_MAX_FIRE_LIGHTS)

/* The directions in which the haze of a sky that is a picture has colours of their own. */
#define KILN_HAZE_PARTS 32

/* Sky, floor, sun and lights. */
struct kiln_draw_backdrop {
    float4 sky_top;       /* w: brightness of the sun's disc, in parts of its colour */
    float4 sky_horizon;   /* w: that of the glow around the sun */
    float4 floor_color;   /* w: height, m */
    float4 floor_params;  /* 1 if there is a floor; edge of its squares, m; haze, 1/m; sky_glow */
    float4 sun_direction; /* unit, towards the sun; w: radius of its disc: sky_disc */
    float4 sun_color;     /* irradiance; w: 1 if each particle has a value of shade, or 0 */
    /* 1 if the haze has the colours below, or 0 if it has that of sky_horizon; lights; 1 if the
     * background is transparent; 1 if there is smoke in the grids */
    uint4 counts;
    S(kiln_draw_light) lights[KILN_MOST_LAMPS];
    float4 sun_to_grid[3]; /* rows: world positions to the grids of smoke (smoke_shadow.glsl) */
    float4 sky_to_grid[3];
    float4 haze[KILN_HAZE_PARTS]; /* without the sun's glow: shared/haze.h */
};

#endif
