/* Opens a device, and declares the options that choose it, the techniques and the threads. */
#ifndef KILN_CMD_DEVICE_H
#define KILN_CMD_DEVICE_H

#include "options.h"

/* Rows of the option tables of commands that draw. */
#define DEVICE_OPTION                                                                              \
    {                                                                                              \
        .name = "device", .kind = OPTION_TEXT, .placeholder = "DEVICE",                            \
        .help = "A number from 'kiln devices', a part of a device's name, 'cpu' to render "        \
                "without OpenGL, or 'software' for OpenGL on the CPU.",                            \
        .fallback = "the first GPU, or else 'cpu' if the techniques need no OpenGL"                \
    }
#define TECHNIQUE_OPTION                                                                           \
    {                                                                                              \
        .name = "technique", .repeats = true, .splits_at_commas = true, .kind = OPTION_PAIRS,      \
        .placeholder = "STAGE=NAME",                                                               \
        .help = "How to run a stage; separate several by commas (see 'kiln help techniques').",    \
        .fallback = "the technique that suits the device"                                          \
    }
#define THREADS_OPTION                                                                             \
    {                                                                                              \
        .name = "threads", .kind = OPTION_INTEGER, .placeholder = "N",                             \
        .help = "Number of threads that work beside the device; 0 takes one for each core.",       \
        .fallback = "0", .max = 256                                                                \
    }

/* Opens the device that --device names, or one that suits the techniques; the caller closes it.
 * Returns NULL after reporting why, with the exit code in *code. */
struct kiln_device *open_device(const struct arguments *arguments,
                                const struct value_list *techniques, int *code);

#endif
