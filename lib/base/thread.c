/* Runs loops on a fixed pool of worker threads. Workers sleep on a condition until a loop is
 * posted, then take pieces of it from an atomic counter. The thread that posts a loop works on it,
 * too. Once no pieces are left, it waits only for workers that have entered the loop, and not for
 * one that has not woken up yet, as may happen on a busy machine. */
#include "base/thread.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"

enum {
    MAX_THREADS = 256,
    COPY_AT_A_TIME = 1 << 18, /* bytes */
};

/* The least time in seconds between two calls of may_go_on. It is much less than a second, so that
 * a job stops soon, and much more than a call takes. */
#define ASK_EVERY_S 0.02

struct worker {
    struct kiln_threads *pool;
    pthread_t thread;
    uint32_t index;
};

struct kiln_threads {
    pthread_mutex_t mutex;
    pthread_cond_t posted, finished;
    uint32_t count;   /* workers, the thread that posts loops included */
    uint32_t started; /* threads to join */
    uint32_t running; /* threads of the pool that are in the present loop */
    uint64_t posts;   /* number of loops posted so far */
    bool open;        /* whether the present loop may be entered */
    bool quit;

    void (*body)(void *, size_t, size_t, uint32_t);
    void *context;
    size_t total, grain;
    atomic_size_t next;

    bool measures;   /* whether shared_s is counted */
    double shared_s; /* time of a processor for the posting thread in loops of several pieces */

    struct kiln_caller caller;
    bool asks;      /* whether the present loop calls caller.may_go_on */
    double asked_s; /* when it was called last */
    bool stopped;   /* it has returned false, with the error `reason`; this stays so */
    struct kiln_error reason;
    struct worker workers[]; /* worker 0, the thread that posts loops, has no element in use */
};

uint32_t kiln_threads_available(void)
{
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof set, &set) != 0)
        return 1;
    int count = CPU_COUNT(&set);
    return count < 1 ? 1 : count > MAX_THREADS ? MAX_THREADS : (uint32_t)count;
}

/* Returns whether the loop goes on. It calls may_go_on every ASK_EVERY_S and returns true in
 * between. Only the thread that posted the loop calls this. */
static bool go_on(struct kiln_threads *pool)
{
    const double now_s = kiln_clock_seconds();
    if (now_s - pool->asked_s < ASK_EVERY_S)
        return true;
    pool->stopped = !kiln_may_go_on(&pool->caller, &pool->reason);
    pool->asked_s = kiln_clock_seconds();
    return !pool->stopped;
}

static void take_pieces(struct kiln_threads *pool, uint32_t worker)
{
    for (;;) {
        if (worker == 0 && pool->asks && !go_on(pool))
            atomic_store(&pool->next, pool->total);
        size_t begin = atomic_fetch_add(&pool->next, pool->grain);
        if (begin >= pool->total)
            return;
        size_t end = pool->total - begin < pool->grain ? pool->total : begin + pool->grain;
        pool->body(pool->context, begin, end, worker);
    }
}

static void *worker_main(void *argument)
{
    struct worker *self = argument;
    struct kiln_threads *pool = self->pool;
    uint64_t seen = 0;
    pthread_mutex_lock(&pool->mutex);
    for (;;) {
        while ((!pool->open || pool->posts == seen) && !pool->quit)
            pthread_cond_wait(&pool->posted, &pool->mutex);
        if (pool->quit)
            break;
        seen = pool->posts;
        pool->running++;
        pthread_mutex_unlock(&pool->mutex);
        take_pieces(pool, self->index);
        pthread_mutex_lock(&pool->mutex);
        if (--pool->running == 0)
            pthread_cond_signal(&pool->finished);
    }
    pthread_mutex_unlock(&pool->mutex);
    return NULL;
}

struct kiln_threads *kiln_threads_create(uint32_t count)
{
    if (count == 0)
        count = kiln_threads_available();
    if (count > MAX_THREADS)
        count = MAX_THREADS;
    struct kiln_threads *pool = calloc(1, sizeof *pool + count * sizeof(struct worker));
    if (!pool)
        return NULL;
    pthread_mutex_init(&pool->mutex, NULL);
    pthread_cond_init(&pool->posted, NULL);
    pthread_cond_init(&pool->finished, NULL);
    pool->count = count;
    for (uint32_t i = 1; i < count; i++) {
        struct worker *worker = &pool->workers[i];
        *worker = (struct worker){.pool = pool, .index = i};
        if (pthread_create(&worker->thread, NULL, worker_main, worker) != 0) {
            kiln_threads_destroy(&pool);
            return NULL;
        }
        pool->started++;
    }
    return pool;
}

void kiln_threads_destroy(struct kiln_threads **threads)
{
    struct kiln_threads *pool = *threads;
    if (!pool)
        return;
    pthread_mutex_lock(&pool->mutex);
    pool->quit = true;
    pthread_cond_broadcast(&pool->posted);
    pthread_mutex_unlock(&pool->mutex);
    for (uint32_t i = 1; i <= pool->started; i++)
        pthread_join(pool->workers[i].thread, NULL);
    pthread_cond_destroy(&pool->finished);
    pthread_cond_destroy(&pool->posted);
    pthread_mutex_destroy(&pool->mutex);
    free(pool);
    *threads = NULL;
}

uint32_t kiln_threads_count(const struct kiln_threads *threads)
{
    return threads->count;
}

/* Runs the pool's loop on all workers, and returns when all have ended. */
static void share_pieces(struct kiln_threads *pool)
{
    pthread_mutex_lock(&pool->mutex);
    pool->posts++;
    pool->open = true;
    pthread_cond_broadcast(&pool->posted);
    pthread_mutex_unlock(&pool->mutex);

    take_pieces(pool, 0);

    pthread_mutex_lock(&pool->mutex);
    pool->open = false;
    while (pool->running > 0)
        pthread_cond_wait(&pool->finished, &pool->mutex);
    pthread_mutex_unlock(&pool->mutex);
}

void kiln_threads_for(struct kiln_threads *threads, size_t count, size_t grain,
                      void (*body)(void *context, size_t begin, size_t end, uint32_t worker),
                      void *context)
{
    if (count == 0)
        return;
    struct kiln_threads *pool = threads;
    pool->body = body;
    pool->context = context;
    pool->total = count;
    pool->grain = grain ? grain : 1;
    atomic_store(&pool->next, 0);
    const bool has_several = count > pool->grain, is_measured = has_several && pool->measures;
    const double start_s = is_measured ? kiln_clock_thread_seconds() : 0.0;
    if (has_several && pool->started > 0)
        share_pieces(pool);
    else
        take_pieces(pool, 0);
    if (is_measured)
        pool->shared_s += kiln_clock_thread_seconds() - start_s;
}

void kiln_threads_measure(struct kiln_threads *threads)
{
    threads->measures = true;
}

double kiln_threads_serial_seconds(const struct kiln_threads *threads)
{
    return kiln_clock_thread_seconds() - threads->shared_s;
}

void kiln_threads_set_caller(struct kiln_threads *threads, const struct kiln_caller *caller)
{
    threads->caller = *caller;
}

bool kiln_threads_try(struct kiln_threads *threads, size_t count, size_t grain,
                      void (*body)(void *context, size_t begin, size_t end, uint32_t worker),
                      void *context, struct kiln_error *error)
{
    if (!threads->stopped) {
        threads->asks = threads->caller.may_go_on != NULL;
        kiln_threads_for(threads, count, grain, body, context);
        threads->asks = false;
    }
    if (threads->stopped)
        *error = threads->reason;
    return !threads->stopped;
}

struct copying {
    char *to;
    const char *from;
};

static void copy(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct copying *c = context;
    memcpy(c->to + begin, c->from + begin, end - begin);
}

bool kiln_threads_copy(struct kiln_threads *threads, void *to, const void *from, size_t bytes,
                       struct kiln_error *error)
{
    struct copying copying = {to, from};
    return kiln_threads_try(threads, bytes, COPY_AT_A_TIME, copy, &copying, error);
}
