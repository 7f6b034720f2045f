/* Writes and reads the sidecar of a figure, FILE.png.figure.json. The sidecar records the command,
 * the device and the sources that made the figure, and hashes of the result. */
#ifndef KILN_FIGURE_RECORD_H
#define KILN_FIGURE_RECORD_H

#include "base/text.h"
#include "figure/panels.h"

#define KILN_RECORD_SUFFIX ".figure.json"

struct kiln_record {
    const char *version;  /* version of kiln */
    const char *folder;   /* working directory of the command, from the folder of the sidecar */
    const char **command; /* the words after `kiln` */
    size_t command_count;
    const char *device, *driver, *cpu; /* as in struct kiln_renderer */
    uint32_t width, height;
    const char *alt;    /* description for screen readers; may be NULL */
    const char *pixels; /* SHA-256 of the figure's pixels; an SVG or PDF is rasterised for it */
    const char *file;   /* SHA-256 of the figure's file */
    struct kiln_panel *panels; /* read from a file, they have no pixels */
    size_t panel_count;
};

/* Makes the text of a sidecar, which the caller frees. */
bool kiln_record_write(const struct kiln_record *record, struct kiln_text *text,
                       struct kiln_error *error);

/* Parses the text of a sidecar into the arena. The text must end in a zero byte, which `size` does
 * not count; `name` names it in messages. NULL with KILN_INVALID_INPUT when it is no sidecar. */
struct kiln_record *kiln_record_parse(struct kiln_arena *arena, const char *text, size_t size,
                                      const char *name, struct kiln_error *error);

/* Reads the file of a sidecar, and parses it as kiln_record_parse does. */
struct kiln_record *kiln_record_read(struct kiln_arena *arena, const char *path,
                                     struct kiln_error *error);

#endif
