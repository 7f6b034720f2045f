/* Table 2 of UberFlow (Kipfer, Segal and Westermann 2004), in today's terms: a texture of n^2
 * particles is so many particles, and frames a second stay frames a second. */
#include "bench/suite.h"

static const char SCENE[] = "bench/cloud.yaml";

/* n^2 particles of each kind, of which one is left out. */
static void set_field(const struct kiln_bench_run *run, struct kiln_settings *settings, double side)
{
    kiln_set_number(run, settings, "systems.*.emit.rate", side * side);
    kiln_set_number(run, settings, "systems.*.look.size", 0.03);
}

/* An experiment: what it is on the device, and what `auto` makes of it. Fire alone is summed and
 * needs no order; smoke alone is sorted. */
static const struct experiment {
    const char *name;
    const char *techniques; /* of the device's lane */
    const char *lane;
    bool collides, sorted, automatic;
    double published[3];
} EXPERIMENTS[] = {
    {"E1 motion",
     "simulate=inplace backdrop=gl raster=geometry composite=gl",
     "on the device",
     false,
     false,
     true,
     {640, 320, 120}},
    {"E2 collisions",
     "simulate=inplace backdrop=gl raster=geometry composite=gl",
     "on the device",
     true,
     false,
     true,
     {155, 96, 42}},
    {"E3 sorted",
     "simulate=inplace sort=bitonic backdrop=gl raster=geometry composite=gl",
     "on the device",
     false,
     true,
     true,
     {39, 8, 1.4}},
    {"E5 sorted, CPU",
     "simulate=cpu sort=cpu backdrop=gl raster=geometry composite=gl",
     "by the CPU, drawn by the device",
     false,
     true,
     false,
     {7, 2, 0.4}},
};
enum { EXPERIMENT_COUNT = sizeof EXPERIMENTS / sizeof *EXPERIMENTS };

static bool run_experiment(const struct kiln_bench_run *run, const struct experiment *experiment,
                           double side, size_t size, struct kiln_error *error)
{
    const struct kiln_lane lanes[] = {
        {.name = experiment->lane, .techniques = experiment->techniques},
        {.name = "auto", .techniques = ""}};
    struct kiln_settings settings = {.count = 0};
    set_field(run, &settings, side);
    kiln_set_picture(run, &settings, 1280, 720);
    kiln_set(run, &settings, "post.bloom.kind=none");
    kiln_set(run, &settings,
             experiment->sorted ? "systems.fire.enabled=false" : "systems.smoke.enabled=false");
    if (!experiment->collides)
        kiln_set(run, &settings, "systems.*.collide=none");
    const struct kiln_comparison comparison = {.scene = SCENE,
                                               .settings = &settings,
                                               .lanes = lanes,
                                               .lane_count = experiment->automatic ? 2 : 1,
                                               .measures = KILN_MEASURE_WHOLE,
                                               .as = experiment->name,
                                               .x = side,
                                               .rates = true};
    kiln_bench_say(run, "%s, %.0f x %.0f particles", experiment->name, side, side);
    return kiln_compare_lanes(run, &comparison, error) &&
           kiln_bench_publish(run, side, experiment->name, "2004", experiment->published[size],
                              KILN_UBERFLOW_SOURCE, error);
}

bool kiln_suite_table_2(const struct kiln_bench_run *run, struct kiln_error *error)
{
    static const double sides[] = {256, 512, 1024};
    const struct kiln_bench_part part = {
        .name = "table2",
        .title = "UberFlow, table 2: whole frames of n x n particles at 1280x720",
        .sweep = "n",
        .unit = "fps",
        .reference = "on the device",
        .plotted = true,
    };
    if (!kiln_bench_begin(run, &part, error))
        return false;
    size_t count = run->params->quick ? 1 : sizeof sides / sizeof *sides;
    for (size_t i = 0; i < count; i++) {
        for (size_t k = 0; k < EXPERIMENT_COUNT; k++) {
            if (!run_experiment(run, &EXPERIMENTS[k], sides[i], i, error))
                return false;
        }
    }
    return kiln_bench_add_note(
               run->bench, error,
               "E2 collides with six boxes instead of a height field: kiln has none yet. E4, "
               "collisions between particles, comes with these (published: 133, 31 and 7).") &&
           kiln_bench_add_note(run->bench, error,
                               "Sprites are of 4 pixels with texture, soft and tone-mapped; those "
                               "of 2004 were points, each of its one colour.");
}
