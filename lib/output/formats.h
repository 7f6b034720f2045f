/* Declares what kiln can write, one row a format. To add a format, write a file with these
 * functions and add a row to formats.c. */
#ifndef KILN_OUTPUT_FORMATS_H
#define KILN_OUTPUT_FORMATS_H

#include "base/pattern.h"
#include "base/temporary.h"
#include "output/output.h"

/* An encoder makes one file: of one picture, or of all when one_file is set. Encoders of different
 * files run on different threads at once; one encoder's calls never overlap. The parameters and the
 * file outlive it. Whoever calls commits or discards the file; a format of one file that has others
 * commits all. */
struct kiln_video_settings;
/* Parameters that some formats heed and others do not. */
enum { KILN_USES_PNG_BITS = 1, KILN_USES_EXR_BITS = 2, KILN_USES_QUALITY = 4 };
struct kiln_format {
    const char *suffix; /* with its dot, lower case */
    const char *also;   /* another suffix that it goes by, or NULL */
    const char *name;
    const char *help;
    uint32_t uses; /* bits of the above */
    bool one_file; /* all frames go into one file, in order and, unless `gaps`, without gaps */
    bool gaps;
    bool is_stream; /* params.stream takes the frames: there is no file, nothing to finish or commit
                     */
    const struct kiln_video_settings *video; /* of those by FFmpeg, else NULL */
    struct kiln_output_needs (*needs)(const struct kiln_output_params *params);
    /* What can be refused before any file is touched. */
    bool (*check)(const struct kiln_output_params *params, struct kiln_error *error);
    void *(*open)(const struct kiln_output_params *params, struct kiln_temporary *file,
                  struct kiln_error *error);
    bool (*encode)(void *encoder, const struct kiln_picture *picture, struct kiln_error *error);
    /* Writes what is still missing; NULL when nothing is. Failed writes may be left to the commit
     * to report. What takes longer than a second asks the caller (which may be NULL) meanwhile. */
    bool (*finish)(void *encoder, const struct kiln_caller *caller, struct kiln_error *error);
    /* Gives the file its name, and files that belong to it theirs: all or none. NULL: there are no
     * others. */
    bool (*commit)(void *encoder, struct kiln_error *error);
    void (*close)(void *encoder); /* with or without a finish before */
    /* Other files may belong to the file: this gives the ending that takes the place of the suffix
     * in the name of each, and NULL behind the last. NULL instead of the function: there are none.
     */
    const char *(*beside)(const struct kiln_output_params *params, uint32_t index);
};

extern const struct kiln_format kiln_format_png;
extern const struct kiln_format kiln_format_jpeg;
extern const struct kiln_format kiln_format_exr;
extern const struct kiln_format kiln_format_mp4;
extern const struct kiln_format kiln_format_webm;
extern const struct kiln_format kiln_format_mkv;
extern const struct kiln_format kiln_format_mov;
extern const struct kiln_format kiln_format_gif;
extern const struct kiln_format kiln_format_apng;
extern const struct kiln_format kiln_format_webp;
extern const struct kiln_format kiln_format_stream; /* not in the table: it has no suffix */

/* The format for the path's suffix, in any case of letters; NULL with KILN_USAGE and the list. */
const struct kiln_format *kiln_format_find(const char *path, struct kiln_error *error);

/* How the files of complete parameters are named. */
enum kiln_numbering kiln_output_numbering(const struct kiln_output_params *params);

/* The name of a file that belongs to another: an ending takes the place of that one's suffix. False
 * when it does not fit. */
bool kiln_format_beside(const char *path, const char *ending, char beside[KILN_PATH_SIZE]);

/* Encodes a picture as PNG into the open file. Of params, scene_hash (with seed and flipbook) is
 * what matters; the picture brings the rest. Asks the caller (which may be NULL) meanwhile. */
bool kiln_png_write(const struct kiln_output_params *params, const struct kiln_picture *picture,
                    struct kiln_temporary *file, const struct kiln_caller *caller,
                    struct kiln_error *error);

#endif
