/* Declares the file of one part of a clip, which waits beside the clip until all parts are there.
 * It has packets of the encoder, or, for formats that need the whole clip at once, pictures
 * compressed without loss. */
#ifndef KILN_OUTPUT_PART_FILE_H
#define KILN_OUTPUT_PART_FILE_H

#include "base/temporary.h"
#include "output/output.h"

/* Describes the content of a file. Texts end in 0. */
struct kiln_part_head {
    uint32_t part, parts; /* number of this part, from 0, and number of all parts */
    /* position of the part's first frame in the clip; number of its frames */
    uint32_t first, frames;
    bool packets;      /* true: the file has packets; false: it has pictures */
    char clip[65];     /* hash of the clip that the part belongs to (kiln_clip_hash) */
    char made_by[128]; /* versions of kiln and of the encoder's library */
};

/* Hashes everything but the pictures that decides the bytes of a clip: SHA-256, in hex, of scene,
 * format, settings and frames. False when memory is short. */
bool kiln_clip_hash(const struct kiln_output_params *params, char hash[65]);

/* Writes the versions of kiln and of the encoder's library, as they go into the heads of parts. */
void kiln_part_made_by(char text[128]);

/* Writes a file: first the head, then blocks of bytes, then the end. The temporary file keeps
 * errors of writing. */
struct kiln_part_out {
    struct kiln_temporary *file;
    uint32_t crc;
};
void kiln_part_begin(struct kiln_part_out *out, struct kiln_temporary *file,
                     const struct kiln_part_head *head);
void kiln_part_add(struct kiln_part_out *out, const void *bytes, size_t size);
void kiln_part_add_word(struct kiln_part_out *out, uint32_t word);
void kiln_part_end(struct kiln_part_out *out);

/* Reads a file. Opening checks the whole file: KILN_INVALID_INPUT with the reason when it is no
 * part, cut off or changed in any byte, KILN_IO. */
struct kiln_part_in {
    const char *path;
    FILE *file;
    uint64_t left; /* bytes that are left before the checksum */
    struct kiln_part_head head;
};
bool kiln_part_open(struct kiln_part_in *in, const char *path, struct kiln_error *error);
bool kiln_part_read(struct kiln_part_in *in, void *bytes, size_t size, struct kiln_error *error);
bool kiln_part_read_word(struct kiln_part_in *in, uint32_t *word, struct kiln_error *error);
bool kiln_part_refuse(const struct kiln_part_in *in, const char *reason, struct kiln_error *error);
void kiln_part_close(struct kiln_part_in *in);

#endif
