/* Steers flocks on the host. It sorts the bodies into cells; then each thread computes the steering
 * of some of them. What a particle sees is a sum of integers, so the order of the others changes no
 * bit. */
#include <string.h>

#include "sim/crowd/flock.h"
#include "sim/crowd/interact_crowd.h"

enum { BIRDS_AT_A_TIME = 128 };

struct flock {
    struct kiln_flock_birds birds;
    kiln_flock_look *look;
    float4 *pushes; /* pushes of the system */
    struct flock_means means;
};

static struct flock_means means_of(const struct kiln_body *bodies, uint32_t count)
{
    struct flock_all all = flock_nobody();
    for (uint32_t i = 0; i < count; i++)
        all = flock_all_add(all, flock_all_of(bodies[i]));
    return flock_means_of(all, count);
}

static void steer(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct flock *flock = context;
    const struct kiln_crowd *view = &flock->birds.view;
    for (size_t i = begin; i < end; i++) {
        const struct kiln_body body = view->bodies[i];
        const struct flock_sums sums =
            view->params->flock.looks ? flock->look(&flock->birds, (uint32_t)i) : flock_no_sums();
        float4 *push = &flock->pushes[(size_t)body.velocity_slot.w * 2];
        *push = flock_push(view, *push, body, flock_acceleration(view, body, sums, flock->means));
    }
}

/* Copies positions and velocities into one row a component, which vector loops read. */
static void fill_rows(struct kiln_flock_birds *birds, float *rows, uint32_t count)
{
    const struct kiln_body *bodies = birds->view.bodies;
    for (size_t row = 0; row < KILN_FLOCK_ROWS; row++)
        birds->rows[row] = rows + row * count;
    for (size_t i = 0; i < count; i++) {
        const float3 position = body_position(bodies[i]), velocity = body_velocity(bodies[i]);
        const float floats[KILN_FLOCK_ROWS] = {position.x, position.y, position.z,
                                               velocity.x, velocity.y, velocity.z};
        for (size_t row = 0; row < KILN_FLOCK_ROWS; row++)
            rows[row * count + i] = floats[row];
    }
}

bool kiln_interact_flock_cpu(struct kiln_interact *interact, const struct kiln_interact_work *work,
                             struct kiln_pool *pool, struct kiln_error *error)
{
    const struct kiln_interact_params *params = &work->params;
    const struct kiln_particle *records = kiln_buffer_host(&pool->records, KILN_READ, error);
    float4 *pushes = kiln_buffer_host(&interact->pushes, KILN_READ_WRITE, error);
    struct kiln_body *bodies = kiln_buffer_host(&interact->bodies, KILN_READ_WRITE, error);
    uint32_t *cell_ends = kiln_buffer_host(&interact->cells, KILN_READ_WRITE, error);
    uint32_t *order = kiln_buffer_host(&interact->order, KILN_READ_WRITE, error);
    float *rows = kiln_buffer_host(&interact->second, KILN_READ_WRITE, error);
    if (!records || !pushes || !bodies || !cell_ends || !order || !rows)
        return false;
    struct flock flock = {.birds.view = {.params = params,
                                         .value_keys = interact->scene->keys,
                                         .bodies = bodies,
                                         .cell_ends = cell_ends},
                          .look = interact->flock->look,
                          .pushes = pushes + (size_t)params->first_push * 2};
    if (!params->adds)
        memset(flock.pushes, 0, (size_t)params->used * 2 * sizeof *flock.pushes);
    struct kiln_interact_crowd crowd = {.view = flock.birds.view,
                                        .threads = interact->threads,
                                        .records = records + params->base,
                                        .bodies = bodies,
                                        .cell_ends = cell_ends,
                                        .order = order};
    kiln_interact_into_cells(&crowd);
    fill_rows(&flock.birds, rows, crowd.count);
    flock.means = means_of(bodies, crowd.count);
    kiln_threads_for(interact->threads, crowd.count, BIRDS_AT_A_TIME, steer, &flock);
    return true;
}
