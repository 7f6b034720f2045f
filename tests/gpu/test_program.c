/* Checks how shader programs are compiled and linked (lib/gpu/program.h, source.h): #include is
 * resolved, errors name the file and line of a shader, and files in the folder KILN_SHADER_DIR
 * replace embedded ones. If this fails, errors in shaders name wrong lines, or changed shader files
 * have no effect. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "gpu/source.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/errors.h"

struct fixture {
    struct kiln_device *device;
    struct kiln_log log;
    char dir[64]; /* a temporary folder, the value of KILN_SHADER_DIR */
};

/* names of all files that the tests write to `dir`, which tear_down removes */
static const char *const written[] = {"main.comp",   "part.h",    "deep.h", "cycle_a.h",
                                      "cycle_b.h",   "test.vert", "t.frag", "shared/platform.h",
                                      "sharedplat.h"};

static void write_file(const struct fixture *fixture, const char *name, const char *text)
{
    char path[256];
    snprintf(path, sizeof path, "%s/%s", fixture->dir, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static int set_up(void **state)
{
    struct fixture *fixture = calloc(1, sizeof *fixture);
    test_device_open(state);
    fixture->device = *state;
    fixture->log = fixture->device->log;
    snprintf(fixture->dir, sizeof fixture->dir, "/tmp/kiln-shaders-XXXXXX");
    if (!mkdtemp(fixture->dir))
        return -1;
    char path[256];
    snprintf(path, sizeof path, "%s/shared", fixture->dir);
    *state = fixture;
    return mkdir(path, 0700) != 0 || setenv("KILN_SHADER_DIR", fixture->dir, 1) != 0;
}

static int tear_down(void **state)
{
    struct fixture *fixture = *state;
    char path[256];
    for (size_t i = 0; i < sizeof written / sizeof *written; i++) {
        snprintf(path, sizeof path, "%s/%s", fixture->dir, written[i]);
        unlink(path);
    }
    snprintf(path, sizeof path, "%s/shared", fixture->dir);
    rmdir(path);
    rmdir(fixture->dir);
    kiln_device_close(&fixture->device);
    free(fixture);
    return 0;
}

/* Creates a program with the log switched off, since some shaders are wrong on purpose and drivers
 * would print warnings about them. */
static GLuint create_quietly(struct fixture *fixture, const struct kiln_program_params *params,
                             struct kiln_error *error)
{
    fixture->device->log = (struct kiln_log){0};
    GLuint program = kiln_program_create(fixture->device, params, error);
    fixture->device->log = fixture->log;
    return program;
}

/* Fails unless kiln refuses main.comp with exactly this message, and leaves no GL error. */
static void assert_refused(struct fixture *fixture, const char *message)
{
    struct kiln_error error = {0};
    struct kiln_program_params params = {.compute = "main.comp"};
    assert_int_equal(create_quietly(fixture, &params, &error), 0);
    expect_error(&error, KILN_DEVICE_FAILED, "%s", message);
    assert_true(kiln_device_check(fixture->device, "after a refusal", &error));
}

/* Fails unless the driver's compiler refuses main.comp and kiln's message starts with `place`, a
 * file and a line. The rest of the message is the driver's own and is not checked. */
static void assert_not_compiled(struct fixture *fixture, const char *place)
{
    struct kiln_error error = {0};
    struct kiln_program_params params = {.compute = "main.comp"};
    assert_int_equal(create_quietly(fixture, &params, &error), 0);
    expect_error_around(&error, KILN_DEVICE_FAILED, "", "%s", place);
    assert_true(kiln_device_check(fixture->device, "after a refusal", &error));
}

static void includes_and_defines_reach_the_driver(void **state)
{
    struct fixture *fixture = *state;
    write_file(fixture, "part.h",
               "#ifndef PART\n#define PART\nuint part() { return ANSWER; }\n#endif\n");
    write_file(fixture, "deep.h", "#include \"part.h\"\n");
    write_file(fixture, "main.comp",
               "#include \"deep.h\"\n"
               "/* not taken:\n#include \"missing.h\"\n*/\n"
               "#include \"part.h\"\n"
               "#ifdef NEVER\n#include <stdint.h>\n#endif\n"
               "layout(local_size_x = 1) in;\n"
               "layout(std430, binding = 0) buffer Out { uint value; };\n"
               "void main() { value = part(); }\n");
    struct kiln_error error = {0};
    struct kiln_program_params params = {.compute = "main.comp", .defines = "#define ANSWER 42u"};
    GLuint program = kiln_program_create(fixture->device, &params, &error);
    assert_string_equal(error.message, "");
    assert_true(program != 0);

    GLuint buffer = 0, value = 0;
    glGenBuffers(1, &buffer);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer);
    glBufferData(GL_SHADER_STORAGE_BUFFER, 4, &value, GL_DYNAMIC_READ);
    glUseProgram(program);
    kiln_device_dispatch(fixture->device, 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, 4, &value);
    assert_int_equal(value, 42);
    glDeleteBuffers(1, &buffer);
    glDeleteProgram(program);
    assert_true(kiln_device_check(fixture->device, "dispatch", &error));
}

/* kiln_device_dispatch runs each index exactly once, also for more work groups than GL guarantees
 * along one axis, 65535, when it spreads them over two axes. A dispatch of 0 work groups runs
 * nothing. */
static void a_dispatch_reaches_every_index(void **state)
{
    enum { MORE_THAN_ONE_AXIS = 3 * 65535 + 5 };
    struct fixture *fixture = *state;
    write_file(fixture, "main.comp",
               "layout(local_size_x = 1) in;\n"
               "layout(std430, binding = 0) buffer Out { uint seen[]; };\n"
               "void main() {\n"
               "uint i = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;\n"
               "if (i < seen.length()) atomicAdd(seen[i], 1u); }\n");
    struct kiln_error error = {0};
    struct kiln_program_params params = {.compute = "main.comp"};
    GLuint program = kiln_program_create(fixture->device, &params, &error);
    assert_true(program != 0);
    struct kiln_buffer buffer;
    kiln_buffer_init(&buffer, fixture->device, MORE_THAN_ONE_AXIS * sizeof(uint32_t), "seen");
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, kiln_buffer_gl(&buffer, KILN_READ_WRITE, &error));
    glUseProgram(program);
    kiln_device_dispatch(fixture->device, 0, 64);
    kiln_device_dispatch(fixture->device, MORE_THAN_ONE_AXIS, 1);
    const uint32_t *seen = kiln_buffer_host(&buffer, KILN_READ, &error);
    assert_non_null(seen);
    for (size_t i = 0; i < MORE_THAN_ONE_AXIS; i++)
        assert_int_equal(seen[i], 1);
    kiln_buffer_finish(&buffer);
    glDeleteProgram(program);
    assert_true(kiln_device_check(fixture->device, "dispatch", &error));
}

static void compile_errors_name_file_and_line(void **state)
{
    struct fixture *fixture = *state;
    write_file(fixture, "part.h", "\n\nuint part() { return unknown_word; }\n");
    write_file(fixture, "main.comp",
               "layout(local_size_x = 1) in;\n#include \"part.h\"\nvoid main() { part(); }\n");
    assert_not_compiled(fixture, "shaders/part.h:3: ");

    write_file(fixture, "part.h", "uint part() { return 1u; }\n");
    write_file(fixture, "main.comp",
               "layout(local_size_x = 1) in;\n#include \"part.h\"\n\nvoid main() { other(); }\n");
    assert_not_compiled(fixture, "shaders/main.comp:4: ");
}

static void wrong_includes_name_file_and_line(void **state)
{
    struct fixture *fixture = *state;
    write_file(fixture, "main.comp", "\n#include \"missing.h\"\n");
    assert_refused(
        fixture, "shaders/main.comp:2: includes \"missing.h\", which is not a file under shaders/");
    write_file(fixture, "main.comp", "#include \"../main.comp\"\n");
    assert_refused(
        fixture,
        "shaders/main.comp:1: includes \"../main.comp\", which is not a file under shaders/");
    write_file(fixture, "main.comp", "#include missing.h\n");
    assert_refused(fixture, "shaders/main.comp:1: #include must be followed by \"path\"");
    write_file(fixture, "main.comp", "void main() {}\n/* open\n");
    assert_refused(fixture, "shaders/main.comp: a comment is not closed");

    write_file(fixture, "main.comp", "#include \"cycle_a.h\"\n");
    write_file(fixture, "cycle_a.h", "// \n#include \"cycle_b.h\"\n");
    write_file(fixture, "cycle_b.h", "#include \"cycle_a.h\"\n");
    assert_refused(fixture, "shaders/cycle_b.h:1: includes \"cycle_a.h\", which includes itself");
}

static void link_errors_name_the_files(void **state)
{
    struct fixture *fixture = *state;
    struct kiln_error error = {0};
    write_file(fixture, "test.vert", "out vec3 shade;\nvoid main() { shade = vec3(1); }\n");
    write_file(fixture, "t.frag", "in vec2 shade;\nout vec4 c;\nvoid main() { c = shade.xyxy; }\n");
    struct kiln_program_params params = {.vertex = "test.vert", .fragment = "t.frag"};
    assert_int_equal(create_quietly(fixture, &params, &error), 0);
    expect_error_around(&error, KILN_DEVICE_FAILED, "", "test.vert + t.frag: ");
    assert_true(kiln_device_check(fixture->device, "after a refusal", &error));

    params = (struct kiln_program_params){.compute = NULL};
    assert_int_equal(kiln_program_create(fixture->device, &params, &error), 0);
}

static void overrides_replace_single_files(void **state)
{
    struct fixture *fixture = *state;
    struct kiln_error error = {0};
    char *text = kiln_program_source("shared/value.h", NULL, &error);
    assert_non_null(text);
    assert_non_null(strstr(text, "#version 430 core\n"));
    assert_non_null(strstr(text, "precise"));
    assert_null(strstr(text, "overridden"));
    free(text);

    write_file(fixture, "shared/platform.h", "// overridden\n");
    text = kiln_program_source("shared/value.h", NULL, &error);
    assert_non_null(text);
    assert_non_null(strstr(text, "overridden"));
    assert_non_null(strstr(text, "value_at_key"));
    assert_null(strstr(text, "precise"));
    free(text);
}

static size_t occurrences(const char *text, const char *word)
{
    size_t count = 0;
    for (const char *at = strstr(text, word); at; at = strstr(at + 1, word))
        count++;
    return count;
}

/* A header with an include guard is in the text once in each branch of #if that needs it, and a
 * file without one wherever it is included. */
static void guarded_headers_are_not_repeated(void **state)
{
    struct fixture *fixture = *state;
    static const struct {
        const char *deep, *main;
        size_t count;
    } cases[] = {
        {"#ifndef D\n#define D\nmark\n#endif\n", "#include \"deep.h\"\n#include \"deep.h\"\n", 1},
        {"mark\n", "#include \"deep.h\"\n#include \"deep.h\"\n", 2},
        {"#ifndef D\n#define D\nmark\n#endif\n#ifdef E\n#endif\n",
         "#include \"deep.h\"\n#include \"deep.h\"\n", 2},
        {"#ifndef D\n#define D\nmark\n#else\n#endif\n",
         "#include \"deep.h\"\n#include \"deep.h\"\n", 2},
        {"#ifndef D\n#define D\n#if 1\nmark\n#else\n#endif\n#endif\n",
         "#include \"deep.h\"\n#include \"deep.h\"\n", 1},
        {"#ifndef D\n#define D\nmark\n#endif\n",
         "#ifdef A\n#include \"deep.h\"\n#include \"deep.h\"\n#endif\n#include \"deep.h\"\n", 2},
        {"#ifndef D\n#define D\nmark\n#endif\n",
         "#ifdef A\n#include \"deep.h\"\n#else\n#include \"deep.h\"\n#endif\n", 2},
        {"#ifndef D\n#define D\nmark\n#endif\n",
         "#if A\n#include \"deep.h\"\n#if B\n#include \"deep.h\"\n#endif\n#endif\n", 1},
        {"#ifndef D\n#define D\nmark\n#endif\n",
         "#include \"deep.h\"\n#if B\n#include \"deep.h\"\n#endif\n", 1},
        {"#ifndef D\n#define D\nmark\n#endif\n",
         "#ifdef A\n#include \"deep.h\"\n#endif\n#ifdef A\n#include \"deep.h\"\n#endif\n", 2},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct kiln_error error = {0};
        write_file(fixture, "deep.h", cases[i].deep);
        write_file(fixture, "main.comp", cases[i].main);
        char *text = kiln_program_source("main.comp", NULL, &error);
        assert_non_null(text);
        assert_int_equal(occurrences(text, "mark"), cases[i].count);
        free(text);
    }
}

static void unreadable_overrides_are_errors(void **state)
{
    struct fixture *fixture = *state;
    struct kiln_error error = {0};
    char path[256];
    snprintf(path, sizeof path, "%s/main.comp", fixture->dir);
    unlink(path);
    assert_int_equal(mkdir(path, 0700), 0);
    assert_int_equal(
        create_quietly(fixture, &(struct kiln_program_params){.compute = "main.comp"}, &error), 0);
    expect_error(&error, KILN_IO, "shader %s: Is a directory", path);
    assert_int_equal(rmdir(path), 0);

    snprintf(path, sizeof path, "%s/no_folder", fixture->dir); /* a folder that does not exist */
    setenv("KILN_SHADER_DIR", path, 1);
    assert_null(kiln_program_source("shared/value.h", NULL, &error));
    expect_error(&error, KILN_IO, "KILN_SHADER_DIR '%s': No such file or directory", path);
    setenv("KILN_SHADER_DIR", fixture->dir, 1);
}

/* Line numbers in messages of each driver become a shader's file and line; other messages stay. The
 * driver sees one text: lines 1 and 2 are the version and the defines, 3 to 5 are lines 1 to 3 of
 * main.comp, 6 and 7 are part.h, and 8 is line 5 of main.comp. */
static void driver_messages_are_mapped(void **state)
{
    struct fixture *fixture = *state;
    static const struct {
        const char *from, *to;
    } cases[] = {
        {"0:5(3): error: no", "shaders/main.comp:3: error: no"},         /* Mesa */
        {"0(7) : error C1000: no", "shaders/part.h:2: error C1000: no"}, /* NVIDIA */
        {"ERROR: 0:8: 'x' : wrong", "shaders/main.comp:5: 'x' : wrong"}, /* glslang, AMD */
        {"0:2(1): error: no", "(version and defines):2: error: no"},
        {"0:9(1): error: no such line", "0:9(1): error: no such line"},
        {"0:0(0): error: no line", "0:0(0): error: no line"},
        {"1:1(1): error: no such string", "1:1(1): error: no such string"},
        {"Vertex info", "Vertex info"},
        {"0:", "0:"},
        {"", ""},
    };
    write_file(fixture, "main.comp", "a\nb\nc\n#include \"part.h\"\ne\n");
    write_file(fixture, "part.h", "one\ntwo");
    struct kiln_error error = {0};
    struct kiln_source source = {.line_count = 0};
    assert_true(kiln_source_load(&source, "main.comp", "#define A\n", &error));
    assert_string_equal(source.text.data, "#version 430 core\n#define A\na\nb\nc\none\ntwo\ne\n");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct kiln_text text = {0};
        kiln_source_map_line(&source, cases[i].from, strlen(cases[i].from), &text);
        assert_string_equal(text.data ? text.data : "", cases[i].to);
        kiln_text_free(&text);
    }
    kiln_source_finish(&source);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(includes_and_defines_reach_the_driver),
        cmocka_unit_test(a_dispatch_reaches_every_index),
        cmocka_unit_test(compile_errors_name_file_and_line),
        cmocka_unit_test(wrong_includes_name_file_and_line),
        cmocka_unit_test(link_errors_name_the_files),
        cmocka_unit_test(overrides_replace_single_files),
        cmocka_unit_test(guarded_headers_are_not_repeated),
        cmocka_unit_test(unreadable_overrides_are_errors),
        cmocka_unit_test(driver_messages_are_mapped),
    };
    return cmocka_run_group_tests_name("program", tests, set_up, tear_down);
}
