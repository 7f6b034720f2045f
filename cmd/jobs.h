/* Declares the jobs of `kiln render`. A job is a scene, its frames and the files to write; all jobs
 * are checked before a device is opened. */
#ifndef KILN_CMD_JOBS_H
#define KILN_CMD_JOBS_H

#include "options.h"

struct job {
    const char *path; /* path of the scene, as given */
    struct kiln_scene *scene;
    struct kiln_scene_info info;
    struct frame_list frames; /* never empty; points to one of the next three members */
    struct kiln_frame_range every_frame;
    struct frame_list chosen;       /* frames of --frames */
    struct kiln_frame_range *cells; /* frames of a flipbook's cells */
    char *output;                   /* NULL: nothing is written */
    char *manifest;                 /* NULL: none */
    int code;                       /* not 0: the exit code of its failure, which was reported */
};

struct job_list {
    struct job *jobs;
    size_t count;
    struct kiln_flipbook flipbook; /* columns 0: none */
    bool resume;
    /* The caller sets these before job_list_create. */
    struct kiln_stream stream; /* in place of output files; KILN_STREAM_NONE: no stream */
    uint32_t shard, shards;    /* shards 0: none */
    bool keep_going;           /* a job that cannot run does not stop the others */
};

/* Returns 0, or the exit code after reporting what is wrong; every wrong scene is reported. The
 * list borrows the arguments, and must be freed in both cases. */
int job_list_create(struct job_list *list, const struct arguments *arguments);
void job_list_free(struct job_list *list);

/* Returns the file that a pattern means for a scene, in new memory; NULL when memory is short. A
 * pattern that is a folder gets a file named after the scene. With `numbers`, '%' and '#' in the
 * pattern stand for the number of a frame. */
char *job_file_name(const char *pattern, const char *scene, const char *suffix, bool numbers);

/* Returns 0, or the exit code after reporting that --quality is given for an output whose format
 * has none. `place` starts the message. */
int quality_check(const struct arguments *arguments, const char *place, const char *output);

#endif
