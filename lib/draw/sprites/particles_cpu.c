/* This file draws particles on the host in pieces of limited size, so that memory stays bounded.
 * For each piece it makes sprites of the particles, lists the sprites for the tiles that they
 * touch, then draws the tiles on threads, each tile's sprites in order. */
#include "draw/sprites/particles_cpu.h"

#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/pages.h"
#include "draw/sprites/bins.h"
#include "draw/sprites/fragments.h"
#include "draw/sprites/tile_target.h"
#include "scene/ribbon.h"
#include "scene/work.h"

enum {
    SPRITES_AT_A_TIME = 1 << 20, /* sprites of a piece */
    SORTED_AT_A_TIME = 1 << 18,  /* the same in a scene with post.compose: oit */
    SPRITES_OF_A_TILE = 1 << 22, /* most sprites of one tile in a scene with post.compose: oit */
    GRAIN = 512                  /* particles of which a thread makes sprites at once */
};

struct kiln_raster_cpu {
    const struct kiln_scene *scene;
    struct kiln_threads *threads;
    struct kiln_cells *cells;
    struct kiln_bins bins;
    struct kiln_sprites sprites;
    uint32_t sprite_room;
    struct kiln_buffer repeated, parts; /* the lists of a pass with ribbons: struct entry_list */
    struct kiln_tile *tiles;            /* one for each thread */
    struct kiln_fragments **fragments;  /* one for each thread; NULL unless post.compose is oit */
    kiln_sprites_make *make;
    kiln_tile_draw *draw;
};

static bool out_of_memory(struct kiln_error *error)
{
    return kiln_error_no_memory(error, "particles");
}

static void free_sprites(struct kiln_sprites *sprites)
{
    free(sprites->sprites);
    free(sprites->extras);
    *sprites = (struct kiln_sprites){0};
}

/* Allocates sprites. Returns false when memory is short, with no sprites. */
static bool alloc_sprites(struct kiln_sprites *sprites, size_t count)
{
    /* Tiles read sprites at scattered addresses; with small pages, a quarter of the drawing time is
     * spent on address translation. */
    sprites->sprites = kiln_alloc_pages(count * sizeof *sprites->sprites);
    sprites->extras = kiln_alloc_pages(count * sizeof *sprites->extras);
    if (sprites->sprites && sprites->extras)
        return true;
    free_sprites(sprites);
    return false;
}

static bool create_fragments(struct kiln_raster_cpu *tiles, enum kiln_simd simd)
{
    if (tiles->scene->post.compose != KILN_COMPOSE_OIT)
        return true;
    const uint32_t threads = kiln_threads_count(tiles->threads);
    tiles->fragments = calloc(threads, sizeof(struct kiln_fragments *));
    for (uint32_t i = 0; i < threads && tiles->fragments; i++) {
        tiles->fragments[i] = kiln_fragments_create(simd);
        if (!tiles->fragments[i])
            return false;
    }
    return tiles->fragments != NULL;
}

struct kiln_raster_cpu *kiln_raster_cpu_create(const struct kiln_scene *scene,
                                               const struct kiln_atlas *atlas,
                                               struct kiln_threads *threads,
                                               struct kiln_error *error)
{
    struct kiln_raster_cpu *tiles = calloc(1, sizeof *tiles);
    if (!tiles) {
        out_of_memory(error);
        return NULL;
    }
    tiles->scene = scene;
    tiles->threads = threads;
    kiln_buffer_init(&tiles->repeated, NULL, 0, "parts of ribbons");
    kiln_buffer_init(&tiles->parts, NULL, 0, "parts of ribbons");
    enum kiln_simd simd;
    if (!kiln_simd_choose(&simd, error)) {
        kiln_raster_cpu_destroy(&tiles);
        return NULL;
    }
    tiles->make = KILN_SIMD_PICK(kiln_sprites_make, simd);
    tiles->draw = KILN_SIMD_PICK(kiln_tile_draw, simd);
    tiles->tiles = aligned_alloc(64, kiln_threads_count(threads) * sizeof *tiles->tiles);
    tiles->cells = kiln_cells_create(atlas, error);
    if (!tiles->tiles || !tiles->cells || !create_fragments(tiles, simd) ||
        !kiln_bins_init(&tiles->bins, scene->width, scene->height, error)) {
        out_of_memory(error);
        kiln_raster_cpu_destroy(&tiles);
    }
    return tiles;
}

void kiln_raster_cpu_footprint(const struct kiln_scene *scene, uint64_t layers,
                               struct kiln_footprint *footprint)
{
    const bool by_fragment = scene->post.compose == KILN_COMPOSE_OIT;
    const uint64_t slots = kiln_scene_sprite_slots(scene);
    const uint64_t most = by_fragment ? SORTED_AT_A_TIME : SPRITES_AT_A_TIME;
    const uint64_t sprites = slots < most ? slots : most;
    /* draw_sorted keeps what one tile may have, besides the sprites of a piece */
    const uint64_t kept = !by_fragment ? 0 : slots < SPRITES_OF_A_TILE ? slots : SPRITES_OF_A_TILE;
    const uint64_t listed = kept > sprites ? kept : sprites;
    bool mixed = false;
    enum kiln_simd simd;
    for (uint32_t i = 0; i < scene->system_count; i++)
        mixed |= scene->systems[i].capacity >= KILN_CELL_MIXED_LEAST;
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, sprites + kept,
                       sizeof(struct kiln_sprite) + sizeof(struct kiln_sprite_extra));
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PICTURE, footprint->threads,
                       sizeof(struct kiln_tile));
    if (by_fragment && kiln_simd_choose(&simd, NULL))
        kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, footprint->threads,
                           kiln_fragments_bytes(simd));
    if (kiln_ribbon_most_parts(scene) > 0) /* struct entry_list */
        kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, slots,
                           sizeof(uint32_t) + sizeof(uint8_t));
    kiln_bins_footprint(scene->width, scene->height, listed, footprint);
    kiln_cells_footprint(layers, mixed, footprint);
}

void kiln_raster_cpu_destroy(struct kiln_raster_cpu **tiles)
{
    struct kiln_raster_cpu *t = *tiles;
    if (!t)
        return;
    kiln_cells_destroy(&t->cells);
    kiln_bins_finish(&t->bins);
    for (uint32_t i = 0; t->fragments && i < kiln_threads_count(t->threads); i++)
        kiln_fragments_destroy(&t->fragments[i]);
    free((void *)t->fragments);
    free_sprites(&t->sprites);
    kiln_buffer_finish(&t->repeated);
    kiln_buffer_finish(&t->parts);
    free(t->tiles);
    free(t);
    *tiles = NULL;
}

/* ---- sprites --------------------------------------------------------------------------------- */

/* Holds draw entries, and of entries of ribbons which part of its segment each is. */
struct entry_list {
    const uint32_t *entries;
    const uint8_t *parts; /* NULL: there are no ribbons */
    uint32_t count;
};

static struct entry_list entries_from(struct entry_list list, uint32_t first)
{
    return (struct entry_list){list.entries + first, list.parts ? list.parts + first : NULL,
                               list.count - first};
}

struct sprite_job {
    kiln_sprites_make *make;
    const struct kiln_sprite_pass *pass;
    struct entry_list list;
    struct kiln_sprites sprites;
    const struct kiln_bins *bins;
};

static void make_sprites(void *context, size_t begin, size_t end, uint32_t worker)
{
    (void)worker;
    const struct sprite_job *job = context;
    const uint8_t *parts = job->list.parts;
    job->make(job->pass, job->list.entries + begin, parts ? parts + begin : NULL, end - begin,
              kiln_sprites_from(job->sprites, begin));
    kiln_bins_note(job->bins, job->sprites.sprites, begin, end);
}

static bool make_room(struct kiln_raster_cpu *tiles, uint32_t count, struct kiln_error *error)
{
    if (count <= tiles->sprite_room)
        return true;
    free_sprites(&tiles->sprites);
    tiles->sprite_room = alloc_sprites(&tiles->sprites, count) ? count : 0;
    return tiles->sprite_room >= count || out_of_memory(error);
}

/* ---- tiles ----------------------------------------------------------------------------------- */

struct tile_job {
    struct kiln_raster_cpu *tiles;
    struct kiln_tile_target target;
    const struct kiln_tile_gas *gas; /* NULL: there is none */
    size_t first_tile;               /* number of the first tile to draw */
};

/* Returns the depth before which no gas lies in a tile; 1e9 where there is none. */
static float nearest_gas(const struct kiln_tile *tile, const struct kiln_tile_gas *gas)
{
    const float x = (float)tile->x * gas->scale - gas->margin_x;
    const float y = (float)tile->y * gas->scale - gas->margin_y;
    const float right = x + (float)tile->width * gas->scale, zero = 0.0f;
    const float bottom = y + (float)tile->height * gas->scale;
    const uint32_t across = gas->profiles->across, down = gas->profiles->tiles / across;
    const uint32_t x_from = exact_uint(exact_max(x, zero)) / VOLUME_TILE;
    const uint32_t y_from = exact_uint(exact_max(y, zero)) / VOLUME_TILE;
    const uint32_t x_to = exact_uint(exact_max(right, zero)) / VOLUME_TILE + 1;
    const uint32_t y_to = exact_uint(exact_max(bottom, zero)) / VOLUME_TILE + 1;
    float near_m = 1e9f;
    for (uint32_t i = 0; i < gas->profiles->count; i++)
        for (uint32_t row = y_from; row < y_to && row < down; row++)
            for (uint32_t column = x_from; column < x_to && column < across; column++)
                near_m = exact_min(near_m,
                                   gas->profiles->domains[i].near_m[(size_t)row * across + column]);
    return near_m;
}

/* Lets a tile's sprites be blended with the gas that lies in it. gas: NULL: there is none. */
static void set_gas(struct kiln_tile *tile, const struct kiln_tile_gas *gas)
{
    tile->gas_near_m = gas ? nearest_gas(tile, gas) : 1e9f;
    tile->gas = tile->gas_near_m < 1e9f ? gas : NULL;
}

static void draw_tile(const struct tile_job *d, size_t number, uint32_t worker)
{
    const struct kiln_raster_cpu *tiles = d->tiles;
    const struct kiln_bins *bins = &tiles->bins;
    struct kiln_tile *tile = &tiles->tiles[worker];
    const uint32_t x = (uint32_t)(number % bins->columns) * KILN_TILE_WIDTH;
    const uint32_t y = (uint32_t)(number / bins->columns) * KILN_TILE_HEIGHT;
    const size_t count = bins->first[number + 1] - bins->first[number];
    if (count == 0) {
        kiln_tile_skip(&d->target, x, y);
        return;
    }
    const uint32_t *list = bins->list + bins->first[number];
    kiln_tile_begin(&d->target, tile, x, y);
    tile->nearest = bins->depth[number].nearest;
    set_gas(tile, d->gas);
    if (!d->target.by_fragment)
        tiles->draw(tile, tiles->sprites, tiles->cells, list, count);
    else
        kiln_fragments_draw(tiles->fragments[worker], tiles->draw, tile, tiles->sprites,
                            tiles->cells, list, count);
    kiln_tile_end(&d->target, tile);
}

static void draw_tiles(void *context, size_t begin, size_t end, uint32_t worker)
{
    const struct tile_job *d = context;
    for (size_t number = begin; number < end; number++)
        draw_tile(d, d->first_tile + number, worker);
}

/* ---- sorted pixels with more sprites than a piece -------------------------------------------- */

/* Holds the state of drawing a pass with by_fragment that has more sprites than a piece. Sorting a
 * pixel needs all sprites of its tile, so sprites are selected and drawn for some tiles at a time.
 */
struct sorted_pass {
    struct kiln_raster_cpu *tiles;
    const struct kiln_sprite_pass *pass;
    struct entry_list list;
    size_t *totals;               /* number of sprites of each tile */
    bool *is_selected;            /* by sprite of a piece: it touches the present tiles */
    struct kiln_sprites selected; /* the sprites of all pieces that touch the present tiles */
    uint32_t selected_count;
};

/* Makes the sprites and the bins of a piece, of fewer sprites where the bins would need much
 * memory. Returns the number of sprites, or 0 with an error. */
static uint32_t make_piece(const struct sorted_pass *s, uint32_t first, struct kiln_error *error)
{
    const uint32_t left = s->list.count - first;
    uint32_t count = left < SORTED_AT_A_TIME ? left : SORTED_AT_A_TIME;
    struct kiln_bins *bins = &s->tiles->bins;
    struct sprite_job job = {s->tiles->make, s->pass, entries_from(s->list, first),
                             s->tiles->sprites, bins};
    if (!kiln_bins_begin(bins, count, error))
        return 0;
    kiln_threads_for(s->tiles->threads, count, GRAIN, make_sprites, &job);
    return kiln_bins_fill_some(bins, 0, &count, s->tiles->threads, error) ? count : 0;
}

/* Counts the sprites of each tile, and mixes the cells that they want. Returns false with an error
 * if a tile has more than SPRITES_OF_A_TILE sprites. */
static bool count_tiles(const struct sorted_pass *s, size_t tile_count, struct kiln_error *error)
{
    const uint32_t *first = s->tiles->bins.first;
    for (uint32_t done = 0, count; done < s->list.count; done += count) {
        count = make_piece(s, done, error);
        if (count == 0)
            return false;
        for (size_t tile = 0; tile < tile_count; tile++)
            s->totals[tile] += first[tile + 1] - first[tile];
    }
    for (size_t tile = 0; tile < tile_count; tile++) {
        if (s->totals[tile] > SPRITES_OF_A_TILE)
            return kiln_error_set(
                error, KILN_DEVICE_FAILED,
                "post.compose: oit: %zu particles lie in one part of %d x %d pixels; at most %d "
                "are allowed: use post.compose=merged, or fewer particles",
                s->totals[tile], KILN_TILE_WIDTH, KILN_TILE_HEIGHT, SPRITES_OF_A_TILE);
    }
    return kiln_cells_mix(s->tiles->cells, s->tiles->threads, error);
}

/* Keeps sprite i of a piece. */
static void select_sprite(struct sorted_pass *s, uint32_t i)
{
    const struct kiln_sprites *from = &s->tiles->sprites;
    s->selected.sprites[s->selected_count] = from->sprites[i];
    if (kiln_sprite_has_extra(&from->sprites[i]))
        s->selected.extras[s->selected_count] = from->extras[i];
    s->selected_count++;
}

/* Makes all sprites again, piece by piece, and keeps those that touch some tiles, in order. */
static bool select_sprites(struct sorted_pass *s, size_t first_tile, size_t end_tile,
                           struct kiln_error *error)
{
    const struct kiln_bins *bins = &s->tiles->bins;
    s->selected_count = 0;
    for (uint32_t done = 0, count; done < s->list.count; done += count) {
        count = make_piece(s, done, error);
        if (count == 0)
            return false;
        memset(s->is_selected, 0, count * sizeof *s->is_selected);
        for (size_t i = bins->first[first_tile]; i < bins->first[end_tile]; i++)
            s->is_selected[bins->list[i]] = true;
        for (uint32_t i = 0; i < count; i++) {
            if (s->is_selected[i])
                select_sprite(s, i);
        }
    }
    return true;
}

static bool draw_some_tiles(struct sorted_pass *s, struct tile_job *job, size_t first_tile,
                            size_t end_tile, struct kiln_error *error)
{
    struct kiln_raster_cpu *tiles = s->tiles;
    if (!select_sprites(s, first_tile, end_tile, error))
        return false;
    const struct kiln_sprites piece = tiles->sprites;
    tiles->sprites = s->selected;
    bool ok = kiln_bins_begin(&tiles->bins, s->selected_count, error);
    if (ok)
        kiln_bins_note(&tiles->bins, s->selected.sprites, 0, s->selected_count);
    ok = ok && kiln_bins_fill_tiles(&tiles->bins, s->selected_count, first_tile, end_tile,
                                    tiles->threads, error);
    job->first_tile = first_tile;
    ok = ok && kiln_threads_try(tiles->threads, end_tile - first_tile, 1, draw_tiles, job, error);
    tiles->sprites = piece;
    return ok;
}

static bool draw_sorted(struct sorted_pass *s, struct tile_job *job, struct kiln_error *error)
{
    const size_t tile_count = (size_t)s->tiles->bins.columns * s->tiles->bins.rows;
    size_t most = SORTED_AT_A_TIME;
    s->totals = calloc(tile_count, sizeof *s->totals);
    s->is_selected = calloc(SORTED_AT_A_TIME, sizeof *s->is_selected);
    bool ok = s->totals && s->is_selected;
    if (!ok)
        out_of_memory(error);
    ok = ok && count_tiles(s, tile_count, error);
    for (size_t tile = 0; ok && tile < tile_count; tile++)
        most = s->totals[tile] > most ? s->totals[tile] : most;
    if (ok && !alloc_sprites(&s->selected, most))
        ok = out_of_memory(error);
    for (size_t first = 0, end; ok && first < tile_count; first = end) {
        size_t total = s->totals[first];
        for (end = first + 1; end < tile_count && total + s->totals[end] <= most; end++)
            total += s->totals[end];
        ok = draw_some_tiles(s, job, first, end, error);
    }
    free_sprites(&s->selected);
    free(s->is_selected);
    free(s->totals);
    return ok;
}

/* ---- a pass ---------------------------------------------------------------------------------- */

static bool draw_piece(struct kiln_raster_cpu *tiles, const struct kiln_sprite_pass *pass,
                       struct entry_list list, struct tile_job *tile_job, struct kiln_error *error)
{
    const uint32_t count = list.count;
    struct sprite_job job = {tiles->make, pass, list, tiles->sprites, &tiles->bins};
    if (!kiln_bins_begin(&tiles->bins, count, error))
        return false;
    kiln_threads_for(tiles->threads, count, GRAIN, make_sprites, &job);
    if (!kiln_cells_mix(tiles->cells, tiles->threads, error))
        return false;
    const size_t tile_count = (size_t)tiles->bins.columns * tiles->bins.rows;
    uint32_t begin = 0, most = count;
    do { /* at least once, to clear the picture if there are no particles */
        uint32_t end = count - begin < most ? count : begin + most;
        if (!kiln_bins_fill_some(&tiles->bins, begin, &end, tiles->threads, error))
            return false;
        if (tile_job->target.by_fragment && end < count) /* pixels need all their sprites at once */
            return draw_sorted(&(struct sorted_pass){.tiles = tiles, .pass = pass, .list = list},
                               tile_job, error);
        if (!kiln_threads_try(tiles->threads, tile_count, 1, draw_tiles, tile_job, error))
            return false;
        most = end - begin;
        begin = end;
        tile_job->target.first = false;
    } while (begin < count);
    return true;
}

/* Writes a system's bloom weights and returns true if they are the same for all particles. */
static bool steady_bloom(const struct kiln_moment *moment, uint32_t system, float weights[3])
{
    const float4 *table = moment->look_table;
    const struct kiln_look_program *program = &moment->look_programs[system];
    for (uint32_t i = 0; i < program->count; i++) {
        if (program->values[i].target == KILN_LOOK_BLOOM)
            return false;
    }
    const float4 *row =
        table + ((size_t)system * KILN_LOOK_ROWS + KILN_LOOK_BLOOM) * KILN_LOOK_SAMPLES;
    for (int i = 1; i < KILN_LOOK_SAMPLES; i++) {
        if (row[i].x != row[0].x || row[i].y != row[0].y || row[i].z != row[0].z)
            return false;
    }
    weights[0] = row[0].x;
    weights[1] = row[0].y;
    weights[2] = row[0].z;
    return true;
}

static bool glows(const float weights[3])
{
    return weights[0] != 0.0f || weights[1] != 0.0f || weights[2] != 0.0f;
}

/* Chooses how tiles draw the glow of a pass: not at all if there is none, and with less work where
 * all glowing particles have the same bloom weights, as in most scenes. Writes these weights. */
static enum kiln_tile_glow choose_glow(const struct kiln_particles_draw *draw, float all[3])
{
    if (draw->framebuffer->count < 2)
        return KILN_TILE_GLOW_NONE;
    if (draw->keep_bloom || draw->by_fragment || draw->gas)
        return KILN_TILE_GLOW_WEIGHED;
    enum kiln_tile_glow glow = KILN_TILE_GLOW_NONE;
    const struct kiln_moment *moment = draw->moment;
    for (uint32_t i = 0; i < moment->scene->system_count; i++) {
        float weights[3];
        const bool steady = steady_bloom(moment, i, weights);
        if (steady && !glows(weights))
            continue;
        if (!steady || (glow == KILN_TILE_GLOW_APART && memcmp(all, weights, sizeof weights) != 0))
            return KILN_TILE_GLOW_WEIGHED;
        glow = KILN_TILE_GLOW_APART;
        memcpy(all, weights, sizeof weights);
    }
    return glow;
}

bool kiln_raster_cpu_splits(const struct kiln_particles_draw *draw, uint64_t systems)
{
    const struct kiln_moment *moment = draw->moment;
    float weights[3];
    if (choose_glow(draw, weights) != KILN_TILE_GLOW_APART || draw->sum_alpha ||
        draw->fire_covers || draw->gas)
        return false;
    for (uint32_t i = 0; i < moment->scene->system_count; i++) {
        const bool drawn = systems >> i & 1, adds = moment->looks[i].flags.x != 0;
        if (drawn && (!steady_bloom(moment, i, weights) || glows(weights) != adds))
            return false;
    }
    return true;
}

/* Returns how many sprites an entry has. */
static uint32_t parts_of(const struct kiln_draw_look *looks, uint32_t entry)
{
    const struct kiln_draw_look *look = &looks[KILN_ENTRY_SYSTEM(entry)];
    return look->form.x == LOOK_RIBBON ? LOOK_RIBBON_PARTS(look->ribbon.x) : 1;
}

/* Makes the pixels that a pass reads and writes available on the host. */
static bool open_images(const struct kiln_particles_draw *draw, struct kiln_tile_target *d,
                        struct kiln_error *error)
{
    struct kiln_image *color = draw->framebuffer->images[0];
    bool blooms = draw->framebuffer->count > 1;
    d->width = color->width;
    d->height = color->height;
    d->depth = kiln_image_host(draw->depth, KILN_READ, error);
    d->color = d->depth ? kiln_image_host(color, KILN_OVERWRITE, error) : NULL;
    if (d->color && blooms)
        d->bloom = kiln_image_host(draw->framebuffer->images[1],
                                   draw->keep_bloom ? KILN_READ_WRITE : KILN_OVERWRITE, error);
    if (d->color && draw->covering)
        d->covering = kiln_image_host(draw->covering, KILN_OVERWRITE, error);
    if (d->color && draw->added)
        d->added = kiln_image_host(draw->added, KILN_OVERWRITE, error);
    return d->color && (d->bloom || !blooms) && (d->covering || !draw->covering) &&
           (d->added || !draw->added);
}

/* Lists the entries of a pass. Each entry of a ribbon is repeated for each part of its segment. */
static bool open_entries(struct kiln_raster_cpu *tiles, const struct kiln_particles_draw *draw,
                         struct entry_list *list, struct kiln_error *error)
{
    const uint32_t *entries = kiln_buffer_host(draw->entries, KILN_READ, error);
    const struct kiln_draw_look *looks = draw->moment->looks;
    *list = (struct entry_list){entries, NULL, draw->count};
    if (!entries || kiln_ribbon_most_parts(tiles->scene) == 0)
        return entries;
    uint64_t total = 0;
    for (uint32_t i = 0; i < draw->count; i++)
        total += parts_of(looks, entries[i]);
    if (total > UINT32_MAX)
        return out_of_memory(error);
    kiln_buffer_reserve(&tiles->repeated, total * sizeof *entries);
    kiln_buffer_reserve(&tiles->parts, total);
    uint32_t *repeated = kiln_buffer_host(&tiles->repeated, KILN_OVERWRITE, error);
    uint8_t *parts = repeated ? kiln_buffer_host(&tiles->parts, KILN_OVERWRITE, error) : NULL;
    if (!parts)
        return false;
    uint32_t count = 0;
    for (uint32_t i = 0; i < draw->count; i++) {
        const uint32_t of_entry = parts_of(looks, entries[i]);
        for (uint32_t part = 0; part < of_entry; part++) {
            repeated[count] = entries[i];
            parts[count++] = (uint8_t)part;
        }
    }
    *list = (struct entry_list){repeated, parts, count};
    return true;
}

bool kiln_raster_cpu_run(struct kiln_raster_cpu *tiles, const struct kiln_particles_draw *draw,
                         struct kiln_error *error)
{
    const uint32_t most = draw->by_fragment ? SORTED_AT_A_TIME : SPRITES_AT_A_TIME;
    struct tile_job job = {.tiles = tiles,
                           .gas = draw->gas,
                           .target = {.first = true,
                                      .keep_bloom = draw->keep_bloom,
                                      .sum = draw->sum_alpha,
                                      .by_fragment = draw->by_fragment}};
    struct kiln_tile_target *target = &job.target;
    struct entry_list list;
    if (!open_entries(tiles, draw, &list, error) || !open_images(draw, target, error) ||
        !make_room(tiles, list.count < most ? list.count : most, error))
        return false;
    target->glow = choose_glow(draw, target->weights);
    struct kiln_sprite_pass pass = {
        .scene = tiles->scene,
        .looks = draw->moment->looks,
        .table = draw->moment->look_table,
        .programs = draw->moment->look_programs,
        .records = draw->moment->records,
        .view = draw->view,
        .backdrop = draw->backdrop,
        .lighting = draw->lighting,
        .cells = tiles->cells,
        .content = kiln_cells_content(tiles->cells),
        .fire_covers = draw->sum_alpha || draw->fire_covers,
    };
    kiln_bins_measure(&tiles->bins, target->depth, target->width, target->height, tiles->threads);
    if (draw->by_fragment && list.count > most) {
        struct sorted_pass sorted = {.tiles = tiles, .pass = &pass, .list = list};
        return draw_sorted(&sorted, &job, error);
    }
    uint32_t done = 0;
    do { /* at least once, to clear the picture if there are no particles */
        struct entry_list piece = entries_from(list, done);
        piece.count = piece.count < most ? piece.count : most;
        if (!draw_piece(tiles, &pass, piece, &job, error))
            return false;
        done += piece.count;
    } while (done < list.count);
    return true;
}
