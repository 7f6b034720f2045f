/* Draws pictures of differences and writes them to the files that a plan names. Light beyond white
 * is shown as white and light below black as black; alpha is shown on black. */
#include "compare/difference.h"

#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "base/error.h"
#include "compare/magma.h"
#include "output/formats.h"

enum { PANELS = 3 };

static bool is_folder(const char *path)
{
    struct stat status;
    size_t length = strlen(path);
    return (length > 0 && path[length - 1] == '/') ||
           (stat(path, &status) == 0 && S_ISDIR(status.st_mode));
}

bool kiln_difference_plan_make(struct kiln_difference_plan *plan, const char *path, bool map_alone,
                               bool sequence, bool overwrite, struct kiln_error *error)
{
    *plan = (struct kiln_difference_plan){
        .path = path, .map_alone = map_alone, .overwrite = overwrite, .folder = is_folder(path)};
    if (plan->folder)
        return true;
    const char *dot = strrchr(path, '.');
    if (!dot || strcasecmp(dot, ".png") != 0)
        return kiln_error_set(error, KILN_USAGE,
                              "%s: pictures of differences are PNG; the name must end in .png, or "
                              "be a folder",
                              path);
    if (!kiln_path_pattern_parse(&plan->pattern, path,
                                 sequence ? KILN_NUMBER_ALWAYS : KILN_NUMBER_IF_ASKED, error))
        return false;
    return plan->pattern.numbered || kiln_target_check(path, overwrite, error);
}

static bool format_path(const struct kiln_difference_plan *plan, const char *name, uint32_t number,
                        char *path, size_t size)
{
    if (!plan->folder)
        return kiln_path_pattern_format(&plan->pattern, number, path, size);
    size_t stem = strlen(name);
    if (stem > 4 && strcasecmp(name + stem - 4, ".png") == 0)
        stem -= 4;
    bool slash = plan->path[strlen(plan->path) - 1] == '/';
    int length =
        snprintf(path, size, "%s%s%.*s.png", plan->path, slash ? "" : "/", (int)stem, name);
    return length >= 0 && (size_t)length < size;
}

static bool declare(const struct kiln_difference_plan *plan, struct kiln_claims *claims,
                    const char *name, uint32_t number, struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    if (!format_path(plan, name, number, path, sizeof path))
        return kiln_error_set(error, KILN_USAGE, "%s: the path is too long", plan->path);
    return kiln_claims_write(claims, path, plan->option, error);
}

struct declaring {
    const struct kiln_difference_plan *plan;
    struct kiln_claims *claims;
    struct kiln_error *error;
};

static bool declare_frame(void *user, const struct kiln_footage_frame *frame)
{
    const struct declaring *d = user;
    return declare(d->plan, d->claims, frame->name, frame->number, d->error);
}

bool kiln_difference_plan_claim(struct kiln_difference_plan *plan, const char *option,
                                const struct kiln_footage *reference, struct kiln_claims *claims,
                                struct kiln_error *error)
{
    plan->option = option;
    plan->claims = kiln_footage_kind(reference) == KILN_FOOTAGE_VIDEO ? claims : NULL;
    struct declaring declaring = {plan, claims, error};
    return kiln_footage_visit(reference, declare_frame, &declaring);
}

static void put_levels(const float *levels, uint8_t *out)
{
    for (int c = 0; c < 3; c++) {
        float level = levels[c] > 0.0f ? levels[c] : 0.0f;
        out[c] = (uint8_t)(level < 255.0f ? level + 0.5f : 255.0f);
    }
}

static void draw_panels(const struct kiln_compare_picture *reference,
                        const struct kiln_compare_picture *test, const float *errors,
                        uint8_t *display)
{
    size_t width = reference->width;
    for (size_t y = 0; y < reference->height; y++) {
        uint8_t *row = display + y * PANELS * width * 4;
        for (size_t x = 0; x < width; x++) {
            size_t i = y * width + x;
            put_levels(reference->levels + 3 * i, row + 4 * x);
            put_levels(test->levels + 3 * i, row + 4 * (width + x));
            kiln_magma_color(errors[i], row + 4 * (2 * width + x));
        }
    }
}

static void draw_map(const float *errors, size_t pixels, uint8_t *display)
{
    for (size_t i = 0; i < pixels; i++)
        kiln_magma_color(errors[i], display + 4 * i);
}

bool kiln_difference_write(const struct kiln_difference_plan *plan, const char *name,
                           uint32_t number, const struct kiln_compare_picture *reference,
                           const struct kiln_compare_picture *test, const float *errors,
                           struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    if (!format_path(plan, name, number, path, sizeof path))
        return kiln_error_set(error, KILN_IO, "%s: the path is too long", plan->path);
    if (plan->claims && number > 0 && !declare(plan, plan->claims, name, number, error))
        return false;
    struct kiln_temporary file = {0};
    if (!kiln_target_check(path, plan->overwrite, error) || !kiln_make_parent_folders(path, error))
        return false;
    uint32_t width = (plan->map_alone ? 1 : PANELS) * reference->width;
    struct kiln_picture *picture =
        kiln_picture_create(width, reference->height, 8, NULL, NULL, 0, error);
    if (!picture)
        return false;
    picture->frame = number;
    if (plan->map_alone)
        draw_map(errors, (size_t)width * reference->height, picture->display);
    else
        draw_panels(reference, test, errors, picture->display);
    const struct kiln_output_params no_scene = {0};
    bool ok = kiln_temporary_open(&file, path, error) &&
              kiln_png_write(&no_scene, picture, &file, NULL, error) &&
              kiln_temporary_commit(&file, plan->overwrite, error);
    kiln_temporary_discard(&file);
    kiln_picture_destroy(&picture);
    return ok;
}
