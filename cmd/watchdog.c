/* Ends the program when a deadline has passed, from a thread that looks at the clock
 * (timer_thread.c).
 *
 * Only cmd/render.c uses it, for --frame-timeout. It sets a deadline when it starts to load the
 * scenes, when it starts to open the device and when a frame begins, and removes the deadline when
 * that work is done: waiting for a slow reader of the output is no fault of a frame.
 *
 * The program is ended, not the frame, because a thread that hangs in a driver cannot be
 * interrupted. It may hold locks of stdio or of a library, so `check_deadline` may call nothing
 * that takes one. */
#include "watchdog.h"

#include <pthread.h>
#include <stdarg.h>
#include <stdlib.h>

#include "exit_message.h"
#include "scene_in.h"
#include "timer_thread.h"

struct watchdog {
    struct timer_thread *timer;
    pthread_mutex_t mutex; /* guards the members below */
    bool armed;
    double deadline_s, limit_s;
    char what[512];
};

enum { CHECK_INTERVAL_MS = 20 };

/* Runs in the timer thread, every CHECK_INTERVAL_MS. While a scene is loaded, the message names
 * that scene instead of `what`, which then stands for all scenes. */
static void check_deadline(void *user)
{
    struct watchdog *watchdog = user;
    pthread_mutex_lock(&watchdog->mutex);
    if (watchdog->armed && now_s() >= watchdog->deadline_s) {
        char scene[KILN_MESSAGE_SIZE], line[KILN_MESSAGE_SIZE + 128];
        snprintf(line, sizeof line,
                 "kiln: %s took longer than its limit of %g s (--frame-timeout)\n",
                 scene_in_describe(scene) ? scene : watchdog->what, watchdog->limit_s);
        exit_with_message(line, KILN_DEVICE_FAILED);
    }
    pthread_mutex_unlock(&watchdog->mutex);
}

struct watchdog *watchdog_create(void)
{
    struct watchdog *watchdog = calloc(1, sizeof *watchdog);
    if (!watchdog)
        return NULL;
    pthread_mutex_init(&watchdog->mutex, NULL);
    watchdog->timer = timer_thread_create(check_deadline, watchdog, CHECK_INTERVAL_MS);
    if (!watchdog->timer)
        watchdog_destroy(&watchdog);
    return watchdog;
}

void watchdog_destroy(struct watchdog **watchdog)
{
    struct watchdog *w = *watchdog;
    if (!w)
        return;
    timer_thread_destroy(&w->timer);
    pthread_mutex_destroy(&w->mutex);
    free(w);
    *watchdog = NULL;
}

void watchdog_arm(struct watchdog *watchdog, double limit_s, const char *what, ...)
{
    va_list args;
    va_start(args, what);
    pthread_mutex_lock(&watchdog->mutex);
    watchdog->armed = true;
    watchdog->deadline_s = now_s() + limit_s;
    watchdog->limit_s = limit_s;
    vsnprintf(watchdog->what, sizeof watchdog->what, what, args);
    pthread_mutex_unlock(&watchdog->mutex);
    va_end(args);
}

void watchdog_disarm(struct watchdog *watchdog)
{
    pthread_mutex_lock(&watchdog->mutex);
    watchdog->armed = false;
    pthread_mutex_unlock(&watchdog->mutex);
}
