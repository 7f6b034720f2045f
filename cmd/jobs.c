/* Makes the list of jobs of kiln render, one for each scene, from its operands and options.
 * cmd/render.c calls job_list_create once, before it opens a device. batch_check.c uses
 * job_file_name, and encode.c uses quality_check.
 *
 * Mistakes are found here, before minutes of work are done. The checks stand in the order of their
 * cost: options and names of files first, then the scenes are loaded, and the files of all jobs are
 * claimed last, because that needs the scenes. A claim only notes that a file will be read or
 * written; nothing is written here. */
#include "jobs.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "json_output.h"
#include "overrides.h"
#include "report.h"
#include "scene_in.h"

static const char mark[] = "{scene}"; /* stands for the scene's name in --output and --manifest */

/* Returns the scene file's name without folder and suffix, or "stdin" for standard input. The
 * suffix follows after *length bytes. */
static const char *scene_stem(const char *path, size_t *length)
{
    const char *slash = strrchr(path, '/');
    const char *name = strcmp(path, "-") == 0 ? "stdin" : slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    *length = dot && dot > name ? (size_t)(dot - name) : strlen(name);
    return name;
}

static bool is_folder(const char *path)
{
    struct stat status;
    size_t length = strlen(path);
    return (length > 0 && path[length - 1] == '/') ||
           (stat(path, &status) == 0 && S_ISDIR(status.st_mode));
}

/* Adds the scene's name to a text. With `escape`, '%' and '#' in it are escaped, since they would
 * stand for the number of a frame in the name of an output. */
static void add_stem(FILE *out, const char *scene, bool escape)
{
    size_t length;
    const char *stem = scene_stem(scene, &length);
    for (size_t i = 0; i < length; i++)
        fprintf(out, "%s%c", escape && (stem[i] == '%' || stem[i] == '#') ? "%" : "", stem[i]);
}

/* Adds the pattern with every mark replaced. The scene's name is not escaped in the part that is a
 * folder's name, where '%' and '#' do not stand for numbers. */
static void add_marked(FILE *out, const char *pattern, const char *scene, bool escape)
{
    const char *slash = strrchr(pattern, '/');
    while (*pattern) {
        if (strncmp(pattern, mark, sizeof mark - 1) == 0) {
            add_stem(out, scene, escape && (!slash || pattern > slash));
            pattern += sizeof mark - 1;
        } else {
            fputc(*pattern++, out);
        }
    }
}

char *job_file_name(const char *pattern, const char *scene, const char *suffix, bool numbers)
{
    char *name = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&name, &size);
    if (!out)
        return NULL;
    add_marked(out, pattern, scene, false);
    fflush(out);
    if (name && is_folder(name)) {
        fputs(name[size - 1] == '/' ? "" : "/", out);
        add_stem(out, scene, numbers);
        fputs(suffix, out);
    } else if (numbers) {
        rewind(out);
        add_marked(out, pattern, scene, true);
    }
    bool failed = ferror(out) != 0;
    if (fclose(out) == 0 && !failed)
        return name;
    free(name);
    return NULL;
}

/* Refuses two jobs that write files of the same name, with a message that says what to do. Two
 * different names can still lead to one file: claim_files finds that, once the scenes are
 * loaded. */
static int check_clash(const struct job *a, const struct job *b)
{
    bool output = a->output && b->output && strcmp(a->output, b->output) == 0;
    bool manifest = a->manifest && b->manifest && strcmp(a->manifest, b->manifest) == 0;
    if (!output && !manifest)
        return 0;
    return report(KILN_USAGE,
                  "render: --%s: '%s' and '%s' would both write '%s'; name a folder, or put "
                  "{scene} into the name",
                  output ? "output" : "manifest", a->path, b->path,
                  output ? a->output : a->manifest);
}

/* Adds the files that a job reads and writes to the claims. Refuses the job if a file would then be
 * written twice, or be both read and written, by this job or those before it. */
static int claim_files_of(const struct job_list *list, const struct job *job,
                          struct kiln_claims *claims)
{
    struct kiln_error error = {0};
    struct kiln_render_params params = kiln_render_defaults();
    params.output = list->stream.format ? NULL : job->output;
    params.manifest = job->manifest;
    params.ranges = job->frames.ranges;
    params.range_count = job->frames.count;
    params.flipbook = list->flipbook.columns > 0 ? &list->flipbook : NULL;
    params.resume = list->resume;
    params.shard = list->shard;
    params.shards = list->shards;
    return kiln_render_claim(job->scene, &params, claims, &error) ? 0 : report_error(&error);
}

/* Claims the files of all jobs and of --json together. */
static int claim_files(struct job_list *list, const struct arguments *arguments)
{
    struct kiln_claims *claims = kiln_claims_create();
    const char *json = json_output_path(arguments);
    struct kiln_error error = {0};
    int code = claims ? 0 : report_no_memory();
    if (code == 0 && json && !kiln_claims_write(claims, json, "--json", &error))
        code = report_error(&error);
    for (size_t i = 0; i < list->count && code == 0; i++) {
        struct job *job = &list->jobs[i];
        if (job->code)
            continue;
        job->code = claim_files_of(list, job, claims);
        if (!list->keep_going)
            code = job->code;
    }
    kiln_claims_destroy(&claims);
    return code;
}

/* Refuses options that have no meaning for this kind of output. */
static int check_output(const struct job_list *list, const struct arguments *arguments)
{
    const struct option_use *output = arguments_last(arguments, "output");
    if (!output)
        return report(KILN_USAGE, "render: needs --output FILE; '--output none' writes nothing");
    const bool writes = strcmp(output->text, "none") != 0;
    if (list->shards > 0 && arguments_last(arguments, "manifest"))
        return report(KILN_USAGE, "render: --manifest: not allowed with --shard; 'kiln join "
                                  "--manifest' writes the manifest of all shards");
    if (list->stream.format && (list->resume || list->shards > 0 || list->flipbook.columns > 0))
        return report(KILN_USAGE, "render: --%s: not allowed with '--output -'",
                      list->resume       ? "resume"
                      : list->shards > 0 ? "shard"
                                         : "flipbook");
    if (list->stream.format && arguments_last(arguments, "quality"))
        return report(KILN_USAGE, "render: --quality: not allowed with '--output -'");
    if (list->resume && !writes)
        return report(KILN_USAGE, "render: --resume: '--output none' writes nothing to go on with");
    if (list->shards > 0 && !writes)
        return report(KILN_USAGE, "render: --shard: '--output none' writes nothing to share");
    return 0;
}

int quality_check(const struct arguments *arguments, const char *place, const char *output)
{
    if (!arguments_last(arguments, "quality") || kiln_output_has_quality(output))
        return 0;
    return report(KILN_USAGE,
                  "%s: --quality: the format of '%s' has no quality; .jpg, .mp4, .webm, .mov and "
                  ".webp have one",
                  place, output);
}

/* Returns the name of a job's output in new memory; NULL when memory is short. */
static char *output_name(const struct job_list *list, const char *pattern, const char *scene)
{
    if (list->stream.format)
        return strdup(pattern);
    return job_file_name(pattern, scene, list->flipbook.columns > 0 ? ".png" : ".mp4", true);
}

static int name_files(struct job_list *list, const struct arguments *arguments)
{
    const struct option_use *output = arguments_last(arguments, "output");
    const struct option_use *manifest = arguments_last(arguments, "manifest");
    list->resume = arguments_flag(arguments, "resume");
    int code = check_output(list, arguments);
    const bool writes = code == 0 && strcmp(output->text, "none") != 0;
    for (size_t i = 0; i < list->count && code == 0; i++) {
        struct job *job = &list->jobs[i];
        job->path = arguments->operands[i];
        if (writes)
            job->output = output_name(list, output->text, job->path);
        if (manifest)
            job->manifest = job_file_name(manifest->text, job->path, ".json", false);
        if ((writes && !job->output) || (manifest && !job->manifest))
            code = report_no_memory();
        if (code == 0 && job->output && !list->stream.format)
            code = quality_check(arguments, "render", job->output);
        for (size_t j = 0; j < i && code == 0; j++)
            code = check_clash(&list->jobs[j], job);
    }
    return code;
}

/* Finds the frames that a job draws: those of --frames, which must all exist, or every frame of the
 * scene. */
static int choose_frames(struct job *job, const struct arguments *arguments)
{
    const struct option_use *frames = arguments_last(arguments, "frames");
    const uint32_t last = job->info.frames - 1;
    if (!frames) {
        job->every_frame = (struct kiln_frame_range){0, last};
        job->frames = (struct frame_list){&job->every_frame, 1};
        return 0;
    }
    const int code = frames_choose(&job->chosen, frames, "render", job->path, last);
    job->frames = job->chosen;
    return code;
}

enum { FLIPBOOK_FADE = 10 }; /* percent; the default of --flipbook-fade */

static int read_flipbook(struct job_list *list, const struct arguments *arguments)
{
    const struct option_use *grid = arguments_last(arguments, "flipbook");
    const struct option_use *alpha = arguments_last(arguments, "flipbook-alpha");
    const struct option_use *motion = arguments_last(arguments, "flipbook-motion");
    const struct option_use *green = arguments_last(arguments, "flipbook-green");
    const struct option_use *padding = arguments_last(arguments, "flipbook-padding");
    const struct option_use *fade = arguments_last(arguments, "flipbook-fade");
    const struct option_use *part = alpha ? alpha : motion ? motion : padding ? padding : fade;
    if (green && !motion)
        return report(KILN_USAGE, "render: --flipbook-green: needs --flipbook-motion");
    if (!grid)
        return part ? report(KILN_USAGE, "render: --%s: needs --flipbook", part->option->name) : 0;
    list->flipbook = (struct kiln_flipbook){
        .size = sizeof list->flipbook,
        .columns = (uint32_t)grid->integer[0],
        .rows = (uint32_t)grid->integer[1],
        .padding = padding ? (uint32_t)padding->integer[0] : 0,
        .premultiplied = alpha && alpha->choice == 1,
        .motion = motion != NULL,
        .fade = fade ? (uint32_t)fade->integer[0] : FLIPBOOK_FADE,
        .green_down = green && green->choice == 1,
    };
    return 0;
}

/* Reduces the job's frames to those that a flipbook shows. */
static int choose_cells(struct job *job, const struct kiln_flipbook *flipbook)
{
    size_t count = (size_t)flipbook->columns * flipbook->rows;
    struct kiln_error error = {0};
    job->cells = calloc(count, sizeof *job->cells);
    if (!job->cells)
        return report_no_memory();
    if (!kiln_flipbook_sample(flipbook, job->frames.ranges, job->frames.count, job->cells, &error))
        return report(error.code, "render: --flipbook: '%s': %s", job->path, error.message);
    job->frames = (struct frame_list){job->cells, count};
    return 0;
}

static int load_scenes(struct job_list *list, const struct arguments *arguments)
{
    struct overrides overrides;
    if (!overrides_create(&overrides, arguments))
        return report_no_memory();
    struct kiln_scene_params params = overrides_scene_params(&overrides, arguments);
    int code = 0;
    for (size_t i = 0; i < list->count; i++) {
        struct job *job = &list->jobs[i];
        struct kiln_error error = {0};
        job->scene = scene_in_load(job->path, &params, &error);
        if (job->scene) {
            job->info = kiln_scene_info_empty();
            kiln_scene_get_info(job->scene, &job->info);
            job->code = choose_frames(job, arguments);
            if (job->code == 0 && list->flipbook.columns > 0)
                job->code = choose_cells(job, &list->flipbook);
        } else {
            job->code = report_scene_error(&error);
        }
        if (code == 0 && !list->keep_going)
            code = job->code;
    }
    overrides_free(&overrides);
    return code;
}

int job_list_create(struct job_list *list, const struct arguments *arguments)
{
    list->jobs = calloc(arguments->operand_count, sizeof *list->jobs);
    list->count = arguments->operand_count;
    if (!list->jobs) {
        list->count = 0;
        return report_no_memory();
    }
    int code = scene_in_check(arguments, "render");
    code = code ? code : read_flipbook(list, arguments);
    code = code ? code : name_files(list, arguments);
    code = code ? code : load_scenes(list, arguments);
    return code ? code : claim_files(list, arguments);
}

void job_list_free(struct job_list *list)
{
    for (size_t i = 0; i < list->count; i++) {
        kiln_scene_destroy(&list->jobs[i].scene);
        free(list->jobs[i].output);
        free(list->jobs[i].manifest);
        free(list->jobs[i].cells);
        frame_list_free(&list->jobs[i].chosen);
    }
    free(list->jobs);
    *list = (struct job_list){0};
}
