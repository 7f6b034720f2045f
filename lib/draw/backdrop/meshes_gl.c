/* This file rasterises meshes in GL for the backdrop's rays, and draws their shadow maps. Triangles
 * are rasterised five times, for the rays through the centres of pixels and for each of the four
 * samples of a pixel at an edge, into layers of one integer texture. Each mesh has a shadow map in
 * a layer of its own, which fits the mesh however far apart meshes are. Shadow maps are drawn again
 * only when a mesh or the sun moved. */
#include "draw/backdrop/meshes_gl.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "gpu/program.h"
#include "shared/exact.h"

enum { HIT_LAYERS = 1 + KILN_EDGE_SAMPLES };

struct drawn_mesh {
    GLuint vertex_array, vertices, triangles, uvs; /* 0: none */
    GLsizei indices;
    float posed_s; /* posed_s of struct kiln_meshes at the last upload */
};

struct kiln_meshes_gl {
    struct kiln_device *device;
    const struct kiln_meshes *meshes;
    uint32_t width, height, count;
    struct drawn_mesh drawn[KILN_MAX_MESHES];
    GLuint hit_program, shadow_program;
    GLint hit_mesh, hit_shift, shadow_mesh;  /* uniforms */
    GLuint hits, shadows;                    /* array textures */
    GLuint paint;                            /* array texture; 0: no mesh takes paint */
    uint32_t paint_changes[KILN_MAX_MESHES]; /* kiln_painted_changes that it shows */
    const struct kiln_painted *painted;
    GLuint hit_depth, shadow_depth; /* renderbuffers */
    GLuint framebuffer;
    struct kiln_draw_mesh shadowed[KILN_MAX_MESHES]; /* the meshes as the shadow maps show them */
    float4 shadow_sun[2];
    bool has_shadows;
};

static void upload(struct kiln_device *device, const struct kiln_mesh *mesh,
                   struct drawn_mesh *drawn)
{
    const size_t stride = sizeof *mesh->vertices;
    glGenVertexArrays(1, &drawn->vertex_array);
    glBindVertexArray(drawn->vertex_array);
    glGenBuffers(1, &drawn->vertices);
    glBindBuffer(GL_ARRAY_BUFFER, drawn->vertices);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(mesh->vertex_count * stride), mesh->vertices,
                 GL_STATIC_DRAW);
    glGenBuffers(1, &drawn->triangles);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, drawn->triangles);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                 (GLsizeiptr)(mesh->triangle_count * sizeof *mesh->triangles), mesh->triangles,
                 GL_STATIC_DRAW);
    glVertexAttribFormat(0, 3, GL_FLOAT, GL_FALSE, 0);
    glVertexAttribBinding(0, 0);
    glVertexAttribFormat(1, 3, GL_FLOAT, GL_FALSE, 3 * sizeof(float));
    glVertexAttribBinding(1, 0);
    glBindVertexBuffer(0, drawn->vertices, 0, (GLsizei)stride);
    glEnableVertexAttribArray(0);
    glEnableVertexAttribArray(1);
    if (mesh->uvs) {
        const size_t uv = sizeof *mesh->uvs;
        glGenBuffers(1, &drawn->uvs);
        glBindBuffer(GL_ARRAY_BUFFER, drawn->uvs);
        glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(mesh->vertex_count * uv), mesh->uvs,
                     GL_STATIC_DRAW);
        glVertexAttribFormat(2, 2, GL_FLOAT, GL_FALSE, 0);
        glVertexAttribBinding(2, 1);
        glBindVertexBuffer(1, drawn->uvs, 0, (GLsizei)uv);
        glEnableVertexAttribArray(2);
        kiln_device_label(device, GL_BUFFER, drawn->uvs, "texture coordinates of a mesh");
    }
    glBindVertexArray(0);
    drawn->indices = (GLsizei)(mesh->triangle_count * 3);
    kiln_device_label(device, GL_BUFFER, drawn->vertices, "mesh");
}

static GLuint create_layers(GLenum format, GLenum layout, GLenum type, GLsizei width,
                            GLsizei height, GLsizei layers)
{
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture);
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, (GLint)format, width, height, layers, 0, layout, type,
                 NULL);
    return texture;
}

static GLuint create_depth(GLsizei width, GLsizei height)
{
    GLuint buffer = 0;
    glGenRenderbuffers(1, &buffer);
    glBindRenderbuffer(GL_RENDERBUFFER, buffer);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, width, height);
    return buffer;
}

static void create_targets(struct kiln_meshes_gl *m)
{
    GLsizei width = (GLsizei)m->width, height = (GLsizei)m->height;
    m->hits = m->painted ? create_layers(GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT, width,
                                         height, HIT_LAYERS)
                         : create_layers(GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT, width, height,
                                         HIT_LAYERS);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    m->hit_depth = create_depth(width, height);

    m->shadows = create_layers(GL_RG32F, GL_RG, GL_FLOAT, KILN_SHADOW_EDGE, KILN_SHADOW_EDGE,
                               (GLsizei)m->count);
    const float nothing[4] = {0.0f, 0.0f, 0.0f, 0.0f};
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
    glTexParameterfv(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_BORDER_COLOR, nothing);
    glGenerateMipmap(GL_TEXTURE_2D_ARRAY);
    m->shadow_depth = create_depth(KILN_SHADOW_EDGE, KILN_SHADOW_EDGE);
    glGenFramebuffers(1, &m->framebuffer);
    kiln_device_label(m->device, GL_TEXTURE, m->hits, "mesh hits");
    kiln_device_label(m->device, GL_TEXTURE, m->shadows, "mesh shadows");
}

/* Creates layers as large as the largest texture; smaller textures begin at a coarser level
 * (shapes.c). */
static void create_paint(struct kiln_meshes_gl *m)
{
    uint32_t levels = 1, layers = 0, edge = 1;
    for (uint32_t i = 0; i < m->count; i++) {
        const struct kiln_pyramid *p = kiln_painted_picture(m->painted, i);
        if (!p)
            continue;
        layers++;
        levels = p->levels > levels ? p->levels : levels;
        edge = p->width > edge ? p->width : edge;
    }
    glGenTextures(1, &m->paint);
    glBindTexture(GL_TEXTURE_2D_ARRAY, m->paint);
    glTexStorage3D(GL_TEXTURE_2D_ARRAY, (GLsizei)levels, GL_RGBA16F, (GLsizei)edge, (GLsizei)edge,
                   (GLsizei)layers);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_S, GL_REPEAT);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_WRAP_T, GL_REPEAT);
    kiln_device_label(m->device, GL_TEXTURE, m->paint, "paint");
}

static bool create_programs(struct kiln_meshes_gl *m, struct kiln_error *error)
{
    char defines[80];
    snprintf(defines, sizeof defines, "%s%s", m->painted ? "#define PAINT 1\n" : "",
             m->count > KILN_FEW_MESHES ? "#define MANY_MESHES 1\n" : "");
    m->hit_program =
        kiln_program_create(m->device,
                            &(struct kiln_program_params){.vertex = "draw/backdrop/meshes.vert",
                                                          .fragment = "draw/backdrop/meshes.frag",
                                                          .defines = defines},
                            error);
    if (!m->hit_program)
        return false;
    m->shadow_program = kiln_program_create(
        m->device,
        &(struct kiln_program_params){.vertex = "draw/backdrop/meshes_shadow.vert",
                                      .fragment = "draw/backdrop/meshes_shadow.frag"},
        error);
    if (!m->shadow_program)
        return false;
    m->hit_mesh = glGetUniformLocation(m->hit_program, "mesh");
    m->hit_shift = glGetUniformLocation(m->hit_program, "shift");
    m->shadow_mesh = glGetUniformLocation(m->shadow_program, "mesh");
    return true;
}

struct kiln_meshes_gl *kiln_meshes_gl_create(struct kiln_device *device,
                                             const struct kiln_scene *scene,
                                             const struct kiln_meshes *meshes,
                                             struct kiln_error *error)
{
    struct kiln_meshes_gl *m = calloc(1, sizeof *m);
    if (!m) {
        kiln_error_no_memory(error, "the meshes");
        return NULL;
    }
    m->device = device;
    m->meshes = meshes;
    m->width = scene->width;
    m->height = scene->height;
    m->count = meshes->count;
    m->painted = meshes->painted;
    if (m->count == 0)
        return m;
    bool ok = create_programs(m, error);
    for (uint32_t i = 0; ok && i < m->count; i++) {
        upload(device, meshes->loaded[i], &m->drawn[i]);
        m->drawn[i].posed_s = meshes->posed_s[i];
    }
    if (ok)
        create_targets(m);
    if (ok && m->painted)
        create_paint(m);
    ok = kiln_device_check(device, "meshes", error) && ok;
    if (!ok)
        kiln_meshes_gl_destroy(&m);
    return m;
}

void kiln_meshes_gl_destroy(struct kiln_meshes_gl **meshes)
{
    struct kiln_meshes_gl *m = *meshes;
    if (!m)
        return;
    for (uint32_t i = 0; i < m->count; i++) {
        glDeleteVertexArrays(1, &m->drawn[i].vertex_array); /* 0 is ignored, here and below */
        glDeleteBuffers(1, &m->drawn[i].vertices);
        glDeleteBuffers(1, &m->drawn[i].triangles);
        glDeleteBuffers(1, &m->drawn[i].uvs);
    }
    glDeleteProgram(m->hit_program);
    glDeleteProgram(m->shadow_program);
    glDeleteTextures(1, &m->hits);
    glDeleteTextures(1, &m->shadows);
    glDeleteTextures(1, &m->paint);
    glDeleteRenderbuffers(1, &m->hit_depth);
    glDeleteRenderbuffers(1, &m->shadow_depth);
    glDeleteFramebuffers(1, &m->framebuffer);
    free(m);
    *meshes = NULL;
}

static void draw_mesh(const struct drawn_mesh *mesh)
{
    glBindVertexArray(mesh->vertex_array);
    glDrawElements(GL_TRIANGLES, mesh->indices, GL_UNSIGNED_INT, NULL);
}

static void draw_hits(struct kiln_meshes_gl *m)
{
#define PAIR(x, y)                                                                                 \
    {                                                                                              \
        x, y                                                                                       \
    }
    static const float offsets[HIT_LAYERS][2] = {{0.5f, 0.5f}, KILN_EDGE_OFFSETS(PAIR)};
#undef PAIR
    static const GLuint nothing[4] = {0, 0, 0, 0};
    static const GLfloat farthest = 0.0f;
    glViewport(0, 0, (GLsizei)m->width, (GLsizei)m->height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, m->hit_depth);
    glUseProgram(m->hit_program);
    glDepthFunc(GL_GREATER);
    for (int layer = 0; layer < HIT_LAYERS; layer++) {
        glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, m->hits, 0, layer);
        glClearBufferuiv(GL_COLOR, 0, nothing);
        glClearBufferfv(GL_DEPTH, 0, &farthest);
        glUniform2f(m->hit_shift, 0.5f - offsets[layer][0], 0.5f - offsets[layer][1]);
        for (uint32_t i = 0; i < m->count; i++) {
            glUniform1i(m->hit_mesh, (GLint)i);
            draw_mesh(&m->drawn[i]);
        }
    }
    glDepthFunc(GL_LESS);
}

static void draw_shadows(struct kiln_meshes_gl *m)
{
    static const GLfloat nothing[4] = {0.0f, 0.0f, 0.0f, 0.0f};
    static const GLfloat far = 1.0f;
    glViewport(0, 0, KILN_SHADOW_EDGE, KILN_SHADOW_EDGE);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                              m->shadow_depth);
    glUseProgram(m->shadow_program);
    for (uint32_t i = 0; i < m->count; i++) {
        glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, m->shadows, 0, (GLint)i);
        glClearBufferfv(GL_COLOR, 0, nothing);
        glClearBufferfv(GL_DEPTH, 0, &far);
        glUniform1i(m->shadow_mesh, (GLint)i);
        draw_mesh(&m->drawn[i]);
    }
    glGenerateMipmap(GL_TEXTURE_2D_ARRAY);
}

/* Returns whether the shadow maps are up to date. Colours do not matter for shadows, but are
 * compared too, since they rarely change alone. */
static bool same_shadows(const struct kiln_meshes_gl *m, const struct kiln_draw_shapes *shapes)
{
    return m->has_shadows && memcmp(&m->shadow_sun[0], &shapes->sun_right, sizeof(float4)) == 0 &&
           memcmp(&m->shadow_sun[1], &shapes->sun_up, sizeof(float4)) == 0 &&
           memcmp(m->shadowed, shapes->meshes, sizeof m->shadowed) == 0;
}

static void bind_layers(GLenum unit, GLuint texture)
{
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture);
}

static void upload_paint(struct kiln_meshes_gl *m, const struct kiln_draw_shapes *shapes)
{
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glBindTexture(GL_TEXTURE_2D_ARRAY, m->paint);
    for (uint32_t i = 0; i < m->count; i++) {
        const struct kiln_pyramid *p = kiln_painted_picture(m->painted, i);
        if (!p || kiln_painted_changes(m->painted, i) == m->paint_changes[i])
            continue;
        const int32_t paint = exact_int(shapes->meshes[i].color.w);
        const GLint layer = KILN_PAINT_LAYER(paint), first = KILN_PAINT_LEVEL(paint);
        for (uint32_t level = 0; level < p->levels; level++)
            glTexSubImage3D(GL_TEXTURE_2D_ARRAY, first + (GLint)level, 0, 0, layer,
                            (GLsizei)p->widths[level], (GLsizei)p->heights[level], 1, GL_RGBA,
                            GL_HALF_FLOAT, p->texels + p->first[level]);
        m->paint_changes[i] = kiln_painted_changes(m->painted, i);
    }
}

void kiln_meshes_gl_bind_shadows(const struct kiln_meshes_gl *meshes)
{
    if (meshes->shadows)
        bind_layers(KILN_UNIT_MESH_SHADOW, meshes->shadows);
    glActiveTexture(GL_TEXTURE0);
}

/* Uploads the vertices of meshes whose pose changed since the last upload. */
static void upload_poses(struct kiln_meshes_gl *m)
{
    for (uint32_t i = 0; i < m->count; i++) {
        const struct kiln_mesh *mesh = m->meshes->loaded[i];
        if (m->drawn[i].posed_s == m->meshes->posed_s[i])
            continue;
        m->drawn[i].posed_s = m->meshes->posed_s[i];
        glBindBuffer(GL_ARRAY_BUFFER, m->drawn[i].vertices);
        glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(mesh->vertex_count * sizeof *mesh->vertices),
                     mesh->vertices, GL_DYNAMIC_DRAW);
    }
}

bool kiln_meshes_gl_draw(struct kiln_meshes_gl *meshes, const struct kiln_draw_shapes *shapes,
                         struct kiln_error *error)
{
    if (meshes->count == 0)
        return true;
    upload_poses(meshes);
    glBindFramebuffer(GL_FRAMEBUFFER, meshes->framebuffer);
    glDisable(GL_BLEND);
    glEnable(GL_DEPTH_TEST);
    bind_layers(KILN_UNIT_MESH_HITS, 0);
    bind_layers(KILN_UNIT_MESH_SHADOW, meshes->shadows);
    draw_hits(meshes);
    if (!same_shadows(meshes, shapes)) {
        draw_shadows(meshes);
        meshes->shadow_sun[0] = shapes->sun_right;
        meshes->shadow_sun[1] = shapes->sun_up;
        memcpy(meshes->shadowed, shapes->meshes, sizeof meshes->shadowed);
        meshes->has_shadows = true;
    }
    glDisable(GL_DEPTH_TEST);
    bind_layers(KILN_UNIT_MESH_HITS, meshes->hits);
    if (meshes->paint) {
        bind_layers(KILN_UNIT_MESH_PAINT, meshes->paint);
        upload_paint(meshes, shapes);
    }
    glActiveTexture(GL_TEXTURE0);
    return kiln_device_check(meshes->device, "meshes", error);
}
