/* lib/base/ffmpeg.c: clips have the same bytes, whatever the locale of the program that uses the
 * library. */
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/cmocka.h"
#include "support/folders.h"
#include "support/pictures.h"

static const char *const names[] = {"clip.mp4", "clip.webm", "clip.mkv", "clip.gif", "clip.webp"};

enum { NAMES = sizeof names / sizeof *names };

struct bytes {
    unsigned char *data;
    size_t size;
};

static struct bytes write_clip(const char *folder, const char *name)
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    const struct kiln_frame_range range = {0, 3};
    struct kiln_output_params params = test_output_params(path, &range);
    params.overwrite = true;
    params.fps_num = 30000;
    params.fps_den = 1001;
    struct kiln_error error = {0};
    assert_true(test_write_all(&params, &error));
    struct bytes bytes = {malloc(1 << 20), 0};
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    bytes.size = fread(bytes.data, 1, 1 << 20, file);
    fclose(file);
    return bytes;
}

/* Makes a locale whose decimal point is a comma, and chooses it. */
static void speak_german(const char *folder)
{
    char command[256];
    snprintf(command, sizeof command, "localedef -i de_DE -f UTF-8 %s/de_DE.UTF-8 >/dev/null 2>&1",
             folder);
    const int code = system(command); /* NOLINT(cert-env33-c): a name of ours */
    assert_int_equal(code, 0);
    setenv("LOCPATH", folder, 1);
    assert_non_null(setlocale(LC_ALL, "de_DE.UTF-8"));
    assert_string_equal(localeconv()->decimal_point, ",");
}

static void clips_do_not_depend_on_the_locale(void **state)
{
    (void)state;
    char folder[32];
    struct bytes before[NAMES];
    test_make_folder(folder);
    for (size_t i = 0; i < NAMES; i++)
        before[i] = write_clip(folder, names[i]);
    speak_german(folder);
    for (size_t i = 0; i < NAMES; i++) {
        struct bytes after = write_clip(folder, names[i]);
        if (after.size != before[i].size || memcmp(after.data, before[i].data, after.size) != 0)
            fail_msg("%s has other bytes in the locale de_DE", names[i]);
        assert_string_equal(localeconv()->decimal_point, ",");
        free(after.data);
        free(before[i].data);
    }
    test_remove_folder(folder);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(clips_do_not_depend_on_the_locale),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
