/* Cells are prepared in float on the host, one flipbook at a time: generated, or cut out of an
 * image and resized in premultiplied linear light, then shrunk level by level and stored in 8 bits.
 */
#include "asset/atlas.h"

#include "asset/builtin.h"
#include "asset/image.h"
#include "base/error.h"
#include "shared/draw_layout.h"

#include <math.h>
#include <stdlib.h>

enum { LEVELS = 8 }; /* 128 to 1 */

static bool out_of_memory(struct kiln_error *error, const char *source)
{
    return kiln_error_set(error, KILN_DEVICE_FAILED, "%s: out of memory for its cells", source);
}

/* ---- image files ----------------------------------------------------------------------------- */

static float decode_srgb(float x)
{
    return x <= 0.04045f ? x / 12.92f : powf((x + 0.055f) / 1.055f, 2.4f);
}

/* A pixel of the image as premultiplied linear light. */
static void read_pixel(const struct kiln_asset_image *image, uint32_t x, uint32_t y, float rgba[4])
{
    size_t at = ((size_t)y * image->width + x) * 4;
    for (int c = 0; c < 4; c++) {
        if (image->type == KILN_IMAGE_U8)
            rgba[c] = (float)((const uint8_t *)image->pixels)[at + (size_t)c] / 255.0f;
        else if (image->type == KILN_IMAGE_U16)
            rgba[c] = (float)((const uint16_t *)image->pixels)[at + (size_t)c] / 65535.0f;
        else
            rgba[c] = ((const float *)image->pixels)[at + (size_t)c];
    }
    for (int c = 0; c < 3; c++) {
        if (image->srgb)
            rgba[c] = decode_srgb(rgba[c]);
        if (!image->premultiplied)
            rgba[c] *= rgba[3];
    }
}

struct area {
    float x0, y0, x1, y1; /* in pixels of the image */
};

/* The mean over an area; an area smaller than a pixel is the pixel under its middle. */
static void average_area(const struct kiln_asset_image *image, struct area area, float rgba[4])
{
    float sum[4] = {0}, weight = 0.0f;
    for (uint32_t y = (uint32_t)area.y0; (float)y < area.y1 && y < image->height; y++) {
        float wy = fminf((float)y + 1.0f, area.y1) - fmaxf((float)y, area.y0);
        for (uint32_t x = (uint32_t)area.x0; (float)x < area.x1 && x < image->width; x++) {
            float w = wy * (fminf((float)x + 1.0f, area.x1) - fmaxf((float)x, area.x0));
            float pixel[4];
            read_pixel(image, x, y, pixel);
            for (int c = 0; c < 4; c++)
                sum[c] += w * pixel[c];
            weight += w;
        }
    }
    for (int c = 0; c < 4; c++)
        rgba[c] = weight > 0.0f ? sum[c] / weight : 0.0f;
}

struct resize {
    const struct kiln_asset_image *image;
    uint32_t columns;
    uint32_t cell_width, cell_height;
    float *cells;
};

static void resize_cells(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct resize *job = context;
    float step_x = (float)job->cell_width / KILN_ATLAS_CELL;
    float step_y = (float)job->cell_height / KILN_ATLAS_CELL;
    for (size_t cell = begin; cell < end; cell++) {
        float left = (float)(cell % job->columns * job->cell_width);
        float top = (float)(cell / job->columns * job->cell_height);
        float *out = job->cells + cell * KILN_ATLAS_CELL * KILN_ATLAS_CELL * 4;
        for (uint32_t y = 0; y < KILN_ATLAS_CELL; y++) {
            for (uint32_t x = 0; x < KILN_ATLAS_CELL; x++, out += 4) {
                struct area area = {left + (float)x * step_x, top + (float)y * step_y,
                                    left + (float)(x + 1) * step_x, top + (float)(y + 1) * step_y};
                average_area(job->image, area, out);
            }
        }
    }
}

static bool load_cells(const struct kiln_atlas_request *request, float *cells,
                       struct kiln_threads *threads, struct kiln_error *error)
{
    struct kiln_asset_image *image = kiln_asset_image_load(request->source, error);
    if (!image)
        return false;
    bool divides = image->width % request->columns == 0 && image->height % request->rows == 0;
    if (divides) {
        struct resize job = {.image = image,
                             .columns = request->columns,
                             .cell_width = image->width / request->columns,
                             .cell_height = image->height / request->rows,
                             .cells = cells};
        kiln_threads_for(threads, (size_t)request->columns * request->rows, 1, resize_cells, &job);
    } else {
        kiln_error_set(error, KILN_INVALID_INPUT,
                       "%s: %u x %u pixels do not divide into %u columns and %u rows",
                       request->source, image->width, image->height, request->columns,
                       request->rows);
    }
    kiln_asset_image_destroy(&image);
    return divides;
}

/* ---- levels of detail ------------------------------------------------------------------------ */

/* Halves a level in place of the next; normals and heat count as much as their density. */
static void shrink(const float *from, uint32_t edge, uint32_t kind, float *to)
{
    uint32_t half = edge / 2;
    for (uint32_t y = 0; y < half; y++) {
        for (uint32_t x = 0; x < half; x++, to += 4) {
            float sum[4] = {0}, plain[3] = {0};
            for (uint32_t i = 0; i < 4; i++) {
                const float *p =
                    from + ((2 * (size_t)y + i / 2) * edge + 2 * (size_t)x + i % 2) * 4;
                float weight = kind == KILN_CELL_MASK ? p[3] : 1.0f;
                for (int c = 0; c < 3; c++) {
                    sum[c] += weight * p[c];
                    plain[c] += 0.25f * p[c];
                }
                sum[3] += p[3];
            }
            float total = kind == KILN_CELL_MASK ? sum[3] : 4.0f;
            for (int c = 0; c < 3; c++)
                to[c] = total > 1e-6f ? sum[c] / total : plain[c];
            to[3] = 0.25f * sum[3];
        }
    }
}

static uint8_t to_byte(float x)
{
    return (uint8_t)(fminf(fmaxf(x, 0.0f), 1.0f) * 255.0f + 0.5f);
}

static void encode(const float *from, size_t pixels, uint32_t kind, uint8_t *to)
{
    for (size_t i = 0; i < pixels; i++, from += 4, to += 4) {
        for (int c = 0; c < 4; c++) {
            float x = from[c];
            if (kind == KILN_CELL_COLOR)
                x = sqrtf(fmaxf(x, 0.0f));
            else if (c < 2)
                x = 0.5f + 0.5f * x;
            to[c] = to_byte(x);
        }
    }
}

/* Uploads one cell with its levels; `cell` is overwritten. */
static void upload_cell(float *cell, uint32_t kind, uint32_t layer, uint8_t *bytes)
{
    uint32_t edge = KILN_ATLAS_CELL;
    for (int level = 0; level < LEVELS; level++, edge /= 2) {
        encode(cell, (size_t)edge * edge, kind, bytes);
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, level, 0, 0, (GLint)layer, (GLsizei)edge,
                        (GLsizei)edge, 1, GL_RGBA, GL_UNSIGNED_BYTE, bytes);
        if (edge > 1)
            shrink(cell, edge, kind, cell);
    }
}

static bool add_flipbook(const struct kiln_atlas_range *range,
                         const struct kiln_atlas_request *request, struct kiln_threads *threads,
                         struct kiln_error *error)
{
    const size_t cell_pixels = (size_t)KILN_ATLAS_CELL * KILN_ATLAS_CELL;
    float *cells = calloc(range->cells, cell_pixels * 4 * sizeof(float));
    uint8_t *bytes = malloc(cell_pixels * 4);
    bool ok = cells && bytes;
    if (!ok) {
        out_of_memory(error, request->source);
    } else if (range->kind == KILN_CELL_MASK) {
        kiln_builtin_generate(kiln_builtin_of(request->source), KILN_ATLAS_CELL, cells, threads);
    } else {
        ok = load_cells(request, cells, threads, error);
    }
    for (uint32_t i = 0; ok && i < range->cells; i++)
        upload_cell(cells + i * cell_pixels * 4, range->kind, range->first_layer + i, bytes);
    free(cells);
    free(bytes);
    return ok;
}

/* ---- the texture ----------------------------------------------------------------------------- */

static bool same_request(const struct kiln_atlas_request *a, const struct kiln_atlas_request *b)
{
    if (strcmp(a->source, b->source) != 0)
        return false;
    return kiln_builtin_of(a->source) || (a->columns == b->columns && a->rows == b->rows);
}

/* Gives each system its layers; *shared tells which repeat an earlier system's. */
static void assign_layers(struct kiln_atlas *atlas, const struct kiln_atlas_request *requests,
                          uint32_t count, bool *shared)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t same = 0;
        while (same < i && !same_request(&requests[same], &requests[i]))
            same++;
        shared[i] = same < i;
        if (shared[i]) {
            atlas->systems[i] = atlas->systems[same];
            continue;
        }
        bool builtin = kiln_builtin_of(requests[i].source) != NULL;
        atlas->systems[i] = (struct kiln_atlas_range){
            .first_layer = atlas->layers,
            .cells = builtin ? KILN_BUILTIN_CELLS : requests[i].columns * requests[i].rows,
            .kind = builtin ? KILN_CELL_MASK : KILN_CELL_COLOR,
        };
        atlas->layers += atlas->systems[i].cells;
    }
}

static void create_texture(struct kiln_atlas *atlas)
{
    glGenTextures(1, &atlas->texture);
    glBindTexture(GL_TEXTURE_2D_ARRAY, atlas->texture);
    for (int level = 0; level < LEVELS; level++) {
        GLsizei edge = KILN_ATLAS_CELL >> level;
        glTexImage3D(GL_TEXTURE_2D_ARRAY, level, GL_RGBA8, edge, edge, (GLsizei)atlas->layers, 0,
                     GL_RGBA, GL_UNSIGNED_BYTE, NULL);
    }
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, LEVELS - 1);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

bool kiln_atlas_init(struct kiln_atlas *atlas, struct kiln_device *device,
                     const struct kiln_atlas_request *requests, uint32_t count,
                     struct kiln_threads *threads, struct kiln_error *error)
{
    *atlas = (struct kiln_atlas){0};
    bool shared[KILN_MAX_SYSTEMS] = {false};
    assign_layers(atlas, requests, count, shared);
    if ((int64_t)atlas->layers > device->info.max_array_layers)
        return kiln_error_set(error, KILN_DEVICE_FAILED,
                              "the atlases have %u cells together; %s takes %d", atlas->layers,
                              device->info.name, device->info.max_array_layers);
    create_texture(atlas);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    for (uint32_t i = 0; i < count; i++) {
        if (!shared[i] && !add_flipbook(&atlas->systems[i], &requests[i], threads, error)) {
            kiln_atlas_finish(atlas);
            return false;
        }
        glBindTexture(GL_TEXTURE_2D_ARRAY, atlas->texture);
    }
    kiln_device_label(device, GL_TEXTURE, atlas->texture, "atlas");
    if (!kiln_device_check(device, "atlas", error)) {
        kiln_atlas_finish(atlas);
        return false;
    }
    return true;
}

void kiln_atlas_finish(struct kiln_atlas *atlas)
{
    glDeleteTextures(1, &atlas->texture);
    *atlas = (struct kiln_atlas){0};
}
