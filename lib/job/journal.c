/* Opens, appends to and closes the journal of a job. Each line is appended with one write. A line
 * that a crash has cut off is ignored. */
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/json.h"
#include "base/temporary.h"
#include "base/text.h"
#include "job/journal_file.h"

static const double sync_s = 1.0;

bool kiln_journal_path(const char *output, struct kiln_shard shard, char path[KILN_PATH_SIZE],
                       struct kiln_error *error)
{
    char part[32] = "";
    if (shard.count > 0)
        snprintf(part, sizeof part, ".%u-of-%u", shard.index + 1, shard.count);
    if (snprintf(path, KILN_PATH_SIZE, "%s%s" KILN_JOURNAL_SUFFIX, output, part) >= KILN_PATH_SIZE)
        return kiln_error_set(error, KILN_USAGE, "%.200s...: the path is longer than %d bytes",
                              output, KILN_PATH_SIZE - 1);
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const size_t length = strlen(name);
    return length <= NAME_MAX ||
           kiln_error_set(error, KILN_USAGE,
                          "%.200s...: with \"%s" KILN_JOURNAL_SUFFIX
                          "\" for the journal, the name has %zu bytes; allowed are %d",
                          output, part, length, NAME_MAX);
}

/* ---- writing --------------------------------------------------------------------------------- */

bool kiln_journal_append(struct kiln_journal *journal, const char *bytes, size_t size, bool sync,
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
    const bool ok = made ? kiln_journal_append(journal, line->data, line->length, sync, error)
                         : kiln_error_no_memory(error, "%s", journal->path);
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

/* Returns the path of a file relative to the folder of the journal. */
static const char *name_of(const struct kiln_journal *journal, const char *path)
{
    const char *slash = strrchr(journal->path, '/');
    const size_t folder = slash ? (size_t)(slash - journal->path) + 1 : 0;
    return strncmp(path, journal->path, folder) == 0 ? path + folder : path;
}

bool kiln_journal_add(struct kiln_journal *journal, const struct kiln_records *records,
                      const struct kiln_finished_file *finished, struct kiln_error *error)
{
    struct kiln_text line = {0};
    struct kiln_json json = kiln_json_to_text(&line);
    kiln_json_begin_object(&json, NULL);
    kiln_json_string(&json,
                     finished->is_clip   ? "clip"
                     : finished->is_part ? "part"
                                         : "frame",
                     name_of(journal, finished->path));
    if (!finished->is_clip)
        kiln_json_pair(&json, "frames", finished->frames.first, finished->frames.last);
    kiln_json_uint(&json, "bytes", finished->bytes);
    kiln_json_string(&json, "sha256", finished->sha256);
    if (!finished->is_clip) {
        kiln_json_begin_array(&json, "states");
        for (uint64_t frame = finished->frames.first; frame <= finished->frames.last; frame++) {
            const struct kiln_record *record = kiln_records_of(records, (uint32_t)frame);
            if (record)
                add_state(&json, record);
        }
        kiln_json_end(&json);
    }
    return append(journal, &json, &line, finished->is_part || finished->is_clip, error);
}

bool kiln_journal_add_attempt(struct kiln_journal *journal, const struct kiln_attempt *run,
                              const struct kiln_render_stats *stats,
                              const struct kiln_error *failure, struct kiln_error *error)
{
    struct kiln_text line = {0};
    struct kiln_json json = kiln_json_to_text(&line);
    kiln_json_begin_object(&json, NULL);
    kiln_json_begin_object(&json, "run");
    kiln_attempt_describe(&json, run, stats, failure);
    kiln_json_end(&json);
    return append(journal, &json, &line, true, error);
}

/* ---- opening --------------------------------------------------------------------------------- */

/* Returns whether the file still has its name. The process that had it locked before may have
 * removed it. */
static bool has_its_name(const struct kiln_journal *journal)
{
    struct stat own, named;
    return fstat(journal->file, &own) != 0 ||
           (stat(journal->path, &named) == 0 && own.st_ino == named.st_ino &&
            own.st_dev == named.st_dev);
}

bool kiln_journal_open_file(struct kiln_journal *journal, int flags, int lock,
                            struct kiln_error *error)
{
    enum { ATTEMPTS = 100 };
    journal->synced_s = kiln_clock_seconds();
    for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
        journal->file = open(journal->path,
                             O_RDWR | O_APPEND | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | flags, 0666);
        if (journal->file < 0)
            return kiln_error_set_errno(error, KILN_IO, errno, "%s: the journal cannot be opened",
                                        journal->path);
        if (flock(journal->file, lock | LOCK_NB) != 0 && errno == EWOULDBLOCK)
            break;
        if (has_its_name(journal))
            return true;
        close(journal->file);
        journal->file = -1;
    }
    return kiln_error_set(error, KILN_IO,
                          "%s: another process is writing this output: it has the journal",
                          journal->path);
}

static bool read_journal(const struct kiln_journal *journal, const struct kiln_journal_head *head,
                         struct kiln_records *records, bool *found, struct kiln_error *error)
{
    size_t first, length = 0;
    char *text = kiln_journal_read_text(journal, error);
    if (!text)
        return false;
    /* the journal lists no file, so it may be of another job */
    if (kiln_journal_has_head_alone(text)) {
        free(text);
        return ftruncate(journal->file, 0) == 0 ||
               kiln_error_set_errno(error, KILN_IO, errno, "%s: the journal cannot be written",
                                    journal->path);
    }
    const bool ok = kiln_journal_read_lines(journal, text, head, records, &first, &length, error);
    free(text);
    *found = length > 0;
    return ok && (ftruncate(journal->file, (off_t)length) == 0 ||
                  kiln_error_set_errno(error, KILN_IO, errno, "%s: the journal cannot be written",
                                       journal->path));
}

struct kiln_journal *kiln_journal_open(const struct kiln_journal_head *head,
                                       struct kiln_shard shard, bool restart,
                                       struct kiln_records *records, bool *found,
                                       struct kiln_error *error)
{
    struct kiln_journal *journal = calloc(1, sizeof *journal);
    *found = false;
    if (!journal) {
        kiln_error_no_memory(error, "%s", head->output.path);
        return NULL;
    }
    journal->file = -1;
    pthread_mutex_init(&journal->mutex, NULL);
    bool ok = kiln_journal_path(head->output.path, shard, journal->path, error) &&
              kiln_make_parent_folders(journal->path, error) &&
              kiln_journal_open_file(journal, O_CREAT, LOCK_EX, error);
    if (ok && restart)
        ok = ftruncate(journal->file, 0) == 0 ||
             kiln_error_set_errno(error, KILN_IO, errno, "%s: the journal cannot be written",
                                  journal->path);
    else if (ok)
        ok = read_journal(journal, head, records, found, error);
    if (ok && !*found)
        ok = write_head(journal, head, error) &&
             (!restart || kiln_journal_append(journal, KILN_JOURNAL_ANEW, strlen(KILN_JOURNAL_ANEW),
                                              false, error));
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
