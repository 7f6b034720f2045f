/* Takes places and velocities between the frame of a domain, the world, and other nodes. */
#ifndef KILN_SIM_GAS_FRAMES_H
#define KILN_SIM_GAS_FRAMES_H

#include <string.h>

#include "scene/scene.h"
#include "shared/exact.h"

/* A map from one frame to another: the rows of a rotation with a scale, and what is added. */
struct gas_map {
    float row[3][4];
};

/* Returns the frame of a node at a clip time, or that of the world. */
static inline struct kiln_node_frame gas_frame(const struct kiln_scene *scene,
                                               const struct kiln_attach *attach, float time_s)
{
    if (attach->name)
        return kiln_node_frame_at(scene, attach->node, time_s, time_s);
    return (struct kiln_node_frame){.turn = {0.0, 0.0, 0.0, 1.0}, .scale = 1.0};
}

/* Fills in where the axes of a frame point: axis[i] is its i-th axis in the world. */
static inline void gas_axes(const struct kiln_node_frame *frame, double axis[3][3])
{
    const double *q = frame->turn, x = q[0], y = q[1], z = q[2], w = q[3];
    const double m[3][3] = {
        {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
        {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
        {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)},
    };
    memcpy(axis, m, sizeof m);
}

/* Returns the map of places in one frame to another. Lengths are in metres of the frames. */
static inline struct gas_map gas_map_between(const struct kiln_node_frame *from,
                                             const struct kiln_node_frame *to)
{
    double a[3][3], b[3][3];
    struct gas_map map;
    gas_axes(from, a);
    gas_axes(to, b);
    for (int i = 0; i < 3; i++) {
        double at = 0.0;
        for (int c = 0; c < 3; c++)
            at += b[i][c] * (from->at[c] - to->at[c]);
        for (int j = 0; j < 3; j++) {
            double sum = 0.0;
            for (int c = 0; c < 3; c++)
                sum += b[i][c] * a[j][c];
            map.row[i][j] = exact_canon((float)(sum * from->scale / to->scale));
        }
        map.row[i][3] = exact_canon((float)(at / to->scale));
    }
    return map;
}

static inline float3 gas_turned(const struct gas_map *map, float3 v)
{
    const float(*m)[4] = map->row;
    return FLOAT3((m[0][0] * v.x + m[0][1] * v.y) + m[0][2] * v.z,
                  (m[1][0] * v.x + m[1][1] * v.y) + m[1][2] * v.z,
                  (m[2][0] * v.x + m[2][1] * v.y) + m[2][2] * v.z);
}

static inline float3 gas_mapped(const struct gas_map *map, float3 p)
{
    const float3 turned = gas_turned(map, p);
    return FLOAT3(turned.x + map->row[0][3], turned.y + map->row[1][3], turned.z + map->row[2][3]);
}

/* Returns the velocity of a frame at a place of the world, m/s. */
static inline float3 gas_frame_velocity(const struct kiln_node_frame *frame, float3 p)
{
    const double d[3] = {(double)p.x - frame->at[0], (double)p.y - frame->at[1],
                         (double)p.z - frame->at[2]};
    const double *spin = frame->spin, *v = frame->velocity;
    const double grow = frame->growth / frame->scale;
    return FLOAT3(exact_canon((float)(v[0] + (spin[1] * d[2] - spin[2] * d[1]) + grow * d[0])),
                  exact_canon((float)(v[1] + (spin[2] * d[0] - spin[0] * d[2]) + grow * d[1])),
                  exact_canon((float)(v[2] + (spin[0] * d[1] - spin[1] * d[0]) + grow * d[2])));
}

#endif
