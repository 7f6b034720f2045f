/* This file sends the light of a frame to textures in GL and binds them. Data that changes every
 * frame is sent once a frame, however many stages bind it.
 *
 * Textures that a scene may need are created with the stage, even if its first frames have no use
 * for them: llvmpipe compiles a program for the formats of its textures, and compiles it again when
 * a texture appears. */
#include "draw/light/lighting_gl.h"

#include <stdlib.h>

#include "shared/exact.h"

enum texture {
    SMOKE_SUN,
    SMOKE_SKY,
    SOLID_BINS,
    SOLID_LIST,
    SOLID_TILES,
    SILHOUETTES,
    SUN_SHADE,
    LAMP_MAPS,
    LAMP_SOLIDS,
    LAMP_SMOKE,
    LAMP_SHADE,
    TEXTURE_COUNT
};

static const struct {
    GLenum target;
    GLuint unit;
    const char *label;
} ABOUT[TEXTURE_COUNT] = {
    [SMOKE_SUN] = {GL_TEXTURE_3D, KILN_UNIT_SMOKE_SUN, "smoke towards the sun"},
    [SMOKE_SKY] = {GL_TEXTURE_3D, KILN_UNIT_SMOKE_SKY, "smoke towards the sky"},
    [SOLID_BINS] = {GL_TEXTURE_2D, KILN_UNIT_SOLID_BINS, "solid bins"},
    [SOLID_LIST] = {GL_TEXTURE_2D, KILN_UNIT_SOLID_LIST, "solid list"},
    [SOLID_TILES] = {GL_TEXTURE_2D, KILN_UNIT_SOLID_TILES, "solid tiles"},
    [SILHOUETTES] = {GL_TEXTURE_2D, KILN_UNIT_SILHOUETTES, "silhouettes"},
    [SUN_SHADE] = {GL_TEXTURE_2D, KILN_UNIT_SUN_SHADE, "sun on particles"},
    [LAMP_MAPS] = {GL_TEXTURE_2D_ARRAY, KILN_UNIT_LAMP_MAPS, "shadows of lamps"},
    [LAMP_SOLIDS] = {GL_TEXTURE_2D_ARRAY, KILN_UNIT_LAMP_SOLIDS, "solids before lamps"},
    [LAMP_SMOKE] = {GL_TEXTURE_2D_ARRAY, KILN_UNIT_LAMP_SMOKE, "smoke around lamps"},
    [LAMP_SHADE] = {GL_TEXTURE_2D_ARRAY, KILN_UNIT_LAMP_SHADE, "lamps on particles"},
};

struct kiln_lighting_gl {
    struct kiln_device *device;
    GLuint textures[TEXTURE_COUNT]; /* 0: not created yet */
    uint64_t run;                   /* of the light that the textures hold */
    size_t solid_rows, shade_rows;  /* of the textures */
    uint32_t lamp_map_count;        /* lamps that the texture has room for */
    uint64_t lamp_map_changes;      /* of the maps that the texture holds */
    uint32_t lamp_solid_count;      /* lamps that their texture has room for */
    uint64_t lamp_solid_changes[KILN_MOST_LAMPS * KILN_LAMP_FACES]; /* of faces in the texture */
    uint32_t lamp_smoke_count; /* lamps that their texture has room for */
    size_t lamp_shade_words;   /* of the texture */
    /* room for a level of a face while it is sent */
    uint32_t texels[KILN_LAMP_EDGE * KILN_LAMP_EDGE * KILN_LAMP_SOLID_TEXEL];
};

void kiln_lighting_gl_destroy(struct kiln_lighting_gl **gl)
{
    if (!*gl)
        return;
    for (int i = 0; i < TEXTURE_COUNT; i++) {
        if ((*gl)->textures[i])
            glDeleteTextures(1, &(*gl)->textures[i]);
    }
    free(*gl);
    *gl = NULL;
}

static void bind(const struct kiln_lighting_gl *gl, enum texture which)
{
    glActiveTexture(GL_TEXTURE0 + ABOUT[which].unit);
    glBindTexture(ABOUT[which].target, gl->textures[which]);
}

/* Binds the texture; returns true when it is new and needs storage. */
static bool make(struct kiln_lighting_gl *gl, enum texture which, GLint filter)
{
    bool is_new = gl->textures[which] == 0;
    if (is_new)
        glGenTextures(1, &gl->textures[which]);
    bind(gl, which);
    if (!is_new)
        return false;
    GLenum target = ABOUT[which].target;
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexParameteri(target, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
    kiln_device_label(gl->device, GL_TEXTURE, gl->textures[which], ABOUT[which].label);
    return true;
}

static void make_grid(struct kiln_lighting_gl *gl, enum texture which)
{
    enum { EDGE = KILN_SMOKE_GRID };
    if (make(gl, which, GL_LINEAR))
        glTexImage3D(GL_TEXTURE_3D, 0, GL_R32F, EDGE, EDGE, EDGE, 0, GL_RED, GL_FLOAT, NULL);
}

static void send_grid(struct kiln_lighting_gl *gl, enum texture which, const float *depth)
{
    enum { EDGE = KILN_SMOKE_GRID };
    make_grid(gl, which);
    glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, 0, EDGE, EDGE, EDGE, GL_RED, GL_FLOAT, depth);
    gl->device->traffic.to_device += sizeof(float) * EDGE * EDGE * EDGE;
}

static void make_bins(struct kiln_lighting_gl *gl)
{
    if (make(gl, SOLID_BINS, GL_NEAREST))
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RG32UI, KILN_SOLID_BINS, KILN_SOLID_BINS, 0,
                     GL_RG_INTEGER, GL_UNSIGNED_INT, NULL);
}

static void make_list(struct kiln_lighting_gl *gl, enum texture which, size_t rows)
{
    make(gl, which, GL_NEAREST);
    if (gl->solid_rows != rows)
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, KILN_SOLID_ROW, (GLsizei)rows, 0, GL_RGBA,
                     GL_FLOAT, NULL);
}

/* Sends a list of float4 in rows; returns how many rows it has. */
static size_t send_list(struct kiln_lighting_gl *gl, enum texture which,
                        const struct kiln_solid_bins *solids, const float4 *list)
{
    make_list(gl, which, solids->rows);
    size_t rows = (solids->entry_count + KILN_SOLID_ROW - 1) / KILN_SOLID_ROW;
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, KILN_SOLID_ROW, (GLsizei)rows, GL_RGBA, GL_FLOAT, list);
    return rows;
}

static void make_silhouettes(struct kiln_lighting_gl *gl)
{
    if (!make(gl, SILHOUETTES, GL_NEAREST))
        return;
    for (GLint level = 0; level < KILN_INSTANCE_LEVELS; level++) {
        const GLsizei edge = KILN_INSTANCE_ATLAS >> level;
        glTexImage2D(GL_TEXTURE_2D, level, GL_R32F, edge, edge, 0, GL_RED, GL_FLOAT, NULL);
    }
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, KILN_INSTANCE_LEVELS - 1);
}

/* Sends the rows of tiles that are in use. */
static void send_silhouettes(struct kiln_lighting_gl *gl, const struct kiln_solid_bins *solids)
{
    const float *texels = solids->silhouettes;
    float last = 0.0f;
    make_silhouettes(gl);
    for (size_t i = 0; i < solids->entry_count; i++) {
        const float4 tile = solids->tiles[i];
        last = tile.y + tile.w > last ? tile.y + tile.w : last;
    }
    for (GLint level = 0; level < KILN_INSTANCE_LEVELS; level++) {
        const GLsizei edge = KILN_INSTANCE_ATLAS >> level, rows = exact_int(last) >> level;
        if (rows > 0)
            glTexSubImage2D(GL_TEXTURE_2D, level, 0, 0, edge, rows, GL_RED, GL_FLOAT, texels);
        texels += (size_t)edge * (size_t)edge;
        gl->device->traffic.to_device += sizeof(float) * (size_t)edge * (size_t)rows;
    }
}

static void send_solids(struct kiln_lighting_gl *gl, const struct kiln_solid_bins *solids)
{
    GLsizei edge = (GLsizei)solids->edge;
    make_bins(gl);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, edge, edge, GL_RG_INTEGER, GL_UNSIGNED_INT,
                    solids->bins);
    size_t rows = send_list(gl, SOLID_LIST, solids, solids->list);
    if (solids->tiles) {
        rows += send_list(gl, SOLID_TILES, solids, solids->tiles);
        send_silhouettes(gl, solids);
    }
    gl->solid_rows = solids->rows;
    gl->device->traffic.to_device +=
        2 * sizeof(uint32_t) * solids->edge * solids->edge + sizeof(float4) * KILN_SOLID_ROW * rows;
}

static void send_shade(struct kiln_lighting_gl *gl, const struct kiln_lighting *lighting)
{
    size_t rows = (lighting->slot_count + KILN_SUN_SHADE_ROW - 1) / KILN_SUN_SHADE_ROW;
    make(gl, SUN_SHADE, GL_NEAREST);
    if (gl->shade_rows != rows)
        glTexImage2D(GL_TEXTURE_2D, 0, GL_R32F, KILN_SUN_SHADE_ROW, (GLsizei)rows, 0, GL_RED,
                     GL_FLOAT, NULL);
    gl->shade_rows = rows;
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, KILN_SUN_SHADE_ROW, (GLsizei)rows, GL_RED, GL_FLOAT,
                    lighting->sunlit);
    gl->device->traffic.to_device += sizeof(float) * KILN_SUN_SHADE_ROW * rows;
}

/* Binds the texture of an array with six faces for each lamp, and gives it storage where it has
 * room for fewer lamps. Texels beside a face count as empty. */
static void make_faces(struct kiln_lighting_gl *gl, enum texture which, uint32_t lamps)
{
    const GLenum target = GL_TEXTURE_2D_ARRAY;
    const bool maps = which == LAMP_MAPS;
    uint32_t *room = maps ? &gl->lamp_map_count : &gl->lamp_solid_count;
    if (make(gl, which, GL_LINEAR)) {
        glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
        glTexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
        glTexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
        glTexParameteri(target, GL_TEXTURE_MAX_LEVEL, KILN_LAMP_LEVELS - 1);
    }
    for (GLint level = 0; *room < lamps && level < KILN_LAMP_LEVELS; level++)
        glTexImage3D(target, level, maps ? GL_RG16 : GL_RGBA16, KILN_LAMP_EDGE >> level,
                     KILN_LAMP_EDGE >> level, (GLsizei)(lamps * KILN_LAMP_FACES), 0,
                     maps ? GL_RG : GL_RGBA, GL_UNSIGNED_SHORT, NULL);
    *room = *room < lamps ? lamps : *room;
}

/* Sends the levels of each face. */
static void send_lamp_maps(struct kiln_lighting_gl *gl, const struct kiln_lighting *lighting)
{
    const GLsizei layers = (GLsizei)(lighting->lamp_map_count * KILN_LAMP_FACES);
    make_faces(gl, LAMP_MAPS, lighting->lamp_map_count);
    for (GLint level = 0; level < KILN_LAMP_LEVELS; level++) {
        const GLsizei edge = KILN_LAMP_EDGE >> level;
        for (GLsizei layer = 0; layer < layers; layer++) {
            kiln_shadow_unpair(lighting->lamp_maps + (size_t)layer * KILN_LAMP_WORDS,
                               KILN_LAMP_EDGE, 1, (uint32_t)level, gl->texels);
            glTexSubImage3D(GL_TEXTURE_2D_ARRAY, level, 0, 0, layer, edge, edge, 1, GL_RG,
                            GL_UNSIGNED_SHORT, gl->texels);
        }
        gl->device->traffic.to_device +=
            sizeof *gl->texels * (size_t)edge * (size_t)edge * (size_t)layers;
    }
    gl->lamp_map_changes = lighting->lamp_map_changes;
}

/* Sends the levels of the faces that were drawn since the texture got them. */
static void send_lamp_solids(struct kiln_lighting_gl *gl, const struct kiln_lighting *lighting)
{
    const struct kiln_lamp_solid_maps *maps = &lighting->lamp_solids;
    const GLsizei layers = (GLsizei)(maps->count * KILN_LAMP_FACES);
    const bool all = gl->lamp_solid_count < maps->count;
    make_faces(gl, LAMP_SOLIDS, maps->count);
    for (GLsizei layer = 0; layer < layers; layer++) {
        if (!all && gl->lamp_solid_changes[layer] == maps->changes[layer])
            continue;
        gl->lamp_solid_changes[layer] = maps->changes[layer];
        const uint32_t *face = maps->texels + (size_t)layer * KILN_LAMP_SOLID_WORDS;
        for (uint32_t level = 0; level < KILN_LAMP_LEVELS; level++) {
            const GLsizei edge = KILN_LAMP_EDGE >> level;
            kiln_shadow_unpair(face, KILN_LAMP_EDGE, KILN_LAMP_SOLID_TEXEL, level, gl->texels);
            glTexSubImage3D(GL_TEXTURE_2D_ARRAY, (GLint)level, 0, 0, layer, edge, edge, 1, GL_RGBA,
                            GL_UNSIGNED_SHORT, gl->texels);
            gl->device->traffic.to_device +=
                sizeof *face * KILN_LAMP_SOLID_TEXEL * (size_t)edge * (size_t)edge;
        }
    }
}

static void make_lamp_smoke(struct kiln_lighting_gl *gl, uint32_t lamps)
{
    make(gl, LAMP_SMOKE, GL_LINEAR);
    if (gl->lamp_smoke_count >= lamps)
        return;
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_R32F, KILN_LAMP_SMOKE_WIDTH, KILN_LAMP_SMOKE_HEIGHT,
                 (GLsizei)(lamps * KILN_LAMP_SMOKE_LAYERS), 0, GL_RED, GL_FLOAT, NULL);
    gl->lamp_smoke_count = lamps;
}

static void send_lamp_smoke(struct kiln_lighting_gl *gl, const struct kiln_lighting *lighting)
{
    const uint32_t count = lighting->lamp_smoke_count;
    make_lamp_smoke(gl, count);
    glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, KILN_LAMP_SMOKE_WIDTH, KILN_LAMP_SMOKE_HEIGHT,
                    (GLsizei)(count * KILN_LAMP_SMOKE_LAYERS), GL_RED, GL_FLOAT,
                    lighting->lamp_smoke);
    gl->device->traffic.to_device += sizeof(float) * KILN_LAMP_SMOKE_MAP * count;
}

/* Sends the parts of lights that particles see, a layer for each plane of words. */
static void send_lamp_shade(struct kiln_lighting_gl *gl, const struct kiln_lighting *lighting)
{
    const GLenum target = GL_TEXTURE_2D_ARRAY;
    const size_t plane = kiln_lamp_shade_plane(lighting->slot_count);
    const GLsizei rows = (GLsizei)(plane / KILN_SUN_SHADE_ROW);
    const GLsizei planes = (GLsizei)((lighting->light_count + 3) / 4);
    const size_t words = plane * (size_t)planes;
    make(gl, LAMP_SHADE, GL_NEAREST);
    if (gl->lamp_shade_words < words) {
        glTexImage3D(target, 0, GL_R32UI, KILN_SUN_SHADE_ROW, rows, planes, 0, GL_RED_INTEGER,
                     GL_UNSIGNED_INT, NULL);
        gl->lamp_shade_words = words;
    }
    glTexSubImage3D(target, 0, 0, 0, 0, KILN_SUN_SHADE_ROW, rows, planes, GL_RED_INTEGER,
                    GL_UNSIGNED_INT, lighting->lamplit);
    gl->device->traffic.to_device += sizeof(uint32_t) * words;
}

struct kiln_lighting_gl *kiln_lighting_gl_create(struct kiln_device *device,
                                                 const struct kiln_lighting_textures *needed)
{
    struct kiln_lighting_gl *gl = calloc(1, sizeof *gl);
    if (!gl)
        return NULL;
    gl->device = device;
    if (needed->smoke)
        make_grid(gl, SMOKE_SKY);
    if (needed->smoke && needed->sun)
        make_grid(gl, SMOKE_SUN);
    if (needed->smoke && needed->lamps)
        make_lamp_smoke(gl, 1);
    if (needed->solids) {
        make_bins(gl);
        make_list(gl, SOLID_LIST, 1);
    }
    if (needed->instances) {
        make_list(gl, SOLID_TILES, 1);
        make_silhouettes(gl);
    }
    gl->solid_rows = needed->solids;
    if (needed->lamp_maps)
        make_faces(gl, LAMP_MAPS, 1);
    if (needed->lamp_solids)
        make_faces(gl, LAMP_SOLIDS, 1);
    glActiveTexture(GL_TEXTURE0);
    return gl;
}

bool kiln_lighting_bind(const struct kiln_lighting *lighting, struct kiln_error *error)
{
    struct kiln_lighting_gl *gl = lighting->gl;
    if (!gl) /* no light depends on particles */
        return true;
    if (gl->run != lighting->run) {
        gl->run = lighting->run;
        if (lighting->smoke)
            send_grid(gl, SMOKE_SKY, lighting->sky_depth);
        if (lighting->smoke && lighting->sun_depth)
            send_grid(gl, SMOKE_SUN, lighting->sun_depth);
        if (lighting->lamp_smoke_count > 0)
            send_lamp_smoke(gl, lighting);
        if (lighting->lamplit && lighting->light_count > 0)
            send_lamp_shade(gl, lighting);
        if (lighting->solids.edge > 0)
            send_solids(gl, &lighting->solids);
        if (lighting->sunlit)
            send_shade(gl, lighting);
        if (lighting->lamp_solids.count > 0)
            send_lamp_solids(gl, lighting);
        if (lighting->lamp_map_count > 0 && gl->lamp_map_changes != lighting->lamp_map_changes)
            send_lamp_maps(gl, lighting);
    }
    for (int i = 0; i < TEXTURE_COUNT; i++) {
        if (gl->textures[i])
            bind(gl, (enum texture)i);
    }
    glActiveTexture(GL_TEXTURE0);
    return kiln_device_check(gl->device, "lighting", error);
}
