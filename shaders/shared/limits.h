/* Sizes of tables, and the binding points of the simulation, that host and shaders agree on. */
#ifndef KILN_SHARED_LIMITS_H
#define KILN_SHARED_LIMITS_H

/* The largest key table of a scene: 16 KiB, the least that every GL allows a uniform block. */
#define KILN_MAX_VALUE_KEYS 1024

#define KILN_MAX_FORCES           16 /* a system */
#define KILN_MAX_DEMITTERS        8  /* a system */
#define KILN_MAX_BURSTS           64 /* a system */
#define KILN_MAX_OBJECTS          32 /* a scene */
#define KILN_MAX_MESHES           8  /* a scene, terrain among them; they count as objects, too */
#define KILN_MAX_LIGHTS           16 /* a scene */
#define KILN_MAX_DEPTH_DIRECTIONS 6  /* of a mesh: each a front and a back */

/* Systems from a first parent to its last descendants. */
#define KILN_MAX_GENERATIONS 4

/* Lights that fire sheds, besides those. */
#define KILN_MAX_FIRE_LIGHTS 16

/* The groups of births of a step: one of the rate and one of each burst. */
#define KILN_MAX_BIRTH_GROUPS 65

/* Objects and the floor. */
#define KILN_MAX_COLLIDERS 33

#define KILN_MAX_WINDS 8                                  /* a scene: files of wind */
#define KILN_MAX_GRIDS (KILN_MAX_WINDS + KILN_MAX_MESHES) /* those, and what collides */

/* Ways in which the particles of a system interact, of each kind one. */
#define KILN_MAX_INTERACTIONS 4

/* Uniform blocks of a step. */
#define SIM_BIND_KEYS         0
#define SIM_BIND_STEP         1
#define SIM_BIND_SURROUNDINGS 2

/* Storage blocks. */
#define SIM_BIND_RECORDS 0
#define SIM_BIND_SUMS    1
#define SIM_BIND_TRACES  2
#define SIM_BIND_SECOND  3 /* records, of techniques with two buffers */
#define SIM_BIND_GRIDS   4
#define SIM_BIND_PUSHES  5
#define SIM_BIND_SPINS   6
#define SIM_BIND_VOLUMES 7

/* Of the kernels that gather pushes; SIM_BIND_KEYS, _RECORDS and _PUSHES serve them, too. */
#define INTERACT_BIND_PARAMS   3 /* uniform block */
#define INTERACT_BIND_BODIES   1
#define INTERACT_BIND_SECOND   2 /* bodies after a round */
#define INTERACT_BIND_CELLS    3
#define INTERACT_BIND_PARTNERS 4
#define INTERACT_BIND_ENTRIES  6 /* of the two grids: what is sorted */
#define INTERACT_BIND_ORDER    7 /* of the second grid */
#define INTERACT_BIND_SPINS    8 /* of those that turn: every device in use has so many */

/* Invocations of the work group that adds up all cells. */
#define INTERACT_SCAN_GROUP 256

/* Invocations of a work group; kernels may be compiled for another size. */
#ifndef SIM_GROUP_SIZE
#define SIM_GROUP_SIZE 64
#endif

/* Slots that one invocation of the hash adds up. */
#define SIM_HASH_SLOTS 16

/* Births that one emitter spawns; 8 words each, of 1024 that every geometry shader may write. On
 * software GL it is one, as others step one slot: all loops of an emitter together run so often and
 * no more (gpu/device.h). */
#ifndef SIM_EMITTER_BIRTHS
#define SIM_EMITTER_BIRTHS 32
#endif

/* Slots in a row of the textures of technique `texels`. */
#define SIM_TEXEL_ROW 2048

#endif
