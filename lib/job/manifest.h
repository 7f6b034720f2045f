/* The manifest: a JSON file that says what a job came to (`result`), and with what and how long a
 * run worked at it (`run`), so that it can be repeated and compared. The result is the same for
 * every run of the job, the run is not. */
#ifndef KILN_JOB_MANIFEST_H
#define KILN_JOB_MANIFEST_H

#include "job/record.h"

struct kiln_manifest_params {
    const char *path;
    bool overwrite;
    bool again;                             /* an older manifest is replaced in any case */
    const char *scene;                      /* of kiln_manifest_scene */
    const struct kiln_device_info *device;  /* NULL: no device was used */
    const char *techniques;                 /* "simulate=cpu sort=cpu ..." */
    const char *output;                     /* as the user gave it; NULL: nothing was written */
    const struct kiln_output_params *files; /* complete; NULL: nothing was written */
    const char *const *command;             /* the words of the command line */
    size_t command_count;
    const char *build; /* which kiln, "0.2.0 (254e4dc)"; NULL: its version */
};

struct kiln_manifest;

/* Makes the JSON by which the result describes a scene, with the whole of its text. The caller
 * frees it; NULL when memory is short. */
char *kiln_manifest_scene(const struct kiln_scene *scene);

/* Opens a temporary file beside path; makes missing folders. All that params points to is borrowed.
 * NULL with KILN_IO, or KILN_DEVICE_FAILED when memory is short. */
struct kiln_manifest *kiln_manifest_open(const struct kiln_manifest_params *params,
                                         struct kiln_error *error);

/* Writes all of it and gives the file its name. KILN_IO, KILN_DEVICE_FAILED. */
bool kiln_manifest_finish(struct kiln_manifest *manifest, const struct kiln_records *records,
                          const struct kiln_render_stats *stats, struct kiln_error *error);

/* Without a finish before, nothing is left of the file. */
void kiln_manifest_close(struct kiln_manifest **manifest);

#endif
