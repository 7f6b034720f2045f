/* Gives the kernels of every GL technique their parameters: the uniform blocks of
 * shaders/sim/step/blocks.h. */
#ifndef KILN_SIM_STEP_BLOCKS_H
#define KILN_SIM_STEP_BLOCKS_H

#include "gpu/probe.h"
#include "gpu/program.h"
#include "sim/world/params.h"

struct kiln_sim_blocks {
    struct kiln_device *device;
    uint32_t group_size;             /* invocations of a work group that steps slots */
    size_t step_stride;              /* bytes from one system's parameters to the next's */
    struct kiln_buffer keys;         /* float4 [KILN_MAX_VALUE_KEYS] */
    struct kiln_buffer steps;        /* struct kiln_step_params, step_stride apart */
    struct kiln_buffer surroundings; /* struct kiln_surroundings */
};

/* After a failure, too, kiln_sim_blocks_finish frees what there is. */
bool kiln_sim_blocks_init(struct kiln_sim_blocks *blocks, struct kiln_device *device,
                          const struct kiln_scene *scene, struct kiln_error *error);
void kiln_sim_blocks_finish(struct kiln_sim_blocks *blocks);

/* Uploads a step's parameters and binds those of all systems, and the grids; with parents among
 * them, also their traces: struct kiln_trace [params->trace_count], scratch; with systems that
 * interact, also their pushes, which have been gathered; with some that spin, also the pool's
 * spins. */
bool kiln_sim_blocks_upload(struct kiln_sim_blocks *blocks, const struct kiln_sim_params *params,
                            struct kiln_buffer *traces, struct kiln_buffer *pushes,
                            struct kiln_buffer *spins, struct kiln_error *error);

/* Binds what belongs to one system, uploaded before. A child's traces are waited for. */
void kiln_sim_blocks_bind(const struct kiln_sim_blocks *blocks,
                          const struct kiln_sim_params *params, uint32_t system);

/* May particles be moved in this stage, not compute? KILN_NO_DEVICE when the device is not exact
 * there, or has too few storage blocks there for scenes with children or grids. */
bool kiln_sim_check_stage(struct kiln_device *device, const struct kiln_sim_params *params,
                          enum kiln_probe_stage stage, struct kiln_error *error);

#define KILN_SIM_SECOND "particles, second" /* label of a second buffer */

/* The GL side of a technique's second buffer, as large as the pool's, or 0 with an error. It starts
 * as zeros, and its contents stay while the pool does. */
GLuint kiln_sim_second(struct kiln_buffer *second, const struct kiln_pool *pool,
                       struct kiln_error *error);

/* The two variants of a kernel. */
struct kiln_sim_programs {
    GLuint alone, family; /* family: 0 while no system needs it */
};

/* files: of a kernel that knows the variants COLLIDE_ROUND, COLLIDE_TURNED, GRIDS, PUSHES,
 * SPINS (with it and COLLIDE_RUB), FORCES_ALL (with it), SWEEP_ALL, COLLIDE_FIELD (with GRIDS),
 * COLLIDE_VOLUME, COLLIDE_RUB and FAMILY; its defines are not looked at. After a failure, too,
 * kiln_sim_programs_finish frees what there is. */
bool kiln_sim_programs_init(struct kiln_sim_programs *programs, struct kiln_device *device,
                            const struct kiln_scene *scene, const struct kiln_sim_params *params,
                            struct kiln_program_params files, struct kiln_error *error);
void kiln_sim_programs_finish(struct kiln_sim_programs *programs);

/* How many births an emitter of technique `feedback` spawns in those made for a device. */
uint32_t kiln_sim_emitter_births(const struct kiln_device *device);

/* The program for a system. */
GLuint kiln_sim_programs_of(const struct kiln_sim_programs *programs,
                            const struct kiln_step_params *step);

#endif
