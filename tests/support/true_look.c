/* Rows of the look of a particle, for the reference of billboards (true_sprite.h): what the table
 * says over life, multiplied by values over other clocks. */
#include "shared/derived.h"
#include "support/true_sprite.h"
#include "support/true_vector.h"

void true_look(const struct true_scene *t, uint32_t system, uint32_t row,
               const struct kiln_particle *record, double out[4])
{
    const struct kiln_view *view = t->view;
    const struct kiln_derived_params derived = t->looks[system].derived;
    const float3 position = particle_position(*record);
    struct value_clocks clocks =
        value_clocks_at(view->clock.x, derived.random_key, derived.scene_key);
    clocks.age_s = particle_age(*record, view->clock_step.x, view->clock.y);
    clocks.life =
        particle_progress(clocks.age_s, particle_life_s(t->scene->keys, derived, *record));
    clocks.height = position.y;
    clocks.distance =
        float3_length(float3_sub(position, FLOAT3(view->eye.x, view->eye.y, view->eye.z)));
    clocks.velocity = particle_velocity(*record);
    clocks.stream = particle_stream(derived, *record);
    const uint4 values = t->looks[system].values;
    if (LOOK_PARENT_SLOTS(values.w) != 0)
        clocks = particle_clocks_of_child(
            t->scene->keys, clocks, t->looks[LOOK_PARENT_SYSTEM(values.w)].derived,
            t->records[LOOK_PARENT_RECORD(values, record->position_serial.w)], *record);
    dvec_look(t->table, system, row, clocks.life, out);
    if (!t->programs)
        return;
    /* unit.looks compares kiln_look_multiply with the values of the scene. */
    const float4 factor =
        kiln_look_multiply(t->table, &t->programs[system], row, &clocks, FLOAT4(1, 1, 1, 1));
    out[0] *= (double)factor.x;
    out[1] *= (double)factor.y;
    out[2] *= (double)factor.z;
    out[3] *= (double)factor.w;
}
