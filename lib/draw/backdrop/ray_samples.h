/* This header computes the colours of pixels at edges from KILN_EDGE_SAMPLES samples of each. All
 * samples are traced, but those of a pixel that lie on one smooth piece of surface share a colour,
 * and those on the piece at its centre have that of the centre, which is known. Where a shadow
 * parts a pixel, each sample has a colour of its own. */
#ifndef KILN_DRAW_BACKDROP_RAY_SAMPLES_H
#define KILN_DRAW_BACKDROP_RAY_SAMPLES_H

#include <stdlib.h>

#include "base/compress.h"
#include "draw/backdrop/ray_edges.h"
#include "draw/backdrop/ray_shade.h"
#include "shared/edge_mean.h"

enum {
    SAMPLES = KILN_EDGE_SAMPLES,
    SAMPLED_PIXELS = 256, /* whose samples share vectors */
    SHARED_ROOM = SAMPLES * SAMPLED_PIXELS + LANES,
};

/* ---- pieces of surface ----------------------------------------------------------------------- */

/* Holds what a ray hits, and where. */
struct placed_hit {
    struct ray_place place;
    struct ray_hit hit;
    struct vf3 at;
};

/* The piece of surface of each sample: 0: that at the pixel's centre; else 1 + the number of the
 * first sample on it. */
struct sample_pieces {
    vi of[SAMPLES];
};

SIMD struct placed_hit trace_place(const struct kiln_ray_frame *frame,
                                   const struct kiln_shape_set *shapes,
                                   const struct ray_place *place)
{
    const struct ray ray = rays_at(frame, place).ray;
    struct placed_hit placed = {.place = *place};
    placed.hit = trace(frame, shapes, &ray, find_floor(frame, &ray), place);
    placed.at = ray_at(&ray, placed.hit.t);
    return placed;
}

/* Returns the lanes where two hits lie on one smooth piece of surface, or both on the sky. */
SIMD vi share_piece(const struct placed_hit *a, const struct placed_hit *b)
{
    const struct vf3 way = vf3_sub(b->at, a->at);
    const vf off = vf3_dot(way, a->hit.normal), square = vf3_dot(way, way);
    const vi smooth = (vf3_dot(a->hit.normal, b->hit.normal) >= KILN_PIECE_COSINE) &
                      (off * off <= KILN_PIECE_SLOPE * KILN_PIECE_SLOPE * square);
    return (a->hit.surface == b->hit.surface) & ((a->hit.surface < 0.0f) | smooth);
}

/* Traces the samples of pixels, and finds the pieces that they are on. center: the rays through
 * the centres of the pixels. */
SIMD struct sample_pieces trace_samples(const struct kiln_ray_frame *frame,
                                        const struct kiln_shape_set *shapes,
                                        const struct ray_place *center,
                                        struct placed_hit samples[SAMPLES])
{
    const struct placed_hit middle = trace_place(frame, shapes, center);
    struct sample_pieces pieces;
    for (int s = 0; s < SAMPLES; s++) {
        const struct ray_place place = sample_place(frame, center, s);
        samples[s] = trace_place(frame, shapes, &place);
        vi piece = vi_all(s + 1);
        for (int before = s - 1; before >= 0; before--)
            piece = vi_select(share_piece(&samples[before], &samples[s]), pieces.of[before], piece);
        pieces.of[s] = vi_select(share_piece(&middle, &samples[s]), vi_all(0), piece);
    }
    return pieces;
}

/* Loads the numbers of pixels and of the eight around each, which repeat at the picture's border.
 */
SIMD void load_numbers_around(const struct kiln_backdrop_picture *p, vi column, vi row,
                              vf numbers[9])
{
    const vi width = vi_all((int32_t)p->width), height = vi_all((int32_t)p->height);
    for (int k = 0; k < 9; k++) {
        vi x = column + (k % 3 - 1), y = row + (k / 3 - 1);
        x = vi_select(x < 0, vi_all(0), vi_select(x < width, x, width - 1));
        y = vi_select(y < 0, vi_all(0), vi_select(y < height, y, height - 1));
        numbers[k] = without_mark(vf_gather(p->surfaces, y * width + x));
    }
}

/* Returns the lanes where no edge of light passes between a pixel and those around it: no two
 * neighbours of these nine are on one surface and differ. */
SIMD vi are_lit_evenly(const struct kiln_backdrop_picture *p, vi column, vi row)
{
    vf numbers[9];
    load_numbers_around(p, column, row, numbers);
    vi even = vi_all(-1);
    for (int k = 0; k < 9; k++) {
        for (int other = 0; other < k; other++) {
            if (k / 3 - other / 3 > 1 || abs(k % 3 - other % 3) > 1)
                continue;
            const vf step = vf_abs(numbers[k] - numbers[other]);
            even &= (step <= KILN_EDGE_THRESHOLD) | (step > KILN_EDGE_MOST_LIGHT);
        }
    }
    return even;
}

/* Gives each sample a piece of its own in the lanes that are not lit evenly. */
SIMD void part_pieces(vi even, struct sample_pieces *pieces)
{
    for (int s = 0; s < SAMPLES; s++)
        pieces->of[s] = vi_select(even, pieces->of[s], vi_all(s + 1));
}

/* Returns the lanes where light must be computed for a sample. */
SIMD vi needs_light(const struct sample_pieces *pieces, int sample)
{
    return pieces->of[sample] == sample + 1;
}

/* ---- colours --------------------------------------------------------------------------------- */

SIMD struct ray_color select_color(vi mask, const struct ray_color *a, const struct ray_color *b)
{
    return (struct ray_color){vf3_select(mask, a->rgb, b->rgb),
                              vf_select(mask, a->alpha, b->alpha)};
}

/* Loads the colours of pixels, which are those at their centres. */
SIMD struct ray_color load_centers(const struct kiln_backdrop_picture *p, vi pixel)
{
    const vi at = 4 * pixel;
    return (struct ray_color){
        {vf_gather(p->color, at), vf_gather(p->color + 1, at), vf_gather(p->color + 2, at)},
        vf_gather(p->color + 3, at)};
}

/* Writes the means of pixels' samples. colors: of their centres, and of the samples that need
 * light. active: mask of pixels that are written. */
SIMD void store_means(const struct kiln_backdrop_picture *p, vi pixel, vi active,
                      const struct sample_pieces *pieces,
                      const struct ray_color colors[1 + SAMPLES])
{
    const vf part = vf_all(1.0f / (float)SAMPLES);
    struct edge_sum sum = edge_sum_none();
    for (int s = 0; s < SAMPLES; s++) {
        struct ray_color color = colors[0];
        for (int piece = 1; piece <= s + 1; piece++)
            color = select_color(pieces->of[s] == piece, &colors[piece], &color);
        sum = edge_add(sum, color.rgb, color.alpha, part, p->frame->view->exposure.x);
    }
    const struct ray_color mean = {edge_mean(sum), sum.alpha};
    _Alignas(64) float channels[4 * LANES];
    store_colors(channels, &mean);
    for (int i = 0; i < LANES; i++) {
        if (active[i])
            memcpy(p->color + 4 * (size_t)pixel[i], channels + 4 * (size_t)i, 4 * sizeof *channels);
    }
}

/* ---- pixels whose samples share vectors ------------------------------------------------------ */

/* Holds the samples of some pixels that need light, without gaps, and what is known of the pixels.
 */
struct shared_samples {
    int count;
    float u[SHARED_ROOM], v[SHARED_ROOM], t[SHARED_ROOM], surface[SHARED_ROOM];
    float normal[3][SHARED_ROOM], albedo[3][SHARED_ROOM];
    int32_t of[SHARED_ROOM]; /* sample * SAMPLED_PIXELS + pixel */
    struct sample_pieces pieces[SAMPLED_PIXELS / LANES];
    float colors[4][SAMPLES * SAMPLED_PIXELS]; /* by `of`; unset where a sample needs no light */
};

SIMD void compress_vector(float (*to)[SHARED_ROOM], int at, struct selection selected, struct vf3 v)
{
    vf_compress(to[0] + at, selected, v.x);
    vf_compress(to[1] + at, selected, v.y);
    vf_compress(to[2] + at, selected, v.z);
}

/* Adds a sample of LANES pixels in the lanes of a mask. first: number of the first pixel. */
SIMD void add_samples(struct shared_samples *all, const struct placed_hit *sample, int number,
                      int first, vi mask)
{
    const struct selection selected = selection_of(mask);
    const int at = all->count;
    vf_compress(all->u + at, selected, sample->place.u);
    vf_compress(all->v + at, selected, sample->place.v);
    vf_compress(all->t + at, selected, sample->hit.t);
    vf_compress(all->surface + at, selected, sample->hit.surface);
    compress_vector(all->normal, at, selected, sample->hit.normal);
    compress_vector(all->albedo, at, selected, sample->hit.albedo);
    vi_compress(all->of + at, selected, vi_count() + (number * SAMPLED_PIXELS + first));
    all->count += selected.count;
}

/* Repeats the last sample, so that whole vectors hold samples. */
static void repeat_last(struct shared_samples *all)
{
    float *const arrays[] = {all->u,         all->v,         all->t,         all->surface,
                             all->normal[0], all->normal[1], all->normal[2], all->albedo[0],
                             all->albedo[1], all->albedo[2]};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) {
        for (int i = 0; i < LANES - 1; i++)
            arrays[k][all->count + i] = arrays[k][all->count - 1];
    }
}

SIMD struct vf3 load_sample_vector(float (*from)[SHARED_ROOM], int at)
{
    return (struct vf3){vf_load(from[0] + at), vf_load(from[1] + at), vf_load(from[2] + at)};
}

/* Computes the colours of all samples. */
SIMD void light_samples(const struct kiln_ray_frame *frame, struct shared_samples *all)
{
    const struct cached_rays planes = not_cached();
    const struct ray_help none = {NULL, &planes};
    if (all->count > 0)
        repeat_last(all);
    for (int at = 0; at < all->count; at += LANES) {
        const struct ray_place place = {.u = vf_load(all->u + at), .v = vf_load(all->v + at)};
        const struct ray ray = rays_at(frame, &place).ray;
        struct ray_hit hit = {.t = vf_load(all->t + at),
                              .surface = vf_load(all->surface + at),
                              .normal = load_sample_vector(all->normal, at),
                              .albedo = load_sample_vector(all->albedo, at)};
        color_floor(frame, &ray, &hit);
        const struct shaded_rays shaded = shade_hits(frame, &ray, &hit, &none);
        _Alignas(64) float channels[4][LANES];
        store_channels(channels, &shaded.color);
        for (int i = 0; i < LANES && at + i < all->count; i++) {
            for (int c = 0; c < 4; c++)
                all->colors[c][all->of[at + i]] = channels[c][i];
        }
    }
}

/* Antialiases up to SAMPLED_PIXELS pixels, in whole vectors; of the last one, only the first lanes
 * are written. */
static void antialias_together(const struct kiln_backdrop_picture *p,
                               const struct kiln_shape_set *shapes, int count,
                               const int32_t *columns, const int32_t *rows)
{
    struct shared_samples all;
    all.count = 0;
    for (int i = 0; i < count; i += LANES) {
        const vi column = vi_load(columns + i), row = vi_load(rows + i);
        struct placed_hit samples[SAMPLES];
        const struct ray_place center = rays_through_pixels(p->frame, column, row).place;
        struct sample_pieces *pieces = &all.pieces[i / LANES];
        *pieces = trace_samples(p->frame, shapes, &center, samples);
        part_pieces(are_lit_evenly(p, column, row), pieces);
        for (int s = 0; s < SAMPLES; s++)
            add_samples(&all, &samples[s], s, i, needs_light(pieces, s));
    }
    light_samples(p->frame, &all);
    for (int i = 0; i < count; i += LANES) {
        const vi pixel = vi_load(rows + i) * (int32_t)p->width + vi_load(columns + i);
        struct ray_color colors[1 + SAMPLES] = {load_centers(p, pixel)};
        for (int s = 0; s < SAMPLES; s++) {
            const int at = s * SAMPLED_PIXELS + i;
            colors[1 + s] =
                (struct ray_color){{vf_load(all.colors[0] + at), vf_load(all.colors[1] + at),
                                    vf_load(all.colors[2] + at)},
                                   vf_load(all.colors[3] + at)};
        }
        store_means(p, pixel, vi_count() < count - i, &all.pieces[i / LANES], colors);
    }
}

/* ---- pixels in the cache --------------------------------------------------------------------- */

/* Returns the pieces of samples that are in the cache, or finds them and puts them in. */
SIMD struct sample_pieces find_cached_pieces(const struct kiln_ray_frame *frame,
                                             const struct kiln_shape_set *shapes,
                                             const struct ray_place *center,
                                             const struct cached_rays *first)
{
    struct sample_pieces pieces;
    if (is_filled(first)) {
        for (int s = 0; s < SAMPLES; s++) {
            const struct cached_rays planes = cached_sample(first, s);
            pieces.of[s] = vi_of(read_cached(&planes, KILN_CACHE_PIECE));
        }
        return pieces;
    }
    struct placed_hit samples[SAMPLES];
    pieces = trace_samples(frame, shapes, center, samples);
    for (int s = 0; s < SAMPLES; s++) {
        const struct cached_rays planes = cached_sample(first, s);
        fill_cached(&planes, KILN_CACHE_PIECE, vf_of(pieces.of[s]));
    }
    return pieces;
}

/* Antialiases LANES pixels whose samples are in the cache, or get into it; then each gets light, so
 * that its planes are filled. first: planes of the first sample. */
SIMD_ONCE void antialias_cached(const struct kiln_backdrop_picture *p,
                                const struct kiln_shape_set *shapes, vi column, vi row, vi active,
                                const struct cached_rays *first)
{
    const struct kiln_ray_frame *frame = p->frame;
    const vi pixel = row * (int32_t)p->width + column;
    const struct ray_place center = rays_through_pixels(frame, column, row).place;
    struct sample_pieces pieces = find_cached_pieces(frame, shapes, &center, first);
    part_pieces(are_lit_evenly(p, column, row), &pieces);
    struct ray_color colors[1 + SAMPLES] = {load_centers(p, pixel)};
    for (int s = 0; s < SAMPLES; s++) {
        if (is_filled(first) && !any(needs_light(&pieces, s) & active))
            continue;
        const struct ray_place place = sample_place(frame, &center, s);
        const struct ray ray = rays_at(frame, &place).ray;
        const struct cached_rays planes = cached_sample(first, s);
        const struct ray_help help = {NULL, &planes};
        const struct ray_hit hit = find_hit(frame, shapes, &ray, &place, &planes);
        colors[1 + s] = shade_hits(frame, &ray, &hit, &help).color;
    }
    store_means(p, pixel, active, &pieces, colors);
}

#endif
