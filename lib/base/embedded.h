/* Declares tables of text files that the build compiles into the library or the program, so that
 * neither needs a folder of its own at run time. cmake/embedded.cmake chooses the files of each
 * table and writes the tables; a new file that matches its patterns needs no change here. The
 * library has only the table of shaders. The program has the others, so only code that belongs to
 * the program, such as lib/report, lib/bench and lib/start, may use them. */
#ifndef KILN_BASE_EMBEDDED_H
#define KILN_BASE_EMBEDDED_H

struct kiln_embedded_file {
    const char *path; /* relative to the table's folder: "bench/cloud.yaml"; NULL ends the table */
    const char *text;
};

/* The files of shaders/, of which lib/gpu/source.c makes GL programs. */
extern const struct kiln_embedded_file kiln_embedded_shaders[];

/* The files of scenes/ that `kiln bench` measures (lib/bench/suite.c, lib/bench/jobs.c). */
extern const struct kiln_embedded_file kiln_embedded_scenes[];

/* The files of scenes/templates/, which `kiln new` copies (lib/start/template.c). */
extern const struct kiln_embedded_file kiln_embedded_templates[];

/* The files of lib/report/page/, of which lib/report/html.c makes report.html. */
extern const struct kiln_embedded_file kiln_embedded_page[];

/* Returns the text of the file with this path in a table, or NULL if the table has no such file. */
const char *kiln_embedded_find(const struct kiln_embedded_file *table, const char *path);

#endif
