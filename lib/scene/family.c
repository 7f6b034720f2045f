/* This file settles systems whose particles are born of others: it finds parents by name, and the
 * slots and the time that descendants need. */
#include "scene/family.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scene/validate.h"

bool kiln_family_has_children(const struct kiln_scene *scene, uint32_t system)
{
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_system *other = &scene->systems[i];
        if (other->enabled && other->emit.parent.enabled && other->emit.parent.system == system)
            return true;
    }
    return false;
}

uint32_t kiln_family_counted_hits(const struct kiln_scene *scene, uint32_t system)
{
    uint32_t hits = 1;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_parent *parent = &scene->systems[i].emit.parent;
        if (scene->systems[i].enabled && parent->enabled && parent->system == system &&
            parent->event == KILN_EVENT_BOUNCE && parent->every)
            hits = parent->hits > hits ? parent->hits : hits;
    }
    return hits;
}

/* Returns whether children are born by the metre of their parent's way. */
static bool is_by_way(const struct kiln_parent *parent)
{
    return parent->event == KILN_EVENT_TRAIL && parent->per_metre > 0;
}

bool kiln_family_travels(const struct kiln_scene *scene, uint32_t system)
{
    bool any = false;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_parent *parent = &scene->systems[i].emit.parent;
        any = any || (scene->systems[i].enabled && parent->enabled && parent->system == system &&
                      is_by_way(parent));
    }
    return any || kiln_family_counted_hits(scene, system) > KILN_PARTICLE_MOST_HITS;
}

bool kiln_family_inherits(const struct kiln_system *system)
{
    const struct kiln_inherited *look = &system->emit.parent.look;
    return system->emit.parent.enabled && (look->color || look->size || look->temperature);
}

bool kiln_family_lies_from_birth(const struct kiln_system *system)
{
    const struct kiln_parent *parent = &system->emit.parent;
    return kiln_look_lies(&system->look) && parent->enabled &&
           (parent->event == KILN_EVENT_BOUNCE ||
            (parent->event == KILN_EVENT_DEATH && parent->impact));
}

bool kiln_family_is_inherited(const struct kiln_scene *scene, uint32_t system)
{
    bool any = false;
    for (uint32_t i = 0; i < scene->system_count; i++)
        any = any || (scene->systems[i].enabled && kiln_family_inherits(&scene->systems[i]) &&
                      scene->systems[i].emit.parent.system == system);
    return any;
}

/* Returns a system's generation: 1 without a parent, else that of the parent + 1. */
static uint32_t generation(const struct kiln_scene *scene, uint32_t system)
{
    uint32_t count = 1;
    const struct kiln_parent *parent = &scene->systems[system].emit.parent;
    while (parent->enabled && count <= scene->system_count) {
        parent = &scene->systems[parent->system].emit.parent;
        count++;
    }
    return count; /* the systems form a cycle: more than the number of systems */
}

void kiln_family_order(const struct kiln_scene *scene, uint32_t order[KILN_MAX_SYSTEMS])
{
    uint32_t count = 0;
    for (uint32_t g = 1; g <= KILN_MAX_GENERATIONS; g++) {
        for (uint32_t i = 0; i < scene->system_count; i++) {
            if (generation(scene, i) == g)
                order[count++] = i;
        }
    }
}

/* Returns the longest life, with a margin: interpolating and drawing a life may round to a little
 * above the largest key. */
static float longest_life_s(const struct kiln_scene *scene, uint32_t system)
{
    return kiln_scene_value_max(scene, &scene->systems[system].emit.life.max) * (1 + 0x1p-20f);
}

/* Returns a limit of the integral of a rate over the whole life. The parts of a rate are not
 * negative. */
static double most_of_a_life(const struct kiln_scene *scene, const struct kiln_value *rate)
{
    if (rate->count == 0)
        return (double)rate->constant;
    const struct kiln_value times = rate->how & VALUE_TIMES ? value_part(scene->keys, *rate, 1)
                                                            : (struct kiln_value){.constant = 1};
    const struct kiln_value plus = rate->how & VALUE_PLUS ? value_part(scene->keys, *rate, 2)
                                                          : (struct kiln_value){.constant = 0};
    struct kiln_value curve = *rate;
    curve.how &= ~(VALUE_TIMES | VALUE_PLUS);
    const double sum = VALUE_CLOCK(rate->how) == KILN_CLOCK_LIFE
                           ? (double)value_sum_of_keys(scene->keys, curve, 1)
                           : (double)kiln_value_most(scene->keys, &curve);
    return sum * (double)kiln_value_most(scene->keys, &times) +
           (double)kiln_value_most(scene->keys, &plus);
}

uint64_t kiln_family_slots(const struct kiln_scene *scene, const struct kiln_parent *parent)
{
    if (parent->event == KILN_EVENT_BOUNCE && parent->every)
        return (uint64_t)parent->count[1] * parent->hits;
    if (parent->event != KILN_EVENT_TRAIL)
        return parent->count[1];
    if (is_by_way(parent))
        return parent->most;
    /* child j is born if the float sum * life, which rises with the life, passes j */
    double sum = most_of_a_life(scene, &parent->rate);
    double most = sum * (double)longest_life_s(scene, parent->system) * (1 + 0x1p-20);
    return (uint64_t)floor(most) + 1;
}

uint32_t kiln_family_lifespan(const struct kiln_scene *scene, uint32_t system, uint32_t steps)
{
    uint32_t longest = 0;
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_system *child = &scene->systems[i];
        if (!child->enabled || !child->emit.parent.enabled || child->emit.parent.system != system)
            continue;
        uint32_t lifespan = kiln_family_lifespan(scene, i, steps);
        longest = lifespan > longest ? lifespan : longest;
    }
    uint32_t own = kiln_births_lifespan(longest_life_s(scene, system), scene->dt_s, steps);
    return own < steps - longest ? own + longest : steps;
}

/* ---- settling ------------------------------------------------------------------------------- */

bool kiln_family_find_system(struct kiln_reader *reader, const struct kiln_node *root,
                             const char *path, const char *name, uint32_t *system)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    const char *names[KILN_MAX_SYSTEMS];
    for (uint32_t i = 0; i < scene->system_count; i++) {
        names[i] = scene->systems[i].name;
        *system = i;
        if (strcmp(names[i], name) == 0)
            return true;
    }
    char suggestion[512], quoted[64];
    kiln_option_suggest(suggestion, sizeof suggestion, name, names, scene->system_count);
    kiln_node_quote(quoted, name);
    return kiln_reader_error_at(reader, root, path, "unknown system '%s'%s", quoted, suggestion);
}

static bool find_parent(struct kiln_reader *reader, const struct kiln_node *root, uint32_t index)
{
    struct kiln_system *system = &kiln_reader_scene(reader)->systems[index];
    struct kiln_parent *parent = &system->emit.parent;
    char path[128];
    snprintf(path, sizeof path, "systems.%s.emit.parent.system", system->name);
    return !parent->enabled ||
           kiln_family_find_system(reader, root, path, parent->name, &parent->system);
}

static bool find_sources(struct kiln_reader *reader, const struct kiln_node *root, uint32_t index)
{
    struct kiln_system *system = &kiln_reader_scene(reader)->systems[index];
    bool ok = true;
    for (uint32_t i = 0; ok && i < system->interaction_count; i++) {
        struct kiln_interaction *gravity = &system->interactions[i];
        if (gravity->kind != KILN_INTERACT_GRAVITY || strcmp(gravity->of, "self") == 0)
            continue;
        char path[128];
        snprintf(path, sizeof path, "systems.%s.interact.%u.gravity.of", system->name, i);
        ok = kiln_family_find_system(reader, root, path, gravity->of, &gravity->source);
        gravity->of_other = ok && gravity->source != index;
    }
    return ok;
}

static bool check_generations(struct kiln_reader *reader, const struct kiln_node *root,
                              uint32_t index)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    uint32_t generations = generation(scene, index);
    bool ring = generations > scene->system_count;
    if (!ring && generations <= KILN_MAX_GENERATIONS)
        return true;
    char path[128];
    snprintf(path, sizeof path, "systems.%s.emit.parent.system", scene->systems[index].name);
    if (ring)
        return kiln_reader_error_at(reader, root, path,
                                    "the system is born of its own descendants; the first system "
                                    "of a family has no parent");
    return kiln_reader_error_at(reader, root, path,
                                "found %u generations of systems; at most %d are allowed",
                                generations, KILN_MAX_GENERATIONS);
}

/* Returns whether an impact may end particles of a system. */
static bool impacts_kill(const struct kiln_scene *scene, const struct kiln_collide *collide)
{
    return collide->enabled && (collide->dies || collide->then == KILN_THEN_DIE) &&
           kiln_scene_value_max(scene, &collide->chance) > 0.0f;
}

/* Refuses keys of an event that would do nothing beside its others. Those that have their default
 * are allowed, since a printed scene has them. */
static bool check_event(struct kiln_reader *reader, const struct kiln_node *root,
                        const struct kiln_system *system)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    const struct kiln_parent *parent = &system->emit.parent;
    const struct kiln_system *born_of = &scene->systems[parent->system];
    const bool has_rate = parent->rate.count > 0 || parent->rate.constant != KILN_TRAIL_RATE;
    char path[128];
    snprintf(path, sizeof path, "systems.%s.emit.parent.on.death.impact", system->name);
    if (parent->event == KILN_EVENT_DEATH && parent->impact &&
        !impacts_kill(scene, &born_of->collide))
        return kiln_reader_error_at(reader, root, path,
                                    "no impact ends particles of '%s': set systems.%s.collide.then "
                                    "to die",
                                    born_of->name, born_of->name);
    snprintf(path, sizeof path, "systems.%s.emit.parent.on.bounce.most", system->name);
    if (parent->event == KILN_EVENT_BOUNCE && !parent->every && parent->hits != KILN_BOUNCE_MOST)
        return kiln_reader_error_at(reader, root, path,
                                    "needs `every: true`; without it, the first impact alone "
                                    "counts");
    snprintf(path, sizeof path, "systems.%s.emit.parent.on.trail.most", system->name);
    if (parent->event == KILN_EVENT_TRAIL && !is_by_way(parent) && parent->most != KILN_TRAIL_MOST)
        return kiln_reader_error_at(reader, root, path,
                                    "needs `per_metre`; by the rate, the life of a parent's "
                                    "particle bounds the number of its children");
    snprintf(path, sizeof path, "systems.%s.emit.parent.on.trail", system->name);
    if (parent->event == KILN_EVENT_TRAIL && is_by_way(parent) && has_rate)
        return kiln_reader_error_at(reader, root, path,
                                    "must have one of `rate` and `per_metre`, found both");
    return true;
}

/* Checks the options that a system with a parent must have or must not have. */
static bool check_births(struct kiln_reader *reader, const struct kiln_node *root,
                         const struct kiln_system *system)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    const struct kiln_parent *parent = &system->emit.parent;
    const struct kiln_system *born_of = &scene->systems[parent->system];
    char path[128];
    snprintf(path, sizeof path, "systems.%s.emit.rate", system->name);
    if (kiln_scene_value_max(scene, &system->emit.rate) > 0)
        return kiln_reader_error_at(
            reader, root, path,
            "must be 0 for a system with a parent; emit.parent.on sets the number of births");
    snprintf(path, sizeof path, "systems.%s.emit.per_metre", system->name);
    if (system->emit.per_metre > 0)
        return kiln_reader_error_at(
            reader, root, path,
            "must be 0 for a system with a parent; emit.parent.on sets the number of births");
    snprintf(path, sizeof path, "systems.%s.emit.bursts", system->name);
    if (system->emit.burst_count > 0)
        return kiln_reader_error_at(
            reader, root, path,
            "must be {} for a system with a parent; emit.parent.on sets the number of births");
    snprintf(path, sizeof path, "systems.%s.emit.parent.on", system->name);
    if (parent->event == KILN_EVENT_TRAIL && !is_by_way(parent) &&
        kiln_scene_value_max(scene, &parent->rate) <= 0)
        return kiln_reader_error_at(reader, root, path,
                                    "the rate is 0 at all times; it must be above 0");
    if (parent->event == KILN_EVENT_BOUNCE && !born_of->collide.enabled)
        return kiln_reader_error_at(reader, root, path,
                                    "particles of '%s' never bounce: set systems.%s.collide",
                                    born_of->name, born_of->name);
    return check_event(reader, root, system);
}

/* Checks one value of the look that children have from their parent. name: its key; uses: what the
 * parent's value uses; twice: the parent has it from its own parent. */
static bool check_inherited(struct kiln_reader *reader, const struct kiln_node *root,
                            const struct kiln_system *system, const char *name, uint32_t uses,
                            bool twice)
{
    const uint32_t of_moments = 1u << KILN_CLOCK_SPEED | 1u << KILN_CLOCK_HEIGHT |
                                1u << KILN_CLOCK_DISTANCE | KILN_VALUE_USES_OWN_NOISE |
                                KILN_VALUE_OF_TIME;
    const char *parent = kiln_reader_scene(reader)->systems[system->emit.parent.system].name;
    char path[128];
    snprintf(path, sizeof path, "systems.%s.emit.parent.inherit.%s", system->name, name);
    if (twice)
        return kiln_reader_error_at(reader, root, path,
                                    "must be false, since particles of '%s' have no %s of their "
                                    "own",
                                    parent, name);
    if (uses & of_moments)
        return kiln_reader_error_at(reader, root, path,
                                    "systems.%s.look.%s must be constant or vary over life, age or "
                                    "random numbers, since others inherit it",
                                    parent, name);
    return true;
}

/* Checks what children have of their parent's look. */
static bool check_looks(struct kiln_reader *reader, const struct kiln_node *root, uint32_t index)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    const struct kiln_system *system = &scene->systems[index];
    const struct kiln_inherited *has = &system->emit.parent.look;
    const struct kiln_system *parent = &scene->systems[system->emit.parent.system];
    const struct kiln_inherited of_parent =
        parent->emit.parent.enabled ? parent->emit.parent.look : (struct kiln_inherited){false};
    const struct kiln_interaction *collide =
        kiln_scene_interaction(scene, index, KILN_INTERACT_COLLIDE);
    char path[128];
    snprintf(path, sizeof path, "systems.%s.emit.parent.inherit.color", system->name);
    if (has->color && system->paint.enabled)
        return kiln_reader_error_at(reader, root, path,
                                    "must be false for a system that paints with its own color");
    snprintf(path, sizeof path, "systems.%s.emit.parent.inherit.size", system->name);
    if (has->size && collide && collide->as_drawn)
        return kiln_reader_error_at(reader, root, path,
                                    "must be false where particles collide as they are drawn");
    const struct kiln_value *temperature = &parent->look.temperature;
    snprintf(path, sizeof path, "systems.%s.emit.parent.inherit.temperature", system->name);
    if (has->temperature && !of_parent.temperature &&
        !(kiln_scene_value_max(scene, temperature) > 0.0f))
        return kiln_reader_error_at(reader, root, path,
                                    "particles of '%s' have no temperature: set "
                                    "systems.%s.look.temperature",
                                    parent->name, parent->name);
    return (!has->color ||
            check_inherited(reader, root, system, "color",
                            kiln_value3_uses(scene->keys, &parent->look.color), of_parent.color)) &&
           (!has->size ||
            check_inherited(reader, root, system, "size",
                            kiln_value_uses(scene->keys, &parent->look.size), of_parent.size)) &&
           (!has->temperature ||
            check_inherited(reader, root, system, "temperature",
                            kiln_value_uses(scene->keys, temperature), of_parent.temperature));
}

static bool settle_slots(struct kiln_reader *reader, const struct kiln_node *root,
                         struct kiln_system *system)
{
    uint64_t slots = kiln_family_slots(kiln_reader_scene(reader), &system->emit.parent);
    char path[128];
    snprintf(path, sizeof path, "systems.%s.emit.parent.on", system->name);
    if (slots > KILN_MAX_PARTICLES)
        return kiln_reader_error_at(reader, root, path,
                                    "up to %" PRIu64
                                    " particles are born of one particle; at most %d are allowed",
                                    slots, KILN_MAX_PARTICLES);
    system->emit.parent.slots = (uint32_t)slots;
    return true;
}

/* Refuses particles that are drawn on surfaces and never rest on one, or are pushed there. */
static bool check_lying(struct kiln_reader *reader, const struct kiln_node *root,
                        const struct kiln_system *system)
{
    const struct kiln_collide *collide = &system->collide;
    const bool from_birth = kiln_family_lies_from_birth(system);
    char path[128];
    snprintf(path, sizeof path, "systems.%s.look.facing", system->name);
    if (!kiln_look_lies(&system->look))
        return true;
    if (!from_birth && !(collide->enabled && collide->then >= KILN_THEN_STOP))
        return kiln_reader_error_at(reader, root, path,
                                    "no particle rests on a surface: set systems.%s.collide.then "
                                    "to stop or stick, or let impacts give birth to particles "
                                    "without a speed (emit.parent.on)",
                                    system->name);
    if (from_birth && system->interaction_count > 0)
        return kiln_reader_error_at(reader, root, path,
                                    "must not be surface where particles interact, since nothing "
                                    "pushes a particle that rests from its birth");
    return true;
}

bool kiln_family_settle(struct kiln_reader *reader, const struct kiln_node *root)
{
    struct kiln_scene *scene = kiln_reader_scene(reader);
    bool ok = true;
    for (uint32_t i = 0; ok && i < scene->system_count; i++)
        ok = find_parent(reader, root, i) && find_sources(reader, root, i);
    for (uint32_t i = 0; ok && i < scene->system_count; i++) {
        struct kiln_system *system = &scene->systems[i];
        if (system->emit.parent.enabled)
            ok = check_generations(reader, root, i) && check_births(reader, root, system) &&
                 check_looks(reader, root, i) && settle_slots(reader, root, system);
        ok = ok && check_lying(reader, root, system);
    }
    return ok;
}
