/* Declares the options that change a scene, and turns them into overrides: --set, and --size, --fps
 * and --seed, which stand for a --set of one key, and --params, which names files with values. */
#ifndef KILN_CMD_OVERRIDES_H
#define KILN_CMD_OVERRIDES_H

#include "options.h"

/* Rows of the option tables of commands that load scenes. */
#define SET_OPTION                                                                                 \
    {                                                                                              \
        .name = "set", .repeats = true, .kind = OPTION_PAIRS, .placeholder = "KEY=VALUE",          \
        .help = "Change a value of the scene, such as systems.fire.emit.rate=500. In a key, '*' "  \
                "stands for every entry of a map or list."                                         \
    }
#define PARAMS_OPTION                                                                              \
    {                                                                                              \
        .name = "params", .repeats = true, .kind = OPTION_TEXT, .placeholder = "FILE",             \
        .access = ACCESS_READ,                                                                     \
        .help = "A file with values of the scene's parameters, YAML or JSON, such as {length: 3 "  \
                "s}. Values of --set params.NAME=VALUE replace them."                              \
    }
#define SIZE_OPTION                                                                                \
    {                                                                                              \
        .name = "size", .kind = OPTION_SIZE, .placeholder = "WxH",                                 \
        .help = "Size of the picture in pixels: --set output.size=[W, H].",                        \
        .scene_key = "output.size"                                                                 \
    }
#define FPS_OPTION                                                                                 \
    {                                                                                              \
        .name = "fps", .kind = OPTION_RATIO, .placeholder = "RATE",                                \
        .help = "Frames a second, such as 30 or 30000/1001: --set output.fps=RATE.",               \
        .scene_key = "output.fps"                                                                  \
    }
#define SEED_OPTION                                                                                \
    {                                                                                              \
        .name = "seed", .kind = OPTION_INTEGER, .placeholder = "N",                                \
        .help = "Seed of all random numbers: --set seed=N.", .scene_key = "seed",                  \
        .max = UINT32_MAX                                                                          \
    }
#define ASSET_ROOT_OPTION                                                                          \
    {                                                                                              \
        .name = "asset-root", .kind = OPTION_TEXT, .placeholder = "FOLDER", .access = ACCESS_READ, \
        .help = "The folder that the scene's files must lie in.",                                  \
        .fallback = "the folder of the scene"                                                      \
    }

struct overrides {
    char **texts; /* "key=value", in the order of the command line */
    size_t count;
    struct value_list params_files; /* of --params */
};

/* Collects the overrides of a command line. Returns false when memory is short. */
bool overrides_create(struct overrides *overrides, const struct arguments *arguments);
void overrides_free(struct overrides *overrides);

/* Prints how long a clip is, as a line behind `before`, if the command line changes the rate of its
 * frames and not their number: the scene's clip is of another length then. path: of the scene. */
void overrides_print_length(const struct arguments *arguments, const char *before, const char *path,
                            const struct kiln_scene_info *info);

/* Returns the parameters to load the scenes of a command line. They point into both arguments. */
struct kiln_scene_params overrides_scene_params(const struct overrides *overrides,
                                                const struct arguments *arguments);

#endif
