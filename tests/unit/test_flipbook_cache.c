/* lib/asset/atlas/flipbook_cache and lib/base/build_id: what one process made, the next one of the
 * same build takes, and nothing else. */
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "asset/atlas/atlas.h"
#include "asset/atlas/flipbook_cache.h"
#include "base/build_id.h"
#include "base/cache.h"
#include "support/cmocka.h"
#include "support/folders.h"

enum { CELLS = 6, TEXEL_BYTES = CELLS * KILN_ATLAS_LAYER_BYTES };

static struct kiln_atlas make(const struct kiln_atlas_request *request, const char *cache)
{
    struct kiln_error error = {0};
    struct kiln_atlas atlas = {0};
    struct kiln_threads *threads = kiln_threads_create(2);
    assert_non_null(threads);
    if (!kiln_atlas_init(&atlas, NULL, request, 1, cache, threads, &error))
        fail_msg("%s", error.message);
    kiln_threads_destroy(&threads);
    return atlas;
}

static size_t count_files(const char *folder)
{
    DIR *list = opendir(folder);
    size_t count = 0;
    for (struct dirent *entry; list && (entry = readdir(list));)
        count += entry->d_name[0] != '.';
    if (list)
        closedir(list);
    return count;
}

/* Whether the cache, and not the code, gives an atlas its texels: a mark in the cached ones shows
 * in it. */
static bool comes_from_cache(const struct kiln_atlas_request *request)
{
    char name[KILN_FLIPBOOK_NAME_SIZE];
    assert_true(kiln_flipbook_name(name, request, 0));
    uint8_t *texels = kiln_cache_read("cache", name, TEXEL_BYTES);
    if (!texels)
        return false;
    uint8_t *marked = malloc(TEXEL_BYTES);
    memcpy(marked, texels, TEXEL_BYTES);
    marked[TEXEL_BYTES - 1] ^= 0xff;
    kiln_cache_write("cache", name, marked, TEXEL_BYTES);
    struct kiln_atlas atlas = make(request, "cache");
    const bool found = memcmp(atlas.texels, marked, TEXEL_BYTES) == 0;
    kiln_cache_write("cache", name, texels, TEXEL_BYTES);
    kiln_atlas_finish(&atlas);
    free(marked);
    free(texels);
    return found;
}

static void same_atlas(const struct kiln_atlas_request *request)
{
    struct kiln_atlas made = make(request, NULL), first = make(request, "cache");
    struct kiln_atlas again = make(request, "cache");
    const struct kiln_atlas *others[] = {&first, &again};
    for (size_t i = 0; i < 2; i++) {
        assert_memory_equal(others[i]->texels, made.texels, TEXEL_BYTES);
        assert_memory_equal(others[i]->systems, made.systems, sizeof made.systems);
        assert_int_equal(others[i]->moves != NULL, made.moves != NULL);
        if (made.moves)
            assert_memory_equal(others[i]->moves, made.moves, CELLS * KILN_ATLAS_MOVES_BYTES);
    }
    assert_true(comes_from_cache(request));
    kiln_atlas_finish(&made);
    kiln_atlas_finish(&first);
    kiln_atlas_finish(&again);
}

static const char *const puff[] = {"builtin:puff"};
static const struct kiln_atlas_request moving = {puff, 1, 3, 2, "auto", {1.0f, 1.0f}, NULL};

static void builtins_are_kept(void **state)
{
    (void)state;
    const struct kiln_atlas_request still = {puff, 1, 3, 2, "none", {1.0f, 1.0f}, NULL};
    same_atlas(&moving);
    assert_int_equal(count_files("cache"), 2);
    same_atlas(&still);
    assert_int_equal(count_files("cache"), 3);
}

static void what_is_spoiled_is_made_anew(void **state)
{
    (void)state;
    char name[KILN_FLIPBOOK_NAME_SIZE], path[128];
    struct kiln_atlas made = make(&moving, "cache");
    assert_true(kiln_flipbook_name(name, &moving, 0));
    for (size_t i = 0; i < 3; i++) {
        snprintf(path, sizeof path, "cache/%.64s%s", name, i == 1 ? ".motion" : ".cells");
        if (i == 2)
            assert_int_equal(unlink(path), 0);
        else
            assert_int_equal(truncate(path, 1000), 0);
        struct kiln_atlas again = make(&moving, "cache");
        assert_memory_equal(again.texels, made.texels, TEXEL_BYTES);
        assert_memory_equal(again.moves, made.moves, CELLS * KILN_ATLAS_MOVES_BYTES);
        assert_true(comes_from_cache(&moving));
        kiln_atlas_finish(&again);
    }
    kiln_atlas_finish(&made);
}

/* A picture of 6 x 4 pixels; `red` of the first one. */
static void write_picture(const char *path, uint8_t red)
{
    uint8_t pixels[4][6][4];
    memset(pixels, 200, sizeof pixels);
    pixels[0][0][0] = red;
    const struct kiln_frame_layer layer = {sizeof layer,       "display", 0,     6, 4, 4,
                                           KILN_SAMPLES_UINT8, 6 * 4,     pixels};
    struct kiln_error error = {0};
    if (!kiln_layer_write(&layer, path, true, &error))
        fail_msg("%s", error.message);
}

static void files_are_known_by_their_contents(void **state)
{
    (void)state;
    char path[KILN_PATH_SIZE], folder[KILN_PATH_SIZE - 16], first[KILN_FLIPBOOK_NAME_SIZE],
        second[KILN_FLIPBOOK_NAME_SIZE];
    assert_non_null(getcwd(folder, sizeof folder));
    snprintf(path, sizeof path, "%s/a.png", folder);
    const char *const sources[] = {path};
    const struct kiln_atlas_request request = {sources, 1, 3, 2, "none", {1.0f, 1.0f}, NULL};
    write_picture(path, 0);
    same_atlas(&request);
    assert_true(kiln_flipbook_name(first, &request, 0));
    write_picture(path, 255);
    assert_true(kiln_flipbook_name(second, &request, 0));
    assert_string_not_equal(first, second);
    same_atlas(&request);
    write_picture(path, 0);
    assert_true(comes_from_cache(&request));
    assert_int_equal(unlink(path), 0);
    assert_false(kiln_flipbook_name(first, &request, 0));
}

static void names_tell_what_differs(void **state)
{
    (void)state;
    static const char *const others[] = {"builtin:smoke"};
    const struct kiln_atlas_request requests[] = {
        moving,
        {puff, 1, 2, 3, "auto", {1.0f, 1.0f}, NULL},
        {puff, 1, 3, 2, "none", {1.0f, 1.0f}, NULL},
        {puff, 1, 3, 2, "auto", {2.0f, 1.0f}, NULL},
        {puff, 1, 3, 2, "auto", {1.0f, 2.0f}, NULL},
        {others, 1, 3, 2, "auto", {1.0f, 1.0f}, NULL},
    };
    enum { COUNT = sizeof requests / sizeof *requests };
    char names[COUNT][KILN_FLIPBOOK_NAME_SIZE];
    for (size_t i = 0; i < COUNT; i++) {
        assert_true(kiln_flipbook_name(names[i], &requests[i], 0));
        for (size_t k = 0; k < i; k++)
            assert_string_not_equal(names[i], names[k]);
    }
}

/* binutils finds the same identifier in the file of this program. */
static void builds_have_an_identifier(void **state)
{
    (void)state;
    char id[KILN_BUILD_ID_SIZE], line[256], found[KILN_BUILD_ID_SIZE] = "";
    assert_true(kiln_build_id(id));
    char program[KILN_PATH_SIZE], command[KILN_PATH_SIZE + 32];
    const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    assert_true(length > 0);
    program[length] = '\0';
    snprintf(command, sizeof command, "readelf -n '%s'", program);
    FILE *notes = popen(command, "r"); /* NOLINT(cert-env33-c): of this program's path */
    assert_non_null(notes);
    while (fgets(line, sizeof line, notes))
        sscanf(line, " Build ID: %64[0-9a-f]", found);
    assert_int_equal(pclose(notes), 0);
    assert_string_equal(id, found);
}

int main(void)
{
#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, test_enter_folder, test_leave_folder)
    static const struct CMUnitTest tests[] = {
        IN_FOLDER(builtins_are_kept),
        IN_FOLDER(what_is_spoiled_is_made_anew),
        IN_FOLDER(files_are_known_by_their_contents),
        cmocka_unit_test(names_tell_what_differs),
        cmocka_unit_test(builds_have_an_identifier),
    };
    return cmocka_run_group_tests_name("flipbook_cache", tests, NULL, NULL);
}
