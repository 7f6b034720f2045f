/* A kiln_loop steps the particles of a scene to a frame and draws it. Its caller decides what
 * becomes of the picture (lib/job). */
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
    struct kiln_caller caller; /* asked for leave between steps, passes and bands of rows */
};

/* Holds a drawn frame and its measurements. */
struct kiln_drawn {
    struct kiln_picture *picture; /* the caller's */
    uint64_t alive;               /* particles, at the first of its moments */
    struct kiln_state_hash state; /* where it was asked for */
    double pass_ms[KILN_PASS_COUNT];
};

/* Chooses techniques and starts threads. Device, scene and the texts of params are borrowed.
 * Returns NULL with KILN_USAGE for unknown techniques, KILN_NO_DEVICE, or KILN_DEVICE_FAILED, also
 * when the device cannot draw so large a scene. */
struct kiln_loop *kiln_loop_create(struct kiln_device *device, const struct kiln_scene *scene,
                                   const struct kiln_loop_params *params, struct kiln_error *error);
void kiln_loop_destroy(struct kiln_loop **loop);

/* Makes buffers, programs and textures for pictures of such needs. Call it once, before the
 * functions below. */
bool kiln_loop_set_up(struct kiln_loop *loop, struct kiln_output_needs needs,
                      struct kiln_error *error);

const struct kiln_techniques *kiln_loop_techniques(const struct kiln_loop *loop);

/* Returns the bytes that the particles and their sorting take, on each side that they are on. */
uint64_t kiln_loop_particle_bytes(const struct kiln_loop *loop);

/* Returns the state of the run, which belongs to the loop. A caller that replaces it calls
 * kiln_loop_resume afterwards. */
struct kiln_run *kiln_loop_run(struct kiln_loop *loop);

/* Says that the state in kiln_loop_run is the one in which a frame starts, with all that later
 * frames need of earlier ones. */
void kiln_loop_resume(struct kiln_loop *loop, uint32_t frame);

/* Returns the loop's sort if that keeps an order from frame to frame, which then belongs to the
 * state; otherwise NULL. */
struct kiln_sort *kiln_loop_kept_sort(struct kiln_loop *loop);

/* Returns the worker threads, for work between frames. */
struct kiln_threads *kiln_loop_threads(struct kiln_loop *loop);

/* Returns how many steps this loop has done itself. */
uint64_t kiln_loop_steps(const struct kiln_loop *loop);

/* Copies the particles of another loop of the same scene, whatever techniques either has. The order
 * that a spread sort keeps is not copied. */
bool kiln_loop_adopt(struct kiln_loop *loop, struct kiln_loop *from, struct kiln_error *error);

/* Steps to where a frame starts, unless it is there already, and draws nothing. Frames in between
 * do what later ones need of them. */
bool kiln_loop_advance(struct kiln_loop *loop, uint32_t frame, struct kiln_error *error);

/* Draws a frame; frames may not go back. `hash` asks for the hash of the state. */
bool kiln_loop_draw(struct kiln_loop *loop, uint32_t frame, bool hash, struct kiln_drawn *drawn,
                    struct kiln_error *error);

/* Writes the hash of the present state, and the number of living particles. */
bool kiln_loop_hash(struct kiln_loop *loop, struct kiln_state_hash *hash, uint64_t *alive,
                    struct kiln_error *error);

#endif
