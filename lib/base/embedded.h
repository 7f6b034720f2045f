/* Finds files of the source tree that the build has put into the library or the program, so that
 * both need no folder of their own at run time. cmake/embedded.cmake chooses the files of each
 * table and writes the tables; a new file that matches its patterns needs no change here. The
 * library has only the shaders. The other tables are in the program alone, so code of the library
 * must not use them. */
#ifndef KILN_BASE_EMBEDDED_H
#define KILN_BASE_EMBEDDED_H

struct kiln_embedded_file {
    const char *path; /* from the table's folder, "bench/cloud.yaml"; NULL ends the table */
    const char *text;
};

/* shaders/: the GL programs (gpu/source.c) */
extern const struct kiln_embedded_file kiln_embedded_shaders[];
/* scenes/: only the scenes that `kiln bench` measures (bench/suite.c, bench/jobs.c) */
extern const struct kiln_embedded_file kiln_embedded_scenes[];
/* scenes/templates/: the scenes of `kiln new` (start/template.c) */
extern const struct kiln_embedded_file kiln_embedded_templates[];
/* lib/report/page/: the parts of report.html of `kiln test` (report/html.c) */
extern const struct kiln_embedded_file kiln_embedded_page[];

/* Returns the text of the file with this path in a table, or NULL if the table has no such file. */
const char *kiln_embedded_find(const struct kiln_embedded_file *table, const char *path);

#endif
