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

/* Adds the box around a cylinder, or around a capsule: around balls at its ends. radii: of the
 * bounds around each end along the axes of the world, m. */
static void put_around_axis(struct kiln_object_bounds *bounds, uint32_t number, float4 center,
                            float4 axis, const float radii[3])
{
    const float half[3] = {fabsf(axis.x) * axis.w + radii[0], fabsf(axis.y) * axis.w + radii[1],
                           fabsf(axis.z) * axis.w + radii[2]};
    put(bounds, number, center, half);
}

/* along: of the disc's unit normal. */
static float disc_extent(float radius, float along)
{
    return radius * sqrtf(fmaxf(1.0f - along * along, 0.0f)) + ROUNDING * radius;
}

static uint32_t put_round(struct kiln_object_bounds *bounds, uint32_t number,
                          const struct kiln_draw_shapes *s)
{
    for (uint32_t i = 0; i < s->counts.x; i++) {
        const float radius = s->spheres[i].w;
        put(bounds, number++, s->spheres[i], (float[]){radius, radius, radius});
    }
    for (uint32_t i = 0; i < s->counts.y; i++) {
        const float radius = s->cylinders[i].w;
        const float4 axis = s->cylinder_axis[i];
        put_around_axis(bounds, number++, s->cylinders[i], axis,
                        (float[]){disc_extent(radius, axis.x), disc_extent(radius, axis.y),
                                  disc_extent(radius, axis.z)});
    }
    return number;
}

static uint32_t put_oriented(struct kiln_object_bounds *bounds, uint32_t number,
                             const struct kiln_draw_shapes *s)
{
    for (uint32_t i = 0; i < s->oriented_counts.x; i++) {
        const float radius = (1.0f + ROUNDING) * s->capsules[i].w;
        put_around_axis(bounds, number++, s->capsules[i], s->capsule_axis[i],
                        (float[]){radius, radius, radius});
    }
    for (uint32_t i = 0; i < s->oriented_counts.y; i++) {
        const struct kiln_draw_oriented_box *box = &s->oriented_boxes[i];
        const float sizes[3] = {box->half_size.x, box->half_size.y, box->half_size.z};
        float half[3] = {0};
        for (int k = 0; k < 3; k++) {
            half[0] += fabsf(box->rows[k].x) * sizes[k];
            half[1] += fabsf(box->rows[k].y) * sizes[k];
            half[2] += fabsf(box->rows[k].z) * sizes[k];
        }
        put(bounds, number++, box->center, half);
    }
    return number;
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
    uint32_t count = 0;
    for (; count < b->counts.x; count++) {
        const float4 half = b->box_half[count];
        put(bounds, count, b->box_center[count], (float[]){half.x, half.y, half.z});
    }
    count = put_round(bounds, count, &inputs->shapes);
    count = put_oriented(bounds, count, &inputs->shapes);
    put_meshes(bounds, &inputs->shapes);
    memset(casters, 0, sizeof *casters);
    casters->sun_objects = first_bits(count);
    casters->sun_meshes = first_bits(inputs->shapes.counts.z);
    for (uint32_t i = 0; i < b->counts.y; i++)
        casters->lamps[i] = b->lights[i].casters.x;
}
