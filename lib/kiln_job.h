/* Declares jobs that are done in parts, and the files that outlive a job. This header is part of
 * kiln.h, which includes it. */
#ifndef KILN_JOB_H
#define KILN_JOB_H

#include "kiln.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Returns the number of frames of a part: about two seconds, at most 600 frames. A clip is a
 * sequence of parts of this length that do not depend on each other; the last may be shorter. */
KILN_API uint32_t kiln_part_frames(uint32_t fps_num, uint32_t fps_den);

/* ---- Saved states --------------------------------------------------------------------------- */

/* A saved state: all that a run carries from one step to the next. It serves every scene of the
 * same motion, however the scene looks, on every device and with every technique. */
struct kiln_baked {
    size_t size;
    uint32_t frame, frames; /* the frame that the state precedes; number of states to be saved */
    uint32_t done;          /* number of states saved so far, this one included */
    uint32_t step;          /* number of steps that led to the state */
    uint64_t alive;         /* living particles */
    uint64_t bytes;         /* size of the file */
    bool kept;              /* the file was there already */
    const char *file;       /* path, valid until the callback returns */
};

struct kiln_bake_params {
    size_t size;
    const char *states;            /* the folder; it is made if it is missing */
    uint32_t every;                /* frames between two states; 0: one before each part */
    const char *const *techniques; /* "stage=name"; a history that they keep is saved, too */
    size_t technique_count;
    uint32_t threads; /* 0 takes one a core */
    bool overwrite;   /* replace states that are there; without overwrite and resume, a state that
                         is there is KILN_USAGE */
    bool resume;      /* keep states that are whole, and go on from them */
    void (*saved)(void *user, const struct kiln_baked *state); /* called for each state, or NULL */
    bool (*stop)(void *user); /* called between steps; true ends with KILN_INTERRUPTED */
    void *user;
    const struct kiln_cancel *cancel; /* NULL: nobody cancels */
    struct kiln_log log;
};
KILN_EMPTY(kiln_bake_params, kiln_bake_defaults)

struct kiln_bake_stats {
    size_t size;
    uint32_t states, kept; /* number of states that are there now, and that were there before */
    uint64_t steps;        /* steps that this run simulated */
    uint64_t bytes;        /* size of the files that were written */
    double total_s;
    char motion[65]; /* hash of the scene's motion, which the names of the files begin with */
};
KILN_EMPTY(kiln_bake_stats, kiln_bake_stats_empty)

/* Steps through the clip once and saves states. A file appears under its name only when it is
 * whole. No state is saved before the first step. `stats` may be NULL. KILN_USAGE, KILN_IO,
 * KILN_INTERRUPTED, or the errors of kiln_render. */
KILN_API bool kiln_bake(struct kiln_device *device, const struct kiln_scene *scene,
                        const struct kiln_bake_params *params, struct kiln_bake_stats *stats,
                        struct kiln_error *error);

/* ---- Exporting gas -------------------------------------------------------------------------- */

enum kiln_up { KILN_UP_Y, KILN_UP_Z };

/* A file of an export, which is whole. */
struct kiln_exported {
    size_t size;
    uint32_t frame;
    uint32_t done, total; /* files that this job has written, and will have written */
    uint64_t bytes;       /* size of the file */
    uint64_t voxels;      /* active voxels of the density */
    double elapsed_s;     /* since the start */
    const char *gas;      /* name of the domain, valid until the callback returns */
    const char *file;     /* path, valid until the callback returns */
};

struct kiln_export_params {
    size_t size;
    const char *output; /* "gas_####.vdb"; "{gas}" in it stands for the name of the domain */
    const char *gas;    /* name of the only domain to export; NULL: all that are enabled */
    const struct kiln_frame_range *ranges; /* ascending; none: all frames */
    size_t range_count;
    enum kiln_up up;    /* the axis of the files that points up: Y as in Houdini, Z as in Blender */
    bool half;          /* values are written as halves, else as floats */
    bool unit;          /* temperatures are from 0 to 1, else in kelvin */
    double cutoff;      /* voxels with less density, temperature (0 to 1) and flame are left out */
    const char *states; /* a folder of kiln_bake to start from, or NULL */
    const char *const *techniques; /* "stage=name" */
    size_t technique_count;
    uint32_t threads; /* 0 takes one a core */
    bool overwrite;   /* replace files that exist; without it, such a file is KILN_USAGE */
    void (*exported)(void *user, const struct kiln_exported *file); /* called for each, or NULL */
    bool (*stop)(void *user); /* called between steps and parts of files; true ends with
                                 KILN_INTERRUPTED */
    void *user;
    const struct kiln_cancel *cancel; /* NULL: nobody cancels */
    struct kiln_log log;
};

static inline struct kiln_export_params kiln_export_defaults(void)
{
    struct kiln_export_params params;
    memset(&params, 0, sizeof params);
    params.size = sizeof params;
    params.cutoff = 0.001;
    return params;
}

struct kiln_export_stats {
    size_t size;
    uint32_t frames, files;
    uint64_t steps; /* steps that this run simulated */
    uint64_t bytes; /* size of the files */
    double total_s;
    char first_file[KILN_PATH_SIZE];
};
KILN_EMPTY(kiln_export_stats, kiln_export_stats_empty)

/* Steps a scene through frames and writes its gas as OpenVDB files, one for each frame and domain,
 * each with the grids density, temperature, flame and vel, and Cd if smoke has colours of its own.
 * A file appears under its name only when it is whole. `stats` may be NULL. KILN_USAGE for a scene
 * without gas, or the errors of kiln_render. */
KILN_API bool kiln_export(struct kiln_device *device, const struct kiln_scene *scene,
                          const struct kiln_export_params *params, struct kiln_export_stats *stats,
                          struct kiln_error *error);

/* ---- Joining -------------------------------------------------------------------------------- */

struct kiln_join_params {
    size_t size;
    const char *output;         /* the output of the shards: a clip, or a pattern of images */
    const char *manifest;       /* a JSON file that describes the job, or NULL */
    const char *const *command; /* words of a command line, for the manifest */
    size_t command_count;
    const char *build; /* the program's version and commit, for the manifest, "0.2.0 (254e4dc)";
                          NULL: kiln_version() */
    bool overwrite;    /* replace files that no journal knows; a manifest is always replaced */
    bool (*stop)(void *user); /* called now and then; true ends with KILN_INTERRUPTED */
    void *user;
    const struct kiln_cancel *cancel; /* NULL: nobody cancels */
    struct kiln_budget *budget;       /* NULL: no limits */
    struct kiln_log log;
};
KILN_EMPTY(kiln_join_params, kiln_join_defaults)

struct kiln_join_stats {
    size_t size;
    uint32_t frames, parts; /* of the clip */
    bool was_whole;         /* the clip or all images were there already */
    double total_s;
};
KILN_EMPTY(kiln_join_stats, kiln_join_stats_empty)

/* Makes the clip of the parts that shards drew or, for images, checks whether all are there.
 * `stats` may be NULL. When parts or frames are missing or damaged, writes nothing and returns
 * false with KILN_IO and their numbers. */
KILN_API bool kiln_join(const struct kiln_join_params *params, struct kiln_join_stats *stats,
                        struct kiln_error *error);

/* ---- Encoding ------------------------------------------------------------------------------- */

struct kiln_encode_params {
    size_t size;
    const char *frames;  /* images: a folder, taken in the order of names, or a numbered pattern */
    const char *output;  /* a clip */
    const char *fps;     /* "30", "29.97" or "30000/1001"; NULL: what the images say */
    const char *tonemap; /* for EXR and HDR, and only for them: "none", "agx" or "aces" */
    float exposure;      /* for EXR and HDR, in stops */
    uint32_t quality;    /* as in kiln_render_params */
    uint32_t threads;    /* 0 takes one a core */
    bool overwrite;
    /* Called after each frame; `alive` and `state` are zero. */
    void (*progress)(void *user, const struct kiln_progress *progress);
    bool (*stop)(void *user); /* called now and then; true ends with KILN_INTERRUPTED */
    void *user;
    const struct kiln_cancel *cancel; /* NULL: nobody cancels */
    struct kiln_budget *budget;       /* NULL: no limits */
    struct kiln_log log;
};

static inline struct kiln_encode_params kiln_encode_defaults(void)
{
    struct kiln_encode_params params;
    memset(&params, 0, sizeof params);
    params.size = sizeof params;
    params.quality = 80;
    return params;
}

/* Makes a clip of images. PNG images by kiln, of the depth that the format takes, give the same
 * bytes as a clip that kiln_render writes of these frames. *frames gets the range of the frames.
 * KILN_INVALID_INPUT when images cannot be read, leave out a frame, or do not belong to one clip;
 * KILN_USAGE, KILN_IO, KILN_INTERRUPTED. */
KILN_API bool kiln_encode(const struct kiln_encode_params *params, struct kiln_frame_range *frames,
                          struct kiln_error *error);

/* ---- Plans ---------------------------------------------------------------------------------- */

/* The cost of a scene, measured by drawing its lightest and its heaviest frame, as its births tell
 * them, or the one that the caller chose. CPU times are sums over all threads. */
struct kiln_plan {
    size_t size;
    uint32_t parts, part_frames; /* number of parts of the clip; frames of each but the last */
    uint32_t frame;              /* the heaviest frame, or the chosen one */
    uint64_t steps;              /* steps that were made to reach the frames */
    double setup_cpu_s;          /* time of loading the scene, and of making programs, textures
                                  * and buffers */
    double step_cpu_s;           /* mean time of a step */
    double frame_cpu_s;          /* time of a frame without its steps and its encoding */
    uint64_t memory_bytes;       /* peak memory of the process */
    /* the hash of the scene's motion; "simulate=cpu sort=cpu ..." */
    char motion[65], techniques[256];
};
KILN_EMPTY(kiln_plan, kiln_plan_empty)

/* One of several tasks that draw a clip together. A task has whole parts; the numbers of parts of
 * two tasks differ by at most one. */
struct kiln_plan_task {
    size_t size;
    uint32_t index, count;          /* number of the task from 0, and number of tasks */
    uint32_t first_part, end;       /* parts first_part to end - 1; none where they are equal */
    struct kiln_frame_range frames; /* frames of these parts */
    bool has_state;                 /* the task starts from a saved state; else from step 0 */
    uint32_t state_step;            /* the step of that state */
    uint64_t steps;                 /* steps from there to the last frame */
    double cpu_s;                   /* time of set-up, steps and frames */
};

struct kiln_plan_params {
    size_t size;
    uint32_t tasks;                /* at least 1 */
    const char *states;            /* a folder of kiln_bake, or NULL */
    int64_t frame;                 /* the frame to measure; -1: two of them */
    const char *const *techniques; /* "stage=name" */
    size_t technique_count;
    uint32_t threads;         /* 0 takes one a core */
    bool (*stop)(void *user); /* called between steps; true ends with KILN_INTERRUPTED */
    /* Called for each task in turn; the plan is filled. */
    void (*task)(void *user, const struct kiln_plan *plan, const struct kiln_plan_task *task);
    void *user;
    const struct kiln_cancel *cancel; /* NULL: nobody cancels */
    struct kiln_log log;
};

static inline struct kiln_plan_params kiln_plan_defaults(void)
{
    struct kiln_plan_params params;
    memset(&params, 0, sizeof params);
    params.size = sizeof params;
    params.tasks = 1;
    params.frame = -1;
    return params;
}

/* Measures the cost of a scene, fills *plan, and calls params->task for each task. KILN_USAGE for a
 * frame that does not exist, or the errors of kiln_render. */
KILN_API bool kiln_plan_tasks(struct kiln_device *device, const struct kiln_scene *scene,
                              const struct kiln_plan_params *params, struct kiln_plan *plan,
                              struct kiln_error *error);

#ifdef __cplusplus
}
#endif

#endif
