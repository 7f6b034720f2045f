/* Checks the light and the shadows of two kinds of lamps, spots and rectangles, on the backdrop.
 * Each backdrop technique is compared with a ray caster in double precision, which divides a
 * rectangle into many small parts and casts a ray to each. If this fails, such lamps light the
 * wrong places, or too brightly or too darkly. */
#include <math.h>
#include <stdlib.h>

#include "support/backdrops.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/ray_caster.h"

#define LIGHTS "  sun: {color: 0}\n  lights:\n"

#define BOX_TEXT                                                                                   \
    "  objects:\n"                                                                                 \
    "    - box: {center: [0, 0.6, 0], size: [0.8, 0.6, 0.5], color: 0.8}\n"

static const struct vec FLOOR_COLOR = {{0.6, 0.5, 0.4}};

/* The box of BOX_TEXT, for the ray caster. */
static const struct shape A_BOX = {
    .kind = BOX, .center = {{0, 0.6, 0}}, .half_size = {{0.4, 0.3, 0.25}}, .albedo = {{0.8}}};

/* The position of the spots, m: above the box and beside it. */
static const struct vec ABOVE = {{1.2, 2.2, 0.8}};

static double degrees(double angle)
{
    return angle * acos(-1.0) / 180;
}

/* Compares the picture of a scene with the ray caster. text: the scene; shape: its only shape
 * besides the floor, for the ray caster; e: the lamp and the tolerance, for the ray caster. */
static void check(void *device, const char *text, const struct shape *shape, struct expected e)
{
    const struct shape shapes[] = {{.kind = FLOOR, .albedo = FLOOR_COLOR}, *shape};
    e.shapes = shapes;
    e.count = 2;
    struct picture p = draw(device, text);
    compare(&p, &e, 3);
    finish(&p);
}

/* ---- spots ----------------------------------------------------------------------------------- */

#define SPOT(more)                                                                                 \
    HEAD LIGHTS "    - spot: {position: [1.2, 2.2, 0.8], color: 4, direction: [-1.2, -2, -0.8]"    \
                ", " more "}\n" BOX_TEXT

/* Returns the ray caster's lamp for SPOT. radius: of the lamp, m; inner, outer: angles between the
 * axis and the inner and outer cone, degrees. */
static struct expected spot(double radius, double inner, double outer)
{
    return (struct expected){.lamp = ABOVE,
                             .lamp_radius = radius,
                             .lamp_color = 4,
                             .lamp_facing = unit((struct vec){{-1.2, -2, -0.8}}),
                             .lamp_inner = degrees(inner),
                             .lamp_outer = degrees(outer),
                             .tolerance = 0.01};
}

/* A spot has full light in its inner cone and none outside its outer cone; between them the light
 * fades. The outer cone has the half angle `angle`, and the inner one angle * (1 - softness). */
static void a_spot_lights_its_cone(void **state)
{
    check(*state, SPOT("radius: 0.001 m, angle: 25 deg, softness: 0.4"), &A_BOX,
          spot(0.001, 15, 25));
    check(*state, SPOT("radius: 0.2 m, angle: 40 deg, softness: 1"), &A_BOX, spot(0.2, 0, 40));
    check(*state, SPOT("radius: 0.001 m, angle: 20 deg, softness: 0.01"), &A_BOX,
          spot(0.001, 19.8, 20));
}

#define SWEEP(start, end)                                                                          \
    HEAD LIGHTS "    - spot: {direction: {keys: {0 s: " start ", 1 s: " end "}}, angle: {keys: "   \
                "{0 s: 20 deg, 1 s: 60 deg}}, softness: {keys: {0 s: 0, 1 s: 1}}}\n"

/* A spot's direction, angle and softness may have key frames. At time 0 it must shine like a spot
 * with the constant values of the first key frames, and light nothing if its first direction points
 * up. */
static void a_spot_has_keys_over_time(void **state)
{
    const double still = sum_of_red(*state, HEAD LIGHTS "    - spot: {direction: [0.3, -1, 0], "
                                                        "angle: 20 deg, softness: 0}\n");
    const double keyed = sum_of_red(*state, SWEEP("[0.3, -1, 0]", "[1, 0, 0]"));
    const double away = sum_of_red(*state, SWEEP("[0, 1, 0]", "[0.3, -1, 0]"));
    assert_true(still > 10 && fabs(keyed - still) <= 1e-5 * still && away == 0);
}

/* The edge of a cone without softness is antialiased: some pixels on it have only a part of the
 * light. The lamp is 30 m above the floor, so within its cone of 2 degrees each pixel has nearly
 * the light 0.6 * 1500 / 30^2: albedo times intensity, over the square of the distance. */
static void the_edge_of_a_cone_is_antialiased(void **state)
{
    struct picture p =
        draw(*state, HEAD LIGHTS "    - spot: {position: [0, 30, 0], color: 1500, radius: 0.001 m, "
                                 "angle: 2 deg, softness: 0}\n");
    int between = 0, lit = 0, dark = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const double part = (double)p.colors[4 * i] / (0.6 * 1500 / 900);
        between += part > 0.1 && part < 0.9;
        lit += part > 0.95;
        dark += part == 0;
    }
    finish(&p);
    print_message("%d lit, %d between, %d dark\n", lit, between, dark);
    assert_true(between >= 40 && lit > 300 && dark > 3000);
}

/* ---- rectangles ------------------------------------------------------------------------------ */

#define PANEL(more) HEAD LIGHTS "    - rectangle: {color: 3, " more "}\n"

/* Returns the ray caster's lamp for PANEL. center: of the rectangle, m; facing: the unit direction
 * in which it shines; right, up: the vectors from its centre to the middles of its edges, m. */
static struct expected panel(struct vec center, struct vec facing, struct vec right, struct vec up)
{
    return (struct expected){.lamp = center,
                             .lamp_color = 3,
                             .lamp_facing = facing,
                             .lamp_right = right,
                             .lamp_up = up,
                             .tolerance = 0.004};
}

/* A box that replaces the shape in scenes without one. It lies so far below the floor that it is
 * not seen and shadows nothing. */
static const struct shape NOTHING = {
    .kind = BOX, .center = {{0, -50, 0}}, .half_size = {{0.1, 0.1, 0.1}}, .albedo = {{0.8}}};

/* A rectangle lights the floor as Lambert's law says: from above, halfway below the floor, where
 * its lower half lights nothing, and rotated. */
static void a_rectangle_lights_as_lambert_says(void **state)
{
    check(*state, PANEL("center: [0.3, 1.5, 0], width: 1.5 m, height: 0.5 m"), &NOTHING,
          panel((struct vec){{0.3, 1.5, 0}}, (struct vec){{0, -1, 0}}, (struct vec){{0.75}},
                (struct vec){{0, 0, 0.25}}));
    check(*state,
          PANEL("center: [0, 0, -1.2], direction: [0, 0, 1], width: 2 m, height: 1.6 m, "
                "shadow: false"),
          &NOTHING,
          panel((struct vec){{0, 0, -1.2}}, (struct vec){{0, 0, 1}}, (struct vec){{1}},
                (struct vec){{0, 0.8, 0}}));
    const double c = sqrt(0.5);
    check(*state,
          PANEL("center: [-0.5, 0.9, 0], direction: [1, -1, 0], up: [1, 1, 1], width: 0.4 m, "
                "height: 1 m"),
          &NOTHING,
          panel((struct vec){{-0.5, 0.9, 0}}, (struct vec){{c, -c, 0}},
                (struct vec){
                    {-0.2 * c * c * 2 / sqrt(6), -0.2 * c * c * 2 / sqrt(6), 0.2 * 2 / sqrt(6)}},
                (struct vec){{0.5 / sqrt(3), 0.5 / sqrt(3), 0.5 / sqrt(3)}}));
}

/* In the light of a rectangle, a box casts the right shadow, with the right penumbra. */
static void a_box_hides_a_rectangle(void **state)
{
    struct expected e = panel((struct vec){{0.3, 2.2, 0}}, (struct vec){{0, -1, 0}},
                              (struct vec){{0.3}}, (struct vec){{0, 0, 0.3}});
    e.tolerance = 0.03;
    check(*state, PANEL("center: [0.3, 2.2, 0], width: 0.6 m, height: 0.6 m") BOX_TEXT, &A_BOX, e);
}

#define ON_A_WALL(wall)                                                                            \
    PANEL("center: [0, 0.8, -1], direction: [0, 0, 1], width: 1 m, height: 0.6 m")                 \
    "  objects:\n    - box: {center: [0, 0.8, " wall "], size: [3, 3, 0.2], color: 0}\n"

/* A wall that a rectangle hangs on does not shadow its light, although it touches the rectangle
 * from behind. A wall just in front of the rectangle does. */
static void a_wall_carries_a_rectangle(void **state)
{
    const double alone = sum_of_red(*state, ON_A_WALL("-9"));
    const double carried = sum_of_red(*state, ON_A_WALL("-1.1"));
    const double hidden = sum_of_red(*state, ON_A_WALL("-0.85"));
    assert_true(alone > 50 && carried > 0.9 * alone && hidden < 0.02 * alone);
}

/* A rectangle below the floor lights nothing. A rectangle that stands on the floor or lies in it is
 * not shadowed by the floor: it lights as much as with shadows switched off. */
static void the_floor_hides_rectangles_below_it(void **state)
{
    static const char *const texts[] = {
        PANEL("center: [0, 0.5, -1], direction: [0, 0, 1]"),
        PANEL("center: [0, 0.5, -1], direction: [0, 0, 1], shadow: false"),
        PANEL("center: [0, -0.6, -1], direction: [0, 0, 1]"),
        PANEL("center: [0, 0, 0], direction: [0, 1, 0], width: 3 m, height: 3 m") BOX_TEXT,
        PANEL("center: [0, 0, 0], direction: [0, 1, 0], width: 3 m, height: 3 m, "
              "shadow: false") BOX_TEXT,
    };
    double sums[5];
    for (int i = 0; i < 5; i++)
        sums[i] = sum_of_red(*state, texts[i]);
    assert_true(sums[0] > 50 && fabs(sums[0] - sums[1]) < 0.01 * sums[1] && sums[2] == 0);
    assert_true(sums[4] > 5 && fabs(sums[3] - sums[4]) < 0.01 * sums[4]);
}

int main(int argc, char **argv)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(a_spot_lights_its_cone),
        test_on_device(a_spot_has_keys_over_time),
        test_on_device(the_edge_of_a_cone_is_antialiased),
        test_on_device(a_rectangle_lights_as_lambert_says),
        test_on_device(a_box_hides_a_rectangle),
        test_on_device(a_wall_carries_a_rectangle),
        test_on_device(the_floor_hides_rectangles_below_it),
    };
    return backdrops_run("lamp_kinds", tests, sizeof tests / sizeof *tests, false, argc, argv);
}
