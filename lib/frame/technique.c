/* This file chooses the technique of each stage from the device and from the flags. It has two
 * tables: the techniques of each stage, and the techniques that `auto` chooses for each class of
 * devices. Only techniques called `cpu` run without GL; on a device without GL, this file refuses
 * all others. */
#include "frame/technique.h"

#include <string.h>

#include "base/error.h"
#include "base/text.h"

enum stage { SIMULATE, GAS, SORT, BACKDROP, MARCH, RASTER, BLOOM, COMPOSITE, STAGE_COUNT };
_Static_assert((int)STAGE_COUNT == (int)KILN_STAGE_COUNT, "the header says how many");

static const char *const STAGE_NAMES[STAGE_COUNT] = {
    [SIMULATE] = "simulate", [GAS] = "gas",       [SORT] = "sort",   [BACKDROP] = "backdrop",
    [MARCH] = "march",       [RASTER] = "raster", [BLOOM] = "bloom", [COMPOSITE] = "composite"};

static const enum kiln_pass STAGE_PASSES[STAGE_COUNT] = {
    [SIMULATE] = KILN_PASS_simulate, [GAS] = KILN_PASS_simulate,
    [SORT] = KILN_PASS_sort,         [BACKDROP] = KILN_PASS_backdrop,
    [MARCH] = KILN_PASS_gas,         [RASTER] = KILN_PASS_particles,
    [BLOOM] = KILN_PASS_bloom,       [COMPOSITE] = KILN_PASS_composite};

#define AUTO "auto"

/* A technique that takes a number is called NAME:N, where N is the `number`, 1 to `most`, `of`. */
struct numbered {
    int value; /* value of the stage's enum of techniques where a number is given */
    uint32_t most;
    const char *number, *of;
};

struct row {
    enum stage stage;
    const char *name;
    int value; /* value of the stage's enum of techniques */
    const char *help;
    /* NULL, or the technique for scenes that this one does not take. Techniques with one are for
     * comparison with the papers that describe them and lie in folders papers/. `auto` never takes
     * them. */
    const char *instead;
    const struct numbered *numbered; /* NULL: the technique takes no number */
};

static const struct numbered SPREAD = {KILN_SORT_SPREAD, KILN_SORT_MAX_SPREAD, "number of frames",
                                       "that the sort is spread over"};

static const struct row ROWS[] = {
    {SIMULATE, "cpu", KILN_SIMULATE_CPU, .help = "host threads"},
    {SIMULATE, "inplace", KILN_SIMULATE_INPLACE, .help = "compute, one buffer updated in place"},
    {SIMULATE, "pingpong", KILN_SIMULATE_PINGPONG,
     .help = "compute, from one buffer to another; it takes twice the memory",
     .instead = "simulate=inplace"},
    {SIMULATE, "feedback", KILN_SIMULATE_FEEDBACK,
     .help = "geometry shaders and transform feedback; they take twice the memory",
     .instead = "simulate=inplace"},
    {SIMULATE, "texels", KILN_SIMULATE_TEXELS,
     .help = "fragment shaders, from textures to textures; they take three times the memory",
     .instead = "simulate=inplace"},
    {GAS, "cpu", KILN_GAS_CPU, .help = "host threads, rows and bricks of cells in vectors"},
    {GAS, "gl", KILN_GAS_GL, .help = "compute; the gas stays in GL"},
    {SORT, "cpu", KILN_SORT_CPU, .help = "stable radix sort, host threads"},
    {SORT, "radix", KILN_SORT_RADIX, .help = "stable radix sort, compute"},
    {SORT, "bitonic", KILN_SORT_BITONIC,
     .help = "bitonic merge sort, compute, padded to a power of two"},
    {SORT, "oddeven", KILN_SORT_ODDEVEN,
     .help = "odd-even merge sort, compute; oddeven:N spreads it over N frames",
     .instead = "sort=radix", .numbered = &SPREAD},
    {BACKDROP, "cpu", KILN_BACKDROP_CPU, .help = "host threads, rays in vectors"},
    {BACKDROP, "gl", KILN_BACKDROP_GL, .help = "fragment shaders"},
    {MARCH, "cpu", KILN_MARCH_CPU, .help = "host threads, rays through gas in vectors"},
    {MARCH, "gl", KILN_MARCH_GL, .help = "compute, a ray through gas for each pixel"},
    {RASTER, "cpu", KILN_RASTER_CPU, .help = "host threads, tiles and vectors"},
    {RASTER, "geometry", KILN_RASTER_GEOMETRY,
     .help = "points turned into billboards by a geometry shader"},
    {RASTER, "instanced", KILN_RASTER_INSTANCED,
     .help = "a quad for each particle, without a geometry shader"},
    {RASTER, "tiled", KILN_RASTER_TILED,
     .help = "compute; sprites are sorted into bins, and tiles are drawn from front to back"},
    {BLOOM, "cpu", KILN_BLOOM_CPU, .help = "host threads, rows"},
    {BLOOM, "gl", KILN_BLOOM_GL, .help = "fragment shaders"},
    {COMPOSITE, "cpu", KILN_COMPOSITE_CPU, .help = "host threads, rows"},
    {COMPOSITE, "gl", KILN_COMPOSITE_GL, .help = "one fragment shader"},
};

enum { ROW_COUNT = sizeof ROWS / sizeof *ROWS };

/* The classes of devices that `auto` distinguishes. */
enum device_class { SOFTWARE, GPU, INEXACT_GPU, CLASS_COUNT };

static const char *const CLASS_NAMES[CLASS_COUNT] = {
    [SOFTWARE] = "a software device",
    [GPU] = "a GPU",
    [INEXACT_GPU] = "a GPU that computes inexactly",
};

static enum device_class classify(const struct kiln_device_info *device)
{
    return device->software ? SOFTWARE : device->exact ? GPU : INEXACT_GPU;
}

/* The choices of `auto` with their reasons. docs/measurements.md has the measurements. */
static const struct choice {
    const char *name, *reason;
} AUTO_CHOICES[STAGE_COUNT][CLASS_COUNT] = {
    [SIMULATE] = {[SOFTWARE] = {"cpu", "threads run the step faster than GL on the same cores"},
                  [GPU] = {"inplace",
                           "particles stay in one buffer; it takes the least memory in GL"},
                  [INEXACT_GPU] = {"cpu", "only exact arithmetic may move particles"}},
    [GAS] = {[SOFTWARE] = {"cpu",
                           "vectors on the host are some 20 times as fast as GL on the same cores"},
             [GPU] = {"gl", "all cells of a pass are computed at once, where they lie"},
             [INEXACT_GPU] = {"cpu", "only exact arithmetic may move gas"}},
    [SORT] = {[SOFTWARE] = {"cpu", "threads sort several times as fast as GL on the same cores"},
              [GPU] = {"bitonic", "up to 250,000 particles it is the fastest sort on a GPU"},
              [INEXACT_GPU] = {"cpu", "only exact arithmetic may order particles"}},
    [BACKDROP] =
        {[SOFTWARE] = {"cpu",
                       "vectors on the host are several times as fast as GL on the same cores"},
         [GPU] = {"gl", "the hardware casts the rays"},
         [INEXACT_GPU] = {"gl", "the hardware casts the rays"}},
    [MARCH] = {[SOFTWARE] =
                   {"cpu", "vectors on the host are several times as fast as GL on the same cores"},
               [GPU] = {"gl", "the rays of all pixels march at once"},
               [INEXACT_GPU] = {"gl", "the rays of all pixels march at once"}},
    [RASTER] =
        {[SOFTWARE] = {"cpu",
                       "vectors on the host draw several times as fast as GL on the same cores"},
         [GPU] = {"tiled", "compute draws faster than the blending units of a server's GPU"},
         [INEXACT_GPU] = {"tiled",
                          "compute draws faster than the blending units of a server's GPU"}},
    [BLOOM] = {[SOFTWARE] =
                   {"cpu", "vectors on the host are several times as fast as GL on the same cores"},
               [GPU] = {"gl", "the picture is in GL already"},
               [INEXACT_GPU] = {"gl", "the picture is in GL already"}},
    [COMPOSITE] = {[SOFTWARE] = {"cpu", "the host is faster than GL on the same cores"},
                   [GPU] = {"gl", "the picture is in GL already"},
                   [INEXACT_GPU] = {"gl", "the picture is in GL already"}},
};

/* Holds the chosen row of each stage. reason is the reason of `auto`, or NULL if a flag chose the
 * row. */
struct choices {
    const struct row *rows[STAGE_COUNT];
    const char *reason[STAGE_COUNT];
    uint32_t numbers[STAGE_COUNT]; /* N of NAME:N; 0: none was given */
};

static const struct row *find_row(enum stage stage, const char *name)
{
    for (size_t i = 0; i < ROW_COUNT; i++) {
        if (ROWS[i].stage == stage && strcmp(ROWS[i].name, name) == 0)
            return &ROWS[i];
    }
    return NULL;
}

static struct choices choose_automatically(const struct kiln_device_info *device)
{
    struct choices choices = {0};
    for (int stage = 0; stage < STAGE_COUNT; stage++) {
        const struct choice *choice = &AUTO_CHOICES[stage][classify(device)];
        choices.rows[stage] = find_row((enum stage)stage, choice->name);
        choices.reason[stage] = choice->reason;
    }
    return choices;
}

static bool unknown_name(const char *label, const char *found, const char *const *names,
                         size_t count, struct kiln_error *error)
{
    char list[256] = "";
    for (size_t i = 0; i < count; i++) {
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", i ? ", " : "", names[i]);
    }
    const char *nearest = kiln_text_nearest(found, names, count);
    return kiln_error_set(error, KILN_USAGE, "%s '%s' is not known%s%s%s; allowed are %s", label,
                          found, nearest ? " (did you mean '" : "", nearest ? nearest : "",
                          nearest ? "'?)" : "", list);
}

/* Removes ":N" from "NAME:N" and returns N in *number, if the technique takes a number. */
static bool take_number(enum stage stage, char *name, uint32_t *number, struct kiln_error *error)
{
    *number = 0;
    char *colon = strchr(name, ':');
    if (!colon)
        return true;
    *colon = '\0';
    const struct row *row = find_row(stage, name);
    const struct numbered *numbered = row ? row->numbered : NULL;
    if (!numbered) {
        *colon = ':';
        return true;
    }
    uint64_t value = 0;
    if (!kiln_text_to_uint64(colon + 1, &value) || value < 1 || value > numbered->most)
        return kiln_error_set(error, KILN_USAGE,
                              "technique: %s=%s:%s: expected %s:N, where N is the %s, 1 to %u, %s",
                              STAGE_NAMES[stage], name, colon + 1, name, numbered->number,
                              numbered->most, numbered->of);
    *number = (uint32_t)value;
    return true;
}

static bool apply_flag(const char *flag, const struct choices *automatic, struct choices *choices,
                       struct kiln_error *error)
{
    const char *equals = strchr(flag, '=');
    if (!equals || equals == flag || equals[1] == '\0')
        return kiln_error_set(error, KILN_USAGE, "technique '%s': expected stage=name", flag);
    char stage_name[64];
    snprintf(stage_name, sizeof stage_name, "%.*s", (int)(equals - flag), flag);

    size_t stage = 0;
    while (stage < STAGE_COUNT && strcmp(STAGE_NAMES[stage], stage_name) != 0)
        stage++;
    if (stage == STAGE_COUNT)
        return unknown_name("technique: stage", stage_name, STAGE_NAMES, STAGE_COUNT, error);

    char name[64];
    snprintf(name, sizeof name, "%s", equals + 1);
    uint32_t number = 0;
    if (!take_number((enum stage)stage, name, &number, error))
        return false;
    bool is_auto = strcmp(name, AUTO) == 0;
    const struct row *row = find_row((enum stage)stage, name);
    if (is_auto || row) {
        choices->numbers[stage] = number;
        choices->rows[stage] = is_auto ? automatic->rows[stage] : row;
        choices->reason[stage] = is_auto ? automatic->reason[stage] : NULL;
        return true;
    }
    const char *names[ROW_COUNT + 1];
    size_t count = 0;
    for (size_t i = 0; i < ROW_COUNT; i++) {
        if (ROWS[i].stage == (enum stage)stage)
            names[count++] = ROWS[i].name;
    }
    names[count++] = AUTO;
    char what[96];
    snprintf(what, sizeof what, "technique: %s", stage_name);
    return unknown_name(what, equals + 1, names, count, error);
}

/* Returns the first chosen row that runs in GL, or NULL. Every technique except `cpu` runs in
 * GL. */
static const struct row *find_gl(const struct choices *choices)
{
    for (int stage = 0; stage < STAGE_COUNT; stage++) {
        if (strcmp(choices->rows[stage]->name, "cpu") != 0)
            return choices->rows[stage];
    }
    return NULL;
}

/* Returns the value of a stage's enum of techniques for its chosen row and number. */
static int value_of(const struct choices *choices, enum stage stage)
{
    const struct row *row = choices->rows[stage];
    return choices->numbers[stage] > 0 ? row->numbered->value : row->value;
}

static bool refuse_gl(const struct row *row, const char *device, struct kiln_error *error)
{
    const char *stage = STAGE_NAMES[row->stage];
    return kiln_error_set(error, KILN_USAGE,
                          "technique %s=%s needs OpenGL, which the device '%s' does not have: use "
                          "%s=cpu, or another device ('kiln devices' lists them)",
                          stage, row->name, device, stage);
}

bool kiln_techniques_need_gl(const char *const *techniques, size_t count)
{
    const struct kiln_device_info host = {.software = true, .exact = true};
    const struct choices automatic = choose_automatically(&host);
    struct choices choices = automatic;
    struct kiln_error ignored = {0};
    for (size_t i = 0; i < count; i++)
        apply_flag(techniques[i], &automatic, &choices, &ignored);
    return find_gl(&choices) != NULL;
}

bool kiln_techniques_choose(const struct kiln_device_info *device, const char *const *flags,
                            size_t flag_count, struct kiln_techniques *techniques,
                            struct kiln_error *error)
{
    const struct choices automatic = choose_automatically(device);
    struct choices choices = automatic;
    for (size_t i = 0; i < flag_count; i++) {
        if (!apply_flag(flags[i], &automatic, &choices, error))
            return false;
    }
    if (!device->gl && find_gl(&choices))
        return refuse_gl(find_gl(&choices), device->name, error);
    if (value_of(&choices, SIMULATE) != KILN_SIMULATE_CPU && !device->exact)
        return kiln_error_set(error, KILN_NO_DEVICE,
                              "%s computes inexactly and cannot simulate; use simulate=cpu",
                              device->name);
    if (value_of(&choices, GAS) != KILN_GAS_CPU && !device->exact)
        return kiln_error_set(error, KILN_NO_DEVICE,
                              "%s computes inexactly and cannot step gas; use gas=cpu",
                              device->name);
    if (value_of(&choices, SORT) != KILN_SORT_CPU && !device->exact)
        return kiln_error_set(error, KILN_NO_DEVICE,
                              "%s computes inexactly and cannot sort; use sort=cpu", device->name);
    *techniques = (struct kiln_techniques){
        .simulate = (enum kiln_simulate_technique)value_of(&choices, SIMULATE),
        .gas = (enum kiln_gas_technique)value_of(&choices, GAS),
        .sort = (enum kiln_sort_technique)value_of(&choices, SORT),
        .sort_number = choices.numbers[SORT],
        .backdrop = (enum kiln_backdrop_technique)value_of(&choices, BACKDROP),
        .march = (enum kiln_march_technique)value_of(&choices, MARCH),
        .raster = (enum kiln_raster_technique)value_of(&choices, RASTER),
        .bloom = (enum kiln_bloom_technique)value_of(&choices, BLOOM),
        .composite = (enum kiln_composite_technique)value_of(&choices, COMPOSITE),
    };
    for (int stage = 0; stage < STAGE_COUNT; stage++)
        techniques->choices[stage] = (struct kiln_technique_choice){
            STAGE_NAMES[stage], choices.rows[stage]->name, choices.reason[stage]};
    return true;
}

bool kiln_techniques_paper(const struct kiln_techniques *techniques, char name[KILN_TECHNIQUE_SIZE],
                           const char **instead)
{
    for (int stage = 0; stage < STAGE_COUNT; stage++) {
        const char *chosen = techniques->choices[stage].name;
        *instead = find_row((enum stage)stage, chosen)->instead;
        if (*instead) {
            snprintf(name, KILN_TECHNIQUE_SIZE, "%s=%s", STAGE_NAMES[stage], chosen);
            return true;
        }
    }
    return false;
}

uint32_t kiln_techniques_history(const struct kiln_techniques *techniques)
{
    return kiln_sort_keeps_history(techniques->sort) ? techniques->sort_number : 0;
}

struct kiln_device_params kiln_techniques_device(const char *wanted, const char *const *flags,
                                                 size_t flag_count)
{
    struct kiln_device_params params = kiln_device_defaults();
    params.gl = kiln_techniques_need_gl(flags, flag_count);
    params.wanted = wanted || params.gl ? wanted : KILN_DEVICE_CPU;
    return params;
}

/* Lists the rows of a stage in their order, with `cpu` before the others. */
static size_t list_rows(enum stage stage, const struct row *rows[ROW_COUNT])
{
    const struct row *first = find_row(stage, "cpu");
    size_t count = 0;
    if (first)
        rows[count++] = first;
    for (size_t i = 0; i < ROW_COUNT; i++) {
        if (ROWS[i].stage == stage && &ROWS[i] != first)
            rows[count++] = &ROWS[i];
    }
    return count;
}

/* The stages at the end of a frame vary fastest, since the pixels of their techniques differ. */
bool kiln_techniques_combination(size_t index, struct kiln_technique_list *list)
{
    for (int stage = STAGE_COUNT; stage-- > 0;) {
        const struct row *rows[ROW_COUNT];
        size_t count = list_rows((enum stage)stage, rows);
        snprintf(list->flags[stage], sizeof list->flags[stage], "%s=%s", STAGE_NAMES[stage],
                 rows[index % count]->name);
        index /= count;
    }
    return index == 0;
}

const char *kiln_stage_name(size_t stage)
{
    return STAGE_NAMES[stage];
}

enum kiln_pass kiln_stage_pass(size_t stage)
{
    return STAGE_PASSES[stage];
}

size_t kiln_stage_techniques(size_t stage, const char *names[KILN_MAX_TECHNIQUES])
{
    size_t count = 0;
    for (size_t i = 0; i < ROW_COUNT && count < KILN_MAX_TECHNIQUES; i++) {
        if (ROWS[i].stage == (enum stage)stage)
            names[count++] = ROWS[i].name;
    }
    return count;
}

void kiln_technique_describe(const struct kiln_techniques *techniques, size_t stage, char *out,
                             size_t size)
{
    const struct kiln_technique_choice *choice = &techniques->choices[stage];
    if (stage == SORT && techniques->sort_number > 0)
        snprintf(out, size, "%s=%s:%u", choice->stage, choice->name, techniques->sort_number);
    else
        snprintf(out, size, "%s=%s", choice->stage, choice->name);
}

void kiln_techniques_describe(const struct kiln_techniques *techniques, char *out, size_t size)
{
    size_t used = 0;
    for (size_t stage = 0; stage < STAGE_COUNT && used < size; stage++) {
        char name[KILN_TECHNIQUE_SIZE];
        kiln_technique_describe(techniques, stage, name, sizeof name);
        int length = snprintf(out + used, size - used, "%s%s", used ? " " : "", name);
        used += length > 0 ? (size_t)length : 0;
    }
}

void kiln_visit_techniques(void (*visit)(void *user, const char *name, const char *help),
                           void *user)
{
    for (size_t i = 0; i < ROW_COUNT; i++) {
        char name[64];
        snprintf(name, sizeof name, "%s=%s", STAGE_NAMES[ROWS[i].stage], ROWS[i].name);
        visit(user, name, ROWS[i].help);
    }
}

static void write_technique(void *user, const char *name, const char *help)
{
    fprintf(user, "  %-18s %s\n", name, help);
}

/* Writes the choices of `auto` for a class of devices as a paragraph. */
static void write_choices(FILE *out, enum device_class class)
{
    fprintf(out, "\n'" AUTO "' on %s:\n", CLASS_NAMES[class]);
    for (int stage = 0; stage < STAGE_COUNT; stage++) {
        const struct choice *choice = &AUTO_CHOICES[stage][class];
        char name[64];
        snprintf(name, sizeof name, "%s=%s", STAGE_NAMES[stage], choice->name);
        fprintf(out, "  %-18s %s\n", name, choice->reason);
    }
}

bool kiln_write_techniques(FILE *out)
{
    write_technique(out, "STAGE=" AUTO, "the default of each stage, by the tables below");
    kiln_visit_techniques(write_technique, out);
    for (int class = 0; class < CLASS_COUNT; class ++)
        write_choices(out, (enum device_class) class);
    return !ferror(out);
}
