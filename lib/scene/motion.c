/* This file hashes the parts of a scene that saved states depend on. A state serves every scene
 * that moves its particles alike, however they look. A part is printed as a scene, the contents of
 * its files and KILN_STATE_VERSION are added, and that text is hashed. tests/unit/test_motion.c
 * changes every row and checks whether the state changes. */
#include "scene/motion.h"

#include "base/error.h"
#include "base/hash.h"
#include "scene/asset_path.h"

/* Adds the hashes of wind files and of the meshes and terrain that particles meet. */
static bool add_files(struct kiln_text *text, const struct kiln_scene *scene,
                      struct kiln_error *error)
{
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_system *system = &scene->systems[i];
        for (uint32_t k = 0; k < system->force_count; k++) {
            if (system->forces[k].kind == KILN_FORCE_FIELD &&
                !kiln_asset_add_hash(scene, system->forces[k].file, text, error))
                return false;
        }
    }
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        const struct kiln_object *object = &scene->backdrop.objects[i];
        if (kiln_row_if_object_is_met(scene, object) == 0)
            continue;
        if (object->kind == KILN_OBJECT_MESH)
            kiln_text_add(text, "%s\n", object->shown->hash);
        else if (object->kind == KILN_OBJECT_TERRAIN && object->file &&
                 !kiln_asset_add_hash(scene, object->file, text, error))
            return false;
    }
    return true;
}

bool kiln_scene_part_hash(const struct kiln_scene *scene, enum kiln_scene_part part, char hex[65],
                          struct kiln_error *error)
{
    struct kiln_text text;
    bool ok = kiln_print_scene(scene, part, &text);
    kiln_text_add(&text, "version %d\n", KILN_STATE_VERSION);
    for (uint32_t i = 0; i < scene->system_count; i++)
        kiln_text_add(&text, "slots %u\n", scene->systems[i].capacity);
    const bool read = !ok || add_files(&text, scene, error);
    ok = ok && !text.failed;
    if (ok)
        kiln_hash_sha256(text.data, text.length, hex);
    kiln_text_free(&text);
    if (!read)
        return false;
    return ok || kiln_error_set(error, KILN_DEVICE_FAILED, "out of memory for a hash of a scene");
}
