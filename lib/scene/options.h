/* Declares the option tables of a scene (options_*.c), and the types of options that only a scene
 * has. */
#ifndef KILN_SCENE_OPTIONS_H
#define KILN_SCENE_OPTIONS_H

#include "option/printer.h"
#include "option/reader.h"
#include "scene/scene.h"

extern const struct kiln_option kiln_options_root[]; /* describes the whole struct kiln_scene */
extern const struct kiln_option kiln_options_system[];
extern const struct kiln_option kiln_options_look[];
extern const struct kiln_option kiln_options_backdrop[];
extern const struct kiln_option kiln_options_post[];
extern const struct kiln_option kiln_options_node[];
extern const struct kiln_option kiln_options_gas[];
extern const struct kiln_option_kind kiln_force_kinds[];
extern const struct kiln_option_kind kiln_object_kinds[];
extern const struct kiln_option_kind kiln_interaction_kinds[];
extern const struct kiln_option *const kiln_baked_force; /* an item of the forces of a baked wind */
extern const struct kiln_option *const kiln_force_of_gas; /* an item of those of a domain of gas */

/* The structs that these tables fill (option/rows.h). */
typedef struct kiln_scene kiln_options_root_fills;
typedef struct kiln_system kiln_options_system_fills;
typedef struct kiln_look kiln_options_look_fills;
typedef struct kiln_backdrop kiln_options_backdrop_fills;
typedef struct kiln_post kiln_options_post_fills;
typedef struct kiln_scene_node kiln_options_node_fills;
typedef struct kiln_gas_domain kiln_options_gas_fills;
typedef struct kiln_force kiln_force_kinds_fills;
typedef struct kiln_object kiln_object_kinds_fills;
typedef struct kiln_interaction kiln_interaction_kinds_fills;

/* Types of options. Each comment gives an example of the value in a scene. */
extern const struct kiln_option_type kiln_type_assets;       /* builtin:name, a path, or a list */
extern const struct kiln_option_type kiln_type_motion;       /* a word of `choices`, or a path */
extern const struct kiln_option_type kiln_type_motion_scale; /* auto, 0.5, [0.5, -0.5] */
extern const struct kiln_option_type kiln_type_picture;      /* an image's path or none */
extern const struct kiln_option_type kiln_type_image;        /* the same, decoded later */
extern const struct kiln_option_type kiln_type_mesh;         /* a mesh's path */
extern const struct kiln_option_type kiln_type_gltf;         /* the path of a file with nodes */
extern const struct kiln_option_type kiln_type_grid;         /* a wind file's path */
extern const struct kiln_option_type kiln_type_clip;         /* a clip's name or number */
extern const struct kiln_option_type kiln_type_part;         /* a name, a number, or none */
extern const struct kiln_option_type kiln_type_name;         /* another system's name */
extern const struct kiln_option_type kiln_type_system;       /* a system's name */
extern const struct kiln_option_type kiln_type_domain;       /* a domain's name */
extern const struct kiln_option_type kiln_type_object;       /* an object's name or number */
extern const struct kiln_option_type kiln_type_bursts;       /* {1 s: 100}, or a list */
extern const struct kiln_option_type kiln_type_counts;       /* 20, or [20, 30] */
extern const struct kiln_option_type kiln_type_attach;       /* a node's name, or none */
extern const struct kiln_option_type kiln_type_place;        /* a vector, or {path: {...}} */
extern const struct kiln_option_type kiln_type_facing;       /* a word, or {normal: [0, 1, 0]} */
extern const struct kiln_option_type kiln_type_points;       /* [[0, 0, 0], [1, 0, 0]] */
extern const struct kiln_option_type kiln_type_demitter;     /* {min, max, attach} */
extern const struct kiln_option_type kiln_type_of;           /* forces of a baked wind */
extern const struct kiln_option_type kiln_type_forces;       /* forces of a domain of gas */
extern const struct kiln_option_type kiln_type_duration;     /* 5 s, or none */

/* The C types of their fields (option/option.h). */
typedef const char *kiln_fills_assets[];
typedef const char *kiln_fills_motion;
typedef struct kiln_motion_scale kiln_fills_motion_scale;
typedef const char *kiln_fills_picture;
typedef const char *kiln_fills_image;
typedef const char *kiln_fills_mesh;
typedef const char *kiln_fills_gltf;
typedef const char *kiln_fills_grid;
typedef const char *kiln_fills_clip;
typedef const char *kiln_fills_part;
typedef const char *kiln_fills_name;
typedef const char *kiln_fills_system;
typedef const char *kiln_fills_domain;
typedef const char *kiln_fills_object;
typedef struct kiln_look_facing kiln_fills_facing;
typedef struct kiln_attach kiln_fills_attach;
typedef struct kiln_node_position kiln_fills_place;
typedef struct kiln_path_points kiln_fills_points;
typedef struct kiln_demitter kiln_fills_demitter;
typedef struct kiln_baked_forces kiln_fills_of;
typedef struct kiln_force kiln_fills_forces[];
typedef struct kiln_burst kiln_fills_bursts[];
typedef uint32_t kiln_fills_counts[2];
typedef struct kiln_scene kiln_fills_duration; /* its frames */

/* Returns the origin of a scene's text: a file of that name. */
static inline struct kiln_origin kiln_scene_origin(const char *name)
{
    return (struct kiln_origin){
        .name = name, .has_lines = true, .kind = "a scene", .version = "kiln: 1"};
}

/* Returns the name of a force's kind in a file. */
const char *kiln_force_name(const struct kiln_force *force);

/* Returns the scene that is being read, or printed, by these tables. */
static inline struct kiln_scene *kiln_reader_scene(const struct kiln_reader *reader)
{
    return reader->target;
}

static inline const struct kiln_scene *kiln_printer_scene(const struct kiln_printer *printer)
{
    return printer->source;
}

#endif
