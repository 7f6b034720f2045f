/* Loads scenes, and estimates the memory that they take: it asks each room that allocates much for
 * the frame loop. */
#include "asset/loader/loader.h"
#include "frame/stages.h"
#include "kiln.h"
#include "scene/gas_shape.h"
#include "scene/instant.h"
#include "scene/load.h"
#include "scene/pool_layout.h"
#include "scene/work.h"
#include "sim/step/simulate.h"
#include "sort/depth.h"

static void estimate(const struct kiln_scene *scene, struct kiln_footprint *footprint)
{
    const struct kiln_pool_layout layout = kiln_scene_pool_layout(scene);
    /* Pictures of sky, floor, motion and heights are decoded whole, one at a time. The scene has
     * decoded each of them once when it was read. */
    kiln_footprint_pass(footprint, KILN_FOOTPRINT_BACKDROP,
                        kiln_loader_largest_picture(scene->loader));
    kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS, 1,
                       kiln_mesh_library_bytes(scene->meshes));
    kiln_pool_footprint(&layout, footprint);
    for (uint32_t i = 0; i < scene->system_count; i++)
        kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, scene->systems[i].emit.way_count,
                           sizeof(uint64_t));
    if (kiln_scene_has_instants_between(scene)) { /* the particles before a step, and within it */
        kiln_between_footprint(scene, footprint);
        kiln_between_footprint(scene, footprint);
    }
    kiln_simulate_footprint(scene, footprint);
    kiln_scene_gas_footprint(scene, footprint);
    kiln_sort_depth_footprint(kiln_work_particles(scene), footprint);
    kiln_stages_footprint(scene, footprint);
}

struct kiln_scene *kiln_scene_load(const char *path, const struct kiln_scene_params *params,
                                   struct kiln_error *error)
{
    return kiln_scene_load_with(path, params, estimate, error);
}

struct kiln_scene *kiln_scene_parse(const char *text, size_t size, const char *name,
                                    const struct kiln_scene_params *params,
                                    struct kiln_error *error)
{
    return kiln_scene_parse_with(text, size, name, params, estimate, error);
}
