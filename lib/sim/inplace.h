/* Technique `inplace`: the step in one compute dispatch a system, the records in one GL buffer. */
#ifndef KILN_SIM_INPLACE_H
#define KILN_SIM_INPLACE_H

#include "sim/params.h"

struct kiln_inplace {
    struct kiln_device *device;
    GLuint step_program, hash_program;
    GLuint family_program;        /* 0 while no system needs it */
    size_t step_stride;           /* bytes from one system's parameters to the next's */
    struct kiln_buffer keys;      /* float4 [KILN_MAX_VALUE_KEYS] */
    struct kiln_buffer steps;     /* struct kiln_step_params, step_stride apart */
    struct kiln_buffer colliders; /* struct kiln_colliders */
    struct kiln_buffer sums;      /* two lanes and the living */
};

/* False with KILN_USAGE without a device, or one that failed the exactness probe. After a failure,
 * too, kiln_inplace_finish frees what there is. */
bool kiln_inplace_init(struct kiln_inplace *inplace, struct kiln_device *device,
                       const struct kiln_scene *scene, const struct kiln_sim_params *params,
                       struct kiln_error *error);
void kiln_inplace_finish(struct kiln_inplace *inplace);

/* traces: struct kiln_trace [params->trace_count], scratch. */
bool kiln_inplace_step(struct kiln_inplace *inplace, const struct kiln_sim_params *params,
                       struct kiln_pool *pool, struct kiln_buffer *traces,
                       struct kiln_error *error);
bool kiln_inplace_hash(struct kiln_inplace *inplace, struct kiln_pool *pool,
                       struct kiln_state_hash *hash, uint64_t *alive, struct kiln_error *error);

#endif
