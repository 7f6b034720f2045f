/* Steps a scene by several techniques side by side, and compares their state hashes. */
#include "support/agree.h"

#include "support/cmocka.h"
#include "support/parts.h"
#include "support/scenes.h"
#include "support/simulation.h"

/* Returns the number of living particles after the last step. */
static uint64_t compare(struct kiln_device *device, const struct kiln_scene *scene,
                        enum kiln_simulate_technique technique, const char *name, uint32_t steps)
{
    struct simulation cpu, other;
    uint64_t alive = 0, other_alive;
    simulation_start(&cpu, scene, NULL, 2);
    simulation_start_with(&other, scene, device, technique, 1);
    for (uint32_t step = 1; step <= steps; step++) {
        simulation_run(&cpu, 1);
        simulation_run(&other, 1);
        const struct kiln_state_hash a = simulation_hash(&cpu, &alive);
        const struct kiln_state_hash b = simulation_hash(&other, &other_alive);
        if (alive != other_alive || a.lane[0] != b.lane[0] || a.lane[1] != b.lane[1])
            fail_msg("step %u: %08x%08x on cpu, %08x%08x with %s", step, a.lane[0], a.lane[1],
                     b.lane[0], b.lane[1], name);
    }
    simulation_end(&other);
    simulation_end(&cpu);
    return alive;
}

void simulation_agree(struct kiln_device *device, const char *text, const char *override,
                      uint32_t steps)
{
    static const struct {
        enum kiln_simulate_technique technique;
        const char *name;
    } ways[] = {{KILN_SIMULATE_INPLACE, "inplace"},
                {KILN_SIMULATE_FEEDBACK, "feedback"},
                {KILN_SIMULATE_PINGPONG, "pingpong"},
                {KILN_SIMULATE_TEXELS, "texels"}};
    const char *const overrides[] = {override, NULL};
    struct kiln_scene *scene = load_scene(text, override ? overrides : NULL);
    for (size_t i = 0; i < (test_is_full() ? 4 : 1); i++) {
        const uint64_t alive = compare(device, scene, ways[i].technique, ways[i].name, steps);
        assert_true(alive > 500);
    }
    kiln_scene_destroy(&scene);
}
