/* This header reads a vector of particles: where they are, how old, and how their system's look has
 * them at that age. */
#ifndef KILN_DRAW_SPRITES_SPRITE_READ_H
#define KILN_DRAW_SPRITES_SPRITE_READ_H

#include "draw/sprites/sprite_lanes.h"

/* Transforms a place from the world to view space. */
SIMD struct vf3 view_place(const struct kiln_view *view, struct vf3 at)
{
    const float4 *rows = view->world_to_view;
    return (struct vf3){vf3_map(rows[0], at), vf3_map(rows[1], at), vf3_map(rows[2], at)};
}

/* Finds the clocks of the parents of particles whose look inherits values. */
static void read_parents(struct sprite_lanes *p)
{
    const struct kiln_sprite_pass *pass = p->pass;
    const uint4 values = p->look->values;
    const struct kiln_derived_params derived = pass->looks[LOOK_PARENT_SYSTEM(values.w)].derived;
    for (int i = 0; i < LANES; i++) {
        const struct kiln_particle child = pass->records[p->slots[i]];
        const struct kiln_particle parent =
            pass->records[LOOK_PARENT_RECORD(values, child.position_serial.w)];
        const struct value_clocks clocks = particle_clocks_of_child(
            pass->scene->keys, value_clocks_at(0, 0, 0), derived, parent, child);
        p->clocks.parent_life[i] = clocks.parent_life;
        p->clocks.parent_age_s[i] = clocks.parent_age_s;
        p->clocks.parent_stream[i] = clocks.parent_stream;
    }
}

static void read_clocks(struct sprite_lanes *p)
{
    p->clocks = (struct clock_lanes){
        .life = p->progress,
        .age_s = p->age_s,
        .height = p->record.position.y,
        .distance = vf_sqrt(vf3_dot(p->center, p->center)),
        .velocity = p->record.velocity,
        .stream = p->stream,
        .time_s = p->pass->view->clock.x,
    };
    if (LOOK_PARENT_SLOTS(p->look->values.w) != 0)
        read_parents(p);
}

/* Finds the places of particles in view space, and in the table of their looks, from their records
 * and ages. */
static void place_in_look(struct sprite_lanes *p)
{
    const struct kiln_sprite_pass *pass = p->pass;
    p->stream = vu_mix(p->record.serial + p->look->derived.random_key);
    p->progress = vf_progress(
        p->age_s, vf_life(pass->scene->keys, &p->look->derived, p->stream, p->record.birth));
    vf sample = p->progress * (float)(KILN_LOOK_SAMPLES - 1);
    vi number = vi_of(vf_min(sample, vf_all((float)(KILN_LOOK_SAMPLES - 2))));
    p->samples = lane_offsets_of(number * 4);
    vf_spread_fours(sample - vf_of(number), p->sample_part);
    p->center = view_place(pass->view, p->record.position);
    p->depth = -p->center.z;
    if (p->program->count > 0)
        read_clocks(p);
}

static void read_ages(struct sprite_lanes *p)
{
    const struct kiln_view *view = p->pass->view;
    p->age_s = vf_age(p->record.birth, view->clock_step.x, view->within.x, view->clock.y);
}

static void read_particles(struct sprite_lanes *p)
{
    p->record = read_records(p->pass->records, p->slots);
    read_ages(p);
    place_in_look(p);
}

/* Computes the opacity of particles from their look at their age and from the near fade. */
static void fade_particles(struct sprite_lanes *p)
{
    const float near = p->pass->view->eye.w;
    p->shape = look_row(p, KILN_LOOK_SHAPE);
    p->hot = look_row(p, KILN_LOOK_HOT);
    vf near_fade = vf_clamp01((p->depth - near) / vf_max(p->hot.c[3], vf_all(1e-6f)));
    vf opacity = p->shape.c[2] * near_fade;
    p->words[WORD_OF(opacity)] = opacity;
    p->words[WORD_OF(soft)] = p->shape.c[3];
    p->visible = (p->depth > near) & (opacity > 0.0f);
}

#endif
