/* FFmpeg has one log callback per process and hands it no user pointer; a pointer per thread says
 * whose messages these are. That pointer is the only state here, and is NULL outside a pair. */
#include "asset/image/avlog.h"

#include <libavutil/log.h>
#include <stdio.h>
#include <string.h>

#include "base/log.h"

static _Thread_local struct kiln_avlog *current;

static void receive(void *context, int level, const char *format, va_list args)
{
    if (!current) {
        av_log_default_callback(context, level, format, args);
        return;
    }
    if (level > AV_LOG_WARNING)
        return;
    char line[256];
    int print_prefix = 0;
    av_log_format_line2(context, level, format, args, line, sizeof line, &print_prefix);
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
    av_log_set_callback(receive);
    avlog->outer = current;
    avlog->first_error[0] = '\0';
    current = avlog;
}

void kiln_avlog_end(struct kiln_avlog *avlog)
{
    current = avlog->outer;
}
