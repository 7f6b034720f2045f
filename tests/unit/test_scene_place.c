/* lib/scene/place.c: a scene whose path enters the asset root is read below the root, whatever
 * links are there and while they are swapped. If this fails, a stranger who may write in the root
 * gets any file of the machine read. A path that does not enter the root is the operator's and is
 * followed. */
#include <pthread.h>
#include <stdatomic.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/clock.h"
#include "kiln_program.h"
#include "scene/scene.h"
#include "support/cmocka.h"
#include "support/folders.h"
#include "support/parts.h"

enum { INSIDE = 7, OUTSIDE = 7777 };

static void write_scene(const char *path, int frames)
{
    char text[128];
    snprintf(text, sizeof text,
             "kiln: 1\noutput: {size: [16, 16], frames: %d}\n"
             "systems: {a: {emit: {rate: 9, life: 1 s}}}\n",
             frames);
    test_write_file(path, text);
}

static int set_up(void **state)
{
    test_enter_folder(state);
    write_scene("root/s.yaml", INSIDE);
    write_scene("root/good.yaml", INSIDE);
    write_scene("root/real/s.yaml", INSIDE);
    write_scene("secret/s.yaml", OUTSIDE);
    write_scene("own.yaml", INSIDE);
    return symlink("../secret/s.yaml", "root/out.yaml") != 0 ||
           symlink("s.yaml", "root/in.yaml") != 0 || symlink("../secret", "root/away") != 0 ||
           symlink("real", "root/near") != 0 || symlink("../root/near", "secret/back") != 0 ||
           symlink("own.yaml", "linked.yaml") != 0 || symlink("root/real", "shortcut") != 0 ||
           symlink("root", "entry") != 0 || symlink("root/away", "detour") != 0 ||
           symlink("loop", "loop") != 0 || symlink("root/in.yaml", "into.yaml") != 0 ||
           symlink("root/out.yaml", "through.yaml") != 0 ||
           symlink("/proc/self/cwd/../secret/s.yaml", "root/magic.yaml") != 0 ||
           mkfifo("root/fifo.yaml", 0600) != 0;
}

/* Returns the frames of the scene at a path; 0 if it is refused. */
static uint32_t frames_of(const char *path, const char *root, struct kiln_error *error)
{
    struct kiln_scene_params params = kiln_scene_defaults();
    params.asset_root = root;
    struct kiln_scene *scene = kiln_scene_load(path, &params, error);
    const uint32_t frames = scene ? scene->frames : 0;
    kiln_scene_destroy(&scene);
    return frames;
}

static void expect_frames(const char *path, const char *root, uint32_t frames, bool is_below)
{
    struct kiln_error error = {0};
    const uint32_t found = frames_of(path, root, &error);
    if (found != frames)
        fail_msg("%s in %s: %u frames, not %u: %s", path, root ? root : "no root", found, frames,
                 error.message);
    if (root && kiln_scene_is_below(path, root) != is_below)
        fail_msg("%s in %s: %s", path, root, is_below ? "not below" : "below");
}

static void paths_that_enter_the_root(void **state)
{
    char here[KILN_PATH_SIZE - 32], path[KILN_PATH_SIZE];
    (void)state;
    assert_non_null(getcwd(here, sizeof here));
    expect_frames("root/s.yaml", "root", INSIDE, true);
    expect_frames("root/in.yaml", "root", INSIDE, true);
    expect_frames("root/near/s.yaml", "root", INSIDE, true);
    expect_frames("root/real/../s.yaml", "root", INSIDE, true);
    expect_frames("./root//real/./s.yaml", "./root/", INSIDE, true);
    expect_frames("shortcut/s.yaml", "root", INSIDE, true);
    expect_frames("entry/near/s.yaml", "root", INSIDE, true);
    expect_frames("into.yaml", "root", INSIDE, true);
    expect_frames("root/s.yaml", "entry", INSIDE, true);
    expect_frames("root/real/s.yaml", "root/real", INSIDE, true);
    snprintf(path, sizeof path, "%s/root/near/s.yaml", here);
    expect_frames(path, "root", INSIDE, true);
    expect_frames(path, "/", INSIDE, true);
    assert_int_equal(chdir("root/real"), 0);
    expect_frames("s.yaml", "..", INSIDE, true);
    expect_frames("../s.yaml", "..", INSIDE, true);
    expect_frames("../../root/s.yaml", "..", INSIDE, true);
    assert_int_equal(chdir("../.."), 0);
}

static void paths_that_lead_out(void **state)
{
    struct kiln_error error = {0};
    (void)state;
    expect_frames("root/out.yaml", "root", 0, true);
    expect_frames("root/magic.yaml", "root", 0, true);
    expect_frames("root/away/s.yaml", "root", 0, true);
    expect_frames("root/away/back/s.yaml", "root", 0, true);
    expect_frames("root/real/../../secret/s.yaml", "root", 0, true);
    expect_frames("entry/out.yaml", "root", 0, true);
    expect_frames("detour/s.yaml", "root", 0, true);
    expect_frames("through.yaml", "root", 0, true);
    expect_frames("loop/s.yaml", "root", 0, false);
    expect_frames("shortcut/../out.yaml", "root", 0, true);
    expect_frames("root/fifo.yaml", "root", 0, true);
    expect_frames("root/real", "root", 0, true);
    expect_frames("missing/s.yaml", "root", 0, false);
    expect_frames("root/missing/s.yaml", "root", 0, true);
    assert_int_equal(frames_of("root/away/s.yaml", "root", &error), 0);
    assert_string_equal(error.message, "root/away/s.yaml: the scene leads outside the asset root");
    assert_int_equal(error.code, KILN_INVALID_INPUT);
}

static void paths_of_the_operator(void **state)
{
    (void)state;
    expect_frames("own.yaml", "root", INSIDE, false);
    expect_frames("linked.yaml", "root", INSIDE, false);
    expect_frames("root/../own.yaml", "root", INSIDE, false);
    expect_frames("secret/s.yaml", "root", OUTSIDE, false);
    expect_frames("root/out.yaml", NULL, OUTSIDE, false); /* no root was given */
    assert_int_equal(chdir("root/real"), 0);
    expect_frames("../../own.yaml", "..", INSIDE, false);
    assert_int_equal(chdir("../.."), 0);
}

/* The file that was read is claimed, and not that which has its name by now. */
static void what_was_read_is_claimed(void **state)
{
    struct kiln_error error = {0};
    struct kiln_scene_params params = kiln_scene_defaults();
    (void)state;
    params.asset_root = "root";
    struct kiln_scene *scene = kiln_scene_load("root/s.yaml", &params, &error);
    struct kiln_claims *claims = kiln_claims_create();
    assert_true(scene && claims);
    assert_int_equal(rename("root/s.yaml", "root/moved.yaml"), 0);
    write_scene("root/s.yaml", INSIDE);
    assert_true(kiln_scene_claim(scene, claims, &error));
    assert_false(kiln_claims_write(claims, "root/moved.yaml", "--output", &error));
    assert_int_equal(error.code, KILN_USAGE);
    kiln_claims_destroy(&claims);
    kiln_scene_destroy(&scene);
}

/* ---- swapping -------------------------------------------------------------------------------- */

static atomic_bool is_over;

static void put(int linked, const char *from, const char *path)
{
    assert_true(linked == 0);
    assert_int_equal(rename(from, path), 0);
}

static void *swap(void *user)
{
    while (!atomic_load(&is_over)) {
        put(link("root/good.yaml", "root/next"), "root/next", "root/s.yaml");
        put(symlink("real", "root/next"), "root/next", "root/deep");
        put(symlink("../secret/s.yaml", "root/next"), "root/next", "root/s.yaml");
        put(symlink("../secret", "root/next"), "root/next", "root/deep");
    }
    return user;
}

static void nothing_outside_is_read_while_it_is_swapped(void **state)
{
    pthread_t thread;
    const double end_s = kiln_clock_seconds() + (test_is_full() ? 60.0 : 1.5);
    unsigned loads = 0, inside = 0, outside = 0;
    (void)state;
    atomic_store(&is_over, false);
    assert_int_equal(symlink("real", "root/deep"), 0);
    assert_int_equal(pthread_create(&thread, NULL, swap, NULL), 0);
    while (kiln_clock_seconds() < end_s) {
        struct kiln_error error = {0};
        const uint32_t frames =
            frames_of(loads++ % 2 ? "root/s.yaml" : "root/deep/s.yaml", "root", &error);
        inside += frames == INSIDE;
        outside += frames == OUTSIDE;
    }
    atomic_store(&is_over, true);
    assert_int_equal(pthread_join(thread, NULL), 0);
    print_message("%u loads, %u of the scene inside\n", loads, inside);
    assert_int_equal(outside, 0);
    assert_true(inside > 0);
}

#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, set_up, test_leave_folder)

int main(void)
{
    const struct CMUnitTest tests[] = {
        IN_FOLDER(paths_that_enter_the_root),
        IN_FOLDER(paths_that_lead_out),
        IN_FOLDER(paths_of_the_operator),
        IN_FOLDER(what_was_read_is_claimed),
        IN_FOLDER(nothing_outside_is_read_while_it_is_swapped),
    };
    return cmocka_run_group_tests_name("scene_place", tests, NULL, NULL);
}
