/* Declares how the library logs: it hands lines to the callback that its caller has set in struct
 * kiln_log (kiln.h). The library's code calls kiln_log_write to inform or to warn; what makes a job
 * fail is an error instead (base/error.h). */
#ifndef KILN_BASE_LOG_H
#define KILN_BASE_LOG_H

#include "kiln.h"

/* Formats one line and hands it over, without a newline. Any thread may call it. Does nothing when
 * the log has no callback. Text from files may be among the arguments: it is escaped
 * (base/shown.h). */
void kiln_log_write(const struct kiln_log *log, enum kiln_log_level level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
