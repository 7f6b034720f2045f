/* Runs kiln figure sheet, which lays out renders of a scene over sweeps of parameters in a grid. */
#include "event.h"
#include "figure_make.h"
#include "overrides.h"

static const struct option options[] = {
    FIGURE_OUTPUT_OPTIONS,
    {.name = "sweep",
     .repeats = true,
     .kind = OPTION_PAIRS,
     .placeholder = "KEY=VALUE,...",
     .help = "A picture for each value of a key, such as systems.*.emit.rate=5,25,200 or "
             "seed=1,2,3; 'frame' and 'time' (in seconds) are keys, too. Several make their "
             "product, of which the last changes fastest."},
    {.name = "with",
     .repeats = true,
     .kind = OPTION_PAIRS,
     .placeholder = "KEY=VALUE,...",
     .help = "Change another key along with the sweep before it, value by value."},
    {.name = "variant",
     .repeats = true,
     .kind = OPTION_PAIRS,
     .placeholder = "KEY=VALUE;...",
     .help = "A picture with these changes; those that follow each other are one sweep."},
    {.name = "frames",
     .letter = 'f',
     .kind = OPTION_FRAMES,
     .placeholder = "RANGES",
     .help = "The frame to show; of several, such as 0-100/10 or last, a picture each.",
     .fallback = "the middle one"},
    {.name = "columns",
     .kind = OPTION_INTEGER,
     .placeholder = "N",
     .help = "Pictures in a row.",
     .fallback = "as many as the last of several sweeps has values, or those of a square",
     .min = 1,
     .max = 1024},
    FIGURE_SCENE_OPTIONS,
    FIGURE_LOOK_OPTIONS,
    FIGURE_THREADS_OPTION,
    EVENTS_OPTION,
    HELP_OPTION,
};

static int run(const struct arguments *arguments)
{
    return figure_make(&figure_sheet_command, KILN_FIGURE_SHEET, arguments, NULL);
}

const struct command figure_sheet_command = {
    .name = "figure sheet",
    .summary = "a sheet of pictures over sweeps of parameters",
    .operands = "SCENE...",
    .description =
        "Renders a scene, or several, with one picture for each value of a sweep, and lays them "
        "out in a grid with labels of what was changed. Renders are those of 'kiln render' with "
        "the techniques that make the same picture on every machine.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .least_operands = 1,
    .most_operands = 64,
    .run = run,
};
