/* Fuzzes the loader of scenes. For any input it must return a scene or an error, and never crash. A
 * scene that loads is printed, and the printed text must load to the same scene. If this fails, a
 * mistake in a scene file crashes kiln, or the scene in a manifest is not the scene that was
 * rendered. Lines "#set key=value" at the start of an input are overrides of keys of the scene. */

#include <stdlib.h>
#include <string.h>

#include "fuzz.h"
#include "kiln.h"
#include "scene/load.h"
#include "scene/work.h"

enum { MAX_OVERRIDES = 8 };

/* Prints the scene, loads the printed text, and checks that both scenes have the same hash. */
static void check_round_trip(const struct kiln_scene *scene)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    require(out && kiln_scene_print(scene, out), "cannot print a scene");
    fclose(out);
    struct kiln_error error = {0};
    struct kiln_scene *again =
        kiln_scene_parse_with(text, size, "printed.yaml", NULL, NULL, &error);
    require(again, error.message);
    struct kiln_scene_info info = kiln_scene_facts(scene), info_again = kiln_scene_facts(again);
    require(strcmp(info.hash, info_again.hash) == 0, "a printed scene differs");
    kiln_scene_destroy(&again);
    free(text);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    if (!text)
        return 0;
    if (size)
        memcpy(text, data, size);
    text[size] = '\0';

    char *overrides[MAX_OVERRIDES];
    struct kiln_scene_params params = kiln_scene_defaults();
    char *rest = text;
    while (strncmp(rest, "#set ", 5) == 0 && params.override_count < MAX_OVERRIDES) {
        char *end = strchr(rest, '\n');
        if (!end)
            break;
        overrides[params.override_count++] = strndup(rest + 5, (size_t)(end - rest - 5));
        rest = end + 1;
    }
    params.overrides = (const char *const *)overrides;
    struct kiln_error error = {0};
    struct kiln_scene *scene = kiln_scene_parse_with(rest, size - (size_t)(rest - text),
                                                     "fuzz.yaml", &params, NULL, &error);
    fuzz_taken = scene != NULL;
    if (scene)
        check_round_trip(scene);
    else
        require(error.code != KILN_OK && *error.message, "an error without a message");
    kiln_scene_destroy(&scene);
    for (size_t i = 0; i < params.override_count; i++)
        free(overrides[i]);
    free(text);
    return 0;
}
