/* A file counts when it is as the journal says, or says itself of what it is. */
#include "job/resume.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "output/formats.h"
#include "output/part.h"

/* ---- looking at files ------------------------------------------------------------------------ */

/* Whether a file is the one that has this hash. */
static bool is_same(const char *path, uint64_t bytes, const char *sha256)
{
    struct kiln_whole whole = {.path = path};
    struct kiln_error ignored = {0};
    struct stat status;
    return bytes > 0 && stat(path, &status) == 0 && S_ISREG(status.st_mode) &&
           (uint64_t)status.st_size == bytes && kiln_whole_measure(&whole, &ignored) &&
           strcmp(whole.sha256, sha256) == 0;
}

static bool is_there(const char *path)
{
    struct stat status;
    return lstat(path, &status) == 0;
}

/* A file that nobody has told of: takes it down. */
static bool adopt(struct kiln_resume *resume, const char *path, uint32_t frame,
                  struct kiln_error *error)
{
    struct kiln_whole whole = {.path = path, .frames = {frame, frame}};
    if (!kiln_whole_measure(&whole, error))
        return false;
    kiln_records_take(resume->records, &whole);
    return true;
}

/* Looks at the image of a frame. found: there was a journal, so that what is in the way is ours. */
static bool look_at_image(struct kiln_resume *resume, uint32_t frame, const char *path, bool found,
                          struct kiln_error *error)
{
    struct kiln_record *record = kiln_records_of(resume->records, frame);
    if (is_same(path, record->bytes, record->sha256)) {
        record->whole = true;
        return true;
    }
    *record = (struct kiln_record){.has_state = false};
    if (!is_there(path))
        return true;
    if (kiln_output_carries(&resume->output, path, frame))
        return adopt(resume, path, frame, error);
    return found || kiln_error_set(error, KILN_IO,
                                   "%s: the file exists, and is not a whole frame %u of this scene "
                                   "(--force replaces it)",
                                   path, frame);
}

static bool look_at_images(struct kiln_resume *resume, bool found, struct kiln_error *error)
{
    const struct kiln_records *records = resume->records;
    for (uint32_t i = 0; i < records->count; i++) {
        char path[KILN_PATH_SIZE];
        const uint32_t frame = kiln_records_frame(records, i);
        if (!kiln_output_file(&resume->output, frame, path, error) ||
            !kiln_output_may_go_on(&resume->output.caller, error) ||
            !look_at_image(resume, frame, path, found, error))
            return false;
    }
    return true;
}

/* Marks the frames of a part as whole, or forgets them. */
static void mark_part(struct kiln_resume *resume, struct kiln_frame_range frames, bool whole)
{
    for (uint64_t frame = frames.first; frame <= frames.last; frame++) {
        struct kiln_record *record = kiln_records_of(resume->records, (uint32_t)frame);
        if (record && whole)
            record->whole = true;
        else if (record)
            *record = (struct kiln_record){.has_state = false};
        if (record) /* what was known of the file of the part */
            record->bytes = 0;
    }
}

/* A part is its own witness: it has a checksum, and says of which clip it is. Its states are in the
 * journal alone, so what that does not name is drawn again. */
static bool look_at_part(struct kiln_resume *resume, uint32_t part, struct kiln_error *error)
{
    const struct kiln_frame_range frames = kiln_part_range(&resume->output, part);
    const struct kiln_record *first = kiln_records_of(resume->records, frames.first);
    struct kiln_error ignored = {0};
    char path[KILN_PATH_SIZE];
    if (!kiln_part_path(&resume->output, part, path, error))
        return false;
    const bool whole = is_same(path, first->bytes, first->sha256) &&
                       kiln_part_check(&resume->output, part, &ignored);
    mark_part(resume, frames, whole);
    return true;
}

/* Whether the clip and what belongs to it are as the journal says. */
static bool clip_is_whole(const struct kiln_resume *resume)
{
    const struct kiln_records *records = resume->records;
    bool whole = records->file_count > 0;
    for (uint32_t i = 0; i < records->file_count; i++)
        whole = whole &&
                is_same(records->files[i].path, records->files[i].bytes, records->files[i].sha256);
    for (uint32_t i = 0; i < records->count; i++)
        whole = whole && records->items[i].has_state;
    return whole;
}

/* Removes the parts of a clip that is whole, and their folder unless there is something else in it.
 */
static void remove_parts(const struct kiln_resume *resume)
{
    for (uint32_t part = 0; part < kiln_parts_count(&resume->output); part++) {
        struct kiln_error ignored = {0};
        char path[KILN_PATH_SIZE];
        if (kiln_part_path(&resume->output, part, path, &ignored))
            unlink(path);
        if (part == 0)
            kiln_temporary_sweep(path);
    }
    rmdir(resume->folder);
}

static bool look_at_clip(struct kiln_resume *resume, bool found, struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    if (!kiln_output_clip_file(&resume->output, 0, path, error))
        return false;
    resume->clip_is_whole = clip_is_whole(resume);
    if (resume->clip_is_whole) {
        remove_parts(resume);
        for (uint32_t i = 0; i < resume->records->count; i++)
            resume->records->items[i] = (struct kiln_record){
                .has_state = true,
                .whole = true,
                .state = resume->records->items[i].state,
                .alive = resume->records->items[i].alive,
            };
        return true;
    }
    resume->records->file_count = 0;
    if (!found && !kiln_target_check(path, false, error))
        return false;
    for (uint32_t part = 0; part < kiln_parts_count(&resume->output); part++) {
        if (!kiln_output_may_go_on(&resume->output.caller, error) ||
            !look_at_part(resume, part, error))
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
        return kiln_error_set(error, KILN_DEVICE_FAILED, "%s: out of memory", resume->output.path);
    struct kiln_frame_range *last = NULL;
    for (uint32_t i = 0; i < records->count; i++) {
        const uint32_t frame = kiln_records_frame(records, i);
        if (records->items[i].whole) {
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

bool kiln_resume_begin(struct kiln_resume *resume, const struct kiln_output_params *output,
                       const char *made_by, bool restart, struct kiln_records *records,
                       struct kiln_error *error)
{
    const struct kiln_journal_params journal = {
        .output = &resume->output, .made_by = made_by, .restart = restart, .log = output->log};
    char clip[KILN_PATH_SIZE];
    bool found = false;
    *resume = (struct kiln_resume){.output = *output, .records = records};
    kiln_temporary_sweep(output->path);
    if (output->format->one_file) {
        if (!kiln_output_clip_file(output, 0, clip, error))
            return false;
        if (snprintf(resume->folder, sizeof resume->folder, "%s.parts", clip) >= KILN_PATH_SIZE)
            return kiln_error_set(error, KILN_USAGE, "%s: the path is too long", output->path);
        resume->output.parts = resume->folder;
    }
    resume->journal = kiln_journal_open(&journal, records, &found, error);
    if (!resume->journal)
        return false;
    bool ok = true;
    if (!restart)
        ok = output->format->one_file ? look_at_clip(resume, found, error)
                                      : look_at_images(resume, found, error);
    ok = ok && list_missing(resume, error);
    if (!ok && !found)
        kiln_journal_remove(&resume->journal);
    return ok;
}

bool kiln_resume_take(struct kiln_resume *resume, const struct kiln_whole *whole,
                      struct kiln_error *error)
{
    kiln_records_take(resume->records, whole);
    return kiln_journal_add(resume->journal, resume->records, whole, error);
}

bool kiln_resume_note(struct kiln_resume *resume, uint32_t frame, struct kiln_error *error)
{
    const struct kiln_record *record = kiln_records_of(resume->records, frame);
    char path[KILN_PATH_SIZE];
    struct kiln_whole whole = {.path = path, .frames = {frame, frame}, .bytes = record->bytes};
    memcpy(whole.sha256, record->sha256, sizeof whole.sha256);
    return kiln_output_file(&resume->output, frame, path, error) &&
           kiln_journal_add(resume->journal, resume->records, &whole, error);
}

bool kiln_resume_join(struct kiln_resume *resume, struct kiln_error *error)
{
    struct kiln_output_params output = resume->output;
    output.overwrite = true; /* what is there was allowed for when the job began */
    if (!kiln_parts_join(&output, error))
        return false;
    remove_parts(resume);
    resume->clip_is_whole = true;
    return true;
}

void kiln_resume_end(struct kiln_resume *resume)
{
    kiln_journal_close(&resume->journal);
    free(resume->missing);
    *resume = (struct kiln_resume){.missing = NULL};
}
