/* Opens FFmpeg's libraries and receives their log messages. Two things are state of this file,
 * since a process has them once: the table of FFmpeg's functions, and FFmpeg's one log callback,
 * which gets no pointer of ours. So a pointer per thread says where the messages of that thread go;
 * it is NULL outside of kiln_avlog_begin and kiln_avlog_end. */
#include "base/ffmpeg.h"

#include <locale.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/log.h"

struct kiln_ffmpeg kiln_ff;

#define FIND(function)          {#function, &kiln_ff.function},
#define NAME(library, major)    library ".so." AV_STRINGIFY(major)
#define PACKAGE(library, major) library AV_STRINGIFY(major)

static const struct kiln_library_function util_functions[] = {KILN_AVUTIL_FUNCTIONS(FIND)};
static const struct kiln_library_function codec_functions[] = {KILN_AVCODEC_FUNCTIONS(FIND)};
static const struct kiln_library_function scale_functions[] = {KILN_SWSCALE_FUNCTIONS(FIND)};
static const struct kiln_library_function format_functions[] = {KILN_AVFORMAT_FUNCTIONS(FIND)};

#define LIBRARY(library, major, functions)                                                         \
    {                                                                                              \
        NAME(library, major), PACKAGE(library, major), functions,                                  \
            sizeof(functions) / sizeof *(functions), false                                         \
    }

/* The libraries, by the names of the versions that the headers describe. */
static struct library {
    const char *file, *package;
    const struct kiln_library_function *functions;
    size_t count;
    bool is_open;
} libraries[] = {
    LIBRARY("libavutil", LIBAVUTIL_VERSION_MAJOR, util_functions),
    LIBRARY("libavcodec", LIBAVCODEC_VERSION_MAJOR, codec_functions),
    LIBRARY("libswscale", LIBSWSCALE_VERSION_MAJOR, scale_functions),
    LIBRARY("libavformat", LIBAVFORMAT_VERSION_MAJOR, format_functions),
};

/* FFmpeg and its encoders write numbers into files as the thread's locale has them. This one is set
 * while they run. */
static locale_t c_locale;

bool kiln_ffmpeg_open(enum kiln_ffmpeg_part part, struct kiln_error *error)
{
    static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
    const size_t count = part == KILN_FFMPEG_CLIPS ? 4 : 3;
    pthread_mutex_lock(&mutex);
    if (!c_locale)
        c_locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    bool ok = c_locale || kiln_error_no_memory(error, "FFmpeg");
    for (size_t i = 0; ok && i < count; i++) {
        struct library *library = &libraries[i];
        ok = library->is_open || kiln_library_open(library->file, library->package,
                                                   library->functions, library->count, error);
        library->is_open = ok;
    }
    pthread_mutex_unlock(&mutex);
    return ok;
}

/* ---- messages -------------------------------------------------------------------------------- */

static _Thread_local struct kiln_avlog *current;

static void receive(void *context, int level, const char *format, va_list args)
{
    if (!current) {
        kiln_ff.av_log_default_callback(context, level, format, args);
        return;
    }
    if (level > AV_LOG_WARNING)
        return;
    char line[256];
    int print_prefix = 0;
    kiln_ff.av_log_format_line2(context, level, format, args, line, sizeof line, &print_prefix);
    line[strcspn(line, "\r\n")] = '\0';
    if (line[0] == '\0')
        return;
    if (level <= AV_LOG_ERROR && current->first_error[0] == '\0')
        snprintf(current->first_error, sizeof current->first_error, "%.*s",
                 (int)sizeof current->first_error - 1, line);
    if (current->log)
        kiln_log_write(current->log, KILN_LOG_DEBUG, "ffmpeg: %s", line);
}

void kiln_avlog_begin(struct kiln_avlog *avlog)
{
    avlog->locale = uselocale(c_locale);
    kiln_ff.av_log_set_callback(receive);
    avlog->outer = current;
    avlog->first_error[0] = '\0';
    current = avlog;
}

void kiln_avlog_end(struct kiln_avlog *avlog)
{
    current = avlog->outer;
    uselocale(avlog->locale);
}
