/* Runs kiln figure strip, which shows frames of a clip in a row. */
#include "event.h"
#include "figure_make.h"
#include "overrides.h"

static const struct option options[] = {
    FIGURE_OUTPUT_OPTIONS,
    {.name = "count",
     .older_letter = 'n', /* sidecars of figures may have it */
     .kind = OPTION_INTEGER,
     .placeholder = "N",
     .help = "Number of frames, spread evenly from the first to the last.",
     .fallback = "6",
     .min = 1,
     .max = 1024},
    {.name = "frames",
     .older_letter = 'f',
     .kind = OPTION_FRAMES,
     .placeholder = "RANGES",
     .help = "The frames to show instead, such as 0-100/10 or 3,last."},
    {.name = "columns",
     .kind = OPTION_INTEGER,
     .placeholder = "N",
     .help = "Number of frames in a row.",
     .fallback = "all",
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
    return figure_make(&figure_strip_command, KILN_FIGURE_STRIP, arguments, NULL);
}

const struct command figure_strip_command = {
    .name = "figure strip",
    .summary = "draw frames of a scene or a clip in a row",
    .operands = "SCENE | CLIP",
    .description =
        "Shows frames of a scene or of a clip. A scene (a file that ends in .yaml) is rendered. A "
        "clip is a video, a folder of pictures, or a pattern such as frame_%04d.png.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .least_operands = 1,
    .most_operands = 1,
    .run = run,
};
