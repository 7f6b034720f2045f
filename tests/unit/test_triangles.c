/* The rasteriser of triangles against rays that are cast at them one by one, in doubles: triangles
 * before the eye, around it and behind it, large and far smaller than a pixel, at every level. The
 * picture is drawn in strips. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/simd.h"
#include "draw/vector/mesh_project.h"
#include "shared/random.h"
#include "support/cmocka.h"

enum { LAYERS = 2, MOST_WIDTH = 1500, MOST_HEIGHT = 40 };

#define U 0.8f /* of rays through the right edge of the picture */
#define V 0.5f

static const float OFFSETS[LAYERS][2] = {{0.5f, 0.5f}, {0.875f, 0.375f}};

struct picture {
    int width, height, pitch;
    float nearness[LAYERS * MOST_HEIGHT * (MOST_WIDTH + KILN_MESH_PAD)];
};

static size_t size_of(const struct picture *p)
{
    return (size_t)(LAYERS * p->height * p->pitch) * sizeof *p->nearness;
}

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

/* Draws a triangle, strip by strip. */
static void draw(const struct kiln_projected_triangle *flat, enum kiln_simd simd,
                 struct picture *picture)
{
    struct kiln_mesh_strip strip = {
        .width = (uint32_t)picture->width,
        .rows = KILN_MESH_ROWS,
        .u = -U,
        .v = V,
        .u_step = 2.0f * U / (float)picture->width,
        .v_step = -2.0f * V / (float)picture->height,
        .layers = LAYERS,
        .nearness_max = 1.0f / KILN_MESH_NEAREST,
        .pitch = (size_t)picture->pitch,
    };
    memcpy(strip.offsets, OFFSETS, sizeof OFFSETS);
    memset(picture->nearness, 0, size_of(picture));
    for (; strip.y < (uint32_t)picture->height; strip.y += KILN_MESH_ROWS) {
        strip.nearness = picture->nearness + strip.y * LAYERS * strip.pitch;
        KILN_SIMD_PICK(kiln_mesh_rows, simd)->draw(&strip, flat, &(uint32_t){0}, 1);
    }
}

/* Checks each sample of a picture of one triangle. Returns how many it covers. */
static int check(const float3 corner[3], const struct picture *p)
{
    int covered = 0;
    for (int y = 0; y < p->height; y++) {
        for (int i = 0; i < LAYERS * p->width; i++) {
            const int layer = i / p->width, x = i % p->width;
            const double u = ((x + (double)OFFSETS[layer][0]) * 2.0 / p->width - 1.0) * (double)U;
            const double v = (1.0 - (y + (double)OFFSETS[layer][1]) * 2.0 / p->height) * (double)V;
            const double expected = cast(corner, u, v);
            const double drawn = (double)p->nearness[(y * LAYERS + layer) * p->pitch + x];
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

/* Draws a triangle at all levels, and checks it. Returns how many samples it covers. */
static int draw_and_check(const float3 corner[3], struct picture *picture)
{
    static struct picture other;
    const float width = (float)picture->width, height = (float)picture->height;
    struct kiln_projected_triangle flat;
    float3 face;
    float volume;
    other.width = picture->width;
    other.height = picture->height;
    other.pitch = picture->pitch;
    kiln_mesh_project(corner, (float4){U, V, width, height},
                      (float4){0.5f * width, 0.5f * height, 0.0f, 0.0f}, KILN_MESH_NEAREST, &flat,
                      &face, &volume);
    bool is_first = true;
    for (enum kiln_simd simd = 0; simd < KILN_SIMD_COUNT; simd++) {
        if (!kiln_simd_has(simd))
            continue;
        draw(&flat, simd, is_first ? picture : &other);
        if (!is_first)
            assert_memory_equal(other.nearness, picture->nearness, size_of(picture));
        is_first = false;
    }
    return check(corner, picture);
}

/* Draws triangles one by one. Returns how many have covered a sample. */
static int draw_all(int width, int height, int count, float size, float aside)
{
    static struct picture picture;
    picture.width = width;
    picture.height = height;
    picture.pitch = width + KILN_MESH_PAD;
    uint32_t seed = 1;
    int seen = 0;
    for (int i = 0; i < count; i++) {
        float3 corner[3];
        make_triangle(&seed, size, aside, corner);
        seen += draw_and_check(corner, &picture) > 0;
    }
    return seen;
}

static void before_and_around_the_eye(void **state)
{
    (void)state;
    assert_in_range(draw_all(61, MOST_HEIGHT, 4000, 1.5f, 3.0f), 400, 2000);
}

static void around_the_eye_and_huge(void **state)
{
    (void)state;
    assert_in_range(draw_all(61, MOST_HEIGHT, 4000, 20.0f, 1.0f), 1000, 4000);
}

static void smaller_than_a_pixel(void **state)
{
    (void)state;
    assert_in_range(draw_all(61, MOST_HEIGHT, 4000, 0.03f, 1.0f), 20, 2000);
}

static void kilometres_away_in_a_wide_picture(void **state)
{
    (void)state;
    assert_in_range(draw_all(MOST_WIDTH, 2 * KILN_MESH_ROWS, 100, 3000.0f, 1.0f), 20, 100);
}

/* Its edge from 1 mm beside the eye to 5.6 km away meets the nearest depth near the right edge. */
static void one_that_reaches_the_eye_from_afar(void **state)
{
    (void)state;
    static struct picture picture;
    picture.width = MOST_WIDTH;
    picture.height = MOST_HEIGHT;
    picture.pitch = MOST_WIDTH + KILN_MESH_PAD;
    const float3 corner[3] = {
        {-1.0f, 1.0f, -2.0f}, {2500.0f, 0.0f, -5000.0f}, {0.001f, 0.0f, 0.0f}};
    assert_in_range(draw_and_check(corner, &picture), 1000, LAYERS * MOST_WIDTH * MOST_HEIGHT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(before_and_around_the_eye),
        cmocka_unit_test(around_the_eye_and_huge),
        cmocka_unit_test(smaller_than_a_pixel),
        cmocka_unit_test(kilometres_away_in_a_wide_picture),
        cmocka_unit_test(one_that_reaches_the_eye_from_afar),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
