/* This header sets up rays that march through gas side by side. */
#ifndef KILN_DRAW_VOLUME_VOLUME_PACKET_H
#define KILN_DRAW_VOLUME_VOLUME_PACKET_H

#include "base/eight.h"
#include "base/lane_math.h"
#include "draw/volume/volume_march.h"

/* Holds the pixels of the rays of a packet. */
struct pixels {
    _Alignas(32) float x[VOLUME_PACKET], y[VOLUME_PACKET]; /* px */
    _Alignas(32) float depth[VOLUME_PACKET];               /* of the scene, m; 0: there is no ray */
    uint32_t at[VOLUME_PACKET];                            /* the pixel's number in the picture */
    uint32_t count;
};

/* Adds a pixel to a packet that is not full. */
SIMD void add_pixel(const struct kiln_volume_march *m, struct pixels *to, uint32_t x, uint32_t y)
{
    const uint32_t i = to->count++, at = y * m->width + x;
    to->x[i] = (float)x;
    to->y[i] = (float)y;
    to->depth[i] = m->depth[at];
    to->at[i] = at;
}

/* Holds where rays are half opaque. */
struct halfway {
    struct eight depth; /* optical depth of this domain at which all gas is half opaque */
    struct eight place; /* from the eye, cells; 0: nowhere */
};

/* Holds eight rays. */
struct packet {
    struct eight way[3];     /* unit, in the window */
    struct eight inverse[3]; /* 1 / way */
    struct eight from, to;   /* where a ray enters the window and where it ends; to 0: nowhere */
    struct eight metre;      /* cells along a ray for a metre of depth */
    struct eight first,
        wide;           /* phase functions of the sun's light, scattered once and more often */
    struct eight clear; /* what gas leaves of the light behind it */
    struct eight depth; /* optical depth of the gas so far */
    struct eight smoke[3], flame[3];
    struct eight weight, far; /* of what is seen: its amount, and that times its distance, cells */
    struct halfway halfway;   /* set if the march asks for it */
    uint32_t samples;         /* of all rays so far */
};

/* Returns the phase function of Henyey and Greenstein in parts of an even one. */
SIMD vf henyey_greenstein(vf cosine, float g)
{
    const vf d = 1.0f + g * g - 2.0f * g * cosine;
    return (1.0f - g * g) / (d * vf_sqrt(d));
}

SIMD vf phase_of(vf cosine, float g)
{
    return 0.8f * henyey_greenstein(cosine, g) + 0.2f * henyey_greenstein(cosine, -0.3f * g);
}

/* Sets up the rays of pixels. Returns whether one of them meets the window. */
SIMD bool make_packet(const struct kiln_volume_march *m, const struct pixels *pixels,
                      struct packet *p)
{
    const float count[3] = {(float)m->field->cells.x, (float)m->field->cells.y,
                            (float)m->field->cells.z};
    const struct eight across = eight_load(pixels->x), from_top = eight_load(pixels->y);
    const struct eight depth = eight_load(pixels->depth);
    bool some = false;
    memset(p, 0, sizeof *p);
    EIGHT_EACH(k)
    {
        const vf aside = (across.part[k] + 0.5f - m->middle_x) * m->pixel_x;
        const vf down = (from_top.part[k] + 0.5f - m->middle_y) * m->pixel_y;
        vf way[3], square = vf_all(0.0f), cosine = vf_all(0.0f);
        for (int i = 0; i < 3; i++) {
            way[i] = m->right[i] * aside + (m->forward[i] - m->up[i] * down);
            square += way[i] * way[i];
        }
        const vf length = vf_sqrt(square); /* cells a metre of depth */
        vf from = length * m->near_m, to = length * depth.part[k];
        for (int i = 0; i < 3; i++) {
            vf along = way[i] / length;
            along = vf_select(vf_abs(along) < 1e-6f, vf_all(1e-6f), along);
            const vf inverse = 1.0f / along;
            const vf a = -m->eye[i] * inverse, b = (count[i] - m->eye[i]) * inverse;
            from = vf_max(from, vf_min(a, b));
            to = vf_min(to, vf_max(a, b));
            cosine += along * m->to_sun[i];
            p->way[i].part[k] = along;
            p->inverse[i].part[k] = inverse;
        }
        const vi meets = from < to;
        p->from.part[k] = from;
        p->to.part[k] = vf_where(meets, to);
        p->metre.part[k] = length;
        p->first.part[k] = phase_of(cosine, m->scattering);
        p->wide.part[k] = phase_of(cosine, 0.5f * m->scattering);
        p->clear.part[k] = vf_all(1.0f);
        some |= any(meets);
    }
    return some;
}

/* Returns the least of eight numbers. */
SIMD float least_of(struct eight x)
{
    float lanes[8];
    eight_store(lanes, x);
    float least = lanes[0];
    for (int i = 1; i < 8; i++)
        least = lanes[i] < least ? lanes[i] : least;
    return least;
}

/* Returns the number of the first step of a packet in a tile, and writes where its last one is. */
SIMD float first_step(const struct kiln_volume_march *m, const struct packet *p,
                      const struct kiln_volume_tile *tile, float *last)
{
    struct eight from, to;
    EIGHT_EACH(k)
    {
        const vi meets = p->from.part[k] < p->to.part[k];
        const vf near = vf_max(p->from.part[k], p->metre.part[k] * tile->near_m);
        from.part[k] = vf_select(meets, near, vf_all(1e9f));
        to.part[k] = -p->metre.part[k] * tile->far_m;
    }
    *last = -least_of(to);
    return floorf(least_of(from) * (1.0f / m->step));
}

#endif
