/* Declares how solid particles (opaque spheres and meshes) are drawn for backdrop=cpu: in threads,
 * by casting rays. Only draw/solids/solids.c calls it; solids.h explains the parameters. */
#ifndef KILN_DRAW_SOLIDS_SOLIDS_CPU_H
#define KILN_DRAW_SOLIDS_SOLIDS_CPU_H

#include "base/footprint.h"
#include "draw/solids/solids.h"

struct kiln_solids_cpu;

struct kiln_solids_cpu *kiln_solids_cpu_create(const struct kiln_moment *moment,
                                               const struct kiln_solids_params *params,
                                               struct kiln_error *error);

/* Adds the memory of drawing the solids of a scene. */
void kiln_solids_cpu_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);
void kiln_solids_cpu_destroy(struct kiln_solids_cpu **stage);

bool kiln_solids_cpu_draw(struct kiln_solids_cpu *stage, const struct kiln_moment *moment,
                          struct kiln_buffer *entries, uint32_t count, struct kiln_error *error);

#endif
