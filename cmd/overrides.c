/* Turns options such as --set and --size into overrides of the scene loader. */
#include "overrides.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "report.h"
#include "signals.h"

/* Returns the override "key=value" that a use of an option stands for, in new memory; NULL when
 * memory is short. *is_override is false for an option that is no override. */
static char *override_text(const struct option_use *use, bool *is_override)
{
    const char *key = use->option->scene_key;
    char *text = NULL;
    *is_override = true;
    int length;
    if (key && use->option->kind == OPTION_SIZE)
        length =
            asprintf(&text, "%s=[%" PRIu64 ", %" PRIu64 "]", key, use->integer[0], use->integer[1]);
    else if (key)
        length = asprintf(&text, "%s=%s", key, use->text);
    else if (strcmp(use->option->name, "set") == 0)
        length = asprintf(&text, "%s", use->text);
    else
        *is_override = false, length = 0;
    return length < 0 ? NULL : text;
}

bool overrides_create(struct overrides *overrides, const struct arguments *arguments)
{
    *overrides = (struct overrides){.texts = calloc(arguments->use_count + 1, sizeof(char *))};
    if (!overrides->texts || !value_list_create(&overrides->params_files, arguments, "params")) {
        overrides_free(overrides);
        return false;
    }
    for (size_t i = 0; i < arguments->use_count; i++) {
        bool is_override;
        char *text = override_text(&arguments->uses[i], &is_override);
        if (!is_override)
            continue;
        if (!text) {
            overrides_free(overrides);
            return false;
        }
        overrides->texts[overrides->count++] = text;
    }
    return true;
}

void overrides_free(struct overrides *overrides)
{
    for (size_t i = 0; i < overrides->count; i++)
        free(overrides->texts[i]);
    free(overrides->texts);
    value_list_free(&overrides->params_files);
    *overrides = (struct overrides){0};
}

/* Returns whether a use of an option changes a key of the scene. */
static bool changes(const struct option_use *use, const char *key)
{
    const size_t length = strlen(key);
    if (use->option->scene_key)
        return strcmp(use->option->scene_key, key) == 0;
    return strcmp(use->option->name, "set") == 0 && strncmp(use->text, key, length) == 0 &&
           use->text[length] == '=';
}

void overrides_print_length(const struct arguments *arguments, const char *before, const char *path,
                            const struct kiln_scene_info *info)
{
    bool rate = false, frames = false;
    for (size_t i = 0; i < arguments->use_count; i++) {
        rate = rate || changes(&arguments->uses[i], "output.fps");
        frames = frames || changes(&arguments->uses[i], "output.frames");
    }
    if (!rate || frames)
        return;
    const double rate_hz = (double)info->fps_num / (double)info->fps_den;
    printf("%s", before);
    print_name(path);
    printf(": %" PRIu32 " frame%s at %.6g a second last %.4g s\n", info->frames,
           info->frames == 1 ? "" : "s", rate_hz, (double)info->frames / rate_hz);
}

struct kiln_scene_params overrides_scene_params(const struct overrides *overrides,
                                                const struct arguments *arguments)
{
    const struct option_use *root = arguments_last(arguments, "asset-root");
    struct kiln_scene_params params = kiln_scene_defaults();
    params.asset_root = root ? root->text : NULL;
    params.overrides = (const char *const *)overrides->texts;
    params.override_count = overrides->count;
    params.params_files = overrides->params_files.items;
    params.params_file_count = overrides->params_files.count;
    params.stop = signals_wants_stop;
    params.budget = arguments->budget;
    params.log = report_log();
    return params;
}
