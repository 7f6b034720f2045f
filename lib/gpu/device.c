/* This file lists, chooses and opens devices, and checks them for GL errors. */
#include "gpu/device.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/error.h"
#include "base/log.h"
#include "base/simd.h"
#include "base/sized.h"
#include "base/text.h"
#include "base/thread.h"
#include "gpu/advice.h"
#include "gpu/egl.h"
#include "gpu/probe.h"

/* ---- Errors -------------------------------------------------------------------------------- */

/* Logs a message of the driver and keeps the first error for kiln_device_check. Messages of the
 * shader compiler are not kept: kiln_program_create reports them with their file and line. */
static void GLAPIENTRY on_debug_message(GLenum source, GLenum type, GLuint id, GLenum severity,
                                        GLsizei length, const GLchar *message, const void *user)
{
    (void)id;
    struct kiln_device *device = (struct kiln_device *)user;
    const bool failure = type == GL_DEBUG_TYPE_ERROR || severity == GL_DEBUG_SEVERITY_HIGH;
    if (source == GL_DEBUG_SOURCE_APPLICATION)
        return;
    while (length > 0 && message[length - 1] == '\n')
        length--;
    kiln_log_write(&device->log, failure ? KILN_LOG_WARNING : KILN_LOG_DEBUG, "GL: %.*s",
                   (int)length, message);
    if (!failure || source == GL_DEBUG_SOURCE_SHADER_COMPILER || device->gl_failed)
        return;
    device->gl_failed = true;
    snprintf(device->gl_message, sizeof device->gl_message, "%.*s", (int)length, message);
}

static void watch_errors(struct kiln_device *device)
{
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(on_debug_message, device);
}

static const char *error_name(GLenum error)
{
    switch (error) {
    case GL_INVALID_ENUM:
        return "invalid enum";
    case GL_INVALID_VALUE:
        return "invalid value";
    case GL_INVALID_OPERATION:
        return "invalid operation";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
        return "invalid framebuffer operation";
    case GL_OUT_OF_MEMORY:
        return "the device is out of memory";
    case GL_CONTEXT_LOST:
        return "the device was lost";
    default:
        return "unknown error";
    }
}

static bool context_was_reset(void)
{
    if (epoxy_gl_version() < 45 && !epoxy_has_gl_extension("GL_KHR_robustness"))
        return false;
    return glGetGraphicsResetStatus() != GL_NO_ERROR;
}

bool kiln_device_check(struct kiln_device *device, const char *where, struct kiln_error *error)
{
    GLenum first = GL_NO_ERROR;
    /* The loop is bounded, since a lost context may report an error for ever. */
    for (int i = 0; i < 16; i++) {
        GLenum code = glGetError();
        if (code == GL_NO_ERROR)
            break;
        if (first == GL_NO_ERROR || code == GL_OUT_OF_MEMORY)
            first = code;
    }
    const bool reported = device->gl_failed;
    device->gl_failed = false;
    if (context_was_reset())
        first = GL_CONTEXT_LOST;
    if (first == GL_NO_ERROR && !reported)
        return true;
    if (first == GL_NO_ERROR)
        return kiln_error_set(error, KILN_DEVICE_FAILED, "%s: GL: %s", where, device->gl_message);
    return kiln_error_set(error, KILN_DEVICE_FAILED, "%s: GL: %s (0x%04x)%s%s", where,
                          error_name(first), first, reported ? ": " : "",
                          reported ? device->gl_message : "");
}

void kiln_device_push_group(struct kiln_device *device, const char *name)
{
    (void)device;
    glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, -1, name);
}

void kiln_device_pop_group(struct kiln_device *device)
{
    (void)device;
    glPopDebugGroup();
}

void kiln_device_label(struct kiln_device *device, GLenum kind, GLuint object, const char *label)
{
    (void)device;
    enum { LEAST_MAX_LABEL_LENGTH = 256 };
    size_t length = strlen(label);
    if (length >= LEAST_MAX_LABEL_LENGTH)
        length = LEAST_MAX_LABEL_LENGTH - 1;
    glObjectLabel(kind, object, (GLsizei)length, label);
}

void kiln_device_dispatch(struct kiln_device *device, uint32_t count, uint32_t group_size)
{
    (void)device;
    enum { MAX_GROUPS_AN_AXIS = 65535 };
    const uint32_t groups = count / group_size + (count % group_size != 0);
    if (groups == 0)
        return;
    const uint32_t y = (groups - 1) / MAX_GROUPS_AN_AXIS + 1;
    const uint32_t x = (groups - 1) / y + 1;
    glDispatchCompute(x, y, 1);
}

uint32_t kiln_device_group_size(const struct kiln_device *device, uint32_t usual, uint32_t most)
{
    if (device->work_group_size == 0)
        return usual;
    uint32_t limit = (uint32_t)device->info.max_work_group_invocations, size = 1;
    while (size < most && 2 * size <= limit && 2 * size <= device->work_group_size)
        size *= 2;
    return size;
}

/* ---- Opening ------------------------------------------------------------------------------- */

static bool is_software(const char *renderer)
{
    static const char *const names[] = {"llvmpipe", "softpipe", "swrast", "SwiftShader",
                                        "software"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcasestr(renderer, names[i]))
            return true;
    return false;
}

static void copy_gl_string(char out[128], GLenum name)
{
    const char *text = (const char *)glGetString(name);
    snprintf(out, 128, "%s", text ? text : "unknown");
}

static void describe(struct kiln_device_info *info)
{
    copy_gl_string(info->name, GL_RENDERER);
    copy_gl_string(info->vendor, GL_VENDOR);
    char version[sizeof info->gl_version] = ""; /* GCC 12 takes two members of *info for one */
    copy_gl_string(version, GL_VERSION);
    memcpy(info->gl_version, version, sizeof version);
    info->software = info->software || is_software(info->name);
    if (epoxy_gl_version() < 43) {
        snprintf(info->problem, sizeof info->problem,
                 "the device has OpenGL %s; 4.3 or later is needed, from a newer driver", version);
        return;
    }
    glGetIntegerv(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS, &info->max_work_group_invocations);
    glGetIntegerv(GL_MAX_COMPUTE_SHARED_MEMORY_SIZE, &info->max_shared_memory_bytes);
    GLint64 block_bytes = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &block_bytes);
    info->max_storage_block_bytes = block_bytes;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &info->max_texture_size);
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &info->max_array_layers);

    /* Storage buffers in vertex shaders are the only optional part of OpenGL 4.3 that kiln draws
     * with. */
    GLint vertex_blocks = 0;
    glGetIntegerv(GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS, &vertex_blocks);
    if (vertex_blocks < 1) {
        snprintf(info->problem, sizeof info->problem,
                 "the device's vertex shaders cannot read storage buffers");
        return;
    }
    info->usable = true;
}

static void open_source(struct kiln_device *device, const struct kiln_egl_source *source,
                        const struct kiln_device_params *params)
{
    *device = (struct kiln_device){.log = params->log,
                                   .debug = params->debug,
                                   .info = {.size = sizeof device->info, .gl = true}};
    struct kiln_device_info *info = &device->info;
    snprintf(info->platform, sizeof info->platform, "%s", source->platform);
    info->software = source->software;
    if (kiln_egl_open(source, params->debug, &device->display, &device->context, info->problem))
        describe(info);
    else
        snprintf(info->name, sizeof info->name, "%s", source->name);
}

/* Returns the device `cpu`, which is this machine without GL. It is not usable, and error is set,
 * if the environment asks for vectors that the processor lacks. Images and buffers may be as large
 * as memory allows. */
static struct kiln_device describe_host(const struct kiln_device_params *params,
                                        struct kiln_error *error)
{
    struct kiln_device host = {.log = params->log, .info.size = sizeof host.info};
    struct kiln_device_info *info = &host.info;
    info->software = info->exact = true;
    info->max_storage_block_bytes = INT64_MAX;
    info->max_texture_size = info->max_array_layers = INT32_MAX;
    snprintf(info->name, sizeof info->name, KILN_DEVICE_CPU);
    snprintf(info->vendor, sizeof info->vendor, "kiln");
    snprintf(info->gl_version, sizeof info->gl_version, "none");
    snprintf(info->platform, sizeof info->platform, "host");
    info->threads = kiln_threads_available();
    enum kiln_simd simd;
    info->usable = kiln_simd_choose(&simd, error);
    if (info->usable)
        snprintf(info->vectors, sizeof info->vectors, "%s", kiln_simd_name(simd));
    else
        snprintf(info->problem, sizeof info->problem, "%.255s", error->message);
    return host;
}

/* ---- Choosing ------------------------------------------------------------------------------ */

/* Holds the devices found so far in the order of their numbers: first the device without GL, then
 * the opened devices with GL. */
struct device_list {
    struct kiln_device devices[1 + KILN_MAX_EGL_SOURCES];
    size_t count;
    char problem[256]; /* why there is no device with GL */
};

static bool is_index(const char *wanted, uint64_t *index)
{
    return wanted && kiln_text_to_uint64(wanted, index);
}

/* Returns whether the devices found so far decide the choice. Scanning then stops, since opening
 * devices costs time and memory on a machine with many GPUs. A name decides only when all devices
 * are known, except `cpu` and `software`. */
static bool list_is_enough(const struct device_list *device_list, const char *wanted)
{
    uint64_t index;
    const struct kiln_device_info *last = &device_list->devices[device_list->count - 1].info;
    if (!wanted)
        return last->usable && !last->software;
    if (is_index(wanted, &index))
        return device_list->count > index;
    if (strcasecmp(wanted, KILN_DEVICE_CPU) == 0)
        return true;
    return strcmp(wanted, "software") == 0 && last->usable && last->gl && last->software;
}

/* Returns whether a device of Mesa's surfaceless platform adds nothing, because it is not usable or
 * is in the list already. */
static bool is_duplicate(const struct device_list *device_list, const struct kiln_device_info *info)
{
    if (strcmp(info->platform, "surfaceless") != 0)
        return false;
    for (size_t i = 0; i < device_list->count; i++) {
        const struct kiln_device_info *other = &device_list->devices[i].info;
        if (!info->usable || (strcmp(info->name, other->name) == 0 &&
                              strcmp(info->gl_version, other->gl_version) == 0))
            return true;
    }
    return false;
}

/* Returns whether a source may be a GPU. The default choice does not open other sources. Mesa's
 * surfaceless platform counts as a possible GPU only if EGL cannot list devices. */
static bool may_be_gpu(const struct kiln_egl_source *source, size_t source_count)
{
    return !source->software && (source->device || source_count == 1);
}

/* Opens devices until the choice is clear, or all of them if `open_all` is set. */
static void open_devices(struct device_list *device_list, const struct kiln_device_params *params,
                         bool open_all)
{
    struct kiln_error error = {0};
    device_list->devices[0] = describe_host(params, &error);
    device_list->count = 1;
    if (!open_all && list_is_enough(device_list, params->wanted))
        return;
    struct kiln_egl_source sources[KILN_MAX_EGL_SOURCES];
    size_t source_count = kiln_egl_sources(sources, device_list->problem);
    for (size_t i = 0; i < source_count; i++) {
        struct kiln_device *device = &device_list->devices[device_list->count];
        if (!open_all && !params->wanted && !params->gl && !may_be_gpu(&sources[i], source_count))
            continue;
        open_source(device, &sources[i], params);
        if (is_duplicate(device_list, &device->info)) {
            kiln_egl_close(device->display, device->context);
            continue;
        }
        device->info.index = (uint32_t)device_list->count++;
        if (!open_all && list_is_enough(device_list, params->wanted))
            return;
    }
}

static void close_list(struct device_list *device_list)
{
    for (size_t i = 0; i < device_list->count; i++)
        kiln_egl_close(device_list->devices[i].display, device_list->devices[i].context);
    device_list->count = 0;
}

static void list_names(const struct device_list *device_list, struct kiln_text *text)
{
    for (size_t i = 0; i < device_list->count; i++)
        kiln_text_add(text, "%s%zu '%s'", i ? ", " : "", i, device_list->devices[i].info.name);
}

static const struct kiln_device *choose_software(const struct device_list *device_list)
{
    for (size_t i = 1; i < device_list->count; i++)
        if (device_list->devices[i].info.usable && device_list->devices[i].info.software)
            return &device_list->devices[i];
    return NULL;
}

static const struct kiln_device *choose_default(const struct device_list *device_list, bool gl)
{
    for (size_t i = 1; i < device_list->count; i++)
        if (device_list->devices[i].info.usable && !device_list->devices[i].info.software)
            return &device_list->devices[i];
    return gl ? choose_software(device_list) : &device_list->devices[0];
}

/* Returns the device whose whole name is `wanted`, or else the one whose name contains it. Sets
 * ambiguous and returns NULL if there are several. */
static const struct kiln_device *choose_named(const struct device_list *device_list,
                                              const char *wanted, bool *ambiguous)
{
    const struct kiln_device *found = NULL;
    size_t matches = 0;
    for (int whole = 1; whole >= 0 && matches == 0; whole--) {
        for (size_t i = 0; i < device_list->count; i++) {
            const char *name = device_list->devices[i].info.name;
            if (whole ? strcasecmp(name, wanted) == 0 : strcasestr(name, wanted) != NULL) {
                found = &device_list->devices[i];
                matches++;
            }
        }
    }
    *ambiguous = matches > 1;
    return matches == 1 ? found : NULL;
}

static const struct kiln_device *refuse_choice(const struct device_list *device_list,
                                               const char *wanted, bool ambiguous,
                                               struct kiln_error *error)
{
    struct kiln_text names = {0};
    list_names(device_list, &names);
    if (!wanted && device_list->count == 1)
        kiln_error_set(error, KILN_NO_DEVICE, "no device with OpenGL: %s", device_list->problem);
    else if (!wanted)
        kiln_error_set(error, KILN_NO_DEVICE, "no usable device with OpenGL; the first one: %s",
                       device_list->devices[1].info.problem);
    else if (ambiguous)
        kiln_error_set(error, KILN_USAGE,
                       "more than one device is called '%s'; give its number: %s", wanted,
                       names.data);
    else
        kiln_error_set(
            error, KILN_NO_DEVICE, "there is no device '%s'; there are: %s%s", wanted, names.data,
            strcmp(wanted, "software") == 0
                ? "; the packages libegl-mesa0 and libgl1-mesa-dri bring a software device"
                : "");
    kiln_text_free(&names);
    return NULL;
}

static const struct kiln_device *choose(const struct device_list *device_list,
                                        const struct kiln_device_params *params,
                                        struct kiln_error *error)
{
    const char *wanted = params->wanted;
    const struct kiln_device *device = NULL;
    bool ambiguous = false;
    uint64_t index;
    if (!wanted)
        device = choose_default(device_list, params->gl);
    else if (is_index(wanted, &index))
        device = index < device_list->count ? &device_list->devices[index] : NULL;
    else if (strcmp(wanted, "software") == 0)
        device = choose_software(device_list);
    else
        device = choose_named(device_list, wanted, &ambiguous);

    if (!device)
        return refuse_choice(device_list, wanted, ambiguous, error);
    if (device->info.usable)
        return device;
    if (!device->info.gl) /* KILN_SIMD in the environment is wrong */
        kiln_error_set(error, KILN_USAGE, "%s", device->info.problem);
    else
        kiln_error_set(error, KILN_NO_DEVICE, "device %u '%s' is not usable: %s",
                       device->info.index, device->info.name, device->info.problem);
    return NULL;
}

/* Runs the exactness probe on a device and sets info.exact. A device that does not compute exactly
 * can still draw, but the host simulates the particles. */
static void probe(struct kiln_device *device)
{
    char reason[256] = "";
    struct kiln_error error = {0};
    if (!device->info.gl || !device->info.usable || !kiln_device_make_current(device, &error))
        return;
    device->info.exact = kiln_probe_exact(device, KILN_PROBE_COMPUTE, reason, &error);
    if (!device->info.exact)
        kiln_log_write(&device->log, KILN_LOG_INFO, "'%s' does not compute exactly: %s",
                       device->info.name, reason[0] ? reason : error.message);
}

/* ---- The interface ------------------------------------------------------------------------- */

size_t kiln_device_list(struct kiln_device_info *infos, size_t stride, size_t capacity,
                        char advice[256])
{
    if (advice)
        snprintf(advice, 256, "out of memory for the list of devices");
    struct kiln_device_info all[1 + KILN_MAX_EGL_SOURCES];
    struct device_list *device_list = calloc(1, sizeof *device_list);
    if (!device_list)
        return 0;
    struct kiln_egl_current before = kiln_egl_current();
    const struct kiln_device_params any = kiln_device_defaults();
    open_devices(device_list, &any, true);
    const size_t count = device_list->count;
    for (size_t i = 0; i < count; i++) {
        probe(&device_list->devices[i]);
        all[i] = device_list->devices[i].info;
        if (i < capacity)
            kiln_sized_give((char *)infos + i * stride, &all[i]);
    }
    if (advice)
        kiln_device_advise(all + 1, count - 1, device_list->problem, advice);
    close_list(device_list);
    kiln_egl_restore(&before);
    free(device_list);
    return count;
}

struct kiln_device *kiln_device_open(const struct kiln_device_params *given,
                                     struct kiln_error *error)
{
    struct kiln_device_params taken = kiln_device_defaults();
    const struct kiln_device_params *params = &taken;
    if (!kiln_sized_take(&taken, given, "kiln_device_params", error))
        return NULL;
    if (params->wanted && params->wanted[0] == '\0') {
        kiln_error_set(error, KILN_USAGE, "the name of the device is empty");
        return NULL;
    }
    struct device_list *device_list = calloc(1, sizeof *device_list);
    struct kiln_device *device = calloc(1, sizeof *device);
    if (!device_list || !device) {
        kiln_error_no_memory(error, "the list of devices");
        goto fail;
    }
    open_devices(device_list, params, false);
    const struct kiln_device *chosen = choose(device_list, params, error);
    if (!chosen)
        goto fail;
    *device = *chosen;
    kiln_handle_mark(&device->handle, KILN_HANDLE_DEVICE);
    device->thread = pthread_self();
    device_list->devices[chosen - device_list->devices].context = NULL;
    close_list(device_list);
    free(device_list);
    if (!kiln_device_make_current(device, error)) {
        kiln_device_close(&device);
        return NULL;
    }
    if (device->info.gl && device->debug)
        watch_errors(device);
    probe(device);
    return device;

fail:
    if (device_list)
        close_list(device_list);
    free(device_list);
    free(device);
    return NULL;
}

void kiln_device_close(struct kiln_device **device)
{
    struct kiln_device *d = device ? *device : NULL;
    if (!d)
        return;
    *device = NULL;
    if (!kiln_handle_retire(&d->handle, KILN_HANDLE_DEVICE))
        return;
    kiln_egl_close(d->display, d->context);
    kiln_handle_free(&d->handle, sizeof *d);
}

const struct kiln_device_info *kiln_device_get_info(const struct kiln_device *device)
{
    return &device->info;
}

struct kiln_device *kiln_device_gl(struct kiln_device *device)
{
    return device->info.gl ? device : NULL;
}

bool kiln_device_make_current(struct kiln_device *device, struct kiln_error *error)
{
    if (!device->info.gl || kiln_egl_make_current(device->display, device->context))
        return true;
    return kiln_error_set(error, KILN_DEVICE_FAILED, "the context of '%s' does not become current",
                          device->info.name);
}
