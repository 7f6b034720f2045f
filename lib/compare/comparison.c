/* Compares pictures, folders, numbered pictures and videos. Frames of both sides are paired,
 * decoded, measured and judged one after the other, so that memory holds one pair at a time. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/order.h"
#include "base/shown.h"
#include "base/sized.h"
#include "compare/difference.h"
#include "compare/footage.h"
#include "compare/mask.h"
#include "compare/metric.h"
#include "kiln_program.h"

struct comparison {
    const struct kiln_compare_params *params;
    const char *output_file, *output_option; /* a file that the caller writes; or NULL */
    struct kiln_footage *footage[2];         /* reference, test */
    struct kiln_metric_set set;
    struct kiln_difference_plan diff, error_map;
    struct kiln_claims *claims; /* of all files that are read and written */
    struct kiln_mask mask;      /* made for the previous frame's size */
    struct kiln_threads *threads;
    struct kiln_compare_result result;
    double sums[KILN_MAX_COLUMNS];
    double worst_score;        /* of result.worst_frame; below 0: there is none */
    struct kiln_error failure; /* the first error of a frame that could not be read */
    bool ended;                /* a video cannot be read any further */
};

const char *kiln_compare_verdict_name(enum kiln_compare_verdict verdict)
{
    static const char *const names[KILN_COMPARE_VERDICT_COUNT] = {
        [KILN_COMPARE_SAME] = "same",
        [KILN_COMPARE_DIFFERENT] = "different",
        [KILN_COMPARE_MISSING] = "missing",
        [KILN_COMPARE_EXTRA] = "extra",
        [KILN_COMPARE_UNREADABLE] = "unreadable",
    };
    return (unsigned)verdict < KILN_COMPARE_VERDICT_COUNT ? names[verdict] : "";
}

/* ---- One frame ---------------------------------------------------------------------------- */

static bool choose_mode(struct comparison *comparison,
                        const struct kiln_compare_picture *const pictures[2], bool *hdr,
                        struct kiln_error *error)
{
    enum kiln_compare_mode mode = comparison->params->mode;
    if (mode == KILN_COMPARE_AUTO && pictures[0]->hdr != pictures[1]->hdr)
        return kiln_error_set(
            error, KILN_USAGE,
            "%s is %s and %s is not: choose the range of light by --range ldr or hdr",
            kiln_footage_path(comparison->footage[0]),
            pictures[0]->hdr ? "of floats" : "of integers",
            kiln_footage_path(comparison->footage[1]));
    *hdr = mode == KILN_COMPARE_AUTO ? pictures[0]->hdr : mode == KILN_COMPARE_HDR;
    comparison->result.hdr = *hdr;
    return true;
}

static void note_places(const struct kiln_measurement *measurement,
                        struct kiln_compare_frame *frame)
{
    const struct kiln_level_difference *d = &measurement->levels;
    frame->equal = d->maximum == 0.0;
    frame->worst_x = d->x;
    frame->worst_y = d->y;
    frame->window_x = d->window_x;
    frame->window_y = d->window_y;
    frame->window_width = d->window_width;
    frame->window_height = d->window_height;
    frame->window_differing = (uint32_t)d->window_differing;
    frame->flip_s = measurement->flip_s;
}

/* Measures and judges a pair of pictures, and draws the difference. Pictures whose sizes or
 * channels do not match get a verdict and are no error. */
static bool compare_pictures(struct comparison *comparison,
                             const struct kiln_compare_picture *const pictures[2],
                             struct kiln_compare_frame *frame, uint32_t number,
                             struct kiln_error *error)
{
    const struct kiln_compare_params *params = comparison->params;
    struct kiln_measurement measurement = {0};
    struct kiln_measure_params measure = {.pixels_per_degree = params->pixels_per_degree,
                                          .threshold = params->threshold,
                                          .window = params->window};
    frame->width = pictures[0]->width;
    frame->height = pictures[0]->height;
    if (!choose_mode(comparison, pictures, &measure.hdr, error))
        return false;
    bool ok = kiln_measurement_take(&measurement, pictures[0], pictures[1], &measure,
                                    comparison->threads, error) &&
              kiln_metric_set_judge(&comparison->set, &measurement, frame, error);
    if (ok) {
        frame->measured = true;
        frame->message = kiln_compare_alpha_note(pictures[0], pictures[1]);
        note_places(&measurement, frame);
    } else if (error->code == KILN_FRAME_FAILED) {
        frame->verdict = KILN_COMPARE_DIFFERENT;
        frame->message = error->message;
    }
    const struct kiln_difference_plan *plans[] = {
        params->diff ? &comparison->diff : NULL, params->error_map ? &comparison->error_map : NULL};
    for (size_t i = 0; i < 2; i++)
        ok = ok && (!plans[i] || kiln_difference_write(plans[i], frame->name, number, pictures[0],
                                                       pictures[1], measurement.errors, error));
    kiln_measurement_finish(&measurement);
    return ok || error->code == KILN_FRAME_FAILED;
}

/* Decodes both sides even if the first fails, so that they stay in step. */
static bool load_images(struct comparison *comparison, struct kiln_asset_image *images[2],
                        struct kiln_error *error)
{
    struct kiln_error errors[2] = {0};
    for (int i = 0; i < 2; i++) {
        images[i] = kiln_footage_take(comparison->footage[i], &errors[i]);
        if (!images[i] && kiln_footage_kind(comparison->footage[i]) == KILN_FOOTAGE_VIDEO)
            comparison->ended = true;
    }
    *error = images[0] ? errors[1] : errors[0];
    return images[0] && images[1];
}

/* Makes the mask for a pair of pictures. *mask is NULL without masks, and for pictures of two
 * sizes, which differ anyway. */
static bool make_mask(struct comparison *comparison, struct kiln_asset_image *const images[2],
                      const struct kiln_mask **mask, struct kiln_error *error)
{
    const struct kiln_compare_params *params = comparison->params;
    uint32_t width = images[0]->width, height = images[0]->height;
    *mask = NULL;
    if (params->mask_count == 0 || width != images[1]->width || height != images[1]->height)
        return true;
    *mask = &comparison->mask;
    return (comparison->mask.width == width && comparison->mask.height == height) ||
           kiln_mask_make(&comparison->mask, params->masks, params->mask_count, width, height,
                          error);
}

static bool make_pictures(struct comparison *comparison, const char *frame,
                          struct kiln_asset_image *const images[2],
                          struct kiln_compare_picture *pictures[2], struct kiln_error *error)
{
    const struct kiln_mask *mask;
    if (!make_mask(comparison, images, &mask, error))
        return false;
    for (int i = 0; i < 2; i++) {
        char name[KILN_PATH_SIZE]; /* for messages */
        bool still = kiln_footage_kind(comparison->footage[i]) == KILN_FOOTAGE_STILL;
        snprintf(name, sizeof name, "%s%s%s", kiln_footage_path(comparison->footage[i]),
                 still ? "" : ": frame ", still ? "" : frame);
        pictures[i] = kiln_compare_picture_create(images[i], mask ? mask->masked : NULL, name,
                                                  comparison->threads, error);
        if (!pictures[i])
            return false;
    }
    if (!kiln_compare_pictures_agree(pictures, error))
        return false;
    if (mask)
        kiln_mask_apply(mask, pictures[0], pictures[1]);
    return true;
}

static bool load_pictures(struct comparison *comparison, const char *frame,
                          struct kiln_compare_picture *pictures[2], struct kiln_error *error)
{
    struct kiln_asset_image *images[2] = {NULL, NULL};
    bool ok = load_images(comparison, images, error) &&
              make_pictures(comparison, frame, images, pictures, error);
    for (int i = 0; i < 2; i++)
        kiln_asset_image_destroy(&images[i]);
    return ok;
}

static bool compare_frame(struct comparison *comparison, struct kiln_compare_frame *frame,
                          uint32_t number, struct kiln_error *error)
{
    struct kiln_compare_picture *pictures[2] = {NULL, NULL};
    bool ok = load_pictures(comparison, frame->name, pictures, error);
    if (ok) {
        const struct kiln_compare_picture *const both[2] = {pictures[0], pictures[1]};
        ok = compare_pictures(comparison, both, frame, number, error);
    } else if (error->code == KILN_INVALID_INPUT) {
        frame->verdict = KILN_COMPARE_UNREADABLE;
        frame->message = error->message;
        if (comparison->failure.code == KILN_OK)
            comparison->failure = *error;
        ok = true;
    }
    kiln_compare_picture_destroy(&pictures[0]);
    kiln_compare_picture_destroy(&pictures[1]);
    return ok;
}

/* ---- All frames ---------------------------------------------------------------------------- */

/* Copies a name such that every character can be shown, since it may be the name of any file. */
static void note_name(char out[256], const char *name)
{
    kiln_shown(out, 256, name);
}

static void add_to_result(struct comparison *comparison, const struct kiln_compare_frame *frame)
{
    struct kiln_compare_result *result = &comparison->result;
    result->frames++;
    result->counts[frame->verdict]++;
    result->flip_s += frame->flip_s;
    double score = frame->measured ? frame->score : INFINITY;
    if (score > comparison->worst_score) {
        comparison->worst_score = score;
        note_name(result->worst_frame, frame->name);
    }
    if (!frame->measured)
        return;
    result->measured++;
    for (size_t i = 0; i < result->column_count; i++) {
        double value = frame->values[i];
        comparison->sums[i] += value;
        result->mean[i] = comparison->sums[i] / result->measured;
        if (result->measured == 1 ||
            kiln_metric_set_is_worse(&comparison->set, i, value, result->worst[i])) {
            result->worst[i] = value;
            note_name(result->worst_names[i], frame->name);
        }
    }
}

/* Returns which side has the next frame: below 0 for the reference, above 0 for the test, 0 for
 * both. */
static int order(const struct comparison *comparison, const struct kiln_footage_frame next[2],
                 const bool has[2])
{
    if (!has[0] || !has[1])
        return has[0] ? -1 : 1;
    switch (kiln_footage_kind(comparison->footage[0])) {
    case KILN_FOOTAGE_STILL:
        return 0;
    case KILN_FOOTAGE_FOLDER:
        return kiln_order_names(next[0].name, next[1].name);
    case KILN_FOOTAGE_NUMBERED:
    case KILN_FOOTAGE_VIDEO:
        break;
    }
    return (next[0].number > next[1].number) - (next[0].number < next[1].number);
}

/* Compares the next frame of either side; false at the end or with the error. */
static bool compare_next(struct comparison *comparison, struct kiln_error *error)
{
    struct kiln_footage_frame next[2];
    bool has[2];
    for (int i = 0; i < 2; i++)
        has[i] = kiln_footage_peek(comparison->footage[i], &next[i]);
    if ((!has[0] && !has[1]) || comparison->ended)
        return false;
    int first = order(comparison, next, has);
    const struct kiln_footage_frame *chosen = &next[first > 0];
    char name[256]; /* the frame's own name is lost with the next peek */
    note_name(name, chosen->name);
    struct kiln_compare_frame frame = {.size = sizeof frame, .name = name, .message = ""};
    if (first == 0) {
        if (!compare_frame(comparison, &frame, chosen->number, error))
            return false;
    } else {
        frame.verdict = first < 0 ? KILN_COMPARE_MISSING : KILN_COMPARE_EXTRA;
        frame.message = first < 0 ? "only in the reference" : "only in the test";
        kiln_footage_skip(comparison->footage[first > 0]);
    }
    add_to_result(comparison, &frame);
    if (comparison->params->frame)
        comparison->params->frame(comparison->params->user, &comparison->result, &frame);
    return true;
}

static bool compare_all(struct comparison *comparison, struct kiln_error *error)
{
    const struct kiln_compare_params *params = comparison->params;
    struct kiln_error frame_error = {0};
    while (compare_next(comparison, &frame_error)) {
        frame_error = (struct kiln_error){0};
        if (kiln_cancel_is_requested(params->cancel) ||
            (params->stop && params->stop(params->user)))
            return kiln_error_set(error, KILN_INTERRUPTED, "stopped after %u frames",
                                  comparison->result.frames);
    }
    if (frame_error.code == KILN_OK && comparison->failure.code != KILN_OK)
        frame_error = comparison->failure;
    if (frame_error.code != KILN_OK)
        *error = frame_error;
    return frame_error.code == KILN_OK;
}

/* ---- The request -------------------------------------------------------------------------- */

static bool check_params(const struct kiln_compare_params *params, struct kiln_error *error)
{
    if (!(params->pixels_per_degree >= 4 && params->pixels_per_degree <= 400))
        return kiln_error_set(error, KILN_USAGE, "found %g pixels a degree; allowed are 4 to 400",
                              params->pixels_per_degree);
    if (!(params->threshold >= 0 && params->threshold <= 255))
        return kiln_error_set(error, KILN_USAGE,
                              "found a threshold of %g levels; allowed are 0 to 255",
                              params->threshold);
    if (params->window < 1)
        return kiln_error_set(error, KILN_USAGE, "found a window of 0 pixels; it needs 1 or more");
    if (!params->layer || !*params->layer)
        return kiln_error_set(error, KILN_USAGE, "the name of the layer is empty");
    return true;
}

/* Checks that the two sides can be paired: folders by names, patterns and videos by numbers, a
 * picture with a picture. */
static bool check_kinds(const struct comparison *comparison, struct kiln_error *error)
{
    static const char *const names[] = {
        [KILN_FOOTAGE_STILL] = "a picture",
        [KILN_FOOTAGE_FOLDER] = "a folder",
        [KILN_FOOTAGE_NUMBERED] = "a pattern of numbered pictures",
        [KILN_FOOTAGE_VIDEO] = "a video",
    };
    enum kiln_footage_kind a = kiln_footage_kind(comparison->footage[0]);
    enum kiln_footage_kind b = kiln_footage_kind(comparison->footage[1]);
    bool numbers = a >= KILN_FOOTAGE_NUMBERED && b >= KILN_FOOTAGE_NUMBERED;
    return a == b || numbers ||
           kiln_error_set(error, KILN_USAGE, "%s is %s and %s is %s: they cannot be compared",
                          kiln_footage_path(comparison->footage[0]), names[a],
                          kiln_footage_path(comparison->footage[1]), names[b]);
}

/* Declares the files that are read and written, so that no output replaces a compared picture or a
 * mask. */
static bool claim_files(struct comparison *comparison, struct kiln_error *error)
{
    static const char *const names[2] = {"a picture of the reference", "a picture of the test"};
    const struct kiln_compare_params *params = comparison->params;
    comparison->claims = kiln_claims_create();
    if (!comparison->claims)
        return kiln_error_no_memory(error, "files to compare");
    for (int i = 0; i < 2; i++) {
        if (!kiln_footage_claim(comparison->footage[i], names[i], comparison->claims, error))
            return false;
    }
    for (size_t i = 0; i < params->mask_count; i++) {
        const char *mask = params->masks[i].picture;
        if (mask && !kiln_claims_read(comparison->claims, mask, "a mask", error))
            return false;
    }
    const struct kiln_footage *reference = comparison->footage[0];
    return (!comparison->output_file ||
            kiln_claims_write(comparison->claims, comparison->output_file,
                              comparison->output_option, error)) &&
           (!params->diff || kiln_difference_plan_claim(&comparison->diff, "--diff", reference,
                                                        comparison->claims, error)) &&
           (!params->error_map || kiln_difference_plan_claim(&comparison->error_map, "--error-map",
                                                             reference, comparison->claims, error));
}

static bool prepare(struct comparison *comparison, struct kiln_error *error)
{
    static const char *const default_limits[] = {KILN_COMPARE_DEFAULT_LIMITS};
    const struct kiln_compare_params *params = comparison->params;
    bool own = params->limit_count > 0;
    if (!check_params(params, error) ||
        !kiln_metric_set_make(&comparison->set, own ? params->limits : default_limits,
                              own ? params->limit_count : 1, error))
        return false;
    const char *const paths[2] = {params->reference, params->test};
    for (int i = 0; i < 2; i++) {
        comparison->footage[i] = kiln_footage_open(paths[i], params->layer, error);
        if (!comparison->footage[i])
            return false;
        if (i == 0 || strcmp(paths[0], paths[1]) != 0)
            kiln_footage_set_log(comparison->footage[i], &params->log);
    }
    comparison->result.sequence = kiln_footage_kind(comparison->footage[0]) != KILN_FOOTAGE_STILL;
    comparison->result.column_count = comparison->set.count;
    memcpy(comparison->result.columns, comparison->set.columns, sizeof comparison->result.columns);
    bool sequence = comparison->result.sequence;
    if (!check_kinds(comparison, error) ||
        (params->diff && !kiln_difference_plan_make(&comparison->diff, params->diff, false,
                                                    sequence, params->overwrite, error)) ||
        (params->error_map &&
         !kiln_difference_plan_make(&comparison->error_map, params->error_map, true, sequence,
                                    params->overwrite, error)) ||
        !claim_files(comparison, error))
        return false;
    comparison->threads = kiln_threads_create(params->threads);
    return comparison->threads ||
           kiln_error_set(error, KILN_DEVICE_FAILED, "the system refuses to start threads");
}

/* Copies the caller's parameters. The masks are copied to the array *masks, which is to be freed.
 */
static bool copy_params(struct kiln_compare_params *copy, const struct kiln_compare_params *params,
                        struct kiln_compare_mask **masks, struct kiln_error *error)
{
    if (!kiln_sized_take(copy, params, "kiln_compare_params", error))
        return false;
    const char *mask = (const char *)copy->masks;
    *masks = calloc(copy->mask_count + 1, sizeof **masks);
    if (!*masks)
        return kiln_error_no_memory(error, "the masks");
    for (size_t i = 0; i < copy->mask_count; i++, mask += copy->mask_stride) {
        (*masks)[i] = kiln_compare_mask_empty();
        if (!kiln_sized_take(&(*masks)[i], mask, "kiln_compare_mask", error))
            return false;
    }
    copy->masks = *masks;
    return true;
}

bool kiln_compare_with_output(const struct kiln_compare_params *params, const char *file,
                              const char *option, struct kiln_compare_result *result,
                              struct kiln_error *error)
{
    double start_s = kiln_clock_seconds();
    struct kiln_compare_params copy = kiln_compare_defaults();
    struct kiln_compare_mask *masks = NULL;
    struct comparison comparison = {.params = &copy,
                                    .output_file = file,
                                    .output_option = option,
                                    .result = kiln_compare_result_empty(),
                                    .worst_score = -1};
    if (!kiln_sized_check(result, "kiln_compare_result", error))
        return false;
    bool ok = copy_params(&copy, params, &masks, error) && prepare(&comparison, error) &&
              compare_all(&comparison, error);
    struct kiln_compare_result *found = &comparison.result;
    found->same = ok && found->measured > 0 && found->counts[KILN_COMPARE_SAME] == found->frames;
    found->total_s = kiln_clock_seconds() - start_s;
    kiln_sized_give(result, found);
    free(masks);
    kiln_threads_destroy(&comparison.threads);
    kiln_mask_finish(&comparison.mask);
    kiln_footage_close(&comparison.footage[0]);
    kiln_footage_close(&comparison.footage[1]);
    kiln_claims_destroy(&comparison.claims);
    return ok;
}

bool kiln_compare(const struct kiln_compare_params *params, struct kiln_compare_result *result,
                  struct kiln_error *error)
{
    return kiln_compare_with_output(params, NULL, NULL, result, error);
}
