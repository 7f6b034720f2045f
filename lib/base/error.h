/* Declares the functions that fill struct kiln_error. The function that detects a failure, in the
 * library or in the program kiln-decode, calls one of them; the functions above it pass the error
 * on. */
#ifndef KILN_BASE_ERROR_H
#define KILN_BASE_ERROR_H

#include "kiln.h"

/* Sets the code, the formatted message and the place in the source, and returns false, so that a
 * caller can return that. error is not NULL. An argument may be error->message itself, so that a
 * caller can add to the message. Arguments may contain text from untrusted files: characters that
 * would act on a terminal, such as line ends and ESC, become escapes such as \n and \x1b. */
#define kiln_error_set(error, code, ...)                                                           \
    kiln_error_set_at(__FILE__, __LINE__, error, code, __VA_ARGS__)

/* Does what kiln_error_set does, and adds ": " and the text of an errno value to the message. For
 * ENOMEM the code becomes KILN_DEVICE_FAILED, which stands for a lack of memory, too (lib/kiln.h);
 * the file that was read or written is then not at fault. */
#define kiln_error_set_errno(error, code, errnum, ...)                                             \
    kiln_error_set_errno_at(__FILE__, __LINE__, error, code, errnum, __VA_ARGS__)

/* Sets KILN_DEVICE_FAILED and "out of memory for WHAT", where the arguments are the format of WHAT
 * and its values: what the memory is for, or the name of a file that is read or written. Returns
 * false. */
#define kiln_error_no_memory(error, ...)                                                           \
    kiln_error_no_memory_at(__FILE__, __LINE__, error, __VA_ARGS__)

/* The functions behind the macros. file: a string literal. */
bool kiln_error_set_at(const char *file, int line, struct kiln_error *error, enum kiln_code code,
                       const char *format, ...) __attribute__((format(printf, 5, 6)));
bool kiln_error_set_errno_at(const char *file, int line, struct kiln_error *error,
                             enum kiln_code code, int errnum, const char *format, ...)
    __attribute__((format(printf, 6, 7)));
bool kiln_error_no_memory_at(const char *file, int line, struct kiln_error *error,
                             const char *format, ...) __attribute__((format(printf, 4, 5)));

#endif
