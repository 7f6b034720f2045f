/* Lays out a figure as a grid below a title. A cell of the grid has a picture, with its insets and
 * its label below. Text and cells are measured first, then marks are added to the drawing. */
#include "figure/layout.h"

#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/log.h"
#include "compare/magma.h"
#include "figure/font.h"
#include "figure/inset.h"

struct theme {
    uint32_t paper, ink, faint, rule;
};

static const struct theme light_theme = {0xffffff, 0x24272b, 0x6c7278, 0xd8dbde};
static const struct theme dark_theme = {0x15171a, 0xe4e6e8, 0x9aa0a6, 0x3a3e43};

/* Colours that are distinct with any colour vision (after Okabe and Ito), and visible on fire. */
static const uint32_t inset_colors[KILN_MAX_INSETS] = {0x56b4e9, 0xe69f00, 0x00b97f, 0xe07bb5};

struct layout {
    struct kiln_drawing *drawing;
    const struct kiln_panels *panels;
    const struct kiln_figure_params *params;
    const struct theme *theme;
    double letter;    /* the height of labels' capitals, in pixels */
    uint32_t capital; /* `letter`, rounded up to whole pixels */
    uint32_t size;    /* font size of the labels, in pixels */
    uint32_t line;    /* the width of thin lines */
    uint32_t margin, gap, row_gap;
    uint32_t top_space;      /* from the upper edge to the title's capitals, or to the pictures */
    uint32_t bottom_space;   /* from the last baseline to the lower edge */
    uint32_t widest_picture; /* the width of the widest picture, in its own pixels */
    uint32_t inset_own, inset_shown; /* widths of the inset that is enlarged most */
    uint32_t columns, rows;
    uint32_t cell_width, picture_height, inset_height;
    uint32_t label_height; /* includes the space above the label; 0 without labels */
    uint32_t top;          /* y of the grid's upper edge */
    struct kiln_error *error;
};

uint32_t kiln_layout_paper(bool dark)
{
    return dark ? dark_theme.paper : light_theme.paper;
}

static void add_text(const struct layout *l, int64_t x, int64_t baseline, double capital,
                     uint32_t color, const char *text)
{
    kiln_drawing_add(l->drawing, &(struct kiln_mark){.kind = KILN_MARK_TEXT,
                                                     .x = (int32_t)x,
                                                     .y = (int32_t)baseline,
                                                     .capital = capital,
                                                     .color = color,
                                                     .text = text});
}

/* Returns `length`, reduced so that no UTF-8 character is cut there. */
static size_t whole_characters(const char *text, size_t length)
{
    while (length > 0 && ((unsigned char)text[length] & 0xc0) == 0x80)
        length--;
    return length;
}

/* Returns the text, or its start with an ellipsis if it is too wide; NULL when memory is short. */
static const char *fit_text(const struct layout *l, const char *text, double capital,
                            uint32_t width)
{
    static const char ellipsis[] = "\xe2\x80\xa6";
    size_t fits = 0, high = strlen(text);
    char *start = kiln_arena_alloc(l->drawing->arena, high + sizeof ellipsis, 1);
    if (!start || kiln_drawing_text_width(text, capital) <= width)
        return start ? text : NULL;
    while (high - fits > 1) {
        size_t length = (fits + high) / 2, end = whole_characters(text, length);
        memcpy(start, text, end);
        memcpy(start + end, ellipsis, sizeof ellipsis);
        if (kiln_drawing_text_width(start, capital) <= width)
            fits = length;
        else
            high = length;
    }
    size_t end = whole_characters(text, fits);
    memcpy(start, text, end);
    memcpy(start + end, ellipsis, sizeof ellipsis);
    return start;
}

/* Scales a length in pixels by to / from; the result is at least 1. */
static uint32_t scale_length(uint32_t length, uint32_t to, uint32_t from)
{
    uint64_t result = ((uint64_t)length * to + from / 2) / from;
    return result > 0 ? (uint32_t)result : 1;
}

/* ---- Insets --------------------------------------------------------------------------------- */

/* Returns the height of a picture's insets, which all have the same height; 0 if they do not fit.
 * Together they fill the panel's width, but are at most 0.6 (a single inset) or 0.8 (several) of
 * the picture's height. */
static uint32_t inset_height(const struct layout *l, const struct kiln_pixels *pixels,
                             uint32_t width, uint32_t height)
{
    size_t count = l->params->inset_count;
    double aspects = 0;
    for (size_t i = 0; i < count; i++) {
        struct kiln_rect rect =
            kiln_inset_rect(&l->params->insets[i], pixels->width, pixels->height);
        aspects += (double)rect.width / rect.height;
    }
    if (count == 0 || width < (count - 1) * l->gap / 2 + count)
        return 0;
    double fitting = (width - (double)(count - 1) * (l->gap / 2)) / aspects;
    double most = count == 1 ? height * 0.6 : height * 0.8;
    return (uint32_t)(fitting < most ? fitting : most);
}

static bool crop(const struct layout *l, const struct kiln_pixels *pixels, struct kiln_rect rect,
                 struct kiln_pixels *out)
{
    uint8_t *rgba = kiln_arena_alloc(l->drawing->arena, (size_t)rect.width * rect.height, 4);
    if (!rgba)
        return false;
    for (uint32_t y = 0; y < rect.height; y++)
        memcpy(rgba + (size_t)y * rect.width * 4,
               pixels->rgba + ((size_t)(rect.y + y) * pixels->width + rect.x) * 4,
               (size_t)rect.width * 4);
    *out = (struct kiln_pixels){rect.width, rect.height, rgba};
    return true;
}

/* Reduces a mark's picture to the pixels that it has on paper, if the request gives the pixels of
 * an inch. Otherwise SVG and PDF carry the picture at its own size. */
static void reduce(const struct layout *l, struct kiln_mark *mark)
{
    bool larger = mark->pixels.width > mark->width || mark->pixels.height > mark->height;
    if (l->params->dpi == 0 || !larger)
        return;
    uint8_t *rgba = kiln_arena_alloc(l->drawing->arena, (size_t)mark->width * mark->height, 4);
    if (rgba && kiln_pixels_resize(&mark->pixels, mark->width, mark->height, rgba))
        mark->pixels = (struct kiln_pixels){mark->width, mark->height, rgba};
    else
        l->drawing->failed = true;
}

/* Adds for each inset a frame in the picture, which has its corner at (x, y) and the given size,
 * and the enlarged inset in a row below the picture. */
static void add_insets(const struct layout *l, const struct kiln_pixels *pixels, uint32_t x,
                       uint32_t y, uint32_t width, uint32_t height)
{
    uint32_t at = x, row = inset_height(l, pixels, width, height);
    for (size_t i = 0; i < l->params->inset_count; i++) {
        struct kiln_rect rect =
            kiln_inset_rect(&l->params->insets[i], pixels->width, pixels->height);
        struct kiln_mark mark = {
            .kind = KILN_MARK_FRAME, .color = inset_colors[i], .stroke = 2 * l->line};
        mark.x = (int32_t)(x + (uint64_t)rect.x * width / pixels->width - l->line);
        mark.y = (int32_t)(y + (uint64_t)rect.y * height / pixels->height - l->line);
        mark.width = (uint32_t)((uint64_t)rect.width * width / pixels->width) + 2 * l->line;
        mark.height = (uint32_t)((uint64_t)rect.height * height / pixels->height) + 2 * l->line;
        kiln_drawing_add(l->drawing, &mark);
        bool last = i + 1 == l->params->inset_count;
        uint32_t shown = scale_length(rect.width, row, rect.height);
        if (last && shown + 4 >= x + width - at) /* fills what rounding left over */
            shown = x + width - at;
        mark = (struct kiln_mark){.kind = KILN_MARK_PICTURE, .x = (int32_t)at};
        mark.y = (int32_t)(y + l->picture_height + l->gap / 2);
        mark.width = shown;
        mark.height = row;
        if (!crop(l, pixels, rect, &mark.pixels)) {
            l->drawing->failed = true;
            return;
        }
        reduce(l, &mark);
        kiln_drawing_add(l->drawing, &mark);
        /* This frame covers the inset's edge, which viewers of SVG and PDF round to whole
         * pixels. */
        mark.kind = KILN_MARK_FRAME;
        mark.x -= (int32_t)l->line;
        mark.y -= (int32_t)l->line;
        mark.width += 2 * l->line;
        mark.height += 2 * l->line;
        mark.color = inset_colors[i];
        mark.stroke = 2 * l->line;
        kiln_drawing_add(l->drawing, &mark);
        at += shown + l->gap / 2;
    }
}

/* ---- Cells ---------------------------------------------------------------------------------- */

static void picture_size(const struct layout *l, const struct kiln_pixels *pixels, uint32_t *width,
                         uint32_t *height)
{
    *width = pixels->width;
    *height = pixels->height;
    if (l->params->paper_width_mm > 0) {
        *width = scale_length(pixels->width, l->cell_width, l->widest_picture);
        *height = scale_length(pixels->height, l->cell_width, l->widest_picture);
    } else if (l->params->width > 0 && pixels->width > l->params->width) {
        *width = l->params->width;
        *height = scale_length(pixels->height, *width, pixels->width);
    }
}

/* Adds the colour scale of an error map, from black for no error to pale yellow for the error 1.
 * The scale ends at x = `right`. */
static void add_scale(const struct layout *l, uint32_t right, uint32_t baseline)
{
    enum { LENGTH = 64, GAP = 4 };
    uint32_t line = l->line, one = kiln_drawing_text_width("1", l->letter);
    uint32_t left = right - one - (GAP + LENGTH) * line;
    add_text(l, right - one, baseline, l->letter, l->theme->faint, "1");
    add_text(l, left - GAP * line - kiln_drawing_text_width("0", l->letter), baseline, l->letter,
             l->theme->faint, "0");
    for (uint32_t i = 0; i < LENGTH; i++) {
        uint8_t rgb[3];
        kiln_magma_color(((float)i + 0.5f) / LENGTH, rgb);
        struct kiln_mark mark = {.kind = KILN_MARK_FILL,
                                 .x = (int32_t)(left + i * line),
                                 .y = (int32_t)(baseline - l->capital),
                                 .width = line,
                                 .height = l->capital};
        mark.color = (uint32_t)rgb[0] << 16 | (uint32_t)rgb[1] << 8 | rgb[2];
        kiln_drawing_add(l->drawing, &mark);
    }
}

static void add_label(const struct layout *l, size_t index, uint32_t x, uint32_t baseline)
{
    const struct kiln_panel *panel = &l->panels->items[index];
    uint32_t width = l->cell_width, scale = 12 * l->capital;
    if (panel->is_map && width > 2 * scale) {
        add_scale(l, x + width, baseline);
        width -= scale;
    }
    const char *text = fit_text(l, panel->label, l->letter, width);
    if (text)
        add_text(l, x, baseline, l->letter, l->theme->ink, text);
    else
        l->drawing->failed = true;
}

/* Returns the x of a column's left edge. If the request gives a width on paper, the pixels that the
 * cells leave over are spread over the gaps. */
static uint32_t column_left(const struct layout *l, uint32_t column)
{
    if (l->params->paper_width_mm > 0)
        return l->margin + (uint32_t)((uint64_t)column *
                                      (l->drawing->width - 2 * l->margin + l->gap) / l->columns);
    return l->margin + column * (l->cell_width + l->gap);
}

static void add_cell(const struct layout *l, size_t index)
{
    const struct kiln_panel *panel = &l->panels->items[index];
    uint32_t column = (uint32_t)index % l->columns, row = (uint32_t)index / l->columns;
    uint32_t below = l->inset_height ? l->inset_height + l->gap / 2 : 0;
    uint32_t x = column_left(l, column);
    uint32_t y = l->top + row * (l->picture_height + below + l->label_height + l->row_gap);
    struct kiln_mark mark = {
        .kind = KILN_MARK_PICTURE, .x = (int32_t)x, .y = (int32_t)y, .pixels = panel->pixels};
    picture_size(l, &panel->pixels, &mark.width, &mark.height);
    reduce(l, &mark);
    kiln_drawing_add(l->drawing, &mark);
    if (!l->params->plain)
        kiln_drawing_add(l->drawing, &(struct kiln_mark){.kind = KILN_MARK_FRAME,
                                                         .x = mark.x - (int32_t)l->line,
                                                         .y = mark.y - (int32_t)l->line,
                                                         .width = mark.width + 2 * l->line,
                                                         .height = mark.height + 2 * l->line,
                                                         .color = l->theme->rule,
                                                         .stroke = l->line});
    if (l->params->inset_count > 0)
        add_insets(l, &panel->pixels, x, y, mark.width, mark.height);
    if (l->label_height > 0)
        add_label(l, index, x, y + l->picture_height + below + l->label_height);
}

/* ---- The whole figure ----------------------------------------------------------------------- */

static bool any_label(const struct layout *l)
{
    if (l->params->unlabelled || l->params->plain)
        return false;
    for (size_t i = 0; i < l->panels->count; i++) {
        if (*l->panels->items[i].label)
            return true;
    }
    return l->params->label_count > 0;
}

/* Measures the lettering and all lengths that depend on its size. A light figure of a given width
 * on paper has a margin of one line only, since the document around it has margins already. */
static void measure_text(struct layout *l)
{
    const struct kiln_figure_params *params = l->params;
    double dpi = params->dpi > 0 ? params->dpi : 96;
    bool sized = params->paper_width_mm > 0, labels = any_label(l);
    if (params->text_points > 0) {
        double pixels = params->text_points * dpi / 72;
        l->letter = pixels * KILN_FONT_CAPITAL / KILN_FONT_EM;
        l->size = (uint32_t)(pixels + 0.5);
        l->capital = (uint32_t)ceil(l->letter);
    } else {
        l->size = params->text_size;
        l->capital = (l->size * 10 + 7) / 14;
        l->letter = l->capital;
    }
    l->line = sized && dpi > 96 ? (uint32_t)(dpi / 96 + 0.5) : 1;
    l->margin = params->plain ? 0 : sized && !params->dark ? l->line : l->size * 3 / 2;
    l->gap = params->plain ? 0 : l->size;
    l->label_height = labels ? l->capital + l->size * 3 / 4 : 0;
    l->row_gap = labels ? l->size * 10 / 7 : l->gap;
    uint32_t above = l->capital * 7 / 5 * (KILN_FONT_ASCENT - KILN_FONT_CAPITAL) / 100 + 1;
    uint32_t below = l->capital * KILN_FONT_DESCENT / 100 + 1;
    bool titled = params->title && *params->title;
    l->top_space = titled && above > l->margin ? above : l->margin;
    l->bottom_space = labels && below > l->margin ? below : l->margin;
}

/* Warns if pictures or insets are enlarged: repeated pixels look coarse in print, and scenes can be
 * rendered larger instead. */
static void warn_of_enlarging(const struct layout *l)
{
    if (l->widest_picture < l->cell_width && !l->params->check)
        kiln_log_write(&l->params->log, KILN_LOG_WARNING,
                       "%s: pictures of %u pixels are enlarged to %u pixels for %u pixels an inch; "
                       "a larger --size renders scenes sharper",
                       l->params->output, l->widest_picture, l->cell_width, l->params->dpi);
    else if (l->inset_own < l->inset_shown && !l->params->check)
        kiln_log_write(&l->params->log, KILN_LOG_WARNING,
                       "%s: insets of %u pixels are enlarged to %u pixels for %u pixels an inch; a "
                       "larger --size renders scenes sharper",
                       l->params->output, l->inset_own, l->inset_shown, l->params->dpi);
}

/* Measures the cells of a figure of a given width on paper. */
static bool measure_cells_on_paper(struct layout *l)
{
    enum { LEAST = 16 };
    const struct kiln_figure_params *params = l->params;
    int64_t paper = llround(params->paper_width_mm / 25.4 * params->dpi);
    int64_t rest = paper - 2 * (int64_t)l->margin - (int64_t)(l->columns - 1) * l->gap;
    if (rest < (int64_t)LEAST * l->columns)
        return kiln_error_set(
            l->error, KILN_USAGE,
            "--width %g mm: found %lld pixels at %u pixels an inch; %u pictures in a row need %lld",
            params->paper_width_mm, (long long)paper, params->dpi, l->columns,
            (long long)(paper - rest) + (long long)LEAST * l->columns);
    l->drawing->width = (uint32_t)(paper < UINT32_MAX ? paper : UINT32_MAX);
    l->cell_width = (uint32_t)(rest / l->columns < KILN_MAX_FIGURE_EDGE ? rest / l->columns
                                                                        : KILN_MAX_FIGURE_EDGE);
    return true;
}

static void measure_insets(struct layout *l, const struct kiln_pixels *pixels, uint32_t row)
{
    for (size_t i = 0; i < l->params->inset_count; i++) {
        struct kiln_rect rect =
            kiln_inset_rect(&l->params->insets[i], pixels->width, pixels->height);
        uint32_t shown = scale_length(rect.width, row, rect.height);
        if ((uint64_t)shown * l->inset_own >= (uint64_t)l->inset_shown * rect.width) {
            l->inset_own = rect.width;
            l->inset_shown = shown;
        }
    }
}

static bool measure(struct layout *l)
{
    const struct kiln_panels *panels = l->panels;
    measure_text(l);
    size_t columns = l->params->columns ? l->params->columns : panels->columns;
    l->columns = (uint32_t)(columns < panels->count ? columns : panels->count);
    l->columns = l->columns > 0 ? l->columns : 1;
    l->rows = (uint32_t)((panels->count + l->columns - 1) / l->columns);
    for (size_t i = 0; i < panels->count; i++) {
        uint32_t own = panels->items[i].pixels.width;
        l->widest_picture = own > l->widest_picture ? own : l->widest_picture;
    }
    if (l->params->paper_width_mm > 0 && !measure_cells_on_paper(l))
        return false;
    for (size_t i = 0; i < panels->count; i++) {
        uint32_t width, height;
        picture_size(l, &panels->items[i].pixels, &width, &height);
        l->cell_width = width > l->cell_width ? width : l->cell_width;
        l->picture_height = height > l->picture_height ? height : l->picture_height;
        uint32_t row = inset_height(l, &panels->items[i].pixels, width, height);
        if (row == 0 && l->params->inset_count > 0)
            return kiln_error_set(l->error, KILN_USAGE,
                                  "--inset: found %zu insets that are too flat to be shown below a "
                                  "picture of %u pixels",
                                  l->params->inset_count, width);
        l->inset_height = row > l->inset_height ? row : l->inset_height;
        measure_insets(l, &panels->items[i].pixels, row);
    }
    l->top = l->top_space;
    return true;
}

/* Adds the title, with a thin line below it. */
static void add_title(struct layout *l)
{
    uint32_t capital = l->capital * 7 / 5, width = l->drawing->width - 2 * l->margin;
    uint32_t baseline = l->top_space + capital;
    double letter = l->params->text_points > 0 ? l->letter * 7 / 5 : capital;
    const char *text = fit_text(l, l->params->title, letter, width);
    if (!text) {
        l->drawing->failed = true;
        return;
    }
    add_text(l, l->margin, baseline, letter, l->theme->ink, text);
    kiln_drawing_add(l->drawing, &(struct kiln_mark){.kind = KILN_MARK_FILL,
                                                     .x = (int32_t)l->margin,
                                                     .y = (int32_t)(baseline + capital * 3 / 4),
                                                     .width = width,
                                                     .height = l->line,
                                                     .color = l->theme->rule});
}

static bool check_request(const struct layout *l)
{
    const struct kiln_figure_params *params = l->params;
    if (params->label_count > 0 && params->label_count != l->panels->count)
        return kiln_error_set(l->error, KILN_USAGE, "found %zu labels where %zu are needed",
                              params->label_count, l->panels->count);
    for (size_t i = 0; i < l->panels->count; i++) {
        const struct kiln_pixels *pixels = &l->panels->items[i].pixels;
        if (!kiln_insets_check(params, pixels->width, pixels->height, l->error))
            return false;
    }
    return true;
}

bool kiln_layout_make(struct kiln_drawing *drawing, const struct kiln_panels *panels,
                      const struct kiln_figure_params *params, struct kiln_error *error)
{
    struct layout l = {.drawing = drawing,
                       .panels = panels,
                       .params = params,
                       .theme = params->dark ? &dark_theme : &light_theme,
                       .error = error};
    if (!check_request(&l) || !measure(&l))
        return false;
    bool titled = params->title && *params->title;
    if (titled)
        l.top += l.capital * 7 / 5 * 11 / 4;
    uint64_t below = l.inset_height ? l.inset_height + l.gap / 2 : 0;
    uint64_t row = l.picture_height + below + l.label_height + l.row_gap;
    uint64_t width = 2 * (uint64_t)l.margin + (uint64_t)l.columns * (l.cell_width + l.gap) - l.gap;
    uint64_t height = l.top + l.rows * row - l.row_gap + l.bottom_space;
    if (params->paper_width_mm > 0)
        width = drawing->width;
    if (width > KILN_MAX_FIGURE_EDGE || height > KILN_MAX_FIGURE_EDGE ||
        width * height > KILN_MAX_FIGURE_PIXELS)
        return kiln_error_set(error, KILN_USAGE,
                              "the figure would have %llu x %llu pixels; allowed are %d a side and "
                              "%d in all: make its panels smaller with --width or --dpi",
                              (unsigned long long)width, (unsigned long long)height,
                              (int)KILN_MAX_FIGURE_EDGE, (int)KILN_MAX_FIGURE_PIXELS);
    if (params->paper_width_mm > 0)
        warn_of_enlarging(&l);
    drawing->width = (uint32_t)width;
    drawing->height = (uint32_t)height;
    drawing->paper = l.theme->paper;
    drawing->title = titled ? params->title : NULL;
    drawing->alt = params->alt;
    drawing->pixel_mm = params->paper_width_mm > 0 ? params->paper_width_mm / (double)width
                        : params->dpi > 0          ? 25.4 / params->dpi
                                                   : 0;
    if (titled)
        add_title(&l);
    for (size_t i = 0; i < panels->count; i++)
        add_cell(&l, i);
    return !drawing->failed || kiln_error_no_memory(error, "the layout of a figure");
}
