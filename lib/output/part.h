/* Declares the parts of a clip. Each part is a file of its own, which waits until all parts are
 * there and are joined. */
#ifndef KILN_OUTPUT_PART_H
#define KILN_OUTPUT_PART_H

#include "output/formats.h"
#include "output/part_file.h"

/* A part that is being written. */
struct kiln_part_writer;

/* Return the number of parts of the whole output, and the part that a frame is in. params->clip has
 * the frames of the whole output. */
uint32_t kiln_parts_count(const struct kiln_output_params *params);
uint32_t kiln_part_of(const struct kiln_output_params *params, uint32_t frame);
struct kiln_frame_range kiln_part_range(const struct kiln_output_params *params, uint32_t part);

/* Makes the path "FOLDER/00007.part". KILN_IO when it is too long. */
bool kiln_part_path(const struct kiln_output_params *params, uint32_t part,
                    char path[KILN_PATH_SIZE], struct kiln_error *error);

/* Opens the file of a part for writing. kiln_part_finish renames it to its path after all its
 * frames. Close frees the writer, and removes a file that was not finished. */
struct kiln_part_writer *kiln_part_writer_open(const struct kiln_output_params *params,
                                               uint32_t part, struct kiln_error *error);
bool kiln_part_write(struct kiln_part_writer *writer, const struct kiln_picture *picture,
                     struct kiln_error *error);
bool kiln_part_finish(struct kiln_part_writer *writer, struct kiln_error *error);
void kiln_part_writer_close(struct kiln_part_writer **writer);

/* Returns whether the file of a part is whole and belongs to this output, else false with
 * KILN_INVALID_INPUT or KILN_IO and the reason. */
bool kiln_part_check(const struct kiln_output_params *params, uint32_t part,
                     struct kiln_error *error);

/* Removes the files of parts in a folder, whole and half-written. Removes the folder, too, if
 * nothing else is in it. */
void kiln_parts_remove(const char *folder);

/* Writes the clip from its parts. The parts are not removed. Errors name the part that is missing
 * or wrong. */
bool kiln_parts_join(const struct kiln_output_params *params, struct kiln_error *error);

#endif
