/* Reads what image files by kiln say of themselves. */
#ifndef KILN_OUTPUT_CARRIED_H
#define KILN_OUTPUT_CARRIED_H

#include "output/output.h"

/* Texts, "" where the file does not say it. */
struct kiln_carried {
    char version[32], scene[65], seed[16], frame[16];
    char fps[32];    /* "30" or "24000/1001" */
    char alpha[2];   /* of EXR, which always has the channel: "1", "0": nothing shines through */
    char quality[4]; /* of JPEG */
    uint32_t bits;   /* a channel */
};

/* Reads a PNG, JPEG or EXR file to its end. False when it is none, or not whole, with what it said
 * before that; *reason gets KILN_DEVICE_FAILED when memory was too short to look. */
bool kiln_carried_read(const char *path, struct kiln_carried *carried, struct kiln_error *reason);

#endif
