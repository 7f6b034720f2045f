/* This file sums up points that are sources of gas, brick by brick. One thread adds the points one
 * after another, so that the sums have one order. */
#include "sim/gas/splats.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "scene/source.h"
#include "shared/emit.h"
#include "shared/particle.h"
#include "sim/world/emit_frame.h"
#include "sim/world/params.h"
#include "sim/world/posed_births.h"

/* Samples of a source: so many that about this many reach each cell. */
#define SAMPLES_A_CELL 6.0
enum { LEAST_SAMPLES = 256, MOST_SAMPLES = 1 << 17 };

void gas_splats_finish(struct gas_splats *splats)
{
    free(splats->brick);
    free(splats->number);
    free(splats->words);
    free(splats->poses);
    *splats = (struct gas_splats){.brick = NULL};
}

struct gas_region gas_region_of(const struct kiln_gas_shape *shape, float3 low, float3 high)
{
    const float edge = shape->cell * (float)GAS_BRICK, most = (float)KILN_MAX_GAS_EDGE;
    const float3 c = shape->corner;
    const float from[3] = {low.x - c.x, low.y - c.y, low.z - c.z};
    const float to[3] = {high.x - c.x, high.y - c.y, high.z - c.z};
    int32_t a[3], b[3];
    for (int i = 0; i < 3; i++) {
        a[i] = (int32_t)FLOOR(exact_clamp(from[i] / edge, -1.0f, most));
        b[i] = (int32_t)FLOOR(exact_clamp(to[i] / edge, -1.0f, most)) + 1;
    }
    return (struct gas_region){{a[0], a[1], a[2]}, {b[0], b[1], b[2]}};
}

/* ---- points ---------------------------------------------------------------------------------- */

static bool begin(struct gas_splats *splats, const struct kiln_gas_shape *shape,
                  struct kiln_error *error)
{
    const size_t bricks = (size_t)(shape->cells.x / GAS_BRICK) *
                          (size_t)(shape->cells.y / GAS_BRICK) *
                          (size_t)(shape->cells.z / GAS_BRICK);
    if (!splats->number)
        splats->number = calloc(bricks, sizeof *splats->number);
    if (!splats->number)
        return kiln_error_no_memory(error, "sources of gas");
    memset(splats->number, 0, bricks * sizeof *splats->number);
    splats->count = 0;
    splats->any = false;
    return true;
}

static bool find_brick(struct gas_splats *splats, size_t brick, float (**to)[4])
{
    if (splats->number[brick] == 0) {
        if (splats->count == splats->room) {
            const uint32_t room = splats->room ? 2 * splats->room : 64;
            void *more = realloc(splats->brick, room * sizeof *splats->brick);
            if (!more)
                return false;
            splats->brick = more;
            splats->room = room;
        }
        memset(splats->brick[splats->count], 0, sizeof *splats->brick);
        splats->number[brick] = ++splats->count;
    }
    *to = splats->brick[splats->number[brick] - 1];
    return true;
}

static void include(struct gas_splats *splats, float3 p, float reach)
{
    const float3 from = FLOAT3(p.x - reach, p.y - reach, p.z - reach);
    const float3 to = FLOAT3(p.x + reach, p.y + reach, p.z + reach);
    const float3 low = splats->low, high = splats->high;
    splats->low = splats->any ? FLOAT3(exact_min(low.x, from.x), exact_min(low.y, from.y),
                                       exact_min(low.z, from.z))
                              : from;
    splats->high = splats->any ? FLOAT3(exact_max(high.x, to.x), exact_max(high.y, to.y),
                                        exact_max(high.z, to.z))
                               : to;
    splats->any = true;
}

/* Adds a point in the domain to the cells around it, by (1 - (distance / reach)^2)^2. */
static bool add(struct gas_splats *splats, const struct kiln_gas_shape *shape, float reach,
                float3 p, float3 velocity)
{
    const float cell = shape->cell, fewer = exact_rcp(reach * reach);
    const float place[3] = {(p.x - shape->corner.x) / cell, (p.y - shape->corner.y) / cell,
                            (p.z - shape->corner.z) / cell};
    const int32_t count[3] = {shape->cells.x, shape->cells.y, shape->cells.z};
    int32_t low[3], high[3];
    for (int i = 0; i < 3; i++) {
        const float r = reach / cell, most = (float)count[i];
        low[i] = (int32_t)FLOOR(exact_clamp(place[i] - r, 0.0f, most));
        high[i] = (int32_t)FLOOR(exact_clamp(place[i] + r + 1.0f, 0.0f, most));
    }
    for (int32_t z = low[2]; z < high[2]; z++)
        for (int32_t y = low[1]; y < high[1]; y++)
            for (int32_t x = low[0]; x < high[0]; x++) {
                const float dx = ((float)x + 0.5f - place[0]) * cell;
                const float dy = ((float)y + 0.5f - place[1]) * cell;
                const float dz = ((float)z + 0.5f - place[2]) * cell;
                const float left = 1.0f - ((dx * dx + dy * dy) + dz * dz) * fewer;
                const float weight = left > 0.0f ? left * left : 0.0f;
                float(*to)[4];
                if (weight <= 0.0f)
                    continue;
                const size_t brick = gas_brick_number(shape, (struct kiln_gas_place){x, y, z});
                if (!find_brick(splats, brick, &to))
                    return false;
                float *sum =
                    to[(z % GAS_BRICK * GAS_BRICK + y % GAS_BRICK) * GAS_BRICK + x % GAS_BRICK];
                sum[0] = sum[0] + weight * velocity.x;
                sum[1] = sum[1] + weight * velocity.y;
                sum[2] = sum[2] + weight * velocity.z;
                sum[3] = sum[3] + weight;
                include(splats, p, reach);
            }
    return true;
}

/* Takes points of the world to a domain. */
struct taking {
    const struct gas_splatting *how;
    struct kiln_node_frame frame; /* of the domain */
    struct gas_map map;
};

static struct taking taking_of(const struct gas_splatting *how)
{
    const struct kiln_node_frame world = {.turn = {0.0, 0.0, 0.0, 1.0}, .scale = 1.0};
    struct taking taking = {.how = how};
    taking.frame =
        gas_frame(how->scene, &how->domain->attach, kiln_scene_time(how->scene, how->step));
    taking.map = gas_map_between(&world, &taking.frame);
    return taking;
}

static bool take(struct gas_splats *splats, const struct taking *taking, float3 position,
                 float3 velocity, struct kiln_error *error)
{
    const struct gas_splatting *how = taking->how;
    const float3 own = gas_frame_velocity(&taking->frame, position);
    const float3 v = gas_turned(&taking->map, float3_sub(velocity, own));
    return add(splats, &how->domain->shape, how->reach, gas_mapped(&taking->map, position),
               float3_scale(v, how->inherit)) ||
           kiln_error_no_memory(error, "sources of gas");
}

/* ---- particles ------------------------------------------------------------------------------- */

bool gas_splats_set_particles(struct gas_splats *splats, const struct gas_splatting *how,
                              struct kiln_pool *pool, uint32_t system, struct kiln_error *error)
{
    const struct kiln_pool_system *from = &pool->systems[system];
    const struct kiln_particle *records = kiln_buffer_host(&pool->records, KILN_READ, error);
    const struct taking taking = taking_of(how);
    if (!records || !begin(splats, &how->domain->shape, error))
        return false;
    const uint32_t used = kiln_pool_used(from);
    const uint32_t oldest =
        used < from->capacity ? 0 : (uint32_t)(from->next_serial % from->capacity);
    for (uint32_t i = 0; i < used; i++) {
        const uint32_t slot = oldest + i < used ? oldest + i : oldest + i - used;
        const struct kiln_particle p = records[from->base + slot];
        if (particle_is_alive(p) &&
            !take(splats, &taking, particle_position(p), particle_velocity(p), error))
            return false;
    }
    return true;
}

/* ---- samples --------------------------------------------------------------------------------- */

static double length_of(float4 v)
{
    return sqrt((double)v.x * (double)v.x + (double)v.y * (double)v.y + (double)v.z * (double)v.z);
}

static double area_of(float4 a, float4 b)
{
    const float4 c =
        FLOAT4(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x, 0.0f);
    return 0.5 * length_of(c);
}

/* Returns how many samples an emitter has that lies in a frame of this scale: so many that they
 * cover it, by its length, area or volume. */
static uint32_t samples_of(const struct kiln_emitter *emit, const float4 *words, double reach)
{
    const struct kiln_source *made = emit->source.made;
    const double edge = (double)emit->source.edge;
    const bool on_mesh = emit->shape == KILN_EMITTER_MESH;
    const uint32_t triangle = made->corners ? SOURCE_POSED_WORDS : SOURCE_TRIANGLE_WORDS;
    double measure = 0.0, of_one = reach * reach; /* what a sample covers */
    for (uint32_t i = 0; i < made->cells; i++) {
        const float4 *word = words + (size_t)i;
        if (emit->shape == KILN_EMITTER_PATH) {
            const float4 way =
                FLOAT4(word[1].x - word[0].x, word[1].y - word[0].y, word[1].z - word[0].z, 0.0f);
            measure += length_of(way);
            of_one = reach;
        } else if (!on_mesh) {
            measure += edge * edge;
        } else if (emit->source.on == KILN_ON_VERTICES) {
            measure += of_one / SAMPLES_A_CELL;
        } else if (emit->source.on == KILN_ON_VOLUME) {
            const float4 *column = words + (size_t)i * SOURCE_COLUMN_WORDS;
            measure += edge * edge * (double)column[1].x;
            of_one = reach * reach * reach;
        } else {
            const float4 *corner = words + (size_t)i * triangle;
            measure += area_of(corner[1], corner[2]);
        }
    }
    const double samples = ceil(SAMPLES_A_CELL * measure / of_one);
    return (uint32_t)fmin(fmax(samples, LEAST_SAMPLES), MOST_SAMPLES);
}

/* Returns the words of a source in a step; those of a mesh with an animation are posed. */
static const float4 *words_of(struct gas_splats *splats, const struct gas_splatting *how,
                              const struct kiln_emitter *emit, struct kiln_error *error)
{
    const struct kiln_source *made = emit->source.made;
    const struct kiln_object *object = &how->scene->backdrop.objects[emit->source.number];
    if (!made->corners)
        return made->words;
    if (!splats->words) {
        splats->words = malloc(made->word_count * sizeof *splats->words);
        splats->poses = calloc(2 * (size_t)object->shown->vertex_count, sizeof *splats->poses);
        if (!splats->words || !splats->poses) {
            kiln_error_no_memory(error, "sources of gas");
            return NULL;
        }
        memcpy(splats->words, made->words, made->word_count * sizeof *splats->words);
    }
    kiln_sim_pose_words(splats->words, made, object, splats->poses,
                        kiln_scene_time(how->scene, how->step - 1),
                        kiln_scene_time(how->scene, how->step));
    return splats->words;
}

bool gas_splats_set_samples(struct gas_splats *splats, const struct gas_splatting *how,
                            const struct kiln_emitter *emit, uint32_t seed,
                            struct kiln_error *error)
{
    const struct kiln_scene *scene = how->scene;
    const float4 *words = words_of(splats, how, emit, error);
    const struct taking taking = taking_of(how);
    const float time_s = kiln_scene_time(scene, how->step);
    const struct value_clocks clocks =
        kiln_scene_clocks(scene, KILN_SYSTEM_OF_GAS((uint32_t)(how->domain - scene->gas)), time_s);
    struct kiln_step_params step = {
        .derived = {.random_key = clocks.system, .scene_key = clocks.scene}, .step = how->step};
    if (!words || !begin(splats, &how->domain->shape, error))
        return false;
    kiln_sim_emitter_fill(&step.emit, emit);
    step.emit.inherit = (struct kiln_value){.constant = 1.0f};
    step.emit.speed = (struct kiln_range){.min = {.constant = 0.0f}};
    if (step.emit.attached)
        step.emit.frame = kiln_emit_frame(scene, emit, how->step);
    const struct kiln_sim sim = {.step = &step, .value_keys = scene->keys, .grid_words = words};
    const double scale = step.emit.attached ? (double)emit_scale(&sim, 1.0f) : 1.0;
    const uint32_t count = samples_of(emit, words, (double)how->reach * taking.frame.scale / scale);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t stream = random_mix(seed + i * 0x9e3779b9u);
        const struct emit_state born = emit_particle(&sim, stream, i, time_s, 1.0f, -1.0f);
        if (!take(splats, &taking, born.position, born.velocity, error))
            return false;
    }
    return true;
}
