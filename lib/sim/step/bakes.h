/* Writes the grids of baked winds: the sums of their forces, which particles read. */
#ifndef KILN_SIM_STEP_BAKES_H
#define KILN_SIM_STEP_BAKES_H

#include "base/simd.h"
#include "sim/step/blocks.h"

/* Describes a grid that kiln_bake_points writes on the host. */
struct kiln_bake_work {
    struct kiln_sim sim; /* its step has the forces */
    struct kiln_grid grid;
    struct kiln_still_frame node; /* that the grid lies in */
    float4 *words;                /* of all grids */
};

/* Writes samples begin to end - 1 of a grid, for kiln_threads_for; context points to a
 * kiln_bake_work. */
typedef void kiln_bake_points(void *context, size_t begin, size_t end, uint32_t worker);
KILN_SIMD_DECLARE(kiln_bake_points, kiln_bake_points);

struct kiln_bakes {
    const struct kiln_scene *scene;
    uint32_t system[KILN_MAX_BAKED];  /* number of the system of each, or of the gas */
    uint32_t written[KILN_MAX_BAKED]; /* step that its grid holds; 0: none */
    struct kiln_step_params params;   /* of the grid that is being written */
    kiln_bake_points *bake_points;    /* on the host */
    /* the following are for techniques in GL */
    struct kiln_device *device; /* NULL: the grids are written on the host */
    GLuint program;             /* 0: there are no baked winds */
    uint32_t group_size;
    struct kiln_buffer block; /* the parameters */
};

/* Prepares for a scene's baked winds. device NULL: for the host. The grids must be those of the
 * scene. kiln_bakes_finish frees everything, also after a failure. */
bool kiln_bakes_init(struct kiln_bakes *bakes, struct kiln_device *device,
                     const struct kiln_scene *scene, const struct kiln_sim_grids *grids,
                     struct kiln_error *error);
void kiln_bakes_finish(struct kiln_bakes *bakes);

/* Writes the grids that the particles of a step read and that hold another time. What they hold
 * follows from the number of the step, whichever steps were run before. params: of the step; in GL,
 * uploaded. */
bool kiln_bakes_step(struct kiln_bakes *bakes, const struct kiln_sim_params *params,
                     struct kiln_threads *threads, uint32_t step, struct kiln_error *error);

/* Writes the grids that the gas of a step reads, likewise, but on the host with every technique. It
 * comes before the gas, and before kiln_bakes_step. */
bool kiln_bakes_step_gas(struct kiln_bakes *bakes, const struct kiln_sim_params *params,
                         struct kiln_threads *threads, uint32_t step, struct kiln_error *error);

/* Writes the sums of the forces of a domain of gas at the points of a grid in the domain's frame,
 * on the host. params: of the step; around: has the grids that forces look up. */
void kiln_bakes_of_gas(struct kiln_bakes *bakes, const struct kiln_sim_params *params,
                       const struct kiln_sim *around, struct kiln_threads *threads, uint32_t domain,
                       const struct kiln_grid *grid, uint32_t step, float4 *words);

#endif
