/* Converts pictures to what a browser can show: 8-bit PNG. */
#ifndef KILN_REPORT_PREVIEW_H
#define KILN_REPORT_PREVIEW_H

#include "base/temporary.h"

/* Whether a file can be shown as it is: a PNG of 8 bits a channel or fewer. Also false when the
 * file cannot be read. */
bool kiln_preview_is_plain(const char *path);

/* Decodes a picture and writes it as 8-bit PNG to an open file. 16 bits are rounded. Linear light
 * goes through the ACES curve of HDR-FLIP, at one exposure for all pictures, so that they can be
 * compared. Alpha is shown on black. Fails as kiln_asset_image_load does, and with KILN_IO. */
bool kiln_preview_write(const char *path, struct kiln_temporary *file, struct kiln_error *error);

#endif
