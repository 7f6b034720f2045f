/* Compares pictures, folders, numbered pictures and videos. Frames of both sides are paired, and
 * compared one after the other (frame.c). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/order.h"
#include "base/shown.h"
#include "base/sized.h"
#include "compare/frame.h"
#include "kiln_program.h"

struct comparison {
    const struct kiln_compare_params *params;
    const char *output_file, *output_option; /* a file that the caller writes; or NULL */
    struct kiln_frame_comparer frames;
    struct kiln_claims *claims; /* of all files that are read and written */
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
    double score = frame->layer_count > 0 ? frame->score : INFINITY;
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
            kiln_metric_set_is_worse(&comparison->frames.set, i, value, result->worst[i])) {
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
    if (kiln_footage_kind(comparison->frames.footage[0]) == KILN_FOOTAGE_FOLDER)
        return kiln_order_names(next[0].name, next[1].name);
    return (next[0].number > next[1].number) - (next[0].number < next[1].number);
}

/* Compares a frame that both sides have. */
static bool compare_both(struct comparison *comparison, struct kiln_compare_frame *frame,
                         uint32_t number, struct kiln_arena *arena, struct kiln_error *error)
{
    struct kiln_error fault = {0};
    if (!kiln_frame_compare(&comparison->frames, frame, number, arena, &fault, error))
        return false;
    comparison->result.hdr = comparison->frames.hdr;
    if (fault.code == KILN_OK)
        return true;
    frame->message = kiln_arena_text(arena, fault.message, strlen(fault.message));
    if (comparison->failure.code == KILN_OK)
        comparison->failure = fault;
    for (int i = 0; i < 2; i++) {
        const struct kiln_footage *footage = comparison->frames.footage[i];
        comparison->ended = comparison->ended || kiln_footage_has_failed(footage);
    }
    return frame->message || kiln_error_no_memory(error, "comparing %s", frame->name);
}

/* Compares a frame. first: below 0 if only the reference has it, above 0 if only the test does. */
static bool compare_one(struct comparison *comparison, const struct kiln_footage_frame *chosen,
                        int first, struct kiln_arena *arena, struct kiln_error *error)
{
    char name[256]; /* the frame's own name is lost with the next peek */
    note_name(name, chosen->name);
    struct kiln_compare_frame frame = {.size = sizeof frame, .name = name, .message = ""};
    if (first == 0) {
        if (!compare_both(comparison, &frame, chosen->number, arena, error))
            return false;
    } else {
        frame.verdict = first < 0 ? KILN_COMPARE_MISSING : KILN_COMPARE_EXTRA;
        frame.message = first < 0 ? "only in the reference" : "only in the test";
        kiln_footage_skip(comparison->frames.footage[first > 0]);
    }
    add_to_result(comparison, &frame);
    if (comparison->params->frame)
        comparison->params->frame(comparison->params->user, &comparison->result, &frame);
    return true;
}

/* Compares the next frame of either side; false at the end or with the error. */
static bool compare_next(struct comparison *comparison, struct kiln_error *error)
{
    struct kiln_footage_frame next[2];
    bool has[2];
    for (int i = 0; i < 2; i++)
        has[i] = kiln_footage_peek(comparison->frames.footage[i], &next[i]);
    if ((!has[0] && !has[1]) || comparison->ended)
        return false;
    struct kiln_arena *arena = kiln_arena_create();
    bool ok = arena || kiln_error_no_memory(error, "comparing a frame");
    if (ok) {
        const int first = order(comparison, next, has);
        ok = compare_one(comparison, &next[first > 0], first, arena, error);
    }
    kiln_arena_destroy(&arena);
    return ok;
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
    if (params->layer && !*params->layer)
        return kiln_error_set(error, KILN_USAGE, "the name of the layer is empty");
    if (!(params->data_limit >= 0 && isfinite(params->data_limit)))
        return kiln_error_set(error, KILN_USAGE,
                              "found a limit of %g for data; allowed are finite numbers of 0 or "
                              "more",
                              params->data_limit);
    return true;
}

/* Checks that the two sides can be paired: folders by names, patterns and videos by numbers, and a
 * picture with a picture or, as its first frame, with a video. */
static bool check_kinds(const struct comparison *comparison, struct kiln_error *error)
{
    static const char *const names[] = {
        [KILN_FOOTAGE_STILL] = "a picture",
        [KILN_FOOTAGE_FOLDER] = "a folder",
        [KILN_FOOTAGE_NUMBERED] = "a pattern of numbered pictures",
        [KILN_FOOTAGE_VIDEO] = "a video",
    };
    enum kiln_footage_kind a = kiln_footage_kind(comparison->frames.footage[0]);
    enum kiln_footage_kind b = kiln_footage_kind(comparison->frames.footage[1]);
    const bool one_frame = (a == KILN_FOOTAGE_STILL && b == KILN_FOOTAGE_VIDEO) ||
                           (a == KILN_FOOTAGE_VIDEO && b == KILN_FOOTAGE_STILL);
    bool numbers = a >= KILN_FOOTAGE_NUMBERED && b >= KILN_FOOTAGE_NUMBERED;
    return a == b || numbers || one_frame ||
           kiln_error_set(error, KILN_USAGE, "%s is %s and %s is %s: they cannot be compared",
                          kiln_footage_path(comparison->frames.footage[0]), names[a],
                          kiln_footage_path(comparison->frames.footage[1]), names[b]);
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
        if (!kiln_footage_claim(comparison->frames.footage[i], names[i], comparison->claims, error))
            return false;
    }
    for (size_t i = 0; i < params->mask_count; i++) {
        const char *mask = params->masks[i].picture;
        if (mask && !kiln_claims_read(comparison->claims, mask, "a mask", error))
            return false;
    }
    const struct kiln_footage *reference = comparison->frames.footage[0];
    return (!comparison->output_file ||
            kiln_claims_write(comparison->claims, comparison->output_file,
                              comparison->output_option, error)) &&
           (!params->diff || kiln_difference_plan_claim(&comparison->frames.diff, "--diff",
                                                        reference, comparison->claims, error)) &&
           (!params->error_map ||
            kiln_difference_plan_claim(&comparison->frames.error_map, "--error-map", reference,
                                       comparison->claims, error));
}

static bool prepare(struct comparison *comparison, struct kiln_error *error)
{
    static const char *const default_limits[] = {KILN_COMPARE_DEFAULT_LIMITS};
    const struct kiln_compare_params *params = comparison->params;
    bool own = params->limit_count > 0;
    if (!check_params(params, error) ||
        !kiln_metric_set_make(&comparison->frames.set, own ? params->limits : default_limits,
                              own ? params->limit_count : 1, error))
        return false;
    const char *const paths[2] = {params->reference, params->test};
    for (int i = 0; i < 2; i++) {
        comparison->frames.footage[i] = kiln_footage_open(paths[i], params->layer, error);
        if (!comparison->frames.footage[i])
            return false;
        if (i == 0 || strcmp(paths[0], paths[1]) != 0)
            kiln_footage_set_log(comparison->frames.footage[i], &params->log);
    }
    for (int i = 0; i < 2; i++)
        comparison->result.sequence =
            comparison->result.sequence ||
            kiln_footage_kind(comparison->frames.footage[i]) != KILN_FOOTAGE_STILL;
    comparison->result.column_count = comparison->frames.set.count;
    memcpy(comparison->result.columns, comparison->frames.set.columns,
           sizeof comparison->result.columns);
    bool sequence = comparison->result.sequence;
    if (!check_kinds(comparison, error) ||
        (params->diff && !kiln_difference_plan_make(&comparison->frames.diff, params->diff, false,
                                                    sequence, params->overwrite, error)) ||
        (params->error_map &&
         !kiln_difference_plan_make(&comparison->frames.error_map, params->error_map, true,
                                    sequence, params->overwrite, error)) ||
        !claim_files(comparison, error))
        return false;
    comparison->frames.threads = kiln_threads_create(params->threads);
    return comparison->frames.threads ||
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
                                    .frames.params = &copy,
                                    .output_file = file,
                                    .output_option = option,
                                    .result = kiln_compare_result_empty(),
                                    .worst_score = -1};
    if (!kiln_sized_check(result, "kiln_compare_result", error))
        return false;
    bool ok = copy_params(&copy, params, &masks, error) && prepare(&comparison, error) &&
              compare_all(&comparison, error);
    struct kiln_compare_result *found = &comparison.result;
    found->same = ok && found->frames > 0 && found->counts[KILN_COMPARE_SAME] == found->frames;
    found->total_s = kiln_clock_seconds() - start_s;
    kiln_sized_give(result, found);
    free(masks);
    kiln_threads_destroy(&comparison.frames.threads);
    kiln_frame_comparer_finish(&comparison.frames);
    kiln_claims_destroy(&comparison.claims);
    return ok;
}

bool kiln_compare(const struct kiln_compare_params *params, struct kiln_compare_result *result,
                  struct kiln_error *error)
{
    return kiln_compare_with_output(params, NULL, NULL, result, error);
}
