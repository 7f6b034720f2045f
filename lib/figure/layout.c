/* A grid: below each picture its insets and its label; a title above all. */
#include "figure/layout.h"

#include <math.h>
#include <string.h>

#include "base/error.h"
#include "compare/magma.h"
#include "figure/inset.h"

struct theme {
    uint32_t paper, ink, faint, rule;
};

static const struct theme light_theme = {0xffffff, 0x24272b, 0x6c7278, 0xd8dbde};
static const struct theme dark_theme = {0x15171a, 0xe4e6e8, 0x9aa0a6, 0x3a3e43};

/* Told apart by eyes of every kind (after Okabe and Ito), and on fire. */
static const uint32_t inset_colors[KILN_MAX_INSETS] = {0x56b4e9, 0xe69f00, 0x00b97f, 0xe07bb5};

struct layout {
    struct kiln_drawing *drawing;
    const struct kiln_panels *panels;
    const struct kiln_figure_params *params;
    const struct theme *theme;
    uint32_t capital; /* the height of labels' capitals */
    uint32_t margin, gap, row_gap;
    uint32_t columns, rows;
    uint32_t cell_width, picture_height, inset_height;
    uint32_t label_height; /* with the space above it; 0 without labels */
    uint32_t top;          /* where the grid starts */
    struct kiln_error *error;
};

uint32_t kiln_layout_paper(bool dark)
{
    return dark ? dark_theme.paper : light_theme.paper;
}

static void add_text(const struct layout *l, int64_t x, int64_t baseline, uint32_t capital,
                     uint32_t color, const char *text)
{
    kiln_drawing_add(l->drawing, &(struct kiln_mark){.kind = KILN_MARK_TEXT,
                                                     .x = (int32_t)x,
                                                     .y = (int32_t)baseline,
                                                     .height = capital,
                                                     .color = color,
                                                     .text = text});
}

/* The text, or its start with an ellipsis where it is too wide; NULL when memory is short. */
static const char *fit_text(const struct layout *l, const char *text, uint32_t capital,
                            uint32_t width)
{
    size_t length = strlen(text);
    const char *fitting = text;
    while (fitting && length > 0 && kiln_drawing_text_width(fitting, capital) > width) {
        length--;
        while (length > 0 && ((unsigned char)text[length] & 0xc0) == 0x80)
            length--;
        fitting = kiln_arena_format(l->drawing->arena, "%.*s\xe2\x80\xa6", (int)length, text);
    }
    return fitting;
}

/* ---- Insets --------------------------------------------------------------------------------- */

/* Insets of one height that fill the width of the panel together, or less where that would make
 * them larger than half of it. */
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

/* A frame in the picture, which lies at (x, y) with that size, and the part in a row below it. */
static void add_insets(const struct layout *l, const struct kiln_pixels *pixels, uint32_t x,
                       uint32_t y, uint32_t width, uint32_t height)
{
    uint32_t at = x, row = inset_height(l, pixels, width, height);
    for (size_t i = 0; i < l->params->inset_count; i++) {
        struct kiln_rect rect =
            kiln_inset_rect(&l->params->insets[i], pixels->width, pixels->height);
        struct kiln_mark mark = {.kind = KILN_MARK_FRAME, .color = inset_colors[i], .stroke = 2};
        mark.x = (int32_t)(x + (uint64_t)rect.x * width / pixels->width) - 1;
        mark.y = (int32_t)(y + (uint64_t)rect.y * height / pixels->height) - 1;
        mark.width = (uint32_t)((uint64_t)rect.width * width / pixels->width) + 2;
        mark.height = (uint32_t)((uint64_t)rect.height * height / pixels->height) + 2;
        kiln_drawing_add(l->drawing, &mark);
        bool last = i + 1 == l->params->inset_count;
        uint32_t shown = (uint32_t)((double)row * rect.width / rect.height);
        if (last && shown + 4 >= x + width - at) /* what rounding has left over */
            shown = x + width - at;
        mark = (struct kiln_mark){.kind = KILN_MARK_PICTURE, .x = (int32_t)at};
        mark.y = (int32_t)(y + l->picture_height + l->gap / 2);
        mark.width = shown;
        mark.height = row;
        if (row == 0 || shown == 0 || !crop(l, pixels, rect, &mark.pixels)) {
            l->drawing->failed = true;
            return;
        }
        kiln_drawing_add(l->drawing, &mark);
        mark.kind = KILN_MARK_FRAME;
        mark.color = inset_colors[i];
        mark.stroke = 2;
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
    if (l->params->width > 0 && pixels->width > l->params->width) {
        *width = l->params->width;
        uint64_t rows = ((uint64_t)pixels->height * *width + pixels->width / 2) / pixels->width;
        *height = rows > 0 ? (uint32_t)rows : 1;
    }
}

/* From black to pale yellow: no error to the largest one. It ends at `right`. */
static void add_scale(const struct layout *l, uint32_t right, uint32_t baseline)
{
    enum { LENGTH = 64 };
    uint32_t capital = l->capital, one = kiln_drawing_text_width("1", capital);
    uint32_t left = right - one - 4 - LENGTH;
    add_text(l, right - one, baseline, capital, l->theme->faint, "1");
    add_text(l, left - 4 - kiln_drawing_text_width("0", capital), baseline, capital,
             l->theme->faint, "0");
    for (uint32_t i = 0; i < LENGTH; i++) {
        uint8_t rgb[3];
        kiln_magma_color(((float)i + 0.5f) / LENGTH, rgb);
        struct kiln_mark mark = {.kind = KILN_MARK_FILL,
                                 .x = (int32_t)(left + i),
                                 .y = (int32_t)(baseline - capital),
                                 .width = 1,
                                 .height = capital};
        mark.color = (uint32_t)rgb[0] << 16 | (uint32_t)rgb[1] << 8 | rgb[2];
        kiln_drawing_add(l->drawing, &mark);
    }
}

static void add_label(const struct layout *l, size_t index, uint32_t x, uint32_t baseline)
{
    const struct kiln_panel *panel = &l->panels->items[index];
    const char *label = l->params->label_count > 0 ? l->params->labels[index] : panel->label;
    uint32_t width = l->cell_width, scale = 12 * l->capital;
    if (panel->is_map && width > 2 * scale) {
        add_scale(l, x + width, baseline);
        width -= scale;
    }
    const char *text = fit_text(l, label, l->capital, width);
    if (text)
        add_text(l, x, baseline, l->capital, l->theme->ink, text);
    else
        l->drawing->failed = true;
}

static void add_cell(const struct layout *l, size_t index)
{
    const struct kiln_panel *panel = &l->panels->items[index];
    uint32_t column = (uint32_t)index % l->columns, row = (uint32_t)index / l->columns;
    uint32_t below = l->inset_height ? l->inset_height + l->gap / 2 : 0;
    uint32_t x = l->margin + column * (l->cell_width + l->gap);
    uint32_t y = l->top + row * (l->picture_height + below + l->label_height + l->row_gap);
    struct kiln_mark mark = {
        .kind = KILN_MARK_PICTURE, .x = (int32_t)x, .y = (int32_t)y, .pixels = panel->pixels};
    picture_size(l, &panel->pixels, &mark.width, &mark.height);
    kiln_drawing_add(l->drawing, &mark);
    if (!l->params->plain)
        kiln_drawing_add(l->drawing, &(struct kiln_mark){.kind = KILN_MARK_FRAME,
                                                         .x = mark.x - 1,
                                                         .y = mark.y - 1,
                                                         .width = mark.width + 2,
                                                         .height = mark.height + 2,
                                                         .color = l->theme->rule,
                                                         .stroke = 1});
    if (l->params->inset_count > 0)
        add_insets(l, &panel->pixels, x, y, mark.width, mark.height);
    if (l->label_height > 0)
        add_label(l, index, x, y + l->picture_height + below + l->label_height);
}

/* ---- The whole ------------------------------------------------------------------------------ */

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

static void measure(struct layout *l)
{
    const struct kiln_panels *panels = l->panels;
    uint32_t size = l->params->text_size;
    l->capital = (size * 10 + 7) / 14;
    l->margin = l->params->plain ? 0 : size * 3 / 2;
    l->gap = l->params->plain ? 0 : size;
    for (size_t i = 0; i < panels->count; i++) {
        uint32_t width, height;
        picture_size(l, &panels->items[i].pixels, &width, &height);
        l->cell_width = width > l->cell_width ? width : l->cell_width;
        l->picture_height = height > l->picture_height ? height : l->picture_height;
        uint32_t row = inset_height(l, &panels->items[i].pixels, width, height);
        l->inset_height = row > l->inset_height ? row : l->inset_height;
    }
    size_t columns = l->params->columns ? l->params->columns : panels->columns;
    l->columns = (uint32_t)(columns < panels->count ? columns : panels->count);
    l->columns = l->columns > 0 ? l->columns : 1;
    l->rows = (uint32_t)((panels->count + l->columns - 1) / l->columns);
    bool labels = any_label(l);
    l->label_height = labels ? l->capital + size * 3 / 4 : 0;
    l->row_gap = labels ? size * 10 / 7 : l->gap;
    l->top = l->margin;
}

/* The title, with a thin line below it. */
static void add_title(struct layout *l)
{
    uint32_t capital = l->capital * 7 / 5, width = l->drawing->width - 2 * l->margin;
    uint32_t baseline = l->margin + capital;
    const char *text = fit_text(l, l->params->title, capital, width);
    if (!text) {
        l->drawing->failed = true;
        return;
    }
    add_text(l, l->margin, baseline, capital, l->theme->ink, text);
    kiln_drawing_add(l->drawing, &(struct kiln_mark){.kind = KILN_MARK_FILL,
                                                     .x = (int32_t)l->margin,
                                                     .y = (int32_t)(baseline + capital * 3 / 4),
                                                     .width = width,
                                                     .height = 1,
                                                     .color = l->theme->rule});
}

static bool check_request(const struct layout *l)
{
    const struct kiln_figure_params *params = l->params;
    if (params->label_count > 0 && params->label_count != l->panels->count)
        return kiln_error_set(l->error, KILN_USAGE, "found %zu labels for %zu pictures",
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
    if (!check_request(&l))
        return false;
    measure(&l);
    bool titled = params->title && *params->title;
    if (titled)
        l.top += l.capital * 7 / 5 * 11 / 4;
    uint64_t below = l.inset_height ? l.inset_height + l.gap / 2 : 0;
    uint64_t row = l.picture_height + below + l.label_height + l.row_gap;
    uint64_t width = 2 * (uint64_t)l.margin + (uint64_t)l.columns * (l.cell_width + l.gap) - l.gap;
    uint64_t height = l.top + l.rows * row - l.row_gap + l.margin;
    if (width > KILN_MAX_FIGURE_EDGE || height > KILN_MAX_FIGURE_EDGE ||
        width * height > KILN_MAX_FIGURE_PIXELS)
        return kiln_error_set(error, KILN_USAGE,
                              "the figure would have %llu x %llu pixels; allowed are %d a side and "
                              "%d in all: make its panels smaller with --width",
                              (unsigned long long)width, (unsigned long long)height,
                              (int)KILN_MAX_FIGURE_EDGE, (int)KILN_MAX_FIGURE_PIXELS);
    drawing->width = (uint32_t)width;
    drawing->height = (uint32_t)height;
    drawing->paper = l.theme->paper;
    drawing->title = titled ? params->title : NULL;
    if (titled)
        add_title(&l);
    for (size_t i = 0; i < panels->count; i++)
        add_cell(&l, i);
    return !drawing->failed ||
           kiln_error_set(error, KILN_DEVICE_FAILED, "out of memory for the layout of a figure");
}
