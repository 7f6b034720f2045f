/* Proposes limits of a test from measurements, for `kiln test calibrate`. It renders the test's
 * frames with several thread counts, techniques and devices, which should not matter, and compares
 * the pictures with the goldens. A proposed limit has a margin above the worst measured value, and
 * is never stricter than another driver's rounding allows. */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/error.h"
#include "base/log.h"
#include "base/text.h"
#include "base/thread.h"
#include "compare/metric.h"
#include "frame/technique.h"
#include "suite/summary.h"
#include "suite/test_case.h"

/* The strictest limits that are proposed: about three times what another code path of a driver
 * changes (docs/measurements.md, "How much changes show"), or a few pixels where nothing changes. A
 * limit of 0 would fail by chance. */
static const struct {
    const char *metric; /* the metric, or the start of its name */
    double value;
} strictest_limits[] = {
    {"flip.mean", 0.001},
    {"flip.max", 0.05},
    {"flip.p", 0.025},
    {"ssim", 0.999},
    {"psnr", 50},
    {"abs.max", 3},
    {"abs.mean", 0.03},
    {"differing.count", 10},
    {"differing.share", 0.001},
    {"window.share", 0.01},
};

enum { MAX_THREAD_COUNTS = 3 };

struct calibrating {
    struct kiln_test_case test_case;
    struct kiln_test_params test_params;
    const struct kiln_calibrate_params *params;
    struct kiln_calibration *calibration;
    const char *folder; /* of the pictures, which are removed once measured */
    uint32_t threads[MAX_THREAD_COUNTS];
    size_t thread_counts, combinations, devices;
    struct kiln_rendering first;
    char device_names[256]; /* of all devices that rendered, for the reason */
    double worst[KILN_MAX_COLUMNS];
    uint32_t measured; /* frames that were measured */
};

struct variant {
    const char *device; /* NULL: the default one */
    uint32_t threads;
    struct kiln_technique_list techniques;
};

/* ---- What is rendered --------------------------------------------------------------------- */

static void list_variants(struct calibrating *c)
{
    struct kiln_threads *threads = kiln_threads_create(0);
    uint32_t cores = threads ? kiln_threads_count(threads) : 1;
    kiln_threads_destroy(&threads);
    c->threads[c->thread_counts++] = 1;
    c->threads[c->thread_counts++] = 2;
    if (cores > 2)
        c->threads[c->thread_counts++] = cores;
    struct kiln_technique_list list;
    c->combinations = 1; /* combination 0, the pinned techniques, always exists */
    while (kiln_techniques_combination(c->combinations, &list))
        c->combinations++;
    c->devices = c->params->device_count ? c->params->device_count : 1;
}

/* Chooses device, techniques and threads of render `index`. The device changes with every render;
 * techniques and threads change after each round of the devices. After each round of the
 * techniques, the threads advance by one more step, so that all pairs of both come up. */
static struct variant choose_variant(const struct calibrating *c, size_t index)
{
    const struct kiln_test *test = c->test_case.test;
    size_t round = index / c->devices;
    struct variant variant = {
        .device = c->params->device_count ? c->params->devices[index % c->devices] : test->device,
        .threads = c->threads[(round + round / c->combinations) % c->thread_counts],
    };
    kiln_techniques_combination(round % c->combinations, &variant.techniques);
    return variant;
}

/* Reports a variant to the caller: "threads=2 simulate=inplace sort=cpu backdrop=cpu
 * raster=geometry device=llvmpipe". */
static void report_variant(const struct calibrating *c, const struct variant *variant)
{
    struct kiln_text text = {0};
    kiln_text_add(&text, "threads=%u", variant->threads);
    for (size_t i = 0; i < KILN_STAGE_COUNT; i++)
        kiln_text_add(&text, " %s", variant->techniques.flags[i]);
    if (variant->device)
        kiln_text_add(&text, " device=%s", variant->device);
    if (c->params->render && !text.failed)
        c->params->render(c->params->user, text.data);
    kiln_text_free(&text);
}

/* Renders a variant. Returns false with the error; *refused tells that the device cannot run these
 * techniques. */
static bool render(struct calibrating *c, const struct variant *variant,
                   struct kiln_rendering *rendering, bool *refused, struct kiln_error *error)
{
    const char *flags[KILN_STAGE_COUNT];
    for (size_t i = 0; i < KILN_STAGE_COUNT; i++)
        flags[i] = variant->techniques.flags[i];
    const struct kiln_rendering_params params = {
        .test = c->test_case.test,
        .device = variant->device,
        .techniques = flags,
        .technique_count = KILN_STAGE_COUNT,
        .threads = variant->threads,
        .folder = c->folder,
        .name_tag = c->calibration->renders == 0 ? "_first" : "_again",
        .stop = c->params->stop,
        .user = c->params->user,
        .log = c->params->log,
    };
    bool ok = kiln_rendering_make(c->test_case.arena, &params, rendering, error);
    bool lacks_gl = error->code == KILN_USAGE && rendering->device.usable && !rendering->device.gl;
    *refused = !ok && ((error->code == KILN_NO_DEVICE && !rendering->no_device) || lacks_gl);
    return ok;
}

static void remove_pictures(const struct kiln_rendering *rendering)
{
    for (size_t i = 0; i < rendering->frame_count; i++)
        unlink(rendering->frames[i].path);
}

/* ---- What is measured --------------------------------------------------------------------- */

static bool is_worse(const struct kiln_compare_column *column, double a, double b)
{
    return column->higher_is_better ? a < b : a > b;
}

static void take_values(struct calibrating *c, const struct kiln_compare_frame *frame)
{
    const struct kiln_result *result = c->test_case.result;
    for (size_t i = 0; i < result->column_count; i++) {
        if (c->measured == 0 || is_worse(&result->columns[i], frame->values[i], c->worst[i]))
            c->worst[i] = frame->values[i];
    }
    c->measured++;
}

/* Checks that a frame has the state of the first render and the accepted one. Pictures of different
 * simulations cannot be measured. */
static bool check_state(const struct calibrating *c, const struct kiln_rendered_frame *frame,
                        const struct kiln_rendered_frame *first, bool has_golden,
                        struct kiln_error *error)
{
    const struct kiln_expect_frame *expected = kiln_expect_find(c->test_case.expect, frame->number);
    if (strcmp(frame->state, first->state) != 0)
        return kiln_error_set(error, KILN_FRAME_FAILED,
                              "render %u has the state %s at frame %u, but the first render had "
                              "%s: the simulation is not deterministic",
                              c->calibration->renders + 1, frame->state, frame->number,
                              first->state);
    if (has_golden && expected && expected->state && *expected->state &&
        strcmp(expected->state, frame->state) != 0)
        return kiln_error_set(error, KILN_FRAME_FAILED,
                              "the simulation changed: the state is %s at frame %u, but %s was "
                              "accepted; update the goldens before calibrating",
                              frame->state, frame->number, expected->state);
    return true;
}

static bool compare_with(struct calibrating *c, const char *reference,
                         const struct kiln_rendered_frame *frame,
                         struct kiln_test_case_comparison *comparison, struct kiln_error *error)
{
    if (!kiln_test_case_compare(&c->test_case, reference, frame->path, NULL, comparison, error))
        return false;
    return comparison->frame.measured ||
           kiln_error_set(error, KILN_FRAME_FAILED, "frame %u: %s: %s", frame->number, reference,
                          comparison->message);
}

static bool measure_frame(struct calibrating *c, const struct kiln_rendering *rendering,
                          size_t index, struct kiln_error *error)
{
    const struct kiln_rendered_frame *frame = &rendering->frames[index];
    const struct kiln_rendered_frame *first = &c->first.frames[index];
    struct kiln_test_case_comparison comparison;
    struct kiln_compare_frame nearest = {0};
    struct kiln_goldens goldens;
    if (!kiln_goldens_find(c->test_case.test, frame->number, rendering->device_name, &goldens,
                           error) ||
        !check_state(c, frame, first, goldens.count > 0, error))
        return false;
    for (size_t i = 0; i < goldens.count; i++) {
        if (!compare_with(c, goldens.paths[i], frame, &comparison, error))
            return false;
        if (i == 0 || comparison.frame.score < nearest.score)
            nearest = comparison.frame;
    }
    if (goldens.count == 0) {
        if (!compare_with(c, first->path, frame, &comparison, error))
            return false;
        nearest = comparison.frame;
    }
    take_values(c, &nearest);
    c->calibration->equal = c->calibration->equal && strcmp(frame->pixels, first->pixels) == 0;
    return true;
}

static void note_device(struct calibrating *c, const char *name)
{
    size_t used = strlen(c->device_names);
    if (!strstr(c->device_names, name))
        snprintf(c->device_names + used, sizeof c->device_names - used, "%s%s", used ? ", " : "",
                 name);
}

static bool measure_render(struct calibrating *c, const struct kiln_rendering *rendering,
                           struct kiln_error *error)
{
    if (rendering->frame_count != c->first.frame_count)
        return kiln_error_set(error, KILN_INVALID_INPUT,
                              "%s: the scene changed during the calibration",
                              c->test_case.test->path);
    for (size_t i = 0; i < rendering->frame_count; i++) {
        if (!measure_frame(c, rendering, i, error))
            return false;
    }
    note_device(c, rendering->device_name);
    return true;
}

static bool measure_all(struct calibrating *c, struct kiln_error *error)
{
    size_t variants = c->devices * c->combinations * c->thread_counts, refusals = 0;
    for (size_t i = 0; c->calibration->renders < c->params->renders; i++) {
        struct kiln_rendering rendering;
        bool refused = false;
        const struct variant variant = choose_variant(c, i);
        if (c->params->stop && c->params->stop(c->params->user))
            return kiln_error_set(error, KILN_INTERRUPTED, "stopped after %u renders",
                                  c->calibration->renders);
        report_variant(c, &variant);
        if (!render(c, &variant, &rendering, &refused, error)) {
            remove_pictures(&rendering);
            if (!refused || ++refusals > variants)
                return false;
            continue;
        }
        bool is_first = c->calibration->renders == 0;
        if (is_first)
            c->first = rendering;
        bool ok = measure_render(c, &rendering, error);
        if (!is_first)
            remove_pictures(&rendering);
        if (!ok)
            return false;
        c->calibration->renders++;
    }
    return true;
}

/* ---- What is proposed --------------------------------------------------------------------- */

/* Rounds a value up to two significant digits. */
static double round_up(double value)
{
    if (!(value > 0))
        return value;
    double unit = pow(10.0, floor(log10(value)) - 1);
    char text[32];
    snprintf(text, sizeof text, "%.2g", ceil(value / unit - 1e-9) * unit);
    double rounded = value;
    return kiln_text_to_double(text, &rounded) ? rounded : value;
}

static double strictest_limit(const struct kiln_compare_column *column)
{
    for (size_t i = 0; i < sizeof strictest_limits / sizeof *strictest_limits; i++) {
        const char *metric = strictest_limits[i].metric;
        if (strncmp(column->name, metric, strlen(metric)) == 0)
            return strictest_limits[i].value;
    }
    return column->limit;
}

static double propose(const struct kiln_compare_column *column, double worst, double margin)
{
    double strictest = strictest_limit(column);
    if (strcmp(column->name, "ssim") == 0) /* may go down to -1 */
        return fmax(-1.0, fmin(strictest, 1.0 - round_up((1.0 - worst) * margin)));
    if (column->higher_is_better) /* decibels */
        return fmax(0.0, fmin(strictest, floor(worst - 20.0 * log10(margin))));
    double limit = fmax(strictest, round_up(worst * margin));
    bool is_part = strncmp(column->name, "flip.", 5) == 0 || strstr(column->name, ".share");
    return is_part ? fmin(limit, 1.0) : limit;
}

static void propose_all(struct calibrating *c)
{
    const struct kiln_result *result = c->test_case.result;
    struct kiln_calibration *calibration = c->calibration;
    for (size_t i = 0; i < result->column_count; i++) {
        const struct kiln_compare_column *column = &result->columns[i];
        if (!column->limited)
            continue;
        struct kiln_calibrated *proposal = &calibration->metrics[calibration->count++];
        memcpy(proposal->metric, column->name, sizeof proposal->metric);
        proposal->now = column->limit;
        proposal->worst = c->worst[i];
        proposal->proposed = propose(column, c->worst[i], c->params->margin);
    }
}

/* Adds the names of limits that are looser than the default ones to the reason, and logs a warning
 * for each. */
static void note_looser(const struct calibrating *c, struct kiln_text *reason)
{
    static const char *const default_limits[] = {KILN_COMPARE_DEFAULT_LIMITS};
    struct kiln_metric_set defaults;
    struct kiln_error ignored = {0};
    bool any = false;
    if (!kiln_metric_set_make(&defaults, default_limits, 1, &ignored))
        return;
    for (size_t i = 0; i < c->calibration->count; i++) {
        const struct kiln_calibrated *proposal = &c->calibration->metrics[i];
        for (size_t k = 0; k < defaults.count; k++) {
            const struct kiln_compare_column *column = &defaults.columns[k];
            if (!column->limited || strcmp(column->name, proposal->metric) != 0 ||
                !is_worse(column, proposal->proposed, column->limit))
                continue;
            kiln_text_add(reason, "%s%s",
                          any ? ", " : "; looser than the default limits: ", proposal->metric);
            kiln_log_write(&c->params->log, KILN_LOG_WARNING,
                           "%s: limit %s=%g is looser than the default limit, %g: %g was measured",
                           c->test_case.test->full_name, proposal->metric, proposal->proposed,
                           column->limit, proposal->worst);
            any = true;
        }
    }
}

/* Returns the reason of the limits: "calibrated 2026-01-31: 8 renders on llvmpipe-..., 1 to 4
 * threads; margin 3". */
static const char *make_reason(struct calibrating *c)
{
    char day[16] = "";
    time_t now = time(NULL);
    struct tm parts;
    if (gmtime_r(&now, &parts))
        strftime(day, sizeof day, "%Y-%m-%d", &parts);
    struct kiln_text reason = {0};
    kiln_text_add(&reason, "calibrated %s: %u renders on %s, 1 to %u threads; margin %g", day,
                  c->calibration->renders, c->device_names, c->threads[c->thread_counts - 1],
                  c->params->margin);
    note_looser(c, &reason);
    const char *text = reason.failed ? "" : kiln_test_case_text(&c->test_case, "%s", reason.data);
    kiln_text_free(&reason);
    return text;
}

static bool write_expect(struct calibrating *c, const char *reason, struct kiln_error *error)
{
    struct kiln_arena *arena = c->test_case.arena;
    size_t count = c->calibration->count;
    struct kiln_expect *expect = kiln_expect_read(arena, c->test_case.test->golden, error);
    if (!expect)
        return false;
    expect->limits = kiln_arena_alloc(arena, count + 1, sizeof *expect->limits);
    expect->measured = kiln_arena_alloc(arena, count + 1, sizeof *expect->measured);
    if (!expect->limits || !expect->measured)
        return kiln_error_no_memory(error, "%s", c->test_case.test->path);
    expect->limit_count = expect->measured_count = 0;
    for (size_t i = 0; i < count; i++) {
        const struct kiln_calibrated *proposal = &c->calibration->metrics[i];
        expect->limits[expect->limit_count++] =
            (struct kiln_expect_value){proposal->metric, proposal->proposed};
        if (isfinite(proposal->worst)) /* the psnr of equal pictures is infinite */
            expect->measured[expect->measured_count++] =
                (struct kiln_expect_value){proposal->metric, proposal->worst};
    }
    expect->reason = reason;
    return kiln_expect_write(expect, c->test_case.test->golden, error);
}

static bool propose_and_write(struct calibrating *c, struct kiln_error *error)
{
    propose_all(c);
    const char *reason = make_reason(c);
    if (c->test_case.no_memory)
        return kiln_error_no_memory(error, "%s", c->test_case.test->path);
    if (!c->params->write)
        return true;
    int lock = kiln_goldens_lock(c->test_case.test, error);
    if (lock < 0)
        return false;
    bool ok = write_expect(c, reason, error);
    kiln_goldens_unlock(lock);
    return ok;
}

/* ---- The request -------------------------------------------------------------------------- */

static bool check_params(const struct kiln_calibrate_params *params, struct kiln_error *error)
{
    bool margin = params->margin >= 1 && params->margin <= 1000;
    if (params->renders < 2)
        kiln_error_set(error, KILN_USAGE,
                       "found %u as the number of renders; a calibration needs 2 or more",
                       params->renders);
    else if (!margin)
        kiln_error_set(error, KILN_USAGE, "found a margin of %g; allowed are 1 to 1000",
                       params->margin);
    return params->renders >= 2 && margin;
}

/* Makes a folder for the pictures of a calibration, so that the results of a run stay as they are.
 */
static bool make_folder(struct calibrating *c, struct kiln_error *error)
{
    char *folder = kiln_arena_format(c->test_case.arena, "%s/kiln-XXXXXX", c->params->scratch);
    if (!folder)
        return kiln_error_no_memory(error, "%s", c->test_case.test->path);
    c->folder = mkdtemp(folder);
    return c->folder ||
           kiln_error_set_errno(error, KILN_IO, errno, "%s: the folder cannot be made", folder);
}

static bool prepare(struct calibrating *c, struct kiln_error *error)
{
    struct kiln_test_case *test_case = &c->test_case;
    if (test_case->test->problem.code != KILN_OK) {
        *error = test_case->test->problem;
        return false;
    }
    test_case->result =
        test_case->arena ? kiln_result_start(test_case->arena, test_case->test) : NULL;
    if (!test_case->result) {
        kiln_error_no_memory(error, "%s", test_case->test->path);
        return false;
    }
    test_case->expect = kiln_expect_read(test_case->arena, test_case->test->golden, error);
    return test_case->expect && kiln_test_case_set_limits(test_case, error) &&
           make_folder(c, error);
}

bool kiln_test_calibrate(const struct kiln_suite *suite, size_t index,
                         const struct kiln_calibrate_params *params,
                         struct kiln_calibration *calibration, struct kiln_error *error)
{
    struct calibrating c = {
        .test_case = {.suite = suite, .test = &suite->tests[index], .arena = kiln_arena_create()},
        .test_params = kiln_test_defaults(),
        .params = params,
        .calibration = calibration,
    };
    c.test_case.params = &c.test_params;
    *calibration = (struct kiln_calibration){.equal = true};
    bool ok = check_params(params, error) && prepare(&c, error);
    if (ok) {
        list_variants(&c);
        ok = measure_all(&c, error);
        remove_pictures(&c.first);
        ok = ok && propose_and_write(&c, error);
    }
    if (c.folder)
        rmdir(c.folder);
    kiln_arena_destroy(&c.test_case.arena);
    return ok;
}
