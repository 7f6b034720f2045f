/* Finds, merges and removes the journals of one output: that of the whole job, and those of its
 * shards. */
#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

#include "base/error.h"
#include "job/journal_file.h"

/* Returns whether a file name is that of a journal of the output: for "clip.mp4" that is
 * "clip.mp4.journal" or, of a shard, "clip.mp4.2-of-4.journal". */
static bool is_journal_of(const char *name, const char *output, bool *is_shard)
{
    static const char digits[] = "0123456789";
    const size_t length = strlen(output);
    if (strncmp(name, output, length) != 0)
        return false;
    name += length;
    *is_shard = strcmp(name, KILN_JOURNAL_SUFFIX) != 0;
    if (!*is_shard)
        return true;
    size_t count = *name == '.' ? strspn(name + 1, digits) : 0;
    if (count == 0 || strncmp(name + 1 + count, "-of-", 4) != 0)
        return false;
    name += 1 + count + 4;
    count = strspn(name, digits);
    return count > 0 && strcmp(name + count, KILN_JOURNAL_SUFFIX) == 0;
}

/* Calls `visit` for each journal beside an output until one call returns false. */
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

/* Opens and reads an existing journal. The caller frees the text and closes the file; after a
 * failure the text is NULL and the file must still be closed. */
static char *open_beside(struct kiln_journal *beside, const char *path, int lock,
                         struct kiln_error *error)
{
    *beside = (struct kiln_journal){.file = -1};
    snprintf(beside->path, sizeof beside->path, "%s", path);
    return kiln_journal_open_file(beside, 0, lock, error) ? kiln_journal_read_text(beside, error)
                                                          : NULL;
}

static void close_beside(struct kiln_journal *beside, char *text)
{
    free(text);
    if (beside->file >= 0)
        close(beside->file);
}

/* The state of a merge: a journal takes the lines of other journals over. */
struct merging {
    struct kiln_journal *into; /* NULL: the journals are read and not removed */
    const struct kiln_journal_head *head;
    struct kiln_records *records;
    bool found;
};

static bool take_over(void *user, const char *path, bool is_shard, struct kiln_error *error)
{
    struct merging *merging = user;
    struct kiln_journal shard;
    if (!is_shard)
        return true;
    merging->found = true;
    char *text = open_beside(&shard, path, LOCK_EX, error);
    size_t first, length;
    const bool ok = text &&
                    kiln_journal_read_lines(&shard, text, merging->head, merging->records, &first,
                                            &length, error) &&
                    (!merging->into ||
                     kiln_journal_append(merging->into, text + first, length - first, true, error));
    if (ok && merging->into)
        unlink(path);
    close_beside(&shard, text);
    return ok;
}

bool kiln_journal_merge(struct kiln_journal *journal, const struct kiln_journal_head *head,
                        bool keep, struct kiln_records *records, bool *found,
                        struct kiln_error *error)
{
    struct merging merging = {.head = head, .records = records};
    /* All journals are checked before one is removed, so that a refusal loses nothing. */
    if (!visit_journals(head->output.path, take_over, &merging, error))
        return false;
    *found = *found || merging.found;
    merging.into = journal;
    return keep || visit_journals(head->output.path, take_over, &merging, error);
}

/* Reads the first line of a journal into the arena, even if another process has the file locked.
 * NULL when there is no line or it is invalid. *alone becomes true when the journal lists no
 * file. */
static bool read_first(const char *path, struct kiln_arena *arena, const struct kiln_node **line,
                       bool *alone, struct kiln_error *error)
{
    struct kiln_journal journal = {.file = -1};
    snprintf(journal.path, sizeof journal.path, "%s", path);
    *line = NULL;
    char *text = kiln_journal_read_text(&journal, error);
    if (!text)
        return false;
    *alone = kiln_journal_has_head_alone(text);
    const char *end = strchr(text, '\n');
    char *first = end ? kiln_arena_text(arena, text, (size_t)(end - text)) : NULL;
    free(text);
    if (!end)
        return true;
    return first ? kiln_journal_parse_line(arena, path, first, line, error)
                 : kiln_error_no_memory(error, "%s", path);
}

/* The state of a shard's look at the journals beside its own. */
struct neighbours {
    const struct kiln_journal *own;
    const struct kiln_journal_head *head;
    struct kiln_records *records;
    bool found;
};

static bool look_at(void *user, const char *path, bool is_shard, struct kiln_error *error)
{
    struct neighbours *neighbours = user;
    struct kiln_journal beside = {.file = -1};
    if (strcmp(path, neighbours->own->path) == 0)
        return true;
    snprintf(beside.path, sizeof beside.path, "%s", path);
    if (!is_shard) {
        size_t first, length = 0;
        char *text = open_beside(&beside, path, LOCK_SH, error);
        const bool ok =
            text && (kiln_journal_has_head_alone(text) ||
                     kiln_journal_read_lines(&beside, text, neighbours->head, neighbours->records,
                                             &first, &length, error));
        neighbours->found |= length > 0;
        close_beside(&beside, text);
        return ok;
    }
    struct kiln_arena *arena = kiln_arena_create();
    const struct kiln_node *line;
    bool alone;
    const bool ok =
        arena ? read_first(path, arena, &line, &alone, error) &&
                    (alone || kiln_journal_check_head(&beside, line, neighbours->head, error))
              : kiln_error_no_memory(error, "%s", path);
    kiln_arena_destroy(&arena);
    return ok;
}

bool kiln_journal_look_around(const struct kiln_journal *journal,
                              const struct kiln_journal_head *head, struct kiln_records *records,
                              bool *found, struct kiln_error *error)
{
    struct neighbours neighbours = {.own = journal, .head = head, .records = records};
    const bool ok = visit_journals(head->output.path, look_at, &neighbours, error);
    *found = *found || neighbours.found;
    return ok;
}

/* Removes a journal if `*user` is true; else only checks that no process has it locked. */
static bool forget(void *user, const char *path, bool is_shard, struct kiln_error *error)
{
    const bool *removes = user;
    struct kiln_journal journal = {.file = -1};
    (void)is_shard;
    snprintf(journal.path, sizeof journal.path, "%s", path);
    const bool ok = kiln_journal_open_file(&journal, 0, LOCK_EX, error);
    if (ok && *removes)
        unlink(path);
    close_beside(&journal, NULL);
    return ok;
}

bool kiln_journal_forget(const char *output, struct kiln_error *error)
{
    bool removes = false;
    if (!visit_journals(output, forget, &removes, error))
        return false;
    removes = true;
    return visit_journals(output, forget, &removes, error);
}

/* Copies the path of the first journal. */
static bool note_path(void *user, const char *path, bool is_shard, struct kiln_error *error)
{
    (void)is_shard;
    (void)error;
    snprintf(user, KILN_PATH_SIZE, "%s", path);
    return false;
}

bool kiln_journal_is_there(const char *output, char path[KILN_PATH_SIZE])
{
    struct kiln_error ignored = {0};
    *path = '\0';
    visit_journals(output, note_path, path, &ignored);
    return *path != '\0';
}

/* The state of a search for the head of an output's journal. */
struct finding {
    struct kiln_journal_head *head;
    const char *output;
    struct kiln_arena *arena;
    bool found;
};

static bool read_head(void *user, const char *path, bool is_shard, struct kiln_error *error)
{
    struct finding *finding = user;
    const struct kiln_node *line;
    bool alone;
    (void)is_shard;
    if (!read_first(path, finding->arena, &line, &alone, error))
        return false;
    finding->found = line && kiln_journal_head_read(finding->head, path, finding->output, line,
                                                    finding->arena, error);
    return !line; /* stop at the first: the others are compared with it */
}

bool kiln_journal_find(const char *output, struct kiln_journal_head *head, struct kiln_arena *arena,
                       struct kiln_error *error)
{
    struct finding finding = {.head = head, .output = output, .arena = arena};
    const bool none = visit_journals(output, read_head, &finding, error);
    if (none)
        kiln_error_set(
            error, KILN_IO,
            "%s: the output has no journal: no job with --resume or --shard has begun it", output);
    return finding.found;
}
