/* Declares the sources of particles that are more than a shape: the triangles or vertices of a
 * mesh, the pixels of an image, and paths. A source is made when the scene is read. Steps look up
 * its words, and drawing its colours; shared/source.h says how a cell of it is chosen. */
#ifndef KILN_SCENE_SOURCE_H
#define KILN_SCENE_SOURCE_H

#include "option/reader.h"
#include "scene/scene.h"

/* The most cells of all sources of a scene: triangles, vertices and pixels. */
enum { KILN_MAX_SOURCE_CELLS = 1 << 21 };

struct kiln_source {
    uint32_t cells;         /* to choose from */
    uint32_t words_of_cell; /* of a mesh */
    uint32_t word_count;
    float4 *words;
    /* Texels of the colours, if look.color is `source`: one for each cell, which has the bits of
     * the share, the other cell, the first of its colours, and their rows; then the colours, four
     * in a texel. */
    uint32_t texel_count;
    uint4 *texels;
    uint32_t first_texel;   /* among those of all systems */
    uint32_t (*corners)[3]; /* vertices of the triangles, if the mesh has an animation */
    char hash[65];          /* of the mesh, or of its colours; "": an image or a path */
    uint64_t making;        /* bytes that making it took, beside what it has and pictures */
};

/* Makes the sources of all enabled systems. The backdrop and the nodes must be settled. */
bool kiln_sources_settle(struct kiln_reader *reader, const struct kiln_node *root);

/* Appends what the hash of a scene, or of its motion alone, has of the files of sources. */
bool kiln_sources_add_hashes(const struct kiln_scene *scene, bool motion, struct kiln_text *text,
                             struct kiln_error *error);

/* Returns whether particles are born on an object of the backdrop, or gas comes from it. */
bool kiln_object_is_source(const struct kiln_scene *scene, const struct kiln_object *object);

/* The sizes of all sources of a scene. */
struct kiln_sources_sizes {
    uint64_t words;     /* of the sources of particles */
    uint64_t texels;    /* of their colours */
    uint64_t gas_words; /* of the sources of gas */
    uint64_t making;    /* the most bytes that making one of them took */
};
struct kiln_sources_sizes kiln_sources_sizes(const struct kiln_scene *scene);

/* Returns the colour of the place where a particle was born, linear. */
float3 kiln_source_color(const struct kiln_source *source, uint32_t stream);

#endif
