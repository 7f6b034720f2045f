/* A profile tells how gas dims what is behind it, and how it shines, along the ray of each pixel:
 * at each of some places on the way, the optical depth of the gas before the place, and the light
 * of that gas. Both change evenly from a place to the next one. Sprites within and behind gas are
 * blended by profiles.
 *
 * Let T be the part of the light from behind that the gas before a fragment lets through, and L the
 * light of that gas. The fragment has the premultiplied colour c and the alpha a. It then counts as
 * one with the colour T c + a L: the gas before it dims it, and it does not hide the light of that
 * gas. When all fragments are blended in their order by `over`, and all gas of the ray after them,
 * the result is the same as if the ray had been marched from fragment to fragment. */
#ifndef KILN_DRAW_VOLUME_VOLUME_PROFILE_H
#define KILN_DRAW_VOLUME_VOLUME_PROFILE_H

#include "base/footprint.h"
#include "particles/gas.h"
#include "shared/gas_profile.h"

/* The numbers at a place. Light is the upper half of a float, which is exact to 1/512 of it. */
enum {
    VOLUME_NODE_DEPTH, /* optical depth, in VOLUME_DEPTH_UNIT; at most 65535 of them */
    VOLUME_NODE_SMOKE, /* light that smoke scatters: rgb */
    VOLUME_NODE_FLAME = VOLUME_NODE_SMOKE + 3, /* light of flames: rgb */
    VOLUME_NODE = VOLUME_NODE_FLAME + 3 + 1    /* the last one is not used */
};

/* The unit of places in the memory of profiles, bytes. */
#define VOLUME_PROFILE_UNIT 64

/* Holds the profiles of a packet of pixels in a domain, whose places have the same distances from
 * the eye in all pixels. The numbers before the first place are those of the first one, and so
 * behind the last. Behind this struct lie the distances of the places and their numbers. */
struct kiln_volume_profile {
    _Alignas(64) float a_metre[VOLUME_PACKET]; /* steps along the ray for a metre of depth */
    uint32_t count;                            /* of places, at least 2 */
};

/* Returns the distances of the places, in steps from the eye, ascending. */
static inline float *kiln_volume_places(const struct kiln_volume_profile *profile)
{
    return (float *)(void *)(profile + 1);
}

/* Returns the numbers of a place, of all pixels. */
static inline uint16_t *kiln_volume_node(const struct kiln_volume_profile *profile, uint32_t place)
{
    const size_t floats = ((size_t)profile->count + 15) / 16 * 16;
    return (uint16_t *)(kiln_volume_places(profile) + floats) +
           (size_t)place * VOLUME_PACKET * VOLUME_NODE;
}

/* Returns the tiles along an edge of a picture. */
static inline uint32_t kiln_tiles_along(uint32_t pixels)
{
    return (pixels + VOLUME_TILE - 1) / VOLUME_TILE;
}

/* Holds the profiles of a domain. */
struct kiln_volume_domain {
    uint32_t *profile_of; /* of each pixel: 8 times the place of its profile in `memory`, in units
                             of VOLUME_PROFILE_UNIT, and its number in the profile's packet; or
                             VOLUME_NO_PROFILE, VOLUME_BETWEEN */
    float *near_m;        /* of each tile: no gas is nearer, m; 1e9: there is none */
    float bloom;          /* the part of the flames' light that glows */
    char *memory;         /* of the profiles */
    _Atomic size_t used;  /* bytes of it */
};

/* Says that a pixel, of number `pixel` in the picture, is number `lane` in the packet of a profile.
 */
static inline void kiln_volume_profile_put(struct kiln_volume_domain *domain, size_t pixel,
                                           const struct kiln_volume_profile *profile, uint32_t lane)
{
    const size_t bytes = (size_t)((const char *)profile - domain->memory);
    domain->profile_of[pixel] = (uint32_t)(bytes / VOLUME_PROFILE_UNIT) * VOLUME_PACKET + lane;
}

/* Says that the gas of a pixel is the mean of that of its neighbours. */
static inline void kiln_volume_profile_between(struct kiln_volume_domain *domain, size_t pixel)
{
    domain->profile_of[pixel] = VOLUME_BETWEEN;
}

/* Holds the profiles of a picture. */
struct kiln_volume_profiles {
    struct kiln_volume_domain domains[KILN_MAX_GAS]; /* from the nearest on */
    uint32_t count;                                  /* domains; 0: no gas is seen */
    uint32_t width, height;                          /* of the picture, px */
    uint32_t across, tiles;                          /* tiles of a row, and in all */
    uint64_t drawn; /* pictures so far: says whether a copy of these profiles is up to date */
};

/* Takes memory for the profiles of a packet with so many places, at most VOLUME_NODES, and sets
 * their count. Threads may call it at a time. */
struct kiln_volume_profile *kiln_volume_profile_take(struct kiln_volume_domain *domain,
                                                     uint32_t count);

/* Makes room for the profiles of some domains in a picture of width x height pixels, in which no
 * gas is seen. The sizes must be the same in all calls. Returns false with an error when memory is
 * short. */
bool kiln_volume_profiles_begin(struct kiln_volume_profiles *profiles, uint32_t count,
                                uint32_t width, uint32_t height, struct kiln_error *error);

void kiln_volume_profiles_finish(struct kiln_volume_profiles *profiles);

/* Adds the memory that the profiles of some domains are expected to take: gas is seen in a third of
 * the picture. */
void kiln_volume_profiles_footprint(uint32_t count, uint32_t width, uint32_t height,
                                    struct kiln_footprint *footprint);

#endif
