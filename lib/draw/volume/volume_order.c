/* This file sorts domains of gas by the distance of their middles. */
#include "draw/volume/volume_order.h"

uint32_t kiln_volume_order(const struct kiln_scene *scene, const struct kiln_moment *moment,
                           const struct kiln_pool *pool, uint32_t order[KILN_MAX_GAS])
{
    float distance[KILN_MAX_GAS];
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->gas_count && i < pool->gas_count; i++) {
        const struct kiln_gas *gas = &pool->gas[i];
        if (!scene->gas[i].enabled || gas->cells.x == 0)
            continue;
        const struct kiln_gas_shape *shape = &gas->shape;
        const float half = 0.5f * shape->cell;
        const float3 middle = {shape->corner.x + half * (float)shape->cells.x,
                               shape->corner.y + half * (float)shape->cells.y,
                               shape->corner.z + half * (float)shape->cells.z};
        const float4 eye = moment->view.eye;
        const float3 at =
            kiln_attached_point(scene, &scene->gas[i].attach, middle, moment->view.clock.x);
        const float3 way = {at.x - eye.x, at.y - eye.y, at.z - eye.z};
        const float square = float3_dot(way, way);
        uint32_t place = count++;
        for (; place > 0 && distance[place - 1] < square; place--) {
            distance[place] = distance[place - 1];
            order[place] = order[place - 1];
        }
        distance[place] = square;
        order[place] = i;
    }
    return count;
}
