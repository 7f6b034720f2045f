/* Estimates the work and the memory that a scene takes, and refuses a scene over its budget. The
 * expected memory is a sum of counts (pixels, cells, slots, triangles...) times measured sizes
 * (docs/measurements.md, "Memory of a clip"). */
#include "scene/work.h"

#include <string.h>

#include "asset/atlas/atlas.h"
#include "asset/loader/loader.h"
#include "base/budget.h"
#include "base/sized.h"
#include "scene/instant.h"
#include "shared/particle.h"

/* Bytes of the program, and bytes for one of each thing that a scene has many of. */
enum {
    PROGRAM_BYTES = 38 << 20,
    MESH_BYTES = 12746944, /* a mesh of the backdrop: its shadow map for the sun */
    PIXEL_BYTES = 68,
    HIT_BYTES = 20,   /* a pixel where the backdrop has meshes: what its samples hit */
    CACHE_BYTES = 80, /* a pixel of the cache of surfaces, which a camera that stands still has */
    SLOT_BYTES = 100,
    CELL_BYTES = 150000, /* a cell of an atlas, including what is needed while it is made */
    TRIANGLE_BYTES = 350,
    TEXEL_BYTES = 80,     /* a texel of paint */
    GROUND_BYTES = 330,   /* a sample of terrain, which has two triangles */
    SAMPLE_BYTES = 32,    /* a sample of a grid that moves particles */
    BACKDROP_BYTES = 15,  /* a pixel of a picture of floor or sky: half floats, with mip levels */
    ATLAS_BYTES = 6,      /* a pixel of an atlas's picture; pictures are loaded one at a time */
    LIGHT_BYTES = 147456, /* a light that casts shadows: its map of smoke */
    LIGHT_MAP_BYTES = 4928448,   /* its maps of meshes */
    LIGHT_SOLID_BYTES = 9856896, /* its maps of solid particles */
};

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

/* Returns whether an earlier system, or an earlier entry of this one, has the same cells. */
static bool is_shared(const struct kiln_scene *scene, uint32_t system, uint32_t texture)
{
    const struct kiln_look *look = &scene->systems[system].look;
    for (uint32_t i = 0; i <= system; i++) {
        const struct kiln_look *other = &scene->systems[i].look;
        const uint32_t count = i < system ? other->atlas_count : texture;
        for (uint32_t k = 0; k < count; k++) {
            if (other->columns == look->columns && other->rows == look->rows &&
                strcmp(other->atlas[k], look->atlas[texture]) == 0)
                return true;
        }
    }
    return false;
}

static uint64_t count_cells(const struct kiln_scene *scene)
{
    uint64_t cells = 0;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_look *look = &scene->systems[i].look;
        for (uint32_t k = 0; k < look->atlas_count; k++)
            cells += is_shared(scene, i, k) ? 0 : (uint64_t)look->columns * look->rows;
    }
    return cells;
}

/* Counts the triangles of all meshes, once for each object, since each has a tree of its own. */
static uint64_t count_triangles(const struct kiln_scene *scene)
{
    uint64_t triangles = 0;
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        const struct kiln_object *object = &scene->backdrop.objects[i];
        if (object->kind == KILN_OBJECT_MESH && object->shown)
            triangles += object->shown->triangle_count;
    }
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_look *look = &scene->systems[i].look;
        if (look->shape == KILN_SHAPE_MESH && look->mesh.shown)
            triangles += look->mesh.shown->triangle_count;
    }
    return triangles;
}

static uint64_t count_meshes(const struct kiln_scene *scene)
{
    uint64_t meshes = 0;
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++)
        meshes += kiln_object_is_mesh(&scene->backdrop.objects[i]);
    return meshes;
}

static uint64_t count_texels(const struct kiln_scene *scene)
{
    uint64_t texels = 0;
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        const struct kiln_object *object = &scene->backdrop.objects[i];
        if (object->kind == KILN_OBJECT_MESH && object->paint.enabled)
            texels += (uint64_t)object->paint.size * object->paint.size;
    }
    return texels;
}

static uint64_t count_ground(const struct kiln_scene *scene)
{
    uint64_t samples = 0;
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        const struct kiln_object *object = &scene->backdrop.objects[i];
        if (object->kind == KILN_OBJECT_TERRAIN)
            samples += (uint64_t)object->samples[0] * object->samples[1];
    }
    return samples;
}

/* Returns the pixels of a picture; 0 for a built-in picture or a video, whose size is not known
 * here. */
static uint64_t count_pixels(const struct kiln_scene *scene, const char *picture)
{
    uint32_t size[2];
    return picture && picture[0] == '/' && kiln_loader_knows_size(scene->loader, picture, size)
               ? (uint64_t)size[0] * size[1]
               : 0;
}

/* Returns the most pixels of a picture of an atlas; *system gets the name of its system. */
static uint64_t find_largest_atlas(const struct kiln_scene *scene, const char **system)
{
    uint64_t most = 0;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_look *look = &scene->systems[i].look;
        for (uint32_t k = 0; k < look->atlas_count; k++) {
            const uint64_t pixels = count_pixels(scene, look->atlas[k]);
            if (pixels > most)
                *system = scene->systems[i].name;
            most = pixels > most ? pixels : most;
        }
    }
    return most;
}

/* Lists the terms of memory and the key that decides each; NULL: the key of the particles. */
struct term {
    uint64_t bytes;
    const char *path;
    const char *system; /* system that the path is in, or NULL */
};

enum { TERMS = 10 };

/* Returns the bytes of a slot. A picture within a step takes the records before it and its own; the
 * shade of lamps takes a byte for each. */
static uint64_t slot_bytes(const struct kiln_scene *scene)
{
    return SLOT_BYTES + kiln_scene_shadow_lights(scene) +
           (kiln_scene_has_instants_between(scene) ? 2 * sizeof(struct kiln_particle) : 0);
}

static bool has_solids(const struct kiln_scene *scene)
{
    bool solids = false;
    for (uint32_t i = 0; i < scene->system_count; i++)
        solids |= scene->systems[i].enabled && kiln_look_is_opaque(&scene->systems[i].look);
    return solids;
}

/* Returns the bytes of a light that casts shadows. */
static uint64_t light_bytes(const struct kiln_scene *scene, bool meshes)
{
    return LIGHT_BYTES + (meshes ? (uint64_t)LIGHT_MAP_BYTES : 0) +
           (has_solids(scene) ? (uint64_t)LIGHT_SOLID_BYTES : 0);
}

/* Returns the bytes of a pixel of the picture. A glossy floor has its reflections in the cache, and
 * each lamp that casts shadows has a number. */
static uint64_t pixel_bytes(const struct kiln_scene *scene)
{
    const uint64_t bytes = PIXEL_BYTES + (count_meshes(scene) > 0 ? HIT_BYTES : 0);
    if (!kiln_scene_view_stands(scene) || scene->frames < 2)
        return bytes;
    const bool gloss = kiln_scene_value_max(scene, &scene->backdrop.floor_gloss) > 0.0f;
    const uint64_t lamps = sizeof(float) * kiln_scene_shadow_lights(scene);
    return bytes + (gloss ? 2 : 1) * (CACHE_BYTES + lamps);
}

static void list_terms(const struct kiln_scene *scene, struct term terms[TERMS])
{
    const uint64_t triangles = count_triangles(scene);
    const char *atlas_system = "";
    const uint64_t atlas_pixels = find_largest_atlas(scene, &atlas_system);
    const uint64_t backdrop_pixels = count_pixels(scene, scene->backdrop.floor_image) +
                                     count_pixels(scene, scene->backdrop.sky_image);
    const struct term all[TERMS] = {
        {pixel_bytes(scene) * scene->width * scene->height, "output.size", NULL},
        {slot_bytes(scene) * kiln_work_particles(scene), NULL, NULL},
        {CELL_BYTES * count_cells(scene), "systems", NULL},
        {TRIANGLE_BYTES * triangles + MESH_BYTES * count_meshes(scene), "backdrop.objects", NULL},
        {TEXEL_BYTES * count_texels(scene), "backdrop.objects", NULL},
        {GROUND_BYTES * count_ground(scene), "backdrop.objects", NULL},
        {SAMPLE_BYTES * scene->samples, "backdrop.objects", NULL},
        {BACKDROP_BYTES * backdrop_pixels, "backdrop", NULL},
        {ATLAS_BYTES * atlas_pixels, "look.atlas", atlas_system},
        {light_bytes(scene, triangles > 0) * kiln_scene_shadow_lights(scene), "backdrop.lights",
         NULL},
    };
    memcpy(terms, all, sizeof all);
}

uint64_t kiln_work_memory(const struct kiln_scene *scene)
{
    struct term terms[TERMS];
    uint64_t bytes = PROGRAM_BYTES;
    list_terms(scene, terms);
    for (size_t i = 0; i < TERMS; i++)
        bytes += terms[i].bytes;
    return bytes;
}

/* Returns the key that takes most memory; a system's key is written into `path`. */
static const char *find_largest(const struct kiln_scene *scene, const char *particles,
                                char path[128])
{
    struct term terms[TERMS];
    size_t largest = 0;
    list_terms(scene, terms);
    for (size_t i = 1; i < TERMS; i++)
        largest = terms[i].bytes > terms[largest].bytes ? i : largest;
    if (!terms[largest].system)
        return terms[largest].path ? terms[largest].path : particles;
    snprintf(path, 128, "systems.%s.%s", terms[largest].system, terms[largest].path);
    return path;
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
    info.memory_bytes = kiln_work_memory(scene);
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

bool kiln_work_check(struct kiln_reader *reader, const struct kiln_node *root)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    char emit[128] = "systems", largest[128];
    if (scene->system_count > 0)
        snprintf(emit, sizeof emit, "systems.%s.emit", largest_system(scene)->name);
    const struct {
        enum kiln_limit limit;
        uint64_t amount;
        const char *path; /* the key that a user would change */
    } rows[] = {
        {KILN_LIMIT_pixels, (uint64_t)scene->width * scene->height, "output.size"},
        {KILN_LIMIT_frames, scene->frames, "output.frames"},
        {KILN_LIMIT_steps, kiln_work_steps(scene), "output.frames"},
        {KILN_LIMIT_particles, kiln_work_particles(scene), emit},
        {KILN_LIMIT_memory, kiln_work_memory(scene), find_largest(scene, emit, largest)},
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
