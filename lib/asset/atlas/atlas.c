/* This file makes the textures of particles. It prepares cells in float on the host, one flipbook
 * at a time: generated or read from a file, then shrunk level by level and stored in 8 bits. The
 * motion of the cells is a second texture with the same layers, much coarser, since gas moves
 * together. */
#include "asset/atlas/atlas.h"

#include <math.h>
#include <stdlib.h>

#include "asset/atlas/atlas_code.h"
#include "asset/atlas/builtin.h"
#include "asset/atlas/cells_in.h"
#include "asset/atlas/flipbook_cache.h"
#include "asset/image/image.h"
#include "asset/loader/loader.h"
#include "base/error.h"
#include "base/pages.h"

/* One of the different flipbooks that the systems of a scene ask for. */
struct flipbook {
    struct kiln_cells_source source;
    const char *name; /* name of a built-in flipbook, or NULL */
    struct kiln_builtin builtin;
    const struct kiln_atlas_request *request;
    struct kiln_atlas_range *range;
    uint32_t texture;                     /* index of the texture in the request */
    char cached[KILN_FLIPBOOK_NAME_SIZE]; /* its name in the cache; "": it is not cached */
    bool is_made;
    bool failed; /* true: memory was short */
};

static const size_t CELL_FLOATS = (size_t)KILN_ATLAS_CELL * KILN_ATLAS_CELL * 4;

static bool out_of_memory(struct kiln_error *error, const char *source)
{
    return kiln_error_no_memory(error, "the cells of %s", source);
}

/* ---- from files ------------------------------------------------------------------------------ */

static uint8_t *texels_of(const struct kiln_atlas *atlas, const struct flipbook *book, size_t cell)
{
    return atlas->texels + (book->range->first_layer + cell) * KILN_ATLAS_LAYER_BYTES;
}

static int8_t *moves_of(const struct kiln_atlas *atlas, const struct flipbook *book)
{
    return atlas->moves + (size_t)book->range->first_layer * KILN_ATLAS_MOVES_BYTES;
}

struct storing {
    const struct kiln_atlas *atlas;
    const struct flipbook *book;
    const struct kiln_atlas_code *code;
    float *cells;
};

static void store_cells(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct storing *job = context;
    for (size_t i = begin; i < end; i++)
        job->code->store_cell(job->cells + i * CELL_FLOATS, KILN_ATLAS_CELL, job->book->range->kind,
                              texels_of(job->atlas, job->book, i));
}

static bool load_cells(struct kiln_atlas *atlas, const struct flipbook *book, enum kiln_simd simd,
                       struct kiln_threads *threads, struct kiln_error *error)
{
    const uint32_t count = book->range->cells;
    struct storing job = {atlas, book, KILN_SIMD_PICK(kiln_atlas, simd),
                          calloc(count, CELL_FLOATS * sizeof(float))};
    bool ok = job.cells != NULL;
    if (!ok)
        out_of_memory(error, book->source.path);
    ok = ok && kiln_cells_load(&book->source, job.cells, threads, error);
    if (ok)
        kiln_threads_for(threads, count, 1, store_cells, &job);
    free(job.cells);
    return ok;
}

/* ---- motion ---------------------------------------------------------------------------------- */

/* Returns whether the cells of a flipbook have motion. */
static bool moves(const struct flipbook *book)
{
    const char *motion = book->request->motion;
    return motion[0] == '/' ||
           (book->name && strcmp(motion, "auto") == 0 && kiln_builtin_has_motion(book->name));
}

/* Stores motion relative to its largest part, rows from the top and y down as textures have it. */
static void encode_motion(const float *motion, size_t pixels, float largest, int8_t *bytes)
{
    for (size_t i = 0; i < 2 * pixels; i++) {
        float part = motion[i] / largest * (i % 2 ? -127.0f : 127.0f);
        bytes[i] = (int8_t)floorf(part + 0.5f);
    }
}

/* Stores the motion of all cells of a flipbook; motion times `scale` is in edges of a cell. */
static void store_motion(struct kiln_atlas *atlas, const struct flipbook *book, const float *motion,
                         float scale)
{
    const size_t pixels = (size_t)book->range->cells * KILN_ATLAS_MOTION * KILN_ATLAS_MOTION;
    float largest = 0.0f;
    for (size_t i = 0; i < pixels * 2; i++)
        largest = fmaxf(largest, fabsf(motion[i]));
    if (largest > 0.0f) {
        encode_motion(motion, pixels, largest, moves_of(atlas, book));
        book->range->motion = largest * scale;
    }
}

/* Makes the motion of a file, which is in full values of red and green, relative to the larger of
 * the two scales, and returns that scale. */
static float scale_axes(const float full[2], float *motion, size_t pixels)
{
    const float scale = fmaxf(fabsf(full[0]), fabsf(full[1]));
    for (size_t i = 0; scale > 0.0f && i < 2 * pixels; i++)
        motion[i] *= full[i % 2] / scale;
    return scale;
}

static bool make_motion(struct kiln_atlas *atlas, const struct flipbook *book,
                        struct kiln_threads *threads, struct kiln_error *error)
{
    const size_t texels = (size_t)KILN_ATLAS_MOTION * KILN_ATLAS_MOTION;
    float *motion = malloc(book->range->cells * texels * 2 * sizeof *motion);
    struct kiln_builtin_scratch *scratch =
        book->builtin.film ? kiln_builtin_scratch_create() : NULL;
    bool ok = motion && (scratch || !book->builtin.film);
    float scale = 1.0f;
    if (!ok)
        out_of_memory(error, book->source.path);
    if (ok && book->request->motion[0] == '/') {
        struct kiln_cells_source source = book->source;
        source.path = book->request->motion;
        source.edge = KILN_ATLAS_MOTION;
        ok = kiln_cells_load_motion(&source, motion, threads, error);
        if (ok)
            scale = scale_axes(book->request->motion_full, motion, book->range->cells * texels);
    } else if (ok) {
        for (uint32_t i = 0; i < book->range->cells; i++)
            kiln_builtin_motion(&book->builtin, i, KILN_ATLAS_MOTION, scratch,
                                motion + i * texels * 2);
    }
    if (ok)
        store_motion(atlas, book, motion, scale);
    free(scratch);
    free(motion);
    return ok;
}

/* ---- textures -------------------------------------------------------------------------------- */

/* Sets the filters of the bound texture. */
static void set_filters(GLint levels, GLint shrinking)
{
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, levels - 1);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, shrinking);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

/* Chooses the format of cells. llvmpipe filters 8-bit textures in 8 bits, which is off by 1 % where
 * a layer is faint. It filters textures of more bits in floats, hardly slower. */
static GLenum cell_format(const struct kiln_device *device)
{
    return device->info.software ? GL_RGBA16 : GL_RGBA8;
}

static void upload_strips(struct kiln_atlas *atlas)
{
    glGenTextures(1, &atlas->strips);
    glBindTexture(GL_TEXTURE_2D_ARRAY, atlas->strips);
    glTexStorage3D(GL_TEXTURE_2D_ARRAY, 1, cell_format(atlas->device), 1, KILN_ATLAS_STRIP,
                   atlas->layers ? (GLsizei)atlas->layers : 1);
    for (uint32_t layer = 0; layer < atlas->layers; layer++)
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, (GLint)layer, 1, KILN_ATLAS_STRIP, 1, GL_RGBA,
                        GL_UNSIGNED_BYTE, kiln_atlas_level(atlas, layer, KILN_STRIP_LEVEL));
    set_filters(1, GL_LINEAR);
}

static void upload_cells(struct kiln_atlas *atlas)
{
    glGenTextures(1, &atlas->texture);
    glBindTexture(GL_TEXTURE_2D_ARRAY, atlas->texture);
    glTexStorage3D(GL_TEXTURE_2D_ARRAY, KILN_ATLAS_LEVELS, cell_format(atlas->device),
                   KILN_ATLAS_CELL, KILN_ATLAS_CELL, atlas->layers ? (GLsizei)atlas->layers : 1);
    for (uint32_t layer = 0; layer < atlas->layers; layer++) {
        for (uint32_t level = 0; level < KILN_ATLAS_LEVELS; level++) {
            GLsizei edge = KILN_ATLAS_CELL >> level;
            glTexSubImage3D(GL_TEXTURE_2D_ARRAY, (GLint)level, 0, 0, (GLint)layer, edge, edge, 1,
                            GL_RGBA, GL_UNSIGNED_BYTE, kiln_atlas_level(atlas, layer, level));
        }
    }
    set_filters(KILN_ATLAS_LEVELS, GL_LINEAR_MIPMAP_NEAREST);
}

/* Uploads the motion; the texture has one texel if nothing moves. */
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
                              "the atlases have %u cells together; %s takes at most %d",
                              atlas->layers, device->info.name, device->info.max_array_layers);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    upload_cells(atlas);
    upload_strips(atlas);
    upload_moves(atlas);
    kiln_device_label(device, GL_TEXTURE, atlas->texture, "atlas");
    kiln_device_label(device, GL_TEXTURE, atlas->strips, "atlas strips");
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

/* ---- making all flipbooks -------------------------------------------------------------------- */

static bool same_flipbook(const struct flipbook *a, const struct flipbook *b)
{
    return strcmp(a->source.path, b->source.path) == 0 && a->source.columns == b->source.columns &&
           a->source.rows == b->source.rows &&
           strcmp(a->request->motion, b->request->motion) == 0 &&
           a->request->motion_full[0] == b->request->motion_full[0] &&
           a->request->motion_full[1] == b->request->motion_full[1];
}

struct flipbooks {
    enum kiln_simd simd;
    struct flipbook books[KILN_MAX_SYSTEMS * KILN_MAX_TEXTURES];
    uint32_t count;
    /* ranges that equal the range of an */
    struct kiln_atlas_range *copies[KILN_MAX_SYSTEMS * KILN_MAX_TEXTURES];
    uint32_t originals[KILN_MAX_SYSTEMS * KILN_MAX_TEXTURES]; /* earlier flipbook */
    uint32_t copy_count;
};

/* Gives a texture its layers, or notes that an earlier texture is the same. */
static void add_texture(struct flipbooks *all, struct kiln_atlas *atlas,
                        const struct kiln_atlas_request *request, uint32_t texture,
                        struct kiln_atlas_range *range)
{
    struct flipbook book = {
        .source = {request->sources[texture], request->columns, request->rows, KILN_ATLAS_CELL,
                   request->loader},
        .name = kiln_builtin_name_of(request->sources[texture]),
        .request = request,
        .range = range,
        .texture = texture,
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
        .kind = book.name ? KILN_CELL_MASK : KILN_CELL_COLOR,
    };
    atlas->layers += range->cells;
    all->books[all->count++] = book;
}

static void open_builtins(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct flipbooks *all = context;
    for (size_t i = begin; i < end; i++) {
        struct flipbook *book = &all->books[i];
        if (book->name && !book->is_made)
            book->failed =
                !kiln_builtin_open(&book->builtin, book->name, book->range->cells, all->simd);
    }
}

/* Holds the memory of one thread. */
struct maker {
    float *cell;
    struct kiln_builtin_scratch *scratch;
};

struct making {
    const struct kiln_atlas *atlas;
    const struct flipbooks *all;
    struct maker *makers; /* one for each thread */
};

/* Makes layers of built-in flipbooks. */
static void make_layers(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct making *job = context;
    const struct maker *maker = &job->makers[worker];
    const struct kiln_atlas_code *code = KILN_SIMD_PICK(kiln_atlas, job->all->simd);
    for (size_t layer = begin; layer < end; layer++) {
        const struct flipbook *book = job->all->books;
        while (layer >= (size_t)book->range->first_layer + book->range->cells)
            book++;
        if (!book->name || book->is_made)
            continue;
        uint32_t cell = (uint32_t)layer - book->range->first_layer;
        kiln_builtin_cell(&book->builtin, cell, KILN_ATLAS_CELL, maker->scratch, maker->cell);
        code->store_cell(maker->cell, KILN_ATLAS_CELL, book->range->kind,
                         texels_of(job->atlas, book, cell));
    }
}

static bool make_builtins(struct kiln_atlas *atlas, struct flipbooks *all,
                          struct kiln_threads *threads, struct kiln_error *error)
{
    const uint32_t count = kiln_threads_count(threads);
    struct making job = {atlas, all, calloc(count, sizeof(struct maker))};
    bool ok = job.makers != NULL;
    kiln_threads_for(threads, all->count, 1, open_builtins, all);
    for (uint32_t i = 0; i < all->count; i++)
        ok = ok && !all->books[i].failed;
    for (uint32_t i = 0; ok && i < count; i++) {
        job.makers[i] =
            (struct maker){malloc(CELL_FLOATS * sizeof(float)), kiln_builtin_scratch_create()};
        ok = job.makers[i].cell && job.makers[i].scratch;
    }
    if (ok)
        kiln_threads_for(threads, atlas->layers, 1, make_layers, &job);
    for (uint32_t i = 0; job.makers && i < count; i++) {
        free(job.makers[i].cell);
        free(job.makers[i].scratch);
    }
    free(job.makers);
    return ok || out_of_memory(error, "built-in atlases");
}

/* ---- the cache ------------------------------------------------------------------------------- */

static struct kiln_flipbook_texels memory_of(const struct kiln_atlas *atlas,
                                             const struct flipbook *book)
{
    return (struct kiln_flipbook_texels){
        .texels = texels_of(atlas, book, 0),
        .texel_bytes = (size_t)book->range->cells * KILN_ATLAS_LAYER_BYTES,
        .moves = moves(book) ? moves_of(atlas, book) : NULL,
        .move_bytes = (size_t)book->range->cells * KILN_ATLAS_MOVES_BYTES,
        .motion = &book->range->motion,
    };
}

static void read_cached(const struct kiln_atlas *atlas, struct flipbooks *all, const char *cache)
{
    for (uint32_t i = 0; i < all->count; i++) {
        struct flipbook *book = &all->books[i];
        const struct kiln_flipbook_texels memory = memory_of(atlas, book);
        if (!kiln_flipbook_name(book->cached, book->request, book->texture))
            book->cached[0] = '\0';
        book->is_made = book->cached[0] && kiln_flipbook_read(cache, book->cached, &memory);
        if (!book->is_made)
            book->range->motion = 0.0f;
    }
}

/* Writes new flipbooks to the cache. A file that was changed while it was decoded has another name
 * now, and is not kept. */
static void write_cached(const struct kiln_atlas *atlas, const struct flipbooks *all,
                         const char *cache)
{
    for (uint32_t i = 0; i < all->count; i++) {
        const struct flipbook *book = &all->books[i];
        const struct kiln_flipbook_texels memory = memory_of(atlas, book);
        char name[KILN_FLIPBOOK_NAME_SIZE];
        if (book->cached[0] && !book->is_made &&
            kiln_flipbook_name(name, book->request, book->texture) &&
            strcmp(name, book->cached) == 0)
            kiln_flipbook_write(cache, name, &memory);
    }
}

static bool fill_layers(struct kiln_atlas *atlas, struct flipbooks *all, const char *cache,
                        struct kiln_threads *threads, struct kiln_error *error)
{
    atlas->texels = kiln_alloc_pages((size_t)atlas->layers * KILN_ATLAS_LAYER_BYTES);
    if (!atlas->texels)
        return out_of_memory(error, "atlas");
    bool any_moves = false;
    for (uint32_t i = 0; i < all->count; i++)
        any_moves |= moves(&all->books[i]);
    if (any_moves) {
        atlas->moves = calloc(atlas->layers, KILN_ATLAS_MOVES_BYTES);
        if (!atlas->moves)
            return out_of_memory(error, "atlas");
    }
    if (cache)
        read_cached(atlas, all, cache);
    bool ok = make_builtins(atlas, all, threads, error);
    for (uint32_t i = 0; ok && i < all->count; i++) {
        const struct flipbook *book = &all->books[i];
        ok = book->is_made || ((book->name || load_cells(atlas, book, all->simd, threads, error)) &&
                               (!moves(book) || make_motion(atlas, book, threads, error)));
    }
    if (ok && cache)
        write_cached(atlas, all, cache);
    return ok;
}

/* Gives all textures their layers and makes the flipbooks. */
static bool make_flipbooks(struct kiln_atlas *atlas, struct flipbooks *all,
                           const struct kiln_atlas_request *requests, uint32_t count,
                           const char *cache, struct kiln_threads *threads,
                           struct kiln_error *error)
{
    for (uint32_t i = 0; i < count; i++) {
        atlas->systems[i].count = requests[i].count;
        for (uint32_t k = 0; k < requests[i].count; k++)
            add_texture(all, atlas, &requests[i], k, &atlas->systems[i].textures[k]);
    }
    const bool ok = fill_layers(atlas, all, cache, threads, error);
    for (uint32_t i = 0; i < all->copy_count; i++)
        *all->copies[i] = *all->books[all->originals[i]].range;
    for (uint32_t i = 0; i < all->count; i++)
        kiln_builtin_close(&all->books[i].builtin);
    return ok;
}

/* Adds what making a flipbook from files takes: its cells in floats, and at most the
 * largest picture of the scene. */
static void add_making(const struct flipbook *book, struct kiln_footprint *footprint)
{
    const uint64_t cells = book->range->cells * CELL_FLOATS * sizeof(float);
    kiln_footprint_pass(footprint, KILN_FOOTPRINT_TEXTURES,
                        cells + kiln_loader_largest_picture(book->source.loader));
}

uint64_t kiln_atlas_footprint(const struct kiln_atlas_request *requests, uint32_t count,
                              struct kiln_footprint *footprint)
{
    struct flipbooks *all = calloc(1, sizeof *all);
    struct kiln_atlas_range ranges[KILN_MAX_TEXTURES * KILN_MAX_SYSTEMS];
    struct kiln_atlas atlas = {.layers = 0};
    uint32_t texture = 0;
    uint64_t films = 0;
    for (uint32_t i = 0; all && i < count; i++) {
        for (uint32_t k = 0; k < requests[i].count; k++)
            add_texture(all, &atlas, &requests[i], k, &ranges[texture++]);
    }
    for (uint32_t i = 0; all && i < all->count; i++) {
        const struct flipbook *book = &all->books[i];
        if (book->name)
            films += kiln_builtin_bytes(book->name, book->range->cells);
        else
            add_making(book, footprint);
    }
    free(all);
    kiln_footprint_pass(footprint, KILN_FOOTPRINT_TEXTURES, films);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_TEXTURES, atlas.layers,
                       KILN_ATLAS_LAYER_BYTES + KILN_ATLAS_MOVES_BYTES);
    return atlas.layers;
}

bool kiln_atlas_init(struct kiln_atlas *atlas, struct kiln_device *device,
                     const struct kiln_atlas_request *requests, uint32_t count, const char *cache,
                     struct kiln_threads *threads, struct kiln_error *error)
{
    *atlas = (struct kiln_atlas){.device = device};
    struct flipbooks *all = calloc(1, sizeof *all);
    bool ok = all ? kiln_simd_choose(&all->simd, error) : out_of_memory(error, "all systems");
    ok = ok && make_flipbooks(atlas, all, requests, count, cache, threads, error);
    free(all);
    if (!ok)
        kiln_atlas_finish(atlas);
    return ok;
}

void kiln_atlas_finish(struct kiln_atlas *atlas)
{
    if (atlas->texture) {
        glDeleteTextures(1, &atlas->texture);
        glDeleteTextures(1, &atlas->strips);
        glDeleteTextures(1, &atlas->motion);
    }
    free(atlas->texels);
    free(atlas->moves);
    *atlas = (struct kiln_atlas){0};
}
