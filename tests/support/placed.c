/* Loads a scene and places particles in its pool by hand, so that tests of single drawing stages
 * need no simulation. */
#include "support/placed.h"

#include "draw/moment/view.h"
#include "support/cmocka.h"
#include "support/pools.h"
#include "support/scenes.h"

void placed_set_up(struct placed *f, const char *text, const char *override)
{
    struct kiln_error error = {0};
    const char *const overrides[] = {override, NULL};
    f->scene = load_scene(text, overrides);
    pool_init_even(&f->pool, NULL, f->scene, PLACED_MOST);
    f->records = kiln_buffer_host(&f->pool.records, KILN_READ_WRITE, &error);
    assert_non_null(f->records);
    assert_true(kiln_moment_init(&f->moment, NULL, f->scene, NULL, &error));
    assert_true(
        kiln_moment_fill(&f->moment, &f->pool, kiln_instant_at_step(PLACED_STEP), true, &error));
    f->threads = kiln_threads_create(2);
    assert_non_null(f->threads);
}

void placed_tear_down(struct placed *f)
{
    kiln_moment_finish(&f->moment);
    kiln_threads_destroy(&f->threads);
    kiln_pool_finish(&f->pool);
    kiln_scene_destroy(&f->scene);
}

void placed_add(struct placed *f, uint32_t system, float3 position, uint32_t birth_step)
{
    struct kiln_pool_system *slots = &f->pool.systems[system];
    uint32_t serial = (uint32_t)slots->next_serial++;
    assert_true(serial < PLACED_MOST);
    f->records[slots->base + serial] = (struct kiln_particle){
        .position_serial = {FLOAT_BITS(position.x), FLOAT_BITS(position.y), FLOAT_BITS(position.z),
                            serial},
        .velocity_birth = {0, 0, 0, birth_step << KILN_BIRTH_STEP_SHIFT | KILN_PARTICLE_ALIVE}};
}
