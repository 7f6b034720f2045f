/* Checks the gravity of bodies that is summed by force splatting, which is additive blending on the
 * device (lib/bench/papers/force_splat.c; Drone 2007, 7.4.3.1), and gravity that is summed in a
 * fixed order, as the simulation does it, against sums in double precision. If this fails, the
 * benchmark compares the simulation with a technique that computes something else. */
#include <stddef.h>
#include <stdint.h>

#include "bench/papers/force_splat.h"
#include "shared/interact_gravity.h"
#include "support/balls.h"
#include "support/cmocka.h"
#include "support/device.h"

enum { BODIES = 300 /* not a multiple of the texels in a row, 128 */, WAYS = 3 };

/* The square of the softening length of gravity, m^2. */
static const float SOFTENING_SQUARE = 0.0025f;

/* Holds the acceleration of a body by all bodies, summed in double precision. */
struct sums {
    double x, y, z;
    double size; /* sum of the magnitudes of all terms, to which errors are relative */
};

/* Makes a cluster of bodies. Every seventh body has no mass and attracts nothing, and bodies 1 and
 * 2 are at the same place. */
static void fill(float4 *sources)
{
    uint32_t seed = 31;
    for (uint32_t i = 0; i < BODIES; i++) {
        const float x = balls_random(&seed), y = balls_random(&seed), z = balls_random(&seed);
        sources[i] = FLOAT4(x, 0.5f * y, z, i % 7 == 0 ? 0.0f : 0.02f + 0.015f * y * z);
    }
    sources[2] = sources[1];
}

static struct sums in_double(const float4 *sources, uint32_t self)
{
    struct sums sums = {0};
    for (uint32_t i = 0; i < BODIES; i++) {
        const double x = (double)sources[i].x - (double)sources[self].x;
        const double y = (double)sources[i].y - (double)sources[self].y;
        const double z = (double)sources[i].z - (double)sources[self].z;
        const double square = x * x + y * y + z * z + (double)SOFTENING_SQUARE;
        const double pull = (double)sources[i].w / (square * sqrt(square));
        sums.x += x * pull;
        sums.y += y * pull;
        sums.z += z * pull;
        sums.size += sqrt(x * x + y * y + z * z) * pull;
    }
    return sums;
}

static void in_order(const float4 *sources, float4 *found)
{
    for (uint32_t i = 0; i < BODIES; i++) {
        float3 sum = FLOAT3(0.0f, 0.0f, 0.0f);
        const float3 at = FLOAT3(sources[i].x, sources[i].y, sources[i].z);
        for (uint32_t k = 0; k < BODIES; k++)
            sum = gravity_add(sum, at, sources[k], SOFTENING_SQUARE);
        found[i] = FLOAT4(sum.x, sum.y, sum.z, 0.0f);
    }
}

static void by_blending(struct kiln_device *device, GLenum format, const float4 *sources,
                        float4 *found)
{
    struct kiln_error error = {0};
    double ms;
    struct kiln_force_splat *splat = kiln_force_splat_create(device, format, BODIES, &error);
    if (!splat) {
        fail_msg("%s", error.message);
        return;
    }
    for (int run = 0; run < 2; run++) /* the second run must not add to the sums of the first */
        if (!kiln_force_splat_run(splat, sources, BODIES, SOFTENING_SQUARE, &ms, &error))
            fail_msg("%s", error.message);
    const float4 *sums = kiln_force_splat_sums(splat, &error);
    if (!sums) {
        fail_msg("%s", error.message);
        return;
    }
    memcpy(found, sums, BODIES * sizeof *found);
    kiln_force_splat_destroy(&splat);
    assert_null(splat);
}

/* Holds the errors of all sums, each divided by its sum's `size`: the largest error and the root of
 * the mean square. */
struct error_of {
    double largest, mean;
};

static struct error_of compare(const float4 *sources, const float4 *found)
{
    struct error_of e = {0};
    for (uint32_t i = 0; i < BODIES; i++) {
        const struct sums s = in_double(sources, i);
        const double x = (double)found[i].x - s.x, y = (double)found[i].y - s.y,
                     z = (double)found[i].z - s.z;
        const double off = sqrt(x * x + y * y + z * z) / s.size;
        e.largest = fmax(e.largest, off);
        e.mean += off * off / BODIES;
    }
    e.mean = sqrt(e.mean);
    return e;
}

/* Both ways to sum must be as exact as their number format allows. A sum of n terms is rounded n
 * times, each time by at most 2^-24 of its size in floats or 2^-11 in half floats. The limits allow
 * for 32 more such errors in the terms. */
static void blending_adds_up_as_exactly_as_its_format(void **state)
{
    static float4 sources[BODIES], found[BODIES];
    static const char *const names[WAYS] = {"in order", "RGBA32F", "RGBA16F"};
    struct error_of errors[WAYS];
    fill(sources);
    for (int way = 0; way < WAYS; way++) {
        if (way == 0)
            in_order(sources, found);
        else
            by_blending(*state, way == 1 ? GL_RGBA32F : GL_RGBA16F, sources, found);
        errors[way] = compare(sources, found);
        print_message("%d bodies, %-8s: off by %.2g at most, %.2g on average\n", BODIES, names[way],
                      errors[way].largest, errors[way].mean);
    }
    assert_true(errors[0].largest <= (BODIES + 32) * 0x1p-24);
    assert_true(errors[1].largest <= (BODIES + 32) * 0x1p-24);
    assert_true(errors[2].largest <= (BODIES + 32) * 0x1p-11);
    assert_true(errors[0].mean < 2e-6 && errors[1].mean < 2e-6);
    assert_true(errors[2].mean < 0.05);
    /* A smaller error would mean that floats were added instead of half floats. */
    assert_true(errors[2].mean > 20.0 * errors[0].mean);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(blending_adds_up_as_exactly_as_its_format),
    };
    return cmocka_run_group_tests_name("force splatting", tests, test_device_open,
                                       test_device_close);
}
