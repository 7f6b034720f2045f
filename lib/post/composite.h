/* The composite stage, stage 5b of a frame, composes scene, particles and bloom into the picture
 * (Heinz 2019, 3.2.1, last step). */
#ifndef KILN_POST_COMPOSITE_H
#define KILN_POST_COMPOSITE_H

#include "base/footprint.h"
#include "base/thread.h"
#include "gpu/image.h"
#include "scene/scene.h"

/* Pictures of the two techniques differ by rounding, at most one level of a channel. */
enum kiln_composite_technique { KILN_COMPOSITE_GL, KILN_COMPOSITE_CPU };

struct kiln_composite_stage;

struct kiln_composite_params {
    enum kiln_composite_technique technique;
    struct kiln_threads *threads; /* for KILN_COMPOSITE_CPU */
    uint32_t bits;                /* bits a channel of the display picture: 8 or 16 */
    bool beauty;                  /* whether kiln_composite_take_beauty will be called */
    /* false: alpha times the display's values of a colour shows it over black, as viewers blend;
     * true: alpha times its light does, as renderers blend textures */
    bool texture;
};

/* The scene and the threads must outlive the stage; device may be NULL for KILN_COMPOSITE_CPU.
 * Returns NULL with an error on failure. */
struct kiln_composite_stage *kiln_composite_create(struct kiln_device *device,
                                                   const struct kiln_scene *scene,
                                                   const struct kiln_composite_params *params,
                                                   struct kiln_error *error);

/* Adds the memory of the technique `cpu` for pictures of 8 bits without layers. */
void kiln_composite_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);
void kiln_composite_destroy(struct kiln_composite_stage **stage);

struct kiln_composite_inputs {
    struct kiln_image *scene, *particles; /* particles: premultiplied; NULL if `scene` contains
                                           * them */
    struct kiln_image *fire;              /* NULL if `particles` contains it */
    struct kiln_image *bloom;             /* smaller than the picture; NULL for no bloom */
    float bloom_scale;                    /* the size of `bloom` divided by that of the picture */
    uint32_t frame;
    float time_s;
};

bool kiln_composite_run(struct kiln_composite_stage *stage,
                        const struct kiln_composite_inputs *inputs, struct kiln_error *error);

/* kiln_composite_read_display copies the display picture to the host (sRGB, RGBA, not
 * premultiplied, 8 or 16 bits a channel, rows from the top). kiln_composite_take_beauty gives
 * the scene-linear, premultiplied picture (float RGBA) once: it writes *pixels, or exchanges that
 * memory, which free() frees, for the picture's. */
bool kiln_composite_read_display(struct kiln_composite_stage *stage, void *pixels,
                                 struct kiln_error *error);
bool kiln_composite_take_beauty(struct kiln_composite_stage *stage, float **pixels,
                                struct kiln_error *error);

#endif
