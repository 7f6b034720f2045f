/* lib/draw/backdrop/casters.c and ray_casters.h: no object that is left out reaches any of many
 * random ways from a box of lit points to a lamp or to the sun. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Builds may lack the narrowest vectors, which this test takes, so it compiles its own copy. */
#define KILN_SIMD_LEVEL test

#include "draw/backdrop/ray_casters.h"
#include "draw/light/ray_lamp.h"
#include "draw/light/ray_smoke.h"
#include "draw/light/shapes_hide_simd.c" /* NOLINT(bugprone-suspicious-include) */
#include "support/cmocka.h"

enum {
    EACH = 5,
    KINDS = 5,
    OBJECTS = EACH * KINDS,
    LAMPS = 4,
    TRIALS = 150,
    WAYS = 150,
    STEPS = 60
};

static const float SPREAD = 0.05f; /* of the sun's light, m per m */
static const double FAR = 25.0;    /* m: beyond all objects */

static double between(double low, double high)
{
    return low + (high - low) * rand() / RAND_MAX;
}

static float4 place(double reach, double w)
{
    return (float4){(float)between(-reach, reach), (float)between(-reach, reach),
                    (float)between(-reach, reach), (float)w};
}

static void direction(double out[3])
{
    double square = 0.0;
    while (square < 0.01 || square > 1.0) {
        square = 0.0;
        for (int k = 0; k < 3; k++) {
            out[k] = between(-1.0, 1.0);
            square += out[k] * out[k];
        }
    }
    for (int k = 0; k < 3; k++)
        out[k] /= sqrt(square);
}

static float4 axis(double half)
{
    double way[3];
    direction(way);
    return (float4){(float)way[0], (float)way[1], (float)way[2], (float)half};
}

/* Turns a box around a random axis. */
static void turn(struct kiln_draw_shape *box)
{
    double n[3];
    direction(n);
    const double angle = between(0.0, 3.0), s = sin(angle), c = cos(angle);
    const double cross[3][3] = {{0, -n[2], n[1]}, {n[2], 0, -n[0]}, {-n[1], n[0], 0}};
    for (int i = 0; i < 3; i++) {
        float row[3];
        for (int k = 0; k < 3; k++)
            row[k] = (float)((i == k) * c + s * cross[i][k] + (1.0 - c) * n[i] * n[k]);
        box->rows[i] = (float4){row[0], row[1], row[2], 0.0f};
    }
}

/* Kinds of objects, which have EACH shapes one after another. */
enum { BOXES, BALLS, CYLINDERS, CAPSULES, TURNED_BOXES };

static void place_shape(int kind, struct kiln_draw_shape *shape)
{
    static const uint32_t kinds[KINDS] = {SHAPE_BOX, SHAPE_CAPSULE, SHAPE_CYLINDER, SHAPE_CAPSULE,
                                          SHAPE_BOX};
    const bool is_box = kind == BOXES || kind == TURNED_BOXES;
    shape->kind = (uint4){kinds[kind], kind != BOXES, 0, 0};
    shape->center = place(5.0, 4.0); /* a sphere that is large enough for all */
    shape->extent = (float4){(float)between(0.1, 1.0), (float)between(0.1, 2.0), 0.3f,
                             is_box ? 0.0f : (float)between(0.1, 1.0)};
    if (kind == BALLS)
        shape->extent.y = 0.0f;
    shape->rows[0].x = shape->rows[1].y = shape->rows[2].z = 1.0f;
    if (kind == TURNED_BOXES)
        turn(shape);
    if (!is_box)
        shape->rows[1] = axis(0.0);
}

static void place_objects(struct kiln_backdrop_inputs *inputs)
{
    struct kiln_draw_backdrop *b = &inputs->block;
    struct kiln_draw_shapes *s = &inputs->shapes;
    memset(inputs, 0, sizeof *inputs);
    b->counts.y = LAMPS;
    s->counts.x = OBJECTS;
    s->sun_right.w = SPREAD;
    b->sun_direction = axis(0.0);
    for (int i = 0; i < OBJECTS; i++)
        place_shape(i / EACH, &s->shapes[i]);
    for (int i = 0; i < LAMPS; i++) {
        b->lights[i].position_radius2 = place(5.0, 0.0);
        b->lights[i].color.w = (float)between(0.01, 0.5);
        b->lights[i].casters.x = 1;
        b->lights[i].hiders[0].x = (1u << OBJECTS) - 1;
        if (i % 2 == 0)
            continue;
        b->lights[i].facing = axis(KILN_LAMP_RECTANGLE);
        b->lights[i].right = (float4){0.7f, 0.1f, 0.0f, 0.0f};
        b->lights[i].up = (float4){-0.1f, 0.7f, 0.3f, 0.0f};
    }
}

/* A scene of random objects and lamps, and what rays know of it. */
struct scene {
    struct kiln_backdrop_inputs inputs;
    struct kiln_object_bounds bounds;
    struct kiln_casters all;
    struct kiln_ray_frame frame;
};

static void open_scene(struct scene *scene)
{
    place_objects(&scene->inputs);
    kiln_casters_find(&scene->inputs, &scene->bounds, &scene->all);
    scene->frame = (struct kiln_ray_frame){.backdrop = &scene->inputs.block,
                                           .shapes = &scene->inputs.shapes,
                                           .object_bounds = &scene->bounds,
                                           .all_casters = &scene->all};
}

/* ---- what objects contain -------------------------------------------------------------------- */

static double dot(const double v[3], float4 other)
{
    return v[0] * (double)other.x + v[1] * (double)other.y + v[2] * (double)other.z;
}

static bool contains(const struct kiln_backdrop_inputs *inputs, int object, const double at[3])
{
    const struct kiln_draw_shape *s = &inputs->shapes.shapes[object];
    const float4 c = s->center;
    const double from[3] = {at[0] - (double)c.x, at[1] - (double)c.y, at[2] - (double)c.z};
    const double square = from[0] * from[0] + from[1] * from[1] + from[2] * from[2];
    const double along = dot(from, s->rows[1]), radius = (double)s->extent.w;
    const double end = (double)s->extent.y, beyond = fmax(fabs(along) - end, 0.0);
    const double aside2 = square - along * along;
    switch (object / EACH) {
    case BOXES:
    case TURNED_BOXES:
        return fabs(dot(from, s->rows[0])) <= (double)s->extent.x &&
               fabs(dot(from, s->rows[1])) <= (double)s->extent.y &&
               fabs(dot(from, s->rows[2])) <= (double)s->extent.z;
    case CYLINDERS:
        return beyond <= 0.0 && aside2 <= radius * radius;
    default:
        return aside2 + beyond * beyond <= radius * radius;
    }
}

/* ---- ways to lights -------------------------------------------------------------------------- */

/* Returns a bit for each object that holds a place on one of many ways from a box. lamp: NULL: to
 * the sun. */
static uint32_t met_on_ways(const struct kiln_backdrop_inputs *inputs,
                            const struct kiln_lit_box *box, const struct kiln_draw_light *lamp)
{
    uint32_t met = 0;
    for (int i = 0; i < WAYS; i++) {
        double from[3], way[3], aside[3];
        direction(aside);
        const float4 sun = inputs->block.sun_direction;
        const float4 at = lamp ? lamp->position_radius2 : sun;
        const double ends[3] = {(double)at.x, (double)at.y, (double)at.z};
        for (int k = 0; k < 3; k++) {
            from[k] = between((double)box->from[k], (double)box->to[k]);
            way[k] = lamp ? ends[k] + (double)lamp->color.w * aside[k] - from[k]
                          : FAR * (ends[k] + (double)SPREAD * aside[k]);
        }
        for (int step = 0; step <= STEPS; step++) {
            double place_on[3];
            for (int k = 0; k < 3; k++)
                place_on[k] = from[k] + way[k] * step / STEPS;
            for (int object = 0; object < OBJECTS; object++)
                met |= (uint32_t)contains(inputs, object, place_on) << object;
        }
    }
    return met;
}

/* Returns a box that has no width along one of the axes. */
static struct kiln_lit_box random_box(int flat)
{
    struct kiln_lit_box box;
    for (int k = 0; k < 3; k++) {
        const double middle = between(-4.0, 4.0), half = flat % 3 == k ? 0.0 : between(0.0, 1.0);
        box.from[k] = (float)(middle - half);
        box.to[k] = (float)(middle + half);
    }
    return box;
}

static void no_caster_is_left_out(void **state)
{
    (void)state;
    static struct scene scene;
    int kept = 0, all = 0;
    srand(7);
    for (int trial = 0; trial < TRIALS; trial++) {
        open_scene(&scene);
        const struct kiln_lit_box box = random_box(trial);
        const struct kiln_casters casters = find_casters(&scene.frame, &box);
        const uint32_t sun = met_on_ways(&scene.inputs, &box, NULL);
        assert_int_equal(sun & ~casters.sun_objects.words[0], 0);
        for (int i = 0; i < LAMPS; i++) {
            const uint32_t met = met_on_ways(&scene.inputs, &box, &scene.inputs.block.lights[i]);
            assert_int_equal(met & ~casters.lamps[i].words[0], 0);
            kept += __builtin_popcount(casters.lamps[i].words[0]);
            all += OBJECTS;
        }
    }
    assert_true(kept * 2 < all && kept > 0); /* most are left out */
}

/* Returns points in a box, and normals there. */
static struct ray_point random_points(const struct kiln_lit_box *box)
{
    struct ray_point points = {.active = vi_all(-1)};
    vf *const at[3] = {&points.at.x, &points.at.y, &points.at.z};
    vf *const normal[3] = {&points.normal.x, &points.normal.y, &points.normal.z};
    for (int lane = 0; lane < LANES; lane++) {
        double way[3];
        direction(way);
        for (int k = 0; k < 3; k++) {
            (*at[k])[lane] = (float)between((double)box->from[k], (double)box->to[k]);
            (*normal[k])[lane] = (float)way[k];
        }
    }
    return points;
}

/* Computes what points see of a lamp that they face. Not inline: the compiler would warn that there
 * are no maps to read. */
static __attribute__((noinline)) void see_lamp(const struct kiln_lamp_objects *objects,
                                               const struct kiln_draw_light *lamp,
                                               const struct kiln_shape_set *casters,
                                               const struct ray_point *p, vf *seen)
{
    const struct vf3 towards = vf3_towards(lamp->position_radius2, p->at);
    const vi away = vf3_dot(p->normal, towards) < 0.0f;
    const struct vf3 normal = vf3_scale(p->normal, vf_select(away, vf_all(-1.0f), vf_all(1.0f)));
    *seen = lamp_visibility(objects, lamp, casters, p->at, normal, NULL, vf_all(0.0f), p->active);
}

static void what_is_seen_of_lamps_stays(void **state)
{
    (void)state;
    static struct scene scene;
    srand(11);
    for (int trial = 0; trial < TRIALS; trial++) {
        open_scene(&scene);
        const struct kiln_lamp_objects objects = {.shapes = &scene.inputs.shapes};
        const struct kiln_lit_box box = random_box(trial);
        const struct kiln_casters casters = find_casters(&scene.frame, &box);
        for (int i = 0; i < LAMPS * WAYS; i++) {
            const struct kiln_draw_light *lamp = &scene.inputs.block.lights[i % LAMPS];
            const struct ray_point p = random_points(&box);
            vf all, found;
            see_lamp(&objects, lamp, &scene.all.lamps[i % LAMPS], &p, &all);
            see_lamp(&objects, lamp, &casters.lamps[i % LAMPS], &p, &found);
            for (int lane = 0; lane < LANES; lane++)
                assert_float_equal(all[lane], found[lane], 1e-6f);
        }
    }
}

/* The box around a turned box touches its corners. */
static void bounds_touch_corners(void **state)
{
    (void)state;
    static struct scene scene;
    open_scene(&scene);
    for (int i = 0; i < EACH; i++) {
        const int number = TURNED_BOXES * EACH + i;
        const struct kiln_draw_shape *box = &scene.inputs.shapes.shapes[number];
        const float half[3] = {box->extent.x, box->extent.y, box->extent.z};
        float farthest[3] = {0};
        for (int corner = 0; corner < 8; corner++) {
            float at[3] = {0};
            for (int k = 0; k < 3; k++) {
                const float step = corner >> k & 1 ? half[k] : -half[k];
                at[0] += step * box->rows[k].x;
                at[1] += step * box->rows[k].y;
                at[2] += step * box->rows[k].z;
            }
            for (int k = 0; k < 3; k++)
                farthest[k] = fmaxf(farthest[k], at[k]);
        }
        for (int k = 0; k < 3; k++)
            assert_float_equal(farthest[k], scene.bounds.half[k][number], 1e-3f);
    }
}

static void nothing_hides_light_from_nothing(void **state)
{
    (void)state;
    static struct scene scene;
    open_scene(&scene);
    const struct lit_vectors none = no_lit_vectors();
    const struct kiln_lit_box box = lit_box_of(&none);
    const struct kiln_casters casters = find_casters(&scene.frame, &box);
    assert_false(kiln_shape_set_any(&casters.sun_objects));
    for (int i = 0; i < LAMPS; i++)
        assert_false(kiln_shape_set_any(&casters.lamps[i]));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_caster_is_left_out),
        cmocka_unit_test(what_is_seen_of_lamps_stays),
        cmocka_unit_test(bounds_touch_corners),
        cmocka_unit_test(nothing_hides_light_from_nothing),
    };
    return cmocka_run_group_tests_name("casters", tests, NULL, NULL);
}
