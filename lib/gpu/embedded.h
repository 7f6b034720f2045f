/* The files under shaders/, as the build put them into the library. */
#ifndef KILN_GPU_EMBEDDED_H
#define KILN_GPU_EMBEDDED_H

#include <stddef.h>

struct kiln_embedded_file {
    const char *path; /* under shaders/, "draw/particles.vert" */
    const char *text;
};

extern const struct kiln_embedded_file kiln_embedded_files[];
extern const size_t kiln_embedded_file_count;

#endif
