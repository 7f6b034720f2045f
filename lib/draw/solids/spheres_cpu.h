/* Technique backdrop=cpu: spheres cast by rays, on threads. */
#ifndef KILN_DRAW_SPHERES_CPU_H
#define KILN_DRAW_SPHERES_CPU_H

#include "draw/solids/spheres.h"

struct kiln_spheres_cpu;

struct kiln_spheres_cpu *kiln_spheres_cpu_create(const struct kiln_scene *scene,
                                                 const struct kiln_spheres_params *params,
                                                 struct kiln_error *error);
void kiln_spheres_cpu_destroy(struct kiln_spheres_cpu **stage);

bool kiln_spheres_cpu_draw(struct kiln_spheres_cpu *stage, struct kiln_pool *pool,
                           struct kiln_buffer *entries, uint32_t count, float time_s,
                           struct kiln_error *error);

#endif
