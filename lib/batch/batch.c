/* Reads files of jobs for kiln render --batch. Files are read by an option table like scenes, so
 * they have the same error messages and the same kind of reference. */
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/file.h"
#include "option/params.h"
#include "option/reader.h"
#include "option/reference.h"
#include "option/rows.h"
#include "option/schema.h"
#include "suite/type.h"

enum { MAX_JOBS = KILN_NODE_MAX_ENTRIES, MAX_OVERRIDES = 64, MAX_TEXT = 4000, MAX_VALUE = 8000 };

/* An entry of `jobs`, as the table fills it. */
struct entry {
    const char *name, *scene, *asset_root, *states;
    struct kiln_batch_text output, manifest, frames, limits;
    const char *params[KILN_MAX_PARAMS]; /* overrides "params.NAME=VALUE" */
    uint32_t param_count;
    const char *set[MAX_OVERRIDES];
    uint32_t set_count;
    double timeout_s;
};

struct document {
    uint32_t version;
    struct entry jobs[MAX_JOBS];
    uint32_t job_count;
};

struct kiln_batch {
    struct kiln_arena *arena;
    const char *name; /* name of the file, for messages */
    enum kiln_batch_format format;
    struct kiln_batch_job *jobs;
    size_t count, capacity;
};

/* ---- the table ------------------------------------------------------------------------------- */

#define FILLS struct entry

/* Reads a text with its line and column: the program checks the text later, and reports errors
 * there by kiln_batch_refuse. */
static bool read_located(struct kiln_reader *reader, const struct kiln_option *option,
                         const struct kiln_node *node, void *field)
{
    struct kiln_batch_text *located = field;
    located->line = node->line + reader->origin->lines_before;
    located->column = node->column;
    return kiln_type_text.read(reader, option, node, &located->text);
}

static void describe_located(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_type_text.describe(option, out);
}

static void schema_located(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_type_text.schema(option, out);
}

typedef struct kiln_batch_text kiln_fills_located;
static const struct kiln_option_type kiln_type_located = {
    .read = read_located, .describe = describe_located, .schema = schema_located};

/* Makes the row of a text: type, name, field, smallest length, default, help. */
#define TEXT(type, n, f, least, def, h)                                                            \
    {                                                                                              \
        ROW(NO_PART, n, type, f, def, h), LIMITS(KILN_PLAIN, least, MAX_TEXT)                      \
    }

/* Reads a mapping of names to values of parameters as the overrides of the job. */
static bool read_values(struct kiln_reader *reader, const struct kiln_option *option,
                        const struct kiln_node *node, void *field)
{
    struct entry *entry = field;
    if (node->kind != KILN_NODE_MAP || node->count > KILN_MAX_PARAMS)
        return kiln_reader_mismatch(reader, option, node);
    for (const struct kiln_node *value = node->first; value; value = value->next) {
        struct kiln_text text = {0};
        const size_t before = kiln_reader_enter(reader, value->key->text);
        if (!kiln_option_is_name(value->key->text))
            return kiln_reader_error(reader, value->key, "this is no name of a parameter");
        kiln_text_add(&text, "params.%s=", value->key->text);
        kiln_node_write(value, &text);
        const bool is_long = text.length > MAX_VALUE;
        const bool ok =
            !text.failed && !is_long &&
            kiln_reader_copy_text(reader, text.data, &entry->params[entry->param_count]);
        kiln_text_free(&text);
        if (is_long)
            return kiln_reader_error(reader, value, "the value is too long");
        if (!ok)
            return kiln_reader_out_of_memory(reader);
        entry->param_count++;
        kiln_reader_leave(reader, before);
    }
    return true;
}

static void describe_values(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "a mapping of up to %d names of parameters to values", KILN_MAX_PARAMS);
}

static void schema_values(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "{\"type\": \"object\", \"maxProperties\": %d}", KILN_MAX_PARAMS);
}

typedef struct entry kiln_fills_values;
static const struct kiln_option_type kiln_type_values = {
    .read = read_values, .describe = describe_values, .schema = schema_values};

ITEM(override_item, override, LIMITS(KILN_PLAIN, 1, MAX_TEXT));

TABLE(job_rows) = {
    TEXT(text, "name", name, 0, "\"\"",
         "Name of the job in the results. Without a name, results have its number."),
    TEXT(text, "scene", scene, 1, NULL, "The scene's path, from the folder of the file of jobs."),
    TEXT(located, "output", output, 1, NULL,
         "Where to write, like --output, from the folder of the file of jobs. 'none' writes "
         "nothing."),
    {ROW_OF_ALL(NO_PART, "params", values, "{}", "Values of the scene's parameters.")},
    LIST(NO_PART, "set", set, override_item, set_count, "[]", "Changes of keys of the scene."),
    TEXT(located, "frames", frames, 0, "\"\"",
         "Frames to draw, like --frames. Without it, all frames are drawn."),
    TEXT(located, "limits", limits, 0, "\"\"", "Limits of the job, like --limits."),
    {ROW(NO_PART, "timeout", number, timeout_s, "0 s",
         "Time limit of the job, like --timeout: seconds, or a time with a unit, ms, s, min or h. "
         "0 is no limit."),
     LIMITS(KILN_SECONDS, 0, 1e7)},
    TEXT(text, "asset_root", asset_root, 0, "\"\"",
         "Folder that the scene's files must lie in. Without it, this is the scene's folder."),
    TEXT(text, "states", states, 0, "\"\"", "A folder of 'kiln bake', like --states."),
    TEXT(located, "manifest", manifest, 0, "\"\"",
         "A JSON file that describes the run, like --manifest."),
    END,
};

ITEM_OF_ROWS(job_item, job_rows);

#undef FILLS
#define FILLS struct document

TABLE(rows) = {
    INTEGER(NO_PART, "kiln_jobs", version, 1, 1, NULL, "Version of the format of files of jobs."),
    LIST(NO_PART, "jobs", jobs, job_item, job_count, NULL, "The jobs. They begin in this order."),
    END,
};

bool kiln_batch_write_reference(FILE *out)
{
    static const char introduction[] =
        "'kiln render --batch jobs.yaml' renders every job of a file, each in a process of its "
        "own:\n"
        "\n"
        "    kiln_jobs: 1\n"
        "    jobs:\n"
        "      - {scene: fire.yaml, output: out/fire.mp4, set: [seed=3], timeout: 600 s}\n"
        "      - {scene: rain.yaml, output: out/rain_####.png, frames: 0-9}\n"
        "\n"
        "A file whose name ends in .ndjson or .jsonl has one job a line, and so has standard "
        "input, '-':\n"
        "\n"
        "    {\"scene\": \"fire.yaml\", \"output\": \"out/fire.mp4\", \"set\": [\"seed=3\"]}\n"
        "    {\"scene\": \"title.yaml\", \"output\": \"a.mp4\", \"params\": {\"brand\": "
        "\"#e61e28\"}}\n"
        "\n";
    return kiln_reference_write(out, introduction, rows);
}

bool kiln_batch_write_schema(FILE *out)
{
    return kiln_schema_write(out, "kiln jobs", rows);
}

/* ---- from entries to jobs -------------------------------------------------------------------- */

static bool out_of_memory(struct kiln_error *error)
{
    return kiln_error_no_memory(error, "reading jobs");
}

/* Resolves a path relative to the file at `base`; NULL for an empty path, or when memory is short.
 */
static const char *resolve(struct kiln_batch *batch, const char *base, const char *path)
{
    const char *slash = base ? strrchr(base, '/') : NULL;
    const int folder = slash && *path != '/' ? (int)(slash + 1 - base) : 0;
    return *path ? kiln_arena_format(batch->arena, "%.*s%s", folder, base ? base : "", path) : NULL;
}

static bool make_room(struct kiln_batch *batch)
{
    if (batch->count < batch->capacity)
        return true;
    const size_t capacity = batch->capacity ? 2 * batch->capacity : 64;
    struct kiln_batch_job *jobs = realloc(batch->jobs, capacity * sizeof *jobs);
    if (!jobs)
        return false;
    batch->jobs = jobs;
    batch->capacity = capacity;
    return true;
}

static struct kiln_batch_text resolve_located(struct kiln_batch *batch, const char *base,
                                              struct kiln_batch_text located)
{
    located.text = resolve(batch, base, located.text);
    return located;
}

static struct kiln_batch_text text_or_null(struct kiln_batch_text located)
{
    return *located.text ? located : (struct kiln_batch_text){.text = NULL};
}

/* Adds the job of an entry, which lies in the batch's arena. */
static bool add_job(struct kiln_batch *batch, const struct entry *entry, const char *base,
                    struct kiln_error *error)
{
    if (!make_room(batch))
        return out_of_memory(error);
    const size_t override_count = entry->param_count + entry->set_count;
    const char **overrides = kiln_arena_alloc(batch->arena, override_count + 1, sizeof *overrides);
    if (!overrides)
        return out_of_memory(error);
    memcpy(overrides, entry->params, entry->param_count * sizeof *overrides);
    memcpy(overrides + entry->param_count, entry->set, entry->set_count * sizeof *overrides);
    const bool writes = strcmp(entry->output.text, "none") != 0;
    const struct kiln_batch_job job = {
        .name = *entry->name ? entry->name
                             : kiln_arena_format(batch->arena, "job %zu", batch->count + 1),
        .scene = resolve(batch, base, entry->scene),
        .output = writes ? resolve_located(batch, base, entry->output) : entry->output,
        .asset_root = resolve(batch, base, entry->asset_root),
        .states = resolve(batch, base, entry->states),
        .manifest = resolve_located(batch, base, entry->manifest),
        .frames = text_or_null(entry->frames),
        .limits = text_or_null(entry->limits),
        .timeout_s = entry->timeout_s,
        .overrides = overrides,
        .override_count = override_count,
    };
    batch->jobs[batch->count++] = job;
    return (job.name && job.scene && job.output.text) || out_of_memory(error);
}

/* ---- reading --------------------------------------------------------------------------------- */

static struct kiln_batch *create(struct kiln_error *error)
{
    struct kiln_batch *batch = calloc(1, sizeof *batch);
    if (batch)
        batch->arena = kiln_arena_create();
    if (!batch || !batch->arena) {
        out_of_memory(error);
        kiln_batch_destroy(&batch);
    }
    return batch;
}

static bool read_yaml(struct kiln_batch *batch, const char *text, size_t size, const char *name,
                      const char *base, struct kiln_error *error)
{
    const struct kiln_origin origin = {
        .name = name, .has_lines = true, .kind = "a file of jobs", .version = "kiln_jobs: 1"};
    struct kiln_arena *scratch = kiln_arena_create();
    struct document *document = kiln_arena_alloc(batch->arena, 1, sizeof *document);
    struct kiln_reader reader = {.origin = &origin,
                                 .arena = batch->arena,
                                 .scratch = scratch,
                                 .error = error,
                                 .target = document};
    bool ok = false;
    if (!scratch || !document)
        out_of_memory(error);
    else
        ok = kiln_read_document(&reader, rows, text, size);
    for (uint32_t i = 0; ok && i < document->job_count; i++)
        ok = add_job(batch, &document->jobs[i], base, error);
    kiln_arena_destroy(&scratch);
    return ok;
}

/* Reads a line of JSON, which is also a flow mapping of YAML. */
static bool read_line(struct kiln_batch *batch, const char *text, size_t size, uint32_t number,
                      const char *name, const char *base, struct kiln_error *error)
{
    const struct kiln_origin origin = {.name = name,
                                       .has_lines = true,
                                       .lines_before = number - 1,
                                       .kind = "a job",
                                       .syntax = "JSON"};
    struct kiln_arena *scratch = kiln_arena_create();
    struct entry *entry = kiln_arena_alloc(batch->arena, 1, sizeof *entry);
    char *line = scratch ? kiln_arena_text(scratch, text, size) : NULL;
    struct kiln_reader reader = {.origin = &origin,
                                 .arena = batch->arena,
                                 .scratch = scratch,
                                 .error = error,
                                 .target = entry};
    const bool ok = entry && line ? kiln_read_document(&reader, job_rows, line, size) &&
                                        add_job(batch, entry, base, error)
                                  : out_of_memory(error);
    kiln_arena_destroy(&scratch);
    return ok;
}

/* Reads lines of JSON, but skips empty lines. Relative paths start at the folder of the file
 * `base`, which may be NULL. */
static bool read_lines(struct kiln_batch *batch, const char *text, size_t size, const char *name,
                       const char *base, struct kiln_error *error)
{
    uint32_t number = 1;
    for (const char *end = text + size; text < end; number++) {
        const char *stop = memchr(text, '\n', (size_t)(end - text));
        const size_t length = (size_t)((stop ? stop : end) - text);
        if (strspn(text, " \t\r") < length &&
            !read_line(batch, text, length, number, name, base, error))
            return false;
        text += length + 1;
    }
    return true;
}

static bool has_suffix(const char *path, const char *suffix)
{
    const size_t length = strlen(path), end = strlen(suffix);
    return length > end && strcmp(path + length - end, suffix) == 0;
}

/* Parses a file of jobs. Relative paths start at the folder of the file `base`, which may be
 * NULL. */
static struct kiln_batch *parse(const char *text, size_t size, const char *name, const char *base,
                                enum kiln_batch_format format, struct kiln_error *error)
{
    struct kiln_batch *batch = create(error);
    if (!batch)
        return NULL;
    batch->format = format;
    batch->name = kiln_arena_text(batch->arena, name, strlen(name));
    bool ok = batch->name || out_of_memory(error);
    ok = ok && (format == KILN_BATCH_LINES ? read_lines(batch, text, size, name, base, error)
                                           : read_yaml(batch, text, size, name, base, error));
    if (ok && batch->count == 0)
        ok = kiln_error_set(error, KILN_INVALID_INPUT, "%s: the file has no jobs", name);
    if (!ok)
        kiln_batch_destroy(&batch);
    return batch;
}

struct kiln_batch *kiln_batch_parse(const char *text, size_t size, const char *name,
                                    enum kiln_batch_format format, struct kiln_error *error)
{
    return parse(text, size, name, NULL, format, error);
}

struct kiln_batch *kiln_batch_read(const char *path, struct kiln_error *error)
{
    size_t size = 0;
    const bool lines = has_suffix(path, ".ndjson") || has_suffix(path, ".jsonl");
    char *text = kiln_text_file_read(path, "a file of jobs", KILN_MAX_BATCH_SIZE, &size, error);
    struct kiln_batch *batch =
        text ? parse(text, size, path, path, lines ? KILN_BATCH_LINES : KILN_BATCH_YAML, error)
             : NULL;
    free(text);
    return batch;
}

void kiln_batch_destroy(struct kiln_batch **batch)
{
    if (!batch || !*batch)
        return;
    kiln_arena_destroy(&(*batch)->arena);
    free((*batch)->jobs);
    free(*batch);
    *batch = NULL;
}

size_t kiln_batch_count(const struct kiln_batch *batch)
{
    return batch->count;
}

const struct kiln_batch_job *kiln_batch_job(const struct kiln_batch *batch, size_t index)
{
    return &batch->jobs[index];
}

bool kiln_batch_refuse(const struct kiln_batch *batch, size_t index,
                       const struct kiln_batch_text *text, const char *key,
                       struct kiln_error *error, const char *format, ...)
{
    char message[KILN_MESSAGE_SIZE], job[32] = "";
    va_list args;
    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
    if (batch->format == KILN_BATCH_YAML)
        snprintf(job, sizeof job, "jobs.%zu.", index);
    return kiln_error_set(error, KILN_INVALID_INPUT, "%s:%u:%u: %s%s: %s", batch->name, text->line,
                          text->column, job, key, message);
}
