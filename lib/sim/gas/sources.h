/* Adds the sources of a domain to its gas. Within a source, gas takes the source's values with a
 * rate; noise takes a part of them away. */
#ifndef KILN_SIM_GAS_SOURCES_H
#define KILN_SIM_GAS_SOURCES_H

#include "particles/pool.h"
#include "scene/scene.h"
#include "sim/gas/advect.h"
#include "sim/gas/splats.h"

/* A source at a time of a step. */
struct gas_source {
    const struct kiln_gas_source *from;
    struct gas_region region; /* bricks that it reaches */
    struct gas_map to_shape;
    float3 origin, axis, half; /* of the shape, m: half edges, or half the span of a line */
    float radius;
    float metres; /* of the domain, in one metre of the shape's frame */
    float reach, fuel, temperature, smoke;
    float rate;             /* 1/s */
    float taken;            /* part of the values that gas takes in a substep, wholly inside */
    float3 color, velocity; /* velocity: m/s, in the domain's frame */
    float outward;          /* m/s */
    float3 center;          /* of the shape, in the domain */
    float3 jet;             /* cone: its axis, in the domain */
    float narrow, wide;     /* cone: cosine and sine of its angle */
    float nozzle;           /* cone: radius of its small end, m of the domain */
    float noise, noise_scale, noise_rise; /* scale: 1/m */
    uint32_t seed;
    struct gas_splats *splats; /* of a system; NULL: of a shape */
};

struct gas_sources {
    const struct kiln_scene *scene;
    const struct kiln_gas_domain *domain;
    uint32_t number; /* of the domain */
    struct gas_source source[KILN_MAX_GAS_SOURCES];
    uint32_t count; /* sources that are on */
    struct gas_splats splats[KILN_MAX_GAS_SOURCES];
};

void gas_sources_init(struct gas_sources *sources, const struct kiln_scene *scene, uint32_t domain);
void gas_sources_finish(struct gas_sources *sources);

/* Evaluates the sources at a clip time. pool: the particles before the step, of which systems are
 * sources. False with KILN_DEVICE_FAILED when memory is short or the pool cannot be read. */
bool gas_sources_set(struct gas_sources *sources, struct kiln_pool *pool, uint32_t step,
                     struct kiln_error *error);

/* Fills in what depends on the length of a substep, s. */
void gas_sources_set_time(struct gas_sources *sources, float dt);

/* Adds all sources to `now` and `change` of a brick. Returns whether any reaches a cell. */
bool gas_sources_add(const struct gas_sources *sources, const struct gas_pass *pass,
                     const struct gas_advect *kernels, gas_brick_place at);

/* The following are for passes in GL, which add sources by a kernel. brings: describes a source;
 * false: there are no more. reach: fills in, for each cell of a brick, the velocity that the source
 * blows with, m/s, and how far the cell lies in it, 0 to 1; returns whether any does. */
bool gas_sources_brings(const struct gas_sources *sources, uint32_t number,
                        struct gas_brought *brought);
bool gas_sources_reach(const struct gas_sources *sources, const struct gas_pass *pass,
                       const struct gas_advect *kernels, uint32_t number, gas_brick_place at,
                       float4 *cells);

#endif
