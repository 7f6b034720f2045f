/* Particles are born on meshes of the backdrop that move, with their velocity and in their colours.
 * If this fails, births lie beside the object, there are too many or too few by the metre of its
 * way, or they have another colour than the object is drawn in. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scene/motion.h"
#include "scene/source.h"
#include "shared/derived.h"
#include "support/cmocka.h"
#include "support/folders.h"
#include "support/scenes.h"
#include "support/simulation.h"

/* ---- motion ---------------------------------------------------------------------------------- */

/* A triangle that moves at 2 m/s along x, and turns about z by 90 degrees a second. */
static const char MOVING[] =
    "kiln: 1\n"
    "output: {frames: 90, fps: 60}\n"
    "backdrop:\n"
    "  objects:\n"
    "    card:\n"
    "      mesh: {file: card.obj, scale: 0.5,\n"
    "             position: {keys: {0 s: [0, 1, 0], 2 s: [4, 1, 0]}},\n"
    "             rotation: {keys: {0 s: [0, 0, 0], 2 s: [0, 0, 180 deg]}}}\n"
    "systems:\n"
    "  a:\n"
    "    emit: {rate: 3000, life: 9 s, speed: 0, inherit: 1, from: {mesh: {object: card}}}\n";

static void objects_carry_births(void **state)
{
    (void)state;
    const double pi = 3.14159265358979;
    struct simulation run;
    test_write_file("card.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nf 1 2 3\n");
    struct kiln_scene *scene = load_scene(MOVING, NULL);
    simulation_start(&run, scene, NULL, 1);
    simulation_run(&run, 60);
    const struct kiln_particle *records = simulation_records(&run);
    double worst_place = 0, worst_speed = 0;
    uint32_t seen = 0;
    for (uint32_t i = 0; i < run.pool.systems[0].capacity; i++) {
        if (!particle_is_alive(records[i]))
            continue;
        const double born_s = (double)particle_birth_time(kiln_scene_derived(scene, 0), records[i]);
        const float3 at = particle_position(records[i]), v = particle_velocity(records[i]);
        const double age = 1.0 - born_s, angle = pi / 2 * born_s;
        const double x = (double)at.x - (double)v.x * age - 2 * born_s;
        const double y = (double)at.y - (double)v.y * age - 1;
        const double own_x = cos(angle) * x + sin(angle) * y;
        const double own_y = cos(angle) * y - sin(angle) * x;
        worst_speed = fmax(worst_speed, fabs((double)v.x - (2 - pi / 2 * y)));
        worst_speed = fmax(worst_speed, fabs((double)v.y - pi / 2 * x));
        worst_place = fmax(worst_place, fmax(-own_x, fmax(-own_y, own_x + own_y - 1)));
        worst_place = fmax(worst_place, fabs((double)at.z));
        seen++;
    }
    print_message("%u births: %.2g m off the mesh, %.2g m/s\n", seen, worst_place, worst_speed);
    assert_true(seen > 2900 && worst_place < 1e-5 && worst_speed < 1e-4);
    simulation_end(&run);
    kiln_scene_destroy(&scene);
}

/* The motion of a mesh that particles are born on belongs to the hash of the motion. */
static void motion_has_sources(void **state)
{
    (void)state;
    static const char *const overrides[][2] = {
        {NULL, NULL},
        {"backdrop.objects.card.mesh.scale=0.6", NULL},
        {"backdrop.objects.card.mesh.position=[0, 1, 0]", NULL},
        {"backdrop.objects.card.mesh.color=[1, 0, 0]", NULL},
        {"systems.a.look.color=source", NULL},
    };
    char hashes[5][65], other[65];
    struct kiln_error error = {0};
    test_write_file("card.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nf 1 2 3\n");
    for (int i = 0; i < 5; i++) {
        struct kiln_scene *scene = load_scene(MOVING, overrides[i]);
        assert_true(kiln_scene_part_hash(scene, KILN_PART_MOTION, hashes[i], &error));
        kiln_scene_destroy(&scene);
    }
    assert_string_not_equal(hashes[0], hashes[1]);
    assert_string_not_equal(hashes[0], hashes[2]);
    assert_string_equal(hashes[0], hashes[4]);
    test_write_file("card.obj", "v 0 0 0\nv 2 0 0\nv 0 3 0\nf 1 2 3\n");
    struct kiln_scene *scene = load_scene(MOVING, NULL);
    assert_true(kiln_scene_part_hash(scene, KILN_PART_MOTION, other, &error));
    assert_string_not_equal(hashes[0], other);
    kiln_scene_destroy(&scene);
}

/* ---- births by the metre --------------------------------------------------------------------- */

/* A triangle of 1 mm with births by the metre of the way of its origin. */
#define DOTS(object, from)                                                                         \
    "kiln: 1\n"                                                                                    \
    "output: {frames: 120, fps: 60}\n"                                                             \
    "nodes: {hub: {position: {keys: {0 s: [0, 0, 0], 2 s: [4, 0, 0]}}}}\n"                         \
    "backdrop: {objects: {card: {mesh: {file: card.obj, " object "}}}}\n"                          \
    "systems:\n"                                                                                   \
    "  a: {emit: {per_metre: 13.7, life: 9 s, speed: 0, from: {mesh: {object: card" from "}}}}\n"

struct dots {
    const char *text;
    double speed;             /* of the origin, m/s */
    float3 (*at)(double s_m); /* the place after a way of the origin */
};

static float3 along_x(double s_m)
{
    return FLOAT3((float)s_m, 0.0f, 0.0f);
}

static float3 around_y(double s_m)
{
    return FLOAT3((float)cos(s_m), 0.0f, (float)-sin(s_m));
}

static float3 outwards(double s_m)
{
    return FLOAT3(0.5f + (float)s_m, 0.0f, 0.0f);
}

static void objects_have_births_by_the_metre(void **state)
{
    (void)state;
    static const struct dots cases[] = {
        {DOTS("position: {keys: {0 s: [0, 0, 0], 2 s: [6, 0, 0]}}", ""), 3, along_x},
        {DOTS("attach: hub", ""), 2, along_x},
        {DOTS("rotation: {keys: {0 s: [0, 0, 0], 2 s: [0, 360 deg, 0]}}", ", origin: [1, 0, 0]"),
         3.141592653589793, around_y},
        {DOTS("scale: {keys: {0 s: 1, 2 s: 5}}", ", origin: [0.5, 0, 0]"), 1, outwards},
    };
    test_write_file("card.obj", "v 0 0 0\nv 0.001 0 0\nv 0 0.001 0\nf 1 2 3\n");
    for (int k = 0; k < 4; k++) {
        struct simulation run;
        struct kiln_scene *scene = load_scene(cases[k].text, NULL);
        simulation_start(&run, scene, NULL, 1);
        for (uint32_t step = 1; step <= 100; step++) {
            uint64_t alive;
            simulation_run(&run, 1);
            simulation_hash(&run, &alive);
            assert_int_equal(alive, (uint64_t)floor(step / 60.0 * cases[k].speed * 13.7));
        }
        const struct kiln_particle *records = simulation_records(&run);
        for (int i = 0; i < (int)floor(100 / 60.0 * cases[k].speed * 13.7); i++) {
            const float3 place = cases[k].at((i + 1) / 13.7);
            const float3 off = float3_sub(particle_position(records[i]), place);
            if (!(float3_dot(off, off) < 0.006f * 0.006f))
                fail_msg("case %d: birth %d is off by %g %g %g m", k, i, (double)off.x,
                         (double)off.y, (double)off.z);
        }
        simulation_end(&run);
        kiln_scene_destroy(&scene);
    }
}

/* ---- colours --------------------------------------------------------------------------------- */

/* Returns how many of 2000 particles have a linear colour, to the bits that a source keeps. */
static uint32_t count_color(const struct kiln_scene *scene, struct simulation *run,
                            const float rgb[3])
{
    const struct kiln_particle *records = simulation_records(run);
    uint32_t count = 0;
    for (uint32_t i = 0; i < 2000; i++) {
        const float3 color =
            kiln_source_color(scene->systems[0].emit.source.made,
                              particle_stream(kiln_scene_derived(scene, 0), records[i]));
        count += fabsf(sqrtf(color.x) - sqrtf(rgb[0])) < 1e-3f &&
                 fabsf(sqrtf(color.y) - sqrtf(rgb[1])) < 1e-3f &&
                 fabsf(sqrtf(color.z) - sqrtf(rgb[2])) < 1e-3f;
    }
    return count;
}

struct shade {
    const char *file;
    const char *key;  /* of the object besides its file */
    const char *from; /* the mesh that particles are born on */
    float rgb[3];     /* the linear colour of the material's place, and then of the other one */
    float other[3];
};

/* The colour of an object is that which it is drawn in, where its mesh has none. */
static void objects_have_their_colors(void **state)
{
    (void)state;
    static const struct shade cases[] = {
        {"plain.obj", ", color: [0.9, 0.1, 0.05]", "object: 0", {0.9f, 0.1f, 0.05f}, {-1.0f}},
        {"plain.obj", "", "object: 0", {0.35f, 0.34f, 0.33f}, {-1.0f}},
        {"plain.obj", ", color: [0.9, 0.1, 0.05]", "file: plain.obj", {1.0f, 1.0f, 1.0f}, {-1.0f}},
        {"half.obj",
         ", color: [0.9, 0.1, 0.05]",
         "object: 0",
         {0.0f, 1.0f, 0.0f},
         {0.9f, 0.1f, 0.05f}},
        {"half.obj", "", "file: half.obj", {0.0f, 1.0f, 0.0f}, {1.0f, 1.0f, 1.0f}},
        {"full.obj", ", color: [0.9, 0.1, 0.05]", "object: 0", {0.0f, 1.0f, 0.0f}, {-1.0f}},
    };
    test_write_file("plain.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    test_write_file("half.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\n"
                                "usemtl green\nf 4 3 2\n");
    test_write_file("full.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl green\nf 1 2 3\n");
    test_write_file("m.mtl", "newmtl green\nKd 0 1 0\n");
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[1024];
        struct simulation run;
        snprintf(text, sizeof text,
                 "kiln: 1\n"
                 "backdrop: {objects: [mesh: {file: %s%s}]}\n"
                 "systems: {a: {emit: {bursts: {0 s: 2000}, life: 9 s, speed: 0,\n"
                 "  from: {mesh: {%s}}}, look: {color: source}}}\n",
                 cases[k].file, cases[k].key, cases[k].from);
        struct kiln_scene *scene = load_scene(text, NULL);
        simulation_start(&run, scene, NULL, 1);
        simulation_run(&run, 1);
        const uint32_t count = count_color(scene, &run, cases[k].rgb);
        const bool two = cases[k].other[0] >= 0.0f;
        const uint32_t others = two ? count_color(scene, &run, cases[k].other) : 0;
        print_message("case %zu: %u and %u\n", k, count, others);
        assert_int_equal(count + others, 2000);
        assert_true(!two || (count > 900 && others > 900));
        simulation_end(&run);
        kiln_scene_destroy(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(objects_carry_births, test_enter_folder, test_leave_folder),
        cmocka_unit_test_setup_teardown(motion_has_sources, test_enter_folder, test_leave_folder),
        cmocka_unit_test_setup_teardown(objects_have_births_by_the_metre, test_enter_folder,
                                        test_leave_folder),
        cmocka_unit_test_setup_teardown(objects_have_their_colors, test_enter_folder,
                                        test_leave_folder),
    };
    return cmocka_run_group_tests_name("source_objects", tests, NULL, NULL);
}
