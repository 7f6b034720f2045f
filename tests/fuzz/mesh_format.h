/* Guesses the format of a mesh from its first bytes, as an input of a fuzz target has no name. */
#ifndef KILN_FUZZ_MESH_FORMAT_H
#define KILN_FUZZ_MESH_FORMAT_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "asset/loader/protocol.h"

/* Takes text that begins with no word of another format for an OBJ, and the rest for an STL. */
static inline enum kiln_mesh_format guess_format(const uint8_t *data, size_t size)
{
    if (size == 0 || data[0] == 'g')
        return KILN_MESH_GLB;
    if (data[0] == '{')
        return KILN_MESH_GLTF;
    if (size >= 3 && memcmp(data, "ply", 3) == 0)
        return KILN_MESH_PLY;
    if (size >= 5 && memcmp(data, "solid", 5) == 0)
        return KILN_MESH_STL;
    return memchr(data, 0, size) ? KILN_MESH_STL : KILN_MESH_OBJ;
}

#endif
