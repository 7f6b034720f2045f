/* The manifest: a JSON file that says what a run rendered, with what and how long it took, so that
 * it can be repeated and compared. */
#ifndef KILN_OUTPUT_MANIFEST_H
#define KILN_OUTPUT_MANIFEST_H

#include "kiln.h"

struct kiln_manifest_params {
    const char *path;
    bool overwrite;
    const struct kiln_scene *scene;        /* printed whole into the file */
    const struct kiln_device_info *device; /* NULL: no device was used */
    const char *techniques;                /* "simulate=cpu sort=cpu ..." */
    const char *output;                    /* as the user gave it; NULL: nothing was written */
};

struct kiln_manifest;

/* Opens a temporary file beside path and writes what is known before the first frame; makes
 * missing folders. NULL with KILN_IO, or KILN_DEVICE_FAILED when memory is short. */
struct kiln_manifest *kiln_manifest_open(const struct kiln_manifest_params *params,
                                         struct kiln_error *error);

/* Adds a frame: number, file (NULL: none was written), state hash, living particles, times. Goes to
 * the file at once, so memory does not grow with the frames. */
bool kiln_manifest_add(struct kiln_manifest *manifest, const struct kiln_progress *progress,
                       const char *file, struct kiln_error *error);

/* Adds the totals and gives the file its name. */
bool kiln_manifest_finish(struct kiln_manifest *manifest, const struct kiln_render_stats *stats,
                          struct kiln_error *error);

/* Without a finish before, nothing is left of the file. */
void kiln_manifest_close(struct kiln_manifest **manifest);

#endif
