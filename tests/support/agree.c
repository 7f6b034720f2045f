/* Steps a scene by several techniques side by side, and compares their state hashes. */
#include "support/agree.h"

#include "support/cmocka.h"
#include "support/parts.h"
#include "support/scenes.h"
#include "support/simulation.h"

const struct simulation_way simulation_ways[] = {{KILN_SIMULATE_INPLACE, "inplace"},
                                                 {KILN_SIMULATE_FEEDBACK, "feedback"},
                                                 {KILN_SIMULATE_PINGPONG, "pingpong"},
                                                 {KILN_SIMULATE_TEXELS, "texels"}};

size_t simulation_way_count(void)
{
    return test_is_full() ? sizeof simulation_ways / sizeof *simulation_ways : 1;
}

/* Returns the number of living particles after the last step. */
static uint64_t compare(struct kiln_device *device, const struct kiln_scene *scene,
                        const struct simulation_way *way, uint32_t steps)
{
    struct simulation cpu, other;
    uint64_t alive = 0, other_alive;
    simulation_start(&cpu, scene, NULL, 2);
    simulation_start_with(&other, scene, device, way->technique, 1);
    for (uint32_t step = 1; step <= steps; step++) {
        simulation_run(&cpu, 1);
        simulation_run(&other, 1);
        const struct kiln_state_hash a = simulation_hash(&cpu, &alive);
        const struct kiln_state_hash b = simulation_hash(&other, &other_alive);
        if (alive != other_alive || a.lane[0] != b.lane[0] || a.lane[1] != b.lane[1])
            fail_msg("step %u: %08x%08x on cpu, %08x%08x with %s", step, a.lane[0], a.lane[1],
                     b.lane[0], b.lane[1], way->name);
    }
    simulation_end(&other);
    simulation_end(&cpu);
    return alive;
}

void simulation_agree(struct kiln_device *device, const char *text, const char *override,
                      uint32_t steps)
{
    const char *const overrides[] = {override, NULL};
    struct kiln_scene *scene = load_scene(text, override ? overrides : NULL);
    for (size_t i = 0; i < simulation_way_count(); i++) {
        const uint64_t alive = compare(device, scene, &simulation_ways[i], steps);
        assert_true(alive > 500);
    }
    kiln_scene_destroy(&scene);
}
