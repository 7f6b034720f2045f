/* A list of frames as a person writes it: "0-149,200". */
#ifndef KILN_CMD_FRAMES_H
#define KILN_CMD_FRAMES_H

#include "kiln_program.h"

/* Ascending and disjoint; neighbouring ranges are one. */
struct frame_list {
    struct kiln_frame_range *ranges;
    size_t count;
};

/* Reads a list in any order, with overlaps. False when the text is no list (list stays empty) or
 * memory is short. */
bool frame_list_parse(const char *text, struct frame_list *list);
void frame_list_free(struct frame_list *list);

/* The first frame of the list after `frame`; false if there is none. */
bool frame_list_next(const struct frame_list *list, uint32_t frame, uint32_t *next);

#endif
