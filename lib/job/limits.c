/* Reads and documents the limits of a job. Each limit has a row with its value in the preset
 * `service` and its help. The help also has the sizes that no scene may go over. */
#include <stdlib.h>
#include <string.h>

#include "base/budget.h"
#include "base/error.h"
#include "base/sized.h"
#include "base/text.h"
#include "kiln_program.h"
#include "option/include.h"
#include "option/node_copy.h"
#include "option/params.h"
#include "option/unit.h"
#include "scene/emit_way.h"
#include "scene/small_steps.h"
#include "scene/source.h"

static const struct row {
    const char *service; /* the limit in the preset `service` */
    const char *help;
} rows[] = {
    [KILN_LIMIT_pixels] = {"16777216", "Width times height of the pictures."},
    [KILN_LIMIT_frames] = {"100000", "Length of the clip in frames."},
    [KILN_LIMIT_steps] = {"1000000", "Steps of the simulation up to its last frame."},
    [KILN_LIMIT_particles] = {"4000000", "Particles that may live at once, of all systems."},
    [KILN_LIMIT_memory] = {"4 GiB",
                           "Memory that the process takes, or that a scene is expected to take."},
    [KILN_LIMIT_time] = {"1 h", "Time from the start of the command to its end, like --timeout."},
    [KILN_LIMIT_cpu] = {"none", "Time of all processors together."},
    [KILN_LIMIT_asset_pixels] = {"268435456",
                                 "Pixels of the pictures that the scene names, decoded."},
    [KILN_LIMIT_asset_bytes] = {"1 GiB", "Bytes of the files that the scene names."},
    [KILN_LIMIT_triangles] = {"2000000", "Triangles of the meshes that the scene names."},
    [KILN_LIMIT_output] = {"64 GiB", "Bytes that are written."},
    [KILN_LIMIT_gas_cells] = {"33554432", "Cells of all domains of gas."},
    [KILN_LIMIT_gas_steps] = {"12 G", "Cells of gas times its steps up to the last frame."},
};

enum unit { COUNT, BYTES, TIME };
static const enum unit units[] = {
#define UNIT(name, unit, noun) [KILN_LIMIT_##name] = unit,
    KILN_LIMITS(UNIT)
#undef UNIT
};

static const struct {
    enum unit of;
    const char *name;
    double factor;
} suffixes[] = {
    {COUNT, "", 1},         {COUNT, "k", 1e3},      {COUNT, "M", 1e6},      {COUNT, "G", 1e9},
    {BYTES, "", 1},         {BYTES, "B", 1},        {BYTES, "kB", 1e3},     {BYTES, "MB", 1e6},
    {BYTES, "GB", 1e9},     {BYTES, "TB", 1e12},    {BYTES, "KiB", 0x1p10}, {BYTES, "MiB", 0x1p20},
    {BYTES, "GiB", 0x1p30}, {BYTES, "TiB", 0x1p40},
};

static const char *const expected[] = {
    [COUNT] = "a number, with k, M or G behind it or without",
    [BYTES] = "a number of bytes, kB, MB, GB, TB, KiB, MiB, GiB or TiB",
    [TIME] = "seconds, or a time in ms, s, min or h",
};

/* ---- reading --------------------------------------------------------------------------------- */

static bool take_amount(double value, uint64_t *amount)
{
    *amount = value >= 1.0 && value < 9e18 ? (uint64_t)value : 0;
    return *amount > 0;
}

static bool read_amount(enum kiln_limit limit, const char *text, uint64_t *amount)
{
    double number;
    const char *unit;
    *amount = 0;
    if (strcmp(text, "none") == 0)
        return true;
    if (units[limit] == TIME)
        return kiln_text_to_seconds(text, &number) && take_amount(1e3 * number + 0.5, amount);
    if (!kiln_unit_split(text, &number, &unit))
        return false;
    for (size_t i = 0; i < sizeof suffixes / sizeof *suffixes; i++) {
        if (suffixes[i].of == units[limit] && strcmp(suffixes[i].name, unit) == 0)
            return take_amount(number * suffixes[i].factor, amount);
    }
    return false;
}

static bool find_limit(const char *name, enum kiln_limit *limit)
{
    for (size_t i = 0; i < KILN_LIMIT_COUNT; i++) {
        *limit = (enum kiln_limit)i;
        if (strcmp(kiln_limit_name(*limit), name) == 0)
            return true;
    }
    return false;
}

static bool refuse_name(const char *name, struct kiln_error *error)
{
    const char *names[KILN_LIMIT_COUNT + 1] = {"service"};
    struct kiln_text list = {0};
    for (size_t i = 0; i < KILN_LIMIT_COUNT; i++) {
        names[i + 1] = kiln_limit_name((enum kiln_limit)i);
        kiln_text_add(&list, "%s, ", names[i + 1]);
    }
    const char *nearest = kiln_text_nearest(name, names, KILN_LIMIT_COUNT + 1);
    if (nearest)
        kiln_error_set(error, KILN_USAGE, "'%.40s' is not a limit; did you mean '%s'?", name,
                       nearest);
    else
        kiln_error_set(error, KILN_USAGE,
                       "'%.40s' is not a limit; there are %sand the preset service", name,
                       list.data ? list.data : "");
    kiln_text_free(&list);
    return false;
}

/* Reads one item of the list, between two commas. */
static bool read_item(struct kiln_limits *limits, char *item, struct kiln_error *error)
{
    enum kiln_limit limit;
    uint64_t amount;
    char *equals = strchr(item, '=');
    if (strcmp(item, "service") == 0) {
        for (size_t i = 0; i < KILN_LIMIT_COUNT; i++)
            read_amount((enum kiln_limit)i, rows[i].service, &limits->most[i]);
        return true;
    }
    if (equals)
        *equals = '\0';
    if (strcmp(item, "service") == 0)
        return kiln_error_set(error, KILN_USAGE, "'service' takes no value");
    if (!find_limit(item, &limit))
        return refuse_name(item, error);
    if (!equals || !read_amount(limit, equals + 1, &amount))
        return kiln_error_set(error, KILN_USAGE, "%s: found '%.40s'; expected %s, or none", item,
                              equals ? equals + 1 : "", expected[units[limit]]);
    limits->most[limit] = amount;
    return true;
}

bool kiln_limits_parse(struct kiln_limits *limits, const char *text, struct kiln_error *error)
{
    struct kiln_limits known = kiln_limits_empty();
    if (!kiln_sized_take(&known, limits, "kiln_limits", error))
        return false;
    char *copy = strdup(text), *rest = copy, *item;
    bool ok = copy || kiln_error_no_memory(error, "the limits");
    while (ok && (item = strsep(&rest, ",")))
        ok = read_item(&known, item, error);
    free(copy);
    kiln_sized_give(limits, &known);
    return ok;
}

/* ---- sizes of a scene ------------------------------------------------------------------------ */

static const struct size {
    const char *name;
    unsigned long long most;
    const char *help;
    unsigned most_in_gl; /* a lower limit of devices of OpenGL; 0: there is none */
    const char *of;      /* what the lower limit holds for, after "of them"; or NULL */
} sizes[] = {
    {"systems", KILN_MAX_SYSTEMS, .help = "Particle systems"},
    {"particles", KILN_MAX_PARTICLES, .help = "Particles that may live at once",
     .most_in_gl = KILN_MAX_GL_PARTICLES},
    {"forces", KILN_MAX_FORCES, .help = "Forces of a system"},
    {"bursts", KILN_MAX_BURSTS, .help = "Bursts of a system"},
    {"demitters", KILN_MAX_DEMITTERS, .help = "Boxes of a system in which particles die"},
    {"generations", KILN_MAX_GENERATIONS,
     .help = "Generations of systems, parents to last descendants"},
    {"textures", KILN_MAX_TEXTURES, .help = "Textures of a system"},
    {"cells", KILN_MAX_CELLS, .help = "Cells of a texture; in OpenGL, of all textures together"},
    {"entries", KILN_NODE_MAX_ENTRIES,
     .help = "Entries of a list or mapping, such as the keys of a value"},
    {"keys", KILN_MAX_VALUE_KEYS, .help = "Keys of all values", .most_in_gl = KILN_BLOCK_KEYS,
     .of = "lives"},
    {"objects", KILN_MAX_OBJECTS, .help = "Objects of the backdrop, meshes and terrain included"},
    {"meshes", KILN_MAX_MESHES, .help = "Meshes and terrains of the backdrop"},
    {"lights", KILN_MAX_LIGHTS, .help = "Lights of the backdrop"},
    {"nodes", KILN_MAX_NODES, .help = "Nodes"},
    {"points", KILN_MAX_PATH_POINTS, .help = "Points of a node's path"},
    {"parameters", KILN_MAX_PARAMS, .help = "Parameters"},
    {"includes", KILN_INCLUDE_MAX_FILES, .help = "Included files, through at most 8 files"},
    {"copies", KILN_NODE_MAX_COPIES, .help = "Nodes that aliases, uses and parameters copy"},
    {"ways", KILN_MAX_WAY_STEPS, .help = "Steps of the ways of emitters by the metre, in all"},
    {"winds", KILN_MAX_WINDS, .help = "Files of wind"},
    {"sources", KILN_MAX_SOURCE_CELLS,
     .help = "Triangles, vertices and pixels that particles are born on"},
    {"baked", KILN_MAX_BAKED, .help = "Baked winds, of up to 12 forces each"},
    {"gas", KILN_MAX_GAS, .help = "Domains of gas"},
    {"gas_cells", KILN_MAX_GAS_CELLS,
     .help = "Cells of all domains of gas, of which an edge has at most 1024"},
    {"gas_sources", KILN_MAX_GAS_SOURCES, .help = "Sources of a domain of gas"},
    {"substeps", KILN_MAX_SUBSTEPS, .help = "Steps of gas in a step of the scene"},
    {"steps", KILN_MAX_STEPS, .help = "Steps of a run, warm-up included"},
};

static void write_sizes(FILE *out)
{
    fputs("\nA scene has at most these, whatever the limits:\n\n", out);
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        fprintf(out, "%-14s%-12llu%s", sizes[i].name, sizes[i].most, sizes[i].help);
        if (sizes[i].most_in_gl > 0)
            fprintf(out, "; in OpenGL, %u", sizes[i].most_in_gl);
        fprintf(out, "%s%s.\n", sizes[i].of ? " of them of " : "", sizes[i].of ? sizes[i].of : "");
    }
}

/* Writes the least speeds that are true to 1 %, for some distances from the origin and rates. */
static void write_speeds(FILE *out)
{
    static const float places[] = {10.0f, 100.0f, 1000.0f, 10000.0f, 100000.0f};
    static const int rates[] = {60, 240, 1000};
    fputs("\nPositions are 32-bit floats, so small steps far from the origin are rounded. Speeds "
          "are true to\n"
          "1 % from these on; kiln warns of systems whose particles are slower:\n"
          "\n"
          "FROM THE ORIGIN",
          out);
    for (size_t k = 0; k < sizeof rates / sizeof *rates; k++)
        fprintf(out, "  %4d steps/s", rates[k]);
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        fprintf(out, "\n%13.0f m", (double)places[i]);
        for (size_t k = 0; k < sizeof rates / sizeof *rates; k++)
            fprintf(out, "  %8.3g m/s", kiln_small_steps_true_speed(places[i], rates[k]));
    }
    fputc('\n', out);
}

/* ---- help and listing ------------------------------------------------------------------------ */

bool kiln_write_limits(FILE *out)
{
    fputs("--limits KEY=VALUE,... sets limits, and so does the environment's KILN_LIMITS; --limits "
          "is read\n"
          "last. `service` stands for all values of its column, `none` lifts a limit. A job that "
          "goes over a\n"
          "limit ends with exit code 8 and leaves no half-written file; --resume may go on. "
          "render, bake,\n"
          "export, plan and check have all limits. encode and join have memory, time, cpu and "
          "output. Tests\n"
          "have a time limit of their own.\n"
          "\n",
          out);
    fputs("KEY           service\n", out);
    for (size_t i = 0; i < KILN_LIMIT_COUNT; i++)
        fprintf(out, "%-14s%-12s%s\n", kiln_limit_name((enum kiln_limit)i), rows[i].service,
                rows[i].help);
    write_sizes(out);
    write_speeds(out);
    return !ferror(out);
}
