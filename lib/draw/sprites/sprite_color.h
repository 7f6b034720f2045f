/* This header finds the colours of a vector of sprites: what they emit, and what they reflect of
 * the light that falls on them, behind the haze before them. */
#ifndef KILN_DRAW_SPRITES_SPRITE_COLOR_H
#define KILN_DRAW_SPRITES_SPRITE_COLOR_H

#include "draw/sprites/sprite_haze.h"
#include "draw/sprites/sprite_light.h"

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

#endif
