/* Reads result.json, and trusts nothing in it, since results travel between machines and reports
 * open the files that they name. A missing or additional member is an error, and so is a file name
 * that leads out of the result's folder. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "option/node.h"
#include "suite/result_member.h"

enum { MAX_FILE_SIZE = 64 << 20 };

struct reading {
    struct kiln_arena *arena;
    struct kiln_error *error;
    const char *results; /* the folder of results, or NULL */
};

/* Refuses a value: "found X; allowed is ...". */
static bool refuse(const struct reading *reading, const struct kiln_node *node, const char *name,
                   const char *allowed)
{
    char found[64] = "a list";
    if (node->kind == KILN_NODE_SCALAR)
        kiln_node_quote(found, node->text);
    else if (node->kind == KILN_NODE_MAP)
        memcpy(found, "an object", sizeof "an object");
    return kiln_node_error(node, reading->error, "%s: found %s%s%s; allowed is %s", name,
                           node->quoted ? "\"" : "", found, node->quoted ? "\"" : "", allowed);
}

static bool is_literal(const struct kiln_node *node)
{
    return node->kind == KILN_NODE_SCALAR && !node->quoted;
}

static bool is_text(const struct kiln_node *node)
{
    return node->kind == KILN_NODE_SCALAR && node->quoted;
}

/* ---- Values ------------------------------------------------------------------------------- */

static bool read_text(const struct reading *reading, const struct kiln_node *node, const char *name,
                      const char **text)
{
    if (!is_text(node))
        return refuse(reading, node, name, "a text in quotes");
    *text = node->text; /* the node lies in the arena */
    return true;
}

static bool read_file(const struct reading *reading, const struct kiln_node *node, const char *name,
                      const char **text)
{
    if (!read_text(reading, node, name, text))
        return false;
    return !**text || kiln_result_file_is_name(*text) ||
           refuse(reading, node, name, "the name of a file in the folder of the result");
}

static bool read_hash(const struct reading *reading, const struct kiln_node *node, const char *name,
                      const char **text)
{
    enum { MOST_DIGITS = 64 };
    if (!read_text(reading, node, name, text))
        return false;
    const size_t digits = strspn(*text, "0123456789abcdef");
    return ((*text)[digits] == '\0' && digits <= MOST_DIGITS) ||
           refuse(reading, node, name, "a hash of at most 64 digits of 0 to 9 and a to f");
}

static bool read_name(const struct reading *reading, const struct kiln_node *node, const char *name,
                      char text[KILN_METRIC_NAME_SIZE])
{
    if (!is_text(node) || strlen(node->text) >= KILN_METRIC_NAME_SIZE || *node->text == '\0')
        return refuse(reading, node, name, "a text of 1 to 23 bytes in quotes");
    memcpy(text, node->text, strlen(node->text) + 1);
    return true;
}

static bool read_uint32(const struct reading *reading, const struct kiln_node *node,
                        const char *name, uint32_t *number)
{
    uint64_t value = 0;
    if (!is_literal(node) || !kiln_text_to_uint64(node->text, &value) || value > UINT32_MAX)
        return refuse(reading, node, name, "a whole number from 0 to 4294967295");
    *number = (uint32_t)value;
    return true;
}

static bool read_double(const struct reading *reading, const struct kiln_node *node,
                        const char *name, double *number)
{
    if (is_literal(node) && strcmp(node->text, "null") == 0)
        *number = INFINITY;
    else if (!is_literal(node) || !kiln_text_to_double(node->text, number))
        return refuse(reading, node, name, "a number, or null for infinity");
    return true;
}

static bool read_bool(const struct reading *reading, const struct kiln_node *node, const char *name,
                      bool *value)
{
    *value = is_literal(node) && strcmp(node->text, "true") == 0;
    if (*value || (is_literal(node) && strcmp(node->text, "false") == 0))
        return true;
    return refuse(reading, node, name, "true or false");
}

static bool read_code(const struct reading *reading, const struct kiln_node *node, const char *name,
                      enum kiln_code *code)
{
    uint64_t value = 0;
    bool number = is_literal(node) && kiln_text_to_uint64(node->text, &value);
    if (!number || (value > KILN_GOLDEN_MISSING && value != KILN_INTERRUPTED))
        return refuse(reading, node, name, "0 to 7 or 130");
    *code = (enum kiln_code)value;
    return true;
}

static bool read_status(const struct reading *reading, const struct kiln_node *node,
                        const char *name, enum kiln_test_status *status)
{
    for (int i = 0; is_text(node) && i < KILN_TEST_STATUS_COUNT; i++) {
        *status = (enum kiln_test_status)i;
        if (strcmp(node->text, kiln_test_status_name(*status)) == 0)
            return true;
    }
    return refuse(reading, node, name, "pass, skip, warn, change, new, fail or error");
}

static bool read_judged_by(const struct reading *reading, const struct kiln_node *node,
                           const char *name, enum kiln_judged_by *judged_by)
{
    for (int i = 0; is_text(node) && i < KILN_JUDGED_BY_COUNT; i++) {
        *judged_by = (enum kiln_judged_by)i;
        if (strcmp(node->text, kiln_judged_by_name(*judged_by)) == 0)
            return true;
    }
    return refuse(reading, node, name, "nothing, state, pixels or metrics");
}

static bool read_value(const struct reading *reading, const struct kiln_node *node,
                       const struct kiln_member *m, void *value)
{
    switch (m->kind) {
    case KILN_MEMBER_TEXT:
        return read_text(reading, node, m->name, value);
    case KILN_MEMBER_FILE:
        return read_file(reading, node, m->name, value);
    case KILN_MEMBER_HASH:
        return read_hash(reading, node, m->name, value);
    case KILN_MEMBER_NAME:
        return read_name(reading, node, m->name, value);
    case KILN_MEMBER_UINT32:
        return read_uint32(reading, node, m->name, value);
    case KILN_MEMBER_DOUBLE:
        return read_double(reading, node, m->name, value);
    case KILN_MEMBER_BOOL:
        return read_bool(reading, node, m->name, value);
    case KILN_MEMBER_CODE:
        return read_code(reading, node, m->name, value);
    case KILN_MEMBER_STATUS:
        return read_status(reading, node, m->name, value);
    case KILN_MEMBER_JUDGED_BY:
        return read_judged_by(reading, node, m->name, value);
    case KILN_MEMBER_END:
        break;
    }
    return false;
}

/* ---- Objects ------------------------------------------------------------------------------ */

/* Reads the members into an object, and counts them. */
static bool read_members(const struct reading *reading, const struct kiln_node *node,
                         const struct kiln_member *members, void *object, uint32_t *count)
{
    for (const struct kiln_member *m = members; m->name; m++) {
        const struct kiln_node *entry = kiln_node_entry(node, m->name);
        if (!entry)
            return kiln_node_error(node, reading->error, "%s is missing", m->name);
        if (!read_value(reading, entry, m, (char *)object + m->offset))
            return false;
        ++*count;
    }
    return true;
}

/* Checks that the object has no more members than were read. */
static bool check_count(const struct reading *reading, const struct kiln_node *node, uint32_t count)
{
    return node->count == count ||
           kiln_node_error(node, reading->error, "found %u members; allowed are %u", node->count,
                           count);
}

static bool read_object(const struct reading *reading, const struct kiln_node *node,
                        const struct kiln_member *members, void *object)
{
    uint32_t count = 0;
    return read_members(reading, node, members, object, &count) &&
           check_count(reading, node, count);
}

/* Returns a list of at most `most` entries, or NULL with the error. */
static const struct kiln_node *find_list(const struct reading *reading,
                                         const struct kiln_node *node, const char *name,
                                         uint32_t most)
{
    const struct kiln_node *list = kiln_node_entry(node, name);
    if (!list) {
        kiln_node_error(node, reading->error, "%s is missing", name);
    } else if (list->kind != KILN_NODE_LIST || list->count > most) {
        char allowed[64];
        snprintf(allowed, sizeof allowed, "a list of at most %u entries", most);
        refuse(reading, list, name, allowed);
        list = NULL;
    }
    return list;
}

/* Allocates one entry more than needed, so that an empty list is not NULL. */
static void *allocate(const struct reading *reading, uint32_t count, size_t size)
{
    void *entries = kiln_arena_alloc(reading->arena, (size_t)count + 1, size);
    if (!entries)
        kiln_error_no_memory(reading->error, "reading a result");
    return entries;
}

/* ---- The parts of a result ---------------------------------------------------------------- */

/* Checks that the code fits the status. Otherwise a run could fail in its report and still succeed
 * by its exit code. */
static bool check_code(const struct reading *reading, const struct kiln_node *root,
                       const struct kiln_result *result)
{
    const struct kiln_node *code = kiln_node_entry(root, "code");
    bool good = result->status < KILN_TEST_NEW;
    return good == (result->code == KILN_OK) ||
           refuse(reading, code, "code",
                  good ? "0, because the status is not a failure"
                       : "a number other than 0, because the status is a failure");
}

/* Checks a command, and replaces it by one that is built anew. A report has it to copy, so whoever
 * made the result must not choose what a person types into a shell. */
static bool check_command(const struct reading *reading, const struct kiln_node *root,
                          const struct kiln_result *result, const char *key, const char **command)
{
    if (!**command)
        return true;
    *command = kiln_result_command(reading->arena, result, *command, reading->results,
                                   command == &result->approve);
    return *command || refuse(reading, kiln_node_entry(root, key), key,
                              "the command that kiln test writes for this test");
}

static bool check_commands(const struct reading *reading, const struct kiln_node *root,
                           struct kiln_result *result)
{
    return check_command(reading, root, result, "rerun", &result->rerun) &&
           check_command(reading, root, result, "approve", &result->approve);
}

static bool read_columns(const struct reading *reading, const struct kiln_node *root,
                         struct kiln_result *result)
{
    const struct kiln_node *list = find_list(reading, root, "columns", KILN_MAX_COLUMNS);
    if (!list)
        return false;
    for (const struct kiln_node *node = list->first; node; node = node->next) {
        struct kiln_compare_column *column = &result->columns[result->column_count++];
        if (!read_object(reading, node, kiln_result_column_members, column))
            return false;
    }
    return true;
}

static bool read_beyond(const struct reading *reading, const struct kiln_node *node,
                        const struct kiln_result *result, struct kiln_result_frame *frame)
{
    const struct kiln_node *beyond = kiln_node_entry(node, "beyond");
    if (!beyond || beyond->kind != KILN_NODE_LIST)
        return kiln_node_error(node, reading->error, "beyond: a list of metrics must be here");
    for (const struct kiln_node *entry = beyond->first; entry; entry = entry->next) {
        size_t i = 0;
        while (i < result->column_count &&
               !(is_text(entry) && strcmp(result->columns[i].name, entry->text) == 0))
            i++;
        if (i == result->column_count)
            return refuse(reading, entry, "beyond", "a metric of the columns");
        frame->beyond[i] = true;
    }
    return true;
}

static bool read_metrics(const struct reading *reading, const struct kiln_node *node,
                         const struct kiln_result *result, struct kiln_result_frame *frame)
{
    const struct kiln_node *metrics = kiln_node_entry(node, "metrics");
    if (!metrics || metrics->kind != KILN_NODE_MAP)
        return kiln_node_error(node, reading->error, "metrics: an object must be here");
    for (size_t i = 0; i < result->column_count; i++) {
        const char *name = result->columns[i].name;
        const struct kiln_node *value = kiln_node_entry(metrics, name);
        if (!value)
            return kiln_node_error(metrics, reading->error, "metrics: %s is missing", name);
        if (!read_double(reading, value, name, &frame->values[i]))
            return false;
    }
    return check_count(reading, metrics, (uint32_t)result->column_count);
}

static bool read_frame(const struct reading *reading, const struct kiln_node *node,
                       const struct kiln_result *result, struct kiln_result_frame *frame)
{
    uint32_t count = 0;
    if (!read_members(reading, node, kiln_result_frame_members, frame, &count))
        return false;
    if (frame->measured) {
        if (!read_members(reading, node, kiln_result_measured_members, frame, &count) ||
            !read_metrics(reading, node, result, frame) ||
            !read_beyond(reading, node, result, frame))
            return false;
        count += 2;
    }
    return check_count(reading, node, count);
}

static bool read_frames(const struct reading *reading, const struct kiln_node *root,
                        struct kiln_result *result)
{
    const struct kiln_node *list = find_list(reading, root, "frames", KILN_TEST_MAX_FRAMES);
    if (!list)
        return false;
    result->frames = allocate(reading, list->count, sizeof *result->frames);
    if (!result->frames)
        return false;
    for (const struct kiln_node *node = list->first; node; node = node->next) {
        struct kiln_result_frame *frame = &result->frames[result->frame_count];
        if (!read_frame(reading, node, result, frame))
            return false;
        if (result->frame_count++ > 0 && frame[-1].number >= frame->number)
            return kiln_node_error(node, reading->error,
                                   "frame %u comes after frame %u; frames must ascend",
                                   frame->number, frame[-1].number);
    }
    return true;
}

/* Reads a change. Versions up to 0.2 did not say where the new value comes from. */
static bool read_change(const struct reading *reading, const struct kiln_node *node,
                        struct kiln_result_change *change)
{
    const struct kiln_node *place = kiln_node_entry(node, "place");
    uint32_t count = place ? 1 : 0;
    change->place = "";
    return (!place || read_text(reading, place, "place", &change->place)) &&
           read_members(reading, node, kiln_result_change_members, change, &count) &&
           check_count(reading, node, count);
}

static bool read_changes(const struct reading *reading, const struct kiln_node *root,
                         struct kiln_result *result)
{
    const struct kiln_node *list = find_list(reading, root, "changes", KILN_RESULT_MAX_ENTRIES);
    if (!list)
        return false;
    result->changes = allocate(reading, list->count, sizeof *result->changes);
    if (!result->changes)
        return false;
    for (const struct kiln_node *node = list->first; node; node = node->next) {
        if (!read_change(reading, node, &result->changes[result->change_count++]))
            return false;
    }
    return true;
}

static bool read_notes(const struct reading *reading, const struct kiln_node *root,
                       struct kiln_result *result)
{
    const struct kiln_node *list = find_list(reading, root, "notes", KILN_RESULT_MAX_ENTRIES);
    if (!list)
        return false;
    result->notes = allocate(reading, list->count, sizeof *result->notes);
    if (!result->notes)
        return false;
    for (const struct kiln_node *node = list->first; node; node = node->next) {
        if (!read_text(reading, node, "notes", &result->notes[result->note_count++]))
            return false;
    }
    return true;
}

/* ---- The whole ---------------------------------------------------------------------------- */

static bool check_version(const struct reading *reading, const struct kiln_node *root)
{
    const struct kiln_node *version = kiln_node_entry(root, "kiln_result");
    uint64_t number = 0;
    if (!version)
        return kiln_node_error(root, reading->error,
                               "not the result of a test: \"kiln_result\" is missing");
    return (is_literal(version) && kiln_text_to_uint64(version->text, &number) &&
            number == KILN_RESULT_VERSION) ||
           refuse(reading, version, "kiln_result", "2, which this version of kiln writes");
}

static struct kiln_result *parse(const struct reading *reading, const char *text, size_t size,
                                 const char *name)
{
    struct kiln_origin *origin = kiln_arena_alloc(reading->arena, 1, sizeof *origin);
    struct kiln_result *result = kiln_arena_alloc(reading->arena, 1, sizeof *result);
    if (!origin || !result) {
        kiln_error_no_memory(reading->error, "reading a result");
        return NULL;
    }
    *origin = (struct kiln_origin){.name = name, .has_lines = true, .kind = "a result"};
    const struct kiln_node *root =
        kiln_node_parse(reading->arena, text, size, origin, reading->error);
    uint32_t count = 5; /* the version and the four lists */
    bool ok = root && check_version(reading, root) &&
              read_members(reading, root, kiln_result_members, result, &count) &&
              check_code(reading, root, result) && check_commands(reading, root, result) &&
              read_columns(reading, root, result) && read_frames(reading, root, result) &&
              read_changes(reading, root, result) && read_notes(reading, root, result) &&
              check_count(reading, root, count);
    return ok ? result : NULL;
}

struct kiln_result *kiln_result_parse(struct kiln_arena *arena, const char *text, size_t size,
                                      const char *name, struct kiln_error *error)
{
    return parse(&(struct reading){arena, error, NULL}, text, size, name);
}

/* Refuses the result of another test, which was moved here. */
static bool check_name(const struct kiln_result *result, const struct kiln_result_place *place,
                       const char *path, struct kiln_error *error)
{
    char found[64], expected[64];
    if (strcmp(result->name, place->name) == 0)
        return true;
    kiln_node_quote(found, result->name);
    kiln_node_quote(expected, place->name);
    return kiln_error_set(error, KILN_INVALID_INPUT,
                          "%s: the file has the result of '%s', but that of '%s' is expected", path,
                          found, expected);
}

struct kiln_result *kiln_result_read(struct kiln_arena *arena,
                                     const struct kiln_result_place *place,
                                     struct kiln_error *error)
{
    const struct kiln_result_file file = {.name = "result.json",
                                          .what = "result of a test",
                                          .allowed = "JSON",
                                          .limit = MAX_FILE_SIZE};
    char path[KILN_PATH_SIZE];
    size_t size = 0;
    const int opened = kiln_result_file_open(place, &file, path, &size, error);
    if (opened < 0 && error->code == KILN_IO)
        error->code = KILN_INVALID_INPUT;
    char *text = opened < 0 ? NULL
                            : kiln_text_file_take(opened, path, "the result of a test",
                                                  MAX_FILE_SIZE, &size, NULL, error);
    if (opened >= 0)
        close(opened);
    if (!text)
        return NULL;
    const struct reading reading = {arena, error, place->results};
    struct kiln_result *result = parse(&reading, text, size, path);
    free(text);
    return result && check_name(result, place, path, error) ? result : NULL;
}
