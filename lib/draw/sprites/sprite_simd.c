/* This file makes sprites of vectors of particles for the rasteriser of the device `cpu`. What a
 * particle looks like is computed by shared/billboard.h and its neighbours, which GL has, too; the
 * results are the same bits on every machine. */
#include "draw/sprites/sprite_cells.h"
#include "draw/sprites/sprite_color.h"
#include "draw/sprites/sprite_place.h"
#include "draw/sprites/sprite_read.h"
#include "draw/sprites/sprite_ribbon.h"

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

/* ---- from particle to sprite ----------------------------------------------------------------- */

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

/* Makes the sprites of a vector of particles that are not drawn as ribbons. */
static void make_billboards(struct sprite_lanes *p)
{
    read_particles(p);
    fade_particles(p);
    if (any(p->visible))
        place_sprites(p);
    if (any(p->visible)) {
        color_sprites(p);
        finish_sprites(p);
    }
}

/* Holds the entries of a piece, and in `order` their numbers sorted by system; entries of one
 * system keep their order. */
struct piece {
    const uint32_t *entries;
    const uint8_t *parts; /* or NULL */
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
    vi parts = vi_all(0);
    for (int i = 0; i < LANES; i++) {
        p->slots[i] = (int32_t)KILN_ENTRY_SLOT(piece->entries[lanes[i]]);
        parts[i] = piece->parts ? piece->parts[lanes[i]] : 0;
    }
    memset(p->words, 0, sizeof p->words);
    memset(p->extra, 0, sizeof p->extra);
    p->flags = vi_all(0);
    p->has_extras = false;
    if (p->look->form.x == LOOK_RIBBON)
        make_ribbons(p, parts);
    else
        make_billboards(p);
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
                                       const uint8_t *parts, size_t count, struct kiln_sprites to)
{
    for (size_t i = 0; i < count; i += PIECE_SIZE) {
        struct piece piece = {.entries = entries + i,
                              .parts = parts ? parts + i : NULL,
                              .to = kiln_sprites_from(to, i),
                              .count = count - i < PIECE_SIZE ? (uint32_t)(count - i) : PIECE_SIZE};
        make_piece(pass, &piece);
    }
}
