/* This file reads the materials of OBJ files. MTL describes surfaces by Phong's model, so roughness
 * and metalness are those of the common extension for physically based materials (Pr, Pm), or else
 * follow from the exponent of the highlight: a lobe of exponent Ns is about as wide as one of
 * roughness (2 / (Ns + 2))^(1/4) in the metallic-roughness model, where the square of roughness is
 * the width of Beckmann's distribution (Walter et al. 2007, 5.2). Without a highlight, roughness
 * is 1.
 *
 * MTL does not say what its colours are. They are taken as sRGB, as three.js does. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "looks.h"

/* The struct holds what was read of the material at hand. */
struct entry {
    float diffuse[3], specular[3], emission[3];
    float exponent, opacity, transparency, roughness, metalness; /* NaN: it does not say */
    bool has_diffuse, has_specular, has_emission, is_matt;
    struct kiln_material_map maps[KILN_MATERIAL_USES];
    char paths[KILN_MATERIAL_USES][KILN_TEXTURE_PATH_SIZE + 1]; /* of their textures */
    size_t lengths[KILN_MATERIAL_USES];                         /* of the paths; 0: no texture */
};

struct reading {
    struct decode_model *model;
    const struct decode_word *names;
    uint32_t *order; /* of the names, for bsearch */
    bool *is_found;
    uint32_t number; /* of the material at hand in the result; KILN_MAX_MATERIALS: it is not used */
    struct entry entry;
};

/* ---- names ----------------------------------------------------------------------------------- */

static int compare_words(const struct decode_word *a, const struct decode_word *b)
{
    if (a->length != b->length)
        return a->length < b->length ? -1 : 1;
    return a->length > 0 ? memcmp(a->start, b->start, a->length) : 0;
}

/* Finds the material of a name, or returns KILN_MAX_MATERIALS. */
static uint32_t find_name(const struct reading *r, const struct decode_word *name)
{
    uint32_t low = 0, high = r->model->looks->material_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        const int order = compare_words(name, &r->names[r->order[middle]]);
        if (order == 0)
            return r->order[middle];
        if (order < 0)
            high = middle;
        else
            low = middle + 1;
    }
    return KILN_MAX_MATERIALS;
}

/* Sorts the numbers of names. Insertion serves, since there are at most a thousand. */
static void sort_names(struct reading *r)
{
    for (uint32_t i = 0; i < r->model->looks->material_count; i++) {
        uint32_t at = i;
        for (; at > 0 && compare_words(&r->names[i], &r->names[r->order[at - 1]]) < 0; at--)
            r->order[at] = r->order[at - 1];
        r->order[at] = i;
    }
}

/* ---- numbers --------------------------------------------------------------------------------- */

static bool read_float(struct decode_line *line, float *out)
{
    struct decode_word word;
    float value = 0;
    if (!decode_line_word(line, &word) || !decode_word_float(&word, &value) || !isfinite(value))
        return false;
    *out = value;
    return true;
}

/* Reads a colour; one number is a grey. Colours as spectra or as XYZ, which nobody writes, are
 * ignored. */
static bool read_color(struct decode_line *line, float out[3])
{
    float color[3];
    if (!read_float(line, &color[0]))
        return false;
    if (!read_float(line, &color[1]))
        color[1] = color[2] = color[0];
    else if (!read_float(line, &color[2]))
        return false;
    memcpy(out, color, sizeof color);
    return true;
}

/* ---- textures -------------------------------------------------------------------------------- */

/* Returns whether a line has another word. */
static bool has_word(struct decode_line line)
{
    struct decode_word word;
    return decode_line_word(&line, &word);
}

/* Reads up to three numbers, of which the first two count, but never the last word of the line:
 * that is the file. */
static void read_pair(struct decode_line *line, float pair[2])
{
    for (int i = 0; i < 3; i++) {
        struct decode_line next = *line;
        float value = 0;
        if (!read_float(&next, &value) || !has_word(next))
            return;
        if (i < 2)
            pair[i] = decode_clamp(value, -KILN_MAX_MATERIAL_NUMBER, KILN_MAX_MATERIAL_NUMBER);
        *line = next;
    }
}

static uint32_t channel_of(const struct decode_word *word)
{
    static const struct {
        const char *name;
        enum kiln_texture_channel channel;
    } channels[] = {{"r", KILN_TEXEL_RED},
                    {"g", KILN_TEXEL_GREEN},
                    {"b", KILN_TEXEL_BLUE},
                    {"m", KILN_TEXEL_ALPHA},
                    {"l", KILN_TEXEL_LUMINANCE}};
    for (size_t i = 0; i < sizeof channels / sizeof *channels; i++) {
        if (decode_word_is_like(word, channels[i].name))
            return channels[i].channel;
    }
    return KILN_TEXEL_RED;
}

/* Reads what stands behind the name of an option. False: there is no such option. */
static bool read_option(const struct decode_word *option, struct decode_line *line,
                        struct kiln_material_map *map)
{
    static const struct {
        const char *name;
        int arguments; /* that mean nothing to kiln */
    } others[] = {{"-blendu", 1}, {"-blendv", 1}, {"-boost", 1}, {"-cc", 1},
                  {"-texres", 1}, {"-type", 1},   {"-mm", 2}};
    struct decode_word word;
    float pair[2] = {0, 0};
    if (decode_word_is_like(option, "-o")) {
        read_pair(line, pair);
        map->rows[0][2] = pair[0];
        map->rows[1][2] = pair[1];
    } else if (decode_word_is_like(option, "-s")) {
        pair[0] = pair[1] = 1;
        read_pair(line, pair);
        map->rows[0][0] = pair[0];
        map->rows[1][1] = pair[1];
    } else if (decode_word_is_like(option, "-t")) {
        read_pair(line, pair); /* turbulence */
    } else if (decode_word_is_like(option, "-bm")) {
        if (read_float(line, &map->strength))
            map->strength =
                decode_clamp(map->strength, -KILN_MAX_MATERIAL_NUMBER, KILN_MAX_MATERIAL_NUMBER);
    } else if (decode_word_is_like(option, "-clamp")) {
        if (decode_line_word(line, &word) && decode_word_is_like(&word, "on"))
            map->wrap[0] = map->wrap[1] = KILN_WRAP_CLAMP;
    } else if (decode_word_is_like(option, "-imfchan")) {
        if (decode_line_word(line, &word))
            map->channel = channel_of(&word);
    } else {
        for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
            if (!decode_word_is_like(option, others[i].name))
                continue;
            for (int k = 0; k < others[i].arguments; k++)
                (void)decode_line_word(line, &word);
            return true;
        }
        return false;
    }
    return true;
}

/* Takes the rest of a line as the path of a file, which may have blanks in it, stand in quotes, and
 * have backslashes between its parts. Returns its length; 0: there is none, or it is too long. */
static size_t take_path(struct decode_line *line, char path[KILN_TEXTURE_PATH_SIZE + 1])
{
    struct decode_word rest = decode_line_rest(line);
    if (rest.length >= 2 && rest.start[0] == '"' && rest.start[rest.length - 1] == '"') {
        rest.start++;
        rest.length -= 2;
    }
    if (rest.length > KILN_TEXTURE_PATH_SIZE)
        rest.length = KILN_TEXTURE_PATH_SIZE; /* decode_add_file refuses one of this length */
    for (size_t i = 0; i < rest.length; i++)
        path[i] = (char)(rest.start[i] == '\\' ? '/' : rest.start[i]);
    return rest.length;
}

static void read_map(struct reading *r, enum kiln_material_use use, struct decode_line *line)
{
    struct kiln_material_map map = kiln_material_default().maps[use];
    for (;;) {
        struct decode_line next = *line;
        struct decode_word word;
        if (!decode_line_word(&next, &word))
            return;
        if (word.start[0] != '-' || !read_option(&word, &next, &map))
            break;
        *line = next;
    }
    const size_t length = take_path(line, r->entry.paths[use]);
    if (length == 0)
        return;
    r->entry.lengths[use] = length;
    r->entry.maps[use] = map;
}

/* ---- materials ------------------------------------------------------------------------------- */

static void begin_entry(struct reading *r)
{
    r->entry = (struct entry){
        .exponent = NAN, .opacity = NAN, .transparency = NAN, .roughness = NAN, .metalness = NAN};
    memcpy(r->entry.maps, kiln_material_default().maps, sizeof r->entry.maps);
}

static bool has_map(const struct kiln_material *material, enum kiln_material_use use)
{
    return material->maps[use].texture != KILN_NO_TEXTURE;
}

static float roughness_of(const struct entry *entry, const struct kiln_material *out)
{
    const float *s = entry->specular;
    if (!isnan(entry->roughness))
        return decode_clamp(entry->roughness, 0, 1);
    if (has_map(out, KILN_USE_ROUGHNESS) || isnan(entry->exponent) || entry->is_matt ||
        (entry->has_specular && s[0] == 0 && s[1] == 0 && s[2] == 0))
        return 1;
    const float exponent = decode_clamp(entry->exponent, 0, 1e6f);
    return sqrtf(sqrtf(2.0f / (exponent + 2.0f)));
}

/* Gives the material at hand its textures. Those of an earlier one with its name are not needed any
 * more. */
static void put_textures(const struct reading *r, struct kiln_material *out)
{
    struct kiln_looks_result *looks = r->model->looks;
    memcpy(out->maps, r->entry.maps, sizeof out->maps);
    if (looks->texture_count > KILN_MAX_TEXTURES - KILN_MATERIAL_USES)
        decode_drop_textures(looks);
    for (int i = 0; i < KILN_MATERIAL_USES; i++) {
        if (r->entry.lengths[i] > 0)
            out->maps[i].texture =
                decode_add_file(r->model, r->entry.paths[i], r->entry.lengths[i]);
    }
}

/* Stores the material at hand. A texture of a number that the file does not give multiplies 1. */
static void put_entry(struct reading *r)
{
    if (r->number == KILN_MAX_MATERIALS)
        return;
    const struct entry *entry = &r->entry;
    struct kiln_material *out = &r->model->looks->materials[r->number];
    put_textures(r, out);
    const bool glows = has_map(out, KILN_USE_EMISSION) && !entry->has_emission;
    for (int c = 0; c < 3; c++) {
        out->color[c] =
            entry->has_diffuse ? kiln_light_of_srgb(decode_clamp(entry->diffuse[c], 0, 1)) : 1;
        out->emission[c] = glows ? 1 : kiln_light_of_srgb(decode_clamp(entry->emission[c], 0, 100));
    }
    if (!isnan(entry->opacity))
        out->alpha = decode_clamp(entry->opacity, 0, 1);
    else
        out->alpha = isnan(entry->transparency) ? 1 : decode_clamp(1 - entry->transparency, 0, 1);
    out->alpha_mode =
        out->alpha < 1 || has_map(out, KILN_USE_ALPHA) ? KILN_ALPHA_BLEND : KILN_ALPHA_OPAQUE;
    out->roughness = roughness_of(entry, out);
    out->metalness = !isnan(entry->metalness)           ? decode_clamp(entry->metalness, 0, 1)
                     : has_map(out, KILN_USE_METALNESS) ? 1
                                                        : 0;
    r->is_found[r->number] = true;
}

static void begin_material(struct reading *r, struct decode_line *line)
{
    const struct decode_word name = decode_line_rest(line);
    put_entry(r);
    begin_entry(r);
    r->number = find_name(r, &name);
}

/* Reads the values that a line of a material gives. */
static void read_value(struct reading *r, const struct decode_word *key, struct decode_line *line)
{
    struct entry *entry = &r->entry;
    const struct {
        const char *key;
        float *number, *color;
        bool *has;
    } values[] = {
        {"kd", NULL, entry->diffuse, &entry->has_diffuse},
        {"ks", NULL, entry->specular, &entry->has_specular},
        {"ke", NULL, entry->emission, &entry->has_emission},
        {"ns", &entry->exponent, NULL, NULL},
        {"d", &entry->opacity, NULL, NULL},
        {"tr", &entry->transparency, NULL, NULL},
        {"pr", &entry->roughness, NULL, NULL},
        {"pm", &entry->metalness, NULL, NULL},
    };
    float model = 0;
    if (decode_word_is_like(key, "illum") && read_float(line, &model))
        entry->is_matt = model == 0 || model == 1; /* a model of light without a highlight */
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        if (!decode_word_is_like(key, values[i].key))
            continue;
        if (values[i].number)
            (void)read_float(line, values[i].number);
        else
            *values[i].has = read_color(line, values[i].color) || *values[i].has;
    }
}

static void read_line(struct reading *r, struct decode_line *line)
{
    static const struct {
        const char *key;
        enum kiln_material_use use;
    } maps[] = {{"map_kd", KILN_USE_COLOR},     {"map_d", KILN_USE_ALPHA},
                {"norm", KILN_USE_NORMAL},      {"map_norm", KILN_USE_NORMAL},
                {"bump", KILN_USE_HEIGHT},      {"map_bump", KILN_USE_HEIGHT},
                {"map_pr", KILN_USE_ROUGHNESS}, {"map_pm", KILN_USE_METALNESS},
                {"map_ke", KILN_USE_EMISSION}};
    struct decode_word key;
    if (!decode_line_word(line, &key))
        return;
    if (decode_word_is_like(&key, "newmtl")) {
        begin_material(r, line);
        return;
    }
    if (r->number == KILN_MAX_MATERIALS)
        return;
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++) {
        if (decode_word_is_like(&key, maps[i].key)) {
            read_map(r, maps[i].use, line);
            return;
        }
    }
    read_value(r, &key, line);
}

void decode_mtl(struct decode_model *model, const void *bytes, size_t size,
                const struct decode_word *names, bool *is_found)
{
    uint32_t order[KILN_MAX_MATERIALS];
    struct reading r = {.model = model,
                        .names = names,
                        .order = order,
                        .is_found = is_found,
                        .number = KILN_MAX_MATERIALS};
    const char *encoding = decode_wide_encoding(bytes, size);
    if (encoding) {
        decode_note(model->notes,
                    "a file of materials is text in %s, and is not read; allowed are ASCII and "
                    "UTF-8",
                    encoding);
        return;
    }
    struct decode_text text = decode_text_begin(bytes, size);
    struct decode_line line;
    text.joins_lines = true;
    sort_names(&r);
    while (decode_text_line(&text, &line))
        read_line(&r, &line);
    put_entry(&r);
}
