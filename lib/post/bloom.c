/* The thesis's four blurs: horizontal and vertical at a third of the size, then at a sixth. Each
 * shrinking averages whole blocks first, where the thesis samples bilinearly and may miss a spark.
 */
#include "post/bloom.h"

#include "base/error.h"
#include "gpu/framebuffer.h"
#include "gpu/program.h"

#include <math.h>
#include <stdlib.h>

enum { TAPS = 6 }; /* of one side, the centre included: 11 in all */

struct level {
    struct kiln_image images[2]; /* shrunk and blurred down; blurred across */
    struct kiln_framebuffer framebuffers[2];
};

struct kiln_bloom_stage {
    struct kiln_device *device;
    GLuint shrink, blur, vertex_array;
    GLint factor, direction;
    struct level third, sixth;
};

static bool init_level(struct kiln_bloom_stage *stage, struct level *level, uint32_t width,
                       uint32_t height, GLenum format, struct kiln_error *error)
{
    for (int i = 0; i < 2; i++) {
        struct kiln_image *image = &level->images[i];
        kiln_image_init(image, stage->device, width, height, format, "bloom");
        if (!kiln_framebuffer_init(&level->framebuffers[i], stage->device, &image, 1, error))
            return false;
    }
    return true;
}

static void finish_level(struct level *level)
{
    for (int i = 0; i < 2; i++) {
        kiln_framebuffer_finish(&level->framebuffers[i]);
        kiln_image_finish(&level->images[i]);
    }
}

static void set_weights(GLuint program)
{
    const double sigma = 2.0;
    double weights[TAPS], sum = 0.0;
    for (int i = 0; i < TAPS; i++) {
        weights[i] = exp(-0.5 * (double)(i * i) / (sigma * sigma));
        sum += i == 0 ? weights[i] : 2.0 * weights[i];
    }
    float normalized[TAPS];
    for (int i = 0; i < TAPS; i++)
        normalized[i] = (float)(weights[i] / sum);
    glUseProgram(program);
    glUniform1fv(glGetUniformLocation(program, "weights"), TAPS, normalized);
}

struct kiln_bloom_stage *kiln_bloom_create(struct kiln_device *device, uint32_t width,
                                           uint32_t height, GLenum format, struct kiln_error *error)
{
    struct kiln_bloom_stage *stage = calloc(1, sizeof *stage);
    if (!stage) {
        kiln_error_set(error, KILN_DEVICE_FAILED, "bloom: out of memory");
        return NULL;
    }
    stage->device = device;
    stage->shrink =
        kiln_program_create(device,
                            &(struct kiln_program_params){.vertex = "draw/fullscreen.vert",
                                                          .fragment = "post/bloom_shrink.frag"},
                            error);
    if (stage->shrink)
        stage->blur =
            kiln_program_create(device,
                                &(struct kiln_program_params){.vertex = "draw/fullscreen.vert",
                                                              .fragment = "post/bloom_blur.frag"},
                                error);
    if (!stage->blur ||
        !init_level(stage, &stage->third, (width + 2) / 3, (height + 2) / 3, format, error) ||
        !init_level(stage, &stage->sixth, (width + 5) / 6, (height + 5) / 6, format, error)) {
        kiln_bloom_destroy(&stage);
        return NULL;
    }
    set_weights(stage->blur);
    stage->factor = glGetUniformLocation(stage->shrink, "factor");
    stage->direction = glGetUniformLocation(stage->blur, "direction");
    glGenVertexArrays(1, &stage->vertex_array);
    return stage;
}

void kiln_bloom_destroy(struct kiln_bloom_stage **stage)
{
    struct kiln_bloom_stage *s = *stage;
    if (!s)
        return;
    finish_level(&s->third);
    finish_level(&s->sixth);
    if (s->shrink)
        glDeleteProgram(s->shrink);
    if (s->blur)
        glDeleteProgram(s->blur);
    glDeleteVertexArrays(1, &s->vertex_array);
    free(s);
    *stage = NULL;
}

static bool pass(struct kiln_bloom_stage *stage, struct kiln_image *from, struct level *level,
                 int target, struct kiln_error *error)
{
    GLuint source = kiln_image_gl(from, KILN_READ, error);
    if (!source || !kiln_framebuffer_bind(&level->framebuffers[target], error))
        return false;
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, source);
    kiln_framebuffer_fill(stage->vertex_array);
    return true;
}

static bool blur_level(struct kiln_bloom_stage *stage, struct kiln_image *source, int factor,
                       struct level *level, struct kiln_error *error)
{
    glUseProgram(stage->shrink);
    glUniform1i(stage->factor, factor);
    if (!pass(stage, source, level, 0, error))
        return false;
    glUseProgram(stage->blur);
    glUniform2i(stage->direction, 1, 0);
    if (!pass(stage, &level->images[0], level, 1, error))
        return false;
    glUniform2i(stage->direction, 0, 1);
    return pass(stage, &level->images[1], level, 0, error);
}

struct kiln_image *kiln_bloom_run(struct kiln_bloom_stage *stage, struct kiln_image *source,
                                  struct kiln_error *error)
{
    glDisable(GL_BLEND);
    if (!blur_level(stage, source, 3, &stage->third, error) ||
        !blur_level(stage, &stage->third.images[0], 2, &stage->sixth, error) ||
        !kiln_device_check(stage->device, "bloom", error))
        return NULL;
    return &stage->sixth.images[0];
}
