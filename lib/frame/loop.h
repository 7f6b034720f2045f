/* The frame loop: steps the particles of a scene to a frame and draws it. What becomes of the
 * picture is a matter of who asks for it (lib/job). */
#ifndef KILN_FRAME_LOOP_H
#define KILN_FRAME_LOOP_H

#include "frame/run.h"
#include "frame/technique.h"
#include "output/output.h"
#include "sort/sort.h"

struct kiln_loop;

struct kiln_loop_params {
    const char *const *techniques; /* "stage=name" */
    size_t technique_count;
    uint32_t threads;         /* 0 takes one a core */
    uint32_t work_group_size; /* as in kiln_render_params */
    struct kiln_log log;
    struct kiln_caller caller; /* asked between steps, passes and bands of rows */
};

/* A frame as it was drawn. */
struct kiln_drawn {
    struct kiln_picture *picture; /* the caller's */
    uint64_t alive;               /* particles, at the first of its moments */
    struct kiln_state_hash state; /* where it was asked for */
    double pass_ms[KILN_PASS_COUNT];
};

/* Chooses techniques and starts threads. Device, scene and the texts of params are borrowed. NULL
 * with KILN_USAGE for techniques that there are not, KILN_NO_DEVICE, or KILN_DEVICE_FAILED, also
 * when the device cannot draw so large a scene. */
struct kiln_loop *kiln_loop_create(struct kiln_device *device, const struct kiln_scene *scene,
                                   const struct kiln_loop_params *params, struct kiln_error *error);
void kiln_loop_destroy(struct kiln_loop **loop);

/* Makes buffers, programs and textures for pictures of such needs. Once, before the functions
 * below. */
bool kiln_loop_set_up(struct kiln_loop *loop, struct kiln_output_needs needs,
                      struct kiln_error *error);

const struct kiln_techniques *kiln_loop_techniques(const struct kiln_loop *loop);

/* Bytes that the particles and their sorting take, on each side that they are on. */
uint64_t kiln_loop_particle_bytes(const struct kiln_loop *loop);

/* The state of the run, of the loop's own. Whoever replaces it says so with kiln_loop_resume. */
struct kiln_run *kiln_loop_run(struct kiln_loop *loop);

/* The state in kiln_loop_run is the one in which a frame starts, with all that earlier frames
 * leave. */
void kiln_loop_resume(struct kiln_loop *loop, uint32_t frame);

/* Its sort where that keeps an order from frame to frame, which then belongs to the state; NULL:
 * it does not. */
struct kiln_sort *kiln_loop_kept_sort(struct kiln_loop *loop);

/* Worker threads, for who has work between frames. */
struct kiln_threads *kiln_loop_threads(struct kiln_loop *loop);

/* Steps that this loop has done itself. */
uint64_t kiln_loop_steps(const struct kiln_loop *loop);

/* Takes over the particles of another loop of the same scene, whatever techniques either has. What
 * a spread sort keeps stays behind. */
bool kiln_loop_adopt(struct kiln_loop *loop, struct kiln_loop *from, struct kiln_error *error);

/* Steps to where a frame starts, if it is not there yet, and draws nothing. Frames in between leave
 * what later ones need of them. */
bool kiln_loop_advance(struct kiln_loop *loop, uint32_t frame, struct kiln_error *error);

/* Draws a frame, no earlier one than before; `hash` asks for the state's. */
bool kiln_loop_draw(struct kiln_loop *loop, uint32_t frame, bool hash, struct kiln_drawn *drawn,
                    struct kiln_error *error);

/* The state hash now, and the number of living particles. */
bool kiln_loop_hash(struct kiln_loop *loop, struct kiln_state_hash *hash, uint64_t *alive,
                    struct kiln_error *error);

#endif
