/* This file hashes a part of a scene: the options that decide the motion of its particles, or those
 * that decide where the camera sees them in each moment (scene/parts.h). job/states.c and
 * job/plan.c compare the hashes, since a saved state fits every scene that moves particles alike,
 * however they look.
 *
 * The text that is hashed consists of the part's options, printed as a scene, KILN_STATE_VERSION,
 * the capacity of each system, what the cells of each domain of gas carry, and the hashes of wind
 * files, of meshes and terrain that particles hit, and of files whose nodes matter to the part. The
 * hash of a mesh is that of its file, so it is followed by the version of the readers of meshes.
 * tests/unit/test_motion.c changes every option, and checks that the hash changes where the state
 * does. */
#include "scene/motion.h"

#include "asset/geometry/rig.h"
#include "base/error.h"
#include "base/hash.h"
#include "scene/asset_path.h"
#include "scene/baked.h"
#include "scene/source.h"

/* Adds the hashes of the files whose nodes move what belongs to a part. */
static void add_node_files(struct kiln_text *text, const struct kiln_scene *scene,
                           enum kiln_scene_part part)
{
    for (uint32_t i = 0; i < scene->node_count; i++) {
        if (kiln_row_if_node_is_of_file(scene, &scene->nodes[i]) & part)
            kiln_text_add(text, "%s read %d\n", kiln_rig_hash(scene->nodes[i].rig),
                          KILN_MESH_READER_VERSION);
    }
}

/* Adds the hashes of the wind files of field forces, and of the meshes and terrain that particles
 * hit. Both parts have them. */
static bool add_files(struct kiln_text *text, const struct kiln_scene *scene,
                      struct kiln_error *error)
{
    for (uint32_t i = 0; i < kiln_force_owners(scene); i++) {
        const struct kiln_force *force;
        for (uint32_t k = 0; (force = kiln_owner_force(scene, i, k)) != NULL; k++) {
            if (force->kind == KILN_FORCE_FIELD &&
                !kiln_asset_add_hash(scene, force->file, text, error))
                return false;
        }
    }
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        const struct kiln_object *object = &scene->backdrop.objects[i];
        if (kiln_row_if_particles_hit_object(scene, object) == 0)
            continue;
        if (object->kind == KILN_OBJECT_MESH)
            kiln_text_add(text, "%s read %d\n", object->shown->hash, KILN_MESH_READER_VERSION);
        else if (object->kind == KILN_OBJECT_TERRAIN && object->file &&
                 !kiln_asset_add_hash(scene, object->file, text, error))
            return false;
    }
    return kiln_sources_add_hashes(scene, true, text, error);
}

bool kiln_scene_part_hash(const struct kiln_scene *scene, enum kiln_scene_part part, char hex[65],
                          struct kiln_error *error)
{
    struct kiln_text text;
    bool ok = kiln_print_scene(scene, part, &text);
    kiln_text_add(&text, "version %d\n", KILN_STATE_VERSION);
    for (uint32_t i = 0; i < scene->system_count; i++)
        kiln_text_add(&text, "slots %u\n", scene->systems[i].capacity);
    for (uint32_t i = 0; i < scene->gas_count; i++)
        kiln_text_add(&text, "groups %u\n", kiln_gas_groups(&scene->gas[i].shape));
    add_node_files(&text, scene, part);
    const bool files_ok = !ok || add_files(&text, scene, error);
    ok = ok && !text.failed;
    if (ok)
        kiln_hash_sha256(text.data, text.length, hex);
    kiln_text_free(&text);
    if (!files_ok)
        return false;
    return ok || kiln_error_no_memory(error, "hashing a scene");
}
