/* Lists on the host, by counting: first how many spheres each bin has, then where its list begins,
 * then the spheres themselves, in the order of systems and slots. A sphere is in all bins that its
 * shadow can fall into, penumbra included.
 */
#include "draw/sphere_shadow.h"

#include "base/error.h"
#include "shared/exact.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ENTRIES = 1 << 20, FIRST_ROOM = 1024 };

struct sphere {
    float4 center; /* world; w: radius, m */
    float x, y;    /* across the sun's direction, m */
    float reach;   /* of the shadow around that, m */
};

struct kiln_sphere_shadow {
    const struct kiln_scene *scene;
    struct kiln_sun_frame sun; /* of the frame at hand */
    float floor;               /* its height; infinite for none */
    struct sphere *spheres;
    size_t count, room;
    bool failed;                                            /* no memory for one */
    uint32_t bins[KILN_SPHERE_BINS * KILN_SPHERE_BINS * 2]; /* first entry and number of each */
    float4 *entries;
    size_t entry_rows; /* of memory */
};

struct kiln_sphere_shadow *kiln_sphere_shadow_create(const struct kiln_scene *scene,
                                                     struct kiln_error *error)
{
    struct kiln_sphere_shadow *shadow = calloc(1, sizeof *shadow);
    if (!shadow) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "shadows of spheres: out of memory");
        return NULL;
    }
    shadow->scene = scene;
    return shadow;
}

void kiln_sphere_shadow_destroy(struct kiln_sphere_shadow **shadow)
{
    struct kiln_sphere_shadow *s = *shadow;
    if (!s)
        return;
    free(s->spheres);
    free(s->entries);
    free(s);
    *shadow = NULL;
}

/* How far around itself a sphere may throw its shadow: the penumbra widens until the floor, or
 * until nothing is left of the shadow (KILN_SPHERE_FADE). */
static float reach_of(const struct kiln_sphere_shadow *shadow, float3 center, float radius)
{
    float spread = shadow->sun.spread, widest = radius * KILN_SPHERE_FADE;
    if (shadow->sun.towards.y > 0.0f && center.y > shadow->floor)
        widest = fminf(widest, spread * (center.y - shadow->floor) / shadow->sun.towards.y);
    return radius + (spread > 0.0f ? widest : 0.0f);
}

/* radius: of a sphere with such a shadow, in radii of the particle. */
static void collect(struct kiln_sphere_shadow *shadow, const struct kiln_living *particle,
                    float radius)
{
    radius *= particle->radius * particle->opacity; /* it grows by it (spheres.vert) */
    if (!(radius > 0.0f) || shadow->failed)
        return;
    if (shadow->count == shadow->room) {
        size_t room = shadow->room ? 2 * shadow->room : FIRST_ROOM;
        struct sphere *more = realloc(shadow->spheres, room * sizeof *more);
        if (!more) {
            shadow->failed = true;
            return;
        }
        shadow->spheres = more;
        shadow->room = room;
    }
    float3 at = particle->position;
    shadow->spheres[shadow->count++] = (struct sphere){
        .center = {at.x, at.y, at.z, radius},
        .x = float3_dot(at, shadow->sun.right),
        .y = float3_dot(at, shadow->sun.up),
        .reach = reach_of(shadow, at, radius),
    };
}

static void collect_system(struct kiln_sphere_shadow *shadow,
                           const struct kiln_living_moment *moment, uint32_t index)
{
    const struct kiln_living_system system = kiln_living_system(moment, index);
    const struct kiln_look *look = &shadow->scene->systems[index].look;
    float radius = look->shape == KILN_SHAPE_MESH ? 2.0f * look->mesh.shade : 1.0f;
    for (uint32_t slot = 0; slot < system.used; slot++) {
        struct kiln_living particle;
        if (kiln_living_at(&system, slot, &particle))
            collect(shadow, &particle, radius);
    }
}

/* Where the bins lie across the sun's direction. */
struct layout {
    uint32_t edge;
    float low_x, low_y, size; /* m */
};

static struct layout lay_out(const struct kiln_sphere_shadow *shadow)
{
    const struct sphere *s = shadow->spheres;
    float low_x = s->x - s->reach, low_y = s->y - s->reach;
    float high_x = s->x + s->reach, high_y = s->y + s->reach;
    for (size_t i = 1; i < shadow->count; i++) {
        low_x = fminf(low_x, s[i].x - s[i].reach);
        low_y = fminf(low_y, s[i].y - s[i].reach);
        high_x = fmaxf(high_x, s[i].x + s[i].reach);
        high_y = fmaxf(high_y, s[i].y + s[i].reach);
    }
    float longest = fmaxf(high_x - low_x, high_y - low_y);
    return (struct layout){KILN_SPHERE_BINS, low_x, low_y, longest / KILN_SPHERE_BINS};
}

struct range {
    uint32_t x[2], y[2]; /* first and last bin */
};

static uint32_t bin_at(const struct layout *layout, float distance)
{
    float at = distance / layout->size, last = (float)(layout->edge - 1);
    return (uint32_t)(at > 0.0f ? fminf(at, last) : 0.0f);
}

static struct range bins_of(const struct layout *layout, const struct sphere *s)
{
    float x = s->x - layout->low_x, y = s->y - layout->low_y;
    return (struct range){{bin_at(layout, x - s->reach), bin_at(layout, x + s->reach)},
                          {bin_at(layout, y - s->reach), bin_at(layout, y + s->reach)}};
}

/* Bins so large that their lists are not too long in all; returns the entries. */
static size_t choose_bins(const struct kiln_sphere_shadow *shadow, struct layout *layout)
{
    for (;;) {
        size_t entries = 0;
        for (size_t i = 0; i < shadow->count; i++) {
            struct range r = bins_of(layout, &shadow->spheres[i]);
            entries += (size_t)(r.x[1] - r.x[0] + 1) * (r.y[1] - r.y[0] + 1);
        }
        if (entries <= MOST_ENTRIES || layout->edge == 1)
            return entries;
        layout->edge /= 2;
        layout->size *= 2.0f;
    }
}

static bool make_room(struct kiln_sphere_shadow *shadow, size_t entries)
{
    size_t rows = shadow->entry_rows ? shadow->entry_rows : 1;
    while (rows * KILN_SPHERE_ROW < entries)
        rows *= 2;
    if (rows == shadow->entry_rows)
        return true;
    float4 *more = realloc(shadow->entries, rows * KILN_SPHERE_ROW * sizeof *more);
    if (!more)
        return false;
    memset(more, 0, rows * KILN_SPHERE_ROW * sizeof *more);
    shadow->entries = more;
    shadow->entry_rows = rows;
    return true;
}

/* Returns the length of the longest. */
static uint32_t fill_lists(struct kiln_sphere_shadow *shadow, const struct layout *layout)
{
    uint32_t edge = layout->edge, first = 0, longest = 0;
    memset(shadow->bins, 0, sizeof shadow->bins);
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < shadow->count; i++) {
            struct range r = bins_of(layout, &shadow->spheres[i]);
            for (uint32_t y = r.y[0]; y <= r.y[1]; y++) {
                for (uint32_t x = r.x[0]; x <= r.x[1]; x++) {
                    uint32_t *bin = shadow->bins + 2 * ((size_t)y * edge + x);
                    if (pass == 1)
                        shadow->entries[bin[0] + bin[1]] = shadow->spheres[i].center;
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

bool kiln_sphere_shadow_run(struct kiln_sphere_shadow *shadow,
                            const struct kiln_living_moment *moment, struct kiln_sphere_bins *bins,
                            struct kiln_error *error)
{
    const struct kiln_scene *scene = shadow->scene;
    *bins = (struct kiln_sphere_bins){.edge = 0};
    shadow->sun = kiln_sun_frame_at(scene, moment->view->clock.x);
    shadow->floor =
        scene->backdrop.floor_enabled
            ? kiln_scene_value(scene, &scene->backdrop.floor_height, moment->view->clock.x)
            : INFINITY;
    shadow->count = 0;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        if (scene->systems[i].enabled && kiln_look_is_opaque(&scene->systems[i].look))
            collect_system(shadow, moment, i);
    }
    if (shadow->count == 0 && !shadow->failed)
        return true;
    struct layout layout = {0};
    size_t entries = 0;
    if (!shadow->failed) {
        layout = lay_out(shadow);
        entries = choose_bins(shadow, &layout);
    }
    if (shadow->failed || !make_room(shadow, entries))
        return kiln_error_set(error, KILN_DEVICE_FAILED, "shadows of spheres: out of memory");
    const uint32_t longest = fill_lists(shadow, &layout);
    float scale = 1.0f / layout.size;
    const float3 right = shadow->sun.right, up = shadow->sun.up;
    *bins = (struct kiln_sphere_bins){.edge = layout.edge,
                                      .bins = shadow->bins,
                                      .list = shadow->entries,
                                      .entry_count = entries,
                                      .rows = shadow->entry_rows,
                                      .longest = longest};
    bins->world_to_bin[0] =
        (float4){right.x * scale, right.y * scale, right.z * scale, -layout.low_x * scale};
    bins->world_to_bin[1] =
        (float4){up.x * scale, up.y * scale, up.z * scale, -layout.low_y * scale};
    return true;
}
