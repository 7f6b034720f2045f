/* This header declares technique backdrop=cpu, which casts vectors of rays on threads. */
#ifndef KILN_DRAW_BACKDROP_BACKDROP_CPU_H
#define KILN_DRAW_BACKDROP_BACKDROP_CPU_H

#include "draw/backdrop/backdrop_inputs.h"

struct kiln_backdrop_cpu;
struct kiln_ray_frame;

/* Creates the technique; NULL with an error. Scene and meshes must outlive it. */
struct kiln_backdrop_cpu *kiln_backdrop_cpu_create(const struct kiln_scene *scene,
                                                   const struct kiln_meshes *meshes,
                                                   const struct kiln_backdrop_params *params,
                                                   struct kiln_error *error);
void kiln_backdrop_cpu_destroy(struct kiln_backdrop_cpu **cpu);

/* Writes the sizes of the floor's and the sky's pictures. */
void kiln_backdrop_cpu_pictures(const struct kiln_backdrop_cpu *cpu,
                                struct kiln_picture_size *floor, struct kiln_picture_size *sky);

/* Draws the backdrop. is_current: the picture of the last call still holds and is not drawn again.
 * Inputs and lighting must live until the next call, or until the result of kiln_backdrop_cpu_rays
 * is no longer read. */
bool kiln_backdrop_cpu_draw(struct kiln_backdrop_cpu *cpu,
                            const struct kiln_backdrop_inputs *inputs,
                            const struct kiln_lighting *lighting, bool is_current,
                            struct kiln_error *error);

/* Returns the objects and lights that rays read, as of the last kiln_backdrop_cpu_draw. */
const struct kiln_ray_frame *kiln_backdrop_cpu_rays(const struct kiln_backdrop_cpu *cpu);

#endif
