/* Writes boxes and balls as OBJ files, and loads them as meshes, for tests of mesh colliders. */
#include "support/bodies.h"

#include <math.h>

#include "support/cmocka.h"

void add_box(struct body *body, double x, double y, double z, double w, double h, double d)
{
    static const int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (int i = 0; i < 8; i++)
        fprintf(body->out, "v %g %g %g\n", x + (i & 1 ? w : -w) / 2, y + (i & 2 ? h : -h) / 2,
                z + (i & 4 ? d : -d) / 2);
    for (int i = 0; i < 6; i++)
        fprintf(body->out, "f %d %d %d %d\n", body->count + 1 + faces[i][0],
                body->count + 1 + faces[i][1], body->count + 1 + faces[i][2],
                body->count + 1 + faces[i][3]);
    body->count += 8;
}

void add_ball(struct body *body)
{
    const int around = 2 * RINGS;
    const double pi = 3.14159265358979;
    for (int i = 1; i < RINGS; i++)
        for (int k = 0; k < around; k++)
            fprintf(body->out, "v %.9g %.9g %.9g\n", sin(pi * i / RINGS) * cos(2 * pi * k / around),
                    cos(pi * i / RINGS), sin(pi * i / RINGS) * sin(2 * pi * k / around));
    fprintf(body->out, "v 0 1 0\nv 0 -1 0\n");
    const int top = around * (RINGS - 1) + 1;
    for (int k = 0; k < around; k++) {
        const int a = k + 1, b = (k + 1) % around + 1, last = around * (RINGS - 2);
        fprintf(body->out, "f %d %d %d\nf %d %d %d\n", top, b, a, top + 1, last + a, last + b);
        for (int i = 0; i + 2 < RINGS; i++)
            fprintf(body->out, "f %d %d %d %d\n", i * around + a, i * around + b,
                    (i + 1) * around + b, (i + 1) * around + a);
    }
}

struct body begin(const char *path)
{
    struct body body = {.out = fopen(path, "w")};
    assert_non_null(body.out);
    return body;
}

struct kiln_mesh *body_load(const char *path)
{
    struct kiln_error error = {0};
    struct kiln_mesh *mesh = kiln_mesh_load(NULL, path, &error);
    if (!mesh)
        fail_msg("%s", error.message);
    return mesh;
}

struct kiln_mesh *body_load_ball(void)
{
    struct body body = begin("ball.obj");
    add_ball(&body);
    fclose(body.out);
    return body_load("ball.obj");
}

void body_write_box(const char *path, double w, double h, double d)
{
    struct body body = begin(path);
    add_box(&body, 0, 0, 0, w, h, d);
    fclose(body.out);
}
