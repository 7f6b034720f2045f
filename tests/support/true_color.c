/* Computes the colours of a sprite behind haze in double precision, as shared/haze.h and
 * particle.glsl do, for the reference rasteriser of true_billboards.h. */
#include <string.h>

#include "support/true_sprite.h"

/* Returns the colour of the haze in the direction of a place, given from the eye, of a sky that is
 * no picture. */
static void true_haze(const struct kiln_draw_backdrop *backdrop, dvec way, double haze[3])
{
    const float *horizon = &backdrop->sky_horizon.x, *sun = &backdrop->sun_color.x;
    const dvec level = dvec_unit((dvec){way.x, 0, way.z});
    const dvec away = dvec_add(level, dvec_of(backdrop->sun_direction), -1);
    const double width = (double)backdrop->floor_params.w;
    const double near = 1 / (1 + dvec_dot(away, away) / (width * width));
    for (int c = 0; c < 3; c++)
        haze[c] = (double)horizon[c] +
                  (double)sun[c] * (double)backdrop->sky_horizon.w * near * sqrt(near);
}

void true_color(const struct true_scene *t, struct true_sprite *s,
                double const row[KILN_LOOK_ROWS][4], dvec position)
{
    const size_t bytes = sizeof s->hot;
    const struct kiln_draw_backdrop *backdrop = t->backdrop;
    memcpy(s->hot, row[KILN_LOOK_HOT], bytes);
    memcpy(s->cool, row[KILN_LOOK_COOL], bytes);
    memcpy(s->color, row[KILN_LOOK_COVER], bytes);
    memcpy(s->bloom, row[KILN_LOOK_BLOOM], bytes);
    if (backdrop->counts.z != 0)
        return;
    const dvec way = dvec_add(position, dvec_of(t->view->eye), -1);
    const double clear = exp(-(double)backdrop->floor_params.z * sqrt(dvec_dot(way, way)));
    double haze[3];
    true_haze(backdrop, way, haze);
    for (int c = 0; c < 3; c++) {
        s->hot[c] *= clear;
        s->cool[c] *= clear;
        s->color[c] *= clear;
        s->veil[c] = s->additive && !t->fire_covers ? 0 : haze[c] * (1 - clear);
    }
}
