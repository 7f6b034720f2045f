/* Hands lines to the caller's log callback. */
#ifndef KILN_BASE_LOG_H
#define KILN_BASE_LOG_H

#include "kiln.h"

/* Formats one line; does nothing when the log has no callback. */
void kiln_log_write(const struct kiln_log *log, enum kiln_log_level level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
