/* Times one sort of given keys by one technique. Before the clock starts, the pairs and the list
 * are written and lie where the technique runs. */
#include "bench/sort_trial.h"

#include <stdlib.h>

#include "base/clock.h"
#include "base/error.h"
#include "bench/bitonic_field.h"
#include "sort/bitonic.h"
#include "sort/oddeven.h"
#include "sort/pairs.h"
#include "sort/radix.h"

struct kiln_sort_trial {
    enum kiln_sort_trial_kind kind;
    struct kiln_threads *threads;
    struct kiln_buffer pairs, list, sorted;
    struct kiln_buffer counts; /* counters of the kind `cpu` */
    struct kiln_radix *radix;
    struct kiln_bitonic *bitonic;
    struct kiln_oddeven *oddeven;
    struct kiln_bitonic_field *field;
};

const char *kiln_sort_trial_name(enum kiln_sort_trial_kind kind)
{
    static const char *const names[KILN_TRIAL_COUNT] = {
        [KILN_TRIAL_CPU] = "cpu",
        [KILN_TRIAL_RADIX] = "radix",
        [KILN_TRIAL_BITONIC] = "bitonic",
        [KILN_TRIAL_ODDEVEN] = "oddeven",
        [KILN_TRIAL_COMPUTED] = "bitonic-computed",
        [KILN_TRIAL_PASSED] = "bitonic-passed",
        [KILN_TRIAL_PACKED] = "bitonic-packed",
    };
    return names[kind];
}

static bool create_sort(struct kiln_sort_trial *t, struct kiln_device *device,
                        struct kiln_error *error)
{
    switch (t->kind) {
    case KILN_TRIAL_RADIX:
        t->radix = kiln_radix_create(device, error);
        return t->radix != NULL;
    case KILN_TRIAL_BITONIC:
        t->bitonic = kiln_bitonic_create(device, error);
        return t->bitonic != NULL;
    case KILN_TRIAL_ODDEVEN:
        t->oddeven = kiln_oddeven_create(device, error);
        return t->oddeven != NULL;
    case KILN_TRIAL_COMPUTED:
    case KILN_TRIAL_PASSED:
    case KILN_TRIAL_PACKED:
        t->field = kiln_bitonic_field_create(
            device, (enum kiln_field_constants)(t->kind - KILN_TRIAL_COMPUTED), error);
        return t->field != NULL;
    case KILN_TRIAL_CPU:
    case KILN_TRIAL_COUNT:
        break;
    }
    return true;
}

struct kiln_sort_trial *kiln_sort_trial_create(struct kiln_device *device,
                                               struct kiln_threads *threads,
                                               enum kiln_sort_trial_kind kind, uint32_t most,
                                               struct kiln_error *error)
{
    if (kind != KILN_TRIAL_CPU && !device) {
        kiln_error_set(error, KILN_USAGE, "sort %s needs a device", kiln_sort_trial_name(kind));
        return NULL;
    }
    struct kiln_sort_trial *trial = calloc(1, sizeof *trial);
    if (!trial) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "sort: no memory");
        return NULL;
    }
    trial->kind = kind;
    trial->threads = threads;
    struct kiln_device *where = kind == KILN_TRIAL_CPU ? NULL : device;
    size_t padded = kiln_network_padded(most);
    kiln_buffer_init(&trial->pairs, where, padded * sizeof(kiln_sort_pair), "trial pairs");
    kiln_buffer_init(&trial->list, where, (size_t)most * sizeof(uint32_t), "trial list");
    kiln_buffer_init(&trial->sorted, where, (size_t)most * sizeof(kiln_sort_pair), "trial result");
    size_t words = kind == KILN_TRIAL_CPU ? kiln_sort_count_words(threads) : 0;
    kiln_buffer_init(&trial->counts, NULL, words * sizeof(uint32_t), "trial counts");
    if (!create_sort(trial, where, error))
        kiln_sort_trial_destroy(&trial);
    return trial;
}

void kiln_sort_trial_destroy(struct kiln_sort_trial **trial)
{
    struct kiln_sort_trial *t = *trial;
    if (!t)
        return;
    kiln_radix_destroy(&t->radix);
    kiln_bitonic_destroy(&t->bitonic);
    kiln_oddeven_destroy(&t->oddeven);
    kiln_bitonic_field_destroy(&t->field);
    struct kiln_buffer *buffers[] = {&t->pairs, &t->list, &t->sorted, &t->counts};
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++)
        kiln_buffer_finish(buffers[i]);
    free(t);
    *trial = NULL;
}

void kiln_sort_trial_restrict(struct kiln_sort_trial *trial, uint32_t rows)
{
    if (trial->field)
        kiln_bitonic_field_restrict(trial->field, rows);
}

static bool prepare(struct kiln_sort_trial *t, const uint32_t *keys, uint32_t count,
                    struct kiln_error *error)
{
    const bool on_host = t->kind == KILN_TRIAL_CPU;
    uint32_t *words = kiln_buffer_host(&t->pairs, KILN_OVERWRITE, error);
    uint32_t *list = words ? kiln_buffer_host(&t->list, KILN_OVERWRITE, error) : NULL;
    if (!list)
        return false;
    for (uint32_t i = 0; i < count; i++) {
        if (on_host) {
            ((kiln_sort_pair *)words)[i] = (kiln_sort_pair)keys[i] << 32 | i;
        } else {
            words[2 * (size_t)i] = keys[i];
            words[2 * (size_t)i + 1] = i;
        }
        list[i] = i;
    }
    if (on_host)
        return kiln_buffer_host(&t->sorted, KILN_OVERWRITE, error) &&
               kiln_buffer_host(&t->counts, KILN_OVERWRITE, error);
    bool ready = kiln_buffer_gl(&t->pairs, KILN_READ_WRITE, error) &&
                 kiln_buffer_gl(&t->list, KILN_READ, error) &&
                 kiln_buffer_gl(&t->sorted, KILN_OVERWRITE, error);
    glFinish();
    return ready;
}

static struct kiln_network *network_of(struct kiln_sort_trial *t)
{
    if (t->bitonic)
        return kiln_bitonic_network(t->bitonic);
    return t->oddeven ? kiln_oddeven_network(t->oddeven) : kiln_bitonic_field_network(t->field);
}

static void sort_on_host(struct kiln_sort_trial *t, uint32_t count)
{
    kiln_sort_pairs(t->threads, t->pairs.host, count, (struct kiln_sort_span){0, UINT32_MAX}, false,
                    t->sorted.host, t->counts.host);
}

bool kiln_sort_trial_run(struct kiln_sort_trial *trial, const uint32_t *keys, uint32_t count,
                         double *ms, struct kiln_error *error)
{
    struct kiln_sort_trial *t = trial;
    *ms = 0;
    if (count == 0)
        return true;
    if (!prepare(t, keys, count, error))
        return false;
    const double before_s = kiln_clock_seconds();
    bool ok = true;
    if (t->kind == KILN_TRIAL_CPU)
        sort_on_host(t, count);
    else if (t->radix)
        ok = kiln_radix_pairs(t->radix, &t->pairs, count, false, error);
    else
        ok =
            kiln_network_pairs(network_of(t), &t->pairs, &t->list, count, false, &t->sorted, error);
    if (t->kind != KILN_TRIAL_CPU)
        glFinish();
    *ms = 1e3 * (kiln_clock_seconds() - before_s);
    return ok;
}

const uint32_t *kiln_sort_trial_places(struct kiln_sort_trial *trial, struct kiln_error *error)
{
    return kiln_buffer_host(trial->radix ? &trial->pairs : &trial->sorted, KILN_READ, error);
}
