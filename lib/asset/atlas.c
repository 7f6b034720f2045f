/* Cells are prepared in float on the host, one flipbook at a time: generated, or read from a file,
 * then shrunk level by level and stored in 8 bits. How they move is a second texture with the same
 * layers, much coarser, since gas moves together.
 */
#include "asset/atlas.h"

#include "asset/builtin.h"
#include "asset/cells_in.h"
#include "base/error.h"

#include <math.h>
#include <stdlib.h>

enum { LEVELS = 8 }; /* 128 to 1 */

/* One flipbook of all that are asked for, once each. */
struct flipbook {
    struct kiln_cells_source source;
    const char *builtin; /* its name, or NULL */
    const struct kiln_atlas_request *request;
    struct kiln_atlas_range *range;
    struct kiln_film *film;
    bool failed; /* out of memory */
};

static bool out_of_memory(struct kiln_error *error, const char *source)
{
    return kiln_error_set(error, KILN_DEVICE_FAILED, "%s: out of memory for its cells", source);
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

static bool upload_cells(const struct flipbook *book, struct kiln_threads *threads,
                         struct kiln_error *error)
{
    const struct kiln_atlas_range *range = book->range;
    const size_t cell_pixels = (size_t)KILN_ATLAS_CELL * KILN_ATLAS_CELL;
    float *cells = calloc(range->cells, cell_pixels * 4 * sizeof(float));
    uint8_t *bytes = malloc(cell_pixels * 4);
    bool ok = cells && bytes;
    if (!ok)
        out_of_memory(error, book->source.path);
    else if (book->builtin)
        kiln_builtin_generate(book->builtin, range->cells, KILN_ATLAS_CELL, book->film, cells,
                              threads);
    else
        ok = kiln_cells_load(&book->source, cells, threads, error);
    for (uint32_t i = 0; ok && i < range->cells; i++)
        upload_cell(cells + i * cell_pixels * 4, range->kind, range->first_layer + i, bytes);
    free(cells);
    free(bytes);
    return ok;
}

/* ---- motion ---------------------------------------------------------------------------------- */

/* Whether the cells of a flipbook are to be moved. */
static bool moves(const struct flipbook *book)
{
    const char *motion = book->request->motion;
    return motion[0] == '/' || (book->film && strcmp(motion, "auto") == 0);
}

/* Stores motion relative to its largest part, rows from the top and y down as textures have it. */
static void encode_motion(const float *motion, size_t pixels, float largest, int8_t *bytes)
{
    for (size_t i = 0; i < 2 * pixels; i++) {
        float part = motion[i] / largest * (i % 2 ? -127.0f : 127.0f);
        bytes[i] = (int8_t)floorf(part + 0.5f);
    }
}

static bool upload_motion(const struct flipbook *book, struct kiln_threads *threads,
                          struct kiln_error *error)
{
    struct kiln_atlas_range *range = book->range;
    const size_t pixels = (size_t)range->cells * KILN_ATLAS_MOTION * KILN_ATLAS_MOTION;
    float *motion = malloc(pixels * 2 * sizeof *motion);
    int8_t *bytes = malloc(pixels * 2);
    bool ok = motion && bytes;
    float scale = 1.0f;
    if (!ok)
        out_of_memory(error, book->source.path);
    if (ok && book->request->motion[0] == '/') {
        struct kiln_cells_source source = book->source;
        source.path = book->request->motion;
        source.edge = KILN_ATLAS_MOTION;
        ok = kiln_cells_load_motion(&source, motion, threads, error);
        scale = book->request->motion_scale;
    } else if (ok) {
        kiln_builtin_motion(book->film, KILN_ATLAS_MOTION, motion);
    }
    float largest = 0.0f;
    for (size_t i = 0; ok && i < pixels * 2; i++)
        largest = fmaxf(largest, fabsf(motion[i]));
    if (ok && largest > 0.0f) {
        encode_motion(motion, pixels, largest, bytes);
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, (GLint)range->first_layer, KILN_ATLAS_MOTION,
                        KILN_ATLAS_MOTION, (GLsizei)range->cells, GL_RG, GL_BYTE, bytes);
        range->motion = largest * scale;
    }
    free(motion);
    free(bytes);
    return ok;
}

/* ---- textures -------------------------------------------------------------------------------- */

/* Of the bound texture. */
static void set_filters(GLint levels, GLint shrinking)
{
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, levels - 1);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, shrinking);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
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
    set_filters(LEVELS, GL_LINEAR_MIPMAP_NEAREST);
}

/* One texel where nothing moves. */
static void create_motion_texture(struct kiln_atlas *atlas, bool any)
{
    GLsizei edge = any ? KILN_ATLAS_MOTION : 1, layers = any ? (GLsizei)atlas->layers : 1;
    glGenTextures(1, &atlas->motion);
    glBindTexture(GL_TEXTURE_2D_ARRAY, atlas->motion);
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RG8_SNORM, edge, edge, layers, 0, GL_RG, GL_BYTE, NULL);
    set_filters(1, GL_LINEAR);
}

/* ---- all flipbooks --------------------------------------------------------------------------- */

static bool same_flipbook(const struct flipbook *a, const struct flipbook *b)
{
    return strcmp(a->source.path, b->source.path) == 0 && a->source.columns == b->source.columns &&
           a->source.rows == b->source.rows &&
           strcmp(a->request->motion, b->request->motion) == 0 &&
           a->request->motion_scale == b->request->motion_scale;
}

struct flipbooks {
    struct flipbook books[KILN_MAX_SYSTEMS * KILN_MAX_TEXTURES];
    uint32_t count;
    struct kiln_atlas_range *copies[KILN_MAX_SYSTEMS * KILN_MAX_TEXTURES]; /* ranges like an */
    uint32_t originals[KILN_MAX_SYSTEMS * KILN_MAX_TEXTURES];              /* earlier book's */
    uint32_t copy_count;
};

/* Gives a texture its layers, or notes that an earlier one is the same. */
static void add_texture(struct flipbooks *all, struct kiln_atlas *atlas,
                        const struct kiln_atlas_request *request, uint32_t texture,
                        struct kiln_atlas_range *range)
{
    struct flipbook book = {
        .source = {request->sources[texture], request->columns, request->rows, KILN_ATLAS_CELL},
        .builtin = kiln_builtin_of(request->sources[texture]),
        .request = request,
        .range = range,
    };
    uint32_t same = 0;
    while (same < all->count && !same_flipbook(&all->books[same], &book))
        same++;
    if (same < all->count) {
        all->copies[all->copy_count] = range;
        all->originals[all->copy_count++] = same;
        return;
    }
    *range = (struct kiln_atlas_range){
        .first_layer = atlas->layers,
        .cells = request->columns * request->rows,
        .kind = book.builtin ? KILN_CELL_MASK : KILN_CELL_COLOR,
    };
    atlas->layers += range->cells;
    all->books[all->count++] = book;
}

static void make_films(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct flipbooks *all = context;
    for (size_t i = begin; i < end; i++) {
        struct flipbook *book = &all->books[i];
        if (book->builtin)
            book->failed = !kiln_builtin_film(book->builtin, book->range->cells, &book->film);
    }
}

static bool fill_textures(struct kiln_atlas *atlas, struct flipbooks *all,
                          struct kiln_threads *threads, struct kiln_error *error)
{
    kiln_threads_for(threads, all->count, 1, make_films, all);
    bool ok = true, any_moves = false;
    for (uint32_t i = 0; i < all->count; i++)
        any_moves |= moves(&all->books[i]);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    create_texture(atlas);
    for (uint32_t i = 0; ok && i < all->count; i++) {
        const struct flipbook *book = &all->books[i];
        ok = book->failed ? out_of_memory(error, book->source.path)
                          : upload_cells(book, threads, error);
    }
    create_motion_texture(atlas, any_moves);
    for (uint32_t i = 0; ok && i < all->count; i++)
        ok = !moves(&all->books[i]) || upload_motion(&all->books[i], threads, error);
    for (uint32_t i = 0; i < all->copy_count; i++)
        *all->copies[i] = *all->books[all->originals[i]].range;
    for (uint32_t i = 0; i < all->count; i++)
        free(all->books[i].film);
    return ok;
}

bool kiln_atlas_init(struct kiln_atlas *atlas, struct kiln_device *device,
                     const struct kiln_atlas_request *requests, uint32_t count,
                     struct kiln_threads *threads, struct kiln_error *error)
{
    *atlas = (struct kiln_atlas){0};
    struct flipbooks all = {0};
    for (uint32_t i = 0; i < count; i++) {
        atlas->systems[i].count = requests[i].count;
        for (uint32_t k = 0; k < requests[i].count; k++)
            add_texture(&all, atlas, &requests[i], k, &atlas->systems[i].textures[k]);
    }
    if ((int64_t)atlas->layers > device->info.max_array_layers)
        return kiln_error_set(error, KILN_DEVICE_FAILED,
                              "the atlases have %u cells together; %s takes %d", atlas->layers,
                              device->info.name, device->info.max_array_layers);
    bool ok = fill_textures(atlas, &all, threads, error);
    if (ok) {
        kiln_device_label(device, GL_TEXTURE, atlas->texture, "atlas");
        kiln_device_label(device, GL_TEXTURE, atlas->motion, "atlas motion");
        ok = kiln_device_check(device, "atlas", error);
    }
    if (!ok)
        kiln_atlas_finish(atlas);
    return ok;
}

void kiln_atlas_finish(struct kiln_atlas *atlas)
{
    glDeleteTextures(1, &atlas->texture);
    glDeleteTextures(1, &atlas->motion);
    *atlas = (struct kiln_atlas){0};
}
