/* The manifest: a JSON file that says what a job came to (`result`), and with what and how long
 * this run and those before worked at it (`run`, `runs_before`), so that it can be repeated and
 * compared. The result is the same for every run that brings the job to its end; runs differ. */
#ifndef KILN_JOB_MANIFEST_H
#define KILN_JOB_MANIFEST_H

#include "job/attempt.h"
#include "job/record.h"

struct kiln_manifest_params {
    const char *path;
    bool overwrite;
    bool again;         /* any older manifest is replaced; else that of a run that failed */
    const char *scene;  /* of kiln_manifest_scene */
    const char *output; /* as the user gave it; NULL: nothing was written */
    const struct kiln_output_params *files; /* complete; NULL: nothing was written */
    const struct kiln_attempt *run;
};

struct kiln_manifest;

/* Makes the JSON by which the result describes a scene, with the whole of its text. The caller
 * frees it; NULL when memory is short. */
char *kiln_manifest_scene(const struct kiln_scene *scene);

/* Opens a temporary file beside path; makes missing folders. All that params points to is borrowed.
 * NULL with KILN_USAGE when it exists, KILN_IO, or KILN_DEVICE_FAILED when memory is short. */
struct kiln_manifest *kiln_manifest_open(const struct kiln_manifest_params *params,
                                         struct kiln_error *error);

/* Writes all of it and gives the file its name. `failure` is why the run failed, or NULL: then its
 * result has all frames, else those that are there. KILN_IO, KILN_DEVICE_FAILED. */
bool kiln_manifest_finish(struct kiln_manifest *manifest, const struct kiln_records *records,
                          const struct kiln_render_stats *stats, const struct kiln_error *failure,
                          struct kiln_error *error);

/* Without a finish before, nothing is left of the file. */
void kiln_manifest_close(struct kiln_manifest **manifest);

#endif
