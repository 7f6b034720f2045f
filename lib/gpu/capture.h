/* A kiln_capture holds the GL objects for a draw with transform feedback: vertices go through their
 * stages and are written into buffers, and nothing is rasterised. */
#ifndef KILN_GPU_CAPTURE_H
#define KILN_GPU_CAPTURE_H

#include "gpu/device.h"

/* Zero-initialised has nothing. */
struct kiln_capture {
    GLuint vertex_array; /* its attributes are uvec4s, interleaved in one vertex buffer */
    GLuint framebuffer;
};

/* attributes: how many uvec4s a vertex has, at locations 0, 1, ... Returns false with an error;
 * kiln_capture_finish then frees what was made. */
bool kiln_capture_init(struct kiln_capture *capture, struct kiln_device *device, GLuint attributes,
                       struct kiln_error *error);
void kiln_capture_finish(struct kiln_capture *capture);

/* Between kiln_capture_begin and kiln_capture_end, points are not rasterised and the vertex array
 * is bound. */
void kiln_capture_begin(const struct kiln_capture *capture);
void kiln_capture_end(void);

#endif
