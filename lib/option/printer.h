/* Prints the struct of a table as text. Declares the state of one printing, and the helpers that
 * the printers of all types share. */
#ifndef KILN_OPTION_PRINTER_H
#define KILN_OPTION_PRINTER_H

#include "option/option.h"

struct kiln_printer {
    struct kiln_text text;
    const void *source; /* what the whole table describes, for types that look around in it */
    const float4 *keys; /* of its animated values */
    unsigned parts;     /* only rows of one of these are printed; 0: all */
    unsigned indent;    /* spaces of the current block */
    bool after_dash;    /* a list's "-" has just been written */
};

/* Writes "name:" at the current indent; the type writes the rest. */
void kiln_print_key(struct kiln_printer *printer, const char *name);

/* Whether a row of a table is printed for a struct that the table describes. */
bool kiln_print_wants(const struct kiln_printer *printer, const struct kiln_option *row,
                      const void *base);

/* Every member of a struct, one key a line. */
void kiln_print_members(struct kiln_printer *printer, const struct kiln_option *members,
                        const void *base);

/* The print of types whose field is a text: in quotes. */
void kiln_print_text(struct kiln_printer *printer, const struct kiln_option *option,
                     const void *field);

#endif
