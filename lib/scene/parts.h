/* Declares the parts of a scene that have hashes of their own (scene/motion.c). Each row of the
 * option tables names the parts that it belongs to. */
#ifndef KILN_SCENE_PARTS_H
#define KILN_SCENE_PARTS_H

#include "scene/scene.h"

enum kiln_scene_part {
    KILN_PART_MOTION = 1, /* options that decide the state of the particles */
    KILN_PART_VIEW = 2,   /* options that decide where the camera sees particles in each moment */
    /* options of which the hash of the whole scene is taken: all but those of later versions that
     * have their default, such as a seed of a system that is the one it would have anyway, so that
     * older scenes keep their hash */
    KILN_PART_HASHED = 4,
};

/* Functions for `parts` of struct kiln_option. */
unsigned kiln_row_look(const void *scene, const void *base);
unsigned kiln_row_view(const void *scene, const void *base);
unsigned kiln_row_motion(const void *scene, const void *base);

/* Return the bits of all parts under a condition, and otherwise that of the hash; base is a struct
 * kiln_look, kiln_object or kiln_backdrop. Particles hit an object or the floor when they collide
 * with it or paint it. */
unsigned kiln_row_if_contacts_are_as_drawn(const void *scene, const void *look);
unsigned kiln_row_if_it_paints(const void *scene, const void *look);
unsigned kiln_row_if_it_lies(const void *scene, const void *look);

/* Return the bit of the hash if a look uses keys that older versions lack, and otherwise 0, so that
 * other scenes keep their hashes. */
unsigned kiln_row_if_formed(const void *scene, const void *look);
unsigned kiln_row_if_ribbon(const void *scene, const void *look);
unsigned kiln_row_if_particles_hit_object(const void *scene, const void *object);
unsigned kiln_row_if_particles_hit_floor(const void *scene, const void *backdrop);

/* Returns the bits of all parts if a force acts in a region alone, and otherwise 0, so that older
 * scenes keep their hash. */
unsigned kiln_row_if_region(const void *scene, const void *force);

/* Return the bits of all parts if impacts stop particles, or if what they do is not certain, and
 * otherwise 0. */
unsigned kiln_row_if_stops(const void *scene, const void *collide);
unsigned kiln_row_if_not_certain(const void *scene, const void *collide);

/* Returns the bits of all parts if deaths of parents at impacts count, and otherwise 0. */
unsigned kiln_row_if_impacts_count(const void *scene, const void *emit);

/* Returns the bits of all parts if the births of bursts are in order, and otherwise 0. */
unsigned kiln_row_if_ordered(const void *scene, const void *emit);

/* Returns the bits of all parts if each impact of a parent has children, and otherwise 0. */
unsigned kiln_row_if_each_bounce(const void *scene, const void *emit);

/* Returns the bits of all parts if children are born by the metre, and otherwise 0. */
unsigned kiln_row_if_by_metre(const void *scene, const void *emit);

/* Returns the bits of all parts if children inherit something of their parent's look, which the
 * state has to know, and otherwise 0. */
unsigned kiln_row_if_looks_are_inherited(const void *scene, const void *emit);

/* Returns the bits of all parts if an emitter has births by the metre, and otherwise 0. */
unsigned kiln_row_if_emitted_by_metre(const void *scene, const void *emit);

/* Return the bits of an `attach` that names a node, and otherwise 0; base is a struct kiln_emitter,
 * kiln_force, kiln_force_region, kiln_object, kiln_light or kiln_camera. */
unsigned kiln_row_if_emitter_is_attached(const void *scene, const void *emitter);
unsigned kiln_row_if_space_is_of_node(const void *scene, const void *system);
unsigned kiln_row_if_force_is_attached(const void *scene, const void *force);
unsigned kiln_row_if_region_is_attached(const void *scene, const void *region);
unsigned kiln_row_if_object_is_attached(const void *scene, const void *object);
unsigned kiln_row_if_light_is_attached(const void *scene, const void *light);
unsigned kiln_row_if_camera_is_attached(const void *scene, const void *camera);

/* Returns the bits of what is attached to a node, or to nodes that lie in it. base is a struct
 * kiln_scene_node, or a struct within one. */
unsigned kiln_row_of_node(const void *scene, const void *inside);
/* Do the same for a node of a file, or for a joint, and otherwise return 0. */
unsigned kiln_row_if_node_is_of_file(const void *scene, const void *inside);
unsigned kiln_row_if_node_is_joint(const void *scene, const void *inside);
/* Returns the bits of all nodes together; 0 if there are none. */
unsigned kiln_row_of_nodes(const void *scene, const void *base);

/* Returns the bits of all parts if there are domains of gas, and otherwise 0. */
unsigned kiln_row_of_gas(const void *scene, const void *base);

/* Returns the bit of the hash: motion.c adds what the detail of gas adds to its state. */
unsigned kiln_row_of_detail(const void *scene, const void *base);

/* Returns the bits of all parts if a system's seed is not its place, and otherwise 0. */
unsigned kiln_row_if_seed_is_pinned(const void *scene, const void *system);

#define LOOK                     kiln_row_look
#define VIEW                     kiln_row_view
#define MOTION                   kiln_row_motion
#define IF_CONTACTS_ARE_AS_DRAWN kiln_row_if_contacts_are_as_drawn
#define IF_IT_PAINTS             kiln_row_if_it_paints
#define IF_IT_LIES               kiln_row_if_it_lies
#define IF_FORMED                kiln_row_if_formed
#define IF_RIBBON                kiln_row_if_ribbon
#define IF_PARTICLES_HIT_OBJECT  kiln_row_if_particles_hit_object
#define IF_PARTICLES_HIT_FLOOR   kiln_row_if_particles_hit_floor
#define IF_SEED_IS_PINNED        kiln_row_if_seed_is_pinned
#define IF_REGION                kiln_row_if_region
#define IF_STOPS                 kiln_row_if_stops
#define IF_IMPACTS_COUNT         kiln_row_if_impacts_count
#define IF_ORDERED               kiln_row_if_ordered
#define IF_EACH_BOUNCE           kiln_row_if_each_bounce
#define IF_BY_METRE              kiln_row_if_by_metre
#define IF_EMITTED_BY_METRE      kiln_row_if_emitted_by_metre
#define IF_LOOKS_ARE_INHERITED   kiln_row_if_looks_are_inherited
#define IF_NOT_CERTAIN           kiln_row_if_not_certain
#define IF_EMITTER_IS_ATTACHED   kiln_row_if_emitter_is_attached
#define IF_SPACE_IS_OF_NODE      kiln_row_if_space_is_of_node
#define IF_FORCE_IS_ATTACHED     kiln_row_if_force_is_attached
#define IF_REGION_IS_ATTACHED    kiln_row_if_region_is_attached
#define IF_OBJECT_IS_ATTACHED    kiln_row_if_object_is_attached
#define IF_LIGHT_IS_ATTACHED     kiln_row_if_light_is_attached
#define IF_CAMERA_IS_ATTACHED    kiln_row_if_camera_is_attached
#define IF_NODE_IS_OF_FILE       kiln_row_if_node_is_of_file
#define IF_NODE_IS_JOINT         kiln_row_if_node_is_joint
#define OF_NODE                  kiln_row_of_node
#define OF_NODES                 kiln_row_of_nodes
#define OF_GAS                   kiln_row_of_gas
#define OF_DETAIL                kiln_row_of_detail

#endif
