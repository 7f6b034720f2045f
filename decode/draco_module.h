/* Declares what kiln-decode asks of the module kiln-draco.so, which has Draco's C++ library. */
#ifndef KILN_DECODE_DRACO_MODULE_H
#define KILN_DECODE_DRACO_MODULE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* An attribute of the points of a stream. */
struct kiln_draco_attribute {
    uint32_t id;         /* in the stream */
    uint32_t components; /* that are wanted */
    /* integers that are not quantised are divided by it; 0: they stay what they are */
    double most;
    float *values; /* result, of all points; free releases it; NULL: the stream has no such one */
};

struct kiln_draco_request {
    const unsigned char *bytes;
    size_t size;
    uint32_t most_points, most_triangles;
    struct kiln_draco_attribute *attributes;
    uint32_t attribute_count;
    uint32_t point_count, triangle_count; /* results */
    uint32_t (*triangles)[3];             /* result; free releases it */
};

enum kiln_draco_result {
    KILN_DRACO_DONE,
    KILN_DRACO_BROKEN,
    KILN_DRACO_NO_MEMORY,
    KILN_DRACO_TOO_LARGE
};

/* Decodes a stream. message: gets the library's words for a broken one. After a failure, the
 * results are to be released, too. */
__attribute__((visibility("default"))) enum kiln_draco_result
kiln_draco_read(struct kiln_draco_request *request, char *message, size_t message_size);

#ifdef __cplusplus
}
#endif

#endif
