/* A thread that sleeps until a deadline that the renderer keeps moving. */
#include "watchdog.h"

#include <math.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdlib.h>
#include <time.h>

#include "last_words.h"

struct watchdog {
    pthread_t thread;
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    bool armed, ended;
    struct timespec deadline; /* CLOCK_MONOTONIC */
    double limit_s;
    char what[512];
};

static bool is_past(const struct timespec *deadline)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec > deadline->tv_sec ||
           (now.tv_sec == deadline->tv_sec && now.tv_nsec >= deadline->tv_nsec);
}

_Noreturn static void bite(const struct watchdog *watchdog)
{
    char line[1024];
    snprintf(line, sizeof line, "kiln: %s took longer than its limit of %g s\n", watchdog->what,
             watchdog->limit_s);
    end_with_words(line, KILN_DEVICE_FAILED);
}

static void *watch(void *context)
{
    struct watchdog *watchdog = context;
    pthread_mutex_lock(&watchdog->mutex);
    while (!watchdog->ended) {
        if (!watchdog->armed)
            pthread_cond_wait(&watchdog->changed, &watchdog->mutex);
        else if (is_past(&watchdog->deadline))
            bite(watchdog);
        else
            pthread_cond_timedwait(&watchdog->changed, &watchdog->mutex, &watchdog->deadline);
    }
    pthread_mutex_unlock(&watchdog->mutex);
    return NULL;
}

struct watchdog *watchdog_create(void)
{
    struct watchdog *watchdog = calloc(1, sizeof *watchdog);
    if (!watchdog)
        return NULL;
    pthread_condattr_t attributes;
    pthread_condattr_init(&attributes);
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    pthread_cond_init(&watchdog->changed, &attributes);
    pthread_condattr_destroy(&attributes);
    pthread_mutex_init(&watchdog->mutex, NULL);
    if (pthread_create(&watchdog->thread, NULL, watch, watchdog) == 0)
        return watchdog;
    pthread_cond_destroy(&watchdog->changed);
    pthread_mutex_destroy(&watchdog->mutex);
    free(watchdog);
    return NULL;
}

void watchdog_destroy(struct watchdog **watchdog)
{
    struct watchdog *w = *watchdog;
    if (!w)
        return;
    pthread_mutex_lock(&w->mutex);
    w->ended = true;
    pthread_cond_signal(&w->changed);
    pthread_mutex_unlock(&w->mutex);
    pthread_join(w->thread, NULL);
    pthread_cond_destroy(&w->changed);
    pthread_mutex_destroy(&w->mutex);
    free(w);
    *watchdog = NULL;
}

void watchdog_arm(struct watchdog *watchdog, double limit_s, const char *what, ...)
{
    va_list args;
    va_start(args, what);
    pthread_mutex_lock(&watchdog->mutex);
    double whole_s = floor(limit_s);
    clock_gettime(CLOCK_MONOTONIC, &watchdog->deadline);
    watchdog->deadline.tv_sec += (time_t)whole_s;
    watchdog->deadline.tv_nsec += (long)((limit_s - whole_s) * 1e9);
    if (watchdog->deadline.tv_nsec >= 1000000000L) {
        watchdog->deadline.tv_sec++;
        watchdog->deadline.tv_nsec -= 1000000000L;
    }
    watchdog->armed = true;
    watchdog->limit_s = limit_s;
    vsnprintf(watchdog->what, sizeof watchdog->what, what, args);
    pthread_cond_signal(&watchdog->changed);
    pthread_mutex_unlock(&watchdog->mutex);
    va_end(args);
}

void watchdog_disarm(struct watchdog *watchdog)
{
    pthread_mutex_lock(&watchdog->mutex);
    watchdog->armed = false;
    pthread_mutex_unlock(&watchdog->mutex);
}
