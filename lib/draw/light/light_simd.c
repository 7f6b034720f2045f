/* This file computes the light of fire and the extinction of smoke for blocks of living particles.
 * Every loop runs over lanes and has no branches, so that compilers vectorise it. Sums are taken in
 * the same order at every level. */
#include <math.h>

#include "draw/light/light_blocks.h"
#include "shared/exact.h"

/* ---- fire ------------------------------------------------------------------------------------ */

enum { SUMS = 16 };

/* A vector of SUMS partial sums. It has this size whatever the width of the machine's vectors, so
 * that all levels add in the same order. */
typedef float partial_sums __attribute__((vector_size(4 * SUMS), may_alias));

static inline double sum_of(const partial_sums *of)
{
    const partial_sums parts = *of;
    double halves[SUMS / 2], sum = 0.0;
    for (int i = 0; i < SUMS / 2; i++)
        halves[i] = (double)(parts[i] + parts[i + SUMS / 2]);
    for (int i = 0; i < SUMS / 2; i++)
        sum += halves[i];
    return sum;
}

struct fire {
    alignas(64) kiln_floats place; /* place among the lights, 0 to light_count - 1 */
    kiln_floats red, green, blue, energy;
    kiln_floats sent;           /* m^2 of a particle's square that send light */
    struct kiln_floats3 offset; /* from `origin`, so that squares stay small */
    float3 origin;
    float place_min, place_max; /* of the places */
};

static inline void find_fire(struct fire *f, const struct kiln_appearance_block *b,
                             const struct kiln_glow *glow, float fill, uint32_t light_count)
{
    f->origin = kiln_get3(&b->position, 0);
    f->place_min = f->place_max = b->progress[0] * (float)(light_count - 1);
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        struct kiln_look_place at = kiln_look_place_at(b->progress[i]);
        float sent = fill * 4.0f * b->radius[i] * b->radius[i] * b->opacity[i];
        const float *r = glow->red + at.sample, *g = glow->green + at.sample;
        const float *l = glow->blue + at.sample;
        f->red[i] = sent * (r[0] + (r[1] - r[0]) * at.part);
        f->green[i] = sent * (g[0] + (g[1] - g[0]) * at.part);
        f->blue[i] = sent * (l[0] + (l[1] - l[0]) * at.part);
        f->sent[i] = sent;
        f->place[i] = b->progress[i] * (float)(light_count - 1);
        kiln_set3(&f->offset, i, float3_sub(kiln_get3(&b->position, i), f->origin));
    }
    for (uint32_t i = 0; i < KILN_LANES && glow->own; i++) {
        f->red[i] = f->sent[i] * glow->own->x[i];
        f->green[i] = f->sent[i] * glow->own->y[i];
        f->blue[i] = f->sent[i] * glow->own->z[i];
    }
    for (uint32_t i = 0; i < KILN_LANES; i++)
        f->energy[i] = (f->red[i] + f->green[i]) + f->blue[i];
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        f->place_min = exact_min(f->place_min, f->place[i]);
        f->place_max = exact_max(f->place_max, f->place[i]);
    }
}

/* Returns floats of an array, aligned to 64 bytes, as vectors of partial sums. */
static inline const partial_sums *as_sums(const float *from)
{
    return (const partial_sums *)__builtin_assume_aligned(from, 64);
}

/* Adds the block's particles to light k, each by its share. */
static inline void add_light(const struct fire *f, const struct kiln_appearance_block *b, float k,
                             struct kiln_light_sums *light)
{
    partial_sums red = {0}, green = {0}, blue = {0}, energy = {0}, radius = {0};
    partial_sums x = {0}, y = {0}, z = {0}, square = {0};
    for (uint32_t i = 0; i < KILN_LANES; i += SUMS) {
        partial_sums share;
        for (uint32_t j = 0; j < SUMS; j++)
            share[j] = exact_max(1.0f - exact_abs(f->place[i + j] - k), 0.0f);
        const partial_sums sent = share * *as_sums(f->energy + i);
        const partial_sums dx = *as_sums(f->offset.x + i), dy = *as_sums(f->offset.y + i);
        const partial_sums dz = *as_sums(f->offset.z + i);
        red += share * *as_sums(f->red + i);
        green += share * *as_sums(f->green + i);
        blue += share * *as_sums(f->blue + i);
        energy += sent;
        radius += sent * *as_sums(b->radius + i);
        x += sent * dx;
        y += sent * dy;
        z += sent * dz;
        square += sent * (dx * dx + dy * dy + dz * dz);
    }
    const double all = sum_of(&energy), offset[3] = {sum_of(&x), sum_of(&y), sum_of(&z)};
    const double origin[3] = {(double)f->origin.x, (double)f->origin.y, (double)f->origin.z};
    light->color[0] += sum_of(&red);
    light->color[1] += sum_of(&green);
    light->color[2] += sum_of(&blue);
    light->energy += all;
    light->radius += sum_of(&radius);
    light->square += sum_of(&square);
    for (int c = 0; c < 3; c++) {
        light->position[c] += offset[c] + all * origin[c];
        light->square += origin[c] * (2.0 * offset[c] + all * origin[c]);
    }
}

__attribute__((flatten)) static void gather_fire(const struct kiln_appearance_block *b,
                                                 const struct kiln_glow *glow, float fill,
                                                 uint32_t light_count,
                                                 struct kiln_light_sums *lights)
{
    struct fire fire;
    find_fire(&fire, b, glow, fill, light_count);
    for (uint32_t k = exact_uint(fire.place_min);
         k < light_count && (float)k < fire.place_max + 1.0f; k++)
        add_light(&fire, b, (float)k, &lights[k]);
}

/* ---- smoke ----------------------------------------------------------------------------------- */

/* Computes the extinction of each particle, summed over its ball. At the distance d from the
 * centre, in radii r, extinction is e (1 - d^2)^2. The optical depth through the middle of the ball
 * is then 16/15 e r, and the sum over its volume e r^3 32 pi / 105. */
__attribute__((flatten)) static void find_extinction(const struct kiln_appearance_block *b,
                                                     float cover, float shadow,
                                                     float extinction[KILN_LANES])
{
    for (uint32_t i = 0; i < KILN_LANES; i++) {
        float alpha = cover * b->opacity[i], radius = b->radius[i];
        float passed = 1.0f - (alpha < 0.98f ? alpha : 0.98f);
        float middle_depth = exact_log2(passed) * -0.693147181f * shadow;
        extinction[i] =
            middle_depth * 15.0f / 16.0f * radius * radius * (32.0f * 3.14159265f / 105.0f);
    }
}

const struct kiln_light_loops KILN_SIMD_NAME(kiln_light_loops) = {
    .gather_fire = gather_fire,
    .find_extinction = find_extinction,
};
