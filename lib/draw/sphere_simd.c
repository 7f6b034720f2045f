/* What shaders/draw/spheres.frag and spheres_resolve.frag do in GL: which sphere each of a pixel's
 * samples shows, then the light of each sphere of a pixel, once, by a ray through the middle.
 */
#include "draw/sphere_rows.h"

#include "draw/ray_light.h"

enum { SAMPLES = KILN_SPHERE_SAMPLES };

/* A rotated grid: no two samples share a row or a column. */
static const float OFFSETS[SAMPLES][2] = {
    {-0.125f, -0.375f}, {0.375f, -0.125f}, {-0.375f, 0.125f}, {0.125f, 0.375f}};

/* Farther than any scene. */
#define NOTHING 2e9f

/* The ray through a place in the picture, with z of -1: its t is depth. */
SIMD struct vf3 view_ray(const struct kiln_ray_frame *frame, vf x, vf y)
{
    const float4 frustum = frame->view->frustum;
    return (struct vf3){(x * (2.0f / frustum.z) - 1.0f) * frustum.x,
                        (1.0f - y * (2.0f / frustum.w)) * frustum.y, vf_all(-1.0f)};
}

/* The t at which a ray passes the centre most closely, and the square of the radius less that of
 * the distance there: negative for a miss. */
struct approach {
    vf t, inside;
    vf inverse2; /* of the ray's length */
};

SIMD struct approach come_close(struct vf3 ray, struct vf3 center, vf radius)
{
    vf inverse2 = 1.0f / vf3_dot(ray, ray), t = vf3_dot(ray, center) * inverse2;
    struct vf3 away = vf3_sub(vf3_scale(ray, t), center);
    return (struct approach){t, radius * radius - vf3_dot(away, away), inverse2};
}

SIMD vf surface_depth(const struct approach *a)
{
    return a->t - vf_sqrt(vf_max(a->inside, vf_all(0.0f)) * a->inverse2);
}

/* ---- samples --------------------------------------------------------------------------------- */

SIMD void sample_pixels(const struct kiln_sphere_strip *s, const struct kiln_drawn_sphere *sphere,
                        int32_t number, uint32_t row, int32_t x)
{
    const struct vf3 center = {vf_all(sphere->center[0]), vf_all(sphere->center[1]),
                               vf_all(sphere->center[2])};
    vf radius = vf_all(sphere->radius), column = vf_count() + ((float)x + 0.5f);
    float line = (float)(s->y + row) + 0.5f;
    const struct approach middle =
        come_close(view_ray(s->frame, column, vf_all(line)), center, radius);
    vf t = surface_depth(&middle);
    size_t at = (size_t)row * SAMPLES * s->pitch + (size_t)x;
    for (int k = 0; k < SAMPLES; k++, at += s->pitch) {
        struct vf3 ray = view_ray(s->frame, column + OFFSETS[k][0], vf_all(line + OFFSETS[k][1]));
        const struct approach aside = come_close(ray, center, radius);
        vf before = vf_load(s->samples + at);
        vi nearer = (aside.inside >= 0.0f) & (t < before);
        if (!any(nearer))
            continue;
        float *numbers = (float *)(void *)(s->nearest + at);
        vf_store(s->samples + at, vf_select(nearer, t, before));
        vf_store(numbers, (vf)vi_select(nearer, vi_all(number), (vi)vf_load(numbers)));
    }
}

static void sample_sphere(const struct kiln_sphere_strip *s, uint32_t number)
{
    const struct kiln_drawn_sphere *sphere = &s->spheres[number];
    const struct kiln_row_range rows = s->rows[number];
    int32_t y = rows.from > (int32_t)s->y ? rows.from : (int32_t)s->y;
    int32_t y_to = rows.to < (int32_t)s->y_to ? rows.to : (int32_t)s->y_to;
    for (; y < y_to; y++) {
        for (int32_t x = sphere->x.from; x < sphere->x.to; x += LANES)
            sample_pixels(s, sphere, (int32_t)number, (uint32_t)y - s->y, x);
    }
}

/* What is behind the scene is not seen. */
static void clear_samples(const struct kiln_sphere_strip *s, uint32_t row)
{
    const float *scene = s->scene_depth + (size_t)(s->y + row) * s->width;
    float *samples = s->samples + (size_t)row * SAMPLES * s->pitch;
    for (int k = 0; k < SAMPLES; k++, samples += s->pitch) {
        for (uint32_t x = 0; x < s->width; x++)
            samples[x] = scene[x] + scene[x] * 1e-7f; /* at the same depth, it is */
        for (size_t x = s->width; x < s->pitch; x++)
            samples[x] = -1.0f;
    }
    memset(s->nearest + (size_t)row * SAMPLES * s->pitch, 0xff,
           SAMPLES * s->pitch * sizeof *s->nearest);
}

/* ---- light ----------------------------------------------------------------------------------- */

/* Spheres of pixels of a row. */
struct seen_spheres {
    vi column, sphere; /* number times the words of a record */
    vf part;           /* of the pixel */
};

SIMD struct vf3 gather3(const float *from, vi index)
{
    return (struct vf3){vf_gather(from, index), vf_gather(from + 1, index),
                        vf_gather(from + 2, index)};
}

SIMD struct vf3 view_to_world(const struct kiln_ray_frame *frame, struct vf3 v)
{
    const float4 *rows = frame->view->world_to_view;
    return (struct vf3){rows[0].x * v.x + rows[1].x * v.y + rows[2].x * v.z,
                        rows[0].y * v.x + rows[1].y * v.y + rows[2].y * v.z,
                        rows[0].z * v.x + rows[1].z * v.y + rows[2].z * v.z};
}

static void light_spheres(const struct kiln_sphere_strip *s, const struct seen_spheres *seen,
                          uint32_t y, struct ray_color *color)
{
    const struct kiln_ray_frame *frame = s->frame;
    const struct kiln_drawn_sphere *all = s->spheres;
    struct vf3 ray = view_ray(frame, vf_of(seen->column) + 0.5f, vf_all((float)y + 0.5f));
    struct vf3 center = gather3(all->center, seen->sphere);
    const struct approach close = come_close(ray, center, vf_gather(&all->radius, seen->sphere));
    vf t = surface_depth(&close);
    struct vf3 direction = view_to_world(frame, ray);
    struct vf3 out = vf3_normalize(vf3_sub(vf3_scale(ray, t), center));
    const struct ray_hit hit = {.t = t,
                                .surface = vf_all(0.0f),
                                .normal = view_to_world(frame, out),
                                .albedo = gather3(all->albedo, seen->sphere)};
    const struct ray_point point = {vf3_along(vf3_all(frame->view->eye), direction, t), hit.normal,
                                    seen->part > 0.0f};
    vf sunlit = sun_visibility(frame, point.at, point.normal, turned_to_sun(frame, &point));
    const struct ray_point sunny = {point.at, point.normal, sunlit > 0.0f};
    sunlit *= smoke_lets_through(frame->smoke_to_sun, frame->backdrop->sun_to_grid, &sunny);
    const struct ray_color lit =
        radiance(frame, &hit, direction, soft_irradiance(frame, &point), sunlit);
    vf part = vf_gather(&all->lit, seen->sphere);
    struct vf3 shown = vf3_along(hit.albedo, vf3_sub(lit.rgb, hit.albedo), part);
    color->rgb = vf3_add(gather3(all->glow, seen->sphere), shown);
    color->alpha = seen->part;
}

/* Adds the light of spheres to their pixels, in their order. */
SIMD void add_spheres(const struct kiln_sphere_strip *s, const struct seen_spheres *seen,
                      uint32_t count, uint32_t y, const struct ray_color *light)
{
    for (uint32_t i = 0; i < count; i++) {
        const float *weights = ((const float *)s->spheres->bloom) + seen->sphere[i];
        size_t at = 4 * ((size_t)y * s->width + (size_t)seen->column[i]);
        float part = seen->part[i];
        const float rgb[3] = {light->rgb.x[i], light->rgb.y[i], light->rgb.z[i]};
        for (int c = 0; c < 3; c++) {
            s->color[at + (size_t)c] += rgb[c] * part;
            s->bloom[at + (size_t)c] += rgb[c] * part * weights[c];
        }
        s->color[at + 3] += part;
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

/* A depth has no mean: a pixel is where the second nearest of its samples is. */
static inline float second_of(const float t[SAMPLES])
{
    float near_a = lesser(t[0], t[1]), far_a = greater(t[0], t[1]);
    float near_b = lesser(t[2], t[3]), far_b = greater(t[2], t[3]);
    return lesser(greater(near_a, near_b), lesser(far_a, far_b));
}

/* Lists the spheres of a pixel and the quarters of it that they cover: the pixel, then the sphere
 * times 4 and the number of quarters less 1. Returns the entries' end. */
static uint32_t *list_pixel(const struct kiln_sphere_strip *s, size_t first, uint32_t x,
                            uint32_t *entries, float *depth)
{
    int32_t numbers[SAMPLES];
    float t[SAMPLES];
    for (size_t k = 0; k < SAMPLES; k++) {
        numbers[k] = s->nearest[first + k * s->pitch + x];
        t[k] = numbers[k] < 0 ? NOTHING : s->samples[first + k * s->pitch + x];
    }
    float second = second_of(t);
    if (second < NOTHING)
        *depth = second;
    for (int k = 0; k < SAMPLES; k++) {
        uint32_t quarters = 0;
        for (int other = k; numbers[k] >= 0 && other < SAMPLES; other++) {
            bool same = numbers[other] == numbers[k];
            quarters += same;
            if (same && other > k)
                numbers[other] = -1;
        }
        if (quarters > 0) {
            *entries++ = x;
            *entries++ = (uint32_t)numbers[k] << 2 | (quarters - 1);
        }
    }
    return entries;
}

/* Puts the scene behind what the spheres' samples have become. */
static void add_scene(const struct kiln_sphere_strip *s, uint32_t y)
{
    const float *scene = s->scene_color + 4 * (size_t)y * s->width;
    float *color = s->color + 4 * (size_t)y * s->width;
    for (uint32_t x = 0; x < s->width; x++, scene += 4, color += 4) {
        float part = 1.0f - color[3];
        for (int c = 0; c < 4; c++)
            color[c] += scene[c] * part;
    }
}

static void resolve_row(const struct kiln_sphere_strip *s, uint32_t row)
{
    const uint32_t y = s->y + row;
    const size_t width = s->width, first = (size_t)row * SAMPLES * s->pitch, pixel = y * width;
    memcpy(s->depth + pixel, s->scene_depth + pixel, width * sizeof *s->depth);
    memset(s->color + 4 * pixel, 0, 4 * width * sizeof *s->color);
    memset(s->bloom + 4 * pixel, 0, 4 * width * sizeof *s->bloom);
    uint32_t *end = s->entries;
    for (uint32_t x = 0; x < width; x++) {
        const int32_t *nearest = s->nearest + first + x;
        if ((nearest[0] & nearest[s->pitch] & nearest[2 * s->pitch] & nearest[3 * s->pitch]) != -1)
            end = list_pixel(s, first, x, end, &s->depth[pixel + x]);
    }
    const int32_t stride = (int32_t)(sizeof *s->spheres / sizeof(float));
    const size_t count = (size_t)(end - s->entries) / 2;
    for (size_t i = 0; i < count; i += LANES) {
        struct seen_spheres seen = {{0}, {0}, {0}};
        uint32_t lanes = count - i < LANES ? (uint32_t)(count - i) : LANES;
        for (uint32_t lane = 0; lane < lanes; lane++) {
            const uint32_t *entry = s->entries + 2 * (i + lane);
            seen.column[lane] = (int32_t)entry[0];
            seen.sphere[lane] = (int32_t)(entry[1] >> 2) * stride;
            seen.part[lane] = 0.25f * (float)((entry[1] & 3) + 1);
        }
        struct ray_color light;
        light_spheres(s, &seen, y, &light);
        add_spheres(s, &seen, lanes, y, &light);
    }
    add_scene(s, y);
}

static void draw_strip(const struct kiln_sphere_strip *strip)
{
    for (uint32_t row = 0; strip->y + row < strip->y_to; row++)
        clear_samples(strip, row);
    for (size_t i = 0; i < strip->count; i++)
        sample_sphere(strip, strip->list[i]);
    for (uint32_t row = 0; strip->y + row < strip->y_to; row++)
        resolve_row(strip, row);
}

const struct kiln_sphere_rows KILN_SIMD_NAME(kiln_sphere_rows) = {.draw = draw_strip};
