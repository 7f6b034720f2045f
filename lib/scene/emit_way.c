/* This file sums up the ways of emitters that have births by the metre, when a scene is read.
 *
 * The sum after each step is in a table, as an integer. So the births of a step depend on the scene
 * alone: not on where a job began, nor on a state. The way of a step is the integral of the speed,
 * by three points of Gauss and Legendre; an emitter that jumps has no way while it does. */
#include "scene/emit_way.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "scene/instant.h"
#include "scene/validate.h"

/* Returns the speed of the centre of a system's shape in the world, m/s. */
static double speed_at(const struct kiln_scene *scene, uint32_t index, double time_s)
{
    const struct kiln_emitter *emit = &scene->systems[index].emit;
    const float at_s = (float)time_s;
    const struct value_clocks clocks = kiln_scene_clocks(scene, index, at_s);
    const float3 origin = kiln_scene_system_value3(scene, index, &emit->origin, at_s);
    const float3 rate = {value_rate_at(scene->keys, emit->origin.x, clocks),
                         value_rate_at(scene->keys, emit->origin.y, clocks),
                         value_rate_at(scene->keys, emit->origin.z, clocks)};
    double v[3];
    if (emit->source.of_object) {
        const struct kiln_object *object = &scene->backdrop.objects[emit->source.number];
        const struct kiln_node_frame frame = kiln_object_frame_at(scene, object, at_s, at_s);
        kiln_frame_velocity(&frame, origin, rate, v);
    } else {
        kiln_attached_velocity(scene, &emit->attach, origin, rate, at_s, v);
    }
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* Returns the metres of a step's way. */
static double way_of(const struct kiln_scene *scene, uint32_t index, uint32_t step)
{
    static const double places[3] = {0.11270166537925831, 0.5, 0.8872983346207417};
    static const double weights[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    const double dt_s = (double)scene->rate.den / (double)scene->rate.num;
    const double start_s = ((double)step - 1 - (double)scene->warmup_steps) * dt_s;
    double way = 0;
    for (int i = 0; i < 3; i++)
        way += weights[i] * dt_s * speed_at(scene, index, start_s + places[i] * dt_s);
    return way;
}

/* Warns of a system that has births by the metre alone, and a way that is too short for one. */
static void warn_of_none(struct kiln_reader *reader, const struct kiln_node *root, uint32_t index,
                         const char *path)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    const struct kiln_emitter *emit = &scene->systems[index].emit;
    const uint64_t sum = emit->by_way[emit->way_count - 1];
    if (sum >> 32 > 0 || emit->burst_count > 0 || kiln_scene_value_max(scene, &emit->rate) > 0.0f)
        return;
    if (sum == 0)
        kiln_reader_warn_at(reader, root, path,
                            "nothing is born: there are births by the metre alone, and the origin "
                            "of `from` does not move in the whole run; `rate` has births where "
                            "nothing moves");
    else
        kiln_reader_warn_at(reader, root, path,
                            "nothing is born: there are births by the metre alone, and the way of "
                            "the origin of `from` in the whole run is %.3g m, shorter than from "
                            "one birth to the next, %.3g m",
                            (double)sum / 4294967296.0 / emit->per_metre, 1 / emit->per_metre);
}

/* Sums up the way of a system, after each of `count` steps, the first of which is 0. */
static bool settle(struct kiln_reader *reader, const struct kiln_node *root, uint32_t index,
                   uint32_t count)
{
    struct kiln_scene *scene = kiln_reader_scene(reader);
    struct kiln_emitter *emit = &scene->systems[index].emit;
    uint64_t *sums = kiln_arena_alloc(reader->arena, count, sizeof *sums);
    char path[128];
    snprintf(path, sizeof path, "systems.%s.emit.per_metre", scene->systems[index].name);
    if (!sums)
        return kiln_reader_out_of_memory(reader);
    sums[0] = 0;
    for (uint32_t step = 1; step < count; step++) {
        const double births = way_of(scene, index, step) * emit->per_metre;
        if (!(births + (double)(sums[step - 1] >> 32) < 4294967294.0))
            return kiln_reader_error_at(reader, root, path,
                                        "the run has more than %" PRIu32 " births by the metre",
                                        UINT32_MAX);
        sums[step] = sums[step - 1] + (uint64_t)(births * 4294967296.0 + 0.5);
    }
    emit->by_way = sums;
    emit->way_count = count;
    warn_of_none(reader, root, index, path);
    return true;
}

static bool has_way(const struct kiln_system *system)
{
    return system->enabled && system->emit.per_metre > 0 && !system->emit.parent.enabled;
}

bool kiln_emit_ways_settle(struct kiln_reader *reader, const struct kiln_node *root)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    const uint32_t steps = kiln_scene_last_step(scene, scene->frames - 1);
    uint64_t ways = 0;
    bool ok = true;
    for (uint32_t i = 0; i < scene->system_count; i++)
        ways += has_way(&scene->systems[i]);
    if (ways * steps > KILN_MAX_WAY_STEPS)
        return kiln_reader_error_at(reader, root, "systems",
                                    "the ways of emitters by the metre have %" PRIu64
                                    " steps; at most %d are allowed: shorten the clip, or write "
                                    "`rate` instead",
                                    ways * steps, KILN_MAX_WAY_STEPS);
    for (uint32_t i = 0; ok && i < scene->system_count; i++)
        ok = !has_way(&scene->systems[i]) || settle(reader, root, i, steps + 2);
    return ok;
}
