/* A `sprite_lanes` holds a vector of particles of which sprite_simd.c makes sprites. Each lane is a
 * particle. All lanes are of one system, so that branches on the system's look are the same for all
 * lanes. */
#ifndef KILN_DRAW_SPRITES_SPRITE_LANES_H
#define KILN_DRAW_SPRITES_SPRITE_LANES_H

#include <assert.h>

#include "base/real.h"
#include "draw/sprites/look_lanes.h"
#include "draw/sprites/sprite.h"
#include "draw/vector/particle_math.h"
#include "shared/billboard.h"

enum {
    SPRITE_WORDS = sizeof(struct kiln_sprite) / sizeof(float),
    EXTRA_WORDS = sizeof(struct kiln_sprite_extra) / sizeof(float),
};

/* The index of the word of a sprite, or of its extra, in which a field lies. */
#define WORD_OF(field)       (offsetof(struct kiln_sprite, field) / sizeof(float))
#define EXTRA_WORD_OF(field) (offsetof(struct kiln_sprite_extra, field) / sizeof(float))

struct sprite_lanes {
    const struct kiln_sprite_pass *pass;
    const struct kiln_draw_look *look;
    const float *rows;                       /* the system's rows of the look table */
    const struct kiln_look_program *program; /* what multiplies them */
    struct clock_lanes clocks;               /* set if the program has any values */
    vi mixes_cells;    /* mask: the system has at least KILN_CELL_MIXED_LEAST slots */
    vi samples_floats; /* mask: the system has at most KILN_CELL_FINE_MOST slots */
    vi visible;        /* mask: the lane's particle may be visible */
    vi slots;
    struct vf_particles record;
    vu stream; /* random stream of each particle */
    vf progress, age_s;
    struct lane_offsets samples; /* of their looks: where in a row, in floats */
    vf sample_part[4];           /* of the way to the next sample, as columns_load_lerp takes it */
    struct vf3 center;           /* view space */
    vf depth;
    struct columns shape, spread, turn, hot, cool, cover;
    vf scale; /* random */
    vf half_size;
    vf half_length; /* of the billboard along plane.up */
    struct billboard_plane plane;
    vi lies;                /* mask: the billboard lies in a plane of the world */
    struct columns texture; /* bits of a texture of struct kiln_draw_look */
    vi level;
    struct columns hull_from, hull_to;   /* hulls of the cells */
    vi shade, flags;                     /* as in struct kiln_sprite */
    _Alignas(64) vf words[SPRITE_WORDS]; /* the sprites, word by word */
    _Alignas(64) vf extra[EXTRA_WORDS];  /* the sprites' extras */
    bool has_extras;                     /* some of the sprites that were made last have an extra */
};

/* Returns a row of the look of the particles. */
SIMD struct columns look_row(const struct sprite_lanes *p, uint32_t row)
{
    struct columns look = columns_load_lerp(p->rows + (size_t)row * KILN_LOOK_SAMPLES * 4,
                                            &p->samples, p->sample_part);
    if (p->program->count > 0)
        multiply_lanes(p->pass->table, p->program, row, &p->clocks, &look);
    return look;
}

/* Transforms a direction from the world to view space. */
SIMD struct vf3 to_view(const struct kiln_view *view, struct vf3 v)
{
    const float4 *rows = view->world_to_view;
    return (struct vf3){vf3_dot_all(v, rows[0]), vf3_dot_all(v, rows[1]), vf3_dot_all(v, rows[2])};
}

#endif
