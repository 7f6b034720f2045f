/* Runs a thread that calls a function at regular times. It sleeps on a condition variable, so that
 * timer_thread_destroy can end it at once. */
#include "timer_thread.h"

#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <time.h>

struct timer_thread {
    void (*callback)(void *user);
    void *user;
    int every_ms;
    pthread_t thread;
    pthread_mutex_t mutex;
    pthread_cond_t ended;
    bool ends;
};

double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Sleeps until the next call is due; the caller holds the mutex. */
static void sleep_until_next(struct timer_thread *timer)
{
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    until.tv_nsec += timer->every_ms * 1000000L;
    until.tv_sec += until.tv_nsec / 1000000000L;
    until.tv_nsec %= 1000000000L;
    while (!timer->ends && pthread_cond_timedwait(&timer->ended, &timer->mutex, &until) == 0)
        continue;
}

static void *run(void *context)
{
    struct timer_thread *timer = context;
    pthread_mutex_lock(&timer->mutex);
    while (!timer->ends) {
        sleep_until_next(timer);
        if (!timer->ends)
            timer->callback(timer->user);
    }
    pthread_mutex_unlock(&timer->mutex);
    return NULL;
}

static void release(struct timer_thread *timer)
{
    pthread_cond_destroy(&timer->ended);
    pthread_mutex_destroy(&timer->mutex);
    free(timer);
}

struct timer_thread *timer_thread_create(void (*callback)(void *user), void *user, int every_ms)
{
    struct timer_thread *timer = calloc(1, sizeof *timer);
    if (!timer)
        return NULL;
    *timer = (struct timer_thread){.callback = callback, .user = user, .every_ms = every_ms};
    pthread_condattr_t attributes;
    pthread_condattr_init(&attributes);
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    pthread_cond_init(&timer->ended, &attributes);
    pthread_condattr_destroy(&attributes);
    pthread_mutex_init(&timer->mutex, NULL);
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    const int status = pthread_create(&timer->thread, NULL, run, timer);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (status == 0)
        return timer;
    release(timer);
    return NULL;
}

void timer_thread_destroy(struct timer_thread **timer)
{
    struct timer_thread *t = *timer;
    if (!t)
        return;
    pthread_mutex_lock(&t->mutex);
    t->ends = true;
    pthread_cond_signal(&t->ended);
    pthread_mutex_unlock(&t->mutex);
    pthread_join(t->thread, NULL);
    release(t);
    *timer = NULL;
}
