/* Defines the sizes of tables, the binding points and the uniform locations of the simulation, for
 * host and shaders. */
#ifndef KILN_SHARED_LIMITS_H
#define KILN_SHARED_LIMITS_H

/* The largest key table of a scene, and of a uniform block of 16 KiB, which every GL allows. With
 * more keys, a scene's table lies in a storage block (KEYS_STORED). */
#define KILN_MAX_VALUE_KEYS 65536
#define KILN_BLOCK_KEYS     1024

#define KILN_MAX_FORCES           32  /* a system */
#define KILN_MAX_DEMITTERS        8   /* a system */
#define KILN_MAX_BURSTS           64  /* a system */
#define KILN_MAX_OBJECTS          256 /* a scene */
#define KILN_MAX_MESHES           64  /* a scene, including terrain; meshes also count as objects */
#define KILN_MAX_LIGHTS           64  /* a scene */
#define KILN_MAX_DEPTH_DIRECTIONS 6   /* a mesh; each direction has a front and a back */

/* Generations from a first parent to its last descendants. */
#define KILN_MAX_GENERATIONS 4

/* Lights of fire, in addition to a scene's lights. */
#define KILN_MAX_FIRE_LIGHTS 16

/* The groups of births of a step: one of the rate, one of the way and one of each burst. */
#define KILN_MAX_BIRTH_GROUPS 66

/* Colliders: objects and the floor. */
#define KILN_MAX_COLLIDERS 257

#define KILN_MAX_WINDS    8  /* wind files of a scene */
#define KILN_MAX_BAKED    8  /* baked winds of a scene */
#define KILN_MAX_BAKED_OF 12 /* forces of a baked wind */

/* Grids of winds and of colliders. */
#define KILN_MAX_GRIDS (KILN_MAX_WINDS + KILN_MAX_BAKED + KILN_MAX_MESHES)

/* The most of each kind with which struct kiln_surroundings lies in a uniform block of 16 KiB. With
 * more, it lies in a storage block (SURROUNDINGS_STORED). */
#define KILN_BLOCK_COLLIDERS 33
#define KILN_BLOCK_MESHES    8
#define KILN_BLOCK_GRIDS     (KILN_MAX_WINDS + KILN_MAX_BAKED + KILN_BLOCK_MESHES)

/* Kinds of interaction; a system has at most one of each. */
#define KILN_MAX_INTERACTIONS 4

/* Uniform blocks of a step. */
#define SIM_BIND_KEYS         0
#define SIM_BIND_STEP         1
#define SIM_BIND_SURROUNDINGS 2

/* Storage blocks. Techniques of papers have another one in the place of SIM_BIND_AROUND
 * (shared/papers/step_layout.h). */
#define SIM_BIND_RECORDS 0
#define SIM_BIND_SUMS    1
#define SIM_BIND_TRACES  2
#define SIM_BIND_AROUND  3 /* the surroundings, if they are stored */
#define SIM_BIND_GRIDS   4
#define SIM_BIND_PUSHES  5
#define SIM_BIND_SPINS   6
#define SIM_BIND_VOLUMES 7

/* Locations of uniforms of the kernels that hash the state. */
#define SIM_AT_SYSTEM     0
#define SIM_AT_BASE       1
#define SIM_AT_USED       2
#define SIM_AT_FIRST_SPIN 3

/* Locations of uniforms of the kernel that writes baked winds. */
#define SIM_AT_GRID      0
#define SIM_AT_NODE      1
#define SIM_AT_NODE_TURN 2

/* Blocks of the kernels that compute pushes, which also use SIM_BIND_KEYS, _RECORDS and _PUSHES. */
#define INTERACT_BIND_PARAMS   3 /* uniform block */
#define INTERACT_BIND_BODIES   1
#define INTERACT_BIND_SECOND   2 /* bodies after a round */
#define INTERACT_BIND_CELLS    3
#define INTERACT_BIND_PARTNERS 4
#define INTERACT_BIND_ENTRIES  6 /* scratch memory, 32 bytes a body */
#define INTERACT_BIND_SPINS    8 /* spins of bodies; every device in use has this binding point */
#define INTERACT_BIND_KEYS     9 /* keys, with KEYS_STORED */

/* Locations of uniforms of these kernels. shared/papers/interact_layout.h has more, and one more
 * block. */
#define INTERACT_AT_CELL_COUNT     0
#define INTERACT_AT_IS_LATER_ROUND 4
#define INTERACT_AT_FIRST_SOURCE   5
#define INTERACT_AT_END_SOURCE     6
#define INTERACT_AT_ALL_SOURCES    7
#define INTERACT_AT_SUMS           8

/* Invocations of the work group that sums up all cells. */
#define INTERACT_SCAN_GROUP 256

/* Invocations of a work group; kernels may be compiled for another size. */
#ifndef SIM_GROUP_SIZE
#define SIM_GROUP_SIZE 64
#endif

/* Slots that one invocation of the hash sums up. */
#define SIM_HASH_SLOTS 16

#endif
