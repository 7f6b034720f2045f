/* This file makes depth maps of a mesh: for each sample of a map, the front and the back of the
 * surface along a direction, and their normals. Places are rounded to 1/256 of a sample, and
 * heights to 2^-24 of the mesh's extent along the direction. All that follows is in 64-bit
 * integers, so no sample is missed between two neighbouring triangles. The order of triangles
 * matters only among equals, of which the first counts. */
#include "asset/geometry/papers/depth_maps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "shared/exact.h"

enum {
    SUB = 256,             /* steps of a place within a sample */
    MARGIN = 5,            /* samples of a map around the mesh */
    REACH = 3,             /* samples from the mesh within which a map may have a surface */
    HEIGHTS = 24,          /* bits of a height */
    MOST_VISITS = 1 << 28, /* products of samples and triangles for one map */
};

/* The least distance from front to back, in parts of the mesh's size, so that a sheet has a back.
 */
static const double HAIR = 1.0 / 8192;

/* A corner of a triangle in the frame of a map. */
struct corner {
    int64_t x, y, height;
};

/* A triangle as it is drawn into a map. */
struct facet {
    struct corner corners[3];
    int64_t low, high, area; /* range of the heights; area: twice the triangle's, at least 0 */
};

/* The surface at a sample; triangle -1: none. */
struct sample {
    int64_t front, back;           /* heights of the triangles that cover the sample */
    int64_t near_front, near_back; /* heights of the triangles at most one sample away */
    int32_t front_triangle, back_triangle;
    int32_t near_triangles[2]; /* the triangles whose normals the front and the back get */
    double near_tilts[2];
};

/* The state of one map while it is made. */
struct making {
    const struct kiln_mesh *mesh;
    const double (*normals)[3]; /* unit normals of the triangles, outwards */
    double axes[3][3];          /* axes of columns, rows and heights */
    /* low: least value on each axis; step: size of a sample or height */
    double low[3], step[3];
    uint32_t resolution;
    struct corner *corners; /* one for each vertex */
    struct sample *samples;
    float (*words)[4]; /* words of the map's samples */
    double hair;
};

static double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross3(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void normalize3(double v[3], const double otherwise[3])
{
    const double length = sqrt(dot3(v, v));
    for (int c = 0; c < 3; c++)
        v[c] = length > 1e-30 ? v[c] / length : otherwise[c];
}

/* ---- triangles ------------------------------------------------------------------------------- */

static void position_of(const struct kiln_mesh *mesh, uint32_t vertex, double p[3])
{
    for (int c = 0; c < 3; c++)
        p[c] = (double)mesh->vertices[vertex][c];
}

/* Finds unit normals. They are flipped if the mesh is inside out, by the sign of its volume. */
static void find_normals(const struct kiln_mesh *mesh, double (*normals)[3])
{
    static const double nowhere[3] = {0, 0, 0};
    double volume = 0;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        double a[3], b[3], c[3];
        position_of(mesh, mesh->triangles[i][0], a);
        position_of(mesh, mesh->triangles[i][1], b);
        position_of(mesh, mesh->triangles[i][2], c);
        for (int k = 0; k < 3; k++) {
            b[k] -= a[k];
            c[k] -= a[k];
            a[k] -= (double)mesh->min[k];
        }
        cross3(b, c, normals[i]);
        volume += dot3(a, normals[i]);
        normalize3(normals[i], nowhere);
    }
    for (uint32_t i = 0; volume < 0 && i < mesh->triangle_count; i++) {
        for (int k = 0; k < 3; k++)
            normals[i][k] = -normals[i][k];
    }
}

/* Returns twice the signed area of the triangle a, b, (x, y); above 0: left of the way from a to b.
 */
static int64_t left_of(const struct corner *a, const struct corner *b, int64_t x, int64_t y)
{
    return (b->x - a->x) * (y - a->y) - (b->y - a->y) * (x - a->x);
}

static int64_t least(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

static int64_t most(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

static struct facet facet_of(const struct making *making, uint32_t triangle)
{
    struct facet facet;
    for (int k = 0; k < 3; k++)
        facet.corners[k] = making->corners[making->mesh->triangles[triangle][k]];
    facet.area =
        left_of(&facet.corners[0], &facet.corners[1], facet.corners[2].x, facet.corners[2].y);
    if (facet.area < 0) {
        const struct corner swapped = facet.corners[1];
        facet.corners[1] = facet.corners[2];
        facet.corners[2] = swapped;
        facet.area = -facet.area;
    }
    const struct corner *c = facet.corners;
    facet.low = least(c[0].height, least(c[1].height, c[2].height));
    facet.high = most(c[0].height, most(c[1].height, c[2].height));
    return facet;
}

/* ---- samples --------------------------------------------------------------------------------- */

static void cover(struct sample *sample, int64_t height, int32_t triangle)
{
    if (sample->front_triangle < 0 || height > sample->front) {
        sample->front = height;
        sample->front_triangle = triangle;
    }
    if (sample->back_triangle < 0 || height < sample->back) {
        sample->back = height;
        sample->back_triangle = triangle;
    }
}

/* Notes a triangle near a sample that no triangle covers. The steepest triangle gives the normal,
 * since the mesh ends at its edge. */
static void come_near(const struct making *making, struct sample *sample, int64_t low, int64_t high,
                      int32_t triangle, double aside)
{
    const bool first = sample->near_triangles[0] < 0;
    sample->near_front = first ? high : most(high, sample->near_front);
    sample->near_back = first ? low : least(low, sample->near_back);
    const double along = dot3(making->normals[triangle], making->axes[2]);
    const double tilt = fabs(along) + (aside < 0 ? 2 : 0);
    for (int side = 0; side < 2; side++) {
        const double facing = side == 0 ? along : -along;
        const double steep = facing < -1e-6 ? tilt + 4 : tilt;
        if (first || steep < sample->near_tilts[side]) {
            sample->near_tilts[side] = steep;
            sample->near_triangles[side] = triangle;
        }
    }
}

/* Returns how far outside of a triangle a sample is, along the plane of the map. */
static double aside_of(const struct making *making, const struct facet *facet, int32_t triangle,
                       int64_t x, int64_t y)
{
    const double *n = making->normals[triangle];
    return dot3(n, making->axes[0]) * (double)(x - facet->corners[0].x) * making->step[0] +
           dot3(n, making->axes[1]) * (double)(y - facet->corners[0].y) * making->step[1];
}

/* Computes the weights of the corners at a place. False: the square around the place, of half edge
 * `slack`, is outside of an edge. */
static bool weigh(const struct facet *facet, int64_t x, int64_t y, int64_t slack,
                  int64_t weights[3])
{
    bool within = true;
    for (int k = 0; k < 3; k++) {
        const struct corner *a = &facet->corners[(k + 1) % 3], *b = &facet->corners[(k + 2) % 3];
        weights[k] = left_of(a, b, x, y);
        const int64_t reach = slack * (llabs(b->x - a->x) + llabs(b->y - a->y));
        within = within && weights[k] >= -reach && (facet->area > 0 || weights[k] <= reach);
    }
    return within;
}

static void meet(const struct making *making, const struct facet *facet, int32_t triangle,
                 struct sample *sample, int64_t x, int64_t y)
{
    int64_t weights[3];
    if (!weigh(facet, x, y, SUB, weights))
        return;
    int64_t low = facet->low, high = facet->high;
    if (facet->area > 0) {
        int64_t sum = 0, slope_x = 0, slope_y = 0;
        for (int k = 0; k < 3; k++) {
            const struct corner *a = &facet->corners[(k + 1) % 3];
            const struct corner *b = &facet->corners[(k + 2) % 3];
            sum += weights[k] * facet->corners[k].height;
            slope_x -= (b->y - a->y) * facet->corners[k].height;
            slope_y += (b->x - a->x) * facet->corners[k].height;
        }
        const int64_t height = sum / facet->area;
        if (weights[0] >= 0 && weights[1] >= 0 && weights[2] >= 0)
            cover(sample, height, triangle);
        const int64_t reach = SUB * ((llabs(slope_x) + llabs(slope_y)) / facet->area + 1);
        low = most(low, least(height - reach, high));
        high = least(high, most(height + reach, low));
    }
    come_near(making, sample, low, high, triangle, aside_of(making, facet, triangle, x, y));
}

/* A range of samples from x0 and y0 to x1 - 1 and y1 - 1. */
struct range {
    int64_t x0, x1, y0, y1;
};

/* Returns the range of samples that are at most one away from a triangle. */
static struct range range_of(const struct making *making, const struct corner corners[3])
{
    const struct corner *c = corners;
    const int64_t end = making->resolution;
    return (struct range){
        .x0 = most((least(c[0].x, least(c[1].x, c[2].x)) - 1) / SUB, 0),
        .x1 = least(most(c[0].x, most(c[1].x, c[2].x)) / SUB + 2, end),
        .y0 = most((least(c[0].y, least(c[1].y, c[2].y)) - 1) / SUB, 0),
        .y1 = least(most(c[0].y, most(c[1].y, c[2].y)) / SUB + 2, end),
    };
}

/* Adds a triangle to the samples in and around it, in the given rows. */
static void meet_samples(const struct making *making, uint32_t triangle, int64_t first_row,
                         int64_t end_row)
{
    const struct facet facet = facet_of(making, triangle);
    const struct range range = range_of(making, facet.corners);
    for (int64_t y = most(range.y0, first_row); y < least(range.y1, end_row); y++) {
        struct sample *row = making->samples + (size_t)y * making->resolution;
        for (int64_t x = range.x0; x < range.x1; x++)
            meet(making, &facet, (int32_t)triangle, &row[x], x * SUB, y * SUB);
    }
}

static void make_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    struct making *making = context;
    for (size_t i = begin * making->resolution; i < end * making->resolution; i++)
        making->samples[i] =
            (struct sample){.front_triangle = -1, .back_triangle = -1, .near_triangles = {-1, -1}};
    for (uint32_t i = 0; i < making->mesh->triangle_count; i++)
        meet_samples(making, i, (int64_t)begin, (int64_t)end);
}

/* ---- words ----------------------------------------------------------------------------------- */

static void set_word(float word[4], const double normal[3], double height)
{
    for (int c = 0; c < 3; c++)
        word[c] = exact_canon((float)normal[c]);
    word[3] = exact_canon((float)height);
}

/* Writes a sample that a triangle covers or is near to. */
static bool write_sample(const struct making *making, size_t index)
{
    const struct sample *sample = &making->samples[index];
    const bool covered = sample->front_triangle >= 0;
    if (!covered && sample->near_triangles[0] < 0)
        return false;
    const int64_t heights[2] = {covered ? sample->front : sample->near_front,
                                covered ? sample->back : sample->near_back};
    const int32_t triangles[2] = {covered ? sample->front_triangle : sample->near_triangles[0],
                                  covered ? sample->back_triangle : sample->near_triangles[1]};
    double ends[2];
    for (int side = 0; side < 2; side++)
        ends[side] = making->low[2] + (double)heights[side] * making->step[2];
    if (ends[0] - ends[1] < 2 * making->hair) {
        const double middle = 0.5 * (ends[0] + ends[1]);
        ends[0] = middle + making->hair;
        ends[1] = middle - making->hair;
    }
    for (int side = 0; side < 2; side++) {
        const double *n = making->normals[triangles[side]];
        const double along = dot3(n, making->axes[2]) * (side == 0 ? 1 : -1);
        /* a thin sheet's back has the normal opposite to its front */
        const double way = along < -1e-3 ? -1 : 1;
        const double normal[3] = {way * n[0], way * n[1], way * n[2]};
        set_word(making->words[2 * index + (size_t)side], normal, ends[side]);
    }
    return true;
}

/* Writes a sample without a triangle. Front and back get one height, the middle of the samples
 * around it. */
static void write_empty(const struct making *making, uint32_t x, uint32_t y)
{
    double normals[2][3] = {{0, 0, 0}, {0, 0, 0}}, height = 0;
    int count = 0;
    for (int i = 0; i < 9; i++) {
        const uint32_t u = x + (uint32_t)(i % 3) - 1, v = y + (uint32_t)(i / 3) - 1;
        if (u >= making->resolution || v >= making->resolution)
            continue;
        const size_t at = (size_t)v * making->resolution + u;
        const struct sample *sample = &making->samples[at];
        if (sample->front_triangle < 0 && sample->near_triangles[0] < 0)
            continue;
        count++;
        for (size_t side = 0; side < 2; side++) {
            const float *word = making->words[2 * at + side];
            height += 0.5 * (double)word[3];
            for (int c = 0; c < 3; c++)
                normals[side][c] += (double)word[c];
        }
    }
    const size_t index = (size_t)y * making->resolution + x;
    const double *up = making->axes[2], down[3] = {-up[0], -up[1], -up[2]};
    height = count > 0 ? height / count : making->low[2];
    normalize3(normals[0], up);
    normalize3(normals[1], down);
    set_word(making->words[2 * index], normals[0], height);
    set_word(making->words[2 * index + 1], normals[1], height);
}

static void write_map(const struct making *making)
{
    const uint32_t resolution = making->resolution;
    /* reuses memory that is free by now: one byte a sample */
    unsigned char *empty = (unsigned char *)making->corners;
    for (size_t i = 0; i < (size_t)resolution * resolution; i++)
        empty[i] = !write_sample(making, i);
    for (uint32_t i = 0; i < resolution * resolution; i++) {
        if (empty[i])
            write_empty(making, i % resolution, i / resolution);
    }
}

/* ---- maps ------------------------------------------------------------------------------------ */

/* Finds the axes of a map's columns and rows, from the axis of the world that is least along the
 * direction. */
static void find_axes(const float direction[3], double axes[3][3])
{
    int across = 0;
    for (int c = 0; c < 3; c++) {
        axes[2][c] = (double)direction[c];
        across = fabs(axes[2][c]) < fabs(axes[2][across]) ? c : across;
    }
    const double up[3] = {0, 0, 1}, side[3] = {across == 0, across == 1, across == 2};
    normalize3(axes[2], up);
    cross3(side, axes[2], axes[0]);
    normalize3(axes[0], side);
    cross3(axes[2], axes[0], axes[1]);
}

/* Places the samples of a map over the extent of the mesh. */
static void place_map(struct making *making, double size)
{
    double high[3];
    for (int a = 0; a < 3; a++) {
        making->low[a] = 1e300;
        high[a] = -1e300;
        for (uint32_t i = 0; i < making->mesh->vertex_count; i++) {
            double p[3];
            position_of(making->mesh, i, p);
            const double along = dot3(making->axes[a], p);
            making->low[a] = fmin(making->low[a], along);
            high[a] = fmax(high[a], along);
        }
        const double span = fmax(high[a] - making->low[a], 1e-3 * size);
        making->step[a] = a < 2 ? span / (making->resolution - 1 - 2 * MARGIN) : span;
        if (a < 2)
            making->low[a] -= MARGIN * making->step[a];
    }
    making->step[2] /= (double)(1 << HEIGHTS);
    making->hair = HAIR * size;
}

static void project(const struct making *making)
{
    for (uint32_t i = 0; i < making->mesh->vertex_count; i++) {
        double p[3];
        int64_t at[3];
        position_of(making->mesh, i, p);
        for (int a = 0; a < 3; a++) {
            const double along = (dot3(making->axes[a], p) - making->low[a]) / making->step[a];
            at[a] = (int64_t)floor(along * (a < 2 ? SUB : 1) + 0.5);
        }
        making->corners[i] = (struct corner){at[0], at[1], at[2]};
    }
}

static void write_rows(const struct making *making, float (*rows)[4])
{
    for (int a = 0; a < 3; a++) {
        const double per_unit = a < 2 ? 1 / making->step[a] : 1;
        const double offset = a < 2 ? -making->low[a] * per_unit : 0;
        double row[3];
        for (int c = 0; c < 3; c++)
            row[c] = making->axes[a][c] * per_unit;
        set_word(rows[a], row, offset);
    }
}

static void make(struct kiln_depth_maps *maps, struct making *making, const float (*directions)[3],
                 double size, struct kiln_threads *threads)
{
    const size_t samples = (size_t)maps->resolution * maps->resolution;
    double reach = 0;
    for (uint32_t i = 0; i < maps->count; i++) {
        find_axes(directions[i], making->axes);
        place_map(making, size);
        reach = fmax(reach, REACH * fmax(making->step[0], making->step[1]));
        write_rows(making, maps->words + (size_t)3 * i);
        project(making);
        making->words = maps->words + (size_t)3 * maps->count + 2 * samples * i;
        kiln_threads_for(threads, maps->resolution, 16, make_rows, making);
        write_map(making);
    }
    for (int c = 0; c < 3; c++) {
        maps->min[c] = exact_canon((float)((double)making->mesh->min[c] - reach));
        maps->max[c] = exact_canon((float)((double)making->mesh->max[c] + reach));
    }
}

static double size_of(const struct kiln_mesh *mesh)
{
    double size = 1e-6;
    for (int c = 0; c < 3; c++)
        size = fmax(size, (double)mesh->max[c] - (double)mesh->min[c]);
    return size;
}

size_t kiln_depth_maps_words(uint32_t count, uint32_t resolution)
{
    return (size_t)count * (3 + 2 * (size_t)resolution * resolution);
}

bool kiln_depth_maps_check(const struct kiln_mesh *mesh, const char *name,
                           const float (*directions)[3], uint32_t count, uint32_t resolution,
                           struct kiln_error *error)
{
    struct making making = {.mesh = mesh,
                            .resolution = resolution,
                            .corners = malloc(mesh->vertex_count * sizeof(struct corner))};
    if (!making.corners)
        return kiln_error_no_memory(error, "%s", name);
    int64_t visits = 0;
    for (uint32_t k = 0; k < count && visits <= MOST_VISITS; k++) {
        find_axes(directions[k], making.axes);
        place_map(&making, size_of(mesh));
        project(&making);
        visits = 0;
        for (uint32_t i = 0; i < mesh->triangle_count; i++) {
            const uint32_t *t = mesh->triangles[i];
            const struct range range = range_of(
                &making, (const struct corner[3]){making.corners[t[0]], making.corners[t[1]],
                                                  making.corners[t[2]]});
            visits += (range.x1 - range.x0) * (range.y1 - range.y0);
        }
    }
    free(making.corners);
    return visits <= MOST_VISITS ||
           kiln_error_set(error, KILN_INVALID_INPUT,
                          "%s: the %u triangles of the mesh lie in %lld samples of a depth map "
                          "altogether; at most %d are allowed: lower the resolution",
                          name, mesh->triangle_count, (long long)visits, MOST_VISITS);
}

struct kiln_depth_maps *kiln_depth_maps_create(const struct kiln_mesh *mesh, const char *name,
                                               const float (*directions)[3], uint32_t count,
                                               uint32_t resolution, struct kiln_threads *threads,
                                               struct kiln_error *error)
{
    const size_t samples = (size_t)resolution * resolution;
    const double size = size_of(mesh);
    const size_t corner_bytes = mesh->vertex_count * sizeof(struct corner);
    struct kiln_depth_maps *maps = calloc(1, sizeof *maps);
    double(*normals)[3] = malloc(mesh->triangle_count * sizeof *normals);
    struct making making = {
        .mesh = mesh,
        .normals = (const double(*)[3])normals,
        .resolution = resolution,
        .corners = malloc(corner_bytes > samples ? corner_bytes : samples),
        .samples = malloc(samples * sizeof *making.samples),
    };
    if (maps) {
        maps->count = count;
        maps->resolution = resolution;
        maps->word_count = kiln_depth_maps_words(count, resolution);
        maps->words = malloc(maps->word_count * sizeof *maps->words);
    }
    if (maps && maps->words && normals && making.corners && making.samples) {
        find_normals(mesh, normals);
        make(maps, &making, directions, size, threads);
    } else {
        kiln_error_no_memory(error, "%s", name);
        kiln_depth_maps_destroy(&maps);
    }
    free(normals);
    free(making.corners);
    free(making.samples);
    return maps;
}

void kiln_depth_maps_destroy(struct kiln_depth_maps **maps)
{
    if (!*maps)
        return;
    free((*maps)->words);
    free(*maps);
    *maps = NULL;
}
