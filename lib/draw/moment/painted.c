/* This file makes textures with mip levels of the paint on the backdrop's meshes. A texel of a
 * coarse level is the mean of the finer texels that lie on the mesh. A texel that lies on no
 * triangle then takes the colour of the coarser texel over it. So no bare texture shows through at
 * seams, whatever mip level is sampled. */
#include "draw/moment/painted.h"

#include <stdlib.h>
#include <string.h>

#include "asset/geometry/chart.h"
#include "base/error.h"

/* Holds the paint texture of a mesh. */
struct paint_texture {
    struct kiln_pyramid *pyramid; /* NULL: the mesh takes no paint */
    float (*colors)[4];           /* the pyramid's texels, before they are rounded to half floats */
    float *weights;               /* the part of each texel that is on the mesh */
    uint32_t drawn_changes;       /* the canvas's `changes` that the texture shows */
    uint32_t changes;             /* grows when the texture changes; 1 at first */
};

struct kiln_painted {
    struct paint_texture textures[KILN_MAX_MESHES];
    uint32_t canvases[KILN_MAX_MESHES]; /* number of each mesh's canvas in the pool */
};

/* ---- levels ---------------------------------------------------------------------------------- */

typedef float color4 __attribute__((vector_size(16)));

static color4 load(const float from[4])
{
    color4 color;
    memcpy(&color, from, sizeof color);
    return color;
}

/* Holds the indices of the four texels of the next finer level that a coarse texel covers. */
struct finer_texels {
    size_t texels[4];
};

static struct finer_texels finer_texels_of(const struct kiln_pyramid *p, uint32_t level, uint32_t x,
                                           uint32_t y)
{
    const size_t width = p->widths[level - 1];
    const size_t first = p->first[level - 1] + 2 * (size_t)y * width + 2 * (size_t)x;
    return (struct finer_texels){{first, first + 1, first + width, first + width + 1}};
}

static void compute_coverage(struct paint_texture *texture, const uint8_t *on)
{
    const struct kiln_pyramid *p = texture->pyramid;
    for (size_t i = 0; i < (size_t)p->widths[0] * p->heights[0]; i++)
        texture->weights[i] = on[i] ? 1.0f : 0.0f;
    for (uint32_t level = 1; level < p->levels; level++) {
        float *to = texture->weights + p->first[level];
        for (uint32_t y = 0; y < p->heights[level]; y++) {
            for (uint32_t x = 0; x < p->widths[level]; x++) {
                const struct finer_texels finer = finer_texels_of(p, level, x, y);
                float sum = 0.0f;
                for (int k = 0; k < 4; k++)
                    sum += texture->weights[finer.texels[k]];
                *to++ = 0.25f * sum;
            }
        }
    }
}

static void average(struct paint_texture *texture, uint32_t level)
{
    const struct kiln_pyramid *p = texture->pyramid;
    size_t at = p->first[level];
    for (uint32_t y = 0; y < p->heights[level]; y++) {
        for (uint32_t x = 0; x < p->widths[level]; x++, at++) {
            const struct finer_texels finer = finer_texels_of(p, level, x, y);
            const float whole = 4.0f * texture->weights[at];
            color4 sum = {0.0f, 0.0f, 0.0f, 0.0f};
            for (int k = 0; k < 4; k++)
                sum += load(texture->colors[finer.texels[k]]) * texture->weights[finer.texels[k]];
            sum = whole > 0.0f ? sum / whole : sum;
            memcpy(texture->colors[at], &sum, sizeof sum);
        }
    }
}

static void fill_holes(struct paint_texture *texture, uint32_t level)
{
    const struct kiln_pyramid *p = texture->pyramid;
    size_t from = p->first[level];
    for (uint32_t y = 0; y < p->heights[level]; y++) {
        for (uint32_t x = 0; x < p->widths[level]; x++, from++) {
            const struct finer_texels finer = finer_texels_of(p, level, x, y);
            for (int k = 0; k < 4; k++) {
                if (texture->weights[finer.texels[k]] == 0.0f)
                    memcpy(texture->colors[finer.texels[k]], texture->colors[from],
                           sizeof *texture->colors);
            }
        }
    }
}

static void update(struct paint_texture *texture, const struct kiln_canvas *canvas)
{
    struct kiln_pyramid *p = texture->pyramid;
    memcpy(texture->colors, canvas->texels,
           (size_t)canvas->edge * canvas->edge * 4 * sizeof(float));
    for (uint32_t level = 1; level < p->levels; level++)
        average(texture, level);
    for (uint32_t level = p->levels - 1; level > 0; level--)
        fill_holes(texture, level);
    kiln_pyramid_set(p, (const float(*)[4])texture->colors);
    texture->drawn_changes = canvas->changes;
    texture->changes++;
}

/* ---- textures of all meshes ------------------------------------------------------------------ */

static bool init_texture(struct paint_texture *texture, const struct kiln_object *object,
                         const struct kiln_mesh *mesh, struct kiln_error *error)
{
    struct kiln_chart *chart = kiln_chart_create(mesh, object->paint.size, object->file, error);
    if (!chart)
        return false;
    texture->pyramid = kiln_pyramid_create(object->paint.size, object->paint.size);
    if (texture->pyramid) {
        const size_t texels = kiln_pyramid_texels(texture->pyramid);
        texture->colors = calloc(texels, sizeof *texture->colors);
        texture->weights = malloc(texels * sizeof *texture->weights);
    }
    const bool ok = texture->colors && texture->weights;
    if (ok)
        compute_coverage(texture, chart->on);
    else
        kiln_error_no_memory(error, "the paint of %s", object->file);
    texture->changes = 1;
    kiln_chart_destroy(&chart);
    return ok;
}

struct kiln_painted *kiln_painted_create(const struct kiln_scene *scene,
                                         const struct kiln_mesh *const *meshes,
                                         struct kiln_error *error)
{
    struct kiln_painted *painted = calloc(1, sizeof *painted);
    if (!painted) {
        kiln_error_no_memory(error, "the paint");
        return NULL;
    }
    uint32_t mesh = 0, canvas = 0;
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        const struct kiln_object *object = &scene->backdrop.objects[i];
        if (kiln_object_takes_paint(object)) {
            painted->canvases[mesh] = canvas++;
            if (!init_texture(&painted->textures[mesh], object, meshes[mesh], error)) {
                kiln_painted_destroy(&painted);
                return NULL;
            }
        }
        mesh += kiln_object_is_mesh(object);
    }
    return painted;
}

void kiln_painted_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    const struct paint_texture *t = NULL;
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        const struct kiln_object *object = &scene->backdrop.objects[i];
        if (!kiln_object_takes_paint(object))
            continue;
        const uint32_t edge = object->paint.size;
        const uint64_t texels = kiln_pyramid_bytes(edge, edge) / sizeof *t->pyramid->texels;
        kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS, texels,
                           sizeof *t->pyramid->texels + sizeof *t->colors + sizeof *t->weights);
        kiln_footprint_pass(footprint, KILN_FOOTPRINT_OBJECTS,
                            kiln_chart_bytes(edge) + kiln_chart_making_bytes(edge));
    }
}

void kiln_painted_destroy(struct kiln_painted **painted)
{
    if (!*painted)
        return;
    for (uint32_t i = 0; i < KILN_MAX_MESHES; i++) {
        struct paint_texture *texture = &(*painted)->textures[i];
        kiln_pyramid_destroy(&texture->pyramid);
        free(texture->colors);
        free(texture->weights);
    }
    free(*painted);
    *painted = NULL;
}

void kiln_painted_update(struct kiln_painted *painted, const struct kiln_pool *pool)
{
    for (uint32_t i = 0; i < KILN_MAX_MESHES; i++) {
        struct paint_texture *texture = &painted->textures[i];
        if (!texture->pyramid || painted->canvases[i] >= pool->canvas_count)
            continue;
        const struct kiln_canvas *canvas = &pool->canvases[painted->canvases[i]];
        if (texture->drawn_changes != canvas->changes)
            update(texture, canvas);
    }
}

const struct kiln_pyramid *kiln_painted_picture(const struct kiln_painted *painted, uint32_t mesh)
{
    return painted->textures[mesh].pyramid;
}

uint32_t kiln_painted_changes(const struct kiln_painted *painted, uint32_t mesh)
{
    return painted->textures[mesh].changes;
}

uint64_t kiln_painted_all_changes(const struct kiln_painted *painted)
{
    uint64_t sum = 0;
    for (uint32_t i = 0; i < KILN_MAX_MESHES; i++)
        sum += painted->textures[i].changes;
    return sum;
}
