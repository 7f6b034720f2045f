/* Counts the work of a scene, and refuses a scene over its budget. */
#include "scene/work.h"

#include <string.h>

#include "base/budget.h"
#include "base/sized.h"
#include "base/thread.h"
#include "scene/gas_shape.h"
#include "scene/instant.h"

/* The program takes this without a scene: for its code, libraries and small things. */
enum { PROGRAM_BYTES = 38 << 20 };

/* Reading takes this for a node of the scene's text, most of it in libfyaml. The allocator keeps
 * it. */
enum { NODE_BYTES = 500 };

/* ---- counts ---------------------------------------------------------------------------------- */

uint64_t kiln_work_steps(const struct kiln_scene *scene)
{
    return kiln_scene_last_step(scene, scene->frames - 1);
}

uint64_t kiln_work_particles(const struct kiln_scene *scene)
{
    uint64_t particles = 0;
    for (uint32_t i = 0; i < scene->system_count; i++)
        particles += scene->systems[i].capacity;
    return particles;
}

/* Sums up the slots of the enabled systems whose look is of a kind. */
static uint64_t count_slots(const struct kiln_scene *scene,
                            bool (*is_counted)(const struct kiln_look *look))
{
    uint64_t slots = 0;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_system *system = &scene->systems[i];
        slots += system->enabled && is_counted(&system->look) ? system->capacity : 0;
    }
    return slots;
}

static bool is_mesh(const struct kiln_look *look)
{
    return look->shape == KILN_SHAPE_MESH;
}

static bool is_sprite(const struct kiln_look *look)
{
    return !kiln_look_is_opaque(look);
}

uint64_t kiln_scene_solid_slots(const struct kiln_scene *scene)
{
    return count_slots(scene, kiln_look_is_opaque);
}

uint64_t kiln_scene_mesh_slots(const struct kiln_scene *scene)
{
    return count_slots(scene, is_mesh);
}

uint64_t kiln_scene_sprite_slots(const struct kiln_scene *scene)
{
    uint64_t slots = count_slots(scene, is_sprite);
    for (uint32_t i = 0; i < scene->system_count; i++) { /* a sprite for each part of a segment */
        const struct kiln_system *system = &scene->systems[i];
        if (system->enabled && system->look.shape == KILN_SHAPE_RIBBON)
            slots += (uint64_t)system->capacity * (system->look.ribbon.smooth - 1);
    }
    return slots;
}

/* ---- facts ----------------------------------------------------------------------------------- */

struct kiln_scene_info kiln_scene_facts(const struct kiln_scene *scene)
{
    struct kiln_scene_info info = {
        .size = sizeof info,
        .width = scene->width,
        .height = scene->height,
        .frames = scene->frames,
        .fps_num = scene->fps.num,
        .fps_den = scene->fps.den,
        .steps_per_frame = scene->steps_per_frame,
        .warmup_steps = scene->warmup_steps,
        .system_count = scene->system_count,
    };
    info.particle_capacity = kiln_work_particles(scene);
    info.steps = kiln_work_steps(scene);
    info.memory_bytes = scene->memory_bytes;
    memcpy(info.hash, scene->hash, sizeof info.hash);
    return info;
}

void kiln_scene_get_info(const struct kiln_scene *scene, struct kiln_scene_info *info)
{
    const struct kiln_scene_info facts = kiln_scene_facts(scene);
    kiln_sized_give(info, &facts);
}

/* ---- limits ---------------------------------------------------------------------------------- */

/* Returns the system with the most particles, which errors point at. */
static const struct kiln_system *largest_system(const struct kiln_scene *scene)
{
    const struct kiln_system *largest = &scene->systems[0];
    for (uint32_t i = 1; i < scene->system_count; i++) {
        if (scene->systems[i].capacity > largest->capacity)
            largest = &scene->systems[i];
    }
    return largest;
}

/* Returns the key that a user would change for a part to take less memory; NULL: that of the
 * particles. */
static const char *key_of(enum kiln_footprint_part part)
{
    static const char *const keys[KILN_FOOTPRINT_PARTS] = {
        [KILN_FOOTPRINT_PICTURE] = "output.size",      [KILN_FOOTPRINT_TEXTURES] = "systems",
        [KILN_FOOTPRINT_OBJECTS] = "backdrop.objects", [KILN_FOOTPRINT_LIGHTS] = "backdrop.lights",
        [KILN_FOOTPRINT_BACKDROP] = "backdrop",        [KILN_FOOTPRINT_GAS] = "gas",
    };
    return keys[part];
}

static uint64_t count_nodes(const struct kiln_node *node)
{
    uint64_t count = node->key ? 2 : 1;
    for (const struct kiln_node *child = node->first; child; child = child->next)
        count += count_nodes(child);
    return count;
}

bool kiln_work_check(struct kiln_reader *reader, const struct kiln_node *root,
                     kiln_scene_estimate *estimate)
{
    struct kiln_scene *scene = kiln_reader_scene(reader);
    struct kiln_footprint footprint = {.threads = kiln_threads_available()};
    /* More were parsed than the tree has, where a file lies over what it includes. */
    const struct kiln_node_counts *counts = reader->counts;
    const uint64_t read = counts ? (uint64_t)counts->parsed + counts->copied : 0;
    const uint64_t left = count_nodes(root), nodes = read > left ? read : left;
    kiln_footprint_add(&footprint, KILN_FOOTPRINT_PARTICLES, nodes, NODE_BYTES);
    for (uint32_t i = 0; i < scene->node_count; i++)
        kiln_footprint_add(&footprint, KILN_FOOTPRINT_PARTICLES, 1,
                           kiln_path_bytes(&scene->nodes[i].position.path));
    if (estimate)
        estimate(scene, &footprint);
    scene->memory_bytes = PROGRAM_BYTES + kiln_footprint_total(&footprint);
    char emit[128] = "systems";
    if (scene->system_count > 0)
        snprintf(emit, sizeof emit, "systems.%s.emit", largest_system(scene)->name);
    const char *largest = key_of(kiln_footprint_largest(&footprint));
    const struct {
        enum kiln_limit limit;
        uint64_t amount;
        const char *path; /* the key that a user would change */
    } rows[] = {
        {KILN_LIMIT_pixels, (uint64_t)scene->width * scene->height, "output.size"},
        {KILN_LIMIT_frames, scene->frames, "output.frames"},
        {KILN_LIMIT_steps, kiln_work_steps(scene), "output.frames"},
        {KILN_LIMIT_particles, kiln_work_particles(scene), emit},
        {KILN_LIMIT_gas_cells, kiln_gas_cells(scene), "gas"},
        {KILN_LIMIT_gas_steps, kiln_gas_cell_steps(scene, kiln_work_steps(scene)), "gas"},
        {KILN_LIMIT_memory, scene->memory_bytes, largest ? largest : emit},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[160];
        if (kiln_budget_allows(scene->budget, rows[i].limit, rows[i].amount, text))
            continue;
        kiln_reader_error_at(reader, root, rows[i].path, "%s", text);
        reader->error->code = KILN_OVER_LIMIT;
        return false;
    }
    return true;
}
