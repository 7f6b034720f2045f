/* Computes, before a step, the forces of the particles of a system on each other, called pushes
 * (shared/push.h). They are computed on the side where the records lie, host or GL, so that no
 * record is copied. All techniques give the same bits. */
#ifndef KILN_SIM_CROWD_INTERACT_H
#define KILN_SIM_CROWD_INTERACT_H

#include "base/footprint.h"
#include "base/thread.h"
#include "shared/interact_layout.h"
#include "sim/crowd/flock.h"
#include "sim/crowd/gravity.h"
#include "sim/world/params.h"

/* The kernels in the order in which they run. Those that sort bodies and find partners for
 * collisions are in sim/crowd/contact_row.h. */
enum kiln_interact_kernel {
    KILN_INTERACT_SPEEDS,
    KILN_INTERACT_SCAN,
    KILN_INTERACT_PLACE,
    KILN_INTERACT_ANSWER,
    KILN_INTERACT_PUSH,
    KILN_INTERACT_SOURCES,
    KILN_INTERACT_GRAVITY_TILES,
    KILN_INTERACT_COUNT_FLOCK,
    KILN_INTERACT_FLOCK_MEANS,
    KILN_INTERACT_FLOCK_STEER,
    KILN_INTERACT_KERNELS
};

/* The source of a kernel. */
struct kiln_interact_file {
    const char *file, *defines;
    bool counts_around; /* on software GL, MOST_AROUND is defined (interact_find.comp) */
};

/* The most kernels of a way to find partners. */
enum { KILN_CONTACT_PROGRAMS = 5 };

/* Describes the interactions of a system in a step. */
struct kiln_interact_work {
    const char *system; /* the system's name */
    struct kiln_interact_params params;
    /* gravity: parameters of the system that attracts, which may be this one */
    struct kiln_interact_params sources;
    bool of_other; /* `sources` are of another system */
    bool collides, pulls, flocks;
    enum kiln_contact_mode mode; /* collisions: this member and those below */
    uint32_t rounds;
    float width_m; /* m: diameter of the largest particle */
    float fastest; /* m/s: approach for which the scene wants collisions searched; below 0: auto */
};

struct kiln_interact {
    const struct kiln_scene *scene;
    struct kiln_device *device; /* NULL: the pushes are computed on the host, in threads */
    struct kiln_threads *threads;
    struct kiln_buffer pushes; /* pushes of all systems: float4 [2 * push_count] */
    /* scratch memory for one system at a time: */
    /* struct kiln_body, for the bodies of the largest system */
    struct kiln_buffer bodies, second;
    struct kiln_buffer cells;    /* uint32_t, several a particle */
    struct kiln_buffer partners; /* uint32_t, one a body */
    struct kiln_buffer entries;  /* two halves, with 16 bytes a body in each */
    /* gravity: start of the second half; the first has the sources, the second the targets */
    uint32_t half;
    struct kiln_buffer order;                 /* uint32_t, two a body */
    struct kiln_buffer contact_scratch;       /* on the host, for the way to find partners */
    struct kiln_buffer accelerations;         /* gravity on the host: float3, one a slot */
    const struct kiln_gravity_loops *gravity; /* loops of gravity for this processor, on the host */
    const struct kiln_flock_loops *flock;
    /* only in GL: */
    struct kiln_buffer block;               /* struct kiln_interact_params */
    GLuint programs[KILN_INTERACT_KERNELS]; /* 0: the scene does not use the kernel */
    GLuint contact_programs[KILN_CONTACT_MODES][KILN_CONTACT_PROGRAMS]; /* as `programs` */
    uint32_t group_size;
    bool spins; /* true: the particles of some system spin */

    char warning[512]; /* the first warning; "": none */
    bool warned;
};

/* Prepares the pushes of a scene. Nothing is allocated if no system interacts. kiln_interact_finish
 * frees everything, also after a failure. */
bool kiln_interact_init(struct kiln_interact *interact, struct kiln_device *device,
                        const struct kiln_scene *scene, struct kiln_threads *threads,
                        struct kiln_error *error);

/* Adds the memory of the interactions of a scene on the host. */
void kiln_interact_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);
void kiln_interact_finish(struct kiln_interact *interact);

/* Computes the pushes of a step with these parameters from the state before it. keys: the scene's
 * keys, in GL; NULL on the host. */
bool kiln_interact_gather(struct kiln_interact *interact, const struct kiln_sim_params *params,
                          struct kiln_pool *pool, struct kiln_buffer *keys,
                          struct kiln_error *error);

/* Returns the first warning about the steps so far; NULL: none. The interact owns the text. */
const char *kiln_interact_warning(struct kiln_interact *interact);

/* ---- shared by the files of this folder ------------------------------------------------------ */

/* Returns the number of entries to allocate for `count`: a power of two, at least 64. */
uint32_t kiln_interact_entries(uint32_t count);

/* Computes the bounds of the velocities of all living particles, as shared/interact_speeds.h
 * defines them. */
bool kiln_interact_cpu_speeds(struct kiln_interact *interact, const struct kiln_interact_work *work,
                              struct kiln_pool *pool, uint32_t *bounds, struct kiln_error *error);
bool kiln_interact_gl_speeds(struct kiln_interact *interact, const struct kiln_interact_work *work,
                             struct kiln_pool *pool, struct kiln_buffer *keys, uint32_t *bounds,
                             struct kiln_error *error);

bool kiln_interact_cpu(struct kiln_interact *interact, const struct kiln_interact_work *work,
                       struct kiln_pool *pool, struct kiln_error *error);

bool kiln_interact_flock_cpu(struct kiln_interact *interact, const struct kiln_interact_work *work,
                             struct kiln_pool *pool, struct kiln_error *error);

/* Binds a buffer as a storage block. */
bool kiln_interact_bind(GLuint at, struct kiln_buffer *buffer, enum kiln_access access,
                        struct kiln_error *error);

/* Runs a program over count slots, bodies or pairs. */
void kiln_interact_run(const struct kiln_interact *interact, GLuint program, uint32_t count);

/* Sets the words of the first `cells` cells to 0. */
void kiln_interact_empty_cells(const struct kiln_interact *interact, uint32_t cells);

/* Sorts the bodies into cells; the program counts those of each cell. */
void kiln_interact_gl_into_cells(const struct kiln_interact *interact,
                                 const struct kiln_interact_params *params, GLuint count);

bool kiln_interact_gl_init(struct kiln_interact *interact, struct kiln_error *error);
bool kiln_interact_gl(struct kiln_interact *interact, const struct kiln_interact_work *work,
                      struct kiln_pool *pool, struct kiln_buffer *keys, struct kiln_error *error);

#endif
