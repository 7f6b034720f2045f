/* Reads the lines of a journal into the records of a job. A line that is not valid is skipped. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/file.h"
#include "base/json.h"
#include "base/text.h"
#include "job/attempt.h"
#include "job/journal_file.h"

enum { MAX_SIZE = 1 << 30 };

static bool read_number(const struct kiln_node *node, uint64_t *number)
{
    return node && node->kind == KILN_NODE_SCALAR && kiln_text_to_uint64(node->text, number);
}

static bool read_state(const struct kiln_node *node, struct kiln_record *record)
{
    uint64_t lanes[2] = {0};
    if (!node || node->kind != KILN_NODE_SCALAR || strlen(node->text) < 18 || node->text[16] != ' ')
        return false;
    for (int i = 0; i < 16; i++) {
        static const char digits[] = "0123456789abcdef";
        const char *digit = strchr(digits, node->text[i]);
        if (!digit)
            return false;
        lanes[i / 8] = lanes[i / 8] << 4 | (uint64_t)(digit - digits);
    }
    record->state = (struct kiln_state_hash){{(uint32_t)lanes[0], (uint32_t)lanes[1]}};
    record->has_state = kiln_text_to_uint64(node->text + 17, &record->alive);
    return record->has_state;
}

/* Copies a line about a frame, or about the frames of a part, into their records. An invalid line
 * is skipped. */
static void read_frames(const struct kiln_node *line, struct kiln_records *records)
{
    const struct kiln_node *frames = kiln_node_entry(line, "frames");
    const struct kiln_node *sha256 = kiln_node_entry(line, "sha256");
    const struct kiln_node *states = kiln_node_entry(line, "states");
    uint64_t first, last, bytes;
    if (!frames || frames->count != 2 || !read_number(frames->first, &first) ||
        !read_number(frames->last, &last) || first > last ||
        last > records->clip[records->clip_count - 1].last ||
        !read_number(kiln_node_entry(line, "bytes"), &bytes) || !sha256 ||
        sha256->kind != KILN_NODE_SCALAR || strlen(sha256->text) != 64 || !states)
        return;
    struct kiln_record *record = kiln_records_of(records, (uint32_t)first);
    if (!record)
        return;
    /* Size and hash of a part's file are kept in the record of its first frame. */
    record->bytes = bytes;
    memcpy(record->sha256, sha256->text, 65);
    const struct kiln_record *end = records->items + records->count;
    for (const struct kiln_node *state = states->first; state && record < end; record++) {
        read_state(state, record);
        state = state->next;
    }
}

/* Copies a line about the clip's file. The last such line counts. */
static void read_clip(const struct kiln_journal *journal, const struct kiln_node *line,
                      struct kiln_records *records)
{
    const struct kiln_node *name = kiln_node_entry(line, "clip");
    const struct kiln_node *sha256 = kiln_node_entry(line, "sha256");
    const char *slash = strrchr(journal->path, '/');
    const int folder = slash ? (int)(slash - journal->path) + 1 : 0;
    char path[KILN_PATH_SIZE];
    struct kiln_finished_file finished = {.path = path, .is_clip = true};
    if (name->kind != KILN_NODE_SCALAR || !sha256 || sha256->kind != KILN_NODE_SCALAR ||
        strlen(sha256->text) != 64 ||
        !read_number(kiln_node_entry(line, "bytes"), &finished.bytes) ||
        snprintf(path, sizeof path, "%.*s%s", folder, journal->path, name->text) >= KILN_PATH_SIZE)
        return;
    memcpy(finished.sha256, sha256->text, 65);
    kiln_records_take(records, &finished);
}

/* Copies the description of a run into the records, unless they have it from a journal that was
 * taken over. */
static void read_run(const struct kiln_node *run, struct kiln_records *records)
{
    struct kiln_text copy = {0};
    struct kiln_json json = kiln_json_to_text(&copy);
    kiln_attempt_copy(&json, NULL, run);
    const bool is_known = records->runs.data && copy.data && strstr(records->runs.data, copy.data);
    if (run->kind == KILN_NODE_MAP && !is_known && !json.failed && !copy.failed)
        kiln_text_add(&records->runs, "%s%s", records->runs.length > 0 ? ",\n    " : "", copy.data);
    kiln_text_free(&copy);
}

bool kiln_journal_parse_line(struct kiln_arena *arena, const char *path, char *line,
                             const struct kiln_node **node, struct kiln_error *error)
{
    const struct kiln_origin origin = {.name = path, .kind = "a journal"};
    struct kiln_error reason = {0};
    *node = kiln_node_parse(arena, line, strlen(line), &origin, &reason);
    if (*node || reason.code != KILN_DEVICE_FAILED)
        return true;
    *error = reason;
    return false;
}

static bool says(const struct kiln_node *line, const char *key, const char *text)
{
    const struct kiln_node *node = kiln_node_entry(line, key);
    return node && kiln_node_is(node, text);
}

bool kiln_journal_check_head(const struct kiln_journal *journal, const struct kiln_node *line,
                             const struct kiln_journal_head *head, struct kiln_error *error)
{
    uint64_t version = 0;
    const char *other = NULL;
    if (!line || !read_number(kiln_node_entry(line, "kiln_journal"), &version))
        other = "the file is not a journal";
    else if (version != KILN_JOURNAL_VERSION)
        other = "the journal belongs to another version of kiln";
    else if (!says(line, "scene", head->output.scene_hash))
        other = "the journal belongs to another scene, or to this scene with other values or "
                "another size";
    else if (!says(line, "job", head->job))
        other = "the journal belongs to other frames, or to other settings of the output";
    if (other)
        return kiln_error_set(error, KILN_USAGE, "%s: %s (--force starts anew)", journal->path,
                              other);
    if (says(line, "made_by", head->made_by))
        return true;
    const struct kiln_node *made_by = kiln_node_entry(line, "made_by");
    /* KILN_IO: a scheduler may find the machine again that has begun the job. */
    return kiln_error_set(error, KILN_IO,
                          "%s: the output was begun by another program, device or techniques "
                          "(%.200s) than this job has (%s); --force starts anew",
                          journal->path,
                          made_by && made_by->kind == KILN_NODE_SCALAR ? made_by->text : "",
                          head->made_by);
}

/* Reads one line into the records. The first line must be the head of this job. */
static bool read_line(const struct kiln_journal *journal, const struct kiln_node *line,
                      const struct kiln_journal_head *head, bool is_first,
                      struct kiln_records *records, struct kiln_error *error)
{
    if (is_first)
        return kiln_journal_check_head(journal, line, head, error);
    if (line && (kiln_node_entry(line, "frame") || kiln_node_entry(line, "part")))
        read_frames(line, records);
    else if (line && kiln_node_entry(line, "clip"))
        read_clip(journal, line, records);
    else if (line && kiln_node_entry(line, "run"))
        read_run(kiln_node_entry(line, "run"), records);
    else if (line && kiln_node_entry(line, "anew"))
        records->anew = true;
    return true;
}

bool kiln_journal_read_lines(const struct kiln_journal *journal, char *text,
                             const struct kiln_journal_head *head, struct kiln_records *records,
                             size_t *first, size_t *length, struct kiln_error *error)
{
    bool ok = true;
    *first = *length = 0;
    for (char *line = text, *end; ok && (end = strchr(line, '\n')); line = end + 1) {
        struct kiln_arena *arena = kiln_arena_create();
        if (!arena)
            return kiln_error_no_memory(error, "%s", journal->path);
        *end = '\0';
        const struct kiln_node *node;
        ok = kiln_journal_parse_line(arena, journal->path, line, &node, error) &&
             read_line(journal, node, head, line == text, records, error);
        *end = '\n';
        kiln_arena_destroy(&arena);
        *length = (size_t)(end + 1 - text);
        *first = line == text ? *length : *first;
    }
    return ok;
}

char *kiln_journal_read_text(const struct kiln_journal *journal, struct kiln_error *error)
{
    static const char start[] = "{\"kiln_journal\"";
    size_t size = 0;
    char *text = kiln_text_file_read(journal->path, "a journal", MAX_SIZE, &size, error);
    const size_t compared = size < sizeof start - 1 ? size : sizeof start - 1;
    if (!text && error->code == KILN_INVALID_INPUT) /* of what nobody gave as an input */
        error->code = KILN_USAGE;
    if (!text || strncmp(text, start, compared) == 0)
        return text;
    kiln_error_set(error, KILN_USAGE, "%s: the file is not a journal (--force starts anew)",
                   journal->path);
    free(text);
    return NULL;
}

bool kiln_journal_has_head_alone(const char *text)
{
    const char *end = strchr(text, '\n');
    return !end || (!strchr(end + 1, '\n') && !strstr(text, KILN_JOURNAL_ANEW));
}
