/* Writes templates, and writes text of any origin into an HTML page, escaped so that no part of it
 * acts as markup. These functions do not report failed writes; the caller checks the stream. */
#ifndef KILN_REPORT_MARKUP_H
#define KILN_REPORT_MARKUP_H

#include "kiln.h"

/* A field of a template; `write` writes the text in place of {{name}}. A NULL name ends a list. */
struct kiln_markup_field {
    const char *name;
    void (*write)(FILE *out, const void *user);
    const void *user;
};

/* Writes a template with its fields. KILN_USAGE for a {{name}} without a field, or "{{" without
 * "}}". */
bool kiln_markup_write_template(FILE *out, const char *text, const struct kiln_markup_field *fields,
                                struct kiln_error *error);

/* Returns the entity of a character that is markup in HTML and XML, or NULL. */
const char *kiln_markup_entity(char c);

/* Writes HTML text or an attribute's value (in double quotes). Invalid UTF-8 and control characters
 * other than line feed and tab become U+FFFD. */
void kiln_markup_write_text(FILE *out, const char *text);

/* Writes a path as a relative URL. Characters that are special in URLs or HTML are percent-encoded.
 */
void kiln_markup_write_url(FILE *out, const char *path);

void kiln_markup_write_base64(FILE *out, const void *bytes, size_t size);

#endif
