/* Declares what kiln-decode asks of the module kiln-openexr.so, which has OpenEXR's C++ library and
 * is opened for the files that OpenEXR's C core cannot decode. */
#ifndef KILN_DECODE_EXR_MODULE_H
#define KILN_DECODE_EXR_MODULE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { KILN_OPENEXR_CHANNELS = 6 };

/* The struct says where the module writes the samples of one channel, as floats. */
struct kiln_openexr_channel {
    const char *name; /* in the part; NULL: none */
    float *first;     /* for the first sample of the data window */
    size_t step;      /* floats to the next sample to the right */
    size_t stride;    /* floats to the next sample below */
    int sampling;     /* pixels a sample and axis */
};

struct kiln_openexr_request {
    const unsigned char *bytes; /* content of the file */
    size_t size;
    int part;
    int32_t data_window[4]; /* left, top, right, bottom: both edges are inside */
    int deep;               /* flatten the samples of a deep part, from front to back */
    struct kiln_openexr_channel channels[KILN_OPENEXR_CHANNELS];
};

enum kiln_openexr_result { KILN_OPENEXR_DONE, KILN_OPENEXR_BROKEN, KILN_OPENEXR_NO_MEMORY };

/* Decodes channels. message: gets the library's words for a broken file. */
__attribute__((visibility("default"))) enum kiln_openexr_result
kiln_openexr_read(const struct kiln_openexr_request *request, char *message, size_t message_size);

#ifdef __cplusplus
}
#endif

#endif
