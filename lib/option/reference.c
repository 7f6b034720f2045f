/* Prints the reference of a table's keys. It visits the rows of the table and of all tables nested
 * in it. */
#include "option/reference.h"

#include <string.h>

enum { WIDTH = 100, MAX_VARIANTS = 32 };

/* Appends a paragraph, indented and broken at blanks into lines of WIDTH columns. */
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

/* Holds the state of a walk over a table and the tables nested in it. */
struct walk {
    void (*visit)(void *user, const struct kiln_option_key *key);
    void *user;
    bool failed;
};

static void visit_rows(struct walk *walk, const char *prefix, const struct kiln_option *rows);

static void add_choices(struct kiln_text *out, const struct kiln_option *row)
{
    if (row->type->list_choices) {
        row->type->list_choices(row, out);
        return;
    }
    for (size_t i = 0; row->choices && row->choices[i]; i++)
        kiln_text_add(out, "%s%s", i ? "|" : "", row->choices[i]);
    if (row->special_word)
        kiln_text_add(out, "%s", row->special_word);
}

static void visit_row(struct walk *walk, const char *path, const struct kiln_option *row)
{
    struct kiln_option_key key = {.path = path, .help = row->help};
    key.holds_keys = row->members || row->kinds || row->item;
    key.in_file_only = row->type == &kiln_type_include || row->type == &kiln_type_use ||
                       row->type == &kiln_type_params;
    if (row->type == &kiln_type_group) {
        walk->visit(walk->user, &key);
        return;
    }
    struct kiln_text allowed = {0}, choices = {0};
    row->type->describe(row, &allowed);
    if (*kiln_unit_choices(row->dimension))
        kiln_text_add(&allowed, "; unit %s", kiln_unit_choices(row->dimension));
    key.allowed = allowed.data ? allowed.data : "";
    key.varies = kiln_option_clocks(row);
    key.fallback = row->fallback;
    add_choices(&choices, row);
    key.choices = choices.data;
    walk->visit(walk->user, &key);
    walk->failed |= allowed.failed || choices.failed;
    kiln_text_free(&allowed);
    kiln_text_free(&choices);
}

/* Visits the key `field`, which chooses among kinds of one name. Its default is the first of
 * them. */
static void visit_field(struct walk *walk, const char *path, const struct kiln_option_kind *first)
{
    const char *variants[MAX_VARIANTS + 1] = {NULL};
    for (size_t i = 0; i < MAX_VARIANTS && first[i].name && strcmp(first[i].name, first->name) == 0;
         i++)
        variants[i] = first[i].variant;
    struct kiln_text name = {0};
    kiln_text_add(&name, "%s.field", path);
    const struct kiln_option row = {.type = &kiln_type_choice,
                                    .choices = variants,
                                    .fallback = first->variant,
                                    .help = "Kind of the field."};
    if (!name.failed)
        visit_row(walk, name.data, &row);
    walk->failed |= name.failed;
    kiln_text_free(&name);
}

static void visit_kinds(struct walk *walk, const char *path, const struct kiln_option_kind *kinds)
{
    for (const struct kiln_option_kind *kind = kinds; kind->name; kind++) {
        struct kiln_text name = {0};
        kiln_text_add(&name, "%s.%s", path, kind->name);
        if (!name.failed) {
            walk->visit(walk->user, &(struct kiln_option_key){.path = name.data,
                                                              .help = kind->help,
                                                              .variant = kind->variant,
                                                              .shortcut = kind->shortcut,
                                                              .holds_keys = true});
            bool is_first = kind == kinds || strcmp(kind[-1].name, kind->name) != 0;
            if (kind->variant && is_first)
                visit_field(walk, name.data, kind);
            visit_rows(walk, name.data, kind->members);
        }
        walk->failed |= name.failed;
        kiln_text_free(&name);
    }
}

static void visit_rows(struct walk *walk, const char *prefix, const struct kiln_option *rows)
{
    for (const struct kiln_option *row = rows; row->name && !walk->failed; row++) {
        struct kiln_text path = {0};
        kiln_text_add(&path, "%s%s%s", prefix, *prefix ? "." : "", row->name);
        if (!path.failed)
            visit_row(walk, path.data, row);
        const struct kiln_option *item = row->item ? row->item : row;
        if (row->type == &kiln_type_map)
            kiln_text_add(&path, ".NAME");
        else if (row->item)
            kiln_text_add(&path, ".N");
        if (item->members && !path.failed)
            visit_rows(walk, path.data, item->members);
        if (item->kinds && !path.failed)
            visit_kinds(walk, path.data, item->kinds);
        walk->failed |= path.failed;
        kiln_text_free(&path);
    }
}

static void add_key(void *user, const struct kiln_option_key *key)
{
    struct kiln_text *out = user;
    kiln_text_add(out, "%s", key->path);
    if (key->variant)
        kiln_text_add(out, " with field: %s", key->variant);
    kiln_text_add(out, "\n");
    add_wrapped(out, 4, key->help);
    if (key->shortcut) {
        const char *dot = strrchr(key->path, '.');
        const char *name = dot ? dot + 1 : key->path;
        kiln_text_add(out, "    %s: VALUE is short for %s: {%s: VALUE}\n", name, name,
                      key->shortcut);
    }
    if (key->allowed)
        add_wrapped(out, 4, key->allowed);
    if (key->varies)
        kiln_text_add(out, "    may vary %s\n", key->varies);
    if (key->fallback)
        kiln_text_add(out, "    default: %s\n", key->fallback);
    else if (key->allowed)
        kiln_text_add(out, "    must be given\n");
    kiln_text_add(out, "\n");
}

bool kiln_reference_write(FILE *out, const char *introduction, const struct kiln_option *rows)
{
    struct kiln_text text = {0};
    kiln_text_add(&text, "%s", introduction);
    struct walk walk = {.visit = add_key, .user = &text};
    visit_rows(&walk, "", rows);
    bool ok = !walk.failed && !text.failed && fputs(text.data, out) >= 0 && fflush(out) == 0;
    kiln_text_free(&text);
    return ok;
}

/* Chooses keys of the reference. */
struct choice {
    const char *below, *text; /* NULL: all */
    struct kiln_text out;
    size_t count;
};

/* Returns whether a key lies at or below another one, part by part. NAME and N in the key's path
 * stand for any name and number, and so does '*' in the other. */
static bool is_below(const char *path, const char *below)
{
    while (*below) {
        const size_t own = strcspn(path, "."), other = strcspn(below, ".");
        const bool any = (own == 4 && strncmp(path, "NAME", 4) == 0) ||
                         (own == 1 && *path == 'N') || (other == 1 && *below == '*');
        if (own == 0 || (!any && (own != other || strncmp(path, below, own) != 0)))
            return false;
        path += own + (path[own] == '.');
        below += other + (below[other] == '.');
    }
    return true;
}

static bool mentions(const char *where, const char *text)
{
    return where && strcasestr(where, text);
}

static void add_chosen(void *user, const struct kiln_option_key *key)
{
    struct choice *choice = user;
    const char *text = choice->text;
    if ((choice->below && !is_below(key->path, choice->below)) ||
        (text && !mentions(key->path, text) && !mentions(key->help, text) &&
         !mentions(key->allowed, text)))
        return;
    choice->count++;
    add_key(&choice->out, key);
}

bool kiln_reference_write_some(FILE *out, const struct kiln_option *rows, const char *below,
                               const char *text, size_t *count)
{
    struct choice choice = {.below = below, .text = text};
    struct walk walk = {.visit = add_chosen, .user = &choice};
    visit_rows(&walk, "", rows);
    const bool ok = !walk.failed && !choice.out.failed &&
                    (!choice.out.data || fputs(choice.out.data, out) >= 0) && fflush(out) == 0;
    *count = choice.count;
    kiln_text_free(&choice.out);
    return ok;
}

bool kiln_reference_visit(const struct kiln_option *rows,
                          void (*visit)(void *user, const struct kiln_option_key *key), void *user)
{
    struct walk walk = {.visit = visit, .user = user};
    visit_rows(&walk, "", rows);
    return !walk.failed;
}
