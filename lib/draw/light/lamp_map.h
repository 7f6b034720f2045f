/* A kiln_lamp_maps holds shadow maps of lamps on the host. They show the backdrop's meshes as lamps
 * see them, six for each lamp, in the layout of shared/lamp_map.h. */
#ifndef KILN_DRAW_LIGHT_LAMP_MAP_H
#define KILN_DRAW_LIGHT_LAMP_MAP_H

#include "base/footprint.h"
#include "base/thread.h"
#include "draw/light/shadow_levels.h"
#include "draw/moment/moment.h"
#include "shared/draw_layout.h"

enum {
    KILN_LAMP_LEVELS = 9, /* down to 1 texel */
    KILN_LAMP_FACES = 6,
    KILN_LAMP_ENTRIES = KILN_SHADOW_MAP_ENTRIES(KILN_LAMP_EDGE, KILN_LAMP_LEVELS), /* of a face */
    KILN_LAMP_WORDS = KILN_LAMP_ENTRIES * KILN_SHADOW_PAIR,                        /* of a face */
};

struct kiln_lamp_maps;

/* Returns whether a scene may need maps: it has meshes, and lamps or fire that they hide. */
bool kiln_lamp_maps_exist(const struct kiln_scene *scene);

/* Creates the maps; NULL with an error. Moment and threads must outlive them. */
struct kiln_lamp_maps *kiln_lamp_maps_create(const struct kiln_moment *moment,
                                             struct kiln_threads *threads,
                                             struct kiln_error *error);

/* Adds the memory of the maps. */
void kiln_lamp_maps_footprint(const struct kiln_scene *scene, struct kiln_footprint *footprint);
void kiln_lamp_maps_destroy(struct kiln_lamp_maps **maps);

/* Draws the maps of the lights whose `casters` is not 0, and sets their numbers and reach. A map
 * that already shows the same meshes from the same place is kept. Returns the entries: for each
 * number its faces, each with all levels (shadow_levels.h). *count becomes how many lamps have
 * maps. NULL with an error when memory is short. */
const uint32_t *kiln_lamp_maps_run(struct kiln_lamp_maps *maps, const struct kiln_moment *moment,
                                   struct kiln_draw_light *lights, uint32_t light_count,
                                   uint32_t *count, struct kiln_error *error);

/* Returns a number that grows when a map is drawn. */
uint64_t kiln_lamp_maps_changes(const struct kiln_lamp_maps *maps);

#endif
