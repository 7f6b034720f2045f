/* Declares the formats that kiln writes, one row a format. To add a format, write a file with these
 * functions and add a row to formats.c. */
#ifndef KILN_OUTPUT_FORMATS_H
#define KILN_OUTPUT_FORMATS_H

#include "base/pattern.h"
#include "base/temporary.h"
#include "output/output.h"

/* Describes a format by the functions of its encoder. An encoder makes one file: of one picture, or
 * of all when one_file is set. Encoders of different files run on different threads at once; one
 * encoder's calls never overlap. The parameters and the file outlive the encoder. The caller
 * commits or discards the file; a format that has other files beside its one file commits all of
 * them. */
struct kiln_video_settings;
/* Parameters that only some formats use. */
enum {
    KILN_USES_PNG_BITS = 1,
    KILN_USES_EXR_BITS = 2,
    KILN_USES_QUALITY = 4,
    KILN_USES_PNG_EFFORT = 8
};
struct kiln_format {
    const char *suffix; /* with the dot, in lower case */
    const char *also;   /* another suffix of the format, or NULL */
    const char *name;
    const char *help;
    uint32_t uses; /* bit mask of KILN_USES_* */
    /* all frames go into one file, in ascending order; frames may be missing only with `gaps` */
    bool one_file;
    bool gaps;
    bool is_stream; /* params.stream gets the frames: there is no file to finish or to commit */
    const struct kiln_video_settings *video; /* settings of formats that FFmpeg writes, else NULL */
    struct kiln_output_needs (*needs)(const struct kiln_output_params *params);
    /* Refuses parameters that are wrong for the format, before any file is touched. */
    bool (*check)(const struct kiln_output_params *params, struct kiln_error *error);
    void *(*open)(const struct kiln_output_params *params, struct kiln_temporary *file,
                  struct kiln_error *error);
    bool (*encode)(void *encoder, const struct kiln_picture *picture, struct kiln_error *error);
    /* Writes the rest of the file; NULL when there is none. A failed write may be left for the
     * commit to report. A step longer than a second asks the caller (which may be NULL) whether to
     * go on. */
    bool (*finish)(void *encoder, const struct kiln_caller *caller, struct kiln_error *error);
    /* Renames the file, and the files that belong to it, to their final names: all or none. NULL:
     * the format has one file alone. */
    bool (*commit)(void *encoder, struct kiln_error *error);
    void (*close)(void *encoder); /* is called with or without a finish before */
    /* Returns the ending of each file that belongs to the output's file, and NULL behind the last.
     * The ending takes the place of the suffix in the file's name. NULL instead of the function:
     * there are no such files. */
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

/* Finds the format of the path's suffix, in upper or lower case; NULL with KILN_USAGE and the list
 * of suffixes. */
const struct kiln_format *kiln_format_find(const char *path, struct kiln_error *error);

/* Returns how the files of complete parameters are named. */
enum kiln_numbering kiln_output_numbering(const struct kiln_output_params *params);

/* Makes the name of a file that belongs to another file: the ending takes the place of that file's
 * suffix. False when it does not fit. */
bool kiln_format_beside(const char *path, const char *ending, char beside[KILN_PATH_SIZE]);

/* Returns what hashes and journals have for the motion of a flipbook: 0 for none, 1 with green up,
 * 2 with green down. */
static inline uint32_t kiln_flipbook_motion_number(const struct kiln_flipbook *flipbook)
{
    return flipbook->motion ? 1 + flipbook->green_down : 0;
}

/* Encodes a picture as PNG into the open file. Of params, only scene_hash, seed, flipbook,
 * threads and png_effort are used. Asks the caller (which may be NULL) meanwhile. */
bool kiln_png_write(const struct kiln_output_params *params, const struct kiln_picture *picture,
                    struct kiln_temporary *file, const struct kiln_caller *caller,
                    struct kiln_error *error);

#endif
