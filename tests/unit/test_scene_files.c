/* lib/scene: files that are no scenes, and assets that are not the scene's to read. */
#include <errno.h>
#include <fcntl.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "scene/scene.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/pictures.h"
#include "support/scenes.h"

/* A folder of its own, which is the working directory during a test, with scenes/textures/ in it.
 */
struct place {
    char folder[32];
    int before;
};

static int enter_folder(void **state)
{
    static struct place place;
    test_make_folder(place.folder);
    place.before = open(".", O_RDONLY | O_DIRECTORY);
    assert_true(place.before >= 0 && chdir(place.folder) == 0);
    assert_true(mkdir("scenes", 0777) == 0 && mkdir("scenes/textures", 0777) == 0);
    *state = &place;
    return 0;
}

static int leave_folder(void **state)
{
    struct place *place = *state;
    assert_int_equal(fchdir(place->before), 0);
    close(place->before);
    test_remove_folder(place->folder);
    return 0;
}

static void write_file(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static void expect_refusal(const char *path, const struct kiln_scene_params *params,
                           const char *message)
{
    struct kiln_error error = {0};
    struct kiln_scene *scene = kiln_scene_load(path, params, &error);
    if (scene)
        fail_msg("accepted: %s", path);
    expect_error(&error, KILN_INVALID_INPUT, "%s", message);
}

static void files_that_are_no_scenes(void **state)
{
    (void)state;
    const struct kiln_scene_params *params = NULL;
    expect_refusal("missing.yaml", params, "missing.yaml: No such file or directory");
    expect_refusal("scenes", params, "scenes: the path is a folder, not a scene file");
    expect_refusal("/dev/zero", params, "/dev/zero: the path is not a regular file");
    assert_int_equal(mkfifo("pipe.yaml", 0666), 0);
    expect_refusal("pipe.yaml", params,
                   "pipe.yaml: the path is not a regular file"); /* and does not wait */
    write_file("empty.yaml", "", 0);
    expect_refusal("empty.yaml", params,
                   "empty.yaml: the file is empty; a scene starts with 'kiln: 1'");
    static const char elf[] = "\x7f"
                              "ELF\2\1\1\0\0\0";
    write_file("binary.yaml", elf, sizeof elf);
    expect_refusal("binary.yaml", params, "binary.yaml:1:8: not a text: a zero byte");
    write_file("latin.yaml", "kiln: 1\n# caf\xe9\n", 15);
    expect_refusal("latin.yaml", params, "latin.yaml:2:6: not a text: invalid UTF-8 (byte 0xe9)");
    write_file("utf16.yaml", "\xff\xfek\0", 4);
    expect_refusal("utf16.yaml", params, "utf16.yaml:1:1: not a text: invalid UTF-8 (byte 0xff)");
    write_file("bom.yaml", "\xef\xbb\xbfkiln: 1\n", 11);
    struct kiln_scene *scene = load_scene_file("bom.yaml");
    kiln_scene_destroy(&scene);
}

/* Told by its size alone, before a byte is read: reading them all would meet the test's limit. */
static void huge_files_are_refused_early(void **state)
{
    (void)state;
    int file = open("huge.yaml", O_WRONLY | O_CREAT, 0666);
    assert_true(file >= 0);
    assert_int_equal(ftruncate(file, (off_t)100 << 30), 0);
    close(file);
    expect_refusal("huge.yaml", NULL,
                   "huge.yaml: the file has 107374182400 bytes; a scene file has at most 4194304");

    struct kiln_error error = {0};
    size_t size = 5 << 20;
    char *text = calloc(size, 1);
    assert_null(kiln_scene_parse(text, size, "memory", NULL, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "memory: the scene file has 5242880 bytes; at most 4194304 are allowed");
    free(text);
}

/* The smallest picture that an image loader takes: a bitmap of one pixel. */
static const unsigned char bitmap[] = {
    'B', 'M', 58, 0, 0, 0, 0, 0, 0, 0, 54, 0, 0, 0, /* file header */
    40,  0,   0,  0, 1, 0, 0, 0, 1, 0, 0,  0, 1, 0, 24, 0, 0, 0, 0, 0,
    4,   0,   0,  0, 0, 0, 0, 0, 0, 0, 0,  0, 0, 0, 0,  0, 0, 0, 0, 0, /* picture header */
    255, 0,   0,  0,
};

static void write_scene(const char *path, const char *atlas)
{
    char text[256];
    int length = snprintf(text, sizeof text,
                          "kiln: 1\nsystems: {a: {look: {atlas: %s, cells: [1, 1]}}}\n", atlas);
    write_file(path, text, (size_t)length);
}

static void expect_atlas_error(const char *atlas, const char *message)
{
    char expected[512];
    snprintf(expected, sizeof expected, "scenes/s.yaml:2:29: systems.a.look.atlas: %s", message);
    write_scene("scenes/s.yaml", atlas);
    expect_refusal("scenes/s.yaml", NULL, expected);
}

static void assets_stay_below_the_scene(void **state)
{
    (void)state;
    write_file("outside.bmp", bitmap, sizeof bitmap);
    write_file("scenes/textures/in.bmp", bitmap, sizeof bitmap);
    assert_int_equal(symlink("../outside.bmp", "scenes/link.bmp"), 0);
    assert_int_equal(symlink("..", "scenes/up"), 0);
    assert_int_equal(symlink("textures/in.bmp", "scenes/fine.bmp"), 0);
    assert_int_equal(symlink("../missing.bmp", "scenes/dangling.bmp"), 0);
    assert_int_equal(symlink("/missing/a.bmp", "scenes/absolute.bmp"), 0);

    static const char outside[] =
        "is outside the asset root; a path starts at the scene's folder and stays below it";
    char message[256];
    snprintf(message, sizeof message, "'../outside.bmp' %s", outside);
    expect_atlas_error("../outside.bmp", message);
    snprintf(message, sizeof message, "'textures/../../outside.bmp' %s", outside);
    expect_atlas_error("textures/../../outside.bmp", message);
    snprintf(message, sizeof message, "'/etc/passwd' %s", outside);
    expect_atlas_error("/etc/passwd", message);
    expect_atlas_error("link.bmp", "'link.bmp' leads outside the asset root");
    expect_atlas_error("up/outside.bmp", "'up/outside.bmp' leads outside the asset root");
    /* A refusal must not tell whether something is there. */
    expect_atlas_error("dangling.bmp", "'dangling.bmp' leads outside the asset root");
    expect_atlas_error("absolute.bmp", "'absolute.bmp' leads outside the asset root");
    expect_atlas_error("up/missing.bmp", "'up/missing.bmp' leads outside the asset root");
    expect_atlas_error("textures", "'textures' is not a file");
    expect_atlas_error(
        "no.bmp",
        "cannot open 'no.bmp': No such file or directory"
        "; a path starts at the scene's folder, or at the asset root that is given instead");
    expect_atlas_error("builtin:smoek",
                       "unknown built-in asset 'builtin:smoek' (did you mean 'smoke'?)");
    static const char *const good[] = {"textures/in.bmp", "./textures/../textures/in.bmp",
                                       "fine.bmp"};
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        write_scene("scenes/s.yaml", good[i]);
        struct kiln_scene *scene = load_scene_file("scenes/s.yaml");
        char *text = print_scene(scene);
        assert_true(scene->systems[0].look.atlas[0][0] == '/');
        assert_non_null(strstr(text, "atlas: \"textures/in.bmp\"\n"));
        free(text);
        kiln_scene_destroy(&scene);
    }
}

static void assets_must_be_pictures(void **state)
{
    (void)state;
    write_file("scenes/text.png", "hello, world\n", 13);
    write_scene("scenes/s.yaml", "text.png");
    struct kiln_error error = {0};
    assert_null(kiln_scene_load("scenes/s.yaml", NULL, &error));
    expect_error(
        &error, KILN_INVALID_INPUT,
        "scenes/s.yaml:2:29: systems.a.look.atlas: 'text.png': the file is not an image: it starts "
        "with the bytes 68 65 6c 6c; allowed are PNG, JPEG, WebP, TIFF, BMP, GIF, EXR or HDR "
        "files");

    unsigned char flat[sizeof bitmap];
    memcpy(flat, bitmap, sizeof flat);
    flat[18] = 0; /* no columns */
    write_file("scenes/flat.bmp", flat, sizeof flat);
    write_scene("scenes/s.yaml", "flat.bmp");
    assert_null(kiln_scene_load("scenes/s.yaml", NULL, &error));
    flat[18] = 0xa0, flat[19] = 0x86, flat[20] = 1; /* 100,000 of them */
    write_file("scenes/flat.bmp", flat, sizeof flat);
    assert_null(kiln_scene_load("scenes/s.yaml", NULL, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "scenes/s.yaml:2:29: systems.a.look.atlas: 'flat.bmp': BMP image of 100000 x 1 "
                 "pixels; allowed are 1 to 16384 a side and at most 67108864 in all");
}

/* Motion is read from images only, while an atlas may be a video. */
static void motion_is_no_video(void **state)
{
    (void)state;
    const struct kiln_frame_range range = {0, 0};
    const struct kiln_output_params params = test_output_params("scenes/x.mp4", &range);
    struct kiln_error error = {0};
    assert_true(test_write_all(&params, &error));
    static const char video[] = "kiln: 1\nsystems: {a: {look: {atlas: x.mp4, cells: [1, 1]}}}\n";
    write_file("scenes/a.yaml", video, sizeof video - 1);
    struct kiln_scene *scene = kiln_scene_load("scenes/a.yaml", NULL, &error);
    assert_non_null(scene);
    kiln_scene_destroy(&scene);
    static const char text[] =
        "kiln: 1\nsystems: {a: {look: {atlas: x.mp4, motion: x.mp4, cells: [1, 1]}}}\n";
    write_file("scenes/a.yaml", text, sizeof text - 1);
    expect_refusal(
        "scenes/a.yaml", NULL,
        "scenes/a.yaml:2:44: systems.a.look.motion: 'x.mp4': the file is not an image: it "
        "starts with the bytes 00 00 00 20; allowed are PNG, JPEG, WebP, TIFF, BMP, GIF, EXR or "
        "HDR "
        "files");
}

static void asset_root_may_be_given(void **state)
{
    (void)state;
    write_file("scenes/textures/in.bmp", bitmap, sizeof bitmap);
    write_scene("s.yaml", "textures/in.bmp");
    struct kiln_scene_params params = kiln_scene_defaults();
    expect_refusal(
        "s.yaml", &params,
        "s.yaml:2:29: systems.a.look.atlas: cannot open 'textures/in.bmp': No such file "
        "or directory"
        "; a path starts at the scene's folder, or at the asset root that is given instead");
    params.asset_root = "nowhere";
    expect_refusal("s.yaml", &params, "asset root 'nowhere': No such file or directory");
    params.asset_root = "s.yaml";
    expect_refusal("s.yaml", &params, "asset root 's.yaml' is not a folder");
    params.asset_root = "scenes";
    struct kiln_error error = {0};
    struct kiln_scene *scene = kiln_scene_load("s.yaml", &params, &error);
    assert_non_null(scene);

    /* The hash does not know where the scene lies. */
    write_scene("scenes/t.yaml", "textures/in.bmp");
    struct kiln_scene *elsewhere = load_scene_file("scenes/t.yaml");
    assert_string_equal(scene->hash, elsewhere->hash);
    assert_string_equal(elsewhere->name, "scenes/t.yaml");
    kiln_scene_destroy(&elsewhere);

    /* But it knows what the textures show. */
    unsigned char changed[sizeof bitmap];
    memcpy(changed, bitmap, sizeof bitmap);
    changed[sizeof changed - 4] ^= 0xff; /* a pixel */
    write_file("scenes/textures/in.bmp", changed, sizeof changed);
    struct kiln_scene *repainted = load_scene_file("scenes/t.yaml");
    assert_string_not_equal(scene->hash, repainted->hash);
    kiln_scene_destroy(&repainted);
    kiln_scene_destroy(&scene);
}

static struct kiln_scene *load_with_mesh(const char *mesh)
{
    static const char text[] =
        "kiln: 1\nbackdrop: {objects: [{mesh: {file: textures/m.obj, scale: 2}}]}\n";
    write_file("scenes/m.yaml", text, sizeof text - 1);
    write_file("scenes/textures/m.obj", mesh, strlen(mesh));
    struct kiln_scene *scene = load_scene_file("scenes/m.yaml");
    assert_int_equal(scene->backdrop.object_count, 1);
    assert_int_equal(scene->backdrop.objects[0].kind, KILN_OBJECT_MESH);
    return scene;
}

static void what_collides_must_be_closed(void **state)
{
    (void)state;
    static const char text[] =
        "kiln: 1\nbackdrop: {objects: [{mesh: {file: textures/open.obj, collide: true}}]}\n";
    const char *triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    struct kiln_error error = {0};
    const struct kiln_scene_params params = kiln_scene_defaults();
    write_file("scenes/open.yaml", text, sizeof text - 1);
    write_file("scenes/textures/open.obj", triangle, strlen(triangle));
    assert_null(kiln_scene_load("scenes/open.yaml", &params, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "scenes/open.yaml:2:64: backdrop.objects.0.mesh.collide: "
                 "'textures/open.obj': the mesh is not closed, so it has no inside: 1 "
                 "triangle is at the edge from 0 0 0 to 0 1 0, where there must be two; 'collider: "
                 "volume' and 'collider: depth_maps' take meshes that are not closed");
    static const char *const colliders[] = {"backdrop.objects.0.mesh.collider=volume",
                                            "backdrop.objects.0.mesh.collider=depth_maps"};
    for (int i = 0; i < 2; i++) {
        struct kiln_scene_params other = kiln_scene_defaults();
        other.overrides = &colliders[i];
        other.override_count = 1;
        struct kiln_scene *scene = kiln_scene_load("scenes/open.yaml", &other, &error);
        if (!scene)
            fail_msg("%s", error.message);
        kiln_scene_destroy(&scene);
    }
}

static void depth_maps_need_directions_and_no_inside(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"{}", NULL},
        {"{directions: [[1, 2, 3]], resolution: 64}", NULL},
        {"{directions: []}",
         "scenes/depths.yaml:2:117: backdrop.objects.0.mesh.depth_maps.directions: must name at "
         "least one direction"},
        {"{directions: [[1, 0, 0], [0, 0, 0]]}",
         "scenes/depths.yaml:2:129: backdrop.objects.0.mesh.depth_maps.directions.1: must not be "
         "[0, 0, 0]"},
        {"{directions: [[1, 0, 0], [0, {keys: {0 s: 1}}, 0]]}",
         "scenes/depths.yaml:2:134: backdrop.objects.0.mesh.depth_maps.directions.1.1.keys: cannot "
         "vary over time here; allowed is a constant"},
    };
    const struct kiln_scene_params params = kiln_scene_defaults();
    const char *triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    write_file("scenes/textures/open.obj", triangle, strlen(triangle));
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[300];
        struct kiln_error error = {0};
        const int size = snprintf(text, sizeof text,
                                  "kiln: 1\nbackdrop: {objects: [{mesh: {file: textures/open.obj, "
                                  "collide: true, collider: depth_maps, depth_maps: %s}}]}\n",
                                  cases[i][0]);
        write_file("scenes/depths.yaml", text, (size_t)size);
        struct kiln_scene *scene = kiln_scene_load("scenes/depths.yaml", &params, &error);
        assert_int_equal(scene != NULL, cases[i][1] == NULL);
        if (!scene && cases[i][1])
            expect_error(&error, KILN_INVALID_INPUT, "%s", cases[i][1]);
        if (scene)
            assert_int_equal(scene->backdrop.objects[0].depth_direction_count, i == 0 ? 3 : 1);
        kiln_scene_destroy(&scene);
    }
}

/* Six meshes of six maps of 2 * 256 * 256 samples; the file is the one above. */
static void depth_maps_are_summed_up(void **state)
{
    (void)state;
    static const char mesh[] =
        "- mesh: {file: textures/open.obj, collide: true, collider: depth_maps, depth_maps: "
        "{resolution: 256, directions: [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0], [1, 0, 1], "
        "[0, 1, 1]]}}\n";
    const char *triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    char text[2048];
    size_t length = (size_t)snprintf(text, sizeof text, "kiln: 1\nbackdrop:\n  objects:\n");
    write_file("scenes/textures/open.obj", triangle, strlen(triangle));
    for (int i = 1; i <= 6; i++) {
        struct kiln_error error = {0};
        length += (size_t)snprintf(text + length, sizeof text - length, "  %s", mesh);
        write_file("scenes/sum.yaml", text, length);
        struct kiln_scene *scene = kiln_scene_load("scenes/sum.yaml", NULL, &error);
        assert_int_equal(scene != NULL, i <= 5);
        if (i == 6)
            expect_error(&error, KILN_INVALID_INPUT,
                         "scenes/sum.yaml:4:46: backdrop.objects.0.mesh.collide: wind, "
                         "terrain and meshes that move particles have 4718700 samples "
                         "altogether; a scene has at most 4194304");
        kiln_scene_destroy(&scene);
    }
}

/* What a terrain's picture contains belongs to the hash, too. */
static void terrain_is_hashed(void **state)
{
    (void)state;
    static const char text[] =
        "kiln: 1\nbackdrop: {objects: [{terrain: {image: textures/h.bmp, samples: [2, 2]}}]}\n";
    uint8_t pixel[58] = {
        'B', 'M', 58, [10] = 54, [14] = 40, [18] = 1, [22] = 1, [26] = 1, [28] = 24};
    write_file("scenes/h.yaml", text, sizeof text - 1);
    write_file("scenes/textures/h.bmp", pixel, sizeof pixel);
    struct kiln_scene *black = load_scene_file("scenes/h.yaml");
    pixel[54] = 255;
    write_file("scenes/textures/h.bmp", pixel, sizeof pixel);
    struct kiln_scene *blue = load_scene_file("scenes/h.yaml");
    assert_string_not_equal(black->hash, blue->hash);
    kiln_scene_destroy(&black);
    kiln_scene_destroy(&blue);
}

/* A broken mesh is an error at its place; what a good one contains belongs to the hash. */
static void meshes_are_checked_and_hashed(void **state)
{
    (void)state;
    const char *corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    struct kiln_scene *scene = load_with_mesh(corners);
    struct kiln_scene *same = load_with_mesh(corners);
    struct kiln_scene *moved = load_with_mesh("v 0 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\n");
    assert_string_equal(scene->hash, same->hash);
    assert_string_not_equal(scene->hash, moved->hash);
    kiln_scene_destroy(&scene);
    kiln_scene_destroy(&same);
    kiln_scene_destroy(&moved);

    write_file("scenes/textures/m.obj", "v 0 0 0\n", 8);
    struct kiln_error error = {0};
    assert_null(kiln_scene_load("scenes/m.yaml", NULL, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "scenes/m.yaml:2:36: backdrop.objects.0.mesh.file: 'textures/m.obj': the mesh has "
                 "no triangles");
}

#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, enter_folder, leave_folder)

int main(void)
{
    static const struct CMUnitTest tests[] = {
        IN_FOLDER(files_that_are_no_scenes),
        IN_FOLDER(huge_files_are_refused_early),
        IN_FOLDER(assets_stay_below_the_scene),
        IN_FOLDER(assets_must_be_pictures),
        IN_FOLDER(motion_is_no_video),
        IN_FOLDER(asset_root_may_be_given),
        IN_FOLDER(meshes_are_checked_and_hashed),
        IN_FOLDER(what_collides_must_be_closed),
        IN_FOLDER(depth_maps_need_directions_and_no_inside),
        IN_FOLDER(depth_maps_are_summed_up),
        IN_FOLDER(terrain_is_hashed),
    };
    return cmocka_run_group_tests_name("scene_files", tests, NULL, NULL);
}
