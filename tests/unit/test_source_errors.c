/* Bad sources of particles, and the exact words that say where, what was found and what is
 * allowed. */
#include <stdio.h>
#include <unistd.h>

#include "support/bad_scenes.h"
#include "support/cmocka.h"
#include "support/folders.h"

#define SYSTEM(from) "kiln: 1\nsystems: {a: {emit: {from: {" from "}}}}\n"

static const struct bad meshes[] = {
    {SYSTEM("mesh: {}"),
     ":2:35: systems.a.emit.from.mesh: must have one of `file` and `object`, found neither"},
    {SYSTEM("mesh: {file: sources/quilt.obj, object: 0}"),
     ":2:35: systems.a.emit.from.mesh: must have one of `file` and `object`, found both"},
    {SYSTEM("mesh: {file: sources/line.obj}"), ":2:42: systems.a.emit.from.mesh.file: the mesh has "
                                               "no area, so no particle can be born on it"},
    {SYSTEM("mesh: {file: sources/mark.png}"),
     ":2:42: systems.a.emit.from.mesh.file: 'sources/mark.png': the name is not that of a mesh; "
     "allowed are OBJ, glTF, GLB, PLY or STL files (.obj, .gltf, .glb, .ply, .stl)"},
    {SYSTEM("mesh: {file: none.obj}"),
     ":2:42: systems.a.emit.from.mesh.file: cannot open 'none.obj': No such file or directory; a "
     "path starts at the scene's folder, or at the asset root that is given instead"},
    {SYSTEM("mesh: {object: horse}"),
     ":2:44: systems.a.emit.from.mesh.object: unknown mesh 'horse' in "
     "backdrop.objects (there are none)"},
    {SYSTEM("mesh: {file: sources/quilt.obj, on: edges}"),
     ":2:65: systems.a.emit.from.mesh.on: expected surface, vertices or volume, found 'edges'"},
    {SYSTEM("mesh: {file: sources/quilt.obj, scale: 0}"),
     ":2:68: systems.a.emit.from.mesh.scale: 0 is out of range; allowed is from 1e-06 to 1000000"},
    {SYSTEM("mesh: {file: sources/quilt.obj, outward: false, direction: [0, 0, 0]}"),
     ":2:88: systems.a.emit.from.mesh.direction: must not be [0, 0, 0]"},
};

/* Begins a scene whose backdrop has a sphere and two meshes. */
#define OBJECTS                                                                                    \
    "kiln: 1\n"                                                                                    \
    "backdrop: {objects: {ball: {sphere: {}}, card: {mesh: {file: sources/quilt.obj}},\n"          \
    "                     sheet: {mesh: {file: sources/quilt.obj}}}}\n"
#define BORN_ON(more) OBJECTS "systems: {a: {emit: {from: {mesh: {" more "}}}}}\n"

static const struct bad objects[] = {
    {BORN_ON("object: cart"), ":4:44: systems.a.emit.from.mesh.object: unknown mesh 'cart' in "
                              "backdrop.objects (did you mean 'card'?)"},
    {BORN_ON("object: horse"), ":4:44: systems.a.emit.from.mesh.object: unknown mesh 'horse' in "
                               "backdrop.objects (there are: card, sheet)"},
    {BORN_ON("object: ball"), ":4:44: systems.a.emit.from.mesh.object: must name a mesh; "
                              "backdrop.objects.ball is a sphere"},
    {BORN_ON("object: 0"), ":4:44: systems.a.emit.from.mesh.object: must name a mesh; "
                           "backdrop.objects.ball is a sphere"},
    {BORN_ON("object: 1.7"), ":4:44: systems.a.emit.from.mesh.object: unknown mesh '1.7' in "
                             "backdrop.objects (there are: card, sheet)"},
    {BORN_ON("object: 01"), ":4:44: systems.a.emit.from.mesh.object: unknown mesh '01' in "
                            "backdrop.objects (there are: card, sheet)"},
    {BORN_ON("object: 3"), ":4:44: systems.a.emit.from.mesh.object: unknown mesh '3' in "
                           "backdrop.objects (there are: card, sheet)"},
    {"kiln: 1\nbackdrop: {objects: [plane: {}, mesh: {file: sources/quilt.obj}]}\n"
     "systems: {a: {emit: {from: {mesh: {object: 0}}}}}\n",
     ":3:44: systems.a.emit.from.mesh.object: must name a mesh; backdrop.objects.0 is a plane"},
    {"kiln: 1\nbackdrop: {objects: [plane: {}, mesh: {file: sources/quilt.obj}]}\n"
     "systems: {a: {emit: {from: {mesh: {object: horse}}}}}\n",
     ":3:44: systems.a.emit.from.mesh.object: unknown mesh 'horse' in backdrop.objects (there are: "
     "1)"},
    {BORN_ON("object: 1, rotation: [0, 90 deg, 0]"),
     ":4:57: systems.a.emit.from.mesh.rotation: must be [0, 0, 0] with `object`, which has its own "
     "rotation"},
    {BORN_ON("object: card, scale: 2"),
     ":4:57: systems.a.emit.from.mesh.scale: must be 1 with `object`, which has its own scale"},
    {BORN_ON("object: card, scale: 0.5"),
     ":4:57: systems.a.emit.from.mesh.scale: must be 1 with `object`, which has its own scale"},
    {OBJECTS "nodes: {n: {}}\nsystems: {a: {emit: {attach: n, from: {mesh: {object: card}}}}}\n",
     ":5:55: systems.a.emit.from.mesh.object: must be none where the emitter is attached to a "
     "node"},
    {OBJECTS "systems: {p: {}, a: {emit: {parent: {system: p}, from: {mesh: {object: 1}}}}}\n",
     ":4:72: systems.a.emit.from.mesh.object: must be none for a system with a parent, around "
     "whose particles its own are born"},
    {"kiln: 1\nbackdrop: {objects: [mesh: {file: mutation/moving.gltf, animation: {}}]}\n"
     "systems: {a: {emit: {from: {mesh: {object: 0, on: vertices}}}}}\n",
     ":3:51: systems.a.emit.from.mesh.on: must be surface for a mesh with an animation"},
    {"kiln: 1\nbackdrop: {objects: [mesh: {file: mutation/moving.gltf, animation: {}}]}\n"
     "systems: {a: {emit: {from: {mesh: {object: 0, on: volume}}}}}\n",
     ":3:51: systems.a.emit.from.mesh.on: must be surface for a mesh with an animation"},
};

static const struct bad solids[] = {
    {SYSTEM("mesh: {file: sources/flat.obj, on: volume}"),
     ":2:42: systems.a.emit.from.mesh.file: the mesh has no volume, so no particle can be born in "
     "it"},
    {SYSTEM("mesh: {file: sources/quilt.obj, on: volume}"),
     ":2:42: systems.a.emit.from.mesh.file: 'sources/quilt.obj': the mesh is not closed, so it has "
     "no inside: 1 triangle is at the edge from 0 0 -1 to 0 1 -1, where there must be two"},
    {"kiln: 1\nsystems: {a: {emit: {from: {mesh: {file: mutation/tetrahedron.obj, on: volume}}}, "
     "look: "
     "{color: source}}}\n",
     ":2:97: systems.a.look.color: cannot be source in a volume, which has no colours"},
};

static const struct bad images[] = {
    {SYSTEM("image: {}"), ":2:36: systems.a.emit.from.image.file: must name an image file"},
    {SYSTEM("image: sources/black.png"),
     ":2:36: systems.a.emit.from.image.file: no pixel of the image counts: the image is opaque, so "
     "that pixels count by their brightness, and all of it is black"},
    {SYSTEM("image: {file: sources/black.png, threshold: 0.2}"),
     ":2:43: systems.a.emit.from.image.file: no pixel of the image counts: the image is opaque, so "
     "that pixels count by their brightness, and all of it is black"},
    {SYSTEM("image: {file: sources/clear.png, threshold: 0}"),
     ":2:43: systems.a.emit.from.image.file: no pixel of the image counts: all of it is "
     "transparent"},
    {SYSTEM("image: {file: sources/mark.png, threshold: 1}"),
     ":2:72: systems.a.emit.from.image.threshold: no pixel of the image counts more than the "
     "threshold, 1: pixels count by their alpha, which is at most 1"},
    {SYSTEM("image: {file: sources/faint.png}"),
     ":2:43: systems.a.emit.from.image.file: no pixel of the image counts more than the threshold, "
     "0.5: pixels count by their alpha, which is at most 0.4"},
    {SYSTEM("image: {file: sources/dim.png, threshold: 0.3}"),
     ":2:71: systems.a.emit.from.image.threshold: no pixel of the image counts more than the "
     "threshold, 0.3: the image is opaque, so that pixels count by their brightness, which is at "
     "most 0.2"},
    {SYSTEM("image: {file: sources/quilt.obj}"),
     ":2:43: systems.a.emit.from.image.file: 'sources/quilt.obj': the file is not an image: it "
     "starts with the bytes 23 20 41 20; allowed are PNG, JPEG, WebP, TIFF, BMP, GIF, EXR or HDR "
     "files"},
    {SYSTEM("image: {file: sources/mark.png, width: 0 m}"),
     ":2:68: systems.a.emit.from.image.width: 0 m is out of range; allowed is from 0.001 m to "
     "100000 m"},
};

static const struct bad paths[] = {
    {SYSTEM("path: {}"),
     ":2:35: systems.a.emit.from.path.points: the key is missing and must be given"},
    {SYSTEM("path: {points: [[0, 0, 0]]}"),
     ":2:44: systems.a.emit.from.path.points: found 1 point; allowed is from 2 to 1024"},
    {SYSTEM("path: {points: [[0, 0, 0], [1, 0, 0]], closed: true}"),
     ":2:44: systems.a.emit.from.path.points: a closed path has 3 points at least"},
    {SYSTEM("path: {points: [[0, 0, 0], [1, 0, 0], [0, 0, 0]], closed: true}"),
     ":2:44: systems.a.emit.from.path.points: the last point must not be the first; a closed path "
     "goes on to the first by itself"},
};

static const struct bad lines[] = {
    {SYSTEM("line: {nozzles: 4, ordered: true}"), ":2:57: systems.a.emit.from.line.ordered: must "
                                                  "be false where the line has `nozzles`, at which "
                                                  "particles are born in turn"},
};

static const struct bad colors[] = {
    {"kiln: 1\n"
     "backdrop: {objects: {card: {mesh: {file: sources/flat.obj, color: {keys: {0 s: 0, 1 s: "
     "1}}}}}}\n"
     "systems: {a: {emit: {from: {mesh: {object: card}}}, look: {color: source}}}\n",
     ":3:67: systems.a.look.color: cannot be source, since triangles of the mesh have no material, "
     "and the colour that they are drawn in, backdrop.objects.card.mesh.color, varies"},
    {"kiln: 1\n"
     "backdrop: {objects: [mesh: {file: sources/flat.obj, color: {keys: {0 s: 0, 1 s: 1}}}]}\n"
     "systems: {a: {emit: {from: {mesh: {object: 0}}}, look: {color: source}}}\n",
     ":3:64: systems.a.look.color: cannot be source, since triangles of the mesh have no material, "
     "and the colour that they are drawn in, backdrop.objects.0.mesh.color, varies"},
    {"kiln: 1\nsystems: {a: {look: {color: source}}}\n",
     ":2:29: systems.a.look.color: source needs an emit.from that is a mesh or an image"},
    {"kiln: 1\nsystems: {a: {emit: {from: {path: {points: [[0, 0, 0], [1, 0, 0]]}}}, look: "
     "{color: source}}}\n",
     ":2:85: systems.a.look.color: source needs an emit.from that is a mesh or an image"},
    {"kiln: 1\nsystems: {a: {emit: {from: {image: sources/mark.png}}, look: {color: {life: "
     "[source, "
     "1]}}}}\n",
     ":2:78: systems.a.look.color.life.0: expected [red, green, blue] or one number for grey, "
     "linear, each from 0 to 1000, or in sRGB \"#e61e28\", \"#abc\" or a name of CSS, or {keys: "
     "{time: value}}, or {life: [...]}, found 'source'"},
    {"kiln: 1\nsystems: {a: {emit: {from: {image: sources/mark.png}}, look: {color: source}, "
     "paint: "
     "{when: near}}}\n",
     ":2:70: systems.a.look.color: cannot be source, since the system paints with it"},
};

/* heap.obj: so many triangles above one another that cutting them would take gigabytes. */
static const struct bad heaps[] = {
    {SYSTEM("mesh: {file: heap.obj, on: volume}"),
     ":2:42: systems.a.emit.from.mesh.file: too many triangles of the mesh lie above one another "
     "for a volume"},
};

static void write_heap(void)
{
    FILE *out = fopen("heap.obj", "w");
    assert_non_null(out);
    for (int i = 0; i < 9000; i++) { /* a triangle and its back */
        fprintf(out, "v 0 %d 0\nv 1 %d 0\nv 0 %d 1\n", i, i, i);
        fprintf(out, "f -3 -2 -1\nf -1 -2 -3\n");
    }
    assert_int_equal(fclose(out), 0);
}

static void bad_heap(void **state)
{
    (void)state;
    write_heap();
    expect_all(heaps, 1);
}

BAD_TEST(meshes)
BAD_TEST(objects)
BAD_TEST(solids)
BAD_TEST(images)
BAD_TEST(paths)
BAD_TEST(lines)
BAD_TEST(colors)

int main(void)
{
    if (chdir(KILN_SOURCE_DIR "/tests") != 0)
        return 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_meshes),
        cmocka_unit_test(bad_objects),
        cmocka_unit_test(bad_solids),
        cmocka_unit_test_setup_teardown(bad_heap, test_enter_folder, test_leave_folder),
        cmocka_unit_test(bad_images),
        cmocka_unit_test(bad_paths),
        cmocka_unit_test(bad_lines),
        cmocka_unit_test(bad_colors),
    };
    return cmocka_run_group_tests_name("source_errors", tests, NULL, NULL);
}
