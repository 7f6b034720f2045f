/* This file warns of systems whose look.light is much more than what the flame itself shows: then
 * the light is a guess that stands for something else, and changes of the flame change it by as
 * much. The light that is shed counts a quarter of each billboard's square
 * (draw/light/firelight.c), whatever its atlas. Most built-in atlases fill less of it. */
#include "scene/light_notes.h"

#include <stdio.h>
#include <string.h>

#include "option/reader.h"

/* Light over this many times what a flame shows has a warning. */
static const float MOST_TIMES = 100.0f;

/* What is shed with look.light 1 beside what cells show over a whole life, of a flame of one
 * temperature. tests/unit/test_light_notes.c measures it. */
static const struct {
    const char *atlas;
    float times;
} KNOWN[] = {
    {"builtin:fire", 2.0f},   {"builtin:flame", 7.4f}, {"builtin:tongue", 13.3f},
    {"builtin:spark", 3.3f},  {"builtin:star", 6.1f},  {"builtin:smoke", 0.9f},
    {"builtin:puff", 9.9f},   {"builtin:drop", 1.0f},  {"builtin:splash", 1.0f},
    {"builtin:debris", 1.0f},
};

float kiln_light_times(const char *atlas)
{
    for (size_t i = 0; i < sizeof KNOWN / sizeof *KNOWN; i++) {
        if (strcmp(KNOWN[i].atlas, atlas) == 0)
            return KNOWN[i].times;
    }
    return 1.0f;
}

/* Returns how many times as much light as its particles show a system sheds at most. */
static float times_of(const struct kiln_scene *scene, const struct kiln_look *look)
{
    const float light = 0.2126f * kiln_scene_value_max(scene, &look->light.x) +
                        0.7152f * kiln_scene_value_max(scene, &look->light.y) +
                        0.0722f * kiln_scene_value_max(scene, &look->light.z);
    float times = 0.0f;
    if (!kiln_look_has_texture(look))
        return light;
    for (uint32_t i = 0; i < look->atlas_count; i++)
        times += kiln_light_times(look->atlas[i]) / (float)look->atlas_count;
    return light * times;
}

void kiln_light_notes_warn(struct kiln_reader *reader, const struct kiln_node *root)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_system *system = &scene->systems[i];
        const float times = times_of(scene, &system->look);
        char path[80];
        if (!system->enabled || times <= MOST_TIMES)
            continue;
        snprintf(path, sizeof path, "systems.%s.look.light", system->name);
        kiln_reader_warn_at(reader, root, path,
                            "sheds about %.0f times as much light as the particles show; a flame "
                            "that is to light that much is brighter, larger or denser",
                            (double)times);
    }
}
