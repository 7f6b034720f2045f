/* Steps a scene through frames and writes the gas of each as OpenVDB files. A domain has files of
 * its own, with grids of the names that other programs expect, since domains differ in the size of
 * their cells and in how they move. */
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/clock.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/pattern.h"
#include "base/ranges.h"
#include "base/sized.h"
#include "job/hold.h"
#include "job/states.h"
#include "job/stop.h"
#include "output/gas_vdb.h"

static const char mark[] = "{gas}", suffix[] = ".vdb";

enum { META_TEXT = 256 }; /* bytes that a text of the metadata may have, with its zero */

/* A domain that is exported. */
struct exported {
    uint32_t number; /* of the domain in the scene */
    struct kiln_path_pattern pattern;
};

struct export
{
    struct kiln_device *device;
    const struct kiln_scene *scene;
    const struct kiln_export_params *params;
    struct kiln_stop stop;
    struct kiln_caller caller;
    struct kiln_loop *loop;
    struct kiln_states *states;
    struct kiln_frame_range whole_clip;
    const struct kiln_frame_range *ranges;
    size_t range_count;
    uint32_t frame_count;
    struct exported domains[KILN_MAX_GAS];
    uint32_t domain_count;
    double started_s;
    struct kiln_export_stats stats;
};

/* ---- What is exported, and where to ---------------------------------------------------------- */

static bool choose_frames(struct export *x, struct kiln_error *error)
{
    const uint32_t last = x->scene->frames - 1;
    uint64_t next = 0;
    x->whole_clip = (struct kiln_frame_range){0, last};
    x->ranges = x->params->range_count > 0 ? x->params->ranges : &x->whole_clip;
    x->range_count = x->params->range_count > 0 ? x->params->range_count : 1;
    for (size_t i = 0; i < x->range_count; i++) {
        const struct kiln_frame_range range = x->ranges[i];
        if (range.first > range.last || range.first < next || range.last > last)
            return kiln_error_set(error, KILN_USAGE,
                                  "frames %u-%u: expected ascending ranges within 0-%u",
                                  range.first, range.last, last);
        next = (uint64_t)range.last + 1;
    }
    x->frame_count = (uint32_t)kiln_ranges_count(x->ranges, x->range_count);
    return true;
}

/* Fails with the names that there are. */
static bool fail_unknown(const struct export *x, struct kiln_error *error)
{
    char names[KILN_MESSAGE_SIZE / 2] = "";
    for (uint32_t i = 0; i < x->scene->gas_count; i++) {
        const size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", i > 0 ? ", " : "",
                 x->scene->gas[i].name);
    }
    return kiln_error_set(error, KILN_USAGE, "%s: the scene has no gas '%s'; it has %s",
                          x->scene->name, x->params->gas, names);
}

static bool choose_domains(struct export *x, struct kiln_error *error)
{
    const struct kiln_scene *scene = x->scene;
    const char *wanted = x->params->gas;
    bool found = false;
    for (uint32_t i = 0; i < scene->gas_count; i++) {
        const bool named = wanted && strcmp(scene->gas[i].name, wanted) == 0;
        found |= named;
        if (scene->gas[i].enabled && (named || !wanted))
            x->domains[x->domain_count++].number = i;
    }
    if (scene->gas_count == 0)
        return kiln_error_set(error, KILN_USAGE,
                              "%s: the scene has no gas to export (see 'kiln help scene gas')",
                              scene->name);
    if (wanted && !found)
        return fail_unknown(x, error);
    return x->domain_count > 0 ||
           kiln_error_set(error, KILN_USAGE, "%s: %s is not enabled", scene->name,
                          wanted ? "this gas" : "the gas of the scene");
}

static bool has_suffix(const char *path)
{
    const size_t length = strlen(path);
    return length > sizeof suffix - 1 && strcmp(path + length - (sizeof suffix - 1), suffix) == 0;
}

/* Writes the output's path with the name of a domain, which has only letters, digits, '-' and '_',
 * in the place of each mark. */
static bool name_output(const struct export *x, const char *name, char path[KILN_PATH_SIZE],
                        struct kiln_error *error)
{
    const size_t length = strlen(name);
    size_t used = 0;
    for (const char *from = x->params->output; *from;) {
        const bool marked = strncmp(from, mark, sizeof mark - 1) == 0;
        const size_t size = marked ? length : 1;
        if (used + size >= KILN_PATH_SIZE)
            return kiln_error_set(error, KILN_USAGE, "%.200s...: the path is too long",
                                  x->params->output);
        memcpy(path + used, marked ? name : from, size);
        used += size;
        from += marked ? sizeof mark - 1 : 1;
    }
    path[used] = '\0';
    return true;
}

static bool name_files(struct export *x, struct kiln_error *error)
{
    const char *output = x->params->output;
    if (!output || !has_suffix(output))
        return kiln_error_set(error, KILN_USAGE, "%s: gas is exported to files with the suffix %s",
                              output ? output : "no output", suffix);
    if (x->domain_count > 1 && !strstr(output, mark))
        return kiln_error_set(error, KILN_USAGE,
                              "%s: the scene has %u domains of gas, which need {gas} for their "
                              "names in the name of the files, as in gas_{gas}_####.vdb",
                              output, x->domain_count);
    for (uint32_t i = 0; i < x->domain_count; i++) {
        struct exported *domain = &x->domains[i];
        char path[KILN_PATH_SIZE];
        if (!name_output(x, x->scene->gas[domain->number].name, path, error) ||
            !kiln_path_pattern_parse(&domain->pattern, path,
                                     x->frame_count > 1 ? KILN_NUMBER_ALWAYS : KILN_NUMBER_IF_ASKED,
                                     error))
            return false;
    }
    return true;
}

static bool file_of(const struct export *x, const struct exported *domain, uint32_t frame,
                    char path[KILN_PATH_SIZE], struct kiln_error *error)
{
    return kiln_path_pattern_format(&domain->pattern, frame, path, KILN_PATH_SIZE) ||
           kiln_error_set(error, KILN_USAGE, "%s: the path is too long", x->params->output);
}

/* Claims the files of a domain, and checks that none of them exists. */
static bool claim_domain(const struct export *x, const struct exported *domain,
                         struct kiln_claims *claims, struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    for (uint64_t i = 0; i < x->frame_count; i++) {
        const uint32_t frame = kiln_ranges_at(x->ranges, x->range_count, i);
        if (!file_of(x, domain, frame, path, error) ||
            !kiln_claims_write(claims, path, "--output", error) ||
            !kiln_target_check(path, x->params->overwrite, error))
            return false;
    }
    return true;
}

/* Finds what is exported and to which files, and claims these. */
static bool claim_files(struct export *x, struct kiln_claims *claims, struct kiln_error *error)
{
    if (!choose_frames(x, error) || !choose_domains(x, error) || !name_files(x, error) ||
        !kiln_scene_claim(x->scene, claims, error))
        return false;
    for (uint32_t i = 0; i < x->domain_count; i++)
        if (!claim_domain(x, &x->domains[i], claims, error))
            return false;
    return true;
}

/* Makes the folder of a domain's files, and removes what killed jobs left in it. */
static bool make_folder(struct export *x, const struct exported *domain, struct kiln_error *error)
{
    char path[KILN_PATH_SIZE];
    if (!file_of(x, domain, x->ranges[0].first, path, error) ||
        !kiln_make_parent_folders(path, error))
        return false;
    kiln_temporary_sweep(path);
    if (domain == x->domains)
        memcpy(x->stats.first_file, path, sizeof path);
    return true;
}

static bool prepare_files(struct export *x, struct kiln_error *error)
{
    struct kiln_claims *claims = kiln_claims_create();
    bool ok =
        claims ? claim_files(x, claims, error) : kiln_error_no_memory(error, "files of the job");
    kiln_claims_destroy(&claims);
    for (uint32_t i = 0; ok && i < x->domain_count; i++)
        ok = make_folder(x, &x->domains[i], error);
    return ok;
}

/* ---- A file ---------------------------------------------------------------------------------- */

/* Writes a UUID that depends on all that decides the content of a file: a part of a SHA-256 in the
 * form of version 8, which RFC 9562 leaves to applications. */
static void make_uuid(const struct export *x, const struct kiln_gas_vdb *vdb, const char *name,
                      uint32_t frame, char uuid[37])
{
    char text[512], hex[65];
    const int size = snprintf(text, sizeof text, "%s %.200s %u %d%d%d %a", x->scene->hash, name,
                              frame, vdb->z_up, vdb->half, vdb->kelvin, (double)vdb->cutoff);
    kiln_hash_sha256(text, (size_t)size, hex);
    hex[12] = '8';
    hex[16] = '8';
    snprintf(uuid, 37, "%.8s-%.4s-%.4s-%.4s-%.12s", hex, hex + 8, hex + 12, hex + 16, hex + 20);
}

/* Writes the gas of a domain, at the time of a frame, into an open file. */
static bool write_gas(const struct export *x, uint32_t number, uint32_t frame,
                      struct kiln_temporary *file, uint64_t *voxels, struct kiln_error *error)
{
    const struct kiln_scene *scene = x->scene;
    const struct kiln_gas_domain *domain = &scene->gas[number];
    const struct kiln_export_params *params = x->params;
    const float time_s = kiln_scene_time(scene, kiln_scene_frame_step(scene, frame));
    const double fps = (double)scene->fps.num / (double)scene->fps.den;
    char scene_name[META_TEXT], gas_name[META_TEXT];
    const char *slash = strrchr(scene->name, '/');
    snprintf(scene_name, sizeof scene_name, "%s", slash ? slash + 1 : scene->name);
    snprintf(gas_name, sizeof gas_name, "%s", domain->name);
    const struct kiln_vdb_meta metas[] = {
        {.name = "creator", .text = "kiln " KILN_VERSION},
        {.name = "scene", .text = scene_name},
        {.name = "scene_hash", .text = scene->hash},
        {.name = "gas", .text = gas_name},
        {.name = "frame", .type = KILN_VDB_INT32, .integer = (int32_t)frame},
        {.name = "time", .type = KILN_VDB_DOUBLE, .number = frame / fps},
        {.name = "fps", .type = KILN_VDB_DOUBLE, .number = fps},
        {.name = "up", .text = params->up == KILN_UP_Z ? "z" : "y"},
        {.name = "length", .text = "m"},
    };
    const float3 albedo = kiln_scene_value3(scene, &domain->look.albedo, time_s);
    struct kiln_node_frame node;
    struct kiln_gas_vdb vdb = {
        .gas = &kiln_loop_run(x->loop)->pool.gas[number],
        .shape = &domain->shape,
        .z_up = params->up == KILN_UP_Z,
        .half = params->half,
        .kelvin = !params->unit,
        .kelvin_of = {kiln_scene_value(scene, &domain->look.kelvin[0], time_s),
                      kiln_scene_value(scene, &domain->look.kelvin[1], time_s)},
        .cutoff = (float)params->cutoff,
        .extinction = (double)kiln_scene_value(scene, &domain->look.extinction, time_s),
        .albedo = {albedo.x, albedo.y, albedo.z},
        .metas = metas,
        .meta_count = sizeof metas / sizeof *metas,
    };
    if (domain->attach.name) {
        node = kiln_node_frame_at(scene, domain->attach.node, time_s, time_s);
        vdb.frame = &node;
    }
    make_uuid(x, &vdb, domain->name, frame, vdb.uuid);
    return kiln_gas_fetch(&kiln_loop_run(x->loop)->pool.gas[number], error) &&
           kiln_gas_vdb_write(&vdb, file, kiln_loop_threads(x->loop), &x->caller, voxels, error);
}

static void tell(struct export *x, uint32_t frame, const char *name, const char *path,
                 uint64_t bytes, uint64_t voxels)
{
    x->stats.files++;
    x->stats.bytes += bytes;
    const struct kiln_exported exported = {
        .size = sizeof exported,
        .frame = frame,
        .done = x->stats.files,
        .total = x->frame_count * x->domain_count,
        .bytes = bytes,
        .voxels = voxels,
        .elapsed_s = kiln_clock_seconds() - x->started_s,
        .gas = name,
        .file = path,
    };
    if (x->params->exported)
        x->params->exported(x->params->user, &exported);
}

static bool write_file(struct export *x, const struct exported *domain, uint32_t frame,
                       struct kiln_error *error)
{
    struct kiln_temporary file = {.target = NULL};
    struct stat status = {0};
    char path[KILN_PATH_SIZE];
    uint64_t voxels = 0;
    if (!file_of(x, domain, frame, path, error) || !kiln_temporary_open(&file, path, error))
        return false;
    file.durable = true;
    file.budget = x->scene->budget;
    if (!write_gas(x, domain->number, frame, &file, &voxels, error)) {
        kiln_temporary_discard(&file);
        return false;
    }
    fstat(file.file, &status);
    if (!kiln_temporary_commit(&file, x->params->overwrite, error))
        return false;
    tell(x, frame, x->scene->gas[domain->number].name, path, (uint64_t)status.st_size, voxels);
    return kiln_device_make_current(x->device, error);
}

/* ---- The job --------------------------------------------------------------------------------- */

static bool begin(struct export *x, struct kiln_error *error)
{
    const struct kiln_export_params *params = x->params;
    const struct kiln_loop_params loop = {.techniques = params->techniques,
                                          .technique_count = params->technique_count,
                                          .threads = params->threads,
                                          .log = params->log,
                                          .caller = x->caller};
    const struct kiln_output_needs needs = {.bits = 8};
    if (!prepare_files(x, error))
        return false;
    x->loop = kiln_loop_create(x->device, x->scene, &loop, error);
    if (!x->loop || !kiln_loop_set_up(x->loop, needs, error))
        return false;
    if (params->states)
        x->states = kiln_states_open(params->states, x->scene, kiln_loop_techniques(x->loop),
                                     &params->log, error);
    return !params->states || x->states;
}

bool kiln_export_claim(const struct kiln_scene *scene, const struct kiln_export_params *params,
                       struct kiln_claims *claims, struct kiln_error *error)
{
    struct export *x = calloc(1, sizeof *x);
    if (!x)
        return kiln_error_no_memory(error, "files of the job");
    x->scene = scene;
    x->params = params;
    const bool ok = claim_files(x, claims, error);
    free(x);
    return ok;
}

static bool export_frame(struct export *x, uint32_t frame, struct kiln_error *error)
{
    if (!kiln_stop_ask(&x->stop, error) ||
        (x->states && !kiln_states_take_up(x->states, x->loop, frame, error)) ||
        !kiln_loop_advance(x->loop, frame, error))
        return false;
    for (uint32_t i = 0; i < x->domain_count; i++)
        if (!write_file(x, &x->domains[i], frame, error))
            return false;
    x->stats.frames++;
    return true;
}

bool kiln_export(struct kiln_device *device, const struct kiln_scene *scene,
                 const struct kiln_export_params *given, struct kiln_export_stats *stats,
                 struct kiln_error *error)
{
    struct kiln_export_params params = kiln_export_defaults();
    if (!kiln_sized_take(&params, given, "kiln_export_params", error) ||
        !kiln_sized_check(stats, "kiln_export_stats", error) ||
        !kiln_hold_take(device, scene, error))
        return false;
    struct export *x = calloc(1, sizeof *x);
    bool ok = x != NULL;
    if (ok) {
        x->device = device;
        x->scene = scene;
        x->params = &params;
        x->started_s = kiln_clock_seconds();
        x->stats = kiln_export_stats_empty();
        x->stop =
            (struct kiln_stop){params.stop, params.user, device, scene->budget, params.cancel};
        x->caller = kiln_stop_caller(&x->stop);
        ok = begin(x, error);
    } else {
        kiln_error_no_memory(error, "an export");
    }
    for (uint64_t i = 0; ok && i < x->frame_count; i++)
        ok = export_frame(x, kiln_ranges_at(x->ranges, x->range_count, i), error);
    if (x) {
        x->stats.steps = x->loop ? kiln_loop_steps(x->loop) : 0;
        x->stats.total_s = kiln_clock_seconds() - x->started_s;
        kiln_states_close(&x->states);
        kiln_loop_destroy(&x->loop);
        kiln_sized_give(stats, &x->stats);
    }
    kiln_hold_release(device, scene);
    free(x);
    return ok;
}
