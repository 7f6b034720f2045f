/* Finds out which files of a job are whole, so that a run draws only the missing frames. A file
 * counts when it has the hash that the journal says, or when it names its own scene and frame. */
#include "job/resume.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "output/formats.h"
#include "output/part.h"

/* ---- looking at files ------------------------------------------------------------------------ */

/* Returns whether a file has this size and hash. *reason is filled where it cannot be read. */
static bool is_same(const char *path, uint64_t bytes, const char *sha256, struct kiln_error *reason)
{
    struct kiln_finished_file finished = {.path = path};
    struct stat status;
    return bytes > 0 && stat(path, &status) == 0 && S_ISREG(status.st_mode) &&
           (uint64_t)status.st_size == bytes && kiln_finished_file_measure(&finished, reason) &&
           strcmp(finished.sha256, sha256) == 0;
}

/* Returns false when memory was too short to look at a file: it may be whole, so the job ends with
 * that error. */
static bool could_look(const struct kiln_error *reason, struct kiln_error *error)
{
    if (reason->code != KILN_DEVICE_FAILED)
        return true;
    *error = *reason;
    return false;
}

static bool is_there(const char *path)
{
    struct stat status;
    return lstat(path, &status) == 0;
}

static bool is_file(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISREG(status.st_mode);
}

/* Records a whole file that the journal does not name. */
static bool adopt(struct kiln_resume *resume, const char *path, uint32_t frame,
                  struct kiln_error *error)
{
    struct kiln_finished_file finished = {.path = path, .frames = {frame, frame}};
    if (!kiln_finished_file_measure(&finished, error))
        return false;
    kiln_records_take(resume->records, &finished);
    return true;
}

/* Looks at the image of a frame. found: there was a journal, so a file of this name is the job's
 * own and may be replaced. */
static bool look_at_image(struct kiln_resume *resume, uint32_t frame, const char *path, bool found,
                          struct kiln_error *error)
{
    struct kiln_record *record = kiln_records_of(resume->records, frame);
    struct kiln_error reason = {0};
    if (is_same(path, record->bytes, record->sha256, &reason)) {
        record->whole = true;
        return true;
    }
    if (!could_look(&reason, error))
        return false;
    *record = (struct kiln_record){.has_state = false};
    if (!is_there(path))
        return true;
    if (!resume->records->anew && is_file(path) &&
        kiln_output_carries(&resume->output, path, frame, &reason))
        return adopt(resume, path, frame, error);
    if (!could_look(&reason, error))
        return false;
    return found ||
           kiln_error_set(
               error, KILN_USAGE,
               "%s: the file exists, and is not a whole frame %u of this job (--force replaces it)",
               path, frame);
}

static bool look_at_images(struct kiln_resume *resume, bool found, struct kiln_error *error)
{
    const struct kiln_records *records = resume->records;
    for (uint32_t i = 0; i < records->count; i++) {
        char path[KILN_PATH_SIZE];
        const uint32_t frame = kiln_records_frame(records, i);
        if (records->items[i].is_others)
            continue;
        if (!kiln_output_file(&resume->output, frame, path, error) ||
            !kiln_may_go_on(&resume->output.caller, error) ||
            !look_at_image(resume, frame, path, found, error))
            return false;
    }
    return true;
}

/* Marks the frames of a part as whole, or clears their records. */
static void mark_part(struct kiln_resume *resume, struct kiln_frame_range frames, bool whole)
{
    for (uint64_t frame = frames.first; frame <= frames.last; frame++) {
        struct kiln_record *record = kiln_records_of(resume->records, (uint32_t)frame);
        if (record && whole)
            record->whole = true;
        else if (record)
            *record = (struct kiln_record){.has_state = false};
        if (record) /* the size of the part's file */
            record->bytes = 0;
    }
}

/* Looks at a part of a clip. The part has a checksum and says of which clip it is. Its states are
 * in the journal alone, so a part that the journal does not name is drawn again. */
static bool look_at_part(struct kiln_resume *resume, uint32_t part, struct kiln_error *error)
{
    const struct kiln_frame_range frames = kiln_part_range(&resume->output, part);
    const struct kiln_record *first = kiln_records_of(resume->records, frames.first);
    struct kiln_error reason = {0};
    char path[KILN_PATH_SIZE];
    if (!kiln_part_path(&resume->output, part, path, error))
        return false;
    const bool whole = is_same(path, first->bytes, first->sha256, &reason) &&
                       kiln_part_check(&resume->output, part, &reason);
    if (!could_look(&reason, error))
        return false;
    mark_part(resume, frames, whole);
    return true;
}

/* Whether the clip and what belongs to it are as the journal says. *reason is filled where a file
 * cannot be read. */
static bool clip_is_whole(const struct kiln_resume *resume, struct kiln_error *reason)
{
    const struct kiln_records *records = resume->records;
    char path[KILN_PATH_SIZE];
    bool whole = true;
    for (uint32_t i = 0; whole; i++) {
        if (!kiln_output_clip_file(&resume->output, i, path, reason))
            return false;
        if (!*path)
            break;
        const struct kiln_clip_file *file = NULL;
        for (uint32_t k = 0; k < records->file_count; k++)
            file = strcmp(records->files[k].path, path) == 0 ? &records->files[k] : file;
        whole = file && is_same(path, file->bytes, file->sha256, reason);
    }
    for (uint32_t i = 0; i < records->count; i++)
        whole = whole && records->items[i].has_state;
    return whole;
}

/* Checks that no file of the clip is there when the job begins. */
static bool check_clip_files(const struct kiln_resume *resume, struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    for (uint32_t i = 0;; i++) {
        if (!kiln_output_clip_file(&resume->output, i, path, error))
            return false;
        if (!*path)
            return true;
        if (!kiln_target_check(path, true, error))
            return false;
        if (!resume->may_replace && is_there(path))
            return kiln_error_set(error, KILN_USAGE,
                                  "%s: the file exists, and no journal says that this job made it "
                                  "(--force replaces it)",
                                  path);
    }
}

static bool find_folder(const struct kiln_output_params *output, char folder[KILN_PATH_SIZE],
                        struct kiln_error *error)
{
    char clip[KILN_PATH_SIZE];
    if (!kiln_output_clip_file(output, 0, clip, error))
        return false;
    if (snprintf(folder, KILN_PATH_SIZE, "%s.parts", clip) >= KILN_PATH_SIZE)
        return kiln_error_set(error, KILN_USAGE, "%s: the path is too long", output->path);
    /* A link is refused: parts would be written and removed in the folder that it leads to. */
    struct stat status;
    return lstat(folder, &status) != 0 || S_ISDIR(status.st_mode) ||
           kiln_error_set(error, KILN_USAGE,
                          "%s: not a folder; the parts of the clip need a folder of this name",
                          folder);
}

/* Marks all frames of a clip that is whole, and removes what is left of the way to it. Of a shard
 * that is its own journal alone: another shard may be drawing parts anew. */
static void keep_clip(struct kiln_resume *resume)
{
    for (uint32_t i = 0; i < resume->records->count; i++) {
        struct kiln_record *record = &resume->records->items[i];
        *record = (struct kiln_record){
            .has_state = true,
            .whole = true,
            .is_others = record->is_others,
            .state = record->state,
            .alive = record->alive,
        };
    }
    if (resume->shard.count == 0)
        kiln_parts_remove(resume->folder);
    else if (!resume->was_begun)
        kiln_journal_remove(&resume->journal);
}

static bool look_at_clip(struct kiln_resume *resume, struct kiln_error *error)
{
    struct kiln_error reason = {0};
    resume->clip_is_whole = clip_is_whole(resume, &reason);
    if (!could_look(&reason, error))
        return false;
    if (resume->clip_is_whole) {
        keep_clip(resume);
        return true;
    }
    resume->records->file_count = 0;
    if (!check_clip_files(resume, error))
        return false;
    for (uint32_t part = resume->first_part; part < resume->end_part; part++) {
        if (!kiln_may_go_on(&resume->output.caller, error) || !look_at_part(resume, part, error))
            return false;
    }
    return true;
}

/* ---- beginning and ending -------------------------------------------------------------------- */

/* Lists the frames that are not whole as ranges within those of the clip. */
static bool list_missing(struct kiln_resume *resume, struct kiln_error *error)
{
    const struct kiln_records *records = resume->records;
    resume->missing = calloc((size_t)records->count + 1, sizeof *resume->missing);
    if (!resume->missing)
        return kiln_error_no_memory(error, "%s", resume->output.path);
    struct kiln_frame_range *last = NULL;
    for (uint32_t i = 0; i < records->count; i++) {
        const uint32_t frame = kiln_records_frame(records, i);
        if (records->items[i].is_others) {
            last = NULL;
        } else if (records->items[i].whole) {
            resume->kept++;
        } else if (last && last->last + 1 == frame) {
            last->last = frame;
        } else {
            last = &resume->missing[resume->missing_count++];
            *last = (struct kiln_frame_range){frame, frame};
        }
    }
    return true;
}

/* Finds the parts that the shard draws, and marks the frames of all other parts as other shards'.
 */
static void choose_parts(struct kiln_resume *resume, struct kiln_shard shard)
{
    const uint32_t parts = kiln_parts_count(&resume->output);
    resume->shard = shard;
    resume->end_part = parts;
    if (shard.count == 0)
        return;
    kiln_shard_parts(shard, parts, &resume->first_part, &resume->end_part);
    for (uint32_t i = 0; i < resume->records->count; i++) {
        const uint32_t part = kiln_part_of(&resume->output, kiln_records_frame(resume->records, i));
        resume->records->items[i].is_others = part < resume->first_part || part >= resume->end_part;
    }
}

static bool set_up(struct kiln_resume *resume, const struct kiln_resume_params *params,
                   struct kiln_records *records, struct kiln_error *error)
{
    const struct kiln_output_params *output = params->output;
    *resume = (struct kiln_resume){.output = *output, .records = records};
    if (!kiln_journal_head_make(&resume->head, output, params->made_by, params->scene))
        return kiln_error_no_memory(error, "%s", output->path);
    choose_parts(resume, params->shard);
    if (!output->format->one_file)
        return true;
    if (!find_folder(output, resume->folder, error))
        return false;
    resume->output.parts = resume->folder;
    return true;
}

/* Reads the other journals of the output: a whole job reads those of shards, a shard reads that of
 * the whole job. */
static bool look_around(struct kiln_resume *resume, const struct kiln_resume_params *params,
                        bool *found, struct kiln_error *error)
{
    if (params->restart)
        return true;
    if (params->shard.count > 0)
        return kiln_journal_look_around(resume->journal, &resume->head, resume->records, found,
                                        error);
    const bool ok = kiln_journal_merge(resume->journal, &resume->head, params->keep_journals,
                                       resume->records, found, error);
    resume->was_begun |= *found && !params->keep_journals;
    return ok;
}

static bool forget_all(const struct kiln_resume *resume, struct kiln_error *error)
{
    if (!kiln_journal_forget(resume->output.path, error))
        return false;
    if (resume->folder[0])
        kiln_parts_remove(resume->folder);
    return true;
}

bool kiln_resume_begin(struct kiln_resume *resume, const struct kiln_resume_params *params,
                       struct kiln_records *records, struct kiln_error *error)
{
    bool found = false;
    if (!set_up(resume, params, records, error))
        return false;
    kiln_temporary_sweep(params->output->path);
    if (params->restart && params->shard.count == 0 && !forget_all(resume, error))
        return false;
    resume->journal =
        kiln_journal_open(&resume->head, params->shard, params->restart, records, &found, error);
    if (!resume->journal)
        return false;
    resume->was_begun = found;
    resume->may_replace = found || params->output->overwrite;
    bool ok = look_around(resume, params, &found, error);
    if (params->shard.count > 0 || !params->output->format->one_file)
        resume->may_replace |= found;
    if (ok && !params->restart)
        ok = params->output->format->one_file ? look_at_clip(resume, error)
                                              : look_at_images(resume, found, error);
    ok = ok && list_missing(resume, error);
    if (!ok)
        kiln_resume_undo(resume);
    return ok;
}

bool kiln_resume_clear(const struct kiln_output_params *output, struct kiln_error *error)
{
    char journal[KILN_PATH_SIZE], folder[KILN_PATH_SIZE];
    if (!kiln_journal_is_there(output->path, journal))
        return true;
    if (output->overwrite && !kiln_journal_forget(output->path, error))
        return false;
    if (!output->format->one_file)
        return true;
    if (!output->overwrite)
        return kiln_error_set(error, KILN_USAGE,
                              "%s: a job with --resume or --shard has begun this output (--force "
                              "replaces it)",
                              journal);
    if (!find_folder(output, folder, error))
        return false;
    kiln_parts_remove(folder);
    return true;
}

void kiln_resume_undo(struct kiln_resume *resume)
{
    /* Without its journal the output belongs to another process, and so does the folder of its
     * parts. */
    if (resume->was_begun || !resume->journal)
        return;
    kiln_journal_remove(&resume->journal);
    if (resume->folder[0])
        rmdir(resume->folder); /* does nothing unless the folder is empty */
}

bool kiln_resume_merge(struct kiln_resume *resume, struct kiln_error *error)
{
    bool found = false;
    struct kiln_records ignored;
    if (!kiln_records_create(&ignored, resume->records->clip, resume->records->clip_count))
        return kiln_error_no_memory(error, "%s", resume->output.path);
    const bool ok =
        kiln_journal_merge(resume->journal, &resume->head, false, &ignored, &found, error);
    kiln_records_free(&ignored);
    return ok;
}

bool kiln_resume_take(struct kiln_resume *resume, const struct kiln_finished_file *finished,
                      struct kiln_error *error)
{
    kiln_records_take(resume->records, finished);
    return kiln_journal_add(resume->journal, resume->records, finished, error);
}

bool kiln_resume_note(struct kiln_resume *resume, uint32_t frame, struct kiln_error *error)
{
    const struct kiln_record *record = kiln_records_of(resume->records, frame);
    char path[KILN_PATH_SIZE];
    struct kiln_finished_file finished = {
        .path = path, .frames = {frame, frame}, .bytes = record->bytes};
    memcpy(finished.sha256, record->sha256, sizeof finished.sha256);
    return kiln_output_file(&resume->output, frame, path, error) &&
           kiln_journal_add(resume->journal, resume->records, &finished, error);
}

bool kiln_resume_end_attempt(struct kiln_resume *resume, const struct kiln_attempt *run,
                             const struct kiln_render_stats *stats,
                             const struct kiln_error *failure, struct kiln_error *error)
{
    return !resume->journal || stats->frames == 0 ||
           kiln_journal_add_attempt(resume->journal, run, stats, failure, error);
}

bool kiln_resume_join(struct kiln_resume *resume, struct kiln_error *error)
{
    struct kiln_output_params output = resume->output;
    output.overwrite = resume->may_replace;
    if (!kiln_parts_join(&output, error))
        return false;
    kiln_parts_remove(resume->folder);
    resume->clip_is_whole = true;
    return true;
}

void kiln_resume_end(struct kiln_resume *resume)
{
    kiln_journal_close(&resume->journal);
    free(resume->missing);
    *resume = (struct kiln_resume){.missing = NULL};
}
