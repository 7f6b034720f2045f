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
struct picture {
    struct kiln_pyramid *pyramid; /* NULL: the mesh takes no paint */
    float (*colors)[4];           /* the pyramid's texels, before they are rounded to half floats */
    float *weights;               /* the part of each texel that is on the mesh */
    uint32_t drawn;               /* the canvas's `changes` that the texture shows */
    uint32_t changes;             /* grows when the texture changes; 1 at first */
};

struct kiln_painted {
    struct picture pictures[KILN_MAX_MESHES];
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
struct under {
    size_t texels[4];
};

static struct under find_under(const struct kiln_pyramid *p, uint32_t level, uint32_t x, uint32_t y)
{
    const size_t width = p->widths[level - 1];
    const size_t first = p->first[level - 1] + 2 * (size_t)y * width + 2 * (size_t)x;
    return (struct under){{first, first + 1, first + width, first + width + 1}};
}

static void weigh(struct picture *picture, const uint8_t *on)
{
    const struct kiln_pyramid *p = picture->pyramid;
    for (size_t i = 0; i < (size_t)p->widths[0] * p->heights[0]; i++)
        picture->weights[i] = on[i] ? 1.0f : 0.0f;
    for (uint32_t level = 1; level < p->levels; level++) {
        float *to = picture->weights + p->first[level];
        for (uint32_t y = 0; y < p->heights[level]; y++) {
            for (uint32_t x = 0; x < p->widths[level]; x++) {
                const struct under under = find_under(p, level, x, y);
                float sum = 0.0f;
                for (int k = 0; k < 4; k++)
                    sum += picture->weights[under.texels[k]];
                *to++ = 0.25f * sum;
            }
        }
    }
}

static void average(struct picture *picture, uint32_t level)
{
    const struct kiln_pyramid *p = picture->pyramid;
    size_t at = p->first[level];
    for (uint32_t y = 0; y < p->heights[level]; y++) {
        for (uint32_t x = 0; x < p->widths[level]; x++, at++) {
            const struct under under = find_under(p, level, x, y);
            const float whole = 4.0f * picture->weights[at];
            color4 sum = {0.0f, 0.0f, 0.0f, 0.0f};
            for (int k = 0; k < 4; k++)
                sum += load(picture->colors[under.texels[k]]) * picture->weights[under.texels[k]];
            sum = whole > 0.0f ? sum / whole : sum;
            memcpy(picture->colors[at], &sum, sizeof sum);
        }
    }
}

static void fill_holes(struct picture *picture, uint32_t level)
{
    const struct kiln_pyramid *p = picture->pyramid;
    size_t from = p->first[level];
    for (uint32_t y = 0; y < p->heights[level]; y++) {
        for (uint32_t x = 0; x < p->widths[level]; x++, from++) {
            const struct under under = find_under(p, level, x, y);
            for (int k = 0; k < 4; k++) {
                if (picture->weights[under.texels[k]] == 0.0f)
                    memcpy(picture->colors[under.texels[k]], picture->colors[from],
                           sizeof *picture->colors);
            }
        }
    }
}

static void update(struct picture *picture, const struct kiln_canvas *canvas)
{
    struct kiln_pyramid *p = picture->pyramid;
    memcpy(picture->colors, canvas->texels,
           (size_t)canvas->edge * canvas->edge * 4 * sizeof(float));
    for (uint32_t level = 1; level < p->levels; level++)
        average(picture, level);
    for (uint32_t level = p->levels - 1; level > 0; level--)
        fill_holes(picture, level);
    kiln_pyramid_set(p, (const float(*)[4])picture->colors);
    picture->drawn = canvas->changes;
    picture->changes++;
}

/* ---- textures of all meshes ------------------------------------------------------------------ */

static bool init_picture(struct picture *picture, const struct kiln_object *object,
                         const struct kiln_mesh *mesh, struct kiln_error *error)
{
    struct kiln_chart *chart = kiln_chart_create(mesh, object->paint.size, object->file, error);
    if (!chart)
        return false;
    picture->pyramid = kiln_pyramid_create(object->paint.size, object->paint.size);
    if (picture->pyramid) {
        const size_t texels = kiln_pyramid_texels(picture->pyramid);
        picture->colors = calloc(texels, sizeof *picture->colors);
        picture->weights = malloc(texels * sizeof *picture->weights);
    }
    const bool ok = picture->colors && picture->weights;
    if (ok)
        weigh(picture, chart->on);
    else
        kiln_error_set(error, KILN_DEVICE_FAILED, "%s: out of memory for paint", object->file);
    picture->changes = 1;
    kiln_chart_destroy(&chart);
    return ok;
}

struct kiln_painted *kiln_painted_create(const struct kiln_scene *scene,
                                         const struct kiln_mesh *const *meshes,
                                         struct kiln_error *error)
{
    struct kiln_painted *painted = calloc(1, sizeof *painted);
    if (!painted) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "paint: out of memory");
        return NULL;
    }
    uint32_t mesh = 0, canvas = 0;
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++) {
        const struct kiln_object *object = &scene->backdrop.objects[i];
        if (kiln_object_takes_paint(object)) {
            painted->canvases[mesh] = canvas++;
            if (!init_picture(&painted->pictures[mesh], object, meshes[mesh], error)) {
                kiln_painted_destroy(&painted);
                return NULL;
            }
        }
        mesh += kiln_object_is_mesh(object);
    }
    return painted;
}

void kiln_painted_destroy(struct kiln_painted **painted)
{
    if (!*painted)
        return;
    for (uint32_t i = 0; i < KILN_MAX_MESHES; i++) {
        struct picture *picture = &(*painted)->pictures[i];
        kiln_pyramid_destroy(&picture->pyramid);
        free(picture->colors);
        free(picture->weights);
    }
    free(*painted);
    *painted = NULL;
}

void kiln_painted_update(struct kiln_painted *painted, const struct kiln_pool *pool)
{
    for (uint32_t i = 0; i < KILN_MAX_MESHES; i++) {
        struct picture *picture = &painted->pictures[i];
        if (!picture->pyramid || painted->canvases[i] >= pool->canvas_count)
            continue;
        const struct kiln_canvas *canvas = &pool->canvases[painted->canvases[i]];
        if (picture->drawn != canvas->changes)
            update(picture, canvas);
    }
}

const struct kiln_pyramid *kiln_painted_picture(const struct kiln_painted *painted, uint32_t mesh)
{
    return painted->pictures[mesh].pyramid;
}

uint32_t kiln_painted_changes(const struct kiln_painted *painted, uint32_t mesh)
{
    return painted->pictures[mesh].changes;
}

uint64_t kiln_painted_all_changes(const struct kiln_painted *painted)
{
    uint64_t sum = 0;
    for (uint32_t i = 0; i < KILN_MAX_MESHES; i++)
        sum += painted->pictures[i].changes;
    return sum;
}
