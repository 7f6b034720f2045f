/* Runs the suite `table2` of `kiln bench`, which measures table 2 of UberFlow (Kipfer, Segal and
 * Westermann 2004). The paper's texture of n x n particles is n^2 particles here; both count frames
 * a second. */
#include "bench/papers/papers.h"

static const char SCENE[] = "bench/cloud.yaml";

/* Sets n^2 particles of each kind, fire and smoke; n is `side`. Each experiment leaves one kind
 * out. */
static void set_field(const struct kiln_bench_run *run, struct kiln_settings *settings, double side)
{
    kiln_set_number(run, settings, "systems.*.emit.rate", side * side);
    kiln_set_number(run, settings, "systems.*.look.size", 0.03);
}

/* Further settings of the experiments; each list ends in NULL. */
static const char *const FREE[] = {"systems.*.collide=none", NULL};
static const char *const HEIGHT_FIELD[] = {
    "backdrop.objects=[terrain: {size: [12, 1.2, 8], samples: [257, 257], hills: 3 m}]",
    "systems.*.forces=[gravity: [0, -4, 0]]",
    NULL,
};
static const char *const STAGGERED[] = {
    "systems.*.collide=none",
    "systems.*.interact=[collide: {mode: staggered, radius: 1.5 cm, rounds: 1}]",
    NULL,
};
static const char *const EXACT_CELLS[] = {
    "systems.*.collide=none",
    "systems.*.interact=[collide: {mode: exact, radius: 1.5 cm, rounds: 1}]",
    NULL,
};

#define ON_DEVICE "backdrop=gl raster=geometry composite=gl"

/* An experiment, which runs with techniques of the device, with those of `auto`, or with both. If
 * it is sorted, it draws smoke alone; else it draws fire alone, which is blended additively and
 * needs no order. */
static const struct experiment {
    const char *name;
    const char *techniques; /* techniques of the device's lane; NULL: there is no such lane */
    const char *lane;
    const char *const *settings;
    bool sorted, automatic;
    double published[3]; /* frames a second; 0: not published */
} EXPERIMENTS[] = {
    {"E1 motion",
     "simulate=inplace " ON_DEVICE,
     "on the device",
     FREE,
     false,
     true,
     {640, 320, 120}},
    {"E2 height field",
     "simulate=inplace " ON_DEVICE,
     "on the device",
     HEIGHT_FIELD,
     false,
     true,
     {155, 96, 42}},
    {"E3 sorted",
     "simulate=inplace sort=bitonic " ON_DEVICE,
     "on the device",
     FREE,
     true,
     true,
     {39, 8, 1.4}},
    {"E4 collisions", NULL, NULL, STAGGERED, false, true, {133, 31, 7}},
    {"E4 collisions, none missed", NULL, NULL, EXACT_CELLS, false, true, {0, 0, 0}},
    {"E5 sorted, CPU",
     "simulate=cpu sort=cpu " ON_DEVICE,
     "by the CPU, drawn by the device",
     FREE,
     true,
     false,
     {7, 2, 0.4}},
};
enum { EXPERIMENT_COUNT = sizeof EXPERIMENTS / sizeof *EXPERIMENTS };

static bool run_experiment(const struct kiln_bench_run *run, const struct experiment *experiment,
                           double side, size_t size, struct kiln_error *error)
{
    struct kiln_lane lanes[2];
    size_t lane_count = 0;
    if (experiment->techniques)
        lanes[lane_count++] =
            (struct kiln_lane){.name = experiment->lane, .techniques = experiment->techniques};
    if (experiment->automatic)
        lanes[lane_count++] = (struct kiln_lane){.name = "auto", .techniques = ""};
    struct kiln_settings settings = {.count = 0};
    set_field(run, &settings, side);
    kiln_set_picture(run, &settings, 1280, 720);
    kiln_set(run, &settings, "post.bloom.kind=none");
    kiln_set(run, &settings,
             experiment->sorted ? "systems.fire.enabled=false" : "systems.smoke.enabled=false");
    for (const char *const *setting = experiment->settings; *setting; setting++)
        kiln_set(run, &settings, *setting);
    const struct kiln_comparison comparison = {.scene = SCENE,
                                               .settings = &settings,
                                               .lanes = lanes,
                                               .lane_count = lane_count,
                                               .measures = KILN_MEASURE_WHOLE,
                                               .as = experiment->name,
                                               .x = side,
                                               .rates = true};
    kiln_bench_say(run, "%s, %.0f x %.0f particles", experiment->name, side, side);
    if (!kiln_compare_lanes(run, &comparison, error))
        return false;
    const double published = experiment->published[size];
    return published == 0.0 || kiln_bench_publish(run, side, experiment->name, "2004", published,
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
               "E4 searches as the paper does, in two staggered grids and 8 particles to each "
               "side, or in all cells around, so that no pair is missed. Sorting networks on a "
               "software device would take seconds for it.") &&
           kiln_bench_add_note(run->bench, error,
                               "The sprites have 4 pixels with texture, soft and tone-mapped. "
                               "Those of 2004 were points of one colour each.");
}
