/* Claims the files of a job, so that none is written twice or both read and written: the files that
 * its scene was read from, its outputs, its journal and its manifest. */
#include "job/journal.h"
#include "kiln_program.h"
#include "output/output.h"
#include "scene/scene.h"

static bool claim_output(const struct kiln_scene *scene, const struct kiln_render_params *params,
                         struct kiln_claims *claims, struct kiln_error *error)
{
    const struct kiln_frame_range whole_clip = {0, scene->frames - 1};
    struct kiln_output_params output = {
        .path = params->output,
        .ranges = params->range_count > 0 ? params->ranges : &whole_clip,
        .range_count = params->range_count > 0 ? params->range_count : 1,
    };
    if (params->flipbook)
        output.flipbook = *params->flipbook;
    char journal[KILN_PATH_SIZE];
    return kiln_output_claim(&output, claims, error) &&
           (!(params->resume || params->shards > 0) ||
            (kiln_journal_path(params->output, (struct kiln_shard){params->shard, params->shards},
                               journal, error) &&
             kiln_claims_write(claims, journal, "--resume", error)));
}

bool kiln_render_claim(const struct kiln_scene *scene, const struct kiln_render_params *params,
                       struct kiln_claims *claims, struct kiln_error *error)
{
    return kiln_scene_claim(scene, claims, error) &&
           (!params->output || claim_output(scene, params, claims, error)) &&
           (!params->manifest || kiln_claims_write(claims, params->manifest, "--manifest", error));
}
