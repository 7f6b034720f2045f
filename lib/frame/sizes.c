/* This file refuses scenes that are too large for a technique. The techniques that kiln has for
 * comparison with papers keep the limits that all scenes had in 0.2. */
#include "frame/sizes.h"

#include <inttypes.h>

#include "base/error.h"
#include "scene/ribbon.h"
#include "scene/work.h"

/* The most that a scene may have for a technique of papers/. */
enum {
    PAPER_SYSTEMS = 16,
    PAPER_FORCES = 16,
    PAPER_OBJECTS = 32,
    PAPER_MESHES = 8,
    PAPER_LIGHTS = 16,
};

static uint32_t most_forces(const struct kiln_scene *scene)
{
    uint32_t most = 0;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const uint32_t count = scene->systems[i].force_count;
        most = count > most ? count : most;
    }
    return most;
}

/* Counts the keys that shaders of drawing evaluate, in a scene of more keys than a uniform block
 * holds (draw/moment/moment_gl.c). */
static uint32_t count_life_keys(const struct kiln_scene *scene)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->system_count && kiln_scene_stores_keys(scene); i++) {
        const struct kiln_range *life = &scene->systems[i].emit.life;
        count += kiln_value_room(scene->keys, &life->min);
        count += kiln_range_is_one_value(life) ? 0 : kiln_value_room(scene->keys, &life->max);
    }
    return count;
}

static uint32_t count_meshes(const struct kiln_scene *scene)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++)
        count += kiln_object_is_mesh(&scene->backdrop.objects[i]);
    return count;
}

/* Refuses ribbons for a sort whose order lags behind: the parts of a ribbon would be blended in any
 * order. */
static bool check_ribbons(const struct kiln_scene *scene, const struct kiln_techniques *techniques,
                          struct kiln_error *error)
{
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_system *system = &scene->systems[i];
        if (techniques->sort == KILN_SORT_SPREAD && system->enabled &&
            system->look.shape == KILN_SHAPE_RIBBON)
            return kiln_error_set(
                error, KILN_USAGE,
                "systems.%s.look.shape: ribbon: a sort that is spread over frames "
                "takes no ribbons: use sort=radix",
                system->name);
    }
    return true;
}

/* Checks what the whole device must take, whichever of its techniques run. */
static bool check_device(const struct kiln_scene *scene, const struct kiln_techniques *techniques,
                         struct kiln_error *error)
{
    const bool on_host =
        techniques->simulate == KILN_SIMULATE_CPU && techniques->sort == KILN_SORT_CPU &&
        techniques->backdrop == KILN_BACKDROP_CPU && techniques->raster == KILN_RASTER_CPU;
    const struct {
        const char *noun;
        uint64_t found;
        int most;
    } rows[] = {
        {"particles at once", kiln_work_particles(scene), KILN_MAX_GL_PARTICLES},
        {"parts of ribbons and other particles at once",
         kiln_work_particles(scene) * (uint64_t)kiln_ribbon_most_parts(scene),
         KILN_MAX_GL_PARTICLES},
        {"keys of lives", count_life_keys(scene), KILN_BLOCK_KEYS},
    };
    for (size_t i = 0; !on_host && i < sizeof rows / sizeof *rows; i++) {
        if (rows[i].found > (uint64_t)rows[i].most)
            return kiln_error_set(error, KILN_USAGE,
                                  "systems: found up to %" PRIu64 " %s; OpenGL takes at most %d: "
                                  "use the device %s",
                                  rows[i].found, rows[i].noun, rows[i].most, KILN_DEVICE_CPU);
    }
    return true;
}

bool kiln_sizes_check(const struct kiln_scene *scene, const struct kiln_techniques *techniques,
                      struct kiln_error *error)
{
    char paper[KILN_TECHNIQUE_SIZE];
    const char *instead;
    const struct {
        const char *path, *noun;
        uint32_t found, most;
    } rows[] = {
        {"systems", "systems", scene->system_count, PAPER_SYSTEMS},
        {"forces", "forces of a system", most_forces(scene), PAPER_FORCES},
        {"scene", "keys", scene->key_count, KILN_BLOCK_KEYS},
        {"backdrop.objects", "objects", scene->backdrop.object_count, PAPER_OBJECTS},
        {"backdrop.objects", "meshes", count_meshes(scene), PAPER_MESHES},
        {"backdrop.lights", "lights", scene->backdrop.light_count, PAPER_LIGHTS},
    };
    const bool found = kiln_techniques_paper(techniques, paper, &instead);
    for (size_t i = 0; found && i < sizeof rows / sizeof *rows; i++) {
        if (rows[i].found > rows[i].most)
            return kiln_error_set(
                error, KILN_USAGE, "%s: found %u %s; the technique %s takes at most %u: use %s",
                rows[i].path, rows[i].found, rows[i].noun, paper, rows[i].most, instead);
    }
    return check_ribbons(scene, techniques, error) && check_device(scene, techniques, error);
}
