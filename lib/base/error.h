/* Declares the functions that fill struct kiln_error. A function of the library, or of kiln-decode,
 * calls one where it finds the fault, and its callers pass the error on. */
#ifndef KILN_BASE_ERROR_H
#define KILN_BASE_ERROR_H

#include "kiln.h"

/* Sets the code and the formatted message, and returns false, so that a caller can return that.
 * error is not NULL. The arguments may contain text from untrusted files, and the error's own old
 * message: characters that would act on a terminal are escaped (base/shown.h). */
bool kiln_error_set(struct kiln_error *error, enum kiln_code code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Does what kiln_error_set does, and adds ": " and the text of an errno value to the message. For
 * ENOMEM the code becomes KILN_DEVICE_FAILED, because the file that was read or written is not at
 * fault when memory is short. */
bool kiln_error_set_errno(struct kiln_error *error, enum kiln_code code, int errnum,
                          const char *format, ...) __attribute__((format(printf, 4, 5)));

#endif
