/* Checks that each raster technique draws particles with the right place, direction, size and
 * opacity: billboards of every facing, points, and lines (Heinz 2019, 2.1.1). A camera with a roll
 * draws one particle, and the test compares it with a plane, disc or segment that it computes in
 * the world. If this fails, particles face or stretch in the wrong direction, or have the wrong
 * size. */
#include <stddef.h>
#include <stdint.h>

#include "support/cmocka.h"
#include "support/device.h"
#include "support/drawing.h"

enum { WIDTH = 320, HEIGHT = 240, PIXELS = WIDTH * HEIGHT, STEP = 30 };

/* The wall at depth 10 m and the soft-particle fade make alpha (10 - depth) * 0.08. System b has no
 * particles, but its shape `point` makes techniques take the program that draws all shapes. */
static const char SCENE[] =
    "kiln: 1\n"
    "output: {size: [320, 240], fps: 30, frames: 100}\n"
    "simulation: {rate: 60}\n"
    "camera: {position: [1, 3.5, 3], target: [0.2, 1, 0.1], fov: 60 deg, roll: 25 deg, near: 0.1}\n"
    "backdrop: {haze: 0}\n"
    "systems:\n"
    "  a:\n"
    "    emit: {rate: 1, life: 10 s}\n"
    "    look: {size: 1.2 m, rotation: 0 deg, soft: 0.08, fade: {in: 0, out: 0}, near_fade: 0 m}\n"
    "  b: {enabled: true, emit: {rate: 1}, look: {shape: point}}\n";

static const double WALL_M = 10, SOFT = 0.08;
static const float3 POSITION = {0.9f, 1.3f, 0.4f}, VELOCITY = {1.0f, 2.0f, -0.5f};

struct billboard {
    vec center, right, up, normal; /* m; right, up: unit vectors, or half edges once scaled */
    bool mirrored;
};

/* Returns the plane of a billboard at POSITION, with unit vectors, by the definitions of Heinz
 * 2019, 2.1.1. axis: of the facing KILN_FACING_AXIAL, of any length. */
static struct billboard plane_of(const struct drawing *d, enum kiln_facing facing, vec axis)
{
    const vec y = {0, 1, 0};
    struct billboard b = {.center = vec_of(POSITION), .normal = drawing_axis(d, 2)};
    vec to_eye = vec_unit(vec_add(drawing_eye(d), b.center, -1));
    if (facing == KILN_FACING_VIEWPOINT)
        b.normal = to_eye;
    vec upward = facing == KILN_FACING_SCREEN     ? drawing_axis(d, 1)
                 : facing == KILN_FACING_AXIAL    ? vec_unit(axis)
                 : facing == KILN_FACING_VELOCITY ? vec_of(VELOCITY)
                                                  : y;
    if (facing == KILN_FACING_AXIAL)
        b.normal = vec_add(to_eye, upward, -vec_dot(to_eye, upward));
    b.normal = vec_unit(b.normal);
    b.up = vec_unit(vec_add(upward, b.normal, -vec_dot(upward, b.normal)));
    b.right = vec_cross(b.up, b.normal);
    return b;
}

/* Rotates a billboard by an angle, rad, counterclockwise as the viewer sees it, and scales its unit
 * vectors to half of its width and height, m. */
static void turn_and_scale(struct billboard *b, double angle, double half_width, double half_height)
{
    vec up = vec_add((vec){0}, b->up, cos(angle) * half_height);
    vec right = vec_add((vec){0}, b->right, cos(angle) * half_width);
    vec old_up = b->up;
    b->up = vec_add(up, b->right, -sin(angle) * half_height);
    b->right = vec_add(right, old_up, sin(angle) * half_width);
}

/* Returns whether the billboard of a particle is mirrored. Particles that spin backwards are
 * mirrored; the serial chooses them at random, and they are half of all (billboard_side in
 * shared/billboard.h). */
static bool is_mirrored(const struct drawing *d, uint32_t serial)
{
    uint32_t stream = random_stream(random_key(d->scene->seed, 0), serial);
    return random_unit(stream, RANDOM_SPIN + 1) < 0.5f;
}

/* Checks that every pixel inside a billboard shows the texel that the pixel's ray meets, with the
 * alpha of the soft-particle fade at that depth, and that all other pixels are empty. The texture's
 * red grows to the right and its green downwards. */
static void check_plane(const struct drawing *d, const struct billboard *b)
{
    int inside = 0;
    for (int p = 0; p < PIXELS; p++) {
        const float *pixel = d->color.host + 4 * p;
        vec ray = drawing_ray(d, p % WIDTH + 0.5, p / WIDTH + 0.5);
        vec to_center = vec_add(b->center, drawing_eye(d), -1);
        double depth = vec_dot(to_center, b->normal) / vec_dot(ray, b->normal);
        vec at = vec_add(vec_add((vec){0}, ray, depth), to_center, -1);
        double x = vec_dot(at, b->right) / vec_dot(b->right, b->right);
        double y = vec_dot(at, b->up) / vec_dot(b->up, b->up);
        double edge = fmax(fabs(x), fabs(y));
        if (fabs(edge - 1) < 0.02)
            continue;
        if (edge > 1 || depth <= 0) {
            assert_true(pixel[3] == 0.0f);
            continue;
        }
        inside++;
        double alpha = (WALL_M - depth) * SOFT;
        assert_true(fabs((double)pixel[3] - alpha) < 1e-3);
        double sideways = b->mirrored ? -x : x;
        if (edge < 0.95) { /* at the edge, filtering clamps texture coordinates */
            assert_true(fabs((double)pixel[0] / alpha - (0.5 + 0.5 * sideways)) < 0.02);
            assert_true(fabs((double)pixel[1] / alpha - (0.5 - 0.5 * y)) < 0.02);
        }
    }
    assert_true(inside > 1000);
}

/* Checks the billboards of a facing for eight serials, some of which are mirrored. angle: the
 * rotation, rad; stretch: the value of look.stretch, s, by which the speed in the billboard's plane
 * is multiplied to lengthen the billboard; all_shapes: makes the technique take its program for all
 * shapes. */
static void check_facing(struct kiln_device *device, enum kiln_facing facing, double angle,
                         double stretch, bool all_shapes)
{
    static const char *const words[] = {"screen", "viewplane", "viewpoint", "axial", "velocity"};
    char facing_text[64], angle_text[64], stretch_text[64];
    snprintf(facing_text, sizeof facing_text, "systems.a.look.facing=%s", words[facing]);
    snprintf(angle_text, sizeof angle_text, "systems.a.look.rotation=%.9g rad", angle);
    snprintf(stretch_text, sizeof stretch_text, "systems.a.look.stretch=%g s", stretch);
    const char *overrides[] = {facing_text, angle_text, stretch_text,
                               "systems.a.look.axis=[1, 3, 0.5]", "systems.b.enabled=false"};
    struct drawing d;
    drawing_init(&d, device, SCENE, overrides, all_shapes ? 4 : 5);
    bool seen[2] = {false, false};
    for (uint32_t serial = 0; serial < 8; serial++) {
        struct kiln_particle particle = drawing_particle(serial, POSITION, VELOCITY);
        drawing_place(&d, &particle, 1, STEP);
        drawing_run(&d, 1, (float)WALL_M);
        struct billboard b = plane_of(&d, facing, (vec){1, 3, 0.5});
        double along = hypot(vec_dot(vec_of(VELOCITY), b.right), vec_dot(vec_of(VELOCITY), b.up));
        if (facing == KILN_FACING_AXIAL) {
            along = fabs(vec_dot(vec_of(VELOCITY), b.up));
            angle = 0; /* an axial billboard does not rotate away from its axis */
        } else if (facing == KILN_FACING_VELOCITY) {
            angle = 0; /* this facing does not rotate away from the velocity */
        } else if (stretch > 0) {
            angle = -atan2(vec_dot(vec_of(VELOCITY), b.right), vec_dot(vec_of(VELOCITY), b.up));
        }
        b.mirrored = is_mirrored(&d, serial);
        turn_and_scale(&b, angle, 0.6, 0.6 + 0.5 * along * stretch);
        check_plane(&d, &b);
        seen[b.mirrored] = true;
    }
    assert_true(seen[0] && seen[1]);
    drawing_finish(&d);
}

/* Billboards of every facing lie as defined, unrotated, rotated, and stretched along the
 * velocity. */
static void billboards_face_as_defined(void **state)
{
    for (int facing = KILN_FACING_SCREEN; facing <= KILN_FACING_VELOCITY; facing++) {
        for (int all_shapes = 0; all_shapes < 2; all_shapes++) {
            check_facing(*state, (enum kiln_facing)facing, 0, 0, all_shapes);
            check_facing(*state, (enum kiln_facing)facing, 0.5, 0, all_shapes);
            check_facing(*state, (enum kiln_facing)facing, 0.5, 0.2, all_shapes);
        }
    }
}

/* Returns the factor on the opacity of a billboard in a plane of the world, 1.2 m large, where the
 * scene has a depth: it fades with the height of the scene above the plane, and where that is
 * nearer by the billboard's size. */
static double lying_fade(const struct drawing *d, const struct billboard *b, vec ray, double depth,
                         double scene)
{
    const vec hit = vec_add(drawing_eye(d), ray, scene);
    const vec to_eye = vec_add(drawing_eye(d), b->center, -1);
    const double side = vec_dot(to_eye, b->normal) < 0 ? -1 : 1;
    const double above = side * vec_dot(vec_add(hit, b->center, -1), b->normal);
    return fmin(fmax(fmin(1 - above * SOFT, 2 - (depth - scene) / 0.6), 0), 1);
}

/* Billboards with a normal lie in that plane of the world. They are seen on what is in their plane
 * and behind it, and fade on what stands out of it. Each wall is a depth of the scene, m. */
static void billboards_lie_in_a_plane_of_the_world(void **state)
{
    static const double walls[] = {10, 3.45, 3.3, 3.1, 2.2};
    static const vec normals[] = {{0, 1, 0}, {0.2, -1, 0.3}, {0.5, 0.2, 2}, {-1, 0.6, 0.2}};
    static const char *const words[] = {"[0, 1, 0]", "[0.2, -1, 0.3]", "[0.5, 0.2, 2]",
                                        "[-1, 0.6, 0.2]"};
    for (size_t i = 0; i < 4; i++) {
        char facing[96];
        snprintf(facing, sizeof facing, "systems.a.look.facing={normal: %s}", words[i]);
        const char *overrides[] = {facing, "systems.b.enabled=false"};
        struct drawing d;
        drawing_init(&d, *state, SCENE, overrides, 2);
        struct kiln_particle particle = drawing_particle(0, POSITION, VELOCITY);
        drawing_place(&d, &particle, 1, STEP);
        struct billboard b = {.center = vec_of(POSITION), .normal = vec_unit(normals[i])};
        const vec upward = i < 2 ? (vec){0, 0, -1} : (vec){0, 1, 0};
        b.up = vec_unit(vec_add(upward, b.normal, -vec_dot(upward, b.normal)));
        b.right = vec_cross(b.up, b.normal);
        b.mirrored = is_mirrored(&d, 0);
        turn_and_scale(&b, 0, 0.6, 0.6);
        int faded = 0, whole = 0;
        for (size_t w = 0; w < sizeof walls / sizeof *walls; w++) {
            drawing_run(&d, 1, (float)walls[w]);
            for (int p = 0; p < PIXELS; p++) {
                const float *pixel = d.color.host + 4 * p;
                vec ray = drawing_ray(&d, p % WIDTH + 0.5, p / WIDTH + 0.5);
                vec to_center = vec_add(b.center, drawing_eye(&d), -1);
                double depth = vec_dot(to_center, b.normal) / vec_dot(ray, b.normal);
                vec at = vec_add(vec_add((vec){0}, ray, depth), to_center, -1);
                double x = vec_dot(at, b.right) / 0.36, y = vec_dot(at, b.up) / 0.36;
                double edge = fmax(fabs(x), fabs(y));
                if (fabs(edge - 1) < 0.03)
                    continue;
                double alpha = edge < 1 ? lying_fade(&d, &b, ray, depth, walls[w]) : 0;
                if (fabs((double)pixel[3] - alpha) >= 2e-3)
                    fail_msg("normal %zu, wall %g m, pixel %d, %d: alpha %g, not %g", i, walls[w],
                             p % WIDTH, p / WIDTH, (double)pixel[3], alpha);
                faded += alpha > 0.01 && alpha < 0.99;
                whole += alpha == 1;
                if (edge < 0.9 && alpha > 0.1)
                    assert_true(fabs((double)(pixel[0] / pixel[3]) -
                                     (0.5 + 0.5 * (b.mirrored ? -x : x))) < 0.03);
            }
        }
        assert_true(faded > 100 && whole > 1000);
        drawing_finish(&d);
    }
}

/* A camera that looks along the up direction of a billboard leaves the billboard's right direction
 * undefined. The billboard must then take the picture's right direction, and not vanish. */
static void a_billboard_seen_from_above_does_not_vanish(void **state)
{
    static const char *const facings[] = {"viewplane", "viewpoint", "axial"};
    for (size_t i = 0; i < 3; i++) {
        char facing[64];
        snprintf(facing, sizeof facing, "systems.a.look.facing=%s", facings[i]);
        const char *overrides[] = {facing, "camera.position=[0.9, 6, 0.4]",
                                   "camera.target=[0.9, 0, 0.4]", "camera.roll=0 deg"};
        struct drawing d;
        drawing_init(&d, *state, SCENE, overrides, 4);
        struct kiln_particle particle = drawing_particle(0, POSITION, VELOCITY);
        drawing_place(&d, &particle, 1, STEP);
        drawing_run(&d, 1, (float)WALL_M);
        int covered = 0;
        for (int p = 0; p < PIXELS; p++)
            covered += d.color.host[4 * p + 3] > 0.0f;
        double edge = 1.2 * HEIGHT / (2 * tan(acos(-1) / 6) * 4.7); /* px, at depth 4.7 m */
        /* The camera sees an axial billboard end-on, as a line at most; the other facings fill a
         * square. */
        if (i < 2)
            assert_true(fabs(covered - edge * edge) < 4 * edge);
        else
            assert_true(covered < 4 * edge);
        drawing_finish(&d);
    }
}

/* ---- points and lines ------------------------------------------------------------------------ */

static double clamp_unit(double x)
{
    return fmin(fmax(x, 0), 1);
}

/* Returns the part of a pixel, 0 to 1, that a rectangle or, if `round` is true, a disc covers. (x,
 * y): the way from the shape's centre to the pixel's centre, px; half_x, half_y: half of the
 * shape's width and height, px. */
static double coverage(double x, double y, double half_x, double half_y, bool round)
{
    if (round)
        return clamp_unit(half_x + 0.5 - hypot(x, y));
    return clamp_unit(half_x + 0.5 - fabs(x)) * clamp_unit(half_y + 0.5 - fabs(y));
}

/* Checks that a point is drawn as a white disc or square. diameter_px: its diameter, px, or 0 for
 * SCENE's size in metres. A point smaller than a pixel must cover one pixel, with its opacity
 * multiplied by its area in pixels. */
static void check_point(struct kiln_device *device, const char *const *overrides, size_t count,
                        double diameter_px, bool round)
{
    struct drawing d;
    drawing_init(&d, device, SCENE, overrides, count);
    struct kiln_particle particle = drawing_particle(0, POSITION, VELOCITY);
    drawing_place(&d, &particle, 1, STEP);
    drawing_run(&d, 1, (float)WALL_M);
    vec center = drawing_project(&d, vec_of(POSITION));
    if (diameter_px <= 0)
        diameter_px = 1.2 * HEIGHT / (2 * (double)d.moment.view.frustum.y * center.z);
    double thin = fmin(diameter_px, 1), half = fmax(diameter_px, 1) / 2, sum = 0;
    for (int p = 0; p < PIXELS; p++) {
        double alpha =
            coverage(p % WIDTH + 0.5 - center.x, p / WIDTH + 0.5 - center.y, half, half, round);
        alpha *= thin * thin * (WALL_M - center.z) * SOFT;
        assert_true(fabs((double)d.color.host[4 * p + 3] - alpha) < 2e-3);
        assert_true(d.color.host[4 * p] == d.color.host[4 * p + 3]); /* a point has no texture */
        sum += alpha;
    }
    assert_true(sum > 0.01);
    drawing_finish(&d);
}

/* Points have their size in metres or pixels, times look.scale; their facing is ignored. */
static void points_have_their_size(void **state)
{
    static const char *const metres[] = {"systems.a.look.shape=point"};
    static const char *const pixels[] = {"systems.a.look.shape=point",
                                         "systems.a.look.point.size=7.5 px"};
    static const char *const square[] = {"systems.a.look.shape=point",
                                         "systems.a.look.point={size: 7.5 px, round: false}",
                                         "systems.a.look.facing=axial"}; /* is ignored */
    static const char *const tiny[] = {
        "systems.a.look.shape=point",
        "systems.a.look.point={size: {life: {0: 0.1 px, 0.1: 0.9 px}}}"};
    static const char *const scaled[] = {"systems.a.look.shape=point", "systems.a.look.scale=2",
                                         "systems.a.look.point.size=7.5 px"};
    check_point(*state, metres, 1, 0, true);
    check_point(*state, pixels, 2, 7.5, true);
    check_point(*state, square, 3, 7.5, false);
    check_point(*state, tiny, 2, 0.5, true);
    check_point(*state, scaled, 3, 15, true);
}

/* Checks a line from the particle's position to the position that it had `seconds` earlier. The
 * line has square ends, which extend it by half of its width. */
static void check_line(struct kiln_device *device, const char *const *overrides, size_t count,
                       float3 position, float3 velocity, double seconds, double width_px)
{
    struct drawing d;
    drawing_init(&d, device, SCENE, overrides, count);
    struct kiln_particle particle = drawing_particle(0, position, velocity);
    drawing_place(&d, &particle, 1, STEP);
    drawing_run(&d, 1, (float)WALL_M);
    vec head = drawing_project(&d, vec_of(position));
    vec tail = drawing_project(&d, vec_add(vec_of(position), vec_of(velocity), -seconds));
    double length = hypot(head.x - tail.x, head.y - tail.y), sum = 0;
    double dx = length > 0 ? (head.x - tail.x) / length : 1;
    double dy = length > 0 ? (head.y - tail.y) / length : 0;
    for (int p = 0; p < PIXELS; p++) {
        double x = p % WIDTH + 0.5 - (head.x + tail.x) / 2;
        double y = p / WIDTH + 0.5 - (head.y + tail.y) / 2;
        double along = x * dx + y * dy, across = y * dx - x * dy;
        double part = length > 0 ? 0.5 + along / length : 0;
        double depth = 1 / (1 / tail.z + (1 / head.z - 1 / tail.z) * part);
        double alpha = coverage(along, across, (length + width_px) / 2, width_px / 2, false) *
                       (WALL_M - depth) * SOFT;
        /* The square ends have the constant depth of head and tail, while `depth` goes on
         * changing. */
        double tolerance = fabs(part - 0.5) < 0.5 ? 4e-3 : 2e-2;
        assert_true(fabs((double)d.color.host[4 * p + 3] - alpha) < tolerance);
        sum += alpha;
    }
    assert_true(sum > 2);
    drawing_finish(&d);
}

/* Lines lie along the velocity, and are as long as the way of the particle during look.stretch or,
 * with `to: previous`, since the last frame. */
static void lines_lie_along_the_velocity(void **state)
{
    static const char *const back[] = {"systems.a.look.shape=line", "systems.a.look.stretch=0.4 s",
                                       "systems.a.look.line.width=3 px"};
    static const char *const frame[] = {"systems.a.look.shape=line", "systems.a.look.stretch=9 s",
                                        "systems.a.look.line={width: 2 px, to: previous}"};
    static const float3 fast = {20.0f, 10.0f, -15.0f}, rest = {0.0f, 0.0f, 0.0f};
    check_line(*state, back, 3, POSITION, VELOCITY, 0.4, 3);
    check_line(*state, back, 3, POSITION, rest, 0.4, 3); /* a particle at rest is a dot */
    check_line(*state, frame, 3, POSITION, fast, 1.0 / 30, 2);
}

/* A line whose tail is behind the camera is cut off at the near plane, so it reaches the edge of
 * the picture with its full width. Without the cut, the tail would be projected to the wrong
 * side. */
static void lines_end_at_the_near_plane(void **state)
{
    static const char *const overrides[] = {"systems.a.look.shape=line",
                                            "systems.a.look.stretch=1 s",
                                            "systems.a.look.line.width=4 px"};
    struct drawing d;
    drawing_init(&d, *state, SCENE, overrides, 3);
    const struct kiln_particle particle =
        drawing_particle(0, (float3){0.2f, 1.0f, 0.1f}, (float3){-2.0f, -5.0f, -6.0f});
    drawing_place(&d, &particle, 1, STEP);
    drawing_run(&d, 1, (float)WALL_M);
    int covered = 0;
    bool at_edge = false;
    for (int p = 0; p < PIXELS; p++) {
        assert_true(isfinite(d.color.host[4 * p + 3]));
        bool here = d.color.host[4 * p + 3] > 0.0f;
        covered += here;
        int x = p % WIDTH, y = p / WIDTH;
        at_edge |= here && (x == 0 || y == 0 || x == WIDTH - 1 || y == HEIGHT - 1);
    }
    assert_true(at_edge && covered > 4 * 60 && covered < 6 * WIDTH);
    drawing_finish(&d);
}

int main(int argc, char **argv)
{
    (void)argc;
    static const struct CMUnitTest tests[] = {
        test_on_device(billboards_face_as_defined),
        test_on_device(billboards_lie_in_a_plane_of_the_world),
        test_on_device(a_billboard_seen_from_above_does_not_vanish),
        test_on_device(points_have_their_size),
        test_on_device(lines_lie_along_the_velocity),
        test_on_device(lines_end_at_the_near_plane),
    };
    return drawing_run_rasters(tests, sizeof tests / sizeof *tests, argv);
}
