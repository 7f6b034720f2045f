/* Casts rays at simple shapes in double precision to compute the light and depth of each pixel of a
 * backdrop, draws the backdrop with kiln, and compares the two. */
#include "support/ray_caster.h"

#include <stdlib.h>
#include <string.h>

#include "asset/geometry/mesh.h"
#include "support/backdrops.h"
#include "support/cmocka.h"

/* ---- the reference --------------------------------------------------------------------------- */

static struct vec cross(struct vec a, struct vec b)
{
    return (struct vec){{a.v[1] * b.v[2] - a.v[2] * b.v[1], a.v[2] * b.v[0] - a.v[0] * b.v[2],
                         a.v[0] * b.v[1] - a.v[1] * b.v[0]}};
}

/* The nearest hit of a ray so far, at origin + t * direction with t > 0. `any` is false while there
 * is no hit. */
struct found {
    double t;
    struct vec normal, albedo;
    bool any;
};

/* Replaces the nearest hit by a hit at t, if t is in front of the origin and nearer. */
static void keep(struct found *found, double t, struct vec normal, struct vec albedo)
{
    if (t > 1e-6 && (!found->any || t < found->t))
        *found = (struct found){t, normal, albedo, true};
}

/* Returns v rotated by angles.v[0] about x, then by angles.v[1] about y, then by angles.v[2] about
 * z, rad. With `back` set, applies the inverse rotation instead. */
static struct vec rotated(struct vec v, struct vec angles, bool back)
{
    for (int k = 0; k < 3; k++) {
        int axis = back ? 2 - k : k, a = (axis + 1) % 3, b = (axis + 2) % 3;
        double c = cos(angles.v[axis]), s = sin(angles.v[axis]) * (back ? -1 : 1);
        double va = c * v.v[a] - s * v.v[b], vb = s * v.v[a] + c * v.v[b];
        v.v[a] = va;
        v.v[b] = vb;
    }
    return v;
}

static void hit_box(const struct shape *s, struct vec from, struct vec way, struct found *found)
{
    struct vec o = along(rotated(along(from, s->center, -1), s->angles, true), s->center, 1);
    struct vec d = rotated(way, s->angles, true);
    double in = -1e30, out = 1e30;
    struct vec normal = {{0}};
    for (int i = 0; i < 3; i++) {
        double a = (s->center.v[i] - s->half_size.v[i] - o.v[i]) / d.v[i];
        double b = (s->center.v[i] + s->half_size.v[i] - o.v[i]) / d.v[i];
        if (fmin(a, b) > in) {
            in = fmin(a, b);
            normal = (struct vec){{0}};
            normal.v[i] = a < b ? -1 : 1;
        }
        out = fmin(out, fmax(a, b));
    }
    if (in < out)
        keep(found, in, rotated(normal, s->angles, false), s->albedo);
}

static void hit_sphere(const struct shape *s, struct vec o, struct vec d, struct found *found)
{
    struct vec q = along(o, s->center, -1);
    double a = dot(d, d), b = dot(q, d), c = dot(q, q) - s->radius * s->radius;
    if (b * b < a * c)
        return;
    double t = (-b - sqrt(b * b - a * c)) / a;
    keep(found, t, unit(along(q, d, t)), s->albedo);
}

static void hit_cylinder(const struct shape *s, struct vec o, struct vec d, struct found *found)
{
    struct vec q = along(o, s->center, -1);
    double h = dot(q, s->axis), climb = dot(d, s->axis);
    struct vec qf = along(q, s->axis, -h), df = along(d, s->axis, -climb);
    double a = dot(df, df), b = dot(qf, df), c = dot(qf, qf) - s->radius * s->radius;
    if (b * b >= a * c) {
        double t = (-b - sqrt(b * b - a * c)) / a;
        if (fabs(h + t * climb) <= s->half_height)
            keep(found, t, unit(along(qf, df, t)), s->albedo);
    }
    for (int end = -1; end <= 1; end += 2) {
        double t = (end * s->half_height - h) / climb;
        struct vec at = along(qf, df, t);
        if (dot(at, at) <= s->radius * s->radius && end * climb < 0)
            keep(found, t, along((struct vec){{0}}, s->axis, end), s->albedo);
    }
}

static void hit_plane(const struct shape *s, struct vec o, struct vec d, struct found *found)
{
    double climb = dot(d, s->axis);
    if (climb < 0)
        keep(found, dot(along(s->center, o, -1), s->axis) / climb, s->axis, s->albedo);
}

/* Finds where a ray first hits a capsule: on its cylinder or on one of the balls at its ends. Half
 * of each ball lies inside the capsule, but a ray from outside always hits the capsule's surface
 * first. */
static void hit_capsule(const struct shape *s, struct vec o, struct vec d, struct found *found)
{
    struct found outside = {.any = false};
    struct vec q = along(o, s->center, -1);
    double h = dot(q, s->axis), climb = dot(d, s->axis);
    struct vec qf = along(q, s->axis, -h), df = along(d, s->axis, -climb);
    double a = dot(df, df), b = dot(qf, df), c = dot(qf, qf) - s->radius * s->radius;
    if (b * b >= a * c) {
        double t = (-b - sqrt(b * b - a * c)) / a;
        if (fabs(h + t * climb) <= s->half_height)
            keep(&outside, t, unit(along(qf, df, t)), s->albedo);
    }
    for (int end = -1; end <= 1; end += 2) {
        struct shape ball = *s;
        ball.center = along(s->center, s->axis, end * s->half_height);
        hit_sphere(&ball, o, d, &outside);
    }
    if (outside.any)
        keep(found, outside.t, outside.normal, s->albedo);
}

/* Returns a vector of the mesh's file in the world's axes: scaled by `scale`, then rotated about y
 * by the shape's angle. */
static struct vec turned(const struct shape *s, const float v[3], double scale)
{
    double c = cos(s->angle), n = sin(s->angle);
    return (struct vec){{scale * (c * (double)v[0] + n * (double)v[2]), scale * (double)v[1],
                         scale * (c * (double)v[2] - n * (double)v[0])}};
}

static void hit_mesh(const struct shape *s, struct vec o, struct vec d, struct found *found)
{
    const struct kiln_mesh *mesh = s->mesh;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        struct vec p[3];
        for (int k = 0; k < 3; k++)
            p[k] = along(turned(s, mesh->vertices[mesh->triangles[i][k]], s->scale), s->center, 1);
        struct vec e1 = along(p[1], p[0], -1), e2 = along(p[2], p[0], -1), q = along(o, p[0], -1);
        struct vec n = cross(d, e2), m = cross(q, e1);
        double det = dot(e1, n), u = dot(q, n) / det, v = dot(d, m) / det, t = dot(e2, m) / det;
        if (det == 0 || u < 0 || v < 0 || u + v > 1)
            continue;
        struct vec normal = {{0}};
        const double weights[3] = {1 - u - v, u, v};
        for (int k = 0; k < 3; k++) {
            const float *vertex = mesh->vertices[mesh->triangles[i][k]];
            normal = along(normal, turned(s, vertex + 3, 1), weights[k]);
        }
        struct vec face = cross(e1, e2);
        if (dot(normal, face) * dot(face, d) > 0)
            normal = along((struct vec){{0}}, normal, -1);
        keep(found, t, unit(normal), s->albedo);
    }
}

static struct found trace(const struct shape *shapes, int count, struct vec o, struct vec d)
{
    struct found found = {.any = false};
    for (int i = 0; i < count; i++) {
        const struct shape *s = &shapes[i];
        if (s->kind == FLOOR)
            keep(&found, -o.v[1] / d.v[1], (struct vec){{0, 1, 0}}, s->albedo);
        else if (s->kind == BOX)
            hit_box(s, o, d, &found);
        else if (s->kind == SPHERE)
            hit_sphere(s, o, d, &found);
        else if (s->kind == CYLINDER)
            hit_cylinder(s, o, d, &found);
        else if (s->kind == CAPSULE)
            hit_capsule(s, o, d, &found);
        else if (s->kind == PLANE)
            hit_plane(s, o, d, &found);
        else
            hit_mesh(s, o, d, &found);
    }
    return found;
}

const struct vec eye = {{0, 2.5, 5}};

struct vec pixel_ray(double px, double py)
{
    struct vec forward = unit((struct vec){{0, -2, -5}}), right = {{1, 0, 0}};
    struct vec up = cross(right, forward);
    double tan_y = tan(20.0 * acos(-1.0) / 180.0);
    struct vec d = along(forward, right, (2 * px / WIDTH - 1) * tan_y * WIDTH / HEIGHT);
    return along(d, up, (1 - 2 * py / HEIGHT) * tan_y);
}

/* Returns which part, 0 to 1, of the disc of the sun or of a lamp is visible from `point`, so that
 * shadows get a penumbra. Casts rays at places on rings of the disc. sun: unit direction to the
 * disc's centre; radius: half of the disc's angular diameter, rad; reach: distance of the light, m,
 * beyond which an object does not hide it. */
static double sun_seen(const struct shape *shapes, int count, struct vec point, struct vec sun,
                       double radius, double reach)
{
    struct vec right = unit(cross((struct vec){{0.3, 1, 0.2}}, sun)), up = cross(sun, right);
    int seen = 0, rays = 0;
    const int rings = radius > 0 ? 12 : 1;
    for (int ring = 0; ring < rings; ring++) {
        int around = radius > 0 ? 6 * ring + 3 : 1;
        double r = radius > 0 ? tan(radius) * (ring + 0.5) / rings : 0;
        for (int k = 0; k < around; k++, rays++) {
            double a = 2 * acos(-1.0) * k / around;
            struct vec d = along(along(sun, right, r * cos(a)), up, r * sin(a));
            const struct found found = trace(shapes, count, point, d);
            seen += !found.any || found.t > reach;
        }
    }
    return (double)seen / rays;
}

/* ---- pictures -------------------------------------------------------------------------------- */

struct picture draw_below(void *device, const char *text, const char *asset_root)
{
    struct kiln_error error = {0};
    struct kiln_scene_params params = kiln_scene_defaults();
    params.asset_root = asset_root;
    struct picture p = {.scene = kiln_scene_parse(text, strlen(text), "test", &params, &error)};
    if (!p.scene)
        fail_msg("%s", error.message);
    kiln_image_init(&p.color, device, WIDTH, HEIGHT, GL_RGBA32F, "color");
    kiln_image_init(&p.depth, device, WIDTH, HEIGHT, GL_R32F, "depth");
    p.moment = calloc(1, sizeof *p.moment); /* allocated, since the stage keeps its address */
    assert_non_null(p.moment);
    if (!kiln_moment_init(p.moment, device, p.scene, NULL, &error) ||
        !kiln_moment_fill(p.moment, NULL, kiln_instant_at_step(0), false, &error))
        fail_msg("%s", error.message);
    p.stage = backdrop_create(device, p.moment, &p.color, &p.depth, &error);
    p.threads = kiln_threads_create(2);
    p.lights = p.threads ? kiln_lighting_create(device, p.moment, p.threads, &error) : NULL;
    struct kiln_lighting lighting;
    if (!p.stage || !p.lights || !kiln_lighting_run(p.lights, p.moment, NULL, &lighting, &error) ||
        !kiln_backdrop_draw(p.stage, p.moment, &lighting, &error))
        fail_msg("%s", error.message);
    p.colors = kiln_image_host(&p.color, KILN_READ, &error);
    p.depths = kiln_image_host(&p.depth, KILN_READ, &error);
    assert_true(p.colors && p.depths);
    return p;
}

struct picture draw(void *device, const char *text)
{
    return draw_below(device, text, KILN_SOURCE_DIR "/scenes");
}

void finish(struct picture *p)
{
    kiln_backdrop_destroy(&p->stage);
    kiln_lighting_destroy(&p->lights);
    kiln_threads_destroy(&p->threads);
    kiln_moment_finish(p->moment);
    free(p->moment);
    kiln_image_finish(&p->color);
    kiln_image_finish(&p->depth);
    kiln_scene_destroy(&p->scene);
}

/* Returns the attenuation, 0 to 1, of a spot light's cone for a surface. from: direction from the
 * lamp to the surface. Returns 1 for a lamp that is no spot. */
static double cone_part(const struct expected *e, struct vec from)
{
    if (e->lamp_outer <= 0)
        return 1;
    const double outer = cos(e->lamp_outer), inner = cos(e->lamp_inner);
    const double t = (dot(unit(from), e->lamp_facing) - outer) / (inner - outer);
    const double part = fmin(fmax(t, 0), 1);
    return part * part * (3 - 2 * part);
}

/* Returns the irradiance, divided by pi, of a point by a rectangular light of radiance 1. Sums over
 * PARTS x PARTS small parts of the rectangle, and casts a shadow ray to each of them. normal: unit
 * normal of the surface at the point. */
static double by_rectangle(const struct expected *e, struct vec point, struct vec normal)
{
    enum { PARTS = 14 };
    const struct vec across = cross(e->lamp_right, e->lamp_up);
    const double area = 4 * sqrt(dot(across, across)) / (PARTS * PARTS);
    double sum = 0;
    for (int i = 0; i < PARTS * PARTS; i++) {
        const double u = (2 * (i % PARTS) + 1.0) / PARTS - 1,
                     v = (2 * (i / PARTS) + 1.0) / PARTS - 1;
        const struct vec at = along(along(e->lamp, e->lamp_right, u), e->lamp_up, v);
        const struct vec way = along(at, point, -1);
        const double reach2 = dot(way, way), cosines = dot(way, normal) * -dot(way, e->lamp_facing);
        if (dot(way, normal) <= 0 || dot(way, e->lamp_facing) >= 0)
            continue;
        const struct found found = trace(e->shapes, e->count, point, way);
        if (!found.any || found.t > 1)
            sum += area * cosines / (reach2 * reach2);
    }
    return sum / acos(-1.0);
}

double light(const struct expected *e, double px, double py, double *depth)
{
    struct vec d = pixel_ray(px, py);
    struct found found = trace(e->shapes, e->count, eye, d);
    *depth = found.any ? found.t : 1e9;
    if (!found.any)
        return 0;
    struct vec point = along(along(eye, d, found.t), found.normal, 1e-3);
    if (dot(e->lamp_right, e->lamp_right) > 0)
        return e->lamp_color * found.albedo.v[0] * by_rectangle(e, point, found.normal);
    struct vec way = e->sun;
    double angle = e->sun_radius, reach = 1e30, bright = 1;
    if (e->lamp_color > 0) {
        way = along(e->lamp, point, -1);
        reach = sqrt(dot(way, way));
        way = unit(way);
        angle = atan(e->lamp_radius / reach);
        bright = e->lamp_color / (reach * reach + e->lamp_radius * e->lamp_radius);
        bright *= cone_part(e, along((struct vec){{0}}, way, -1));
    }
    double facing = fmax(dot(found.normal, way), 0);
    if (facing > 0)
        facing *= sun_seen(e->shapes, e->count, point, way, angle, reach);
    return bright * facing * found.albedo.v[0];
}

void compare(const struct picture *p, const struct expected *e, int step)
{
    int compared = 0, looked = 0;
    double worst = 0;
    for (int y = 0; y < HEIGHT; y += step) {
        for (int x = 0; x < WIDTH; x += step) {
            static const double corners[4][2] = {{0.1, 0.1}, {0.9, 0.1}, {0.1, 0.9}, {0.9, 0.9}};
            double depth, expected = light(e, x + 0.5, y + 0.5, &depth);
            bool even = true;
            for (int k = 0; k < 4; k++) {
                double other, aside = light(e, x + corners[k][0], y + corners[k][1], &other);
                even = even && fabs(aside - expected) < fmax(e->tolerance, 0.04) &&
                       fabs(other - depth) < 0.03 * depth;
            }
            looked++;
            if (!even)
                continue;
            compared++;
            double found = (double)p->colors[4 * (y * WIDTH + x)];
            double found_depth = (double)p->depths[y * WIDTH + x];
            if (fabs(found_depth - depth) > 3e-4 * depth)
                fail_msg("pixel %d,%d: depth %g, expected %g", x, y, found_depth, depth);
            worst = fmax(worst, fabs(found - expected));
            if (fabs(found - expected) > e->tolerance)
                fail_msg("pixel %d,%d: light %g, expected %g", x, y, found, expected);
        }
    }
    print_message("%d of %d pixels compared, worst %.3f\n", compared, looked, worst);
    assert_true(compared > looked * 3 / 4);
}

double sum_of_red(void *device, const char *text)
{
    double sum = 0;
    struct picture p = draw(device, text);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        sum += (double)p.colors[4 * i];
    finish(&p);
    return sum;
}
