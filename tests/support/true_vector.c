/* Transforms points and directions from the world to the camera in double precision, and
 * interpolates the table of particles' looks over life, for the reference rasteriser
 * (true_sprite.h). */
#include "support/true_vector.h"

#include "shared/look_layout.h"

double dvec_row(float4 row, dvec p)
{
    return dvec_dot(dvec_of(row), p) + (double)row.w;
}

dvec dvec_view(const struct kiln_view *view, dvec p)
{
    const float4 *rows = view->world_to_view;
    return (dvec){dvec_row(rows[0], p), dvec_row(rows[1], p), dvec_row(rows[2], p)};
}

dvec dvec_turn(const struct kiln_view *view, dvec v)
{
    const float4 *rows = view->world_to_view;
    return (dvec){dvec_dot(dvec_of(rows[0]), v), dvec_dot(dvec_of(rows[1]), v),
                  dvec_dot(dvec_of(rows[2]), v)};
}

void dvec_look(const float4 *table, uint32_t system, uint32_t row, float life, double out[4])
{
    double x = (double)(life * (float)(KILN_LOOK_SAMPLES - 1));
    int sample = x < KILN_LOOK_SAMPLES - 2 ? (int)x : KILN_LOOK_SAMPLES - 2;
    const float *from =
        &table[(system * KILN_LOOK_ROWS + row) * KILN_LOOK_SAMPLES + (uint32_t)sample].x;
    for (int i = 0; i < 4; i++)
        out[i] = (double)from[i] + ((double)from[4 + i] - (double)from[i]) * (x - sample);
}
