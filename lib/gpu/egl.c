/* This file lists EGL devices and opens contexts on them without a display. It looks up extension
 * functions by name, because libepoxy 1.5 aborts the process if a library or a function is missing
 * or if eglGetPlatformDisplay is called before there is a display.
 *
 * Displays are never terminated: EGL returns the same display for equal attributes, and terminating
 * it would close it for another renderer of the process as well. libEGL is loaded only when a
 * device with GL is asked for. */
#include "gpu/egl.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <stdio.h>
#include <string.h>

static bool has_extension(const char *list, const char *name)
{
    size_t length = strlen(name);
    for (const char *match = list; match && (match = strstr(match, name)); match += length) {
        bool starts = match == list || match[-1] == ' ';
        if (starts && (match[length] == ' ' || match[length] == '\0'))
            return true;
    }
    return false;
}

/* Loads the libraries of EGL and OpenGL. Returns false with the name of the missing library in
 * problem. The libraries stay loaded, since libepoxy opens them again. */
static bool libraries_present(char problem[256])
{
    if (!dlopen("libEGL.so.1", RTLD_LAZY | RTLD_LOCAL)) {
        snprintf(problem, 256, "libEGL.so.1 cannot be loaded; install the package libegl1");
        return false;
    }
    if (!dlopen("libOpenGL.so.0", RTLD_LAZY | RTLD_LOCAL) &&
        !dlopen("libGL.so.1", RTLD_LAZY | RTLD_LOCAL)) {
        snprintf(problem, 256, "libOpenGL.so.0 cannot be loaded; install the package libopengl0");
        return false;
    }
    return true;
}

static void name_device(struct kiln_egl_source *source, size_t index)
{
    snprintf(source->name, sizeof source->name, "EGL device %zu", index);
    PFNEGLQUERYDEVICESTRINGEXTPROC query_string =
        (PFNEGLQUERYDEVICESTRINGEXTPROC)eglGetProcAddress("eglQueryDeviceStringEXT");
    if (!query_string)
        return;
    const char *extensions = query_string(source->device, EGL_EXTENSIONS);
    if (has_extension(extensions, "EGL_MESA_device_software")) {
        source->software = true;
        snprintf(source->name, sizeof source->name, "Mesa's software device");
    }
    if (!has_extension(extensions, "EGL_EXT_device_drm"))
        return;
    const char *file = query_string(source->device, EGL_DRM_DEVICE_FILE_EXT);
    if (file)
        snprintf(source->name, sizeof source->name, "%s", file);
}

size_t kiln_egl_sources(struct kiln_egl_source sources[KILN_MAX_EGL_SOURCES], char problem[256])
{
    problem[0] = '\0';
    if (!libraries_present(problem))
        return 0;
    const char *extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    size_t count = 0;
    PFNEGLQUERYDEVICESEXTPROC query_devices =
        (PFNEGLQUERYDEVICESEXTPROC)eglGetProcAddress("eglQueryDevicesEXT");
    if (query_devices && has_extension(extensions, "EGL_EXT_platform_device")) {
        EGLDeviceEXT devices[KILN_MAX_EGL_SOURCES - 1];
        EGLint found = 0;
        if (!query_devices(KILN_MAX_EGL_SOURCES - 1, devices, &found))
            found = 0;
        for (EGLint i = 0; i < found; i++) {
            sources[count] = (struct kiln_egl_source){.platform = "device", .device = devices[i]};
            name_device(&sources[count], count);
            count++;
        }
    }
    if (has_extension(extensions, "EGL_MESA_platform_surfaceless"))
        sources[count++] = (struct kiln_egl_source){
            .platform = "surfaceless", .device = NULL, .name = "surfaceless Mesa"};
    if (count == 0)
        snprintf(problem, 256,
                 "EGL has no driver that works without a display; install the package "
                 "libegl-mesa0, or the GPU vendor's EGL");
    return count;
}

/* Creates a context of OpenGL 4.5, whose core includes robustness, or else of 4.3, the least
 * version that kiln needs. If the driver supports it, a reset loses the context, so that a hung GPU
 * is an error, not a freeze. */
static EGLContext create_context(EGLDisplay display, bool debug)
{
    static const EGLint minors[] = {5, 3};
    for (size_t i = 0; i < 2; i++) {
        for (int reset = 1; reset >= 0; reset--) {
            EGLint attributes[16] = {
                EGL_CONTEXT_MAJOR_VERSION,       4,
                EGL_CONTEXT_MINOR_VERSION,       minors[i],
                EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
            size_t used = 6;
            if (debug) {
                attributes[used++] = EGL_CONTEXT_FLAGS_KHR;
                attributes[used++] = EGL_CONTEXT_OPENGL_DEBUG_BIT_KHR;
            }
            if (reset) {
                attributes[used++] = EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY;
                attributes[used++] = EGL_LOSE_CONTEXT_ON_RESET;
            }
            attributes[used] = EGL_NONE;
            EGLContext context =
                eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
            if (context != EGL_NO_CONTEXT)
                return context;
        }
    }
    return EGL_NO_CONTEXT;
}

static EGLDisplay open_display(const struct kiln_egl_source *source, char problem[256])
{
    PFNEGLGETPLATFORMDISPLAYEXTPROC get_display =
        (PFNEGLGETPLATFORMDISPLAYEXTPROC)eglGetProcAddress("eglGetPlatformDisplayEXT");
    EGLDisplay display = EGL_NO_DISPLAY;
    if (get_display)
        display =
            get_display(source->device ? EGL_PLATFORM_DEVICE_EXT : EGL_PLATFORM_SURFACELESS_MESA,
                        source->device ? source->device : (void *)EGL_DEFAULT_DISPLAY, NULL);
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, NULL, NULL)) {
        snprintf(problem, 256,
                 "the device's EGL display does not start (EGL error 0x%04x); install the package "
                 "libgl1-mesa-dri, or the GPU vendor's driver",
                 (unsigned)eglGetError());
        return EGL_NO_DISPLAY;
    }
    return display;
}

bool kiln_egl_open(const struct kiln_egl_source *source, bool debug, void **display, void **context,
                   char problem[256])
{
    *display = open_display(source, problem);
    if (*display == EGL_NO_DISPLAY)
        return false;
    static const char *const needed[] = {"EGL_KHR_no_config_context", "EGL_KHR_surfaceless_context",
                                         "EGL_KHR_create_context"};
    const char *extensions = eglQueryString(*display, EGL_EXTENSIONS);
    for (size_t i = 0; i < sizeof needed / sizeof *needed; i++) {
        if (!has_extension(extensions, needed[i])) {
            snprintf(problem, 256, "the device's EGL lacks %s; a newer driver is needed",
                     needed[i]);
            return false;
        }
    }
    if (!eglBindAPI(EGL_OPENGL_API)) {
        snprintf(problem, 256, "the device's EGL has no OpenGL, only OpenGL ES");
        return false;
    }
    *context = create_context(*display, debug);
    if (*context == EGL_NO_CONTEXT) {
        snprintf(problem, 256,
                 "the device gives no OpenGL 4.3 core context (EGL error 0x%04x); a newer driver "
                 "is needed",
                 (unsigned)eglGetError());
        return false;
    }
    if (!kiln_egl_make_current(*display, *context)) {
        snprintf(problem, 256, "the device's context does not become current (EGL error 0x%04x)",
                 (unsigned)eglGetError());
        eglDestroyContext(*display, *context);
        *context = EGL_NO_CONTEXT;
        return false;
    }
    return true;
}

/* Binds the OpenGL API first, since the bound API belongs to the thread and decides which context
 * eglGetCurrentContext returns. Does not make a context current that already is, since that would
 * flush it. */
bool kiln_egl_make_current(void *display, void *context)
{
    return eglBindAPI(EGL_OPENGL_API) &&
           (eglGetCurrentContext() == context ||
            eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context));
}

void kiln_egl_close(void *display, void *context)
{
    if (context == EGL_NO_CONTEXT)
        return;
    if (eglGetCurrentContext() == context)
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);
}

struct kiln_egl_current kiln_egl_current(void)
{
    char problem[256];
    struct kiln_egl_current current = {NULL, NULL};
    if (!libraries_present(problem) || !eglBindAPI(EGL_OPENGL_API))
        return current;
    current.display = eglGetCurrentDisplay();
    current.context = eglGetCurrentContext();
    return current;
}

void kiln_egl_restore(const struct kiln_egl_current *current)
{
    if (current->context != EGL_NO_CONTEXT)
        kiln_egl_make_current(current->display, current->context);
}
