/* Flipbooks kept from one process to the next: making one takes longer than drawing a small frame.
 * What is kept is what drawing reads: the texels of all levels, and motion. */
#ifndef KILN_ASSET_ATLAS_FLIPBOOK_CACHE_H
#define KILN_ASSET_ATLAS_FLIPBOOK_CACHE_H

#include "asset/atlas/atlas.h"

enum { KILN_FLIPBOOK_NAME_SIZE = 80 };

/* Names the flipbook of a texture of a request by what it is made of: this build of kiln, the
 * built-in name or the contents of the file, the division into cells, and the motion. False when it
 * cannot be kept: a file cannot be read, or the build has no identifier. */
bool kiln_flipbook_name(char name[KILN_FLIPBOOK_NAME_SIZE],
                        const struct kiln_atlas_request *request, uint32_t texture);

/* The memory of a flipbook in its atlas. */
struct kiln_flipbook_texels {
    uint8_t *texels;
    size_t texel_bytes;
    int8_t *moves; /* NULL: it does not move */
    size_t move_bytes;
    float *motion; /* kiln_atlas_range.motion */
};

/* Fills the memory; false when the cache does not have the flipbook whole, and then the memory may
 * hold anything. */
bool kiln_flipbook_read(const char *cache, const char *name,
                        const struct kiln_flipbook_texels *book);
void kiln_flipbook_write(const char *cache, const char *name,
                         const struct kiln_flipbook_texels *book);

#endif
