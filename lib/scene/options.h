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
extern const struct kiln_option_kind kiln_force_kinds[];
extern const struct kiln_option_kind kiln_interaction_kinds[];

/* Types of options. Each comment gives an example of the value in a scene, then the field's type in
 * C. */
extern const struct kiln_option_type kiln_type_assets;       /* builtin:name, a path, or a list; */
                                                             /* const char *[], count */
extern const struct kiln_option_type kiln_type_motion;       /* a word of `choices`, or a path; */
                                                             /* const char * */
extern const struct kiln_option_type kiln_type_motion_scale; /* auto, 0.5, [0.5, -0.5]; */
                                                             /* struct kiln_motion_scale */
extern const struct kiln_option_type kiln_type_picture; /* an image's path or none; const char * */
extern const struct kiln_option_type kiln_type_mesh;    /* a mesh's path; const char * */
extern const struct kiln_option_type kiln_type_grid;    /* a wind file's path; const char * */
extern const struct kiln_option_type kiln_type_clip;    /* a clip's name or number; const char * */
extern const struct kiln_option_type kiln_type_name;    /* a system's name; const char * */
extern const struct kiln_option_type kiln_type_bursts;  /* {1 s: 100}; kiln_burst[], count */

/* Returns the origin of a scene's text: a file of that name. */
static inline struct kiln_origin kiln_scene_origin(const char *name)
{
    return (struct kiln_origin){
        .name = name, .has_lines = true, .kind = "a scene", .version = "kiln: 1"};
}

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
