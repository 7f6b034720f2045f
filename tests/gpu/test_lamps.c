/* Checks the shadows that boxes, round shapes and meshes cast under a spherical lamp, drawn by GL
 * and by the CPU, against a ray caster in double precision that sends rays to all parts of the
 * lamp. If this fails, shadows of lamps have the wrong place or penumbra, or an object hides a lamp
 * that it should not. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "asset/geometry/mesh.h"
#include "support/backdrops.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/ray_caster.h"

#define LAMP(position, radius, more)                                                               \
    "  sun: {color: 0}\n"                                                                          \
    "  lights:\n"                                                                                  \
    "    - point: {position: " position ", color: 4, radius: " radius " m" more "}\n"

static const struct vec FLOOR_COLOR = {{0.6, 0.5, 0.4}};

/* Compares the picture of `text`, a scene of a floor, one shape and one lamp, with the ray caster.
 * lamp: the lamp's centre, m; radius: the lamp's radius, m; tolerance: the largest allowed absolute
 * difference of red light; step: only every step-th pixel of every step-th row is compared. */
static void check(void *device, const char *text, const struct shape *shape, struct vec lamp,
                  double radius, double tolerance, int step)
{
    const struct shape shapes[] = {{.kind = FLOOR, .albedo = FLOOR_COLOR}, *shape};
    const struct expected e = {.shapes = shapes,
                               .count = 2,
                               .lamp = lamp,
                               .lamp_radius = radius,
                               .lamp_color = 4,
                               .tolerance = tolerance};
    struct picture p = draw(device, text);
    compare(&p, &e, step);
    finish(&p);
}

/* Centre of the lamp in most tests, above the shape, m. */
static const struct vec ABOVE = {{1.2, 2.2, 0.8}};

static void a_box_hides_a_lamp(void **state)
{
    const struct shape box = {
        .kind = BOX, .center = {{0, 0.6, 0}}, .half_size = {{0.4, 0.3, 0.25}}, .albedo = {{0.8}}};
    check(*state,
          HEAD LAMP("[1.2, 2.2, 0.8]", "0.001",
                    "") "  objects:\n"
                        "    - box: {center: [0, 0.6, 0], size: [0.8, 0.6, 0.5], color: 0.8}\n",
          &box, ABOVE, 0.001, 0.01, 3);
    check(*state,
          HEAD LAMP("[1.2, 2.2, 0.8]", "0.4",
                    "") "  objects:\n"
                        "    - box: {center: [0, 0.6, 0], size: [0.8, 0.6, 0.5], color: 0.8}\n",
          &box, ABOVE, 0.4, 0.03, 3);
}

static void a_box_of_any_direction_hides_a_lamp(void **state)
{
    const double degree = acos(-1.0) / 180;
    const struct shape box = {.kind = BOX,
                              .center = {{0, 0.7, 0}},
                              .half_size = {{0.4, 0.3, 0.25}},
                              .angles = {{20 * degree, 35 * degree, -10 * degree}},
                              .albedo = {{0.8}}};
    check(*state,
          HEAD LAMP("[1.2, 2.2, 0.8]", "0.3", "") "  objects:\n"
                                                  "    - box: {center: [0, 0.7, 0], size: [0.8, "
                                                  "0.6, 0.5], rotation: [20 deg, 35 deg, "
                                                  "-10 deg], color: 0.8}\n",
          &box, ABOVE, 0.3, 0.03, 3);
}

static void round_shapes_hide_a_lamp(void **state)
{
    const struct shape sphere = {
        .kind = SPHERE, .center = {{0, 0.8, 0}}, .radius = 0.5, .albedo = {{0.8}}};
    const struct shape cylinder = {.kind = CYLINDER,
                                   .center = {{0, 0.8, 0}},
                                   .axis = unit((struct vec){{1, 0.4, 0.2}}),
                                   .radius = 0.25,
                                   .half_height = 0.6,
                                   .albedo = {{0.8}}};
    struct shape capsule = cylinder;
    capsule.kind = CAPSULE;
    check(*state,
          HEAD LAMP("[1.2, 2.2, 0.8]", "0.3",
                    "") "  objects:\n"
                        "    - sphere: {center: [0, 0.8, 0], radius: 0.5 m, color: 0.8}\n",
          &sphere, ABOVE, 0.3, 0.03, 3);
    check(*state,
          HEAD LAMP("[1.2, 2.2, 0.8]", "0.2", "") "  objects:\n"
                                                  "    - cylinder: {center: [0, 0.8, 0], axis: [1, "
                                                  "0.4, 0.2], radius: 0.25 m, height: 1.2 m, "
                                                  "color: 0.8}\n",
          &cylinder, ABOVE, 0.2, 0.04, 3);
    check(*state,
          HEAD LAMP("[1.2, 2.2, 0.8]", "0.2", "") "  objects:\n"
                                                  "    - capsule: {center: [0, 0.8, 0], axis: [1, "
                                                  "0.4, 0.2], radius: 0.25 m, height: 1.2 m, "
                                                  "color: 0.8}\n",
          &capsule, ABOVE, 0.2, 0.04, 3);
}

/* A shape above a lamp casts no shadow on the floor below the lamp. */
static void a_shape_behind_a_lamp_hides_nothing(void **state)
{
    const struct shape box = {
        .kind = BOX, .center = {{0, 2.4, -0.6}}, .half_size = {{0.6, 0.1, 0.6}}, .albedo = {{0.8}}};
    check(*state,
          HEAD LAMP("[0, 1.2, -0.6]", "0.1",
                    "") "  objects:\n"
                        "    - box: {center: [0, 2.4, -0.6], size: [1.2, 0.2, 1.2], color: 0.8}\n",
          &box, (struct vec){{0, 1.2, -0.6}}, 0.1, 0.01, 3);
}

/* A mesh shadows itself and the floor, by shadow maps, under a small lamp with hard shadows and
 * under a large lamp with soft shadows. */
static void a_mesh_hides_a_lamp(void **state)
{
    struct kiln_error error = {0};
    struct kiln_mesh *mesh =
        kiln_mesh_load(NULL, KILN_SOURCE_DIR "/scenes/meshes/cabin.obj", &error);
    if (!mesh)
        fail_msg("%s", error.message);
    const struct shape cabin = {.kind = MESH,
                                .center = {{-0.2, 0.3, 0.1}},
                                .mesh = mesh,
                                .angle = 30 * acos(-1.0) / 180,
                                .scale = 0.4,
                                .albedo = {{0.8}}};
    check(*state,
          HEAD LAMP("[1.2, 2.2, 0.8]", "0.02",
                    "") "  objects:\n"
                        "    - mesh: {file: meshes/cabin.obj, position: [-0.2, 0.3, 0.1], "
                        "rotation: [0 deg, 30 deg, 0 deg], scale: 0.4, color: 0.8}\n",
          &cabin, ABOVE, 0.02, 0.08, 3);
    check(*state,
          HEAD LAMP("[1.2, 2.2, 0.8]", "0.2",
                    "") "  objects:\n"
                        "    - mesh: {file: meshes/cabin.obj, position: [-0.2, 0.3, 0.1], "
                        "rotation: [0 deg, 30 deg, 0 deg], scale: 0.4, color: 0.8}\n",
          &cabin, ABOVE, 0.2, 0.12, 3);
    kiln_mesh_destroy(&mesh);
}

#define GLOBE "    - sphere: {center: [0, 1.2, 0], radius: 0.3 m, color: 0}\n"
#define LID   "    - box: {center: [0, 0.8, 0], size: [0.6, 0.05, 0.6], color: 0}\n"

/* A sphere that encloses a lamp lets the lamp's light out. A box below the sphere hides a part of
 * the light from the floor, unless the lamp's shadows are switched off. */
static void a_shape_around_a_lamp_does_not_hide_it(void **state)
{
    const double globe =
        sum_of_red(*state, HEAD LAMP("[0, 1.2, 0]", "0.05", "") "  objects:\n" GLOBE);
    const double lid =
        sum_of_red(*state, HEAD LAMP("[0, 1.2, 0]", "0.05", "") "  objects:\n" GLOBE LID);
    const double through = sum_of_red(
        *state, HEAD LAMP("[0, 1.2, 0]", "0.05", ", shadow: false") "  objects:\n" GLOBE LID);
    assert_true(globe > 100 && lid < 0.9 * globe && through > 1.05 * lid);
}

#define POST "  objects:\n    - box: {center: [0.8, 0.5, -0.5], size: [0.5, 1, 0.5]}\n"

/* A lamp whose centre is at floor level gives half of the light of the same lamp with shadows
 * switched off. A lamp that is entirely below the floor gives no light. */
static void the_floor_hides_lamps_below_it(void **state)
{
    const double half = sum_of_red(*state, HEAD LAMP("[0, 0, 0]", "0.5", "") POST);
    const double whole = sum_of_red(*state, HEAD LAMP("[0, 0, 0]", "0.5", ", shadow: false") POST);
    const double none = sum_of_red(*state, HEAD LAMP("[0, -0.6, 0]", "0.5", "") POST);
    print_message("half %g, whole %g, none %g\n", half, whole, none);
    assert_true(fabs(half - 0.5 * whole) <= 1e-3 * whole && none == 0);
}

int main(int argc, char **argv)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(a_box_hides_a_lamp),
        test_on_device(a_box_of_any_direction_hides_a_lamp),
        test_on_device(round_shapes_hide_a_lamp),
        test_on_device(a_shape_behind_a_lamp_hides_nothing),
        test_on_device(a_mesh_hides_a_lamp),
        test_on_device(a_shape_around_a_lamp_does_not_hide_it),
        test_on_device(the_floor_hides_lamps_below_it),
    };
    return backdrops_run("lamps", tests, sizeof tests / sizeof *tests, true, argc, argv);
}
