/* Keeps flipbooks on the disk from one process to the next, since making one takes longer than
 * drawing a small frame. The files have the data that drawing reads: the texels of all levels, and
 * motion. */
#ifndef KILN_ASSET_ATLAS_FLIPBOOK_CACHE_H
#define KILN_ASSET_ATLAS_FLIPBOOK_CACHE_H

#include "asset/atlas/atlas.h"

enum { KILN_FLIPBOOK_NAME_SIZE = 80 };

/* Names the flipbook of a texture of a request by all that it is made from: this build of kiln, the
 * built-in name or the contents of the file, the division into cells, and the motion. False when it
 * cannot be cached, because a file cannot be read or the build has no identifier. */
bool kiln_flipbook_name(char name[KILN_FLIPBOOK_NAME_SIZE],
                        const struct kiln_atlas_request *request, uint32_t texture);

/* Points to the memory of a flipbook in its atlas. */
struct kiln_flipbook_texels {
    uint8_t *texels;
    size_t texel_bytes;
    int8_t *moves; /* NULL: it has no motion */
    size_t move_bytes;
    float *motion; /* the member `motion` of its kiln_atlas_range */
};

/* Fills the memory from the cache. False when the cache does not have the whole flipbook; then the
 * memory may hold anything. */
bool kiln_flipbook_read(const char *cache, const char *name,
                        const struct kiln_flipbook_texels *book);
void kiln_flipbook_write(const char *cache, const char *name,
                         const struct kiln_flipbook_texels *book);

#endif
