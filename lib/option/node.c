/* Reads YAML text into a tree of nodes, which it builds from libfyaml's events. It does not use
 * libfyaml's documents, because events allow it to count copies and to refuse deep nesting before
 * anything is built. */
#include "option/node.h"

#include <libfyaml.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/shown.h"
#include "base/text.h"
#include "option/node_anchors.h"

void kiln_node_append(struct kiln_node *node, struct kiln_node *child)
{
    if (node->last)
        node->last->next = child;
    else
        node->first = child;
    node->last = child;
    node->count++;
}

struct kiln_node *kiln_node_entry(const struct kiln_node *node, const char *key)
{
    if (node->kind != KILN_NODE_MAP)
        return NULL;
    for (struct kiln_node *entry = node->first; entry; entry = entry->next) {
        if (strcmp(entry->key->text, key) == 0)
            return entry;
    }
    return NULL;
}

bool kiln_node_is(const struct kiln_node *node, const char *text)
{
    return node->kind == KILN_NODE_SCALAR && strcmp(node->text, text) == 0;
}

struct kiln_node *kiln_node_create_map(struct kiln_arena *arena, const struct kiln_origin *origin)
{
    struct kiln_node *node = kiln_arena_alloc(arena, 1, sizeof *node);
    if (node) {
        node->kind = KILN_NODE_MAP;
        node->origin = origin;
    }
    return node;
}

void kiln_node_place(const struct kiln_node *node, char *out, size_t size)
{
    if (!node->origin->has_lines || node->line == 0)
        snprintf(out, size, "%s", node->origin->name);
    else
        snprintf(out, size, "%s:%u:%u", node->origin->name, node->line + node->origin->lines_before,
                 node->column);
}

/* Appends "; included from scene.yaml:2:11" for each link of a chain to a message. */
static void add_links(char message[KILN_MESSAGE_SIZE], const struct kiln_node_link *link)
{
    char place[KILN_MESSAGE_SIZE];
    for (; link; link = link->next) {
        const size_t length = strlen(message), room = KILN_MESSAGE_SIZE - length;
        kiln_node_place(link->at, place, sizeof place);
        if (snprintf(message + length, room, "; %s %s", link->words, place) >= (int)room)
            return;
    }
}

bool kiln_node_error(const struct kiln_node *node, struct kiln_error *error, const char *format,
                     ...)
{
    char message[KILN_MESSAGE_SIZE], place[KILN_MESSAGE_SIZE];
    va_list args;
    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
    add_links(message, node->origin->via);
    add_links(message, node->via);
    kiln_node_place(node, place, sizeof place);
    return kiln_error_set(error, KILN_INVALID_INPUT, "%s: %s", place, message);
}

void kiln_node_quote(char out[64], const char *text)
{
    enum { MAX_SHOWN_BYTES = 48 };
    size_t length = 0;
    while (*text) {
        size_t bytes = kiln_text_character_length(text);
        if (length + (bytes ? bytes : 1) > MAX_SHOWN_BYTES) {
            memcpy(out + length, "...", 4);
            return;
        }
        uint32_t character;
        char escaped[12] = "";
        if (kiln_shown_character(text, &character) == 0 || kiln_shown_needs_escape(character))
            kiln_shown_escape(character, bytes == 0, escaped);
        const size_t size = *escaped ? strlen(escaped) : bytes;
        memcpy(out + length, *escaped ? escaped : text, size);
        length += size;
        text += bytes ? bytes : 1;
    }
    out[length] = '\0';
}

/* ---- building ------------------------------------------------------------------------------ */

struct builder {
    const char *text; /* the whole text */
    size_t size;
    struct kiln_arena *arena;
    struct kiln_error *error;
    const struct kiln_origin *origin;
    struct kiln_node *root;
    struct kiln_node *open[KILN_NODE_MAX_DEPTH]; /* the lists and mappings around the next event */
    struct kiln_node *key[KILN_NODE_MAX_DEPTH];  /* of a mapping open[i]: a key that has no value
                                                  * yet */
    bool has_merge[KILN_NODE_MAX_DEPTH];         /* whether the mapping open[i] has the key << */
    struct kiln_anchors anchors;
    uint32_t depth, total, documents;
};

static bool out_of_memory(const struct kiln_origin *origin, struct kiln_error *error)
{
    return kiln_error_no_memory(error, "reading %s", origin->kind);
}

static struct kiln_node *create_node(struct builder *builder, struct fy_event *event,
                                     enum kiln_node_kind kind)
{
    struct kiln_node *node = kiln_arena_alloc(builder->arena, 1, sizeof *node);
    if (!node) {
        out_of_memory(builder->origin, builder->error);
        return NULL;
    }
    node->kind = kind;
    node->origin = builder->origin;
    const struct fy_mark *mark = fy_event_start_mark(event);
    if (mark) {
        node->line = (uint32_t)mark->line + 1;
        node->column = (uint32_t)mark->column + 1;
    }
    struct kiln_node_counts *counts = builder->origin->counts;
    if (++*(counts ? &counts->parsed : &builder->total) > KILN_NODE_MAX_TOTAL) {
        kiln_node_error(node, builder->error, "more than %d entries in all; no more are allowed",
                        KILN_NODE_MAX_TOTAL);
        return NULL;
    }
    return node;
}

/* Adds a node to the tree as the root, the next entry of a list, or a key or value of a mapping. */
static bool place_node(struct builder *builder, struct kiln_node *node)
{
    struct kiln_error *error = builder->error;
    if (builder->depth == 0) {
        builder->root = node;
        return true;
    }
    struct kiln_node *parent = builder->open[builder->depth - 1];
    struct kiln_node **key = &builder->key[builder->depth - 1];
    const uint32_t most = builder->origin->most_entries ? builder->origin->most_entries
                                                        : (uint32_t)KILN_NODE_MAX_ENTRIES;
    if (parent->count == most)
        return kiln_node_error(
            node, error, "more than %u entries in one list or mapping; no more are allowed", most);
    if (parent->kind == KILN_NODE_LIST || *key) {
        node->key = *key;
        if (*key && node->line == 0) { /* "key:" without a value */
            node->line = (*key)->line;
            node->column = (*key)->column;
        }
        *key = NULL;
        kiln_node_append(parent, node);
        return true;
    }
    char quoted[64];
    if (node->kind != KILN_NODE_SCALAR)
        return kiln_node_error(node, error, "a key must be a word, not a list or mapping");
    kiln_node_quote(quoted, node->text);
    if (strcmp(node->text, "<<") == 0) {
        if (!builder->origin->counts)
            return kiln_node_error(node, error, "merge keys are not allowed");
        builder->has_merge[builder->depth - 1] = true;
    }
    if (*node->text == '\0')
        return kiln_node_error(node, error, "empty key");
    const struct kiln_node *before = kiln_node_entry(parent, node->text);
    if (before && builder->origin->has_lines)
        return kiln_node_error(node, error, "duplicate key '%s' (first in line %u)", quoted,
                               before->key->line + builder->origin->lines_before);
    if (before)
        return kiln_node_error(node, error, "duplicate key '%s'", quoted);
    *key = node;
    return true;
}

/* Gives a node the name of its anchor, unless the token is NULL. */
static bool take_anchor(struct builder *builder, struct fy_token *token, struct kiln_node *node)
{
    size_t length = 0;
    const char *name = token ? fy_token_get_text(token, &length) : NULL;
    return !name ||
           kiln_anchors_add(&builder->anchors, builder->arena, name, length, node, builder->error);
}

static bool open_collection(struct builder *builder, struct fy_event *event,
                            enum kiln_node_kind kind, struct fy_token *anchor)
{
    struct kiln_node *node = create_node(builder, event, kind);
    if (!node || !place_node(builder, node) || !take_anchor(builder, anchor, node))
        return false;
    if (builder->depth == KILN_NODE_MAX_DEPTH)
        return kiln_node_error(node, builder->error,
                               "nested deeper than the %d levels that are allowed",
                               KILN_NODE_MAX_DEPTH);
    builder->open[builder->depth] = node;
    builder->key[builder->depth] = NULL;
    builder->has_merge[builder->depth] = false;
    builder->depth++;
    return true;
}

/* Closes the innermost list or mapping. */
static bool close_collection(struct builder *builder)
{
    builder->depth--;
    return !builder->has_merge[builder->depth] ||
           kiln_anchors_merge(builder->open[builder->depth], builder->error);
}

/* Places a copy of the node that an alias names. */
static bool add_alias(struct builder *builder, struct fy_event *event)
{
    size_t length = 0;
    const char *name = event->alias.anchor ? fy_token_get_text(event->alias.anchor, &length) : "";
    struct kiln_node *at = create_node(builder, event, KILN_NODE_SCALAR);
    if (!at)
        return false;
    at->column--; /* libfyaml's mark is behind the star */
    const struct kiln_node *named =
        kiln_anchors_find(&builder->anchors, at, name ? name : "", length, builder->error);
    if (!named)
        return false;
    for (uint32_t i = 0; i < builder->depth; i++) {
        if (builder->open[i] == named)
            return kiln_node_error(at, builder->error, "the alias is inside of its own anchor");
    }
    struct kiln_copying copying = {builder->arena, builder->error, builder->origin->counts,
                                   "repeated by the alias at", at};
    struct kiln_node *copy = kiln_node_copy(&copying, named, builder->depth);
    if (!copy)
        return false;
    copy->key = NULL;
    return place_node(builder, copy);
}

/* Returns whether a text in double quotes continues in the next line by a backslash. libfyaml
 * 0.7.12 reads the line break after "\\\" as a space, cuts off the end of the text, or returns
 * bytes from outside the text. */
static bool has_escaped_line_break(const struct builder *builder, struct fy_event *event)
{
    const struct fy_mark *start = fy_event_start_mark(event), *end = fy_event_end_mark(event);
    const size_t last = end && end->input_pos < builder->size ? end->input_pos : builder->size;
    for (size_t i = start ? start->input_pos : 0; i + 1 < last; i++) {
        const char next = builder->text[i + 1];
        if (builder->text[i] == '\\' && (next == '\n' || next == '\r'))
            return true;
    }
    return false;
}

static bool add_scalar(struct builder *builder, struct fy_event *event)
{
    struct kiln_node *node = create_node(builder, event, KILN_NODE_SCALAR);
    if (!node)
        return false;
    const enum fy_scalar_style style =
        event->scalar.value ? fy_scalar_token_get_style(event->scalar.value) : FYSS_PLAIN;
    if (style == FYSS_DOUBLE_QUOTED && has_escaped_line_break(builder, event))
        return kiln_node_error(node, builder->error,
                               "a backslash must not continue a quoted text in the next line");
    size_t length = 0;
    const char *text = event->scalar.value ? fy_token_get_text(event->scalar.value, &length) : "";
    if (!text || memchr(text, '\0', length))
        return kiln_node_error(node, builder->error, "a text must not contain zero bytes");
    node->text = kiln_arena_text(builder->arena, text, length);
    if (!node->text)
        return out_of_memory(builder->origin, builder->error);
    node->quoted = style != FYSS_PLAIN;
    /* libfyaml's mark is behind the opening quote. */
    if (style == FYSS_SINGLE_QUOTED || style == FYSS_DOUBLE_QUOTED)
        node->column--;
    return take_anchor(builder, event->scalar.anchor, node) && place_node(builder, node);
}

/* Fails with an error at the position of an event. The node only carries the position. */
static bool refuse(struct builder *builder, struct fy_event *event, const char *reason)
{
    struct kiln_node *node = create_node(builder, event, KILN_NODE_SCALAR);
    return node && kiln_node_error(node, builder->error, "%s", reason);
}

static bool refuse_second_document(struct builder *builder, struct fy_event *event)
{
    char reason[96];
    snprintf(reason, sizeof reason, "%s has one document; a second one starts here",
             builder->origin->kind);
    return refuse(builder, event, reason);
}

static bool refuse_anchor_or_tag(struct builder *builder, struct fy_event *event,
                                 struct fy_token *anchor, struct fy_token *tag)
{
    if (anchor && !builder->origin->counts)
        return refuse(builder, event, "anchors and aliases are not allowed");
    if (tag)
        return refuse(builder, event, "tags are not allowed");
    return true;
}

static bool take_event(struct builder *builder, struct fy_event *event)
{
    switch (event->type) {
    case FYET_DOCUMENT_START:
        if (builder->documents++ > 0)
            return refuse_second_document(builder, event);
        return true;
    case FYET_ALIAS:
        return builder->origin->counts
                   ? add_alias(builder, event)
                   : refuse(builder, event, "anchors and aliases are not allowed");
    case FYET_SCALAR:
        return refuse_anchor_or_tag(builder, event, event->scalar.anchor, event->scalar.tag) &&
               add_scalar(builder, event);
    case FYET_MAPPING_START:
        return refuse_anchor_or_tag(builder, event, event->mapping_start.anchor,
                                    event->mapping_start.tag) &&
               open_collection(builder, event, KILN_NODE_MAP, event->mapping_start.anchor);
    case FYET_SEQUENCE_START:
        return refuse_anchor_or_tag(builder, event, event->sequence_start.anchor,
                                    event->sequence_start.tag) &&
               open_collection(builder, event, KILN_NODE_LIST, event->sequence_start.anchor);
    case FYET_MAPPING_END:
    case FYET_SEQUENCE_END:
        return close_collection(builder);
    default:
        return true;
    }
}

/* Fills the error with libfyaml's first error and its position. */
static bool report_syntax(struct builder *builder, struct fy_diag *diag)
{
    struct kiln_node position = {.origin = builder->origin};
    const char *line = builder->origin->syntax, *syntax = line ? line : "YAML";
    void *iterator = NULL;
    const struct fy_diag_error *first = fy_diag_errors_iterate(diag, &iterator);
    if (!first || !first->msg)
        return kiln_node_error(&position, builder->error, "not valid %s", syntax);
    if (first->line > 0 && first->column > 0) {
        position.line = (uint32_t)first->line;
        position.column = (uint32_t)first->column;
    }
    if (line && position.line > 1) {
        position.line = 1;
        position.column = (uint32_t)builder->size;
        return kiln_node_error(&position, builder->error, "not valid %s: the line ends too early",
                               syntax);
    }
    return kiln_node_error(&position, builder->error, "not valid %s: %s", syntax, first->msg);
}

static bool take_all_events(struct builder *builder, struct fy_parser *parser, struct fy_diag *diag)
{
    for (;;) {
        struct fy_event *event = fy_parser_parse(parser);
        if (!event)
            break;
        enum fy_event_type type = event->type;
        bool ok = take_event(builder, event);
        fy_parser_event_free(parser, event);
        if (!ok)
            return false;
        if (type == FYET_STREAM_END)
            return true;
    }
    return report_syntax(builder, diag);
}

static bool report_empty(const struct kiln_origin *origin, struct kiln_error *error)
{
    struct kiln_node position = {.origin = origin};
    if (!origin->has_lines)
        return kiln_node_error(&position, error,
                               "the value after '=' is empty; '#' begins a comment");
    if (!origin->version)
        return kiln_node_error(&position, error, "the file is empty; expected %s", origin->kind);
    return kiln_node_error(&position, error, "the file is empty; %s starts with '%s'", origin->kind,
                           origin->version);
}

/* libfyaml scans all lines of a block of blank lines again for each of them, which takes quadratic
 * time. So the length of a block is limited. */
enum { MOST_BLANK_LINES = 5000 };

/* Refuses bytes that are not UTF-8 text, and long blocks of blank lines, before the parser reads
 * them. */
static bool check_bytes(const char *text, size_t size, const struct kiln_origin *origin,
                        struct kiln_error *error)
{
    struct kiln_node position = {.origin = origin, .line = 1, .column = 1};
    size_t blank_lines = 0; /* consecutive blank lines and the newline before them */
    for (size_t i = 0; i < size;) {
        size_t length = kiln_text_character_length(text + i);
        if (text[i] == '\0')
            return kiln_node_error(&position, error, "not a text: a zero byte");
        if (length == 0)
            return kiln_node_error(&position, error, "not a text: invalid UTF-8 (byte 0x%02x)",
                                   (unsigned char)text[i]);
        blank_lines = text[i] == '\n'            ? blank_lines + 1
                      : strchr(" \t\r", text[i]) ? blank_lines
                                                 : 0;
        if (blank_lines > MOST_BLANK_LINES)
            return kiln_node_error(&position, error,
                                   "more than the %d blank lines in a row that are allowed",
                                   MOST_BLANK_LINES);
        if (text[i] == '\n') {
            position.line++;
            position.column = 0;
        }
        position.column++;
        i += length;
    }
    return true;
}

struct kiln_node *kiln_node_parse(struct kiln_arena *arena, const char *text, size_t size,
                                  const struct kiln_origin *origin, struct kiln_error *error)
{
    if (!check_bytes(text, size, origin, error))
        return NULL;

    struct builder builder = {
        .text = text, .size = size, .arena = arena, .error = error, .origin = origin};
    /* With this option, libfyaml collects its errors and does not print them. */
    struct fy_diag *diag = fy_diag_create(&(struct fy_diag_cfg){.level = FYET_ERROR});
    struct fy_parse_cfg config = {.flags = FYPCF_QUIET | FYPCF_COLLECT_DIAG | FYPCF_JSON_NONE,
                                  .diag = diag};
    struct fy_parser *parser = NULL;
    if (diag) {
        fy_diag_set_collect_errors(diag, true);
        parser = fy_parser_create(&config);
    }
    bool ok = false;
    if (!parser || fy_parser_set_string(parser, text, size) != 0)
        out_of_memory(origin, error);
    else
        ok = take_all_events(&builder, parser, diag);
    if (ok && !builder.root)
        ok = report_empty(origin, error);
    if (parser)
        fy_parser_destroy(parser);
    if (diag)
        fy_diag_destroy(diag);
    return ok ? builder.root : NULL;
}
