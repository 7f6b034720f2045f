/* Checks ribbons (look.shape: ribbon) by particles that are placed by hand: a ribbon would cover
 * another area than its width and length say, its parts would overlap or leave cracks where they
 * meet, its texture would lie elsewhere, or it would go on over a gap or a dead particle. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "support/cmocka.h"
#include "support/device.h"
#include "support/drawing.h"
#include "support/frame.h"
#include "support/parts.h"

enum { WIDTH = 128, HEIGHT = 96, PIXELS = WIDTH * HEIGHT, STEP = 30, COUNT = 5 };

/* The particles are 5 m from the camera, where 1 m is 40 px. */
static const char SCENE[] =
    "kiln: 1\n"
    "output: {size: [128, 96], fps: 30, frames: 100}\n"
    "simulation: {rate: 60}\n"
    "camera: {position: [0, 0, 5], target: [0, 0, 0], fov: 26.991467 deg, near: 0.1}\n"
    "backdrop: {haze: 0}\n"
    "systems:\n"
    "  a:\n"
    "    emit: {bursts: {0 s: 5}, life: 10 s}\n"
    "    look:\n"
    "      shape: ribbon\n"
    "      size: 0.25 m\n"
    "      soft: 0\n"
    "      fade: {in: 0, out: 0}\n"
    "      near_fade: 0 m\n"
    "      ribbon: {smooth: 1, taper: {tail: 1}}\n";

static const double PIXELS_A_METRE = 40;

static double sum_of(const struct kiln_image *image, int channel)
{
    double sum = 0;
    for (int p = 0; p < PIXELS; p++)
        sum += (double)image->host[4 * p + channel];
    return sum;
}

static double most_of(const struct kiln_image *image, int channel)
{
    double most = 0;
    for (int p = 0; p < PIXELS; p++)
        most = fmax(most, (double)image->host[4 * p + channel]);
    return most;
}

/* Draws the ribbon through particles at the places, of which those with a bit in `dead` are dead.
 */
static void draw_ribbon(struct drawing *d, const float3 places[COUNT], uint32_t dead)
{
    struct kiln_particle particles[COUNT];
    for (uint32_t i = 0; i < COUNT; i++) {
        particles[i] = drawing_particle(i, places[i], (float3){0.0f, 0.0f, 0.0f});
        if (dead >> i & 1)
            particles[i] = (struct kiln_particle){{0}, {0}};
    }
    drawing_place(d, particles, COUNT, STEP);
    drawing_run(d, COUNT, 1e6f);
}

/* Finds places on a line through (0.01, 0.02) at an angle, from one end to the other. */
static void place_on_line(double length_m, double angle, float3 places[COUNT])
{
    for (int i = 0; i < COUNT; i++) {
        const double along = length_m * (i / (COUNT - 1.0) - 0.5);
        places[i] =
            (float3){(float)(0.01 + along * cos(angle)), (float)(0.02 + along * sin(angle)), 0.0f};
    }
}

static void a_straight_ribbon_covers_its_area(void **state)
{
    static const char *const smooth[] = {"systems.a.look.ribbon.smooth=1",
                                         "systems.a.look.ribbon.smooth=3",
                                         "systems.a.look.ribbon.facing=normal"};
    for (size_t k = 0; k < sizeof smooth / sizeof *smooth; k++) {
        const char *const overrides[] = {smooth[k], "systems.a.look.axis=[0, 0, 1]"};
        struct drawing d;
        drawing_init(&d, *state, SCENE, overrides, 2);
        for (int i = 0; i <= 12; i++) {
            const double angle = i * acos(-1) / 12;
            float3 places[COUNT];
            place_on_line(2, angle, places);
            draw_ribbon(&d, places, 0);
            const double want = 2 * 0.25 * PIXELS_A_METRE * PIXELS_A_METRE;
            const double found = sum_of(&d.color, 3);
            if (fabs(found / want - 1) > 1e-3)
                print_message("%s, %d deg: %g px for %g\n", smooth[k], 15 * i, found, want);
            assert_true(fabs(found / want - 1) <= 1e-3);
        }
        drawing_finish(&d);
    }
}

/* A ribbon that is thinner than a pixel has the light of its area, too. */
static void thin_ribbons_are_faint(void **state)
{
    static const char *const overrides[] = {"systems.a.look.size=0.01 m"};
    struct drawing d;
    drawing_init(&d, *state, SCENE, overrides, 1);
    for (int i = 0; i <= 6; i++) {
        float3 places[COUNT];
        place_on_line(2, i * acos(-1) / 12, places);
        draw_ribbon(&d, places, 0);
        const double want = 2 * 0.01 * PIXELS_A_METRE * PIXELS_A_METRE;
        assert_true(fabs(sum_of(&d.color, 3) / want - 1) <= 0.02);
    }
    drawing_finish(&d);
}

/* Joints are mitred: straight segments cover their width times their length, wherever they bend.
 * With half of the opacity, any overlap would be more opaque, and any crack less area. */
static void bends_neither_overlap_nor_crack(void **state)
{
    static const char *const overrides[] = {"systems.a.look.opacity=0.5",
                                            "systems.a.look.axis=[0, 0, 1]",
                                            "systems.a.look.ribbon.facing=normal"};
    struct drawing d;
    drawing_init(&d, *state, SCENE, overrides, 3);
    for (int i = 1; i <= 8; i++) {
        const double turn = i * 10 * acos(-1) / 180;
        float3 places[COUNT] = {{-0.9f, -0.7f, 0.0f}};
        double angle = 0.13;
        for (int k = 1; k < COUNT; k++) {
            places[k].x = places[k - 1].x + (float)(0.55 * cos(angle));
            places[k].y = places[k - 1].y + (float)(0.55 * sin(angle));
            places[k].z = 0.0f;
            angle += k == 2 ? -turn : turn;
        }
        draw_ribbon(&d, places, 0);
        const double want = 4 * 0.55 * 0.25 * PIXELS_A_METRE * PIXELS_A_METRE * 0.5;
        const double found = sum_of(&d.color, 3);
        if (fabs(found / want - 1) > 2e-3)
            print_message("bends of %d deg: %g px for %g\n", 10 * i, found, want);
        assert_true(fabs(found / want - 1) <= 2e-3);
        assert_true(most_of(&d.color, 3) <= 0.5 + 1e-4);
    }
    drawing_finish(&d);
}

/* A curve whose parts meet on rows and columns of pixels, exactly in their middles. */
static void curves_neither_overlap_nor_crack(void **state)
{
    static const char *const overrides[] = {"systems.a.look.opacity=0.5",
                                            "systems.a.look.ribbon.smooth=4"};
    struct drawing d;
    drawing_init(&d, *state, SCENE, overrides, 2);
    float3 places[COUNT];
    place_on_line(2, 0, places);
    for (int i = 0; i < COUNT; i++)
        places[i].x = (float)((20 * (i - 2) + 0.5) / PIXELS_A_METRE);
    draw_ribbon(&d, places, 0);
    assert_true(fabs(sum_of(&d.color, 3) / (2 * 0.25 * 1600 * 0.5) - 1) <= 1e-3);
    assert_true(most_of(&d.color, 3) <= 0.5 + 1e-4);
    for (int i = 0; i < COUNT; i++) { /* an arc of 180 degrees about the middle */
        const double angle = acos(-1) * i / (COUNT - 1.0);
        places[i] = (float3){(float)(0.7 * cos(angle)), (float)(0.7 * sin(angle) - 0.3), 0.0f};
    }
    draw_ribbon(&d, places, 0);
    const double arc = acos(-1) * 0.7 * 0.25 * 1600 * 0.5; /* of the circle through the points */
    assert_true(fabs(sum_of(&d.color, 3) / arc - 1) <= 0.02);
    assert_true(most_of(&d.color, 3) <= 0.5 + 1e-4);
    drawing_finish(&d);
}

/* The texture's red grows along the ribbon from the first to the last particle of the burst, and
 * its green across it. */
static void the_texture_is_stretched_over_the_ribbon(void **state)
{
    struct drawing d;
    drawing_init(&d, *state, SCENE, NULL, 0);
    float3 places[COUNT];
    place_on_line(2, 0, places);
    draw_ribbon(&d, places, 0);
    const int row = HEIGHT / 2 - 1;
    for (int x = WIDTH / 2 - 36; x < WIDTH / 2 + 36; x += 4) {
        const float *pixel = d.color.host + 4 * (row * WIDTH + x);
        const double along = ((x + 0.5 - WIDTH / 2) / PIXELS_A_METRE - 0.01) / 2 + 0.5;
        assert_true(fabs((double)pixel[0] - along) < 0.04);
        assert_true(fabs((double)pixel[1] - 0.5) < 0.1);
    }
    drawing_finish(&d);
}

static void deaths_and_gaps_cut(void **state)
{
    const double segment = 0.5 * 0.25 * PIXELS_A_METRE * PIXELS_A_METRE;
    struct drawing d;
    drawing_init(&d, *state, SCENE, NULL, 0);
    float3 places[COUNT];
    place_on_line(2, 0.3, places);
    draw_ribbon(&d, places, 1u << 3);
    assert_true(fabs(sum_of(&d.color, 3) / (2 * segment) - 1) <= 2e-3);
    draw_ribbon(&d, places, 1u << 1 | 1u << 3);
    assert_true(sum_of(&d.color, 3) == 0.0);
    drawing_finish(&d);

    static const char *const overrides[] = {"systems.a.look.ribbon.gap=0.6 m"};
    drawing_init(&d, *state, SCENE, overrides, 1);
    draw_ribbon(&d, places, 0);
    assert_true(fabs(sum_of(&d.color, 3) / (4 * segment) - 1) <= 2e-3);
    places[4].x += 0.2f;
    draw_ribbon(&d, places, 0);
    assert_true(fabs(sum_of(&d.color, 3) / (3 * segment) - 1) <= 2e-3);
    drawing_finish(&d);
}

/* ---- ribbons of a whole scene ---------------------------------------------------------------- */

/* Trails that bounce and are joined to their parents, a repeated texture, straight segments of half
 * opacity, lit by the sun behind haze; a bolt with hairpins; a strip in a plane. */
static const char TRAILS[] =
    "kiln: 1\n"
    "output: {size: [320, 180], fps: 30, frames: 90}\n"
    "camera: {position: [0, 2, 9], target: [0, 1.6, 0], fov: 40 deg}\n"
    "backdrop:\n"
    "  sun: {direction: [-0.5, 0.6, 0.4], color: [4, 3.5, 3]}\n"
    "  floor: {color: [0.2, 0.2, 0.2]}\n"
    "  haze: 0.03\n"
    "systems:\n"
    "  balls:\n"
    "    emit: {rate: 6, life: 2.2 s, speed: [5, 7], from: {cone: {angle: 25 deg, radius: 20 "
    "cm}}}\n"
    "    forces: [gravity: [0, -6, 0]]\n"
    "    collide: {slowdown: 0.7}\n"
    "    look: {shape: point, blend: add, size: 0.1 m}\n"
    "  tails:\n"
    "    emit: {parent: {system: balls, on: {trail: {per_metre: 3}}}, life: 1.2 s, speed: 0}\n"
    "    look: {shape: ribbon, atlas: 'builtin:band', size: 0.22 m, color: [0.6, 0.1, 0.05],\n"
    "           opacity: 0.5, lit: 1, fade: {in: 0, out: 0},\n"
    "           ribbon: {smooth: 1, texture: 0.5 m, taper: {tail: 1}}}\n"
    "  bolt:\n"
    "    emit: {bursts: {1.6 s: 24}, life: 1 s, speed: 0,\n"
    "           from: {line: {origin: [2.6, 1.5, 0], span: [0, 3, 0], ordered: true}}}\n"
    "    forces: [curl: {strength: 1.5, scale: 0.6 m, pull: 20}]\n"
    "    look: {shape: ribbon, atlas: 'builtin:trail', blend: add, color: [4, 6, 14], size: 0.1 "
    "m,\n"
    "           fade: {in: 0}, ribbon: {smooth: 2, taper: {tail: 1}}}\n"
    "  strip:\n"
    "    emit: {rate: 20, life: 1.5 s, speed: 1.2,\n"
    "           from: {point: {origin: [-3.2, 1.5, 0], direction: [0.3, 1, 0]}}}\n"
    "    forces: [curl: {strength: 1, scale: 1 m, pull: 2}]\n"
    "    look: {shape: ribbon, atlas: 'builtin:band', size: 0.4 m, color: [0.1, 0.5, 0.2],\n"
    "           axis: [0.2, 0, 1], ribbon: {facing: normal, taper: {tail: 1}}}\n";

static void all_techniques_draw_the_same_ribbons(void **state)
{
    static const enum kiln_raster_technique techniques[] = {
        KILN_RASTER_GEOMETRY, KILN_RASTER_INSTANCED, KILN_RASTER_TILED};
    static const char *const composes[] = {"post.compose=merged", "post.compose=oit",
                                           "post.compose=separate"};
    for (size_t k = 0; k < sizeof composes / sizeof *composes; k++) {
        struct frame_setting setting = {{composes[k]}, 1, FRAME_CPU, 0};
        struct kiln_picture *expected = frame_draw(*state, TRAILS, 120, &setting);
        for (size_t i = 0; i < sizeof techniques / sizeof *techniques; i++) {
            setting.techniques.raster = techniques[i];
            struct kiln_picture *found = frame_draw(*state, TRAILS, 120, &setting);
            const double fire = frame_difference(expected, found, FRAME_FIRE);
            const double smoke = frame_difference(expected, found, FRAME_SMOKE);
            print_message("%s, technique %zu: fire %.2g, smoke %.2g\n", composes[k], i, fire,
                          smoke);
            assert_true(fire <= 1e-3 && smoke <= 1e-3);
            kiln_picture_destroy(&found);
        }
        kiln_picture_destroy(&expected);
    }
}

int main(int argc, char **argv)
{
    static const struct CMUnitTest whole[] = {
        test_on_device(all_techniques_draw_the_same_ribbons),
    };
    struct test_list list = {.count = 0};
    test_list_add(&list, whole, 1);
    const int failed =
        test_list_run(&list, "ribbons", argc, argv, test_device_open, test_device_close);
    static const struct CMUnitTest tests[] = {
        test_on_device(a_straight_ribbon_covers_its_area),
        test_on_device(thin_ribbons_are_faint),
        test_on_device(bends_neither_overlap_nor_crack),
        test_on_device(curves_neither_overlap_nor_crack),
        test_on_device(the_texture_is_stretched_over_the_ribbon),
        test_on_device(deaths_and_gaps_cut),
    };
    return drawing_run_rasters(tests, sizeof tests / sizeof *tests, argv) + failed;
}
