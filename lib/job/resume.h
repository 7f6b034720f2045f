/* What of a job is there already, and what is still to be drawn. */
#ifndef KILN_JOB_RESUME_H
#define KILN_JOB_RESUME_H

#include "job/journal.h"

struct kiln_resume {
    struct kiln_output_params output; /* of the whole job, complete; parts is `folder` */
    struct kiln_records *records;
    struct kiln_journal *journal;
    char folder[KILN_PATH_SIZE]; /* of the parts of a clip */
    bool clip_is_whole;
    struct kiln_frame_range *missing; /* frames to be drawn, ascending: of a clip, whole parts */
    size_t missing_count;
    uint32_t kept; /* frames that are there */
};

/* Reads the journal and looks at every file that it names. output: of the whole job, complete,
 * without parts; records: of its frames, which are marked. Both are borrowed. KILN_IO when the
 * journal is of another job or process, or when a file is in the way that is not of this job;
 * `restart` forgets the journal and all files. After a failure, too, kiln_resume_end frees. */
bool kiln_resume_begin(struct kiln_resume *resume, const struct kiln_output_params *output,
                       const char *made_by, bool restart, struct kiln_records *records,
                       struct kiln_error *error);

/* Of a clip whose parts are all there: joins them, says so in the journal, and removes them. */
bool kiln_resume_join(struct kiln_resume *resume, struct kiln_error *error);

/* Takes down in the journal an image that was found without it, now that its state is known. */
bool kiln_resume_note(struct kiln_resume *resume, uint32_t frame, struct kiln_error *error);

/* Takes down a file in records and journal. */
bool kiln_resume_take(struct kiln_resume *resume, const struct kiln_whole *whole,
                      struct kiln_error *error);
void kiln_resume_end(struct kiln_resume *resume);

#endif
