/* Files that a scene names: picture, mesh, grid. */
#include <string.h>

#include "asset/geometry/grid_in.h"
#include "asset/image/image.h"
#include "option/printer.h"
#include "option/reader.h"
#include "scene/asset_path.h"

static bool is_none(const struct kiln_node *node)
{
    return node->kind == KILN_NODE_SCALAR && strcmp(node->text, "none") == 0;
}

static bool read_file(struct kiln_reader *reader, const struct kiln_option *option,
                      const struct kiln_node *node,
                      bool (*check)(const char *, const struct kiln_scene *, struct kiln_error *),
                      const char **file)
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
        kiln_text_add_json(&printer->text, kiln_asset_name(printer->scene, file));
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

static bool check_picture(const char *path, const struct kiln_scene *scene,
                          struct kiln_error *error)
{
    (void)scene;
    return kiln_asset_image_check(path, error);
}

static bool read_picture(struct kiln_reader *reader, const struct kiln_option *option,
                         const struct kiln_node *node, void *field)
{
    const char **picture = field;
    *picture = NULL;
    return is_none(node) || read_file(reader, option, node, check_picture, picture);
}

static void describe_picture(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "the path of an image file, from the scene's folder and inside it, or none");
}

const struct kiln_option_type kiln_type_picture = {read_picture, print_file, describe_picture,
                                                   schema_file};

/* ---- mesh ------------------------------------------------------------------------------------ */

/* What is in it is read when all is known that is wanted of it. "none" is a default that some rows
 * have. */
static bool read_mesh(struct kiln_reader *reader, const struct kiln_option *option,
                      const struct kiln_node *node, void *field)
{
    const char **file = field;
    *file = NULL;
    return (option->fallback && is_none(node)) || read_file(reader, option, node, NULL, file);
}

static void describe_mesh(const struct kiln_option *option, struct kiln_text *out)
{
    kiln_text_add(out,
                  "the path of an OBJ, glTF or GLB file, from the scene's folder and inside it%s",
                  option->fallback ? ", or none" : "");
}

const struct kiln_option_type kiln_type_mesh = {read_mesh, print_file, describe_mesh, schema_file};

/* ---- grid ------------------------------------------------------------------------------------ */

static bool check_grid(const char *path, const struct kiln_scene *scene, struct kiln_error *error)
{
    (void)scene;
    struct kiln_grid_file *grid = kiln_grid_load(path, error);
    bool good = grid != NULL;
    kiln_grid_destroy(&grid);
    return good;
}

static bool read_grid(struct kiln_reader *reader, const struct kiln_option *option,
                      const struct kiln_node *node, void *field)
{
    return read_file(reader, option, node, check_grid, field);
}

static void describe_grid(const struct kiln_option *option, struct kiln_text *out)
{
    (void)option;
    kiln_text_add(out, "the path of a kiln-grid file, from the scene's folder and inside it");
}

const struct kiln_option_type kiln_type_grid = {read_grid, print_file, describe_grid, schema_file};
