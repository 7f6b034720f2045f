/* Declares the description of a mesh's materials. */
#ifndef KILN_SCENE_MESH_LOOKS_H
#define KILN_SCENE_MESH_LOOKS_H

#include "asset/geometry/material.h"

/* Describes materials and colours of vertices for people: a line each, none if there are none. The
 * caller frees the text; NULL: memory is short. */
char *kiln_mesh_looks_describe(const struct kiln_mesh_looks *looks);

#endif
