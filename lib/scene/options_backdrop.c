/* This file has the option tables of the backdrop: sky, floor, sun, objects and lights. */
#include "asset/geometry/chart.h"
#include "asset/geometry/depth_maps.h"
#include "asset/geometry/field.h"
#include "scene/rows.h"

#define AT(field) offsetof(struct kiln_object, field)

/* Factors of an object on the restitution and friction of particles. */
#define RUBBING                                                                                    \
    VALUE(MOTION, "restitution", restitution, KILN_FRACTION, 0, 1, TIME, "1",                      \
          "Factor on the restitution of what bounces off it."),                                    \
        VALUE(MOTION, "friction", friction, KILN_PLAIN, 0, 100, TIME, "1",                         \
              "Factor on the friction of what touches it.")

#define COLLIDING                                                                                  \
    BOOLEAN(MOTION, "collide", collide, "true",                                                    \
            "Particles of systems that collide bounce off it."),                                   \
        RUBBING

#define REFLECTANCE                                                                                \
    COLOR(LOOK, "color", color, 1, TIME, "[0.35, 0.34, 0.33]",                                     \
          "Part of the light that it reflects.")

static const struct kiln_option box[] = {
    VECTOR(MOTION, "center", center, KILN_METRES, -FAR, FAR, TIME, "[0, 0.5, 0]", "Centre."),
    VECTOR(MOTION, "size", size, KILN_METRES, 0.001, FAR, TIME, "[1, 1, 1]", "Full edges."),
    VECTOR(MOTION, "rotation", rotation, KILN_ANGLE, KILN_DEG(-3600), KILN_DEG(3600), TIME,
           "[0, 0, 0]", "About x, then about y, then about z; in a step it turns the shorter way."),
    REFLECTANCE,
    COLLIDING,
    END,
};

static const struct kiln_option sphere[] = {
    VECTOR(MOTION, "center", center, KILN_METRES, -FAR, FAR, TIME, "[0, 0.5, 0]", "Centre."),
    VALUE(MOTION, "radius", radius, KILN_METRES, 0.001, FAR, TIME, "0.5 m",
          "From centre to surface."),
    REFLECTANCE,
    COLLIDING,
    END,
};

static const struct kiln_option cylinder[] = {
    VECTOR(MOTION, "center", center, KILN_METRES, -FAR, FAR, TIME, "[0, 0.5, 0]", "Centre."),
    VECTOR(MOTION, "axis", axis, KILN_PLAIN, -FAR, FAR, TIME, "[0, 1, 0]",
           "Along it; of any length but 0."),
    VALUE(MOTION, "radius", radius, KILN_METRES, 0.001, FAR, TIME, "0.5 m", "Of its round side."),
    VALUE(MOTION, "height", height, KILN_METRES, 0.001, FAR, TIME, "1 m",
          "Along the axis, end to end."),
    REFLECTANCE,
    COLLIDING,
    END,
};

static const struct kiln_option capsule[] = {
    VECTOR(MOTION, "center", center, KILN_METRES, -FAR, FAR, TIME, "[0, 1, 0]", "Centre."),
    VECTOR(MOTION, "axis", axis, KILN_PLAIN, -FAR, FAR, TIME, "[0, 1, 0]",
           "Along it; of any length but 0."),
    VALUE(MOTION, "radius", radius, KILN_METRES, 0.001, FAR, TIME, "0.5 m",
          "Of its side and ends."),
    VALUE(MOTION, "height", height, KILN_METRES, 0.001, FAR, TIME, "1 m",
          "Along the axis, between the centres of its round ends."),
    REFLECTANCE,
    COLLIDING,
    END,
};

static const struct kiln_option plane[] = {
    VECTOR(MOTION, "center", center, KILN_METRES, -FAR, FAR, TIME, "[0, 0, 0]",
           "A place on it, about which it turns."),
    VECTOR(MOTION, "normal", axis, KILN_PLAIN, -FAR, FAR, TIME, "[0, 1, 0]",
           "Away from it; of any length but 0."),
    REFLECTANCE,
    BOOLEAN(LOOK, "visible", visible, "true", "False: particles alone meet it."),
    COLLIDING,
    END,
};

static const struct kiln_option animation[] = {
    {ROW(MOTION, "clip", clip, AT(animation.clip), "0",
         "Its name in the file, or its number from 0.")},
    VALUE(MOTION, "start", animation.start, KILN_SECONDS, -FAR, FAR, 0, "0 s",
          "Where in it the mesh is at clip time 0."),
    VALUE(MOTION, "speed", animation.speed, KILN_PLAIN, -1000, 1000, 0, "1",
          "Factor on how fast it plays; below 0 backwards."),
    BOOLEAN(MOTION, "loop", animation.loop, "true",
            "From its end it goes on at its start; else it stays."),
    END,
};

static const char *const colliders[] = {"field", "volume", "depth_maps", NULL};
static const char *const sides[] = {"one", "two", NULL};

static const struct kiln_option direction = {
    ROW(MOTION, "direction", vector, 0, NULL,
        "From which the mesh is seen, and from its opposite."),
    LIMITS(KILN_PLAIN, -FAR, FAR)};

static const struct kiln_option depth_maps[] = {
    {ROW(MOTION, "directions", list, AT(depth_directions), "[[1, 0, 0], [0, 1, 0], [0, 0, 1]]",
         "In the frame of the mesh, of any length but 0; each gives a front and a back."),
     .item = &direction, .item_size = sizeof(struct kiln_value3),
     .count_offset = AT(depth_direction_count), .max_count = KILN_MAX_DEPTH_DIRECTIONS},
    INTEGER(MOTION, "resolution", depth_resolution, KILN_MIN_DEPTH_RESOLUTION,
            KILN_MAX_DEPTH_RESOLUTION, "128", "Samples along each edge of a map."),
    END,
};

static const char *const gathers[] = {
    [KILN_GATHER_NEAR] = "near",
    [KILN_GATHER_ALL] = "all",
    NULL,
};

static const struct kiln_option paint[] = {
    INTEGER(MOTION, "size", paint.size, KILN_MIN_CHART, KILN_MAX_CHART, "512",
            "Texels along an edge of its texture; a power of two."),
    CHOICE(
        LOOK, "gather", paint.gather, gathers, "near",
        "near brings splats to the texels that they may reach; all has each texel look at all of "
        "them, as the paper does. They paint the same."),
    INTEGER(MOTION, "per_step", paint.per_step, 0, KILN_MAX_PARTICLES, "0",
            "Particles whose turn it is to paint in a step, one after the other; what several of "
            "a particle's splats would be is then the last. 0: all."),
    END,
};

static const struct kiln_option mesh[] = {
    {ROW(MOTION, "file", mesh, AT(file), NULL,
         "Triangles in an OBJ, glTF or GLB file, in metres and y up; its materials are left out.")},
    VECTOR(MOTION, "position", center, KILN_METRES, -FAR, FAR, TIME, "[0, 0, 0]",
           "Where the origin of the file lies."),
    VECTOR(MOTION, "rotation", rotation, KILN_ANGLE, KILN_DEG(-3600), KILN_DEG(3600), TIME,
           "[0, 0, 0]", "About x, then about y, then about z."),
    VALUE(MOTION, "scale", scale, KILN_PLAIN, 0.000001, FAR, TIME, "1",
          "Metres for a unit of the file."),
    {ROW(MOTION, "animation", switch, 0, "none",
         "An animation of the glTF or GLB file: nodes, and bones that vertices follow."),
     .members = animation, .count_offset = AT(animation.enabled)},
    REFLECTANCE,
    BOOLEAN(MOTION, "collide", collide, "false",
            "Particles of systems that collide bounce off it."),
    RUBBING,
    CHOICE(
        MOTION, "collider", collider, colliders, "field",
        "What they collide with: field, a lattice of distances, made once, of a mesh that is "
        "closed (UberFlow 2004, 4.6); volume, cells that in each step take up planes of any "
        "mesh, and how these move (Drone 2007, 7.5.2); depth_maps, its fronts and backs from some "
        "directions, which fill hollows that none of them looks into (Heinz 2019, 2.5.1)."),
    INTEGER(MOTION, "cells", cells, KILN_MIN_FIELD_CELLS, KILN_MAX_FIELD_CELLS, "48",
            "Of that lattice, along the mesh's longest edge; what is thinner than a cell particles "
            "may miss."),
    VECTOR(MOTION, "heading", heading, KILN_PLAIN, -FAR, FAR, TIME, "[0, -1, 0]",
           "Of a volume, where most particles go; a cell keeps the plane that they meet first, of "
           "those that face them (Drone 2007, 7.5.2.3). Of any length but 0."),
    CHOICE(MOTION, "sides", sides, sides, "one",
           "Of a volume's planes: one, what is behind is put in front, for closed meshes; two, "
           "they are met from both sides, for sheets."),
    GROUP(MOTION, "depth_maps", 0, depth_maps,
          "Of collider depth_maps; nothing is too thin for them, and the mesh need not be closed."),
    {ROW(MOTION, "paint", switch, 0, "none",
         "It takes paint of the systems that have some (Drone 2007, 7.6.1). The file has texture "
         "coordinates, from 0 to 1, by which no two triangles overlap."),
     .members = paint, .count_offset = AT(paint.enabled)},
    END,
};

static const struct kiln_option terrain[] = {
    {ROW(MOTION, "image", picture, AT(file), "none",
         "Heights by how bright a picture is, its top towards -z; none: hills out of noise.")},
    VECTOR(MOTION, "position", center, KILN_METRES, -FAR, FAR, 0, "[0, 0, 0]",
           "The middle, and where black or the deepest valley lies."),
    VECTOR(MOTION, "size", size, KILN_METRES, 0.001, FAR, 0, "[20, 2, 20]",
           "Width, height from black to white or from valley to peak, and depth."),
    {ROW(MOTION, "samples", pair, AT(samples), "[129, 129]",
         "Points along x and z, of which every four carry two triangles."),
     LIMITS(KILN_PLAIN, 2, KILN_MAX_TERRAIN_EDGE)},
    VALUE(MOTION, "hills", hills, KILN_METRES, 0.001, FAR, 0, "8 m", "Size of the largest hills."),
    INTEGER(MOTION, "octaves", octaves, 1, KILN_MAX_TERRAIN_OCTAVES, "6",
            "Layers of ever smaller hills."),
    VALUE(MOTION, "roughness", roughness, KILN_PLAIN, 0, 1, 0, "0.45",
          "Height of a layer, in parts of the one before."),
    VALUE(MOTION, "ridges", ridges, KILN_PLAIN, 0, 1, 0, "0",
          "From round hills to crests above valleys."),
    INTEGER(MOTION, "seed", seed, 0, 1000000, "1", "Another landscape."),
    REFLECTANCE,
    BOOLEAN(MOTION, "collide", collide, "true",
            "Particles of systems that collide bounce off it, and off the sides of all that is "
            "below."),
    RUBBING,
    END,
};

static const struct kiln_option_kind object_kinds[] = {
    {.name = "box", .value = KILN_OBJECT_BOX, .members = box, .help = "A box."},
    {.name = "sphere", .value = KILN_OBJECT_SPHERE, .members = sphere, .help = "A sphere."},
    {.name = "cylinder",
     .value = KILN_OBJECT_CYLINDER,
     .members = cylinder,
     .help = "A cylinder with flat ends, along any axis."},
    {.name = "capsule",
     .value = KILN_OBJECT_CAPSULE,
     .members = capsule,
     .help = "A cylinder with round ends, along any axis."},
    {.name = "plane",
     .value = KILN_OBJECT_PLANE,
     .members = plane,
     .help =
         "A plane without end, and all that is behind it: where the sun is there, none shines."},
    {.name = "mesh",
     .value = KILN_OBJECT_MESH,
     .members = mesh,
     .help = "A mesh from a file; a scene has at most 8, terrain among them."},
    {.name = "terrain",
     .value = KILN_OBJECT_TERRAIN,
     .members = terrain,
     .help = "A landscape, from a picture or of noise (UberFlow 2004, 4.6)."},
    {.name = NULL},
};

static const struct kiln_option object = {.name = "object",
                                          .type = &kiln_type_kind,
                                          .parts = IF_OBJECT_IS_MET,
                                          .kinds = object_kinds,
                                          .kind_offset = AT(kind)};

#undef AT
#define AT(field) offsetof(struct kiln_light, field)

static const struct kiln_option point[] = {
    VECTOR(LOOK, "position", position, KILN_METRES, -FAR, FAR, TIME, "[0, 2, 0]", "Where it is."),
    COLOR(LOOK, "color", color, 1000000, TIME, "1", "Light that arrives 1 m away."),
    VALUE(LOOK, "radius", radius, KILN_METRES, 0.001, FAR, TIME, "0.2 m",
          "Size, which bounds the light nearby."),
    END,
};

static const struct kiln_option_kind light_kinds[] = {
    {.name = "point", .members = point, .help = "Shines to all sides, without a shadow."},
    {.name = NULL},
};

static const struct kiln_option light = {
    .name = "light", .type = &kiln_type_kind, .kinds = light_kinds, .kind_offset = KILN_KIND_NONE};

#undef AT
#define AT(field) offsetof(struct kiln_backdrop, field)

static const struct kiln_option sky[] = {
    COLOR(LOOK, "top", sky_top, 1000, TIME, "[0.02, 0.03, 0.05]", "Overhead."),
    COLOR(LOOK, "horizon", sky_horizon, 1000, TIME, "[0.12, 0.13, 0.16]", "At eye level."),
    {ROW(LOOK, "image", picture, AT(sky_image), "none",
         "The whole sphere around the scene as one picture, left to right and top to bottom, in "
         "place of the gradient; its middle lies towards -z. Its averages light the scene.")},
    VALUE(LOOK, "rotation", sky_rotation, KILN_ANGLE, KILN_DEG(-3600), KILN_DEG(3600), TIME,
          "0 deg", "Turns the image about y."),
    VALUE(LOOK, "intensity", sky_intensity, KILN_PLAIN, 0, 1000000, TIME, "1",
          "Factor on the image."),
    END,
};

static const struct kiln_option floor_rows[] = {
    COLOR(LOOK, "color", floor_color, 1, TIME, "[0.35, 0.34, 0.33]",
          "Part of the light that it reflects."),
    VALUE(MOTION, "height", floor_height, KILN_METRES, -FAR, FAR, TIME, "0 m",
          "May vary only while it does not collide."),
    VALUE(LOOK, "checker", floor_checker, KILN_METRES, 0, FAR, TIME, "0 m",
          "Edge of lighter and darker squares; 0 is plain."),
    {ROW(LOOK, "image", picture, AT(floor_image), "none",
         "A picture that repeats, its top towards -z, in place of colour and squares.")},
    VALUE(LOOK, "tile", floor_tile, KILN_METRES, 0.001, FAR, TIME, "1 m", "Width of the picture."),
    VALUE(LOOK, "gloss", floor_gloss, KILN_PLAIN, 0, 10, TIME, "0",
          "Mirrors sky, lights and objects but meshes as water does, times this; particles by the "
          "light that they shed (look.light)."),
    VALUE(LOOK, "roughness", floor_roughness, KILN_PLAIN, 0, 1, TIME, "0.3",
          "How wide gloss spreads lights."),
    VALUE(LOOK, "wave_height", floor_wave_height, KILN_METRES, 0, 100, TIME, "0 m",
          "Of waves that tilt what gloss mirrors, trough to crest; the floor itself stays flat."),
    VALUE(LOOK, "wave_length", floor_wave_length, KILN_METRES, 0.001, 10000, TIME, "1 m",
          "Of the longest waves; smaller ones ride on them."),
    BOOLEAN(MOTION, "collide", floor_collide, "true",
            "Particles of systems that collide bounce off it."),
    VALUE(MOTION, "restitution", floor_restitution, KILN_FRACTION, 0, 1, TIME, "1",
          "Factor on the restitution of what bounces off it."),
    VALUE(MOTION, "friction", floor_friction, KILN_PLAIN, 0, 100, TIME, "1",
          "Factor on the friction of what touches it."),
    END,
};

static const struct kiln_option sun[] = {
    VECTOR(LOOK, "direction", sun_direction, KILN_PLAIN, -FAR, FAR, TIME, "[0.5, 1, 0.3]",
           "Towards the sun; of any length but 0."),
    COLOR(LOOK, "color", sun_color, 1000000, TIME, "[0.8, 0.75, 0.65]", "Its light; 0 for none."),
    VALUE(LOOK, "size", sun_size, KILN_ANGLE, 0, KILN_DEG(30), TIME, "0 deg",
          "Its diameter in the sky: the larger, the softer are the edges of shadows."),
    END,
};

const struct kiln_option kiln_options_backdrop[] = {
    BOOLEAN(LOOK, "transparent", transparent, "false",
            "Pictures with alpha instead of a sky; a floor stays, unless it is none."),
    GROUP(LOOK, "sky", 0, sky, "A gradient or an image."),
    {ROW(IF_FLOOR_IS_MET, "floor", switch, 0, "{}", "An endless plane."), .members = floor_rows,
     .count_offset = AT(floor_enabled)},
    GROUP(LOOK, "sun", 0, sun, "The one light with a shadow."),
    VALUE(LOOK, "haze", haze, KILN_PER_METRE, 0, 100, TIME, "0.02",
          "How fast the floor fades into the horizon."),
    {ROW(MOTION, "objects", list, AT(objects), "[]", "What stands on the floor."), .item = &object,
     .item_size = sizeof(struct kiln_object), .count_offset = AT(object_count),
     .max_count = KILN_MAX_OBJECTS},
    {ROW(LOOK, "lights", list, AT(lights), "[]", "Lights besides the sun."), .item = &light,
     .item_size = sizeof(struct kiln_light), .count_offset = AT(light_count),
     .max_count = KILN_MAX_LIGHTS},
    END,
};
