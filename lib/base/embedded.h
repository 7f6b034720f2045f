/* Finds files of the tree that the build put into the library (cmake/embedded.cmake). */
#ifndef KILN_BASE_EMBEDDED_H
#define KILN_BASE_EMBEDDED_H

struct kiln_embedded_file {
    const char *path; /* under the table's folder; NULL ends the table */
    const char *text;
};

extern const struct kiln_embedded_file kiln_embedded_shaders[];   /* shaders/ */
extern const struct kiln_embedded_file kiln_embedded_scenes[];    /* scenes/, what is measured */
extern const struct kiln_embedded_file kiln_embedded_templates[]; /* scenes/templates/ */
extern const struct kiln_embedded_file kiln_embedded_page[];      /* lib/report/page/ */

/* Returns the text of the file of that path, or NULL. */
const char *kiln_embedded_find(const struct kiln_embedded_file *table, const char *path);

#endif
