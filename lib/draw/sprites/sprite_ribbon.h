/* This header makes the sprites of ribbons by shared/ribbon.h. A draw entry of a ribbon stands for
 * the segment from its particle to the next one, and is repeated for each of its parts. */
#ifndef KILN_DRAW_SPRITES_SPRITE_RIBBON_H
#define KILN_DRAW_SPRITES_SPRITE_RIBBON_H

#include "draw/sprites/sprite_cells.h"
#include "draw/sprites/sprite_color.h"
#include "draw/sprites/sprite_place.h"
#include "draw/sprites/sprite_read.h"
#include "shared/ribbon.h"

/* ---- the particles of a segment -------------------------------------------------------------- */

/* Holds the particles around a vector of segments, whose first particles are in sprite_lanes. */
struct ribbon_lanes {
    struct vf_particles before, to, after;
    vi to_slots;
    vi is_joined; /* mask: `to` is the parent, at the birth of the next child */
    struct ribbon_points points;
    vi number; /* of the first particle in its ribbon; 0 if it never ends */
};

/* Returns the slots `by` after or before those of a system, in the order of serials. */
SIMD vi slots_beside(const struct kiln_draw_look *look, vi slots, int32_t by)
{
    const int32_t first = (int32_t)LOOK_RIBBON_SLOT(look->ribbon.x);
    const int32_t capacity = (int32_t)LOOK_RIBBON_SLOT(look->ribbon.y);
    vi beside = slots + by;
    beside = vi_select(beside < first, beside + capacity, beside);
    return vi_select(beside >= first + capacity, beside - capacity, beside);
}

/* Returns which particles are alive and have the serials. */
SIMD vi are_there(const struct vf_particles *p, vu serials)
{
    return (vi)(p->serial == serials) & ((vi)(p->birth & KILN_PARTICLE_ALIVE) != 0);
}

/* Finds the place of the living parent of one particle whose later siblings are not born yet.
 * Returns false if there is none. */
static bool find_parent(const struct kiln_particle *records, const struct kiln_draw_look *look,
                        uint32_t slot, uint32_t serial, float3 *place)
{
    const uint32_t run = look->ribbon.z, number = serial % run;
    const struct kiln_particle parent = records[LOOK_PARENT_RECORD(look->values, serial)];
    if (number == run - 1 || !particle_is_alive(parent) || parent.position_serial.w != serial / run)
        return false;
    for (uint32_t i = 1; i < run - number; i++) {
        const struct kiln_particle *sibling = &records[slot + i];
        if (particle_is_alive(*sibling) && sibling->position_serial.w == serial + i)
            return false;
    }
    *place = particle_position(parent);
    return true;
}

/* Finds the parents that the ribbons of some lanes go on to. slots, serials: of their particles.
 * Returns which lanes have one, and puts its place there. */
static vi join_parents(const struct sprite_lanes *p, vi slots, vu serials, vi lanes,
                       struct vf3 *places)
{
    vi joined = vi_all(0);
    if ((p->look->ribbon.y & LOOK_RIBBON_JOINS) == 0 || !any(lanes))
        return joined;
    for (int i = 0; i < LANES; i++) {
        float3 place;
        if (!lanes[i] ||
            !find_parent(p->pass->records, p->look, (uint32_t)slots[i], serials[i], &place))
            continue;
        joined[i] = -1;
        places->x[i] = place.x;
        places->y[i] = place.y;
        places->z[i] = place.z;
    }
    return joined;
}

/* Returns which of two places lie no farther from each other than a look's longest segment. */
SIMD vi are_near(const struct sprite_lanes *p, struct vf3 a, struct vf3 b)
{
    const struct vf3 way = vf3_sub(a, b);
    const vf gap = p->shape.c[1];
    return (gap <= 0.0f) | (vf3_dot(way, way) <= gap * gap);
}

/* Finds the particles around segments. Lanes without a segment become invisible. */
static void find_segments(struct sprite_lanes *p, struct ribbon_lanes *r)
{
    const struct kiln_sprite_pass *pass = p->pass;
    const struct kiln_draw_look *look = p->look;
    const uint32_t run = look->ribbon.z;
    vi first = vi_all(0), last = vi_all(0), next_is_last = vi_all(0);
    r->number = vi_all(0);
    for (int i = 0; i < LANES && run > 0; i++) {
        const uint32_t number = p->record.serial[i] % run;
        r->number[i] = (int32_t)number;
        first[i] = -(int32_t)(number == 0);
        last[i] = -(int32_t)(number == run - 1);
        next_is_last[i] = -(int32_t)(number + 2 >= run);
    }
    const vu serial = p->record.serial;
    r->to_slots = slots_beside(look, p->slots, 1);
    r->before = read_records(pass->records, slots_beside(look, p->slots, -1));
    r->to = read_records(pass->records, r->to_slots);
    r->after = read_records(pass->records, slots_beside(look, r->to_slots, 1));
    const vi goes_on = are_there(&r->to, serial + 1) & ~last;
    r->is_joined = join_parents(p, p->slots, serial, p->visible & ~goes_on, &r->to.position);
    r->to.serial = serial + 1;
    r->to.birth = (vu)vi_select(r->is_joined, (vi)p->record.birth, (vi)r->to.birth);
    r->to.stopped &= ~r->is_joined;
    r->to_slots = vi_select(r->is_joined, p->slots, r->to_slots);
    p->visible &= (goes_on | r->is_joined) & are_near(p, p->record.position, r->to.position);
    r->points.has_before = are_there(&r->before, serial - 1) & ~first &
                           are_near(p, r->before.position, p->record.position);
    vi has_after = are_there(&r->after, serial + 2) & goes_on & ~next_is_last;
    has_after |= join_parents(p, r->to_slots, serial + 1, p->visible & goes_on & ~has_after,
                              &r->after.position);
    has_after &= are_near(p, r->to.position, r->after.position);
    r->points.before = view_place(pass->view, r->before.position);
    r->points.from = p->center;
    r->points.to = view_place(pass->view, r->to.position);
    r->points.after = view_place(pass->view, r->after.position);
    r->points.has_before &= ribbon_bends(r->points.before, r->points.from, r->points.to);
    r->points.has_after = has_after & ribbon_bends(r->points.from, r->points.to, r->points.after);
}

/* ---- its ends -------------------------------------------------------------------------------- */

/* Holds what a ribbon is at one of its particles. */
struct ribbon_end {
    vf half_width; /* m */
    vf along;      /* place in the texture, in textures */
    vf opacity;
    vf base[3], slope[3];
};

/* Computes the ends of segments at the particles of `p`, which have faded; their colours stay in
 * it. number: of the particles in their ribbons. */
static void find_end(struct sprite_lanes *p, vi number, struct ribbon_end *end)
{
    const uint32_t run = p->look->ribbon.z;
    p->spread = look_row(p, KILN_LOOK_SPREAD);
    p->turn = look_row(p, KILN_LOOK_TURN);
    p->cool = look_row(p, KILN_LOOK_COOL);
    p->cover = look_row(p, KILN_LOOK_COVER);
    p->scale = vf_lerp(p->spread.c[0], p->spread.c[1], vu_unit(p->stream, RANDOM_SCALE));
    const bool counted = (p->look->ribbon.y & LOOK_RIBBON_COUNTED) != 0;
    vf along = p->progress;
    if (counted)
        along = vf_of(number) * (1.0f / (float)(run > 1 ? run - 1 : 1));
    const vf taper = vf_lerp(p->turn.c[1], p->turn.c[0], along);
    end->half_width = 0.5f * p->shape.c[0] * p->scale * taper;
    p->half_size = end->half_width;
    end->along = along;
    end->opacity = p->words[WORD_OF(opacity)];
    p->plane = billboard_plane_facing(
        LOOK_VIEWPOINT,
        to_view(p->pass->view, (struct vf3){vf_all(0.0f), vf_all(1.0f), vf_all(0.0f)}), p->center);
    color_sprites(p);
    for (size_t c = 0; c < 3; c++) {
        end->base[c] = p->words[WORD_OF(base) + c];
        end->slope[c] = p->words[WORD_OF(slope) + c];
    }
}

/* Finds the places in a texture that repeats along ribbons: those that follow from the numbers of
 * particles, of which whole textures do not matter. */
SIMD void count_textures(const struct sprite_lanes *p, const struct ribbon_lanes *r,
                         struct ribbon_end ends[2])
{
    const uint32_t step = p->look->ribbon.w;
    if (!any(p->turn.c[2] > 0.0f))
        return;
    const vf unit = vf_all(0x1p-24f);
    const vu number = p->look->ribbon.z > 0 ? (vu)r->number : p->record.serial;
    const struct vf3 way = vf3_sub(r->to.position, p->record.position);
    const vf length = vf_sqrt(vf3_dot(way, way)) * p->turn.c[2];
    ends[0].along = vf_of((vi)(number * step >> 8)) * unit;
    ends[1].along = ends[0].along + vf_select(r->is_joined, length, vf_all((float)step * 0x1p-32f));
}

/* ---- sprites --------------------------------------------------------------------------------- */

/* Chooses the cell of ribbons: the first of their texture, at the level of their width. */
static void choose_ribbon_cells(struct sprite_lanes *p, vf width_px)
{
    p->level = level_of(width_px, width_px);
    const vi first = (vi)p->texture.c[0];
    struct chosen_cells chosen = {first, first, vi_all(0), p->level, vf_all(0.0f)};
    const vi cells = cell_number(first, vi_all(0), p->level);
    request_cells(p, &chosen, cells, p->visible);
    p->words[WORD_OF(cell)] = (vf)cells;
    p->words[WORD_OF(edge_u)] = p->words[WORD_OF(edge_v)] = edge_of(p->level);
}

SIMD void put_line(vf *words, const struct ribbon_line *line)
{
    words[0] = line->x;
    words[1] = line->y;
    words[2] = line->at;
}

/* Places parts of segments. part: which, of `parts`. */
SIMD void place_parts(struct sprite_lanes *p, const struct ribbon_lanes *r,
                      const struct ribbon_end ends[2], vf part, float parts)
{
    const struct kiln_view *view = p->pass->view;
    const bool straight = parts < 2.0f;
    const vf begins = part * (1.0f / parts), ends_at = (part + 1.0f) * (1.0f / parts);
    const vi is_first = part<0.5f, is_last = part> parts - 1.5f;
    const vf at[2] = {vf_select(is_first, vf_all(0.0f), begins),
                      vf_select(is_last, vf_all(1.0f), ends_at)};
    struct ribbon_joint joints[2];
    for (size_t i = 0; i < 2; i++) {
        const struct ribbon_place place = ribbon_place_at(r->points, at[i], straight);
        struct vf3 face = place.at;
        if ((p->look->ribbon.y & LOOK_RIBBON_NORMAL) != 0) {
            const struct columns row = look_row(p, KILN_LOOK_AXIS);
            face = to_view(view, (struct vf3){row.c[0], row.c[1], row.c[2]});
        }
        const vf width = vf_lerp(ends[0].half_width, ends[1].half_width, at[i]);
        joints[i] = ribbon_joint_at(view->frustum, view->principal, place, width, face);
        p->extra[EXTRA_WORD_OF(ribbon.near) + i] = joints[i].near;
        p->extra[EXTRA_WORD_OF(ribbon.along) + i] = vf_lerp(ends[0].along, ends[1].along, at[i]);
        p->visible &= -place.at.z > view->eye.w;
    }
    const struct ribbon_part made = ribbon_part_between(joints[0], joints[1], straight);
    p->visible &= made.seen;
    put_line(p->words + WORD_OF(joints), &made.begins);
    put_line(p->words + WORD_OF(joints) + 3, &made.ends);
    put_line(p->extra + EXTRA_WORD_OF(ribbon.middle), &made.middle);
    p->extra[EXTRA_WORD_OF(ribbon.half_px)] = made.half_begins;
    p->extra[EXTRA_WORD_OF(ribbon.half_px) + 1] = made.half_ends;
    p->words[WORD_OF(opacity)] =
        vf_lerp(ends[0].opacity, ends[1].opacity, at[0]) * made.thin_begins;
    p->extra[EXTRA_WORD_OF(ribbon.to_opacity)] =
        vf_lerp(ends[0].opacity, ends[1].opacity, at[1]) * made.thin_ends;
    for (size_t c = 0; c < 3; c++) {
        p->words[WORD_OF(base) + c] = vf_lerp(ends[0].base[c], ends[1].base[c], at[0]);
        p->words[WORD_OF(slope) + c] = vf_lerp(ends[0].slope[c], ends[1].slope[c], at[0]);
        p->extra[EXTRA_WORD_OF(ribbon.to_base) + c] =
            vf_lerp(ends[0].base[c], ends[1].base[c], at[1]);
        p->extra[EXTRA_WORD_OF(ribbon.to_slope) + c] =
            vf_lerp(ends[0].slope[c], ends[1].slope[c], at[1]);
    }
    p->flags |= is_first & ~r->points.has_before & KILN_SPRITE_BEGINS;
    p->flags |= is_last & ~r->points.has_after & KILN_SPRITE_ENDS;
    choose_ribbon_cells(p, 2.0f * vf_max(made.half_begins, made.half_ends));
    limit_box(p, made.low, made.high);
}

/* Makes the sprites of a vector of parts of segments of one system. parts: the numbers of the parts
 * in drawing order, of which the first is that at the farther end. Leaves the sprites in p->words
 * and p->extra. */
static void make_ribbons(struct sprite_lanes *p, vi parts)
{
    const float count = (float)LOOK_RIBBON_PARTS(p->look->ribbon.x);
    read_particles(p);
    fade_particles(p);
    p->visible = p->depth > p->pass->view->eye.w;
    struct ribbon_lanes r;
    find_segments(p, &r);
    if (!any(p->visible))
        return;
    struct sprite_lanes to = *p;
    to.record = r.to;
    to.slots = r.to_slots;
    read_ages(&to);
    to.age_s = vf_where(~r.is_joined, to.age_s);
    place_in_look(&to);
    fade_particles(&to);
    p->visible &= (p->words[WORD_OF(opacity)] > 0.0f) | (to.words[WORD_OF(opacity)] > 0.0f);
    to.visible = p->visible;
    p->texture = choose_textures(p);
    const vi colored = (vi)p->texture.c[2] == (int32_t)KILN_CELL_COLOR;
    p->shade = vi_select(colored, vi_all(KILN_SHADE_COLOR), vi_all(KILN_SHADE_GLOW));
    to.shade = p->shade;
    struct ribbon_end ends[2];
    find_end(p, r.number, &ends[0]);
    find_end(&to, r.number + 1, &ends[1]);
    count_textures(p, &r, ends);
    p->flags |= to.flags;
    const vf part = vf_of(parts);
    const vf from_tail = vf_select(p->depth >= to.depth, part, count - 1.0f - part);
    place_parts(p, &r, ends, from_tail, count);
    if (any(p->turn.c[2] > 0.0f))
        p->flags |= KILN_SPRITE_REPEATS;
    p->flags |= KILN_SPRITE_DEEP | (cover(p) ? KILN_SPRITE_COVERS : 0);
    p->shade = vi_select(colored, vi_all(KILN_SHADE_RIBBON_COLOR), vi_all(KILN_SHADE_RIBBON));
    const vi pitch = vi_of(p->words[WORD_OF(edge_u)]) + KILN_CELL_MARGIN;
    p->words[WORD_OF(pitch)] = (vf)(pitch | p->shade << 16 | p->flags << 24);
    p->has_extras = any(p->visible);
}

#endif
