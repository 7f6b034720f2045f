/* Implements the library's calls to render: a whole job (kiln_render), or a job frame by frame in
 * the program's own loop (kiln_rendering_next). */
#include <pthread.h>
#include <stdlib.h>

#include "base/error.h"
#include "base/sized.h"
#include "job/frame.h"
#include "job/hold.h"
#include "job/job.h"

struct kiln_rendering {
    struct kiln_render_params params;
    struct kiln_flipbook flipbook;
    struct kiln_device *device;
    const struct kiln_scene *scene;
    pthread_t thread; /* the one that began the job */
    struct kiln_job *job;
    bool ended;                /* no frame is left to draw */
    struct kiln_error failure; /* the error of a frame; code 0: none */
};

/* Copies the parameters into the job's own. */
static bool take(struct kiln_rendering *r, const struct kiln_render_params *params,
                 struct kiln_error *error)
{
    r->params = kiln_render_defaults();
    r->flipbook = kiln_flipbook_empty();
    if (!kiln_sized_take(&r->params, params, "kiln_render_params", error) ||
        !kiln_sized_take(&r->flipbook, r->params.flipbook, "kiln_flipbook", error))
        return false;
    r->params.flipbook = r->params.flipbook ? &r->flipbook : NULL;
    return true;
}

struct kiln_rendering *kiln_rendering_begin(struct kiln_device *device,
                                            const struct kiln_scene *scene,
                                            const struct kiln_render_params *params,
                                            struct kiln_error *error)
{
    struct kiln_rendering *r = calloc(1, sizeof *r);
    if (!r) {
        kiln_error_no_memory(error, "a job");
        return NULL;
    }
    r->device = device;
    r->scene = scene;
    r->thread = pthread_self();
    if (take(r, params, error) && kiln_hold_take(device, scene, error)) {
        r->job = kiln_job_create(device, scene, &r->params, error);
        if (r->job)
            return r;
        kiln_hold_release(device, scene);
    }
    free(r);
    return NULL;
}

/* Returns false with KILN_USAGE on another thread than the job's. Reads nothing that the job's own
 * thread may be changing. */
static bool check_thread(const struct kiln_rendering *r, struct kiln_error *error)
{
    return pthread_equal(r->thread, pthread_self()) ||
           kiln_error_set(
               error, KILN_USAGE,
               "the job belongs to another thread: the one that began it draws and ends it");
}

bool kiln_rendering_next(struct kiln_rendering *r, bool *drawn, struct kiln_progress *progress,
                         struct kiln_error *error)
{
    *drawn = false;
    if (!check_thread(r, error) || !kiln_sized_check(progress, "kiln_progress", error))
        return false;
    if (!kiln_hold_check(r->device, r->scene, &r->failure) ||
        !kiln_device_make_current(r->device, &r->failure) ||
        !kiln_job_next(r->job, drawn, &r->failure))
        return kiln_error_set(error, r->failure.code, "%s", r->failure.message);
    r->ended = !*drawn;
    if (*drawn)
        kiln_sized_give(progress, kiln_job_progress(r->job));
    return true;
}

struct kiln_frame *kiln_rendering_take_frame(struct kiln_rendering *r, struct kiln_error *error)
{
    if (!check_thread(r, error))
        return NULL;
    struct kiln_picture *picture = kiln_job_take_picture(r->job);
    if (picture)
        return kiln_frame_create(picture, error);
    kiln_error_set(error, KILN_USAGE,
                   r->params.keep_frames ? "no frame was drawn since one was taken"
                                         : "frames are not kept: set keep_frames to take them");
    return NULL;
}

bool kiln_rendering_end(struct kiln_rendering **rendering, struct kiln_render_stats *stats,
                        struct kiln_error *error)
{
    struct kiln_rendering *r = rendering ? *rendering : NULL;
    if (!r)
        return true;
    if (!check_thread(r, error))
        return false;
    struct kiln_render_stats done = kiln_render_stats_empty();
    bool ok = kiln_device_make_current(r->device, error) &&
              kiln_sized_check(stats, "kiln_render_stats", error) &&
              kiln_hold_check(r->device, r->scene, error);
    if (ok && !r->ended)
        ok = kiln_error_set(error, KILN_INTERRUPTED, "ended before the last frame");
    ok = ok && kiln_job_finish(r->job, &done, error);
    if (ok)
        kiln_sized_give(stats, &done);
    else
        kiln_job_fail(r->job, r->failure.code ? &r->failure : error);
    kiln_job_destroy(&r->job);
    kiln_hold_release(r->device, r->scene);
    free(r);
    *rendering = NULL;
    return ok;
}

bool kiln_render(struct kiln_device *device, const struct kiln_scene *scene,
                 const struct kiln_render_params *params, struct kiln_render_stats *stats,
                 struct kiln_error *error)
{
    if (!kiln_sized_check(stats, "kiln_render_stats", error))
        return false;
    struct kiln_rendering *rendering = kiln_rendering_begin(device, scene, params, error);
    bool ok = rendering != NULL;
    for (bool drawn = ok; ok && drawn;)
        ok = kiln_rendering_next(rendering, &drawn, NULL, error);
    struct kiln_error why = kiln_error_empty(); /* the first error is the one that is reported */
    if (rendering && !kiln_rendering_end(&rendering, stats, ok ? error : &why))
        ok = false;
    return ok;
}
