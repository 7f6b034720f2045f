/* Declares jobs that are done in parts, and the files that outlive a job. This header is part of
 * kiln.h, which includes it. */
#ifndef KILN_JOB_H
#define KILN_JOB_H

#include "kiln.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A clip is a sequence of parts of equal length, which do not depend on each other: so many frames,
 * about two seconds of them and at most 600. The last part may be shorter. */
KILN_API uint32_t kiln_part_frames(uint32_t fps_num, uint32_t fps_den);

/* ---- Saved states --------------------------------------------------------------------------- */

/* A state that was saved: what a run carries from one step to the next. It serves every scene of
 * the same motion, whatever that looks like, on every device and with every technique. */
struct kiln_baked {
    size_t size;
    uint32_t frame, frames; /* the one that it was saved before, of so many states to be saved */
    uint32_t done;          /* of these, it included */
    uint32_t step;
    uint64_t alive; /* particles */
    uint64_t bytes; /* of the file */
    bool kept;      /* it was there already */
    const char *file;
};

struct kiln_bake_params {
    size_t size;
    const char *states; /* the folder; it is made if it is missing */
    uint32_t every;     /* frames between two states; 0: one before each part */
    const char *const
        *techniques; /* "stage=name"; with those of a spread sort, its order is saved */
    size_t technique_count;
    uint32_t threads; /* 0 takes one a core */
    bool overwrite;   /* states of the same names; else they are refused, */
    bool resume;      /* or else kept where they are whole, and the run goes on from them */
    void (*saved)(void *user, const struct kiln_baked *state); /* told of each; NULL: nobody */
    bool (*stop)(void *user); /* asked between steps; true ends with KILN_INTERRUPTED */
    void *user;
    const struct kiln_cancel *cancel; /* NULL: nobody cancels */
    struct kiln_log log;
};
KILN_EMPTY(kiln_bake_params, kiln_bake_defaults)

struct kiln_bake_stats {
    size_t size;
    uint32_t states, kept; /* that are there now; of these were there before */
    uint64_t steps;        /* that were done */
    uint64_t bytes;        /* of the files that were written */
    double total_s;
    char motion[65]; /* the motion hash, by which they are known */
};
KILN_EMPTY(kiln_bake_stats, kiln_bake_stats_empty)

/* Steps through the clip once and saves states, whole files alone under their names. A state of
 * step 0 is none. KILN_USAGE, KILN_IO, KILN_INTERRUPTED, or the errors of kiln_render. stats may be
 * NULL.
 */
KILN_API bool kiln_bake(struct kiln_device *device, const struct kiln_scene *scene,
                        const struct kiln_bake_params *params, struct kiln_bake_stats *stats,
                        struct kiln_error *error);

/* ---- Joining -------------------------------------------------------------------------------- */

struct kiln_join_params {
    size_t size;
    const char *output;         /* as the job was given it: a clip, or a pattern of images */
    const char *manifest;       /* a JSON file that describes the job, or NULL */
    const char *const *command; /* words of a command line, for the manifest */
    size_t command_count;
    const char
        *build;     /* of the program, "0.2.0 (254e4dc)", for the manifest; NULL: kiln_version() */
    bool overwrite; /* files that no journal knows of; a manifest is replaced anyway */
    bool (*stop)(void *user); /* asked now and then; true ends with KILN_INTERRUPTED */
    void *user;
    const struct kiln_cancel *cancel; /* NULL: nobody cancels */
    struct kiln_budget *budget;       /* NULL: no limits */
    struct kiln_log log;
};
KILN_EMPTY(kiln_join_params, kiln_join_defaults)

struct kiln_join_stats {
    size_t size;
    uint32_t frames, parts;
    bool was_whole; /* there was nothing to do */
    double total_s;
};
KILN_EMPTY(kiln_join_stats, kiln_join_stats_empty)

/* Makes the clip of parts that shards drew, or looks whether all images are there. KILN_IO, with
 * the parts and frames that are missing or damaged, when not all are; then nothing is written. */
KILN_API bool kiln_join(const struct kiln_join_params *params, struct kiln_join_stats *stats,
                        struct kiln_error *error);

/* ---- Encoding ------------------------------------------------------------------------------- */

struct kiln_encode_params {
    size_t size;
    const char *frames;  /* images: a folder, taken in the order of names, or a numbered pattern */
    const char *output;  /* a clip */
    const char *fps;     /* "30", "29.97" or "30000/1001"; NULL: what the images say */
    const char *tonemap; /* of EXR images, and only of them: "none", "agx" or "aces" */
    float exposure;      /* of these, in stops */
    uint32_t quality;    /* as in kiln_render_params */
    uint32_t threads;    /* 0 takes one a core */
    bool overwrite;
    void (*progress)(void *user, const struct kiln_progress *progress); /* pixels alone: no state */
    bool (*stop)(void *user); /* asked now and then; true ends with KILN_INTERRUPTED */
    void *user;
    const struct kiln_cancel *cancel; /* NULL: nobody cancels */
    struct kiln_budget *budget;       /* NULL: no limits */
    struct kiln_log log;
};
KILN_EMPTY(kiln_encode_params, kiln_encode_params_empty)

static inline struct kiln_encode_params kiln_encode_defaults(void)
{
    struct kiln_encode_params params = kiln_encode_params_empty();
    params.quality = 80;
    return params;
}

/* Makes a clip of images. Of PNG images by kiln, of the depth that the format takes, it has the
 * bytes of a clip that kiln_render would have written of the same frames. frames gets their range.
 * KILN_INVALID_INPUT when images cannot be read, leave out a frame, or are not of one clip;
 * KILN_USAGE, KILN_IO, KILN_INTERRUPTED. */
KILN_API bool kiln_encode(const struct kiln_encode_params *params, struct kiln_frame_range *frames,
                          struct kiln_error *error);

/* ---- Plans ---------------------------------------------------------------------------------- */

/* What a scene costs, measured by drawing one of its frames. CPU times are of all threads. */
struct kiln_plan {
    size_t size;
    uint32_t parts, part_frames; /* of the clip; frames of a part but the last */
    uint32_t frame;              /* the one that was drawn */
    uint64_t steps;              /* that were done for it */
    double setup_cpu_s;          /* programs, textures, buffers */
    double step_cpu_s;           /* a step, in the mean of those */
    double frame_cpu_s;          /* a frame, its steps and its encoding apart */
    uint64_t memory_bytes;       /* the most that the process had at once */
    char motion[65], techniques[256];
};
KILN_EMPTY(kiln_plan, kiln_plan_empty)

/* One of several tasks that draw a clip together: whole parts, as many as the others or one more.
 */
struct kiln_plan_task {
    size_t size;
    uint32_t index, count;          /* from 0; of so many */
    uint32_t first_part, end;       /* parts first_part to end - 1; none where they are equal */
    struct kiln_frame_range frames; /* of these */
    bool has_state;
    uint32_t state_step; /* of the state that it starts at; else it steps from 0 */
    uint64_t steps;      /* from there */
    double cpu_s;        /* set-up, steps and frames */
};

struct kiln_plan_params {
    size_t size;
    uint32_t tasks;     /* at least 1 */
    const char *states; /* a folder of kiln_bake, or NULL */
    int64_t frame;      /* to measure; -1: the middle one */
    const char *const *techniques;
    size_t technique_count;
    uint32_t threads;
    bool (*stop)(void *user); /* asked between steps; true ends with KILN_INTERRUPTED */
    /* Told of each task in turn, with plan filled. */
    void (*task)(void *user, const struct kiln_plan *plan, const struct kiln_plan_task *task);
    void *user;
    const struct kiln_cancel *cancel; /* NULL: nobody cancels */
    struct kiln_log log;
};
KILN_EMPTY(kiln_plan_params, kiln_plan_params_empty)

static inline struct kiln_plan_params kiln_plan_defaults(void)
{
    struct kiln_plan_params params = kiln_plan_params_empty();
    params.tasks = 1;
    params.frame = -1;
    return params;
}

/* Measures and tells what each task would do. KILN_USAGE for a frame that there is not, or the
 * errors of kiln_render. */
KILN_API bool kiln_plan_tasks(struct kiln_device *device, const struct kiln_scene *scene,
                              const struct kiln_plan_params *params, struct kiln_plan *plan,
                              struct kiln_error *error);

#ifdef __cplusplus
}
#endif

#endif
