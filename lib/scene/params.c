/* This file keeps the parameters of a scene as texts, and lists them. */
#include "scene/params.h"

#include <string.h>

#include "base/sized.h"
#include "option/params.h"

const char *kiln_param_kind_name(enum kiln_param_kind kind)
{
    return (unsigned)kind < KILN_PARAM_KINDS ? kiln_params_kind_name(kind) : "";
}

/* Moves a text that was built into the scene's arena. NULL when memory is short. */
static const char *keep(struct kiln_reader *reader, struct kiln_text *text)
{
    const char *copy =
        text->failed ? NULL
                     : kiln_arena_text(reader->arena, text->data ? text->data : "", text->length);
    kiln_text_free(text);
    if (!copy)
        kiln_reader_out_of_memory(reader);
    return copy;
}

static const char *keep_value(struct kiln_reader *reader, const struct kiln_param *param,
                              const struct kiln_node *value)
{
    struct kiln_text text = {0};
    if (kiln_params_write_json(reader, param, value, &text))
        return keep(reader, &text);
    kiln_text_free(&text);
    return NULL;
}

static const char *keep_schema(struct kiln_reader *reader, const struct kiln_param *param)
{
    struct kiln_text text = {0};
    param->row.type->schema(&param->row, &text);
    return keep(reader, &text);
}

static bool keep_words(struct kiln_reader *reader, const struct kiln_param *param,
                       struct kiln_scene_param *kept)
{
    const char *const *choices = param->row.choices;
    while (choices && choices[kept->word_count])
        kept->word_count++;
    const char **words = kiln_arena_alloc(reader->arena, kept->word_count + 1, sizeof *words);
    if (!words)
        return kiln_reader_out_of_memory(reader);
    for (size_t i = 0; i < kept->word_count; i++) {
        if (!kiln_reader_copy_text(reader, choices[i], &words[i]))
            return false;
    }
    kept->words = words;
    return true;
}

/* Returns a limit in the unit that a parameter is shown in. */
static double shown_limit(const struct kiln_param *param, double limit)
{
    return kiln_unit_is_required(param->row.dimension) ? limit * (180 / KILN_PI) : limit;
}

static bool keep_param(struct kiln_reader *reader, const struct kiln_param *param,
                       struct kiln_scene_param *kept)
{
    char place[KILN_PATH_SIZE];
    kiln_node_place(param->entry->key, place, sizeof place);
    const enum kiln_dimension dimension = param->row.dimension;
    *kept = kiln_scene_param_empty();
    kept->kind = param->kind;
    kept->has_min = param->has_min;
    kept->has_max = param->has_max;
    kept->min = shown_limit(param, param->row.min);
    kept->max = shown_limit(param, param->row.max);
    kept->unit = dimension == KILN_ANGLE           ? "deg"
                 : dimension == KILN_ANGULAR_SPEED ? "deg/s"
                                                   : kiln_unit_name(dimension);
    kept->value = keep_value(reader, param, param->value);
    kept->fallback = kept->value ? keep_value(reader, param, param->fallback) : NULL;
    kept->schema = kept->fallback ? keep_schema(reader, param) : NULL;
    return kept->schema && keep_words(reader, param, kept) &&
           kiln_reader_copy_text(reader, place, &kept->place) &&
           kiln_reader_copy_text(reader, param->name, &kept->name) &&
           kiln_reader_copy_text(reader, param->help, &kept->help);
}

bool kiln_scene_keep_params(struct kiln_reader *reader)
{
    struct kiln_scene *scene = kiln_reader_scene(reader);
    const struct kiln_params *params = reader->params;
    struct kiln_scene_param *kept =
        kiln_arena_alloc(reader->arena, params->count + 1, sizeof *kept);
    if (!kept)
        return kiln_reader_out_of_memory(reader);
    kiln_reader_leave(reader, 0);
    for (uint32_t i = 0; i < params->count; i++) {
        if (!keep_param(reader, &params->list[i], &kept[i]))
            return false;
    }
    scene->params = kept;
    scene->param_count = params->count;
    return true;
}

size_t kiln_scene_list_params(const struct kiln_scene *scene, struct kiln_scene_param *params,
                              size_t stride, size_t capacity)
{
    for (size_t i = 0; i < scene->param_count && i < capacity; i++)
        kiln_sized_give((char *)params + i * stride, &scene->params[i]);
    return scene->param_count;
}
