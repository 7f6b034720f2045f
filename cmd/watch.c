/* Runs a thread that calls a function at regular times. It sleeps on a condition variable, so that
 * watch_destroy can end it at once. */
#include "watch.h"

#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <time.h>

struct watch {
    void (*look)(void *user);
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
static void sleep_until_next(struct watch *watch)
{
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    until.tv_nsec += watch->every_ms * 1000000L;
    until.tv_sec += until.tv_nsec / 1000000000L;
    until.tv_nsec %= 1000000000L;
    while (!watch->ends && pthread_cond_timedwait(&watch->ended, &watch->mutex, &until) == 0)
        continue;
}

static void *run(void *context)
{
    struct watch *watch = context;
    pthread_mutex_lock(&watch->mutex);
    while (!watch->ends) {
        sleep_until_next(watch);
        if (!watch->ends)
            watch->look(watch->user);
    }
    pthread_mutex_unlock(&watch->mutex);
    return NULL;
}

static void release(struct watch *watch)
{
    pthread_cond_destroy(&watch->ended);
    pthread_mutex_destroy(&watch->mutex);
    free(watch);
}

struct watch *watch_create(void (*look)(void *user), void *user, int every_ms)
{
    struct watch *watch = calloc(1, sizeof *watch);
    if (!watch)
        return NULL;
    *watch = (struct watch){.look = look, .user = user, .every_ms = every_ms};
    pthread_condattr_t attributes;
    pthread_condattr_init(&attributes);
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    pthread_cond_init(&watch->ended, &attributes);
    pthread_condattr_destroy(&attributes);
    pthread_mutex_init(&watch->mutex, NULL);
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    const int status = pthread_create(&watch->thread, NULL, run, watch);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (status == 0)
        return watch;
    release(watch);
    return NULL;
}

void watch_destroy(struct watch **watch)
{
    struct watch *w = *watch;
    if (!w)
        return;
    pthread_mutex_lock(&w->mutex);
    w->ends = true;
    pthread_cond_signal(&w->ended);
    pthread_mutex_unlock(&w->mutex);
    pthread_join(w->thread, NULL);
    release(w);
    *watch = NULL;
}
