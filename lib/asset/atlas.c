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

/* Stores a cell's levels one after the other; `cell` is overwritten. */
static void store_cell(float *cell, uint32_t kind, uint8_t *texels)
{
    for (uint32_t edge = KILN_ATLAS_CELL; edge > 0; edge /= 2) {
        encode(cell, (size_t)edge * edge, kind, texels);
        texels += 4 * (size_t)edge * edge;
        if (edge > 1)
            shrink(cell, edge, kind, cell);
    }
}

static bool make_cells(struct kiln_atlas *atlas, const struct flipbook *book,
                       struct kiln_threads *threads, struct kiln_error *error)
{
    const struct kiln_atlas_range *range = book->range;
    const size_t cell_pixels = (size_t)KILN_ATLAS_CELL * KILN_ATLAS_CELL;
    float *cells = calloc(range->cells, cell_pixels * 4 * sizeof(float));
    bool ok = cells != NULL;
    if (!ok)
        out_of_memory(error, book->source.path);
    else if (book->builtin)
        kiln_builtin_generate(book->builtin, range->cells, KILN_ATLAS_CELL, book->film, cells,
                              threads);
    else
        ok = kiln_cells_load(&book->source, cells, threads, error);
    for (uint32_t i = 0; ok && i < range->cells; i++)
        store_cell(cells + i * cell_pixels * 4, range->kind,
                   atlas->texels + (size_t)(range->first_layer + i) * KILN_ATLAS_LAYER_BYTES);
    free(cells);
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

static bool make_motion(struct kiln_atlas *atlas, const struct flipbook *book,
                        struct kiln_threads *threads, struct kiln_error *error)
{
    struct kiln_atlas_range *range = book->range;
    const size_t pixels = (size_t)range->cells * KILN_ATLAS_MOTION * KILN_ATLAS_MOTION;
    float *motion = malloc(pixels * 2 * sizeof *motion);
    bool ok = motion != NULL;
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
        encode_motion(motion, pixels, largest,
                      atlas->moves + (size_t)range->first_layer * KILN_ATLAS_MOVES_BYTES);
        range->motion = largest * scale;
    }
    free(motion);
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

static void upload_cells(struct kiln_atlas *atlas)
{
    glGenTextures(1, &atlas->texture);
    glBindTexture(GL_TEXTURE_2D_ARRAY, atlas->texture);
    glTexStorage3D(GL_TEXTURE_2D_ARRAY, KILN_ATLAS_LEVELS, GL_RGBA8, KILN_ATLAS_CELL,
                   KILN_ATLAS_CELL, atlas->layers ? (GLsizei)atlas->layers : 1);
    for (uint32_t layer = 0; layer < atlas->layers; layer++) {
        for (uint32_t level = 0; level < KILN_ATLAS_LEVELS; level++) {
            GLsizei edge = KILN_ATLAS_CELL >> level;
            glTexSubImage3D(GL_TEXTURE_2D_ARRAY, (GLint)level, 0, 0, (GLint)layer, edge, edge, 1,
                            GL_RGBA, GL_UNSIGNED_BYTE, kiln_atlas_level(atlas, layer, level));
        }
    }
    set_filters(KILN_ATLAS_LEVELS, GL_LINEAR_MIPMAP_NEAREST);
}

/* One texel where nothing moves. */
static void upload_moves(struct kiln_atlas *atlas)
{
    static const int8_t still[2] = {0};
    GLsizei edge = atlas->moves ? KILN_ATLAS_MOTION : 1;
    GLsizei layers = atlas->moves ? (GLsizei)atlas->layers : 1;
    glGenTextures(1, &atlas->motion);
    glBindTexture(GL_TEXTURE_2D_ARRAY, atlas->motion);
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RG8_SNORM, edge, edge, layers, 0, GL_RG, GL_BYTE,
                 atlas->moves ? atlas->moves : still);
    set_filters(1, GL_LINEAR);
}

bool kiln_atlas_send(struct kiln_atlas *atlas, struct kiln_error *error)
{
    if (atlas->texture)
        return true;
    struct kiln_device *device = atlas->device;
    if (!device)
        return kiln_error_set(error, KILN_DEVICE_FAILED, "a host atlas is not in GL");
    if ((int64_t)atlas->layers > device->info.max_array_layers)
        return kiln_error_set(error, KILN_DEVICE_FAILED,
                              "the atlases have %u cells together; %s takes %d", atlas->layers,
                              device->info.name, device->info.max_array_layers);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    upload_cells(atlas);
    upload_moves(atlas);
    kiln_device_label(device, GL_TEXTURE, atlas->texture, "atlas");
    kiln_device_label(device, GL_TEXTURE, atlas->motion, "atlas motion");
    return kiln_device_check(device, "atlas", error);
}

const uint8_t *kiln_atlas_level(const struct kiln_atlas *atlas, uint32_t layer, uint32_t level)
{
    size_t offset = (size_t)layer * KILN_ATLAS_LAYER_BYTES;
    for (uint32_t i = 0; i < level; i++)
        offset += 4 * (size_t)(KILN_ATLAS_CELL >> i) * (KILN_ATLAS_CELL >> i);
    return atlas->texels + offset;
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

static bool fill_layers(struct kiln_atlas *atlas, struct flipbooks *all,
                        struct kiln_threads *threads, struct kiln_error *error)
{
    bool ok = true, any_moves = false;
    for (uint32_t i = 0; i < all->count; i++)
        any_moves |= moves(&all->books[i]);
    atlas->texels = malloc((size_t)atlas->layers * KILN_ATLAS_LAYER_BYTES + 1); /* none: not NULL */
    if (any_moves)
        atlas->moves = calloc(atlas->layers, KILN_ATLAS_MOVES_BYTES);
    if (!atlas->texels || (any_moves && !atlas->moves))
        return out_of_memory(error, "atlas");
    for (uint32_t i = 0; ok && i < all->count; i++) {
        const struct flipbook *book = &all->books[i];
        ok = book->failed ? out_of_memory(error, book->source.path)
                          : make_cells(atlas, book, threads, error) &&
                                (!moves(book) || make_motion(atlas, book, threads, error));
    }
    return ok;
}

bool kiln_atlas_init(struct kiln_atlas *atlas, struct kiln_device *device,
                     const struct kiln_atlas_request *requests, uint32_t count,
                     struct kiln_threads *threads, struct kiln_error *error)
{
    *atlas = (struct kiln_atlas){.device = device};
    struct flipbooks all = {0};
    for (uint32_t i = 0; i < count; i++) {
        atlas->systems[i].count = requests[i].count;
        for (uint32_t k = 0; k < requests[i].count; k++)
            add_texture(&all, atlas, &requests[i], k, &atlas->systems[i].textures[k]);
    }
    kiln_threads_for(threads, all.count, 1, make_films, &all);
    bool ok = fill_layers(atlas, &all, threads, error);
    for (uint32_t i = 0; i < all.copy_count; i++)
        *all.copies[i] = *all.books[all.originals[i]].range;
    for (uint32_t i = 0; i < all.count; i++)
        free(all.books[i].film);
    if (!ok)
        kiln_atlas_finish(atlas);
    return ok;
}

void kiln_atlas_finish(struct kiln_atlas *atlas)
{
    if (atlas->texture) {
        glDeleteTextures(1, &atlas->texture);
        glDeleteTextures(1, &atlas->motion);
    }
    free(atlas->texels);
    free(atlas->moves);
    *atlas = (struct kiln_atlas){0};
}
