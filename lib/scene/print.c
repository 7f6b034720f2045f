/* The scene as a scene file, with nothing left to defaults: what `kiln check` prints, and what the
 * scene's hash is taken of. It names no path but those of assets, below their root. */
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
