/* This file says what the stage that draws gas takes of memory, before it is created. */
#include "draw/light/sun_shade.h"
#include "draw/volume/volume.h"
#include "draw/volume/volume_cast.h"
#include "draw/volume/volume_glow.h"
#include "draw/volume/volume_light.h"
#include "scene/gas_extent.h"
#include "scene/work.h"

uint32_t kiln_volume_domains(const struct kiln_scene *scene)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->gas_count; i++)
        count += scene->gas[i].enabled;
    return count;
}

bool kiln_volume_has_half(const struct kiln_scene *scene)
{
    bool half = false;
    for (uint32_t i = 0; i < scene->gas_count; i++)
        half |= scene->gas[i].enabled && scene->gas[i].look.resolution == KILN_GAS_HALF;
    return half;
}

size_t kiln_volume_grid_of(const struct kiln_scene *scene)
{
    return kiln_volume_has_half(scene) ? kiln_volume_grid_bytes(scene->width, scene->height) : 0;
}

void kiln_volume_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    const uint64_t pixels = (uint64_t)scene->width * scene->height;
    uint64_t largest = 0;
    const uint32_t drawn = kiln_volume_domains(scene);
    if (drawn == 0)
        return;
    for (uint32_t i = 0; i < scene->gas_count; i++) {
        const struct kiln_gas_extent extent = kiln_gas_extent(scene, i);
        const struct kiln_gas_place cells = extent.cells;
        const uint64_t bytes = kiln_volume_field_bytes(&scene->gas[i].shape, extent.bricks) +
                               kiln_volume_slices_bytes(cells) + kiln_volume_glow_bytes(cells);
        largest = scene->gas[i].enabled && bytes > largest ? bytes : largest;
    }
    kiln_footprint_add(footprint, KILN_FOOTPRINT_GAS, 1, largest);
    if (scene->backdrop.object_count > 0)
        kiln_sun_shade_footprint(scene, footprint);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PICTURE, pixels, 12 * sizeof(float));
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PICTURE, 1, kiln_volume_grid_of(scene));
    if (kiln_scene_sprite_slots(scene) > 0)
        kiln_volume_profiles_footprint(drawn, scene->width, scene->height, footprint);
}
