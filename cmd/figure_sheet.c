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
     .help =
         "Draw a picture for each value of a key, such as systems.*.emit.rate=5,25,200 or "
         "seed=1,2,3. 'frame' and 'time' (in seconds) are keys, too. Several sweeps are combined: "
         "each value of one with each value of the others, and the last changes fastest."},
    {.name = "with",
     .repeats = true,
     .kind = OPTION_PAIRS,
     .placeholder = "KEY=VALUE,...",
     .help = "Change another key along with the sweep before it, value by value."},
    {.name = "variant",
     .repeats = true,
     .kind = OPTION_PAIRS,
     .placeholder = "KEY=VALUE;...",
     .help = "Draw a picture with these changes. Variants that follow each other are one sweep."},
    {.name = "frames",
     .older_letter = 'f',
     .kind = OPTION_FRAMES,
     .placeholder = "RANGES",
     .help = "The frame to show. Several frames, such as 0-100/10, give one picture each; 'last' "
             "is the last frame.",
     .fallback = "the middle frame"},
    {.name = "columns",
     .kind = OPTION_INTEGER,
     .placeholder = "N",
     .help = "Number of pictures in a row.",
     .fallback = "the number of values of the last of several sweeps, or a square layout",
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
    .summary = "draw a sheet of pictures over sweeps of parameters",
    .operands = "SCENE...",
    .description =
        "Renders a scene or several scenes, with one picture for each value of a sweep. It lays "
        "the pictures out in a grid, with labels that name what was changed. It renders like 'kiln "
        "render', with the techniques that make the same picture on every machine.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .least_operands = 1,
    .most_operands = 64,
    .run = run,
};
