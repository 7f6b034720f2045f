/* Meshes are imported once each. */
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "asset/geometry/mesh_library.h"
#include "scene/scene.h"
#include "support/cmocka.h"
#include "support/errors.h"

static const char FOLDER[] = KILN_SOURCE_DIR "/tests/mutation";
#define TETRAHEDRON KILN_SOURCE_DIR "/tests/mutation/tetrahedron.obj"
#define CARD        KILN_SOURCE_DIR "/tests/mutation/card.obj"
#define MOVING      KILN_SOURCE_DIR "/tests/mutation/moving.gltf"

/* ---- a library ------------------------------------------------------------------------------- */

static void what_is_there_is_given_again(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct kiln_mesh_library *library = kiln_mesh_library_create(NULL);
    const struct kiln_mesh *plain = kiln_mesh_library_get(library, CARD, &error);
    const struct kiln_mesh *unwrapped = kiln_mesh_library_get_unwrapped(library, CARD, &error);
    const struct kiln_skin *moving = kiln_mesh_library_get_skin(library, MOVING, &error);
    assert_non_null(plain);
    assert_non_null(unwrapped);
    assert_non_null(moving);
    assert_null(plain->uvs);
    assert_non_null(unwrapped->uvs);
    assert_string_equal(plain->hash, unwrapped->hash);

    assert_ptr_equal(kiln_mesh_library_get_skin(library, MOVING, &error), moving);
    assert_ptr_equal(kiln_mesh_library_get_unwrapped(library, CARD, &error), unwrapped);
    assert_ptr_equal(kiln_mesh_library_get(library, CARD, &error), plain);
    const struct kiln_mesh *still = kiln_mesh_library_get(library, MOVING, &error);
    assert_non_null(still);
    assert_string_equal(still->hash, kiln_skin_mesh(moving)->hash);
    kiln_mesh_library_destroy(&library);
    assert_null(library);
    kiln_mesh_library_destroy(&library);
}

static void failures_are_told_and_not_kept(void **state)
{
    (void)state;
    struct kiln_mesh_library *library = kiln_mesh_library_create(NULL);
    for (int i = 0; i < 2; i++) {
        struct kiln_error error = {0};
        assert_null(kiln_mesh_library_get_skin(library, TETRAHEDRON, &error));
        expect_error(&error, KILN_INVALID_INPUT, TETRAHEDRON ": the file has no animation");
    }
    struct kiln_error error = {0};
    assert_non_null(kiln_mesh_library_get(library, TETRAHEDRON, &error));
    kiln_mesh_library_destroy(&library);
}

/* ---- a render -------------------------------------------------------------------------------- */

static const char SCENE[] =
    "kiln: 1\n"
    "output: {size: [32, 18], fps: 30, frames: 2}\n"
    "backdrop:\n"
    "  objects:\n"
    "  - mesh: {file: tetrahedron.obj, collide: true, cells: 8}\n"
    "  - mesh: {file: tetrahedron.obj, collide: true, collider: volume, cells: 8}\n"
    "  - mesh: {file: tetrahedron.obj, collide: true, collider: depth_maps}\n"
    "  - mesh: {file: moving.gltf, animation: {}, collide: true, collider: volume, cells: 8}\n"
    "  - mesh: {file: moving.gltf, animation: {}, position: [1, 0, 0]}\n"
    "  - mesh: {file: card.obj, paint: {size: 16}}\n"
    "systems:\n"
    "  a:\n"
    "    emit: {rate: 100, life: 1 s, speed: 1}\n"
    "    collide: {}\n"
    "    paint: {radius: 0.1}\n"
    "    look: {shape: mesh, mesh: {file: tetrahedron.obj}}\n"
    "  b:\n"
    "    emit: {rate: 100, life: 1 s, speed: 1}\n"
    "    look: {shape: mesh, mesh: {file: tetrahedron.obj}}\n";

/* Objects and looks of one file share what it was imported as, for each way of it. */
static void a_scene_imports_each_once(void **state)
{
    (void)state;
    struct kiln_error error = {0};
    struct kiln_scene_params params = kiln_scene_defaults();
    params.asset_root = FOLDER;
    struct kiln_scene *scene = kiln_scene_parse(SCENE, sizeof SCENE - 1, "s", &params, &error);
    if (!scene)
        fail_msg("%s", error.message);
    const struct kiln_object *objects = scene->backdrop.objects;
    assert_ptr_equal(objects[0].collision_mesh, objects[1].collision_mesh);
    assert_ptr_equal(objects[0].collision_mesh, objects[2].collision_mesh);
    assert_ptr_equal(objects[3].skin, objects[4].skin);
    assert_ptr_equal(scene->systems[0].look.mesh.shown, scene->systems[1].look.mesh.shown);
    kiln_scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_there_is_given_again),
        cmocka_unit_test(failures_are_told_and_not_kept),
        cmocka_unit_test(a_scene_imports_each_once),
    };
    return cmocka_run_group_tests_name("mesh_library", tests, NULL, NULL);
}
