/* Runs kiln check, which validates scenes, and prints each with every default spelled out, unless
 * --quiet or --hash is given.
 *
 * The main function finds check_command in the table of commands and calls its `run`; the parser,
 * the help, the man page, the completion and the sandbox read its options. The printed text of a
 * scene must stay a scene file, so anything else is printed as a YAML comment. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "event.h"
#include "limits.h"
#include "overrides.h"
#include "report.h"
#include "sandbox.h"
#include "scene_in.h"
#include "signals.h"

static const struct option options[] = {
    SIZE_OPTION,
    FPS_OPTION,
    SEED_OPTION,
    PARAMS_OPTION,
    SET_OPTION,
    ASSET_ROOT_OPTION,
    LIMITS_OPTION,
    TIMEOUT_OPTION,
    SANDBOX_OPTION,
    {.name = "origin",
     .kind = OPTION_FLAG,
     .help = "Print behind each line the file and line that it comes from, or 'default'."},
    {.name = "hash", .kind = OPTION_FLAG, .help = "Print only the scene's hash."},
    {.name = "quiet", .letter = 'q', .kind = OPTION_FLAG, .help = "Print nothing but errors."},
    EVENTS_OPTION,
    HELP_OPTION,
};

/* Prints the work that a clip takes, as a YAML comment after the scene. */
static bool print_work(const struct kiln_scene_info *info)
{
    return printf("# work: %" PRIu32 " frame%s of %" PRIu32 " x %" PRIu32 " pixels, %" PRIu64
                  " steps, up to %" PRIu64 " particles, about %" PRIu64 " MiB\n",
                  info->frames, info->frames == 1 ? "" : "s", info->width, info->height,
                  info->steps, info->particle_capacity, info->memory_bytes >> 20) >= 0;
}

/* Prints lines as YAML comments, each behind `before`. */
static void print_lines(const char *lines, const char *before)
{
    char text[2 * KILN_MESSAGE_SIZE], shown[2 * KILN_MESSAGE_SIZE];
    for (const char *at = lines; *at;) {
        const size_t length = strcspn(at, "\n");
        snprintf(text, sizeof text, "%.*s", (int)length, at);
        kiln_shown(shown, sizeof shown, text);
        printf("#   %s%s\n", before, shown);
        at += length + (at[length] == '\n');
    }
}

/* Prints what a mesh is, as YAML comments: its size, whether it has an inside, how it
 * moves and looks, and what was left out of it. */
static void print_mesh(void *user, const struct kiln_mesh_info *info)
{
    (void)user;
    char text[KILN_MESSAGE_SIZE];
    kiln_shown(text, sizeof text, info->path);
    printf("# mesh %s: %s, %" PRIu32 " triangle%s, %" PRIu32 " vertices, from %g %g %g to %g %g "
           "%g\n",
           text, info->format, info->triangles, info->triangles == 1 ? "" : "s", info->vertices,
           (double)info->min[0], (double)info->min[1], (double)info->min[2], (double)info->max[0],
           (double)info->max[1], (double)info->max[2]);
    if (*info->open)
        printf("#   not closed: %s\n", info->open);
    else if (isfinite(info->thinnest))
        printf("#   closed, its thinnest part %.4g\n", info->thinnest);
    else
        printf("#   closed\n");
    if (info->joints > 0)
        printf("#   %" PRIu32 " joint%s\n", info->joints, info->joints == 1 ? "" : "s");
    if (info->morph_targets > 0)
        printf("#   %" PRIu32 " morph target%s\n", info->morph_targets,
               info->morph_targets == 1 ? "" : "s");
    for (uint32_t i = 0; i < info->clip_count; i++) {
        kiln_shown(text, sizeof text, info->clips[i].name);
        printf("#   clip %" PRIu32 " '%s' of %.4g s\n", i, text, info->clips[i].seconds);
    }
    print_lines(info->looks, "");
    print_lines(info->notes, "note: ");
}

/* Prints how large a domain of gas is, as a YAML comment. */
static void print_gas(void *user, const struct kiln_gas_info *info)
{
    (void)user;
    printf("# gas %s: ", info->name);
    if (!info->enabled) {
        printf("not enabled\n");
        return;
    }
    printf("%" PRIu32 " x %" PRIu32 " x %" PRIu32 " cells of %.4g m, up to %" PRIu64
           " MiB, %" PRIu32 " step%s or more in each of the scene\n",
           info->cells[0], info->cells[1], info->cells[2], info->cell_m, info->memory_bytes >> 20,
           info->substeps, info->substeps == 1 ? "" : "s");
}

/* Prints the hash of a scene, or the scene and its work. With several scenes, the path is printed,
 * too. Returns false when printing failed. */
static bool print_scene(const struct kiln_scene *scene, const char *path,
                        const struct arguments *arguments)
{
    const bool hash = arguments_flag(arguments, "hash");
    const bool several = arguments->operand_count > 1;
    struct kiln_scene_info info = kiln_scene_info_empty();
    kiln_scene_get_info(scene, &info);
    char shown[KILN_PATH_SIZE];
    kiln_shown(shown, sizeof shown, path);
    if (hash && several)
        return printf("%s  %s\n", info.hash, shown) >= 0;
    if (hash)
        return printf("%s\n", info.hash) >= 0;
    if (several && printf("--- # %s\n", shown) < 0)
        return false;
    const bool printed = arguments_flag(arguments, "origin")
                             ? kiln_scene_print_origins(scene, stdout)
                             : kiln_scene_print(scene, stdout);
    if (!printed || !kiln_scene_visit_meshes(scene, print_mesh, NULL))
        return false;
    kiln_scene_visit_gas(scene, print_gas, NULL);
    return print_work(&info);
}

static int run(const struct arguments *arguments)
{
    bool quiet = arguments_last(arguments, "quiet") != NULL;
    signals_install_for_job();
    const int wrong = scene_in_check(arguments, "check");
    if (wrong)
        return wrong;
    struct overrides overrides;
    if (!overrides_create(&overrides, arguments))
        return report_no_memory();
    struct kiln_scene_params params = overrides_scene_params(&overrides, arguments);
    params.keep_origins = arguments_flag(arguments, "origin");

    int code = 0;
    for (size_t i = 0; i < arguments->operand_count; i++) {
        const char *path = arguments->operands[i];
        struct kiln_error error = {0};
        struct kiln_scene *scene = scene_in_load(path, &params, &error);
        if (!scene) {
            int failure = report_scene_error(&error);
            code = code ? code : failure;
        } else if (!quiet && !print_scene(scene, path, arguments)) {
            /* Either standard output failed, which report_finish reports, or memory was short. */
            int failure = ferror(stdout) ? KILN_IO : report_no_memory();
            code = code ? code : failure;
        } else if (!quiet && !arguments_flag(arguments, "hash")) {
            struct kiln_scene_info info = kiln_scene_info_empty();
            kiln_scene_get_info(scene, &info);
            overrides_print_length(arguments, "# ", path, &info);
        }
        kiln_scene_destroy(&scene);
    }
    overrides_free(&overrides);
    return code;
}

const struct command check_command = {
    .name = "check",
    .summary = "validate scenes and print them with every default",
    .operands = "SCENE...",
    .description =
        "Reads each scene and prints it with every default spelled out. '-' reads a scene from "
        "standard input, whose files lie below the working directory. The output is a scene file "
        "that renders to the same pictures. Comments at its end tell what its meshes are (their "
        "size, whether they are closed, their joints, clips and materials, and what is left out of "
        "them), how large its domains of gas are, and the work of the whole clip: steps, particles "
        "at once, and memory. The memory "
        "is the most that rendering without OpenGL may take, encoders left out. After a wrong "
        "scene is reported, the other scenes are checked all the same. A scene that asks for more "
        "than --limits allow ends with exit code 8.",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .least_operands = 1,
    .most_operands = SIZE_MAX,
    .access = ACCESS_READ,
    .run = run,
};
