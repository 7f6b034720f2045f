/* Holds the table of metrics, parses the limits of metrics, and judges a measured frame by them. */
#include "compare/metric.h"

#include <math.h>
#include <string.h>

#include "base/error.h"
#include "kiln_program.h"

struct metric_value {
    const struct kiln_measurement *measurement;
    double percentile;
    double value;
    struct kiln_error *error;
};

struct kiln_metric {
    const char *name; /* an N at its end stands for any number from 0 to 100; such a metric is in a
                         report only if a limit asks for it */
    const char *unit;
    const char *help;
    bool higher_is_better;
    double percentile;
    double least, most; /* the range of valid limits */
    bool (*compute)(struct metric_value *value);
};

static bool flip_mean(struct metric_value *v)
{
    v->value = v->measurement->flip.mean;
    return true;
}

static bool flip_percentile(struct metric_value *v)
{
    const struct kiln_measurement *m = v->measurement;
    return kiln_pool_percentile(m->errors, (size_t)m->width * m->height, v->percentile / 100.0,
                                &v->value, v->error);
}

static bool flip_maximum(struct metric_value *v)
{
    v->value = v->measurement->flip.maximum;
    return true;
}

static bool ssim(struct metric_value *v)
{
    v->value = v->measurement->ssim;
    return true;
}

static bool psnr(struct metric_value *v)
{
    v->value = 10.0 * log10(255.0 * 255.0 / v->measurement->levels.mean_square);
    return true;
}

static bool level_maximum(struct metric_value *v)
{
    v->value = v->measurement->levels.maximum;
    return true;
}

static bool level_mean(struct metric_value *v)
{
    v->value = v->measurement->levels.mean;
    return true;
}

static bool differing_count(struct metric_value *v)
{
    v->value = (double)v->measurement->levels.differing;
    return true;
}

static bool differing_share(struct metric_value *v)
{
    const struct kiln_measurement *m = v->measurement;
    v->value = (double)m->levels.differing / ((double)m->width * m->height);
    return true;
}

static bool window_share(struct metric_value *v)
{
    const struct kiln_level_difference *d = &v->measurement->levels;
    v->value = (double)d->window_differing / ((double)d->window_width * d->window_height);
    return true;
}

static const struct kiln_metric metrics[] = {
    {.name = "flip.mean",
     .unit = "",
     .help = "FLIP: how different the pictures look when flipped; mean over all pixels, 0 to 1",
     .most = 1,
     .compute = flip_mean},
    {.name = "flip.p50",
     .unit = "",
     .help = "median of FLIP, weighted by the errors",
     .percentile = 50,
     .most = 1,
     .compute = flip_percentile},
    {.name = "flip.p99",
     .unit = "",
     .help = "99th percentile of FLIP, weighted by the errors",
     .percentile = 99,
     .most = 1,
     .compute = flip_percentile},
    {.name = "flip.pN",
     .unit = "",
     .help = "any other percentile of FLIP, such as flip.p99.9",
     .most = 1,
     .compute = flip_percentile},
    {.name = "flip.max",
     .unit = "",
     .help = "FLIP of the worst pixel",
     .most = 1,
     .compute = flip_maximum},
    {.name = "ssim",
     .unit = "",
     .help = "structural similarity of luma (Wang 2004): 1 for equal pictures",
     .higher_is_better = true,
     .least = -1,
     .most = 1,
     .compute = ssim},
    {.name = "psnr",
     .unit = "dB",
     .help = "peak signal to noise over all channels: infinite for equal pictures",
     .higher_is_better = true,
     .most = 1000,
     .compute = psnr},
    {.name = "abs.max",
     .unit = "levels",
     .help = "the largest difference of a channel, in 1/255 of sRGB's range",
     .most = INFINITY,
     .compute = level_maximum},
    {.name = "abs.mean",
     .unit = "levels",
     .help = "the mean difference over all channels",
     .most = INFINITY,
     .compute = level_mean},
    {.name = "differing.count",
     .unit = "pixels",
     .help = "number of pixels that differ by more than --threshold levels",
     .most = INFINITY,
     .compute = differing_count},
    {.name = "differing.share",
     .unit = "",
     .help = "part of the picture that differs by more than --threshold levels, 0 to 1",
     .most = 1,
     .compute = differing_share},
    {.name = "window.share",
     .unit = "",
     .help = "part of the densest --window that differs by more than --threshold levels; it finds "
             "small faults",
     .most = 1,
     .compute = window_share},
};
enum { METRIC_COUNT = sizeof metrics / sizeof *metrics };

static bool is_family(const struct kiln_metric *metric)
{
    return metric->name[strlen(metric->name) - 1] == 'N';
}

static struct kiln_compare_column *add_column(struct kiln_metric_set *set, const char *name,
                                              const struct kiln_metric *metric, double percentile)
{
    struct kiln_compare_column *column = &set->columns[set->count];
    *column = (struct kiln_compare_column){.unit = metric->unit,
                                           .higher_is_better = metric->higher_is_better};
    snprintf(column->name, sizeof column->name, "%s", name);
    set->metrics[set->count] = metric;
    set->percentiles[set->count++] = percentile;
    return column;
}

static bool unknown_metric(const char *limit, const char *name, struct kiln_error *error)
{
    const char *names[METRIC_COUNT];
    for (size_t i = 0; i < METRIC_COUNT; i++)
        names[i] = metrics[i].name;
    const char *nearest = kiln_text_nearest(name, names, METRIC_COUNT);
    return kiln_error_set(error, KILN_USAGE, "limit '%s': unknown metric '%s'%s%s%s", limit, name,
                          nearest ? " (did you mean '" : "; 'kiln help metrics' lists them",
                          nearest ? nearest : "", nearest ? "'?)" : "");
}

/* Returns the column of that name. A percentile that has no column yet gets one. */
static struct kiln_compare_column *find_column(struct kiln_metric_set *set, const char *limit,
                                               const char *name, struct kiln_error *error)
{
    for (size_t i = 0; i < set->count; i++) {
        if (strcmp(set->columns[i].name, name) == 0)
            return &set->columns[i];
    }
    for (size_t i = 0; i < METRIC_COUNT; i++) {
        size_t stem = strlen(metrics[i].name) - 1;
        double percentile = 0;
        if (!is_family(&metrics[i]) || strncmp(name, metrics[i].name, stem) != 0 ||
            !kiln_text_to_double(name + stem, &percentile))
            continue;
        if (!(percentile >= 0 && percentile <= 100)) {
            kiln_error_set(
                error, KILN_USAGE,
                "limit '%s': found the percentile '%s'; allowed are 0 to 100, as in flip.p99.9",
                limit, name + stem);
            return NULL;
        }
        if (set->count == KILN_MAX_COLUMNS) {
            kiln_error_set(error, KILN_USAGE, "limit '%s': too many percentiles", limit);
            return NULL;
        }
        return add_column(set, name, &metrics[i], percentile);
    }
    unknown_metric(limit, name, error);
    return NULL;
}

static bool set_limit(struct kiln_metric_set *set, const char *limit, struct kiln_error *error)
{
    const char *equals = strchr(limit, '=');
    size_t length = equals ? (size_t)(equals - limit) : 0;
    if (length == 0)
        return kiln_error_set(error, KILN_USAGE,
                              "limit '%s': expected METRIC=VALUE, such as flip.mean=0.01", limit);
    char name[KILN_METRIC_NAME_SIZE];
    snprintf(name, sizeof name, "%.*s", (int)length, limit);
    struct kiln_compare_column *column = find_column(set, limit, name, error);
    if (!column)
        return false;
    const struct kiln_metric *metric = set->metrics[column - set->columns];
    double value = 0;
    if (!kiln_text_to_double(equals + 1, &value) || value < metric->least || value > metric->most) {
        if (isfinite(metric->most))
            return kiln_error_set(error, KILN_USAGE, "limit '%s': expected a number, %g to %g",
                                  limit, metric->least, metric->most);
        return kiln_error_set(error, KILN_USAGE, "limit '%s': expected a number, %g or more", limit,
                              metric->least);
    }
    column->limited = true;
    column->limit = value;
    return true;
}

bool kiln_metric_set_make(struct kiln_metric_set *set, const char *const *limits,
                          size_t limit_count, struct kiln_error *error)
{
    *set = (struct kiln_metric_set){0};
    for (size_t i = 0; i < METRIC_COUNT; i++) {
        if (!is_family(&metrics[i]))
            add_column(set, metrics[i].name, &metrics[i], metrics[i].percentile);
    }
    for (size_t i = 0; i < limit_count; i++) {
        for (const char *rest = limits[i];; rest++) {
            char limit[64];
            size_t length = strcspn(rest, ",");
            snprintf(limit, sizeof limit, "%.*s", (int)length, rest);
            if (length >= sizeof limit)
                return kiln_error_set(error, KILN_USAGE, "limit '%s...' is too long", limit);
            if (!set_limit(set, limit, error))
                return false;
            rest += length;
            if (*rest == '\0')
                break;
        }
    }
    return true;
}

/* Returns the share of its limit that a value takes up; 1 is at the limit. */
static double score_of(const struct kiln_compare_column *column, double value)
{
    double over = column->higher_is_better ? column->limit : value;
    double under = column->higher_is_better ? value : column->limit;
    if (isinf(under))
        return 0;
    return under > 0 ? over / under : over > under ? INFINITY : 0;
}

bool kiln_metric_set_judge(const struct kiln_metric_set *set,
                           const struct kiln_measurement *measurement,
                           struct kiln_compare_layer *layer, struct kiln_error *error)
{
    layer->verdict = KILN_COMPARE_SAME;
    layer->score = 0;
    for (size_t i = 0; i < set->count; i++) {
        const struct kiln_compare_column *column = &set->columns[i];
        struct metric_value v = {
            .measurement = measurement, .percentile = set->percentiles[i], .error = error};
        if (!set->metrics[i]->compute(&v))
            return false;
        layer->values[i] = v.value;
        bool within =
            column->higher_is_better ? v.value >= column->limit : v.value <= column->limit;
        layer->beyond[i] = column->limited && !within;
        if (layer->beyond[i])
            layer->verdict = KILN_COMPARE_DIFFERENT;
        if (!column->limited)
            continue;
        double score = score_of(column, v.value);
        layer->score = score > layer->score ? score : layer->score;
    }
    return true;
}

bool kiln_metric_set_is_worse(const struct kiln_metric_set *set, size_t i, double a, double b)
{
    return set->columns[i].higher_is_better ? a < b : a > b;
}

bool kiln_write_metrics(FILE *out)
{
    for (size_t i = 0; i < METRIC_COUNT; i++)
        fprintf(out, "  %-16s %-7s %s\n", metrics[i].name, metrics[i].unit, metrics[i].help);
    fprintf(out,
            "\n"
            "A limit is the worst value that passes: the least value of ssim and psnr, and the "
            "greatest value\n"
            "of the other metrics. Without --tolerance it is %s.\n",
            KILN_COMPARE_DEFAULT_LIMITS);
    return !ferror(out);
}

void kiln_visit_metrics(void (*visit)(void *user, const char *name, const char *help), void *user)
{
    for (size_t i = 0; i < METRIC_COUNT; i++) {
        if (!strchr(metrics[i].name, 'N')) /* N stands for any percentile */
            visit(user, metrics[i].name, metrics[i].help);
    }
}
