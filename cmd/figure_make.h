/* Declares the common options of `kiln figure sheet`, `triptych` and `strip`, and the function that
 * makes their figures. `kiln figure --check` calls it with the arguments in a figure's sidecar. */
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
         "vector lettering. FILE.figure.json is written beside it, for 'kiln figure --check'."},   \
        {.name = "depfile",                                                                        \
         .kind = OPTION_TEXT,                                                                      \
         .placeholder = "FILE",                                                                    \
         .help = "Write a rule for make into this file. The rule names the files that the figure " \
                 "is made of."},                                                                   \
        {.name = "force", .kind = OPTION_FLAG, .help = "Replace files that exist."},               \
    {                                                                                              \
        .name = "quiet", .letter = 'q', .kind = OPTION_FLAG,                                       \
        .help = "Print nothing but warnings and errors, as is done in any case."                   \
    }

#define FIGURE_LOOK_OPTIONS                                                                        \
    {.name = "inset",                                                                              \
     .repeats = true,                                                                              \
     .kind = OPTION_TEXT,                                                                          \
     .placeholder = "X,Y,WxH",                                                                     \
     .help = "Show a part of each picture enlarged below it, in a coloured frame. The part is in " \
             "pixels, or in parts of the picture where a number has a point (0.4,0.25,0.2x0.2). "  \
             "Up to four parts are allowed."},                                                     \
        {.name = "width",                                                                          \
         .kind = OPTION_TEXT,                                                                      \
         .placeholder = "LENGTH",                                                                  \
         .help = "Width of the whole figure on paper: 84mm, 8.4cm, 3.3in or 240pt. The pictures "  \
                 "fill it without a margin. A number of pixels (480) instead reduces each larger " \
                 "picture to that width.",                                                         \
         .fallback = "the width of the pictures in their own size"},                               \
        {.name = "dpi",                                                                            \
         .kind = OPTION_INTEGER,                                                                   \
         .placeholder = "N",                                                                       \
         .help = "Resolution in pixels an inch of paper. PNG and JPEG files have this resolution " \
                 "and state it. In PDF and SVG, pictures have at most this resolution.",           \
         .fallback = "300 with a width on paper; otherwise files state none, and PDF has 96",      \
         .min = 36,                                                                                \
         .max = 2400},                                                                             \
        {.name = "alt",                                                                            \
         .kind = OPTION_TEXT,                                                                      \
         .placeholder = "TEXT",                                                                    \
         .help = "Description of the figure for people who cannot see it. It is written into the " \
                 "file and its sidecar."},                                                         \
        {.name = "title",                                                                          \
         .kind = OPTION_TEXT,                                                                      \
         .placeholder = "TEXT",                                                                    \
         .help = "A line above the pictures."},                                                    \
        {.name = "label",                                                                          \
         .repeats = true,                                                                          \
         .kind = OPTION_TEXT,                                                                      \
         .placeholder = "TEXT",                                                                    \
         .help = "The label of a picture. Give one label for each picture, in their order.",       \
         .fallback = "what distinguishes the picture from the others"},                            \
        {.name = "no-labels", .kind = OPTION_FLAG, .help = "Leave out the labels."},               \
        {.name = "plain",                                                                          \
         .kind = OPTION_FLAG,                                                                      \
         .help = "Draw only the pictures, edge to edge. A figure of one picture is then the "      \
                 "picture itself."},                                                               \
        {.name = "text-size",                                                                      \
         .kind = OPTION_TEXT,                                                                      \
         .placeholder = "LENGTH",                                                                  \
         .help = "Size of the lettering, in points on paper (8pt, from 4 to 72) or in pixels "     \
                 "(14, from 8 to 64). Margins and gaps scale with it.",                            \
         .fallback = "8pt with a width on paper, otherwise 14"},                                   \
    {                                                                                              \
        .name = "dark", .kind = OPTION_FLAG, .help = "Draw light lettering on dark paper."         \
    }

#define FIGURE_SCENE_OPTIONS                                                                       \
    {.name = "size",                                                                               \
     .kind = OPTION_SIZE,                                                                          \
     .placeholder = "WxH",                                                                         \
     .help = "Size of each picture in pixels: --set output.size=[W, H].",                          \
     .scene_key = "output.size"},                                                                  \
        {.name = "seed",                                                                           \
         .kind = OPTION_INTEGER,                                                                   \
         .placeholder = "N",                                                                       \
         .help = "Seed of all random numbers: --set seed=N.",                                      \
         .scene_key = "seed",                                                                      \
         .max = UINT32_MAX},                                                                       \
        SET_OPTION, ASSET_ROOT_OPTION,                                                             \
        {.name = "device",                                                                         \
         .kind = OPTION_TEXT,                                                                      \
         .placeholder = "DEVICE",                                                                  \
         .help = "A number from 'kiln devices', a part of a device's name, 'cpu' or 'software'.",  \
         .fallback = "'cpu', or the first GPU or 'software' if a technique needs it"},             \
    {                                                                                              \
        .name = "technique", .repeats = true, .splits_at_commas = true, .kind = OPTION_PAIRS,      \
        .placeholder = "STAGE=NAME",                                                               \
        .help = "How to run a stage; separate several by commas (see 'kiln help techniques').",    \
        .fallback = "the techniques that make the same picture everywhere"                         \
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
