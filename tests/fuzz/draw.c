/* Fuzzes drawing with numbers at the ends of their ranges, on the device cpu. From any bytes the
 * target makes a scene, steps it and draws two small frames. If this fails, a scene that the loader
 * accepts crashes kiln, or, in a build with sanitizers, computes what C leaves undefined, such as
 * an integer of a float that no integer holds.
 *
 * An input that begins with "kiln: 1" is the text of a scene. Any other input chooses one: the
 * target walks through the option tables, and each byte decides whether a row is written and which
 * end of its range it gets. A new row thus takes part without a change here. Numbers that decide
 * how much there is to draw, such as rates, have limits of their own in `small`, and scenes that
 * still are large are not drawn. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "frame/loop.h"
#include "fuzz.h"
#include "scene/options.h"
#include "scene/parts.h"
#include "scene/work.h"

enum {
    FRAMES = 2,
    MOST_PARTICLES = 1500,
    MOST_DEPTH = 12, /* of members within members */
};

static const uint64_t MOST_MEMORY = 400 << 20;

/* ---- the choice of a scene ------------------------------------------------------------------- */

/* Holds the bytes that choose, and the scene's text so far. */
struct choice {
    const uint8_t *bytes;
    size_t size, at;
    struct kiln_text text;
};

/* Returns the next byte; 0, which chooses the defaults, when there are no more. */
static uint8_t take(struct choice *c)
{
    return c->at < c->size ? c->bytes[c->at++] : 0;
}

/* The greatest values of rows that decide how much there is to step and to draw. */
static const struct {
    const char *name;
    double most;
} small[] = {
    {"rate", 400}, {"count", 6},    {"cells", 12},  {"samples", 3}, {"resolution", 16},
    {"size", 64},  {"per_step", 8}, {"nozzles", 9}, {"rounds", 8},
};

/* Returns the largest value that is written for a row. Of the rows called `size`, only those of
 * whole numbers are counts. */
static double most_of(const struct kiln_option *row)
{
    const bool whole = row->type == &kiln_type_integer || row->type == &kiln_type_pair;
    if (row->name && row->type == &kiln_type_pair && strcmp(row->name, "cells") == 0)
        return 2; /* divides the pictures of the tree */
    for (size_t i = 0; row->name && i < sizeof small / sizeof *small; i++) {
        const bool is_rate = strcmp(small[i].name, "rate") == 0;
        if (strcmp(row->name, small[i].name) == 0 && (whole || is_rate))
            return fmax(row->min, fmin(row->max, small[i].most));
    }
    return row->max;
}

/* Returns a value of a row, most often an end of its range. */
static double value_of(struct choice *c, const struct kiln_option *row)
{
    const double low = row->min, high = most_of(row);
    switch (take(c) % 8) {
    case 0:
    case 1:
        return high;
    case 2:
    case 3:
        return low;
    case 4:
        return fmin(fmax(0, low), high);
    case 5:
        return fmin(fmax(1, low), high);
    case 6: /* near the lower end, or near 0 */
        return fmin(low > 0 ? low * 1.5 : 1e-6, high);
    default:
        return low > 0 ? sqrt(low * high) : 0.01 * high;
    }
}

static bool is_whole(const struct kiln_option *row)
{
    return row->type == &kiln_type_integer || row->type == &kiln_type_pair ||
           row->type == &kiln_type_bursts;
}

static void add_number(struct choice *c, const struct kiln_option *row, double value)
{
    char text[48];
    kiln_unit_print_double(text, row->dimension, is_whole(row) ? floor(value) : value);
    kiln_text_add(&c->text, "%s", text);
}

static void add_numbers(struct choice *c, const struct kiln_option *row, int count)
{
    kiln_text_add(&c->text, "[");
    for (int i = 0; i < count; i++) {
        kiln_text_add(&c->text, i ? ", " : "");
        add_number(c, row, value_of(c, row));
    }
    kiln_text_add(&c->text, "]");
}

/* Adds a number, or as many as a vector has. */
static void add_plain(struct choice *c, const struct kiln_option *row, int count)
{
    if (count == 1)
        add_number(c, row, value_of(c, row));
    else
        add_numbers(c, row, count);
}

/* Adds what multiplies a value, or what is added to it. */
static void add_part(struct choice *c, const struct kiln_option *row)
{
    static const char *const parts[] = {
        "", ", times: {random: [-1, 2]}, plus: 0", ", times: {noise: [0, 1000000], octaves: 8}",
        ", times: {keys: {0 s: -1000000, 0.04 s: 2}, repeat: mirror, ease: in}"};
    const char *part = parts[take(c) % 4];
    const bool is_random = strstr(part, "random") != NULL, is_noise = strstr(part, "noise") != NULL;
    if ((row->clocks & KILN_ALLOW_FORMS) && (!is_random || (row->clocks & KILN_ALLOW_RANDOM)) &&
        (!is_noise || (row->clocks & KILN_ALLOW_NOISE)) &&
        (!is_random || row->type == &kiln_type_value))
        kiln_text_add(&c->text, "%s", part);
}

/* Adds a value over one of the clocks that the row takes. */
static void add_clock(struct choice *c, const struct kiln_option *row, int count)
{
    static const struct {
        const char *begin, *middle, *end;
        unsigned clock;
    } clocks[] = {
        {"{age: {0 s: ", ", 0.05 s: ", "}, repeat: loop, ease: smooth", KILN_ALLOW_AGE},
        {"{speed: {0: ", ", 100000: ", "}, ease: out", KILN_ALLOW_SPEED},
        {"{height: {-1000000: ", ", 1000000: ", "}", KILN_ALLOW_HEIGHT},
        {"{distance: {0: ", ", 1000000: ", "}", KILN_ALLOW_DISTANCE},
        {"{random: {0: ", ", 0.5: ", "}", KILN_ALLOW_RANDOM},
        {"{choose: [", ", ", "]", KILN_ALLOW_RANDOM},
        {"{noise: [", ", ", "], period: 0.001 s, octaves: 8", KILN_ALLOW_OWN_NOISE},
    };
    const size_t i = take(c) % (sizeof clocks / sizeof *clocks);
    if (!(row->clocks & clocks[i].clock)) {
        add_plain(c, row, count);
        return;
    }
    kiln_text_add(&c->text, "%s", clocks[i].begin);
    add_plain(c, row, count);
    kiln_text_add(&c->text, "%s", clocks[i].middle);
    add_plain(c, row, count);
    kiln_text_add(&c->text, "%s", clocks[i].end);
    add_part(c, row);
    kiln_text_add(&c->text, "}");
}

/* Adds a value that may vary. */
static void add_animated(struct choice *c, const struct kiln_option *row, int count)
{
    const uint8_t how = take(c) % 8;
    if (how == 6 && (row->clocks & KILN_ALLOW_TIME)) {
        kiln_text_add(&c->text, "{keys: {0 s: ");
        add_plain(c, row, count);
        kiln_text_add(&c->text, ", 0.04 s: ");
        add_plain(c, row, count);
        kiln_text_add(&c->text, "}}");
    } else if (how == 7 && (row->clocks & KILN_ALLOW_LIFE)) {
        kiln_text_add(&c->text, "{life: [");
        add_plain(c, row, count);
        kiln_text_add(&c->text, ", ");
        add_plain(c, row, count);
        kiln_text_add(&c->text, "]}");
    } else if (how == 5 && row->clocks) {
        add_clock(c, row, count);
    } else {
        add_plain(c, row, count);
    }
}

static void add_range(struct choice *c, const struct kiln_option *row)
{
    const double a = value_of(c, row), b = value_of(c, row);
    kiln_text_add(&c->text, "[");
    add_number(c, row, fmin(a, b));
    kiln_text_add(&c->text, ", ");
    add_number(c, row, fmax(a, b));
    kiln_text_add(&c->text, "]");
}

static void add_bounds(struct choice *c, const struct kiln_option *row, bool attached)
{
    const double half = take(c) % 2 ? row->max : 0.5;
    char text[48];
    kiln_unit_print_double(text, KILN_PLAIN, half);
    kiln_text_add(&c->text, "{min: [-%s, -%s, -%s], max: [%s, %s, %s]%s}", text, text, text, text,
                  text, text, attached ? ", attach: a" : "");
}

/* Adds one of several texts. */
static void add_one(struct choice *c, const char *const *texts, size_t count)
{
    kiln_text_add(&c->text, "%s", texts[take(c) % count]);
}

static void add_choice(struct choice *c, const struct kiln_option *row)
{
    size_t count = 0;
    while (row->choices[count])
        count++;
    add_one(c, row->choices, count);
}

#define ADD_ONE(c, ...)                                                                            \
    add_one(c, (const char *const[]){__VA_ARGS__},                                                 \
            sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *))

/* Adds the value of a type that names something, or lists points; false: the type is another. */
static bool add_name(struct choice *c, const struct kiln_option *row)
{
    const struct kiln_option_type *type = row->type;
    if (type == &kiln_type_assets)
        ADD_ONE(c, "\"builtin:spark\"", "\"builtin:drop\"",
                "[\"builtin:star\", \"builtin:debris\"]", "\"scenes/textures/card.png\"");
    else if (type == &kiln_type_motion)
        ADD_ONE(c, "auto", "none");
    else if (type == &kiln_type_motion_scale)
        ADD_ONE(c, "auto", "10", "-10", "[10, -10]");
    else if (type == &kiln_type_picture)
        ADD_ONE(c, "none", "\"scenes/textures/card.png\"");
    else if (type == &kiln_type_gltf)
        /* with the rows that such a file needs, which are not written by themselves */
        ADD_ONE(c, "\"tests/gltf/nodes/nodes-growing.gltf\", node: Camera",
                "\"tests/gltf/nodes/nodes-uneven.gltf\", node: Tip, animation: {speed: -1000}",
                "\"tests/gltf/nodes/nodes-step.gltf\", node: 3, animation: {clip: 1, loop: false}");
    else if (type == &kiln_type_mesh)
        ADD_ONE(c, "\"scenes/meshes/cabin.obj\"", "\"scenes/meshes/slab.obj\"",
                "\"scenes/meshes/paper_plane.obj\"", "\"scenes/meshes/starling.obj\"");
    else if (type == &kiln_type_image)
        ADD_ONE(c, "\"scenes/textures/card.png\"", "\"scenes/textures/leaf_red.png\"");
    else if (type == &kiln_type_grid)
        ADD_ONE(c, "\"tests/support/whirl.grid\"");
    else if (type == &kiln_type_name || type == &kiln_type_system || type == &kiln_type_domain)
        ADD_ONE(c, "a", "b");
    else if (type == &kiln_type_forces)
        ADD_ONE(c, "[curl: 10000]", "[attract: {attach: a, strength: -100000}, drag: 1000]",
                "[wind: {field: grid, file: \"tests/support/whirl.grid\"}]");
    else if (type == &kiln_type_of)
        ADD_ONE(c, "[curl: 1]", "[vortex: {lift: 10000}, wind: {mode: add}, drag: 1000]",
                "[attract: {attach: a, strength: -100000}]",
                "[wind: {field: grid, file: \"tests/support/whirl.grid\"}]");
    else if (type == &kiln_type_counts)
        ADD_ONE(c, "1", "6", "[1, 6]");
    else if (type == &kiln_type_attach && strcmp(row->name, "parent") == 0)
        ADD_ONE(c, "none"); /* others would often be a ring */
    else if (type == &kiln_type_attach)
        ADD_ONE(c, "a", "none");
    else if (type == &kiln_type_points)
        ADD_ONE(c, "[[0, 0, 0], [1, 1, 0], [0, 1, 1]]",
                "[[-100000, 0, 0], [100000, 0, 0], [0, 100000, 0]]",
                "[[0, 0, 0], [0.00001, 0, 0], [0, 0, 0], [9, 9, 9]]");
    else if (type == &kiln_type_bursts)
        ADD_ONE(c, "{0 s: 9}", "{0 s: 1, 0.01 s: 30}",
                "[{at: 0 s, count: [0, 9], every: 0.01 s, most: 5, jitter: 0.01 s}]");
    else
        return false;
    return true;
}

static void add_value(struct choice *c, const struct kiln_option *row, int depth);

/* Returns whether a row is written. What a scene cannot do without is always written, and so are
 * the texture, since the default one takes long to make, and groups. */
static bool is_chosen(struct choice *c, const struct kiln_option *row, int depth)
{
    const bool needed = !row->fallback || row->type == &kiln_type_assets ||
                        row->type == &kiln_type_bursts ||
                        (row->type == &kiln_type_map && !row->is_hidden_if_empty) ||
                        row->type == &kiln_type_group || row->type == &kiln_type_image ||
                        row->type == &kiln_type_mesh || row->type == &kiln_type_gltf;
    if (row->is_unprinted || row->type == &kiln_type_text || row->type == &kiln_type_rational ||
        row->type == &kiln_type_clip || row->type == &kiln_type_object || depth > MOST_DEPTH)
        return !row->fallback;
    if (row->type == &kiln_type_part ||
        (row->parts == kiln_row_if_node_is_of_file && row->type != &kiln_type_gltf))
        return false;
    return needed || take(c) % 4 == 3;
}

static void add_members(struct choice *c, const struct kiln_option *members, int depth)
{
    const char *separator = "";
    kiln_text_add(&c->text, "{");
    for (const struct kiln_option *row = members; row->name; row++) {
        if (!is_chosen(c, row, depth))
            continue;
        kiln_text_add(&c->text, "%s%s: ", separator, row->name);
        add_value(c, row, depth + 1);
        separator = ", ";
    }
    kiln_text_add(&c->text, "}");
}

static void add_kind(struct choice *c, const struct kiln_option_kind *kinds, int depth)
{
    size_t count = 0;
    while (kinds[count].name)
        count++;
    const struct kiln_option_kind *kind = &kinds[take(c) % count];
    kiln_text_add(&c->text, "{%s: ", kind->name);
    const size_t begin = c->text.length;
    add_members(c, kind->members, depth);
    if (kind->variant && c->text.data && c->text.length > begin) {
        /* the last brace gives way to the row that names the variant */
        const bool empty = c->text.length == begin + 2;
        c->text.data[--c->text.length] = '\0';
        kiln_text_add(&c->text, "%sfield: %s}", empty ? "" : ", ", kind->variant);
    }
    kiln_text_add(&c->text, "}");
}

static void add_list(struct choice *c, const struct kiln_option *row, int depth)
{
    const size_t least = row->name && strcmp(row->name, "directions") == 0 ? 1 : 0;
    const size_t count = least + take(c) % 4u;
    kiln_text_add(&c->text, "[");
    for (size_t i = 0; i < count && i < row->max_count; i++) {
        kiln_text_add(&c->text, i ? ", " : "");
        add_value(c, row->item, depth + 1);
    }
    kiln_text_add(&c->text, "]");
}

static void add_map(struct choice *c, const struct kiln_option *row, int depth)
{
    const bool two = take(c) % 2;
    kiln_text_add(&c->text, "{a: ");
    add_members(c, row->members, depth);
    if (two) {
        kiln_text_add(&c->text, ", b: ");
        add_members(c, row->members, depth);
    }
    kiln_text_add(&c->text, "}");
}

/* Adds the value of a row that has members. */
static void add_nested(struct choice *c, const struct kiln_option *row, int depth)
{
    if (row->type == &kiln_type_map)
        add_map(c, row, depth);
    else if (row->type == &kiln_type_list)
        add_list(c, row, depth);
    else if (row->type == &kiln_type_kind)
        add_kind(c, row->kinds, depth);
    else
        add_members(c, row->members, depth); /* a group or a switch */
}

/* Adds a position of a node: a vector, or a path. */
static void add_place(struct choice *c, const struct kiln_option *row, int depth)
{
    if (take(c) % 2)
        add_members(c, row->members, depth);
    else
        add_animated(c, row, 3);
}

static void add_value(struct choice *c, const struct kiln_option *row, int depth)
{
    const struct kiln_option_type *type = row->type;
    if (row->special_word && take(c) % 4 == 3)
        kiln_text_add(&c->text, "%s", row->special_word);
    else if (type == &kiln_type_boolean)
        ADD_ONE(c, "true", "false");
    else if (type == &kiln_type_choice)
        add_choice(c, row);
    else if (type == &kiln_type_integer || type == &kiln_type_number)
        add_plain(c, row, 1);
    else if (type == &kiln_type_pair)
        add_numbers(c, row, 2);
    else if (type == &kiln_type_value)
        add_animated(c, row, 1);
    else if (type == &kiln_type_vector || type == &kiln_type_color)
        add_animated(c, row, 3);
    else if (type == &kiln_type_range && row->is_of_clip)
        ADD_ONE(c, "[0 s, 0.1 s]", "[-100000 s, 1000000 s]");
    else if (type == &kiln_type_range)
        add_range(c, row);
    else if (type == &kiln_type_place)
        add_place(c, row, depth);
    else if (type == &kiln_type_bounds || type == &kiln_type_demitter)
        add_bounds(c, row, type == &kiln_type_demitter && take(c) % 2);
    else if (!add_name(c, row))
        add_nested(c, row, depth);
}

/* ---- drawing --------------------------------------------------------------------------------- */

/* Keep pictures and clips small, whatever the scene says. The last one, which a lens needs, is not
 * for all scenes. */
static const char *const overrides[] = {
    "output.size=[32, 18]", "output.frames=2",         "output.fps=30",
    "simulation.rate=auto", "simulation.warmup=0.2 s", "output.samples=2",
};

/* Loads a scene, or returns NULL if its text is wrong. */
static struct kiln_scene *load(const struct kiln_text *text, bool samples)
{
    const size_t count = sizeof overrides / sizeof *overrides;
    const struct kiln_scene_params params = {.size = sizeof params,
                                             .asset_root = KILN_SOURCE_DIR,
                                             .overrides = overrides,
                                             .override_count = samples ? count : count - 1};
    struct kiln_error error = {0};
    if (text->failed || !text->data)
        return NULL;
    struct kiln_scene *scene =
        kiln_scene_parse(text->data, text->length, "draw.yaml", &params, &error);
    require(scene || (error.code != KILN_OK && *error.message), "an error without a message");
    return scene;
}

static bool draw(struct kiln_device *device, const struct kiln_scene *scene)
{
    const struct kiln_loop_params params = {.threads = 1};
    const struct kiln_output_needs needs = {.bits = 8, .layers = KILN_LAYERS_ALL};
    struct kiln_error error = {0};
    struct kiln_loop *loop = kiln_loop_create(device, scene, &params, &error);
    bool ok = loop && kiln_loop_set_up(loop, needs, &error);
    for (uint32_t frame = 0; frame < FRAMES && ok; frame++) {
        struct kiln_drawn drawn;
        ok = kiln_loop_draw(loop, frame, true, &drawn, &error);
        if (ok)
            kiln_picture_destroy(&drawn.picture);
    }
    require(ok || (error.code != KILN_OK && *error.message), "an error without a message");
    kiln_loop_destroy(&loop);
    return ok;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char start[] = "kiln: 1";
    struct choice choice = {.bytes = data, .size = size};
    bool samples = false;
    if (size >= sizeof start - 1 && memcmp(data, start, sizeof start - 1) == 0) {
        kiln_text_add(&choice.text, "%.*s", (int)size, (const char *)data);
    } else {
        samples = take(&choice) % 2 != 0;
        add_members(&choice, kiln_options_root, 0);
    }
    fuzz_taken = false;
    if (getenv("KILN_FUZZ_SHOW") && choice.text.data) /* shows which scene an input stands for */
        fprintf(stderr, "%s\n", choice.text.data);
    struct kiln_scene *scene = load(&choice.text, samples);
    if (scene) {
        const struct kiln_scene_info info = kiln_scene_facts(scene);
        const struct kiln_device_params params = {.size = sizeof params, .wanted = KILN_DEVICE_CPU};
        struct kiln_error error = {0};
        struct kiln_device *device = kiln_device_open(&params, &error);
        if (device && info.particle_capacity <= MOST_PARTICLES && info.memory_bytes <= MOST_MEMORY)
            fuzz_taken = draw(device, scene);
        kiln_device_close(&device);
    }
    kiln_scene_destroy(&scene);
    kiln_text_free(&choice.text);
    return 0;
}
