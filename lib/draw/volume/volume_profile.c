/* This file allocates the profiles of gas. There is room for the most places in all pixels, and the
 * system gives memory to what is written alone. */
#include "draw/volume/volume_profile.h"

#include <assert.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"

/* Gas is expected in one of so many packets, which then have so many places. */
enum { EXPECTED_PART = 3, EXPECTED_PLACES = 20 };

/* Returns the bytes of the profiles of a packet. */
static size_t bytes_of(uint32_t count)
{
    const size_t floats = ((size_t)count + 15) / 16 * 16;
    return sizeof(struct kiln_volume_profile) + floats * sizeof(float) +
           (size_t)count * VOLUME_PACKET * VOLUME_NODE * sizeof(uint16_t);
}
static_assert(sizeof(struct kiln_volume_profile) % VOLUME_PROFILE_UNIT == 0, "places of profiles");
static_assert((size_t)VOLUME_PACKET * VOLUME_NODE * sizeof(uint16_t) % VOLUME_PROFILE_UNIT == 0,
              "as above");

/* Returns the most packets of a picture. */
static size_t packets_of(uint32_t tiles)
{
    return (size_t)tiles * VOLUME_TILE * VOLUME_TILE / VOLUME_PACKET;
}

static bool make_room(struct kiln_volume_domain *d, size_t pixels, uint32_t tiles)
{
    if (d->profile_of)
        return true;
    d->profile_of = malloc(pixels * sizeof *d->profile_of);
    d->near_m = malloc(tiles * sizeof *d->near_m);
    d->memory = aligned_alloc(VOLUME_PROFILE_UNIT,
                              VOLUME_PROFILE_UNIT + packets_of(tiles) * bytes_of(VOLUME_NODES));
    return d->profile_of && d->near_m && d->memory;
}

bool kiln_volume_profiles_begin(struct kiln_volume_profiles *profiles, uint32_t count,
                                uint32_t width, uint32_t height, struct kiln_error *error)
{
    const size_t pixels = (size_t)width * height;
    profiles->width = width;
    profiles->height = height;
    profiles->across = kiln_tiles_along(width);
    profiles->tiles = profiles->across * kiln_tiles_along(height);
    profiles->count = count;
    profiles->drawn++;
    for (uint32_t i = 0; i < count; i++) {
        struct kiln_volume_domain *d = &profiles->domains[i];
        if (!make_room(d, pixels, profiles->tiles)) {
            kiln_volume_profiles_finish(profiles);
            return kiln_error_no_memory(error, "drawn gas");
        }
        atomic_store(&d->used, VOLUME_PROFILE_UNIT); /* place 0 means none */
        memset(d->profile_of, 0, pixels * sizeof *d->profile_of);
        for (uint32_t k = 0; k < profiles->tiles; k++)
            d->near_m[k] = 1e9f;
    }
    return true;
}

void kiln_volume_profiles_finish(struct kiln_volume_profiles *profiles)
{
    for (uint32_t i = 0; i < KILN_MAX_GAS; i++) {
        struct kiln_volume_domain *d = &profiles->domains[i];
        free(d->profile_of);
        free(d->near_m);
        free(d->memory);
        d->profile_of = NULL;
        d->near_m = NULL;
        d->memory = NULL;
    }
    profiles->count = 0;
}

struct kiln_volume_profile *kiln_volume_profile_take(struct kiln_volume_domain *domain,
                                                     uint32_t count)
{
    const size_t at = atomic_fetch_add(&domain->used, bytes_of(count));
    struct kiln_volume_profile *profile =
        (struct kiln_volume_profile *)(void *)(domain->memory + at);
    profile->count = count;
    return profile;
}

void kiln_volume_profiles_footprint(uint32_t count, uint32_t width, uint32_t height,
                                    struct kiln_footprint *footprint)
{
    const uint64_t tiles = (uint64_t)kiln_tiles_along(width) * kiln_tiles_along(height);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PICTURE, (uint64_t)count * width * height,
                       sizeof(uint32_t));
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PICTURE,
                       count * packets_of((uint32_t)tiles) / EXPECTED_PART,
                       bytes_of(EXPECTED_PLACES));
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PICTURE, count * tiles, sizeof(float));
}
