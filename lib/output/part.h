/* Parts of a clip that wait in files of their own until all are there. */
#ifndef KILN_OUTPUT_PART_H
#define KILN_OUTPUT_PART_H

#include "output/formats.h"
#include "output/part_file.h"

/* A part that is being written. */
struct kiln_part_writer;

/* Parts of the whole output, and which one a frame is in. params->clip says what the whole is. */
uint32_t kiln_parts_count(const struct kiln_output_params *params);
uint32_t kiln_part_of(const struct kiln_output_params *params, uint32_t frame);
struct kiln_frame_range kiln_part_range(const struct kiln_output_params *params, uint32_t part);

/* "FOLDER/00007.part". KILN_IO when it is too long. */
bool kiln_part_path(const struct kiln_output_params *params, uint32_t part,
                    char path[KILN_PATH_SIZE], struct kiln_error *error);

/* Opens the file of a part for writing; kiln_part_finish gives it its name when all its frames
 * came. Close frees the writer, and removes what has no name yet. */
struct kiln_part_writer *kiln_part_writer_open(const struct kiln_output_params *params,
                                               uint32_t part, struct kiln_error *error);
bool kiln_part_write(struct kiln_part_writer *writer, const struct kiln_picture *picture,
                     struct kiln_error *error);
bool kiln_part_finish(struct kiln_part_writer *writer, struct kiln_error *error);
void kiln_part_writer_close(struct kiln_part_writer **writer);

/* Whether the file of a part is one of this output, whole: else KILN_INVALID_INPUT or KILN_IO with
 * what is wrong. */
bool kiln_part_check(const struct kiln_output_params *params, uint32_t part,
                     struct kiln_error *error);

/* Removes the files of parts in a folder, whole and half-written, and the folder unless there is
 * something else in it. */
void kiln_parts_remove(const char *folder);

/* Makes the clip of its parts, which stay. Errors name the part that is missing or wrong. */
bool kiln_parts_join(const struct kiln_output_params *params, struct kiln_error *error);

#endif
