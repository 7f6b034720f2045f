/* lib/figure: the lettering, the panels of sweeps, the layout, what is written and read back. */
#include <locale.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <wchar.h>

#include "asset/image/image.h"
#include "base/hash.h"
#include "figure/font.h"
#include "figure/font_glyphs.h"
#include "figure/layout.h"
#include "figure/record.h"
#include "figure/sweep.h"
#include "support/cmocka.h"
#include "support/errors.h"

/* ---- Lettering ------------------------------------------------------------------------------ */

static void require_range(uint32_t first, uint32_t last, const char *without)
{
    for (uint32_t code = first; code <= last; code++) {
        char text[8];
        snprintf(text, sizeof text, "%lc", (wint_t)code);
        if (!kiln_font_has(code) && !(*text && strstr(without, text)))
            fail_msg("no glyph for U+%04X", code);
    }
}

/* U+00AD only says where a word may be parted, and U+03A2 is no letter. */
static void the_font_has_latin_greek_and_mathematics(void **state)
{
    (void)state;
    assert_non_null(setlocale(LC_CTYPE, "C.UTF-8"));
    require_range(' ', '~', "");
    require_range(0xA0, 0x17F, "\u00AD");
    require_range(0x391, 0x3A9, "\u03A2");
    require_range(0x3AA, 0x3CE, "");
    require_range(0x2010, 0x2015, "");
    require_range(0x2074, 0x208E, "");
    uint32_t code;
    const char *signs = "‘’‚“”„‹›…†‡•‰€™←↑→↓↔⇒∀∂∃∇∈∉∏∑−√∝∞∧∨∩∪∫≈≠≡≤≥≪≫⊂⊃⁰ⁿ½⅓ΆΈΉΊΌΎΏẞȘșȚț";
    assert_null(kiln_font_missing(signs, &code));
    const char *text = "ab中c";
    assert_ptr_equal(kiln_font_missing(text, &code), text + 2);
    assert_int_equal(code, 0x4E2D);
}

static void tables_of_the_font_are_in_order(void **state)
{
    (void)state;
    for (uint32_t i = 1; i < kiln_font_glyph_count; i++)
        assert_true(kiln_font_glyphs[i - 1].code < kiln_font_glyphs[i].code);
    for (uint32_t i = 1; i < kiln_font_mark_count; i++)
        assert_true(kiln_font_marks[i - 1].code < kiln_font_marks[i].code);
    for (uint32_t i = 0; i < kiln_font_letter_count; i++) {
        const struct kiln_font_letter *letter = &kiln_font_letters[i];
        assert_true(i == 0 || kiln_font_letters[i - 1].code < letter->code);
        assert_true(kiln_font_has(letter->base));
        assert_true(letter->mark == 0 || kiln_font_has(letter->mark));
        for (uint32_t k = 0; k < kiln_font_glyph_count; k++)
            assert_true(kiln_font_glyphs[k].code != letter->code);
        for (uint32_t k = 0; k < kiln_font_letter_count; k++)
            assert_true(kiln_font_letters[k].code != letter->base);
    }
}

struct bounds {
    double left, right, bottom, top;
    int moves;
};

static void reach(struct bounds *bounds, double x, double y)
{
    bounds->left = x < bounds->left ? x : bounds->left;
    bounds->right = x > bounds->right ? x : bounds->right;
    bounds->bottom = y < bounds->bottom ? y : bounds->bottom;
    bounds->top = y > bounds->top ? y : bounds->top;
}

static void on_move(void *user, double x, double y)
{
    ((struct bounds *)user)->moves++;
    reach(user, x, y);
}

static void on_line(void *user, double x, double y)
{
    reach(user, x, y);
}

static void on_curve(void *user, const double points[6])
{
    reach(user, points[4], points[5]);
}

static struct bounds bounds_of(const char *text)
{
    struct bounds bounds = {1e9, -1e9, 1e9, -1e9, 0};
    kiln_font_draw(text, &(struct kiln_font_pen){on_move, on_line, on_curve, &bounds});
    return bounds;
}

/* Neighbours do not run into each other, lines not into lines, and no two glyphs are the same. */
static void glyphs_stay_in_their_room(void **state)
{
    (void)state;
    const double pen = KILN_FONT_PEN / 2.0;
    for (uint32_t code = '!'; code < 0x2FFF; code++) {
        char text[8];
        snprintf(text, sizeof text, "%lc", (wint_t)code);
        if (!kiln_font_has(code) || kiln_font_advance(code) == 0)
            continue;
        struct bounds bounds = bounds_of(text);
        if (bounds.moves == 0)
            continue; /* a space */
        if (bounds.left < -6 || bounds.right > kiln_font_advance(code) + 4 ||
            bounds.bottom - pen < -KILN_FONT_DESCENT || bounds.top + pen > KILN_FONT_ASCENT)
            fail_msg("U+%04X reaches from %g to %g, %g to %g", code, bounds.left, bounds.right,
                     bounds.bottom, bounds.top);
    }
    for (uint32_t i = 1; i < kiln_font_glyph_count; i++)
        for (uint32_t k = i + 1; k < kiln_font_glyph_count && *kiln_font_glyphs[i].path; k++)
            assert_true(strcmp(kiln_font_glyphs[i].path, kiln_font_glyphs[k].path) != 0);
}

/* Letters are drawn alike whether their marks come with them or behind them. */
static void marks_join_their_letters(void **state)
{
    (void)state;
    static const char *const pairs[][2] = {
        {"é", "e\u0301"}, {"Ž", "Z\u030C"}, {"ş", "s\u0327"}, {"ü!", "u\u0308!"}};
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        struct bounds one = bounds_of(pairs[i][0]), two = bounds_of(pairs[i][1]);
        assert_memory_equal(&one, &two, sizeof one);
        assert_int_equal(kiln_font_width(pairs[i][0]), kiln_font_width(pairs[i][1]));
    }
    assert_true(bounds_of("i\u0302").moves == 2); /* its dot has gone */
    assert_true(bounds_of("É").top > bounds_of("é").top);
}

static void broken_utf8_is_lettered_all_the_same(void **state)
{
    (void)state;
    const char *text = "\xff\xc2\xb0";
    assert_int_equal(kiln_font_next(&text), 0xFFFD);
    assert_int_equal(kiln_font_next(&text), 0xB0);
    assert_int_equal(kiln_font_next(&text), 0);
    assert_int_equal(kiln_font_width("\xff"), kiln_font_width("\xe4\xb8\xad"));
}

/* ---- Sweeps --------------------------------------------------------------------------------- */

static void sweeps_make_their_product(void **state)
{
    (void)state;
    static const char *const scenes[] = {"a.yaml"};
    static const struct kiln_figure_sweep sweeps[] = {
        {KILN_SWEEP_KEY, "systems.*.emit.rate=5,20000"},
        {KILN_SWEEP_TOGETHER, "x.scale=[2, 2],[1, 1]"},
        {KILN_SWEEP_KEY, "post.bloom.kind=none"},
        {KILN_SWEEP_KEY, "time=1,2.5 s,3"},
    };
    struct kiln_figure_params params = kiln_figure_defaults();
    params.inputs = scenes;
    params.input_count = 1;
    params.sweeps = sweeps;
    params.sweep_count = 4;
    struct kiln_arena *arena = kiln_arena_create();
    struct kiln_choices choices;
    struct kiln_error error = {0};
    assert_true(kiln_choices_make(arena, &params, &choices, &error));
    assert_int_equal(choices.count, 6);
    assert_int_equal(choices.last_axis, 3);
    const struct kiln_choice *choice = &choices.items[4];
    assert_string_equal(choice->label, "rate = 20000, bloom.kind = none, 2.5 s");
    assert_int_equal(choice->override_count, 3);
    assert_string_equal(choice->overrides[0], "systems.*.emit.rate=20000");
    assert_string_equal(choice->overrides[1], "x.scale=[1, 1]");
    assert_int_equal(choice->moment, KILN_MOMENT_TIME);
    assert_true(choice->when == 2.5);
    kiln_arena_destroy(&arena);
}

/* ---- Layout --------------------------------------------------------------------------------- */

enum { WIDTH = 96, HEIGHT = 54, PANELS = 4 };

struct figure {
    struct kiln_arena *arena;
    struct kiln_panels panels;
    struct kiln_drawing drawing;
    struct kiln_figure_params params;
    uint8_t rgba[WIDTH * HEIGHT * 4];
};

static int make_figure(void **state)
{
    struct figure *figure = calloc(1, sizeof *figure);
    figure->arena = kiln_arena_create();
    figure->drawing.arena = figure->panels.arena = figure->arena;
    figure->panels.items = kiln_arena_alloc(figure->arena, PANELS, sizeof *figure->panels.items);
    figure->panels.count = PANELS;
    figure->panels.columns = 2;
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        figure->rgba[4 * i] = (uint8_t)i;
        figure->rgba[4 * i + 1] = (uint8_t)(i / WIDTH);
        figure->rgba[4 * i + 3] = 255;
    }
    for (size_t i = 0; i < PANELS; i++)
        figure->panels.items[i] = (struct kiln_panel){
            .label = "a < b & \"c\"", .source = "s", .pixels = {WIDTH, HEIGHT, figure->rgba}};
    figure->params = kiln_figure_defaults();
    *state = figure;
    return 0;
}

static int free_figure(void **state)
{
    struct figure *figure = *state;
    kiln_arena_destroy(&figure->arena);
    free(figure);
    return 0;
}

static bool overlap(const struct kiln_mark *a, const struct kiln_mark *b)
{
    return a->x < b->x + (int32_t)b->width && b->x < a->x + (int32_t)a->width &&
           a->y < b->y + (int32_t)b->height && b->y < a->y + (int32_t)a->height;
}

static void pictures_lie_apart_and_on_the_paper(void **state)
{
    struct figure *figure = *state;
    static const struct kiln_figure_inset insets[] = {{0.1, 0.2, 0.3, 0.4, true},
                                                      {40, 20, 16, 9, false}};
    figure->params.insets = insets;
    figure->params.inset_count = 2;
    figure->params.title = "A title";
    struct kiln_error error = {0};
    assert_true(kiln_layout_make(&figure->drawing, &figure->panels, &figure->params, &error));
    int pictures = 0;
    for (size_t i = 0; i < figure->drawing.count; i++) {
        const struct kiln_mark *mark = &figure->drawing.marks[i];
        if (mark->kind != KILN_MARK_PICTURE)
            continue;
        pictures++;
        assert_true(mark->x > 0 && mark->x + (int32_t)mark->width < (int32_t)figure->drawing.width);
        assert_true(mark->y > 0 &&
                    mark->y + (int32_t)mark->height < (int32_t)figure->drawing.height);
        for (size_t k = 0; k < i; k++)
            assert_true(figure->drawing.marks[k].kind != KILN_MARK_PICTURE ||
                        !overlap(mark, &figure->drawing.marks[k]));
    }
    assert_int_equal(pictures, PANELS * 3);
}

/* What a reader sees of a panel is that panel, to the bit. */
static void pixels_are_those_of_the_panels(void **state)
{
    struct figure *figure = *state;
    struct kiln_error error = {0};
    struct kiln_pixels pixels;
    assert_true(kiln_layout_make(&figure->drawing, &figure->panels, &figure->params, &error));
    assert_true(kiln_drawing_rasterise(&figure->drawing, &pixels, &error));
    const struct kiln_mark *mark = &figure->drawing.marks[0];
    assert_int_equal(mark->width, WIDTH);
    for (uint32_t y = 0; y < HEIGHT; y++)
        assert_memory_equal(
            pixels.rgba + 4 * ((size_t)(mark->y + (int32_t)y) * pixels.width + (size_t)mark->x),
            figure->rgba + (size_t)4 * WIDTH * y, (size_t)4 * WIDTH);
    uint8_t *bytes;
    size_t size;
    assert_true(kiln_pixels_png(&pixels, NULL, &bytes, &size, &error));
    struct kiln_asset_image *image = kiln_asset_image_parse(bytes, size, "figure", &error);
    assert_non_null(image);
    assert_memory_equal(image->pixels, pixels.rgba, (size_t)pixels.width * pixels.height * 4);
    kiln_asset_image_destroy(&image);
    free(bytes);
    free(pixels.rgba);
}

static const uint8_t *find_bytes(const uint8_t *bytes, size_t size, const char *what, size_t length)
{
    const uint8_t *found = memmem(bytes, size, what, length);
    assert_non_null(found);
    return found + length;
}

/* What was asked for holds on paper whatever the format, and the words are in the file. */
static void figures_have_their_width_on_paper(void **state)
{
    struct figure *figure = *state;
    static const char alt[] = "Four ramps, \xce\xb1 to \xce\xb4";
    struct kiln_error error = {0};
    struct kiln_pixels pixels;
    uint8_t *bytes;
    size_t size;
    figure->params.paper_width_mm = 84;
    figure->params.dpi = 300;
    figure->params.text_points = 8;
    figure->params.alt = alt;
    assert_true(kiln_layout_make(&figure->drawing, &figure->panels, &figure->params, &error));
    assert_int_equal(figure->drawing.width, 992);
    for (size_t i = 0; i < figure->drawing.count; i++) {
        const struct kiln_mark *mark = &figure->drawing.marks[i];
        if (mark->kind == KILN_MARK_TEXT)
            assert_float_equal(kiln_drawing_font_size(mark->capital) * 72 / 300, 8, 1e-9);
        assert_true(mark->x >= 0 && mark->x + (int32_t)mark->width <= 992);
    }
    assert_true(kiln_drawing_rasterise(&figure->drawing, &pixels, &error));
    const struct kiln_imprint imprint = {300, alt};
    assert_true(kiln_pixels_png(&pixels, &imprint, &bytes, &size, &error));
    assert_memory_equal(find_bytes(bytes, size, "pHYs", 4), "\0\0\x2e\x23\0\0\x2e\x23\1", 9);
    find_bytes(bytes, size, "iTXtDescription\0\0\0\0\0Four ramps, \xce\xb1 to \xce\xb4", 38);
    free(bytes);
    assert_true(kiln_pixels_jpeg(&pixels, &imprint, &bytes, &size, &error));
    assert_memory_equal(bytes + 13, "\1\x01\x2c\x01\x2c", 5);
    find_bytes(bytes, size, alt, sizeof alt - 1);
    struct kiln_asset_image *image = kiln_asset_image_parse(bytes, size, "jpeg", &error);
    assert_non_null(image);
    kiln_asset_image_destroy(&image);
    free(bytes);
    assert_true(kiln_drawing_svg(&figure->drawing, &bytes, &size, &error));
    find_bytes(bytes, size, " width=\"84mm\"", 13);
    find_bytes(bytes, size, ">a &lt; b &amp; &quot;c&quot;</text>", 34);
    free(bytes);
    free(pixels.rgba);
    figure->params.columns = 4;
    figure->params.paper_width_mm = 10;
    assert_false(kiln_layout_make(&figure->drawing, &figure->panels, &figure->params, &error));
    expect_error(
        &error, KILN_USAGE,
        "--width 10 mm: found 118 pixels at 300 pixels an inch; 4 pictures in a row need 169");
}

/* Panel by panel, edge to edge. */
static void plain_pictures_have_no_paper(void **state)
{
    struct figure *figure = *state;
    struct kiln_error error = {0};
    struct kiln_pixels pixels;
    figure->params.plain = true;
    assert_true(kiln_layout_make(&figure->drawing, &figure->panels, &figure->params, &error));
    assert_true(kiln_drawing_rasterise(&figure->drawing, &pixels, &error));
    assert_int_equal(pixels.width, 2 * WIDTH);
    assert_int_equal(pixels.height, 2 * HEIGHT);
    for (size_t y = 0; y < pixels.height; y++)
        for (size_t x = 0; x < pixels.width; x += WIDTH)
            assert_memory_equal(pixels.rgba + 4 * (y * pixels.width + x),
                                figure->rgba + 4 * (y % HEIGHT * WIDTH), (size_t)4 * WIDTH);
    free(pixels.rgba);
}

/* JPEG loses little of what eyes see, nothing of where colours end, and is the same twice. */
static void jpegs_look_like_their_pixels(void **state)
{
    (void)state;
    static const uint8_t colors[4][4] = {
        {0, 0, 0, 255}, {255, 255, 255, 255}, {230, 40, 20, 255}, {10, 60, 200, 255}};
    enum { EDGE = 64 };
    static uint8_t rgba[EDGE * EDGE * 4];
    for (size_t i = 0; i < (size_t)EDGE * EDGE; i++)
        memcpy(rgba + 4 * i, colors[i / (EDGE * 16) % 2 * 2 + i % EDGE / 16 % 2], 4);
    struct kiln_error error = {0};
    const struct kiln_pixels pixels = {EDGE, EDGE, rgba};
    uint8_t *bytes[2];
    size_t sizes[2];
    for (int i = 0; i < 2; i++)
        assert_true(kiln_pixels_jpeg(&pixels, NULL, &bytes[i], &sizes[i], &error));
    assert_int_equal(sizes[0], sizes[1]);
    assert_memory_equal(bytes[0], bytes[1], sizes[0]);
    assert_memory_equal(bytes[0] + 6, "JFIF", 5);
    struct kiln_asset_image *image = kiln_asset_image_parse(bytes[0], sizes[0], "jpeg", &error);
    assert_non_null(image);
    assert_int_equal(image->width, EDGE);
    assert_int_equal(image->height, EDGE);
    const uint8_t *decoded = (const uint8_t *)image->pixels;
    for (size_t i = 0; i < sizeof rgba; i++)
        assert_true(abs(decoded[i] - rgba[i]) <= 3);
    kiln_asset_image_destroy(&image);
    free(bytes[0]);
    free(bytes[1]);
}

static void lettering_is_there_and_has_smooth_edges(void **state)
{
    struct figure *figure = *state;
    figure->drawing.width = 200;
    figure->drawing.height = 40;
    figure->drawing.paper = 0xffffff;
    struct kiln_mark mark = {.kind = KILN_MARK_TEXT, .x = 10, .y = 30, .capital = 20, .text = "IH"};
    kiln_drawing_add(&figure->drawing, &mark);
    struct kiln_pixels pixels;
    struct kiln_error error = {0};
    assert_true(kiln_drawing_rasterise(&figure->drawing, &pixels, &error));
    int black = 0, grey = 0;
    for (size_t i = 0; i < (size_t)200 * 40; i++) {
        black += pixels.rgba[4 * i] == 0;
        grey += pixels.rgba[4 * i] > 0 && pixels.rgba[4 * i] < 255;
    }
    assert_in_range(black, 60, 260); /* three stems of 20 pixels and a bar, 2.4 wide */
    assert_in_range(grey, 20, 260);
    free(pixels.rgba);
}

/* A reduced picture has the light of the larger one. */
static void reducing_averages_light(void **state)
{
    (void)state;
    uint8_t checks[4 * 4 * 4], out[2 * 2 * 4];
    for (size_t i = 0; i < 16; i++)
        memset(checks + 4 * i, (i + i / 4) % 2 ? 255 : 0, 4);
    assert_true(kiln_pixels_resize(&(struct kiln_pixels){4, 4, checks}, 2, 2, out));
    for (size_t i = 0; i < 4; i++)
        assert_int_equal(out[4 * i], 188); /* half of white's light, in sRGB */
}

static void requests_that_make_no_sense_are_refused(void **state)
{
    struct figure *figure = *state;
    struct kiln_error error = {0};
    static const struct kiln_figure_inset outside = {0.9, 0.2, 0.3, 0.4, true};
    figure->params.insets = &outside;
    figure->params.inset_count = 1;
    assert_false(kiln_layout_make(&figure->drawing, &figure->panels, &figure->params, &error));
    expect_error(&error, KILN_USAGE,
                 "--inset 0.9,0.2,0.3x0.4: found a part that is not in a picture of 96 x 54");
    figure->params.inset_count = 0;
    for (size_t i = 0; i < PANELS; i++)
        figure->panels.items[i].pixels.height = 20000;
    assert_false(kiln_layout_make(&figure->drawing, &figure->panels, &figure->params, &error));
    expect_error(&error, KILN_USAGE,
                 "the figure would have 248 x 40102 pixels; allowed are 32768 a side and 134217728 "
                 "in all: make its panels smaller with --width or --dpi");
}

/* ---- Files ---------------------------------------------------------------------------------- */

static void vectors_are_the_same_twice_and_need_no_font(void **state)
{
    struct figure *figure = *state;
    struct kiln_error error = {0};
    assert_true(kiln_layout_make(&figure->drawing, &figure->panels, &figure->params, &error));
    bool (*const writers[])(const struct kiln_drawing *, uint8_t **, size_t *,
                            struct kiln_error *) = {kiln_drawing_svg, kiln_drawing_pdf};
    for (int i = 0; i < 2; i++) {
        uint8_t *bytes[2];
        size_t sizes[2];
        for (int k = 0; k < 2; k++)
            assert_true(writers[i](&figure->drawing, &bytes[k], &sizes[k], &error));
        assert_int_equal(sizes[0], sizes[1]);
        assert_memory_equal(bytes[0], bytes[1], sizes[0]);
        if (i == 0) {
            assert_null(strstr((char *)bytes[0], "fill-opacity=\"1\""));
            assert_non_null(strstr((char *)bytes[0], ">a &lt; b &amp; &quot;c&quot;</text>"));
        } else {
            assert_non_null(memmem(bytes[0], sizes[0], "/FontFile2", 10));
            assert_memory_equal(bytes[0] + sizes[0] - 6, "%%EOF\n", 6);
            const char *start = strstr((char *)bytes[0] + sizes[0] - 40, "startxref\n");
            assert_non_null(start);
            assert_memory_equal(bytes[0] + strtol(start + 10, NULL, 10), "xref\n", 5);
        }
        free(bytes[0]);
        free(bytes[1]);
    }
}

static void sidecars_come_back_as_they_were(void **state)
{
    struct figure *figure = *state;
    static const char *command[] = {"figure", "sheet", "a \"b\".yaml", "\xc3\xa9\n"};
    struct kiln_panel *panel = &figure->panels.items[1];
    panel->has_frame = true;
    panel->frame = 30;
    memset(panel->scene_hash, 'a', 64);
    memcpy(panel->state, "0123456789abcdef", 17);
    for (size_t i = 0; i < PANELS; i++)
        memset(figure->panels.items[i].hash, 'b', 64);
    struct kiln_record record = {.version = "1.2.3",
                                 .folder = "../..",
                                 .command = command,
                                 .command_count = 4,
                                 .device = "a GPU",
                                 .driver = "1.0",
                                 .cpu = "",
                                 .width = 10,
                                 .height = 20,
                                 .pixels = panel->hash,
                                 .file = panel->scene_hash,
                                 .panels = figure->panels.items,
                                 .panel_count = PANELS};
    struct kiln_text text = {0};
    struct kiln_error error = {0};
    assert_true(kiln_record_write(&record, &text, &error));
    char path[] = "/tmp/kiln-figure-XXXXXX";
    int file = mkstemp(path);
    assert_true(file >= 0 && write(file, text.data, text.length) == (ssize_t)text.length);
    close(file);
    struct kiln_record *read = kiln_record_read(figure->arena, path, &error);
    unlink(path);
    if (!read)
        fail_msg("%s", error.message);
    assert_int_equal(read->command_count, 4);
    for (size_t i = 0; i < 4; i++)
        assert_string_equal(read->command[i], command[i]);
    assert_string_equal(read->folder, "../..");
    assert_string_equal(read->driver, "1.0");
    assert_int_equal(read->height, 20);
    assert_int_equal(read->panel_count, PANELS);
    assert_string_equal(read->panels[1].state, panel->state);
    assert_int_equal(read->panels[1].frame, 30);
    assert_string_equal(read->panels[0].scene_hash, "");
    struct kiln_text again = {0};
    assert_true(kiln_record_write(read, &again, &error));
    assert_string_equal(again.data, text.data);
    kiln_text_free(&again);
    kiln_text_free(&text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_font_has_latin_greek_and_mathematics),
        cmocka_unit_test(tables_of_the_font_are_in_order),
        cmocka_unit_test(marks_join_their_letters),
        cmocka_unit_test(glyphs_stay_in_their_room),
        cmocka_unit_test(broken_utf8_is_lettered_all_the_same),
        cmocka_unit_test(sweeps_make_their_product),
        cmocka_unit_test(reducing_averages_light),
        cmocka_unit_test_setup_teardown(pictures_lie_apart_and_on_the_paper, make_figure,
                                        free_figure),
        cmocka_unit_test_setup_teardown(pixels_are_those_of_the_panels, make_figure, free_figure),
        cmocka_unit_test_setup_teardown(figures_have_their_width_on_paper, make_figure,
                                        free_figure),
        cmocka_unit_test_setup_teardown(plain_pictures_have_no_paper, make_figure, free_figure),
        cmocka_unit_test(jpegs_look_like_their_pixels),
        cmocka_unit_test_setup_teardown(lettering_is_there_and_has_smooth_edges, make_figure,
                                        free_figure),
        cmocka_unit_test_setup_teardown(requests_that_make_no_sense_are_refused, make_figure,
                                        free_figure),
        cmocka_unit_test_setup_teardown(vectors_are_the_same_twice_and_need_no_font, make_figure,
                                        free_figure),
        cmocka_unit_test_setup_teardown(sidecars_come_back_as_they_were, make_figure, free_figure),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
