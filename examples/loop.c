/* loop SCENE CLIP.mp4: draws a clip frame by frame in the program's own main loop, does other work
 * between frames, and ends the job at Ctrl-C with nothing half-written. */
#include <kiln.h>
#include <signal.h>
#include <stdio.h>

static struct kiln_cancel *cancel;

static void on_interrupt(int number)
{
    (void)number;
    kiln_cancel_request(cancel);
}

int main(int argc, char **argv)
{
    if (argc != 3) {
        fprintf(stderr, "usage: loop SCENE CLIP.mp4\n");
        return KILN_USAGE;
    }
    struct kiln_error error = kiln_error_empty();
    struct kiln_scene *scene = kiln_scene_load(argv[1], NULL, &error);
    struct kiln_device *device = scene ? kiln_device_open(NULL, &error) : NULL;
    cancel = kiln_cancel_create();
    signal(SIGINT, on_interrupt);

    struct kiln_render_params params = kiln_render_defaults();
    params.output = argv[2];
    params.overwrite = true;
    params.cancel = cancel;
    struct kiln_rendering *job =
        device ? kiln_rendering_begin(device, scene, &params, &error) : NULL;

    bool ok = job != NULL;
    for (bool drawn = ok; ok && drawn;) {
        struct kiln_progress progress = kiln_progress_empty();
        ok = kiln_rendering_next(job, &drawn, &progress, &error);
        if (ok && drawn) /* other work of the program goes here */
            printf("\rframe %u of %u, %llu particles", progress.done, progress.total,
                   (unsigned long long)progress.alive);
        fflush(stdout);
    }
    struct kiln_render_stats stats = kiln_render_stats_empty();
    struct kiln_error at_end = kiln_error_empty();
    if (job && !kiln_rendering_end(&job, &stats, ok ? &error : &at_end))
        ok = false;

    if (ok)
        printf("\n%u frames in %.1f s\n", stats.frames, stats.total_s);
    else
        fprintf(stderr, "\n%s\n", error.message);
    kiln_device_close(&device);
    kiln_scene_destroy(&scene);
    kiln_cancel_destroy(&cancel);
    return ok ? 0 : (int)error.code;
}
