/* Creates the backdrop stage (floor, sky and solid objects) with the technique that a test has
 * chosen, draws it in the light of lamps, and runs tests with every technique. */
#include "support/backdrops.h"

#include "draw/light/lamps.h"
#include "support/device.h"
#include "support/parts.h"

enum kiln_backdrop_technique backdrop_technique = KILN_BACKDROP_GL;

/* Returns the worker threads that all backdrops share. They live until the program ends. */
static struct kiln_threads *backdrop_threads(void)
{
    static struct kiln_threads *threads;
    if (!threads)
        threads = kiln_threads_create(2);
    return threads;
}

struct kiln_backdrop_stage *backdrop_create(struct kiln_device *device,
                                            const struct kiln_moment *moment,
                                            struct kiln_image *color, struct kiln_image *depth,
                                            struct kiln_error *error)
{
    const struct kiln_backdrop_params params = {.technique = backdrop_technique,
                                                .threads = backdrop_threads(),
                                                .color = color,
                                                .depth = depth};
    return kiln_backdrop_create(device, moment, &params, error);
}

bool backdrop_draw_by_lamps(struct kiln_backdrop_stage *stage, const struct kiln_moment *moment,
                            struct kiln_error *error)
{
    struct kiln_lighting lighting = {.light_count = 0};
    lighting.light_count = kiln_lamps_fill(moment, lighting.lights);
    kiln_lamps_find_casters(moment, lighting.lights, lighting.light_count);
    return kiln_backdrop_draw(stage, moment, &lighting, error);
}

int backdrops_run(const char *name, const struct CMUnitTest *tests, size_t count, bool sampled,
                  int argc, char **argv)
{
    static const enum kiln_backdrop_technique techniques[] = {KILN_BACKDROP_CPU, KILN_BACKDROP_GL};
    int failed = 0;
    for (int i = 0; i < (sampled && !test_is_full() ? 1 : 2); i++) {
        struct test_list list = {.count = 0};
        test_list_add(&list, tests, count);
        backdrop_technique = techniques[i];
        failed += test_list_run(&list, name, argc, argv, test_device_open, test_device_close);
    }
    return failed;
}
