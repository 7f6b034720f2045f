/* Converts pictures to what a browser can show: 8-bit PNG. */
#ifndef KILN_REPORT_PREVIEW_H
#define KILN_REPORT_PREVIEW_H

#include "base/temporary.h"

/* Returns whether a browser can show a file with these bytes as it is: a PNG of at most 8 bits a
 * channel. */
bool kiln_preview_is_plain(const unsigned char *bytes, size_t size);

/* Decodes the bytes of a picture's file and writes it as 8-bit PNG to an open file. 16 bits are
 * rounded. Linear light is tone-mapped by the ACES curve of HDR-FLIP, at one exposure for all
 * pictures, so that they can be compared. Transparent parts are shown on black. `name` stands for
 * the file in messages. Fails as kiln_asset_image_parse does, and with KILN_IO. */
bool kiln_preview_write(const unsigned char *bytes, size_t size, const char *name,
                        struct kiln_temporary *file, struct kiln_error *error);

#endif
