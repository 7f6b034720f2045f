/* Declares the functions that fill struct kiln_error. */
#ifndef KILN_BASE_ERROR_H
#define KILN_BASE_ERROR_H

#include "kiln.h"

/* Sets the code and the formatted message; returns false, so that a caller can return it. Texts of
 * strangers may be in it: what would act on a terminal is shown escaped (base/shown.h). */
bool kiln_error_set(struct kiln_error *error, enum kiln_code code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Does what kiln_error_set does, and adds ": " and the text of an errno value to the message.
 * ENOMEM is KILN_DEVICE_FAILED whatever the code: that memory is short says nothing of a file. */
bool kiln_error_set_errno(struct kiln_error *error, enum kiln_code code, int errnum,
                          const char *format, ...) __attribute__((format(printf, 4, 5)));

#endif
