/* One particle for true_billboards.h: shaders/draw/sprites/particle.glsl, outline.glsl
 * and shade.glsl in double precision. Only what the definition rounds is in floats: age, random
 * numbers, the choice of a cell.
 */
#ifndef KILN_TESTS_TRUE_SPRITE_H
#define KILN_TESTS_TRUE_SPRITE_H

#include "draw/light/lighting.h"
#include "shared/look_layout.h"
#include "support/true_vector.h"

/* What all of a pass have in common. */
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
    uint32_t layers[2], level;
    double part, motion;
    /* Plain ones lie in the picture, px: middle, unit way, half edges, 1/m at both ends. */
    double middle[2], way[2], extent[2], near[2];
    int box[4]; /* pixels: x and y from, x and y to */
};

/* A place of a sprite. Of plain ones, u and v are pixels from the middle. */
struct true_place {
    double u, v, depth;
};

/* false: nothing of it can be seen. */
bool true_sprite_make(const struct true_scene *t, uint32_t entry,
                      const struct kiln_particle *record, struct true_sprite *s);

/* Where the ray through a place of the picture meets it; false: nowhere. */
bool true_place_of(const struct true_scene *t, const struct true_sprite *s, double x, double y,
                   struct true_place *at);

/* Premultiplied; alpha as of one that covers. */
void true_shade(const struct true_scene *t, const struct true_sprite *s,
                const struct true_place *at, double scene, double rgba[4]);

#endif
