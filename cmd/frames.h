/* Reads frames as a person writes them: "0-149,200", "170-", "-30", "last", "0-100/10". */
#ifndef KILN_CMD_FRAMES_H
#define KILN_CMD_FRAMES_H

#include "kiln_program.h"

/* A frame or a range of the text. */
struct frame_piece {
    uint32_t first, last;
    uint32_t step;                    /* from 1; each step-th frame from the first on */
    bool first_is_last, last_is_last; /* the last frame of the clip instead of the number */
};

/* A text that has been read, and what it means for a clip is not known yet. */
struct frame_spec {
    struct frame_piece *pieces;
    size_t count;
};

/* Names the spellings that are allowed, for errors. */
#define FRAMES_EXPECTED "frames and ranges, such as 0-149,200 or 170- or -30 or last or 0-100/10"

/* The piece that makes no sense, in bytes of the text. */
struct frame_piece_place {
    size_t start, length;
    bool no_memory; /* nothing is wrong with the text */
};

/* Reads pieces in any order, with overlaps. False when one of them is none (the spec stays empty),
 * or memory is short. */
bool frame_spec_parse(const char *text, struct frame_spec *spec, struct frame_piece_place *wrong);
void frame_spec_free(struct frame_spec *spec);

/* Whether it takes the length of a clip to know the frames. */
bool frame_spec_is_open(const struct frame_spec *spec);

/* Ascending and disjoint; neighbouring ranges are one. */
struct frame_list {
    struct kiln_frame_range *ranges;
    size_t count;
};

enum frame_result { FRAMES_OK, FRAMES_BEYOND, FRAMES_NO_MEMORY };

/* The frames of a clip whose last one is `last`. FRAMES_BEYOND: *frame is none of the clip.
 * The list must be freed. */
enum frame_result frame_list_create(struct frame_list *list, const struct frame_spec *spec,
                                    uint32_t last, uint32_t *frame);
void frame_list_free(struct frame_list *list);

#endif
