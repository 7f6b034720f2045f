/* This file compiles and links GLSL programs. The error of a failed build is one line: the driver's
 * first error at its file and line. The driver's whole message goes to the log. */
#include "gpu/program.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/error.h"
#include "base/log.h"
#include "gpu/source.h"

enum { MAX_STAGES = 4 };

/* Holds a program while it is built: its GL objects and its name. */
struct build {
    struct kiln_device *device;
    GLuint program;
    GLuint shaders[MAX_STAGES];
    size_t shader_count;
    struct kiln_text name; /* the files, for messages and labels */
};

static char *get_log(GLuint object, bool is_shader)
{
    GLint length = 0;
    if (is_shader)
        glGetShaderiv(object, GL_INFO_LOG_LENGTH, &length);
    else
        glGetProgramiv(object, GL_INFO_LOG_LENGTH, &length);
    char *log = calloc((size_t)(length > 0 ? length : 0) + 1, 1);
    if (log && length > 0 && is_shader)
        glGetShaderInfoLog(object, length, NULL, log);
    else if (log && length > 0)
        glGetProgramInfoLog(object, length, NULL, log);
    return log;
}

/* Logs each line of a driver's message. If the build failed, the first line that contains "error",
 * or else the first line, becomes the error. source is NULL if the message does not refer to a
 * file. */
static void report(struct build *build, char *log, const struct kiln_source *source, bool failed,
                   struct kiln_error *error)
{
    bool has_error = false, has_line = false;
    const struct kiln_source no_files = {.file_count = 0};
    if (failed)
        kiln_error_set(error, KILN_DEVICE_FAILED, "shaders %s: the driver refuses them",
                       build->name.data);
    for (char *line = log; line && *line;) {
        size_t length = strcspn(line, "\n");
        struct kiln_text text = {0};
        kiln_source_map_line(source ? source : &no_files, line, length, &text);
        line += length + (line[length] == '\n');
        if (!text.data || text.length == 0) {
            kiln_text_free(&text);
            continue;
        }
        kiln_log_write(&build->device->log, failed ? KILN_LOG_WARNING : KILN_LOG_DEBUG, "%s",
                       text.data);
        const bool names_error = strcasestr(text.data, "error") != NULL;
        if (failed && (!has_line || (names_error && !has_error)))
            kiln_error_set(error, KILN_DEVICE_FAILED, "%s%s%s", source ? "" : build->name.data,
                           source ? "" : ": ", text.data);
        has_line = true;
        has_error = has_error || names_error;
        kiln_text_free(&text);
    }
    free(log);
}

static bool compile(struct build *build, GLenum stage, const char *file, const char *defines,
                    struct kiln_error *error)
{
    struct kiln_source *source = calloc(1, sizeof *source);
    if (!source)
        return kiln_error_no_memory(error, "shader %s", file);
    bool ok = kiln_source_load(source, file, defines, error);
    if (ok) {
        GLuint shader = glCreateShader(stage);
        build->shaders[build->shader_count++] = shader;
        kiln_device_label(build->device, GL_SHADER, shader, file);
        glShaderSource(shader, 1, (const GLchar *const *)&source->text.data, NULL);
        glCompileShader(shader);
        GLint compiled = GL_FALSE;
        glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
        ok = compiled == GL_TRUE;
        report(build, get_log(shader, true), source, !ok, error);
        glAttachShader(build->program, shader);
    }
    kiln_source_finish(source);
    free(source);
    return ok;
}

static bool link_program(struct build *build, struct kiln_error *error)
{
    glLinkProgram(build->program);
    GLint linked = GL_FALSE;
    glGetProgramiv(build->program, GL_LINK_STATUS, &linked);
    report(build, get_log(build->program, false), NULL, linked != GL_TRUE, error);
    return linked == GL_TRUE && kiln_device_check(build->device, build->name.data, error);
}

GLuint kiln_program_create(struct kiln_device *device, const struct kiln_program_params *params,
                           struct kiln_error *error)
{
    const struct {
        GLenum stage;
        const char *file;
    } stages[MAX_STAGES] = {
        {GL_COMPUTE_SHADER, params->compute},
        {GL_VERTEX_SHADER, params->vertex},
        {GL_GEOMETRY_SHADER, params->geometry},
        {GL_FRAGMENT_SHADER, params->fragment},
    };
    struct build build = {.device = device};
    for (size_t i = 0; i < MAX_STAGES; i++)
        if (stages[i].file)
            kiln_text_add(&build.name, "%s%s", build.name.length ? " + " : "", stages[i].file);
    if (build.name.length == 0 || build.name.failed) {
        kiln_error_no_memory(error, "the name of a program of shaders");
        kiln_text_free(&build.name);
        return 0;
    }
    build.program = glCreateProgram();
    kiln_device_label(device, GL_PROGRAM, build.program, build.name.data);

    bool ok = true;
    for (size_t i = 0; ok && i < MAX_STAGES; i++)
        if (stages[i].file)
            ok = compile(&build, stages[i].stage, stages[i].file, params->defines, error);
    if (params->captured_count > 0)
        glTransformFeedbackVaryings(build.program, (GLsizei)params->captured_count,
                                    params->captured, GL_INTERLEAVED_ATTRIBS);
    ok = ok && link_program(&build, error);

    for (size_t i = 0; i < build.shader_count; i++) {
        glDetachShader(build.program, build.shaders[i]);
        glDeleteShader(build.shaders[i]);
    }
    if (!ok)
        glDeleteProgram(build.program);
    kiln_text_free(&build.name);
    return ok ? build.program : 0;
}

char *kiln_program_source(const char *file, const char *defines, struct kiln_error *error)
{
    struct kiln_source *source = calloc(1, sizeof *source);
    if (!source) {
        kiln_error_no_memory(error, "shader %s", file);
        return NULL;
    }
    char *text = NULL;
    if (kiln_source_load(source, file, defines, error)) {
        text = source->text.data;
        source->text = (struct kiln_text){0};
    }
    kiln_source_finish(source);
    free(source);
    return text;
}
