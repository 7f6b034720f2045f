/* Declares the manifest, a JSON file about a job, so that the job can be repeated and compared.
 * `result` says what was made. `run` and `runs_before` say with which machine and techniques, and
 * how long, this run and earlier ones worked. The result is the same for every run that completes
 * the job; the descriptions of runs differ. */
#ifndef KILN_JOB_MANIFEST_H
#define KILN_JOB_MANIFEST_H

#include "job/attempt.h"
#include "job/record.h"

struct kiln_manifest_params {
    const char *path;
    bool overwrite;
    /* true: any older manifest is replaced; false: only that of a run that failed */
    bool again;
    const char *scene;  /* JSON made by kiln_manifest_scene */
    const char *output; /* path as the user gave it; NULL: nothing was written */
    const struct kiln_output_params *files; /* complete; NULL: nothing was written */
    const struct kiln_attempt *run;
};

struct kiln_manifest;

/* Makes the JSON by which the result describes a scene, with the scene's whole text. The caller
 * frees it; NULL when memory is short. */
char *kiln_manifest_scene(const struct kiln_scene *scene);

/* Opens a temporary file beside path; makes missing folders. All that params points to is borrowed.
 * NULL with KILN_USAGE when it exists, KILN_IO, or KILN_DEVICE_FAILED when memory is short. */
struct kiln_manifest *kiln_manifest_open(const struct kiln_manifest_params *params,
                                         struct kiln_error *error);

/* Writes the whole manifest and renames the temporary file to its path. `failure` is the error of
 * the run, or NULL. Without a failure the result lists all frames, else the frames that are there.
 * KILN_IO, KILN_DEVICE_FAILED. */
bool kiln_manifest_finish(struct kiln_manifest *manifest, const struct kiln_records *records,
                          const struct kiln_render_stats *stats, const struct kiln_error *failure,
                          struct kiln_error *error);

/* Closes the manifest. If it was not finished, its temporary file is removed. */
void kiln_manifest_close(struct kiln_manifest **manifest);

#endif
