/* Declares the state of printing the struct of a table as text, and the helpers that the printers
 * of all types share. */
#ifndef KILN_OPTION_PRINTER_H
#define KILN_OPTION_PRINTER_H

#include "option/option.h"

struct kiln_printer {
    struct kiln_text text;
    /* the struct that the whole table describes, for types that need other parts of it */
    const void *source;
    const float4 *keys; /* keys of the animated values in source */
    unsigned parts;     /* bit mask: only rows of one of these parts are printed; 0: all rows */
    unsigned indent;    /* spaces of the current block */
    bool after_dash;    /* a list's "-" has just been written */
};

/* Writes "name:" at the current indent; the type writes the rest. */
void kiln_print_key(struct kiln_printer *printer, const char *name);

/* Returns whether a row of a table is printed for a struct that the table describes. */
bool kiln_print_wants(const struct kiln_printer *printer, const struct kiln_option *row,
                      const void *base);

/* Prints every member of a struct, one key a line. */
void kiln_print_members(struct kiln_printer *printer, const struct kiln_option *members,
                        const void *base);

/* Adds a text in quotes. A '$' at its start is doubled, so that it is no parameter when it is
 * read. */
void kiln_print_quoted(struct kiln_printer *printer, const char *text);

/* Prints a text in quotes. This is the `print` function of types whose field is a text. */
void kiln_print_text(struct kiln_printer *printer, const struct kiln_option *option,
                     const void *field);

#endif
