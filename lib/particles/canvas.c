/* This file creates, copies and hashes the paint on a mesh: its texels and the splats that wait to
 * be painted. Both are in host memory, since the host applies paint. */
#include "particles/canvas.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "shared/state_hash.h"

static_assert(sizeof(struct kiln_splat) == 48, "hashed by its words, of which none is padding");

enum { SPLAT_WORDS = 12 };

bool kiln_canvas_init(struct kiln_canvas *canvas, uint32_t edge, uint32_t slot_count,
                      struct kiln_error *error)
{
    *canvas = (struct kiln_canvas){.edge = edge, .slot_count = slot_count};
    canvas->texels = calloc((size_t)edge * edge, sizeof *canvas->texels);
    if (slot_count > 0)
        canvas->pending = calloc(slot_count, sizeof *canvas->pending);
    if (canvas->texels && (canvas->pending || slot_count == 0))
        return true;
    kiln_error_no_memory(error, "paint of %u x %u texels", edge, edge);
    return false;
}

void kiln_canvas_finish(struct kiln_canvas *canvas)
{
    free(canvas->texels);
    free(canvas->pending);
    *canvas = (struct kiln_canvas){.edge = 0};
}

void kiln_canvas_footprint(const struct kiln_canvas_shape *shape, struct kiln_footprint *footprint)
{
    kiln_footprint_add(footprint, KILN_FOOTPRINT_OBJECTS, (uint64_t)shape->edge * shape->edge,
                       sizeof *(struct kiln_canvas){0}.texels);
    kiln_footprint_add(footprint, KILN_FOOTPRINT_PARTICLES, shape->slot_count,
                       sizeof *(struct kiln_canvas){0}.pending);
}

void kiln_canvas_copy(struct kiln_canvas *to, const struct kiln_canvas *from)
{
    assert(to->edge == from->edge && to->slot_count == from->slot_count);
    memcpy(to->texels, from->texels, (size_t)to->edge * to->edge * sizeof *to->texels);
    if (to->pending)
        memcpy(to->pending, from->pending, to->slot_count * sizeof *to->pending);
    to->next = from->next;
    /* A copy is a new version, so that it is not taken for a canvas that was drawn before. */
    to->changes = 1 + (to->changes > from->changes ? to->changes : from->changes);
}

/* Adds the hash of a texel or a splat to the state hash. */
static void add(uint32_t kind, uint32_t index, const float *words, uint32_t count,
                struct kiln_state_hash *hash)
{
    struct state_hash_lanes lanes = {kind + 0x7061696eu, kind + 0x74696e67u};
    lanes = state_hash_word(lanes, index);
    for (uint32_t i = 0; i < count; i++)
        lanes = state_hash_word(lanes, FLOAT_BITS(words[i]));
    hash->lane[0] += lanes.a;
    hash->lane[1] += lanes.b;
}

void kiln_canvas_hash(const struct kiln_canvas *canvas, uint32_t number,
                      struct kiln_state_hash *hash)
{
    const uint32_t texels = canvas->edge * canvas->edge;
    for (uint32_t i = 0; i < texels; i++) {
        if (canvas->texels[i][3] > 0.0f)
            add(2 * number, i, canvas->texels[i], 4, hash);
    }
    for (uint32_t i = 0; i < canvas->slot_count; i++) {
        float words[SPLAT_WORDS];
        memcpy(words, &canvas->pending[i], sizeof words);
        if (canvas->pending[i].opacity > 0.0f)
            add(2 * number + 1, i, words, SPLAT_WORDS, hash);
    }
}
