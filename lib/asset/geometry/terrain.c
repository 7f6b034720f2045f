/* Makes terrain from a picture or from noise: its heights, slopes and ceilings, and a mesh to draw.
 * Heights use the arithmetic of the simulation, since particles collide with them. */
#include "asset/geometry/terrain.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "asset/image/image.h"
#include "base/error.h"
#include "shared/noise.h"

static size_t point_count(const struct kiln_terrain *terrain)
{
    return (size_t)terrain->samples[0] * terrain->samples[1];
}

static struct kiln_terrain_point *point_at(const struct kiln_terrain *terrain, uint32_t x,
                                           uint32_t z)
{
    return &terrain->points[(size_t)z * terrain->samples[0] + x];
}

/* ---- pictures -------------------------------------------------------------------------------- */

static float channel(const struct kiln_asset_image *image, size_t at)
{
    if (image->type == KILN_IMAGE_F32) {
        float value = ((const float *)image->pixels)[at];
        return value > 0.0f ? (value < 1.0f ? value : 1.0f) : 0.0f; /* a NaN becomes 0 */
    }
    if (image->type == KILN_IMAGE_U16)
        return (float)((const uint16_t *)image->pixels)[at] / 65535.0f;
    return (float)((const uint8_t *)image->pixels)[at] / 255.0f;
}

/* Returns the height of a pixel. Heights are data, so values are not decoded to linear light. */
static float pixel_height(const struct kiln_asset_image *image, uint32_t x, uint32_t y)
{
    const size_t at = ((size_t)y * image->width + x) * 4;
    const float r = channel(image, at), g = channel(image, at + 1), b = channel(image, at + 2);
    if (r == g && g == b) /* equal channels are grey, which weights that do not quite add up to 1
                           * would change */
        return r;
    return 0.2126f * r + 0.7152f * g + 0.0722f * b;
}

/* The pixels around a point along one axis, and its place between them. */
struct pixel_place {
    uint32_t before, after;
    float part;
};

static struct pixel_place find_pixels(uint32_t point, uint32_t points, uint32_t pixels)
{
    const uint64_t along = (uint64_t)point * (pixels - 1);
    const uint32_t before = (uint32_t)(along / (points - 1));
    return (struct pixel_place){before, before + 1 < pixels ? before + 1 : before,
                                (float)(along % (points - 1)) / (float)(points - 1)};
}

static bool read_image(struct kiln_terrain *terrain, const struct kiln_terrain_params *params,
                       struct kiln_error *error)
{
    struct kiln_asset_image *image =
        kiln_asset_image_load_data(params->loader, params->image, error);
    if (!image)
        return false;
    for (uint32_t z = 0; z < terrain->samples[1]; z++) {
        const struct pixel_place row = find_pixels(z, terrain->samples[1], image->height);
        for (uint32_t x = 0; x < terrain->samples[0]; x++) {
            const struct pixel_place at = find_pixels(x, terrain->samples[0], image->width);
            const float far = exact_lerp(pixel_height(image, at.before, row.before),
                                         pixel_height(image, at.after, row.before), at.part);
            const float near = exact_lerp(pixel_height(image, at.before, row.after),
                                          pixel_height(image, at.after, row.after), at.part);
            point_at(terrain, x, z)->height = exact_lerp(far, near, row.part);
        }
    }
    kiln_asset_image_destroy(&image);
    return true;
}

/* ---- noise ----------------------------------------------------------------------------------- */

/* Computes gradient noise in the plane, about -1 to 1. */
static float noise_flat(float x, float z, uint32_t seed)
{
    if (!noise_reaches(FLOAT3(x, 0.0f, z)))
        return 0.0f;
    const float low_x = FLOOR(x), low_z = FLOOR(z);
    const uint32_t lattice = UINT(INT(low_x)) * NOISE_X + UINT(INT(low_z)) * NOISE_Z + seed;
    const float part_x = x - low_x, part_z = z - low_z;
    const struct noise_fade fade_x = noise_fade_at(part_x), fade_z = noise_fade_at(part_z);
    float sum = 0.0f;
    for (uint32_t corner = 0; corner < 4; corner++) {
        const uint32_t ux = corner & 1, uz = corner >> 1;
        const float weight = noise_fade_of_corner(fade_x, ux != 0).weight *
                             noise_fade_of_corner(fade_z, uz != 0).weight;
        const float3 g = noise_gradient(random_mix(lattice + ux * NOISE_X + uz * NOISE_Z));
        const float slope = g.x * (part_x - (float)ux) + g.z * (part_z - (float)uz);
        sum += weight * slope;
    }
    return sum * 0.45f;
}

/* Sums octaves of noise, each of half the size. With ridges, the height so far is the weight of the
 * next octave, so that low ground stays smooth. */
static float noise_height(const struct kiln_terrain_params *params, float x, float z)
{
    float sum = 0.0f, amplitude = 1.0f, frequency = 1.0f / params->hills, weight = 1.0f;
    for (uint32_t octave = 0; octave < params->octaves; octave++) {
        const uint32_t seed = random_mix(params->seed + octave);
        const float round = noise_flat(x * frequency, z * frequency, seed);
        const float crest = 1.0f - exact_abs(round);
        const float ridge = crest * crest - 0.5f;
        const float height = exact_lerp(round, ridge, params->ridges);
        sum += amplitude * weight * height;
        const float next = exact_clamp(0.75f + height, 0.0f, 1.0f);
        weight = weight * exact_lerp(1.0f, next, params->ridges);
        amplitude *= params->roughness;
        frequency *= 2.0f;
    }
    return sum;
}

/* Makes heights of noise, scaled to 0 to 1; if all are equal they are 0. */
static void make_noise(struct kiln_terrain *terrain, const struct kiln_terrain_params *params)
{
    float least = 0.0f, most = 0.0f;
    for (uint32_t z = 0; z < terrain->samples[1]; z++) {
        for (uint32_t x = 0; x < terrain->samples[0]; x++) {
            const float from_x = (float)x * terrain->spacing[0] - 0.5f * params->size[0];
            const float from_z = (float)z * terrain->spacing[1] - 0.5f * params->size[2];
            const float height = noise_height(params, from_x, from_z);
            point_at(terrain, x, z)->height = height;
            least = (x == 0 && z == 0) || height < least ? height : least;
            most = (x == 0 && z == 0) || height > most ? height : most;
        }
    }
    const float range = most - least;
    for (size_t i = 0; i < point_count(terrain); i++)
        terrain->points[i].height =
            range > 0.0f ? (terrain->points[i].height - least) / range : 0.0f;
}

/* ---- heights, slopes, ceilings --------------------------------------------------------------- */

static void place_heights(struct kiln_terrain *terrain, const struct kiln_terrain_params *params)
{
    terrain->top = params->position[1];
    for (size_t i = 0; i < point_count(terrain); i++) {
        float *height = &terrain->points[i].height;
        *height = exact_canon(params->position[1] + *height * params->size[1]);
        terrain->top = exact_max(terrain->top, *height);
    }
}

/* Returns the slope along one axis from `before` to `after`, which are two cells apart, or one cell
 * at the edges. */
static float slope_between(const struct kiln_terrain_point *before,
                           const struct kiln_terrain_point *after, uint32_t cells, float spacing)
{
    return exact_canon((after->height - before->height) / ((float)cells * spacing));
}

static void find_slopes(struct kiln_terrain *terrain)
{
    const uint32_t last_x = terrain->samples[0] - 1, last_z = terrain->samples[1] - 1;
    for (uint32_t z = 0; z <= last_z; z++) {
        for (uint32_t x = 0; x <= last_x; x++) {
            const uint32_t x0 = x > 0 ? x - 1 : 0, x1 = x < last_x ? x + 1 : x;
            const uint32_t z0 = z > 0 ? z - 1 : 0, z1 = z < last_z ? z + 1 : z;
            struct kiln_terrain_point *point = point_at(terrain, x, z);
            point->slope_x = slope_between(point_at(terrain, x0, z), point_at(terrain, x1, z),
                                           x1 - x0, terrain->spacing[0]);
            point->slope_z = slope_between(point_at(terrain, x, z0), point_at(terrain, x, z1),
                                           z1 - z0, terrain->spacing[1]);
        }
    }
}

/* Finds the ceilings, with a margin for the rounding of interpolation. */
static void find_ceilings(struct kiln_terrain *terrain)
{
    for (uint32_t z = 0; z < terrain->samples[1]; z++) {
        for (uint32_t x = 0; x < terrain->samples[0]; x++) {
            float most = point_at(terrain, x, z)->height;
            for (uint32_t k = z > 0 ? z - 1 : 0; k <= z + 2 && k < terrain->samples[1]; k++) {
                for (uint32_t i = x > 0 ? x - 1 : 0; i <= x + 2 && i < terrain->samples[0]; i++)
                    most = exact_max(most, point_at(terrain, i, k)->height);
            }
            point_at(terrain, x, z)->ceiling = most + 1e-3f + exact_abs(most) * 1e-6f;
        }
    }
}

struct kiln_terrain *kiln_terrain_create(const struct kiln_terrain_params *params,
                                         struct kiln_error *error)
{
    struct kiln_terrain *terrain = calloc(1, sizeof *terrain);
    if (terrain) {
        memcpy(terrain->samples, params->samples, sizeof terrain->samples);
        terrain->points = calloc(point_count(terrain), sizeof *terrain->points);
    }
    if (!terrain || !terrain->points) {
        kiln_error_no_memory(error, "the terrain");
        kiln_terrain_destroy(&terrain);
        return NULL;
    }
    for (int c = 0; c < 3; c++)
        terrain->origin[c] =
            exact_canon(params->position[c] - (c == 1 ? 0.0f : 0.5f * params->size[c]));
    terrain->spacing[0] = params->size[0] / (float)(params->samples[0] - 1);
    terrain->spacing[1] = params->size[2] / (float)(params->samples[1] - 1);
    if (!params->image) {
        make_noise(terrain, params);
    } else if (!read_image(terrain, params, error)) {
        kiln_terrain_destroy(&terrain);
        return NULL;
    }
    place_heights(terrain, params);
    find_slopes(terrain);
    find_ceilings(terrain);
    return terrain;
}

void kiln_terrain_destroy(struct kiln_terrain **terrain)
{
    if (!*terrain)
        return;
    free((*terrain)->points);
    free(*terrain);
    *terrain = NULL;
}

/* ---- the mesh -------------------------------------------------------------------------------- */

static void add_vertex(struct kiln_mesh *mesh, float3 p, float3 normal)
{
    const float vertex[6] = {p.x, p.y, p.z, normal.x, normal.y, normal.z};
    memcpy(mesh->vertices[mesh->vertex_count++], vertex, sizeof vertex);
    const float place[3] = {p.x, p.y, p.z};
    for (int c = 0; c < 3; c++) {
        mesh->min[c] = mesh->vertex_count == 1 ? place[c] : fminf(mesh->min[c], place[c]);
        mesh->max[c] = mesh->vertex_count == 1 ? place[c] : fmaxf(mesh->max[c], place[c]);
    }
}

static void add_triangle(struct kiln_mesh *mesh, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t corners[3] = {a, b, c};
    memcpy(mesh->triangles[mesh->triangle_count++], corners, sizeof corners);
}

/* Returns the place of a point relative to the origin, where the mesh is placed. */
static float3 place_of(const struct kiln_terrain *terrain, uint32_t x, uint32_t z)
{
    return FLOAT3((float)x * terrain->spacing[0],
                  point_at(terrain, x, z)->height - terrain->origin[1],
                  (float)z * terrain->spacing[1]);
}

static void add_ground(struct kiln_mesh *mesh, const struct kiln_terrain *terrain)
{
    const uint32_t width = terrain->samples[0], depth = terrain->samples[1];
    const float3 up = {0.0f, 1.0f, 0.0f};
    for (uint32_t z = 0; z < depth; z++) {
        for (uint32_t x = 0; x < width; x++) {
            const struct kiln_terrain_point *point = point_at(terrain, x, z);
            const float3 normal = FLOAT3(-point->slope_x, 1.0f, -point->slope_z);
            add_vertex(mesh, place_of(terrain, x, z), float3_normalize(normal, up));
        }
    }
    for (uint32_t z = 0; z + 1 < depth; z++) {
        for (uint32_t x = 0; x + 1 < width; x++) {
            const uint32_t first = z * width + x, last = first + width + 1;
            add_triangle(mesh, first, last - 1, last);
            add_triangle(mesh, first, last, first + 1);
        }
    }
}

/* Adds a wall along x from (0, z), or along z from (x, 0). */
static void add_wall(struct kiln_mesh *mesh, const struct kiln_terrain *terrain, uint32_t x,
                     uint32_t z, bool along_x, float3 normal)
{
    const uint32_t count = terrain->samples[along_x ? 0 : 1];
    for (uint32_t i = 0; i < count; i++) {
        float3 p = place_of(terrain, along_x ? i : x, along_x ? z : i);
        add_vertex(mesh, p, normal);
        p.y = 0.0f;
        add_vertex(mesh, p, normal);
        if (i == 0)
            continue;
        const uint32_t last = mesh->vertex_count - 4;
        add_triangle(mesh, last, last + 1, last + 2);
        add_triangle(mesh, last + 2, last + 1, last + 3);
    }
}

void kiln_terrain_mesh_count(const uint32_t samples[2], uint64_t *vertices, uint64_t *triangles)
{
    const uint64_t points = (uint64_t)samples[0] * samples[1];
    const uint64_t cells = ((uint64_t)samples[0] - 1) * (samples[1] - 1);
    const uint64_t edges = 2 * ((uint64_t)samples[0] + samples[1]);
    *vertices = points + 2 * edges; /* the ground, and the walls below its edges */
    *triangles = 2 * (cells + edges);
}

struct kiln_mesh *kiln_terrain_mesh(const struct kiln_terrain *terrain, struct kiln_error *error)
{
    const uint32_t width = terrain->samples[0], depth = terrain->samples[1];
    uint64_t vertices, triangles;
    kiln_terrain_mesh_count(terrain->samples, &vertices, &triangles);
    struct kiln_mesh *mesh = calloc(1, sizeof *mesh);
    if (mesh) {
        mesh->vertices = malloc(vertices * sizeof *mesh->vertices);
        mesh->triangles = malloc(triangles * sizeof *mesh->triangles);
    }
    if (!mesh || !mesh->vertices || !mesh->triangles) {
        kiln_error_no_memory(error, "the terrain");
        kiln_mesh_destroy(&mesh);
        return NULL;
    }
    add_ground(mesh, terrain);
    add_wall(mesh, terrain, 0, 0, false, FLOAT3(-1.0f, 0.0f, 0.0f));
    add_wall(mesh, terrain, width - 1, 0, false, FLOAT3(1.0f, 0.0f, 0.0f));
    add_wall(mesh, terrain, 0, 0, true, FLOAT3(0.0f, 0.0f, -1.0f));
    add_wall(mesh, terrain, 0, depth - 1, true, FLOAT3(0.0f, 0.0f, 1.0f));
    return mesh;
}

uint64_t kiln_terrain_bytes(const uint32_t samples[2])
{
    return (uint64_t)samples[0] * samples[1] * sizeof(struct kiln_terrain_point);
}
