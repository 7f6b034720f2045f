/* Lists the kinds of shapes. Each has a file shape_KIND.h, whose first part draws it (shapes.h says
 * by which functions) and whose last part lets particles collide with it (collide_oriented.h). A
 * file that does both includes this one twice, so it has no guard; the parts have. */
#define SHAPE_KINDS_OF_DRAWING(ROW)                                                                \
    ROW(BOX, box)                                                                                  \
    ROW(CYLINDER, cylinder)                                                                        \
    ROW(CAPSULE, capsule)                                                                          \
    ROW(PLANE, plane)                                                                              \
    ROW(CONE, cone)
#define SHAPE_KINDS_OF_COLLISION(ROW)                                                              \
    ROW(ORIENTED_BOX, box)                                                                         \
    ROW(ORIENTED_CYLINDER, cylinder)                                                               \
    ROW(CAPSULE, capsule)                                                                          \
    ROW(PLANE, plane)                                                                              \
    ROW(CONE, cone)

/* All kinds have the same parameters, of which some use only a part. */
#ifndef GL_core_profile
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif

#include "shared/shape_box.h"
#include "shared/shape_capsule.h"
#include "shared/shape_cone.h"
#include "shared/shape_cylinder.h"
#include "shared/shape_plane.h"

#ifndef GL_core_profile
#pragma GCC diagnostic pop
#endif
