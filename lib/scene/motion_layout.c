/* This file finds out what red and green of a motion file stand for. Tools disagree about the
 * direction of green: Houdini and Unity count v upwards, Unreal counts it downwards. So kiln's own
 * layout names the direction, and a scene can name it for files of other tools. */
#include "scene/motion_layout.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "asset/loader/loader.h"
#include "base/error.h"
#include "base/text.h"
#include "scene/asset_path.h"

enum {
    MOST_BYTES = 1 << 20, /* of a layout; those that kiln writes have at most 60 kB */
    MOST_CELLS = 4096,    /* 64 x 64, which a layout lists */
};

static const double MOST_SCALE = 10; /* edges of a cell */

/* Holds what a layout says of motion. */
struct layout {
    bool down;
    double scale;
};

/* Writes the path of the layout that belongs to a motion file: NAME.json for NAME_motion.png. False
 * when the file has another name. */
static bool name_layout(char path[KILN_PATH_SIZE], const char *motion)
{
    static const char ending[] = "_motion";
    const char *slash = strrchr(motion, '/'), *dot = strrchr(motion, '.');
    const size_t length = sizeof ending - 1;
    if (!dot || dot < slash || (size_t)(dot - slash) <= length ||
        strncmp(dot - length, ending, length) != 0)
        return false;
    const int stem = (int)(dot - length - motion);
    return snprintf(path, KILN_PATH_SIZE, "%.*s.json", stem, motion) < KILN_PATH_SIZE;
}

/* Refuses a member of a layout: "motion.green: found 'left'; allowed is up or down". */
static bool refuse(const struct kiln_node *layout, const struct kiln_node *node, const char *name,
                   const char *allowed, struct kiln_error *error)
{
    char found[64] = "another kind of value";
    if (!node)
        return kiln_node_error(layout, error, "%s is missing; allowed is %s", name, allowed);
    if (node->kind == KILN_NODE_SCALAR)
        kiln_node_quote(found, node->text);
    return kiln_node_error(node, error, "%s: found '%s'; allowed is %s", name, found, allowed);
}

/* Reads the members that matter to playing. *has_motion: whether the flipbook has motion. */
static bool read_members(const struct kiln_node *root, struct layout *layout, bool *has_motion,
                         struct kiln_error *error)
{
    const struct kiln_node *version = kiln_node_entry(root, "kiln_flipbook");
    const struct kiln_node *motion = kiln_node_entry(root, "motion");
    if (!version || (!kiln_node_is(version, "1") && !kiln_node_is(version, "2")))
        return refuse(root, version, "kiln_flipbook", "1 or 2, the versions that this kiln reads",
                      error);
    *has_motion = motion && motion->kind == KILN_NODE_MAP;
    if (!*has_motion)
        return true;
    const struct kiln_node *green = kiln_node_entry(motion, "green");
    const struct kiln_node *scale = kiln_node_entry(motion, "scale");
    layout->down = green && kiln_node_is(green, "down");
    if (!layout->down && (!green || !kiln_node_is(green, "up")))
        return refuse(motion, green, "motion.green", "up or down", error);
    if (!scale || scale->kind != KILN_NODE_SCALAR || scale->quoted ||
        !kiln_text_to_double(scale->text, &layout->scale) ||
        !(layout->scale > 0 && layout->scale <= MOST_SCALE))
        return refuse(motion, scale, "motion.scale", "a number above 0 and up to 10", error);
    return true;
}

/* Returns whether a file is there. The loader says why one that is there cannot be read. */
static bool exists(const char *path)
{
    return access(path, F_OK) == 0;
}

/* Reads a layout. *found becomes true if the file is a layout of kiln's with motion. */
static bool read_layout(struct kiln_reader *reader, const char *path, struct layout *layout,
                        bool *found, struct kiln_error *error)
{
    const struct kiln_loader_file file = {path, "layout of a flipbook", "JSON", MOST_BYTES};
    const struct kiln_origin origin = {.name = path,
                                       .has_lines = true,
                                       .kind = "a layout of a flipbook",
                                       .syntax = "JSON",
                                       .most_entries = MOST_CELLS};
    size_t size = 0;
    unsigned char *bytes = kiln_loader_read(kiln_reader_scene(reader)->loader, &file, &size, error);
    char *text = bytes ? kiln_arena_text(reader->scratch, (const char *)bytes, size) : NULL;
    free(bytes);
    if (!bytes)
        return false;
    if (!text)
        return kiln_error_no_memory(error, "reading a scene");
    *found = false;
    if (!strstr(text, "\"kiln_flipbook\"")) /* JSON of another program */
        return true;
    const struct kiln_node *root = kiln_node_parse(reader->scratch, text, size, &origin, error);
    return root && read_members(root, layout, found, error);
}

bool kiln_motion_layout_settle(struct kiln_reader *reader, const struct kiln_node *root,
                               struct kiln_system *system)
{
    struct kiln_look *look = &system->look;
    struct layout layout = {.scale = 1};
    char path[KILN_PATH_SIZE], place[128];
    const bool is_open = look->motion_green == KILN_GREEN_AUTO || !look->motion_scale.given;
    if (look->motion[0] == '/' && is_open && name_layout(path, look->motion) && exists(path)) {
        struct kiln_error error = {0};
        bool found = false;
        snprintf(place, sizeof place, "systems.%s.look.motion", system->name);
        if (!read_layout(reader, path, &layout, &found, &error))
            return kiln_asset_fail(reader, root, place, path, &error);
        if (found && (!kiln_reader_copy_text(reader, path, &look->motion_layout) ||
                      !kiln_scene_add_file(kiln_reader_scene(reader), look->motion_layout,
                                           "a file of the scene")))
            return kiln_reader_out_of_memory(reader);
    }
    const bool down = look->motion_green == KILN_GREEN_DOWN ||
                      (look->motion_green == KILN_GREEN_AUTO && layout.down);
    const double right = look->motion_scale.given ? look->motion_scale.right : layout.scale;
    const double up = look->motion_scale.given ? look->motion_scale.up : layout.scale;
    look->motion_full[0] = (float)right;
    look->motion_full[1] = (float)(down ? -up : up);
    return true;
}
