/* This file makes the sources of a scene when it is read, and says what is wrong with them. Files
 * are decoded by kiln-decode, whose counts are checked where its answers are received
 * (asset/geometry/mesh_in.c, asset/image/received.c); this file computes all else from the checked
 * arrays. */
#include "scene/source.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "asset/geometry/closed.h"
#include "base/budget.h"
#include "base/error.h"
#include "base/hash.h"
#include "scene/asset_path.h"
#include "scene/options.h"
#include "scene/source_image.h"
#include "scene/source_mesh.h"
#include "scene/source_path.h"

/* A system, or a source of gas, whose source is made. */
struct making {
    struct kiln_reader *reader;
    const struct kiln_node *root;
    struct kiln_scene *scene;
    struct kiln_emitter *emit;
    const struct kiln_system *system; /* NULL: of a source of gas */
    bool wants_color;                 /* look.color is `source` */
    struct kiln_source *source;
    char path[128]; /* of the kind of `from`, for errors */
};

static bool refuse(const struct making *m, const char *key, const char *text)
{
    char path[192];
    snprintf(path, sizeof path, "%s%s%s", m->path, *key ? "." : "", key);
    return kiln_reader_error_at(m->reader, m->root, path, "%s", text);
}

/* Returns the key that names the mesh. */
static const char *mesh_key(const struct making *m)
{
    return m->emit->source.object ? "object" : "file";
}

/* ---- meshes ---------------------------------------------------------------------------------- */

/* An object as a scene names it: by its name, or by its number from 0 where it has none. */
struct label {
    char number[12];
    const char *text;
};

static void label_object(const struct kiln_backdrop *backdrop, uint32_t i, struct label *label)
{
    const char *name = backdrop->objects[i].name;
    snprintf(label->number, sizeof label->number, "%" PRIu32, i);
    label->text = name ? name : label->number;
}

static const char *kind_of(const struct kiln_object *object)
{
    const struct kiln_option_kind *kind = kiln_object_kinds;
    while (kind->value != (int)object->kind)
        kind++;
    return kind->name;
}

static bool refuse_unknown_object(const struct making *m)
{
    const struct kiln_backdrop *backdrop = &m->scene->backdrop;
    const char *object = m->emit->source.object;
    struct label labels[KILN_MAX_OBJECTS];
    const char *names[KILN_MAX_OBJECTS];
    uint32_t count = 0;
    char suggestion[512], quoted[64], text[640];
    for (uint32_t i = 0; i < backdrop->object_count; i++) {
        if (backdrop->objects[i].kind != KILN_OBJECT_MESH)
            continue;
        label_object(backdrop, i, &labels[count]);
        names[count] = labels[count].text;
        count++;
    }
    kiln_option_suggest(suggestion, sizeof suggestion, object, names, count);
    kiln_node_quote(quoted, object);
    snprintf(text, sizeof text, "unknown mesh '%s' in backdrop.objects%s", quoted, suggestion);
    return refuse(m, "object", text);
}

/* Refuses what a source of an object cannot have besides. */
static bool check_object(const struct making *m, uint32_t number)
{
    const struct kiln_backdrop *backdrop = &m->scene->backdrop;
    const struct kiln_object *object = &backdrop->objects[number];
    const struct kiln_emit_source *from = &m->emit->source;
    const struct kiln_value3 *angles = &from->rotation;
    struct label label;
    char text[256];
    label_object(backdrop, number, &label);
    snprintf(text, sizeof text, "must name a mesh; backdrop.objects.%.100s is a %s", label.text,
             kind_of(object));
    if (object->kind != KILN_OBJECT_MESH)
        return refuse(m, "object", text);
    if (angles->x.constant != 0.0f || angles->y.constant != 0.0f || angles->z.constant != 0.0f)
        return refuse(m, "rotation", "must be [0, 0, 0] with `object`, which has its own rotation");
    if (from->scale < 1 || from->scale > 1)
        return refuse(m, "scale", "must be 1 with `object`, which has its own scale");
    if (object->animation.enabled && from->on != KILN_ON_SURFACE)
        return refuse(m, "on", "must be surface for a mesh with an animation");
    if (m->emit->parent.enabled)
        return refuse(m, "object",
                      "must be none for a system with a parent, around whose "
                      "particles its own are born");
    if (m->emit->attach.name)
        return refuse(m, "object",
                      !m->system ? "must be none where the source is attached to a node"
                                 : "must be none where the emitter is attached to a node");
    return true;
}

/* Finds the object that a source names: by its name, or by its number from 0. */
static bool find_object(struct making *m)
{
    const struct kiln_backdrop *backdrop = &m->scene->backdrop;
    struct kiln_emit_source *from = &m->emit->source;
    struct label label;
    uint32_t found = backdrop->object_count;
    for (uint32_t i = 0; i < backdrop->object_count; i++) {
        const char *name = backdrop->objects[i].name;
        found = name && strcmp(name, from->object) == 0 ? i : found;
    }
    for (uint32_t i = 0; i < backdrop->object_count && found == backdrop->object_count; i++) {
        label_object(backdrop, i, &label);
        found = strcmp(label.number, from->object) == 0 ? i : found;
    }
    if (found == backdrop->object_count)
        return refuse_unknown_object(m);
    from->of_object = true;
    from->number = found;
    return check_object(m, found);
}

static bool fill_volume(struct making *m, const struct kiln_mesh *mesh, const float rotation[3][3],
                        float scale, const char *file)
{
    struct kiln_emit_source *from = &m->emit->source;
    struct kiln_error error = {0};
    char path[192];
    snprintf(path, sizeof path, "%s.%s", m->path, mesh_key(m));
    if (!kiln_mesh_check_closed(mesh, file, &error))
        return kiln_asset_fail(m->reader, m->root, path, file, &error);
    bool fits = true;
    if (!kiln_source_fill_volume(m->scene->arena, mesh, rotation, scale, m->source, &from->edge,
                                 &fits))
        return fits ? kiln_reader_out_of_memory(m->reader)
                    : refuse(m, mesh_key(m),
                             "too many triangles of the mesh lie above one another for a volume");
    return m->source->cells > 0 ||
           refuse(m, mesh_key(m),
                  !m->system ? "the mesh has no volume, so it is no source of gas"
                             : "the mesh has no volume, so no particle can be born in it");
}

/* Fills the colours of a mesh. Where it has none, it has the colour that its object is drawn in; a
 * mesh of a file is white there. */
static bool color_mesh(struct making *m, const struct kiln_mesh *mesh,
                       const struct kiln_mesh *looks, const char *file)
{
    const struct kiln_backdrop *backdrop = &m->scene->backdrop;
    const struct kiln_emit_source *from = &m->emit->source;
    float plain[3] = {1.0f, 1.0f, 1.0f};
    struct kiln_error error = {0};
    char path[192];
    if (looks->triangle_count != mesh->triangle_count)
        return refuse(m, "object",
                      "the mesh has other triangles with its animation than without, "
                      "so it has no colours for look.color");
    if (from->of_object && kiln_source_is_plain(looks)) {
        const struct kiln_value3 *color = &backdrop->objects[from->number].color;
        struct label label;
        label_object(backdrop, from->number, &label);
        snprintf(path, sizeof path, "systems.%s.look.color", m->system->name);
        if (!kiln_value3_is_constant(color))
            return kiln_reader_error_at(
                m->reader, m->root, path,
                "cannot be source, since triangles of the mesh have no material, and the colour "
                "that they are drawn in, backdrop.objects.%s.mesh.color, varies",
                label.text);
        plain[0] = color->x.constant;
        plain[1] = color->y.constant;
        plain[2] = color->z.constant;
    }
    snprintf(path, sizeof path, "%s.%s", m->path, mesh_key(m));
    return kiln_source_color_mesh(m->scene, looks, file, from->on, plain, m->source, &error) ||
           kiln_asset_fail(m->reader, m->root, path, file, &error);
}

/* Fills the cells of a mesh. looks: the same mesh with its materials; `mesh` is another one where
 * it has an animation. */
static bool fill_mesh(struct making *m, const struct kiln_mesh *mesh, const struct kiln_mesh *looks,
                      const char *file)
{
    const struct kiln_emit_source *from = &m->emit->source;
    const struct kiln_value3 *angles = &from->rotation;
    const float3 none = {0.0f, 0.0f, 0.0f};
    const float3 turned = {angles->x.constant, angles->y.constant, angles->z.constant};
    const float scale = from->of_object ? 1.0f : (float)from->scale;
    float rotation[3][3];
    bool has_area = true;
    kiln_scene_rotation(from->of_object ? none : turned, rotation);
    if (from->on == KILN_ON_VOLUME)
        return fill_volume(m, mesh, (const float(*)[3])rotation, scale, file);
    if (!kiln_source_fill_mesh(m->scene->arena, mesh, from->on, (const float(*)[3])rotation, scale,
                               mesh != looks, m->source, &has_area))
        return has_area
                   ? kiln_reader_out_of_memory(m->reader)
                   : refuse(m, mesh_key(m),
                            !m->system ? "the mesh has no area, so it is no source of gas"
                                       : "the mesh has no area, so no particle can be born on it");
    return !m->wants_color || color_mesh(m, mesh, looks, file);
}

static bool settle_mesh(struct making *m)
{
    struct kiln_emit_source *from = &m->emit->source;
    if (from->file && from->object)
        return refuse(m, "", "must have one of `file` and `object`, found both");
    if (!from->file && !from->object)
        return refuse(m, "", "must have one of `file` and `object`, found neither");
    if (from->object && !find_object(m))
        return false;
    const char *file = from->object ? m->scene->backdrop.objects[from->number].file : from->file;
    struct kiln_error error = {0};
    struct kiln_mesh *mesh = kiln_mesh_load_with_materials(m->scene->loader, file, &error);
    bool ok = mesh && kiln_budget_take(kiln_loader_budget(m->scene->loader), KILN_LIMIT_triangles,
                                       mesh->triangle_count, file, &error);
    if (!ok) {
        char path[192];
        snprintf(path, sizeof path, "%s.%s", m->path, mesh_key(m));
        kiln_asset_fail(m->reader, m->root, path, file, &error);
    }
    const struct kiln_object *object =
        from->of_object ? &m->scene->backdrop.objects[from->number] : NULL;
    const bool posed = object && object->animation.enabled;
    ok = ok && fill_mesh(m, posed ? object->shown : mesh, mesh, file);
    if (ok)
        m->source->making += kiln_mesh_bytes(mesh);
    kiln_mesh_destroy(&mesh);
    return ok;
}

/* ---- images ---------------------------------------------------------------------------------- */

/* Returns whether the scene has a key of the source, so that its value is not the default one. */
static bool is_written(const struct making *m, const char *key)
{
    const char *const way[] = {"systems", m->system ? m->system->name : "", "emit", "from", "image",
                               key};
    const struct kiln_node *node = m->root;
    for (size_t i = 0; node && i < sizeof way / sizeof *way; i++)
        node = kiln_node_entry(node, way[i]);
    return node != NULL;
}

/* Refuses an image of which no pixel counts more than the threshold. */
static bool refuse_dark_image(const struct making *m, const struct kiln_pixel_counts *counts)
{
    char text[256];
    if (!(counts->most > 0))
        return refuse(m, "file",
                      counts->by_alpha
                          ? "no pixel of the image counts: all of it is transparent"
                          : "no pixel of the image counts: the image is opaque, so that "
                            "pixels count by their brightness, and all of it is black");
    snprintf(text, sizeof text,
             "no pixel of the image counts more than the threshold, %g: %s, which is at most %.6g",
             m->emit->source.threshold,
             counts->by_alpha ? "pixels count by their alpha"
                              : "the image is opaque, so that pixels count by their brightness",
             counts->most);
    return refuse(m, is_written(m, "threshold") ? "threshold" : "file", text);
}

static bool settle_image(struct making *m)
{
    struct kiln_emit_source *from = &m->emit->source;
    struct kiln_error error = {0};
    char path[192], text[160];
    if (!from->file)
        return refuse(m, "file", "must name an image file");
    struct kiln_asset_image *image = kiln_asset_image_load(m->scene->loader, from->file, &error);
    snprintf(path, sizeof path, "%s.file", m->path);
    if (!image)
        return kiln_asset_fail(m->reader, m->root, path, from->file, &error);
    const struct kiln_pixel_counts counts = kiln_source_count_pixels(image, from->threshold);
    const uint32_t count = counts.above;
    bool ok = count > 0 && count <= KILN_MAX_SOURCE_CELLS;
    if (count == 0)
        refuse_dark_image(m, &counts);
    snprintf(text, sizeof text,
             "%" PRIu32 " pixels of the image are above the threshold; a scene has at most %d",
             count, KILN_MAX_SOURCE_CELLS);
    if (count > KILN_MAX_SOURCE_CELLS)
        refuse(m, "file", text);
    from->edge = (float)(from->width / image->width);
    if (ok && !kiln_source_fill_image(m->scene->arena, image, from->threshold, from->width,
                                      m->wants_color, count, m->source))
        ok = kiln_reader_out_of_memory(m->reader);
    kiln_asset_image_destroy(&image);
    return ok;
}

/* ---- paths ----------------------------------------------------------------------------------- */

static bool settle_path(struct making *m)
{
    struct kiln_path *curve = &m->emit->source.path;
    const uint32_t count = curve->points.count;
    if (curve->closed && count < 3)
        return refuse(m, "points", "a closed path has 3 points at least");
    if (curve->closed &&
        memcmp(curve->points.at[0], curve->points.at[count - 1], sizeof *curve->points.at) == 0)
        return refuse(m, "points",
                      "the last point must not be the first; a closed path goes on to the first by "
                      "itself");
    return kiln_source_fill_path(m->scene->arena, curve, m->source) ||
           kiln_reader_out_of_memory(m->reader);
}

/* ---- all sources ----------------------------------------------------------------------------- */

static const char *name_of(enum kiln_emitter_shape shape)
{
    switch (shape) {
    case KILN_EMITTER_MESH:
        return "mesh";
    case KILN_EMITTER_IMAGE:
        return "image";
    case KILN_EMITTER_PATH:
        return "path";
    default:
        return NULL;
    }
}

/* Checks a look whose colours are those of the source. */
static bool check_color(const struct making *m, const char *name)
{
    const struct kiln_emitter *emit = m->emit;
    const struct kiln_system *system = m->system;
    char path[128];
    snprintf(path, sizeof path, "systems.%s.look.color", system->name);
    if (!name || emit->shape == KILN_EMITTER_PATH)
        return kiln_reader_error_at(m->reader, m->root, path,
                                    "source needs an emit.from that is a mesh or an image");
    if (emit->shape == KILN_EMITTER_MESH && emit->source.on == KILN_ON_VOLUME)
        return kiln_reader_error_at(m->reader, m->root, path,
                                    "cannot be source in a volume, which has no colours");
    return !system->paint.enabled ||
           kiln_reader_error_at(m->reader, m->root, path,
                                "cannot be source, since the system paints with it");
}

/* Makes the source of an emitter whose shape has this name, at a path. */
static bool settle(struct making *m, const char *name, const char *path)
{
    struct kiln_emitter *emit = m->emit;
    snprintf(m->path, sizeof m->path, "%s.from.%s", path, name);
    m->source = kiln_arena_alloc(m->scene->arena, 1, sizeof *m->source);
    if (!m->source)
        return kiln_reader_out_of_memory(m->reader);
    emit->source.made = m->source;
    if (emit->shape == KILN_EMITTER_MESH)
        return settle_mesh(m);
    return emit->shape == KILN_EMITTER_IMAGE ? settle_image(m) : settle_path(m);
}

/* Counts the cells of all sources made so far. */
struct total {
    uint64_t cells;
    uint32_t texels;
};

static bool add(const struct making *m, struct total *total)
{
    total->cells += m->source->cells;
    m->source->first_texel = total->texels;
    total->texels += m->source->texel_count;
    return total->cells <= KILN_MAX_SOURCE_CELLS ||
           kiln_reader_error_at(m->reader, m->root, m->path,
                                "triangles, vertices and pixels that particles are born on "
                                "are %" PRIu64 " altogether; a scene has at most %d",
                                total->cells, KILN_MAX_SOURCE_CELLS);
}

static bool settle_system(struct kiln_reader *reader, const struct kiln_node *root,
                          struct kiln_system *system, struct total *total)
{
    struct making m = {.reader = reader,
                       .root = root,
                       .scene = kiln_reader_scene(reader),
                       .emit = &system->emit,
                       .system = system,
                       .wants_color = kiln_look_color_is_source(&system->look)};
    const char *name = name_of(m.emit->shape);
    char path[128];
    snprintf(path, sizeof path, "systems.%s.emit.from.line.ordered", system->name);
    if (m.emit->shape == KILN_EMITTER_LINE && m.emit->ordered && m.emit->nozzles > 0)
        return kiln_reader_error_at(reader, root, path,
                                    "must be false where the line has `nozzles`, at which "
                                    "particles are born in turn");
    if (m.wants_color && !check_color(&m, name))
        return false;
    snprintf(path, sizeof path, "systems.%s.emit", system->name);
    return !name || (settle(&m, name, path) && add(&m, total));
}

static bool settle_gas(struct kiln_reader *reader, const struct kiln_node *root,
                       struct kiln_gas_domain *domain, struct total *total)
{
    bool ok = true;
    for (uint32_t i = 0; ok && i < domain->source_count; i++) {
        struct making m = {.reader = reader,
                           .root = root,
                           .scene = kiln_reader_scene(reader),
                           .emit = &domain->sources[i].emit};
        const char *name = name_of(m.emit->shape);
        char path[128];
        snprintf(path, sizeof path, "gas.%s.sources.%u", domain->name, i);
        ok = !name || (settle(&m, name, path) && add(&m, total));
    }
    return ok;
}

bool kiln_sources_settle(struct kiln_reader *reader, const struct kiln_node *root)
{
    struct kiln_scene *scene = kiln_reader_scene(reader);
    struct total total = {.cells = 0};
    bool ok = true;
    for (uint32_t i = 0; ok && i < scene->system_count; i++)
        ok = !scene->systems[i].enabled || settle_system(reader, root, &scene->systems[i], &total);
    for (uint32_t i = 0; ok && i < scene->gas_count; i++)
        ok = !scene->gas[i].enabled || settle_gas(reader, root, &scene->gas[i], &total);
    return ok;
}

/* Returns emitter number i: those of the systems, then those of the sources of gas; NULL: there are
 * fewer. */
static const struct kiln_emitter *emitter_at(const struct kiln_scene *scene, uint32_t i)
{
    if (i < scene->system_count)
        return &scene->systems[i].emit;
    i -= scene->system_count;
    for (uint32_t k = 0; k < scene->gas_count; k++) {
        if (i < scene->gas[k].source_count)
            return &scene->gas[k].sources[i].emit;
        i -= scene->gas[k].source_count;
    }
    return NULL;
}

bool kiln_sources_add_hashes(const struct kiln_scene *scene, bool motion, struct kiln_text *text,
                             struct kiln_error *error)
{
    const struct kiln_emitter *emit;
    for (uint32_t i = 0; (emit = emitter_at(scene, i)) != NULL; i++) {
        const struct kiln_emit_source *from = &emit->source;
        const struct kiln_source *source = from->made;
        char hex[65];
        if (!source)
            continue;
        if (*source->hash)
            kiln_text_add(text, "%s read %d\n", source->hash, KILN_MESH_READER_VERSION);
        else if (from->file && !kiln_asset_add_hash(scene, from->file, text, error))
            return false;
        if (motion || !source->texels)
            continue;
        kiln_hash_sha256(source->texels, source->texel_count * sizeof *source->texels, hex);
        kiln_text_add(text, "%s\n", hex);
    }
    return true;
}

bool kiln_object_is_source(const struct kiln_scene *scene, const struct kiln_object *object)
{
    const struct kiln_emitter *emit;
    bool found = false;
    for (uint32_t i = 0; (emit = emitter_at(scene, i)) != NULL; i++) {
        const struct kiln_emit_source *from = &emit->source;
        found = found || (from->of_object && object == &scene->backdrop.objects[from->number]);
    }
    return found;
}

struct kiln_sources_sizes kiln_sources_sizes(const struct kiln_scene *scene)
{
    struct kiln_sources_sizes sizes = {.words = 0};
    for (uint32_t i = 0; i < scene->system_count; i++) {
        const struct kiln_source *source = scene->systems[i].emit.source.made;
        if (!source)
            continue;
        sizes.words += source->word_count;
        sizes.texels += source->texel_count;
        sizes.making = source->making > sizes.making ? source->making : sizes.making;
    }
    for (uint32_t i = 0; i < scene->gas_count; i++) {
        for (uint32_t k = 0; k < scene->gas[i].source_count; k++) {
            const struct kiln_source *source = scene->gas[i].sources[k].emit.source.made;
            sizes.gas_words += source ? source->word_count : 0;
            sizes.making = source && source->making > sizes.making ? source->making : sizes.making;
        }
    }
    return sizes;
}
