/* Formats a line and hands it to the caller's log callback. The library itself prints nothing. */
#include "base/log.h"

#include <stdarg.h>

#include "base/shown.h"

void kiln_log_write(const struct kiln_log *log, enum kiln_log_level level, const char *format, ...)
{
    if (!log->write)
        return;
    char line[1024], shown[1024];
    va_list args;
    va_start(args, format);
    vsnprintf(line, sizeof line, format, args);
    va_end(args);
    kiln_shown(shown, sizeof shown, line);
    log->write(log->user, level, shown);
}
