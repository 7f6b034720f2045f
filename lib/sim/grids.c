#include "sim/grids.h"

#include <string.h>

#include "asset/grid_in.h"
#include "base/error.h"
#include "shared/exact.h"

uint32_t kiln_sim_grids_find(const struct kiln_sim_grids *grids, const char *file)
{
    uint32_t i = 0;
    while (i < grids->count && strcmp(grids->files[i], file) != 0)
        i++;
    return i;
}

static bool list_files(struct kiln_sim_grids *grids, const struct kiln_scene *scene,
                       struct kiln_error *error)
{
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_system *system = &scene->systems[i];
        for (uint32_t k = 0; k < system->force_count; k++) {
            const char *file = system->forces[k].file;
            if (system->forces[k].kind != KILN_FORCE_FIELD ||
                kiln_sim_grids_find(grids, file) < grids->count)
                continue;
            if (grids->count == KILN_MAX_GRIDS)
                return kiln_error_set(error, KILN_INVALID_INPUT,
                                      "%s: systems.%s.forces.%u: more than %d files of wind",
                                      scene->name, system->name, k, KILN_MAX_GRIDS);
            grids->files[grids->count++] = file;
        }
    }
    return true;
}

static float4 canon4(const float v[3])
{
    return FLOAT4(exact_canon(v[0]), exact_canon(v[1]), exact_canon(v[2]), 0.0f);
}

static struct kiln_grid place_grid(const struct kiln_grid_file *file, size_t first)
{
    const float per_metre[3] = {1.0f / file->spacing[0], 1.0f / file->spacing[1],
                                1.0f / file->spacing[2]};
    return (struct kiln_grid){.origin = canon4(file->origin),
                              .per_metre = canon4(per_metre),
                              .size = {file->size[0], file->size[1], file->size[2], (uint)first}};
}

static size_t count_words(const struct kiln_grid_file *file)
{
    return (size_t)file->size[0] * file->size[1] * file->size[2];
}

/* One after the other into the buffer. */
static bool fill(struct kiln_sim_grids *grids, struct kiln_device *device,
                 struct kiln_grid_file *const *files, struct kiln_error *error)
{
    size_t total = 0;
    for (uint32_t i = 0; i < grids->count; i++) {
        grids->table[i] = place_grid(files[i], total);
        total += count_words(files[i]);
    }
    if (total > KILN_MAX_GRID_SAMPLES)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "%zu samples in all files of wind; a scene has at most %d", total,
                              KILN_MAX_GRID_SAMPLES);
    kiln_buffer_init(&grids->words, device, total * sizeof(float4), "grids");
    float4 *words = kiln_buffer_host(&grids->words, KILN_OVERWRITE, error);
    if (!words)
        return false;
    for (uint32_t i = 0; i < grids->count; i++) {
        const size_t count = count_words(files[i]);
        for (size_t k = 0; k < count; k++)
            *words++ = canon4(files[i]->samples[k]);
    }
    return true;
}

bool kiln_sim_grids_init(struct kiln_sim_grids *grids, struct kiln_device *device,
                         const struct kiln_scene *scene, struct kiln_error *error)
{
    *grids = (struct kiln_sim_grids){.count = 0};
    kiln_buffer_init(&grids->words, device, 0, "grids");
    if (!list_files(grids, scene, error))
        return false;
    struct kiln_grid_file *files[KILN_MAX_GRIDS] = {NULL};
    bool ok = true;
    for (uint32_t i = 0; ok && i < grids->count; i++)
        ok = (files[i] = kiln_grid_load(grids->files[i], error)) != NULL;
    ok = ok && (grids->count == 0 || fill(grids, device, files, error));
    for (uint32_t i = 0; i < KILN_MAX_GRIDS; i++)
        kiln_grid_destroy(&files[i]);
    return ok;
}

void kiln_sim_grids_finish(struct kiln_sim_grids *grids)
{
    kiln_buffer_finish(&grids->words);
    *grids = (struct kiln_sim_grids){.count = 0};
}
