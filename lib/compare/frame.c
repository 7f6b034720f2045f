/* Compares one frame of two sides. Both sides give their layers in one order, so layers of one name
 * are paired as in a merge, and memory holds one pair at a time and the one that is drawn. */
#include "compare/frame.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "compare/values.h"

/* The layers that a picture of the difference shows: the first colours that differ or else, the
 * first data that do, or else the first layer. */
struct shown {
    struct kiln_compare_picture *pictures[2];
    float *errors;
    int rank; /* 2: colours that differ, 1: data that differ */
};

struct comparing {
    struct kiln_frame_comparer *comparer;
    struct kiln_compare_frame *frame;
    struct kiln_arena *arena;
    struct kiln_error *error;
    struct kiln_image_layer next[2];   /* without an image behind the last layer of a side */
    struct kiln_compare_layer *layers; /* in the arena */
    size_t count, capacity;
    struct shown shown;
};

static bool no_memory(const struct comparing *c)
{
    return kiln_error_no_memory(c->error, "comparing %s", c->frame->name);
}

/* ---- one layer ------------------------------------------------------------------------------- */

static struct kiln_compare_layer *add_layer(struct comparing *c, const char *name)
{
    if (c->count == c->capacity) {
        const size_t capacity = 2 * c->capacity + 8;
        struct kiln_compare_layer *more = kiln_arena_alloc(c->arena, capacity, sizeof *more);
        if (more && c->count > 0)
            memcpy(more, c->layers, c->count * sizeof *more);
        c->layers = more;
        c->capacity = more ? capacity : 0;
    }
    const char *copy = c->layers ? kiln_arena_text(c->arena, name, strlen(name)) : NULL;
    if (!copy) {
        no_memory(c);
        return NULL;
    }
    struct kiln_compare_layer *layer = &c->layers[c->count++];
    *layer = (struct kiln_compare_layer){.size = sizeof *layer, .name = copy, .message = ""};
    return layer;
}

static bool is_drawn(const struct comparing *c)
{
    return c->comparer->params->diff || c->comparer->params->error_map;
}

static void drop_shown(struct shown *shown)
{
    kiln_compare_picture_destroy(&shown->pictures[0]);
    kiln_compare_picture_destroy(&shown->pictures[1]);
    free(shown->errors);
    *shown = (struct shown){0};
}

/* Keeps the layer to be drawn, if none before it comes first. The pictures and the errors are taken
 * or freed. */
static void keep_shown(struct comparing *c, struct shown *shown,
                       const struct kiln_compare_layer *layer)
{
    shown->rank = layer->verdict == KILN_COMPARE_SAME ? 0 : layer->data ? 1 : 2;
    const bool first = !c->shown.errors || shown->rank > c->shown.rank;
    struct shown *dropped = first ? &c->shown : shown;
    drop_shown(dropped);
    if (first)
        c->shown = *shown;
}

/* Makes the mask for a pair of pictures of one size. *mask is NULL without masks. */
static bool make_mask(const struct comparing *c, const struct kiln_mask **mask)
{
    struct kiln_frame_comparer *comparer = c->comparer;
    const struct kiln_compare_params *params = comparer->params;
    const uint32_t width = c->next[0].image->width, height = c->next[0].image->height;
    *mask = NULL;
    if (params->mask_count == 0)
        return true;
    *mask = &comparer->mask;
    return (comparer->mask.width == width && comparer->mask.height == height) ||
           kiln_mask_make(&comparer->mask, params->masks, params->mask_count, width, height,
                          c->error);
}

static bool has_floats(const struct comparing *c, int side)
{
    return c->next[side].image->type == KILN_IMAGE_F32;
}

/* Chooses how FLIP judges light. What integers cannot hold is a difference, so a mixed pair is
 * judged as floats are. */
static bool choose_hdr(const struct comparing *c)
{
    const enum kiln_compare_mode mode = c->comparer->params->mode;
    const bool hdr =
        mode == KILN_COMPARE_AUTO ? has_floats(c, 0) || has_floats(c, 1) : mode == KILN_COMPARE_HDR;
    c->comparer->hdr = hdr;
    return hdr;
}

/* Makes the sentence that says how the kinds of two files differ. */
static bool note_kinds(const struct comparing *c, struct kiln_compare_picture *const pictures[2],
                       struct kiln_compare_layer *layer)
{
    const char *alpha = kiln_compare_alpha_note(pictures[0], pictures[1]);
    layer->message = alpha;
    if (has_floats(c, 0) == has_floats(c, 1))
        return true;
    layer->message =
        kiln_arena_format(c->arena, "the reference is of %s, the test of %s%s%s",
                          has_floats(c, 0) ? "floats" : "integers",
                          has_floats(c, 1) ? "floats" : "integers", *alpha ? "; " : "", alpha);
    return layer->message || no_memory(c);
}

static bool make_pictures(const struct comparing *c, const struct kiln_mask *mask,
                          struct kiln_compare_picture *pictures[2])
{
    const struct kiln_frame_comparer *comparer = c->comparer;
    for (int i = 0; i < 2; i++) {
        char name[KILN_PATH_SIZE]; /* for messages */
        const struct kiln_footage *footage = comparer->footage[i];
        const bool still = kiln_footage_kind(footage) == KILN_FOOTAGE_STILL;
        const bool beauty = strcmp(c->next[i].name, "beauty") == 0;
        snprintf(name, sizeof name, "%s%s%s%s%s", kiln_footage_path(footage),
                 still ? "" : ": frame ", still ? "" : c->frame->name, beauty ? "" : ": layer ",
                 beauty ? "" : c->next[i].name);
        pictures[i] = kiln_compare_picture_create(c->next[i].image, mask ? mask->masked : NULL,
                                                  name, comparer->threads, c->error);
        if (!pictures[i])
            return false;
    }
    if (!kiln_compare_pictures_agree(pictures, c->error))
        return false;
    if (mask)
        kiln_mask_apply(mask, pictures[0], pictures[1]);
    return true;
}

static void note_places(const struct kiln_measurement *measurement,
                        struct kiln_compare_layer *layer)
{
    const struct kiln_level_difference *d = &measurement->levels;
    layer->equal = d->maximum == 0.0;
    layer->worst_x = d->x;
    layer->worst_y = d->y;
    layer->window_x = d->window_x;
    layer->window_y = d->window_y;
    layer->window_width = d->window_width;
    layer->window_height = d->window_height;
    layer->window_differing = (uint32_t)d->window_differing;
}

/* Measures a pair of pictures and judges it by the limits. */
static bool measure(struct comparing *c, struct kiln_compare_picture *pictures[2],
                    struct kiln_compare_layer *layer)
{
    const struct kiln_compare_params *params = c->comparer->params;
    struct kiln_measurement measurement = {0};
    const struct kiln_measure_params how = {.hdr = choose_hdr(c),
                                            .pixels_per_degree = params->pixels_per_degree,
                                            .threshold = params->threshold,
                                            .window = params->window};
    const bool ok = kiln_measurement_take(&measurement, pictures[0], pictures[1], &how,
                                          c->comparer->threads, c->error) &&
                    kiln_metric_set_judge(&c->comparer->set, &measurement, layer, c->error) &&
                    note_kinds(c, pictures, layer);
    if (ok) {
        layer->measured = true;
        note_places(&measurement, layer);
        c->frame->flip_s += measurement.flip_s;
    }
    if (ok && is_drawn(c)) {
        struct shown shown = {.pictures = {pictures[0], pictures[1]}, .errors = measurement.errors};
        pictures[0] = pictures[1] = NULL;
        measurement.errors = NULL;
        keep_shown(c, &shown, layer);
    }
    kiln_measurement_finish(&measurement);
    return ok;
}

static bool compare_colors(struct comparing *c, const struct kiln_mask *mask,
                           struct kiln_compare_layer *layer)
{
    struct kiln_compare_picture *pictures[2] = {NULL, NULL};
    const bool ok = make_pictures(c, mask, pictures) && measure(c, pictures, layer);
    kiln_compare_picture_destroy(&pictures[0]);
    kiln_compare_picture_destroy(&pictures[1]);
    return ok;
}

/* Compares a pair of layers by their numbers. */
static bool compare_data(struct comparing *c, const struct kiln_mask *mask,
                         struct kiln_compare_layer *layer)
{
    const struct kiln_asset_image *const images[2] = {c->next[0].image, c->next[1].image};
    const uint8_t *masked = mask ? mask->masked : NULL;
    const double limit = c->comparer->params->data_limit;
    struct kiln_value_difference difference;
    kiln_values_compare(images[0], images[1], masked, &difference);
    layer->data = true;
    layer->difference = difference.largest;
    layer->differing = difference.differing;
    layer->worst_x = difference.x;
    layer->worst_y = difference.y;
    layer->equal = difference.differing == 0;
    layer->score = limit > 0 && isfinite(difference.largest) ? difference.largest / limit
                   : difference.largest > 0                  ? INFINITY
                                                             : 0;
    if (difference.largest > limit)
        layer->verdict = KILN_COMPARE_DIFFERENT;
    if (images[0]->channels != images[1]->channels) {
        layer->verdict = KILN_COMPARE_DIFFERENT;
        layer->message = "the numbers of channels differ";
        layer->score = INFINITY;
    }
    struct shown shown = {.errors = NULL};
    if (!is_drawn(c))
        return true;
    if (!kiln_values_show(images, masked, difference.largest, shown.pictures, &shown.errors,
                          c->error))
        return false;
    keep_shown(c, &shown, layer);
    return true;
}

/* Compares the two layers of a name. */
static bool compare_pair(struct comparing *c)
{
    const struct kiln_asset_image *const images[2] = {c->next[0].image, c->next[1].image};
    const struct kiln_mask *mask;
    struct kiln_compare_layer *layer = add_layer(c, c->next[0].name);
    if (!layer)
        return false;
    c->frame->width = images[0]->width;
    c->frame->height = images[0]->height;
    if (images[0]->width != images[1]->width || images[0]->height != images[1]->height) {
        layer->verdict = KILN_COMPARE_DIFFERENT;
        layer->score = INFINITY;
        layer->message = kiln_arena_format(
            c->arena, "the sizes differ: the reference has %u x %u pixels, the test %u x %u",
            images[0]->width, images[0]->height, images[1]->width, images[1]->height);
        return layer->message || no_memory(c);
    }
    if (!make_mask(c, &mask))
        return false;
    return c->next[0].data || c->next[1].data ? compare_data(c, mask, layer)
                                              : compare_colors(c, mask, layer);
}

/* ---- all layers ------------------------------------------------------------------------------ */

static bool read_layer(struct comparing *c, int side)
{
    kiln_asset_image_destroy(&c->next[side].image);
    return kiln_footage_next_layer(c->comparer->footage[side], &c->next[side], c->error);
}

/* Notes that only one side has a layer. */
static bool note_single(struct comparing *c, int side)
{
    struct kiln_compare_layer *layer = add_layer(c, c->next[side].name);
    if (!layer)
        return false;
    layer->verdict = side == 0 ? KILN_COMPARE_MISSING : KILN_COMPARE_EXTRA;
    layer->message = side == 0 ? "only in the reference" : "only in the test";
    layer->data = c->next[side].data;
    layer->score = INFINITY;
    return true;
}

static bool compare_layers(struct comparing *c)
{
    bool ok = read_layer(c, 0) && read_layer(c, 1);
    while (ok && (c->next[0].image || c->next[1].image)) {
        int side = c->next[0].image ? 0 : 1;
        int order = c->next[0].image && c->next[1].image
                        ? kiln_order_layers(c->next[0].name, c->next[1].name)
                        : (side == 0 ? -1 : 1);
        if (order == 0)
            ok = compare_pair(c) && read_layer(c, 0) && read_layer(c, 1);
        else
            ok = note_single(c, order > 0) && read_layer(c, order > 0);
    }
    return ok;
}

/* Opens both sides even if the first fails, so that they stay in step. */
static bool open_layers(struct comparing *c)
{
    struct kiln_error errors[2] = {0};
    bool ok = true;
    for (int i = 0; i < 2; i++)
        ok = kiln_footage_open_layers(c->comparer->footage[i], &errors[i]) && ok;
    if (!ok)
        *c->error = errors[0].code != KILN_OK ? errors[0] : errors[1];
    return ok;
}

/* Takes the values of a layer into those of the frame, if they are worse. */
static void add_values(const struct comparing *c, const struct kiln_compare_layer *layer)
{
    struct kiln_compare_frame *frame = c->frame;
    const bool first = !frame->measured;
    for (size_t i = 0; i < c->comparer->set.count; i++) {
        if (first ||
            kiln_metric_set_is_worse(&c->comparer->set, i, layer->values[i], frame->values[i]))
            frame->values[i] = layer->values[i];
        frame->beyond[i] = frame->beyond[i] || layer->beyond[i];
    }
    frame->measured = true;
    if (!first && !(layer->score > frame->score))
        return;
    frame->worst_x = layer->worst_x;
    frame->worst_y = layer->worst_y;
    frame->window_x = layer->window_x;
    frame->window_y = layer->window_y;
    frame->window_width = layer->window_width;
    frame->window_height = layer->window_height;
    frame->window_differing = layer->window_differing;
}

/* Makes the frame's verdict and values of those of its layers. */
static bool add_up(const struct comparing *c)
{
    struct kiln_compare_frame *frame = c->frame;
    frame->layers = c->layers;
    frame->layer_count = c->count;
    frame->layer_stride = sizeof *c->layers;
    frame->equal = true;
    frame->message = c->count == 1 ? c->layers[0].message : "";
    size_t differing = 0;
    for (size_t i = 0; i < c->count; i++) {
        const struct kiln_compare_layer *layer = &c->layers[i];
        if (layer->measured)
            add_values(c, layer);
        frame->score = layer->score > frame->score ? layer->score : frame->score;
        frame->equal = frame->equal && layer->equal;
        differing += layer->verdict != KILN_COMPARE_SAME;
    }
    frame->verdict = differing > 0 ? KILN_COMPARE_DIFFERENT : KILN_COMPARE_SAME;
    if (c->count > 1 && differing > 0)
        frame->message =
            kiln_arena_format(c->arena, "%zu of %zu layers differ", differing, c->count);
    return frame->message || no_memory(c);
}

static bool write_pictures(const struct comparing *c, uint32_t number)
{
    const struct kiln_frame_comparer *comparer = c->comparer;
    const struct kiln_difference_plan *plans[] = {comparer->params->diff ? &comparer->diff : NULL,
                                                  comparer->params->error_map ? &comparer->error_map
                                                                              : NULL};
    bool ok = true;
    for (size_t i = 0; i < 2; i++)
        ok = ok && (!plans[i] || !c->shown.errors ||
                    kiln_difference_write(plans[i], c->frame->name, number, c->shown.pictures[0],
                                          c->shown.pictures[1], c->shown.errors, c->error));
    return ok;
}

bool kiln_frame_compare(struct kiln_frame_comparer *comparer, struct kiln_compare_frame *frame,
                        uint32_t number, struct kiln_arena *arena, struct kiln_error *fault,
                        struct kiln_error *error)
{
    struct comparing c = {.comparer = comparer, .frame = frame, .arena = arena, .error = error};
    const bool read = open_layers(&c) && compare_layers(&c);
    if (!read && error->code == KILN_IO) /* nothing was written yet: a file cannot be read */
        error->code = KILN_INVALID_INPUT;
    bool ok = read ? add_up(&c) && write_pictures(&c, number) : error->code == KILN_INVALID_INPUT;
    if (!read && ok) {
        *fault = *error;
        *frame = (struct kiln_compare_frame){.size = frame->size,
                                             .name = frame->name,
                                             .verdict = KILN_COMPARE_UNREADABLE,
                                             .message = fault->message};
    }
    for (int i = 0; i < 2; i++)
        kiln_asset_image_destroy(&c.next[i].image);
    drop_shown(&c.shown);
    return ok;
}

void kiln_frame_comparer_finish(struct kiln_frame_comparer *comparer)
{
    kiln_mask_finish(&comparer->mask);
    for (int i = 0; i < 2; i++)
        kiln_footage_close(&comparer->footage[i]);
}
