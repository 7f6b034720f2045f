/* This file uploads the looks of a scene to GL once, with the keys of lives, and the look table
 * whenever it has changed. It binds both, together with the particles' records. */
#include "draw/moment/moment_gl.h"

#include <assert.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "gpu/buffer.h"
#include "option/value_curve.h"
#include "scene/family.h"
#include "scene/source.h"
#include "shared/source.h"

static_assert(offsetof(struct kiln_draw_look, flags) == 48, "std140");
static_assert(sizeof(struct kiln_draw_look) == 128 + 16 * KILN_MAX_TEXTURES, "std140");
static_assert(KILN_MAX_SYSTEMS * sizeof(struct kiln_draw_look) <= 16384, "of every GL");

struct kiln_moment_gl {
    struct kiln_device *device;
    struct kiln_buffer looks, keys;
    GLuint sources;            /* texture of the colours of sources; 0: there are none */
    GLuint look_table;         /* texture, KILN_LOOK_SAMPLES wide; 0: nothing is made yet */
    uint64_t uploaded_changes; /* the moment's look_changes when the texture was uploaded */
};

void kiln_moment_gl_defines(const struct kiln_scene *scene, struct kiln_text *defines)
{
    uint32_t clocks = 1u << KILN_CLOCK_TIME;
    const uint32_t base_rows = (scene->system_count ? scene->system_count : 1) * KILN_LOOK_ROWS;
    for (uint32_t i = 0; i < scene->system_count; i++)
        clocks |= kiln_range_uses(scene->keys, &scene->systems[i].emit.life);
    if (clocks != 1u << KILN_CLOCK_TIME)
        kiln_text_add(defines, "#define USES_CLOCKS %uu\n", clocks);
    if (kiln_look_rows(scene) > base_rows)
        kiln_text_add(defines, "#define LOOK_VALUES 1\n");
    if (kiln_sources_sizes(scene).texels > 0)
        kiln_text_add(defines, "#define LOOK_SOURCES 1\n");
    bool inherits = false;
    for (uint32_t i = 0; i < scene->system_count; i++)
        inherits = inherits || kiln_family_inherits(&scene->systems[i]);
    if (inherits)
        kiln_text_add(defines, "#define LOOK_PARENTS 1\n");
}

struct kiln_moment_gl *kiln_moment_gl_create(struct kiln_device *device)
{
    struct kiln_moment_gl *gl = calloc(1, sizeof *gl);
    if (gl)
        gl->device = device;
    return gl;
}

void kiln_moment_gl_destroy(struct kiln_moment_gl **gl)
{
    if (!*gl)
        return;
    if ((*gl)->look_table) {
        kiln_buffer_finish(&(*gl)->looks);
        kiln_buffer_finish(&(*gl)->keys);
        glDeleteTextures(1, &(*gl)->look_table);
        if ((*gl)->sources)
            glDeleteTextures(1, &(*gl)->sources);
    }
    free(*gl);
    *gl = NULL;
}

/* A table of keys that is being filled. */
struct packing {
    const float4 *from; /* the scene's keys */
    float4 *keys;
    uint32_t count;
};

/* Appends the keys of one part of a value, after room for its entries, and points the part at them.
 * Returns false if the table has no room for them. */
static bool pack_part(struct packing *p, struct kiln_value *part, uint32_t entries)
{
    if (part->count == 0)
        return true;
    if (part->count + entries > KILN_BLOCK_KEYS - p->count)
        return false;
    memcpy(p->keys + p->count, p->from + part->first - entries,
           (part->count + entries) * sizeof *p->keys);
    part->first = p->count + entries;
    p->count += part->count + entries;
    return true;
}

/* Appends the keys of a value, and of what multiplies it and is added to it (shared/value.h). */
static bool pack_value(struct packing *p, struct kiln_value *value)
{
    const uint32_t bits[] = {VALUE_TIMES, VALUE_PLUS};
    const struct kiln_value before = *value;
    bool fits = pack_part(p, value, kiln_value_entries(value->how));
    for (uint32_t i = 0; fits && value->count > 0 && i < 2; i++) {
        if (!(value->how & bits[i]))
            continue;
        struct kiln_value part = value_part(p->from, before, i + 1);
        fits = pack_part(p, &part, kiln_value_entries(part.how));
        p->keys[value->first - 2 - i] = kiln_curve_pack(&part);
    }
    return fits;
}

/* Fills the table of keys for drawing. Where the scene's keys do not fit into a uniform block, the
 * table has only those that shaders of drawing evaluate: the keys of the lives. kiln_sizes_check
 * has refused scenes for which this fails. */
static bool fill_keys(const struct kiln_scene *scene, struct kiln_draw_look *looks, float4 *keys,
                      struct kiln_error *error)
{
    struct packing packing = {.from = scene->keys, .keys = keys};
    bool fits = true;
    if (scene->key_count > 0 && !kiln_scene_stores_keys(scene))
        memcpy(keys, scene->keys, scene->key_count * sizeof *keys);
    for (uint32_t i = 0; fits && i < scene->system_count && kiln_scene_stores_keys(scene); i++) {
        struct kiln_range *life = &looks[i].derived.life;
        const bool is_one = kiln_range_is_one_value(life);
        fits = pack_value(&packing, &life->min) && (is_one || pack_value(&packing, &life->max));
        if (is_one)
            life->max = life->min;
    }
    return fits || kiln_error_set(error, KILN_USAGE, "systems: the keys of lives are more than %d",
                                  KILN_BLOCK_KEYS);
}

static bool make_buffers(const struct kiln_moment *moment, struct kiln_error *error)
{
    struct kiln_moment_gl *gl = moment->gl;
    struct kiln_draw_look looks[KILN_MAX_SYSTEMS];
    float4 keys[KILN_BLOCK_KEYS] = {{0}};
    memcpy(looks, moment->looks, sizeof looks);
    if (!fill_keys(moment->scene, looks, keys, error))
        return false;
    kiln_buffer_init(&gl->looks, gl->device, sizeof looks, "looks");
    kiln_buffer_init(&gl->keys, gl->device, sizeof keys, "value keys");
    return kiln_buffer_upload(&gl->looks, looks, error) &&
           kiln_buffer_upload(&gl->keys, keys, error);
}

static GLsizei count_rows(const struct kiln_moment *moment)
{
    return (GLsizei)moment->look_rows;
}

/* Uploads the texels of all sources, one system after another, in rows of SOURCE_ROW. */
static bool make_sources(const struct kiln_moment *moment, struct kiln_error *error)
{
    struct kiln_moment_gl *gl = moment->gl;
    const size_t count = kiln_sources_sizes(moment->scene).texels;
    const size_t rows = (count + SOURCE_ROW - 1) / SOURCE_ROW;
    if (count == 0)
        return true;
    uint4 *texels = calloc(rows * SOURCE_ROW, sizeof *texels), *next = texels;
    if (!texels)
        return kiln_error_no_memory(error, "the colours of sources");
    for (uint32_t i = 0; i < moment->scene->system_count; i++) {
        const struct kiln_source *source = moment->scene->systems[i].emit.source.made;
        if (!source || source->texel_count == 0)
            continue;
        memcpy(next, source->texels, source->texel_count * sizeof *next);
        next += source->texel_count;
    }
    glGenTextures(1, &gl->sources);
    glBindTexture(GL_TEXTURE_2D, gl->sources);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32UI, SOURCE_ROW, (GLsizei)rows, 0, GL_RGBA_INTEGER,
                 GL_UNSIGNED_INT, texels);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    kiln_device_label(gl->device, GL_TEXTURE, gl->sources, "colours of sources");
    free(texels);
    return true;
}

static bool make(const struct kiln_moment *moment, struct kiln_error *error)
{
    struct kiln_moment_gl *gl = moment->gl;
    glGenTextures(1, &gl->look_table);
    glBindTexture(GL_TEXTURE_2D, gl->look_table);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, KILN_LOOK_SAMPLES, count_rows(moment), 0, GL_RGBA,
                 GL_FLOAT, NULL);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    kiln_device_label(gl->device, GL_TEXTURE, gl->look_table, "look table");
    return make_sources(moment, error) && make_buffers(moment, error) &&
           kiln_device_check(gl->device, "looks", error);
}

static void bind_look_table(const struct kiln_moment *moment)
{
    struct kiln_moment_gl *gl = moment->gl;
    if (gl->sources) {
        glActiveTexture(GL_TEXTURE0 + KILN_UNIT_SOURCES);
        glBindTexture(GL_TEXTURE_2D, gl->sources);
    }
    glActiveTexture(GL_TEXTURE0 + KILN_UNIT_LOOK_TABLE);
    glBindTexture(GL_TEXTURE_2D, gl->look_table);
    if (gl->uploaded_changes == moment->look_changes)
        return;
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, KILN_LOOK_SAMPLES, count_rows(moment), GL_RGBA,
                    GL_FLOAT, moment->look_table);
    gl->uploaded_changes = moment->look_changes;
}

bool kiln_moment_bind_looks(const struct kiln_moment *moment, struct kiln_error *error)
{
    struct kiln_moment_gl *gl = moment->gl;
    if (!gl->look_table && !make(moment, error))
        return false;
    GLuint looks = kiln_buffer_gl(&gl->looks, KILN_READ, error);
    GLuint keys = looks ? kiln_buffer_gl(&gl->keys, KILN_READ, error) : 0;
    if (!keys)
        return false;
    glBindBufferBase(GL_UNIFORM_BUFFER, KILN_BIND_LOOKS, looks);
    glBindBufferBase(GL_UNIFORM_BUFFER, KILN_BIND_KEYS, keys);
    return true;
}

bool kiln_moment_bind(const struct kiln_moment *moment, struct kiln_buffer *entries,
                      struct kiln_error *error)
{
    GLuint records = kiln_buffer_gl(&moment->pool->records, KILN_READ, error);
    GLuint order = records ? kiln_buffer_gl(entries, KILN_READ, error) : 0;
    if (!order || !kiln_moment_bind_looks(moment, error))
        return false;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, KILN_BIND_RECORDS, records);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, KILN_BIND_ENTRIES, order);
    bind_look_table(moment);
    return true;
}
