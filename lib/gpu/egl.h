/* EGL without a display: which devices there are, and a context on one of them. */
#ifndef KILN_GPU_EGL_H
#define KILN_GPU_EGL_H

#include <stdbool.h>
#include <stddef.h>

enum { KILN_MAX_EGL_SOURCES = 32 };

/* A way to a device, before anything is opened. */
struct kiln_egl_source {
    const char *platform; /* "device" or "surfaceless" */
    void *device;         /* EGLDeviceEXT, or NULL */
    bool software;        /* known to be one before it is opened */
    char name[128];       /* for messages until the renderer's name is known */
};

/* Fills the sources, devices first, and returns how many there are. With none, problem says why
 * and which package mends it. */
size_t kiln_egl_sources(struct kiln_egl_source sources[KILN_MAX_EGL_SOURCES], char problem[256]);

/* Makes a core context of OpenGL 4.3 or later, current on this thread. Displays are shared by the
 * whole process and stay open; the context belongs to the caller. False: problem says why. */
bool kiln_egl_open(const struct kiln_egl_source *source, bool debug, void **display, void **context,
                   char problem[256]);
bool kiln_egl_make_current(void *display, void *context);
void kiln_egl_close(void *display, void *context);

/* What is current on this thread, to be put back later; nothing when EGL is missing. */
struct kiln_egl_current {
    void *display, *context;
};
struct kiln_egl_current kiln_egl_current(void);
void kiln_egl_restore(const struct kiln_egl_current *current);

#endif
