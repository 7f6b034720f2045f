/* This file marches rays through gas, eight side by side. A ray is sampled at fixed steps from the
 * eye, without jitter, so smoke shows neither noise nor shells that move with its window. The light
 * of a step is the integral over a segment of even gas; segments end where the scene does.
 *
 * A step in which no ray meets a block adds nothing to any of them, so leaving it out changes no
 * bit. The eight rays are the same at each level of vectors. */
#include "base/eight.h"
#include "draw/vector/haze_color.h"
#include "draw/volume/volume_between.h"
#include "draw/volume/volume_detail.h"
#include "draw/volume/volume_halfway.h"
#include "draw/volume/volume_march.h"
#include "draw/volume/volume_packet.h"
#include "draw/volume/volume_record.h"

/* ---- light ----------------------------------------------------------------------------------- */

/* Returns the light of flames by their temperature. */
SIMD struct columns flame_light(const struct kiln_flame_colors *colors, vf temperature)
{
    const vf place = vf_clamp(temperature * ((float)FLAME_COLORS / FLAME_HOTTEST), 0.0f,
                              (float)FLAME_COLORS - 0.001f);
    const vi low = vi_of(place);
    const struct lane_offsets at = lane_offsets_of(low * 4);
    vf part[4];
    vf_spread_fours(place - vf_of(low), part);
    return columns_load_lerp(&colors->rgb[0].x, &at, part);
}

/* Adds the light of a step, and dims what is behind it. tints: NULL without colours. */
SIMD void shade(const struct kiln_volume_march *m, struct packet *p, const struct places *at,
                const struct eight values[VOLUME_CELL], const struct eight *tints)
{
    EIGHT_EACH(k)
    {
        const vf zero = vf_all(0.0f);
        const vf smoke = vf_max(values[VOLUME_SMOKE].part[k], zero) * m->extinction;
        const vf flame = vf_max(values[VOLUME_FLAME].part[k], zero);
        const vf extinction = smoke + flame * m->absorption;
        const vf length = at->length.part[k] * m->cell_m, depth = extinction * length;
        const vf left = vf_exp(-depth);
        const vf thick = (1.0f - left) / vf_max(extinction, vf_all(1e-20f));
        const vf thin = length * (1.0f - 0.5f * depth);
        const vf seen = p->clear.part[k] * vf_select(depth > 1e-3f, thick, thin);
        const vf sun = values[VOLUME_SUN].part[k] * p->first.part[k] +
                       values[VOLUME_SCATTERED].part[k] * p->wide.part[k];
        for (int i = 0; i < 3; i++) {
            const vf scatters = tints ? tints[i].part[k] * m->extinction : smoke * m->albedo[i];
            p->smoke[i].part[k] +=
                seen * scatters * (sun * m->sun[i] + values[VOLUME_RED + i].part[k]);
        }
        p->clear.part[k] *= left;
        p->depth.part[k] += depth;
        const vf amount = seen * (extinction + flame);
        p->weight.part[k] += amount;
        p->far.part[k] += amount * at->middle.part[k];
        if (!any(flame > 0.0f))
            continue;
        const struct columns light = flame_light(m->colors, values[VOLUME_TEMPERATURE].part[k]);
        const vf emitted = seen * flame * m->intensity;
        for (int i = 0; i < 3; i++)
            p->flame[i].part[k] += emitted * light.c[i];
    }
}

/* Adds the gas of a step to rays. tints: NULL without colours. */
SIMD void add_step(const struct kiln_volume_march *m, struct packet *p, const struct places *at,
                   const struct eight values[VOLUME_CELL], const struct eight *tints)
{
    const struct eight before = p->depth;
    shade(m, p, at, values, tints);
    if (m->halfway.depth_m && halfway_lies_in(&before, &p->depth, &p->halfway))
        halfway_add(&(struct halfway_step){before, p->depth, at->middle, at->length}, &p->halfway);
}

/* Ends rays that gas hides what is behind from. Returns whether any ray goes on after a step. */
SIMD bool end_rays(const struct kiln_volume_march *m, struct packet *p, float step)
{
    bool some = false;
    EIGHT_EACH(k)
    {
        const vi opaque = p->clear.part[k] < VOLUME_OPAQUE_BELOW;
        p->clear.part[k] = vf_select(opaque, vf_all(0.0f), p->clear.part[k]);
        p->to.part[k] = vf_select(opaque, vf_all(0.0f), p->to.part[k]);
        some |= any((p->to.part[k] > (step + 1.0f) * m->step) & (p->from.part[k] < p->to.part[k]));
    }
    return some;
}

/* Holds the haze before the gas of rays. */
struct veil {
    struct eight clear; /* the part of the gas's light that comes through */
    struct vf3 color[EIGHT_PARTS];
};

/* Returns the haze before the gas of rays. All of it counts as far away as it is in the mean of
 * what is seen. */
SIMD_ONCE void find_veil(const struct kiln_volume_march *m, const struct packet *p, struct veil *v)
{
    EIGHT_EACH(k)
    {
        const vf weight = vf_max(p->weight.part[k], vf_all(1e-20f));
        const vf distance = p->far.part[k] / weight * m->cell_m;
        v->clear.part[k] = haze_clear(m->haze->floor_params.z, vf_all(1.0f), distance);
        struct vf3 way;
        vf *const axes[3] = {&way.x, &way.y, &way.z};
        for (int i = 0; i < 3; i++)
            *axes[i] = m->world[i][0] * p->way[0].part[k] + m->world[i][1] * p->way[1].part[k] +
                       m->world[i][2] * p->way[2].part[k];
        v->color[k] = haze_toward(m->haze, haze_level(way));
    }
}

/* Veils light of gas that lets the part `through` of what is behind it through. */
SIMD void veil(const struct veil *v, struct eight through, struct eight smoke[3],
               struct eight flame[3])
{
    EIGHT_EACH(k)
    {
        const vf clear = v->clear.part[k];
        const vf hidden = (1.0f - through.part[k]) * (1.0f - clear);
        const vf added[3] = {v->color[k].x * hidden, v->color[k].y * hidden,
                             v->color[k].z * hidden};
        for (int i = 0; i < 3; i++) {
            smoke[i].part[k] = smoke[i].part[k] * clear + added[i];
            flame[i].part[k] *= clear;
        }
    }
}

/* ---- pixels ---------------------------------------------------------------------------------- */

/* Returns the numbers of a profile at the present place of a packet. */
SIMD void numbers_of(const struct packet *p, struct eight numbers[RECORDED])
{
    numbers[VOLUME_NODE_DEPTH] = p->depth;
    for (int i = 0; i < 3; i++) {
        numbers[VOLUME_NODE_SMOKE + i] = p->smoke[i];
        numbers[VOLUME_NODE_FLAME + i] = p->flame[i];
    }
}

/* Records the profiles of a packet up to the begin of a step. */
SIMD_ONCE void record_packet(struct record *r, const struct packet *p, float step)
{
    struct eight numbers[RECORDED];
    numbers_of(p, numbers);
    record_until(r, step, numbers);
}

/* Writes the recorded profiles of a packet that has been drawn to the end of a step. veil: NULL
 * without haze. */
SIMD_ONCE struct kiln_volume_profile *write_profile(const struct kiln_volume_march *m,
                                                    struct record *r, const struct packet *p,
                                                    const struct veil *v, float step)
{
    struct eight numbers[RECORDED], a_metre;
    numbers_of(p, numbers);
    record_end(r, step, numbers);
    for (uint32_t i = 0; i < r->count && v; i++) {
        struct eight *node = r->nodes[i], clear;
        EIGHT_EACH(k)
        clear.part[k] = vf_exp(-node[VOLUME_NODE_DEPTH].part[k]);
        veil(v, clear, node + VOLUME_NODE_SMOKE, node + VOLUME_NODE_FLAME);
    }
    struct kiln_volume_profile *to = write_record(r, m->profiles);
    EIGHT_EACH(k)
    a_metre.part[k] = p->metre.part[k] * (1.0f / m->step);
    eight_store(to->a_metre, a_metre);
    return to;
}

/* Marches a packet of rays. record: NULL unless profiles are wanted. Returns the end of the last
 * step that was drawn, or a negative number if none was. */
SIMD float march_rays(const struct kiln_volume_march *m, const struct kiln_volume_tile *tile,
                      struct packet *p, struct record *record)
{
    float last, step = first_step(m, p, tile, &last), drawn = -1.0f;
    const bool colored = m->field->gas->shape.colored;
    const bool detail = m->octaves > 0 && m->field->gas->shape.detailed;
    bool more = true;
    while (more && step * m->step < last) {
        struct places at;
        find_places(m, p, step, &at);
        if (!at.some) {
            if (at.skip >= 1e9f)
                break;
            const float next = floorf(at.skip * (1.0f / m->step) - 0.5f);
            step = next > step + 1.0f ? next : step + 1.0f;
            continue;
        }
        if (record)
            record_packet(record, p, step);
        struct eight values[VOLUME_CELL], tints[3];
        p->samples += sample_floats(m->field->blocks, &at, values);
        drawn = step + 1.0f;
        if (is_clear(values)) { /* a step that changes no bit */
            step += 1.0f;
            continue;
        }
        if (colored)
            sample_fours(m->field->tints, &at, 3, tints);
        if (detail)
            add_detail(m, p, &at, values, colored ? tints : NULL);
        add_step(m, p, &at, values, colored ? tints : NULL);
        more = end_rays(m, p, step);
        step += 1.0f;
    }
    return drawn;
}

/* Writes the floats of rays (VOLUME_RAY), one ray after another. */
SIMD void store_rays(const struct packet *p, float *rays)
{
    struct eight columns[VOLUME_RAY] = {{{{0}}}};
    for (int i = 0; i < 3; i++) {
        columns[VOLUME_RAY_SMOKE + i] = p->smoke[i];
        columns[VOLUME_RAY_FLAME + i] = p->flame[i];
    }
    EIGHT_EACH(k)
    columns[VOLUME_RAY_ALPHA].part[k] = 1.0f - p->clear.part[k];
    eight_rows(rays, columns);
}

/* Marches the rays of pixels, and writes their floats. Returns false, and writes none, if no ray
 * meets gas, or light is not asked for. */
SIMD_ONCE bool march_packet(const struct kiln_volume_march *m, const struct kiln_volume_tile *tile,
                            const struct pixels *pixels, float *rays)
{
    struct packet p;
    struct record record;
    record.count = 0;
    struct veil veiled;
    if (!make_packet(m, pixels, &p))
        return false;
    if (m->halfway.depth_m)
        halfway_begin(m, pixels, &p.halfway);
    const float end = march_rays(m, tile, &p, m->profiles ? &record : NULL);
    if (end < 0.0f)
        return false;
    atomic_fetch_add_explicit(&m->counts->rays, pixels->count, memory_order_relaxed);
    atomic_fetch_add_explicit(&m->counts->samples, p.samples, memory_order_relaxed);
    if (m->halfway.depth_m)
        halfway_store(m, &p.halfway, p.metre, p.depth, pixels);
    if (!m->planes.smoke)
        return false;
    if (m->haze)
        find_veil(m, &p, &veiled);
    if (m->profiles) {
        const struct kiln_volume_profile *profile =
            write_profile(m, &record, &p, m->haze ? &veiled : NULL, end);
        for (uint32_t i = 0; i < pixels->count; i++)
            kiln_volume_profile_put(m->profiles, pixels->at[i], profile, i);
    }
    if (m->haze)
        veil(&veiled, p.clear, p.smoke, p.flame);
    store_rays(&p, rays);
    return true;
}

/* Draws what a ray has seen over a pixel. */
SIMD void put_ray(const struct kiln_volume_march *m, const float *ray, size_t pixel)
{
    float *to = m->planes.smoke + 4 * pixel, *fire = m->planes.flame + 4 * pixel;
    const float clear = 1.0f - ray[VOLUME_RAY_ALPHA];
    for (int i = 0; i < 4; i++) {
        to[i] = ray[VOLUME_RAY_SMOKE + i] + clear * to[i];
        fire[i] = ray[VOLUME_RAY_FLAME + i] + clear * fire[i];
    }
    if (!m->planes.glow)
        return;
    float *glow = m->planes.glow + 4 * pixel;
    for (int i = 0; i < 3; i++)
        glow[i] = m->bloom * ray[VOLUME_RAY_FLAME + i] + clear * glow[i];
}

/* Marches the rays of pixels, draws what they see, and empties the packet. */
SIMD_ONCE void draw_packet(const struct kiln_volume_march *m, const struct kiln_volume_tile *tile,
                           struct pixels *pixels)
{
    _Alignas(32) float rays[VOLUME_PACKET * VOLUME_RAY];
    if (march_packet(m, tile, pixels, rays))
        for (uint32_t i = 0; i < pixels->count; i++)
            put_ray(m, rays + (size_t)i * VOLUME_RAY, pixels->at[i]);
    memset(pixels, 0, sizeof *pixels);
}

/* Packets are blocks of pixels, whose rays meet the same bricks. */
static void draw_all(const struct kiln_volume_march *m, const struct kiln_volume_tile *tile)
{
    struct pixels pixels = {.count = 0};
    for (uint32_t block = 0; block < VOLUME_TILE; block++) {
        const uint32_t x = tile->x + block % 2 * 4, y = tile->y + block / 2 * 2;
        for (uint32_t i = 0; i < VOLUME_PACKET; i++)
            if (x + i % 4 < m->width && y + i / 4 < m->height)
                add_pixel(m, &pixels, x + i % 4, y + i / 4);
        if (pixels.count > 0)
            draw_packet(m, tile, &pixels);
    }
}

/* ---- every second pixel ---------------------------------------------------------------------- */

static void march_grid(const struct kiln_volume_march *m, const struct kiln_volume_tile *tile)
{
    _Alignas(32) float rays[VOLUME_PACKET * VOLUME_RAY];
    for (uint32_t y = tile->y; y < tile->y + VOLUME_TILE; y += 4) {
        struct pixels pixels = {.count = 0};
        for (uint32_t i = 0; i < VOLUME_PACKET; i++) {
            const uint32_t column = tile->x + i % 4 * 2, row = y + i / 4 * 2;
            if (column < m->width && row < m->height)
                add_pixel(m, &pixels, column, row);
        }
        if (pixels.count == 0 || !march_packet(m, tile, &pixels, rays))
            continue;
        for (uint32_t i = 0; i < pixels.count; i++) {
            float *to =
                kiln_volume_grid_ray(m, pixels.at[i] % m->width / 2, pixels.at[i] / m->width / 2);
            memcpy(to, rays + (size_t)i * VOLUME_RAY, VOLUME_RAY_END * sizeof *to);
        }
    }
}

static void draw_between(const struct kiln_volume_march *m, const struct kiln_volume_tile *tile)
{
    struct pixels pixels = {.count = 0};
    const bool wide = cells_are_wide(m, tile->near_m);
    for (uint32_t i = 0; i < VOLUME_TILE * VOLUME_TILE; i++) {
        const uint32_t x = tile->x + i % VOLUME_TILE, y = tile->y + i / VOLUME_TILE;
        if (x >= m->width || y >= m->height)
            continue;
        float ray[VOLUME_RAY];
        if (x % 2 == 0 && y % 2 == 0) {
            put_ray(m, kiln_volume_grid_ray(m, x / 2, y / 2), (size_t)y * m->width + x);
        } else if (wide && find_between(m, x, y, ray) && halfway_between(m, x, y)) {
            put_ray(m, ray, (size_t)y * m->width + x);
            if (m->profiles)
                kiln_volume_profile_between(m->profiles, (size_t)y * m->width + x);
        } else {
            add_pixel(m, &pixels, x, y);
            if (pixels.count == VOLUME_PACKET)
                draw_packet(m, tile, &pixels);
        }
    }
    if (pixels.count > 0)
        draw_packet(m, tile, &pixels);
}

const struct kiln_volume_march_rows KILN_SIMD_NAME(kiln_volume_march_rows) = {
    .draw = draw_all, .march_grid = march_grid, .draw_between = draw_between};
