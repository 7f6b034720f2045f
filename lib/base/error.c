/* Fills struct kiln_error, a code and one line of message. An error is a value: it is written where
 * the fault is found, and the caller of the library prints it once. */
#include "base/error.h"

#include <errno.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "base/shown.h"
#include "base/text.h"

/* Removes the bytes of half a character at the end of a text that was cut. */
static void drop_cut_character(char *text)
{
    size_t length = strlen(text);
    for (int i = 0; i < 3 && length > 0 && ((unsigned char)text[length - 1] & 0xc0) == 0x80; i++)
        length--;
    if (length > 0 && kiln_text_character_length(text + length - 1) == 0)
        text[length - 1] = '\0';
}

/* Returns how many bytes the caller's struct has for a message. A struct of size 0 counts as one of
 * this version. */
static size_t message_room(const struct kiln_error *error)
{
    const size_t before = offsetof(struct kiln_error, message);
    if (error->size == 0 || error->size >= sizeof *error)
        return sizeof error->message;
    return error->size > before ? error->size - before : 0;
}

static void format_message(struct kiln_error *error, enum kiln_code code, const char *format,
                           va_list args)
{
    char text[KILN_MESSAGE_SIZE];
    error->code = code;
    const int length = vsnprintf(text, sizeof text, format, args);
    if (length >= (int)sizeof text)
        drop_cut_character(text);
    if (message_room(error) > 0)
        kiln_shown(error->message, message_room(error), text);
}

/* Stores the place in the source, for which a struct of an older version has no room. */
static void set_origin(struct kiln_error *error, const char *file, int line)
{
    if (error->size != 0 && error->size < sizeof *error)
        return;
    error->file = file;
    error->line = line;
}

bool kiln_error_set_at(const char *file, int line, struct kiln_error *error, enum kiln_code code,
                       const char *format, ...)
{
    va_list args;
    va_start(args, format);
    format_message(error, code, format, args);
    va_end(args);
    set_origin(error, file, line);
    return false;
}

bool kiln_error_set_errno_at(const char *file, int line, struct kiln_error *error,
                             enum kiln_code code, int errnum, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    format_message(error, errnum == ENOMEM ? KILN_DEVICE_FAILED : code, format, args);
    va_end(args);
    set_origin(error, file, line);

    char text[128];
    const size_t room = message_room(error), length = room > 0 ? strlen(error->message) : 0;
    if (room > 0)
        snprintf(error->message + length, room - length, ": %s",
                 strerror_r(errnum, text, sizeof text));
    return false;
}

bool kiln_error_no_memory_at(const char *file, int line, struct kiln_error *error,
                             const char *format, ...)
{
    char what[KILN_MESSAGE_SIZE];
    va_list args;
    va_start(args, format);
    vsnprintf(what, sizeof what, format, args);
    va_end(args);
    kiln_error_set(error, KILN_DEVICE_FAILED, "out of memory for %s", what);
    set_origin(error, file, line);
    return false;
}
