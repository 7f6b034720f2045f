/* This file finds the procedural flipbooks by their names and makes their cells. For a flipbook of
 * gas it also makes the motion, in each texel, from a cell to the next one. atlas.c calls it while
 * a renderer is created, in several threads; the scene's reader looks up names.
 *
 * The flipbooks stand in two tables, gases and solids. Each width of vectors has a copy of both,
 * with the same names in the same order, so a look-up of a name may use any of them. */
#include "asset/atlas/builtin.h"

#include <stdlib.h>
#include <string.h>

#include "asset/atlas/texel_cell.h"
#include "shared/random.h"

static const struct builtin *at_index(size_t index, enum kiln_simd simd)
{
    const struct builtin *const tables[] = {KILN_SIMD_PICK(kiln_builtin_gases, simd)->builtins,
                                            KILN_SIMD_PICK(kiln_builtin_solids, simd)->builtins};
    for (size_t table = 0; table < 2; table++) {
        for (const struct builtin *row = tables[table]; row->name; row++) {
            if (index-- == 0)
                return row;
        }
    }
    return NULL;
}

static const struct builtin *find(const char *name, enum kiln_simd simd)
{
    const struct builtin *builtin;
    for (size_t i = 0; (builtin = at_index(i, simd)); i++) {
        if (strcmp(builtin->name, name) == 0)
            return builtin;
    }
    return NULL;
}

const char *kiln_builtin_name_of(const char *source)
{
    static const char prefix[] = "builtin:";
    const size_t length = sizeof prefix - 1;
    return strncmp(source, prefix, length) == 0 ? source + length : NULL;
}

bool kiln_builtin_exists(const char *name)
{
    return find(name, kiln_simd_narrowest()) != NULL;
}

bool kiln_builtin_has_motion(const char *name)
{
    const struct builtin *found = find(name, kiln_simd_narrowest());
    return found && found->gas;
}

const char *kiln_builtin_name_at(size_t index)
{
    const struct builtin *builtin = at_index(index, kiln_simd_narrowest());
    return builtin ? builtin->name : NULL;
}

bool kiln_builtin_open(struct kiln_builtin *builtin, const char *name, uint32_t cell_count,
                       enum kiln_simd simd)
{
    *builtin = (struct kiln_builtin){.name = name, .cell_count = cell_count, .simd = simd};
    const struct builtin *found = find(name, simd);
    if (found && found->gas)
        builtin->film = kiln_film_create(found->gas, KILN_SIMD_PICK(kiln_fluid, simd), cell_count);
    return found && (builtin->film || !found->gas);
}

uint64_t kiln_builtin_bytes(const char *name, uint32_t cell_count)
{
    return kiln_builtin_has_motion(name) ? kiln_film_bytes(cell_count) : 0;
}

void kiln_builtin_close(struct kiln_builtin *builtin)
{
    free(builtin->film);
    *builtin = (struct kiln_builtin){0};
}

struct kiln_builtin_scratch *kiln_builtin_scratch_create(void)
{
    return malloc(sizeof(struct kiln_builtin_scratch));
}

/* Returns one of the spheres that smoke consists of. Its place is random, but the same in each run.
 * Lengths are in half edges of the cell. The draws keep their numbers, of which 3 is not used,
 * since others would change the pictures. */
static struct texel_lobe lobe_at(uint32_t index)
{
    uint stream = random_stream(0x10be5u, index);
    struct exact_angle angle = exact_sincos(EXACT_TWO_PI * random_unit(stream, 0));
    float away = 0.50f * exact_sqrt(random_unit(stream, 1));
    if (index == 0) /* the large sphere in the middle */
        return (struct texel_lobe){0.0f, 0.0f, 0.52f};
    return (struct texel_lobe){away * angle.cosine, away * angle.sine,
                               0.18f + 0.26f * random_unit(stream, 2) * random_unit(stream, 4)};
}

void kiln_builtin_cell(const struct kiln_builtin *builtin, uint32_t cell, uint32_t edge,
                       struct kiln_builtin_scratch *scratch, float *pixels)
{
    const uint32_t gaps = builtin->cell_count > 1 ? builtin->cell_count - 1 : 1;
    const struct kiln_film_cell *filmed = builtin->film ? &builtin->film->cells[cell] : NULL;
    struct texel_lobe lobes[TEXEL_LOBES];
    for (uint32_t i = 0; i < TEXEL_LOBES; i++)
        lobes[i] = lobe_at(i);
    const struct texel_job job = {
        .builtin = find(builtin->name, builtin->simd),
        .gas = filmed,
        .lobes = lobes,
        .time = filmed ? filmed->time : (float)cell / (float)gaps,
        .edge = edge,
    };
    KILN_SIMD_PICK(kiln_texel, builtin->simd)->make_cell(&job, scratch, pixels);
}

void kiln_builtin_motion(const struct kiln_builtin *builtin, uint32_t cell, uint32_t edge,
                         struct kiln_builtin_scratch *scratch, float *motion)
{
    const struct kiln_film_cell *filmed = &builtin->film->cells[cell];
    const struct kiln_fluid_code *fluid = KILN_SIMD_PICK(kiln_fluid, builtin->simd);
    fluid->sample(filmed->motion_x, edge, &scratch->fluid, scratch->x);
    fluid->sample(filmed->motion_y, edge, &scratch->fluid, scratch->y);
    for (uint32_t i = 0; i < edge * edge; i++) { /* half edges of the cell become edges */
        motion[2 * (size_t)i] = 0.5f * scratch->x[i];
        motion[2 * (size_t)i + 1] = 0.5f * scratch->y[i];
    }
}
