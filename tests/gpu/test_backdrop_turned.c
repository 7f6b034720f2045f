/* Checks that each technique of the backdrop draws capsules, planes and rotated boxes, and their
 * shadows, as a ray caster in double precision does. If this fails, such objects or their shadows
 * have the wrong place, direction or brightness. */
#include <stddef.h>
#include <stdint.h>

#include "support/backdrops.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/ray_caster.h"

#define OBJECTS                                                                                    \
    "  objects:\n"                                                                                 \
    "    - box: {center: [-1.2, 0.6, 0.3], size: [0.5, 0.8, 0.4], color: 0.9,\n"                   \
    "            rotation: [20 deg, 50 deg, -35 deg]}\n"                                           \
    "    - box: {center: [1.5, 0.4, 0.4], size: [0.9, 0.1, 0.5], rotation: [0, 0, 25 deg],\n"      \
    "            color: 0.7}\n"                                                                    \
    "    - capsule: {center: [0.3, 0.6, 0.2], axis: [0.4, 2, 0.3], radius: 0.25 m,\n"              \
    "                height: 0.6 m, color: 0.8}\n"                                                 \
    "    - capsule: {center: [-0.4, 0.3, -0.9], axis: [1, 0, 0.2], radius: 0.2 m,\n"               \
    "                height: 1.2 m, color: 0.6}\n"                                                 \
    "    - plane: {center: [0, 0, -3], normal: [0.2, 1, 2], color: 0.5}\n"                         \
    "    - plane: {center: [0, 3, 0], normal: [-1, -1, 0.3], visible: false}\n"

static int shapes_of_scene(struct shape shapes[8])
{
    const double degree = acos(-1.0) / 180;
    const struct shape list[] = {
        {.kind = FLOOR, .albedo = {{0.6, 0.5, 0.4}}},
        {.kind = BOX,
         .center = {{-1.2, 0.6, 0.3}},
         .half_size = {{0.25, 0.4, 0.2}},
         .angles = {{20 * degree, 50 * degree, -35 * degree}},
         .albedo = {{0.9}}},
        {.kind = BOX,
         .center = {{1.5, 0.4, 0.4}},
         .half_size = {{0.45, 0.05, 0.25}},
         .angles = {{0, 0, 25 * degree}},
         .albedo = {{0.7}}},
        {.kind = CAPSULE,
         .center = {{0.3, 0.6, 0.2}},
         .axis = unit((struct vec){{0.4, 2, 0.3}}),
         .radius = 0.25,
         .half_height = 0.3,
         .albedo = {{0.8}}},
        {.kind = CAPSULE,
         .center = {{-0.4, 0.3, -0.9}},
         .axis = unit((struct vec){{1, 0, 0.2}}),
         .radius = 0.2,
         .half_height = 0.6,
         .albedo = {{0.6}}},
        {.kind = PLANE,
         .center = {{0, 0, -3}},
         .axis = unit((struct vec){{0.2, 1, 2}}),
         .albedo = {{0.5}}},
    };
    memcpy(shapes, list, sizeof list);
    return sizeof list / sizeof *list;
}

static void turned_shapes_match_c(void **state)
{
    struct shape shapes[8];
    struct expected e = {.shapes = shapes,
                         .count = shapes_of_scene(shapes),
                         .sun = unit((struct vec){{-0.6, 1, 0.5}}),
                         .tolerance = 0.03};
    struct picture p =
        draw(*state, HEAD "  sun: {direction: [-0.6, 1, 0.5], color: 3.14159265}\n" OBJECTS);
    compare(&p, &e, 1);
    finish(&p);
}

/* Shadows of a capsule equal the reference when the sun shines exactly along the capsule's axis.
 * All points of the axis then have the same distance from a shadow ray, and rounding decides which
 * point is found as the nearest; the shadow must not depend on it. The axis vector gets several
 * lengths to vary the rounding. */
static void capsules_along_the_sun_match_c(void **state)
{
    static const double lengths[] = {3, 5, 7};
    for (int i = 0; i < 3; i++) {
        const double k = lengths[i];
        const struct vec sun = unit((struct vec){{-0.31 * k, 0.77 * k, 0.53 * k}});
        const struct shape shapes[] = {
            {.kind = FLOOR, .albedo = {{0.6, 0.5, 0.4}}},
            {.kind = CAPSULE,
             .center = {{0.2, 1.2, 0.2}},
             .axis = sun,
             .radius = 0.3,
             .half_height = 0.4,
             .albedo = {{0.8}}},
        };
        struct expected e = {.shapes = shapes, .count = 2, .sun = sun, .tolerance = 0.03};
        char text[1024];
        snprintf(text, sizeof text,
                 HEAD "  sun: {direction: [-0.31, 0.77, 0.53], color: 3.14159265}\n"
                      "  objects:\n"
                      "    - capsule: {center: [0.2, 1.2, 0.2], axis: [%.2f, %.2f, %.2f],\n"
                      "                radius: 0.3 m, height: 0.8 m, color: 0.8}\n",
                 -0.31 * k, 0.77 * k, 0.53 * k);
        struct picture p = draw(*state, text);
        compare(&p, &e, 1);
        finish(&p);
    }
}

static void soft_shadows_match_c(void **state)
{
    struct shape shapes[8];
    struct expected e = {.shapes = shapes,
                         .count = shapes_of_scene(shapes),
                         .sun = unit((struct vec){{-0.6, 1, 0.5}}),
                         .sun_radius = 10 * acos(-1.0) / 180,
                         .tolerance = 0.09};
    struct picture p =
        draw(*state,
             HEAD "  sun: {direction: [-0.6, 1, 0.5], color: 3.14159265, size: 20 deg}\n" OBJECTS);
    compare(&p, &e, 3);
    finish(&p);
}

/* A plane hides the part of the sun's disc that is behind it, so that a sun which sets behind the
 * plane lights the floor with its whole disc, then with half of it, then not at all. */
static void planes_hide_the_sun(void **state)
{
    static const struct {
        const char *direction;
        double light; /* expected: albedo 0.6 * cosine * visible part of the disc */
    } suns[] = {{"[0, 1, 0]", 0.6}, {"[0, 1, -0.5]", 0.268328}, {"[0, 1, -1]", 0}};
    for (int i = 0; i < 3; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 HEAD "  sun: {direction: %s, color: 3.14159265, size: 10 deg}\n"
                      "  objects:\n    - plane: {center: [0, 0, -9], normal: [0, 0.5, 1]}\n",
                 suns[i].direction);
        struct picture p = draw(*state, text);
        double found = (double)p.colors[4 * ((HEIGHT - 4) * WIDTH + WIDTH / 2)];
        if (fabs(found - suns[i].light) > 0.01)
            fail_msg("sun %s: %g, expected %g", suns[i].direction, found, suns[i].light);
        finish(&p);
    }
}

int main(int argc, char **argv)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(turned_shapes_match_c),
        test_on_device(soft_shadows_match_c),
        test_on_device(capsules_along_the_sun_match_c),
        test_on_device(planes_hide_the_sun),
    };
    return backdrops_run("backdrop_turned", tests, sizeof tests / sizeof *tests, false, argc, argv);
}
