/* This file lists the opaque particles by bins across the sun's direction, on the host, by a
 * counting sort: it counts the solids of each bin, then sums the counts to where each list begins,
 * then writes the solids in order: meshes before spheres, by systems and slots. A solid is in all
 * bins that its shadow can fall into, penumbra included. */
#include "draw/light/solid_shadow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "draw/light/instance_tiles.h"
#include "scene/work.h"
#include "shared/exact.h"

enum {
    MOST_ENTRIES = 1 << 20,
    FIRST_ROOM = 1024,
    BINS_OF_A_SOLID = 64, /* that its shadow may be in, as the memory is estimated */
};

struct solid {
    float4 center;         /* world position; w: radius, m */
    float low[2], high[2]; /* bounds of its shadow across the sun's direction, m */
    float4 tile;           /* as of struct kiln_solid_bins */
};

struct kiln_solid_shadow {
    const struct kiln_scene *scene;
    struct kiln_sun_frame sun; /* of the current frame */
    float floor;               /* height of the floor, m; infinite: no floor */
    struct solid *solids;
    size_t count, room;
    struct kiln_instance_tiles *instances; /* NULL: there are no tiles */
    struct kiln_silhouette *places;        /* of the first place_count solids, which have tiles */
    uint32_t place_count, place_room;
    bool failed;                                          /* memory was short for a solid */
    uint32_t bins[KILN_SOLID_BINS * KILN_SOLID_BINS * 2]; /* first entry and count of each */
    float4 *entries, *tiles;
    size_t entry_rows; /* of entries and tiles, as allocated */
};

void kiln_solid_shadow_destroy(struct kiln_solid_shadow **shadow)
{
    struct kiln_solid_shadow *s = *shadow;
    if (!s)
        return;
    free(s->solids);
    free(s->entries);
    free(s->tiles);
    free(s->places);
    kiln_instance_tiles_destroy(&s->instances);
    free(s);
    *shadow = NULL;
}

struct kiln_solid_shadow *kiln_solid_shadow_create(const struct kiln_scene *scene,
                                                   const struct kiln_instances *meshes,
                                                   struct kiln_error *error)
{
    struct kiln_solid_shadow *shadow = calloc(1, sizeof *shadow);
    if (!shadow) {
        kiln_error_no_memory(error, "the shadows of solids");
        return NULL;
    }
    shadow->scene = scene;
    if (kiln_instance_tile_edge(scene) > 0) {
        shadow->instances = kiln_instance_tiles_create(scene, meshes, error);
        if (!shadow->instances)
            kiln_solid_shadow_destroy(&shadow);
    }
    return shadow;
}

void kiln_solid_shadow_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    const struct kiln_solid_shadow *s = NULL;
    const uint64_t solids = kiln_scene_solid_slots(scene);
    const bool tiles = kiln_instance_tile_edge(scene) > 0;
    const uint64_t listed = solids > MOST_ENTRIES ? solids : MOST_ENTRIES;
    const uint64_t most =
        solids < MOST_ENTRIES / BINS_OF_A_SOLID ? solids * BINS_OF_A_SOLID : listed;
    uint64_t rows = 1;
    while (rows * KILN_SOLID_ROW < most)
        rows *= 2;
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, solids, sizeof *s->solids);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, rows * KILN_SOLID_ROW,
                       (tiles ? 2 : 1) * sizeof *s->entries);
    if (tiles) {
        kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, kiln_scene_mesh_slots(scene),
                           sizeof *s->places);
        kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, 1, kiln_instance_tiles_bytes());
    }
}

/* Returns the greatest width of a solid's penumbra, m: that at the floor, or at most `widest`,
 * where nothing is left of the shadow that the penumbra blurs. */
static float penumbra_of(const struct kiln_solid_shadow *shadow, float3 center, float widest)
{
    const float spread = shadow->sun.spread;
    if (shadow->sun.towards.y > 0.0f && center.y > shadow->floor)
        widest = fminf(widest, spread * (center.y - shadow->floor) / shadow->sun.towards.y);
    return spread > 0.0f ? widest : 0.0f;
}

/* Returns the radius of a solid's shadow with its penumbra, m. */
static float shadow_radius(const struct kiln_solid_shadow *shadow, float3 center, float radius)
{
    return radius + penumbra_of(shadow, center, radius * KILN_SOLID_FADE);
}

static struct solid *add(struct kiln_solid_shadow *shadow, float3 at)
{
    if (shadow->count == shadow->room) {
        size_t room = shadow->room ? 2 * shadow->room : FIRST_ROOM;
        struct solid *more = realloc(shadow->solids, room * sizeof *more);
        if (!more) {
            shadow->failed = true;
            return NULL;
        }
        shadow->solids = more;
        shadow->room = room;
    }
    struct solid *solid = &shadow->solids[shadow->count++];
    *solid = (struct solid){.center = {at.x, at.y, at.z, 0.0f}};
    return solid;
}

/* Sets the bounds of a solid's shadow from bounds relative to its middle. */
static void set_bounds(const struct kiln_solid_shadow *shadow, struct solid *solid,
                       const float low[2], const float high[2])
{
    const float3 at = {solid->center.x, solid->center.y, solid->center.z};
    const float across[2] = {float3_dot(at, shadow->sun.right), float3_dot(at, shadow->sun.up)};
    for (int c = 0; c < 2; c++) {
        solid->low[c] = across[c] + low[c];
        solid->high[c] = across[c] + high[c];
    }
}

/* Collects a particle as a sphere. radius: that of the sphere with the particle's shadow, in radii
 * of the particle. */
static void collect(struct kiln_solid_shadow *shadow, const struct kiln_appearance *particle,
                    float radius)
{
    /* A particle's opacity scales its radius (solids_spheres.vert). */
    radius *= particle->radius * particle->opacity;
    struct solid *solid = radius > 0.0f && !shadow->failed ? add(shadow, particle->position) : NULL;
    if (!solid)
        return;
    solid->center.w = radius;
    const float reach = shadow_radius(shadow, particle->position, radius);
    set_bounds(shadow, solid, (const float[2]){-reach, -reach}, (const float[2]){reach, reach});
}

/* ---- meshes ---------------------------------------------------------------------------------- */

static struct kiln_silhouette *add_place(struct kiln_solid_shadow *shadow)
{
    if (shadow->place_count == shadow->place_room) {
        const uint32_t room = shadow->place_room ? 2 * shadow->place_room : FIRST_ROOM;
        struct kiln_silhouette *more = realloc(shadow->places, room * sizeof *more);
        if (!more) {
            shadow->failed = true;
            return NULL;
        }
        shadow->places = more;
        shadow->place_room = room;
    }
    return &shadow->places[shadow->place_count++];
}

/* Collects a mesh with a tile; draw_tiles sets its radius, which depends on its silhouette. */
static void collect_mesh(struct kiln_solid_shadow *shadow,
                         const struct kiln_appearance_system *system, uint32_t number,
                         uint32_t slot, const struct kiln_appearance *particle)
{
    const struct kiln_look *look = &shadow->scene->systems[number].look;
    const float reach = kiln_instance_tiles_mesh(shadow->instances, number)->reach;
    const float size = 2.0f * particle->radius * particle->opacity;
    struct solid *solid = size > 0.0f ? add(shadow, particle->position) : NULL;
    struct kiln_silhouette *place = solid ? add_place(shadow) : NULL;
    if (!place)
        return;
    const struct instance_axes axes =
        kiln_appearance_axes(system, slot, &particle->clocks, look->mesh.orient);
    const float3 columns[3] = {axes.x, axes.y, axes.z};
    place->system = number;
    for (int c = 0; c < 3; c++) {
        place->across[0][c] = float3_dot(columns[c], shadow->sun.right) / reach;
        place->across[1][c] = float3_dot(columns[c], shadow->sun.up) / reach;
    }
    solid->tile.z = size * reach;
}

/* Bounds the shadow of a silhouette. A silhouette spreads half a texel past the texels that it
 * touches, and at most half a texel past its tile. It is read at two levels; the coarser one has
 * texels up to twice as large as the sun's radius. Where a sphere takes the silhouette's place, the
 * sphere's shadow counts as well. */
static void bound_silhouette(const struct kiln_solid_shadow *shadow, struct solid *solid,
                             const struct kiln_silhouette *place)
{
    const float4 center = solid->center, tile = solid->tile;
    const float3 at = {center.x, center.y, center.z};
    const float soft = penumbra_of(shadow, at, tile.z * KILN_INSTANCE_ROUND);
    const float texel = exact_max(2.0f * tile.z / tile.w, 2.0f * soft);
    const float farthest = tile.z + 0.5f * texel;
    const float ball =
        soft > tile.z * KILN_INSTANCE_SHARP ? shadow_radius(shadow, at, center.w) : 0.0f;
    float low[2], high[2];
    for (int c = 0; c < 2; c++) {
        low[c] = exact_max(tile.z * place->low[c] - 1.5f * texel, -farthest);
        high[c] = exact_min(tile.z * place->high[c] + 1.5f * texel, farthest);
        low[c] = exact_min(low[c], -ball);
        high[c] = exact_max(high[c], ball);
    }
    set_bounds(shadow, solid, low, high);
}

/* Draws the tiles of the meshes. The disc of the sphere that stands for a mesh has the area of the
 * mesh's silhouette. */
static void draw_tiles(struct kiln_solid_shadow *shadow, struct kiln_threads *threads)
{
    struct kiln_instance_tiles *tiles = shadow->instances;
    const float root = 2.0f / 1.7724539f; /* 2 over the square root of pi */
    const float edge = (float)kiln_instance_tile_edge(shadow->scene);
    kiln_instance_tiles_run(tiles, shadow->places, shadow->place_count, threads);
    for (uint32_t i = 0; i < shadow->place_count; i++) {
        struct solid *solid = &shadow->solids[i];
        const struct kiln_instance_tile at = kiln_instance_tile_at(tiles, i);
        const float reach = solid->tile.z;
        solid->tile = (float4){(float)at.x, (float)at.y, reach, edge};
        solid->center.w = reach * root * sqrtf(shadow->places[i].covered);
        bound_silhouette(shadow, solid, &shadow->places[i]);
    }
}

static void collect_system(struct kiln_solid_shadow *shadow, const struct kiln_moment *moment,
                           uint32_t index)
{
    const struct kiln_appearance_system system = kiln_appearance_system(moment, index);
    const struct kiln_look *look = &shadow->scene->systems[index].look;
    const bool mesh = look->shape == KILN_SHAPE_MESH;
    float radius = mesh ? 2.0f * look->mesh.shade : 1.0f;
    for (uint32_t slot = 0; slot < system.used && !shadow->failed; slot++) {
        struct kiln_appearance particle;
        if (!kiln_appearance_at(&system, slot, &particle))
            continue;
        if (mesh && shadow->instances)
            collect_mesh(shadow, &system, index, slot, &particle);
        else
            collect(shadow, &particle, radius);
    }
}

/* Collects all solids; those with tiles come first. */
static void collect_all(struct kiln_solid_shadow *shadow, const struct kiln_moment *moment,
                        struct kiln_threads *threads)
{
    const struct kiln_scene *scene = shadow->scene;
    shadow->count = shadow->place_count = 0;
    for (int meshes = 1; meshes >= 0; meshes--) {
        for (uint32_t i = 0; i < scene->system_count; i++) {
            const struct kiln_system *system = &scene->systems[i];
            if (system->enabled && kiln_look_is_opaque(&system->look) &&
                (system->look.shape == KILN_SHAPE_MESH) == (meshes == 1))
                collect_system(shadow, moment, i);
        }
    }
    if (shadow->place_count > 0 && !shadow->failed)
        draw_tiles(shadow, threads);
}

/* ---- lists ----------------------------------------------------------------------------------- */

/* Describes the bins across the sun's direction. */
struct layout {
    uint32_t edge;
    float low_x, low_y, size; /* m */
};

static struct layout lay_out(const struct kiln_solid_shadow *shadow)
{
    const struct solid *s = shadow->solids;
    float low_x = s->low[0], low_y = s->low[1], high_x = s->high[0], high_y = s->high[1];
    for (size_t i = 1; i < shadow->count; i++) {
        low_x = fminf(low_x, s[i].low[0]);
        low_y = fminf(low_y, s[i].low[1]);
        high_x = fmaxf(high_x, s[i].high[0]);
        high_y = fmaxf(high_y, s[i].high[1]);
    }
    float longest = fmaxf(high_x - low_x, high_y - low_y);
    return (struct layout){KILN_SOLID_BINS, low_x, low_y, longest / KILN_SOLID_BINS};
}

struct range {
    uint32_t x[2], y[2]; /* first and last bin */
};

static uint32_t bin_at(const struct layout *layout, float distance)
{
    float at = distance / layout->size, last = (float)(layout->edge - 1);
    return exact_uint(at > 0.0f ? fminf(at, last) : 0.0f);
}

static struct range bins_of(const struct layout *layout, const struct solid *s)
{
    const float x = layout->low_x, y = layout->low_y;
    return (struct range){{bin_at(layout, s->low[0] - x), bin_at(layout, s->high[0] - x)},
                          {bin_at(layout, s->low[1] - y), bin_at(layout, s->high[1] - y)}};
}

/* Doubles the bins' size until their lists have at most MOST_ENTRIES entries in all, or one bin is
 * left. Returns the number of entries. */
static size_t choose_bins(const struct kiln_solid_shadow *shadow, struct layout *layout)
{
    for (;;) {
        size_t entries = 0;
        for (size_t i = 0; i < shadow->count; i++) {
            struct range r = bins_of(layout, &shadow->solids[i]);
            entries += (size_t)(r.x[1] - r.x[0] + 1) * (r.y[1] - r.y[0] + 1);
        }
        if (entries <= MOST_ENTRIES || layout->edge == 1)
            return entries;
        layout->edge /= 2;
        layout->size *= 2.0f;
    }
}

static bool make_room(struct kiln_solid_shadow *shadow, size_t entries)
{
    size_t rows = shadow->entry_rows ? shadow->entry_rows : 1;
    while (rows * KILN_SOLID_ROW < entries)
        rows *= 2;
    if (rows == shadow->entry_rows)
        return true;
    float4 *more = realloc(shadow->entries, rows * KILN_SOLID_ROW * sizeof *more);
    if (!more)
        return false;
    memset(more, 0, rows * KILN_SOLID_ROW * sizeof *more);
    shadow->entries = more;
    if (shadow->instances) {
        more = realloc(shadow->tiles, rows * KILN_SOLID_ROW * sizeof *more);
        if (!more)
            return false;
        memset(more, 0, rows * KILN_SOLID_ROW * sizeof *more);
        shadow->tiles = more;
    }
    shadow->entry_rows = rows;
    return true;
}

static void put_entry(struct kiln_solid_shadow *shadow, uint32_t at, const struct solid *solid)
{
    shadow->entries[at] = solid->center;
    if (shadow->tiles)
        shadow->tiles[at] = solid->tile;
}

/* Fills the lists and returns the length of the longest. */
static uint32_t fill_lists(struct kiln_solid_shadow *shadow, const struct layout *layout)
{
    uint32_t edge = layout->edge, first = 0, longest = 0;
    memset(shadow->bins, 0, sizeof shadow->bins);
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < shadow->count; i++) {
            struct range r = bins_of(layout, &shadow->solids[i]);
            for (uint32_t y = r.y[0]; y <= r.y[1]; y++) {
                for (uint32_t x = r.x[0]; x <= r.x[1]; x++) {
                    uint32_t *bin = shadow->bins + 2 * ((size_t)y * edge + x);
                    if (pass == 1)
                        put_entry(shadow, bin[0] + bin[1], &shadow->solids[i]);
                    bin[1]++;
                }
            }
        }
        for (size_t i = 0; pass == 0 && i < (size_t)edge * edge; i++) {
            shadow->bins[2 * i] = first;
            const uint32_t count = shadow->bins[2 * i + 1];
            longest = count > longest ? count : longest;
            first += count;
            shadow->bins[2 * i + 1] = 0;
        }
    }
    return longest;
}

bool kiln_solid_shadow_run(struct kiln_solid_shadow *shadow, const struct kiln_moment *moment,
                           struct kiln_threads *threads, struct kiln_solid_bins *bins,
                           struct kiln_error *error)
{
    const struct kiln_scene *scene = shadow->scene;
    *bins = (struct kiln_solid_bins){.edge = 0};
    shadow->sun = moment->sun;
    shadow->floor =
        scene->backdrop.floor_enabled
            ? kiln_scene_value(scene, &scene->backdrop.floor_height, moment->view.clock.x)
            : INFINITY;
    collect_all(shadow, moment, threads);
    if (shadow->count == 0 && !shadow->failed)
        return true;
    struct layout layout = {0};
    size_t entries = 0;
    if (!shadow->failed) {
        layout = lay_out(shadow);
        entries = choose_bins(shadow, &layout);
    }
    if (shadow->failed || !make_room(shadow, entries))
        return kiln_error_no_memory(error, "the shadows of solids");
    const uint32_t longest = fill_lists(shadow, &layout);
    float scale = 1.0f / layout.size;
    const float3 right = shadow->sun.right, up = shadow->sun.up;
    *bins = (struct kiln_solid_bins){
        .edge = layout.edge,
        .bins = shadow->bins,
        .list = shadow->entries,
        .entry_count = entries,
        .rows = shadow->entry_rows,
        .tiles = shadow->tiles,
        .silhouettes = shadow->tiles ? kiln_instance_tiles_texels(shadow->instances) : NULL,
        .longest = longest};
    bins->world_to_bin[0] =
        (float4){right.x * scale, right.y * scale, right.z * scale, -layout.low_x * scale};
    bins->world_to_bin[1] =
        (float4){up.x * scale, up.y * scale, up.z * scale, -layout.low_y * scale};
    return true;
}
