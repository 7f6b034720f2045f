/* This file computes the light that arrives at what vectors of rays hit, and where it may be
 * interpolated between the nodes of a strip's grid. */
#include "draw/backdrop/ray_shade.h"

void KILN_SIMD_NAME(kiln_rays_light)(const struct kiln_ray_frame *frame, const struct ray *ray,
                                     bool glossy, const struct ray_help *help,
                                     struct shaded_rays *shaded)
{
    const struct ray_hit *hit = &shaded->first;
    const struct ray_point point = {ray_at(ray, hit->t), hit->normal, hit->surface >= 0.0f};
    struct arrived arrived = {.irradiance = {{0}, {0}, {0}}};
    if (any(point.active)) {
        struct grid_place place;
        const struct grid_place *in_grid = NULL;
        if (help->pixels) {
            const struct grid_pixels *pixels = help->pixels;
            place = grid_place_of(pixels->grid, pixels->column, pixels->row, hit, point.at);
            in_grid = &place;
        }
        const vf sunlit = sun_seen(frame, &point, facing_sun(frame, &point), help->cached);
        const struct ray_point sunny = {point.at, point.normal, sunlit > 0.0f};
        shaded->arrives = sunlit * past_smoke(frame, GRID_SUN, &sunny, in_grid);
        glossy = glossy && any(hit->surface == 0.0f);
        if (glossy)
            shaded->mirror = floor_reflection_along(frame, ray);
        const struct lit_surface surface = {.point = point,
                                            .gloss = glossy ? &shaded->mirror.at : NULL,
                                            .grid = in_grid,
                                            .cached = help->cached};
        arrived = light_without_sun(frame, &surface);
        shaded->light = sunlit - arrived.hidden / vf_max(arrived.all, vf_all(1e-6f));
        shaded->reflected = arrived.reflected;
    }
    const struct hit_light light = {arrived.irradiance, shaded->arrives};
    shaded->color = radiance_or_sky(frame, hit, ray->direction, &light, help->cached);
}

void KILN_SIMD_NAME(kiln_rays_judge_grid)(const struct kiln_ray_frame *frame,
                                          struct grid_lights lights, struct light_grid *grid)
{
    const struct kiln_draw_backdrop *b = frame->backdrop;
    for (int first = 0; first < GRID_BLOCKS; first += LANES)
        judge_surfaces(frame, first, &lights.lamps, grid);
    memset(grid->sky_smooth, 0, sizeof grid->sky_smooth);
    if (lights.sky && are_some(grid->alike))
        judge_sky(frame, grid);
    for (uint32_t i = 0; i < b->counts.y; i++) {
        if (!kiln_bits_have(lights.lamps.words, i) || !are_some(grid->smooth[i]))
            continue;
        for (int first = 0; first < GRID_NODES; first += LANES)
            light_nodes(frame, i, first, grid);
        for (int first = 0; first < GRID_BLOCKS; first += LANES)
            judge_seen(i, first, grid);
    }
}

void KILN_SIMD_NAME(kiln_rays_judge_smoke)(const struct kiln_ray_frame *frame,
                                           const struct kiln_lit_box *box, struct light_grid *grid)
{
    const bool alike = are_some(grid->alike);
    for (uint32_t light = 0; light < GRID_SMOKY; light++) {
        grid->smoky[light] = has_smoke_before(frame, light, box);
        if (!grid->smoky[light])
            continue;
        if (alike)
            judge_smoke_of(frame, light, grid);
        else
            memset(grid->smoke_smooth[light], 0, sizeof grid->smoke_smooth[light]);
    }
}
