/* Runs the suite `bytes` of `kiln bench`, which measures what techniques cost besides time (Heinz
 * 2019, 4.2): memory, and bytes between host and device. */
#include <stdlib.h>

#include "base/error.h"
#include "bench/papers/papers.h"

/* Each entry is a combination of techniques for simulating, sorting and drawing. The thesis
 * compares the combinations that have a published name. */
static const struct {
    const char *techniques;
    const char *published; /* name of the combination in the thesis, or NULL */
    double memory;         /* published bytes a particle, from the MiB of 160,000 */
    double upload;         /* published bytes a particle to the device, from its floats */
} COMBINATIONS[] = {
    {"simulate=cpu sort=cpu backdrop=gl raster=geometry composite=gl", "CPU (2019)", 43.9, 32},
    {"simulate=feedback sort=bitonic backdrop=gl raster=geometry composite=gl",
     "transform feedback (2019)", 94.4, 0},
    {"simulate=pingpong sort=bitonic backdrop=gl raster=geometry composite=gl",
     "compute, two buffers (2019)", 94.4, 0},
    {"simulate=inplace sort=bitonic backdrop=gl raster=geometry composite=gl",
     "compute, one buffer (2019)", 50.5, 0},
    {"simulate=inplace sort=radix backdrop=gl raster=geometry composite=gl", NULL, 0, 0},
    {"simulate=inplace sort=cpu backdrop=gl raster=geometry composite=gl", NULL, 0, 0},
    {"simulate=cpu sort=cpu raster=cpu", NULL, 0, 0},
};
enum { COMBINATION_COUNT = sizeof COMBINATIONS / sizeof *COMBINATIONS };

static bool add_value(const struct kiln_bench_run *run, double particles, const char *measure,
                      const char *technique, double value, struct kiln_error *error)
{
    const struct kiln_bench_row row = {.x = particles,
                                       .measure = measure,
                                       .technique = technique,
                                       .spread = kiln_spread_of(&value, 1)};
    return kiln_bench_add_row(run->bench, &row, error);
}

/* Adds rows for the memory of the lane's techniques: the records of particles, and the buffers of
 * sorting. */
static bool add_memory(const struct kiln_bench_run *run, size_t combination, double particles,
                       const struct kiln_lane *lane, struct kiln_error *error)
{
    struct kiln_lane_flags flags;
    const struct kiln_render_params params = kiln_lane_params(run, lane, &flags, NULL);
    struct kiln_techniques techniques;
    if (!kiln_techniques_choose(kiln_device_get_info(run->device), params.techniques,
                                params.technique_count, &techniques, error))
        return false;
    double records = (double)kiln_simulate_slot_bytes(techniques.simulate);
    enum { SLOTS = 1 << 20 }; /* so many that padding is negligible */
    const uint64_t sorted = kiln_sort_bytes(techniques.sort, SLOTS);
    double sorting = (double)sorted / SLOTS;
    return add_value(run, particles, "memory, records", COMBINATIONS[combination].techniques,
                     records, error) &&
           add_value(run, particles, "memory, sorting", COMBINATIONS[combination].techniques,
                     sorting, error);
}

static bool add_published(const struct kiln_bench_run *run, size_t combination,
                          struct kiln_error *error)
{
    static const char source[] = "Heinz 2019, 4.2";
    return !COMBINATIONS[combination].published ||
           (kiln_bench_publish(run, 160000, "memory, all", COMBINATIONS[combination].published,
                               COMBINATIONS[combination].memory, source, error) &&
            kiln_bench_publish(run, 160000, "to the device", COMBINATIONS[combination].published,
                               COMBINATIONS[combination].upload, source, error));
}

static bool add_ways(const struct kiln_bench_run *run, const struct kiln_lane *lanes,
                     const struct kiln_samples *samples, double particles, struct kiln_error *error)
{
    for (size_t i = 0; i < COMBINATION_COUNT; i++) {
        const struct kiln_samples *s = &samples[i];
        if (s->problem) {
            if (!kiln_bench_add_note(run->bench, error, "Not measured: %s: %s.", lanes[i].name,
                                     s->problem))
                return false;
            continue;
        }
        double alive = s->alive ? (double)s->alive : 1.0;
        if (!add_memory(run, i, particles, &lanes[i], error) ||
            !add_value(run, particles, "to the device", lanes[i].name, s->to_device / alive,
                       error) ||
            !add_value(run, particles, "to the host", lanes[i].name, s->to_host / alive, error) ||
            !add_published(run, i, error))
            return false;
    }
    return true;
}

bool kiln_suite_bytes(const struct kiln_bench_run *run, struct kiln_error *error)
{
    const struct kiln_bench_part part = {
        .name = "bytes",
        .title = "Bytes of a particle: memory, and in a frame of one step between host and device",
        .sweep = "particles",
        .unit = "bytes",
    };
    if (!kiln_bench_begin(run, &part, error))
        return false;
    struct kiln_lane lanes[COMBINATION_COUNT];
    for (size_t i = 0; i < COMBINATION_COUNT; i++)
        lanes[i] = (struct kiln_lane){.name = COMBINATIONS[i].techniques,
                                      .techniques = COMBINATIONS[i].techniques};
    double particles = run->params->quick ? 1600 : 160000;
    struct kiln_settings settings = {.count = 0};
    kiln_set_number(run, &settings, "systems.*.emit.rate", particles / 2);
    kiln_set_small_picture(run, &settings);
    kiln_bench_say(run, "%.0f particles", particles);
    struct kiln_scene *scene = kiln_bench_load_scene(run, "bench/cloud.yaml", &settings, error);
    struct kiln_samples *samples = calloc(COMBINATION_COUNT, sizeof *samples);
    if (scene && !samples)
        kiln_error_no_memory(error, "measurements");
    bool ok = scene && samples &&
              kiln_contest_run(run, scene, 0, lanes, COMBINATION_COUNT, samples, error) &&
              add_ways(run, lanes, samples, particles, error);
    free(samples);
    kiln_scene_destroy(&scene);
    return ok &&
           kiln_bench_add_note(
               run->bench, error,
               "The picture has 64x36 pixels; its bytes are among those that move. On a software "
               "device, the bytes stay in the same memory but are copied all the same.");
}
