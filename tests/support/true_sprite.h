/* Makes and shades the sprite of one particle for true_billboards.h: does what particle.glsl,
 * outline.glsl and shade.glsl in shaders/draw/sprites do, in double precision. Only values that the
 * definition rounds are floats: age, random numbers, the choice of a cell. */
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
    float4 *table;
};

struct true_sprite {
    bool plain, disc, masks, additive, literal;
    dvec center, right, up; /* half edges, view space, m */
    double soft, distance, opacity;
    double hot[3], cool[3], color[3], light[4][3], bloom[3], bulge;
    /* Both are of a billboard, along right and up: the part by which its texture is drawn wider
     * than it is, and pixels of the picture over the texture's width; 0: its edges are hard. */
    double narrowed[2], rim[2];
    uint32_t layers[2], level;
    int columns, rows; /* of texels, at the level */
    double part, motion;
    /* A plain sprite is a rectangle of the picture: its middle, px; unit direction; half edges, px;
     * 1 / depth at both ends, 1/m. */
    double middle[2], way[2], extent[2], near[2];
    int box[4]; /* pixels that it may touch: least x and y, and the ends of x and y */
};

/* A place of a sprite: texture coordinates and depth, m. For a plain sprite, u and v are pixels
 * from its middle. */
struct true_place {
    double u, v, depth;
};

/* Makes the sprite of a particle. Returns false if no part of it can be seen. */
bool true_sprite_make(const struct true_scene *t, uint32_t entry,
                      const struct kiln_particle *record, struct true_sprite *s);

/* Finds the place of a sprite that the ray through (x, y), px, meets; false if there is none. */
bool true_place_of(const struct true_scene *t, const struct true_sprite *s, double x, double y,
                   struct true_place *at);

/* Computes the premultiplied colour of a sprite at a place, before a scene at depth `scene`, m. The
 * alpha is that of a sprite that covers, also if the sprite is additive. */
void true_shade(const struct true_scene *t, const struct true_sprite *s,
                const struct true_place *at, double scene, double rgba[4]);

#endif
