/* Checks two ways to compute the mean position and velocity of a flock: sums of integers, as in the
 * simulation, and the last mip level of a float texture, as in Drone 2007, 7.4.4.2. Both are
 * compared with means in double precision, and their errors are printed. If the sums are wrong, a
 * flock steers towards a wrong place or velocity.
 */
#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "shared/interact_flock.h"
#include "support/balls.h"
#include "support/cmocka.h"
#include "support/device.h"

enum { SIDE = 64, BIRDS = SIDE * SIDE };

static struct scene_fixture fixture; /* too large for a stack */

/* Means over all birds: x, y and z of the positions, m, then of the velocities, m/s. */
struct averages {
    double values[6];
};

/* Simulates a flock for one second, and writes its birds to `birds`. The flock starts around the
 * point (far_m, 0, 0), m. */
static void fly(struct kiln_body *birds, float far_m)
{
    balls_init(&fixture, BIRDS, 0.01f);
    fixture.scene.systems[0].interaction_count = 0;
    fixture_add_flock(&fixture.scene.systems[0], 0.5f);
    struct simulation run;
    simulation_start(&run, &fixture.scene, NULL, 2);
    uint32_t seed = 9;
    for (uint32_t i = 0; i < BIRDS; i++) {
        const float x = balls_random(&seed), y = balls_random(&seed), z = balls_random(&seed);
        balls_place(&run, i, FLOAT3(far_m + 4.0f * x, 4.0f * y, 4.0f * z),
                    FLOAT3(4.0f + z, y, x * y));
    }
    simulation_run(&run, 60);
    const struct kiln_particle *records = simulation_records(&run);
    for (uint32_t i = 0; i < BIRDS; i++) {
        assert_true(particle_is_alive(records[i]));
        birds[i] = (struct kiln_body){.position_radius = records[i].position_serial,
                                      .velocity_slot = records[i].velocity_birth};
    }
    simulation_end(&run);
}

/* Returns the means computed in double precision, which are the reference. */
static struct averages in_double(const struct kiln_body *birds)
{
    struct averages mean = {{0}};
    for (uint32_t i = 0; i < BIRDS; i++) {
        const float3 p = body_position(birds[i]), v = body_velocity(birds[i]);
        const float values[6] = {p.x, p.y, p.z, v.x, v.y, v.z};
        for (int k = 0; k < 6; k++)
            mean.values[k] += (double)values[k] / BIRDS;
    }
    return mean;
}

static struct averages by_integers(const struct kiln_body *birds)
{
    struct flock_all all = flock_nobody();
    for (uint32_t i = 0; i < BIRDS; i++)
        all = flock_all_add(all, flock_all_of(birds[i]));
    const struct flock_means means = flock_means_of(all, BIRDS);
    return (struct averages){{(double)means.position.x, (double)means.position.y,
                              (double)means.position.z, (double)means.velocity.x,
                              (double)means.velocity.y, (double)means.velocity.z}};
}

/* Computes a mean by GL: uploads a texture in which each texel holds one bird, generates its mip
 * levels, and copies the single texel of the last level to mean[0] to mean[2]. velocities: true for
 * velocities, m/s, false for positions, m. */
static void mip_maps(const struct kiln_body *birds, GLenum format, bool velocities, double *mean)
{
    static float texels[BIRDS][4];
    float last[4];
    GLuint texture;
    for (uint32_t i = 0; i < BIRDS; i++) {
        const float3 v = velocities ? body_velocity(birds[i]) : body_position(birds[i]);
        memcpy(texels[i], (float[4]){v.x, v.y, v.z, 1.0f}, sizeof texels[i]);
    }
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexStorage2D(GL_TEXTURE_2D, 7, format, SIDE, SIDE);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, SIDE, SIDE, GL_RGBA, GL_FLOAT, texels);
    glGenerateMipmap(GL_TEXTURE_2D);
    glGetTexImage(GL_TEXTURE_2D, 6, GL_RGBA, GL_FLOAT, last);
    glBindTexture(GL_TEXTURE_2D, 0);
    glDeleteTextures(1, &texture);
    for (int k = 0; k < 3; k++)
        mean[k] = (double)last[k];
}

static struct averages by_mip_maps(const struct kiln_body *birds, GLenum format)
{
    struct averages mean;
    mip_maps(birds, format, false, mean.values);
    mip_maps(birds, format, true, mean.values + 3);
    return mean;
}

/* Returns the largest absolute error of three of the means, from index `first` on: 0 for positions,
 * m, 3 for velocities, m/s. */
static double error_of(const struct averages *found, const struct averages *expected, int first)
{
    double largest = 0.0;
    for (int k = first; k < first + 3; k++)
        largest = fmax(largest, fabs(found->values[k] - expected->values[k]));
    return largest;
}

static void mip_maps_are_nearly_the_averages(void **state)
{
    (void)state;
    static struct kiln_body birds[BIRDS];
    static const float places[] = {0.0f, 1000.0f};
    for (int far = 0; far < 2; far++) {
        fly(birds, places[far]);
        const struct averages expected = in_double(birds);
        const struct averages found[] = {by_integers(birds), by_mip_maps(birds, GL_RGBA32F),
                                         by_mip_maps(birds, GL_RGBA16F)};
        static const char *const names[] = {"integers", "RGBA32F", "RGBA16F"};
        double errors[3];
        for (int k = 0; k < 3; k++) {
            errors[k] = error_of(&found[k], &expected, 0);
            print_message("%d birds at %4.0f m by %-8s: off by %.2g m and %.2g m/s\n", BIRDS,
                          (double)places[far], names[k], errors[k],
                          error_of(&found[k], &expected, 3));
        }
        assert_true(errors[0] <= 0x1p-22 + (double)places[far] * 0x1p-20);
        assert_true(errors[1] < 1e-5 + (double)places[far] * 1e-6);
        assert_true(errors[2] > errors[0] && errors[2] < 0.05 + (double)places[far] * 4e-3);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(mip_maps_are_nearly_the_averages),
    };
    return cmocka_run_group_tests_name("flock_means", tests, test_device_open, test_device_close);
}
