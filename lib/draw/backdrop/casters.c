/* This file finds boxes around the objects that may hide lights. */
#include "draw/backdrop/casters.h"

#include <math.h>
#include <string.h>

#include "draw/backdrop/ray.h"

/* Bounds are larger by this part of a radius, since directions are not exactly unit vectors. */
#define ROUNDING 1e-4f

/* Texels of a mesh's shadow map by which its shadow may be wider than the mesh. */
#define MAP_MARGIN 8.0f

/* Adds a box. half: half of its edges, m. */
static void put(struct kiln_object_bounds *bounds, uint32_t number, float4 center,
                const float half[3])
{
    const float centers[3] = {center.x, center.y, center.z};
    for (int k = 0; k < 3; k++) {
        bounds->center[k][number] = centers[k];
        bounds->half[k][number] = half[k];
    }
}

static void put_shapes(struct kiln_object_bounds *bounds, const struct kiln_draw_shapes *s)
{
    static const float3 axes[3] = {{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
    for (uint32_t i = 0; i < s->counts.x; i++) {
        const struct kiln_draw_shape *shape = &s->shapes[i];
        float half[3];
        for (int k = 0; k < 3; k++)
            half[k] = kiln_shape_reach(shape, axes[k]) + ROUNDING * shape->center.w;
        put(bounds, i, shape->center, half);
    }
}

static void put_meshes(struct kiln_object_bounds *bounds, const struct kiln_draw_shapes *s)
{
    for (uint32_t i = 0; i < s->counts.z; i++) {
        const float4 center = s->meshes[i].center, half = s->meshes[i].half_size;
        const float texel = 2.0f * center.w * (1.0f + KILN_SHADOW_MARGIN) / (float)KILN_SHADOW_EDGE;
        const float more = MAP_MARGIN * texel;
        put(bounds, KILN_BOUNDS_MESHES + i, center,
            (float[]){half.x + more, half.y + more, half.z + more});
    }
}

void kiln_casters_find(const struct kiln_backdrop_inputs *inputs, struct kiln_object_bounds *bounds,
                       struct kiln_casters *casters)
{
    const struct kiln_draw_backdrop *b = &inputs->block;
    memset(bounds, 0, sizeof *bounds);
    put_shapes(bounds, &inputs->shapes);
    put_meshes(bounds, &inputs->shapes);
    memset(casters, 0, sizeof *casters);
    casters->sun_objects = kiln_shapes_that_hide(&inputs->shapes);
    const uint32_t meshes = inputs->shapes.counts.z;
    casters->sun_meshes = meshes < 64 ? ((uint64_t)1 << meshes) - 1 : ~(uint64_t)0;
    for (uint32_t i = 0; i < b->counts.y; i++)
        casters->lamps[i] = kiln_shape_set_of_lamp(&b->lights[i], inputs->shapes.counts.x);
}
