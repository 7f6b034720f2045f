/* Writes and reads the sidecar of a figure, FILE.png.figure.json. It says by what the figure was
 * made, from what, and what came out. */
#ifndef KILN_FIGURE_RECORD_H
#define KILN_FIGURE_RECORD_H

#include "base/text.h"
#include "figure/panels.h"

#define KILN_RECORD_SUFFIX ".figure.json"

struct kiln_record {
    const char *version;  /* of kiln */
    const char *folder;   /* where the command was given, from the folder of the sidecar */
    const char **command; /* the words after `kiln` */
    size_t command_count;
    const char *device, *driver, *cpu; /* as in kiln_maker */
    uint32_t width, height;
    const char *alt;    /* what the figure shows, in words; NULL: not said */
    const char *pixels; /* SHA-256 of the figure's pixels, also of what is written as vectors */
    const char *file;   /* SHA-256 of the figure's file */
    struct kiln_panel *panels; /* without their pixels */
    size_t panel_count;
};

/* Makes the text of a sidecar, which the caller frees. */
bool kiln_record_write(const struct kiln_record *record, struct kiln_text *text,
                       struct kiln_error *error);

/* Reads the text of a sidecar, which must end in a zero byte that size does not count, into the
 * arena. name stands for it in messages. NULL with KILN_INVALID_INPUT when it is no sidecar. */
struct kiln_record *kiln_record_parse(struct kiln_arena *arena, const char *text, size_t size,
                                      const char *name, struct kiln_error *error);

/* Reads the file of a sidecar, as kiln_record_parse reads its text. */
struct kiln_record *kiln_record_read(struct kiln_arena *arena, const char *path,
                                     struct kiln_error *error);

#endif
