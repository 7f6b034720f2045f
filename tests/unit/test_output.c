/* What every output format shares: names of files, refusals, whole files or none, bounded memory.
 */
#include <dirent.h>
#include <errno.h>
#include <signal.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include "base/pattern.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/pictures.h"

static const char *const suffixes[] = {".png", ".jpg", ".exr", ".mp4"};
enum { SUFFIX_COUNT = sizeof suffixes / sizeof *suffixes };

/* ---- Names -------------------------------------------------------------------------------- */

static void names_are_numbered(void **state)
{
    (void)state;
    static const struct {
        const char *path;
        enum kiln_numbering numbering;
        uint32_t frame;
        const char *expected;
    } cases[] = {
        {"beam.png", KILN_NUMBER_IF_ASKED, 7, "beam.png"},
        {"beam.png", KILN_NUMBER_ALWAYS, 7, "beam_0007.png"},
        {"a.b/beam.v2.png", KILN_NUMBER_ALWAYS, 12345, "a.b/beam.v2_12345.png"},
        {"out/f_###.png", KILN_NUMBER_ALWAYS, 7, "out/f_007.png"},
        {"out/f_###.png", KILN_NUMBER_IF_ASKED, 4294967295u, "out/f_4294967295.png"},
        {"f#.png", KILN_NUMBER_ALWAYS, 10, "f10.png"},
        {"f%d.png", KILN_NUMBER_ALWAYS, 10, "f10.png"},
        {"f%05d_x.png", KILN_NUMBER_ALWAYS, 10, "f00010_x.png"},
        {"f%3d.png", KILN_NUMBER_ALWAYS, 10, "f010.png"},
        {"100%%_%02d.png", KILN_NUMBER_ALWAYS, 3, "100%_03.png"},
        {"50%/f#.png", KILN_NUMBER_ALWAYS, 3, "50%/f3.png"},
        {"50%%.png", KILN_NUMBER_NEVER, 3, "50%.png"},
        {"take%#2_#%#.png", KILN_NUMBER_ALWAYS, 3, "take#2_3#.png"},
        {"50%/take#2/a.png", KILN_NUMBER_NEVER, 3, "50%/take#2/a.png"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct kiln_path_pattern pattern;
        struct kiln_error error = {0};
        char path[64];
        assert_true(kiln_path_pattern_parse(&pattern, cases[i].path, cases[i].numbering, &error));
        assert_true(kiln_path_pattern_format(&pattern, cases[i].frame, path, sizeof path));
        assert_string_equal(path, cases[i].expected);
        assert_false(
            kiln_path_pattern_format(&pattern, cases[i].frame, path, strlen(cases[i].expected)));
    }
}

static void bad_names_are_refused(void **state)
{
    (void)state;
#define REFUSED                                                                                    \
    " in the file name is not allowed; write %d, %04d or #### for the number of the frame, %% "    \
    "for "                                                                                         \
    "a percent sign, and %# for a hash"
#define TWICE  "the file name has two frame numbers"
#define WIDE   "the frame number is too wide; allowed are 1 to 9 digits"
#define FOLDER "the name of a folder has a frame number (## or %d); only the file name may have one"
    static const struct {
        const char *path, *message;
    } bad[] = {
        {"%s.png", "'%s.'" REFUSED},
        {"%n.png", "'%n.'" REFUSED},
        {"f%.png", "'%.p'" REFUSED},
        {"f%x.png", "'%x.'" REFUSED},
        {"%d_%d.png", TWICE},
        {"##_#.png", TWICE},
        {"f#_%d.png", TWICE},
        {"%-4d.png", "'%-4'" REFUSED},
        {"%4.2d.png", "'%4.'" REFUSED},
        {"%ld.png", "'%ld'" REFUSED},
        {"%0d%.png", "'%.p'" REFUSED},
        {"%10d.png", WIDE},
        {"%1000d.png", "'%10'" REFUSED},
        {"% d.png", "'% d'" REFUSED},
        {"out_##/f.png", FOLDER},
        {"out_%04d/f.png", FOLDER},
        {"f%$d.png", "'%$d'" REFUSED},
        {"f%1$d.png", "'%1$'" REFUSED},
        {"##########.png", WIDE},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct kiln_path_pattern pattern;
        struct kiln_error error = {0};
        assert_false(kiln_path_pattern_parse(&pattern, bad[i].path, KILN_NUMBER_ALWAYS, &error));
        expect_error(&error, KILN_USAGE, "%s: %s", bad[i].path, bad[i].message);
    }
    char name[KILN_PATH_SIZE + 8];
    struct kiln_path_pattern pattern;
    struct kiln_error error = {0};
    memset(name, 'x', sizeof name);
    memcpy(name + 252, ".png", 5);
    assert_false(kiln_path_pattern_parse(&pattern, name, KILN_NUMBER_ALWAYS, &error));
    expect_error(&error, KILN_USAGE,
                 "%.200s...: the path is too long; allowed are "
                 "4090 bytes, and 250 for the file name",
                 name);
    assert_false(kiln_path_pattern_parse(&pattern, "f#.mp4", KILN_NUMBER_NEVER, &error));
    expect_error(&error, KILN_USAGE,
                 "f#.mp4: a video or flipbook is one file, so its name cannot have a frame number");
}

static void suffixes_are_looked_up(void **state)
{
#define SUFFIXES ".png, .jpg, .exr, .mp4, .webm, .mkv, .mov, .gif, .apng, .webp"
#define NEEDED   "the output needs a file name with a suffix that names its format: "
    (void)state;
    static const struct {
        const char *path, *message;
    } cases[] = {
        {"", "'': " NEEDED SUFFIXES},
        {"out/", "out/: " NEEDED SUFFIXES},
        {"out/.png", "out/.png: " NEEDED SUFFIXES},
        {"out.d/beam", "out.d/beam: " NEEDED SUFFIXES},
        {"beam.pgn",
         "beam.pgn: unknown output format '.pgn' (did you mean '.png'?); allowed are " SUFFIXES},
        {"beam.jxl",
         "beam.jxl: unknown output format '.jxl' (did you mean '.jpg'?); allowed are " SUFFIXES},
    };
    const struct kiln_frame_range range = {0, 3};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct kiln_output_params params = test_output_params(cases[i].path, &range);
        struct kiln_error error = {0};
        assert_null(kiln_output_open(&params, &error));
        expect_error(&error, KILN_USAGE, "%s", cases[i].message);
    }
    char *text = NULL;
    size_t size = 0;
    FILE *memory = open_memstream(&text, &size);
    assert_true(kiln_write_outputs(memory));
    fclose(memory);
    for (size_t i = 0; i < SUFFIX_COUNT; i++)
        assert_non_null(strstr(text, suffixes[i]));
    free(text);
}

/* ---- Refusals before the first frame ------------------------------------------------------ */

static void existing_files_are_kept(void **state)
{
    (void)state;
    const struct kiln_frame_range ranges[] = {{0, 1}, {5, 6}};
    char folder[32], path[64], last[64];
    test_make_folder(folder);
    snprintf(path, sizeof path, "%s/x.png", folder);
    snprintf(last, sizeof last, "%s/x_0006.png", folder);
    struct kiln_output_params params = test_output_params(path, ranges);
    params.range_count = 2;
    FILE *file = fopen(last, "w");
    assert_non_null(file);
    fputs("mine", file);
    fclose(file);

    struct kiln_error error = {0};
    assert_false(test_write_all(&params, &error));
    expect_error(&error, KILN_USAGE, "%s: the file exists (--force replaces it)", last);
    assert_int_equal(test_count_files(folder), 1);

    params.overwrite = true;
    assert_true(test_write_all(&params, &error));
    assert_int_equal(test_count_files(folder), 4);
    struct stat status;
    assert_int_equal(stat(last, &status), 0);
    assert_true(status.st_size > 4);

    /* A folder in the way is no file that could be replaced. */
    unlink(last);
    assert_int_equal(mkdir(last, 0777), 0);
    assert_false(test_write_all(&params, &error));
    expect_error(&error, KILN_USAGE, "%s: a folder has this name", last);
    test_remove_folder(folder);
}

/* An output of a format in a folder of its own. */
struct opened {
    char folder[32], path[64];
    struct kiln_output_params params;
    struct kiln_output *output;
};

static void open_in_folder(struct opened *opened, const char *suffix,
                           const struct kiln_frame_range *range)
{
    struct kiln_error error = {0};
    test_make_folder(opened->folder);
    snprintf(opened->path, sizeof opened->path, "%s/x%s", opened->folder, suffix);
    opened->params = test_output_params(opened->path, range);
    opened->output = kiln_output_open(&opened->params, &error);
    assert_non_null(opened->output);
}

static bool write_frame(struct opened *opened, uint32_t frame, struct kiln_error *error)
{
    return kiln_output_write(opened->output, test_picture(opened->output, &opened->params, frame),
                             error);
}

static void close_in_folder(struct opened *opened)
{
    kiln_output_close(&opened->output);
    assert_null(opened->output);
    test_remove_folder(opened->folder);
}

/* A file that appears between the check and the rename is not replaced either. */
static void late_files_are_kept(void **state)
{
    (void)state;
    const struct kiln_frame_range range = {3, 3};
    for (size_t i = 0; i < SUFFIX_COUNT; i++) {
        struct opened opened;
        struct kiln_error error = {0};
        open_in_folder(&opened, suffixes[i], &range);
        fclose(fopen(opened.path, "w"));
        assert_true(write_frame(&opened, 3, &error));
        assert_false(kiln_output_finish(opened.output, &error));
        expect_error(&error, KILN_USAGE, "%s: the file exists (--force replaces it)", opened.path);
        assert_int_equal(test_count_files(opened.folder), 1);
        struct stat status;
        assert_int_equal(stat(opened.path, &status), 0);
        assert_int_equal(status.st_size, 0);
        close_in_folder(&opened);
    }
}

static void folders_are_made(void **state)
{
    (void)state;
    const struct kiln_frame_range range = {0, 0};
    char folder[32], path[64];
    test_make_folder(folder);
    snprintf(path, sizeof path, "%s/a//b/c.d/x.png", folder);
    struct kiln_output_params params = test_output_params(path, &range);
    struct kiln_error error = {0};
    assert_true(test_write_all(&params, &error));
    assert_int_equal(access(path, R_OK), 0);

    snprintf(path, sizeof path, "%s/a/b/c.d/x.png/y.png", folder);
    assert_false(test_write_all(&params, &error));
    expect_error(&error, KILN_USAGE,
                 "%s/a/b/c.d/x.png: the path is not a folder, but %s needs a folder here", folder,
                 path);
    test_remove_folder(folder);

    params.path = "/proc/kiln/x.png";
    assert_false(test_write_all(&params, &error));
    expect_error(&error, KILN_IO,
                 "/proc/kiln: the folder cannot be made: No such file or directory");
}

static void ranges_must_ascend(void **state)
{
    (void)state;
    static const struct kiln_frame_range bad[][2] = {
        {{5, 4}, {6, 6}}, {{0, 4}, {4, 6}}, {{7, 8}, {1, 2}}};
    static const char *const named[] = {"5-4", "4-6", "1-2"};
    struct kiln_error error = {0};
    for (size_t i = 0; i < 3; i++) {
        struct kiln_output_params params = test_output_params("x.png", bad[i]);
        params.range_count = 2;
        assert_null(kiln_output_open(&params, &error));
        expect_error(&error, KILN_USAGE, "x.png: frames %s are not in ascending order", named[i]);
    }
    struct kiln_output_params params = test_output_params("x.png", bad[0]);
    params.range_count = 0;
    assert_null(kiln_output_open(&params, &error));
    expect_error(&error, KILN_USAGE, "x.png: there are no frames to write");
}

/* ---- Failures on the way: run in a child, since they change the process ---------------------- */

/* Runs body in a child and expects that it returns true. */
static void in_child(bool (*body)(const char *path), const char *path)
{
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0)
        _exit(body(path) ? 0 : 1);
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 0);
}

static struct kiln_output_params large_params(const char *path,
                                              const struct kiln_frame_range *range)
{
    struct kiln_output_params params = test_output_params(path, range);
    params.width = 320;
    params.height = 180;
    return params;
}

/* Returns the length of a path without its suffix. In errors, a frame's number follows it, and
 * which frame fails first is up to threads. */
static int stem(const char *path)
{
    return (int)(strrchr(path, '.') - path);
}

/* Stands for a full disk: writes beyond the limit fail. */
static bool disk_is_full(const char *path)
{
    const struct kiln_frame_range range = {0, 19};
    struct kiln_output_params params = large_params(path, &range);
    struct rlimit limit = {700, 700};
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &limit);
    struct kiln_error error = {0};
    return !test_write_all(&params, &error) &&
           is_error_around(&error, KILN_IO, ": the file cannot be written: File too large", "%.*s",
                           stem(path), path);
}

static bool folder_is_read_only(const char *path)
{
    const struct kiln_frame_range range = {0, 19};
    struct kiln_output_params params = large_params(path, &range);
    char folder[64];
    snprintf(folder, sizeof folder, "%.*s", (int)(strrchr(path, '/') - path), path);
    if (chmod(folder, 0555) != 0 || (geteuid() == 0 && setuid(65534) != 0))
        return false;
    struct kiln_error error = {0};
    return !test_write_all(&params, &error) &&
           is_error_around(&error, KILN_IO, ": the file cannot be created: Permission denied",
                           "%.*s", stem(path), path);
}

static bool process_is_stopped(const char *path)
{
    const struct kiln_frame_range range = {0, 199};
    struct kiln_output_params params = large_params(path, &range);
    struct kiln_error error = {0};
    struct kiln_output *output = kiln_output_open(&params, &error);
    for (uint32_t frame = 0; output && frame < 5; frame++) {
        if (!kiln_output_write(output, test_picture(output, &params, frame), &error))
            return false;
    }
    kiln_abandon_outputs();
    _exit(output ? 0 : 1);
}

/* Of an image sequence whole frames may stay, and nothing hidden; of a video nothing. */
static void check_only_whole_files(const char *folder, const char *suffix)
{
    DIR *entries = opendir(folder);
    assert_non_null(entries);
    for (struct dirent *entry = readdir(entries); entry; entry = readdir(entries)) {
        if (entry->d_name[0] == '.' && strlen(entry->d_name) < 3)
            continue;
        assert_true(entry->d_name[0] == 'x');
        assert_string_equal(entry->d_name + strlen(entry->d_name) - strlen(suffix), suffix);
        assert_string_not_equal(suffix, ".mp4");
    }
    closedir(entries);
}

static void failures_leave_nothing(void **state)
{
    (void)state;
    static bool (*const bodies[])(const char *) = {disk_is_full, folder_is_read_only,
                                                   process_is_stopped};
    for (size_t i = 0; i < SUFFIX_COUNT; i++) {
        for (size_t b = 0; b < 3; b++) {
            char folder[32], path[64];
            test_make_folder(folder);
            snprintf(path, sizeof path, "%s/x%s", folder, suffixes[i]);
            in_child(bodies[b], path);
            check_only_whole_files(folder, suffixes[i]);
            if (bodies[b] != process_is_stopped)
                assert_int_equal(test_count_files(folder), 0);
            test_remove_folder(folder);
        }
    }
}

static void closing_early_keeps_whole_images(void **state)
{
    (void)state;
    const struct kiln_frame_range range = {0, 19};
    for (size_t i = 0; i < SUFFIX_COUNT; i++) {
        struct opened opened;
        struct kiln_error error = {0};
        open_in_folder(&opened, suffixes[i], &range);
        for (uint32_t frame = 0; frame < 3; frame++)
            assert_true(write_frame(&opened, frame, &error));
        kiln_output_close(&opened.output);
        assert_int_equal(test_count_files(opened.folder), strcmp(suffixes[i], ".mp4") == 0 ? 0 : 3);
        close_in_folder(&opened);
    }
}

static void pictures_must_be_as_announced(void **state)
{
    (void)state;
    const struct kiln_frame_range range = {4, 6};
    for (size_t i = 0; i < SUFFIX_COUNT; i++) {
        struct opened opened;
        struct kiln_error error = {0};
        open_in_folder(&opened, suffixes[i], &range);
        assert_false(write_frame(&opened, 5, &error));
        expect_error(&error, KILN_USAGE, "%s: frame 5 came where frame 4 was expected",
                     opened.path);
        struct kiln_output_params other = opened.params;
        other.width = 32;
        assert_false(
            kiln_output_write(opened.output, test_picture(opened.output, &other, 4), &error));
        assert_true(write_frame(&opened, 4, &error));
        assert_false(kiln_output_finish(opened.output, &error));
        expect_error(&error, KILN_USAGE, "%s: frame 5 was never given", opened.path);
        close_in_folder(&opened);
    }
}

/* ---- Memory ------------------------------------------------------------------------------- */

static long peak_kib(const char *path, uint32_t frames)
{
    const struct kiln_frame_range range = {0, frames - 1};
    struct kiln_output_params params = test_output_params(path, &range);
    params.width = 160;
    params.height = 90;
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        struct kiln_error error = {0};
        _exit(test_write_all(&params, &error) ? 0 : 1);
    }
    int status = 0;
    struct rusage usage;
    assert_int_equal(wait4(child, &status, 0, &usage), child);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    return usage.ru_maxrss;
}

static void memory_does_not_grow_with_frames(void **state)
{
    (void)state;
#ifdef __SANITIZE_ADDRESS__
    skip(); /* the sanitizer holds back what is freed */
#endif
    for (size_t i = 0; i < SUFFIX_COUNT; i++) {
        char folder[32], few[64], many[64];
        test_make_folder(folder);
        snprintf(few, sizeof few, "%s/few%s", folder, suffixes[i]);
        snprintf(many, sizeof many, "%s/many%s", folder, suffixes[i]);
        /* x264 holds back about 50 pictures, so the shorter video must be longer than that. */
        long peak_few = peak_kib(few, 90), peak_many = peak_kib(many, 360);
        print_message("%s: peak %ld KiB with 90 frames, %ld KiB with 360\n", suffixes[i], peak_few,
                      peak_many);
        /* 270 pictures take 15 MiB and more; how many threads were busy at once is up to chance. */
        assert_true(peak_many - peak_few < 6 * 1024);
        test_remove_folder(folder);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_are_numbered),
        cmocka_unit_test(bad_names_are_refused),
        cmocka_unit_test(suffixes_are_looked_up),
        cmocka_unit_test(existing_files_are_kept),
        cmocka_unit_test(late_files_are_kept),
        cmocka_unit_test(folders_are_made),
        cmocka_unit_test(ranges_must_ascend),
        cmocka_unit_test(failures_leave_nothing),
        cmocka_unit_test(closing_early_keeps_whole_images),
        cmocka_unit_test(pictures_must_be_as_announced),
        cmocka_unit_test(memory_does_not_grow_with_frames),
    };
    return cmocka_run_group_tests_name("output", tests, NULL, NULL);
}
