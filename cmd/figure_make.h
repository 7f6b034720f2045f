/* Declares the common options of `kiln figure sheet`, `triptych` and `strip`, and the function that
 * makes their figures. `kiln figure --check` calls it with the words in a figure's sidecar. */
#ifndef KILN_CMD_FIGURE_MAKE_H
#define KILN_CMD_FIGURE_MAKE_H

#include "command.h"

#define FIGURE_OUTPUT_OPTIONS                                                                      \
    {.name = "output",                                                                             \
     .letter = 'o',                                                                                \
     .kind = OPTION_TEXT,                                                                          \
     .placeholder = "FILE",                                                                        \
     .help =                                                                                       \
         "Where to write: .png, .jpg (smaller, of a fixed high quality), or .svg or .pdf with "    \
         "vector lettering. Beside it comes FILE.figure.json, for 'kiln figure --check'."},        \
        {.name = "depfile",                                                                        \
         .kind = OPTION_TEXT,                                                                      \
         .placeholder = "FILE",                                                                    \
         .help = "Write there which files the figure is made of, as a rule for make."},            \
    {                                                                                              \
        .name = "force", .kind = OPTION_FLAG, .help = "Replace files that exist."                  \
    }

#define FIGURE_LOOK_OPTIONS                                                                        \
    {.name = "inset",                                                                              \
     .repeats = true,                                                                              \
     .kind = OPTION_TEXT,                                                                          \
     .placeholder = "X,Y,WxH",                                                                     \
     .help =                                                                                       \
         "Show a part of each picture enlarged below it, in a coloured frame: in pixels, or "      \
         "in parts of the picture where a number has a point (0.4,0.25,0.2x0.2). Up to four."},    \
        {.name = "width",                                                                          \
         .kind = OPTION_TEXT,                                                                      \
         .placeholder = "LENGTH",                                                                  \
         .help =                                                                                   \
             "How wide the whole figure is on paper: 84mm, 8.4cm, 3.3in or 240pt; its pictures "   \
             "fill it, without a margin. A number of pixels (480) instead reduces each larger "    \
             "picture to it.",                                                                     \
         .fallback = "what its pictures take, in their own size"},                                 \
        {.name = "dpi",                                                                            \
         .kind = OPTION_INTEGER,                                                                   \
         .placeholder = "N",                                                                       \
         .help =                                                                                   \
             "Pixels an inch of paper: of PNG and JPEG the resolution, which their files say; "    \
             "of PDF and SVG the most that pictures in them have.",                                \
         .fallback = "300 with a width on paper; else files say none, and PDF has 96",             \
         .min = 36,                                                                                \
         .max = 2400},                                                                             \
        {.name = "alt",                                                                            \
         .kind = OPTION_TEXT,                                                                      \
         .placeholder = "TEXT",                                                                    \
         .help = "What the figure shows, for those who do not see it; written into the file and "  \
                 "its sidecar."},                                                                  \
        {.name = "title",                                                                          \
         .kind = OPTION_TEXT,                                                                      \
         .placeholder = "TEXT",                                                                    \
         .help = "A line above the pictures."},                                                    \
        {.name = "label",                                                                          \
         .repeats = true,                                                                          \
         .kind = OPTION_TEXT,                                                                      \
         .placeholder = "TEXT",                                                                    \
         .help = "The label of a picture; give one for each, in their order.",                     \
         .fallback = "what tells it from the others"},                                             \
        {.name = "no-labels", .kind = OPTION_FLAG, .help = "Leave the labels out."},               \
        {.name = "plain",                                                                          \
         .kind = OPTION_FLAG,                                                                      \
         .help = "Nothing but the pictures, edge to edge: of one, the picture itself."},           \
        {.name = "text-size",                                                                      \
         .kind = OPTION_TEXT,                                                                      \
         .placeholder = "LENGTH",                                                                  \
         .help = "The size of the lettering, in points on paper (8pt, from 4 to 72) or in pixels " \
                 "(14, from 8 to 64); margins and gaps go with it.",                               \
         .fallback = "8pt with a width on paper, else 14"},                                        \
    {                                                                                              \
        .name = "dark", .kind = OPTION_FLAG, .help = "Light lettering on dark paper."              \
    }

#define FIGURE_SCENE_OPTIONS                                                                       \
    {.name = "size",                                                                               \
     .kind = OPTION_SIZE,                                                                          \
     .placeholder = "WxH",                                                                         \
     .help = "Size of each picture in pixels: --set output.size=[W, H].",                          \
     .sets = "output.size"},                                                                       \
        {.name = "seed",                                                                           \
         .kind = OPTION_INTEGER,                                                                   \
         .placeholder = "N",                                                                       \
         .help = "Seed of everything random: --set seed=N.",                                       \
         .sets = "seed",                                                                           \
         .max = UINT32_MAX},                                                                       \
        SET_OPTION, ASSET_ROOT_OPTION,                                                             \
        {.name = "device",                                                                         \
         .kind = OPTION_TEXT,                                                                      \
         .placeholder = "DEVICE",                                                                  \
         .help = "A number from 'kiln devices', a part of a device's name, 'cpu' or 'software'.",  \
         .fallback = "'cpu', or the first GPU or 'software' if a technique needs it"},             \
    {                                                                                              \
        .name = "technique", .repeats = true, .commas = true, .kind = OPTION_PAIRS,                \
        .placeholder = "STAGE=NAME",                                                               \
        .help = "How to run a stage; more of them after commas (see 'kiln help techniques').",     \
        .fallback = "what makes the same picture everywhere"                                       \
    }

#define FIGURE_THREADS_OPTION                                                                      \
    {                                                                                              \
        .name = "threads", .kind = OPTION_INTEGER, .placeholder = "N", .help = "Worker threads.",  \
        .fallback = "one a core", .max = 256                                                       \
    }

/* Makes figure_make compare a figure with its sidecar instead of writing it. */
struct figure_check {
    const char *sidecar; /* path of the sidecar */
    bool update;         /* write the figure anew if it is stale */
    struct kiln_figure_result *result;
};

/* Draws the figure that a command's arguments ask for and returns the exit code, after reporting
 * what is wrong. check is NULL for a figure that is written. */
int figure_make(const struct command *command, enum kiln_figure_kind kind,
                const struct arguments *arguments, const struct figure_check *check);

#endif
