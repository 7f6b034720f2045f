/* The scene as a scene file, with nothing left to defaults: what `kiln check` prints, and what the
 * scene's hash is taken of. It names no path but those of assets, below their root. */
#include "option/printer.h"

#include "base/error.h"

void kiln_print_key(struct kiln_printer *printer, const char *name)
{
    kiln_text_add(&printer->text, "%*s%s:", (int)printer->indent, "", name);
}

void kiln_print_members(struct kiln_printer *printer, const struct kiln_option *members,
                        const void *base)
{
    for (const struct kiln_option *row = members; row->name; row++) {
        kiln_print_key(printer, row->name);
        row->type->print(printer, row, (const char *)base + row->offset);
    }
}

bool kiln_print_scene(const struct kiln_scene *scene, struct kiln_text *text)
{
    struct kiln_printer printer = {.scene = scene};
    kiln_print_members(&printer, kiln_options_root, scene);
    *text = printer.text;
    return !text->failed;
}

bool kiln_scene_print(const struct kiln_scene *scene, FILE *out)
{
    struct kiln_text text;
    bool ok = kiln_print_scene(scene, &text) && fputs(text.data, out) >= 0 && fflush(out) == 0;
    kiln_text_free(&text);
    return ok;
}
