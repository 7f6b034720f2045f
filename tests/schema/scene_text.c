/* Prints texts of kiln for the test of the schema (ajv.mjs): `scene_text schema` prints the JSON
 * schema of scenes, and `scene_text print FILE` prints a scene with all its defaults. */
#include <stdio.h>
#include <string.h>

#include "kiln_program.h"

int main(int argc, char **argv)
{
    struct kiln_error error = {0};
    if (argc == 2 && strcmp(argv[1], "schema") == 0)
        return kiln_scene_write_schema(stdout) ? 0 : KILN_IO;
    if (argc != 3 || strcmp(argv[1], "print") != 0)
        return KILN_USAGE;
    struct kiln_scene *scene = kiln_scene_load(argv[2], NULL, &error);
    if (!scene) {
        fprintf(stderr, "%s\n", error.message);
        return (int)error.code;
    }
    bool ok = kiln_scene_print(scene, stdout);
    kiln_scene_destroy(&scene);
    return ok ? 0 : KILN_IO;
}
