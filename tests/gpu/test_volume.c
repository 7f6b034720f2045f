/* Compares kiln's volumes (lib/sim/world/voxels.h), lattices of cells in which each cell that a
 * mesh touches keeps a triangle's plane, with volumes rendered by GL as in Drone 2007, 7.5.2.1:
 * each slice of the volume is rasterised, a geometry shader clips the triangles to the slice, and
 * the depth test keeps the nearest. GL misses cells, since it asks only whether a triangle covers a
 * pixel's centre. The test prints how many cells GL misses and how often it keeps another triangle
 * (for docs/volumes.md), and limits both. If it fails, kiln's volumes lack planes or keep wrong
 * ones. kiln itself never renders volumes by GL. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "sim/world/voxels.h"
#include "support/cmocka.h"
#include "support/device.h"

enum { RINGS = 24, AROUND = 48, VERTICES = (RINGS + 1) * AROUND, TRIANGLES = 2 * RINGS * AROUND };

static struct {
    float vertices[VERTICES][3];
    uint32_t triangles[TRIANGLES][3];
} ball; /* a sphere of radius 1 m; half of the triangles at its poles have no area */

static void make_ball(void)
{
    const double pi = 3.14159265358979;
    for (uint32_t i = 0; i < VERTICES; i++) {
        const double down = pi * (i / AROUND) / RINGS, turn = 2 * pi * (i % AROUND) / AROUND;
        ball.vertices[i][0] = (float)(sin(down) * cos(turn));
        ball.vertices[i][1] = (float)cos(down);
        ball.vertices[i][2] = (float)(sin(down) * sin(turn));
    }
    for (uint32_t i = 0; i < TRIANGLES; i++) {
        const uint32_t row = i / 2 / AROUND, a = i / 2 % AROUND, b = (a + 1) % AROUND;
        const uint32_t here = row * AROUND, below = here + AROUND;
        const uint32_t halves[2][3] = {{here + a, here + b, below + b},
                                       {here + a, below + b, below + a}};
        memcpy(ball.triangles[i], halves[i % 2], sizeof ball.triangles[i]);
    }
}

static const char VERTEX[] = "#version 450\n"
                             "layout(location = 0) in vec3 cells;\n"
                             "out vec3 place;\n"
                             "flat out int slice;\n"
                             "void main() { place = cells; slice = gl_InstanceID; }\n";

/* The view is along -z, so the place with the greatest z is the nearest. */
static const char GEOMETRY[] = "#version 450\n"
                               "layout(triangles) in;\n"
                               "layout(triangle_strip, max_vertices = 3) out;\n"
                               "in gl_PerVertex { vec4 gl_Position; } gl_in[];\n"
                               "out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[2]; };\n"
                               "in vec3 place[];\n"
                               "flat in int slice[];\n"
                               "flat out uint triangle;\n"
                               "uniform vec3 size;\n"
                               "void main()\n"
                               "{\n"
                               "    for (int i = 0; i < 3; i++) {\n"
                               "        vec3 at = 2.0 * place[i] / size - 1.0;\n"
                               "        gl_Position = vec4(at.xy, -at.z, 1.0);\n"
                               "        gl_ClipDistance[0] = place[i].z - float(slice[0]);\n"
                               "        gl_ClipDistance[1] = float(slice[0] + 1) - place[i].z;\n"
                               "        gl_Layer = slice[0];\n"
                               "        triangle = uint(gl_PrimitiveIDIn);\n"
                               "        EmitVertex();\n"
                               "    }\n"
                               "}\n";

static const char FRAGMENT[] = "#version 450\n"
                               "flat in uint triangle;\n"
                               "layout(location = 0) out uint kept;\n"
                               "void main() { kept = triangle + 1u; }\n";

static void attach(GLuint program, GLenum stage, const char *source)
{
    const GLuint shader = glCreateShader(stage);
    GLint compiled = 0;
    glShaderSource(shader, 1, &source, NULL);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (!compiled) {
        char text[1024];
        glGetShaderInfoLog(shader, sizeof text, NULL, text);
        fail_msg("%s", text);
    }
    glAttachShader(program, shader);
    glDeleteShader(shader);
}

static GLuint make_program(void)
{
    const GLuint program = glCreateProgram();
    GLint linked = 0;
    attach(program, GL_VERTEX_SHADER, VERTEX);
    attach(program, GL_GEOMETRY_SHADER, GEOMETRY);
    attach(program, GL_FRAGMENT_SHADER, FRAGMENT);
    glLinkProgram(program);
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    assert_true(linked);
    return program;
}

static GLuint make_slices(const struct kiln_voxels *v, GLenum format, GLenum attachment)
{
    GLuint texture;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture);
    glTexStorage3D(GL_TEXTURE_2D_ARRAY, 1, format, (GLsizei)v->size[0], (GLsizei)v->size[1],
                   (GLsizei)v->size[2]);
    glFramebufferTexture(GL_FRAMEBUFFER, attachment, texture, 0);
    return texture;
}

/* Makes buffers of the ball's vertices, in units of cells, and of its triangles, and attaches them
 * to the bound vertex array. */
static void make_buffers(const struct kiln_voxels *v, GLuint buffers[2])
{
    static float cells[VERTICES][3];
    for (uint32_t i = 0; i < VERTICES; i++)
        for (int c = 0; c < 3; c++)
            cells[i][c] = (ball.vertices[i][c] - v->origin[c]) * v->per_metre;
    glGenBuffers(2, buffers);
    glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    glBufferData(GL_ARRAY_BUFFER, sizeof cells, cells, GL_STATIC_DRAW);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, NULL);
    glEnableVertexAttribArray(0);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, sizeof ball.triangles, ball.triangles, GL_STATIC_DRAW);
}

/* Renders the volume by GL. For each cell, writes 1 + the number of the triangle that it keeps, or
 * 0 if it has none. */
static void draw(const struct kiln_voxels *v, uint32_t *kept)
{
    GLuint array, framebuffer, buffers[2];
    const GLuint program = make_program();
    const GLuint none[4] = {0, 0, 0, 0};
    const GLfloat far = 1.0f;
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    make_buffers(v, buffers);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    GLuint textures[2] = {make_slices(v, GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT),
                          make_slices(v, GL_R32UI, GL_COLOR_ATTACHMENT0)};
    assert_int_equal(glCheckFramebufferStatus(GL_FRAMEBUFFER), GL_FRAMEBUFFER_COMPLETE);
    glViewport(0, 0, (GLsizei)v->size[0], (GLsizei)v->size[1]);
    glUseProgram(program);
    glUniform3f(glGetUniformLocation(program, "size"), (float)v->size[0], (float)v->size[1],
                (float)v->size[2]);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
    glEnable(GL_CLIP_DISTANCE0);
    glEnable(GL_CLIP_DISTANCE0 + 1);
    glClearBufferuiv(GL_COLOR, 0, none);
    glClearBufferfv(GL_DEPTH, 0, &far);
    glDrawElementsInstanced(GL_TRIANGLES, 3 * TRIANGLES, GL_UNSIGNED_INT, NULL,
                            (GLsizei)v->size[2]);
    glGetTexImage(GL_TEXTURE_2D_ARRAY, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, kept);
    glDisable(GL_CLIP_DISTANCE0);
    glDisable(GL_CLIP_DISTANCE0 + 1);
    glDisable(GL_DEPTH_TEST);
    glUseProgram(0);
    glBindVertexArray(0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteTextures(2, textures);
    glDeleteBuffers(2, buffers);
    glDeleteVertexArrays(1, &array);
    glDeleteProgram(program);
}

/* Builds kiln's volume of the ball, without GL. spacing: the edge of a cell, m. */
static void build(struct kiln_voxels *voxels, float spacing)
{
    struct kiln_error error = {0};
    struct kiln_threads *threads = kiln_threads_create(2);
    const struct kiln_voxels_input input = {
        .before = (const float(*)[3])ball.vertices,
        .after = (const float(*)[3])ball.vertices,
        .vertex_count = VERTICES,
        .triangles = (const uint32_t(*)[3])ball.triangles,
        .triangle_count = TRIANGLES,
        .spacing = spacing,
        .heading = {0.0f, 0.0f, -1.0f},
    };
    assert_non_null(threads);
    assert_true(kiln_voxels_build(voxels, &input, threads, &error));
    kiln_threads_destroy(&threads);
}

/* Each cell that GL fills has a plane in kiln's volume, too, in more than 9 of 10 cells that of the
 * same triangle. GL leaves out cells in which no triangle crosses the line along the view through
 * the cell's centre: about two thirds of a sphere's cells, at its sides. */
static void the_rasteriser_leaves_out_cells(void **state)
{
    (void)state;
    make_ball();
    static const float spacings[] = {0.2f, 0.08f};
    for (int s = 0; s < 2; s++) {
        struct kiln_voxels v = {.plane_count = 0};
        build(&v, spacings[s]);
        const size_t count = (size_t)v.size[0] * v.size[1] * v.size[2];
        uint32_t *kept = calloc(count, sizeof *kept);
        assert_non_null(kept);
        draw(&v, kept);
        uint32_t both = 0, same = 0, missing = 0, added = 0;
        for (size_t i = 0; i < count; i++) {
            const bool ours = v.marks[i] > 0.0f;
            missing += ours && kept[i] == 0;
            added += !ours && kept[i] != 0;
            if (!ours || kept[i] == 0)
                continue;
            both++;
            same += v.planes[(uint32_t)v.marks[i] - 1].triangle == kept[i] - 1;
        }
        print_message("%u cells: %.1f %% without a plane, %.1f %% with another\n", both + missing,
                      100.0 * missing / (both + missing), 100.0 * (both - same) / both);
        assert_int_equal(added, 0);
        assert_true(both > 100 && missing > both / 2 && missing < 3 * both);
        assert_true(same < both && same > both * 9 / 10);
        free(kept);
        kiln_voxels_finish(&v);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        test_on_device(the_rasteriser_leaves_out_cells),
    };
    return cmocka_run_group_tests_name("volume", tests, test_device_open, test_device_close);
}
