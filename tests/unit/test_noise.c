/* shaders/shared/noise.h: the analytic curl against a potential in double, and what follows. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "shared/noise.h"
#include "support/cmocka.h"

static float3 random_point(uint32_t i, float reach)
{
    return FLOAT3(random_between(i, 1, -reach, reach), random_between(i, 2, -reach, reach),
                  random_between(i, 3, -reach, reach));
}

/* Gradient noise number `part` (0, 1, 2) in double, written down independently: lattice gradients
 * blended by the quintic fade. */
static double potential(const double p[3], uint32_t seed, int part)
{
    double sum = 0;
    for (int corner = 0; corner < 8; corner++) {
        double weight = 1, product = 0;
        uint32_t lattice = seed;
        static const uint32_t primes[3] = {0x8da6b343u, 0xd8163841u, 0xcb1ab31fu};
        double r[3];
        for (int axis = 0; axis < 3; axis++) {
            int up = corner >> axis & 1;
            double cell = floor(p[axis]), t = p[axis] - cell;
            double fade = t * t * t * (10 + t * (6 * t - 15));
            weight *= up ? fade : 1 - fade;
            r[axis] = t - up;
            lattice += (uint32_t)((int32_t)cell + up) * primes[axis];
        }
        uint32_t bits = random_mix(lattice) >> (9 * part);
        for (int axis = 0; axis < 3; axis++)
            product += ((bits >> 3 * axis & 7) - 3.5) * r[axis];
        sum += weight * product;
    }
    return sum;
}

static double slope(const double p[3], uint32_t seed, int part, int axis)
{
    const double h = 1e-4;
    double a[3] = {p[0], p[1], p[2]}, b[3] = {p[0], p[1], p[2]};
    a[axis] -= h;
    b[axis] += h;
    return (potential(b, seed, part) - potential(a, seed, part)) / (2 * h);
}

static void the_curl_is_the_curl_of_the_potential(void **state)
{
    (void)state;
    const uint32_t seed = 99;
    for (uint32_t i = 0; i < 20000; i++) {
        float3 q = random_point(i, 30.0f);
        double p[3] = {(double)q.x, (double)q.y, (double)q.z};
        float3 c = noise_curl_octave(q, seed);
        const double unit = (double)NOISE_CURL_UNIT;
        double x = unit * (slope(p, seed, 2, 1) - slope(p, seed, 1, 2));
        double y = unit * (slope(p, seed, 0, 2) - slope(p, seed, 2, 0));
        double z = unit * (slope(p, seed, 1, 0) - slope(p, seed, 0, 1));
        assert_true(fabs((double)c.x - x) < 1e-4);
        assert_true(fabs((double)c.y - y) < 1e-4);
        assert_true(fabs((double)c.z - z) < 1e-4);
    }
}

static void the_field_has_no_divergence(void **state)
{
    (void)state;
    const float h = 1.0f / 64.0f;
    double worst = 0, steepest = 0;
    for (uint32_t i = 0; i < 20000; i++) {
        float3 p = random_point(i + 77, 30.0f);
        float dx = noise_curl(FLOAT3(p.x + h, p.y, p.z), 5, 1).x -
                   noise_curl(FLOAT3(p.x - h, p.y, p.z), 5, 1).x;
        float dy = noise_curl(FLOAT3(p.x, p.y + h, p.z), 5, 1).y -
                   noise_curl(FLOAT3(p.x, p.y - h, p.z), 5, 1).y;
        float dz = noise_curl(FLOAT3(p.x, p.y, p.z + h), 5, 1).z -
                   noise_curl(FLOAT3(p.x, p.y, p.z - h), 5, 1).z;
        worst = fmax(worst, fabs((double)(dx + dy + dz)) / (2.0 * (double)h));
        steepest = fmax(steepest, fabs((double)dx) / (2.0 * (double)h));
    }
    print_message("divergence %.3g where slopes reach %.3g\n", worst, steepest);
    assert_true(steepest > 1.0);
    assert_true(worst < 0.02 * steepest);
}

static void the_field_is_continuous_and_of_unit_speed(void **state)
{
    (void)state;
    double square = 0, mean = 0;
    const uint32_t count = 200000;
    for (uint32_t i = 0; i < count; i++) {
        float3 c = noise_curl_octave(random_point(i, 100.0f), 3);
        square += (double)float3_dot(c, c) / count;
        mean += (double)c.x / count;
    }
    assert_true(fabs(sqrt(square) - 1.0) < 0.01);
    assert_true(fabs(mean) < 0.01);
    for (uint32_t i = 0; i < 1000; i++) { /* across the faces between lattice cells */
        float3 p = random_point(i, 20.0f);
        p.x = floorf(p.x);
        float3 a = noise_curl_octave(FLOAT3(p.x - 1e-5f, p.y, p.z), 3);
        float3 b = noise_curl_octave(FLOAT3(p.x + 1e-5f, p.y, p.z), 3);
        float3 d = float3_sub(a, b);
        assert_true(float3_length(d) < 1e-3f);
    }
}

static void octaves_add_detail_and_far_away_is_still(void **state)
{
    (void)state;
    float3 p = FLOAT3(1.3f, -2.6f, 0.4f), none = FLOAT3(0, 0, 0);
    float3 one = noise_curl(p, 11, 1), two = noise_curl(p, 11, 2), many = noise_curl(p, 11, 9);
    float3 four = noise_curl(p, 11, 4);
    assert_true(float3_length(float3_sub(one, two)) > 0.01f);
    assert_memory_equal(&many, &four, sizeof many);
    const float3 far[] = {{2e6f, 0, 0}, {0, -2e6f, 0}, {0, 0, INFINITY}, {NAN, 0, 0}};
    for (size_t i = 0; i < sizeof far / sizeof *far; i++) {
        float3 still = noise_curl_octave(far[i], 1);
        assert_memory_equal(&still, &none, sizeof still);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_curl_is_the_curl_of_the_potential),
        cmocka_unit_test(the_field_has_no_divergence),
        cmocka_unit_test(the_field_is_continuous_and_of_unit_speed),
        cmocka_unit_test(octaves_add_detail_and_far_away_is_still),
    };
    return cmocka_run_group_tests_name("noise", tests, NULL, NULL);
}
