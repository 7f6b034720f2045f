/* Gathers, before a step, what the particles of a system do to each other: pushes (shared/push.h).
 * The technique that steps the particles gathers them where their records lie, so that no record is
 * copied. All techniques give the same bits. */
#ifndef KILN_SIM_CROWD_INTERACT_H
#define KILN_SIM_CROWD_INTERACT_H

#include "base/thread.h"
#include "shared/interact_layout.h"
#include "sim/crowd/flock.h"
#include "sim/crowd/gravity.h"
#include "sim/world/params.h"

/* In the order of their use. */
enum kiln_interact_kernel {
    KILN_INTERACT_SPEEDS,
    KILN_INTERACT_COUNT,
    KILN_INTERACT_SCAN,
    KILN_INTERACT_PLACE,
    KILN_INTERACT_FIND,
    KILN_INTERACT_COUNT_STAGGERED,
    KILN_INTERACT_BITONIC,
    KILN_INTERACT_ORDER,
    KILN_INTERACT_ORDER_SECOND,
    KILN_INTERACT_FIND_STAGGERED,
    KILN_INTERACT_ANSWER,
    KILN_INTERACT_PUSH,
    KILN_INTERACT_SOURCES,
    KILN_INTERACT_GRAVITY_TILES,
    KILN_INTERACT_COUNT_FLOCK,
    KILN_INTERACT_FLOCK_MEANS,
    KILN_INTERACT_FLOCK_STEER,
    KILN_INTERACT_KERNELS
};

/* What is gathered for a system in a step. */
struct kiln_interact_work {
    const char *system; /* its name */
    struct kiln_interact_params params;
    struct kiln_interact_params sources; /* gravity: of the system that pulls, which may be this */
    bool of_other;                       /* it is another one */
    bool collides, pulls, flocks;
    enum kiln_contact_mode mode; /* of collisions, and what follows: */
    uint32_t rounds;
    float width_m; /* of the largest particle */
    float fastest; /* m/s: approach that the scene wants foreseen; below 0: auto */
};

struct kiln_interact {
    const struct kiln_scene *scene;
    struct kiln_device *device; /* NULL: on the host, in threads */
    struct kiln_threads *threads;
    struct kiln_buffer pushes; /* of all systems: float4 [2 * push_count] */
    /* scratch for one system at a time: */
    struct kiln_buffer bodies, second;        /* struct kiln_body, of the largest system */
    struct kiln_buffer cells;                 /* uint32_t, some a particle */
    struct kiln_buffer partners;              /* uint32_t, one a body */
    struct kiln_buffer entries;               /* staggered: what is sorted; gravity: two halves */
    uint32_t half;                            /* of those: sources first, then what follows */
    struct kiln_buffer order;                 /* uint32_t, two a body */
    struct kiln_buffer counts;                /* staggered, on the host: of a sort */
    struct kiln_buffer accelerations;         /* gravity on the host: float3, one a slot */
    const struct kiln_gravity_loops *gravity; /* on the host */
    const struct kiln_flock_loops *flock;
    /* in GL: */
    struct kiln_buffer block;               /* struct kiln_interact_params */
    GLuint programs[KILN_INTERACT_KERNELS]; /* 0: not used by the scene */
    uint32_t group_size;
    bool spins; /* of some system, balls turn */

    char warning[512]; /* "": none */
    bool warned;
};

/* Nothing is allocated while no system interacts. After a failure, too, kiln_interact_finish frees
 * what there is. */
bool kiln_interact_init(struct kiln_interact *interact, struct kiln_device *device,
                        const struct kiln_scene *scene, const struct kiln_sim_params *params,
                        struct kiln_threads *threads, struct kiln_error *error);
void kiln_interact_finish(struct kiln_interact *interact);

/* Gathers the pushes of a step whose parameters are these, from the state before it. keys: the
 * scene's values, in GL; NULL on the host. */
bool kiln_interact_gather(struct kiln_interact *interact, const struct kiln_sim_params *params,
                          struct kiln_pool *pool, struct kiln_buffer *keys,
                          struct kiln_error *error);

/* A warning about the steps so far, the first of them alone; NULL: none. It is the interact's. */
const char *kiln_interact_warning(struct kiln_interact *interact);

/* ---- for the two ways to gather -------------------------------------------------------------- */

/* Room for so many entries: a power of two, at least 64. */
uint32_t kiln_interact_entries(uint32_t count);

/* The bounds of the velocities of all that live, as shared/interact_speeds.h has them. */
bool kiln_interact_cpu_speeds(struct kiln_interact *interact, const struct kiln_interact_work *work,
                              struct kiln_pool *pool, uint32_t *bounds, struct kiln_error *error);
bool kiln_interact_gl_speeds(struct kiln_interact *interact, const struct kiln_interact_work *work,
                             struct kiln_pool *pool, struct kiln_buffer *keys, uint32_t *bounds,
                             struct kiln_error *error);

bool kiln_interact_cpu(struct kiln_interact *interact, const struct kiln_interact_work *work,
                       struct kiln_pool *pool, struct kiln_error *error);

bool kiln_interact_flock_cpu(struct kiln_interact *interact, const struct kiln_interact_work *work,
                             struct kiln_pool *pool, struct kiln_error *error);

bool kiln_interact_gl_init(struct kiln_interact *interact, struct kiln_error *error);
bool kiln_interact_gl(struct kiln_interact *interact, const struct kiln_interact_work *work,
                      struct kiln_pool *pool, struct kiln_buffer *keys, struct kiln_error *error);

#endif
