/* lib/scene: what is wrong with the objects and pictures of a backdrop, in the exact words. */
#include <stddef.h>
#include <stdint.h>

#include "support/cmocka.h"
#include "support/errors.h"
#include "support/scenes.h"

#define FOUR_TERRAINS       "{terrain: {}}, {terrain: {}}, {terrain: {}}, {terrain: {}}, "
#define SIXTEEN_TERRAINS    FOUR_TERRAINS FOUR_TERRAINS FOUR_TERRAINS FOUR_TERRAINS
#define SIXTY_FOUR_TERRAINS SIXTEEN_TERRAINS SIXTEEN_TERRAINS SIXTEEN_TERRAINS SIXTEEN_TERRAINS

static const struct {
    const char *text;
    const char *message; /* after the name of the file */
} bad[] = {
    {"kiln: 1\n"
     "backdrop: {objects: [{box: {}}, {cylinder: {axis: [0, 0, 0]}}]}\n",
     ":2:51: backdrop.objects.1.cylinder.axis: must not be [0, 0, 0]"},
    {"kiln: 1\n"
     "backdrop: {objects: [{capsule: {axis: {keys: {0 s: [0, 1, 0], 1 s: [0, 0, 0]}}}}]}\n",
     ":2:39: backdrop.objects.0.capsule.axis: must not be [0, 0, 0]"},
    {"kiln: 1\n"
     "backdrop: {objects: [{plane: {normal: [0, 0, 0]}}]}\n",
     ":2:39: backdrop.objects.0.plane.normal: must not be [0, 0, 0]"},
    {"kiln: 1\n"
     "backdrop: {objects: [{box: {friction: -1}}]}\n",
     ":2:39: backdrop.objects.0.box.friction: -1 is out of range; allowed is from 0 to 100"},
    {"kiln: 1\n"
     "backdrop: {objects: [{mesh: {}}]}\n",
     ":2:29: backdrop.objects.0.mesh.file: the key is missing and must be given"},
    {"kiln: 1\n"
     "backdrop: {objects: [{mesh: {file: 7}}]}\n",
     ":2:36: backdrop.objects.0.mesh.file: expected the path of an OBJ, glTF, GLB, PLY or STL "
     "file, from the scene's folder and inside it, found '7'"},
    {"kiln: 1\n"
     "backdrop: {objects: [{mesh: {file: ../pot.obj}}]}\n",
     ":2:36: backdrop.objects.0.mesh.file: '../pot.obj' is outside the asset root; a path starts "
     "at the scene's folder and stays below it"},
    {"kiln: 1\n"
     "backdrop: {objects: [{terrain: {samples: [1, 9]}}]}\n",
     ":2:43: backdrop.objects.0.terrain.samples: 1 is out of range; allowed is from 2 to "
     "513"},
    {"kiln: 1\n"
     "backdrop: {objects: [{terrain: {image: none.png}}]}\n",
     ":2:40: backdrop.objects.0.terrain.image: cannot open 'none.png': No such file or directory"
     "; a path starts at the scene's folder, or at the asset root that is given instead"},
    {"kiln: 1\n"
     "backdrop: {objects: [" SIXTY_FOUR_TERRAINS "{terrain: {}}]}\n",
     ":2:21: backdrop.objects: more than 64 meshes; no more are allowed"},
    {"kiln: 1\n"
     "backdrop: {sky: {image: /etc/passwd}}\n",
     ":2:25: backdrop.sky.image: '/etc/passwd' is outside the asset root; a path starts at the "
     "scene's folder and stays below it"},
    {"kiln: 1\n"
     "backdrop: {floor: {image: no-such-file.png}}\n",
     ":2:27: backdrop.floor.image: cannot open 'no-such-file.png': No such file or directory"
     "; a path starts at the scene's folder, or at the asset root that is given instead"},
};

static void bad_backdrops(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct kiln_error error = {0};
        if (try_scene(bad[i].text, NULL, &error))
            fail_msg("accepted: %s", bad[i].text);
        expect_error(&error, KILN_INVALID_INPUT, SCENE_NAME "%s", bad[i].message);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {cmocka_unit_test(bad_backdrops)};
    return cmocka_run_group_tests_name("scene_backdrop", tests, NULL, NULL);
}
