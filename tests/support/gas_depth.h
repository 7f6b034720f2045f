/* Draws sprites before, within and behind a ball of gas, as the stages do, and by a reference that
 * marches through the gas from each sprite of a pixel to the next one. */
#ifndef KILN_TESTS_GAS_DEPTH_H
#define KILN_TESTS_GAS_DEPTH_H

#include "support/gas_view.h"
#include "support/raster.h"

enum { GAS_DEPTH_SPRITES = 48 };

/* A picture, with alpha, and its glow. */
struct gas_depth_drawn {
    float color[GAS_VIEW_FLOATS], glow[GAS_VIEW_FLOATS];
};

struct gas_depth {
    struct gas_view gas;
    struct raster raster;
    struct kiln_volume_stage *stage, *in_gl; /* in_gl: NULL unless march_in_gl */
    struct kiln_threads *threads;
    float depths[GAS_DEPTH_SPRITES]; /* of the sprites, m */
    bool by_fragment, half;          /* as in the setting */
};

/* Says what is drawn. */
struct gas_depth_setting {
    struct kiln_device *device; /* NULL for `cpu` */
    enum kiln_raster_technique technique;
    bool march_in_gl; /* not for the reference */
    float extinction; /* 1/m */
    bool by_fragment; /* post.compose: oit */
    bool half;        /* large cells; not all pixels of the gas have a ray, but with march_in_gl */
};

void gas_depth_open(struct gas_depth *f, const struct gas_depth_setting *setting);
void gas_depth_close(struct gas_depth *f);

/* Draws gas and sprites as the stages do. behind: true: all gas lies behind all sprites. */
void gas_depth_draw(struct gas_depth *f, bool behind, struct gas_depth_drawn *to);

void gas_depth_draw_reference(struct gas_depth *f, struct gas_depth_drawn *sum);

/* Returns the greatest part of a pixel's light, or with alpha of the light from behind, by which a
 * picture is off. Light of less than a part `least` of the picture's brightest counts as that. */
double gas_depth_difference(const float found[GAS_VIEW_FLOATS],
                            const float expected[GAS_VIEW_FLOATS], bool alpha, double least);

/* Fails the test if the picture is not close to the reference. */
void gas_depth_check(struct gas_depth *f);

#endif
