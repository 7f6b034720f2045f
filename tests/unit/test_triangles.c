/* The rasteriser of triangles against rays that are cast at them one by one, in doubles: triangles
 * before the eye, around it and behind it, large and far smaller than a pixel, at every level. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/simd.h"
#include "draw/vector/mesh_project.h"
#include "shared/random.h"
#include "support/cmocka.h"

enum { WIDTH = 61, HEIGHT = 40, PITCH = WIDTH + KILN_MESH_PAD, LAYERS = 2, TRIANGLES = 4000 };

static const float4 FRUSTUM = {0.8f, 0.5f, WIDTH, HEIGHT};
static const float4 PRINCIPAL = {0.5f * WIDTH, 0.5f * HEIGHT, 0.0f, 0.0f};
static const float OFFSETS[LAYERS][2] = {{0.5f, 0.5f}, {0.875f, 0.375f}};

static float between(uint32_t *seed, float low, float high)
{
    return low + (high - low) * (float)(random_mix((*seed)++) >> 8) * 0x1p-24f;
}

/* Makes a triangle whose corners are up to `size` from a place; the place is up to 6 m before or
 * behind the eye and up to `aside` beside it. */
static void make_triangle(uint32_t *seed, float size, float aside, float3 corner[3])
{
    const float3 middle = {between(seed, -aside, aside), between(seed, -aside, aside),
                           between(seed, -6.0f, 6.0f)};
    for (int k = 0; k < 3; k++)
        corner[k] =
            (float3){middle.x + between(seed, -size, size), middle.y + between(seed, -size, size),
                     middle.z + between(seed, -size, size)};
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Returns the nearness of a triangle along the ray (u, v, -1), 0 where the ray misses it, and -1
 * where it passes so close to an edge, or so close to the nearest depth, that either may be. */
static double cast(const float3 corner[3], double u, double v)
{
    double p[3][3], side[3][3], sides[3], volume = 0.0, least = 1e9, most = -1e9;
    const double ray[3] = {u, v, -1.0};
    for (int k = 0; k < 3; k++) {
        const double at[3] = {(double)corner[k].x, (double)corner[k].y, (double)corner[k].z};
        memcpy(p[k], at, sizeof at);
    }
    for (int k = 0; k < 3; k++) {
        const double *a = p[(k + 1) % 3], *b = p[(k + 2) % 3];
        const double cross[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                                 a[0] * b[1] - a[1] * b[0]};
        memcpy(side[k], cross, sizeof cross);
        volume = dot(p[k], cross);
        sides[k] = dot(ray, cross) / sqrt(dot(cross, cross) * dot(ray, ray));
    }
    const double sign = volume < 0.0 ? -1.0 : 1.0;
    double nearness = 0.0; /* volume / the sum of the sides is the depth */
    for (int k = 0; k < 3; k++) {
        least = fmin(least, sides[k] * sign);
        most = fmax(most, fabs(sides[k]));
        nearness += dot(ray, side[k]) / volume;
    }
    const double nearest = 1.0 / (double)KILN_MESH_NEAREST;
    if (fabs(least) < 2e-5 || most < 1e-3 || fabs(nearness / nearest - 1.0) < 0.01)
        return -1.0;
    return least > 0.0 && nearness > 0.0 && nearness < nearest ? nearness : 0.0;
}

static const struct kiln_mesh_strip STRIP = {
    .width = WIDTH,
    .rows = HEIGHT,
    .u = -0.8f,
    .v = 0.5f,
    .u_step = 2.0f * 0.8f / WIDTH,
    .v_step = -2.0f * 0.5f / HEIGHT,
    .layers = LAYERS,
    .offsets = {{0.5f, 0.5f}, {0.875f, 0.375f}},
    .nearness_max = 1.0f / KILN_MESH_NEAREST,
    .pitch = PITCH,
};

/* Checks each sample of a picture of one triangle. Returns how many it covers. */
static int check(const float3 corner[3], const float *nearness)
{
    int covered = 0;
    for (int y = 0; y < HEIGHT; y++) {
        for (int i = 0; i < LAYERS * WIDTH; i++) {
            const int layer = i / WIDTH, x = i % WIDTH;
            const double u = ((x + (double)OFFSETS[layer][0]) * 2.0 / WIDTH - 1.0) * 0.8;
            const double v = (1.0 - (y + (double)OFFSETS[layer][1]) * 2.0 / HEIGHT) * 0.5;
            const double expected = cast(corner, u, v);
            const double drawn = (double)nearness[(y * LAYERS + layer) * PITCH + x];
            covered += drawn > 0.0;
            if (expected >= 0.0 && fabs(drawn - expected) > 1e-3 * expected)
                fail_msg("pixel (%d, %d), layer %d: nearness %g, not %g; corners (%g, %g, %g), "
                         "(%g, %g, %g), (%g, %g, %g)",
                         x, y, layer, drawn, expected, (double)corner[0].x, (double)corner[0].y,
                         (double)corner[0].z, (double)corner[1].x, (double)corner[1].y,
                         (double)corner[1].z, (double)corner[2].x, (double)corner[2].y,
                         (double)corner[2].z);
        }
    }
    return covered;
}

/* Draws TRIANGLES triangles one by one at all levels. Returns how many have covered a sample. */
static int draw_all(float size, float aside)
{
    static float nearness[LAYERS * HEIGHT * PITCH], first[LAYERS * HEIGHT * PITCH];
    uint32_t seed = 1;
    int seen = 0;
    for (int i = 0; i < TRIANGLES; i++) {
        float3 corner[3], face;
        float volume;
        struct kiln_projected_triangle flat;
        make_triangle(&seed, size, aside, corner);
        const bool drawn = kiln_mesh_project(corner, FRUSTUM, PRINCIPAL, &flat, &face, &volume);
        bool is_first = true;
        for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
            if (!kiln_simd_has(simd))
                continue;
            memset(nearness, 0, sizeof nearness);
            struct kiln_mesh_strip strip = STRIP;
            strip.nearness = nearness;
            if (drawn)
                KILN_SIMD_PICK(kiln_mesh_rows, simd)->draw(&strip, &flat, &(uint32_t){0}, 1);
            if (is_first)
                memcpy(first, nearness, sizeof first);
            is_first = false;
            for (size_t k = 0; k < sizeof first / sizeof *first; k++)
                assert_true(nearness[k] == first[k] || k % PITCH >= WIDTH);
        }
        seen += check(corner, nearness) > 0;
    }
    return seen;
}

static void before_and_around_the_eye(void **state)
{
    (void)state;
    assert_in_range(draw_all(1.5f, 3.0f), TRIANGLES / 10, TRIANGLES / 2);
}

static void around_the_eye_and_huge(void **state)
{
    (void)state;
    assert_in_range(draw_all(20.0f, 1.0f), TRIANGLES / 4, TRIANGLES);
}

static void smaller_than_a_pixel(void **state)
{
    (void)state;
    assert_in_range(draw_all(0.03f, 1.0f), 20, TRIANGLES / 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(before_and_around_the_eye),
        cmocka_unit_test(around_the_eye_and_huge),
        cmocka_unit_test(smaller_than_a_pixel),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
