/* Finds what the pool of a scene holds. A canvas keeps a waiting splat for each slot of the systems
 * that paint, unless all splats are painted in their own step. */
#include "scene/pool_layout.h"

#include "scene/family.h"

uint32_t kiln_scene_paint_slots(const struct kiln_scene *scene)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->system_count; i++)
        count += kiln_scene_paints(scene, i) ? scene->systems[i].capacity : 0;
    return count;
}

struct kiln_pool_layout kiln_scene_pool_layout(const struct kiln_scene *scene)
{
    struct kiln_pool_layout layout = {.system_count = scene->system_count};
    for (uint32_t i = 0; i < scene->system_count; i++) {
        layout.capacities[i] = scene->systems[i].capacity;
        layout.spins[i] = kiln_scene_system_spins(scene, i);
        layout.travels[i] = kiln_family_travels(scene, i);
    }
    layout.gas_count = scene->gas_count;
    for (uint32_t i = 0; i < scene->gas_count; i++)
        layout.gas[i] = scene->gas[i].shape;
    const uint32_t slots = kiln_scene_paint_slots(scene);
    for (uint32_t i = 0; i < scene->backdrop.object_count && slots > 0; i++) {
        const struct kiln_object *object = &scene->backdrop.objects[i];
        if (!kiln_object_takes_paint(object))
            continue;
        const bool waits = object->paint.per_step != 0 && object->paint.per_step < slots;
        layout.canvases[layout.canvas_count++] =
            (struct kiln_canvas_shape){.edge = object->paint.size, .slot_count = waits ? slots : 0};
    }
    return layout;
}
