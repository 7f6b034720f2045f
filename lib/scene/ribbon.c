/* This file says which particles of a system one ribbon goes through. */
#include "scene/ribbon.h"

#include <stdio.h>

#include "scene/options.h"

/* The fewest particles of a burst that make a ribbon. */
enum { FEWEST = 2 };

uint32_t kiln_ribbon_most_parts(const struct kiln_scene *scene)
{
    uint32_t most = 0;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_look *look = &scene->systems[i].look;
        if (scene->systems[i].enabled && look->shape == KILN_SHAPE_RIBBON)
            most = look->ribbon.smooth > most ? look->ribbon.smooth : most;
    }
    return most;
}

bool kiln_ribbon_joins_parent(const struct kiln_system *system)
{
    return system->emit.parent.enabled && system->emit.parent.event == KILN_EVENT_TRAIL;
}

bool kiln_ribbon_is_at_once(const struct kiln_system *system)
{
    const struct kiln_emitter *emit = &system->emit;
    return emit->parent.enabled ? emit->parent.event != KILN_EVENT_TRAIL : emit->burst_count > 0;
}

uint32_t kiln_ribbon_run(const struct kiln_system *system)
{
    const struct kiln_emitter *emit = &system->emit;
    if (kiln_ribbon_joins_parent(system))
        return emit->parent.slots;
    if (emit->parent.enabled)
        return emit->parent.count[1];
    return emit->burst_count > 0 ? emit->bursts[0].count[1] : 0;
}

double kiln_ribbon_per_metre(const struct kiln_system *system)
{
    return system->emit.parent.enabled ? system->emit.parent.per_metre : system->emit.per_metre;
}

/* Checks that all bursts have one number of particles, by which their ribbons are told apart. */
static bool check_bursts(struct kiln_reader *reader, const struct kiln_node *root,
                         const struct kiln_system *system)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    const struct kiln_emitter *emit = &system->emit;
    char path[128];
    snprintf(path, sizeof path, "systems.%s.emit.bursts", system->name);
    if (kiln_scene_value_max(scene, &emit->rate) > 0.0f || emit->per_metre > 0.0)
        return kiln_reader_error_at(reader, root, path,
                                    "ribbons are of a rate or of bursts, and this system has both");
    for (uint32_t i = 0; i < emit->burst_count; i++) {
        const struct kiln_burst *burst = &emit->bursts[i];
        if (burst->count[0] != burst->count[1] || burst->count[1] != emit->bursts[0].count[1])
            return kiln_reader_error_at(
                reader, root, path,
                "found bursts of %u to %u particles; all bursts of ribbons must have one number",
                emit->bursts[0].count[0], burst->count[1]);
        if (burst->count[1] < FEWEST)
            return kiln_reader_error_at(reader, root, path,
                                        "found a burst of %u; a ribbon needs at least %d particles",
                                        burst->count[1], FEWEST);
    }
    return true;
}

static bool check_ribbon(struct kiln_reader *reader, const struct kiln_node *root,
                         const struct kiln_system *system)
{
    char path[128];
    if (system->look.shape != KILN_SHAPE_RIBBON)
        return true;
    snprintf(path, sizeof path, "systems.%s.look.atlas", system->name);
    if (system->look.atlas_count > 1)
        return kiln_reader_error_at(reader, root, path,
                                    "found %u textures; a ribbon has one, since it goes through "
                                    "many particles",
                                    system->look.atlas_count);
    snprintf(path, sizeof path, "systems.%s.look.ribbon.texture", system->name);
    if (system->look.ribbon.texture_m > 0.0 && kiln_ribbon_per_metre(system) <= 0.0)
        return kiln_reader_error_at(reader, root, path,
                                    "a length needs births by the metre: emit.per_metre, or "
                                    "per_metre of a trail");
    return system->emit.parent.enabled || system->emit.burst_count == 0 ||
           check_bursts(reader, root, system);
}

bool kiln_ribbons_check(struct kiln_reader *reader, const struct kiln_node *root)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    for (uint32_t i = 0; i < scene->system_count; i++)
        if (!check_ribbon(reader, root, &scene->systems[i]))
            return false;
    return true;
}
