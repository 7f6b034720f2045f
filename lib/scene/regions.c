/* This file checks the regions in which forces of systems and of domains of gas act. */
#include "scene/regions.h"

#include <stdio.h>

#include "scene/baked.h"

bool kiln_regions_check(struct kiln_reader *reader, const struct kiln_node *root, uint32_t owner)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    char path[128], key[160];
    const struct kiln_force *force;
    for (uint32_t i = 0; (force = kiln_owner_force(scene, owner, i)) != NULL; i++) {
        kiln_owner_force_path(scene, owner, i, path, sizeof path);
        snprintf(key, sizeof key, "%s.region", path);
        if (force->region.enabled && force->region.box == force->region.sphere)
            return kiln_reader_error_at(reader, root, key,
                                        "must have one of `box` and `sphere`, found %s",
                                        force->region.box ? "both" : "neither");
    }
    return true;
}
