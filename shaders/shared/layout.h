/* Parameters that the host gives to the simulation, laid out alike in C and in a std140 block:
 * every member is a word, or starts at a multiple of 16 bytes.
 */
#ifndef KILN_SHARED_LAYOUT_H
#define KILN_SHARED_LAYOUT_H

#include "shared/platform.h"
#include "shared/value.h"

/* Births of one step that follow one another at equal distances. Birth j of a group happens at
 * (first + j * spacing) / 2^32 of the step. */
struct kiln_birth_group {
    uint count;
    uint first;
    uint spacing;
    uint unused;
};

/* The groups of a step: one of the rate and one of each burst. */
#define KILN_MAX_BIRTH_GROUPS 65

#endif
