/* The table of glyphs, ascending by code. */
#ifndef KILN_FIGURE_FONT_GLYPHS_H
#define KILN_FIGURE_FONT_GLYPHS_H

#include "figure/font.h"

extern const struct kiln_glyph kiln_font_glyphs[];
extern const uint32_t kiln_font_glyph_count;

#endif
