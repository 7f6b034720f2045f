/* Declares how the passes of a substep run, by a table for each technique. The solver has what all
 * techniques share: the window, the active bricks, the order of the passes. */
#ifndef KILN_SIM_GAS_PASSES_H
#define KILN_SIM_GAS_PASSES_H

#include "sim/gas/pass.h"

struct gas_solver;
struct gas_hooks;

/* The passes of a step, in their order. */
enum gas_timer {
    GAS_TIMER_TRACE,   /* moves what cells have along the velocity */
    GAS_TIMER_REACT,   /* corrects it, lets it burn and pushes it: fills `found` of the solver */
    GAS_TIMER_SOURCES, /* adds sources: fills `sourced`, and `left` of what was found */
    GAS_TIMER_WALLS,   /* moves solids to the end of the substep */
    GAS_TIMER_PUSH,    /* gives the changes of velocities to faces */
    GAS_TIMER_DIVERGE,
    GAS_TIMER_PRESSURE,
    GAS_TIMER_PROJECT, /* takes the pressure's gradient off faces: fills `fastest` of the gas */
    GAS_TIMERS,
};

/* Why a step failed. */
enum gas_failure {
    GAS_STEPPED,
    GAS_NO_MEMORY,
    GAS_STOPPED, /* the error says why: the caller wants no more, or the device failed */
    GAS_WRONG,   /* a number is not finite: gas_solver_find_wrong */
};

/* Holds what the passes of a substep are about. */
struct gas_job {
    struct gas_solver *solver;
    struct gas_pass *pass;
    const struct gas_hooks *hooks;
    uint32_t cycles; /* of the multigrid */
    double residual; /* that may be left; 0: as it comes */
    struct kiln_error *error;
};

struct gas_passes {
    /* Prepares for the solver's gas. False: memory is short. */
    bool (*init)(struct gas_solver *solver);
    void (*finish)(struct gas_solver *solver);
    /* Makes what is for a window, and frees it. False: memory is short. */
    bool (*init_window)(struct gas_solver *solver);
    void (*free_window)(struct gas_solver *solver);
    /* Sets a group of what cells carry beside to 0, where it is not on the host. NULL: it is. */
    void (*clear_group)(struct gas_solver *solver, uint32_t group);
    enum gas_failure (*pass[GAS_TIMERS])(struct gas_job *job);
};

/* Finds the pressure. All of them return false with an error. */
struct gas_pressure {
    bool (*center)(struct gas_job *job); /* gas_level_center */
    bool (*cycle)(struct gas_job *job);  /* job->cycles */
    /* Fills in the length of the right side, or of the residual. */
    bool (*length)(struct gas_job *job, bool residual, double *length);
};

/* Runs V-cycles until the residual is as small as it should be. */
bool gas_solver_find_pressure(struct gas_job *job, const struct gas_pressure *pressure);

extern const struct gas_passes gas_passes_cpu, gas_passes_gl;

#endif
