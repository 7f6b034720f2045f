/* A kiln_lamp_solids holds shadow maps of lamps on the host. They show the solid particles as lamps
 * see them, six for each lamp, in the layout of shared/lamp_map.h. Maps of meshes are separate
 * (lamp_map.h): those are kept while nothing moves, and solids move. */
#ifndef KILN_DRAW_LIGHT_LAMP_SOLIDS_H
#define KILN_DRAW_LIGHT_LAMP_SOLIDS_H

#include "base/footprint.h"
#include "base/thread.h"
#include "draw/light/lamp_map.h"
#include "draw/moment/moment.h"

/* A texel has two words. The first is that of shadow_levels.h. The second has the covered part
 * times the means of the squared distance (lower 16 bits) and of how narrow the solids are
 * (shared/lamp_map.h), in the same units. */
enum {
    KILN_LAMP_SOLID_TEXEL = 2,                                       /* words of a texel */
    KILN_LAMP_SOLID_WORDS = KILN_LAMP_WORDS * KILN_LAMP_SOLID_TEXEL, /* of a face */
};

/* Holds the maps of one moment; they are valid until the next run. */
struct kiln_lamp_solid_maps {
    uint32_t count; /* lamps that have maps */
    /* For each lamp its faces, each with all levels (shadow_levels.h). NULL: there are none. */
    const uint32_t *texels;
    /* Each face of each lamp has a number that grows when the face is drawn. */
    const uint64_t *changes;
};

struct kiln_lamp_solids;

/* Returns whether a scene has solid particles, and lamps or fire that they may hide. */
bool kiln_lamp_solids_exist(const struct kiln_scene *scene);

/* Creates the maps; NULL with an error. Moment and threads must outlive them. */
struct kiln_lamp_solids *kiln_lamp_solids_create(const struct kiln_moment *moment,
                                                 struct kiln_threads *threads,
                                                 struct kiln_error *error);

/* Adds the memory of the maps, and of the solids that they show. */
void kiln_lamp_solids_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);
void kiln_lamp_solids_destroy(struct kiln_lamp_solids **solids);

/* Draws the maps of the lights whose `casters.x` is not 0 and that shine on solids, and adds the
 * numbers and the reach of the maps to these lights. A map that already shows the same solids from
 * the same place is kept. The moment must have been filled with on_host. False with an error when
 * memory is short. */
bool kiln_lamp_solids_run(struct kiln_lamp_solids *solids, const struct kiln_moment *moment,
                          struct kiln_draw_light *lights, uint32_t light_count,
                          struct kiln_lamp_solid_maps *maps, struct kiln_error *error);

#endif
