/* The reference of scene keys, from the option tables. */
#include "scene/reference.h"

#include <string.h>

enum { WIDTH = 100 };

/* A paragraph, indented and broken at blanks. */
static void add_wrapped(struct kiln_text *out, unsigned indent, const char *text)
{
    size_t room = WIDTH - indent;
    while (*text) {
        size_t length = strlen(text);
        if (length > room) {
            length = room;
            while (length > 1 && text[length] != ' ')
                length--;
        }
        kiln_text_add(out, "%*s%.*s\n", (int)indent, "", (int)length, text);
        text += length;
        text += strspn(text, " ");
    }
}

static void add_rows(struct kiln_text *out, const char *prefix, const struct kiln_option *rows);

static void add_kinds(struct kiln_text *out, const char *path, const struct kiln_option_kind *kind)
{
    for (; kind->name; kind++) {
        struct kiln_text name = {0};
        kiln_text_add(&name, "%s.%s", path, kind->name);
        kiln_text_add(out, "%s", name.data ? name.data : "");
        if (kind->variant)
            kiln_text_add(out, " with field: %s", kind->variant);
        kiln_text_add(out, "\n");
        add_wrapped(out, 4, kind->help);
        if (kind->shortcut)
            kiln_text_add(out, "    %s: VALUE is short for %s: {%s: VALUE}\n", kind->name,
                          kind->name, kind->shortcut);
        kiln_text_add(out, "\n");
        add_rows(out, name.data ? name.data : "", kind->members);
        kiln_text_free(&name);
    }
}

static void add_row(struct kiln_text *out, const char *path, const struct kiln_option *row)
{
    kiln_text_add(out, "%s\n", path);
    add_wrapped(out, 4, row->help);
    if (row->type == &kiln_type_group) {
        kiln_text_add(out, "\n");
        return;
    }
    struct kiln_text allowed = {0};
    row->type->describe(row, &allowed);
    if (*kiln_unit_choices(row->dimension))
        kiln_text_add(&allowed, "; unit %s", kiln_unit_choices(row->dimension));
    add_wrapped(out, 4, allowed.data ? allowed.data : "");
    out->failed |= allowed.failed;
    kiln_text_free(&allowed);
    if (kiln_option_clocks(row))
        kiln_text_add(out, "    may vary %s\n", kiln_option_clocks(row));
    if (row->fallback)
        kiln_text_add(out, "    default: %s\n\n", row->fallback);
    else
        kiln_text_add(out, "    must be given\n\n");
}

static void add_rows(struct kiln_text *out, const char *prefix, const struct kiln_option *rows)
{
    for (const struct kiln_option *row = rows; row->name; row++) {
        struct kiln_text path = {0};
        kiln_text_add(&path, "%s%s%s", prefix, *prefix ? "." : "", row->name);
        add_row(out, path.data ? path.data : "", row);
        const struct kiln_option *item = row->type == &kiln_type_list ? row->item : row;
        if (row->type == &kiln_type_map)
            kiln_text_add(&path, ".NAME");
        else if (row->type == &kiln_type_list)
            kiln_text_add(&path, ".N");
        if (item->members)
            add_rows(out, path.data ? path.data : "", item->members);
        if (item->kinds)
            add_kinds(out, path.data ? path.data : "", item->kinds);
        kiln_text_free(&path);
    }
}

bool kiln_reference_write(FILE *out, const char *introduction, const struct kiln_option *rows)
{
    struct kiln_text text = {0};
    kiln_text_add(&text, "%s", introduction);
    add_rows(&text, "", rows);
    bool ok = !text.failed && fputs(text.data, out) >= 0 && fflush(out) == 0;
    kiln_text_free(&text);
    return ok;
}

static const char scene_introduction[] =
    "A scene is a YAML file. Every key below may also be given with --set KEY=VALUE; '*' in a KEY\n"
    "stands for every entry of a mapping or list, and entries of a list are counted from 0.\n"
    "\n"
    "Numbers may carry a unit (2 s, 45 deg); without one they are in the SI unit, except that an\n"
    "angle always needs one. Where it is allowed, a number or colour may vary:\n"
    "\n"
    "    {keys: {0 s: 1, 3 s: 2}}      over time; 0 s is the first frame\n"
    "    {life: [0.1, 1.2]}            over a particle's life, evenly spread from birth to death\n"
    "    {life: {0: 0, 0.2: 1, 1: 0}}  the same with the parts of the life named\n"
    "\n"
    "joined by straight lines, held before the first and after the last. A vector or colour "
    "varies\n"
    "as a whole ({keys: {0 s: [1, 0, 0], 1 s: [0, 1, 0]}}) or in each component.\n"
    "\n"
    "Metres, y up, right-handed; colours linear, Rec. 709 primaries.\n"
    "\n";

bool kiln_scene_write_reference(FILE *out)
{
    return kiln_reference_write(out, scene_introduction, kiln_options_root);
}
