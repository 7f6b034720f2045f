/* Expands the axes of a figure into panels. An axis is a list of settings, and a panel takes one
 * setting of each axis. */
#include "figure/sweep.h"

#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/ranges.h"
#include "base/text.h"

/* One value of an axis: the overrides or the moment that it sets, and its label. */
struct setting {
    const char **overrides;
    size_t override_count;
    enum kiln_sweep_moment moment;
    double when;
    const char *label;
};

struct axis {
    struct setting *settings;
    size_t count;
    bool variants; /* an axis of --variant options, which grows with each of them */
    const char *key;
};

struct expansion {
    struct kiln_arena *arena;
    const struct kiln_figure_params *params;
    struct axis axes[KILN_MAX_AXES];
    size_t axis_count;
    struct kiln_error *error;
};

static bool no_memory(const struct expansion *e)
{
    return kiln_error_no_memory(e->error, "the panels of a figure");
}

static struct axis *add_axis(struct expansion *e, size_t count)
{
    if (e->axis_count == KILN_MAX_AXES) {
        kiln_error_set(e->error, KILN_USAGE, "more than %d axes; no more are allowed",
                       (int)KILN_MAX_AXES);
        return NULL;
    }
    struct axis *axis = &e->axes[e->axis_count];
    axis->count = count;
    axis->settings = kiln_arena_alloc(e->arena, count, sizeof *axis->settings);
    if (!axis->settings) {
        no_memory(e);
        return NULL;
    }
    e->axis_count++;
    return axis;
}

/* ---- Texts ---------------------------------------------------------------------------------- */

/* Returns the length of a value up to a separator outside of brackets and quotes. */
static size_t value_length(const char *text, char separator)
{
    int depth = 0;
    char quote = 0;
    const char *c = text;
    for (; *c && (*c != separator || depth > 0 || quote); c++) {
        if (quote && *c == quote)
            quote = '\0';
        else if (quote)
            continue;
        else if (*c == '"' || *c == '\'')
            quote = *c;
        else if (*c == '[' || *c == '{')
            depth++;
        else if (*c == ']' || *c == '}')
            depth--;
    }
    return (size_t)(c - text);
}

static size_t count_values(const char *text, char separator)
{
    size_t count = 1;
    for (text += value_length(text, separator); *text; text += value_length(text, separator)) {
        text++;
        count++;
    }
    return count;
}

/* Returns the key's last word, which is enough for a reader; its last two words if the last is
 * "kind" or "enabled", which says too little. */
static const char *tail_of(const char *key, size_t length)
{
    size_t start = length;
    while (start > 0 && key[start - 1] != '.')
        start--;
    bool says_little = (length - start == 4 && strncmp(key + start, "kind", 4) == 0) ||
                       (length - start == 7 && strncmp(key + start, "enabled", 7) == 0);
    if (says_little && start > 1)
        for (start--; start > 0 && key[start - 1] != '.';)
            start--;
    return key + start;
}

static const char *label_of(struct expansion *e, const char *key, size_t key_length,
                            const char *value, size_t value_size)
{
    const char *tail = tail_of(key, key_length);
    return kiln_arena_format(e->arena, "%.*s = %.*s", (int)(key + key_length - tail), tail,
                             (int)value_size, value);
}

/* ---- Axes ----------------------------------------------------------------------------------- */

static bool read_moment(struct expansion *e, const char *sweep, const char *value, size_t length,
                        struct setting *setting)
{
    char text[40] = "";
    bool time = setting->moment == KILN_MOMENT_TIME;
    size_t digits = length;
    if (time && digits > 1 && value[digits - 1] == 's')
        for (digits--; digits > 0 && value[digits - 1] == ' ';)
            digits--;
    if (digits < sizeof text)
        memcpy(text, value, digits);
    bool ok = kiln_text_to_double(text, &setting->when) && setting->when >= 0 &&
              setting->when < 1e9 && (time || setting->when == floor(setting->when));
    if (!ok)
        return kiln_error_set(e->error, KILN_USAGE, "--sweep %s: found '%.*s'; expected %s", sweep,
                              (int)(length < 64 ? length : 64), value,
                              time ? "seconds, such as 1.5" : "the number of a frame");
    setting->label = time ? kiln_arena_format(e->arena, "%s s", text)
                          : kiln_arena_format(e->arena, "frame %s", text);
    return setting->label || no_memory(e);
}

static bool add_override(struct expansion *e, struct setting *setting, const char *key,
                         size_t key_length, const char *value, size_t length, bool labelled)
{
    const char **grown =
        kiln_arena_alloc(e->arena, setting->override_count + 1, sizeof *setting->overrides);
    if (!grown)
        return no_memory(e);
    if (setting->override_count)
        memcpy(grown, setting->overrides, setting->override_count * sizeof *grown);
    setting->overrides = grown;
    const char *text =
        kiln_arena_format(e->arena, "%.*s=%.*s", (int)key_length, key, (int)length, value);
    setting->overrides[setting->override_count++] = text;
    if (!text)
        return no_memory(e);
    if (!labelled)
        return true;
    const char *label = label_of(e, key, key_length, value, length);
    setting->label = label && setting->label
                         ? kiln_arena_format(e->arena, "%s, %s", setting->label, label)
                         : label;
    return setting->label || no_memory(e);
}

/* Returns where the values of "key=..." start, and finds the length of the key. */
static const char *values_of(struct expansion *e, const char *option, const char *text,
                             size_t *key_length)
{
    const char *equals = strchr(text, '=');
    if (equals && equals > text && equals[1]) {
        *key_length = (size_t)(equals - text);
        return equals + 1;
    }
    kiln_error_set(e->error, KILN_USAGE, "--%s: found '%s'; expected KEY=VALUE,VALUE,...", option,
                   text);
    return NULL;
}

static bool add_sweep(struct expansion *e, const char *text)
{
    size_t key_length;
    const char *value = values_of(e, "sweep", text, &key_length);
    struct axis *axis = value ? add_axis(e, count_values(value, ',')) : NULL;
    if (!axis)
        return false;
    axis->key = text;
    bool frame = key_length == 5 && strncmp(text, "frame", 5) == 0;
    bool time = key_length == 4 && strncmp(text, "time", 4) == 0;
    for (size_t i = 0; i < axis->count; i++) {
        struct setting *setting = &axis->settings[i];
        size_t length = value_length(value, ',');
        setting->moment = frame ? KILN_MOMENT_FRAME : time ? KILN_MOMENT_TIME : KILN_MOMENT_NONE;
        bool ok = frame || time ? read_moment(e, text, value, length, setting)
                                : add_override(e, setting, text, key_length, value, length, true);
        if (!ok)
            return false;
        value += length + 1;
    }
    return true;
}

static bool add_coupled(struct expansion *e, const char *text)
{
    size_t key_length;
    const char *value = values_of(e, "with", text, &key_length);
    struct axis *axis = e->axis_count > 0 ? &e->axes[e->axis_count - 1] : NULL;
    if (!value)
        return false;
    if (!axis || !axis->key)
        return kiln_error_set(e->error, KILN_USAGE, "--with %s: there is no --sweep before it",
                              text);
    size_t count = count_values(value, ',');
    if (count != axis->count)
        return kiln_error_set(
            e->error, KILN_USAGE,
            "--with %s: found %zu values; expected as many as --sweep %s before it has, %zu", text,
            count, axis->key, axis->count);
    for (size_t i = 0; i < count; i++) {
        size_t length = value_length(value, ',');
        if (!add_override(e, &axis->settings[i], text, key_length, value, length, false))
            return false;
        value += length + 1;
    }
    return true;
}

static bool add_variant(struct expansion *e, const char *text)
{
    struct axis *axis = e->axis_count > 0 ? &e->axes[e->axis_count - 1] : NULL;
    if (!axis || !axis->variants) {
        axis = add_axis(e, KILN_MAX_PANELS);
        if (!axis)
            return false;
        axis->count = 0;
        axis->variants = true;
    }
    if (axis->count == KILN_MAX_PANELS)
        return kiln_error_set(e->error, KILN_USAGE, "more than %d panels; no more are allowed",
                              (int)KILN_MAX_PANELS);
    struct setting *setting = &axis->settings[axis->count++];
    for (const char *piece = text;; piece++) {
        size_t length = value_length(piece, ';');
        const char *equals = memchr(piece, '=', length);
        if (!equals || equals == piece || equals + 1 == piece + length)
            return kiln_error_set(e->error, KILN_USAGE,
                                  "--variant: found '%s'; expected KEY=VALUE;KEY=VALUE...", text);
        if (!add_override(e, setting, piece, (size_t)(equals - piece), equals + 1,
                          (size_t)(piece + length - equals - 1), true))
            return false;
        piece += length;
        if (!*piece)
            return true;
    }
}

static bool add_scenes(struct expansion *e)
{
    if (e->params->input_count < 2)
        return true;
    struct axis *axis = add_axis(e, e->params->input_count);
    for (size_t i = 0; axis && i < axis->count; i++) {
        const char *path = e->params->inputs[i], *slash = strrchr(path, '/');
        const char *name = slash ? slash + 1 : path, *dot = strrchr(name, '.');
        axis->settings[i].label = kiln_arena_text(
            e->arena, name, dot && dot > name ? (size_t)(dot - name) : strlen(name));
        if (!axis->settings[i].label)
            return no_memory(e);
    }
    return axis != NULL;
}

/* Adds the frames of the request as an axis. A single frame gets no label. */
static bool add_frames(struct expansion *e)
{
    const struct kiln_figure_params *params = e->params;
    const uint64_t count = kiln_ranges_count(params->ranges, params->range_count);
    if (count == 0)
        return true;
    for (size_t i = 0; i < e->axis_count; i++) {
        if (e->axes[i].count > 0 && e->axes[i].settings[0].moment != KILN_MOMENT_NONE)
            return kiln_error_set(
                e->error, KILN_USAGE,
                "--frames: not allowed with --sweep %s, which chooses frames itself",
                e->axes[i].key);
    }
    if (count > KILN_MAX_PANELS)
        return kiln_error_set(e->error, KILN_USAGE,
                              "found %llu frames; a figure has up to %d panels",
                              (unsigned long long)count, (int)KILN_MAX_PANELS);
    struct axis *axis = add_axis(e, (size_t)count);
    if (!axis)
        return false;
    struct setting *setting = axis->settings;
    for (size_t i = 0; i < params->range_count; i++) {
        for (uint64_t f = params->ranges[i].first; f <= params->ranges[i].last; f++, setting++) {
            setting->moment = KILN_MOMENT_FRAME;
            setting->when = (double)f;
            setting->label =
                count > 1 ? kiln_arena_format(e->arena, "frame %llu", (unsigned long long)f) : NULL;
        }
    }
    return true;
}

/* ---- The product of the axes ---------------------------------------------------------------- */

static bool fill_choice(struct expansion *e, size_t number, struct kiln_choice *choice)
{
    size_t indices[KILN_MAX_AXES], capacity = 0;
    for (size_t i = e->axis_count; i-- > 0;) {
        indices[i] = number % e->axes[i].count;
        number /= e->axes[i].count;
        capacity += e->axes[i].settings[indices[i]].override_count;
    }
    choice->overrides = kiln_arena_alloc(e->arena, capacity + 1, sizeof *choice->overrides);
    choice->label = "";
    if (!choice->overrides)
        return no_memory(e);
    for (size_t i = 0; i < e->axis_count; i++) {
        const struct setting *setting = &e->axes[i].settings[indices[i]];
        if (i == 0 && e->params->input_count > 1)
            choice->scene = indices[i];
        for (size_t k = 0; k < setting->override_count; k++)
            choice->overrides[choice->override_count++] = setting->overrides[k];
        if (setting->moment != KILN_MOMENT_NONE) {
            choice->moment = setting->moment;
            choice->when = setting->when;
        }
        if (setting->label)
            choice->label = kiln_arena_format(e->arena, "%s%s%s", choice->label,
                                              *choice->label ? ", " : "", setting->label);
        if (!choice->label)
            return no_memory(e);
    }
    return true;
}

static bool add_sweeps(struct expansion *e)
{
    for (size_t i = 0; i < e->params->sweep_count; i++) {
        const struct kiln_figure_sweep *sweep = &e->params->sweeps[i];
        bool ok = sweep->kind == KILN_SWEEP_KEY        ? add_sweep(e, sweep->text)
                  : sweep->kind == KILN_SWEEP_TOGETHER ? add_coupled(e, sweep->text)
                                                       : add_variant(e, sweep->text);
        if (!ok)
            return false;
    }
    return true;
}

bool kiln_choices_make(struct kiln_arena *arena, const struct kiln_figure_params *params,
                       struct kiln_choices *choices, struct kiln_error *error)
{
    struct expansion e = {.arena = arena, .params = params, .error = error};
    *choices = (struct kiln_choices){.count = 1, .last_axis = 1};
    if (!add_scenes(&e) || !add_sweeps(&e) || !add_frames(&e))
        return false;
    for (size_t i = 0; i < e.axis_count; i++) {
        size_t count = e.axes[i].count;
        if (choices->count > KILN_MAX_PANELS / count)
            return kiln_error_set(error, KILN_USAGE,
                                  "the sweeps make more than %d panels; no more are allowed",
                                  (int)KILN_MAX_PANELS);
        choices->count *= count;
        choices->axis_count += count > 1;
        choices->last_axis = count > 1 ? count : choices->last_axis;
    }
    choices->items = kiln_arena_alloc(arena, choices->count, sizeof *choices->items);
    if (!choices->items)
        return no_memory(&e);
    for (size_t i = 0; i < choices->count; i++) {
        if (!fill_choice(&e, i, &choices->items[i]))
            return false;
    }
    return true;
}
