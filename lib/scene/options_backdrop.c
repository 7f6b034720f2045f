/* This file has the option tables of the backdrop: sky, floor, sun, objects and lights. The reader,
 * the printer and the help of a scene's keys reach them from the table in options_root.c. The
 * macros of rows are in option/rows.h. A MOTION row decides how particles move, and a LOOK row only
 * how the picture looks (scene/parts.h); a row with TIME may vary over time. */
#include "asset/geometry/chart.h"
#include "asset/geometry/field.h"
#include "scene/rows.h"

#define FILLS struct kiln_object

/* The least size of an object, m. Near the origin, positions are still 10,000 times as fine. */
#define LEAST_LENGTH 1e-5

/* The options of how particles bounce off an object and slide along it. */
#define SURFACE_FACTORS                                                                            \
    VALUE(MOTION, "restitution", restitution, KILN_FRACTION, 0, 1, TIME(8), "1",                   \
          "Factor on the restitution of particles that bounce off it."),                           \
        VALUE(MOTION, "friction", friction, KILN_PLAIN, 0, 100, TIME(9), "1",                      \
              "Factor on the friction of particles that touch it.")

#define COLLIDING                                                                                  \
    BOOLEAN(MOTION, "collide", collide, "true",                                                    \
            "Particles of systems that collide bounce off it."),                                   \
        SURFACE_FACTORS

#define ATTACHED                                                                                   \
    ATTACH(IF_OBJECT_IS_ATTACHED,                                                                  \
           "Node that the object lies in: place, directions and sizes are in its frame.")

#define REFLECTANCE                                                                                \
    COLOR(LOOK, "color", color, 1, TIME(10), "[0.35, 0.34, 0.33]",                                 \
          "Fraction of the incoming light that it reflects.")

TABLE(box) = {
    ATTACHED,
    VECTOR(MOTION, "center", center, KILN_METRES, -FAR, FAR, TIME(11), "[0, 0.5, 0]",
           "Centre of the box."),
    VECTOR(MOTION, "size", size, KILN_METRES, LEAST_LENGTH, FAR, TIME(12), "[1, 1, 1]",
           "Lengths of the edges."),
    VECTOR(MOTION, "rotation", rotation, KILN_ANGLE, KILN_DEG(-3600), KILN_DEG(3600), TIME(13),
           "[0, 0, 0]",
           "Angles about x, then y, then z. In each step, the box turns the shorter way "
           "from its old angles to its new ones."),
    REFLECTANCE,
    COLLIDING,
    END,
};

TABLE(sphere) = {
    ATTACHED,
    VECTOR(MOTION, "center", center, KILN_METRES, -FAR, FAR, TIME(14), "[0, 0.5, 0]",
           "Centre of the sphere."),
    VALUE(MOTION, "radius", radius, KILN_METRES, LEAST_LENGTH, FAR, TIME(15), "0.5 m",
          "Radius of the sphere."),
    REFLECTANCE,
    COLLIDING,
    END,
};

TABLE(cylinder) = {
    ATTACHED,
    VECTOR(MOTION, "center", center, KILN_METRES, -FAR, FAR, TIME(16), "[0, 0.5, 0]",
           "Centre of the cylinder."),
    VECTOR(MOTION, "axis", axis, KILN_PLAIN, -FAR, FAR, TIME(17), "[0, 1, 0]",
           "Direction of the axis, of any length but 0."),
    VALUE(MOTION, "radius", radius, KILN_METRES, LEAST_LENGTH, FAR, TIME(18), "0.5 m",
          "Radius of the cylinder."),
    VALUE(MOTION, "height", height, KILN_METRES, LEAST_LENGTH, FAR, TIME(19), "1 m",
          "Height along the axis, from end to end."),
    REFLECTANCE,
    COLLIDING,
    END,
};

TABLE(capsule) = {
    ATTACHED,
    VECTOR(MOTION, "center", center, KILN_METRES, -FAR, FAR, TIME(20), "[0, 1, 0]",
           "Centre of the capsule."),
    VECTOR(MOTION, "axis", axis, KILN_PLAIN, -FAR, FAR, TIME(21), "[0, 1, 0]",
           "Direction of the axis, of any length but 0."),
    VALUE(MOTION, "radius", radius, KILN_METRES, LEAST_LENGTH, FAR, TIME(22), "0.5 m",
          "Radius of the side and of the round ends."),
    VALUE(MOTION, "height", height, KILN_METRES, LEAST_LENGTH, FAR, TIME(23), "1 m",
          "Height along the axis, between the centres of the round ends."),
    REFLECTANCE,
    COLLIDING,
    END,
};

TABLE(cone) = {
    ATTACHED,
    VECTOR(MOTION, "center", center, KILN_METRES, -FAR, FAR, TIME(24), "[0, 0.5, 0]",
           "Centre of the cone, halfway between its base and its tip."),
    VECTOR(MOTION, "axis", axis, KILN_PLAIN, -FAR, FAR, TIME(25), "[0, 1, 0]",
           "Direction from the base to the tip, of any length but 0."),
    VALUE(MOTION, "radius", radius, KILN_METRES, LEAST_LENGTH, FAR, TIME(26), "0.5 m",
          "Radius of the base."),
    VALUE(MOTION, "height", height, KILN_METRES, LEAST_LENGTH, FAR, TIME(27), "1 m",
          "Height along the axis, from the base to the tip."),
    REFLECTANCE,
    COLLIDING,
    END,
};

TABLE(plane) = {
    ATTACHED,
    VECTOR(MOTION, "center", center, KILN_METRES, -FAR, FAR, TIME(28), "[0, 0, 0]",
           "A point of the plane. The plane turns about this point."),
    VECTOR(MOTION, "normal", axis, KILN_PLAIN, -FAR, FAR, TIME(29), "[0, 1, 0]",
           "Normal of the plane, of any length but 0. It points away from the solid side."),
    REFLECTANCE,
    BOOLEAN(LOOK, "visible", visible, "true",
            "Whether the plane is drawn. Particles collide with it in any case."),
    COLLIDING,
    END,
};

TABLE(animation) = {
    ANIMATION(MOTION, animation.),
    END,
};

static const char *const colliders[] = {
    [KILN_COLLIDER_FIELD] = "field",
    [KILN_COLLIDER_VOLUME] = "volume",
    [KILN_COLLIDER_DEPTH_MAPS] = "depth_maps",
    NULL,
};
static const char *const sides[] = {"one", "two", NULL};

ITEM(direction, vector, .name = "direction", .parts = MOTION, LIMITS(KILN_PLAIN, -FAR, FAR),
     .help = "Direction from which the mesh is seen. The mesh is also seen from the opposite "
             "direction.");

TABLE(depth_maps) = {
    LIST(MOTION, "directions", depth_directions, direction, depth_direction_count,
         "[[1, 0, 0], [0, 1, 0], [0, 0, 1]]",
         "Directions from which the mesh is seen, in its own frame; vectors of any length but 0. "
         "Each gives a depth map of the front and, from the opposite direction, one of the back."),
    INTEGER(MOTION, "resolution", depth_resolution, KILN_MIN_DEPTH_RESOLUTION,
            KILN_MAX_DEPTH_RESOLUTION, "128", "Samples along each edge of a map."),
    END,
};

static const char *const gathers[] = {
    [KILN_GATHER_NEAR] = "near",
    [KILN_GATHER_ALL] = "all",
    NULL,
};

TABLE(paint) = {
    INTEGER(MOTION, "size", paint.size, KILN_MIN_CHART, KILN_MAX_CHART, "512",
            "Texels along an edge of the painted texture, a power of two."),
    CHOICE(
        LOOK, "gather", paint.gather, gathers, "near",
        "How texels find their splats; the paint is the same. With `near`, each splat goes to the "
        "texels that it may reach. With `all`, each texel tests every splat (Drone 2007, 7.6.1)."),
    INTEGER(MOTION, "per_step", paint.per_step, 0, KILN_MAX_PARTICLES, "0",
            "Most particles that paint in a step; 0 lets all paint in each step. Particles take "
            "turns. At its turn, a particle paints only its last hit since the turn before."),
    END,
};

TABLE(mesh) = {
    {ROW(MOTION, "file", mesh, file, NULL,
         "An OBJ, glTF, GLB, PLY or STL file of triangles, in metres and y up. Its materials are "
         "not drawn.")},
    ATTACHED,
    VECTOR(MOTION, "position", center, KILN_METRES, -FAR, FAR, TIME(30), "[0, 0, 0]",
           "Position of the file's origin."),
    VECTOR(MOTION, "rotation", rotation, KILN_ANGLE, KILN_DEG(-3600), KILN_DEG(3600), TIME(31),
           "[0, 0, 0]", "Angles about x, then y, then z."),
    VALUE(MOTION, "scale", scale, KILN_PLAIN, 0.000001, FAR, TIME(32), "1",
          "Metres per unit of the file."),
    SWITCH(MOTION, "animation", animation, animation.enabled, "none",
           "An animation of the glTF or GLB file: it moves nodes, bones that vertices follow, and "
           "morph targets."),
    REFLECTANCE,
    BOOLEAN(MOTION, "collide", collide, "false",
            "Particles of systems that collide bounce off it."),
    SURFACE_FACTORS,
    CHOICE(MOTION, "collider", collider, colliders, "field",
           "How particles collide with the mesh. `field` is a grid of distances to a closed mesh, "
           "made once (UberFlow 2004, 4.6). `volume` is a grid made anew in each step: its cells "
           "have the planes of triangles and their motion, and the mesh may be open (Drone 2007, "
           "7.5.2). `depth_maps` are depth maps of the mesh's fronts and backs from some "
           "directions; a hollow that no direction looks into counts as filled (Heinz 2019, "
           "2.5.1)."),
    INTEGER(MOTION, "cells", cells, KILN_MIN_FIELD_CELLS, KILN_MAX_FIELD_CELLS, "48",
            "Cells of the field or the volume along the mesh's longest edge. Particles may miss "
            "parts that are thinner than a cell."),
    VECTOR(MOTION, "heading", heading, KILN_PLAIN, -FAR, FAR, TIME(33), "[0, -1, 0]",
           "For collider `volume`: direction in which most particles fly; a vector of any length "
           "but 0. Of the planes that face this direction, a cell keeps the one that particles "
           "meet first (Drone 2007, 7.5.2.3)."),
    CHOICE(MOTION, "sides", sides, sides, "one",
           "For collider `volume`: sides of the mesh that stop particles. `one` suits closed "
           "meshes: a particle behind a plane is put in front of it. `two` suits sheets: particles "
           "meet a plane from both sides."),
    GROUP(MOTION, "depth_maps", depth_maps,
          "Settings of collider `depth_maps`. Depth maps do not miss thin parts, and the mesh need "
          "not be closed."),
    SWITCH(MOTION, "paint", paint, paint.enabled, "none",
           "The mesh takes paint of systems that paint (Drone 2007, 7.6.1). Its file must have "
           "texture coordinates from 0 to 1, in which no two triangles overlap."),
    END,
};

TABLE(terrain) = {
    {ROW(MOTION, "image", picture, file, "none",
         "A picture whose brightness gives the heights, its top towards -z. With none, the hills "
         "are noise.")},
    VECTOR(MOTION, "position", center, KILN_METRES, -FAR, FAR, 0, "[0, 0, 0]",
           "Position of the terrain's middle, at the height of black or of the deepest valley."),
    VECTOR(MOTION, "size", size, KILN_METRES, 0.001, FAR, 0, "[20, 2, 20]",
           "Width, height and depth. The height is that from black to white or from the deepest "
           "valley to the highest peak."),
    {ROW(MOTION, "samples", pair, samples, "[129, 129]",
         "Numbers of points along x and z. Two triangles lie between each four neighbours."),
     LIMITS(KILN_PLAIN, 2, KILN_MAX_TERRAIN_EDGE)},
    VALUE(MOTION, "hills", hills, KILN_METRES, 0.001, FAR, 0, "8 m", "Size of the largest hills."),
    INTEGER(MOTION, "octaves", octaves, 1, KILN_MAX_TERRAIN_OCTAVES, "6",
            "Number of layers of ever smaller hills."),
    VALUE(MOTION, "roughness", roughness, KILN_PLAIN, 0, 1, 0, "0.45",
          "Height of a layer of hills as a fraction of the height of the layer before it."),
    VALUE(MOTION, "ridges", ridges, KILN_PLAIN, 0, 1, 0, "0",
          "Shape of the hills: 0 is round, 1 has crests above valleys."),
    INTEGER(MOTION, "seed", seed, 0, 1000000, "1",
            "Seed of the noise. Another seed gives another landscape."),
    REFLECTANCE,
    BOOLEAN(MOTION, "collide", collide, "true",
            "Particles of systems that collide bounce off it. It is solid downwards without an "
            "end, with walls below its edges; those that are beside it fall past it."),
    SURFACE_FACTORS,
    END,
};

PUBLIC_KINDS(kiln_object_kinds) = {
    {.name = "box", .value = KILN_OBJECT_BOX, MEMBERS(box), .help = "A box."},
    {.name = "sphere", .value = KILN_OBJECT_SPHERE, MEMBERS(sphere), .help = "A sphere."},
    {.name = "cylinder",
     .value = KILN_OBJECT_CYLINDER,
     MEMBERS(cylinder),
     .help = "A cylinder with flat ends, along any axis."},
    {.name = "capsule",
     .value = KILN_OBJECT_CAPSULE,
     MEMBERS(capsule),
     .help = "A cylinder with round ends, along any axis."},
    {.name = "cone",
     .value = KILN_OBJECT_CONE,
     MEMBERS(cone),
     .help = "A cone with a flat base, along any axis."},
    {.name = "plane",
     .value = KILN_OBJECT_PLANE,
     MEMBERS(plane),
     .help = "An infinite plane and all that is behind it. No sunlight passes it: where the sun is "
             "behind the plane, the sun does not shine."},
    {.name = "mesh",
     .value = KILN_OBJECT_MESH,
     MEMBERS(mesh),
     .help = "A mesh from a file. Meshes and terrains together may be at most 64."},
    {.name = "terrain",
     .value = KILN_OBJECT_TERRAIN,
     MEMBERS(terrain),
     .help = "A landscape from a picture or from noise (UberFlow 2004, 4.6). It ends at its edges, "
             "where walls are drawn down to its lowest height."},
    {.name = NULL},
};

ITEM_OF_KINDS(object, kiln_object_kinds, kind, .name = "object", .parts = IF_PARTICLES_HIT_OBJECT);

#undef FILLS
#define FILLS struct kiln_light

/* The options that a point light and a spot share. */
#define SMALL_LIGHT                                                                                \
    VECTOR(LOOK, "position", position, KILN_METRES, -FAR, FAR, TIME(34), "[0, 2, 0]",              \
           "Position of the light."),                                                              \
        COLOR(LOOK, "color", color, 1000000, TIME(35), "1", "Light that arrives 1 m away."),       \
        VALUE(LOOK, "radius", radius, KILN_METRES, LEAST_LENGTH, FAR, TIME(36), "0.2 m",           \
              "Radius of the light. Near the light, it keeps the brightness finite; it softens "   \
              "shadows."),                                                                         \
        BOOLEAN(LOOK, "shadow", shadow, "true",                                                    \
                "Smoke dims the light, and objects of the backdrop and solid particles hide it, "  \
                "except those that contain its centre.")

#define LIGHT_ATTACHED                                                                             \
    ATTACH(IF_LIGHT_IS_ATTACHED,                                                                   \
           "Node that the light lies in: place, directions and sizes are in its frame.")

#define LIGHT_DIRECTION                                                                            \
    VECTOR(LOOK, "direction", direction, KILN_PLAIN, -FAR, FAR, TIME(37), "[0, -1, 0]",            \
           "Direction in which the light shines, of any length but 0.")

TABLE(point) = {
    LIGHT_ATTACHED,
    SMALL_LIGHT,
    END,
};

TABLE(spot) = {
    LIGHT_ATTACHED,
    SMALL_LIGHT,
    LIGHT_DIRECTION,
    VALUE(LOOK, "angle", angle, KILN_ANGLE, KILN_DEG(1), KILN_DEG(180), TIME(38), "30 deg",
          "Angle between the light's direction and the edge of its cone: half of the opening."),
    VALUE(LOOK, "softness", softness, KILN_FRACTION, 0, 1, TIME(39), "0.2",
          "Part of the angle, inwards from the edge of the cone, in which the light fades."),
    END,
};

TABLE(rectangle) = {
    LIGHT_ATTACHED,
    VECTOR(LOOK, "center", position, KILN_METRES, -FAR, FAR, TIME(40), "[0, 2, 0]",
           "Centre of the rectangle."),
    VALUE(LOOK, "width", width, KILN_METRES, LEAST_LENGTH, 1000, TIME(41), "1 m",
          "Length of the edges across `up`."),
    VALUE(LOOK, "height", height, KILN_METRES, LEAST_LENGTH, 1000, TIME(42), "1 m",
          "Length of the edges along `up`."),
    LIGHT_DIRECTION,
    VECTOR(LOOK, "up", up, KILN_PLAIN, -FAR, FAR, TIME(43), "[0, 1, 0]",
           "Direction of the upper edge, as seen from the centre. The part of it along `direction` "
           "does not count. If nothing else is left, the upper edge is towards -z, or towards y if "
           "`direction` is along z."),
    COLOR(LOOK, "color", color, 1000000, TIME(44), "1",
          "Radiance of the rectangle's front. From afar and from in front, it gives as much light "
          "as a point light of this colour times the area in m^2, divided by pi."),
    BOOLEAN(LOOK, "shadow", shadow, "true",
            "Smoke dims the light, and objects of the backdrop and solid particles hide it, except "
            "those that contain its centre or are wholly behind it. Edges of shadows are as soft "
            "as those of a ball "
            "whose outline has the area of the rectangle."),
    END,
};

KINDS(light_kinds) = {
    {.name = "point",
     .value = KILN_LIGHT_POINT,
     MEMBERS(point),
     .help = "A light that shines to all sides."},
    {.name = "spot",
     .value = KILN_LIGHT_SPOT,
     MEMBERS(spot),
     .help = "A light that shines into a cone."},
    {.name = "rectangle",
     .value = KILN_LIGHT_RECTANGLE,
     MEMBERS(rectangle),
     .help = "A panel that shines from its front, such as a window or a lamp at a ceiling. It is "
             "not drawn itself."},
    {.name = NULL},
};

ITEM_OF_KINDS(light, light_kinds, kind, .name = "light");

#undef FILLS
#define FILLS struct kiln_backdrop

TABLE(sky) = {
    COLOR(LOOK, "top", sky_top, 1000, TIME(45), "[0.02, 0.03, 0.05]", "Colour overhead."),
    COLOR(LOOK, "horizon", sky_horizon, 1000, TIME(46), "[0.12, 0.13, 0.16]",
          "Colour at eye level."),
    {ROW(LOOK, "image", picture, sky_image, "none",
         "The whole sphere around the scene as one picture, left to right and top to bottom, in "
         "place of the gradient. Its middle lies towards -z. Averages of its colours over parts of "
         "the sky light the scene. Files of floats, such as HDR and EXR, have light that is "
         "brighter than white.")},
    VALUE(LOOK, "rotation", sky_rotation, KILN_ANGLE, KILN_DEG(-3600), KILN_DEG(3600), TIME(47),
          "0 deg", "Angle by which the image is turned about y."),
    VALUE(LOOK, "intensity", sky_intensity, KILN_PLAIN, 0, 1000000, TIME(48), "1",
          "Factor on the image."),
    END,
};

TABLE(floor_rows) = {
    COLOR(LOOK, "color", floor_color, 1, TIME(49), "[0.35, 0.34, 0.33]",
          "Fraction of the incoming light that it reflects."),
    VALUE(MOTION, "height", floor_height, KILN_METRES, -FAR, FAR, TIME(50), "0 m",
          "Height of the floor. It may vary over time only if `collide` is false."),
    VALUE(LOOK, "checker", floor_checker, KILN_METRES, 0, FAR, TIME(51), "0 m",
          "Edge length of lighter and darker squares; 0 is a plain floor."),
    {ROW(LOOK, "image", picture, floor_image, "none",
         "A picture that repeats, its top towards -z, in place of colour and squares.")},
    VALUE(LOOK, "tile", floor_tile, KILN_METRES, LEAST_LENGTH, FAR, TIME(52), "1 m",
          "Width of the picture."),
    VALUE(LOOK, "gloss", floor_gloss, KILN_PLAIN, 0, 10, TIME(53), "0",
          "Strength of the floor's reflection; 1 reflects as water does. The floor mirrors sky, "
          "lights and objects except meshes. Of particles it mirrors only the light that they shed "
          "(look.light)."),
    VALUE(LOOK, "roughness", floor_roughness, KILN_PLAIN, 0, 1, TIME(54), "0.3",
          "How widely `gloss` spreads lights."),
    VALUE(LOOK, "wave_height", floor_wave_height, KILN_METRES, 0, 100, TIME(55), "0 m",
          "Height, from trough to crest, of waves that tilt the reflection of `gloss`. The floor "
          "itself stays flat."),
    VALUE(LOOK, "wave_length", floor_wave_length, KILN_METRES, 0.001, 10000, TIME(56), "1 m",
          "Length of the longest waves. Smaller waves ride on them."),
    BOOLEAN(MOTION, "collide", floor_collide, "true",
            "Particles of systems that collide bounce off it."),
    VALUE(MOTION, "restitution", floor_restitution, KILN_FRACTION, 0, 1, TIME(57), "1",
          "Factor on the restitution of particles that bounce off it."),
    VALUE(MOTION, "friction", floor_friction, KILN_PLAIN, 0, 100, TIME(58), "1",
          "Factor on the friction of particles that touch it."),
    END,
};

TABLE(sun) = {
    VECTOR(LOOK, "direction", sun_direction, KILN_PLAIN, -FAR, FAR, TIME(59), "[0.5, 1, 0.3]",
           "Direction towards the sun, of any length but 0."),
    COLOR(LOOK, "color", sun_color, 1000000, TIME(60), "[0.8, 0.75, 0.65]",
          "Light of the sun; 0 is no sun."),
    VALUE(LOOK, "size", sun_size, KILN_ANGLE, 0, KILN_DEG(30), TIME(61), "0 deg",
          "Angular diameter of the sun. A larger sun gives softer edges of shadows."),
    VALUE(LOOK, "disc", sun_disc, KILN_PLAIN, 0, 1000000, TIME(62), "0",
          "Brightness of the sun's disc in the sky, as a factor on `color`; 0 draws no disc. The "
          "disc is as wide as `size`. A glossy floor mirrors the sun in any case."),
    VALUE(LOOK, "glow", sun_glow, KILN_PLAIN, 0, 1000000, TIME(63), "0",
          "Brightness of the sky at the sun's middle beside that of the disc, as a factor on "
          "`color`. This glow gets weaker away from the sun, and colours the haze as well."),
    VALUE(LOOK, "glow_size", sun_glow_size, KILN_ANGLE, KILN_DEG(0.01), KILN_DEG(90), TIME(64),
          "6 deg", "Angle away from the sun at which a third of the glow is left."),
    END,
};

PUBLIC_TABLE(kiln_options_backdrop) = {
    BOOLEAN(LOOK, "transparent", transparent, "false",
            "Pictures have alpha in place of the sky. The floor stays, unless it is `none`."),
    GROUP(LOOK, "sky", sky, "The sky: a gradient or an image."),
    SWITCH(IF_PARTICLES_HIT_FLOOR, "floor", floor_rows, floor_enabled, "{}", "An endless plane."),
    GROUP(LOOK, "sun", sun, "The sun, the one light with a shadow."),
    VALUE(
        LOOK, "haze", haze, KILN_PER_METRE, 0, 100, TIME(65), "0.02",
        "How fast, per metre of distance, all that is drawn fades into the colour of the horizon: "
        "exp(-haze * distance) is left. Light that covers nothing, like fire, is dimmed. "
        "Transparent pictures have no haze."),
    NAMED_LIST(MOTION, "objects", objects, object, object_count, "[]",
               "Objects of the scene. An entry of a mapping may `use` another one."),
    NAMED_LIST(LOOK, "lights", lights, light, light_count, "[]",
               "Lights besides the sun. An entry of a mapping may `use` another one."),
    END,
};
