/* Builds a scene for tests of families, which are particles born of other particles: stars, glow,
 * embers and sparks come from rockets, and splashes and drips from rain. */
#include "support/family_fixture.h"

/* Adds rockets, the stars that dying rockets give birth to, the glow that stars trail, and the
 * embers that dying glow gives birth to: four generations. Their system indices go from the
 * youngest generation to the oldest, so that tests meet children with lower indices than their
 * parents. The sparks that rockets trail have a higher index than rockets. */
static void fixture_family_fireworks(struct scene_fixture *f)
{
    struct kiln_system *ember = fixture_add_child(f, "ember", FAMILY_GLOW, KILN_EVENT_DEATH, 2);
    ember->emit.life = fixture_range(0.01f, 0.2f);
    ember->emit.inherit = fixture_constant(1.0f);

    struct kiln_system *glow = fixture_add_child(f, "glow", FAMILY_STAR, KILN_EVENT_TRAIL, 0);
    glow->emit.parent.rate = fixture_ramp(f, KILN_CLOCK_LIFE, 0.1f, 50.0f, 0.9f, 0.0f);
    glow->emit.parent.align = KILN_ALIGN_VELOCITY;
    glow->emit.life = fixture_range(0.05f, 0.3f);
    glow->emit.shape = KILN_EMITTER_CONE;
    glow->emit.angle = fixture_constant(0.3f);
    glow->emit.inherit = fixture_constant(0.3f);
    struct kiln_force *curl = fixture_add_force(glow, KILN_FORCE_CURL);
    curl->strength = curl->pull = fixture_constant(2.0f);

    struct kiln_system *star = fixture_add_child(f, "star", FAMILY_ROCKET, KILN_EVENT_DEATH, 9);
    star->emit.life = fixture_range(0.004f, 0.5f);
    star->emit.shape = KILN_EMITTER_SPHERE;
    star->emit.outward = star->emit.surface = true;
    star->emit.radius = fixture_constant(0.1f);
    star->emit.speed = fixture_range(1.0f, 6.0f);
    fixture_add_force(star, KILN_FORCE_LIMIT)->strength =
        fixture_ramp(f, KILN_CLOCK_LIFE, 0.0f, 5.0f, 1.0f, 1.0f);
    star->collide.enabled = true;
    star->collide.dies = true;

    struct kiln_system *rocket = fixture_add_system(f, "rocket", 31.0f);
    rocket->emit.life = fixture_range(0.2f, 0.6f);
    rocket->emit.speed = fixture_range(2.0f, 5.0f);
    rocket->emit.angle = fixture_constant(0.6f);
    rocket->emit.shape = KILN_EMITTER_LINE;
    rocket->emit.size = fixture_constant3(0.5f, 0.0f, -0.2f);
    rocket->emit.nozzles = 3;
    fixture_add_force(rocket, KILN_FORCE_GRAVITY)->vector = fixture_constant3(0.0f, -9.81f, 0.0f);
    rocket->collide.enabled = true;
    rocket->bounds = (struct kiln_bounds){true, {-1.5f, -2.0f, -2.0f}, {1.5f, 3.0f, 2.0f}};

    struct kiln_system *spark = fixture_add_child(f, "spark", FAMILY_ROCKET, KILN_EVENT_TRAIL, 0);
    spark->emit.parent.rate = fixture_constant(333.0f);
    spark->emit.life = fixture_range(0.1f, 0.4f);
    spark->emit.speed = fixture_range(0.0f, 0.5f);
    spark->emit.angle = fixture_constant(3.0f);
    spark->emit.shape = KILN_EMITTER_LINE;
    spark->emit.size = fixture_constant3(0.0f, 0.03f, 0.04f);
    spark->emit.inherit = fixture_ramp(f, KILN_CLOCK_TIME, 0.0f, 0.0f, 3.0f, 1.0f);
}

/* Adds rain, which gives birth to splashes where it first bounces, and to drips where it dies. */
static void fixture_family_rain(struct scene_fixture *f)
{
    struct kiln_system *rain = fixture_add_system(f, "rain", 200.0f);
    rain->emit.shape = KILN_EMITTER_BOX;
    rain->emit.origin = fixture_constant3(0.0f, 3.0f, 0.0f);
    rain->emit.size = fixture_constant3(6.0f, 0.2f, 3.0f);
    rain->emit.direction = fixture_constant3(0.3f, -1.0f, 0.0f);
    rain->emit.speed = fixture_range(5.0f, 9.0f);
    rain->emit.life = fixture_range(0.3f, 1.5f);
    rain->collide.enabled = true;
    rain->collide.slowdown = fixture_constant(0.7f);

    struct kiln_system *splash = fixture_add_child(f, "splash", FAMILY_RAIN, KILN_EVENT_BOUNCE, 4);
    splash->emit.parent.align = KILN_ALIGN_NORMAL;
    splash->emit.shape = KILN_EMITTER_CONE;
    splash->emit.angle = fixture_constant(0.9f);
    splash->emit.inherit = fixture_constant(0.5f);
    splash->emit.life = fixture_range(0.1f, 0.5f);
    splash->collide.enabled = true;
    splash->collide.mode = KILN_COLLIDE_CLAMP;
    splash->collide.slowdown = fixture_constant(0.5f);

    struct kiln_system *drip = fixture_add_child(f, "drip", FAMILY_RAIN, KILN_EVENT_DEATH, 1);
    drip->collide.enabled = drip->collide.dies = true;
    drip->emit.direction = fixture_constant3(0.0f, -1.0f, 0.0f);
}

void fixture_family(struct scene_fixture *f, enum kiln_integration integration)
{
    fixture_init(f);
    f->scene.integration = integration;
    f->scene.warmup_steps = 10;
    fixture_zoo_backdrop(f);
    fixture_family_fireworks(f);
    fixture_family_rain(f);
}
