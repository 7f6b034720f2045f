/* This file sums up pictures of the moments of a frame while the shutter is open. It owns the
 * images of the sums and adds to them on the host; shutter_gl.c adds to them in GL. */
#include "post/shutter.h"

#include <stdlib.h>

#include "base/error.h"
#include "post/compose.h"
#include "post/shutter_gl.h"

enum { ROWS_AT_A_TIME = 16 };

struct kiln_shutter_stage {
    struct kiln_threads *threads;
    struct kiln_image sums[KILN_SHUTTER_SUM_COUNT];
    struct kiln_shutter_gl *gl; /* NULL if the sums are computed on the host */
};

struct kiln_shutter_stage *kiln_shutter_create(struct kiln_device *device,
                                               const struct kiln_shutter_params *params,
                                               struct kiln_error *error)
{
    struct kiln_shutter_stage *stage = calloc(1, sizeof *stage);
    if (!stage) {
        kiln_error_no_memory(error, "the shutter");
        return NULL;
    }
    stage->threads = params->threads;
    for (int i = 0; i < KILN_SHUTTER_SUM_COUNT; i++)
        kiln_image_init(&stage->sums[i], device, params->width, params->height, GL_RGBA32F,
                        "shutter");
    if (params->technique == KILN_COMPOSITE_GL) {
        stage->gl = kiln_shutter_gl_create(device, stage->sums, error);
        if (!stage->gl)
            kiln_shutter_destroy(&stage);
    }
    return stage;
}

void kiln_shutter_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    const uint64_t sums = scene->post.bloom != KILN_BLOOM_NONE ? 2 : 1;
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PICTURE, (uint64_t)scene->width * scene->height,
                       sums * 4 * sizeof(float));
}

void kiln_shutter_destroy(struct kiln_shutter_stage **stage)
{
    if (!*stage)
        return;
    kiln_shutter_gl_destroy(&(*stage)->gl);
    for (int i = 0; i < KILN_SHUTTER_SUM_COUNT; i++)
        kiln_image_finish(&(*stage)->sums[i]);
    free(*stage);
    *stage = NULL;
}

/* Describes a moment that is being added to a sum. */
struct accumulation {
    struct kiln_compose_light light;
    float *sum;
    size_t width;
    float weight;
    bool first;
};

static void add_rows(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct accumulation *a = context;
    for (size_t at = 4 * begin * a->width; at < 4 * end * a->width; at += 4) {
        kiln_quad moment = kiln_compose(&a->light, at) * a->weight;
        kiln_quad_store(a->sum + at, a->first ? moment : kiln_quad_load(a->sum + at) + moment);
    }
}

/* Adds the composed picture of a moment to a sum. The inputs' particles and fire may be NULL. */
static bool add_moment(struct kiln_shutter_stage *stage, enum kiln_shutter_sum which,
                       const struct kiln_composite_inputs *inputs, float weight, bool first,
                       struct kiln_error *error)
{
    struct kiln_image *sum = &stage->sums[which];
    struct accumulation accumulation = {.width = sum->width, .weight = weight, .first = first};
    if (!kiln_compose_open(&accumulation.light, inputs->scene, inputs->particles, inputs->fire,
                           error))
        return false;
    accumulation.sum = kiln_image_host(sum, first ? KILN_OVERWRITE : KILN_READ_WRITE, error);
    if (!accumulation.sum)
        return false;
    return kiln_threads_try(stage->threads, sum->height, ROWS_AT_A_TIME, add_rows, &accumulation,
                            error);
}

bool kiln_shutter_add_composed(struct kiln_shutter_stage *stage,
                               const struct kiln_composite_inputs *inputs, float weight, bool first,
                               struct kiln_error *error)
{
    if (stage->gl)
        return kiln_shutter_gl_add_composed(stage->gl, inputs, weight, first, error);
    return add_moment(stage, KILN_SHUTTER_COMPOSED, inputs, weight, first, error);
}

bool kiln_shutter_add(struct kiln_shutter_stage *stage, enum kiln_shutter_sum sum,
                      struct kiln_image *image, float weight, bool first, struct kiln_error *error)
{
    if (stage->gl)
        return kiln_shutter_gl_add(stage->gl, sum, image, weight, first, error);
    const struct kiln_composite_inputs alone = {.scene = image};
    return add_moment(stage, sum, &alone, weight, first, error);
}

struct kiln_image *kiln_shutter_image(struct kiln_shutter_stage *stage, enum kiln_shutter_sum sum)
{
    return &stage->sums[sum];
}
