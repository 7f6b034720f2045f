/* Makes and shades the sprite of one particle, which is the billboard, point or line that shows it,
 * for the reference rasteriser of true_billboards.h. The file does what particle.glsl, outline.glsl
 * and shade.glsl in shaders/draw/sprites do, in double precision. Age, random numbers and the
 * choice of an atlas cell are floats, since their rounding is part of what is drawn. */
#ifndef KILN_TESTS_TRUE_SPRITE_H
#define KILN_TESTS_TRUE_SPRITE_H

#include "draw/light/lighting.h"
#include "shared/look_layout.h"
#include "support/true_vector.h"

/* Holds the input that all particles of a pass have in common. */
struct true_scene {
    const struct kiln_scene *scene;
    const struct kiln_atlas *atlas;
    const struct kiln_view *view;
    const struct kiln_draw_backdrop *backdrop;
    const struct kiln_lighting *lighting;
    struct kiln_draw_look looks[KILN_MAX_SYSTEMS];
    bool fire_covers; /* additive particles cover, too, or their alpha is summed */
    float4 *table;    /* values of the looks (shared/look_layout.h, draw/moment/look_values.h) */
    const struct kiln_look_program *programs; /* of each system; NULL: values over life alone */
    const struct kiln_particle *records;      /* of all systems, for looks that are inherited */
};

struct true_sprite {
    /* plain: a point or a line instead of a billboard; disc: a round point; masks: the texture has
     * cells of KILN_CELL_MASK; additive: blended additively; literal: the soft-particle fade is
     * equation 3.3 of Heinz 2019 as printed (look.soft_formula). */
    bool plain, disc, masks, additive, literal;
    dvec center, right, up; /* its centre; a billboard's half edges; view space, m */
    /* soft: rate of the soft-particle fade, 1/m; distance: from the eye, m; opacity: 0 to 1. */
    double soft, distance, opacity;
    /* hot, cool: light emitted where a cell's heat is 1 and 0; color: reflected colour; light:
     * received from all sides, and the parts along right, up and towards the viewer; bloom: factors
     * on the light that goes to the bloom; bulge: half of the sprite's thickness, m; veil: the haze
     * before the sprite where it is opaque. */
    double hot[3], cool[3], color[3], light[4][3], bloom[3], bulge, veil[3];
    /* lies: a billboard in a plane of the world; away: that plane's distance from the eye, m;
     * slant: how much shorter it is seen, as the mean of both directions; half_size: half its edge,
     * m. */
    bool lies;
    double away, slant, half_size;
    /* Index 0 is for a billboard's width along right, index 1 along up. narrowed: the true width
     * divided by the drawn width, below 1 for a width of less than a pixel; rim: the drawn width,
     * px, if the edges are filtered, or 0 for hard edges. */
    double narrowed[2], rim[2];
    uint32_t layers[2], level; /* layers of the atlas with two adjacent cells; level of detail */
    int columns, rows;         /* texels of a cell at that level */
    double part, motion;       /* weight of the second cell, 0 to 1; factor on the motion vectors */
    /* A plain sprite is a rectangle of the picture. middle: its centre, px; way: the unit direction
     * of its length; extent: half its length and half its width, px; near: 1 / view depth at its
     * tail and at its head, 1/m. */
    double middle[2], way[2], extent[2], near[2];
    int box[4]; /* bounding box in the picture, px: least x and y, and the ends of x and y */
};

/* A point of a sprite: its texture coordinates u and v, 0 to 1, and its view depth, m. On a plain
 * sprite, u and v are px from its middle, along and across its direction. */
struct true_place {
    double u, v, depth;
};

/* Finds the axes (right, up and normal, view space) of a billboard that lies in a plane of the
 * world with the normal, and fills in what follows from that. The sprite's centre is set. */
void true_plane_across(const struct true_scene *t, dvec normal, struct true_sprite *s,
                       dvec axes[3]);

/* Returns the soft-particle fade: the factor on a sprite's opacity close to a surface of the scene
 * (Heinz 2019, equation 3.3). depth, scene: view depths of the sprite and of the scene, m. */
double true_soft(const struct true_sprite *s, double depth, double scene);

/* Makes the sprite of a particle. Returns false if it is transparent or nearer than the near plane.
 * entry: the particle's draw entry. */
bool true_sprite_make(const struct true_scene *t, uint32_t entry,
                      const struct kiln_particle *record, struct true_sprite *s);

/* Computes a row of the look (KILN_LOOK_*) of a particle. */
void true_look(const struct true_scene *t, uint32_t system, uint32_t row,
               const struct kiln_particle *record, double out[4]);

/* Fills in the colours of a sprite from the rows of its look (KILN_LOOK_*), behind the haze.
 * position: the particle's, in the world, m. */
void true_color(const struct true_scene *t, struct true_sprite *s,
                double const row[KILN_LOOK_ROWS][4], dvec position);

/* Finds the point of a sprite that the ray through the point (x, y) of the picture, px, meets.
 * Returns false if the ray misses the sprite. */
bool true_place_of(const struct true_scene *t, const struct true_sprite *s, double x, double y,
                   struct true_place *at);

/* Computes the premultiplied colour of a sprite at a point of it, where the scene has the view
 * depth `scene`, m. The alpha of an additive sprite is not set to 0: it is computed as for a sprite
 * that covers. */
void true_shade(const struct true_scene *t, const struct true_sprite *s,
                const struct true_place *at, double scene, double rgba[4]);

#endif
