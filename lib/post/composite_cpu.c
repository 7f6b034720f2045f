/* What shaders/post/composite.frag says of a pixel, for blocks of a row at a time: composed pixel
 * by pixel, then channel by channel, which gcc makes into vectors.
 */
#include "post/composite_cpu.h"

#include "base/error.h"
#include "base/vector.h"
#include "post/magnify.h"
#include "post/tonemap.h"

#include <stdlib.h>
#include <string.h>

enum { BLOCK = 128, ROWS_AT_A_TIME = 8 };

static const float HALF_MAX = 65504.0f;

struct kiln_composite_cpu {
    const struct kiln_scene *scene;
    struct kiln_threads *threads;
    uint32_t bits;
    void *display; /* four channels of bits a pixel */
    float *beauty; /* NULL unless asked for */
    struct kiln_magnifier magnifier;
};

struct kiln_composite_cpu *kiln_composite_cpu_create(const struct kiln_scene *scene,
                                                     const struct kiln_composite_params *params,
                                                     struct kiln_error *error)
{
    struct kiln_composite_cpu *stage = calloc(1, sizeof *stage);
    size_t pixels = (size_t)scene->width * scene->height;
    if (stage) {
        *stage = (struct kiln_composite_cpu){
            .scene = scene, .threads = params->threads, .bits = params->bits};
        stage->display = malloc(pixels * 4 * (params->bits / 8));
        stage->beauty = params->beauty ? malloc(pixels * 4 * sizeof(float)) : NULL;
    }
    if (!stage || !stage->display || (params->beauty && !stage->beauty)) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "composite: out of memory");
        kiln_composite_cpu_destroy(&stage);
    }
    return stage;
}

void kiln_composite_cpu_destroy(struct kiln_composite_cpu **stage)
{
    if (!*stage)
        return;
    kiln_magnifier_finish(&(*stage)->magnifier);
    free((*stage)->display);
    free((*stage)->beauty);
    free(*stage);
    *stage = NULL;
}

/* ---- a block of a row ------------------------------------------------------------------------ */

struct block {
    float red[BLOCK], green[BLOCK], blue[BLOCK], alpha[BLOCK];
    float noise[3][BLOCK]; /* of the dither, in levels */
    int32_t words[4][BLOCK];
};

/* What the whole picture shares. */
struct picture {
    struct kiln_composite_cpu *stage;
    struct kiln_compose_light light;
    const float *glow; /* NULL: none */
    float strength, exposure, levels;
    enum kiln_tonemap tonemap;
    bool dither;
    uint32_t frame_hash;
};

static inline uint32_t hash(uint32_t x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return x;
}

/* Triangular noise of one level, different for each pixel, channel and frame, the same in each
 * run; half of it. */
static inline void make_noise(struct block *block, uint32_t first, uint32_t row_hash)
{
    for (uint32_t i = 0; i < BLOCK; i++) {
        uint32_t h = hash(first + i + row_hash);
        for (uint32_t c = 0; c < 3; c++) {
            h = hash(h + c);
            float sum = (float)(int32_t)(h & 0xffffu) + (float)(int32_t)(h >> 16);
            block->noise[c][i] = sum * (0.5f / 65535.0f) - 0.5f;
        }
    }
}

/* Light of the display's range; a NaN is black. */
static inline float exposed(float light, float exposure)
{
    return exact_min(exact_max(light * exposure, 0.0f), HALF_MAX);
}

static inline void expose(struct block *block, float exposure)
{
    for (int i = 0; i < BLOCK; i++) {
        block->red[i] = exposed(block->red[i], exposure);
        block->green[i] = exposed(block->green[i], exposure);
        block->blue[i] = exposed(block->blue[i], exposure);
    }
}

static inline void map_agx(struct block *block)
{
    for (int i = 0; i < BLOCK; i++) {
        float3 color = kiln_tonemap_agx(FLOAT3(block->red[i], block->green[i], block->blue[i]));
        block->red[i] = color.x;
        block->green[i] = color.y;
        block->blue[i] = color.z;
    }
}

static inline void map_aces(struct block *block)
{
    for (int i = 0; i < BLOCK; i++) {
        float3 color = kiln_tonemap_aces(FLOAT3(block->red[i], block->green[i], block->blue[i]));
        block->red[i] = color.x;
        block->green[i] = color.y;
        block->blue[i] = color.z;
    }
}

static inline void encode_channel(float *channel)
{
    for (int i = 0; i < BLOCK; i++)
        channel[i] = kiln_encode_srgb(exact_min(channel[i], 1.0f));
}

/* A file's alpha is not premultiplied. Light without cover (fire on nothing) has no such form: its
 * brightness becomes its cover, so that it still shows over black. */
static inline void straighten(struct block *block)
{
    for (int i = 0; i < BLOCK; i++) {
        float r = block->red[i], g = block->green[i], b = block->blue[i], a = block->alpha[i];
        bool opaque = !(a < 1.0f);
        float cover = exact_clamp(exact_max(a, exact_max(exact_max(r, g), b)), 0.0f, 1.0f);
        float whole = cover > 0.0f ? cover : 1.0f; /* where there is nothing, nothing is shown */
        whole = opaque ? 1.0f : whole;
        block->red[i] = exact_min(r / whole, 1.0f);
        block->green[i] = exact_min(g / whole, 1.0f);
        block->blue[i] = exact_min(b / whole, 1.0f);
        block->alpha[i] = opaque ? 1.0f : cover;
    }
}

static inline void round_channel(const float *channel, const float *noise, float levels,
                                 int32_t *words)
{
    for (int i = 0; i < BLOCK; i++) {
        float steps = channel[i] * levels + 0.5f + noise[i];
        words[i] = (int32_t)exact_clamp(steps, 0.0f, levels);
    }
}

static inline void encode_block(const struct picture *p, struct block *block, uint32_t first,
                                uint32_t row_hash)
{
    static const float no_noise[BLOCK];
    expose(block, p->exposure);
    if (p->tonemap == KILN_TONEMAP_AGX)
        map_agx(block);
    else if (p->tonemap == KILN_TONEMAP_ACES)
        map_aces(block);
    encode_channel(block->red);
    encode_channel(block->green);
    encode_channel(block->blue);
    straighten(block);
    if (p->dither)
        make_noise(block, first, row_hash);
    round_channel(block->red, p->dither ? block->noise[0] : no_noise, p->levels, block->words[0]);
    round_channel(block->green, p->dither ? block->noise[1] : no_noise, p->levels, block->words[1]);
    round_channel(block->blue, p->dither ? block->noise[2] : no_noise, p->levels, block->words[2]);
    round_channel(block->alpha, no_noise, p->levels, block->words[3]);
}

static inline void store_bytes(const struct block *block, uint32_t count, uint8_t *out)
{
    for (uint32_t i = 0; i < count; i++) {
        for (int c = 0; c < 4; c++)
            out[4 * i + (uint32_t)c] = (uint8_t)block->words[c][i];
    }
}

static inline void store_shorts(const struct block *block, uint32_t count, uint16_t *out)
{
    for (uint32_t i = 0; i < count; i++) {
        for (int c = 0; c < 4; c++)
            out[4 * i + (uint32_t)c] = (uint16_t)block->words[c][i];
    }
}

/* ---- rows ------------------------------------------------------------------------------------ */

/* The light of a block, which begins at a pixel of the picture and of a row. */
static inline void compose_block(const struct picture *p, struct block *block, size_t at,
                                 uint32_t x, uint32_t count, const kiln_quad *glow)
{
    float *beauty = p->stage->beauty;
    for (uint32_t i = 0; i < count; i++) {
        kiln_quad color = kiln_compose(&p->light, 4 * (at + i));
        if (glow)
            color += kiln_magnified(&p->stage->magnifier, glow, x + i);
        if (beauty)
            kiln_quad_store(beauty + 4 * (at + i), color);
        block->red[i] = color[0];
        block->green[i] = color[1];
        block->blue[i] = color[2];
        block->alpha[i] = color[3];
    }
}

static inline void compose_row(const struct picture *p, uint32_t y, uint32_t worker)
{
    const struct kiln_composite_cpu *stage = p->stage;
    const uint32_t width = stage->scene->width;
    const uint32_t row_hash = hash(y + p->frame_hash);
    const kiln_quad *glow = NULL;
    if (p->glow)
        glow = kiln_magnifier_row(&stage->magnifier, p->glow, y, p->strength, worker);
    struct block block = {0};
    for (uint32_t x = 0; x < width; x += BLOCK) {
        uint32_t count = width - x < BLOCK ? width - x : BLOCK;
        size_t at = (size_t)y * width + x;
        compose_block(p, &block, at, x, count, glow);
        encode_block(p, &block, x, row_hash);
        if (stage->bits == 16)
            store_shorts(&block, count, (uint16_t *)stage->display + 4 * at);
        else
            store_bytes(&block, count, (uint8_t *)stage->display + 4 * at);
    }
}

KILN_WIDE_VECTORS
static void compose_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    for (size_t y = begin; y < end; y++)
        compose_row(context, (uint32_t)y, worker);
}

bool kiln_composite_cpu_run(struct kiln_composite_cpu *stage,
                            const struct kiln_composite_inputs *inputs, struct kiln_error *error)
{
    const struct kiln_scene *scene = stage->scene;
    const struct kiln_post *post = &scene->post;
    struct picture picture = {
        .stage = stage,
        .exposure = exact_exp2(kiln_scene_value(scene, &post->exposure, inputs->time_s)),
        .levels = stage->bits == 16 ? 65535.0f : 255.0f,
        .tonemap = post->tonemap,
        .dither = post->dither,
        .frame_hash = hash(inputs->frame),
    };
    if (!kiln_compose_open(&picture.light, inputs->scene, inputs->particles, inputs->fire, error))
        return false;
    if (inputs->bloom)
        picture.strength = kiln_scene_value(scene, &post->bloom_strength, inputs->time_s);
    if (picture.strength > 0.0f) {
        picture.glow = kiln_image_host(inputs->bloom, KILN_READ, error);
        if (!picture.glow ||
            !kiln_magnifier_prepare(&stage->magnifier, scene->width, inputs->bloom,
                                    inputs->bloom_scale, kiln_threads_count(stage->threads), error))
            return false;
    }
    kiln_threads_for(stage->threads, scene->height, ROWS_AT_A_TIME, compose_rows, &picture);
    return true;
}

void kiln_composite_cpu_read_display(const struct kiln_composite_cpu *stage, void *pixels)
{
    size_t channels = (size_t)stage->scene->width * stage->scene->height * 4;
    memcpy(pixels, stage->display, channels * (stage->bits / 8));
}

void kiln_composite_cpu_read_beauty(const struct kiln_composite_cpu *stage, float *pixels)
{
    size_t channels = (size_t)stage->scene->width * stage->scene->height * 4;
    memcpy(pixels, stage->beauty, channels * sizeof(float));
}
