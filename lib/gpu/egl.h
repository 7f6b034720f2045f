/* This header declares how EGL is used without a display: it lists devices and opens a context on
 * one of them. */
#ifndef KILN_GPU_EGL_H
#define KILN_GPU_EGL_H

#include <stdbool.h>
#include <stddef.h>

enum { KILN_MAX_EGL_SOURCES = 32 };

/* Describes a device of EGL before it is opened. */
struct kiln_egl_source {
    const char *platform; /* "device" or "surfaceless" */
    void *device;         /* EGLDeviceEXT, or NULL */
    bool software;        /* EGL reports a software device */
    char name[128];       /* for messages while GL_RENDERER is not known */
};

/* Fills the sources, EGL devices first, and returns their number. If it is 0, problem says why and
 * which package to install. */
size_t kiln_egl_sources(struct kiln_egl_source sources[KILN_MAX_EGL_SOURCES], char problem[256]);

/* Creates a core context of OpenGL 4.3 or later and makes it current on this thread. The display is
 * shared by the whole process and stays open; the caller owns the context. Returns false with the
 * reason in problem on failure. */
bool kiln_egl_open(const struct kiln_egl_source *source, bool debug, void **display, void **context,
                   char problem[256]);
bool kiln_egl_make_current(void *display, void *context);
void kiln_egl_close(void *display, void *context);

/* Holds the display and context that are current on this thread, so that they can be restored; both
 * are NULL when EGL is missing. */
struct kiln_egl_current {
    void *display, *context;
};
struct kiln_egl_current kiln_egl_current(void);
void kiln_egl_restore(const struct kiln_egl_current *current);

#endif
