/* Poses skinned meshes for tests, which pose seldom enough to take memory for each pose. */
#include "support/posed.h"

#include <stddef.h>
#include <stdint.h>

#include "support/cmocka.h"

void test_pose(const struct kiln_skin *skin, uint32_t clip, float seconds, float (*vertices)[6])
{
    struct kiln_skin_scratch *scratch = kiln_skin_scratch_create(skin);
    assert_non_null(scratch);
    kiln_skin_pose(skin, scratch, clip, seconds, vertices);
    kiln_skin_scratch_destroy(&scratch);
}

void test_pose_mesh(const struct kiln_skin *skin, uint32_t clip, float seconds,
                    struct kiln_mesh *mesh)
{
    struct kiln_skin_scratch *scratch = kiln_skin_scratch_create(skin);
    assert_non_null(scratch);
    kiln_skin_pose_mesh(skin, scratch, clip, seconds, mesh);
    kiln_skin_scratch_destroy(&scratch);
}
