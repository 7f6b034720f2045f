/* Draws particles in double precision, as the reference for the techniques of stage `raster`. It
 * blends particles in the order of their entries, or collects the fragments of each pixel, sorts
 * them by depth and then blends them. */
#include "support/true_billboards.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/cmocka.h"

/* One particle's contribution to a pixel: view depth, m; premultiplied colour; bloom weights.
 * order: the drawing order, which decides between fragments of equal depth. One list holds the
 * fragments of all pixels. */
struct true_fragment {
    double depth, rgba[4], glow[3];
    uint64_t order;
    uint32_t pixel;
};

struct true_fragments {
    struct true_fragment *all;
    size_t count, room;
};

void true_picture_init(struct true_picture *picture, uint32_t width, uint32_t height)
{
    size_t pixels = (size_t)width * height;
    *picture = (struct true_picture){
        .width = width,
        .height = height,
        .color = (double(*)[4])calloc(pixels, sizeof *picture->color),
        .glow = (double(*)[4])calloc(pixels, sizeof *picture->glow),
    };
    assert_true(picture->color && picture->glow);
}

void true_picture_finish(struct true_picture *picture)
{
    free(picture->color);
    free(picture->glow);
}

/* Blends premultiplied rgba over a pixel of the picture, and rgba times the bloom weights over the
 * pixel's glow. sum: uses additive blending instead, also for alpha. */
static void true_blend(struct true_picture *picture, size_t pixel, const double rgba[4],
                       const double weights[3], bool sum)
{
    double passed = sum ? 1 : 1 - rgba[3];
    for (int c = 0; c < 4; c++) {
        double *color = &picture->color[pixel][c], *glow = &picture->glow[pixel][c];
        *color = rgba[c] + *color * passed;
        *glow = (c < 3 ? weights[c] : 1) * rgba[c] + *glow * passed;
    }
}

/* Appends a fragment to the list. */
static void true_keep(struct true_fragments *list, const struct true_fragment *fragment)
{
    if (list->count == list->room) {
        list->room = list->room ? 2 * list->room : 1 << 16;
        list->all = realloc(list->all, list->room * sizeof *list->all);
        assert_non_null(list->all);
    }
    list->all[list->count++] = *fragment;
}

/* Adds a sprite's fragment at a pixel to the list. The fragment of a round billboard becomes two
 * sheets, each of half its density, one in front of the billboard's plane and one behind it
 * (shared/fragment_layout.h). number: the sprite's index in the drawing order. */
static void true_split(struct true_fragments *list, const struct true_sprite *s,
                       const struct true_place *at, const double rgba[4], size_t pixel,
                       size_t number)
{
    struct true_fragment f = {.depth = at->depth, .order = 2 * number, .pixel = (uint32_t)pixel};
    memcpy(f.rgba, rgba, sizeof f.rgba);
    memcpy(f.glow, s->bloom, sizeof f.glow);
    double u = at->u * 2 - 1, v = at->v * 2 - 1;
    double half_depth = 0.5 * s->bulge * sqrt(fmax(1 - (u * u + v * v), 0));
    if (!(half_depth > 0)) {
        true_keep(list, &f);
        return;
    }
    f.rgba[3] = 1 - sqrt(fmax(1 - rgba[3], 0));
    for (int c = 0; c < 3; c++)
        f.rgba[c] = rgba[c] / (2 - f.rgba[3]);
    f.depth = at->depth + half_depth;
    true_keep(list, &f);
    f.depth = fmax(at->depth - half_depth, 0);
    f.order++;
    true_keep(list, &f);
}

/* Compares two fragments for qsort: by pixel, then by depth from far to near, then by drawing
 * order. */
static int true_compare(const void *a, const void *b)
{
    const struct true_fragment *one = a, *other = b;
    if (one->pixel != other->pixel)
        return one->pixel < other->pixel ? -1 : 1;
    if (one->depth > other->depth || one->depth < other->depth)
        return one->depth > other->depth ? -1 : 1;
    return one->order < other->order ? -1 : 1;
}

/* The input and output of drawing all entries. depth: the scene's view depth, m, at each pixel. */
struct true_pass {
    const struct true_scene *scene;
    const struct kiln_particles_draw *draw;
    const float *depth;
    struct true_fragments list;
    struct true_picture *picture;
};

static void true_draw_sprite(struct true_pass *pass, const struct true_sprite *s, size_t number)
{
    const struct kiln_particles_draw *draw = pass->draw;
    for (int y = s->box[1]; y < s->box[3]; y++) {
        for (int x = s->box[0]; x < s->box[2]; x++) {
            struct true_place at;
            size_t pixel = (size_t)y * pass->picture->width + (size_t)x;
            double rgba[4];
            if (!true_place_of(pass->scene, s, x + 0.5, y + 0.5, &at))
                continue;
            true_shade(pass->scene, s, &at, (double)pass->depth[pixel], rgba);
            if (s->additive && !draw->sum_alpha && !draw->fire_covers)
                rgba[3] = 0;
            if (!draw->by_fragment)
                true_blend(pass->picture, pixel, rgba, s->bloom, draw->sum_alpha);
            else if (rgba[0] != 0 || rgba[1] != 0 || rgba[2] != 0 || rgba[3] != 0)
                true_split(&pass->list, s, &at, rgba, pixel, number);
        }
    }
}

void true_draw(const struct true_scene *scene, const struct kiln_particles_draw *draw,
               struct true_picture *picture)
{
    struct kiln_error error = {0};
    struct true_pass pass = {
        scene, draw, kiln_image_host(draw->depth, KILN_READ, &error), {0}, picture};
    const uint32_t *entries = kiln_buffer_host(draw->entries, KILN_READ, &error);
    const struct kiln_particle *records =
        kiln_buffer_host(&draw->moment->pool->records, KILN_READ, &error);
    assert_true(entries && records && pass.depth);
    for (uint32_t i = 0; i < draw->count; i++) {
        struct true_sprite sprite;
        if (true_sprite_make(scene, entries[i], &records[KILN_ENTRY_SLOT(entries[i])], &sprite))
            true_draw_sprite(&pass, &sprite, i);
    }
    const struct true_fragments list = pass.list;
    if (list.count)
        qsort(list.all, list.count, sizeof *list.all, true_compare);
    for (size_t i = 0; i < list.count; i++) {
        const struct true_fragment *f = &list.all[i];
        true_blend(picture, f->pixel, f->rgba, f->glow, false);
    }
    free(list.all);
}
