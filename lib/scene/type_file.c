/* This file reads, prints and describes the types of options that name a file: picture, image,
 * mesh, grid. */
#include "asset/image/image.h"
#include "scene/asset_path.h"

static bool read_file(struct kiln_reader *reader, const struct kiln_option *option,
                      const struct kiln_node *node, kiln_check_file *check, const char **file)
{
    double number;
    bool is_text = node->kind == KILN_NODE_SCALAR && *node->text &&
                   (node->quoted || !kiln_text_to_double(node->text, &number));
    if (!is_text)
        return kiln_reader_mismatch(reader, option, node);
    return kiln_read_file_asset(reader, node, check, file);
}

static void print_file(struct kiln_printer *printer, const struct kiln_option *option,
                       const void *field)
{
    (void)option;
    const char *file = *(const char *const *)field;
    kiln_text_add(&printer->text, " ");
    if (file)
        kiln_print_quoted(printer, kiln_asset_name(kiln_printer_scene(printer), file));
    else
        kiln_text_add(&printer->text, "none");
    kiln_text_add(&printer->text, "\n");
}

static void schema_file(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "{\"type\": \"string\", \"pattern\": \"^(?!/).+$\"}");
}

/* ---- picture --------------------------------------------------------------------------------- */

static bool read_picture(struct kiln_reader *reader, const struct kiln_option *option,
                         const struct kiln_node *node, void *field)
{
    const char **picture = field;
    *picture = NULL;
    return kiln_node_is(node, "none") ||
           read_file(reader, option, node, kiln_asset_image_check, picture);
}

static void describe_picture(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "the path of an image file, from the scene's folder and inside it, or none");
}

static void list_picture(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "none");
}

const struct kiln_option_type kiln_type_picture = {
    .read = read_picture,
    .print = print_file,
    .describe = describe_picture,
    .schema = schema_file,
    .list_choices = list_picture,
};

/* ---- image ----------------------------------------------------------------------------------- */

/* Reads the name of an image file that is decoded when all options are read. */
static bool read_image(struct kiln_reader *reader, const struct kiln_option *option,
                       const struct kiln_node *node, void *field)
{
    const char **file = field;
    *file = NULL;
    return kiln_node_is(node, "none") || read_file(reader, option, node, NULL, file);
}

const struct kiln_option_type kiln_type_image = {
    .read = read_image,
    .print = print_file,
    .describe = describe_picture,
    .schema = schema_file,
    .list_choices = list_picture,
};

/* ---- mesh ------------------------------------------------------------------------------------ */

/* Reads the name of a mesh file; the file is imported once all options of the mesh are known.
 * "none" is the default of some rows. */
static bool read_mesh(struct kiln_reader *reader, const struct kiln_option *option,
                      const struct kiln_node *node, void *field)
{
    const char **file = field;
    *file = NULL;
    return (option->fallback && kiln_node_is(node, "none")) ||
           read_file(reader, option, node, NULL, file);
}

static void describe_mesh(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out,
                  "the path of an OBJ, glTF, GLB, PLY or STL file, from the scene's folder and "
                  "inside it%s",
                  option->fallback ? ", or none" : "");
}

const struct kiln_option_type kiln_type_mesh = {
    .read = read_mesh,
    .print = print_file,
    .describe = describe_mesh,
    .schema = schema_file,
};

/* ---- gltf: a file that has nodes ------------------------------------------------------------- */

static void describe_gltf(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out, "the path of a glTF or GLB file, from the scene's folder and inside it%s",
                  option->fallback ? ", or none" : "");
}

const struct kiln_option_type kiln_type_gltf = {
    .read = read_mesh,
    .print = print_file,
    .describe = describe_gltf,
    .schema = schema_file,
};

/* ---- grid ------------------------------------------------------------------------------------ */

/* Reads the name of a grid file; the file is loaded once all grids are counted (scene/samples.h).
 */
static bool read_grid(struct kiln_reader *reader, const struct kiln_option *option,
                      const struct kiln_node *node, void *field)
{
    return read_file(reader, option, node, NULL, field);
}

static void describe_grid(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "the path of a kiln-grid file, from the scene's folder and inside it");
}

const struct kiln_option_type kiln_type_grid = {
    .read = read_grid,
    .print = print_file,
    .describe = describe_grid,
    .schema = schema_file,
};
