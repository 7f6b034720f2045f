/* This file settles the domains of gas of a scene: it computes their grids, replaces `auto`, finds
 * systems and domains by their names, and says what is wrong with them, or in vain. */
#include "scene/gas_settle.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scene/family.h"
#include "scene/gas_shape.h"
#include "scene/regions.h"

enum { DEFAULT_CELLS = 128 };

/* A domain that is settled. */
struct settling {
    struct kiln_reader *reader;
    const struct kiln_node *root;
    struct kiln_scene *scene;
    struct kiln_gas_domain *domain;
};

/* Writes the path of a key of the domain. */
static void path_of(const struct settling *s, const char *key, char path[160])
{
    snprintf(path, 160, "gas.%s.%s", s->domain->name, key);
}

static bool refuse(const struct settling *s, const char *key, const char *text)
{
    char path[160];
    path_of(s, key, path);
    return kiln_reader_error_at(s->reader, s->root, path, "%s", text);
}

/* ---- the grid -------------------------------------------------------------------------------- */

/* Lets a box without a centre stand on y = 0. */
static void settle_center(struct kiln_gas_domain *domain)
{
    struct kiln_value3 *center = &domain->center;
    if (isnan(center->x.constant))
        *center = (struct kiln_value3){.y = {.constant = 0.5f * domain->size.y.constant}};
}

static bool refuse_edge(const struct settling *s, const double cells[3])
{
    char path[160];
    path_of(s, "cell", path);
    const double bytes = kiln_gas_bytes_of(&s->domain->shape, cells[0] * cells[1] * cells[2]);
    return kiln_reader_error_at(
        s->reader, s->root, path,
        "the domain has %.0f x %.0f x %.0f cells, which take up to %.1f GiB where gas fills it; an "
        "edge has at most %d: make the cells larger",
        cells[0], cells[1], cells[2], bytes / 0x1p30, KILN_MAX_GAS_EDGE);
}

static bool settle_shape(const struct settling *s)
{
    struct kiln_gas_domain *domain = s->domain;
    double cells[3];
    if (domain->cell > 0 && domain->cell_count != KILN_INTEGER_BY_WORD)
        return refuse(s, "cells", "cannot be given together with `cell`");
    if (!(domain->cell > 0) && domain->cell_count == KILN_INTEGER_BY_WORD)
        domain->cell_count = DEFAULT_CELLS;
    if (domain->detail == 3)
        return refuse(s, "detail", "found 3; allowed are 1, 2 and 4");
    settle_center(domain);
    kiln_gas_domain_cells(domain, cells);
    if (fmax(cells[0], fmax(cells[1], cells[2])) > KILN_MAX_GAS_EDGE)
        return refuse_edge(s, cells);
    kiln_scene_gas_shape(domain);
    return true;
}

static bool settle_rates(const struct settling *s)
{
    struct kiln_gas_domain *domain = s->domain;
    const bool is_auto = domain->substeps_given == KILN_INTEGER_BY_WORD;
    const double rate = (double)s->scene->rate.num / (double)s->scene->rate.den;
    char path[160];
    path_of(s, "rate", path);
    domain->substeps = is_auto ? 0 : domain->substeps_given;
    if (domain->rate > rate * KILN_MAX_SUBSTEPS)
        return kiln_reader_error_at(s->reader, s->root, path,
                                    "a step of the scene has at most %d of the gas, %g a second: a "
                                    "larger simulation.rate makes more",
                                    KILN_MAX_SUBSTEPS, rate * KILN_MAX_SUBSTEPS);
    return true;
}

static float longest_of(const struct kiln_gas_domain *domain)
{
    return fmaxf(domain->size.x.constant, fmaxf(domain->size.y.constant, domain->size.z.constant));
}

/* Replaces a value that is `auto`. */
static void settle_auto(struct kiln_value *value, float metres)
{
    if (value->count == 0 && value->constant < 0.0f)
        *value = (struct kiln_value){.constant = metres};
}

/* ---- sources --------------------------------------------------------------------------------- */

static bool is_zero(const struct kiln_scene *scene, const struct kiln_value *value)
{
    return kiln_scene_value_max(scene, value) == 0.0f && kiln_scene_value_min(scene, value) == 0.0f;
}

static bool is_zero_vector(const struct kiln_scene *scene, const struct kiln_value3 *v)
{
    return is_zero(scene, &v->x) && is_zero(scene, &v->y) && is_zero(scene, &v->z);
}

static bool settle_system(const struct settling *s, uint32_t index)
{
    struct kiln_gas_source *source = &s->domain->sources[index];
    char key[64], path[160];
    snprintf(key, sizeof key, "sources.%u.attach", index);
    if (source->emit.attach.name)
        return refuse(s, key, "must be none where the particles of a system are sources");
    snprintf(key, sizeof key, "sources.%u.from.system", index);
    path_of(s, key, path);
    if (!kiln_family_find_system(s->reader, s->root, path, source->system_name, &source->system))
        return false;
    if (s->domain->enabled && !s->scene->systems[source->system].enabled)
        kiln_reader_warn_at(s->reader, s->root, path,
                            "systems.%s is not enabled, so nothing comes of this source",
                            source->system_name);
    return true;
}

/* Returns how far a shape reaches from its origin along an axis, at a time; negative where that is
 * not known. */
static float reach_of(const struct kiln_scene *scene, const struct kiln_gas_source *source,
                      uint32_t system, int axis, float time_s)
{
    const struct kiln_emitter *emit = &source->emit;
    const float3 size = kiln_scene_system_value3(scene, system, &emit->size, time_s);
    const float edges[3] = {size.x, size.y, size.z};
    const float fade = kiln_scene_system_value(scene, system, &source->reach, time_s);
    switch (emit->shape) {
    case KILN_EMITTER_POINT:
        return fade;
    case KILN_EMITTER_SPHERE:
    case KILN_EMITTER_DISC:
    case KILN_EMITTER_RING:
    case KILN_EMITTER_CONE:
        return fade + kiln_scene_system_value(scene, system, &emit->radius, time_s);
    case KILN_EMITTER_BOX:
    case KILN_EMITTER_LINE:
        return fade + 0.5f * fabsf(edges[axis]);
    default:
        return -1.0f;
    }
}

/* Returns whether a source is outside of the box at a time. */
static bool is_outside(const struct settling *s, const struct kiln_gas_source *source, float time_s)
{
    const struct kiln_gas_shape *shape = &s->domain->shape;
    const uint32_t system = KILN_SYSTEM_OF_GAS((uint32_t)(s->domain - s->scene->gas));
    const float3 at = kiln_scene_system_value3(s->scene, system, &source->emit.origin, time_s);
    const float place[3] = {at.x, at.y, at.z};
    const float low[3] = {shape->corner.x, shape->corner.y, shape->corner.z};
    const int32_t cells[3] = {shape->cells.x, shape->cells.y, shape->cells.z};
    bool outside = false;
    for (int c = 0; c < 3; c++) {
        const float reach = reach_of(s->scene, source, system, c, time_s);
        const float high = low[c] + (float)cells[c] * shape->cell;
        outside = outside || (reach >= 0 && (place[c] + reach < low[c] || place[c] - reach > high));
    }
    return outside;
}

/* Warns of a source that lies outside of the box whenever one of the keys of its place counts. */
static void warn_of_outside(const struct settling *s, uint32_t index)
{
    const struct kiln_gas_domain *domain = s->domain;
    const struct kiln_gas_source *source = &domain->sources[index];
    const struct kiln_gas_shape *shape = &domain->shape;
    const struct kiln_value *parts[3] = {&source->emit.origin.x, &source->emit.origin.y,
                                         &source->emit.origin.z};
    const double cell = (double)shape->cell;
    char key[64], path[160];
    bool outside = domain->enabled && !source->emit.attach.name && is_outside(s, source, 0);
    for (int c = 0; c < 3; c++) {
        for (uint32_t i = 0; i < parts[c]->count; i++)
            outside = outside && is_outside(s, source, s->scene->keys[parts[c]->first + i].x);
    }
    if (!outside)
        return;
    snprintf(key, sizeof key, "sources.%u.from", index);
    path_of(s, key, path);
    kiln_reader_warn_at(
        s->reader, s->root, path,
        "the source lies outside of the box, from [%g, %g, %g] m to [%g, %g, %g] m, "
        "so nothing comes of it",
        (double)shape->corner.x, (double)shape->corner.y, (double)shape->corner.z,
        (double)shape->corner.x + shape->cells.x * cell,
        (double)shape->corner.y + shape->cells.y * cell,
        (double)shape->corner.z + shape->cells.z * cell);
}

static bool settle_source(const struct settling *s, uint32_t index)
{
    struct kiln_gas_domain *domain = s->domain;
    struct kiln_gas_source *source = &domain->sources[index];
    const float longest = longest_of(domain);
    static const char *const facing[KILN_EMITTER_SYSTEM + 1] = {
        [KILN_EMITTER_DISC] = "disc", [KILN_EMITTER_RING] = "ring", [KILN_EMITTER_CONE] = "cone"};
    const char *shape = facing[source->emit.shape];
    char key[64];
    settle_auto(&source->reach, fmaxf(longest / 16.0f, 1.5f * domain->shape.cell));
    settle_auto(&source->noise_size, longest / 16.0f);
    source->blows = !is_zero_vector(s->scene, &source->velocity) ||
                    !is_zero(s->scene, &source->outward) || !is_zero(s->scene, &source->inherit);
    source->from =
        source->emit.shape == KILN_EMITTER_SYSTEM ? KILN_GAS_FROM_SYSTEM : KILN_GAS_FROM_SHAPE;
    if (source->from == KILN_GAS_FROM_SYSTEM)
        return settle_system(s, index);
    snprintf(key, sizeof key, "sources.%u.from.%s.direction", index, shape ? shape : "");
    if (shape && is_zero_vector(s->scene, &source->emit.direction))
        return refuse(s, key, "must not be [0, 0, 0]");
    warn_of_outside(s, index);
    return true;
}

/* ---- domains --------------------------------------------------------------------------------- */

static bool settle_domain(const struct settling *s)
{
    struct kiln_gas_domain *domain = s->domain;
    const uint32_t owner = s->scene->system_count + (uint32_t)(domain - s->scene->gas);
    char path[160];
    if (!settle_shape(s) || !settle_rates(s) || !kiln_regions_check(s->reader, s->root, owner))
        return false;
    settle_auto(&domain->turbulence.size, longest_of(domain) / 10.0f);
    for (uint32_t i = 0; i < domain->source_count; i++) {
        if (!settle_source(s, i))
            return false;
    }
    path_of(s, "sources", path);
    if (domain->enabled && domain->source_count == 0)
        kiln_reader_warn_at(s->reader, s->root, path,
                            "the domain has no sources, so it stays empty");
    return true;
}

/* Refuses more cells than a scene may have. */
static bool check_cells(struct kiln_reader *reader, const struct kiln_node *root)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    const uint64_t cells = kiln_gas_cells(scene);
    return cells <= KILN_MAX_GAS_CELLS ||
           kiln_reader_error_at(reader, root, "gas",
                                "the domains have %" PRIu64
                                " cells, which take up to %.1f GiB where gas fills them; a scene "
                                "has at most %d: make the cells larger",
                                cells, (double)kiln_gas_most_bytes(scene) / 0x1p30,
                                KILN_MAX_GAS_CELLS);
}

/* ---- winds of gas ---------------------------------------------------------------------------- */

static bool find_domain(struct kiln_reader *reader, const struct kiln_node *root, const char *path,
                        struct kiln_force *force)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    const char *names[KILN_MAX_GAS];
    for (uint32_t i = 0; i < scene->gas_count; i++) {
        names[i] = scene->gas[i].name;
        force->domain = i;
        if (strcmp(names[i], force->gas) == 0)
            return true;
    }
    char suggestion[512], quoted[64];
    kiln_option_suggest(suggestion, sizeof suggestion, force->gas, names, scene->gas_count);
    kiln_node_quote(quoted, force->gas);
    return kiln_reader_error_at(reader, root, path, "unknown gas '%s'%s", quoted, suggestion);
}

/* Lets the grid of a wind fill the box of its domain, in the domain's node. */
static void place_wind(struct kiln_force *force, const struct kiln_gas_domain *domain)
{
    const struct kiln_gas_shape *shape = &domain->shape;
    const int32_t cells[3] = {shape->cells.x, shape->cells.y, shape->cells.z};
    const float low[3] = {shape->corner.x, shape->corner.y, shape->corner.z};
    struct kiln_value center[3], size[3];
    for (int c = 0; c < 3; c++) {
        const float edge = (float)cells[c] * shape->cell;
        center[c] = (struct kiln_value){.constant = low[c] + 0.5f * edge};
        size[c] = (struct kiln_value){.constant = edge};
    }
    force->box_center = (struct kiln_value3){center[0], center[1], center[2]};
    force->box_size = (struct kiln_value3){size[0], size[1], size[2]};
    force->attach = domain->attach;
    force->every = 1;
}

static bool settle_winds(struct kiln_reader *reader, const struct kiln_node *root,
                         struct kiln_system *system)
{
    const struct kiln_scene *scene = kiln_reader_scene(reader);
    char path[128];
    for (uint32_t i = 0; i < system->force_count; i++) {
        struct kiln_force *force = &system->forces[i];
        if (force->kind != KILN_FORCE_GAS)
            continue;
        snprintf(path, sizeof path, "systems.%s.forces.%u.wind.gas", system->name, i);
        if (!find_domain(reader, root, path, force))
            return false;
        const struct kiln_gas_domain *domain = &scene->gas[force->domain];
        place_wind(force, domain);
        if (!domain->enabled && system->enabled)
            kiln_reader_warn_at(reader, root, path,
                                "gas.%s is not enabled, so this wind does nothing", domain->name);
    }
    return true;
}

bool kiln_gas_settle(struct kiln_reader *reader, const struct kiln_node *root)
{
    struct kiln_scene *scene = kiln_reader_scene(reader);
    bool ok = true;
    for (uint32_t i = 0; ok && i < scene->gas_count; i++) {
        const struct settling settling = {reader, root, scene, &scene->gas[i]};
        ok = settle_domain(&settling);
    }
    ok = ok && check_cells(reader, root);
    for (uint32_t i = 0; ok && i < scene->system_count; i++)
        ok = settle_winds(reader, root, &scene->systems[i]);
    return ok;
}
