/* Resumes a job: finds out which of its files are there, and which frames are still to be drawn. */
#ifndef KILN_JOB_RESUME_H
#define KILN_JOB_RESUME_H

#include "job/journal.h"

struct kiln_resume {
    struct kiln_output_params output; /* output of the whole job, complete; `parts` is `folder` */
    struct kiln_journal_head head;
    struct kiln_shard shard;
    /* the parts that this run answers for: first_part to end_part - 1 */
    uint32_t first_part, end_part;
    struct kiln_records *records;
    struct kiln_journal *journal;
    char folder[KILN_PATH_SIZE]; /* folder of the parts of a clip */
    /* true: there was a journal, or shards' journals were merged; false: a job without result
     * removes its journal */
    bool was_begun;
    /* true: files under final names may be replaced, because the caller allows it, or because a
     * journal lists them (for a clip, the journal of the whole job) */
    bool may_replace;
    bool clip_is_whole;
    struct kiln_frame_range *missing; /* frames to be drawn, ascending; of a clip, whole parts */
    size_t missing_count;
    uint32_t kept; /* number of frames that are there */
};

struct kiln_resume_params {
    /* output of the whole job, complete, without `parts` */
    const struct kiln_output_params *output;
    const char *made_by; /* device and techniques */
    /* the scene for manifests, made by kiln_manifest_scene */
    const char *scene;
    /* the shard whose frames are drawn; count 0: all frames */
    struct kiln_shard shard;
    bool restart;       /* true: the journal and all files that are there are discarded */
    bool keep_journals; /* true: journals of shards stay; false: they are merged into the job's */
};

/* Reads the journal and looks at every file that it names. records: of all frames, which are
 * marked. What is handed over is borrowed. KILN_USAGE when the journal is of another job, or when a
 * file is in the way that is not of this job; KILN_IO when another process has the journal. After a
 * failure, too, kiln_resume_end frees. */
bool kiln_resume_begin(struct kiln_resume *resume, const struct kiln_resume_params *params,
                       struct kiln_records *records, struct kiln_error *error);

/* For an output that is made without a journal: what journals say of one of its name is true no
 * more, so they and the parts of a clip are removed. KILN_IO when a process has one of them,
 * KILN_USAGE for a clip that is not to be overwritten: a job has begun it. */
bool kiln_resume_clear(const struct kiln_output_params *output, struct kiln_error *error);

/* Appends the description of this run to the journal if it made frames. KILN_IO. */
bool kiln_resume_end_attempt(struct kiln_resume *resume, const struct kiln_attempt *run,
                             const struct kiln_render_stats *stats,
                             const struct kiln_error *failure, struct kiln_error *error);

/* Joins the parts of a clip, which must all be there, appends the clip to the journal, and removes
 * the parts. */
bool kiln_resume_join(struct kiln_resume *resume, struct kiln_error *error);

/* Merges the shards' journals that were kept into the job's journal. */
bool kiln_resume_merge(struct kiln_resume *resume, struct kiln_error *error);

/* Appends an image to the journal that was found without a line in it, now that its state is
 * known. */
bool kiln_resume_note(struct kiln_resume *resume, uint32_t frame, struct kiln_error *error);

/* Adds a file that has become whole to records and journal. */
bool kiln_resume_take(struct kiln_resume *resume, const struct kiln_finished_file *finished,
                      struct kiln_error *error);

/* Removes a journal that kiln_resume_begin began, for a job that has no result. */
void kiln_resume_undo(struct kiln_resume *resume);
void kiln_resume_end(struct kiln_resume *resume);

#endif
