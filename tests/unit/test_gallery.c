/* lib/report/gallery.c, preview.c: which pictures are in a page, and how. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "asset/image/image.h"
#include "base/arena.h"
#include "base/file_in.h"
#include "output/formats.h"
#include "report/gallery.h"
#include "report/preview.h"
#include "support/cmocka.h"
#include "support/pictures.h"

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

/* A frame of the waves of support/pictures.h. */
static void write_wave(const char *path, uint32_t frame, uint32_t bits)
{
    const struct kiln_frame_range range = {frame, frame};
    struct kiln_output_params params = test_output_params(path, &range);
    struct kiln_error error = {0};
    params.png_bits = bits;
    params.overwrite = true;
    if (!test_write_all(&params, &error))
        fail_msg("%s", error.message);
}

static bool is_plain(const char *path)
{
    size_t size = 0;
    struct kiln_error error = {0};
    unsigned char *bytes = kiln_file_read(path, "picture", "PNG", SIZE_MAX, &size, &error);
    const bool plain = bytes && kiln_preview_is_plain(bytes, size);
    free(bytes);
    return plain;
}

static struct kiln_asset_image *preview_of(const char *path, const char *target)
{
    struct kiln_error error = {0};
    struct kiln_temporary file = {0};
    assert_true(kiln_temporary_open(&file, target, &error));
    size_t size = 0;
    unsigned char *bytes = kiln_file_read(path, "picture", "PNG", SIZE_MAX, &size, &error);
    if (!bytes || !kiln_preview_write(bytes, size, path, &file, &error))
        fail_msg("%s", error.message);
    free(bytes);
    assert_true(kiln_temporary_commit(&file, true, &error));
    assert_true(is_plain(target));
    struct kiln_asset_image *image = kiln_asset_image_load(NULL, target, &error);
    assert_non_null(image);
    assert_int_equal(image->type, KILN_IMAGE_U8);
    return image;
}

static void previews_have_eight_bits(void **state)
{
    (void)state;
    char folder[32], path[64], target[64];
    test_make_folder(folder);
    snprintf(path, sizeof path, "%s/deep.png", folder);
    snprintf(target, sizeof target, "%s/preview.png", folder);
    write_wave(path, 3, 16);
    assert_false(is_plain(path));
    struct kiln_error error = {0};
    struct kiln_asset_image *deep = kiln_asset_image_load(NULL, path, &error);
    struct kiln_asset_image *image = preview_of(path, target);
    assert_non_null(deep);
    const uint16_t *from = deep->pixels;
    const uint8_t *to = image->pixels;
    for (size_t i = 0; i < (size_t)4 * image->width * image->height; i++)
        assert_int_equal(to[i], (from[i] * 255u + 32767u) / 65535u);
    kiln_asset_image_destroy(&deep);
    kiln_asset_image_destroy(&image);

    write_wave(path, 3, 8);
    assert_true(is_plain(path));
    write_text(path, "\x89PNG");
    assert_false(is_plain(path));
    test_remove_folder(folder);
}

/* Linear light keeps its order, from black up to far beyond white. */
static void previews_map_tones(void **state)
{
    (void)state;
    char folder[32], path[64], target[64];
    test_make_folder(folder);
    snprintf(path, sizeof path, "%s/light.exr", folder);
    snprintf(target, sizeof target, "%s/preview.png", folder);
    write_wave(path, 0, 8);
    struct kiln_error error = {0};
    struct kiln_asset_image *light = kiln_asset_image_load(NULL, path, &error);
    struct kiln_asset_image *image = preview_of(path, target);
    assert_non_null(light);
    const float *from = light->pixels;
    const uint8_t *to = image->pixels;
    bool seen_black = false, seen_between = false;
    for (uint32_t x = 0; x + 1 < image->width; x++) {
        const float *a = from + 4 * x;
        assert_true(a[0] < a[4]);
        assert_true(to[4 * x] <= to[4 * x + 4]);
        assert_int_equal(to[4 * x + 3], 255);
        seen_black = seen_black || (a[0] <= 0.0f && to[4 * x] == 0);
        seen_between = seen_between || (a[0] > 1.0f && to[4 * x] < 255);
    }
    assert_true(seen_black);
    assert_true(seen_between);
    kiln_asset_image_destroy(&light);
    kiln_asset_image_destroy(&image);
    test_remove_folder(folder);
}

/* ---- The gallery -------------------------------------------------------------------------- */

struct album {
    char folder[32], results[64], page[96];
    struct kiln_result result;
    struct kiln_result_frame frames[3];
    struct kiln_results all;
};

static void open_album(struct album *album)
{
    *album = (struct album){0};
    test_make_folder(album->folder);
    snprintf(album->results, sizeof album->results, "%s/out/a b", album->folder);
    char out[64];
    snprintf(out, sizeof out, "%s/out", album->folder);
    assert_int_equal(mkdir(out, 0777), 0);
    assert_int_equal(mkdir(album->results, 0777), 0);
    snprintf(album->page, sizeof album->page, "%s/report.html", album->folder);
    kiln_result_init(&album->result, "a b");
    album->result.frames = album->frames;
    for (uint32_t i = 0; i < 3; i++)
        kiln_result_frame_init(&album->frames[i], i);
    album->all.arena = kiln_arena_create();
    album->all.tests = kiln_arena_alloc(album->all.arena, 1, sizeof *album->all.tests);
    album->all.folders = kiln_arena_alloc(album->all.arena, 1, sizeof *album->all.folders);
    album->all.tests[0] = &album->result;
    album->all.folders[0] = album->results;
    album->all.count = 1;
}

static void close_album(struct album *album)
{
    kiln_arena_destroy(&album->all.arena);
    test_remove_folder(album->folder);
}

static void in_album(const struct album *album, const char *name, char path[128])
{
    snprintf(path, 128, "%s/%s", album->results, name);
}

static struct kiln_gallery *plan(const struct album *album, bool link)
{
    static const size_t order[] = {0};
    struct kiln_error error = {0};
    const struct kiln_results_output output = {"html", album->page, link, false};
    struct kiln_gallery *gallery = kiln_gallery_plan(&album->all, order, &output, &error);
    if (!gallery)
        fail_msg("%s", error.message);
    return gallery;
}

static char *write_gallery(const struct kiln_gallery *gallery)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    kiln_gallery_write(gallery, out);
    assert_int_equal(fclose(out), 0);
    return text;
}

static void equal_pictures_are_held_once(void **state)
{
    (void)state;
    struct album album;
    char path[128];
    open_album(&album);
    album.result.frame_count = 2;
    static const char *const names[] = {"0.png", "0r.png", "1.png", "1r.png"};
    for (uint32_t i = 0; i < 4; i++) {
        in_album(&album, names[i], path);
        write_wave(path, i < 2 ? 7 : i, 8);
    }
    album.frames[0].picture = "0.png";
    album.frames[0].reference = "0r.png";
    album.frames[1].picture = "1.png";
    album.frames[1].reference = "1r.png";
    album.frames[1].status = KILN_TEST_FAIL;
    struct kiln_gallery *gallery = plan(&album, false);
    assert_int_equal(kiln_gallery_embedded_count(gallery), 3);
    const struct kiln_gallery_place *same = kiln_gallery_places(gallery, 0, 0);
    const struct kiln_gallery_place *other = kiln_gallery_places(gallery, 0, 1);
    assert_int_equal(same[KILN_GALLERY_RESULT].number, same[KILN_GALLERY_REFERENCE].number);
    assert_int_equal(same[KILN_GALLERY_ERROR_MAP].kind, KILN_GALLERY_NONE);
    /* The frame that fails comes first. */
    assert_int_equal(other[KILN_GALLERY_REFERENCE].number, 0);
    assert_int_equal(other[KILN_GALLERY_RESULT].number, 1);
    char *text = write_gallery(gallery);
    assert_non_null(strstr(text, "<script type=\"text/plain\" id=\"p2\">iVBORw0KGgo"));
    free(text);
    close_album(&album);
}

static void links_are_relative_to_the_page(void **state)
{
    (void)state;
    struct album album;
    char path[128];
    open_album(&album);
    album.result.frame_count = 1;
    album.frames[0].picture = "0.png";
    album.frames[0].reference = "0.exr";
    in_album(&album, "0.png", path);
    write_wave(path, 1, 8);
    in_album(&album, "0.exr", path);
    write_wave(path, 1, 8);
    const struct kiln_gallery_place *places = kiln_gallery_places(plan(&album, true), 0, 0);
    assert_int_equal(places[KILN_GALLERY_RESULT].kind, KILN_GALLERY_LINKED);
    assert_string_equal(places[KILN_GALLERY_RESULT].text, "out/a b/0.png");
    assert_string_equal(places[KILN_GALLERY_REFERENCE].text, "out/a b/0.preview.png");
    in_album(&album, "0.preview.png", path);
    assert_true(is_plain(path));

    snprintf(album.page, sizeof album.page, "%s/out/a b/report.html", album.folder);
    places = kiln_gallery_places(plan(&album, true), 0, 0);
    assert_string_equal(places[KILN_GALLERY_RESULT].text, "0.png");
    snprintf(album.page, sizeof album.page, "%s/out/a", album.folder);
    assert_int_equal(mkdir(album.page, 0777), 0);
    snprintf(album.page, sizeof album.page, "%s/out/a/report.html", album.folder);
    places = kiln_gallery_places(plan(&album, true), 0, 0);
    assert_string_equal(places[KILN_GALLERY_RESULT].text, "../a b/0.png");
    close_album(&album);
}

static void broken_pictures_say_why(void **state)
{
    (void)state;
    struct album album;
    char path[128];
    open_album(&album);
    album.result.frame_count = 1;
    album.frames[0].picture = "<0>.png";
    album.frames[0].reference = "absent.png";
    in_album(&album, "<0>.png", path);
    write_text(path, "no picture");
    const struct kiln_gallery_place *places = kiln_gallery_places(plan(&album, true), 0, 0);
    assert_int_equal(places[KILN_GALLERY_RESULT].kind, KILN_GALLERY_BROKEN);
    assert_non_null(strstr(places[KILN_GALLERY_RESULT].text, "<0>.png"));
    assert_int_equal(places[KILN_GALLERY_REFERENCE].kind, KILN_GALLERY_BROKEN);
    char *text = write_gallery(plan(&album, false));
    assert_non_null(strstr(text, "id=\"p0\" data-problem=\""));
    assert_non_null(strstr(text, "id=\"p1\" data-problem=\""));
    assert_non_null(strstr(text, "&lt;0&gt;.png"));
    assert_null(strstr(text, "<0>"));
    free(text);
    close_album(&album);
}

/* What does not fit is linked, the frames of the least concern first. */
static void a_page_has_a_size(void **state)
{
    (void)state;
    struct album album;
    char path[128];
    open_album(&album);
    album.result.frame_count = 3;
    static const char *const names[] = {"0.png", "1.png", "2.png"};
    for (uint32_t i = 0; i < 3; i++) {
        in_album(&album, names[i], path);
        write_wave(path, i, 8);
        assert_int_equal(truncate(path, KILN_GALLERY_BYTES / 2), 0);
        album.frames[i].picture = names[i];
    }
    album.frames[2].status = KILN_TEST_FAIL;
    struct kiln_gallery *gallery = plan(&album, false);
    assert_int_equal(kiln_gallery_embedded_count(gallery), 2);
    assert_int_equal(kiln_gallery_linked_for_size(gallery), 1);
    static const enum kiln_gallery_kind kinds[] = {KILN_GALLERY_EMBEDDED, KILN_GALLERY_LINKED,
                                                   KILN_GALLERY_EMBEDDED};
    for (size_t i = 0; i < 3; i++)
        assert_int_equal(kiln_gallery_places(gallery, 0, i)[KILN_GALLERY_RESULT].kind, kinds[i]);
    close_album(&album);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(previews_have_eight_bits),
        cmocka_unit_test(previews_map_tones),
        cmocka_unit_test(equal_pictures_are_held_once),
        cmocka_unit_test(links_are_relative_to_the_page),
        cmocka_unit_test(broken_pictures_say_why),
        cmocka_unit_test(a_page_has_a_size),
    };
    return cmocka_run_group_tests_name("gallery", tests, NULL, NULL);
}
