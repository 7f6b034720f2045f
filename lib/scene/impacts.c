/* This file checks what a scene says of impacts. `dies`, the key of older scenes, and `then` say
 * the same, so a file may have both only where they agree. */
#include "scene/impacts.h"

#include <stdio.h>

bool kiln_impacts_agree(struct kiln_reader *reader, const struct kiln_node *root,
                        const struct kiln_system *system)
{
    const struct kiln_collide *collide = &system->collide;
    const struct kiln_node *rows = kiln_node_entry(root, "systems");
    rows = rows ? kiln_node_entry(rows, system->name) : NULL;
    rows = rows ? kiln_node_entry(rows, "collide") : NULL;
    if (!rows || rows->kind != KILN_NODE_MAP)
        return true;
    const bool certain = collide->chance.count == 0 && collide->chance.constant == 1.0f;
    char path[128];
    snprintf(path, sizeof path, "systems.%s.collide.then", system->name);
    if (collide->dies && collide->then == KILN_THEN_BOUNCE && kiln_node_entry(rows, "then"))
        return kiln_reader_error_at(reader, root, path, "must not be bounce where `dies` is true");
    if (!collide->dies && collide->then == KILN_THEN_DIE && kiln_node_entry(rows, "dies"))
        return kiln_reader_error_at(reader, root, path, "must not be die where `dies` is false");
    snprintf(path, sizeof path, "systems.%s.collide.chance", system->name);
    if (!collide->dies && collide->then == KILN_THEN_BOUNCE && !certain)
        return kiln_reader_error_at(reader, root, path,
                                    "needs a `then` other than bounce, which is what particles do "
                                    "by the rest of the chance");
    return true;
}
