/* Checks the cache of built programs (lib/gpu/program_cache.h). If this fails, programs are
 * compiled anew in each run, a program is taken for another one, or a driver gets a file that it
 * did not write or that another user could have written. */
#include <dirent.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/cache.h"
#include "gpu/buffer.h"
#include "gpu/program.h"
#include "gpu/program_cache.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/folders.h"

#define FOLDER "cache/kiln-programs"

/* Each test has a folder of its own, with a kernel and an empty cache. */
static int set_up(void **state)
{
    char path[256], folder[512];
    GLint formats = 0;
    glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &formats);
    test_enter_folder(state);
    test_write_file("main.comp", "layout(local_size_x = 1) in;\n"
                                 "layout(std430, binding = 0) buffer Out { uint value; };\n"
                                 "void main() { value = ANSWER; }\n");
    assert_non_null(getcwd(path, sizeof path));
    assert_int_equal(setenv("KILN_SHADER_DIR", path, 1), 0);
    snprintf(folder, sizeof folder, "%s/cache", path);
    assert_int_equal(setenv("XDG_CACHE_HOME", folder, 1), 0);
    test_device()->programs = (struct kiln_program_counts){0};
    if (formats == 0)
        fprintf(stderr, "the driver gives no binaries of programs\n");
    return 0;
}

static bool gives_binaries(void)
{
    struct kiln_program_key key = {.debug = true};
    return kiln_program_cache_ask_driver(&key, test_device());
}

static GLuint create_of(const struct kiln_program_params *params)
{
    struct kiln_error error = {0};
    const GLuint program = kiln_program_create(test_device(), params, &error);
    assert_string_equal(error.message, "");
    assert_true(program != 0);
    return program;
}

/* Creates the kernel, which must write an answer. */
static void create(const char *defines, GLuint answer)
{
    struct kiln_error error = {0};
    const GLuint program =
        create_of(&(struct kiln_program_params){.compute = "main.comp", .defines = defines});
    struct kiln_buffer buffer;
    kiln_buffer_init(&buffer, test_device(), sizeof answer, "answer");
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, kiln_buffer_gl(&buffer, KILN_READ_WRITE, &error));
    glUseProgram(program);
    kiln_device_dispatch(test_device(), 1, 1);
    const GLuint *value = kiln_buffer_host(&buffer, KILN_READ, &error);
    assert_non_null(value);
    assert_int_equal(*value, answer);
    kiln_buffer_finish(&buffer);
    glDeleteProgram(program);
    assert_true(kiln_device_check(test_device(), "a program", &error));
}

static void create_42(void)
{
    create("#define ANSWER 42u", 42);
}

static void expect_counts(uint32_t built, uint32_t loaded)
{
    assert_int_equal(test_device()->programs.built, built);
    assert_int_equal(test_device()->programs.loaded, loaded);
}

/* Finds the files of the cache, in no order, and returns how many there are. */
static size_t list(char names[][256], size_t most)
{
    DIR *folder = opendir(FOLDER);
    size_t count = 0;
    for (const struct dirent *entry; folder && (entry = readdir(folder));) {
        if (entry->d_name[0] == '.')
            continue;
        assert_true(count < most);
        snprintf(names[count++], 256, "%s", entry->d_name);
    }
    if (folder)
        closedir(folder);
    return count;
}

static void a_second_program_comes_from_the_cache(void **state)
{
    (void)state;
    char names[2][256];
    struct stat status;
    if (!gives_binaries())
        skip();
    create_42();
    expect_counts(1, 0);
    assert_int_equal(list(names, 2), 1);
    assert_int_equal(stat(FOLDER, &status), 0);
    assert_int_equal(status.st_mode & 0777, 0700);
    create_42();
    create_42();
    expect_counts(1, 2);
    assert_int_equal(list(names, 2), 1);
}

/* A program that is loaded captures the outputs that it was built with. */
static void captured_outputs_come_along(void **state)
{
    (void)state;
    static const char *const one[] = {"first"}, *const both[] = {"first", "second"};
    if (!gives_binaries())
        skip();
    test_write_file("main.vert", "out vec4 first, second;\n"
                                 "void main() { first = second = vec4(gl_VertexID); }\n");
    struct kiln_program_params params = {
        .vertex = "main.vert", .captured = both, .captured_count = 2};
    for (uint32_t turn = 0; turn < 2; turn++) {
        const GLuint program = create_of(&params);
        GLint count = 0;
        glGetProgramiv(program, GL_TRANSFORM_FEEDBACK_VARYINGS, &count);
        assert_int_equal(count, 2);
        glDeleteProgram(program);
        expect_counts(1, turn);
    }
    params.captured = one;
    params.captured_count = 1;
    glDeleteProgram(create_of(&params));
    expect_counts(2, 1);
}

static void another_text_is_another_program(void **state)
{
    (void)state;
    char names[4][256];
    if (!gives_binaries())
        skip();
    create_42();
    create("#define ANSWER 43u", 43);
    test_write_file("part.h", "const uint part = 44u;\n");
    test_write_file("main.comp", "#include \"part.h\"\nlayout(local_size_x = 1) in;\n"
                                 "layout(std430, binding = 0) buffer Out { uint value; };\n"
                                 "void main() { value = part; }\n");
    create(NULL, 44);
    test_write_file("part.h", "const uint part = 45u;\n");
    create(NULL, 45);
    expect_counts(4, 0);
    assert_int_equal(list(names, 4), 4);
}

/* Each part of a key makes another name. */
static void names_have_the_whole_key(void **state)
{
    (void)state;
    static const struct kiln_program_stage stage = {GL_COMPUTE_SHADER, "a"},
                                           other_kind = {GL_VERTEX_SHADER, "a"},
                                           other_text = {GL_COMPUTE_SHADER, "b"},
                                           two[] = {{GL_VERTEX_SHADER, "a"},
                                                    {GL_FRAGMENT_SHADER, "b"}};
    static const char *const captured[] = {"x", "y"};
    const struct kiln_program_key key = {"v", "r", "4.5", "4.50", false, &stage, 1, NULL, 0};
    struct kiln_program_key keys[12];
    char names[12][KILN_PROGRAM_NAME_SIZE];
    for (size_t i = 0; i < 12; i++)
        keys[i] = key;
    keys[1].vendor = "w";
    keys[2].renderer = "s";
    keys[3].version = "4.6";
    keys[4].language = "4.60";
    keys[5].debug = true;
    keys[6].stages = &other_kind;
    keys[7].stages = &other_text;
    keys[8].stages = two;
    keys[9].stages = two;
    keys[9].stage_count = 2;
    keys[10].captured = keys[11].captured = captured;
    keys[10].captured_count = 1;
    keys[11].captured_count = 2;
    keys[8].stages = two + 1;
    for (size_t i = 0; i < 12; i++) {
        assert_true(kiln_program_cache_name(names[i], &keys[i]));
        for (size_t j = 0; j < i; j++)
            assert_string_not_equal(names[i], names[j]);
    }
    char again[KILN_PROGRAM_NAME_SIZE];
    assert_true(kiln_program_cache_name(again, &key));
    assert_string_equal(again, names[0]);
}

static void spoil(const char *path, long at)
{
    FILE *file = fopen(path, "r+b");
    assert_non_null(file);
    assert_int_equal(fseek(file, at, at < 0 ? SEEK_END : SEEK_SET), 0);
    const int byte = fgetc(file);
    assert_int_equal(fseek(file, -1, SEEK_CUR), 0);
    assert_int_equal(fputc(byte ^ 0x55, file), byte ^ 0x55);
    fclose(file);
}

static void damaged_files_are_ignored(void **state)
{
    (void)state;
    static const long places[] = {0, 20, 30, 104, 110, -1};
    enum { PLACES = sizeof places / sizeof *places };
    char names[1][256], path[512];
    struct stat whole;
    if (!gives_binaries())
        skip();
    create_42();
    assert_int_equal(list(names, 1), 1);
    snprintf(path, sizeof path, FOLDER "/%s", names[0]);
    assert_int_equal(stat(path, &whole), 0);
    for (uint32_t i = 0; i < PLACES + 4; i++) {
        if (i < PLACES)
            spoil(path, places[i]);
        else
            assert_int_equal(
                truncate(path, (off_t[]){0, 10, whole.st_size - 1, whole.st_size + 1}[i - PLACES]),
                0);
        create_42(); /* writes the file anew */
        expect_counts(2 + i, i);
        create_42();
        expect_counts(2 + i, i + 1);
    }
}

/* The parts of a file after its checksum. */
enum { NAME_SIZE = 76, HEAD_SIZE = 80 };

/* Writes a file of the cache whose checksum is right. */
static void forge(const char *file, const char *name, uint32_t format, const void *binary,
                  size_t size)
{
    unsigned char bytes[4096] = {0};
    assert_true(HEAD_SIZE + size <= sizeof bytes);
    memcpy(bytes, name, strlen(name) + 1);
    memcpy(bytes + NAME_SIZE, &format, sizeof format);
    if (size > 0)
        memcpy(bytes + HEAD_SIZE, binary, size);
    kiln_cache_write(FOLDER, file, bytes, HEAD_SIZE + size);
}

static void foreign_files_are_ignored(void **state)
{
    (void)state;
    char names[2][256], path[512], other[512];
    static const unsigned char noise[2000] = {7, 5, 3};
    size_t size = 0;
    uint32_t format = 0;
    if (!gives_binaries())
        skip();
    create_42();
    assert_int_equal(list(names, 2), 1);
    unsigned char *bytes = kiln_cache_read_any(FOLDER, names[0], 1 << 20, &size);
    assert_true(bytes && size > HEAD_SIZE);
    memcpy(&format, bytes + NAME_SIZE, sizeof format);
    free(bytes);

    forge(names[0], names[0], 0xbad, noise, sizeof noise); /* a format that the driver lacks */
    create_42();
    expect_counts(2, 0);
    forge(names[0], names[0], format, noise, sizeof noise); /* a binary of another driver */
    create_42();
    expect_counts(3, 0);
    forge(names[0], names[0], format, noise, 0);
    create_42();
    expect_counts(4, 0);

    create("#define ANSWER 43u", 43); /* a file that has got another program's name */
    expect_counts(5, 0);
    assert_int_equal(list(names, 2), 2);
    snprintf(path, sizeof path, FOLDER "/%s", names[0]);
    snprintf(other, sizeof other, FOLDER "/%s", names[1]);
    assert_int_equal(rename(path, other), 0);
    create_42();
    create("#define ANSWER 43u", 43);
    expect_counts(7, 0);
    create_42();
    create("#define ANSWER 43u", 43);
    expect_counts(7, 2);
}

/* Other users must not be able to write what the driver reads. */
static void a_folder_of_others_is_not_used(void **state)
{
    (void)state;
    if (!gives_binaries())
        skip();
    create_42();
    for (uint32_t i = 0; i < 3; i++) {
        assert_int_equal(chmod(FOLDER, (mode_t[]){0755, 0770, 0701}[i]), 0);
        create_42();
        expect_counts(2 + i, 0);
    }
    assert_int_equal(chmod(FOLDER, 0700), 0);
    create_42();
    expect_counts(4, 1);
    assert_int_equal(rename(FOLDER, "elsewhere"), 0);
    assert_int_equal(symlink("../elsewhere", FOLDER), 0);
    create_42();
    expect_counts(5, 1);
    if (geteuid() == 0) {
        assert_int_equal(unlink(FOLDER), 0);
        assert_int_equal(rename("elsewhere", FOLDER), 0);
        assert_int_equal(chown(FOLDER, 1, 1), 0);
        create_42();
        expect_counts(6, 1);
    }
}

static void without_a_folder_programs_are_built(void **state)
{
    (void)state;
    assert_int_equal(setenv("XDG_CACHE_HOME", "/dev/null", 1), 0);
    create_42();
    create_42();
    expect_counts(2, 0);
    assert_int_equal(access("cache", F_OK), -1);
}

static int tear_down(void **state)
{
    test_leave_folder(state);
    return test_device_is_clean(state);
}

int main(void)
{
#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, set_up, tear_down)
    static const struct CMUnitTest tests[] = {
        IN_FOLDER(a_second_program_comes_from_the_cache),
        IN_FOLDER(captured_outputs_come_along),
        IN_FOLDER(another_text_is_another_program),
        cmocka_unit_test(names_have_the_whole_key),
        IN_FOLDER(damaged_files_are_ignored),
        IN_FOLDER(foreign_files_are_ignored),
        IN_FOLDER(a_folder_of_others_is_not_used),
        IN_FOLDER(without_a_folder_programs_are_built),
    };
    return cmocka_run_group_tests_name("program_cache", tests, test_device_open_alone,
                                       test_device_close);
}
