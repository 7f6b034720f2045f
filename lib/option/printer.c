/* Holds the helpers that the printers of all types share. */
#include "option/printer.h"

void kiln_print_key(struct kiln_printer *printer, const char *name)
{
    kiln_text_add(&printer->text, "%*s%s:", (int)printer->indent, "", name);
}

bool kiln_print_wants(const struct kiln_printer *printer, const struct kiln_option *row,
                      const void *base)
{
    return printer->parts == 0 || !row->parts ||
           (row->parts(printer->source, base) & printer->parts) != 0;
}

void kiln_print_members(struct kiln_printer *printer, const struct kiln_option *members,
                        const void *base)
{
    for (const struct kiln_option *row = members; row->name; row++) {
        const void *field = (const char *)base + row->offset;
        if (row->is_unprinted || !kiln_print_wants(printer, row, base))
            continue;
        if (row->is_hidden_if_empty && kiln_option_count(row, field) == 0)
            continue;
        kiln_print_key(printer, row->name);
        row->type->print(printer, row, field);
    }
}

void kiln_print_quoted(struct kiln_printer *printer, const char *text)
{
    struct kiln_text doubled = {0};
    kiln_text_add(&doubled, "%s%s", *text == '$' ? "$" : "", text);
    kiln_text_add_json(&printer->text, doubled.data ? doubled.data : "");
    printer->text.failed |= doubled.failed;
    kiln_text_free(&doubled);
}

void kiln_print_text(struct kiln_printer *printer, const struct kiln_option *option,
                     const void *field)
{
    (void)option;
    kiln_text_add(&printer->text, " ");
    kiln_print_quoted(printer, *(const char *const *)field);
    kiln_text_add(&printer->text, "\n");
}
