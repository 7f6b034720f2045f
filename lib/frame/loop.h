/* A kiln_loop steps the particles of a scene to a frame and draws it. The caller (lib/job) decides
 * what to do with the picture. */
#ifndef KILN_FRAME_LOOP_H
#define KILN_FRAME_LOOP_H

#include "frame/run.h"
#include "frame/technique.h"
#include "output/output.h"
#include "particles/history.h"

struct kiln_loop;
struct kiln_timer;

struct kiln_loop_params {
    const char *const *techniques; /* "stage=name" */
    size_t technique_count;
    uint32_t threads;         /* 0: one for each core */
    uint32_t work_group_size; /* as in kiln_render_params */
    struct kiln_log log;
    struct kiln_caller caller; /* asked between steps, passes and bands of rows whether to go on */
};

/* Holds a drawn frame and its measurements. */
struct kiln_drawn {
    struct kiln_picture *picture; /* owned by the caller */
    uint64_t alive;               /* particles drawn at the first moment of the frame */
    struct kiln_state_hash state; /* of these particles; set only if `hash` was true */
    double pass_ms[KILN_PASS_COUNT];
};

/* Chooses techniques and starts threads. Device, scene and the strings of params are borrowed.
 * Returns NULL with KILN_USAGE for unknown techniques, with KILN_NO_DEVICE if a technique needs an
 * exact device, or with KILN_DEVICE_FAILED, also if the scene is too large for the device. */
struct kiln_loop *kiln_loop_create(struct kiln_device *device, const struct kiln_scene *scene,
                                   const struct kiln_loop_params *params, struct kiln_error *error);
void kiln_loop_destroy(struct kiln_loop **loop);

/* Creates buffers, programs and textures for pictures with these needs. The caller must call it
 * once, before the functions below. */
bool kiln_loop_set_up(struct kiln_loop *loop, struct kiln_output_needs needs,
                      struct kiln_error *error);

const struct kiln_techniques *kiln_loop_techniques(const struct kiln_loop *loop);

/* Returns the bytes that particles and sort buffers take on each side, host or device, that holds
 * them. */
uint64_t kiln_loop_particle_bytes(const struct kiln_loop *loop);

/* Returns the state of the run, which the loop owns. A caller that replaces the state calls
 * kiln_loop_set_frame afterwards. */
struct kiln_run *kiln_loop_run(struct kiln_loop *loop);

/* Declares that the state in kiln_loop_run is the state at the start of a frame, together with
 * everything that later frames need from earlier frames. */
void kiln_loop_set_frame(struct kiln_loop *loop, uint32_t frame);

/* Returns what a stage keeps from frame to frame; its kind is NULL if none does. It is part of the
 * state. */
const struct kiln_history *kiln_loop_history(const struct kiln_loop *loop);

/* Returns the worker threads, for work between frames. */
struct kiln_threads *kiln_loop_threads(struct kiln_loop *loop);

/* Returns the timer of the passes. */
struct kiln_timer *kiln_loop_timer(struct kiln_loop *loop);

/* Returns how many steps this loop has simulated itself. */
uint64_t kiln_loop_steps(const struct kiln_loop *loop);

/* Copies the particles and the position in the clip from another loop of the same scene, which may
 * use other techniques. Does not copy the history that a stage keeps. */
bool kiln_loop_copy_state(struct kiln_loop *loop, struct kiln_loop *from, struct kiln_error *error);

/* Simulates up to the start of a frame and draws nothing. Frames in between advance the history
 * that a stage keeps. */
bool kiln_loop_advance(struct kiln_loop *loop, uint32_t frame, struct kiln_error *error);

/* Draws a frame, which must not be earlier than the last frame. hash: also compute the hash of the
 * state. */
bool kiln_loop_draw(struct kiln_loop *loop, uint32_t frame, bool hash, struct kiln_drawn *drawn,
                    struct kiln_error *error);

/* Writes the hash of the current state and the number of living particles. */
bool kiln_loop_hash(struct kiln_loop *loop, struct kiln_state_hash *hash, uint64_t *alive,
                    struct kiln_error *error);

/* Writes the number of living particles that the frame at 0 s shows, with those of bursts at 0 s,
 * which are not part of the state. The loop has not gone beyond that frame. */
bool kiln_loop_count_first(struct kiln_loop *loop, uint64_t *alive, struct kiln_error *error);

#endif
