/* Declares the jobs of `kiln render`, which are checked before any device is opened: which scene,
 * which frames, into which files. */
#ifndef KILN_CMD_JOBS_H
#define KILN_CMD_JOBS_H

#include "options.h"

struct job {
    const char *path; /* of the scene, as given */
    struct kiln_scene *scene;
    struct kiln_scene_info info;
    struct frame_list frames; /* never empty; borrowed from one of these three */
    struct kiln_frame_range every_frame;
    struct frame_list chosen;       /* of --frames */
    struct kiln_frame_range *cells; /* of a flipbook; the list points here then */
    char *output;                   /* NULL: nothing is written */
    char *manifest;                 /* NULL: none */
    int code;                       /* not 0: why it cannot run, which was reported */
};

struct job_list {
    struct job *jobs;
    size_t count;
    struct kiln_flipbook flipbook; /* columns 0: none */
    bool resume;
    /* To be set before job_list_create. */
    struct kiln_stream stream; /* in place of outputs; of no format: none */
    uint32_t shard, shards;    /* shards 0: none */
    bool keep_going;           /* a job that cannot run is no failure of the list */
};

/* Returns 0, or the exit code after reporting what is wrong; every wrong scene is reported. The
 * list borrows the arguments, and must be freed in both cases. */
int job_list_create(struct job_list *list, const struct arguments *arguments);
void job_list_free(struct job_list *list);

/* Returns the file that a pattern means for a scene, in new memory; NULL when memory is short. A
 * pattern that is a folder gets a file named after the scene. `numbers`: the name may have the
 * number of a frame. */
char *job_file_name(const char *pattern, const char *scene, const char *suffix, bool numbers);

/* Returns 0, or the exit code after reporting that --quality is given for an output whose format
 * has none. `place` starts the message. */
int quality_check(const struct arguments *arguments, const char *place, const char *output);

#endif
