/* lib/asset/cells_in: flipbooks out of images and videos, and how they move. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "asset/atlas/cells_in.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/pictures.h"

struct picture {
    uint32_t width, height; /* width a multiple of 4 */
    uint8_t *rgb;           /* rows from the top */
};

static struct picture make_picture(uint32_t width, uint32_t height)
{
    struct picture picture = {width, height, calloc((size_t)width * height, 3)};
    assert_non_null(picture.rgb);
    return picture;
}

static void put_le32(uint8_t *out, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        out[i] = (uint8_t)(value >> (8 * i));
}

/* Writes a BMP file and frees the picture. */
static void write_picture(struct picture *picture, const char *path)
{
    uint8_t header[54] = {'B', 'M'};
    uint32_t size = picture->width * picture->height * 3;
    put_le32(header + 2, 54 + size);
    put_le32(header + 10, 54);
    put_le32(header + 14, 40);
    put_le32(header + 18, picture->width);
    put_le32(header + 22, picture->height);
    header[26] = 1;
    header[28] = 24;
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(header, 1, sizeof header, file), sizeof header);
    for (uint32_t y = picture->height; y-- > 0;) {
        for (uint32_t x = 0; x < picture->width; x++) {
            const uint8_t *rgb = picture->rgb + ((size_t)y * picture->width + x) * 3;
            const uint8_t bgr[3] = {rgb[2], rgb[1], rgb[0]};
            assert_int_equal(fwrite(bgr, 1, 3, file), 3);
        }
    }
    assert_int_equal(fclose(file), 0);
    free(picture->rgb);
}

struct fixture {
    char folder[32], path[64], motion[64];
    struct kiln_threads *threads;
};

static int set_up(void **state)
{
    struct fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    test_make_folder(f->folder);
    snprintf(f->path, sizeof f->path, "%s/a.bmp", f->folder);
    snprintf(f->motion, sizeof f->motion, "%s/m.bmp", f->folder);
    f->threads = kiln_threads_create(2);
    assert_non_null(f->threads);
    *state = f;
    return 0;
}

static int tear_down(void **state)
{
    struct fixture *f = *state;
    test_remove_folder(f->folder);
    kiln_threads_destroy(&f->threads);
    free(f);
    return 0;
}

static float linear(uint8_t level)
{
    float x = (float)level / 255.0f;
    return x <= 0.04045f ? x / 12.92f : powf((x + 0.055f) / 1.055f, 2.4f);
}

/* Cells of one colour each keep it, next to others, shrunk and enlarged. */
static void cells_do_not_bleed(void **state)
{
    struct fixture *f = *state;
    struct picture picture = make_picture(32, 32); /* 2 x 2 cells of 16 x 16 */
    static const uint8_t levels[4] = {255, 0, 40, 120};
    for (uint32_t i = 0; i < 32 * 32; i++)
        memset(picture.rgb + (size_t)i * 3, levels[i % 32 / 16 + i / 32 / 16 * 2], 3);
    write_picture(&picture, f->path);
    static const uint32_t edges[] = {4, 12, 40};
    for (size_t e = 0; e < 3; e++) {
        uint32_t pixels = edges[e] * edges[e];
        float *cells = calloc(4 * pixels, 4 * sizeof *cells);
        assert_non_null(cells);
        struct kiln_error error = {0};
        const struct kiln_cells_source source = {f->path, 2, 2, edges[e], NULL};
        assert_true(kiln_cells_load(&source, cells, f->threads, &error));
        for (uint32_t i = 0; i < 4 * pixels; i++) {
            assert_true(fabsf(cells[4 * i] - linear(levels[i / pixels])) < 1e-5f);
            assert_true(fabsf(cells[4 * i + 3] - 1.0f) < 1e-5f);
        }
        free(cells);
    }
}

/* A cell that is four times as wide as high, or as high as wide, takes a quarter of the square, in
 * its middle. All its light is there, and what is around it is transparent. */
static void cells_keep_their_proportions(void **state)
{
    struct fixture *f = *state;
    enum { SIDE = 32 };
    for (int high = 0; high < 2; high++) {
        struct picture picture = high ? make_picture(16, 64) : make_picture(64, 16);
        memset(picture.rgb, 255, 64 * 16 * 3);
        write_picture(&picture, f->path);
        float cell[SIDE * SIDE * 4], alpha = 0.0f;
        struct kiln_error error = {0};
        const struct kiln_cells_source source = {f->path, 1, 1, SIDE, NULL};
        assert_true(kiln_cells_load(&source, cell, f->threads, &error));
        for (int i = 0; i < SIDE * SIDE; i++) {
            const int from_middle = abs((high ? i % SIDE : i / SIDE) * 2 + 1 - SIDE);
            alpha += cell[4 * i + 3];
            if (from_middle < 4)
                assert_true(fabsf(cell[4 * i + 3] - 1.0f) < 1e-5f);
            else if (from_middle > 12)
                assert_true(cell[4 * i + 3] == 0.0f && cell[4 * i] == 0.0f);
        }
        assert_true(fabsf(alpha / (SIDE * SIDE) - 0.25f) < 0.006f);
    }
}

/* Full red and green of a cell that is twice as wide as high are a whole edge of the square to the
 * right, and half of one upwards. */
static void motion_counts_edges_of_the_square(void **state)
{
    struct fixture *f = *state;
    struct picture picture = make_picture(32, 16);
    memset(picture.rgb, 255, 32 * 16 * 3);
    write_picture(&picture, f->path);
    float motion[16 * 16 * 2];
    struct kiln_error error = {0};
    const struct kiln_cells_source source = {f->path, 1, 1, 16, NULL};
    assert_true(kiln_cells_load_motion(&source, motion, f->threads, &error));
    const float *middle = motion + (8 * 16 + 8) * 2;
    assert_true(fabsf(middle[0] - 1.0f) < 1e-5f && fabsf(middle[1] - 0.5f) < 1e-5f);
    assert_true(motion[0] == 0.0f && motion[1] == 0.0f);
}

/* A ramp stays a ramp: no steps where it is enlarged, the same light where it is shrunk. */
static void cells_are_resized_smoothly(void **state)
{
    struct fixture *f = *state;
    struct picture picture = make_picture(16, 16);
    float mean = 0.0f;
    for (uint32_t i = 0; i < 16 * 16; i++) {
        memset(picture.rgb + (size_t)i * 3, (int)(100 + i % 16 * 4), 3);
        mean += linear((uint8_t)(100 + i % 16 * 4)) / 256.0f;
    }
    write_picture(&picture, f->path);
    static const uint32_t edges[] = {4, 64};
    for (size_t e = 0; e < 2; e++) {
        uint32_t edge = edges[e];
        float *cells = calloc((size_t)edge * edge, 4 * sizeof *cells), sum = 0.0f;
        assert_non_null(cells);
        struct kiln_error error = {0};
        const struct kiln_cells_source source = {f->path, 1, 1, edge, NULL};
        assert_true(kiln_cells_load(&source, cells, f->threads, &error));
        for (uint32_t i = 0; i < edge * edge; i++)
            sum += cells[4 * i] / (float)(edge * edge);
        assert_true(fabsf(sum - mean) < 0.002f);
        float widest = (linear(160) - linear(100)) / (float)edge * 1.6f;
        for (uint32_t x = edge / 8 + 1; x < edge - edge / 8; x++) {
            float step = cells[4 * x] - cells[4 * (x - 1)];
            assert_true(step > 0.0f && step < widest);
        }
        free(cells);
    }
}

/* ---- motion ---------------------------------------------------------------------------------- */

enum { EDGE = 64, COLUMNS = 4, COUNT = 16 };

/* A soft disc that travels from the lower left to the upper right of the cell in its life, and what
 * a file says of its motion: full red is half a cell. */
static float disc(float life, float x, float y)
{
    float dx = x - 0.2f - 0.6f * life, dy = y - 0.8f + 0.6f * life * life;
    return fminf(fmaxf((0.12f - sqrtf(dx * dx + dy * dy)) / 0.04f + 0.5f, 0.0f), 1.0f);
}

static const float SCALE = 0.125f;

static void write_flipbook(const struct fixture *f)
{
    struct picture picture = make_picture(COLUMNS * EDGE, COLUMNS * EDGE);
    struct picture motion = make_picture(COLUMNS * EDGE, COLUMNS * EDGE);
    for (uint32_t i = 0; i < COUNT * EDGE * EDGE; i++) {
        uint32_t px = i % (COLUMNS * EDGE), py = i / (COLUMNS * EDGE);
        float life = (float)(px / EDGE + py / EDGE * COLUMNS) / (COUNT - 1),
              next = 1.0f / (COUNT - 1);
        float light =
            disc(life, ((float)(px % EDGE) + 0.5f) / EDGE, ((float)(py % EDGE) + 0.5f) / EDGE);
        float level =
            light <= 0.0031308f ? 12.92f * light : 1.055f * powf(light, 1.0f / 2.4f) - 0.055f;
        float up = 0.6f * ((life + next) * (life + next) - life * life);
        memset(picture.rgb + (size_t)i * 3, (int)lroundf(255.0f * level), 3);
        motion.rgb[(size_t)i * 3] = (uint8_t)lroundf(128.0f + 127.0f * 0.6f * next / SCALE);
        motion.rgb[(size_t)i * 3 + 1] = (uint8_t)lroundf(128.0f + 127.0f * up / SCALE);
    }
    write_picture(&picture, f->path);
    write_picture(&motion, f->motion);
}

/* The first channel of a cell, x and y in texels. */
static float sample(const float *cell, float x, float y)
{
    float x0 = floorf(x), y0 = floorf(y), sum = 0.0f;
    for (int k = 0; k < 4; k++) {
        float px = x0 + (float)(k % 2), py = y0 + (float)(k / 2);
        float weight = (1.0f - fabsf(x - px)) * (1.0f - fabsf(y - py));
        size_t column = (size_t)fminf(fmaxf(px, 0.0f), EDGE - 1);
        size_t row = (size_t)fminf(fmaxf(py, 0.0f), EDGE - 1);
        sum += weight * cell[(row * EDGE + column) * 4];
    }
    return sum;
}

/* 16 cells of a file, played as the fragment shader does (draw/sprites/shade.glsl) at 61 times:
 * with the motion file, nearer to what was filmed than mixed, by a lot. */
static void motion_of_a_file_makes_up_for_cells(void **state)
{
    struct fixture *f = *state;
    write_flipbook(f);
    float *cells = calloc(COUNT * EDGE * EDGE, 4 * sizeof *cells);
    float *motion = calloc(COUNT * EDGE * EDGE, 2 * sizeof *motion);
    assert_true(cells && motion);
    struct kiln_error error = {0};
    struct kiln_cells_source source = {f->path, COLUMNS, COLUMNS, EDGE, NULL};
    assert_true(kiln_cells_load(&source, cells, f->threads, &error));
    source.path = f->motion;
    assert_true(kiln_cells_load_motion(&source, motion, f->threads, &error));

    double off[2] = {0};
    for (uint32_t i = 0; i < 61 * EDGE * EDGE; i++) {
        uint32_t time = i / (EDGE * EDGE), pixel = i % (EDGE * EDGE);
        size_t first = time / 4 < COUNT - 1 ? time / 4 : COUNT - 2, at = first * EDGE * EDGE;
        float part = (float)time / 4.0f - (float)first;
        float x = (float)(pixel % EDGE), y = (float)(pixel / EDGE);
        float truth = disc((float)time / 60.0f, (x + 0.5f) / EDGE, (y + 0.5f) / EDGE);
        for (int moving = 0; moving < 2; moving++) {
            float way = moving ? EDGE * SCALE : 0.0f;
            float way_x = way * motion[(at + pixel) * 2],
                  way_y = -way * motion[(at + pixel) * 2 + 1];
            float from = sample(cells + at * 4, x - part * way_x, y - part * way_y);
            float to = sample(cells + (at + EDGE * EDGE) * 4, x + (1 - part) * way_x,
                              y + (1 - part) * way_y);
            double error_here = (double)(from + (to - from) * part - truth);
            off[moving] += error_here * error_here;
        }
    }
    double gain_db = 10.0 * log10(off[0] / off[1]);
    print_message("16 cells of a file are %.1f dB nearer with motion\n", gain_db);
    assert_true(gain_db > 6.0);
    free(cells);
    free(motion);
}

static void half_of_red_and_green_is_rest(void **state)
{
    struct fixture *f = *state;
    struct picture picture = make_picture(8, 8);
    memset(picture.rgb, 128, 8 * 8 * 3);
    write_picture(&picture, f->path);
    float motion[4 * 4 * 2];
    struct kiln_error error = {0};
    const struct kiln_cells_source source = {f->path, 1, 1, 4, NULL};
    assert_true(kiln_cells_load_motion(&source, motion, f->threads, &error));
    for (int i = 0; i < 4 * 4 * 2; i++)
        assert_true(fabsf(motion[i]) < 1e-6f);
}

/* ---- videos, and files that do not fit ------------------------------------------------------- */

static void frames_of_a_video_are_cells(void **state)
{
    struct fixture *f = *state;
    char path[64];
    snprintf(path, sizeof path, "%s/x.mp4", f->folder);
    const struct kiln_frame_range range = {0, 11};
    struct kiln_output_params params = test_output_params(path, &range);
    params.quality = 95;
    struct kiln_error error = {0};
    assert_true(test_write_all(&params, &error));
    assert_true(kiln_cells_check(NULL, path, &error));

    float *cells = calloc(16 * 16 * 16, 4 * sizeof *cells);
    assert_non_null(cells);
    struct kiln_cells_source source = {path, 4, 3, 16, NULL};
    assert_true(kiln_cells_load(&source, cells, f->threads, &error));
    for (uint32_t cell = 0; cell < 12; cell++) {
        float sum = 0.0f, expected = 0.0f;
        for (uint32_t i = 0; i < 16 * 16; i++)
            sum += cells[(cell * 16 * 16 + i) * 4 + 2] / (16 * 16);
        for (uint32_t i = 0; i < 64 * 36; i++)
            expected += linear((uint8_t)test_level(cell, 64, i % 64, i / 64, 2)) / (64 * 64);
        assert_true(fabsf(sum - expected) < 0.02f);
    }
    source.rows = 4;
    assert_false(kiln_cells_load(&source, cells, f->threads, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "%s: the video has 12 frames; 4 columns and 4 rows need 16 frames", path);
    free(cells);
}

/* A frame is black on its left and white on its right, where the filter overshoots below 0. */
static void light_of_a_video_is_not_negative(void **state)
{
    struct fixture *f = *state;
    char path[64];
    snprintf(path, sizeof path, "%s/x.mp4", f->folder);
    const struct kiln_frame_range range = {0, 0};
    struct kiln_output_params params = test_output_params(path, &range);
    params.quality = 95;
    struct kiln_error error = {0};
    struct kiln_output *output = kiln_output_open(&params, &error);
    assert_non_null(output);
    struct kiln_picture *picture = test_picture(output, &params, 0);
    const size_t row = (size_t)params.width * 4 * kiln_output_needs(output).bits / 8;
    for (uint32_t y = 0; y < params.height; y++) {
        memset((char *)picture->display + y * row, 0, row / 2);
        memset((char *)picture->display + y * row + row / 2, 255, row / 2);
    }
    assert_true(kiln_output_write(output, picture, &error));
    assert_true(kiln_output_finish(output, &error));
    kiln_output_close(&output);

    float cell[16 * 16 * 4], largest = 0.0f;
    const struct kiln_cells_source source = {path, 1, 1, 16, NULL};
    assert_true(kiln_cells_load(&source, cell, f->threads, &error));
    for (size_t i = 0; i < sizeof cell / sizeof *cell; i++) {
        assert_true(cell[i] >= 0.0f);
        largest = fmaxf(largest, cell[i]);
    }
    assert_true(largest > 0.9f);
}

static void cells_must_divide_the_image(void **state)
{
    struct fixture *f = *state;
    struct picture picture = make_picture(32, 16);
    write_picture(&picture, f->path);
    float cells[6 * 4 * 4 * 4];
    struct kiln_error error = {0};
    const struct kiln_cells_source source = {f->path, 2, 3, 4, NULL};
    assert_false(kiln_cells_load(&source, cells, f->threads, &error));
    expect_error(&error, KILN_INVALID_INPUT,
                 "%s: 32 x 16 pixels do not divide into 2 columns and 3 rows", f->path);
    assert_false(kiln_cells_check_layout(&source, &error));
    assert_true(kiln_cells_check_layout(
        &(struct kiln_cells_source){.path = f->path, .columns = 2, .rows = 4}, &error));
    assert_true(kiln_cells_check(NULL, f->path, &error));
    assert_false(kiln_cells_check(NULL, f->folder, &error));
}

int main(void)
{
#define WITH_FOLDER(test) cmocka_unit_test_setup_teardown(test, set_up, tear_down)
    static const struct CMUnitTest tests[] = {
        WITH_FOLDER(cells_do_not_bleed),
        WITH_FOLDER(cells_keep_their_proportions),
        WITH_FOLDER(cells_are_resized_smoothly),
        WITH_FOLDER(motion_of_a_file_makes_up_for_cells),
        WITH_FOLDER(motion_counts_edges_of_the_square),
        WITH_FOLDER(half_of_red_and_green_is_rest),
        WITH_FOLDER(frames_of_a_video_are_cells),
        WITH_FOLDER(light_of_a_video_is_not_negative),
        WITH_FOLDER(cells_must_divide_the_image),
    };
    return cmocka_run_group_tests_name("cells", tests, NULL, NULL);
}
