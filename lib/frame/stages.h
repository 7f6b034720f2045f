/* A kiln_stages holds the stages that draw a state and the images that they pass on to each other
 * (Heinz 2019, figure 3.1). */
#ifndef KILN_FRAME_STAGES_H
#define KILN_FRAME_STAGES_H

#include "asset/atlas/atlas.h"
#include "base/footprint.h"
#include "draw/backdrop/backdrop.h"
#include "draw/moment/between.h"
#include "draw/solids/solids.h"
#include "draw/sprites/coarse.h"
#include "draw/sprites/particles.h"
#include "draw/volume/volume.h"
#include "frame/run.h"
#include "frame/technique.h"
#include "gpu/timer.h"
#include "output/output.h"
#include "post/bloom.h"
#include "post/composite.h"
#include "post/shutter.h"
#include "sort/sort.h"

struct kiln_stages {
    struct kiln_device *device; /* NULL if all stages run on the host */
    const struct kiln_scene *scene;
    struct kiln_threads *threads;
    uint64_t opaque_systems;  /* a bit for each system of opaque particles */
    bool layers;              /* the output needs the layers of an EXR file */
    bool glow;                /* particles draw their glow into bloom_color */
    struct kiln_timer *timer; /* timer and caller are borrowed */
    const struct kiln_caller *caller;
    struct kiln_atlas atlas;

    struct kiln_sort *sort;
    struct kiln_history history;  /* of the sort, the one stage that may keep a history */
    struct kiln_between *between; /* NULL if all moments are at the ends of steps */
    struct kiln_moment moment;    /* the moment that is being drawn */
    struct kiln_instant instant;  /* of the moment */
    bool same_instant;            /* the moment differs from the one before by its view alone */
    struct kiln_lighting_stage *lighting;
    struct kiln_lighting light; /* of the moment */
    bool on_host;               /* a drawing stage reads particles on the host */
    struct kiln_backdrop_stage *backdrop;
    struct kiln_particles_stage *particles;
    struct kiln_coarse_stage *coarse;   /* NULL if particles are drawn at the frame's resolution */
    struct kiln_solids_stage *solids;   /* NULL if no system has opaque particles */
    struct kiln_volume_stage *volume;   /* NULL if the scene has no gas */
    struct kiln_shutter_stage *shutter; /* NULL if a frame is a single moment */
    struct kiln_bloom_stage *bloom;
    struct kiln_composite_stage *composite;

    struct kiln_buffer entries;                       /* draw entries of the current pass */
    struct kiln_image backdrop_color, backdrop_depth; /* used if the scene has solids */
    struct kiln_image scene_color, scene_depth;       /* the backdrop with the solids */
    struct kiln_image particle_color; /* all particles (merged), or smoke alone (separate) */
    struct kiln_image fire_color;     /* for separate composition and for layers */
    struct kiln_image smoke_color;    /* for layers unless the composition is separate */
    /* for layers, if there is gas: the light of its flames with its opacity; the depth at which it
     * has become half opaque */
    struct kiln_image gas_color, gas_depth;
    struct kiln_image bloom_color;   /* what glows in a moment */
    struct kiln_image *bloom_source; /* what the bloom stage blurs: bloom_color, or its mean over a
                                      * frame's moments */
    struct kiln_framebuffer particle_framebuffer, fire_framebuffer, smoke_framebuffer;
};

/* Holds the parameters of kiln_stages_init. Threads, timer and caller are borrowed; the caller is
 * asked before each pass whether to go on. */
struct kiln_stages_params {
    struct kiln_techniques techniques;
    struct kiln_output_needs needs; /* what the output needs of each picture */
    struct kiln_threads *threads;
    struct kiln_timer *timer;
    const struct kiln_caller *caller;
    uint32_t slot_count; /* slots of the pool that will be drawn */
};

/* Creates all stages for a scene. If device is NULL, all techniques must be `cpu`. Frees everything
 * on failure. */
bool kiln_stages_init(struct kiln_stages *stages, struct kiln_device *device,
                      const struct kiln_scene *scene, const struct kiln_stages_params *params,
                      struct kiln_error *error);
void kiln_stages_finish(struct kiln_stages *stages);

/* Adds the memory of all stages of the device `cpu`, and of a picture of 8 bits without layers. */
void kiln_stages_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);

/* Runs every stage from sort to particles for a moment of a frame: 0 to
 * kiln_scene_moment_count() - 1, in order. pool: the state after instant.step steps. before: the
 * particles a step earlier; NULL is allowed if the instant does not lie within a step. *drawn
 * becomes the number of particles. */
bool kiln_stages_draw(struct kiln_stages *stages, struct kiln_pool *before, struct kiln_pool *pool,
                      struct kiln_instant instant, uint32_t moment, uint32_t *drawn,
                      struct kiln_error *error);

/* Advances the history for a moment that is not drawn, as kiln_stages_draw does. It must be called
 * if a stage keeps a history. */
bool kiln_stages_skip_moment(struct kiln_stages *stages, struct kiln_pool *before,
                             struct kiln_pool *pool, struct kiln_instant instant,
                             struct kiln_error *error);

/* Runs bloom and composite, which make the picture of a frame from the drawn moments. */
bool kiln_stages_compose(struct kiln_stages *stages, uint32_t frame, struct kiln_error *error);

/* Copies the drawn frame to a picture that was created for the same needs. */
bool kiln_stages_read(struct kiln_stages *stages, struct kiln_picture *picture,
                      struct kiln_error *error);

/* Writes the names and channels of a frame's layers for kiln_picture_create, with those of gas or
 * without them; a scene has them if kiln_volume_domains is not 0. Returns the number of layers. */
uint32_t kiln_stages_layers(bool gas, const char *names[KILN_MAX_LAYERS],
                            uint32_t channels[KILN_MAX_LAYERS]);

#endif
