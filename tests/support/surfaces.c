/* Adds a collider of each kind to the scene of thrown.h, always with its top at the origin, so that
 * tests can throw the same particles at each kind. */
#include "support/surfaces.h"

#include <stdio.h>

#include "support/bodies.h"
#include "support/cmocka.h"
#include "support/thrown.h"

static struct kiln_object *add_floor(void)
{
    fixture.scene.backdrop.floor_enabled = true;
    fixture.scene.backdrop.floor_collide = true;
    return NULL;
}

static struct kiln_object *add_flat_box(void)
{
    return fixture_add_box(&fixture, 0, -1, 0, 40, 2, 40);
}

static struct kiln_object *add_oriented_box(void)
{
    struct kiln_object *box = fixture_add_box(&fixture, 0, -1, 0, 40, 2, 40);
    box->rotation.y = fixture_constant(0.7f);
    return box;
}

static struct kiln_object *add_level_plane(void)
{
    return fixture_add_plane(&fixture, 0, 0, 0);
}

static struct kiln_object *add_globe(void)
{
    return fixture_add_sphere(&fixture, 0, -5, 0, 5);
}

static struct kiln_object *add_cylinder_end(void)
{
    return fixture_add_cylinder(&fixture, 0, -1, 0, 30, 2);
}

static struct kiln_object *add_cylinder_side(void)
{
    struct kiln_object *cylinder = fixture_add_cylinder(&fixture, 0, -5, 0, 5, 40);
    cylinder->axis = fixture_constant3(0, 0, 2);
    return cylinder;
}

/* Adds a cylinder with an animated axis, so kiln treats it as an object that may turn. Only the
 * axis's length changes, so the cylinder rests. */
static struct kiln_object *add_turning_cylinder(void)
{
    struct kiln_object *cylinder = add_cylinder_side();
    cylinder->axis.z = fixture_ramp(&fixture, KILN_CLOCK_TIME, 0, 1, 1, 2);
    return cylinder;
}

static struct kiln_object *add_lying_capsule(void)
{
    struct kiln_object *capsule = fixture_add_capsule(&fixture, 0, -5, 0, 5, 40);
    capsule->axis = fixture_constant3(0, 0, 2);
    return capsule;
}

static struct kiln_object *add_cone_base(void)
{
    struct kiln_object *cone = fixture_add_cylinder(&fixture, 0, -1, 0, 30, 2);
    cone->kind = KILN_OBJECT_CONE;
    cone->axis = fixture_constant3(0, -2, 0);
    return cone;
}

/* Adds flat terrain: its heights come from a picture of one black pixel. */
static struct kiln_object *add_flat_terrain(void)
{
    static const uint8_t pixel[58] = {
        'B', 'M', 58, [10] = 54, [14] = 40, [18] = 1, [22] = 1, [26] = 1, [28] = 24};
    FILE *out = fopen("black.bmp", "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(pixel, sizeof pixel, 1, out), 1);
    fclose(out);
    struct kiln_object *terrain = fixture_add_terrain(&fixture, 0, 40, 1, 9);
    terrain->file = "black.bmp";
    return terrain;
}

/* Adds a mesh of a box, which particles hit by its signed distance field. */
static struct kiln_object *add_slab(void)
{
    body_write_box("slab.obj", 40, 2, 40);
    return fixture_add_mesh(&fixture, "slab.obj", 0, -1, 0);
}

/* Adds a mesh of a box, which particles hit by its depth maps. */
static struct kiln_object *add_mapped_slab(void)
{
    struct kiln_object *slab = add_slab();
    fixture_map_depths(slab, 32);
    return slab;
}

const struct surface surfaces[SURFACES] = {
    {"floor", add_floor, SURFACE_FLAT, false},
    {"box", add_flat_box, SURFACE_FLAT, true},
    {"turned box", add_oriented_box, SURFACE_FLAT, true},
    {"plane", add_level_plane, SURFACE_FLAT, true},
    {"sphere", add_globe, SURFACE_ROUND, true},
    {"end of a cylinder", add_cylinder_end, SURFACE_FLAT, true},
    {"side of a cylinder", add_cylinder_side, SURFACE_LYING, true},
    {"cylinder that may turn", add_turning_cylinder, SURFACE_LYING, true},
    {"capsule", add_lying_capsule, SURFACE_LYING, true},
    {"base of a cone", add_cone_base, SURFACE_FLAT, true},
    {"terrain", add_flat_terrain, SURFACE_FLAT, false},
    {"distance field", add_slab, SURFACE_FLAT, true},
    {"depth maps", add_mapped_slab, SURFACE_FLAT, true},
};
