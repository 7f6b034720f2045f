/* This file prints a scene as a scene file, with no option left to its default. `kiln check` prints
 * it, and the scene's hash is taken of most of it. It names no path but those of assets, below
 * their root.
 */
#include "scene/options.h"

bool kiln_print_scene(const struct kiln_scene *scene, unsigned parts, struct kiln_text *text)
{
    struct kiln_printer printer = {.source = scene, .keys = scene->keys, .parts = parts};
    kiln_print_members(&printer, kiln_options_root, scene);
    *text = printer.text;
    return !text->failed;
}

bool kiln_scene_print(const struct kiln_scene *scene, FILE *out)
{
    struct kiln_text text;
    bool ok = kiln_print_scene(scene, 0, &text) && fputs(text.data, out) >= 0 && fflush(out) == 0;
    kiln_text_free(&text);
    return ok;
}

size_t kiln_scene_text(const struct kiln_scene *scene, char *out, size_t room)
{
    struct kiln_text text;
    const size_t length = kiln_print_scene(scene, 0, &text) ? text.length : 0;
    const size_t taken = length < room ? length : room - (room > 0);
    if (taken > 0)
        memcpy(out, text.data, taken);
    if (room > 0)
        out[taken] = '\0';
    kiln_text_free(&text);
    return length;
}
