/* Checks that each technique of stage `raster` draws the particles of every scene in scenes/ as a
 * reference does, which draws pixel by pixel in double precision (support/true_billboards.h).
 * Pictures are compared in linear light. If this fails, a technique differs from the reference by
 * more than docs/determinism.md promises. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "support/cmocka.h"
#include "support/device.h"
#include "support/frame.h"
#include "support/parts.h"
#include "support/pools.h"
#include "support/scenes.h"
#include "support/stages.h"
#include "support/true_billboards.h"

static const struct {
    enum kiln_raster_technique technique;
    const char *name;
} RASTERS[] = {
    {KILN_RASTER_CPU, "cpu"},
    {KILN_RASTER_TILED, "tiled"},
    {KILN_RASTER_GEOMETRY, "geometry"},
    {KILN_RASTER_INSTANCED, "instanced"},
};
enum { RASTER_COUNT = sizeof RASTERS / sizeof *RASTERS };

/* A scene at one instant. Its stages have drawn that instant, so that its backdrop, light and depth
 * are known. Each technique of stage `raster` has a stage of its own. */
struct subject {
    const char *name;
    struct kiln_scene *scene;
    struct kiln_threads *threads;
    struct kiln_run run;
    struct kiln_stages stages;
    struct kiln_simulate *simulate;
    struct kiln_particles_stage *rasters[RASTER_COUNT];
    struct kiln_image color, glow;
    struct kiln_framebuffer targets;
    bool failed; /* a technique differed from the reference by more than is allowed */
};

/* One drawing of some of the scene's systems together. */
struct pass {
    const char *name;
    uint32_t systems; /* bit i is set if system i is drawn */
    bool over;        /* true: the picture is also compared after blending over the backdrop */
};

/* Most steps from the start to the drawn instant. Every scene has particles by then. */
enum { MOST_STEPS = 200 };

/* A scene whose text is in this file and not in scenes/. */
struct text {
    const char *name, *yaml;
};

/* A scene of 70000 particles, each so faint that it changes a pixel by about one 8-bit level or
 * less. */
static const struct text FAINT = {
    "faint",
    "kiln: 1\n"
    "simulation: {rate: 10}\n"
    "output: {frames: 4, fps: 10}\n"
    "camera: {position: [0, 0, 5], target: [0, 0, 0]}\n"
    "systems:\n"
    "  haze:\n"
    "    emit: {bursts: {0 s: 70000}, life: 10 s, from: {box: {size: [6, 3, 2]}}}\n"
    "    look: {atlas: \"builtin:smoke\", size: 20 cm, opacity: 0.004, color: [1, 0.9, 0.8]}\n"};

/* Sprites of all kinds in haze that is bright towards the sun, right above the eye as well. */
static const struct text HAZY = {
    "hazy",
    "kiln: 1\n"
    "simulation: {rate: 10}\n"
    "output: {frames: 4, fps: 10}\n"
    "camera: {position: [0, 1, 9], target: [0, 1.5, 0]}\n"
    "backdrop: {haze: 0.1, sky: {horizon: [0.3, 0.4, 0.6]},\n"
    "           sun: {direction: [-0.4, 0.3, -1], glow: 3, glow_size: 30 deg}}\n"
    "systems:\n"
    "  smoke:\n"
    "    emit: {bursts: {0 s: 60}, life: 10 s, speed: 0, from: {box: {size: [6, 3, 16]}}}\n"
    "    look: {atlas: \"builtin:puff\", lit: 1, color: [0.3, 0.2, 0.1]}\n"
    "  glow:\n"
    "    emit: {bursts: {0 s: 60}, life: 10 s, speed: 0, from: {box: {size: [6, 3, 16]}}}\n"
    "    look: {atlas: \"builtin:fire\", temperature: 1500, bloom: 1}\n"
    "  fire:\n"
    "    emit: {bursts: {0 s: 60}, life: 10 s, speed: 0, from: {box: {size: [6, 3, 16]}}}\n"
    "    look: {atlas: \"builtin:spark\", blend: add, temperature: 1700, bloom: [1, 0.5, 0.2]}\n"
    "  dots:\n"
    "    emit: {bursts: {0 s: 60}, life: 10 s, speed: 0, from: {box: {size: [6, 3, 16]}}}\n"
    "    look: {shape: point, size: 0.1 m, color: [1, 0.1, 0.1]}\n"
    "  lines:\n"
    "    emit: {bursts: {0 s: 60}, life: 10 s, from: {box: {size: [6, 3, 16]}}}\n"
    "    look: {shape: line, stretch: 0.3 s, line: {width: 3 px}, color: [0.1, 1, 0.1]}\n"};

/* Billboards that lie on a floor, on a slope and on walls, in and on which objects stand; seen from
 * behind, too; and drops that splash on a ball and a floor and stay there. */
static const struct text LYING = {
    "lying",
    "kiln: 1\n"
    "simulation: {rate: 30}\n"
    "output: {frames: 4, fps: 10}\n"
    "camera: {position: [0, 1.2, 6], target: [0, 0.5, 0]}\n"
    "backdrop: {sun: {direction: [0.4, 0.7, 0.6]}, floor: {height: 0 m}, objects: [\n"
    "  box: {center: [1.6, 0.5, -0.6], size: [1, 1, 1], rotation: [0, 30 deg, 0]},\n"
    "  sphere: {center: [-1.5, 0.6, 0.3], radius: 0.6 m}]}\n"
    "systems:\n"
    "  ground:\n"
    "    emit: {bursts: {0 s: 60}, life: 10 s, speed: 0, from: {box: {size: [5, 0.05, 3]}}}\n"
    "    look: {atlas: \"builtin:smoke\", facing: {normal: [0, 1, 0]}, size: 1.2 m, soft: 3, lit: "
    "1}\n"
    "  slope:\n"
    "    emit: {bursts: {0 s: 20}, life: 10 s, speed: 0.2, from: {box: {size: [4, 2, 3]}}}\n"
    "    look: {atlas: \"builtin:star\", blend: add, facing: {normal: [-1, 2, -3]}, size: 0.5 m,\n"
    "           soft: 0, spin: 90 deg/s, stretch: 1 s, width: 0.5, height: {age: {0 s: 2, 9 s: "
    "1}}}\n"
    "  bars:\n"
    "    emit: {bursts: {0 s: 30}, life: 10 s, speed: 0.3, from: {box: {size: [4, 2, 3]}}}\n"
    "    look: {atlas: \"builtin:puff\", size: 0.3 m, lit: 1, width: {life: [3, 0.1]},\n"
    "           height: {random: [0.1, 2]}, stretch: {random: [0, 0.4]}, stretch_dims: true}\n"
    "  drops:\n"
    "    emit: {rate: 300, life: 2 s, speed: [1, 2], from: {box: {origin: [0, 2, 0],\n"
    "           size: [4, 0.1, 2.5], direction: [0, -1, 0], angle: 20 deg}}}\n"
    "    forces: [gravity: {}]\n"
    "    collide: {then: stop}\n"
    "    look: {atlas: \"builtin:drop\", facing: surface, size: 0.2 m, lit: 1}\n"
    "  rings:\n"
    "    emit: {parent: {system: drops, on: {bounce: 1}}, life: 1 s, speed: 0, inherit: 0}\n"
    "    look: {atlas: \"builtin:splash\", facing: surface, size: 0.4 m, soft: 8, lit: 1}\n"};

/* So many particles that raster=cpu blends pairs of flipbook cells before it draws
 * (lib/draw/sprites/cells.h). The particles are about 8 to 24 pixels wide and of all ages, so that
 * it blends cells of several levels of detail, with motion vectors, at many phases. */
static const struct text MIXED = {
    "mixed",
    "kiln: 1\n"
    "simulation: {rate: 10}\n"
    "output: {frames: 4, fps: 10}\n"
    "camera: {position: [0, 0, 5], target: [0, 0, 0]}\n"
    "systems:\n"
    "  fire:\n"
    "    emit: {bursts: {0 s: 66000}, life: [0.5 s, 10 s], from: {box: {size: [6, 3, 2]}}}\n"
    "    look:\n"
    "      atlas: \"builtin:fire\"\n"
    "      cells: [8, 4]\n"
    "      blend: add\n"
    "      size: 27 cm\n"
    "      scale: [0.7, 1.3]\n"
    "      rotation: [0 deg, 360 deg]\n"
    "      opacity: 0.01\n"
    "      temperature: 1700\n"};

/* Looks whose values vary over every clock, or are the colours of an image and of a mesh, and
 * shapes of three kinds. */
static const struct text VALUES = {
    "values",
    "kiln: 1\n"
    "output: {frames: 60}\n"
    "systems:\n"
    "  fire:\n"
    "    emit: {rate: 300, life: {random: [0.5 s, 2 s]}, speed: 2}\n"
    "    look:\n"
    "      atlas: \"builtin:fire\"\n"
    "      blend: add\n"
    "      temperature: {random: [1500 K, 2500 K], times: {life: [1, 0.7]}}\n"
    "      intensity: {random: [5, 40]}\n"
    "      size: {age: {0 s: 0.1, 1 s: 0.5}, times: {random: [0.5, 1.5]}}\n"
    "      rotation: {random: [0 deg, 90 deg]}\n"
    "      spin: {random: [0 deg/s, 90 deg/s]}\n"
    "      cycles: {choose: [1, 2]}\n"
    "  smoke:\n"
    "    emit: {rate: 200, life: 2 s, speed: [1, 3], from: {sphere: {radius: 0.4}}}\n"
    "    look:\n"
    "      color: {choose: [[0.8, 0.3, 0.2], [0.2, 0.5, 0.9]], weights: [1, 2]}\n"
    "      opacity: {speed: {0: 0.1, 3 m/s: 0.8}, plus: {noise: [-0.1, 0.1]}}\n"
    "      lit: {height: {0 m: 0, 3 m: 1}}\n"
    "      soft: {distance: {1 m: 1, 20 m: 4}}\n"
    "      stretch: {noise: [0 s, 0.2 s], period: 0.5 s, octaves: 2}\n"
    "      scale: {random: [0.3, 1]}\n"
    "  points:\n"
    "    emit: {rate: 400, life: 2 s, speed: [1, 3], from: {cone: {}}}\n"
    "    look: {shape: point, point: {size: {choose: [2 px, 5 px, 9 px]}},\n"
    "           color: [{random: [0, 1]}, 0.5, {age: {0 s: 0, 0.3 s: 1}, repeat: mirror}]}\n"
    "  logo:\n"
    "    emit: {rate: 900, life: 1 s, speed: 0.2,\n"
    "           from: {image: {file: tests/sources/mark.png, width: 2 m, origin: [0, 1, 0]}}}\n"
    "    look: {shape: point, size: 6 cm, color: source}\n"
    "  quilt:\n"
    "    emit: {rate: 900, life: 1 s, speed: 0.2, from: {mesh: {file: tests/sources/quilt.obj}}}\n"
    "    look: {atlas: \"builtin:spark\", blend: add, size: 6 cm, color: source, intensity: 3}\n"};

/* Children with the color, size and temperature of parents, most of which are dead, and with the
 * colours of an image that parents were born on. */
static const struct text INHERITED = {
    "inherited",
    "kiln: 1\n"
    "output: {frames: 60}\n"
    "systems:\n"
    "  before: {emit: {rate: 10}}\n"
    "  shell:\n"
    "    emit: {rate: 60, life: [0.2 s, 0.4 s], speed: [1, 4], from: {cone: {angle: 60 deg}}}\n"
    "    look: {size: {life: [0.1, 0.4], times: {random: [0.5, 1]}}, temperature: {random: [1200 "
    "K,\n"
    "           2500 K]}, color: {choose: [[1, 0.2, 0.1], [0.1, 1, 0.3], [0.2, 0.3, 1]]}}\n"
    "  smoke:\n"
    "    emit: {parent: {system: shell, on: {trail: 40}, inherit: {color: true, size: true}},\n"
    "           life: 1 s, speed: 0.4}\n"
    "    look: {opacity: {life: [0.6, 0]}, lit: 0.5, scale: [0.5, 1]}\n"
    "  fire:\n"
    "    emit: {parent: {system: shell, on: {death: 6}, inherit: {temperature: true}}, life: 1 s,\n"
    "           speed: 1}\n"
    "    look: {atlas: \"builtin:spark\", blend: add, size: 0.2, intensity: 9}\n"
    "  dots:\n"
    "    emit: {parent: {system: shell, on: {death: 9}, inherit: {color: true}}, life: 1 s, speed: "
    "2}\n"
    "    look: {shape: point, size: 5 cm, opacity: {age: {0 s: 1, 1 s: 0}}}\n"
    "  logo:\n"
    "    emit: {rate: 200, life: 0.3 s, speed: 0.2,\n"
    "           from: {image: {file: tests/sources/mark.png, width: 2 m, origin: [0, 1, 0]}}}\n"
    "    look: {shape: point, size: 6 cm, color: source}\n"
    "  crumbs:\n"
    "    emit: {parent: {system: logo, on: {trail: 9}, inherit: {color: true}}, life: 1 s, speed: "
    "0.5}\n"
    "    look: {shape: point, size: 9 cm, color: [0, 1, 0]}\n"};

/* Loads a scene, and creates its stages and a stage for each technique. path: the scene's file, or
 * NULL to load `text`. */
static void open_subject(struct subject *s, struct kiln_device *device, const char *path,
                         const struct text *text)
{
    struct kiln_error error = {0};
    static const char *const overrides[] = {"output.size=[384, 216]", "post.bloom.kind=none", NULL};
    struct kiln_scene_params params = kiln_scene_defaults();
    params.overrides = overrides;
    params.override_count = 2;
    params.asset_root = path ? NULL : KILN_SOURCE_DIR;
    *s = (struct subject){.name = path ? strrchr(path, '/') + 1 : text->name,
                          .threads = kiln_threads_create(2)};
    s->scene = path ? load_coarse_scene(path, overrides)
                    : kiln_scene_parse(text->yaml, strlen(text->yaml), text->name, &params, &error);
    if (!s->scene) {
        fail_msg("%s", error.message);
        return;
    }
    pool_init_of(&s->run.pool, device, s->scene);
    stages_open(&s->stages, &s->simulate, device, s->scene, &FRAME_CPU, true, s->threads,
                &s->run.pool);
    for (int i = 0; i < RASTER_COUNT; i++) {
        s->rasters[i] = kiln_particles_create(device, s->scene, &s->stages.atlas,
                                              RASTERS[i].technique, s->threads, &error);
        if (!s->rasters[i])
            fail_msg("%s", error.message);
    }
    kiln_image_init(&s->color, device, s->scene->width, s->scene->height, GL_RGBA32F, "color");
    kiln_image_init(&s->glow, device, s->scene->width, s->scene->height, GL_RGBA32F, "glow");
    struct kiln_image *images[] = {&s->color, &s->glow};
    assert_true(kiln_framebuffer_init(&s->targets, device, images, 2, &error));
}

/* Simulates and draws the frame in the middle of the clip, or the state after MOST_STEPS steps if
 * that is earlier. A scene of gas alone has no particles to draw. */
static void draw_subject(struct subject *s)
{
    struct kiln_error error = {0};
    uint32_t step = kiln_scene_frame_step(s->scene, s->scene->frames / 2), drawn = 0;
    step = step < MOST_STEPS ? step : MOST_STEPS;
    for (uint32_t i = 1; i <= step; i++)
        assert_true(kiln_simulate_step(s->simulate, &s->run.pool, i, &error));
    if (!kiln_stages_draw(&s->stages, NULL, &s->run.pool, kiln_instant_at_step(step), 0, &drawn,
                          &error))
        fail_msg("%s", error.message);
    assert_true(drawn > 0 || s->scene->system_count == 0);
}

static void close_subject(struct subject *s)
{
    for (int i = 0; i < RASTER_COUNT; i++)
        kiln_particles_destroy(&s->rasters[i]);
    kiln_framebuffer_finish(&s->targets);
    kiln_image_finish(&s->color);
    kiln_image_finish(&s->glow);
    stages_close(&s->stages, &s->simulate);
    kiln_pool_finish(&s->run.pool);
    kiln_threads_destroy(&s->threads);
    kiln_scene_destroy(&s->scene);
}

static uint32_t systems_of(const struct kiln_scene *scene, enum kiln_blend blend)
{
    uint32_t mask = 0;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_system *system = &scene->systems[i];
        if (system->enabled && system->look.blend == blend && !kiln_look_is_opaque(&system->look))
            mask |= 1u << i;
    }
    return mask;
}

/* Lists the particles of a pass from the farthest to the nearest, or by serial number if all are
 * blended additively, so that order does not matter. Returns the parameters for drawing them. */
static struct kiln_particles_draw list_pass(struct subject *s, const struct pass *pass)
{
    struct kiln_error error = {0};
    const bool separate = s->scene->post.compose == KILN_COMPOSE_SEPARATE;
    const bool smoke = (pass->systems & systems_of(s->scene, KILN_BLEND_ALPHA)) != 0;
    struct kiln_particles_draw draw = {
        .moment = &s->stages.moment,
        .entries = &s->stages.entries,
        .view = &s->stages.moment.view,
        .backdrop = kiln_backdrop_block(s->stages.backdrop),
        .lighting = &s->stages.light,
        .depth = &s->stages.scene_depth,
        .framebuffer = &s->targets,
        .sum_alpha = separate && !smoke,
        .fire_covers = s->scene->post.compose == KILN_COMPOSE_ALPHA,
        .by_fragment = s->scene->post.compose == KILN_COMPOSE_OIT && smoke,
    };
    const struct kiln_sort_params params = {
        .eye = {s->stages.moment.view.eye.x, s->stages.moment.view.eye.y,
                s->stages.moment.view.eye.z},
        .forward = kiln_view_forward(&s->stages.moment.view),
        .systems = pass->systems,
        .order = smoke || draw.fire_covers ? KILN_SORT_BACK_TO_FRONT : KILN_SORT_BY_SERIAL,
    };
    if (!kiln_sort_run(s->stages.sort, &s->run.pool, &params, &s->stages.entries, &draw.count,
                       &error))
        fail_msg("%s", error.message);
    return draw;
}

static void reverse(const struct kiln_particles_draw *draw)
{
    struct kiln_error error = {0};
    uint32_t *entries = kiln_buffer_host(draw->entries, KILN_READ_WRITE, &error);
    assert_non_null(entries);
    for (uint32_t i = 0; i < draw->count / 2; i++) {
        uint32_t entry = entries[i];
        entries[i] = entries[draw->count - 1 - i];
        entries[draw->count - 1 - i] = entry;
    }
}

/* The difference of two pictures. mean: the relative error, which is the sum of |a - b| divided by
 * the sum of |a|; off: the share of values, 0 to 1, whose error exceeds 1 % of (value + 0.1). */
struct difference {
    double mean, off;
};

/* Returns the difference of two premultiplied pictures, or, if `behind` is not NULL, of the
 * pictures blended over `behind`. */
static struct difference measure(const double (*truth)[4], const float *drawn, const float *behind,
                                 size_t pixels, int channels)
{
    double error_sum = 0, light_sum = 1e-9, off = 0;
    for (size_t i = 0; i < pixels; i++) {
        for (int c = 0; c < channels; c++) {
            double back = behind ? (double)behind[4 * i + (size_t)c] : 0;
            double light = truth[i][c] + back * (1 - truth[i][3]);
            double other = (double)drawn[4 * i + (size_t)c] + back * (1 - (double)drawn[4 * i + 3]);
            double delta = fabs(light - other);
            error_sum += delta;
            light_sum += fabs(light);
            off += delta > 1e-2 * (fabs(light) + 0.1);
        }
    }
    return (struct difference){error_sum / light_sum, off / (double)(pixels * (size_t)channels)};
}

/* Compares a technique's picture of a pass with the reference, and notes in s->failed if they
 * differ too much. docs/determinism.md allows a mean relative error of 1e-3, and one value in a
 * thousand that is off by more than 1 %. */
static void compare(struct subject *s, const struct pass *pass, const char *raster,
                    const struct true_picture *truth)
{
    struct kiln_error error = {0};
    const size_t pixels = (size_t)truth->width * truth->height;
    const float *color = kiln_image_host(&s->color, KILN_READ, &error);
    const float *glow = kiln_image_host(&s->glow, KILN_READ, &error);
    const float *behind = kiln_image_host(&s->stages.scene_color, KILN_READ, &error);
    assert_true(color && glow && behind);
    const struct difference of_layers[] = {
        measure((const double(*)[4])truth->color, color, NULL, pixels, 4),
        measure((const double(*)[4])truth->glow, glow, NULL, pixels, 4),
        measure((const double(*)[4])truth->color, color, behind, pixels, 3),
    };
    static const char *const layers[] = {"color", "glow", "beauty"};
    for (int i = 0; i < (pass->over ? 3 : 2); i++) {
        const struct difference d = of_layers[i];
        print_message("%-20s %-10s %-5s %-6s %.2g %.2g\n", s->name, raster, pass->name, layers[i],
                      d.mean, d.off);
        s->failed = s->failed || d.mean > 1e-3 || d.off > 1e-3;
    }
}

static void draw_pass(struct subject *s, const struct pass *pass)
{
    struct kiln_error error = {0};
    struct kiln_particles_draw draw = list_pass(s, pass);
    static struct kiln_look_program programs[KILN_MAX_SYSTEMS];
    struct true_scene scene = {
        .scene = s->scene,
        .atlas = &s->stages.atlas,
        .view = draw.view,
        .backdrop = draw.backdrop,
        .lighting = draw.lighting,
        .fire_covers = draw.sum_alpha || draw.fire_covers,
        .table = calloc((size_t)kiln_look_rows(s->scene) * KILN_LOOK_SAMPLES, sizeof(float4)),
        .programs = programs,
        .records = kiln_buffer_host(&draw.moment->pool->records, KILN_READ, &error)};
    assert_true(scene.table && scene.records);
    kiln_look_programs_fill(s->scene, programs);
    kiln_looks_fill(s->scene, scene.atlas, programs, scene.looks);
    kiln_looks_sample(s->scene, draw.view->clock.x, scene.table);
    kiln_look_programs_sample(s->scene, programs, draw.view->clock.x, scene.table);
    struct true_picture truth;
    true_picture_init(&truth, s->scene->width, s->scene->height);
    true_draw(&scene, &draw, &truth);
    for (int i = 0; i < RASTER_COUNT; i++) {
        bool backwards = kiln_particles_nearest_first(s->rasters[i]);
        if (backwards)
            reverse(&draw);
        if (!kiln_particles_run(s->rasters[i], &draw, &error))
            fail_msg("%s", error.message);
        if (backwards)
            reverse(&draw);
        compare(s, pass, RASTERS[i].name, &truth);
    }
    true_picture_finish(&truth);
    free(scene.table);
}

/* Compares pictures of all billboards of a scene with the reference. If the scene has both additive
 * and alpha-blended systems (fire and smoke), also compares each kind alone, as in the layers of an
 * EXR file. Returns false if a difference is too large. */
static bool agree_on(struct kiln_device *device, const char *path, const struct text *text)
{
    struct subject s;
    open_subject(&s, device, path, text);
    draw_subject(&s);
    uint32_t fire = systems_of(s.scene, KILN_BLEND_ADD);
    uint32_t smoke = systems_of(s.scene, KILN_BLEND_ALPHA);
    const struct pass passes[] = {
        {"all", fire | smoke, s.scene->post.compose != KILN_COMPOSE_SEPARATE},
        {"fire", fire, false},
        {"smoke", smoke, false}};
    for (int i = 0; i < 3; i++) {
        if (passes[i].systems != 0 && (i == 0 || passes[i].systems != passes[0].systems))
            draw_pass(&s, &passes[i]);
    }
    close_subject(&s);
    return !s.failed;
}

static void techniques_agree_on_a_scene(void **state)
{
    const struct test_scene *given = *state;
    assert_true(agree_on(test_device(), given->path, NULL));
}

static void techniques_agree_in_haze(void **state)
{
    (void)state;
    assert_true(agree_on(test_device(), NULL, &HAZY));
}

static void techniques_agree_on_what_is_faint(void **state)
{
    (void)state;
    assert_true(agree_on(test_device(), NULL, &FAINT));
}

static void techniques_agree_on_mixed_cells(void **state)
{
    (void)state;
    assert_true(agree_on(test_device(), NULL, &MIXED));
}

static void techniques_agree_on_what_lies(void **state)
{
    (void)state;
    assert_true(agree_on(test_device(), NULL, &LYING));
}

static void techniques_agree_on_values(void **state)
{
    (void)state;
    assert_true(agree_on(test_device(), NULL, &VALUES));
}

static void techniques_agree_on_parents_looks(void **state)
{
    (void)state;
    assert_true(agree_on(test_device(), NULL, &INHERITED));
}

int main(int argc, char **argv)
{
    static const struct CMUnitTest inherited = test_on_device(techniques_agree_on_parents_looks);
    static const struct CMUnitTest values = test_on_device(techniques_agree_on_values);
    static const struct CMUnitTest lying = test_on_device(techniques_agree_on_what_lies);
    static const struct CMUnitTest faint = test_on_device(techniques_agree_on_what_is_faint);
    static const struct CMUnitTest hazy = test_on_device(techniques_agree_in_haze);
    static const struct CMUnitTest mixed = test_on_device(techniques_agree_on_mixed_cells);
    static const struct CMUnitTest scene = test_on_device(techniques_agree_on_a_scene);
    struct test_list list = {.count = 0};
    test_list_add_full(&list, &faint, 1);
    test_list_add_full(&list, &mixed, 1);
    test_list_add(&list, &values, 1);
    test_list_add(&list, &lying, 1);
    test_list_add(&list, &inherited, 1);
    test_list_add_full(&list, &hazy, 1);
    test_list_add_scenes(&list, scene, 7);
    return test_list_run(&list, "rasters", argc, argv, test_device_open_alone, test_device_close);
}
