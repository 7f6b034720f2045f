/* This file draws strips of opaque particles on the host. It first finds the sphere or triangle
 * that is visible in each sample of a pixel. It then computes the light of each visible sphere or
 * triangle once a pixel, by a ray through the pixel's middle. */
#include "draw/solids/instance_cast.h"
#include "shared/ball_pattern.h"
#include "shared/edge_mean.h"

enum { SAMPLES = KILN_SOLID_SAMPLES };

/* A depth beyond any scene. */
#define NO_DEPTH 2e9f

/* Holds the t at which a ray passes the centre of a sphere most closely. */
struct approach {
    vf t, inside; /* inside: radius^2 - distance^2 at t, m^2; negative for a miss */
    vf inverse2;  /* 1 / the squared length of the ray's direction */
};

SIMD struct approach closest_approach(struct vf3 ray, struct vf3 center, vf radius)
{
    vf inverse2 = 1.0f / vf3_dot(ray, ray), t = vf3_dot(ray, center) * inverse2;
    struct vf3 away = vf3_sub(vf3_scale(ray, t), center);
    return (struct approach){t, radius * radius - vf3_dot(away, away), inverse2};
}

/* Returns the t at which a ray enters the sphere; for a miss, the t of its closest approach. */
SIMD vf surface_depth(const struct approach *a)
{
    return a->t - vf_sqrt(vf_max(a->inside, vf_all(0.0f)) * a->inverse2);
}

/* ---- samples --------------------------------------------------------------------------------- */

/* Updates the samples of LANES pixels of a row, from column x on, where the sphere is nearest. */
SIMD void sample_pixels(const struct kiln_solid_strip *s, const struct kiln_drawn_sphere *sphere,
                        int32_t number, uint32_t row, int32_t x)
{
    const struct vf3 center = {vf_all(sphere->center[0]), vf_all(sphere->center[1]),
                               vf_all(sphere->center[2])};
    vf radius = vf_all(sphere->radius), column = vf_count() + ((float)x + 0.5f);
    float line = (float)(s->y + row) + 0.5f;
    const struct approach middle =
        closest_approach(view_ray(s->frame, column, vf_all(line)), center, radius);
    vf t = surface_depth(&middle);
    size_t at = (size_t)row * SAMPLES * s->pitch + (size_t)x;
    for (int k = 0; k < SAMPLES; k++, at += s->pitch) {
        struct vf3 ray =
            view_ray(s->frame, column + SAMPLE_OFFSETS[k][0], vf_all(line + SAMPLE_OFFSETS[k][1]));
        const struct approach aside = closest_approach(ray, center, radius);
        vf before = vf_load(s->samples + at);
        vi nearer = (aside.inside >= 0.0f) & (t < before);
        if (!any(nearer))
            continue;
        float *numbers = (float *)(void *)(s->nearest + at);
        vf_store(s->samples + at, vf_select(nearer, t, before));
        vf_store(numbers, (vf)vi_select(nearer, vi_all(number), (vi)vf_load(numbers)));
    }
}

static void sample_sphere(const struct kiln_solid_strip *s, uint32_t number)
{
    const struct kiln_drawn_sphere *sphere = &s->spheres[number];
    const struct kiln_row_range rows = s->ranges[number];
    int32_t y = rows.from > (int32_t)s->y ? rows.from : (int32_t)s->y;
    int32_t y_to = rows.to < (int32_t)s->y_to ? rows.to : (int32_t)s->y_to;
    for (; y < y_to; y++) {
        for (int32_t x = sphere->x.from; x < sphere->x.to; x += LANES)
            sample_pixels(s, sphere, (int32_t)number, (uint32_t)y - s->y, x);
    }
}

/* Sets the samples to the scene's depth, so that particles behind the scene are not visible. */
static void clear_samples(const struct kiln_solid_strip *s, uint32_t row)
{
    const float *scene = s->scene_depth + (size_t)(s->y + row) * s->width;
    float *samples = s->samples + (size_t)row * SAMPLES * s->pitch;
    for (int k = 0; k < SAMPLES; k++, samples += s->pitch) {
        for (uint32_t x = 0; x < s->width; x++)
            samples[x] = scene[x] + scene[x] * 1e-7f; /* a solid at the scene's depth is visible */
        for (size_t x = s->width; x < s->pitch; x++)
            samples[x] = -1.0f;
    }
    memset(s->nearest + (size_t)row * SAMPLES * s->pitch, 0xff,
           SAMPLES * s->pitch * sizeof *s->nearest);
}

/* ---- patterns -------------------------------------------------------------------------------- */

/* Transforms a direction from the world to the ball's own axes. axis, w: the ball's pose, a unit
 * quaternion from its axes to the world. */
SIMD struct vf3 world_to_ball(const struct vf3 axis, vf w, struct vf3 v)
{
    struct vf3 twice = vf3_scale(cast_cross(axis, v), vf_all(-2.0f));
    return vf3_add(vf3_add_scaled(v, twice, w), vf3_scale(cast_cross(axis, twice), vf_all(-1.0f)));
}

/* Mixes the second colour of patterns into the albedo, antialiased over the width of a pixel. */
static void paint_spheres(const struct kiln_solid_strip *s, const struct visible_particles *visible,
                          struct visible_point *place)
{
    const struct kiln_drawn_sphere *all = s->spheres;
    const float4 frustum = s->frame->view->frustum;
    const struct vf3 axis = gather3(all->pose, visible->particle);
    struct vf3 n = world_to_ball(axis, vf_gather(all->pose + 3, visible->particle), place->normal);
    vf away = vf3_dot(place->direction, place->direction);
    vf facing = vf_max(-vf3_dot(place->direction, place->normal), vf_all(0.0f)) / vf_sqrt(away);
    vf pixel = place->depth * (2.0f * frustum.y / frustum.w);
    vf width = pixel / (vf_gather(&all->radius, visible->particle) * vf_max(facing, vf_all(0.1f)));
    vf part = ball_other_part(n, vf_gather(&all->segments, visible->particle), width);
    struct vf3 other = gather3(all->other, visible->particle);
    place->albedo = vf3_add_scaled(place->albedo, vf3_sub(other, place->albedo), part);
}

/* ---- light ----------------------------------------------------------------------------------- */

static void light_spheres(const struct kiln_solid_strip *s, const struct visible_particles *visible,
                          uint32_t y, struct ray_color *color)
{
    const struct kiln_ray_frame *frame = s->frame;
    const struct kiln_drawn_sphere *all = s->spheres;
    struct vf3 ray = view_ray(frame, vf_of(visible->column) + 0.5f, vf_all((float)y + 0.5f));
    struct vf3 center = gather3(all->center, visible->particle);
    const struct approach close =
        closest_approach(ray, center, vf_gather(&all->radius, visible->particle));
    vf t = surface_depth(&close);
    struct vf3 out = vf3_normalize(vf3_sub(vf3_scale(ray, t), center));
    struct visible_point place = {.depth = t,
                                  .lit = vf_gather(&all->lit, visible->particle),
                                  .albedo = gather3(all->albedo, visible->particle),
                                  .glow = gather3(all->glow, visible->particle)};
    place.direction = view_to_world(frame, ray);
    place.normal = view_to_world(frame, out);
    place.at = vf3_add_scaled(vf3_all(frame->view->eye), place.direction, t);
    place.sun_from = place.at;
    place.middle = vf3_add(vf3_all(frame->view->eye), view_to_world(frame, center));
    if (s->patterned)
        paint_spheres(s, visible, &place);
    light_place(frame, &place, visible, color);
}

/* Adds the light of particles to their pixels, lane by lane: weighted as samples of an edge to the
 * colour, with the sum of weights in its alpha; as it is to the bloom. bloom: the bloom weights in
 * the first record of the particles' array. */
SIMD void add_particles(const struct kiln_solid_strip *s, const struct visible_particles *visible,
                        uint32_t count, uint32_t y, const float *bloom,
                        const struct ray_color *light)
{
    const vf weight = visible->part * edge_weight(light->rgb, s->frame->view->exposure.x);
    for (uint32_t i = 0; i < count; i++) {
        const float *weights = bloom + visible->particle[i];
        size_t at = 4 * ((size_t)y * s->width + (size_t)visible->column[i]);
        float part = visible->part[i];
        const float rgb[3] = {light->rgb.x[i], light->rgb.y[i], light->rgb.z[i]};
        for (int c = 0; c < 3; c++) {
            s->color[at + (size_t)c] += rgb[c] * weight[i];
            s->bloom[at + (size_t)c] += rgb[c] * part * weights[c];
        }
        s->color[at + 3] += weight[i];
        s->bloom[at + 3] += part;
    }
}

/* ---- pixels ---------------------------------------------------------------------------------- */

static inline float lesser(float a, float b)
{
    return a < b ? a : b;
}

static inline float greater(float a, float b)
{
    return a > b ? a : b;
}

/* Returns the second least depth of a pixel's samples. It is the pixel's depth, since a mean of the
 * depths of different surfaces would lie on none of them. */
static inline float second_of(const float t[SAMPLES])
{
    float near_a = lesser(t[0], t[1]), far_a = greater(t[0], t[1]);
    float near_b = lesser(t[2], t[3]), far_b = greater(t[2], t[3]);
    return lesser(greater(near_a, near_b), lesser(far_a, far_b));
}

/* Returns the part of the pixels that it fills that a particle covers. */
static inline float part_of(const struct kiln_solid_strip *s, uint32_t number)
{
    return is_instance(s, number) ? s->instances[number].part : s->spheres[number].part;
}

/* Holds lists of the particles in the pixels of a row. An entry has three words: the column; the
 * particle's number times 4, plus the quarters of the pixel that it covers less 1; the triangle.
 * The list of spheres grows from the front of the memory, that of triangles from its back. */
struct row_entries {
    uint32_t *spheres, *triangles; /* end of the list of spheres; start of that of triangles */
};

static void list_particle(const struct kiln_solid_strip *s, struct row_entries *entries,
                          const uint32_t entry[KILN_SOLID_VISIBLE_WORDS])
{
    uint32_t **to = is_instance(s, entry[1] >> 2) ? &entries->triangles : &entries->spheres;
    if (to == &entries->triangles)
        *to -= KILN_SOLID_VISIBLE_WORDS;
    memcpy(*to, entry, KILN_SOLID_VISIBLE_WORDS * sizeof *entry);
    if (to == &entries->spheres)
        *to += KILN_SOLID_VISIBLE_WORDS;
}

/* Lists the particles in the samples of pixel x, each once, and writes the pixel's depth, for which
 * a particle counts that covers at least half of the pixels that it fills. first: index of the
 * row's first sample. */
static void list_pixel(const struct kiln_solid_strip *s, size_t first, uint32_t x,
                       struct row_entries *entries, float *depth)
{
    int32_t numbers[SAMPLES], triangles[SAMPLES] = {0};
    float t[SAMPLES];
    for (size_t k = 0; k < SAMPLES; k++) {
        size_t at = first + k * s->pitch + x;
        numbers[k] = s->nearest[at];
        bool counts = numbers[k] >= 0 && part_of(s, (uint32_t)numbers[k]) >= 0.5f;
        t[k] = counts ? s->samples[at] : NO_DEPTH;
        if (numbers[k] >= 0 && is_instance(s, (uint32_t)numbers[k]))
            triangles[k] = s->triangles[at];
    }
    float second = second_of(t);
    if (second < NO_DEPTH)
        *depth = second;
    for (int k = 0; k < SAMPLES; k++) {
        uint32_t quarters = 0;
        for (int other = k; numbers[k] >= 0 && other < SAMPLES; other++) {
            bool same = numbers[other] == numbers[k] && triangles[other] == triangles[k];
            quarters += same;
            if (same && other > k)
                numbers[other] = -1;
        }
        if (quarters > 0)
            list_particle(s, entries,
                          (const uint32_t[3]){x, (uint32_t)numbers[k] << 2 | (quarters - 1),
                                              (uint32_t)triangles[k]});
    }
}

/* Mixes the scene into LANES pixels of a row that solids cover at least in part. columns: of the
 * pixels, of which the first `count` are written. */
SIMD void mix_scene(const struct kiln_solid_strip *s, uint32_t y, vi columns, uint32_t count)
{
    const size_t row = 4 * (size_t)y * s->width;
    const float *behind = s->scene_color + row, *bloom = s->bloom + row;
    float *color = s->color + row;
    const vi at = 4 * columns;
    const vf covered = vf_gather(bloom + 3, at);
    struct edge_sum sum = {.light = {{0}, {0}, {0}},
                           .weighted = gather3(color, at),
                           .alpha = covered,
                           .weighted_alpha = vf_gather(color + 3, at)};
    sum = edge_add(sum, gather3(behind, at), vf_gather(behind + 3, at), 1.0f - covered,
                   s->frame->view->exposure.x);
    const struct vf3 mean = edge_mean(sum);
    for (uint32_t i = 0; i < count; i++) {
        const float rgba[4] = {mean.x[i], mean.y[i], mean.z[i], sum.alpha[i]};
        memcpy(color + at[i], rgba, sizeof rgba);
    }
}

/* Puts the scene behind the resolved samples of the solids. */
static void add_scene(const struct kiln_solid_strip *s, uint32_t y)
{
    const size_t row = 4 * (size_t)y * s->width;
    vi columns = vi_all(0);
    uint32_t count = 0;
    for (uint32_t x = 0; x < s->width; x++) {
        const size_t at = row + 4 * (size_t)x;
        if (s->bloom[at + 3] > 0.0f) {
            columns[count++] = (int32_t)x;
        } else {
            memcpy(s->color + at, s->scene_color + at, 4 * sizeof *s->color);
        }
        if (count == LANES || (count > 0 && x + 1 == s->width)) {
            mix_scene(s, y, columns, count);
            count = 0;
        }
    }
}

/* Fills in the lanes from entries. size: bytes of a record of the particles. */
static void load_particles(const struct kiln_solid_strip *s, const uint32_t *entries,
                           uint32_t lanes, size_t size, struct visible_particles *visible)
{
    const int32_t stride = (int32_t)(size / sizeof(float));
    *visible = (struct visible_particles){{0}, {0}, {0}, {0}};
    for (uint32_t lane = 0; lane < lanes; lane++, entries += KILN_SOLID_VISIBLE_WORDS) {
        uint32_t number = entries[1] >> 2;
        visible->column[lane] = (int32_t)entries[0];
        visible->particle[lane] = (int32_t)number * stride;
        visible->part[lane] = 0.25f * (float)((entries[1] & 3) + 1) * part_of(s, number);
        if (is_instance(s, number))
            visible->corner[lane] = corner_of(s, number, entries[2]);
    }
    for (uint32_t lane = lanes; lane < LANES; lane++) { /* repeats lane 0, with part 0 */
        visible->particle[lane] = visible->particle[0];
        visible->corner[lane] = visible->corner[0];
    }
}

static void resolve_row(const struct kiln_solid_strip *s, uint32_t row)
{
    const uint32_t y = s->y + row;
    const size_t width = s->width, first = (size_t)row * SAMPLES * s->pitch, pixel = y * width;
    memcpy(s->depth + pixel, s->scene_depth + pixel, width * sizeof *s->depth);
    memset(s->color + 4 * pixel, 0, 4 * width * sizeof *s->color);
    memset(s->bloom + 4 * pixel, 0, 4 * width * sizeof *s->bloom);
    uint32_t *const room_end = s->visible + (size_t)KILN_SOLID_VISIBLE_WORDS * SAMPLES * s->pitch;
    struct row_entries entries = {s->visible, room_end};
    for (uint32_t x = 0; x < width; x++) {
        const int32_t *nearest = s->nearest + first + x;
        if ((nearest[0] & nearest[s->pitch] & nearest[2 * s->pitch] & nearest[3 * s->pitch]) != -1)
            list_pixel(s, first, x, &entries, &s->depth[pixel + x]);
    }
    const size_t spheres = (size_t)(entries.spheres - s->visible) / KILN_SOLID_VISIBLE_WORDS;
    for (size_t i = 0; i < spheres; i += LANES) {
        struct visible_particles visible;
        struct ray_color light;
        uint32_t lanes = spheres - i < LANES ? (uint32_t)(spheres - i) : LANES;
        load_particles(s, s->visible + KILN_SOLID_VISIBLE_WORDS * i, lanes, sizeof *s->spheres,
                       &visible);
        light_spheres(s, &visible, y, &light);
        add_particles(s, &visible, lanes, y, s->spheres->bloom, &light);
    }
    const size_t triangles = (size_t)(room_end - entries.triangles) / KILN_SOLID_VISIBLE_WORDS;
    for (size_t i = 0; i < triangles; i += LANES) {
        struct visible_particles visible;
        struct ray_color light;
        uint32_t lanes = triangles - i < LANES ? (uint32_t)(triangles - i) : LANES;
        load_particles(s, entries.triangles + KILN_SOLID_VISIBLE_WORDS * i, lanes,
                       sizeof *s->instances, &visible);
        light_triangles(s, &visible, y, &light);
        add_particles(s, &visible, lanes, y, s->instances->bloom, &light);
    }
    add_scene(s, y);
}

static void draw_strip(const struct kiln_solid_strip *strip)
{
    for (uint32_t row = 0; strip->y + row < strip->y_to; row++)
        clear_samples(strip, row);
    for (size_t i = 0; i < strip->count; i++) {
        if (is_instance(strip, strip->list[i]))
            sample_instance(strip, strip->list[i]);
        else
            sample_sphere(strip, strip->list[i]);
    }
    for (uint32_t row = 0; strip->y + row < strip->y_to; row++)
        resolve_row(strip, row);
}

const struct kiln_solid_rows KILN_SIMD_NAME(kiln_solid_rows) = {.draw = draw_strip};
