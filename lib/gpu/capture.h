/* A kiln_capture holds the GL objects for draws with transform feedback, which write the outputs of
 * the vertex or geometry stage to buffers and rasterise nothing. */
#ifndef KILN_GPU_CAPTURE_H
#define KILN_GPU_CAPTURE_H

#include "gpu/device.h"

/* A zero-initialised kiln_capture holds nothing and may be finished. */
struct kiln_capture {
    GLuint vertex_array; /* its attributes are uvec4s, interleaved in one vertex buffer */
    GLuint framebuffer;
};

/* attributes: the number of uvec4s of a vertex, at locations 0, 1, ... Returns false with an error
 * on failure; kiln_capture_finish frees all objects, also then. */
bool kiln_capture_init(struct kiln_capture *capture, struct kiln_device *device, GLuint attributes,
                       struct kiln_error *error);
void kiln_capture_finish(struct kiln_capture *capture);

/* Between kiln_capture_begin and kiln_capture_end, the vertex array and the framebuffer are bound
 * and draws are not rasterised. */
void kiln_capture_begin(const struct kiln_capture *capture);
void kiln_capture_end(void);

#endif
