/* This file measures how long each pass of a frame takes.
 *
 * A GPU runs behind the host, and a pass may work on either. Each pass therefore records four times
 * on one clock: the times when host and GPU reach its beginning and its end. A pass begins at the
 * later of the two times of its beginning and ends at the later of the two times of its end. So a
 * pass that only submits work is charged for the time of that work on the GPU, and a pass that
 * waits for an earlier one is not charged for the wait. */
#include "gpu/timer.h"

#include <stdlib.h>

#include "base/clock.h"

/* The number of passes of a frame that are timed on a GPU; further passes count host time. */
enum { MAX_SPANS = 64 };

struct span {
    enum kiln_pass pass;
    GLuint begin, end; /* timestamp queries, kept from frame to frame */
    double host_begin, host_end;
};

struct kiln_timer {
    struct kiln_device *device; /* NULL: host only */
    bool on_gpu;
    bool open;
    enum kiln_pass pass; /* of the open pass */
    double begin;        /* of the open pass, host seconds */
    double ms[KILN_PASS_COUNT];
    const struct kiln_threads *threads; /* NULL: serial times are not measured */
    double serial_begin;                /* of the open pass, seconds */
    double serial_ms[KILN_PASS_COUNT];
    double gpu_to_host; /* added to GPU seconds; measured at the first pass of a frame */
    struct span spans[MAX_SPANS];
    size_t span_count;
};

const char *kiln_pass_name(enum kiln_pass pass)
{
    static const char *const names[] = {
#define PASS_NAME(name) [KILN_PASS_##name] = #name,
        KILN_PASSES(PASS_NAME)
#undef PASS_NAME
    };
    return names[pass];
}

struct kiln_timer *kiln_timer_create(struct kiln_device *device)
{
    struct kiln_timer *timer = calloc(1, sizeof *timer);
    if (!timer)
        return NULL;
    timer->device = device;
    timer->on_gpu = device && !device->info.software;
    return timer;
}

void kiln_timer_destroy(struct kiln_timer **timer)
{
    if (!*timer)
        return;
    for (size_t i = 0; i < MAX_SPANS; i++) {
        if ((*timer)->spans[i].begin) {
            const GLuint queries[] = {(*timer)->spans[i].begin, (*timer)->spans[i].end};
            glDeleteQueries(2, queries);
        }
    }
    free(*timer);
    *timer = NULL;
}

static void begin_span(struct kiln_timer *timer, enum kiln_pass pass)
{
    if (timer->span_count == 0) {
        GLint64 gpu_ns = 0;
        glGetInteger64v(GL_TIMESTAMP, &gpu_ns);
        timer->gpu_to_host = kiln_clock_seconds() - (double)gpu_ns * 1e-9;
    }
    struct span *span = &timer->spans[timer->span_count];
    if (!span->begin) {
        glGenQueries(1, &span->begin);
        glGenQueries(1, &span->end);
    }
    span->pass = pass;
    glQueryCounter(span->begin, GL_TIMESTAMP);
    glFlush(); /* without a flush, the driver may delay the query until much later work */
}

void kiln_timer_begin(struct kiln_timer *timer, enum kiln_pass pass)
{
    if (timer->device)
        kiln_device_push_group(timer->device, kiln_pass_name(pass));
    if (timer->device && !timer->on_gpu)
        glFinish();
    if (timer->on_gpu && timer->span_count < MAX_SPANS)
        begin_span(timer, pass);
    timer->pass = pass;
    timer->open = true;
    if (timer->threads)
        timer->serial_begin = kiln_threads_serial_seconds(timer->threads);
    timer->begin = kiln_clock_seconds();
}

void kiln_timer_end(struct kiln_timer *timer)
{
    if (!timer->open)
        return;
    timer->open = false;
    if (timer->threads)
        timer->serial_ms[timer->pass] +=
            (kiln_threads_serial_seconds(timer->threads) - timer->serial_begin) * 1e3;
    if (timer->on_gpu && timer->span_count < MAX_SPANS) {
        struct span *span = &timer->spans[timer->span_count++];
        glQueryCounter(span->end, GL_TIMESTAMP);
        span->host_begin = timer->begin;
        span->host_end = kiln_clock_seconds();
    } else {
        if (timer->device && !timer->on_gpu)
            glFinish();
        timer->ms[timer->pass] += (kiln_clock_seconds() - timer->begin) * 1e3;
    }
    if (timer->device)
        kiln_device_pop_group(timer->device);
}

static double query_seconds(GLuint query)
{
    GLuint64 ns = 0;
    glGetQueryObjectui64v(query, GL_QUERY_RESULT, &ns);
    return (double)ns * 1e-9;
}

void kiln_timer_collect(struct kiln_timer *timer, double pass_ms[KILN_PASS_COUNT])
{
    for (size_t i = 0; i < timer->span_count; i++) {
        const struct span *span = &timer->spans[i];
        const double gpu_begin = query_seconds(span->begin) + timer->gpu_to_host;
        const double gpu_end = query_seconds(span->end) + timer->gpu_to_host;
        const double begin = gpu_begin > span->host_begin ? gpu_begin : span->host_begin;
        const double end = gpu_end > span->host_end ? gpu_end : span->host_end;
        timer->ms[span->pass] += end > begin ? (end - begin) * 1e3 : 0;
    }
    timer->span_count = 0;
    for (size_t i = 0; i < KILN_PASS_COUNT; i++) {
        pass_ms[i] = timer->ms[i];
        timer->ms[i] = 0;
    }
}

void kiln_timer_measure_serial(struct kiln_timer *timer, struct kiln_threads *threads)
{
    kiln_threads_measure(threads);
    timer->threads = threads;
}

void kiln_timer_collect_serial(struct kiln_timer *timer, double serial_ms[KILN_PASS_COUNT])
{
    for (size_t i = 0; i < KILN_PASS_COUNT; i++) {
        serial_ms[i] = timer->serial_ms[i];
        timer->serial_ms[i] = 0;
    }
}
