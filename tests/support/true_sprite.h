/* Makes and shades the sprite of one particle, for the reference rasteriser of true_billboards.h.
 * It does what particle.glsl, outline.glsl and shade.glsl in shaders/draw/sprites do, in double
 * precision. Age, random numbers and the choice of an atlas cell are floats, since their rounding
 * is part of what is drawn. */
#ifndef KILN_TESTS_TRUE_SPRITE_H
#define KILN_TESTS_TRUE_SPRITE_H

#include "draw/light/lighting.h"
#include "shared/look_layout.h"
#include "support/true_vector.h"

/* The input that all particles of a pass have in common. */
struct true_scene {
    const struct kiln_scene *scene;
    const struct kiln_atlas *atlas;
    const struct kiln_view *view;
    const struct kiln_draw_backdrop *backdrop;
    const struct kiln_lighting *lighting;
    struct kiln_draw_look looks[KILN_MAX_SYSTEMS];
    float4 *table; /* values of the looks over life (shared/look_layout.h) */
};

struct true_sprite {
    /* plain: a point or a line, otherwise a billboard; disc: a round point; masks: the texture has
     * cells of KILN_CELL_MASK; literal: the soft fade is equation 3.3 as printed
     * (look.soft_formula). */
    bool plain, disc, masks, additive, literal;
    dvec center, right, up;         /* centre; half edges of a billboard; view space, m */
    double soft, distance, opacity; /* soft fade, 1/m; from the eye, m; factor */
    /* hot, cool: light emitted where a cell's heat is 1 and 0; color: what covers; light: from all
     * sides, and along right, up and towards the viewer; bloom: weights; bulge: half the thickness,
     * m */
    double hot[3], cool[3], color[3], light[4][3], bloom[3], bulge;
    /* Of a billboard, along right and up. narrowed: its width over the drawn width, which is below
     * 1 if it is thinner than a pixel; rim: the drawn width, px, or 0 for hard edges. */
    double narrowed[2], rim[2];
    uint32_t layers[2], level; /* two adjacent cells of the atlas; level of detail */
    int columns, rows;         /* texels of a cell at that level */
    double part, motion;       /* of the second cell in the mix; factor on the motion vectors */
    /* A plain sprite is a rectangle of the picture. middle: px; way: its unit direction; extent:
     * half its length and half its width, px; near: 1 / depth at its tail and its head, 1/m. */
    double middle[2], way[2], extent[2], near[2];
    int box[4]; /* pixels that the sprite may touch: least x and y, and the ends of x and y */
};

/* A place of a sprite: its texture coordinates u and v, 0 to 1, and its view depth, m. On a plain
 * sprite, u and v count pixels from its middle, along and across its direction. */
struct true_place {
    double u, v, depth;
};

/* Makes the sprite of a particle. Returns false if it is transparent or nearer than the near plane.
 * entry: the particle's draw entry. */
bool true_sprite_make(const struct true_scene *t, uint32_t entry,
                      const struct kiln_particle *record, struct true_sprite *s);

/* Finds which place of a sprite the ray through a place of the picture (x, y), px, meets. Returns
 * false if it misses the sprite. */
bool true_place_of(const struct true_scene *t, const struct true_sprite *s, double x, double y,
                   struct true_place *at);

/* Computes the premultiplied colour of a sprite at a place, where the scene has the view depth
 * `scene`, m. For an additive sprite, too, the alpha is that of a sprite that covers. */
void true_shade(const struct true_scene *t, const struct true_sprite *s,
                const struct true_place *at, double scene, double rgba[4]);

#endif
