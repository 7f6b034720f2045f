/* This file allocates images as textures in GL and as floats on the host, and copies them between
 * the two sides when one of them is stale. */
#include "gpu/image.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/error.h"
#include "base/pages.h"

void kiln_image_init(struct kiln_image *image, struct kiln_device *device, uint32_t width,
                     uint32_t height, GLenum gl_format, const char *label)
{
    *image = (struct kiln_image){
        .device = device,
        .label = label,
        .width = width,
        .height = height,
        .channels = gl_format == GL_R32F ? 1 : 4,
        .gl_format = gl_format,
    };
}

void kiln_image_finish(struct kiln_image *image)
{
    if (image->gl)
        glDeleteTextures(1, &image->gl);
    free(image->host);
    *image = (struct kiln_image){.device = NULL};
}

void kiln_image_exchange(struct kiln_image *image, float **pixels)
{
    float *host = image->host;
    image->host = *pixels;
    *pixels = host;
}

static bool refuse_memory(const struct kiln_image *image, const char *place,
                          struct kiln_error *error)
{
    return kiln_error_no_memory(error, "%u x %u pixels of the image '%s' %s", image->width,
                                image->height, image->label, place);
}

static bool allocate_host(struct kiln_image *image, struct kiln_error *error)
{
    size_t size = image->channels * sizeof(float);
    bool overflow = __builtin_mul_overflow(size, image->width, &size) ||
                    __builtin_mul_overflow(size, image->height, &size);
    if (!overflow)
        image->host = kiln_alloc_pages(size);
    return image->host || refuse_memory(image, "on the host", error);
}

/* Binds a texture and returns the previously bound texture. The caller must bind that one again,
 * since it may belong to a draw that is being set up. */
static GLuint bind(GLuint texture)
{
    GLint before = 0;
    glGetIntegerv(GL_TEXTURE_BINDING_2D, &before);
    glBindTexture(GL_TEXTURE_2D, texture);
    return (GLuint)before;
}

static GLenum pixel_format(const struct kiln_image *image)
{
    return image->channels == 1 ? GL_RED : GL_RGBA;
}

/* Returns the size in bytes of the pixels as floats, the format in which both sides exchange
 * them. */
static uint64_t pixel_bytes(const struct kiln_image *image)
{
    return (uint64_t)image->width * image->height * image->channels * sizeof(float);
}

static bool copy_to_host(struct kiln_image *image, struct kiln_error *error)
{
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    const GLuint before = bind(image->gl);
    glGetTexImage(GL_TEXTURE_2D, 0, pixel_format(image), GL_FLOAT, image->host);
    glBindTexture(GL_TEXTURE_2D, before);
    image->device->traffic.to_host += pixel_bytes(image);
    return kiln_device_check(image->device, image->label, error);
}

float *kiln_image_host(struct kiln_image *image, enum kiln_access access, struct kiln_error *error)
{
    if (!image->host && !allocate_host(image, error))
        return NULL;
    if (!image->host_valid && image->gl_valid && access != KILN_OVERWRITE &&
        !copy_to_host(image, error))
        return NULL;
    image->host_valid = true;
    if (access != KILN_READ)
        image->gl_valid = false;
    return image->host;
}

static bool allocate_gl(struct kiln_image *image, struct kiln_error *error)
{
    if (!image->device)
        return kiln_error_set(error, KILN_DEVICE_FAILED, "%s: a host image is not in GL",
                              image->label);
    const uint32_t most = (uint32_t)image->device->info.max_texture_size;
    if (image->width < 1 || image->height < 1 || image->width > most || image->height > most)
        return kiln_error_set(error, KILN_DEVICE_FAILED,
                              "%s: found %u x %u pixels; the device takes 1 to %u a side",
                              image->label, image->width, image->height, most);
    GLuint gl = 0;
    glGenTextures(1, &gl);
    const GLuint before = bind(gl);
    glTexStorage2D(GL_TEXTURE_2D, 1, image->gl_format, (GLsizei)image->width,
                   (GLsizei)image->height);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    kiln_device_label(image->device, GL_TEXTURE, gl, image->label);
    glBindTexture(GL_TEXTURE_2D, before);
    char description[128]; /* the size shows why memory may run out */
    snprintf(description, sizeof description, "%s, %u x %u pixels", image->label, image->width,
             image->height);
    if (!kiln_device_check(image->device, description, error)) {
        glDeleteTextures(1, &gl);
        return false;
    }
    image->gl = gl;
    return true;
}

static bool copy_to_gl(struct kiln_image *image, struct kiln_error *error)
{
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    const GLuint before = bind(image->gl);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, (GLsizei)image->width, (GLsizei)image->height,
                    pixel_format(image), GL_FLOAT, image->host);
    glBindTexture(GL_TEXTURE_2D, before);
    image->device->traffic.to_device += pixel_bytes(image);
    return kiln_device_check(image->device, image->label, error);
}

GLuint kiln_image_gl(struct kiln_image *image, enum kiln_access access, struct kiln_error *error)
{
    if (!image->gl && !allocate_gl(image, error))
        return 0;
    if (!image->gl_valid && image->host_valid && access != KILN_OVERWRITE &&
        !copy_to_gl(image, error))
        return 0;
    image->gl_valid = true;
    if (access != KILN_READ)
        image->host_valid = false;
    return image->gl;
}
