/* Materials of meshes (decode/looks.c, mtl.c, gltf_material.c and lib/asset/geometry/material.c).
 * If this fails, meshes look otherwise than their files say. What is expected of the files in
 * tests/materials is what three.js reads in them (tests/materials/expect.mjs); the small texts here
 * have what the specifications say beside them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "asset/geometry/mesh_in.h"
#include "support/cmocka.h"
#include "support/errors.h"
#include "support/folders.h"

#define FOLDER KILN_SOURCE_DIR "/tests/materials/"

/* ---- describing ------------------------------------------------------------------------------ */

/* Writes a text without blanks, so that it is one word. */
static void write_word(FILE *out, const char *text)
{
    for (; *text; text++)
        fputc(*text == ' ' ? '_' : *text, out);
}

static void write_map(FILE *out, const struct kiln_mesh_looks *looks,
                      const struct kiln_material_map *map, const char *use)
{
    if (map->texture == KILN_NO_TEXTURE)
        return;
    const struct kiln_texture *texture = &looks->textures[map->texture];
    fprintf(out, "map %s ", use);
    if (*texture->file)
        write_word(out, texture->file);
    else
        fprintf(out, "bytes:%u", texture->byte_count);
    fprintf(out, " %u %u %u %u %.9g", map->uv_set, map->wrap[0], map->wrap[1], map->is_nearest,
            (double)map->strength);
    for (int i = 0; i < 6; i++)
        fprintf(out, " %.9g", (double)map->rows[i / 3][i % 3]);
    fputc('\n', out);
}

static void write_material(FILE *out, const struct kiln_mesh_looks *looks,
                           const struct kiln_material *m)
{
    static const char *const uses[] = {
        [KILN_USE_COLOR] = "color",         [KILN_USE_ALPHA] = "alpha",
        [KILN_USE_NORMAL] = "normal",       [KILN_USE_HEIGHT] = "height",
        [KILN_USE_ROUGHNESS] = "roughness", [KILN_USE_METALNESS] = "metalness",
        [KILN_USE_EMISSION] = "emission"};
    const double numbers[] = {
        (double)m->color[0],    (double)m->color[1],    (double)m->color[2],
        (double)m->alpha,       (double)m->roughness,   (double)m->metalness,
        (double)m->emission[0], (double)m->emission[1], (double)m->emission[2]};
    fputs("material ", out);
    write_word(out, m->name);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        fprintf(out, " %.9g", numbers[i]);
    if (m->alpha_mode == KILN_ALPHA_MASK)
        fprintf(out, " mask %.9g", (double)m->cutoff);
    else
        fputs(m->alpha_mode == KILN_ALPHA_BLEND ? " blend" : " opaque", out);
    fprintf(out, " %u %u\n", m->is_two_sided, m->is_unlit);
    for (int i = 0; i < KILN_MATERIAL_USES; i++)
        write_map(out, looks, &m->maps[i], uses[i]);
}

static void write_triangle(FILE *out, const struct kiln_mesh *mesh, uint32_t triangle)
{
    const struct kiln_mesh_looks *looks = mesh->looks;
    const uint16_t material = looks->of_triangles[triangle];
    fputs("triangle ", out);
    write_word(out, material == KILN_NO_MATERIAL ? "-" : looks->materials[material].name);
    for (int i = 0; i < 12; i++) {
        const uint32_t vertex = mesh->triangles[triangle][i / 4];
        fprintf(out, " %.9g", looks->colors ? (double)looks->colors[vertex][i % 4] : 1.0);
    }
    fputc('\n', out);
}

/* Describes the materials and triangles of a mesh as expect.mjs does. The caller frees the text. */
static char *describe(const struct kiln_mesh *mesh)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    for (uint32_t i = 0; i < mesh->looks->material_count; i++)
        write_material(out, mesh->looks, &mesh->looks->materials[i]);
    for (uint32_t i = 0; i < mesh->triangle_count; i++)
        write_triangle(out, mesh, i);
    fclose(out);
    return text;
}

/* Compares word for word; numbers may differ by `most`, and - is not compared. */
static void expect_words(const char *found, const char *expected, double most, const char *name)
{
    for (int number = 1;; number++) {
        found += strspn(found, " \n");
        expected += strspn(expected, " \n");
        const size_t length = strcspn(found, " \n"), wanted = strcspn(expected, " \n");
        char *end = NULL;
        const double value = strtod(expected, &end);
        const bool is_number = wanted > 0 && end == expected + wanted;
        const bool good = (wanted == 1 && *expected == '-' && length > 0) ||
                          (is_number && length > 0 && fabs(strtod(found, NULL) - value) <= most) ||
                          (!is_number && length == wanted && memcmp(found, expected, length) == 0);
        if (!good)
            fail_msg("%s: word %d is '%.*s', not '%.*s'", name, number, (int)length, found,
                     (int)wanted, expected);
        if (length == 0)
            return;
        found += length;
        expected += wanted;
    }
}

/* ---- files ----------------------------------------------------------------------------------- */

static void expect_near(float found, double expected)
{
    if (!(fabs((double)found - expected) <= 1e-6 * fmax(1, expected)))
        fail_msg("%.9g is not %.9g", (double)found, expected);
}

static struct kiln_mesh *load(const char *path)
{
    struct kiln_error error = {0};
    struct kiln_mesh *mesh = kiln_mesh_load_with_materials(NULL, path, &error);
    if (!mesh)
        fail_msg("%s", error.message);
    return mesh;
}

static void expect_file(const char *name, double most)
{
    char path[512];
    snprintf(path, sizeof path, FOLDER "%s", name);
    struct kiln_mesh *mesh = load(path);
    snprintf(path, sizeof path, FOLDER "%s.expect", name);
    char *expected = test_read_file(path), *found = describe(mesh);
    expect_words(found, expected, most, name);
    free(expected);
    free(found);
    kiln_mesh_destroy(&mesh);
}

static void materials_are_read_as_by_three_js(void **state)
{
    (void)state;
    expect_file("painted.obj", 2e-6);
    expect_file("painted.gltf", 2e-6);
    expect_file("painted.glb", 2e-6);
    expect_file("painted.ply", 0.5 / 255); /* three.js rounds its colours to bytes */
}

/* Which channels have the numbers, and where textures are laid: three.js does not tell. */
static void gltf_says_channels_and_sets(void **state)
{
    (void)state;
    struct kiln_mesh *mesh = load(FOLDER "painted.glb");
    const struct kiln_mesh_looks *looks = mesh->looks;
    const struct kiln_material_map *maps = looks->materials[1].maps;
    assert_int_equal(maps[KILN_USE_ROUGHNESS].channel, KILN_TEXEL_GREEN);
    assert_int_equal(maps[KILN_USE_METALNESS].channel, KILN_TEXEL_BLUE);
    assert_int_equal(maps[KILN_USE_ROUGHNESS].texture, maps[KILN_USE_EMISSION].texture);
    assert_int_equal(looks->texture_count, 3);
    const struct kiln_texture *picture = &looks->textures[maps[KILN_USE_NORMAL].texture];
    assert_memory_equal(looks->bytes + picture->first_byte, "\x89PNG", 4);
    assert_true(looks->textures[maps[KILN_USE_COLOR].texture].is_missing);
    assert_non_null(strstr(mesh->notes, "names the file 'my wood.png'"));
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        const float u = mesh->uvs[i][0]; /* all count from the bottom, and are parts of a number */
        assert_true(mesh->uvs[i][1] == u && looks->second_uvs[i][0] == u / 2 &&
                    looks->second_uvs[i][1] == 1 - u / 4);
    }
    kiln_mesh_destroy(&mesh);
}

/* Draco's streams have colours and both sets of texture coordinates, too (make_draco.mjs). */
static void draco_has_colors(void **state)
{
    static const uint8_t colors[3][3] = {{255, 51, 0}, {0, 102, 255}, {204, 0, 153}};
    static const float uvs[3][4] = {{0, 1, 0.5f, 1}, {1, 1, 0, 0.75f}, {0, 0, 0.125f, 0}};
    (void)state;
    struct kiln_mesh *mesh = load(FOLDER "draco.glb");
    assert_int_equal(mesh->vertex_count, 3);
    assert_int_equal(mesh->looks->material_count, 0);
    assert_int_equal(mesh->looks->of_triangles[0], KILN_NO_MATERIAL);
    for (uint32_t i = 0; i < 3; i++) {
        const uint32_t vertex = mesh->triangles[0][i];
        for (int c = 0; c < 4; c++)
            expect_near(mesh->looks->colors[vertex][c], c < 3 ? colors[i][c] / 255.0 : 1);
        assert_memory_equal(mesh->uvs[vertex], uvs[i], sizeof *mesh->uvs);
        assert_memory_equal(mesh->looks->second_uvs[vertex], uvs[i] + 2, sizeof *mesh->uvs);
    }
    kiln_mesh_destroy(&mesh);
}

/* A mesh is the same with its materials, but for vertices that are not joined any more, and its
 * hash is that of its own files. */
static void materials_change_no_mesh(void **state)
{
    static const char *const files[] = {"painted.obj", "painted.gltf", "painted.glb",
                                        "painted.ply"};
    (void)state;
    for (size_t f = 0; f < sizeof files / sizeof *files; f++) {
        char path[512];
        struct kiln_error error = {0};
        snprintf(path, sizeof path, FOLDER "%s", files[f]);
        struct kiln_mesh *mesh = load(path), *plain = kiln_mesh_load(NULL, path, &error);
        assert_non_null(plain);
        assert_null(plain->looks);
        assert_null(plain->uvs);
        assert_string_equal(plain->notes, "");
        assert_string_equal(plain->hash, mesh->hash);
        assert_int_equal(plain->triangle_count, mesh->triangle_count);
        for (uint32_t i = 0; i < 3 * mesh->triangle_count; i++)
            assert_memory_equal(plain->vertices[plain->triangles[i / 3][i % 3]],
                                mesh->vertices[mesh->triangles[i / 3][i % 3]],
                                sizeof *mesh->vertices);
        kiln_mesh_destroy(&mesh);
        kiln_mesh_destroy(&plain);
    }
}

/* ---- spellings of MTL ------------------------------------------------------------------------ */

/* Loads a triangle whose file has some lines before it, beside a file of materials. */
static struct kiln_mesh *load_painted(const char *lines, const char *materials)
{
    char text[1024];
    snprintf(text, sizeof text, "%s\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", lines);
    test_write_file("a.obj", text);
    test_write_file("a.mtl", materials);
    test_write_file("there.png", "no picture");
    return load("a.obj");
}

static struct kiln_material material_of(const char *lines)
{
    char text[2048];
    snprintf(text, sizeof text, "newmtl m\n%s\n", lines);
    struct kiln_mesh *mesh = load_painted("mtllib a.mtl\nusemtl m", text);
    assert_int_equal(mesh->looks->material_count, 1);
    assert_int_equal(mesh->looks->of_triangles[0], 0);
    const struct kiln_material material = mesh->looks->materials[0];
    kiln_mesh_destroy(&mesh);
    return material;
}

static void values_of_mtl_are_those_of_its_words(void **state)
{
    (void)state;
    expect_near(material_of("Ns 0").roughness, 1);
    expect_near(material_of("Ns 30").roughness, 0.5);             /* (2 / 32)^(1/4) */
    expect_near(material_of("Ns 510\nKs 1 1 1").roughness, 0.25); /* (2 / 512)^(1/4) */
    expect_near(material_of("Ns 510\nKs 0 0 0").roughness, 1);
    expect_near(material_of("Ns 510\nillum 1").roughness, 1);
    expect_near(material_of("Ns 510\nPr 0.75\nPm 0.5").roughness, 0.75);
    expect_near(material_of("Ns 510\nPr 0.75\nPm 0.5").metalness, 0.5);
    expect_near(material_of("").metalness, 0);
    expect_near(material_of("map_Pm there.png").metalness, 1);
    expect_near(material_of("map_Pm ../there.png").metalness, 0); /* it is left out */
    expect_near(material_of("map_Pr there.png\nNs 9").roughness, 1);
    expect_near(material_of("map_Ke there.png").emission[2], 1);
    expect_near(material_of("map_Ke there.png\nKe 0 0 0").emission[2], 0);
    expect_near(material_of("Ke 2 0 0").emission[0], 4.953846); /* ((2 + 0.055) / 1.055)^2.4 */
    expect_near(material_of("KD 1 # grey").color[2], 1);
    expect_near(material_of("Kd 1 0 # no colour").color[1], 1);
    expect_near(material_of("Kd 7 -1 nan\nKd 2 -1 0.5").color[0], 1);
    expect_near(material_of("Tr 0.75").alpha, 0.25);
    expect_near(material_of("Tr 1\nd 0.5").alpha, 0.5);
    assert_int_equal(material_of("d 1").alpha_mode, KILN_ALPHA_OPAQUE);
    assert_int_equal(material_of("d 0.5").alpha_mode, KILN_ALPHA_BLEND);
    assert_int_equal(material_of("map_d there.png").alpha_mode, KILN_ALPHA_BLEND);
}

/* Expects that a line names a texture in a file. Returns the map. */
static struct kiln_material_map expect_texture(const char *line, enum kiln_material_use use,
                                               const char *file)
{
    char text[1024];
    snprintf(text, sizeof text, "newmtl m\n%s\n", line);
    struct kiln_mesh *mesh = load_painted("mtllib a.mtl\nusemtl m", text);
    const struct kiln_material_map map = mesh->looks->materials[0].maps[use];
    if (map.texture == KILN_NO_TEXTURE)
        fail_msg("%s: no texture", line);
    assert_string_equal(mesh->looks->textures[map.texture].file, file);
    assert_int_equal(mesh->looks->textures[map.texture].is_missing, strcmp(file, "there.png") != 0);
    kiln_mesh_destroy(&mesh);
    return map;
}

static void textures_of_mtl_have_options(void **state)
{
    (void)state;
    struct kiln_material_map map = expect_texture(
        "\tmap_Kd -blendu off -cc on -mm 0 1 -texres 2 -boost 3 -t 1 1 1 -s 2 3 -o 4 there.png",
        KILN_USE_COLOR, "there.png");
    const float rows[2][3] = {{2, 0, 4}, {0, 3, 0}};
    assert_memory_equal(map.rows, rows, sizeof rows);
    expect_texture("map_kd \"my dir/a b.png\"  \r", KILN_USE_COLOR, "my dir/a b.png");
    expect_texture("map_Kd my\\dir\\.\\a  b.png", KILN_USE_COLOR, "my/dir/./a  b.png");
    expect_texture("map_Kd -x.png", KILN_USE_COLOR, "-x.png");
    expect_texture("map_Kd -o 1 2 3", KILN_USE_COLOR, "3");
    expect_texture("map_Kd there.png\nmap_Kd", KILN_USE_COLOR, "there.png");
    map = expect_texture("bump -bm -0.25 -imfchan l there.png", KILN_USE_HEIGHT, "there.png");
    expect_near(map.strength, -0.25);
    assert_int_equal(map.channel, KILN_TEXEL_LUMINANCE);
    map = expect_texture("map_d -clamp on -imfchan m there.png", KILN_USE_ALPHA, "there.png");
    assert_int_equal(map.channel, KILN_TEXEL_ALPHA);
    assert_int_equal(map.wrap[0], KILN_WRAP_CLAMP);
    assert_int_equal(map.wrap[1], KILN_WRAP_CLAMP);
    map = expect_texture("map_Pm -imfchan b -clamp off there.png", KILN_USE_METALNESS, "there.png");
    assert_int_equal(map.channel, KILN_TEXEL_BLUE);
    assert_int_equal(map.wrap[0], KILN_WRAP_REPEAT);
    expect_texture("map_Bump there.png", KILN_USE_HEIGHT, "there.png");
    expect_texture("map_Pr there.png", KILN_USE_ROUGHNESS, "there.png");
}

static void expect_note(const char *lines, const char *materials, const char *note)
{
    struct kiln_mesh *mesh = load_painted(lines, materials);
    assert_string_equal(mesh->notes, note);
    kiln_mesh_destroy(&mesh);
}

/* Files that are missing or elsewhere, and what is left out, are notes and no errors. */
static void faults_are_notes(void **state)
{
    (void)state;
    const char *const elsewhere = "is left out, since files must lie in the mesh's folder or below";
    char note[512], text[512];
    expect_note("mtllib a.mtl\nusemtl m", "newmtl m\nmap_Kd there.png", "");
    expect_note("mtllib b.mtl\nusemtl m", "",
                "the mesh file names the file 'b.mtl': the materials cannot be opened: No such "
                "file or directory");
    expect_note("mtllib ..\\a.mtl\nusemtl m", "",
                "the mesh file names the file '../a.mtl'; its files must lie in its folder or "
                "below");
    expect_note("mtllib a.mtl\nusemtl m", "newmtl M",
                "no file that the mesh names has its material 'm'");
    static const char *const paths[] = {"/etc/passwd", "../a.png", "c:/a.png", "http://there.png"};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        snprintf(text, sizeof text, "newmtl m\nmap_Kd %s\n", paths[i]);
        snprintf(note, sizeof note, "the mesh names the texture '%s'; it %s", paths[i], elsewhere);
        expect_note("mtllib a.mtl\nusemtl m", text, note);
    }
    memset(text, 'x', sizeof text);
    memcpy(text, "newmtl m\nnorm ", 14);
    text[300] = '\0';
    expect_note("mtllib a.mtl\nusemtl m", text,
                "the mesh names a texture by a path that is empty, is longer than 255 bytes or has "
                "a zero; it is left out");
    expect_note("mtllib a.mtl\nusemtl m", "\xff\xfe-m-",
                "a file of materials is text in UTF-16, and is not read; allowed are ASCII and "
                "UTF-8\nno file that the mesh names has its material 'm'");
}

static void names_of_libraries_may_have_blanks(void **state)
{
    (void)state;
    struct kiln_mesh *mesh =
        load_painted("mtllib no such.mtl a.mtl .\\a.MTL\nusemtl  m  1 ", "newmtl m  1\nPm 1");
    expect_near(mesh->looks->materials[0].metalness, 1);
    assert_string_equal(mesh->looks->materials[0].name, "m  1");
    kiln_mesh_destroy(&mesh);
}

/* ---- other spellings of glTF ----------------------------------------------------------------- */

#define TRIANGLE                                                                                   \
    "\"asset\": {\"version\": \"2.0\"}, \"buffers\": [{\"byteLength\": 36, \"uri\": "              \
    "\"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}], \"bufferViews\": "       \
    "[{\"buffer\": 0, \"byteLength\": 36}], \"accessors\": [{\"bufferView\": 0, "                  \
    "\"componentType\": "                                                                          \
    "5126, \"count\": 3, \"type\": \"VEC3\"}], \"meshes\": [{\"primitives\": [{\"attributes\": "   \
    "{\"POSITION\": 0}, \"material\": 0}]}], \"nodes\": [{\"mesh\": 0}]"

/* Loads a triangle of glTF with a material and other members of the document. */
static struct kiln_mesh *parse_gltf(const char *material, const char *others)
{
    char text[4096];
    struct kiln_error error = {0};
    snprintf(text, sizeof text, "{" TRIANGLE ", \"materials\": [{%s}]%s}", material, others);
    struct kiln_mesh *mesh = kiln_mesh_parse_with_materials(text, strlen(text), "a.gltf", &error);
    if (!mesh)
        fail_msg("%s", error.message);
    return mesh;
}

static struct kiln_material gloss_of(const char *members)
{
    char text[1024];
    snprintf(text, sizeof text, "\"extensions\": {\"KHR_materials_pbrSpecularGlossiness\": {%s}}",
             members);
    struct kiln_mesh *mesh = parse_gltf(text, "");
    const struct kiln_material material = mesh->looks->materials[0];
    kiln_mesh_destroy(&mesh);
    return material;
}

/* A surface that reflects 4 % is no metal and has its diffuse colour; one without diffuse light is
 * a metal and has its specular colour. */
static void glossiness_is_converted(void **state)
{
    (void)state;
    struct kiln_material m = gloss_of("\"diffuseFactor\": [0.5, 0.25, 0.125, 0.75], "
                                      "\"specularFactor\": [0.04, 0.04, 0.04], "
                                      "\"glossinessFactor\": 0.25");
    expect_near(m.metalness, 0);
    expect_near(m.roughness, 0.75);
    expect_near(m.alpha, 0.75);
    expect_near(m.color[0], 0.5);
    expect_near(m.color[2], 0.125);
    m = gloss_of("\"diffuseFactor\": [0, 0, 0, 1], \"specularFactor\": [1, 0.75, 0.25]");
    expect_near(m.metalness, 1);
    expect_near(m.roughness, 0);
    expect_near(m.color[0], 1);
    expect_near(m.color[1], 0.75);
    expect_near(m.color[2], 0.25);
}

/* What a file describes wrongly is left out: the mesh is read as it was before kiln read materials.
 */
static void faults_of_gltf_are_no_errors(void **state)
{
    static const struct {
        const char *material, *others, *notes;
    } cases[] = {
        {"\"name\": 7, \"pbrMetallicRoughness\": [], \"alphaMode\": 3, \"emissiveFactor\": {}", "",
         ""},
        {"\"normalTexture\": {\"index\": 9}", "", ""},
        {"\"normalTexture\": {\"index\": 0}", ", \"textures\": [{\"source\": 3}]", ""},
        {"\"normalTexture\": {\"index\": 0, \"texCoord\": 2}", ", \"textures\": [{}]",
         "a texture is left out that is laid by set 2 of texture coordinates; allowed are 0 to 1"},
        {"\"normalTexture\": {\"index\": 0}",
         ", \"textures\": [{\"source\": 0}], \"images\": [{\"uri\": \"data:image/png;base64,*\"}]",
         "a texture is left out: its data URI is broken"},
        {"\"normalTexture\": {\"index\": 0}",
         ", \"textures\": [{\"source\": 0}], \"images\": [{\"uri\": \"https://a/b.png\"}]",
         "the mesh names the texture 'https://a/b.png'; it is left out, since files must lie in "
         "the mesh's folder or below"},
        {"\"pbrMetallicRoughness\": {\"baseColorFactor\": [9, -1, \"a\"], \"metallicFactor\": "
         "1e99}",
         "", ""},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct kiln_mesh *mesh = parse_gltf(cases[i].material, cases[i].others);
        assert_int_equal(mesh->looks->texture_count, 0);
        assert_int_equal(mesh->looks->material_count, 1);
        assert_string_equal(mesh->notes, cases[i].notes);
        kiln_mesh_destroy(&mesh);
    }
}

/* ---- what a process sends that a file has taken over ----------------------------------------- */

/* Makes a triangle with a material and two textures. */
static void make_sound(struct kiln_mesh_result *result, unsigned char *bytes)
{
    struct kiln_looks_result *looks = &result->looks;
    result->vertex_count = 3;
    result->triangle_count = 1;
    looks->material_count = 1;
    looks->texture_count = 2;
    looks->byte_count = 8;
    looks->bytes = bytes;
    looks->has_uvs = looks->has_second_uvs = looks->has_colors = true;
    memset(looks->colors, 0, 3 * sizeof *looks->colors);
    memset(looks->second_uvs, 0, 3 * sizeof *looks->second_uvs);
    memset(result->uvs, 0, 3 * sizeof *result->uvs);
    looks->materials[0] = kiln_material_default();
    looks->materials[0].maps[KILN_USE_COLOR].texture = 1;
    looks->of_triangles[0] = 0;
    looks->textures[0] = (struct kiln_texture){.first_byte = 4, .byte_count = 4};
    looks->textures[1] = (struct kiln_texture){.file = "dir/a.png"};
}

static void expect_taken(const struct kiln_mesh_result *result, bool taken, int line)
{
    struct kiln_error error = {0};
    struct kiln_mesh_looks *looks = kiln_looks_take("a.obj", result, &error);
    if ((looks != NULL) != taken)
        fail_msg("line %d: %s", line, taken ? error.message : "it was taken");
    if (!taken)
        expect_error(&error, KILN_INVALID_INPUT,
                     "a.obj: the mesh is broken: the importer returned inconsistent materials");
    kiln_mesh_looks_destroy(&looks);
}

static void wrong_materials_are_refused(void **state)
{
    (void)state;
    unsigned char bytes[8] = {0};
    struct kiln_mesh_result *result = calloc(1, sizeof *result);
    assert_non_null(result);
    struct kiln_looks_result *looks = &result->looks;
    struct kiln_material *m = looks->materials;
    struct kiln_material_map *map = &m->maps[KILN_USE_NORMAL];
    struct kiln_texture *texture = looks->textures;
    make_sound(result, bytes);
    expect_taken(result, true, __LINE__);
#define REFUSED(assignment)                                                                        \
    do {                                                                                           \
        make_sound(result, bytes);                                                                 \
        assignment;                                                                                \
        expect_taken(result, false, __LINE__);                                                     \
    } while (0)
    REFUSED(memset(m->name, 'a', sizeof m->name));
    REFUSED(m->color[2] = NAN);
    REFUSED(m->color[0] = 1.5f);
    REFUSED(m->alpha = -0.5f);
    REFUSED(m->roughness = INFINITY);
    REFUSED(m->metalness = -1);
    REFUSED(m->emission[1] = 1e7f);
    REFUSED(m->cutoff = NAN);
    REFUSED(m->alpha_mode = 3);
    REFUSED(m->is_two_sided = 2);
    REFUSED(m->is_unlit = 2);
    REFUSED(map->texture = 2);
    REFUSED(map->uv_set = 2);
    REFUSED(map->channel = KILN_TEXTURE_CHANNELS);
    REFUSED(map->wrap[1] = KILN_TEXTURE_WRAPS);
    REFUSED(map->is_nearest = 2);
    REFUSED(map->is_inverse = 2);
    REFUSED(map->strength = INFINITY);
    REFUSED(map->rows[1][2] = NAN);
    REFUSED(texture[0].first_byte = 5);
    REFUSED(texture[0].first_byte = UINT32_MAX);
    REFUSED(texture[0].byte_count = 0);
    REFUSED(texture[1].byte_count = 1);
    REFUSED(texture[1].is_missing = 2);
    REFUSED(memset(texture[1].file, 'a', sizeof texture[1].file));
    REFUSED(strcpy(texture[1].file, "../a.png"));
    REFUSED(strcpy(texture[1].file, "/a.png"));
    REFUSED(strcpy(texture[1].file, "a/../../b.png"));
    REFUSED(looks->of_triangles[0] = 1);
    REFUSED(looks->colors[2][3] = 2);
    REFUSED(looks->second_uvs[2][1] = NAN);
    REFUSED(result->uvs[2][1] = INFINITY);
#undef REFUSED
    free(result);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(materials_are_read_as_by_three_js),
        cmocka_unit_test(gltf_says_channels_and_sets),
        cmocka_unit_test(draco_has_colors),
        cmocka_unit_test(materials_change_no_mesh),
        cmocka_unit_test_setup_teardown(values_of_mtl_are_those_of_its_words, test_enter_folder,
                                        test_leave_folder),
        cmocka_unit_test_setup_teardown(textures_of_mtl_have_options, test_enter_folder,
                                        test_leave_folder),
        cmocka_unit_test_setup_teardown(faults_are_notes, test_enter_folder, test_leave_folder),
        cmocka_unit_test_setup_teardown(names_of_libraries_may_have_blanks, test_enter_folder,
                                        test_leave_folder),
        cmocka_unit_test(glossiness_is_converted),
        cmocka_unit_test(faults_of_gltf_are_no_errors),
        cmocka_unit_test(wrong_materials_are_refused),
    };
    return cmocka_run_group_tests_name("materials", tests, NULL, NULL);
}
