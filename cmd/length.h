/* Reads lengths on the command line: a number of pixels, or a length on paper. */
#ifndef KILN_CMD_LENGTH_H
#define KILN_CMD_LENGTH_H

#include "kiln_program.h"

struct length {
    double value;  /* pixels, or millimetres on paper */
    bool on_paper; /* "84mm", "8.4cm", "3.3in" or "240pt"; else "480" or "480px", a whole number */
};

/* Reads a length. Returns false when the text is no length. */
bool length_read(const char *text, struct length *length);

#endif
