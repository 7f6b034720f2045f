/* Declares the records of a job's frames. A record holds what is known of one frame; the manifest
 * and runs that resume the job read it. */
#ifndef KILN_JOB_RECORD_H
#define KILN_JOB_RECORD_H

#include "base/text.h"
#include "output/output.h"

struct kiln_record {
    bool has_state; /* true: step and hash of the state, the next two members, are known */
    bool whole;     /* true: the frame's file, or the file of its part, is whole */
    bool is_others; /* true: another shard draws the frame */
    struct kiln_state_hash state;
    uint64_t alive;
    uint64_t bytes;  /* size of the frame's file; 0: the frame has no file of its own */
    char sha256[65]; /* hash of the frame's file, if it has one */
    bool drawn;      /* true: this run drew the frame, and ms has its times */
    float pass_ms[KILN_PASS_COUNT];
};

/* Holds the records of a job's frames in ascending order. */
struct kiln_records {
    const struct kiln_frame_range *clip; /* borrowed */
    size_t clip_count;
    struct kiln_record *items; /* one record a frame */
    uint32_t count;
    /* the file with all frames of a clip, and the files written beside it */
    struct kiln_clip_file {
        char path[KILN_PATH_SIZE];
        uint64_t bytes;
        char sha256[65];
    } files[3];
    uint32_t file_count;
    /* the runs that the journals list: objects of JSON with ",\n    " between them */
    struct kiln_text runs;
    bool anew; /* true: files that were there before the job started do not count */
};

/* Makes a record for each frame. False when memory is short. */
bool kiln_records_create(struct kiln_records *records, const struct kiln_frame_range *clip,
                         size_t clip_count);
void kiln_records_free(struct kiln_records *records);

/* Returns the record of a frame, or NULL when the frame is not of the job. */
struct kiln_record *kiln_records_of(const struct kiln_records *records, uint32_t frame);

/* Returns the number of the frame at an index below count. */
uint32_t kiln_records_frame(const struct kiln_records *records, uint32_t index);

/* Copies what a report about a whole file says into the records: for a frame, a part, or the
 * clip. */
void kiln_records_take(struct kiln_records *records, const struct kiln_finished_file *finished);

#endif
