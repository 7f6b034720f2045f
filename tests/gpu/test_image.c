/* Checks kiln_image (lib/gpu/image.h), a render target that is on the host and in GL: pixels are
 * unchanged after the way to GL and back, row 0 is the top row, and impossible sizes are errors. If
 * this fails, pictures are flipped, sheared or stale. */
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "gpu/image.h"
#include "support/cmocka.h"
#include "support/device.h"
#include "support/errors.h"

/* The sizes are odd, so that a copy that pads rows to an alignment would shift the pixels. */
enum { WIDTH = 37, HEIGHT = 11 };

/* Clears `rows` rows of a texture, from row y on, to a colour, as a pass that draws in GL would
 * write them. */
static void clear_texel_rows(GLuint gl, GLint y, GLsizei rows, const float color[4])
{
    GLuint framebuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, gl, 0);
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, y, WIDTH, rows);
    glClearBufferfv(GL_COLOR, 0, color);
    glDisable(GL_SCISSOR_TEST);
    glDeleteFramebuffers(1, &framebuffer);
}

/* Pixels that the host sends to GL come back unchanged, for each format. The test erases the host's
 * copy while GL has the valid pixels, so that they can only come from GL. */
static void pixels_return_as_they_were(void **state)
{
    static const GLenum formats[] = {GL_R32F, GL_RGBA16F, GL_RGBA32F};
    for (size_t f = 0; f < 3; f++) {
        struct kiln_error error = {0};
        struct kiln_image image;
        kiln_image_init(&image, *state, WIDTH, HEIGHT, formats[f], "round trip");
        const size_t count = (size_t)WIDTH * HEIGHT * image.channels;
        float *host = kiln_image_host(&image, KILN_OVERWRITE, &error);
        assert_non_null(host);
        assert_int_equal((uintptr_t)host % 64, 0);
        for (size_t i = 0; i < count; i++)
            host[i] = (float)i * 0.5f; /* exact in half floats: a multiple of 0.5 below 1024 */
        assert_true(kiln_image_gl(&image, KILN_READ_WRITE, &error) != 0);
        memset(host, 0, count * sizeof *host);
        assert_false(image.host_valid);
        assert_ptr_equal(kiln_image_host(&image, KILN_READ, &error), host);
        for (size_t i = 0; i < count; i++)
            assert_true(host[i] == (float)i * 0.5f);
        kiln_image_finish(&image);
    }
}

static void pixels_drawn_by_gl_are_fetched(void **state)
{
    struct kiln_error error = {0};
    struct kiln_image image;
    kiln_image_init(&image, *state, WIDTH, HEIGHT, GL_RGBA16F, "drawn");
    GLuint gl = kiln_image_gl(&image, KILN_OVERWRITE, &error);
    assert_true(gl != 0);
    clear_texel_rows(gl, 0, HEIGHT, (float[4]){0, 0, 0, 0});
    clear_texel_rows(gl, 0, 1, (float[4]){1, 2, 3, 0.5f});
    const float *host = kiln_image_host(&image, KILN_READ, &error);
    assert_true(host[0] == 1 && host[1] == 2 && host[2] == 3 && host[3] == 0.5f);
    assert_true(host[4 * WIDTH] == 0);
    assert_true(host[4 * (WIDTH - 1)] == 1);
    kiln_image_finish(&image);
}

static void bindings_are_left_alone(void **state)
{
    struct kiln_error error = {0};
    struct kiln_image bound, other;
    kiln_image_init(&bound, *state, 4, 4, GL_R32F, "bound");
    kiln_image_init(&other, *state, 4, 4, GL_R32F, "other");
    GLuint gl = kiln_image_gl(&bound, KILN_OVERWRITE, &error);
    glBindTexture(GL_TEXTURE_2D, gl);
    memset(kiln_image_host(&other, KILN_OVERWRITE, &error), 0, 4 * 4 * sizeof(float));
    kiln_image_gl(&other, KILN_READ_WRITE, &error);
    kiln_image_host(&other, KILN_READ, &error);
    GLint binding = 0;
    glGetIntegerv(GL_TEXTURE_BINDING_2D, &binding);
    assert_int_equal(binding, gl);
    kiln_image_finish(&bound);
    kiln_image_finish(&other);
}

static void impossible_sizes_are_errors(void **state)
{
    static const uint32_t sizes[][2] = {{0, 4}, {4, 0}, {100000, 1}, {UINT32_MAX, UINT32_MAX}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        struct kiln_error error = {0};
        struct kiln_image image;
        kiln_image_init(&image, *state, sizes[i][0], sizes[i][1], GL_RGBA32F, "impossible");
        assert_int_equal(kiln_image_gl(&image, KILN_OVERWRITE, &error), 0);
        expect_error(&error, KILN_DEVICE_FAILED,
                     "impossible: found %u x %u pixels; the device takes 1 to %d a side",
                     sizes[i][0], sizes[i][1],
                     ((const struct kiln_device *)*state)->info.max_texture_size);
        kiln_image_finish(&image);
    }
    struct kiln_error error = {0};
    struct kiln_image image;
    kiln_image_init(&image, NULL, UINT32_MAX, UINT32_MAX, GL_RGBA32F, "impossible");
    assert_null(kiln_image_host(&image, KILN_OVERWRITE, &error));
    expect_error(&error, KILN_DEVICE_FAILED,
                 "out of memory for 4294967295 x 4294967295 pixels of the image 'impossible' on "
                 "the host");
    assert_int_equal(kiln_image_gl(&image, KILN_OVERWRITE, &error), 0);
    kiln_image_finish(&image);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(pixels_return_as_they_were),
        test_on_device(pixels_drawn_by_gl_are_fetched),
        test_on_device(bindings_are_left_alone),
        test_on_device(impossible_sizes_are_errors),
    };
    return cmocka_run_group_tests_name("image", tests, test_device_open, test_device_close);
}
