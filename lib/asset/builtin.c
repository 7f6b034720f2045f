/* The procedural flipbooks: their names, and from texels to cells. */
#include "asset/builtin.h"

#include "asset/texel.h"

#include <math.h>
#include <string.h>

static const struct builtin *at_index(size_t index)
{
    for (const struct builtin *gas = kiln_builtin_gases; gas->name; gas++) {
        if (index-- == 0)
            return gas;
    }
    for (const struct builtin *solid = kiln_builtin_solids; solid->name; solid++) {
        if (index-- == 0)
            return solid;
    }
    return NULL;
}

static const struct builtin *find(const char *name)
{
    const struct builtin *builtin;
    for (size_t i = 0; (builtin = at_index(i)); i++) {
        if (strcmp(builtin->name, name) == 0)
            return builtin;
    }
    return NULL;
}

const char *kiln_builtin_of(const char *source)
{
    static const char prefix[] = "builtin:";
    const size_t length = sizeof prefix - 1;
    return strncmp(source, prefix, length) == 0 ? source + length : NULL;
}

bool kiln_builtin_exists(const char *name)
{
    return find(name) != NULL;
}

const char *kiln_builtin_name(size_t index)
{
    const struct builtin *builtin = at_index(index);
    return builtin ? builtin->name : NULL;
}

bool kiln_builtin_film(const char *name, uint32_t cell_count, struct kiln_film **film)
{
    const struct builtin *builtin = find(name);
    *film = builtin && builtin->gas ? kiln_film_create(builtin->gas, cell_count) : NULL;
    return *film || !builtin || !builtin->gas;
}

struct generation {
    const struct builtin *builtin;
    const struct kiln_film *film; /* NULL: nothing flows */
    uint32_t cell_count, edge;
    float *cells;
};

/* A cell's time and gas. */
static struct texel_site site_at(const struct generation *job, size_t cell, float u, float v)
{
    uint32_t gaps = job->cell_count > 1 ? job->cell_count - 1 : 1;
    struct texel_site site = {.u = u, .v = v, .time = (float)cell / (float)gaps};
    if (job->film) {
        const struct kiln_film_cell *gas = &job->film->cells[cell];
        site.time = gas->time;
        site.heat = kiln_fluid_sample(gas->heat, u, v);
        float weight = kiln_fluid_sample(gas->weight, u, v);
        site.place_x = kiln_fluid_sample(gas->place_x, u, v) / weight;
        site.place_y = kiln_fluid_sample(gas->place_y, u, v) / weight;
    }
    return site;
}

/* First the height in the place of the normal's x; then its slope. */
static void generate_cell(const struct generation *job, size_t cell)
{
    uint32_t edge = job->edge;
    float *pixels = job->cells + cell * edge * edge * 4;
    float texel_size = 2.0f / (float)edge;
    struct texel_lobe lobes[TEXEL_LOBES];
    kiln_texel_lobes(lobes);
    for (uint32_t y = 0; y < edge; y++) {
        for (uint32_t x = 0; x < edge; x++) {
            float u = ((float)x + 0.5f) * texel_size - 1.0f;
            float v = 1.0f - ((float)y + 0.5f) * texel_size;
            struct texel_site site = site_at(job, cell, u, v);
            site.lobes = lobes;
            struct texel texel = job->builtin->texel(&site);
            float *pixel = pixels + ((size_t)y * edge + x) * 4;
            pixel[0] = texel.height;
            pixel[2] = texel.heat;
            pixel[3] = texel.density;
        }
    }
}

/* Normals from the height in channel 0: y first, since it needs the heights of other rows. */
static void tilt_cell(const struct generation *job, size_t cell)
{
    uint32_t edge = job->edge;
    float *pixels = job->cells + cell * edge * edge * 4;
    float scale = job->builtin->relief;
#define HEIGHT(x, y) pixels[((size_t)(y)*edge + (x)) * 4]
    for (uint32_t y = 0; y < edge; y++) {
        for (uint32_t x = 0; x < edge; x++) {
            uint32_t above = y > 0 ? y - 1 : y, below = y < edge - 1 ? y + 1 : y;
            pixels[((size_t)y * edge + x) * 4 + 1] = scale * (HEIGHT(x, below) - HEIGHT(x, above));
        }
    }
    for (uint32_t y = 0; y < edge; y++) {
        float left = HEIGHT(0, y);
        for (uint32_t x = 0; x < edge; x++) {
            float *pixel = pixels + ((size_t)y * edge + x) * 4;
            float right = HEIGHT(x < edge - 1 ? x + 1 : x, y);
            float slope_x = scale * (left - right), slope_y = pixel[1];
            left = pixel[0];
            float shorten = 1.0f / sqrtf(1.0f + slope_x * slope_x + slope_y * slope_y);
            pixel[0] = slope_x * shorten;
            pixel[1] = slope_y * shorten;
        }
    }
#undef HEIGHT
}

static void generate_cells(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    for (size_t cell = begin; cell < end; cell++) {
        generate_cell(context, cell);
        tilt_cell(context, cell);
    }
}

void kiln_builtin_generate(const char *name, uint32_t cell_count, uint32_t edge,
                           const struct kiln_film *film, float *cells, struct kiln_threads *threads)
{
    struct generation job = {.builtin = find(name),
                             .film = film,
                             .cell_count = cell_count,
                             .edge = edge,
                             .cells = cells};
    if (job.builtin)
        kiln_threads_for(threads, cell_count, 1, generate_cells, &job);
}

void kiln_builtin_motion(const struct kiln_film *film, uint32_t edge, float *motion)
{
    const float texel_size = 2.0f / (float)edge;
    for (uint32_t cell = 0; cell < film->cell_count; cell++) {
        const struct kiln_film_cell *gas = &film->cells[cell];
        for (uint32_t i = 0; i < edge * edge; i++, motion += 2) {
            float u = ((float)(i % edge) + 0.5f) * texel_size - 1.0f;
            float v = 1.0f - ((float)(i / edge) + 0.5f) * texel_size;
            motion[0] = 0.5f * kiln_fluid_sample(gas->motion_x, u, v);
            motion[1] = 0.5f * kiln_fluid_sample(gas->motion_y, u, v);
        }
    }
}
