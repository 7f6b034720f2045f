/* The option tables of a scene (options_*.c), and the types that only a scene has. */
#ifndef KILN_SCENE_OPTIONS_H
#define KILN_SCENE_OPTIONS_H

#include "option/printer.h"
#include "option/reader.h"
#include "scene/scene.h"

extern const struct kiln_option kiln_options_root[]; /* of struct kiln_scene: all of it */
extern const struct kiln_option kiln_options_system[];
extern const struct kiln_option kiln_options_look[];
extern const struct kiln_option kiln_options_backdrop[];
extern const struct kiln_option kiln_options_post[];
extern const struct kiln_option_kind kiln_force_kinds[];
extern const struct kiln_option_kind kiln_interaction_kinds[];

/* The types; what a scene writes, and the field that it fills. */
extern const struct kiln_option_type kiln_type_assets;  /* builtin:name, a path, or a list of */
                                                        /* these; const char *[], count */
extern const struct kiln_option_type kiln_type_motion;  /* a word of `choices` or a path; */
                                                        /* const char * */
extern const struct kiln_option_type kiln_type_picture; /* an image's path or none; const char * */
extern const struct kiln_option_type kiln_type_mesh;    /* a mesh's path; const char * */
extern const struct kiln_option_type kiln_type_grid;    /* a wind's path; const char * */
extern const struct kiln_option_type kiln_type_clip;    /* a name or number; const char * */
extern const struct kiln_option_type kiln_type_name;    /* of a system; const char * */
extern const struct kiln_option_type kiln_type_bursts;  /* {1 s: 100}; kiln_burst[], count */

/* Where the text of a scene came from: a file of that name. */
static inline struct kiln_origin kiln_scene_origin(const char *name)
{
    return (struct kiln_origin){
        .name = name, .has_lines = true, .kind = "a scene", .version = "kiln: 1"};
}

/* The scene that is read, or printed, by these tables. */
static inline struct kiln_scene *kiln_reader_scene(const struct kiln_reader *reader)
{
    return reader->target;
}

static inline const struct kiln_scene *kiln_printer_scene(const struct kiln_printer *printer)
{
    return printer->source;
}

#endif
