/* Lines are appended with one write each. A line that a crash has cut off is forgotten. */
#include "job/journal.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/file.h"
#include "base/json.h"
#include "base/temporary.h"
#include "base/text.h"
#include "option/node.h"

#define SUFFIX ".journal"
#define ANEW   "{\"anew\": true}\n"

enum { MAX_SIZE = 1 << 30 };

static const double sync_s = 1.0;

struct kiln_journal {
    char path[KILN_PATH_SIZE];
    int file;
    pthread_mutex_t mutex; /* of what follows, and of the end of the file */
    double synced_s;
    bool unsynced;
};

bool kiln_journal_path(const char *output, struct kiln_shard shard, char path[KILN_PATH_SIZE],
                       struct kiln_error *error)
{
    char part[32] = "";
    if (shard.count > 0)
        snprintf(part, sizeof part, ".%u-of-%u", shard.index + 1, shard.count);
    return snprintf(path, KILN_PATH_SIZE, "%s%s" SUFFIX, output, part) < KILN_PATH_SIZE ||
           kiln_error_set(error, KILN_IO, "%.200s...: the path is longer than %d bytes", output,
                          KILN_PATH_SIZE - 1);
}

/* ---- writing --------------------------------------------------------------------------------- */

static bool append_bytes(struct kiln_journal *journal, const char *bytes, size_t size, bool sync,
                         struct kiln_error *error)
{
    bool ok = true;
    pthread_mutex_lock(&journal->mutex);
    for (size_t done = 0; ok && done < size;) {
        const ssize_t count = write(journal->file, bytes + done, size - done);
        if (count < 0 && errno != EINTR)
            ok = kiln_error_set_errno(error, KILN_IO, errno, "%s: the journal cannot be written",
                                      journal->path);
        done += count > 0 ? (size_t)count : 0;
    }
    journal->unsynced = true;
    const double now_s = kiln_clock_seconds();
    if (ok && (sync || now_s - journal->synced_s >= sync_s)) {
        fdatasync(journal->file);
        journal->synced_s = now_s;
        journal->unsynced = false;
    }
    pthread_mutex_unlock(&journal->mutex);
    return ok;
}

/* Ends the line and appends it. */
static bool append(struct kiln_journal *journal, struct kiln_json *json, struct kiln_text *line,
                   bool sync, struct kiln_error *error)
{
    kiln_json_end(json);
    const bool made = kiln_json_finish(json) && !line->failed;
    const bool ok =
        made ? append_bytes(journal, line->data, line->length, sync, error)
             : kiln_error_set(error, KILN_DEVICE_FAILED, "%s: out of memory", journal->path);
    kiln_text_free(line);
    return ok;
}

static bool write_head(struct kiln_journal *journal, const struct kiln_journal_head *head,
                       struct kiln_error *error)
{
    struct kiln_text line = {0};
    struct kiln_json json = kiln_json_to_text(&line);
    kiln_json_begin_object(&json, NULL);
    kiln_journal_head_write(&json, head);
    return append(journal, &json, &line, false, error);
}

static void add_state(struct kiln_json *json, const struct kiln_record *record)
{
    kiln_json_format(json, NULL, "%08x%08x %" PRIu64, record->state.lane[0], record->state.lane[1],
                     record->alive);
}

/* The name of a file as seen from the folder of the journal. */
static const char *name_of(const struct kiln_journal *journal, const char *path)
{
    const char *slash = strrchr(journal->path, '/');
    const size_t folder = slash ? (size_t)(slash - journal->path) + 1 : 0;
    return strncmp(path, journal->path, folder) == 0 ? path + folder : path;
}

bool kiln_journal_add(struct kiln_journal *journal, const struct kiln_records *records,
                      const struct kiln_whole *whole, struct kiln_error *error)
{
    struct kiln_text line = {0};
    struct kiln_json json = kiln_json_to_text(&line);
    kiln_json_begin_object(&json, NULL);
    kiln_json_string(&json,
                     whole->is_clip   ? "clip"
                     : whole->is_part ? "part"
                                      : "frame",
                     name_of(journal, whole->path));
    if (!whole->is_clip)
        kiln_json_pair(&json, "frames", whole->frames.first, whole->frames.last);
    kiln_json_uint(&json, "bytes", whole->bytes);
    kiln_json_string(&json, "sha256", whole->sha256);
    if (!whole->is_clip) {
        kiln_json_begin_array(&json, "states");
        for (uint64_t frame = whole->frames.first; frame <= whole->frames.last; frame++) {
            const struct kiln_record *record = kiln_records_of(records, (uint32_t)frame);
            if (record)
                add_state(&json, record);
        }
        kiln_json_end(&json);
    }
    return append(journal, &json, &line, whole->is_part || whole->is_clip, error);
}

/* ---- reading --------------------------------------------------------------------------------- */

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

/* Takes what a line says of a frame, or of the frames of a part; one that makes no sense is passed
 * over. */
static void read_frames(const struct kiln_node *line, bool is_part, struct kiln_records *records)
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
    const struct kiln_node *state = states->first;
    for (uint64_t frame = first; frame <= last && state; frame++) {
        struct kiln_record *record = kiln_records_of(records, (uint32_t)frame);
        if (!record)
            continue;
        read_state(state, record);
        state = state->next;
        /* The record of a part's first frame has what is known of the file. */
        if (!is_part || frame == first) {
            record->bytes = bytes;
            memcpy(record->sha256, sha256->text, 65);
        }
    }
}

/* The last that is said of a file counts. */
static void read_clip(const struct kiln_journal *journal, const struct kiln_node *line,
                      struct kiln_records *records)
{
    const struct kiln_node *name = kiln_node_entry(line, "clip");
    const struct kiln_node *sha256 = kiln_node_entry(line, "sha256");
    const char *slash = strrchr(journal->path, '/');
    const int folder = slash ? (int)(slash - journal->path) + 1 : 0;
    char path[KILN_PATH_SIZE];
    struct kiln_whole whole = {.path = path, .is_clip = true};
    if (name->kind != KILN_NODE_SCALAR || !sha256 || sha256->kind != KILN_NODE_SCALAR ||
        strlen(sha256->text) != 64 || !read_number(kiln_node_entry(line, "bytes"), &whole.bytes) ||
        snprintf(path, sizeof path, "%.*s%s", folder, journal->path, name->text) >= KILN_PATH_SIZE)
        return;
    memcpy(whole.sha256, sha256->text, 65);
    kiln_records_take(records, &whole);
}

/* *node becomes NULL where a line makes no sense. False when memory was too short to say. */
static bool parse_line(struct kiln_arena *arena, const char *path, char *line,
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

/* That a journal is of this job. */
static bool check_head(const struct kiln_journal *journal, const struct kiln_node *line,
                       const struct kiln_journal_head *head, struct kiln_error *error)
{
    uint64_t version = 0;
    const char *other = NULL;
    if (!line || !read_number(kiln_node_entry(line, "kiln_journal"), &version))
        other = "is not a journal";
    else if (version != KILN_JOURNAL_VERSION)
        other = "is a journal of another version of kiln";
    else if (!says(line, "scene", head->output.scene_hash))
        other = "is the journal of another scene";
    else if (!says(line, "job", head->job))
        other = "is the journal of other frames, or other settings of the output";
    if (other)
        return kiln_error_set(error, KILN_IO, "%s: %s (--force starts anew)", journal->path, other);
    if (says(line, "made_by", head->made_by))
        return true;
    const struct kiln_node *made_by = kiln_node_entry(line, "made_by");
    return kiln_error_set(
        error, KILN_IO,
        "%s: was begun by another program, device or techniques (%.200s), this is "
        "%s; --force starts anew",
        journal->path, made_by && made_by->kind == KILN_NODE_SCALAR ? made_by->text : "",
        head->made_by);
}

/* Takes what a line says; the first line has to be the head of this job. */
static bool read_line(const struct kiln_journal *journal, const struct kiln_node *line,
                      const struct kiln_journal_head *head, bool is_first,
                      struct kiln_records *records, struct kiln_error *error)
{
    if (is_first)
        return check_head(journal, line, head, error);
    if (line && kiln_node_entry(line, "frame"))
        read_frames(line, false, records);
    else if (line && kiln_node_entry(line, "part"))
        read_frames(line, true, records);
    else if (line && kiln_node_entry(line, "clip"))
        read_clip(journal, line, records);
    else if (line && kiln_node_entry(line, "anew"))
        records->anew = true;
    return true;
}

/* Reads all whole lines; *length gets where the last one ends, *first where the first one does. */
static bool read_lines(const struct kiln_journal *journal, char *text,
                       const struct kiln_journal_head *head, struct kiln_records *records,
                       size_t *first, size_t *length, struct kiln_error *error)
{
    bool ok = true;
    *first = *length = 0;
    for (char *line = text, *end; ok && (end = strchr(line, '\n')); line = end + 1) {
        struct kiln_arena *arena = kiln_arena_create();
        if (!arena)
            return kiln_error_set(error, KILN_DEVICE_FAILED, "%s: out of memory", journal->path);
        *end = '\0';
        const struct kiln_node *node;
        ok = parse_line(arena, journal->path, line, &node, error) &&
             read_line(journal, node, head, line == text, records, error);
        *end = '\n';
        kiln_arena_destroy(&arena);
        *length = (size_t)(end + 1 - text);
        *first = line == text ? *length : *first;
    }
    return ok;
}

/* The text of a journal, which the caller frees; NULL with an error when it is something else. */
static char *read_text(const struct kiln_journal *journal, struct kiln_error *error)
{
    static const char start[] = "{\"kiln_journal\"";
    size_t size = 0;
    char *text = kiln_text_file_read(journal->path, "a journal", MAX_SIZE, &size, error);
    const size_t compared = size < sizeof start - 1 ? size : sizeof start - 1;
    if (!text && error->code == KILN_INVALID_INPUT) /* of what nobody gave as an input */
        error->code = KILN_IO;
    if (!text || strncmp(text, start, compared) == 0)
        return text;
    kiln_error_set(error, KILN_IO, "%s: is not a journal (--force starts anew)", journal->path);
    free(text);
    return NULL;
}

/* Whether there is no whole line behind the first, and that one does not say that what is there is
 * forgotten. */
static bool has_head_alone(const char *text)
{
    const char *end = strchr(text, '\n');
    return !end || (!strchr(end + 1, '\n') && !strstr(text, ANEW));
}

static bool read_journal(const struct kiln_journal *journal, const struct kiln_journal_head *head,
                         struct kiln_records *records, bool *found, struct kiln_error *error)
{
    size_t first, length = 0;
    char *text = read_text(journal, error);
    if (!text)
        return false;
    if (has_head_alone(text)) { /* nothing came of it, and it may be of another job */
        free(text);
        return ftruncate(journal->file, 0) == 0 ||
               kiln_error_set_errno(error, KILN_IO, errno, "%s: the journal cannot be written",
                                    journal->path);
    }
    const bool ok = read_lines(journal, text, head, records, &first, &length, error);
    free(text);
    *found = length > 0;
    return ok && (ftruncate(journal->file, (off_t)length) == 0 ||
                  kiln_error_set_errno(error, KILN_IO, errno, "%s: the journal cannot be written",
                                       journal->path));
}

/* ---- opening --------------------------------------------------------------------------------- */

static bool open_file(struct kiln_journal *journal, int flags, struct kiln_error *error)
{
    journal->synced_s = kiln_clock_seconds();
    journal->file =
        open(journal->path, O_RDWR | O_APPEND | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | flags, 0666);
    if (journal->file < 0)
        return kiln_error_set_errno(error, KILN_IO, errno, "%s: the journal cannot be opened",
                                    journal->path);
    return flock(journal->file, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK ||
           kiln_error_set(error, KILN_IO,
                          "%s: another process is writing this output: it has the journal",
                          journal->path);
}

struct kiln_journal *kiln_journal_open(const struct kiln_journal_head *head,
                                       struct kiln_shard shard, bool restart,
                                       struct kiln_records *records, bool *found,
                                       struct kiln_error *error)
{
    struct kiln_journal *journal = calloc(1, sizeof *journal);
    *found = false;
    if (!journal) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "%s: out of memory", head->output.path);
        return NULL;
    }
    journal->file = -1;
    pthread_mutex_init(&journal->mutex, NULL);
    bool ok = kiln_journal_path(head->output.path, shard, journal->path, error) &&
              kiln_make_parent_folders(journal->path, error) && open_file(journal, O_CREAT, error);
    if (ok && restart)
        ok = ftruncate(journal->file, 0) == 0 ||
             kiln_error_set_errno(error, KILN_IO, errno, "%s: the journal cannot be written",
                                  journal->path);
    else if (ok)
        ok = read_journal(journal, head, records, found, error);
    if (ok && !*found)
        ok = write_head(journal, head, error) &&
             (!restart || append_bytes(journal, ANEW, strlen(ANEW), false, error));
    if (ok && restart)
        records->anew = true;
    if (!ok)
        kiln_journal_close(&journal);
    return journal;
}

void kiln_journal_close(struct kiln_journal **journal)
{
    struct kiln_journal *j = *journal;
    if (!j)
        return;
    if (j->file >= 0 && j->unsynced)
        fdatasync(j->file);
    if (j->file >= 0)
        close(j->file);
    pthread_mutex_destroy(&j->mutex);
    free(j);
    *journal = NULL;
}

void kiln_journal_remove(struct kiln_journal **journal)
{
    if (*journal)
        unlink((*journal)->path);
    kiln_journal_close(journal);
}

/* ---- shards ---------------------------------------------------------------------------------- */

/* "clip.mp4.2-of-4.journal" for the output "clip.mp4", or "clip.mp4.journal". */
static bool is_journal_of(const char *name, const char *output, bool *is_shard)
{
    static const char digits[] = "0123456789";
    const size_t length = strlen(output);
    if (strncmp(name, output, length) != 0)
        return false;
    name += length;
    *is_shard = strcmp(name, SUFFIX) != 0;
    if (!*is_shard)
        return true;
    size_t count = *name == '.' ? strspn(name + 1, digits) : 0;
    if (count == 0 || strncmp(name + 1 + count, "-of-", 4) != 0)
        return false;
    name += 1 + count + 4;
    count = strspn(name, digits);
    return count > 0 && strcmp(name + count, SUFFIX) == 0;
}

/* Visits the journals beside an output until one visit is false. */
static bool visit_journals(const char *output,
                           bool (*visit)(void *user, const char *path, bool is_shard,
                                         struct kiln_error *error),
                           void *user, struct kiln_error *error)
{
    char folder[KILN_PATH_SIZE];
    const char *slash = strrchr(output, '/');
    const int before = slash ? (int)(slash - output) + 1 : 0;
    struct dirent **entries = NULL;
    snprintf(folder, sizeof folder, "%.*s.", before, output);
    const int count = scandir(folder, &entries, NULL, alphasort);
    bool ok =
        count >= 0 || errno != ENOMEM || kiln_error_set_errno(error, KILN_IO, errno, "%s", folder);
    for (int i = 0; i < count; i++) {
        char path[KILN_PATH_SIZE];
        bool is_shard;
        if (ok && is_journal_of(entries[i]->d_name, output + before, &is_shard) &&
            snprintf(path, sizeof path, "%.*s%s", before, output, entries[i]->d_name) <
                KILN_PATH_SIZE)
            ok = visit(user, path, is_shard, error);
        free(entries[i]);
    }
    free(entries);
    return ok;
}

/* A journal that takes others over. */
struct merging {
    struct kiln_journal *into;
    const struct kiln_journal_head *head;
    struct kiln_records *records;
    bool keep, found;
};

static bool take_over(void *user, const char *path, bool is_shard, struct kiln_error *error)
{
    struct merging *merging = user;
    struct kiln_journal shard = {.file = -1};
    if (!is_shard)
        return true;
    merging->found = true;
    snprintf(shard.path, sizeof shard.path, "%s", path);
    char *text = open_file(&shard, 0, error) ? read_text(&shard, error) : NULL;
    size_t first, length;
    const bool ok =
        text && read_lines(&shard, text, merging->head, merging->records, &first, &length, error) &&
        (merging->keep || append_bytes(merging->into, text + first, length - first, true, error));
    if (ok && !merging->keep)
        unlink(path);
    free(text);
    if (shard.file >= 0)
        close(shard.file);
    return ok;
}

bool kiln_journal_merge(struct kiln_journal *journal, const struct kiln_journal_head *head,
                        bool keep, struct kiln_records *records, bool *found,
                        struct kiln_error *error)
{
    struct merging merging = {.into = journal, .head = head, .records = records, .keep = keep};
    const bool ok = visit_journals(head->output.path, take_over, &merging, error);
    *found = *found || merging.found;
    return ok;
}

/* A head that is looked for. */
struct finding {
    struct kiln_journal_head *head;
    const char *output;
    struct kiln_arena *arena;
    bool found;
};

static bool read_head(void *user, const char *path, bool is_shard, struct kiln_error *error)
{
    struct finding *finding = user;
    struct kiln_journal journal = {.file = -1};
    (void)is_shard;
    snprintf(journal.path, sizeof journal.path, "%s", path);
    char *text = read_text(&journal, error);
    char *end = text ? strchr(text, '\n') : NULL;
    if (end)
        *end = '\0';
    const struct kiln_node *line = NULL;
    bool ok = text && (!end || parse_line(finding->arena, path, text, &line, error));
    if (line) {
        ok = kiln_journal_head_read(finding->head, path, finding->output, line, finding->arena,
                                    error);
        finding->found = ok;
    }
    free(text);
    return ok && !finding->found; /* one is enough: others are compared with it */
}

bool kiln_journal_find(const char *output, struct kiln_journal_head *head, struct kiln_arena *arena,
                       struct kiln_error *error)
{
    struct finding finding = {.head = head, .output = output, .arena = arena};
    const bool none = visit_journals(output, read_head, &finding, error);
    if (none)
        kiln_error_set(error, KILN_IO,
                       "%s: has no journal beside it: no job with --resume or --shard has begun it",
                       output);
    return finding.found;
}
