/* What transform feedback needs around it: vertices go through their stages and are written into
 * buffers, and nothing is drawn. */
#ifndef KILN_GPU_CAPTURE_H
#define KILN_GPU_CAPTURE_H

#include "gpu/device.h"

/* Zero-initialised has nothing. */
struct kiln_capture {
    GLuint vertex_array; /* of uvec4s that follow each other in one vertex buffer */
    GLuint framebuffer;
};

/* attributes: uvec4s of a vertex, at locations 0, 1, ... False with an error; kiln_capture_finish
 * then frees what there is. */
bool kiln_capture_init(struct kiln_capture *capture, struct kiln_device *device, GLuint attributes,
                       struct kiln_error *error);
void kiln_capture_finish(struct kiln_capture *capture);

/* Points drawn between the two are not rasterised; the vertex array is bound. */
void kiln_capture_begin(const struct kiln_capture *capture);
void kiln_capture_end(void);

#endif
