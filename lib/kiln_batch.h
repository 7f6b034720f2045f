/* Many jobs out of one file: part of kiln_program.h, which includes it. */
#ifndef KILN_BATCH_H
#define KILN_BATCH_H

#include "kiln_program.h"

/* A job of `kiln render --batch`. Paths are as the program can open them; NULL: not given. */
struct kiln_batch_job {
    const char *name; /* as the file calls it, or "job 3" */
    const char *scene, *output, *asset_root, *states, *manifest;
    const char *frames, *limits; /* as the options of these names */
    double timeout_s;            /* 0: none */
    const char *const *overrides;
    size_t override_count;
};

struct kiln_batch;

/* Reads a file of jobs: YAML, or, as .ndjson and .jsonl, a JSON object a line. Relative paths in it
 * start at its folder. The caller destroys it. NULL with KILN_INVALID_INPUT and the place, KILN_IO,
 * or KILN_DEVICE_FAILED when memory is short. */
struct kiln_batch *kiln_batch_read(const char *path, struct kiln_error *error);

/* Reads jobs out of a text in memory, with a zero behind it that size does not count; name is for
 * messages. Relative paths start at the working directory. */
enum kiln_batch_format { KILN_BATCH_YAML, KILN_BATCH_LINES };
struct kiln_batch *kiln_batch_parse(const char *text, size_t size, const char *name,
                                    enum kiln_batch_format format, struct kiln_error *error);
void kiln_batch_destroy(struct kiln_batch **batch);

size_t kiln_batch_count(const struct kiln_batch *batch);
const struct kiln_batch_job *kiln_batch_job(const struct kiln_batch *batch, size_t index);

enum { KILN_MAX_BATCH_SIZE = 64 << 20 }; /* bytes of such a file */

/* The keys of a job, for people, and the JSON schema of a YAML file of jobs. */
bool kiln_batch_write_reference(FILE *out);
bool kiln_batch_write_schema(FILE *out);

#endif
