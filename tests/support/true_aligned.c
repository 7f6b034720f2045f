/* Computes in double precision how billboards lie in planes of the world, for the reference
 * rasteriser: their plane, and how these and other sprites fade at the scene. */
#include "support/true_sprite.h"

void true_plane_across(const struct true_scene *t, dvec normal, struct true_sprite *s, dvec axes[3])
{
    const bool level = fabs(normal.y) > sqrt(0.5);
    const dvec upward = level ? (dvec){0, 0, -1} : (dvec){0, 1, 0};
    const dvec up = dvec_unit(dvec_add(upward, normal, -dvec_dot(upward, normal)));
    axes[0] = dvec_turn(t->view, dvec_cross(up, normal));
    axes[1] = dvec_turn(t->view, up);
    axes[2] = dvec_turn(t->view, normal);
    s->away = fabs(dvec_dot(axes[2], s->center));
    s->slant = sqrt(s->away / sqrt(dvec_dot(s->center, s->center)));
    if (dvec_dot(axes[2], s->center) > 0)
        axes[2] = dvec_scale(axes[2], -1);
    s->lies = true;
}

/* Returns the fade of a billboard that lies in a plane of the world. */
static double true_lying_fade(const struct true_sprite *s, double depth, double scene)
{
    const double size = 2 * s->half_size;
    const double above = (depth - scene) / depth * s->away; /* m above the plane */
    const double reach = s->soft > 0 ? 1 / s->soft : 0.02 * size;
    const double of_height = 1 - above / reach, of_depth = 2 - (depth - scene) / s->half_size;
    return fmin(fmax(fmin(of_height, of_depth), 0), 1);
}

double true_soft(const struct true_sprite *s, double depth, double scene)
{
    if (s->lies && !s->literal)
        return true_lying_fade(s, depth, scene);
    if (s->soft <= 0)
        return depth <= scene;
    if (s->literal)
        return depth <= scene ? fabs(scene - s->distance) * s->soft : 0;
    return fmin(fmax((scene - depth) * s->soft, 0), 1);
}
