/* Writes a flipbook: an atlas of cells in rows from the top, and on request a motion atlas beside
 * it. Each cell is a frame with its padding inside, since engines divide the texture by columns and
 * rows and know nothing of gaps. Motion is estimated on smaller pictures: it is smooth, and an
 * engine filters it anyway. Green points up, as in Houdini and Unity and as `look.motion` reads it,
 * unless the caller asks for down, as Unreal has it. The files get their names together, the
 * layout's last.
 *
 * A glow or smoke that leaves the frame ends at its border, and a billboard with such a cell shows
 * a square. So cells with alpha fade out towards the border. */
#include "output/flipbook.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/json.h"
#include "base/log.h"
#include "base/ranges.h"
#include "base/sized.h"
#include "output/bleed.h"
#include "output/flow.h"
#include "scene/motion_layout.h"

enum {
    MAX_CELLS_A_SIDE = 64,
    MAX_PADDING = 256,
    MAX_FADE = 50,         /* percent */
    MAX_EDGE = 16384,      /* edge of the atlas; GPUs accept no more */
    MAX_MOTION_EDGE = 128, /* edge of a cell of the motion atlas */
    /* channels that flow is estimated from: brightness over black, and alpha */
    FEATURES = 2,
};

static const uint64_t FADE_ONE = 1 << 16; /* stands for 1 in the factors of a fade */

struct flipbook_encoder {
    const struct kiln_output_params *params;
    struct kiln_temporary *file;
    struct kiln_temporary layout_file, motion_file;
    struct kiln_picture *atlas;
    uint32_t cells;                   /* number of cells that are filled */
    uint32_t cell_width, cell_height; /* size of a cell with padding */
    uint32_t margin;                  /* pixels from a frame's border over which it fades out */

    uint32_t motion_width, motion_height; /* size of a cell of the motion atlas */
    float *features[2];                   /* features of this cell and of the one before */
    /* flow from each cell to the next, in pixels of the motion cell */
    float *flows;
};

static uint32_t cell_count(const struct kiln_output_params *params)
{
    return params->flipbook.columns * params->flipbook.rows;
}

/* ---- Frames for cells ----------------------------------------------------------------------- */

bool kiln_flipbook_sample(const struct kiln_flipbook *given, const struct kiln_frame_range *ranges,
                          size_t range_count, struct kiln_frame_range *cells,
                          struct kiln_error *error)
{
    struct kiln_flipbook taken = kiln_flipbook_empty();
    const struct kiln_flipbook *flipbook = &taken;
    if (!kiln_sized_take(&taken, given, "kiln_flipbook", error))
        return false;
    if (flipbook->columns < 1 || flipbook->columns > MAX_CELLS_A_SIDE || flipbook->rows < 1 ||
        flipbook->rows > MAX_CELLS_A_SIDE)
        return kiln_error_set(error, KILN_USAGE,
                              "found a flipbook of %u x %u cells; allowed are 1 to %d",
                              flipbook->columns, flipbook->rows, MAX_CELLS_A_SIDE);
    uint32_t count = flipbook->columns * flipbook->rows;
    uint64_t frames = kiln_ranges_count(ranges, range_count);
    if (frames < count)
        return kiln_error_set(
            error, KILN_USAGE,
            "the %u x %u cells of a flipbook need more than the %" PRIu64
            " frames that there are; at least %u are needed: take fewer cells, or a higher rate",
            flipbook->columns, flipbook->rows, frames, count);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t frame = kiln_ranges_at(ranges, range_count, i * frames / count);
        cells[i] = (struct kiln_frame_range){frame, frame};
    }
    return true;
}

/* Computes the least and the most frames from one cell to the next. */
static void measure_steps(const struct kiln_output_params *params, uint32_t *least, uint32_t *most)
{
    uint32_t before = 0, frame = 0;
    *least = UINT32_MAX;
    *most = 0;
    for (uint32_t i = 0; i < cell_count(params); i++, before = frame) {
        frame = kiln_ranges_at(params->clip, params->clip_count, i);
        if (i > 0) {
            *least = frame - before < *least ? frame - before : *least;
            *most = frame - before > *most ? frame - before : *most;
        }
    }
}

/* ---- Opening -------------------------------------------------------------------------------- */

static struct kiln_output_needs needs(const struct kiln_output_params *params)
{
    /* Premultiplied, colours are the display's values, which renderers add as light. */
    return (struct kiln_output_needs){.bits = params->png_bits,
                                      .texture = !params->flipbook.premultiplied};
}

static bool check(const struct kiln_output_params *params, struct kiln_error *error)
{
    const struct kiln_flipbook *flipbook = &params->flipbook;
    if (!kiln_format_png.check(params, error))
        return false;
    if (flipbook->columns < 1 || flipbook->columns > MAX_CELLS_A_SIDE || flipbook->rows < 1 ||
        flipbook->rows > MAX_CELLS_A_SIDE || flipbook->padding > MAX_PADDING)
        return kiln_error_set(error, KILN_USAGE,
                              "%s: found a flipbook of %u x %u cells, padded by %u; allowed are 1 "
                              "to %d cells, and 0 to %d pixels",
                              params->path, flipbook->columns, flipbook->rows, flipbook->padding,
                              MAX_CELLS_A_SIDE, MAX_PADDING);
    if (flipbook->fade > MAX_FADE)
        return kiln_error_set(error, KILN_USAGE,
                              "%s: found a flipbook whose cells fade out over %u percent; "
                              "allowed are 0 to %d",
                              params->path, flipbook->fade, MAX_FADE);
    uint64_t width =
        flipbook->columns * ((uint64_t)params->width + 2 * (uint64_t)flipbook->padding);
    uint64_t height = flipbook->rows * ((uint64_t)params->height + 2 * (uint64_t)flipbook->padding);
    if (width > MAX_EDGE || height > MAX_EDGE)
        return kiln_error_set(
            error, KILN_USAGE,
            "%s: the flipbook would have %" PRIu64 " x %" PRIu64
            " pixels; allowed are %d a side: make the frames smaller (%u x %u) or the cells fewer",
            params->path, width, height, MAX_EDGE, params->width, params->height);
    uint64_t frames = kiln_ranges_count(params->clip, params->clip_count);
    return frames == cell_count(params) ||
           kiln_error_set(error, KILN_USAGE, "%s: found %" PRIu64 " frames for %u x %u cells",
                          params->path, frames, flipbook->columns, flipbook->rows);
}

static void warn(const struct kiln_output_params *params)
{
    uint32_t least, most;
    measure_steps(params, &least, &most);
    if (least < most)
        kiln_log_write(
            &params->log, KILN_LOG_WARNING,
            "%s: the cells are %u to %u frames apart, so motion will not be even; choose "
            "a multiple of %u frames",
            params->path, least, most, cell_count(params));
    if (!params->alpha)
        kiln_log_write(&params->log, KILN_LOG_WARNING,
                       "%s: the backdrop is opaque, so the flipbook has no alpha "
                       "(backdrop.transparent: true)",
                       params->path);
}

static const char *beside(const struct kiln_output_params *params, uint32_t index)
{
    static const char *const endings[] = {".json", "_motion.png"};
    return index < (params->flipbook.motion ? 2 : 1) ? endings[index] : NULL;
}

/* Opens one of the files beside the atlas. */
static bool open_beside(const struct flipbook_encoder *encoder, uint32_t index,
                        struct kiln_temporary *file, struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    if (!kiln_format_beside(encoder->file->target, beside(encoder->params, index), path))
        return kiln_error_set(error, KILN_USAGE, "%s: the path is too long", encoder->params->path);
    return kiln_target_check(path, encoder->params->overwrite, error) &&
           kiln_temporary_open(file, path, error);
}

static void close_encoder(void *opaque)
{
    struct flipbook_encoder *encoder = opaque;
    kiln_temporary_discard(&encoder->layout_file);
    kiln_temporary_discard(&encoder->motion_file);
    kiln_picture_destroy(&encoder->atlas);
    free(encoder->features[0]);
    free(encoder->features[1]);
    free(encoder->flows);
    free(encoder);
}

static bool create_motion(struct flipbook_encoder *encoder, struct kiln_error *error)
{
    uint32_t longer =
        encoder->cell_width > encoder->cell_height ? encoder->cell_width : encoder->cell_height;
    uint32_t shrink = (longer + MAX_MOTION_EDGE - 1) / MAX_MOTION_EDGE;
    encoder->motion_width = (encoder->cell_width + shrink - 1) / shrink;
    encoder->motion_height = (encoder->cell_height + shrink - 1) / shrink;
    size_t pixels = (size_t)encoder->motion_width * encoder->motion_height;
    for (int i = 0; i < 2; i++)
        encoder->features[i] = malloc(FEATURES * pixels * sizeof(float));
    encoder->flows = calloc(cell_count(encoder->params) * pixels, 2 * sizeof(float));
    return (encoder->features[0] && encoder->features[1] && encoder->flows) ||
           kiln_error_no_memory(error, "the motion of %s", encoder->params->path);
}

/* Returns over how many pixels frames fade out: at least one, unless they do not. */
static uint32_t fade_margin(const struct kiln_output_params *params)
{
    const uint64_t shorter = params->width < params->height ? params->width : params->height;
    const uint64_t margin = shorter * params->flipbook.fade / 100;
    return params->flipbook.fade == 0 || !params->alpha ? 0 : margin == 0 ? 1 : (uint32_t)margin;
}

static void *open_encoder(const struct kiln_output_params *params, struct kiln_temporary *file,
                          struct kiln_error *error)
{
    const struct kiln_flipbook *flipbook = &params->flipbook;
    struct flipbook_encoder *encoder = calloc(1, sizeof *encoder);
    if (!encoder) {
        kiln_error_no_memory(error, "the flipbook of %s", params->path);
        return NULL;
    }
    encoder->params = params;
    encoder->file = file;
    encoder->cell_width = params->width + 2 * flipbook->padding;
    encoder->cell_height = params->height + 2 * flipbook->padding;
    encoder->margin = fade_margin(params);
    encoder->atlas = kiln_picture_create(encoder->cell_width * flipbook->columns,
                                         encoder->cell_height * flipbook->rows, params->png_bits,
                                         NULL, NULL, 0, error);
    bool good = encoder->atlas && open_beside(encoder, 0, &encoder->layout_file, error) &&
                (!flipbook->motion || (open_beside(encoder, 1, &encoder->motion_file, error) &&
                                       create_motion(encoder, error)));
    if (good) {
        encoder->atlas->has_alpha = params->alpha;
        warn(params);
        return encoder;
    }
    close_encoder(encoder);
    return NULL;
}

/* ---- Cells ---------------------------------------------------------------------------------- */

static uint32_t read_sample(const struct kiln_picture *picture, size_t index)
{
    return picture->bits == 8 ? ((const uint8_t *)picture->display)[index]
                              : ((const uint16_t *)picture->display)[index];
}

static void write_sample(const struct kiln_picture *picture, size_t index, uint32_t value)
{
    if (picture->bits == 8)
        ((uint8_t *)picture->display)[index] = (uint8_t)value;
    else
        ((uint16_t *)picture->display)[index] = (uint16_t)value;
}

static uint32_t clamp(uint32_t position, uint32_t padding, uint32_t size)
{
    uint32_t inside = position < padding ? 0 : position - padding;
    return inside < size ? inside : size - 1;
}

/* Returns the factor of a fade at a position of a frame along an axis, in 1 / FADE_ONE: 0 at the
 * border, FADE_ONE from `margin` pixels inwards, and a smoothstep between. */
static uint64_t fade_at(uint32_t position, uint32_t size, uint64_t margin)
{
    const uint32_t opposite = size - 1 - position;
    const uint64_t d = position < opposite ? position : opposite;
    if (d >= margin)
        return FADE_ONE;
    return FADE_ONE * d * d * (3 * margin - 2 * d) / (margin * margin * margin);
}

/* Copies one pixel of a cell. Padding repeats the colour of the edge, with alpha 0 where there is
 * alpha, so that a texture filter does not mix in the neighbouring cell. Premultiplied, alpha 0 is
 * black. */
static void copy_pixel(const struct flipbook_encoder *encoder, const struct kiln_picture *picture,
                       uint32_t x, uint32_t y, size_t out)
{
    const struct kiln_flipbook *flipbook = &encoder->params->flipbook;
    uint32_t px = clamp(x, flipbook->padding, picture->width);
    uint32_t py = clamp(y, flipbook->padding, picture->height);
    size_t in = 4 * ((size_t)py * picture->width + px);
    const uint32_t full = (1u << picture->bits) - 1;
    bool inside = px + flipbook->padding == x && py + flipbook->padding == y;
    uint64_t fade = fade_at(px, picture->width, encoder->margin) *
                    fade_at(py, picture->height, encoder->margin);
    uint32_t alpha = inside || !picture->has_alpha ? read_sample(picture, in + 3) : 0;
    if (picture->has_alpha)
        alpha = (uint32_t)((alpha * fade + FADE_ONE * FADE_ONE / 2) / (FADE_ONE * FADE_ONE));
    for (size_t c = 0; c < 3; c++) {
        uint32_t value = read_sample(picture, in + c);
        if (flipbook->premultiplied && picture->has_alpha)
            value = (uint32_t)(((uint64_t)value * alpha + full / 2) / full);
        write_sample(encoder->atlas, out + c, value);
    }
    write_sample(encoder->atlas, out + 3, alpha);
}

/* Returns the index of the first sample of a cell in an atlas. */
static size_t cell_origin(const struct flipbook_encoder *encoder, uint32_t cell, uint32_t width,
                          uint32_t height)
{
    uint32_t columns = encoder->params->flipbook.columns;
    return 4 *
           ((size_t)(cell / columns) * height * width * columns + (size_t)(cell % columns) * width);
}

static void fill_cell(struct flipbook_encoder *encoder, const struct kiln_picture *picture)
{
    uint32_t width = encoder->cell_width, height = encoder->cell_height;
    size_t origin = cell_origin(encoder, encoder->cells, width, height);
    for (uint32_t y = 0; y < height; y++) {
        size_t out = origin + (size_t)4 * y * encoder->atlas->width;
        for (uint32_t x = 0; x < width; x++, out += 4)
            copy_pixel(encoder, picture, x, y, out);
    }
}

/* ---- Motion --------------------------------------------------------------------------------- */

/* Makes a smaller picture of a cell with its features: brightness over black, and alpha, both
 * averaged. */
static void measure_features(const struct flipbook_encoder *encoder, float *features)
{
    static const float weights[3] = {0.3f, 0.55f, 0.15f};
    const struct kiln_picture *atlas = encoder->atlas;
    bool premultiplied = encoder->params->flipbook.premultiplied;
    float full = (float)((1u << atlas->bits) - 1);
    size_t origin = cell_origin(encoder, encoder->cells, encoder->cell_width, encoder->cell_height);
    for (uint32_t my = 0; my < encoder->motion_height; my++) {
        uint32_t top = my * encoder->cell_height / encoder->motion_height;
        uint32_t bottom = (my + 1) * encoder->cell_height / encoder->motion_height;
        for (uint32_t mx = 0; mx < encoder->motion_width; mx++, features += FEATURES) {
            uint32_t left = mx * encoder->cell_width / encoder->motion_width;
            uint32_t right = (mx + 1) * encoder->cell_width / encoder->motion_width;
            float light = 0, cover = 0;
            for (uint32_t y = top; y < bottom; y++) {
                for (uint32_t x = left; x < right; x++) {
                    size_t at = origin + 4 * ((size_t)y * atlas->width + x);
                    float alpha = (float)read_sample(atlas, at + 3) / full;
                    float by = (premultiplied || !atlas->has_alpha ? 1.0f : alpha) / full;
                    for (size_t c = 0; c < 3; c++)
                        light += by * weights[c] * (float)read_sample(atlas, at + c);
                    cover += alpha;
                }
            }
            float count = (float)((bottom - top) * (right - left));
            features[0] = light / count;
            features[1] = atlas->has_alpha ? cover / count : 0;
        }
    }
}

static bool add_motion(struct flipbook_encoder *encoder, struct kiln_error *error)
{
    uint32_t width = encoder->motion_width, height = encoder->motion_height;
    float *now = encoder->features[encoder->cells % 2];
    const float *before = encoder->features[(encoder->cells + 1) % 2];
    measure_features(encoder, now);
    if (encoder->cells == 0)
        return true;
    float *flow = encoder->flows + (size_t)2 * width * height * (encoder->cells - 1);
    return kiln_flow_estimate(before, now, width, height, FEATURES, flow) ||
           kiln_error_no_memory(error, "the motion of %s", encoder->params->path);
}

/* Returns the largest motion along an axis as a part of a cell, which 255 stands for. It is at
 * least a pixel. */
static float motion_scale(const struct flipbook_encoder *encoder)
{
    uint32_t width = encoder->motion_width, height = encoder->motion_height;
    float scale = 1.0f / (float)(width > height ? width : height);
    size_t count = (size_t)2 * width * height * cell_count(encoder->params);
    for (size_t i = 0; i < count; i += 2) {
        scale = fmaxf(scale, fabsf(encoder->flows[i]) / (float)width);
        scale = fmaxf(scale, fabsf(encoder->flows[i + 1]) / (float)height);
    }
    return scale;
}

/* Maps -1..1 to 1..255. 128 is no motion exactly, and kiln_cells_load_motion reads it so. */
static uint8_t encode_motion(float motion)
{
    return (uint8_t)floorf(128.0f + 127.0f * motion + 0.5f);
}

static struct kiln_picture *draw_motion(const struct flipbook_encoder *encoder, float scale,
                                        struct kiln_error *error)
{
    const struct kiln_flipbook *flipbook = &encoder->params->flipbook;
    uint32_t width = encoder->motion_width, height = encoder->motion_height;
    struct kiln_picture *picture = kiln_picture_create(
        width * flipbook->columns, height * flipbook->rows, 8, NULL, NULL, 0, error);
    if (!picture)
        return NULL;
    picture->is_data = true;
    const float *flow = encoder->flows;
    const float green = flipbook->green_down ? 1.0f : -1.0f; /* rows of flow run downwards */
    for (uint32_t cell = 0; cell < cell_count(encoder->params); cell++) {
        for (uint32_t y = 0; y < height; y++) {
            uint8_t *out = (uint8_t *)picture->display + cell_origin(encoder, cell, width, height) +
                           (size_t)4 * y * picture->width;
            for (uint32_t x = 0; x < width; x++, out += 4, flow += 2) {
                out[0] = encode_motion(flow[0] / (float)width / scale);
                out[1] = encode_motion(green * flow[1] / (float)height / scale);
                out[2] = 0;
                out[3] = 255;
            }
        }
    }
    return picture;
}

/* ---- Files ---------------------------------------------------------------------------------- */

static void add_name(struct kiln_json *json, const struct kiln_temporary *file)
{
    const char *slash = strrchr(file->target, '/');
    kiln_json_string(json, "image", slash ? slash + 1 : file->target);
}

/* Begins an object with a size and leaves it open, for more members. */
static void begin_size(struct kiln_json *json, const char *key, uint32_t width, uint32_t height)
{
    kiln_json_begin_object(json, key);
    kiln_json_uint(json, "width", width);
    kiln_json_uint(json, "height", height);
}

static void add_frames(struct kiln_json *json, const struct kiln_output_params *params)
{
    uint32_t frame = 0, first = 0;
    kiln_json_begin_array(json, "frames");
    for (uint32_t i = 0; i < cell_count(params); i++) {
        frame = kiln_ranges_at(params->clip, params->clip_count, i);
        first = i == 0 ? frame : first;
        kiln_json_uint(json, NULL, frame);
    }
    kiln_json_end(json);
    double step = cell_count(params) > 1 ? (double)(frame - first) / (cell_count(params) - 1) : 1;
    kiln_json_pair(json, "frame_rate", params->fps_num, params->fps_den);
    kiln_json_number(json, "cells_per_second", (double)params->fps_num / params->fps_den / step);
}

static void add_motion_layout(struct kiln_json *json, const struct flipbook_encoder *encoder,
                              float scale)
{
    if (!encoder->motion_file.target) {
        kiln_json_null(json, "motion");
        return;
    }
    char number[32];
    kiln_text_from_float(number, scale);
    kiln_json_begin_object(json, "motion");
    kiln_json_indent_items(json, 4);
    add_name(json, &encoder->motion_file);
    begin_size(json, "cell", encoder->motion_width, encoder->motion_height);
    kiln_json_end(json);
    kiln_json_string(json, "encoding", "(channel - 128) / 127 * scale");
    kiln_json_raw(json, "scale", number);
    kiln_json_string(json, "unit", "cell");
    kiln_json_string(json, "red", "right");
    kiln_json_string(json, "green", encoder->params->flipbook.green_down ? "down" : "up");
    kiln_json_string(json, "from", "this cell");
    kiln_json_string(json, "to", "the next cell");
    kiln_json_string(json, "color_space", "linear");
    kiln_json_end_indented(json, 2);
}

static void add_layout(struct kiln_json *json, const struct flipbook_encoder *encoder, float scale)
{
    const struct kiln_output_params *params = encoder->params;
    const struct kiln_flipbook *flipbook = &params->flipbook;
    kiln_json_uint(json, "kiln_flipbook", KILN_FLIPBOOK_VERSION);
    add_name(json, encoder->file);
    begin_size(json, "size", encoder->atlas->width, encoder->atlas->height);
    kiln_json_end(json);
    kiln_json_uint(json, "columns", flipbook->columns);
    kiln_json_uint(json, "rows", flipbook->rows);
    kiln_json_uint(json, "cells", cell_count(params));
    kiln_json_string(json, "order", "rows from the top, each from the left");
    begin_size(json, "cell", encoder->cell_width, encoder->cell_height);
    kiln_json_uint(json, "padding", flipbook->padding);
    kiln_json_uint(json, "fade", encoder->margin);
    kiln_json_end(json);
    kiln_json_string(json, "alpha",
                     !params->alpha            ? "none"
                     : flipbook->premultiplied ? "premultiplied"
                                               : "straight");
    kiln_json_string(json, "color_space", "srgb");
    add_frames(json, params);
    add_motion_layout(json, encoder, scale);
    kiln_json_begin_object(json, "kiln");
    kiln_json_string(json, "version", KILN_VERSION);
    kiln_json_string(json, "scene_hash", params->scene_hash);
    kiln_json_uint(json, "seed", params->seed);
    kiln_json_end(json);
}

static bool write_layout(struct flipbook_encoder *encoder, float scale, struct kiln_error *error)
{
    struct kiln_text text = {0};
    struct kiln_json json = kiln_json_to_text(&text);
    kiln_json_begin_object(&json, NULL);
    kiln_json_indent_items(&json, 2);
    add_layout(&json, encoder, scale);
    kiln_json_end_indented(&json, 0);
    bool good = kiln_json_finish(&json);
    if (good) /* without a commit the file is not kept, and the commit reports failures */
        kiln_temporary_write(&encoder->layout_file, text.data, text.length);
    kiln_text_free(&text);
    return good || kiln_error_no_memory(error, "the layout of %s", encoder->params->path);
}

static bool encode(void *opaque, const struct kiln_picture *picture, struct kiln_error *error)
{
    struct flipbook_encoder *encoder = opaque;
    const struct kiln_flipbook *flipbook = &encoder->params->flipbook;
    if (picture->has_alpha && !flipbook->premultiplied && !kiln_bleed_colors(picture, error))
        return false;
    fill_cell(encoder, picture);
    if (flipbook->motion && !add_motion(encoder, error))
        return false;
    encoder->cells++;
    return true;
}

static bool write_motion(struct flipbook_encoder *encoder, float scale,
                         const struct kiln_caller *caller, struct kiln_error *error)
{
    struct kiln_picture *motion = draw_motion(encoder, scale, error);
    bool good =
        motion && kiln_png_write(encoder->params, motion, &encoder->motion_file, caller, error);
    kiln_picture_destroy(&motion);
    return good;
}

static bool finish(void *opaque, const struct kiln_caller *caller, struct kiln_error *error)
{
    struct flipbook_encoder *encoder = opaque;
    bool motion = encoder->params->flipbook.motion;
    float scale = motion ? motion_scale(encoder) : 0;
    return (!motion || write_motion(encoder, scale, caller, error)) &&
           write_layout(encoder, scale, error) &&
           kiln_png_write(encoder->params, encoder->atlas, encoder->file, caller, error);
}

/* Renames the files, the layout last. So the pictures that an existing layout names are always
 * there and belong to it. */
static bool commit(void *opaque, struct kiln_error *error)
{
    struct flipbook_encoder *encoder = opaque;
    const struct kiln_output_params *params = encoder->params;
    struct kiln_temporary *files[] = {encoder->file, &encoder->layout_file, &encoder->layout_file};
    size_t count = 2;
    if (params->flipbook.motion) {
        files[1] = &encoder->motion_file;
        count = 3;
    }
    return kiln_temporary_commit_all(files, count, params->overwrite, error);
}

const struct kiln_format kiln_format_flipbook = {
    .suffix = ".png",
    .name = "flipbook",
    .help = "frames in one PNG, with a layout and motion vectors",
    .one_file = true,
    .gaps = true,
    .uses = KILN_USES_PNG_BITS | KILN_USES_PNG_EFFORT,
    .needs = needs,
    .check = check,
    .open = open_encoder,
    .encode = encode,
    .finish = finish,
    .commit = commit,
    .close = close_encoder,
    .beside = beside,
};
