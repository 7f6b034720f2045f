/* Writes and reads the sidecars of figures as JSON. Writer and reader share no table of keys, since
 * such a table would be longer than the two. */
#include "figure/record.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/file.h"
#include "base/json.h"
#include "option/node.h"

enum { VERSION = 2, MAX_SIZE = 16 << 20 };

static void add_panel(struct kiln_json *json, const struct kiln_panel *panel)
{
    kiln_json_begin_object(json, NULL);
    kiln_json_string(json, "label", panel->label);
    kiln_json_string(json, "source", panel->source);
    if (panel->has_frame)
        kiln_json_uint(json, "frame", panel->frame);
    kiln_json_indent_items(json, 3);
    if (*panel->scene_hash)
        kiln_json_string(json, "scene_hash", panel->scene_hash);
    if (*panel->state)
        kiln_json_string(json, "state", panel->state);
    kiln_json_string(json, "pixels", panel->hash);
    kiln_json_end(json);
}

bool kiln_record_write(const struct kiln_record *record, struct kiln_text *text,
                       struct kiln_error *error)
{
    struct kiln_json json = kiln_json_to_text(text);
    kiln_json_begin_object(&json, NULL);
    kiln_json_indent_items(&json, 0);
    kiln_json_uint(&json, "kiln_figure", VERSION);
    kiln_json_string(&json, "version", record->version);
    kiln_json_string(&json, "folder", record->folder);
    kiln_json_strings(&json, "command", record->command, record->command_count);
    kiln_json_string(&json, "device", record->device);
    kiln_json_string(&json, "driver", record->driver);
    kiln_json_string(&json, "cpu", record->cpu);
    kiln_json_pair(&json, "size", record->width, record->height);
    if (record->alt)
        kiln_json_string(&json, "alt", record->alt);
    kiln_json_string(&json, "pixels", record->pixels);
    kiln_json_string(&json, "file", record->file);
    kiln_json_begin_array(&json, "panels");
    kiln_json_indent_items(&json, 2);
    for (size_t i = 0; i < record->panel_count; i++)
        add_panel(&json, &record->panels[i]);
    kiln_json_end_indented(&json, 0);
    kiln_json_end_indented(&json, 0);
    return kiln_json_finish(&json) || kiln_error_no_memory(error, "the sidecar of a figure");
}

/* ---- Reading -------------------------------------------------------------------------------- */

static bool read_text(const struct kiln_node *map, const char *name, const char **value,
                      struct kiln_error *error)
{
    const struct kiln_node *node = kiln_node_entry(map, name);
    if (!node || node->kind != KILN_NODE_SCALAR || !node->quoted)
        return kiln_node_error(node ? node : map, error, "%s: expected a text in quotes", name);
    *value = node->text;
    return true;
}

static bool read_number(const struct kiln_node *node, const struct kiln_node *place,
                        const char *name, uint32_t *number, struct kiln_error *error)
{
    uint64_t value = 0;
    if (!node || node->kind != KILN_NODE_SCALAR || node->quoted ||
        !kiln_text_to_uint64(node->text, &value) || value > UINT32_MAX)
        return kiln_node_error(node ? node : place, error, "%s: expected a whole number", name);
    *number = (uint32_t)value;
    return true;
}

static bool read_hash(const struct kiln_node *map, const char *name, size_t digits, bool needed,
                      char *out, struct kiln_error *error)
{
    const struct kiln_node *node = kiln_node_entry(map, name);
    *out = '\0';
    if (!node && !needed)
        return true;
    if (!node || node->kind != KILN_NODE_SCALAR || !node->quoted ||
        strspn(node->text, "0123456789abcdef") != digits || node->text[digits])
        return kiln_node_error(node ? node : map, error, "%s: expected %zu hex digits", name,
                               digits);
    memcpy(out, node->text, digits + 1);
    return true;
}

static bool read_command(struct kiln_arena *arena, const struct kiln_node *root,
                         struct kiln_record *record, struct kiln_error *error)
{
    const struct kiln_node *list = kiln_node_entry(root, "command");
    if (!list || list->kind != KILN_NODE_LIST || list->count == 0)
        return kiln_node_error(list ? list : root, error, "command: expected a list of words");
    record->command = kiln_arena_alloc(arena, list->count, sizeof *record->command);
    if (!record->command)
        return kiln_error_no_memory(error, "a sidecar");
    for (const struct kiln_node *word = list->first; word; word = word->next) {
        if (word->kind != KILN_NODE_SCALAR || !word->quoted)
            return kiln_node_error(word, error, "command: expected words in quotes");
        record->command[record->command_count++] = word->text;
    }
    return true;
}

static bool read_panels(struct kiln_arena *arena, const struct kiln_node *root,
                        struct kiln_record *record, struct kiln_error *error)
{
    const struct kiln_node *list = kiln_node_entry(root, "panels");
    if (!list || list->kind != KILN_NODE_LIST)
        return kiln_node_error(list ? list : root, error, "panels: expected a list");
    record->panels = kiln_arena_alloc(arena, list->count + 1, sizeof *record->panels);
    if (!record->panels)
        return kiln_error_no_memory(error, "a sidecar");
    for (const struct kiln_node *node = list->first; node; node = node->next) {
        struct kiln_panel *panel = &record->panels[record->panel_count++];
        const struct kiln_node *frame = kiln_node_entry(node, "frame");
        panel->has_frame = frame != NULL;
        if (node->kind != KILN_NODE_MAP)
            return kiln_node_error(node, error, "panels: expected objects");
        if ((frame && !read_number(frame, node, "frame", &panel->frame, error)) ||
            !read_text(node, "label", &panel->label, error) ||
            !read_text(node, "source", &panel->source, error) ||
            !read_hash(node, "scene_hash", 64, false, panel->scene_hash, error) ||
            !read_hash(node, "state", 16, false, panel->state, error) ||
            !read_hash(node, "pixels", 64, true, panel->hash, error))
            return false;
    }
    return true;
}

static bool read_size(const struct kiln_node *root, struct kiln_record *record,
                      struct kiln_error *error)
{
    const struct kiln_node *size = kiln_node_entry(root, "size");
    if (!size || size->kind != KILN_NODE_LIST || size->count != 2)
        return kiln_node_error(size ? size : root, error, "size: expected two numbers");
    return read_number(size->first, size, "size", &record->width, error) &&
           read_number(size->last, size, "size", &record->height, error);
}

static bool read_root(struct kiln_arena *arena, const struct kiln_node *root,
                      struct kiln_record *record, struct kiln_error *error)
{
    uint32_t version = 0;
    char hash[65];
    if (!read_number(kiln_node_entry(root, "kiln_figure"), root, "kiln_figure", &version, error))
        return false;
    if (version != VERSION)
        return kiln_node_error(
            root, error,
            "kiln_figure: found %u; this kiln reads %d: draw the figure again, with "
            "--force",
            version, (int)VERSION);
    return read_text(root, "version", &record->version, error) &&
           read_text(root, "folder", &record->folder, error) &&
           read_text(root, "device", &record->device, error) &&
           read_text(root, "driver", &record->driver, error) &&
           read_text(root, "cpu", &record->cpu, error) &&
           read_hash(root, "pixels", 64, true, hash, error) &&
           read_hash(root, "file", 64, true, hash, error) &&
           read_text(root, "pixels", &record->pixels, error) &&
           read_text(root, "file", &record->file, error) &&
           (!kiln_node_entry(root, "alt") || read_text(root, "alt", &record->alt, error)) &&
           read_size(root, record, error) && read_command(arena, root, record, error) &&
           read_panels(arena, root, record, error);
}

struct kiln_record *kiln_record_parse(struct kiln_arena *arena, const char *text, size_t size,
                                      const char *name, struct kiln_error *error)
{
    struct kiln_record *record = kiln_arena_alloc(arena, 1, sizeof *record);
    struct kiln_origin *origin = kiln_arena_alloc(arena, 1, sizeof *origin);
    const char *name_copy = kiln_arena_format(arena, "%s", name);
    if (!record || !origin || !name_copy) {
        kiln_error_no_memory(error, "%s", name);
        return NULL;
    }
    *origin = (struct kiln_origin){
        .name = name_copy, .has_lines = true, .kind = "a figure", .version = "\"kiln_figure\": 2"};
    const struct kiln_node *root = kiln_node_parse(arena, text, size, origin, error);
    return root && read_root(arena, root, record, error) ? record : NULL;
}

struct kiln_record *kiln_record_read(struct kiln_arena *arena, const char *path,
                                     struct kiln_error *error)
{
    size_t size;
    char *text = kiln_text_file_read(path, "the sidecar of a figure", MAX_SIZE, &size, error);
    struct kiln_record *record = text ? kiln_record_parse(arena, text, size, path, error) : NULL;
    free(text);
    return record;
}
