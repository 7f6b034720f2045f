/* Declares a validated scene, which every stage reads and none changes.
 *
 * SI units, radians, metres, y up, right-handed; colours linear Rec. 709. Every number that a scene
 * may animate is a struct kiln_value (shared/value.h) whose keys lie in scene->keys; the option
 * tables (options_*.c) say which clocks each may use, its unit, its range and its default. */
#ifndef KILN_SCENE_SCENE_H
#define KILN_SCENE_SCENE_H

#include "asset/geometry/mesh_library.h"
#include "asset/geometry/terrain.h"
#include "base/arena.h"
#include "base/handle.h"
#include "base/text.h"
#include "kiln_program.h"
#include "option/values.h"
#include "particles/births.h"
#include "scene/camera.h"
#include "scene/collide.h"
#include "scene/emitter.h"
#include "scene/force.h"
#include "scene/gas.h"
#include "scene/interaction.h"
#include "scene/light.h"
#include "scene/look.h"
#include "scene/node.h"
#include "scene/pattern.h"
#include "scene/post.h"
#include "shared/draw_layout.h"
#include "shared/particle.h"

enum {
    /* limits that shaders use, too, are in shared/limits.h and particle.h */
    KILN_MAX_CELLS = 2048, /* cells of an atlas: the texture layers that every GL 4.3 has */
    /* slots of all systems, half of those that a draw entry can address: offsets of bytes in the
     * records fit into 31 bits. GL takes fewer (KILN_MAX_GL_PARTICLES). */
    KILN_MAX_PARTICLES = 1 << 25,
    KILN_MAX_GL_PARTICLES = 1 << 24,
};

/* Limits of particles that are meshes. */
enum {
    KILN_MAX_INSTANCES = 1 << 20,          /* slots of all systems that show meshes */
    KILN_MAX_PARTICLE_TRIANGLES = 1 << 16, /* triangles of one particle */
    KILN_MAX_INSTANCE_TRIANGLES = 1 << 26, /* triangles of all slots together */
};

enum kiln_integration {
    KILN_INTEGRATE_SEMI_IMPLICIT,  /* velocity, then position */
    KILN_INTEGRATE_POSITION_FIRST, /* the thesis's order: position, then velocity (3.3.2) */
    KILN_INTEGRATE_TRAPEZOID,      /* second order: as in UberFlow 2004, 4.2 (shared/stages.h) */
    KILN_INTEGRATE_RK4,            /* fourth order */
};

/* ---- systems --------------------------------------------------------------------------------- */

/* The largest number of a system: the key of the next one would be that of system 0 (random.h). */
#define KILN_MAX_SYSTEM_SEED (UINT32_MAX - 1)

/* A box in which particles die (Heinz 2019, 2.1.2). */
struct kiln_demitter {
    struct kiln_bounds box;
    struct kiln_attach attach; /* the box lies in this node */
};

struct kiln_system {
    const char *name;
    bool enabled;
    uint32_t seed; /* number of the system in shared/random.h: its place, if the scene has none */
    struct kiln_emitter emit;
    struct kiln_attach space; /* the particles move with this node */
    struct kiln_force forces[KILN_MAX_FORCES];
    uint32_t force_count;
    struct kiln_collide collide;
    struct kiln_interaction interactions[KILN_MAX_INTERACTIONS];
    uint32_t interaction_count;
    struct kiln_painting paint;
    struct kiln_demitter demitters[KILN_MAX_DEMITTERS];
    uint32_t demitter_count;
    struct kiln_bounds bounds; /* box: a particle outside dies (2.1.2) */
    struct kiln_look look;
    /* slots: the most births in any window as long as the longest life, including that of the
     * longest-lived descendants; of children: the parent's capacity times slots */
    uint32_t capacity;
};

/* ---- objects, backdrop, camera, picture ------------------------------------------------------ */

enum kiln_object_kind {
    KILN_OBJECT_BOX, /* along the axes, unless it has a rotation */
    KILN_OBJECT_SPHERE,
    KILN_OBJECT_CYLINDER, /* with flat ends */
    KILN_OBJECT_MESH,
    KILN_OBJECT_CAPSULE, /* with round caps */
    KILN_OBJECT_PLANE,   /* the half-space below it is solid */
    KILN_OBJECT_TERRAIN, /* drawn as a mesh */
    KILN_OBJECT_CONE,    /* with a flat base; its axis points to the tip */
};

/* How particles collide with a mesh. */
enum kiln_collider_kind {
    KILN_COLLIDER_FIELD,      /* with its distance field: closed, moves rigidly */
    KILN_COLLIDER_VOLUME,     /* with planes in a lattice of cells, which are made in each step */
    KILN_COLLIDER_DEPTH_MAPS, /* with all between its fronts and backs, seen from some directions */
    KILN_COLLIDER_KINDS
};

enum {
    KILN_MIN_DEPTH_RESOLUTION = 16, /* least samples along each edge of a depth map */
    KILN_MAX_DEPTH_RESOLUTION = 256,
};

enum kiln_sides {
    KILN_SIDES_ONE, /* all that is behind a plane of a volume counts as inside the mesh */
    KILN_SIDES_TWO,
};

enum kiln_gather {
    KILN_GATHER_NEAR, /* each splat visits the texels that it may reach */
    KILN_GATHER_ALL,  /* each texel visits all splats, as in the paper */
};

/* Paint on a mesh (Drone 2007, 7.6.1). */
struct kiln_object_paint {
    bool enabled;
    uint32_t size; /* texels along an edge, a power of two */
    enum kiln_gather gather;
    uint32_t per_step; /* the most particles painted in a step, in turn; 0: all */
};

/* Values have the clock constant or time. */
struct kiln_object {
    const char *name; /* NULL for an entry of a list */
    enum kiln_object_kind kind;
    struct kiln_attach attach; /* the object lies in this node; not of terrain */
    /* m; mesh: place of its file's origin; terrain: middle and lowest height, constant */
    struct kiln_value3 center;
    struct kiln_value3 color;    /* albedo */
    struct kiln_value3 size;     /* m: box, full edges; terrain, constant */
    struct kiln_value radius;    /* m: sphere, cylinder, capsule, base of a cone */
    struct kiln_value height;    /* m: along the axis; of a capsule, without its caps */
    struct kiln_value3 axis;     /* of a plane: normal; not zero, of any length */
    const char *file;            /* mesh: an absolute path; terrain: that of an image, or NULL */
    struct kiln_value3 rotation; /* rad: box, mesh: about x, then y, then z */
    struct kiln_value scale;     /* mesh: metres in one unit of the file */
    struct kiln_animation animation; /* mesh */
    /* mesh, follows: what is drawn; with texture coordinates for paint; at rest if animated */
    const struct kiln_mesh *shown;
    const struct kiln_mesh *collision_mesh; /* follows, if `collide`: without texture coordinates */
    const struct kiln_skin *skin;           /* follows, if animated */
    uint32_t samples[2];                    /* terrain, constant; also the members up to cells */
    struct kiln_value hills, roughness, ridges;
    uint32_t octaves, seed;
    uint32_t cells;                   /* mesh: cells of its collision grid along its longest edge */
    enum kiln_collider_kind collider; /* mesh, and the members up to depth_resolution */
    struct kiln_value3 heading;       /* volume: where most particles fly; not zero */
    enum kiln_sides sides;            /* volume: which sides of its planes are solid */
    /* depth maps: directions of view */
    struct kiln_value3 depth_directions[KILN_MAX_DEPTH_DIRECTIONS];
    uint32_t depth_direction_count, depth_resolution; /* (asset/geometry/papers/depth_maps.h) */
    struct kiln_object_paint paint;                   /* mesh */
    bool collide;
    bool visible;                  /* plane: drawn */
    struct kiln_value restitution; /* factors on those of the particles */
    struct kiln_value friction;
};

struct kiln_backdrop {
    bool transparent; /* true: there is neither sky nor floor, and the output has alpha */
    struct kiln_value3 sky_top, sky_horizon;
    const char *sky_image;           /* equirectangular, absolute path; NULL: gradient */
    struct kiln_value sky_rotation;  /* rad: rotation of the image about y */
    struct kiln_value sky_intensity; /* factor on the image */
    bool floor_enabled, floor_collide;
    struct kiln_value3 floor_color;
    struct kiln_value floor_height; /* m; constant if particles collide with it */
    struct kiln_value floor_restitution, floor_friction; /* factors, as of an object */
    struct kiln_value floor_checker;                     /* m: edge of the squares; 0: plain */
    const char *floor_image;       /* repeated, absolute path; NULL: the colour */
    struct kiln_value floor_tile;  /* m: width of the image */
    struct kiln_value floor_gloss; /* factor on the reflection; 0: matt */
    struct kiln_value floor_roughness;
    struct kiln_value floor_wave_height, floor_wave_length; /* m: height and length of waves */
    struct kiln_value3 sun_direction;                       /* direction towards the sun */
    struct kiln_value3 sun_color;                           /* irradiance; 0 0 0: none */
    struct kiln_value sun_size;                             /* rad: diameter; 0: hard shadows */
    struct kiln_value sun_disc;      /* radiance of the disc, in parts of color */
    struct kiln_value sun_glow;      /* that of the sky beside it */
    struct kiln_value sun_glow_size; /* rad: a third of the glow is left there */
    struct kiln_value haze;          /* 1/m: density */
    struct kiln_object objects[KILN_MAX_OBJECTS];
    uint32_t object_count;
    struct kiln_light lights[KILN_MAX_LIGHTS];
    uint32_t light_count;
};

/* Returns whether particles collide with the floor: it is visible and collides. */
static inline bool kiln_backdrop_floor_collides(const struct kiln_backdrop *backdrop)
{
    return backdrop->floor_enabled && backdrop->floor_collide;
}

/* A file that a scene was read from. */
struct kiln_scene_file {
    const char *path;
    const char *what; /* kind of file for messages: "the scene" */
    /* what fstat says of the file that was read; NULL: the path has to be asked */
    const struct stat *status;
    struct kiln_scene_file *next;
};

struct kiln_scene {
    struct kiln_handle handle;
    struct kiln_arena *arena;         /* of all but this struct */
    const char *name;                 /* name of the file, as given */
    struct kiln_scene_file *files;    /* all files that were read, except those that meshes name */
    const char *asset_root;           /* absolute folder that paths start from */
    struct kiln_mesh_library *meshes; /* owns the meshes of all objects and looks */
    struct kiln_budget *budget;       /* limits of kiln_scene_params */
    struct kiln_loader *loader;       /* opens the files below the asset root; owned by the scene */
    const struct kiln_scene_param *params; /* that the scene declares */
    size_t param_count;
    struct kiln_arena *tree_arena; /* of the tree below; NULL: no tree is kept */
    const struct kiln_node *tree;  /* what the options were read from, for their origins */

    uint32_t format_version; /* always 1 */
    uint32_t seed;
    union { /* px; an option fills both at once */
        uint32_t size[2];
        struct {
            uint32_t width, height;
        };
    };
    uint32_t pixel_samples; /* places in each pixel that are averaged */
    struct kiln_rational fps;
    uint32_t frames;

    struct kiln_rational rate; /* steps a second: fps * steps_per_frame */
    double warmup_s;           /* as written; warmup_steps is the value that is used */
    uint32_t steps_per_frame;  /* rate / fps, a whole number */
    uint32_t warmup_steps;     /* steps before frame 0, at negative clip times */
    enum kiln_integration integration;
    struct kiln_bounds bounds; /* bounds of systems without their own; copied to them */
    float dt_s;                /* 1 / rate, rounded once */

    struct kiln_scene_node nodes[KILN_MAX_NODES];
    uint32_t node_count;
    struct kiln_node_cache *node_cache; /* remembers frames; NULL: there are no nodes, or not yet */
    struct kiln_camera camera;
    struct kiln_backdrop backdrop;
    struct kiln_system systems[KILN_MAX_SYSTEMS];
    uint32_t system_count;
    struct kiln_gas_domain gas[KILN_MAX_GAS];
    uint32_t gas_count;
    struct kiln_post post;

    uint64_t samples;      /* follows: samples of grids (scene/samples.h) */
    uint64_t memory_bytes; /* that rendering on the device cpu is expected to take */
    double loading_cpu_s;  /* time of processors that loading took, without that of helpers */

    float4 *keys; /* keys: x, y, slope, integral from 0 */
    uint32_t key_count;
    /* SHA-256, in hex, of the rows of KILN_PART_HASHED (scene/parts.h), as they are printed, and of
     * the textures */
    char hash[65];
};

/* Claims the files that the scene was read from as read; errors as of kiln_claims_read. */
bool kiln_scene_claim(const struct kiln_scene *scene, struct kiln_claims *claims,
                      struct kiln_error *error);

/* Claims a scene file as read without loading it, and all files below the scene's folder that its
 * texts, or the texts of overrides ("key=value"), name. Files that cannot be read are not
 * claimed. */
bool kiln_scene_claim_file(const char *path, const char *const *overrides, size_t override_count,
                           struct kiln_claims *claims, struct kiln_error *error);

/* Prints the scene as a scene file, with every default written out, into a text that the caller
 * frees; false when memory is short. parts: bits of enum kiln_scene_part; only rows of these parts
 * are printed; 0: all rows. */
bool kiln_print_scene(const struct kiln_scene *scene, unsigned parts, struct kiln_text *text);

/* Does the same with the place of each line behind it, as kiln_scene_print_origins does. */
bool kiln_print_scene_origins(const struct kiln_scene *scene, struct kiln_text *text);

/* Returns the clip time in seconds at the end of a step. Steps count from 1; 0 is the start of the
 * run. The division is IEEE's, so every host gets the same float. */
float kiln_scene_time(const struct kiln_scene *scene, uint32_t step);

/* Returns the number of steps to run before frame `frame` is drawn. */
uint32_t kiln_scene_frame_step(const struct kiln_scene *scene, uint32_t frame);

/* Compute values on the host at a clip time, for values that are the same for all particles. Values
 * of a system may have the system's noise, others that of the scene. `system` may be
 * KILN_SYSTEM_OF_GAS(domain), for a value of a domain of gas. */
float kiln_scene_value(const struct kiln_scene *scene, const struct kiln_value *value,
                       float time_s);
struct value_clocks kiln_scene_clocks(const struct kiln_scene *scene, uint32_t system,
                                      float time_s);
float kiln_scene_system_value(const struct kiln_scene *scene, uint32_t system,
                              const struct kiln_value *value, float time_s);
float3 kiln_scene_system_value3(const struct kiln_scene *scene, uint32_t system,
                                const struct kiln_value3 *value, float time_s);
float3 kiln_scene_value3(const struct kiln_scene *scene, const struct kiln_value3 *value,
                         float time_s);

bool kiln_value3_is_constant(const struct kiln_value3 *value);

/* Returns whether both ends of a range are one value, with the same keys if it has any. */
bool kiln_range_is_one_value(const struct kiln_range *range);

/* Returns whether an object is a box that has a rotation at any time, or lies in a node. */
bool kiln_object_is_oriented_box(const struct kiln_object *object);

/* Return limits that a value never goes over, or below (kiln_value_most). */
float kiln_scene_value_max(const struct kiln_scene *scene, const struct kiln_value *value);
float kiln_scene_value_min(const struct kiln_scene *scene, const struct kiln_value *value);

/* Returns whether the scene has more keys than a uniform block holds. */
static inline bool kiln_scene_stores_keys(const struct kiln_scene *scene)
{
    return scene->key_count > KILN_BLOCK_KEYS;
}

/* Returns whether all pictures have the same view: nothing of the camera changes with time, and the
 * eye and the pixels' samples have one place. */
bool kiln_scene_view_stands(const struct kiln_scene *scene);

/* Return how many lights the flames of a domain of gas may shed on what is around, and whether the
 * domain throws shadows. */
uint32_t kiln_scene_gas_lights(const struct kiln_scene *scene, uint32_t domain);
bool kiln_scene_gas_is_smoke(const struct kiln_scene *scene, uint32_t domain);

/* Return whether the sun ever shines, whether particles or flames of gas ever emit light, whether
 * there are lamps or such light, whether there is smoke of particles or gas that throws shadows,
 * and whether there is ever haze. */
bool kiln_scene_has_sun(const struct kiln_scene *scene);
bool kiln_scene_has_firelight(const struct kiln_scene *scene);
static inline bool kiln_scene_has_lamps(const struct kiln_scene *scene)
{
    return scene->backdrop.light_count > 0 || kiln_scene_has_firelight(scene);
}
bool kiln_scene_has_smoke(const struct kiln_scene *scene);
bool kiln_scene_has_haze(const struct kiln_scene *scene);

/* Returns whether a system is smoke. Spheres are not smoke, and particles a few pixels wide
 * (points, lines) hide nothing. */
static inline bool kiln_system_is_smoke(const struct kiln_system *system)
{
    return system->enabled && system->look.blend == KILN_BLEND_ALPHA &&
           system->look.shape == KILN_SHAPE_BILLBOARD;
}

/* Returns how many lamps, and lights of fire, may be hidden by what is in their way. */
uint32_t kiln_scene_shadow_lights(const struct kiln_scene *scene);

/* Computes the columns of the rotation about x, then y, then z, by angles in radians: a mat3 of
 * base/matrix.h. */
void kiln_scene_rotation(float3 angles, float columns[3][3]);

/* Returns whether the object is drawn as a mesh. */
bool kiln_object_is_mesh(const struct kiln_object *object);

/* Return whether particles of a system paint any mesh, and whether an object takes paint. */
bool kiln_scene_paints(const struct kiln_scene *scene, uint32_t system);
bool kiln_object_takes_paint(const struct kiln_object *object);

/* Returns the parameters of a terrain; the image's path stays owned by the scene. */
struct kiln_terrain_params kiln_scene_terrain(const struct kiln_scene *scene,
                                              const struct kiln_object *terrain);
/* Returns the largest radius of a system's particles as balls, m; 0: they do not collide. */
float kiln_scene_contact_radius(const struct kiln_scene *scene, uint32_t system);

/* Return whether the particles of a system, or of any system, spin by collisions. */
bool kiln_scene_system_spins(const struct kiln_scene *scene, uint32_t system);
bool kiln_scene_spins(const struct kiln_scene *scene);

/* Returns the system's interaction of a kind, or NULL. */
const struct kiln_interaction *kiln_scene_interaction(const struct kiln_scene *scene,
                                                      uint32_t system,
                                                      enum kiln_interaction_kind kind);

/* Returns the parameters that recompute a particle from its record (shared/derived.h). */
struct kiln_derived_params kiln_scene_derived(const struct kiln_scene *scene, uint32_t system);

#endif
