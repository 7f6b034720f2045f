/* This file reads and writes flipbooks in the cache. A flipbook is one file there, or two if it
 * moves. The names contain the build's identifier, so that a changed program never reads what an
 * older one made. */
#include "asset/atlas/flipbook_cache.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "asset/loader/loader.h"
#include "base/build_id.h"
#include "base/cache.h"
#include "base/hash.h"
#include "base/text.h"

/* Adds the identity of a source: the name of a built-in flipbook, or the hash of the file's
 * contents. */
static bool add_source(struct kiln_text *text, const char *source, struct kiln_loader *loader)
{
    const struct kiln_loader_file file = {source, "image", "regular", SIZE_MAX};
    struct kiln_error ignored = {0};
    char hash[65];
    if (source[0] != '/') {
        kiln_text_add(text, "%s\n", source);
        return true;
    }
    if (!kiln_loader_hash(loader, &file, hash, &ignored))
        return false;
    kiln_text_add(text, "file %s\n", hash);
    return true;
}

bool kiln_flipbook_name(char name[KILN_FLIPBOOK_NAME_SIZE],
                        const struct kiln_atlas_request *request, uint32_t texture)
{
    char build[KILN_BUILD_ID_SIZE], hash[65], right[32], up[32];
    struct kiln_text text = {0};
    kiln_text_from_double(right, (double)request->motion_full[0]);
    kiln_text_from_double(up, (double)request->motion_full[1]);
    bool named = kiln_build_id(build);
    if (named)
        kiln_text_add(&text, "%s\n%u x %u, motion by %s, %s\n", build, request->columns,
                      request->rows, right, up);
    named = named && add_source(&text, request->sources[texture], request->loader) &&
            add_source(&text, request->motion, request->loader) && !text.failed;
    if (named) {
        kiln_hash_sha256(text.data, text.length, hash);
        snprintf(name, KILN_FLIPBOOK_NAME_SIZE, "%s.cells", hash);
    }
    kiln_text_free(&text);
    return named;
}

/* ---- motion ---------------------------------------------------------------------------------- */

/* Makes the name of the second file, which has the scale of the motion, then its bytes. */
static void name_motion(char motion[KILN_FLIPBOOK_NAME_SIZE], const char *name)
{
    snprintf(motion, KILN_FLIPBOOK_NAME_SIZE, "%.*s.motion", (int)strcspn(name, "."), name);
}

static bool read_motion(const char *cache, const char *name,
                        const struct kiln_flipbook_texels *book)
{
    char motion[KILN_FLIPBOOK_NAME_SIZE];
    name_motion(motion, name);
    unsigned char *bytes = kiln_cache_read(cache, motion, sizeof(float) + book->move_bytes);
    if (bytes) {
        memcpy(book->motion, bytes, sizeof(float));
        memcpy(book->moves, bytes + sizeof(float), book->move_bytes);
    }
    free(bytes);
    return bytes && isfinite(*book->motion);
}

static void write_motion(const char *cache, const char *name,
                         const struct kiln_flipbook_texels *book)
{
    char motion[KILN_FLIPBOOK_NAME_SIZE];
    name_motion(motion, name);
    unsigned char *bytes = malloc(sizeof(float) + book->move_bytes);
    if (!bytes)
        return;
    memcpy(bytes, book->motion, sizeof(float));
    memcpy(bytes + sizeof(float), book->moves, book->move_bytes);
    kiln_cache_write(cache, motion, bytes, sizeof(float) + book->move_bytes);
    free(bytes);
}

/* ---- flipbooks ------------------------------------------------------------------------------- */

bool kiln_flipbook_read(const char *cache, const char *name,
                        const struct kiln_flipbook_texels *book)
{
    return kiln_cache_read_into(cache, name, book->texels, book->texel_bytes) &&
           (!book->moves || read_motion(cache, name, book));
}

void kiln_flipbook_write(const char *cache, const char *name,
                         const struct kiln_flipbook_texels *book)
{
    if (book->moves)
        write_motion(cache, name, book);
    kiln_cache_write(cache, name, book->texels, book->texel_bytes);
}
