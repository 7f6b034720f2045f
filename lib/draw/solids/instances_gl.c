/* This file draws particles that are meshes in GL, with one instanced draw call for each system
 * that has a mesh. A call draws an instance for each draw entry, and the vertex shader discards the
 * entries of other systems, since only the device knows where in the list they are. */
#include "draw/solids/instances_gl.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/error.h"
#include "draw/moment/moment_gl.h"
#include "gpu/program.h"

struct kiln_instances_gl {
    struct kiln_device *device;
    const struct kiln_scene *scene;
    const struct kiln_instances *meshes;
    GLuint corners, vertex_array;
    GLuint program;
    GLint system, first, orient, extent; /* uniforms */
};

static bool create_program(struct kiln_instances_gl *m, struct kiln_error *error)
{
    const struct kiln_shape_features features = kiln_shape_features(m->scene);
    const struct kiln_program_params files = {.vertex = "draw/solids/instances.vert",
                                              .fragment = "draw/solids/instances.frag"};
    struct kiln_text defines = {0};
    kiln_shape_defines(&features, &defines);
    if (kiln_scene_spins(m->scene))
        kiln_text_add(&defines, "#define SPINS 1\n");
    kiln_moment_gl_defines(m->scene, &defines);
    m->program = kiln_program_create_defined(m->device, &files, &defines, error);
    if (!m->program)
        return false;
    m->system = glGetUniformLocation(m->program, "drawn_system");
    m->first = glGetUniformLocation(m->program, "first_corner");
    m->orient = glGetUniformLocation(m->program, "orient");
    m->extent = glGetUniformLocation(m->program, "extent");
    return true;
}

static bool upload(struct kiln_instances_gl *m, struct kiln_error *error)
{
    size_t size = m->meshes->corner_count * sizeof *m->meshes->corners;
    glGenVertexArrays(1, &m->vertex_array);
    glGenBuffers(1, &m->corners);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, m->corners);
    glBufferData(GL_SHADER_STORAGE_BUFFER, (GLsizeiptr)size, m->meshes->corners, GL_STATIC_DRAW);
    kiln_device_label(m->device, GL_BUFFER, m->corners, "meshes of particles");
    return kiln_device_check(m->device, "meshes of particles", error);
}

struct kiln_instances_gl *kiln_instances_gl_create(struct kiln_device *device,
                                                   const struct kiln_moment *moment,
                                                   struct kiln_error *error)
{
    struct kiln_instances_gl *m = calloc(1, sizeof *m);
    if (!m) {
        kiln_error_no_memory(error, "meshes of particles");
        return NULL;
    }
    m->device = device;
    m->scene = moment->scene;
    m->meshes = &moment->instances;
    if (!upload(m, error) || !create_program(m, error))
        kiln_instances_gl_destroy(&m);
    return m;
}

void kiln_instances_gl_destroy(struct kiln_instances_gl **meshes)
{
    struct kiln_instances_gl *m = *meshes;
    if (!m)
        return;
    if (m->program)
        glDeleteProgram(m->program);
    glDeleteBuffers(1, &m->corners); /* 0 is ignored */
    glDeleteVertexArrays(1, &m->vertex_array);
    free(m);
    *meshes = NULL;
}

bool kiln_instances_gl_draw(struct kiln_instances_gl *meshes, uint32_t count,
                            struct kiln_error *error)
{
    glUseProgram(meshes->program);
    glBindVertexArray(meshes->vertex_array);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, KILN_BIND_CORNERS, meshes->corners);
    for (uint32_t i = 0; count > 0 && i < meshes->scene->system_count; i++) {
        const struct kiln_instance_mesh *mesh = &meshes->meshes->meshes[i];
        const struct kiln_look *look = &meshes->scene->systems[i].look;
        if (mesh->triangles == 0)
            continue;
        glUniform1ui(meshes->system, i);
        glUniform1ui(meshes->first, mesh->first);
        glUniform1ui(meshes->orient, (GLuint)look->mesh.orient);
        glUniform2f(meshes->extent, mesh->reach, look->mesh.shade);
        glDrawArraysInstanced(GL_TRIANGLES, 0, (GLsizei)(3 * mesh->triangles), (GLsizei)count);
    }
    return kiln_device_check(meshes->device, "meshes of particles", error);
}
