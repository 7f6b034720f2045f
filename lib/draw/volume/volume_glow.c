/* This file solves for the light of flames in smoke by V-cycles of multigrid, always from darkness,
 * so that a frame does not depend on the frames before it. The level of solution that is needed is
 * low: three cycles leave errors below what is seen. */
#include "draw/volume/volume_glow.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/pages.h"

enum {
    ARRAYS = 5, /* of a level */
    CYCLES = 3,
    SWEEPS = 2,           /* before, and after, a coarser level */
    COARSEST_SWEEPS = 16, /* on the coarsest level; even */
    LEAST_EDGE = 4,       /* levels are halved down to this number of cells */
    GRAIN = 2,
};

/* Numbers chosen by eye: the part of the light of flames that smoke scatters, the way in clear air,
 * in parts of D, after which 1/e of the light is left, and the part of the light that smoke
 * swallows. */
#define GLOW_STRENGTH 0.4f
#define CLEAR_WAY     5.2f
#define SWALLOWED     0.2f

/* ---- levels ---------------------------------------------------------------------------------- */

static ptrdiff_t row_of(struct kiln_gas_place cells)
{
    return (cells.x + GLOW_PAD - 1) / GLOW_PAD * GLOW_PAD + GLOW_PAD;
}

static size_t floats_of(struct kiln_gas_place cells)
{
    return (size_t)row_of(cells) * (size_t)(cells.y + 2) * (size_t)(cells.z + 2) +
           (size_t)2 * GLOW_PAD;
}

static struct kiln_gas_place halved(struct kiln_gas_place n)
{
    return (struct kiln_gas_place){(n.x + 1) / 2, (n.y + 1) / 2, (n.z + 1) / 2};
}

static bool is_coarsest(struct kiln_gas_place n)
{
    return n.x <= LEAST_EDGE || n.y <= LEAST_EDGE || n.z <= LEAST_EDGE;
}

/* Returns the floats of all levels below a window, and writes the cells of each. */
static size_t plan_levels(struct kiln_gas_place window, struct kiln_gas_place cells[GLOW_LEVELS],
                          uint32_t *count)
{
    size_t floats = 0;
    struct kiln_gas_place n = halved(window);
    *count = 0;
    do {
        cells[(*count)++] = n;
        floats += ARRAYS * floats_of(n);
        if (is_coarsest(n))
            break;
        n = halved(n);
    } while (*count < GLOW_LEVELS);
    return floats;
}

uint64_t kiln_volume_glow_bytes(struct kiln_gas_place cells)
{
    struct kiln_gas_place levels[GLOW_LEVELS];
    uint32_t count;
    return plan_levels(cells, levels, &count) * sizeof(float);
}

void kiln_volume_glow_finish(struct kiln_volume_glow *glow)
{
    free(glow->floats);
    free(glow->sums);
    *glow = (struct kiln_volume_glow){.level_count = 0};
}

static bool make_levels(struct kiln_volume_glow *glow, struct kiln_gas_place window,
                        struct kiln_error *error)
{
    struct kiln_gas_place cells[GLOW_LEVELS];
    const size_t all = plan_levels(window, cells, &glow->level_count);
    if (all > glow->room || (size_t)window.z > glow->sum_room) {
        free(glow->floats);
        free(glow->sums);
        glow->floats = kiln_alloc_pages(all * sizeof *glow->floats);
        glow->sums = malloc((size_t)window.z * 4 * sizeof *glow->sums);
        glow->room = glow->floats ? all : 0;
        glow->sum_room = glow->sums ? (size_t)window.z : 0;
    }
    if (!glow->floats || !glow->sums)
        return kiln_error_no_memory(error, "the light of flames");
    memset(glow->floats, 0, all * sizeof *glow->floats);
    float *next = glow->floats;
    for (uint32_t i = 0; i < glow->level_count; i++) {
        const ptrdiff_t row = row_of(cells[i]), plane = row * (cells[i].y + 2);
        struct kiln_glow_level *level = &glow->levels[i];
        *level = (struct kiln_glow_level){.cells = cells[i], .row = row, .plane = plane};
        float **const arrays[ARRAYS] = {&level->light, &level->next, &level->source,
                                        &level->diagonal, &level->inverse};
        for (int k = 0; k < ARRAYS; k++, next += floats_of(cells[i]))
            *arrays[k] = next + GLOW_PAD + row + plane;
    }
    return true;
}

/* ---- equations ------------------------------------------------------------------------------- */

/* Returns the diagonal of a cell that swallows no light. Beyond an open side, light falls off as
 * that of a source in the middle of the window; a closed side reflects it. */
static float clear_diagonal(const struct kiln_glow_level *l, const bool closed[6], int32_t x,
                            int32_t y, int32_t z)
{
    const int32_t at[3] = {x, y, z}, count[3] = {l->cells.x, l->cells.y, l->cells.z};
    float diagonal = 6.0f;
    for (size_t i = 0; i < 3; i++) {
        const float open = count[i] > 2 ? 1.0f - 2.0f / (float)count[i] : 0.0f;
        if (at[i] == 0)
            diagonal -= closed[2 * i] ? 1.0f : open;
        if (at[i] == count[i] - 1)
            diagonal -= closed[2 * i + 1] ? 1.0f : open;
    }
    return diagonal;
}

struct glow_job {
    struct kiln_volume_glow *glow;
    const struct kiln_volume_field *field;
    const struct kiln_volume_fire *fire;
    const struct kiln_volume_glow_rows *rows;
    struct kiln_glow_level *level, *coarse;
};

/* Sums up the smoke and the light of the flames in two cells along each axis. */
static float gather_cell(const struct glow_job *job, int32_t x, int32_t y, int32_t z,
                         double sums[4], float *emitted)
{
    const struct kiln_gas *gas = job->field->gas;
    const size_t number = kiln_gas_brick_index(gas, x / 4, y / 4, z / 4);
    const float *cells = gas->brick[number].now;
    float smoke = 0.0f;
    *emitted = 0.0f;
    if (!cells)
        return 0.0f;
    for (int k = 0; k < 8; k++) {
        const int32_t cx = 2 * (x % 4) + (k & 1), cy = 2 * (y % 4) + (k >> 1 & 1);
        const int32_t cz = 2 * (z % 4) + (k >> 2);
        const float *cell =
            cells + (ptrdiff_t)((cz * GAS_BRICK + cy) * GAS_BRICK + cx) * GAS_CARRIED;
        smoke += cell[GAS_SMOKE];
        if (!(cell[GAS_FLAME] > 0.0f))
            continue;
        const float4 light = kiln_flame_color_near(job->fire->colors, cell[GAS_TEMPERATURE]);
        *emitted += cell[GAS_FLAME] * light.w;
        sums[0] += (double)(cell[GAS_FLAME] * light.x);
        sums[1] += (double)(cell[GAS_FLAME] * light.y);
        sums[2] += (double)(cell[GAS_FLAME] * light.z);
        sums[3] += (double)(cell[GAS_FLAME] * light.w);
    }
    *emitted *= 0.125f;
    return 0.125f * smoke;
}

static void make_finest(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct glow_job *job = context;
    const struct kiln_volume_fire *fire = job->fire;
    struct kiln_glow_level *l = job->level;
    const float edge_m = 2.0f * fire->cell_m, part = edge_m / fire->reach_m;
    const float gain = edge_m * part, air = part * part / (CLEAR_WAY * CLEAR_WAY);
    for (int32_t z = (int32_t)begin; z < (int32_t)end; z++) {
        double *sums = job->glow->sums + 4 * (size_t)z;
        memset(sums, 0, 4 * sizeof *sums);
        for (int32_t y = 0; y < l->cells.y; y++)
            for (int32_t x = 0; x < l->cells.x; x++) {
                const ptrdiff_t at = z * l->plane + y * l->row + x;
                float emitted;
                const float depth =
                    2.0f * fire->thickness * gather_cell(job, x, y, z, sums, &emitted);
                const float diagonal = clear_diagonal(l, fire->closed, x, y, z) + air +
                                       (3.0f * depth + SWALLOWED * part) * depth;
                l->source[at] = gain * emitted;
                l->diagonal[at] = diagonal;
                l->inverse[at] = 1.0f / diagonal;
            }
    }
}

/* Calls a function with each of the finer cells of a coarse one that exist. */
#define EACH_FINE(fine, X, Y, Z, x, y, z)                                                          \
    for (int32_t z = 2 * (Z); z < 2 * (Z) + 2 && z < (fine)->cells.z; z++)                         \
        for (int32_t y = 2 * (Y); y < 2 * (Y) + 2 && y < (fine)->cells.y; y++)                     \
            for (int32_t x = 2 * (X); x < 2 * (X) + 2 && x < (fine)->cells.x; x++)

static void make_coarse(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct glow_job *job = context;
    const struct kiln_glow_level *f = job->level;
    struct kiln_glow_level *c = job->coarse;
    const bool *closed = job->fire->closed;
    for (int32_t Z = (int32_t)begin; Z < (int32_t)end; Z++)
        for (int32_t Y = 0; Y < c->cells.y; Y++)
            for (int32_t X = 0; X < c->cells.x; X++) {
                const ptrdiff_t at = Z * c->plane + Y * c->row + X;
                float swallowed = 0.0f, count = 0.0f;
                EACH_FINE(f, X, Y, Z, x, y, z)
                {
                    swallowed += f->diagonal[z * f->plane + y * f->row + x] -
                                 clear_diagonal(f, closed, x, y, z);
                    count += 1.0f;
                }
                c->diagonal[at] = clear_diagonal(c, closed, X, Y, Z) + 4.0f * swallowed / count;
                c->inverse[at] = 1.0f / c->diagonal[at];
            }
}

/* ---- cycles ---------------------------------------------------------------------------------- */

static void relax(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct glow_job *job = context;
    job->rows->relax(job->level, (int32_t)begin, (int32_t)end);
}

static void find_residual(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct glow_job *job = context;
    job->rows->find_residual(job->level, (int32_t)begin, (int32_t)end);
}

/* Four times the mean of the residual of the finer cells is the coarse equation's source, since the
 * square of a cell's edge is four times as large there. */
static void restrict_residual(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct glow_job *job = context;
    const struct kiln_glow_level *f = job->level;
    struct kiln_glow_level *c = job->coarse;
    for (int32_t Z = (int32_t)begin; Z < (int32_t)end; Z++)
        for (int32_t Y = 0; Y < c->cells.y; Y++)
            for (int32_t X = 0; X < c->cells.x; X++) {
                float sum = 0.0f;
                EACH_FINE(f, X, Y, Z, x, y, z)
                sum += f->next[z * f->plane + y * f->row + x];
                const ptrdiff_t at = Z * c->plane + Y * c->row + X;
                c->source[at] = 0.5f * sum;
                c->light[at] = 0.0f;
            }
}

/* Holds the two coarse cells around a finer one along an axis; the first one weighs 3/4. */
struct coarse_pair {
    int32_t near, other;
};

static struct coarse_pair pair_of(int32_t fine, int32_t count)
{
    const int32_t near = fine / 2, other = fine & 1 ? near + 1 : near - 1;
    return (struct coarse_pair){near, other < 0 || other >= count ? near : other};
}

/* Returns a level's light at a cell of a grid twice as fine. */
static float light_between(const struct kiln_glow_level *c, int32_t x, int32_t y, int32_t z)
{
    const struct coarse_pair px = pair_of(x, c->cells.x), py = pair_of(y, c->cells.y);
    const struct coarse_pair pz = pair_of(z, c->cells.z);
    const ptrdiff_t rows[4] = {
        pz.near * c->plane + py.near * c->row, pz.near * c->plane + py.other * c->row,
        pz.other * c->plane + py.near * c->row, pz.other * c->plane + py.other * c->row};
    static const float weights[4] = {0.5625f, 0.1875f, 0.1875f, 0.0625f};
    float sum = 0.0f;
    for (int i = 0; i < 4; i++)
        sum += weights[i] *
               (0.75f * c->light[rows[i] + px.near] + 0.25f * c->light[rows[i] + px.other]);
    return sum;
}

static void add_coarse(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct glow_job *job = context;
    struct kiln_glow_level *f = job->level;
    for (int32_t z = (int32_t)begin; z < (int32_t)end; z++)
        for (int32_t y = 0; y < f->cells.y; y++)
            for (int32_t x = 0; x < f->cells.x; x++)
                f->light[z * f->plane + y * f->row + x] += light_between(job->coarse, x, y, z);
}

static void sweep(struct glow_job *job, struct kiln_threads *threads, int count)
{
    for (int i = 0; i < count; i++) {
        kiln_threads_for(threads, (size_t)job->level->cells.z, GRAIN, relax, job);
        float *light = job->level->light;
        job->level->light = job->level->next;
        job->level->next = light;
    }
}

static void run_cycle(struct glow_job *job, struct kiln_threads *threads)
{
    struct kiln_glow_level *levels = job->glow->levels;
    const uint32_t last = job->glow->level_count - 1;
    for (uint32_t i = 0; i < last; i++) {
        job->level = &levels[i];
        job->coarse = &levels[i + 1];
        sweep(job, threads, SWEEPS);
        kiln_threads_for(threads, (size_t)levels[i].cells.z, GRAIN, find_residual, job);
        kiln_threads_for(threads, (size_t)levels[i + 1].cells.z, GRAIN, restrict_residual, job);
    }
    job->level = &levels[last];
    sweep(job, threads, COARSEST_SWEEPS);
    for (uint32_t i = last; i-- > 0;) {
        job->level = &levels[i];
        job->coarse = &levels[i + 1];
        kiln_threads_for(threads, (size_t)levels[i].cells.z, GRAIN, add_coarse, job);
        sweep(job, threads, SWEEPS);
    }
}

/* Sums up the colour of all flames. Returns false if there are none. */
static bool find_color(struct kiln_volume_glow *glow)
{
    double sums[4] = {0.0, 0.0, 0.0, 0.0};
    for (int32_t z = 0; z < glow->levels[0].cells.z; z++)
        for (int i = 0; i < 4; i++)
            sums[i] += glow->sums[4 * (size_t)z + (size_t)i];
    if (!(sums[3] > 0.0))
        return false;
    for (int i = 0; i < 3; i++)
        glow->color[i] = (float)(sums[i] / sums[3]);
    return true;
}

bool kiln_volume_glow_run(struct kiln_volume_glow *glow, const struct kiln_volume_field *field,
                          const struct kiln_volume_fire *fire,
                          const struct kiln_volume_glow_rows *rows, struct kiln_threads *threads,
                          bool *lit, struct kiln_error *error)
{
    *lit = false;
    if (!make_levels(glow, field->cells, error))
        return false;
    struct glow_job job = {.glow = glow, .field = field, .fire = fire, .rows = rows};
    job.level = &glow->levels[0];
    kiln_threads_for(threads, (size_t)job.level->cells.z, GRAIN, make_finest, &job);
    if (!find_color(glow))
        return true;
    for (uint32_t i = 1; i < glow->level_count; i++) {
        job.level = &glow->levels[i - 1];
        job.coarse = &glow->levels[i];
        kiln_threads_for(threads, (size_t)job.coarse->cells.z, GRAIN, make_coarse, &job);
    }
    for (int i = 0; i < CYCLES; i++)
        run_cycle(&job, threads);
    *lit = true;
    return true;
}

float kiln_volume_glow_at(const struct kiln_volume_glow *glow, int32_t x, int32_t y, int32_t z)
{
    return GLOW_STRENGTH * light_between(&glow->levels[0], x, y, z);
}
