/* Declares the uniform blocks that give the kernels of every GL technique their parameters
 * (shaders/sim/step/blocks.h), and the creation of the kernels' programs. */
#ifndef KILN_SIM_STEP_BLOCKS_H
#define KILN_SIM_STEP_BLOCKS_H

#include "gpu/program.h"
#include "sim/world/params.h"

struct kiln_sim_blocks {
    struct kiln_device *device;
    uint32_t group_size; /* invocations of a work group that steps slots */
    size_t step_stride;  /* bytes from one system's parameters to the next's */
    /* float4: the scene's keys, room for KILN_BLOCK_KEYS; empty if they lie before the grids */
    struct kiln_buffer keys;
    struct kiln_buffer steps; /* struct kiln_step_params, step_stride apart */
    struct kiln_buffer
        surroundings; /* struct kiln_surroundings, or KILN_SURROUNDINGS_BLOCK of it */
};

/* Creates the blocks. kiln_sim_blocks_finish frees everything, also after a failure. */
bool kiln_sim_blocks_init(struct kiln_sim_blocks *blocks, struct kiln_device *device,
                          const struct kiln_scene *scene, struct kiln_error *error);
void kiln_sim_blocks_finish(struct kiln_sim_blocks *blocks);

/* Uploads a step's parameters, and binds those that all systems share, and the grids. If there are
 * parents, it also binds their traces: struct kiln_trace [params->trace_count], scratch memory. If
 * systems interact, it binds their pushes, which have been computed. If particles spin, it binds
 * the pool's spins. */
bool kiln_sim_blocks_upload(struct kiln_sim_blocks *blocks, const struct kiln_sim_params *params,
                            struct kiln_buffer *traces, struct kiln_buffer *pushes,
                            struct kiln_buffer *spins, struct kiln_error *error);

/* Binds the parameters of one system, which were uploaded before. For a system of children, it
 * waits for the traces of its parents. */
void kiln_sim_blocks_bind(const struct kiln_sim_blocks *blocks,
                          const struct kiln_sim_params *params, uint32_t system);

/* The two variants of a kernel: for systems without relations, and for families. */
struct kiln_sim_programs {
    GLuint alone, family; /* 0 if no system needs it */
};

/* Creates the programs of a kernel. `files` name a kernel that knows the variants GRIDS,
 * SURROUNDINGS_STORED, KEYS_STORED, PUSHES, SPINS (with PUSHES and COLLIDE_RUB), FORCES_ALL,
 * SWEEP_ALL (with FORCES_ALL), COLLIDE_FIELD (with GRIDS), COLLIDE_VOLUME, COLLIDE_RUB and FAMILY,
 * and the masks of shaders/shared/uses.h; it also gets the defines in `files`.
 * kiln_sim_programs_finish frees everything, also after a failure. */
bool kiln_sim_programs_init(struct kiln_sim_programs *programs, struct kiln_device *device,
                            const struct kiln_scene *scene, const struct kiln_sim_params *params,
                            struct kiln_program_params files, struct kiln_error *error);
void kiln_sim_programs_finish(struct kiln_sim_programs *programs);

/* Returns the program for a system. */
GLuint kiln_sim_programs_of(const struct kiln_sim_programs *programs,
                            const struct kiln_step_params *step);

#endif
