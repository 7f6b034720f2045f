/* This file makes sprites of vectors of particles for the rasteriser of the device `cpu`. What a
 * particle looks like is computed by shared/billboard.h and its neighbours, which GL has, too; the
 * results are the same bits on every machine. */
#include "draw/sprites/sprite_cells.h"
#include "draw/sprites/sprite_haze.h"
#include "draw/sprites/sprite_light.h"
#include "draw/sprites/sprite_place.h"

enum {
    PIECE_SIZE = 512,       /* particles of a piece, which are sorted by system */
    PREFETCH_DISTANCE = 32, /* particles that are prefetched */
};

/* ---- form ------------------------------------------------------------------------------------ */

/* Finds the planes of billboards that lie in planes of the world. The others face the camera. */
static struct billboard_plane find_aligned_plane(struct sprite_lanes *p)
{
    const float4 *rows = p->pass->view->world_to_view;
    struct vf3 normal;
    if (p->look->form.y == LOOK_NORMAL) {
        const struct columns row = look_row(p, KILN_LOOK_AXIS);
        normal = (struct vf3){row.c[0], row.c[1], row.c[2]};
        p->lies = ~(vi){0};
    } else {
        normal = vf_heading(&p->record);
        p->lies = p->record.stopped;
    }
    const struct billboard_plane picture = billboard_plane_of_picture();
    const struct billboard_plane plane =
        billboard_plane_across(normal, p->center, rows[0], rows[1], rows[2]);
    return (struct billboard_plane){real3_select(p->lies, plane.right, picture.right),
                                    real3_select(p->lies, plane.up, picture.up),
                                    real3_select(p->lies, plane.normal, picture.normal)};
}

static struct billboard_plane find_plane(struct sprite_lanes *p)
{
    const uint32_t facing = p->look->form.y;
    if (billboard_is_flat(facing))
        return billboard_plane_of_picture();
    if (billboard_is_aligned(facing))
        return find_aligned_plane(p);
    struct vf3 axis = {vf_all(0.0f), vf_all(1.0f), vf_all(0.0f)};
    if (facing == LOOK_AXIAL) {
        struct columns row = look_row(p, KILN_LOOK_AXIS);
        axis = (struct vf3){row.c[0], row.c[1], row.c[2]};
    }
    return billboard_plane_facing(facing, to_view(p->pass->view, axis), p->center);
}

/* Returns whether the velocity of some billboard turns or lengthens it. */
SIMD bool some_stretch(const struct sprite_lanes *p)
{
    const uint32_t facing = p->look->form.y;
    return facing == LOOK_AXIAL || facing == LOOK_VELOCITY || any(p->shape.c[1] > 0.0f);
}

/* Turns billboards in their plane by their angle, or along their velocity. */
static void turn_billboards(struct sprite_lanes *p)
{
    const struct billboard_plane plane = find_plane(p);
    vf angle = vf_lerp(p->turn.c[0], p->turn.c[1], vu_unit(p->stream, RANDOM_ROTATION));
    vf spin = vf_lerp(p->spread.c[2], p->spread.c[3], vu_unit(p->stream, RANDOM_SPIN));
    vf side = billboard_side(vu_unit(p->stream, RANDOM_SPIN + 1u));
    const vf turned_s = vf_turned(&p->record, p->age_s, p->pass->view->clock.y);
    const struct vf_angle rotation = vf_sincos(angle + spin * side * turned_s);
    vf half_width = p->half_size, half_length = p->half_size;
    if ((p->look->flags.y & LOOK_FORMED) != 0) {
        const struct columns form = look_row(p, KILN_LOOK_FORM);
        half_width *= form.c[0];
        half_length *= form.c[1];
    }
    struct billboard_edge edge = {-rotation.sine, rotation.cosine, half_length};
    if (some_stretch(p)) {
        struct vf3 moving = to_view(p->pass->view, vf_heading(&p->record));
        edge =
            billboard_stretched(p->look->form.y, edge, vf_where(~p->record.stopped, p->shape.c[1]),
                                vf3_dot(moving, plane.right), vf3_dot(moving, plane.up));
    }
    p->half_length = edge.half_length;
    if (p->look->form.x == 0 && p->look->form.w != 0)
        p->words[WORD_OF(opacity)] *= billboard_dimming(half_length, edge.half_length);
    p->half_size = half_width;
    if ((p->look->flags.y & LOOK_UNMIRRORED) != 0)
        side = vf_all(1.0f);
    p->plane = billboard_rotated(plane, edge, side);
}

/* Widens small billboards of a picture smaller than the frame. */
SIMD void widen(struct sprite_lanes *p, vf pixels_per_m)
{
    if (!(p->pass->view->clock.w < 1.0f) || p->look->form.x != 0)
        return;
    const struct billboard_size size =
        billboard_widened(p->half_size, p->half_length, pixels_per_m);
    p->half_size = size.half_width;
    p->half_length = size.half_length;
    p->words[WORD_OF(opacity)] *= size.opacity;
}

/* Sets how billboards in planes of the world fade, but for those that fade by equation 3.3 as it is
 * printed. Returns the factor on their size by which their cells are chosen. */
SIMD vf lay(struct sprite_lanes *p)
{
    if (p->look->form.x != 0 || !billboard_is_aligned(p->look->form.y))
        return vf_all(1.0f);
    const struct billboard_lying lying =
        billboard_lying_of(p->plane, p->center, p->shape.c[3], p->half_size);
    if (p->look->flags.z == 0) {
        p->words[WORD_OF(soft)] = vf_select(p->lies, lying.soft, p->shape.c[3]);
        p->extra[EXTRA_WORD_OF(distance)] = vf_where(p->lies, lying.near);
    }
    return vf_select(p->lies, billboard_slant(p->plane, p->center), vf_all(1.0f));
}

/* ---- colour ---------------------------------------------------------------------------------- */

/* Returns a mask of the particles that reflect light. */
SIMD vi reflecting(const struct sprite_lanes *p)
{
    return (p->cover.c[0] > 0.0f) | (p->cover.c[1] > 0.0f) | (p->cover.c[2] > 0.0f);
}

static void choose_shade(struct sprite_lanes *p)
{
    p->shade = vi_all(KILN_SHADE_PLAIN);
    if (p->look->form.x != 0)
        return;
    vi lit = (p->cover.c[3] > 0.0f) & reflecting(p);
    p->shade = vi_select((vi)p->texture.c[2] == (int32_t)KILN_CELL_COLOR, vi_all(KILN_SHADE_COLOR),
                         vi_select(lit, vi_all(KILN_SHADE_LIT), vi_all(KILN_SHADE_GLOW)));
}

/* Returns whether the sprites cover what is behind them, or their alpha is summed. */
SIMD bool cover(const struct sprite_lanes *p)
{
    return p->look->flags.x == 0 || p->pass->fire_covers;
}

/* Puts haze before the light of a channel: dims what the sprites emit and reflect, and adds the
 * haze itself, which is as opaque as each place on them. */
SIMD void veil(const struct sprite_lanes *p, const struct sprite_haze *haze, vf added, vf *base,
               vf *slope)
{
    const vi colored = p->shade == KILN_SHADE_COLOR;
    *slope = vf_select(colored, added, *slope * haze->clear);
    *base = *base * haze->clear + vf_where(~colored, added);
}

static void color_sprites(struct sprite_lanes *p)
{
    const vf zero = vf_all(0.0f);
    const bool hazy = has_haze(p->pass->backdrop);
    struct sprite_haze haze;
    if (hazy)
        haze = find_haze(p, cover(p));
    vi lit = p->shade == KILN_SHADE_LIT, glows = p->shade == KILN_SHADE_GLOW;
    vi emits = vi_all(0), heated = vi_all(0);
    struct light_sum light;
    memset(&light, 0, sizeof light);
    if (any(p->visible & reflecting(p)))
        light_sprites(p, &light);
    bool some_lit = any(lit & p->visible);
    const struct light_channel *channels[3] = {&light.red, &light.green, &light.blue};
    for (size_t c = 0; c < 3; c++) {
        const struct light_channel *channel = channels[c];
        vf albedo = p->cover.c[c], hot = p->hot.c[c], cool = p->cool.c[c];
        /* The light on a sprite without normals in its cell does not change along the axes. */
        vf flat = vf_max(channel->all + channel->along.z, zero) * albedo;
        vf base = vf_select(lit, cool, vf_select(glows, cool, hot) + flat);
        vf slope = vf_where(lit | glows, hot - cool);
        if (hazy) {
            const vf added[3] = {haze.added.x, haze.added.y, haze.added.z};
            veil(p, &haze, added[c], &base, &slope);
            albedo *= haze.clear;
        }
        heated |= slope != 0.0f;
        emits |= (base != 0.0f) | heated;
        p->words[WORD_OF(base) + c] = base;
        p->words[WORD_OF(slope) + c] = slope;
        if (!some_lit)
            continue;
        p->extra[EXTRA_WORD_OF(light) + c] = vf_where(lit, channel->all * albedo);
        p->extra[EXTRA_WORD_OF(light) + 3 + c] = vf_where(lit, channel->along.x * albedo);
        p->extra[EXTRA_WORD_OF(light) + 6 + c] = vf_where(lit, channel->along.y * albedo);
        p->extra[EXTRA_WORD_OF(light) + 9 + c] = vf_where(lit, channel->along.z * albedo);
    }
    p->flags |= emits & KILN_SPRITE_EMITS;
    if (hazy && cover(p))
        p->flags |= (p->shade == KILN_SHADE_COLOR) & KILN_SPRITE_VEILED;
    p->shade = vi_select(glows & ~heated, vi_all(KILN_SHADE_ALPHA), p->shade);
    const struct columns bloom = look_row(p, KILN_LOOK_BLOOM);
    for (size_t c = 0; c < 3; c++)
        p->words[WORD_OF(bloom) + c] = bloom.c[c];
    if (p->look->form.x == 0)
        p->words[WORD_OF(bulge)] = p->half_size * bloom.c[3];
}

/* ---- from particle to sprite ----------------------------------------------------------------- */

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

static void read_particles(struct sprite_lanes *p)
{
    const struct kiln_sprite_pass *pass = p->pass;
    const struct kiln_view *view = pass->view;
    p->record = read_records(pass->records, p->slots);
    p->stream = vu_mix(p->record.serial + p->look->derived.random_key);
    p->age_s = vf_age(p->record.birth, view->clock_step.x, view->within.x, view->clock.y);
    p->progress = vf_progress(
        p->age_s, vf_life(pass->scene->keys, &p->look->derived, p->stream, p->record.birth));
    vf sample = p->progress * (float)(KILN_LOOK_SAMPLES - 1);
    vi number = vi_of(vf_min(sample, vf_all((float)(KILN_LOOK_SAMPLES - 2))));
    p->samples = lane_offsets_of(number * 4);
    vf_spread_fours(sample - vf_of(number), p->sample_part);
    const float4 *rows = view->world_to_view;
    p->center =
        (struct vf3){vf3_map(rows[0], p->record.position), vf3_map(rows[1], p->record.position),
                     vf3_map(rows[2], p->record.position)};
    p->depth = -p->center.z;
    if (p->program->count > 0)
        read_clocks(p);
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

static void place_sprites(struct sprite_lanes *p)
{
    const struct kiln_view *view = p->pass->view;
    p->spread = look_row(p, KILN_LOOK_SPREAD);
    p->turn = look_row(p, KILN_LOOK_TURN);
    p->cool = look_row(p, KILN_LOOK_COOL);
    p->cover = look_row(p, KILN_LOOK_COVER);
    p->scale = vf_lerp(p->spread.c[0], p->spread.c[1], vu_unit(p->stream, RANDOM_SCALE));
    p->half_size = 0.5f * p->shape.c[0] * p->scale;
    turn_billboards(p);
    p->texture = choose_textures(p);
    choose_shade(p);
    vf pixels_per_m =
        (view->frustum.w / (2.0f * view->frustum.y)) / vf_max(p->depth, vf_all(1e-3f));
    widen(p, pixels_per_m);
    vf diameter_px = 2.0f * p->half_size * pixels_per_m;
    if (p->look->form.x != 0) {
        place_plain(p, diameter_px);
        return;
    }
    const vf shown = lay(p);
    p->level = level_of(diameter_px * shown, 2.0f * p->half_length * pixels_per_m * shown);
    choose_cells(p);
    if (billboard_is_flat(p->look->form.y))
        place_flat(p);
    else
        place_deep(p);
}

static_assert(WORD_OF(pitch) == WORD_OF(shade) && WORD_OF(pitch) == WORD_OF(flags) &&
                  offsetof(struct kiln_sprite, shade) % 4 == 2,
              "pitch, shade and flags are one word");

static void finish_sprites(struct sprite_lanes *p)
{
    p->flags |=
        (cover(p) ? KILN_SPRITE_COVERS : 0) | (p->look->flags.z != 0 ? KILN_SPRITE_LITERAL : 0);
    vi pitch = vi_all(0);
    if (p->look->form.x == 0)
        pitch = vi_of(p->words[WORD_OF(edge_u)]) + KILN_CELL_MARGIN;
    p->words[WORD_OF(pitch)] = (vf)(pitch | p->shade << 16 | p->flags << 24);
    p->has_extras = /* as kiln_sprite_has_extra */
        any(p->visible & ((p->shade == KILN_SHADE_LIT) |
                          ((p->flags & (KILN_SPRITE_DEEP | KILN_SPRITE_LITERAL)) != 0)));
    if (p->look->flags.z != 0)
        p->extra[EXTRA_WORD_OF(distance)] = vf_sqrt(vf3_dot(p->center, p->center));
}

/* Holds the entries of a piece, and in `order` their numbers sorted by system; entries of one
 * system keep their order. */
struct piece {
    const uint32_t *entries;
    struct kiln_sprites to;
    uint32_t count;
    uint16_t order[PIECE_SIZE];
};

/* Sorts a piece by system. Writes where each system's entries start in `order`, and the end, to
 * first. */
static void order_piece(struct piece *piece, uint32_t system_count,
                        uint32_t first[KILN_MAX_SYSTEMS + 1])
{
    memset(first, 0, (system_count + 1) * sizeof *first);
    for (uint32_t i = 0; i < piece->count; i++)
        first[KILN_ENTRY_SYSTEM(piece->entries[i]) + 1]++;
    uint32_t next[KILN_MAX_SYSTEMS];
    for (uint32_t i = 0; i < system_count; i++) {
        next[i] = first[i];
        first[i + 1] += first[i];
    }
    for (uint32_t i = 0; i < piece->count; i++)
        piece->order[next[KILN_ENTRY_SYSTEM(piece->entries[i])]++] = (uint16_t)i;
}

/* Prefetches records and sprites, since neighbours in depth are far apart in memory, and the
 * sprites' memory is too large for the caches. extras: true: prefetches the sprites' extras, too.
 * The function is inline because gcc drops calls of a function that only prefetches, as one without
 * effect. */
SIMD void fetch(const struct kiln_sprite_pass *pass, const struct piece *piece, uint32_t from,
                uint32_t to, bool extras)
{
    const float *sunlit = pass->lighting->sunlit;
    for (uint32_t i = from; i < to && i < piece->count; i++) {
        uint32_t slot = KILN_ENTRY_SLOT(piece->entries[piece->order[i]]);
        __builtin_prefetch(&pass->records[slot]);
        if (sunlit)
            __builtin_prefetch(&sunlit[slot]);
        const char *sprite = (const char *)&piece->to.sprites[piece->order[i]];
        for (size_t line = 0; line < sizeof *piece->to.sprites; line += 64)
            __builtin_prefetch(sprite + line, 1);
        if (extras)
            __builtin_prefetch(&piece->to.extras[piece->order[i]], 1);
    }
}

/* Makes the sprites of a vector of particles. lanes: numbers of their entries in the piece. */
static void make_vector(struct sprite_lanes *p, const struct piece *piece,
                        const uint16_t lanes[LANES])
{
    for (int i = 0; i < LANES; i++)
        p->slots[i] = (int32_t)KILN_ENTRY_SLOT(piece->entries[lanes[i]]);
    memset(p->words, 0, sizeof p->words);
    memset(p->extra, 0, sizeof p->extra);
    p->flags = vi_all(0);
    p->has_extras = false;
    read_particles(p);
    fade_particles(p);
    if (any(p->visible))
        place_sprites(p);
    if (any(p->visible)) {
        color_sprites(p);
        finish_sprites(p);
    }
    float *sprites = (float *)(void *)piece->to.sprites;
    for (int line = 0; line < SPRITE_WORDS; line += LINE_FLOATS)
        vf_store_lines(p->words + line, sprites + line, SPRITE_WORDS, lanes);
    if (p->has_extras)
        vf_store_lines(p->extra, (float *)(void *)piece->to.extras, EXTRA_WORDS, lanes);
}

static void make_piece(const struct kiln_sprite_pass *pass, struct piece *piece)
{
    const uint32_t system_count = pass->scene->system_count;
    uint32_t first[KILN_MAX_SYSTEMS + 1];
    order_piece(piece, system_count, first);
    fetch(pass, piece, 0, PREFETCH_DISTANCE, false);
    struct sprite_lanes p;
    p.pass = pass;
    p.has_extras = false;
    for (uint32_t system = 0; system < system_count; system++) {
        p.look = &pass->looks[system];
        p.program = &pass->programs[system];
        p.rows = &pass->table[(size_t)system * KILN_LOOK_ROWS * KILN_LOOK_SAMPLES].x;
        const uint32_t end = first[system + 1];
        const uint32_t capacity = pass->scene->systems[system].capacity;
        p.mixes_cells = vi_all(-(capacity >= KILN_CELL_MIXED_LEAST));
        p.samples_floats = vi_all(-(capacity <= KILN_CELL_FINE_MOST));
        for (uint32_t i = first[system]; i < end; i += LANES) {
            uint16_t rest[LANES]; /* the last entries, padded with the last one */
            for (uint32_t k = 0; end - i < LANES && k < LANES; k++)
                rest[k] = piece->order[i + k < end ? i + k : end - 1];
            fetch(pass, piece, i + PREFETCH_DISTANCE, i + PREFETCH_DISTANCE + LANES, p.has_extras);
            make_vector(&p, piece, end - i < LANES ? rest : piece->order + i);
        }
    }
}

void KILN_SIMD_NAME(kiln_sprites_make)(const struct kiln_sprite_pass *pass, const uint32_t *entries,
                                       size_t count, struct kiln_sprites to)
{
    for (size_t i = 0; i < count; i += PIECE_SIZE) {
        struct piece piece = {.entries = entries + i,
                              .to = kiln_sprites_from(to, i),
                              .count = count - i < PIECE_SIZE ? (uint32_t)(count - i) : PIECE_SIZE};
        make_piece(pass, &piece);
    }
}
