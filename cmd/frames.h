/* Parses frames as a user types them: "0-149,200", "170-", "-30", "last", "0-100/10". */
#ifndef KILN_CMD_FRAMES_H
#define KILN_CMD_FRAMES_H

#include "kiln_program.h"

/* One piece of the text between commas: a frame or a range. */
struct frame_piece {
    uint32_t first, last;
    uint32_t step;                    /* at least 1: every step-th frame from `first` on */
    bool first_is_last, last_is_last; /* the clip's last frame instead of the number */
};

/* A parsed text. Which frames it means depends on the clip. */
struct frame_spec {
    struct frame_piece *pieces;
    size_t count;
};

/* Names the spellings that are allowed, for errors. */
#define FRAMES_EXPECTED "frames and ranges, such as 0-149,200 or 170- or -30 or last or 0-100/10"

/* The place of the wrong piece in the text, in bytes. */
struct frame_piece_place {
    size_t start, length;
    bool no_memory; /* memory was short; the text is not wrong */
};

/* Parses a text whose pieces may come in any order and overlap. Returns false, with an empty spec,
 * when a piece is wrong or memory is short. */
bool frame_spec_parse(const char *text, struct frame_spec *spec, struct frame_piece_place *wrong);
void frame_spec_free(struct frame_spec *spec);

/* Returns whether the frames depend on the length of the clip. */
bool frame_spec_is_open(const struct frame_spec *spec);

/* Ranges of frames, ascending and disjoint; neighbouring ranges are merged. */
struct frame_list {
    struct kiln_frame_range *ranges;
    size_t count;
};

enum frame_result { FRAMES_OK, FRAMES_BEYOND, FRAMES_NO_MEMORY };

/* Fills in the frames that a spec means for a clip whose last frame is `last`. Returns
 * FRAMES_BEYOND with the wrong number in *frame if a frame is beyond the clip. The list must be
 * freed. */
enum frame_result frame_list_create(struct frame_list *list, const struct frame_spec *spec,
                                    uint32_t last, uint32_t *frame);
void frame_list_free(struct frame_list *list);

#endif
