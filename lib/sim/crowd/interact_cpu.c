/* This file gathers pushes on the host: collisions between particles, and their gravity. Each
 * thread computes some of the bodies. A round reads the state before it and writes only its own
 * result, so the division among threads changes no bit. */
#include <string.h>

#include "shared/interact_gravity.h"
#include "shared/interact_speeds.h"
#include "sim/crowd/contact_row.h"
#include "sim/crowd/interact_crowd.h"

enum { BODIES_AT_A_TIME = 512 };

/* ---- bounds of velocities -------------------------------------------------------------------- */

struct speeds {
    const struct kiln_particle *records; /* records of the system */
    _Atomic uint32_t bounds[SPEEDS_BOUNDS];
};

static void raise_bound(_Atomic uint32_t *bound, uint32_t to)
{
    uint32_t now = atomic_load(bound);
    while (now < to && !atomic_compare_exchange_weak(bound, &now, to))
        continue;
}

static void bound_speeds(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct speeds *speeds = context;
    uint32_t bounds[SPEEDS_BOUNDS] = {0};
    for (size_t slot = begin; slot < end; slot++) {
        if (!particle_is_alive(speeds->records[slot]))
            continue;
        const float3 velocity = particle_velocity(speeds->records[slot]);
        for (uint32_t i = 0; i < SPEEDS_BOUNDS; i++) {
            const uint32_t bound = speeds_bound(velocity, i);
            bounds[i] = bound > bounds[i] ? bound : bounds[i];
        }
    }
    for (uint32_t i = 0; i < SPEEDS_BOUNDS; i++)
        raise_bound(&speeds->bounds[i], bounds[i]);
}

bool kiln_interact_cpu_speeds(struct kiln_interact *interact, const struct kiln_interact_work *work,
                              struct kiln_pool *pool, uint32_t *bounds, struct kiln_error *error)
{
    const struct kiln_particle *records = kiln_buffer_host(&pool->records, KILN_READ, error);
    if (!records)
        return false;
    struct speeds speeds = {.records = records + work->params.base};
    kiln_threads_for(interact->threads, work->params.used, BODIES_AT_A_TIME, bound_speeds, &speeds);
    for (uint32_t i = 0; i < SPEEDS_BOUNDS; i++)
        bounds[i] = atomic_load(&speeds.bounds[i]);
    return true;
}

/* ---- collisions ------------------------------------------------------------------------------ */

static void answer(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct kiln_interact_crowd *crowd = context;
    for (size_t i = begin; i < end; i++)
        crowd->after[i] = contact_after(&crowd->view, (uint32_t)i);
}

static void answer_turning(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct kiln_interact_crowd *crowd = context;
    const uint32_t used = crowd->view.params->used;
    for (size_t i = begin; i < end; i++) {
        const struct contact_turning after = contact_after_turning(&crowd->view, (uint32_t)i);
        crowd->after[i] = after.body;
        crowd->after[used + i].position_radius = spin_words_of(after.rate);
    }
}

static void swap_bodies(struct kiln_interact_crowd *crowd)
{
    struct kiln_body *before = crowd->bodies;
    crowd->bodies = crowd->after;
    crowd->after = before;
    crowd->view.bodies = crowd->bodies;
}

static void push(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct kiln_interact_crowd *crowd = context;
    const uint32_t used = crowd->view.params->used;
    for (size_t i = begin; i < end; i++) {
        const uint32_t slot = crowd->bodies[i].velocity_slot.w;
        const struct body_push push = body_push_of(crowd->bodies[i], crowd->records[slot]);
        crowd->pushes[(size_t)slot * 2] = push.velocity;
        crowd->pushes[(size_t)slot * 2 + 1] = push.position;
        if (crowd->spins)
            crowd->spins[slot].rate = crowd->bodies[used + i].position_radius;
    }
}

static bool begin(struct kiln_interact_crowd *crowd, struct kiln_interact *interact,
                  const struct kiln_interact_work *work, struct kiln_pool *pool,
                  struct kiln_error *error)
{
    const struct kiln_interact_params *params = &work->params;
    const struct kiln_particle *records = kiln_buffer_host(&pool->records, KILN_READ, error);
    float4 *pushes = kiln_buffer_host(&interact->pushes, KILN_READ_WRITE, error);
    *crowd = (struct kiln_interact_crowd){
        .threads = interact->threads,
        .bodies = kiln_buffer_host(&interact->bodies, KILN_READ_WRITE, error),
        .after = kiln_buffer_host(&interact->second, KILN_READ_WRITE, error),
        .cell_ends = kiln_buffer_host(&interact->cells, KILN_READ_WRITE, error),
        .partners = kiln_buffer_host(&interact->partners, KILN_READ_WRITE, error),
        .order = kiln_buffer_host(&interact->order, KILN_READ_WRITE, error),
    };
    if (!records || !pushes || !crowd->bodies || !crowd->after || !crowd->cell_ends ||
        !crowd->partners || !crowd->order)
        return false;
    if (params->spins) {
        crowd->spins = kiln_buffer_host(&pool->spins, KILN_READ_WRITE, error);
        if (!crowd->spins)
            return false;
        crowd->spins += params->first_spin;
    }
    crowd->records = records + params->base;
    crowd->pushes = pushes + (size_t)params->first_push * 2;
    crowd->view = (struct kiln_crowd){.params = params,
                                      .value_keys = interact->scene->keys,
                                      .bodies = crowd->bodies,
                                      .cell_ends = crowd->cell_ends,
                                      .partners = crowd->partners,
                                      .order = crowd->order};
    return true;
}

static bool collide(struct kiln_interact *interact, const struct kiln_interact_work *work,
                    struct kiln_pool *pool, struct kiln_error *error)
{
    const struct kiln_contact_row *row = kiln_contact_row(work->mode);
    struct kiln_interact_crowd crowd;
    if (!begin(&crowd, interact, work, pool, error))
        return false;
    memset(crowd.pushes, 0, (size_t)work->params.used * 2 * sizeof *crowd.pushes);
    if (!row->sort(&crowd, interact, error))
        return false;
    for (uint32_t round = 0; round < work->rounds; round++) {
        atomic_store(&crowd.met, 0);
        crowd.later = round > 0;
        kiln_threads_for(interact->threads, crowd.count, BODIES_AT_A_TIME, row->find, &crowd);
        if (atomic_load(&crowd.met) == 0) /* no body has a partner, so further rounds would change
                                           * nothing */
            break;
        kiln_threads_for(interact->threads, crowd.count, BODIES_AT_A_TIME,
                         crowd.spins ? answer_turning : answer, &crowd);
        swap_bodies(&crowd);
    }
    kiln_threads_for(interact->threads, crowd.count, BODIES_AT_A_TIME, push, &crowd);
    return true;
}

/* ---- gravity -------------------------------------------------------------------------------- */

enum { TARGETS_AT_A_TIME = 4 * KILN_GRAVITY_BLOCK };

/* Fills in a source for each slot, and sources without mass up to a whole block. The buffer has
 * room for a power of two of them, at least 64. */
static void fill_sources(const struct kiln_crowd *view, const struct kiln_particle *records,
                         float4 *sources)
{
    const uint32_t used = view->params->used;
    for (uint32_t slot = 0; slot < used; slot++)
        sources[slot] = particle_is_alive(records[slot]) ? gravity_source(view, records[slot])
                                                         : gravity_no_source();
    for (uint32_t slot = used; slot % KILN_GRAVITY_BLOCK != 0; slot++)
        sources[slot] = gravity_no_source();
}

static void fill_places(const struct kiln_particle *records, uint32_t used, float4 *places)
{
    for (uint32_t slot = 0; slot < used || slot % KILN_GRAVITY_BLOCK != 0; slot++) {
        places[slot] = gravity_no_source();
        if (slot < used && particle_is_alive(records[slot])) {
            const float3 p = particle_position(records[slot]);
            places[slot] = FLOAT4(p.x, p.y, p.z, 0.0f);
        }
    }
}

static bool pull(struct kiln_interact *interact, const struct kiln_interact_work *work,
                 struct kiln_pool *pool, struct kiln_error *error)
{
    const struct kiln_interact_params *params = &work->params;
    const struct kiln_crowd view = {.params = &work->sources, .value_keys = interact->scene->keys};
    const struct kiln_particle *records = kiln_buffer_host(&pool->records, KILN_READ, error);
    float4 *pushes = kiln_buffer_host(&interact->pushes, KILN_READ_WRITE, error);
    float4 *sources = kiln_buffer_host(&interact->entries, KILN_READ_WRITE, error);
    float3 *accelerations = kiln_buffer_host(&interact->accelerations, KILN_READ_WRITE, error);
    if (!records || !pushes || !sources || !accelerations)
        return false;
    float4 *places = work->of_other ? sources + interact->half : sources;
    fill_sources(&view, records + work->sources.base, sources);
    records += params->base;
    pushes += (size_t)params->first_push * 2;
    if (work->of_other)
        fill_places(records, params->used, places);
    struct kiln_gravity gravity = {.sources = sources,
                                   .count = work->sources.used,
                                   .places = places,
                                   .softening_square = params->softening_square,
                                   .accelerations = accelerations};
    kiln_threads_for(interact->threads, params->used, TARGETS_AT_A_TIME, interact->gravity->pull,
                     &gravity);
    if (!params->adds)
        memset(pushes, 0, (size_t)params->used * 2 * sizeof *pushes);
    for (size_t slot = 0; slot < params->used; slot++) {
        float4 *push = &pushes[slot * 2];
        if (particle_is_alive(records[slot]))
            *push = gravity_push(*push, accelerations[slot], params->derived.dt_s);
    }
    return true;
}

bool kiln_interact_cpu(struct kiln_interact *interact, const struct kiln_interact_work *work,
                       struct kiln_pool *pool, struct kiln_error *error)
{
    return (!work->collides || collide(interact, work, pool, error)) &&
           (!work->pulls || pull(interact, work, pool, error)) &&
           (!work->flocks || kiln_interact_flock_cpu(interact, work, pool, error));
}
