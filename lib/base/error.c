/* Errors are values: a code and one line, written where the fault is found and printed once, by
 * whoever called the library. */
#include "base/error.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static void format_message(struct kiln_error *error, enum kiln_code code, const char *format,
                           va_list args)
{
    error->code = code;
    vsnprintf(error->message, sizeof error->message, format, args);
}

bool kiln_error_set(struct kiln_error *error, enum kiln_code code, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    format_message(error, code, format, args);
    va_end(args);
    return false;
}

bool kiln_error_set_errno(struct kiln_error *error, enum kiln_code code, int errnum,
                          const char *format, ...)
{
    va_list args;
    va_start(args, format);
    format_message(error, errnum == ENOMEM ? KILN_DEVICE_FAILED : code, format, args);
    va_end(args);

    char text[128];
    size_t length = strlen(error->message);
    snprintf(error->message + length, sizeof error->message - length, ": %s",
             strerror_r(errnum, text, sizeof text));
    return false;
}
