/* Declares what kiln-decode asks of the module kiln-openexr.so, which has OpenEXR's C++ library and
 * is opened for the files that OpenEXR's C core cannot decode. */
#ifndef KILN_DECODE_EXR_MODULE_H
#define KILN_DECODE_EXR_MODULE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The struct says where the module writes the samples of one channel. */
struct kiln_openexr_channel {
    const char *name; /* in the part */
    void *first;      /* for the first sample of the data window */
    size_t step;      /* samples to the next one to the right */
    size_t stride;    /* samples to the next one below */
    int sampling;     /* pixels a sample and axis */
    int whole;        /* as uint32_t; else as float */
};

/* The enum says what becomes of the samples of a pixel of a deep part. */
enum kiln_openexr_deep {
    KILN_OPENEXR_NOT_DEEP,
    KILN_OPENEXR_FLATTEN, /* they cover each other, from front to back */
    KILN_OPENEXR_NEAREST, /* the one with the least Z counts; a pixel without samples is 0 */
};

struct kiln_openexr_request {
    const unsigned char *bytes; /* content of the file */
    size_t size;
    int part;
    int32_t data_window[4]; /* left, top, right, bottom: both edges are inside */
    enum kiln_openexr_deep deep;
    const struct kiln_openexr_channel *channels;
    size_t channel_count;
};

enum kiln_openexr_result { KILN_OPENEXR_DONE, KILN_OPENEXR_BROKEN, KILN_OPENEXR_NO_MEMORY };

/* Decodes channels. message: gets the library's words for a broken file. */
__attribute__((visibility("default"))) enum kiln_openexr_result
kiln_openexr_read(const struct kiln_openexr_request *request, char *message, size_t message_size);

#ifdef __cplusplus
}
#endif

#endif
