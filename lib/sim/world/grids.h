/* Loads the grids that a scene's forces and colliders look up. All grids lie in one buffer; a table
 * says where each begins. The words of the meshes, images and paths that particles are born on lie
 * behind them (scene/source.h). In GL the buffer also has the keys of a scene that has too many for
 * a uniform block, since few storage blocks are guaranteed. */
#ifndef KILN_SIM_WORLD_GRIDS_H
#define KILN_SIM_WORLD_GRIDS_H

#include "base/footprint.h"
#include "base/thread.h"
#include "gpu/buffer.h"
#include "sim/world/mesh_row.h"
#include "sim/world/volumes.h"

struct kiln_sim_grids {
    /* number of grids: first those of wind files, then those of baked winds, then those of objects
     * that collide */
    uint32_t count;
    uint32_t wind_count; /* of files and of baked winds */
    uint32_t file_count;
    const char *files[KILN_MAX_WINDS]; /* wind file of each grid; the scene owns the texts */
    /* forces whose grids follow those of files: baked winds, and winds of gas */
    const struct kiln_force *baked[KILN_MAX_BAKED];
    uint32_t of_object[KILN_MAX_OBJECTS]; /* number of an object's grid, if it needs one */
    float top[KILN_MAX_GRIDS];            /* m: highest point of a terrain */
    float steepest[KILN_MAX_GRIDS];       /* of a terrain: the value for struct kiln_collider */
    struct kiln_grid table[KILN_MAX_GRIDS];
    /* words of all grids, as float4; in GL, the scene's keys lie before them if they are stored */
    struct kiln_buffer words;
    size_t key_words;
    uint32_t sources[KILN_MAX_SYSTEMS]; /* first word of what a system is born on */
    bool has_sources;
    /* of a system that is born on a mesh with an animation: its vertices at both ends of a step,
     * and the step */
    float (*poses[KILN_MAX_SYSTEMS])[6];
    uint32_t posed_step[KILN_MAX_SYSTEMS];
    struct kiln_volumes volumes;
};

/* Loads the wind files of the scene, each once, and makes its terrain, distance fields and depth
 * maps, on the threads. device NULL: for the host. Errors are those of loading and making them.
 * kiln_sim_grids_finish frees everything, also after a failure. */
bool kiln_sim_grids_init(struct kiln_sim_grids *grids, struct kiln_device *device,
                         const struct kiln_scene *scene, struct kiln_threads *threads,
                         struct kiln_error *error);

/* Adds the memory of the grids of a scene on the host. */
void kiln_sim_grids_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);
void kiln_sim_grids_finish(struct kiln_sim_grids *grids);

/* Returns whether an object needs a grid that does not change during a run. */
bool kiln_sim_grids_needs(const struct kiln_object *object);

/* Returns the kind of the grid of a mesh that needs one. */
const struct kiln_mesh_row *kiln_sim_mesh_row(const struct kiln_object *mesh);

/* Return the number of the grid of a wind file that the scene names, and of a baked wind. */
uint32_t kiln_sim_grids_find(const struct kiln_sim_grids *grids, const char *file);
uint32_t kiln_sim_grids_find_baked(const struct kiln_sim_grids *grids,
                                   const struct kiln_force *baked);

#endif
