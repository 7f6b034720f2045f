/* Times one sort of given keys by one technique. Before the clock starts, the pairs and the list
 * are written and lie where the technique runs. */
#include "bench/papers/sort_timer.h"

#include <stdlib.h>

#include "base/clock.h"
#include "base/error.h"
#include "bench/papers/bitonic_field.h"
#include "sort/bitonic.h"
#include "sort/pairs.h"
#include "sort/papers/oddeven.h"
#include "sort/radix.h"

struct kiln_sort_timer {
    enum kiln_sort_timer_kind kind;
    struct kiln_threads *threads;
    struct kiln_buffer pairs, list, sorted;
    struct kiln_buffer counts; /* counters of the kind `cpu` */
    struct kiln_radix *radix;
    struct kiln_bitonic *bitonic;
    struct kiln_oddeven *oddeven;
    struct kiln_bitonic_field *field;
};

const char *kiln_sort_timer_name(enum kiln_sort_timer_kind kind)
{
    static const char *const names[KILN_SORT_TIMER_COUNT] = {
        [KILN_SORT_TIMER_CPU] = "cpu",
        [KILN_SORT_TIMER_RADIX] = "radix",
        [KILN_SORT_TIMER_BITONIC] = "bitonic",
        [KILN_SORT_TIMER_ODDEVEN] = "oddeven",
        [KILN_SORT_TIMER_COMPUTED] = "bitonic-computed",
        [KILN_SORT_TIMER_PASSED] = "bitonic-passed",
        [KILN_SORT_TIMER_PACKED] = "bitonic-packed",
    };
    return names[kind];
}

static bool create_sort(struct kiln_sort_timer *timer, struct kiln_device *device,
                        struct kiln_error *error)
{
    switch (timer->kind) {
    case KILN_SORT_TIMER_RADIX:
        timer->radix = kiln_radix_create(device, error);
        return timer->radix != NULL;
    case KILN_SORT_TIMER_BITONIC:
        timer->bitonic = kiln_bitonic_create(device, error);
        return timer->bitonic != NULL;
    case KILN_SORT_TIMER_ODDEVEN:
        timer->oddeven = kiln_oddeven_create(device, error);
        return timer->oddeven != NULL;
    case KILN_SORT_TIMER_COMPUTED:
    case KILN_SORT_TIMER_PASSED:
    case KILN_SORT_TIMER_PACKED:
        timer->field = kiln_bitonic_field_create(
            device, (enum kiln_field_constants)(timer->kind - KILN_SORT_TIMER_COMPUTED), error);
        return timer->field != NULL;
    case KILN_SORT_TIMER_CPU:
    case KILN_SORT_TIMER_COUNT:
        break;
    }
    return true;
}

struct kiln_sort_timer *kiln_sort_timer_create(struct kiln_device *device,
                                               struct kiln_threads *threads,
                                               enum kiln_sort_timer_kind kind, uint32_t most,
                                               struct kiln_error *error)
{
    if (kind != KILN_SORT_TIMER_CPU && !device) {
        kiln_error_set(error, KILN_USAGE, "sort %s needs a device", kiln_sort_timer_name(kind));
        return NULL;
    }
    struct kiln_sort_timer *timer = calloc(1, sizeof *timer);
    if (!timer) {
        kiln_error_no_memory(error, "the sort");
        return NULL;
    }
    timer->kind = kind;
    timer->threads = threads;
    struct kiln_device *where = kind == KILN_SORT_TIMER_CPU ? NULL : device;
    size_t padded = kiln_network_padded(most);
    kiln_buffer_init(&timer->pairs, where, padded * sizeof(kiln_sort_pair), "trial pairs");
    kiln_buffer_init(&timer->list, where, (size_t)most * sizeof(uint32_t), "trial list");
    kiln_buffer_init(&timer->sorted, where, (size_t)most * sizeof(kiln_sort_pair), "trial result");
    size_t count_words = kind == KILN_SORT_TIMER_CPU ? kiln_sort_count_words(threads) : 0;
    kiln_buffer_init(&timer->counts, NULL, count_words * sizeof(uint32_t), "trial counts");
    if (!create_sort(timer, where, error))
        kiln_sort_timer_destroy(&timer);
    return timer;
}

void kiln_sort_timer_destroy(struct kiln_sort_timer **timer)
{
    struct kiln_sort_timer *t = *timer;
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
    *timer = NULL;
}

void kiln_sort_timer_restrict(struct kiln_sort_timer *timer, uint32_t rows)
{
    if (timer->field)
        kiln_bitonic_field_restrict(timer->field, rows);
}

static bool prepare(struct kiln_sort_timer *t, const uint32_t *keys, uint32_t count,
                    struct kiln_error *error)
{
    const bool on_host = t->kind == KILN_SORT_TIMER_CPU;
    uint32_t *count_words = kiln_buffer_host(&t->pairs, KILN_OVERWRITE, error);
    uint32_t *list = count_words ? kiln_buffer_host(&t->list, KILN_OVERWRITE, error) : NULL;
    if (!list)
        return false;
    for (uint32_t i = 0; i < count; i++) {
        if (on_host) {
            ((kiln_sort_pair *)count_words)[i] = (kiln_sort_pair)keys[i] << 32 | i;
        } else {
            count_words[2 * (size_t)i] = keys[i];
            count_words[2 * (size_t)i + 1] = i;
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

static struct kiln_network *network_of(struct kiln_sort_timer *t)
{
    if (t->bitonic)
        return kiln_bitonic_network(t->bitonic);
    return t->oddeven ? kiln_oddeven_network(t->oddeven) : kiln_bitonic_field_network(t->field);
}

static void sort_on_host(struct kiln_sort_timer *t, uint32_t count)
{
    kiln_sort_pairs(t->threads, t->pairs.host, count, (struct kiln_sort_span){0, UINT32_MAX}, false,
                    t->sorted.host, t->counts.host);
}

bool kiln_sort_timer_run(struct kiln_sort_timer *timer, const uint32_t *keys, uint32_t count,
                         double *ms, struct kiln_error *error)
{
    struct kiln_sort_timer *t = timer;
    *ms = 0;
    if (count == 0)
        return true;
    if (!prepare(t, keys, count, error))
        return false;
    const double before_s = kiln_clock_seconds();
    bool ok = true;
    if (t->kind == KILN_SORT_TIMER_CPU)
        sort_on_host(t, count);
    else if (t->radix)
        ok = kiln_radix_pairs(t->radix, &t->pairs, count, false, error);
    else
        ok =
            kiln_network_pairs(network_of(t), &t->pairs, &t->list, count, false, &t->sorted, error);
    if (t->kind != KILN_SORT_TIMER_CPU)
        glFinish();
    *ms = 1e3 * (kiln_clock_seconds() - before_s);
    return ok;
}

const uint32_t *kiln_sort_timer_places(struct kiln_sort_timer *timer, struct kiln_error *error)
{
    return kiln_buffer_host(timer->radix ? &timer->pairs : &timer->sorted, KILN_READ, error);
}
