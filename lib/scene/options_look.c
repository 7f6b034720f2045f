/* This file has the option tables of what the particles of a system look like. */
#include "scene/rows.h"

#define AT(field) offsetof(struct kiln_look, field)

_Static_assert(AT(rows) == AT(columns) + sizeof(uint32_t), "cells are read as a pair");

static const char *const blends[] = {
    [KILN_BLEND_ALPHA] = "alpha",
    [KILN_BLEND_ADD] = "add",
    NULL,
};

static const char *const shapes[] = {
    [KILN_SHAPE_BILLBOARD] = "billboard", [KILN_SHAPE_POINT] = "point", [KILN_SHAPE_LINE] = "line",
    [KILN_SHAPE_SPHERE] = "sphere",       [KILN_SHAPE_MESH] = "mesh",   NULL,
};

static const char *const facings[] = {
    [KILN_FACING_SCREEN] = "screen",       [KILN_FACING_VIEWPLANE] = "viewplane",
    [KILN_FACING_VIEWPOINT] = "viewpoint", [KILN_FACING_AXIAL] = "axial",
    [KILN_FACING_VELOCITY] = "velocity",   NULL,
};

static const char *const line_ends[] = {
    [KILN_LINE_VELOCITY] = "velocity",
    [KILN_LINE_PREVIOUS] = "previous",
    NULL,
};

static const struct kiln_option point[] = {
    VALUE(LOOK, "size", point_size, KILN_PIXELS, 0, 10000, BOTH, "0 px",
          "Diameter in pixels; 0 takes the size in metres."),
    BOOLEAN(LOOK, "round", point_round, "true", "A disc; false is a square."),
    END,
};

static const struct kiln_option line[] = {
    VALUE(LOOK, "width", line_width, KILN_PIXELS, 0, 1000, BOTH, "1.5 px", "Width in pixels."),
    CHOICE(LOOK, "to", line_to, line_ends, "velocity",
           "velocity: back along it by the speed times stretch; previous: to where the particle "
           "was a frame ago."),
    END,
};

static const char *const orients[] = {
    [KILN_ORIENT_VELOCITY] = "velocity",
    [KILN_ORIENT_SPIN] = "spin",
    [KILN_ORIENT_UPRIGHT] = "upright",
    NULL,
};

static const struct kiln_option mesh[] = {
    {ROW(LOOK, "file", mesh, AT(mesh.file), "none",
         "Triangles in an OBJ, glTF or GLB file, z ahead and y up; its materials are left out. The "
         "longest edge of the box around it becomes the size.")},
    CHOICE(LOOK, "orient", mesh.orient, orients, "velocity",
           "velocity: ahead is where the particle goes, without a roll; spin: as collisions that "
           "spin have turned it, or else rotation and spin turn it about an axis drawn for each "
           "particle; upright: they turn it about the world's up."),
    END,
};

static const char *const patterns[] = {
    [KILN_PATTERN_PLAIN] = "plain",
    [KILN_PATTERN_STRIPE] = "stripe",
    [KILN_PATTERN_SEGMENTS] = "segments",
    NULL,
};

static const struct kiln_option sphere[] = {
    CHOICE(LOOK, "pattern", sphere.pattern, patterns, "plain",
           "stripe: look.color is a band about the equator; segments: it takes turns with the "
           "other colour, from pole to pole. Collisions that spin turn it; else rotation and spin "
           "do, about an axis drawn for each particle."),
    INTEGER(LOOK, "segments", sphere.segments, 1, 8, "3", "So many of each colour."),
    COLOR(LOOK, "color", sphere.color, 1000, BOTH, "1", "The other colour."),
    END,
};

static const char *const soft_formulas[] = {
    [KILN_SOFT_CLAMPED] = "clamped",
    [KILN_SOFT_LITERAL] = "literal",
    NULL,
};

static const char *const motions[] = {"auto", "none", NULL};

static const struct kiln_option fade[] = {
    VALUE(LOOK, "in", fade_in, KILN_FRACTION, 0, 1, TIME, "0.1",
          "Part of the life to full opacity."),
    VALUE(LOOK, "out", fade_out, KILN_FRACTION, 0, 1, TIME, "0.3",
          "Part of the life to vanish in."),
    END,
};

const struct kiln_option kiln_options_look[] = {
    {ROW(LOOK, "atlas", assets, AT(atlas), "\"builtin:smoke\"",
         "The texture: cells that play in order. Of several, each particle gets one."),
     .count_offset = AT(atlas_count), .max_count = KILN_MAX_TEXTURES},
    {ROW(LOOK, "cells", pair, AT(columns), "[8, 8]",
         "Columns and rows of an atlas file; a built-in atlas and a video have as many cells."),
     LIMITS(KILN_PLAIN, 1, 64)},
    {ROW(LOOK, "motion", motion, AT(motion), "auto",
         "An image of where each cell moves until the next (red right, green up, half is none), "
         "so that few cells play smoothly; auto: what built-in atlases know; none: cells mix."),
     .choices = motions},
    {ROW(LOOK, "motion_scale", number, AT(motion_scale), "1",
         "What full red or green of a motion file means, in edges of a cell."),
     LIMITS(KILN_PLAIN, 0, 10)},
    CHOICE(LOOK, "blend", blend, blends, "alpha",
           "alpha covers what is behind, like smoke; add shines through, like fire."),
    VALUE(IF_CONTACTS_ARE_AS_DRAWN, "size", size, KILN_METRES, 0, 1000, BOTH, "0.5 m",
          "Edge of the billboard."),
    RANGE(IF_CONTACTS_ARE_AS_DRAWN, "scale", scale, KILN_PLAIN, 0, 1000, TIME, "1",
          "Factor on size, drawn for each particle."),
    CHOICE(LOOK, "shape", shape, shapes, "billboard",
           "billboard: the texture on a quad; point, line: plain, without a texture; sphere, "
           "mesh: opaque, lit like the backdrop, scaled by opacity and fade."),
    CHOICE(LOOK, "facing", facing, facings, "screen",
           "A billboard is parallel to the picture and upright in it (screen), in the world "
           "(viewplane) or along its velocity; or turned to the eye, upright in the world "
           "(viewpoint) or about the axis (axial), which it never leaves."),
    VECTOR(LOOK, "axis", axis, KILN_PLAIN, -FAR, FAR, TIME, "[0, 1, 0]",
           "What axial billboards turn about; of any length but 0."),
    GROUP(LOOK, "point", 0, point, "How points look."),
    GROUP(LOOK, "line", 0, line, "How lines look."),
    GROUP(LOOK, "sphere", 0, sphere, "How spheres look."),
    GROUP(LOOK, "mesh", 0, mesh, "How meshes look, which are instances of one from a file."),
    VALUE(LOOK, "stretch", stretch, KILN_SECONDS, 0, 10, BOTH, "0 s",
          "Longer along the velocity by the speed times this; 0 keeps a billboard square."),
    RANGE(LOOK, "rotation", rotation, KILN_ANGLE, KILN_DEG(-3600), KILN_DEG(3600), BOTH,
          "[0 deg, 360 deg]", "Turn, drawn for each particle; spin comes on top."),
    RANGE(LOOK, "spin", spin, KILN_ANGULAR_SPEED, 0, KILN_DEG(36000), BOTH, "0 deg/s",
          "Speed of turning, drawn for each particle, to either side."),
    VALUE(LOOK, "cycles", cycles, KILN_PLAIN, 0, 1000, TIME, "1",
          "Passes through the atlas in a life."),
    BOOLEAN(LOOK, "random_start", random_start, "false",
            "Each particle starts at a cell of its own."),
    COLOR(IF_IT_PAINTS, "color", color, 1000, BOTH, "1", "Multiplies the atlas or the glow."),
    VALUE(LOOK, "opacity", opacity, KILN_FRACTION, 0, 1, BOTH, "1",
          "Multiplies the atlas's alpha."),
    VALUE(LOOK, "temperature", temperature, KILN_KELVIN, 0, 20000, BOTH, "0 K",
          "Glows with the colour of a black body; 0 does not."),
    VALUE(LOOK, "intensity", intensity, KILN_PLAIN, 0, 1000000, BOTH, "1",
          "Factor on emitted light."),
    GROUP(LOOK, "fade", 0, fade, "Opacity at birth and death."),
    VALUE(LOOK, "soft", soft, KILN_PER_METRE, 0, 1000, BOTH, "2",
          "Fades where it nears a surface, the faster the larger; 0 is hard."),
    CHOICE(LOOK, "soft_formula", soft_formula, soft_formulas, "clamped",
           "clamped to 0..1; or literal, as the thesis prints equation 3.3: without a bound."),
    VALUE(LOOK, "thickness", thickness, KILN_PLAIN, 0, 10, BOTH, "1",
          "Depth of a billboard in parts of its size, where post.compose is oit: 1 is as deep as "
          "wide, like a puff; 0 is flat."),
    VALUE(LOOK, "near_fade", near_fade, KILN_METRES, 0, 1000, BOTH, "0.2 m",
          "Transparent when this near to the camera's near plane."),
    COLOR(LOOK, "bloom", bloom, 100, BOTH, "0", "Part of the colour that goes to the bloom."),
    VALUE(LOOK, "lit", lit, KILN_FRACTION, 0, 1, BOTH, "0",
          "0 shows its own colour, 1 is lit by sun, sky and lights."),
    VALUE(LOOK, "shadow", shadow, KILN_PLAIN, 0, 100, TIME, "1",
          "Of what covers: factor on the light that it keeps off itself and what is behind it."),
    COLOR(LOOK, "light", light, 1000000, TIME, "0",
          "Factor on the light that what glows sheds on backdrop and smoke; 1 is what it amounts "
          "to."),
    INTEGER(LOOK, "lights", light_count, 1, KILN_MAX_FIRE_LIGHTS, "4",
            "Moving lights that shed it, by the particles' ages; a scene has up to 16 in all."),
    END,
};
