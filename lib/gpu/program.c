/* This file compiles and links GLSL programs. The error of a failed build is one line: the driver's
 * first error at its file and line. The driver's whole message goes to the log. A program that was
 * built before is taken from the cache instead (program_cache.c). */
#include "gpu/program.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/log.h"
#include "gpu/program_cache.h"
#include "gpu/source.h"

enum { MAX_STAGES = 4 };

/* One stage of a program while it is built. */
struct stage {
    GLenum kind;
    const char *file;
    struct kiln_source source;
    GLuint shader;
};

/* Holds a program while it is built: its GL objects and its name. */
struct build {
    struct kiln_device *device;
    GLuint program;
    struct stage stages[MAX_STAGES];
    size_t stage_count;
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

static bool compile(struct build *build, struct stage *stage, struct kiln_error *error)
{
    stage->shader = glCreateShader(stage->kind);
    kiln_device_label(build->device, GL_SHADER, stage->shader, stage->file);
    glShaderSource(stage->shader, 1, (const GLchar *const *)&stage->source.text.data, NULL);
    glCompileShader(stage->shader);
    GLint compiled = GL_FALSE;
    glGetShaderiv(stage->shader, GL_COMPILE_STATUS, &compiled);
    report(build, get_log(stage->shader, true), &stage->source, compiled != GL_TRUE, error);
    glAttachShader(build->program, stage->shader);
    return compiled == GL_TRUE;
}

static bool link_program(struct build *build, struct kiln_error *error)
{
    glLinkProgram(build->program);
    GLint linked = GL_FALSE;
    glGetProgramiv(build->program, GL_LINK_STATUS, &linked);
    report(build, get_log(build->program, false), NULL, linked != GL_TRUE, error);
    return linked == GL_TRUE && kiln_device_check(build->device, build->name.data, error);
}

/* Makes an empty program object. */
static void create_object(struct build *build)
{
    build->program = glCreateProgram();
    kiln_device_label(build->device, GL_PROGRAM, build->program, build->name.data);
}

/* Compiles and links a program; `retrievable` says that its binary will be asked for. */
static bool build_program(struct build *build, const struct kiln_program_params *params,
                          bool retrievable, struct kiln_error *error)
{
    bool ok = true;
    create_object(build);
    if (retrievable)
        glProgramParameteri(build->program, GL_PROGRAM_BINARY_RETRIEVABLE_HINT, GL_TRUE);
    for (size_t i = 0; ok && i < build->stage_count; i++)
        ok = compile(build, &build->stages[i], error);
    if (params->captured_count > 0)
        glTransformFeedbackVaryings(build->program, (GLsizei)params->captured_count,
                                    params->captured, GL_INTERLEAVED_ATTRIBS);
    ok = ok && link_program(build, error);
    for (size_t i = 0; i < build->stage_count; i++) {
        if (build->stages[i].shader) {
            glDetachShader(build->program, build->stages[i].shader);
            glDeleteShader(build->stages[i].shader);
        }
    }
    if (!ok)
        glDeleteProgram(build->program);
    return ok;
}

/* Takes a program from the cache, or builds it and writes it there. */
static bool find_or_build(struct build *build, const struct kiln_program_params *params,
                          struct kiln_error *error)
{
    char name[KILN_PROGRAM_NAME_SIZE];
    struct kiln_program_stage stages[MAX_STAGES];
    const double start_s = kiln_clock_seconds();
    for (size_t i = 0; i < build->stage_count; i++)
        stages[i] = (struct kiln_program_stage){.kind = build->stages[i].kind,
                                                .text = build->stages[i].source.text.data};
    struct kiln_program_key key = {.stages = stages,
                                   .stage_count = build->stage_count,
                                   .captured = params->captured,
                                   .captured_count = params->captured_count};
    const bool cached =
        kiln_program_cache_ask_driver(&key, build->device) && kiln_program_cache_name(name, &key);
    bool loaded = false;
    if (cached) {
        create_object(build);
        loaded = kiln_program_cache_load(build->device, name, build->program);
        if (!loaded)
            glDeleteProgram(build->program);
    }
    if (!loaded && !build_program(build, params, cached, error))
        return false;
    if (cached && !loaded)
        kiln_program_cache_save(build->device, name, build->program);
    if (loaded)
        build->device->programs.loaded++;
    else
        build->device->programs.built++;
    kiln_log_write(&build->device->log, KILN_LOG_DEBUG, "shaders %s: %s in %.0f ms",
                   build->name.data, loaded ? "loaded from the cache" : "built",
                   (kiln_clock_seconds() - start_s) * 1000);
    return true;
}

static bool load_sources(struct build *build, const char *defines, struct kiln_error *error)
{
    for (size_t i = 0; i < build->stage_count; i++) {
        struct stage *stage = &build->stages[i];
        if (!kiln_source_load(&stage->source, stage->file, defines, error))
            return false;
    }
    return true;
}

static void finish(struct build *build)
{
    for (size_t i = 0; i < build->stage_count; i++)
        kiln_source_finish(&build->stages[i].source);
    kiln_text_free(&build->name);
    free(build);
}

GLuint kiln_program_create(struct kiln_device *device, const struct kiln_program_params *params,
                           struct kiln_error *error)
{
    const struct {
        GLenum kind;
        const char *file;
    } stages[MAX_STAGES] = {
        {GL_COMPUTE_SHADER, params->compute},
        {GL_VERTEX_SHADER, params->vertex},
        {GL_GEOMETRY_SHADER, params->geometry},
        {GL_FRAGMENT_SHADER, params->fragment},
    };
    struct build *build = calloc(1, sizeof *build); /* the sources are too large for a stack */
    if (!build) {
        kiln_error_no_memory(error, "a program of shaders");
        return 0;
    }
    build->device = device;
    for (size_t i = 0; i < MAX_STAGES; i++) {
        if (!stages[i].file)
            continue;
        build->stages[build->stage_count++] =
            (struct stage){.kind = stages[i].kind, .file = stages[i].file};
        kiln_text_add(&build->name, "%s%s", build->name.length ? " + " : "", stages[i].file);
    }
    bool ok = build->name.length > 0 && !build->name.failed;
    if (!ok)
        kiln_error_no_memory(error, "the name of a program of shaders");
    ok = ok && load_sources(build, params->defines, error) && find_or_build(build, params, error);
    const GLuint program = ok ? build->program : 0;
    finish(build);
    return program;
}

GLuint kiln_program_create_defined(struct kiln_device *device,
                                   const struct kiln_program_params *params,
                                   struct kiln_text *defines, struct kiln_error *error)
{
    struct kiln_program_params defined = *params;
    GLuint program = 0;
    defined.defines = defines->data;
    if (defines->failed)
        kiln_error_no_memory(error, "the defines of a program");
    else
        program = kiln_program_create(device, &defined, error);
    kiln_text_free(defines);
    return program;
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
