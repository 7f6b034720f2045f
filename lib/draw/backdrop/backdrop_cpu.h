/* This header declares technique backdrop=cpu: rays on threads, many at a time. */
#ifndef KILN_DRAW_BACKDROP_BACKDROP_CPU_H
#define KILN_DRAW_BACKDROP_BACKDROP_CPU_H

#include "draw/backdrop/backdrop_inputs.h"

struct kiln_backdrop_cpu;
struct kiln_ray_frame;

/* Scene and meshes must outlive it. NULL with an error. */
struct kiln_backdrop_cpu *kiln_backdrop_cpu_create(const struct kiln_scene *scene,
                                                   const struct kiln_meshes *meshes,
                                                   const struct kiln_backdrop_params *params,
                                                   struct kiln_error *error);
void kiln_backdrop_cpu_destroy(struct kiln_backdrop_cpu **cpu);

void kiln_backdrop_cpu_pictures(const struct kiln_backdrop_cpu *cpu,
                                struct kiln_picture_size *floor, struct kiln_picture_size *sky);

/* Draws, unless the picture of the last call still holds (kept). Inputs and lighting must live
 * until the next call, or until the rays are no longer read. */
bool kiln_backdrop_cpu_draw(struct kiln_backdrop_cpu *cpu,
                            const struct kiln_backdrop_inputs *inputs,
                            const struct kiln_lighting *lighting, bool kept,
                            struct kiln_error *error);

/* As of the last kiln_backdrop_cpu_draw. */
const struct kiln_ray_frame *kiln_backdrop_cpu_rays(const struct kiln_backdrop_cpu *cpu);

#endif
