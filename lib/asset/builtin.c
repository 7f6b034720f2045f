/* Flames and smoke are noise pushed about by noise (domain warping), cut by a threshold that rises
 * with age, so that a sprite breaks up into shreds instead of fading (erosion). A cell is sampled
 * on [-1, 1]^2, y up; t runs from 0 at birth to 1 at death. */
#include "asset/builtin.h"

#include "base/vector.h"
#include "shared/noise.h"

#include <math.h>
#include <string.h>

struct texel {
    float height; /* of the lit surface, in half edges of the cell: its slope becomes the normal */
    float heat, density;
};

static float mix(float a, float b, float t)
{
    return a + (b - a) * t;
}

static float saturate(float x)
{
    return x < 0.0f ? 0.0f : x > 1.0f ? 1.0f : x;
}

static float smooth_step(float from, float to, float x)
{
    float t = saturate((x - from) / (to - from));
    return t * t * (3.0f - 2.0f * t);
}

/* Gradient noise with lattice points one unit apart, within about -1 and 1. */
KILN_WIDE_VECTORS
static float noise(float x, float y, float z, uint32_t seed)
{
    enum { CORNERS = 8 };
    float3 p = {x, y, z};
    float3 cell = {floorf(x), floorf(y), floorf(z)};
    float3 f = float3_sub(p, cell);
    float wx[2], wy[2], wz[2];
    wx[1] = noise_fade_at(f.x).weight;
    wy[1] = noise_fade_at(f.y).weight;
    wz[1] = noise_fade_at(f.z).weight;
    wx[0] = 1.0f - wx[1];
    wy[0] = 1.0f - wy[1];
    wz[0] = 1.0f - wz[1];
    /* All corners at once: tables instead of branches, so that the loop becomes vectors. */
    static const uint32_t I[CORNERS] = {0, 1, 0, 1, 0, 1, 0, 1};
    static const uint32_t J[CORNERS] = {0, 0, 1, 1, 0, 0, 1, 1};
    static const uint32_t K[CORNERS] = {0, 0, 0, 0, 1, 1, 1, 1};
    uint32_t cx = (uint32_t)(int)cell.x, cy = (uint32_t)(int)cell.y, cz = (uint32_t)(int)cell.z;
    float parts[CORNERS];
#pragma GCC unroll 1
    for (int c = 0; c < CORNERS; c++) {
        float i = (float)(int)I[c], j = (float)(int)J[c], k = (float)(int)K[c];
        uint32_t at = (cx + I[c]) * NOISE_X ^ (cy + J[c]) * NOISE_Y ^ (cz + K[c]) * NOISE_Z ^ seed;
        float3 gradient = noise_gradient(random_mix(at));
        float3 away = {f.x - i, f.y - j, f.z - k};
        /* Exact, since i, j and k are 0 or 1. */
        float weight = ((1.0f - i) * wx[0] + i * wx[1]) * ((1.0f - j) * wy[0] + j * wy[1]) *
                       ((1.0f - k) * wz[0] + k * wz[1]);
        parts[c] = weight * float3_dot(gradient, away);
    }
    float sum = 0.0f;
    for (int corner = 0; corner < CORNERS; corner++)
        sum += parts[corner];
    return 0.32f * sum;
}

/* Octaves of noise, the third coordinate (time) growing more slowly: small detail must not boil. */
static float octaves(float x, float y, float z, int count, uint32_t seed)
{
    float sum = 0.0f, total = 0.0f, amplitude = 1.0f;
    for (int i = 0; i < count; i++) {
        sum += amplitude * noise(x, y, z, seed + (uint32_t)i);
        total += amplitude;
        amplitude *= 0.5f;
        x = 2.03f * x + 1.7f;
        y = 2.03f * y - 3.1f;
        z = 1.6f * z + 0.7f;
    }
    return sum / total;
}

/* Octaves of ridges: bright sheets where the noise crosses zero. */
static float ridges(float x, float y, float z, int count, uint32_t seed)
{
    float sum = 0.0f, total = 0.0f, amplitude = 1.0f;
    for (int i = 0; i < count; i++) {
        float ridge = saturate(1.0f - 1.9f * fabsf(noise(x, y, z, seed + (uint32_t)i)));
        sum += amplitude * ridge * ridge;
        total += amplitude;
        amplitude *= 0.55f;
        x = 2.07f * x + 1.7f;
        y = 2.07f * y - 3.1f;
        z = 1.5f * z + 0.7f;
    }
    return sum / total;
}

enum { LOBES = 22 };

/* A heap of drifting spheres. */
struct lobes {
    float x[LOBES], y[LOBES], size[LOBES];
};

static void place_lobes(struct lobes *lobes, float t)
{
    for (uint32_t i = 0; i < LOBES; i++) {
        uint stream = random_stream(0x10be5u, i);
        float drift = 1.6f * (random_unit(stream, 3) - 0.5f) * t;
        struct exact_angle angle = exact_sincos(EXACT_TWO_PI * random_unit(stream, 0) + drift);
        float away = 0.56f * exact_sqrt(random_unit(stream, 1)) * (0.85f + 0.25f * t);
        float size = 0.20f + 0.26f * random_unit(stream, 2) * random_unit(stream, 4);
        lobes->x[i] = away * angle.cosine;
        lobes->y[i] = away * angle.sine;
        lobes->size[i] = size * (0.9f + 0.35f * t);
    }
    lobes->x[0] = lobes->y[0] = 0.0f; /* the one in the middle */
    lobes->size[0] = 0.55f;
}

/* A rolling ball of fire that tears into sheets. */
static struct texel fire_texel(const struct lobes *lobes, float u, float v, float t)
{
    (void)lobes;
    float radius = sqrtf(u * u + v * v);
    float z = 1.6f * t;
    float push = 0.55f + 0.35f * t;
    float x = u + push * octaves(1.3f * u + 5.0f, 1.3f * v, z, 3, 11);
    float y = v + push * octaves(1.3f * u, 1.3f * v + 9.0f, z, 3, 23);
    float fine_x = octaves(2.8f * x, 2.8f * y, 1.7f * z + 3.0f, 3, 31);
    float fine_y = octaves(2.8f * x, 2.8f * y, 1.7f * z + 7.0f, 3, 37);
    x += 0.22f * fine_x;
    y += 0.22f * fine_y;

    float body = 1.0f - sqrtf(x * x + y * y) / 0.86f;
    float sheets = ridges(1.7f * x, 1.7f * y, z, 5, 41);
    float threshold = mix(0.05f, 0.92f, 0.55f * t * t + 0.45f * t);
    float excess = 1.15f * body + sheets - 0.45f - threshold;
    float inside_cell = smooth_step(0.96f, 0.72f, radius);
    return (struct texel){
        .height = 0.0f,
        .heat = saturate(1.15f * excess) * saturate(0.35f + 0.9f * sheets),
        .density = smooth_step(0.0f, 0.22f, excess) * inside_cell * mix(1.0f, 0.75f, t),
    };
}

/* The heap seen from the front; a power mean joins the domes. */
static float lobes_height(const struct lobes *lobes, float x, float y)
{
    float sum = 0.0f;
    for (uint32_t i = 0; i < LOBES; i++) {
        float dx = x - lobes->x[i], dy = y - lobes->y[i];
        float squared = lobes->size[i] * lobes->size[i] - (dx * dx + dy * dy);
        float dome = squared > 0.0f ? 2.25f * squared : 0.0f; /* the square of its height */
        sum += dome * dome;
    }
    return sqrtf(sqrtf(sum));
}

static struct texel smoke_texel(const struct lobes *lobes, float u, float v, float t)
{
    float radius = sqrtf(u * u + v * v);
    u *= 0.78f; /* the heap fills the cell */
    v *= 0.78f;
    float z = 1.2f * t;
    float push = 0.22f + 0.18f * t;
    float x = u + push * octaves(1.5f * u + 5.0f, 1.5f * v, z, 4, 61);
    float y = v + push * octaves(1.5f * u, 1.5f * v + 9.0f, z, 4, 67);
    float height = lobes_height(lobes, x, y);
    float fine = octaves(4.5f * x, 4.5f * y, 1.5f * z, 4, 83);
    float coarse = octaves(2.0f * x + 3.0f, 2.0f * y, 1.2f * z, 3, 89);
    height += 0.10f * fine * saturate(3.0f * height);
    float excess =
        height - mix(0.05f, 0.16f, t) + 0.30f * coarse * mix(0.5f, 1.1f, t) + 0.12f * fine;
    float inside_cell = smooth_step(0.96f, 0.72f, radius);
    return (struct texel){
        .height = height,
        .heat = saturate(excess),
        .density = smooth_step(0.0f, 0.55f, excess) * inside_cell,
    };
}

/* A glowing grain: a hot point with a faint halo, the same at any age. */
static struct texel spark_texel(const struct lobes *lobes, float u, float v, float t)
{
    (void)lobes;
    (void)t;
    float r2 = u * u + v * v;
    float core = saturate(1.0f - r2 / 0.16f);
    float halo = saturate(1.0f - r2 / 0.92f);
    return (struct texel){.heat = core,
                          .density = 0.75f * core * core + 0.25f * halo * halo * halo};
}

static const struct builtin {
    const char *name;
    struct texel (*texel)(const struct lobes *lobes, float u, float v, float t);
    float relief; /* how much the height tilts the normal */
} BUILTINS[] = {
    {"fire", fire_texel, 0.0f},
    {"smoke", smoke_texel, 14.0f},
    {"spark", spark_texel, 0.0f},
};

enum { BUILTIN_COUNT = sizeof BUILTINS / sizeof *BUILTINS };

static const struct builtin *find(const char *name)
{
    for (size_t i = 0; i < BUILTIN_COUNT; i++) {
        if (strcmp(BUILTINS[i].name, name) == 0)
            return &BUILTINS[i];
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
    return index < BUILTIN_COUNT ? BUILTINS[index].name : NULL;
}

struct generation {
    const struct builtin *builtin;
    uint32_t edge;
    float *cells;
};

/* First the height in the place of the normal's x; then its slope. */
static void generate_cell(const struct generation *job, size_t cell)
{
    uint32_t edge = job->edge;
    float *pixels = job->cells + cell * edge * edge * 4;
    float t = (float)cell / (float)(KILN_BUILTIN_CELLS - 1);
    float texel_size = 2.0f / (float)edge;
    struct lobes lobes;
    place_lobes(&lobes, t);
    for (uint32_t y = 0; y < edge; y++) {
        for (uint32_t x = 0; x < edge; x++) {
            float u = ((float)x + 0.5f) * texel_size - 1.0f;
            float v = 1.0f - ((float)y + 0.5f) * texel_size;
            struct texel texel = job->builtin->texel(&lobes, u, v, t);
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

void kiln_builtin_generate(const char *name, uint32_t edge, float *cells,
                           struct kiln_threads *threads)
{
    struct generation job = {.builtin = find(name), .edge = edge, .cells = cells};
    if (job.builtin)
        kiln_threads_for(threads, KILN_BUILTIN_CELLS, 1, generate_cells, &job);
}
