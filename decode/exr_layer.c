/* This file finds the channels of a layer in an OpenEXR file. A channel's name is "LAYER.R", in the
 * beauty and in parts that are named like the layer "R" alone. */
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/error.h"
#include "exr.h"

static int find_word(const char *text)
{
    static const struct {
        const char *text;
        enum exr_word word;
    } words[] = {
        {"R", EXR_WORD_R},   {"G", EXR_WORD_G},     {"B", EXR_WORD_B},    {"A", EXR_WORD_A},
        {"Y", EXR_WORD_Y},   {"RY", EXR_WORD_RY},   {"BY", EXR_WORD_BY},  {"X", EXR_WORD_X},
        {"Z", EXR_WORD_Z},   {"U", EXR_WORD_U},     {"V", EXR_WORD_V},    {"W", EXR_WORD_W},
        {"red", EXR_WORD_R}, {"green", EXR_WORD_G}, {"blue", EXR_WORD_B}, {"alpha", EXR_WORD_A}};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        if (strcasecmp(text, words[i].text) == 0)
            return (int)words[i].word;
    }
    return -1;
}

/* Returns what follows "PREFIX." in a name, or NULL. An empty prefix has no dot. */
static const char *after(const char *name, const char *prefix)
{
    const size_t length = strlen(prefix);
    if (length == 0)
        return name;
    return strncmp(name, prefix, length) == 0 && name[length] == '.' ? name + length + 1 : NULL;
}

struct exr_words decode_exr_words(const exr_attr_chlist_t *list, const char *prefix)
{
    struct exr_words words = {{NULL}};
    for (int i = 0; i < list->num_channels; i++) {
        const char *name = list->entries[i].name.str;
        const char *last = after(name, prefix);
        const int word = last ? find_word(last) : -1;
        if (word >= 0 && !words.channels[word])
            words.channels[word] = name;
    }
    return words;
}

/* Returns whether a layer that has red, green and blue holds no light, by the last word of its
 * name. Other numbers are not converted between primaries. */
static bool is_data(const char *layer)
{
    static const char *const names[] = {"N",        "P",       "id",       "uv",
                                        "normal",   "normals", "position", "motion",
                                        "velocity", "vector",  "depth",    "mask"};
    const char *dot = strrchr(layer, '.');
    const char *last = dot ? dot + 1 : layer;
    bool found = strncasecmp(last, "crypto", 6) == 0;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        found = found || strcasecmp(last, names[i]) == 0;
    return found;
}

static void take(struct exr_layer *layer, const struct exr_words *words, enum exr_word first,
                 enum exr_word second, enum exr_word third)
{
    layer->names[EXR_RED] = words->channels[first];
    layer->names[EXR_GREEN] = words->channels[second];
    layer->names[EXR_BLUE] = words->channels[third];
}

bool decode_exr_choose(const struct exr_words *words, bool vectors, struct exr_layer *layer)
{
    const char *const *has = words->channels;
    const bool chroma = has[EXR_WORD_RY] || has[EXR_WORD_BY];
    *layer = (struct exr_layer){.sampling = 1};
    if (has[EXR_WORD_G] || has[EXR_WORD_B]) {
        take(layer, words, EXR_WORD_R, EXR_WORD_G, EXR_WORD_B);
        layer->is_color = true;
    } else if (has[EXR_WORD_R]) {
        layer->names[EXR_RED] = has[EXR_WORD_R];
    } else if (has[EXR_WORD_Y] && has[EXR_WORD_RY] && has[EXR_WORD_BY]) {
        layer->names[EXR_RED] = has[EXR_WORD_Y];
        layer->names[EXR_RY] = has[EXR_WORD_RY];
        layer->names[EXR_BY] = has[EXR_WORD_BY];
        layer->is_color = true;
    } else if (vectors && has[EXR_WORD_X] && has[EXR_WORD_Y]) {
        take(layer, words, EXR_WORD_X, EXR_WORD_Y, EXR_WORD_Z);
        layer->is_data = true;
    } else if (vectors && has[EXR_WORD_U] && has[EXR_WORD_V]) {
        take(layer, words, EXR_WORD_U, EXR_WORD_V, EXR_WORD_W);
        layer->is_data = true;
    } else if (has[EXR_WORD_Y] && !has[EXR_WORD_X] && !chroma) {
        layer->names[EXR_RED] = has[EXR_WORD_Y];
    } else if (vectors && has[EXR_WORD_Z]) {
        layer->names[EXR_RED] = has[EXR_WORD_Z];
        layer->is_data = true;
    } else {
        return false;
    }
    layer->names[EXR_ALPHA] = has[EXR_WORD_A];
    layer->grey = !layer->names[EXR_GREEN] && !layer->names[EXR_BLUE] && !layer->names[EXR_RY];
    return true;
}

bool decode_exr_choose_one(const char *channel, struct exr_layer *layer)
{
    *layer = (struct exr_layer){.names = {channel}, .sampling = 1, .grey = true, .is_data = true};
    return channel != NULL;
}

/* Returns the channel that has the name of the layer itself, or NULL. */
static const char *find_channel(const exr_attr_chlist_t *list, const char *name)
{
    for (int i = 0; name && i < list->num_channels; i++) {
        if (strcmp(list->entries[i].name.str, name) == 0)
            return list->entries[i].name.str;
    }
    return NULL;
}

/* Looks for a layer in one part. part: the part's name, or "". */
static bool find_channels(struct exr_layer *layer, const exr_attr_chlist_t *list, const char *part,
                          const char *wanted)
{
    const bool beauty = strcmp(wanted, "beauty") == 0;
    struct exr_words words = decode_exr_words(list, beauty ? "" : wanted);
    if (decode_exr_choose(&words, !beauty, layer) && *wanted)
        return true;
    words = decode_exr_words(list, "");
    const char *depth = words.channels[EXR_WORD_X] ? NULL : words.channels[EXR_WORD_Z];
    if (strcmp(wanted, "depth") == 0 && decode_exr_choose_one(depth, layer))
        return true;
    if (*part && strcmp(part, wanted) == 0 && decode_exr_choose(&words, !beauty, layer))
        return true;
    const char *rest = *part ? after(wanted, part) : NULL;
    words = decode_exr_words(list, rest ? rest : "");
    if (rest && *rest && decode_exr_choose(&words, true, layer))
        return true;
    words = decode_exr_words(list, wanted);
    if (beauty && decode_exr_choose(&words, true, layer))
        return true;
    return decode_exr_choose_one(find_channel(list, wanted), layer) ||
           decode_exr_choose_one(find_channel(list, rest), layer);
}

static const exr_attr_chlist_entry_t *entry_of(const exr_attr_chlist_t *list, const char *name)
{
    for (int i = 0; i < list->num_channels; i++) {
        if (list->entries[i].name.str == name)
            return &list->entries[i];
    }
    return NULL;
}

/* Only chroma may have less than a sample for each pixel: one for two by two pixels, for RY and BY
 * alike. */
static bool check_sampling(struct exr_reading *reading, const exr_attr_chlist_t *list)
{
    struct exr_layer *layer = &reading->layer;
    for (int role = 0; role < EXR_ROLES; role++) {
        const exr_attr_chlist_entry_t *entry = entry_of(list, layer->names[role]);
        if (!entry)
            continue;
        if (role == EXR_RY && entry->x_sampling == 2)
            layer->sampling = 2;
        const int allowed = role >= EXR_RY ? layer->sampling : 1;
        if (entry->x_sampling != allowed || entry->y_sampling != allowed)
            return kiln_error_set(reading->picture->error, KILN_INVALID_INPUT,
                                  "the channel '%s' has one sample for %d x %d pixels; kiln reads "
                                  "this only of RY and BY, with 2 x 2 pixels for both",
                                  layer->names[role], entry->x_sampling, entry->y_sampling);
    }
    return true;
}

/* Returns whether all channels of a layer are whole numbers. */
static bool is_whole(const struct exr_layer *layer, const exr_attr_chlist_t *list)
{
    bool whole = true;
    for (int role = 0; role < EXR_ROLES; role++) {
        const exr_attr_chlist_entry_t *entry = entry_of(list, layer->names[role]);
        whole = whole && (!entry || entry->pixel_type == EXR_PIXEL_UINT);
    }
    return whole;
}

bool decode_exr_describe(struct exr_reading *reading, const exr_attr_chlist_t *list)
{
    struct exr_layer *layer = &reading->layer;
    const bool whole = is_whole(layer, list);
    layer->is_data = layer->is_data || whole || is_data(reading->name);
    layer->is_color = layer->is_color && !is_data(reading->name);
    layer->is_whole = whole && reading->picture->layers;
    return check_sampling(reading, list);
}

/* Lists the channels of the file for an error: "R, G, B, fire.R, ..." */
static void list_channels(const struct exr_reading *reading, int parts, char *text, size_t size)
{
    size_t length = 0;
    for (int part = 0; part < parts; part++) {
        const exr_attr_chlist_t *list = NULL;
        const char *name = NULL;
        if (exr_get_channels(reading->file, part, &list) != EXR_ERR_SUCCESS)
            continue;
        if (parts == 1 || exr_get_name(reading->file, part, &name) != EXR_ERR_SUCCESS)
            name = NULL;
        for (int i = 0; i < list->num_channels && length + 1 < size; i++) {
            const int written =
                snprintf(text + length, size - length, "%s%s%s%s", length ? ", " : "",
                         name ? name : "", name ? "." : "", list->entries[i].name.str);
            length += written > 0 ? (size_t)written : 0;
        }
    }
}

bool decode_exr_find_layer(struct exr_reading *reading)
{
    int parts = 0;
    const char *wanted = reading->picture->layer;
    exr_result_t code = exr_get_count(reading->file, &parts);
    for (int part = 0; code == EXR_ERR_SUCCESS && part < parts; part++) {
        const exr_attr_chlist_t *list = NULL;
        const char *name = NULL;
        code = exr_get_channels(reading->file, part, &list);
        if (code != EXR_ERR_SUCCESS)
            break;
        if (exr_get_name(reading->file, part, &name) != EXR_ERR_SUCCESS || !name)
            name = "";
        reading->part = part;
        if (find_channels(&reading->layer, list, name, wanted)) {
            snprintf(reading->name, sizeof reading->name, "%s", wanted);
            return decode_exr_describe(reading, list);
        }
    }
    if (code != EXR_ERR_SUCCESS)
        return decode_exr_fail(reading, code);
    char found[256] = "none";
    list_channels(reading, parts, found, sizeof found);
    return kiln_error_set(reading->picture->error, KILN_INVALID_INPUT,
                          "no layer '%s'; the file has the channels %s", wanted, found);
}
