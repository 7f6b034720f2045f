/* The scene as a text: the state of the writer, and what the types' printers share. */
#ifndef KILN_SCENE_PRINTER_H
#define KILN_SCENE_PRINTER_H

#include "option/option.h"

struct kiln_printer {
    struct kiln_text text;
    const struct kiln_scene *scene;
    unsigned indent; /* spaces of the current block */
    bool after_dash; /* a list's "-" has just been written */
};

/* Writes "name:" at the current indent; the type writes the rest. */
void kiln_print_key(struct kiln_printer *printer, const char *name);

/* Every member of a struct, one key a line. */
void kiln_print_members(struct kiln_printer *printer, const struct kiln_option *members,
                        const void *base);

/* The whole scene into a text that the caller frees; false when memory is short. */
bool kiln_print_scene(const struct kiln_scene *scene, struct kiln_text *text);

#endif
