/* This file sends the profiles of gas to a buffer texture. The arrays of all domains lie in it one
 * after another, each from a whole texel on. They are sent once a moment, straight from where the
 * march wrote them. */
#include "draw/sprites/gas_before.h"

#include <assert.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "draw/volume/volume.h"

enum { TEXEL = 16 };

static_assert(sizeof(struct kiln_gas_before_block) == 128, "std140");
static_assert(KILN_MAX_GAS == 4, "domains of struct kiln_gas_before_block");
static_assert(sizeof(struct kiln_volume_profile) == 64 &&
                  offsetof(struct kiln_volume_profile, count) == 32 && VOLUME_PACKET == 8 &&
                  VOLUME_NODE * sizeof(uint16_t) == TEXEL && VOLUME_NODES <= 32 &&
                  VOLUME_PROFILE_UNIT == 64,
              "gas_before.glsl");

struct kiln_gas_before {
    struct kiln_device *device;
    struct kiln_buffer block;                /* struct kiln_gas_before_block */
    GLuint buffer, texture;                  /* the profiles */
    uint64_t texels;                         /* of the buffer */
    const struct kiln_volume_profiles *sent; /* NULL: none yet */
    uint64_t sent_drawn;                     /* `drawn` of them */
    uint4 domains[KILN_MAX_GAS];             /* as in struct kiln_gas_before_block */
};

const char *kiln_gas_before_defines(const struct kiln_scene *scene)
{
    return kiln_volume_has_half(scene)      ? "#define GAS 1\n#define GAS_BETWEEN 1\n"
           : kiln_volume_domains(scene) > 0 ? "#define GAS 1\n"
                                            : "";
}

/* Makes the buffer so large. Its contents are lost. */
static bool make_room(struct kiln_gas_before *g, uint64_t texels, struct kiln_error *error)
{
    glBindBuffer(GL_TEXTURE_BUFFER, g->buffer);
    if (texels <= g->texels)
        return true;
    g->texels = 0;
    glBufferData(GL_TEXTURE_BUFFER, (GLsizeiptr)(texels * TEXEL), NULL, GL_DYNAMIC_DRAW);
    if (!kiln_device_check(g->device, "profiles of gas", error))
        return false;
    glActiveTexture(GL_TEXTURE0 + KILN_UNIT_PROFILES);
    glBindTexture(GL_TEXTURE_BUFFER, g->texture);
    glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32UI, g->buffer);
    g->texels = texels;
    return true;
}

struct kiln_gas_before *kiln_gas_before_create(struct kiln_device *device, struct kiln_error *error)
{
    struct kiln_gas_before *g = calloc(1, sizeof *g);
    if (!g) {
        kiln_error_no_memory(error, "profiles of gas");
        return NULL;
    }
    g->device = device;
    kiln_buffer_init(&g->block, device, sizeof(struct kiln_gas_before_block),
                     "gas before particles");
    glGenBuffers(1, &g->buffer);
    glGenTextures(1, &g->texture);
    if (!make_room(g, 1, error))
        kiln_gas_before_destroy(&g);
    return g;
}

void kiln_gas_before_destroy(struct kiln_gas_before **gas)
{
    struct kiln_gas_before *g = *gas;
    if (!g)
        return;
    kiln_buffer_finish(&g->block);
    glDeleteTextures(1, &g->texture);
    glDeleteBuffers(1, &g->buffer);
    free(g);
    *gas = NULL;
}

/* Returns the bytes of a domain's memory that profiles have. */
static size_t used_bytes(const struct kiln_volume_domain *domain)
{
    return atomic_load(&domain->used);
}

/* Gives bytes a place behind others, and returns the texel at which it begins. */
static uint32_t take_texels(uint64_t *texels, uint64_t bytes)
{
    const uint64_t first = *texels;
    *texels += (bytes + TEXEL - 1) / TEXEL;
    return (uint32_t)first;
}

/* Gives the arrays of all domains places. Returns the texels of all, or 0 with an error. */
static uint64_t place_domains(struct kiln_gas_before *g, const struct kiln_volume_profiles *p,
                              struct kiln_error *error)
{
    const uint64_t pixels = (uint64_t)p->width * p->height;
    uint64_t texels = 0;
    GLint most = 0;
    for (uint32_t i = 0; i < p->count; i++) {
        g->domains[i].x = take_texels(&texels, p->tiles * sizeof(float));
        g->domains[i].y = take_texels(&texels, pixels * sizeof(uint32_t));
        g->domains[i].z = take_texels(&texels, used_bytes(&p->domains[i]));
    }
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
    if (texels <= (uint64_t)most)
        return texels;
    kiln_error_set(error, KILN_DEVICE_FAILED,
                   "gas in a picture of %u x %u pixels needs a buffer texture of %llu texels; %s "
                   "allows %d: use raster=cpu, or a smaller picture",
                   p->width, p->height, (unsigned long long)texels, g->device->info.name, most);
    return 0;
}

/* Sends bytes to a place in the bound buffer. */
static void send(struct kiln_gas_before *g, uint32_t texel, const void *bytes, uint64_t count)
{
    glBufferSubData(GL_TEXTURE_BUFFER, (GLintptr)((uint64_t)texel * TEXEL), (GLsizeiptr)count,
                    bytes);
    g->device->traffic.to_device += count;
}

static bool send_profiles(struct kiln_gas_before *g, const struct kiln_volume_profiles *p,
                          struct kiln_error *error)
{
    const uint64_t texels = place_domains(g, p, error);
    g->sent = NULL;
    if (texels == 0 || !make_room(g, texels, error))
        return false;
    for (uint32_t i = 0; i < p->count; i++) {
        const struct kiln_volume_domain *d = &p->domains[i];
        send(g, g->domains[i].x, d->near_m, p->tiles * sizeof *d->near_m);
        send(g, g->domains[i].y, d->profile_of,
             (uint64_t)p->width * p->height * sizeof *d->profile_of);
        send(g, g->domains[i].z, d->memory, used_bytes(d));
    }
    g->sent = p;
    g->sent_drawn = p->drawn;
    return kiln_device_check(g->device, "profiles of gas", error);
}

bool kiln_gas_before_bind(struct kiln_gas_before *gas, const struct kiln_tile_gas *of,
                          struct kiln_error *error)
{
    const struct kiln_volume_profiles *p = of ? of->profiles : NULL;
    struct kiln_gas_before_block block;
    memset(&block, 0, sizeof block);
    if (p && (gas->sent != p || gas->sent_drawn != p->drawn) && !send_profiles(gas, p, error))
        return false;
    if (p) {
        float *const blooms[KILN_MAX_GAS] = {&block.blooms.x, &block.blooms.y, &block.blooms.z,
                                             &block.blooms.w};
        block.picture = UINT4(of->width, of->height, p->across, p->count);
        block.place = FLOAT4(of->scale, of->margin_x, of->margin_y, 0.0f);
        block.covered = FLOAT4(of->smoke, of->flame, of->glow, 0.0f);
        for (uint32_t i = 0; i < p->count; i++) {
            block.domains[i] = gas->domains[i];
            *blooms[i] = p->domains[i].bloom;
        }
    }
    const GLuint buffer = kiln_buffer_upload(&gas->block, &block, error);
    glBindBufferBase(GL_UNIFORM_BUFFER, KILN_BIND_GAS, buffer);
    glActiveTexture(GL_TEXTURE0 + KILN_UNIT_PROFILES);
    glBindTexture(GL_TEXTURE_BUFFER, gas->texture);
    return buffer != 0;
}
