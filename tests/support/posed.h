/* Poses skinned meshes, with memory for each pose. */
#ifndef KILN_TESTS_POSED_H
#define KILN_TESTS_POSED_H

#include "asset/geometry/skin.h"

/* Compute a pose as kiln_skin_pose and kiln_skin_pose_mesh do. Lack of memory fails the test. */
void test_pose(const struct kiln_skin *skin, uint32_t clip, float seconds, float (*vertices)[6]);
void test_pose_mesh(const struct kiln_skin *skin, uint32_t clip, float seconds,
                    struct kiln_mesh *mesh);

#endif
