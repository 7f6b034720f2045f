/* Reads what image files by kiln say of their scene, frame and settings. */
#ifndef KILN_OUTPUT_CARRIED_H
#define KILN_OUTPUT_CARRIED_H

#include "output/output.h"

/* Holds the texts of a file; a text is "" where the file does not have it. */
struct kiln_carried {
    char version[32], scene[65], seed[16], frame[16];
    char fps[32]; /* "30" or "24000/1001" */
    /* only EXR, which always has an alpha channel: "1", or "0" when all is opaque */
    char alpha[2];
    char quality[4]; /* only JPEG */
    uint32_t bits;   /* bits of a channel */
};

/* Reads a PNG, JPEG or EXR file to its end. False when the file is of another format or not whole;
 * then `carried` has what came before the fault. *reason gets KILN_DEVICE_FAILED when memory was
 * too short to look. */
bool kiln_carried_read(const char *path, struct kiln_carried *carried, struct kiln_error *reason);

#endif
