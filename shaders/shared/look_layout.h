/* Declares the looks of the systems for drawing: a uniform block, and a table of all values that
 * may vary over life, sampled evenly from birth to death. The host makes the table for each frame
 * in which it changes. So shaders evaluate no keys (whose many inlined loops take compilers
 * minutes), and every rasteriser reads the same numbers. */
#ifndef KILN_SHARED_LOOK_LAYOUT_H
#define KILN_SHARED_LOOK_LAYOUT_H

#include "shared/draw_layout.h"
#include "shared/layout.h"

/* Samples over life. A key between two samples is smoothed over a 127th of the life. */
#define KILN_LOOK_SAMPLES 128

/* Rows of a system's part of the table: one RGBA texel a sample. */
#define KILN_LOOK_SHAPE  0 /* size, m; stretch, s; opacity with fades; soft fade, 1/m */
#define KILN_LOOK_COVER  1 /* colour that covers, rgb; lit */
#define KILN_LOOK_HOT    2 /* light emitted where a cell's heat is 1, rgb; near fade, m */
#define KILN_LOOK_COOL   3 /* light emitted where the heat is 0, rgb; passes through the atlas */
#define KILN_LOOK_BLOOM  4 /* bloom weights, rgb; thickness in units of the size */
#define KILN_LOOK_SPREAD 5 /* scale, least and most; mean spin so far, least and most, rad/s */
#define KILN_LOOK_TURN   6 /* rotation, least and most, rad; point, line width, px */
#define KILN_LOOK_AXIS   7 /* axis or normal, unit vector in the world; unused */
#define KILN_LOOK_OTHER  8 /* second colour of a sphere's pattern, rgb; lit */
#define KILN_LOOK_FORM   9 /* factors on size across and along; unused. Read if LOOK_FORMED */
#define KILN_LOOK_ROWS   10

/* Values over other clocks than life lie behind the rows of all systems
 * (lib/draw/moment/look_values.h). A system that has some has two rows with the texels below, and
 * rows of samples.
 *
 *    texel r     of row r of the look, KILN_LOOK_*: the first of its values; how many it has
 *    LOOK_VALUE_TEXEL(v), the values; each has LOOK_VALUE_TEXELS:
 *       +0         bit mask of the components that it multiplies; bit mask of its parts; row of
 *                  light or 0
 *       +1         least and greatest result; first x of the row of light; samples for each 1 of x
 *       +2 + 2 p   part p: clock + 16 times LOOK_PART_*; draw; row; number of steps, or octaves
 *       +3 + 2 p   first x; samples for each 1 of x; length of a repetition; period of a noise, s
 */
#define LOOK_VALUE_TEXELS    8
#define LOOK_VALUE_TEXEL(v)  (16 + (v)*LOOK_VALUE_TEXELS)
#define LOOK_PROGRAM_ROWS    2
#define LOOK_PART_STEPS      1u /* each texel holds until the x of the next, which its w has */
#define LOOK_PART_LOOPS      2u
#define LOOK_PART_MIRRORS    4u
#define LOOK_PART_PARENT     8u /* its clock is that of the parent at the particle's birth */
#define LOOK_PART_FLAG_SHIFT 4u

/* The clock of a part that is the colour of what the particle was born on (shared/source.h): its
 * row is the first texel of the source, and its number of octaves that of the source's cells. */
#define LOOK_CLOCK_SOURCE 15u

/* enum kiln_shape and enum kiln_facing of the scene. */
#define LOOK_POINT     1u
#define LOOK_LINE      2u
#define LOOK_MESH      4u
#define LOOK_RIBBON    5u
#define LOOK_SCREEN    0u
#define LOOK_VIEWPOINT 2u
#define LOOK_AXIAL     3u
#define LOOK_VELOCITY  4u
#define LOOK_SURFACE   5u
#define LOOK_NORMAL    6u

/* Bits of `flags.y` of a look. */
#define LOOK_RANDOM_START 1u /* each particle starts at a cell of its own */
#define LOOK_UNMIRRORED   2u /* no billboard is mirrored */
#define LOOK_FORMED       4u /* billboards are not as long as wide: KILN_LOOK_FORM */

/* Patterns of spheres: none, a stripe, or segments of each colour. */
#define LOOK_PLAIN    0u
#define LOOK_STRIPE   1u
#define LOOK_SEGMENTS 2u /* plus the number of segments */

/* The slots of the children of one parent, and the parent's system, in `values.w` of a look. */
#define LOOK_PARENT_SLOTS(word)  ((word)&0x3ffffffu)
#define LOOK_PARENT_SYSTEM(word) ((word) >> 26u)
/* Returns the record of the parent of a particle, among those of all systems. */
#define LOOK_PARENT_RECORD(values, serial)                                                         \
    ((values).y + (serial) / LOOK_PARENT_SLOTS((values).w) % (values).z)

/* Parts of the words of `ribbon`. Rows of the table have other numbers of ribbons where those of
 * billboards are: KILN_LOOK_SHAPE the longest segment, m, or 0, in place of the stretch;
 * KILN_LOOK_TURN the factors on the width at the tail and at the head, and textures a metre or 0.
 */
#define LOOK_RIBBON_SLOT(word)  ((word)&0x3ffffffu)
#define LOOK_RIBBON_PARTS(word) (((word) >> 26u) + 1u)
#define LOOK_RIBBON_NORMAL      0x04000000u /* the face is turned to the axis, not to the eye */
#define LOOK_RIBBON_COUNTED     0x08000000u /* places are counted, and do not follow from ages */
#define LOOK_RIBBON_JOINS       0x10000000u /* the youngest particle is joined to its parent */

/* The part of a look that is the same at any age. */
struct kiln_draw_look {
    S(kiln_derived_params) derived; /* parameters for the progress of life */
    uint4 flags;  /* additive; LOOK_* bits; literal soft formula (equation 3.3); textures */
    uint4 form;   /* LOOK_* shape; LOOK_* facing; points are round; lines reach back a frame, or */
                  /* a stretch dims billboards */
    uint4 values; /* row of the table in which the values over other clocks begin; 0: none; of a */
                  /* system that inherits values: first record and capacity of the parent's */
                  /* system; slots of one parent's children + the parent's system << 26 */
    uint4 turn;   /* 1: collisions turn it; offset of its slots to those of spins; pattern of */
                  /* spheres, LOOK_*; 1: a mesh is oriented by its spin */
    uint4 ribbon; /* first record of the system + (parts of a segment - 1) << 26; capacity of the */
                  /* system + LOOK_RIBBON_*; serials of a ribbon, or 0; 2^32 textures from one */
                  /* particle to the next, or 0 */
    uint4 textures[KILN_MAX_TEXTURES]; /* first layer; cells; KILN_CELL_*; bits of the float that */
                                       /* scales the motion */
};

#endif
