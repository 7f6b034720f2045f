/* A record holds what is known of a frame of a job, for the manifest and for a run that goes on
 * with the job. */
#ifndef KILN_JOB_RECORD_H
#define KILN_JOB_RECORD_H

#include "base/text.h"
#include "output/output.h"

struct kiln_record {
    bool has_state; /* the next two are known */
    bool whole;     /* its file is, or that of the part that it is in */
    bool is_others; /* another shard draws it */
    struct kiln_state_hash state;
    uint64_t alive;
    uint64_t bytes;  /* of its file; 0: it has none of its own */
    char sha256[65]; /* likewise */
    bool drawn;      /* in this run, in these times */
    float pass_ms[KILN_PASS_COUNT];
};

/* The frames of a job in their order. */
struct kiln_records {
    const struct kiln_frame_range *clip; /* borrowed */
    size_t clip_count;
    struct kiln_record *items; /* a frame */
    uint32_t count;
    struct kiln_clip_file { /* the file of all of them, and those beside it */
        char path[KILN_PATH_SIZE];
        uint64_t bytes;
        char sha256[65];
    } files[3];
    uint32_t file_count;
    struct kiln_text runs; /* objects of JSON with ",\n    " between them: runs of which the
                              journals tell */
    bool anew;             /* files that were there before the job do not count */
};

/* False when memory is short. */
bool kiln_records_create(struct kiln_records *records, const struct kiln_frame_range *clip,
                         size_t clip_count);
void kiln_records_free(struct kiln_records *records);

/* That of a frame, or NULL when it is none of the job's. */
struct kiln_record *kiln_records_of(const struct kiln_records *records, uint32_t frame);

/* The frame of an index below count. */
uint32_t kiln_records_frame(const struct kiln_records *records, uint32_t index);

/* Takes down what was told of a file: of a frame, of a part, or of the clip. */
void kiln_records_take(struct kiln_records *records, const struct kiln_whole *whole);

#endif
