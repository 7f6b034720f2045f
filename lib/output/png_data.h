/* Compresses the pixels of a picture to the data of a PNG: a zlib stream (RFC 1950) of filtered
 * rows, in parts for IDAT chunks. */
#ifndef KILN_OUTPUT_PNG_DATA_H
#define KILN_OUTPUT_PNG_DATA_H

#include "output/output.h"

struct kiln_png_data;

/* Returns the data of a picture, which must outlive it. KILN_PNG_FAST is compressed by `threads`
 * workers; the data is the same for any number of them, and on every machine. KILN_PNG_SMALL is
 * compressed by the calling thread, depends on the version of libdeflate, and needs
 * kiln_libdeflate_open. NULL with KILN_DEVICE_FAILED when memory is short. */
struct kiln_png_data *kiln_png_data_create(const struct kiln_picture *picture,
                                           enum kiln_png_effort effort, uint32_t threads,
                                           struct kiln_error *error);

/* Compresses the next part. *bytes and *size are valid until the next call; *size is 0 behind the
 * last part, and below 2^31. Asks the caller (which may be NULL) whether to go on, and returns
 * false with its error if not, or with KILN_DEVICE_FAILED when memory is short. KILN_PNG_SMALL is
 * compressed in the first call, which takes about 2 us a pixel and asks only before. */
bool kiln_png_data_next(struct kiln_png_data *data, const struct kiln_caller *caller,
                        const uint8_t **bytes, size_t *size, struct kiln_error *error);

void kiln_png_data_destroy(struct kiln_png_data **data);

#endif
