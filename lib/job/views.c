/* Finds the layers of a frame by their names, in the display pixels or among the float layers, and
 * shows them to the caller's callback. */
#include "job/views.h"

#include <string.h>

#include "base/error.h"
#include "base/text.h"
#include "frame/stages.h"

#define DISPLAY "display"
#define BEAUTY  "beauty"

/* The layers that are shown to a caller that names none. */
static const char *const usual[] = {DISPLAY};

static const char *const *wanted(const struct kiln_render_params *params, size_t *count)
{
    *count = params->layer_count > 0 ? params->layer_count : 1;
    return params->layer_count > 0 ? params->layers : usual;
}

static bool is_layer(bool gas, const char *name)
{
    const char *names[KILN_MAX_LAYERS];
    uint32_t channels[KILN_MAX_LAYERS];
    const uint32_t count = kiln_stages_layers(gas, names, channels);
    for (uint32_t i = 0; i < count; i++) {
        if (strcmp(name, names[i]) == 0)
            return true;
    }
    return false;
}

static bool refuse(const struct kiln_scene *scene, const char *name, struct kiln_error *error)
{
    const char *names[KILN_MAX_LAYERS + 1] = {DISPLAY};
    uint32_t channels[KILN_MAX_LAYERS];
    const uint32_t count =
        1 + kiln_stages_layers(kiln_volume_domains(scene) > 0, names + 1, channels);
    if (is_layer(true, name))
        return kiln_error_set(error, KILN_USAGE,
                              "the layer '%s' needs gas, of which '%s' draws none", name,
                              scene->name);
    const char *nearest = kiln_text_nearest(name, names, count);
    struct kiln_text all = {0};
    for (uint32_t i = 0; i < count; i++)
        kiln_text_add(&all, "%s%s", i ? ", " : "", names[i]);
    kiln_error_set(error, KILN_USAGE, "there is no layer '%s'%s%s%s; there are %s", name,
                   nearest ? ", did you mean '" : "", nearest ? nearest : "", nearest ? "'?" : "",
                   all.failed ? "others" : all.data);
    kiln_text_free(&all);
    return false;
}

bool kiln_views_need(const struct kiln_scene *scene, const struct kiln_render_params *params,
                     struct kiln_output_needs *needs, struct kiln_error *error)
{
    size_t count;
    const char *const *names = wanted(params, &count);
    const bool is_seen = params->picture || params->keep_frames;
    for (size_t i = 0; is_seen && i < count; i++) {
        const bool beauty = strcmp(names[i], BEAUTY) == 0;
        if (strcmp(names[i], DISPLAY) == 0)
            needs->bits = needs->bits > 0 ? needs->bits : 8;
        else if (!is_layer(kiln_volume_domains(scene) > 0, names[i]))
            return refuse(scene, names[i], error);
        else if (!beauty || needs->layers == KILN_LAYERS_NONE)
            needs->layers = beauty ? KILN_LAYERS_BEAUTY : KILN_LAYERS_ALL;
    }
    return true;
}

static struct kiln_frame_layer view_display(const struct kiln_picture *picture)
{
    const size_t bytes = picture->bits / 8;
    return (struct kiln_frame_layer){
        .size = sizeof(struct kiln_frame_layer),
        .layer = DISPLAY,
        .frame = picture->frame,
        .width = picture->width,
        .height = picture->height,
        .channels = 4,
        .samples = bytes == 1 ? KILN_SAMPLES_UINT8 : KILN_SAMPLES_UINT16,
        .row_bytes = 4 * bytes * picture->width,
        .pixels = picture->display,
    };
}

static struct kiln_frame_layer view_layer(const struct kiln_picture *picture,
                                          const struct kiln_layer *layer)
{
    return (struct kiln_frame_layer){
        .size = sizeof(struct kiln_frame_layer),
        .layer = layer->name,
        .frame = picture->frame,
        .width = picture->width,
        .height = picture->height,
        .channels = layer->channels,
        .samples = KILN_SAMPLES_FLOAT,
        .row_bytes = sizeof(float) * layer->channels * picture->width,
        .pixels = layer->pixels,
    };
}

bool kiln_views_find(const struct kiln_picture *picture, const char *name,
                     struct kiln_frame_layer *view)
{
    if (strcmp(name, DISPLAY) == 0 && picture->display) {
        *view = view_display(picture);
        return true;
    }
    for (uint32_t k = 0; k < picture->layer_count; k++) {
        if (strcmp(name, picture->layers[k].name) == 0) {
            *view = view_layer(picture, &picture->layers[k]);
            return true;
        }
    }
    return false;
}

void kiln_views_show(const struct kiln_render_params *params, const struct kiln_picture *picture)
{
    size_t count;
    const char *const *names = wanted(params, &count);
    for (size_t i = 0; params->picture && i < count; i++) {
        struct kiln_frame_layer view;
        if (kiln_views_find(picture, names[i], &view))
            params->picture(params->user, &view);
    }
}
