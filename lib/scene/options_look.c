/* This file has the tables of the options `look` of a system in a scene: how its particles look.
 * options_emit.c includes them in the table of a system; the parser of scenes, `kiln help scene`
 * and the schema read them. Each row says whether the option changes pixels alone (LOOK) or, under
 * a condition, the motion as well (IF_..., see parts.h), and over which clocks a value may vary
 * (scene/rows.h). */
#include "scene/rows.h"

#define FILLS struct kiln_look

static const char *const blends[] = {
    [KILN_BLEND_ALPHA] = "alpha",
    [KILN_BLEND_ADD] = "add",
    NULL,
};

static const char *const shapes[] = {
    [KILN_SHAPE_BILLBOARD] = "billboard",
    [KILN_SHAPE_POINT] = "point",
    [KILN_SHAPE_LINE] = "line",
    [KILN_SHAPE_SPHERE] = "sphere",
    [KILN_SHAPE_MESH] = "mesh",
    [KILN_SHAPE_RIBBON] = "ribbon",
    NULL,
};

static const char *const ribbon_facings[] = {
    [KILN_RIBBON_CAMERA] = "camera",
    [KILN_RIBBON_NORMAL] = "normal",
    NULL,
};

static const char *const facings[] = {
    [KILN_FACING_SCREEN] = "screen",
    [KILN_FACING_VIEWPLANE] = "viewplane",
    [KILN_FACING_VIEWPOINT] = "viewpoint",
    [KILN_FACING_AXIAL] = "axial",
    [KILN_FACING_VELOCITY] = "velocity",
    [KILN_FACING_SURFACE] = "surface",
    NULL,
};

#undef FILLS
#define FILLS struct kiln_look_facing

TABLE(facing_rows) = {
    VECTOR(LOOK, "normal", normal, KILN_PLAIN, -FAR, FAR, TIME(110), NULL,
           "Normal of the plane in the world that billboards lie in, of any length but 0: "
           "[0, 1, 0] is the ground's."),
    END,
};

#undef FILLS
#define FILLS struct kiln_look

static const char *const line_ends[] = {
    [KILN_LINE_VELOCITY] = "velocity",
    [KILN_LINE_PREVIOUS] = "previous",
    NULL,
};

TABLE(point) = {
    VALUE(
        LOOK, "size", point_size, KILN_PIXELS, 0, 10000, DRAWN(23), "0 px",
        "Diameter of a point in pixels; 0 uses look.size, in metres. A point of less than a pixel "
        "is drawn a pixel wide, and fainter."),
    BOOLEAN(LOOK, "round", point_round, "true", "true draws a disc, false a square."),
    END,
};

TABLE(line) = {
    VALUE(LOOK, "width", line_width, KILN_PIXELS, 0, 1000, DRAWN(24), "1.5 px",
          "Width of a line in pixels. A line of less than a pixel is drawn a pixel wide, and "
          "fainter."),
    CHOICE(LOOK, "to", line_to, line_ends, "velocity",
           "The far end of a line. `velocity` puts it behind the particle, along the velocity, by "
           "the speed times look.stretch. `previous` puts it where the particle was a frame ago."),
    END,
};

static const char *const orients[] = {
    [KILN_ORIENT_VELOCITY] = "velocity",
    [KILN_ORIENT_SPIN] = "spin",
    [KILN_ORIENT_UPRIGHT] = "upright",
    NULL,
};

TABLE(mesh) = {
    {ROW(LOOK, "file", mesh, mesh.file, "none",
         "An OBJ, glTF, GLB, PLY or STL file of triangles, z ahead and y up. Its materials are not "
         "drawn. The longest edge of its bounding box is scaled to the size.")},
    CHOICE(LOOK, "orient", mesh.orient, orients, "velocity",
           "`velocity` turns the z axis of the mesh to the direction of flight, without a roll. "
           "`spin` turns the mesh as collisions have turned the particle, where they do "
           "(collide.spin of an interaction); elsewhere look.rotation and look.spin turn it about "
           "an axis chosen at random for each particle. `upright` turns it by look.rotation and "
           "look.spin about the world's y axis."),
    END,
};

static const char *const patterns[] = {
    [KILN_PATTERN_PLAIN] = "plain",
    [KILN_PATTERN_STRIPE] = "stripe",
    [KILN_PATTERN_SEGMENTS] = "segments",
    NULL,
};

TABLE(sphere) = {
    CHOICE(
        LOOK, "pattern", sphere.pattern, patterns, "plain",
        "`plain` has one colour. `stripe` draws look.color as a band about the equator. `segments` "
        "alternates the two colours from pole to pole. Collisions turn the pattern where they turn "
        "particles (collide.spin of an interaction); elsewhere look.rotation and look.spin turn it "
        "about an axis chosen at random for each particle."),
    INTEGER(LOOK, "segments", sphere.segments, 1, 8, "3", "Number of segments of each colour."),
    COLOR(LOOK, "color", sphere.color, 1000, DRAWN(25), "1",
          "The second colour of the pattern; the first is look.color."),
    END,
};

TABLE(taper) = {
    {ROW(IF_RIBBON, "tail", number, ribbon.taper[0], "0",
         "Factor on the width at the end of the oldest particles."),
     LIMITS(KILN_PLAIN, 0, 100)},
    {ROW(IF_RIBBON, "head", number, ribbon.taper[1], "1",
         "Factor on the width at the end of the youngest particles."),
     LIMITS(KILN_PLAIN, 0, 100)},
    END,
};

TABLE(ribbon) = {
    CHOICE(IF_RIBBON, "facing", ribbon.facing, ribbon_facings, "camera",
           "`camera` turns the face of a ribbon to the eye. `normal` turns it to look.axis: the "
           "ribbon lies in a plane at right angles to it where its particles do."),
    INTEGER(IF_RIBBON, "smooth", ribbon.smooth, 1, KILN_RIBBON_MOST_SMOOTH, "4",
            "Parts of the curve between two particles. 1 joins them by straight segments."),
    {ROW(IF_RIBBON, "texture", number, ribbon.texture_m, "0 m",
         "Length of the texture along the ribbon, which repeats it; it needs births by the metre. "
         "0 stretches the texture over the ribbon, from its youngest particle to the end of "
         "life, or from the first particle of a burst to the last."),
     LIMITS(KILN_METRES, 0, 1000)},
    GROUP(IF_RIBBON, "taper", taper, "How the width changes along a ribbon, besides look.size."),
    {ROW(IF_RIBBON, "gap", number, ribbon.gap_m, "0 m",
         "A ribbon is cut between particles that are farther from each other; 0 never cuts it."),
     LIMITS(KILN_METRES, 0, FAR)},
    END,
};

static const char *const soft_formulas[] = {
    [KILN_SOFT_CLAMPED] = "clamped",
    [KILN_SOFT_LITERAL] = "literal",
    NULL,
};

static const char *const motions[] = {"auto", "none", NULL};

static const char *const greens[] = {
    [KILN_GREEN_AUTO] = "auto",
    [KILN_GREEN_UP] = "up",
    [KILN_GREEN_DOWN] = "down",
    NULL,
};

TABLE(fade) = {
    VALUE(LOOK, "in", fade_in, KILN_FRACTION, 0, 1, TIME(26), "0.1",
          "Fraction of the life in which a particle fades in to its full opacity."),
    VALUE(LOOK, "out", fade_out, KILN_FRACTION, 0, 1, TIME(27), "0.3",
          "Fraction of the life in which a particle fades out before its death."),
    END,
};

PUBLIC_TABLE(kiln_options_look) = {
    {ROW(LOOK, "atlas", assets, atlas, "\"builtin:smoke\"",
         "The texture, whose cells play in order. Of several textures, each particle gets one. "
         "Cells of a file keep their proportions: the longer edge of one is as long as the "
         "billboard's, and it lies in the middle of the other."),
     COUNTED(atlas, atlas_count)},
    {ROW(LOOK, "cells", pair, cells, "[8, 8]",
         "Columns and rows of cells in an atlas file. Their product is the number of cells: a "
         "built-in atlas is made with that many, and a video gives its first frames."),
     LIMITS(KILN_PLAIN, 1, 64)},
    {ROW(LOOK, "motion", motion, motion, "auto",
         "An image of the motion from each cell to the next, so that few cells play smoothly: red "
         "is right, green is as `motion_green` says, 128 of 255 is no motion. `auto` takes the "
         "motion that a built-in atlas has. `none` cross-fades the cells."),
     .choices = motions},
    CHOICE(LOOK, "motion_green", motion_green, greens, "auto",
           "Where green of a motion file points: `up` as in Houdini and Unity, or `down` as in "
           "Unreal. `auto` is what FILE.json says beside FILE_motion.png, where kiln wrote them; "
           "without it, `up`."),
    {ROW(LOOK, "motion_scale", motion_scale, motion_scale, "auto",
         "Motion that full red and full green of a motion file stand for, in edges of a cell. A "
         "pair is for files whose axes have scales of their own, a negative number for vectors "
         "that point back. `auto` is the scale of FILE.json beside FILE_motion.png, where kiln "
         "wrote them; without it, 1."),
     LIMITS(KILN_PLAIN, -10, 10)},
    CHOICE(LOOK, "blend", blend, blends, "alpha",
           "`alpha` covers what is behind the particle, like smoke. `add` adds light to it, like "
           "fire."),
    VALUE(IF_CONTACTS_ARE_AS_DRAWN, "size", size, KILN_METRES, 0, 1000, DRAWN(28), "0.5 m",
          "Edge length of a billboard, width of a ribbon, diameter of a sphere, longest edge of a "
          "mesh. A billboard that is thinner than a pixel is drawn a pixel wide, and fainter by "
          "the same factor."),
    RANGE(IF_CONTACTS_ARE_AS_DRAWN, "scale", scale, KILN_PLAIN, 0, 1000, BIRTH(29), "1",
          "Factor on size, chosen at random for each particle."),
    VALUE(IF_FORMED, "width", width, KILN_PLAIN, 0, 1000, DRAWN(111), "1",
          "Factor on the size of a billboard across, from its left to its right edge. Shadows and "
          "light that it sheds are those of its size alone."),
    VALUE(IF_FORMED, "height", height, KILN_PLAIN, 0, 1000, DRAWN(112), "1",
          "Factor on the size of a billboard along, from its lower to its upper edge; a stretch "
          "adds to that."),
    CHOICE(
        LOOK, "shape", shape, shapes, "billboard",
        "`billboard` draws the texture on a quad. `point` and `line` draw a plain colour without a "
        "texture. `ribbon` draws strips through the particles in the order of their births, as "
        "wide as their size. `sphere` and `mesh` are opaque, lit like the backdrop, and become "
        "smaller where opacity and fade would make them transparent."),
    {ROW(IF_IT_LIES, "facing", facing, facing, "screen",
         "How a billboard is turned. `screen`, `viewplane` and `velocity` are parallel to the "
         "picture. `screen` is upright in the picture, `viewplane` is upright in the world, and "
         "`velocity` has its upper edge towards the velocity. `viewpoint` is turned to the eye "
         "and upright in the world. `axial` turns about `axis` alone, as far towards the eye as it "
         "can. With a normal, it lies in that plane of the world, such as the ground. `surface` "
         "lays it on the surface that its particle rests on, by `collide.then` or because it was "
         "born there of an impact without a speed; in flight it is as with `screen`."),
     .choices = facings, .members = facing_rows},
    VECTOR(LOOK, "axis", axis, KILN_PLAIN, -FAR, FAR, TIME(30), "[0, 1, 0]",
           "Axis that axial billboards turn about, of any length but 0."),
    GROUP(LOOK, "point", point, "How points look."),
    GROUP(LOOK, "line", line, "How lines look."),
    GROUP(LOOK, "sphere", sphere, "How spheres look."),
    GROUP(IF_RIBBON, "ribbon", ribbon, "How ribbons look."),
    GROUP(LOOK, "mesh", mesh,
          "How meshes look. All of them are instances of one mesh from a file."),
    VALUE(LOOK, "stretch", stretch, KILN_SECONDS, 0, 10, DRAWN(31), "0 s",
          "The billboard is longer along the velocity by the speed times this. 0 keeps it square."),
    BOOLEAN(LOOK, "stretch_dims", stretch_dims, "false",
            "true spreads the light of a billboard over its stretch, as the shutter of a camera "
            "does: it is fainter by the factor by which it is longer."),
    {ROW(LOOK, "rotation", range, rotation, "auto",
         "Angle by which a particle is turned, chosen at random for each particle. `spin` adds to "
         "it. `auto` is any angle, but 0 deg for billboards whose atlas are files of one cell "
         "(`cells: [1, 1]`), such as a logo: they are upright. These are not mirrored, either, as "
         "half of all other particles are."),
     LIMITS(KILN_ANGLE, KILN_DEG(-3600), KILN_DEG(3600)), .clocks = DRAWN(32),
     .special_word = "auto"},
    RANGE(
        LOOK, "spin", spin, KILN_ANGULAR_SPEED, 0, KILN_DEG(36000), SUMMED(33), "0 deg/s",
        "Angular speed of a particle. Speed and direction are chosen at random for each particle."),
    VALUE(LOOK, "cycles", cycles, KILN_PLAIN, 0, 1000, BIRTH(34), "1",
          "How many times the atlas plays in a life."),
    BOOLEAN(LOOK, "random_start", random_start, "false",
            "Each particle starts at a random cell of the atlas."),
    {ROW(IF_IT_PAINTS, "color", color, color, "1",
         "Factor on the colour of the atlas or of the glow. `source` is the colour of the mesh or "
         "of the image at the place where the particle was born."),
     LIMITS(KILN_PLAIN, 0, 1000), .clocks = DRAWN(35), .special_word = "source"},
    VALUE(LOOK, "opacity", opacity, KILN_FRACTION, 0, 1, DRAWN(36), "1",
          "Factor on the alpha of the atlas."),
    VALUE(LOOK, "temperature", temperature, KILN_KELVIN, 0, 20000, DRAWN(37), "0 K",
          "Temperature of the black body whose colour the particle glows with; 0 is no glow. It "
          "sets the brightness as well: (temperature / 1900 K)^4 times `intensity`, which is 0.16 "
          "at 1200 K, 0.39 at 1500 K, 1 at 1900 K, 3 at 2500 K and 137 at 6500 K. Cool parts of a "
          "cell have 0.72 of the temperature, so 0.27 of the brightness."),
    VALUE(LOOK, "intensity", intensity, KILN_PLAIN, 0, 1000000, DRAWN(38), "1",
          "Factor on emitted light: how bright the particle is at 1900 K, or, of blend add without "
          "a temperature, a factor on its colour."),
    GROUP(LOOK, "fade", fade, "Opacity at birth and death."),
    VALUE(LOOK, "soft", soft, KILN_PER_METRE, 0, 1000, DRAWN(39), "2",
          "How fast a particle fades where it nears a surface. A larger value fades over a shorter "
          "distance. 0 gives a hard edge."),
    CHOICE(
        LOOK, "soft_formula", soft_formula, soft_formulas, "clamped",
        "`clamped` limits the fade to 0..1. `literal` is equation 3.3 of Heinz's thesis (2019) as "
        "printed: it has no limit, and takes the particle's distance from the eye for its depth."),
    VALUE(LOOK, "thickness", thickness, KILN_PLAIN, 0, 10, DRAWN(40), "1",
          "Depth of a billboard as a multiple of its size, where post.compose is oit: 1 is as deep "
          "as wide, like a puff of smoke; 0 is flat."),
    VALUE(LOOK, "near_fade", near_fade, KILN_METRES, 0, 1000, DRAWN(41), "0.2 m",
          "Distance beyond the camera's near plane over which a particle fades in."),
    COLOR(LOOK, "bloom", bloom, 100, DRAWN(42), "0",
          "Factor on the colour that goes to the bloom."),
    {ROW(LOOK, "lit", value, lit, "auto",
         "0 shows the particle's own colour. 1 lights the particle by sun, sky and lights. `auto` "
         "is 1 for spheres and meshes, and 0 for all other shapes."),
     LIMITS(KILN_FRACTION, 0, 1), .clocks = DRAWN(43), .special_word = "auto"},
    VALUE(LOOK, "shadow", shadow, KILN_PLAIN, 0, 100, TIME(44), "1",
          "How strongly a particle of blend alpha shadows itself and what lies behind it as seen "
          "from a light: a factor on the light that it absorbs."),
    COLOR(LOOK, "light", light, 1000000, TIME(45), "0",
          "Factor on the light that a glowing particle sheds on backdrop and smoke. With 1, it is "
          "that of a quarter of its square, as bright as the mean of its hottest and coolest "
          "parts: 2 to 13 times what the atlases of fire show. N particles then make a white "
          "surface 1 m away light * N * brightness * opacity * size^2 / (4 pi) bright."),
    INTEGER(LOOK, "lights", light_count, 1, KILN_MAX_FIRE_LIGHTS, "4",
            "Number of moving lights that shed the light of the system, grouped by the ages of its "
            "particles. All systems of a scene have up to 16 together."),
    BOOLEAN(
        LOOK, "light_shadow", light_shadow, "true",
        "Smoke dims the light of look.light, and objects of the backdrop and solid particles hide "
        "it, except those that contain a light's centre."),
    END,
};
