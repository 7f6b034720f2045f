/* Resumes a job: finds out which of its files are there, and which frames are still to be drawn. */
#ifndef KILN_JOB_RESUME_H
#define KILN_JOB_RESUME_H

#include "job/journal.h"

struct kiln_resume {
    struct kiln_output_params output; /* of the whole job, complete; parts is `folder` */
    struct kiln_journal_head head;
    struct kiln_shard shard;
    uint32_t first_part, end_part; /* those that count: first to end - 1 */
    struct kiln_records *records;
    struct kiln_journal *journal;
    char folder[KILN_PATH_SIZE]; /* of the parts of a clip */
    bool was_begun;   /* the journal was there, or took others over; else it is removed when nothing
                       * comes of the job */
    bool may_replace; /* what is there under final names: it was asked for, or is of the job by a
                       * journal (a clip: by that of the whole job) */
    bool clip_is_whole;
    struct kiln_frame_range *missing; /* frames to be drawn, ascending: of a clip, whole parts */
    size_t missing_count;
    uint32_t kept; /* frames that are there */
};

struct kiln_resume_params {
    const struct kiln_output_params *output; /* of the whole job, complete, without parts */
    const char *made_by;                     /* device and techniques */
    const char *scene;                       /* for manifests: kiln_manifest_scene */
    struct kiln_shard shard;                 /* whose frames alone count; count 0: all */
    bool restart;       /* the journal and all files that are there are forgotten */
    bool keep_journals; /* of shards, which else go into the one of the job */
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

/* Says in the journal what this run came to, if it made frames. KILN_IO. */
bool kiln_resume_end_attempt(struct kiln_resume *resume, const struct kiln_attempt *run,
                             const struct kiln_render_stats *stats,
                             const struct kiln_error *failure, struct kiln_error *error);

/* Joins the parts of a clip, which are all there, says so in the journal, and removes them. */
bool kiln_resume_join(struct kiln_resume *resume, struct kiln_error *error);

/* Takes the journals of shards over that were kept. */
bool kiln_resume_merge(struct kiln_resume *resume, struct kiln_error *error);

/* Takes down in the journal an image that was found without it, now that its state is known. */
bool kiln_resume_note(struct kiln_resume *resume, uint32_t frame, struct kiln_error *error);

/* Takes down a file in records and journal. */
bool kiln_resume_take(struct kiln_resume *resume, const struct kiln_whole *whole,
                      struct kiln_error *error);

/* Removes a journal that was begun by kiln_resume_begin: nothing comes of the job. */
void kiln_resume_undo(struct kiln_resume *resume);
void kiln_resume_end(struct kiln_resume *resume);

#endif
