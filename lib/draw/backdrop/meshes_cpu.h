/* This header declares the host's view of meshes for technique backdrop=cpu: the triangles that its
 * rays hit, and the shadow maps. */
#ifndef KILN_DRAW_BACKDROP_MESHES_CPU_H
#define KILN_DRAW_BACKDROP_MESHES_CPU_H

#include "base/footprint.h"
#include "base/thread.h"
#include "draw/backdrop/mesh_view.h"
#include "draw/moment/meshes.h"

struct kiln_meshes_cpu;

/* Creates the view of a scene with meshes; NULL with an error. Scene, meshes and threads must
 * outlive it. */
struct kiln_meshes_cpu *kiln_meshes_cpu_create(const struct kiln_scene *scene,
                                               const struct kiln_meshes *meshes,
                                               struct kiln_threads *threads,
                                               struct kiln_error *error);

/* Adds the memory of drawing the meshes of a scene, and their shadow maps. */
void kiln_meshes_cpu_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);
void kiln_meshes_cpu_destroy(struct kiln_meshes_cpu **meshes);

/* Finds the triangles that the rays of the view hit, and draws the shadow maps of meshes that
 * moved. */
bool kiln_meshes_cpu_run(struct kiln_meshes_cpu *meshes, const struct kiln_view *view,
                         const struct kiln_draw_backdrop *backdrop,
                         const struct kiln_draw_shapes *shapes, struct kiln_error *error);

/* Returns the result of the last run. The pointer is the same after every run. */
const struct kiln_mesh_view *kiln_meshes_cpu_view(const struct kiln_meshes_cpu *meshes);

#endif
