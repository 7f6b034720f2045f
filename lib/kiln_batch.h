/* Declares batches: many jobs that one file lists. This header is part of kiln_program.h, which
 * includes it. */
#ifndef KILN_BATCH_H
#define KILN_BATCH_H

#include "kiln_program.h"

/* A text of the file of jobs and its place in the file. */
struct kiln_batch_text {
    const char *text; /* NULL: not given */
    uint32_t line, column;
};

/* A job of `kiln render --batch`. Paths are as the program can open them; NULL: not given. */
struct kiln_batch_job {
    const char *name; /* as the file calls it, or "job 3" */
    const char *scene, *asset_root, *states;
    struct kiln_batch_text output, manifest;
    struct kiln_batch_text frames, limits; /* as the options --frames and --limits take them */
    double timeout_s;                      /* 0: none */
    const char *const *overrides;
    size_t override_count;
};

struct kiln_batch;

/* Reads a file of jobs: YAML or, for the suffixes .ndjson and .jsonl, one JSON object a line.
 * Relative paths in the file start at its folder. Returns a batch of at least one job, which the
 * caller destroys, or NULL with KILN_INVALID_INPUT and the place of the fault, KILN_IO, or
 * KILN_DEVICE_FAILED when memory is short. */
struct kiln_batch *kiln_batch_read(const char *path, struct kiln_error *error);

/* Reads jobs from a text of `size` bytes in memory, behind which there must be a zero. `name`
 * stands for the file in messages. Relative paths start at the working directory. Returns as
 * kiln_batch_read does. */
enum kiln_batch_format { KILN_BATCH_YAML, KILN_BATCH_LINES };
struct kiln_batch *kiln_batch_parse(const char *text, size_t size, const char *name,
                                    enum kiln_batch_format format, struct kiln_error *error);
void kiln_batch_destroy(struct kiln_batch **batch);

/* Returns the number of jobs, and the job of an index below that; the job belongs to the batch. */
size_t kiln_batch_count(const struct kiln_batch *batch);
const struct kiln_batch_job *kiln_batch_job(const struct kiln_batch *batch, size_t index);

/* Fills the error with KILN_INVALID_INPUT, the place of a text of a job, the key whose value the
 * text is, and the formatted message. Returns false. */
bool kiln_batch_refuse(const struct kiln_batch *batch, size_t index,
                       const struct kiln_batch_text *text, const char *key,
                       struct kiln_error *error, const char *format, ...)
    __attribute__((format(printf, 6, 7)));

enum { KILN_MAX_BATCH_SIZE = 64 << 20 }; /* bytes of a file of jobs */

/* Write the reference of the keys of a job, for people, and the JSON schema of a YAML file of jobs.
 * They return false when writing fails. */
bool kiln_batch_write_reference(FILE *out);
bool kiln_batch_write_schema(FILE *out);

#endif
