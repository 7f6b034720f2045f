/* Declares the functions that fill struct kiln_error. The function that detects a failure, in the
 * library or in the program kiln-decode, calls one of them; the functions above it pass the error
 * on. */
#ifndef KILN_BASE_ERROR_H
#define KILN_BASE_ERROR_H

#include "kiln.h"

/* Sets the code and the formatted message, and returns false, so that a caller can return that.
 * error is not NULL. An argument may be error->message itself, so that a caller can add to the
 * message. Arguments may contain text from untrusted files: characters that would act on a
 * terminal, such as line ends and ESC, become escapes such as \n and \x1b. */
bool kiln_error_set(struct kiln_error *error, enum kiln_code code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Does what kiln_error_set does, and adds ": " and the text of an errno value to the message. For
 * ENOMEM the code becomes KILN_DEVICE_FAILED, which stands for a lack of memory, too (lib/kiln.h);
 * the file that was read or written is then not at fault. */
bool kiln_error_set_errno(struct kiln_error *error, enum kiln_code code, int errnum,
                          const char *format, ...) __attribute__((format(printf, 4, 5)));

#endif
