/* This file finds the channels of a layer in an OpenEXR file. A channel's name is "LAYER.R", in the
 * beauty and in parts that are named like the layer "R" alone. */
#include <string.h>
#include <strings.h>

#include "base/error.h"
#include "exr.h"

/* Meanings of the last word of a channel's name. */
enum word {
    WORD_R,
    WORD_G,
    WORD_B,
    WORD_A,
    WORD_Y,
    WORD_RY,
    WORD_BY,
    WORD_X,
    WORD_Z,
    WORD_U,
    WORD_V,
    WORD_W,
    WORD_COUNT,
};

struct words {
    const char *channels[WORD_COUNT]; /* names of the channels that end in each word, or NULL */
};

static int find_word(const char *text)
{
    static const struct {
        const char *text;
        enum word word;
    } words[] = {{"R", WORD_R},   {"G", WORD_G},     {"B", WORD_B},    {"A", WORD_A},
                 {"Y", WORD_Y},   {"RY", WORD_RY},   {"BY", WORD_BY},  {"X", WORD_X},
                 {"Z", WORD_Z},   {"U", WORD_U},     {"V", WORD_V},    {"W", WORD_W},
                 {"red", WORD_R}, {"green", WORD_G}, {"blue", WORD_B}, {"alpha", WORD_A}};
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

static struct words find_words(const exr_attr_chlist_t *list, const char *prefix)
{
    struct words words = {{NULL}};
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

static void take(struct exr_layer *layer, const struct words *words, enum word first,
                 enum word second, enum word third)
{
    layer->names[EXR_RED] = words->channels[first];
    layer->names[EXR_GREEN] = words->channels[second];
    layer->names[EXR_BLUE] = words->channels[third];
}

/* Chooses the channels of a layer from those with one prefix. A vector is X, Y and Z, or U, V and
 * W, of which the last may be missing. vectors: the layer may hold other things than light. */
static bool choose(const struct words *words, bool vectors, struct exr_layer *layer)
{
    const char *const *has = words->channels;
    const bool chroma = has[WORD_RY] || has[WORD_BY];
    *layer = (struct exr_layer){.sampling = 1};
    if (has[WORD_G] || has[WORD_B]) {
        take(layer, words, WORD_R, WORD_G, WORD_B);
        layer->is_color = true;
    } else if (has[WORD_R]) {
        layer->names[EXR_RED] = has[WORD_R];
    } else if (has[WORD_Y] && has[WORD_RY] && has[WORD_BY]) {
        layer->names[EXR_RED] = has[WORD_Y];
        layer->names[EXR_RY] = has[WORD_RY];
        layer->names[EXR_BY] = has[WORD_BY];
        layer->is_color = true;
    } else if (vectors && has[WORD_X] && has[WORD_Y]) {
        take(layer, words, WORD_X, WORD_Y, WORD_Z);
    } else if (vectors && has[WORD_U] && has[WORD_V]) {
        take(layer, words, WORD_U, WORD_V, WORD_W);
    } else if (has[WORD_Y] && !chroma) {
        layer->names[EXR_RED] = has[WORD_Y];
    } else if (vectors && has[WORD_Z]) {
        layer->names[EXR_RED] = has[WORD_Z];
    } else {
        return false;
    }
    layer->names[EXR_ALPHA] = has[WORD_A];
    layer->grey = !layer->names[EXR_GREEN] && !layer->names[EXR_BLUE] && !layer->names[EXR_RY];
    return true;
}

static bool choose_one(const char *channel, struct exr_layer *layer)
{
    *layer = (struct exr_layer){.names = {channel}, .sampling = 1, .grey = true};
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
    struct words words = find_words(list, beauty ? "" : wanted);
    if (choose(&words, !beauty, layer) && *wanted)
        return true;
    words = find_words(list, "");
    const char *depth = words.channels[WORD_X] ? NULL : words.channels[WORD_Z];
    if (strcmp(wanted, "depth") == 0 && choose_one(depth, layer))
        return true;
    if (*part && strcmp(part, wanted) == 0 && choose(&words, !beauty, layer))
        return true;
    const char *rest = *part ? after(wanted, part) : NULL;
    words = find_words(list, rest ? rest : "");
    if (rest && *rest && choose(&words, true, layer))
        return true;
    return choose_one(find_channel(list, wanted), layer) ||
           choose_one(find_channel(list, rest), layer);
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
            reading->layer.is_color = reading->layer.is_color && !is_data(wanted);
            return check_sampling(reading, list);
        }
    }
    if (code != EXR_ERR_SUCCESS)
        return decode_exr_fail(reading, code);
    char found[256] = "none";
    list_channels(reading, parts, found, sizeof found);
    return kiln_error_set(reading->picture->error, KILN_INVALID_INPUT,
                          "no layer '%s'; the file has the channels %s", wanted, found);
}
