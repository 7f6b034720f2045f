/* This file says of an option in a scene file what it decides: how particles move, at which
 * moments and from where the camera sees them, or only how the picture looks. Each row of the
 * option tables (scene/options*.c) names one of these functions. The printer calls it for each row
 * while kiln_scene_part_hash prints one part of a scene to hash it. kiln_scene_part_hash also asks
 * for each object whether the content of its file belongs to the hash.
 *
 * A saved state carries these hashes. A scene takes up only states of its own motion hash and, if
 * a stage keeps a history of what the camera has seen, of its own view hash. So a row that can
 * change a particle's state must return BOTH; otherwise a scene takes up states of another motion.
 * A row that returns BOTH without need makes states useless that would have served.
 * tests/unit/test_motion.c changes every row and checks this. */
#include "scene/parts.h"

#include "scene/baked.h"
#include "scene/source.h"

/* A row that decides the motion also decides the view, so no row belongs to the motion alone. */
enum {
    NEITHER = KILN_PART_HASHED,
    BOTH = KILN_PART_HASHED | KILN_PART_MOTION | KILN_PART_VIEW,
};

unsigned kiln_row_look(const void *scene, const void *base)
{
    (void)scene;
    (void)base;
    return NEITHER;
}

unsigned kiln_row_view(const void *scene, const void *base)
{
    (void)scene;
    (void)base;
    return KILN_PART_HASHED | KILN_PART_VIEW;
}

unsigned kiln_row_motion(const void *scene, const void *base)
{
    (void)scene;
    (void)base;
    return BOTH;
}

/* Returns the number of the system that a look belongs to. The look must be that of a system of the
 * scene. */
static uint32_t system_of(const struct kiln_scene *scene, const struct kiln_look *look)
{
    uint32_t system = 0;
    while (look != &scene->systems[system].look)
        system++;
    return system;
}

/* A row of a look decides the motion if contacts are as drawn: its size then decides when particles
 * touch. */
unsigned kiln_row_if_contacts_are_as_drawn(const void *scene, const void *look)
{
    const struct kiln_interaction *collide =
        kiln_scene_interaction(scene, system_of(scene, look), KILN_INTERACT_COLLIDE);
    return collide && collide->as_drawn ? BOTH : NEITHER;
}

unsigned kiln_row_if_it_paints(const void *scene, const void *look)
{
    return kiln_scene_paints(scene, system_of(scene, look)) ? BOTH : NEITHER;
}

/* Particles that rest have the normal of their surface in their state, where they are drawn on it.
 */
unsigned kiln_row_if_it_lies(const void *scene, const void *look)
{
    (void)scene;
    return ((const struct kiln_look *)look)->facing.way == KILN_FACING_SURFACE ? BOTH : NEITHER;
}

unsigned kiln_row_if_ribbon(const void *scene, const void *look)
{
    (void)scene;
    return ((const struct kiln_look *)look)->shape == KILN_SHAPE_RIBBON ? NEITHER : 0;
}

unsigned kiln_row_if_formed(const void *scene, const void *look)
{
    (void)scene;
    return kiln_look_is_formed(look) ? NEITHER : 0;
}

static bool any_collides(const struct kiln_scene *scene)
{
    bool any = false;
    for (uint32_t i = 0; i < scene->system_count; i++)
        any = any || scene->systems[i].collide.enabled;
    for (uint32_t i = 0; i < scene->gas_count; i++)
        any = any || (scene->gas[i].enabled && scene->gas[i].collide);
    return any;
}

static bool any_paints(const struct kiln_scene *scene)
{
    bool any = false;
    for (uint32_t i = 0; i < scene->system_count; i++)
        any = any || kiln_scene_paints(scene, i);
    return any;
}

unsigned kiln_row_if_particles_hit_floor(const void *scene, const void *backdrop)
{
    return kiln_backdrop_floor_collides(backdrop) && any_collides(scene) ? BOTH : NEITHER;
}

unsigned kiln_row_if_seed_is_pinned(const void *scene, const void *system)
{
    const struct kiln_scene *in = scene;
    const struct kiln_system *s = system;
    return s->seed != (uint32_t)(s - in->systems) ? BOTH : 0;
}

unsigned kiln_row_if_region(const void *scene, const void *force)
{
    (void)scene;
    return ((const struct kiln_force *)force)->region.enabled ? BOTH : 0;
}

unsigned kiln_row_if_stops(const void *scene, const void *collide)
{
    (void)scene;
    return ((const struct kiln_collide *)collide)->then >= KILN_THEN_STOP ? BOTH : 0;
}

unsigned kiln_row_if_not_certain(const void *scene, const void *collide)
{
    (void)scene;
    const struct kiln_value *chance = &((const struct kiln_collide *)collide)->chance;
    return chance->count > 0 || chance->constant != 1.0f ? BOTH : 0;
}

unsigned kiln_row_if_impacts_count(const void *scene, const void *emit)
{
    (void)scene;
    return ((const struct kiln_emitter *)emit)->parent.impact ? BOTH : 0;
}

unsigned kiln_row_if_ordered(const void *scene, const void *emit)
{
    (void)scene;
    return ((const struct kiln_emitter *)emit)->ordered ? BOTH : 0;
}

unsigned kiln_row_if_each_bounce(const void *scene, const void *emit)
{
    (void)scene;
    const struct kiln_parent *parent = &((const struct kiln_emitter *)emit)->parent;
    return parent->event == KILN_EVENT_BOUNCE && parent->every ? BOTH : 0;
}

unsigned kiln_row_if_by_metre(const void *scene, const void *emit)
{
    (void)scene;
    const struct kiln_parent *parent = &((const struct kiln_emitter *)emit)->parent;
    return parent->event == KILN_EVENT_TRAIL && parent->per_metre > 0 ? BOTH : 0;
}

unsigned kiln_row_if_looks_are_inherited(const void *scene, const void *emit)
{
    (void)scene;
    const struct kiln_inherited *look = &((const struct kiln_emitter *)emit)->parent.look;
    return look->color || look->size || look->temperature ? BOTH : 0;
}

unsigned kiln_row_if_emitted_by_metre(const void *scene, const void *emit)
{
    (void)scene;
    return ((const struct kiln_emitter *)emit)->per_metre > 0 ? BOTH : 0;
}

unsigned kiln_row_if_emitter_is_attached(const void *scene, const void *emitter)
{
    (void)scene;
    return ((const struct kiln_emitter *)emitter)->attach.name ? BOTH : 0;
}

unsigned kiln_row_if_space_is_of_node(const void *scene, const void *system)
{
    (void)scene;
    return ((const struct kiln_system *)system)->space.name ? BOTH : 0;
}

unsigned kiln_row_if_force_is_attached(const void *scene, const void *force)
{
    (void)scene;
    return ((const struct kiln_force *)force)->attach.name ? BOTH : 0;
}

unsigned kiln_row_if_region_is_attached(const void *scene, const void *region)
{
    (void)scene;
    return ((const struct kiln_force_region *)region)->attach.name ? BOTH : 0;
}

unsigned kiln_row_if_object_is_attached(const void *scene, const void *object)
{
    (void)scene;
    return ((const struct kiln_object *)object)->attach.name ? BOTH : 0;
}

unsigned kiln_row_if_light_is_attached(const void *scene, const void *light)
{
    (void)scene;
    return ((const struct kiln_light *)light)->attach.name ? NEITHER : 0;
}

unsigned kiln_row_if_camera_is_attached(const void *scene, const void *camera)
{
    (void)scene;
    return ((const struct kiln_camera *)camera)->attach.name ? KILN_PART_HASHED | KILN_PART_VIEW
                                                             : 0;
}

static bool is_carried(const struct kiln_scene *scene, uint32_t node,
                       const struct kiln_attach *attach)
{
    return attach->name && kiln_node_carries(scene, node, attach->node);
}

static bool moves_particles(const struct kiln_scene *scene, uint32_t node,
                            const struct kiln_system *system)
{
    bool moves =
        is_carried(scene, node, &system->emit.attach) || is_carried(scene, node, &system->space);
    const struct kiln_force *force;
    for (uint32_t i = 0; (force = kiln_system_force(system, i)) != NULL; i++)
        moves = moves || is_carried(scene, node, &force->attach) ||
                is_carried(scene, node, &force->region.attach);
    for (uint32_t i = 0; i < system->demitter_count; i++)
        moves = moves || is_carried(scene, node, &system->demitters[i].attach);
    return moves;
}

static bool moves_gas(const struct kiln_scene *scene, uint32_t node,
                      const struct kiln_gas_domain *domain)
{
    bool moves = is_carried(scene, node, &domain->attach);
    for (uint32_t i = 0; i < domain->source_count; i++)
        moves = moves || is_carried(scene, node, &domain->sources[i].emit.attach);
    const struct kiln_force *force;
    for (uint32_t i = 0; (force = kiln_gas_force(domain, i)) != NULL; i++)
        moves = moves || is_carried(scene, node, &force->attach) ||
                is_carried(scene, node, &force->region.attach);
    return moves;
}

static unsigned parts_of_node(const struct kiln_scene *scene, uint32_t node)
{
    unsigned parts = NEITHER;
    if (is_carried(scene, node, &scene->camera.attach))
        parts |= KILN_PART_VIEW;
    for (uint32_t i = 0; i < scene->system_count; i++)
        parts |= moves_particles(scene, node, &scene->systems[i]) ? BOTH : 0;
    for (uint32_t i = 0; i < scene->gas_count; i++)
        parts |= moves_gas(scene, node, &scene->gas[i]) ? BOTH : 0;
    for (uint32_t i = 0; i < scene->backdrop.object_count; i++)
        parts |= is_carried(scene, node, &scene->backdrop.objects[i].attach) ? BOTH : 0;
    return parts;
}

/* Returns the number of the node that a struct lies in. */
static uint32_t number_of(const struct kiln_scene *scene, const void *inside)
{
    const size_t offset = (size_t)((const char *)inside - (const char *)scene->nodes);
    return (uint32_t)(offset / sizeof *scene->nodes);
}

unsigned kiln_row_of_node(const void *scene, const void *inside)
{
    return parts_of_node(scene, number_of(scene, inside));
}

unsigned kiln_row_if_node_is_of_file(const void *scene, const void *inside)
{
    const struct kiln_scene *in = scene;
    return in->nodes[number_of(in, inside)].file ? kiln_row_of_node(scene, inside) : 0;
}

unsigned kiln_row_if_node_is_joint(const void *scene, const void *inside)
{
    const struct kiln_scene *in = scene;
    return in->nodes[number_of(in, inside)].mesh ? kiln_row_of_node(scene, inside) : 0;
}

/* Joints of an object move what is attached to them. */
unsigned kiln_row_if_particles_hit_object(const void *scene, const void *object)
{
    const struct kiln_object *o = object;
    const struct kiln_scene *in = scene;
    const bool bounces = o->collide && any_collides(in);
    const bool painted = kiln_object_takes_paint(o) && any_paints(in);
    unsigned parts = bounces || painted || kiln_object_is_source(scene, o) ? BOTH : NEITHER;
    for (uint32_t i = 0; i < in->node_count; i++) {
        const struct kiln_scene_node *node = &in->nodes[i];
        if (node->mesh && o == &in->backdrop.objects[node->object])
            parts |= parts_of_node(in, i);
    }
    return parts;
}

unsigned kiln_row_of_nodes(const void *scene, const void *base)
{
    const struct kiln_scene *in = scene;
    unsigned parts = 0;
    (void)base;
    for (uint32_t i = 0; i < in->node_count; i++)
        parts |= parts_of_node(in, i);
    return parts;
}

unsigned kiln_row_of_gas(const void *scene, const void *base)
{
    (void)base;
    return ((const struct kiln_scene *)scene)->gas_count > 0 ? BOTH : 0;
}

unsigned kiln_row_of_detail(const void *scene, const void *base)
{
    (void)scene;
    (void)base;
    return NEITHER;
}
