/* This file says where the keys of a scene come from: from which line of which file, from an
 * override, or from a default. It follows a key of the printed scene through the option tables and,
 * beside them, through the tree that the scene was read from. The tables say what a place in the
 * tree means where the tree has a short form, such as `gravity: [0, -9.8, 0]`. */
#include <stdlib.h>
#include <string.h>

#include "option/animated.h"
#include "scene/options.h"

/* Where a walk along a key is: at a node that is described by one of the members below it. */
struct walk {
    const struct kiln_node *node; /* NULL: the key has its default */
    const struct kiln_option *rows;
    const struct kiln_option *names;      /* the row of a mapping of names */
    const struct kiln_option *list;       /* the row of a list */
    const struct kiln_option_kind *kinds; /* the kinds of an item */
    const char *shortcut; /* the member that the node is the value of, in short form */
};

static void enter_row(struct walk *walk, const struct kiln_option *row)
{
    const struct kiln_node *node = walk->node;
    *walk = (struct walk){.node = node};
    if (row->type == &kiln_type_map)
        walk->names = row;
    else if (row->type == &kiln_type_list)
        walk->list = row;
    else if (row->type == &kiln_type_kind)
        walk->kinds = row->kinds;
    else
        walk->rows = row->members;
}

/* Goes to an entry of a mapping. A node that is no mapping, such as `none`, stands for all below.
 */
static void enter_entry(struct walk *walk, const char *name)
{
    if (walk->node && walk->node->kind == KILN_NODE_MAP)
        walk->node = kiln_node_entry(walk->node, name);
}

static void enter_kind(struct walk *walk, const char *name)
{
    const struct kiln_option_kind *kind = walk->kinds;
    enter_entry(walk, name);
    const struct kiln_node *node = walk->node;
    const struct kiln_node *inside =
        node ? kiln_option_variant_inside(walk->kinds, name, node) : NULL;
    const struct kiln_node *field = node ? kiln_node_entry(node, "field") : NULL;
    const struct kiln_option_kind *by_member =
        node && !field ? kiln_option_variant_by_member(walk->kinds, name, node) : NULL;
    field = inside ? inside->key : field;
    node = inside ? inside : node;
    while (kind->name && (strcmp(kind->name, name) != 0 ||
                          (kind->variant && field && !kiln_node_is(field, kind->variant))))
        kind++;
    kind = by_member ? by_member : kind;
    const bool is_short =
        node && kind->shortcut && (node->kind != KILN_NODE_MAP || kiln_node_is_animated(node));
    *walk = (struct walk){
        .node = node, .rows = kind->members, .shortcut = is_short ? kind->shortcut : NULL};
}

static void enter_item(struct walk *walk, const char *name)
{
    const struct kiln_node *node = walk->node;
    if (node && node->kind == KILN_NODE_LIST) {
        unsigned long index = strtoul(name, NULL, 10);
        for (node = node->first; node && index > 0; index--)
            node = node->next;
        walk->node = node;
    } else {
        enter_entry(walk, name);
    }
    enter_row(walk, walk->list->item);
}

/* Goes to the part of a key. Returns false where the key has no parts, such as in a curve. */
static bool enter(struct walk *walk, const char *name)
{
    if (walk->names) {
        enter_entry(walk, name);
        *walk = (struct walk){.node = walk->node, .rows = walk->names->members};
    } else if (walk->list) {
        enter_item(walk, name);
    } else if (walk->kinds) {
        enter_kind(walk, name);
    } else if (walk->rows) {
        const struct kiln_option *row = kiln_option_find(walk->rows, name);
        if (!row)
            return false;
        if (walk->shortcut)
            walk->node = strcmp(walk->shortcut, name) == 0 ? walk->node : NULL;
        else
            enter_entry(walk, name);
        enter_row(walk, row);
    } else {
        return false;
    }
    return true;
}

/* Adds "FILE:LINE" of a node, or the name of an origin without lines. */
static void add_place(struct kiln_text *out, const struct kiln_node *node)
{
    /* A mapping in block style begins behind the line of its key. */
    if (node->kind != KILN_NODE_SCALAR && node->key && node->key->origin == node->origin)
        node = node->key;
    const struct kiln_origin *origin = node->origin;
    char name[KILN_PATH_SIZE];
    kiln_shown(name, sizeof name, origin->name);
    kiln_text_add(out, "%s", name);
    if (origin->has_lines && node->line > 0)
        kiln_text_add(out, ":%u", node->line + origin->lines_before);
}

/* Adds the place that a key of the printed scene comes from. */
static void add_origin(struct kiln_text *out, const struct kiln_scene *scene, const char *key)
{
    struct walk walk = {.node = scene->tree, .rows = kiln_options_root};
    const struct kiln_option *before = NULL;
    const struct kiln_node *parent = NULL;
    char part[64] = "";
    for (bool going = true; going && walk.node && *key;) {
        const size_t length = strcspn(key, ".");
        snprintf(part, sizeof part, "%.*s", (int)length, key);
        before = walk.rows;
        parent = walk.node;
        going = enter(&walk, part);
        key += length + (key[length] == '.');
    }
    /* What is not printed, such as a duration, says the value of another key. */
    const struct kiln_option *row = before && !walk.node ? kiln_option_find(before, part) : NULL;
    if (row && row->instead_of)
        walk.node = kiln_node_entry(parent, row->instead_of);
    if (!walk.node) {
        kiln_text_add(out, "default");
        return;
    }
    add_place(out, walk.node);
    for (const struct kiln_node_link *link = walk.node->via; link; link = link->next) {
        kiln_text_add(out, ", %s ", link->words);
        add_place(out, link->at);
    }
}

/* ---- a printed scene ------------------------------------------------------------------------- */

/* The keys of the lines of a printed scene. */
struct lines {
    struct kiln_arena *arena;
    const char **keys; /* one for each line; NULL: the line has none */
    uint32_t count;
    bool failed;
};

/* Gives each line the first key that begins in it. The recursion is limited by
 * KILN_NODE_MAX_DEPTH. */
static void find_keys(struct lines *lines, const struct kiln_node *node, const char *key)
{
    uint32_t index = 0;
    for (const struct kiln_node *child = node->first; child; child = child->next, index++) {
        char number[16];
        snprintf(number, sizeof number, "%u", index);
        const char *name = child->key ? child->key->text : number;
        const uint32_t line = child->key ? child->key->line : child->line;
        const char *path = kiln_arena_format(lines->arena, "%s%s%s", key, *key ? "." : "", name);
        if (!path || line == 0 || line > lines->count) {
            lines->failed = true;
            return;
        }
        if (!lines->keys[line - 1])
            lines->keys[line - 1] = path;
        find_keys(lines, child, path);
    }
}

static bool add_places(const struct kiln_scene *scene, const struct lines *lines, const char *text,
                       struct kiln_text *out)
{
    for (uint32_t i = 0; i < lines->count; i++) {
        const size_t length = strcspn(text, "\n");
        kiln_text_add(out, "%.*s", (int)length, text);
        if (lines->keys[i]) {
            kiln_text_add(out, "  # ");
            add_origin(out, scene, lines->keys[i]);
        }
        kiln_text_add(out, "\n");
        text += length + (text[length] == '\n');
    }
    return !out->failed;
}

bool kiln_print_scene_origins(const struct kiln_scene *scene, struct kiln_text *out)
{
    struct kiln_text text = {0};
    struct kiln_error error = {0};
    const struct kiln_origin origin = {.name = "the printed scene", .kind = "a scene"};
    struct lines lines = {.arena = kiln_arena_create()};
    *out = (struct kiln_text){0};
    bool ok = scene->tree && lines.arena && kiln_print_scene(scene, 0, &text);
    for (const char *c = ok ? text.data : ""; *c; c++)
        lines.count += *c == '\n';
    if (ok)
        lines.keys = kiln_arena_alloc(lines.arena, lines.count + 1, sizeof *lines.keys);
    const struct kiln_node *root =
        lines.keys ? kiln_node_parse(lines.arena, text.data, text.length, &origin, &error) : NULL;
    if (root)
        find_keys(&lines, root, "");
    ok = root && !lines.failed && add_places(scene, &lines, text.data, out);
    kiln_text_free(&text);
    kiln_arena_destroy(&lines.arena);
    return ok;
}

bool kiln_scene_print_origins(const struct kiln_scene *scene, FILE *out)
{
    struct kiln_text text;
    const bool ok =
        kiln_print_scene_origins(scene, &text) && fputs(text.data, out) >= 0 && fflush(out) == 0;
    kiln_text_free(&text);
    return ok;
}
