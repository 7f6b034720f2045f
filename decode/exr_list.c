/* This file lists the layers of an OpenEXR file: channels that have a prefix in common and make a
 * colour or a vector are one layer, and each other channel is one of its own. A layer has the name
 * by which decode_exr_find_layer finds it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "asset/image/layers_in.h"
#include "base/error.h"
#include "exr.h"

struct listing {
    const struct exr_reading *file;
    struct exr_reading *layers;
    size_t count;

    /* the part at hand */
    int part;
    const char *part_name; /* "" for the only part of a file */
    const exr_attr_chlist_t *channels;
    size_t first; /* of its layers */
};

static bool refuse(const struct listing *listing, const char *what)
{
    return kiln_error_set(listing->file->picture->error, KILN_INVALID_INPUT, "the EXR image has %s",
                          what);
}

static bool has_layer(const struct listing *listing, const char *name)
{
    bool found = false;
    for (size_t i = 0; i < listing->count && !found; i++)
        found = strcmp(listing->layers[i].name, name) == 0;
    return found;
}

/* Returns whether a layer of the part at hand holds the channel already. */
static bool is_taken(const struct listing *listing, const char *channel)
{
    for (size_t i = listing->first; i < listing->count; i++) {
        for (int role = 0; role < EXR_ROLES; role++) {
            if (listing->layers[i].layer.names[role] == channel)
                return true;
        }
    }
    return false;
}

/* Returns whether none of the layer's channels belongs to a layer already. */
static bool is_new(const struct listing *listing, const struct exr_layer *layer)
{
    for (int role = 0; role < EXR_ROLES; role++) {
        if (layer->names[role] && is_taken(listing, layer->names[role]))
            return false;
    }
    return true;
}

static bool fits(const struct listing *listing, const char *name, const char *part,
                 const char *rest, char out[KILN_LAYER_NAME_SIZE])
{
    const int length =
        part ? snprintf(out, KILN_LAYER_NAME_SIZE, "%s%s%s", part, *rest ? "." : "", rest)
             : snprintf(out, KILN_LAYER_NAME_SIZE, "%s", name);
    return length > 0 && length < KILN_LAYER_NAME_SIZE && !has_layer(listing, out);
}

/* Adds a layer. If there is one of its name already, it is called "PART.rest" or, if it is one
 * channel, like its channel. */
static bool add(struct listing *listing, const struct exr_layer *layer, const char *name,
                const char *rest)
{
    if (listing->count == KILN_MAX_IMAGE_LAYERS)
        return refuse(listing, "more than 1024 layers");
    const char *part = *listing->part_name ? listing->part_name : NULL;
    const char *channel = layer->grey ? layer->names[EXR_RED] : name;
    struct exr_reading *added = &listing->layers[listing->count];
    *added = (struct exr_reading){.picture = listing->file->picture,
                                  .file = listing->file->file,
                                  .part = listing->part,
                                  .layer = *layer};
    if (!fits(listing, name, NULL, NULL, added->name) &&
        !(part && fits(listing, NULL, part, rest, added->name)) &&
        !fits(listing, channel, NULL, NULL, added->name))
        return kiln_error_set(listing->file->picture->error, KILN_INVALID_INPUT,
                              "the EXR image has two layers '%s', or one with a name of more than "
                              "511 bytes; a layer can be chosen by its name",
                              added->name);
    listing->count++;
    return decode_exr_describe(added, listing->channels);
}

/* Adds the layer of the channels without a prefix: the picture or, if a part before has that, the
 * layer that is called like the part. */
static bool add_bare(struct listing *listing, const char *channel)
{
    const char *part = listing->part_name;
    const struct exr_words words = decode_exr_words(listing->channels, "");
    struct exr_layer layer;
    if (!has_layer(listing, "beauty") && decode_exr_choose(&words, false, &layer) &&
        is_new(listing, &layer))
        return add(listing, &layer, "beauty", "");
    const char *depth = words.channels[EXR_WORD_X] ? NULL : words.channels[EXR_WORD_Z];
    if (*part && decode_exr_choose(&words, true, &layer) && is_new(listing, &layer) &&
        layer.names[EXR_RED] != depth)
        return add(listing, &layer, part, "");
    decode_exr_choose_one(channel, &layer);
    return add(listing, &layer, channel == depth ? "depth" : channel, channel);
}

static bool add_prefixed(struct listing *listing, const char *channel, const char *dot)
{
    char prefix[KILN_LAYER_NAME_SIZE] = "";
    struct exr_layer layer;
    if (dot - channel < KILN_LAYER_NAME_SIZE)
        snprintf(prefix, sizeof prefix, "%.*s", (int)(dot - channel), channel);
    const struct exr_words words = decode_exr_words(listing->channels, prefix);
    if (*prefix && decode_exr_choose(&words, true, &layer) && is_new(listing, &layer))
        return add(listing, &layer, prefix, prefix);
    decode_exr_choose_one(channel, &layer);
    return add(listing, &layer, channel, channel);
}

/* Lists the layers of the channels with or without a prefix. A layer may not hold the channel that
 * led to it, such as Z beside R, G and B: then the channel's turn comes again. */
static bool list_channels(struct listing *listing, bool prefixed)
{
    for (int i = 0; i < listing->channels->num_channels; i++) {
        const char *channel = listing->channels->entries[i].name.str;
        const char *dot = strrchr(channel, '.');
        while ((dot != NULL) == prefixed && !is_taken(listing, channel)) {
            if (!(dot ? add_prefixed(listing, channel, dot) : add_bare(listing, channel)))
                return false;
        }
    }
    return true;
}

static int compare_layers(const void *a, const void *b)
{
    return kiln_order_layers(((const struct exr_reading *)a)->name,
                             ((const struct exr_reading *)b)->name);
}

bool decode_exr_list(const struct exr_reading *file, struct exr_reading **list, size_t *count)
{
    struct listing listing = {.file = file};
    int parts = 0;
    listing.layers = calloc(KILN_MAX_IMAGE_LAYERS, sizeof *listing.layers);
    if (!listing.layers)
        return decode_out_of_memory(file->picture->error);
    exr_result_t code = exr_get_count(file->file, &parts);
    bool ok = true;
    for (int part = 0; ok && code == EXR_ERR_SUCCESS && part < parts; part++) {
        const char *name = NULL;
        if (parts == 1 || exr_get_name(file->file, part, &name) != EXR_ERR_SUCCESS || !name)
            name = "";
        listing.part = part;
        listing.part_name = name;
        listing.first = listing.count;
        code = exr_get_channels(file->file, part, &listing.channels);
        ok = code == EXR_ERR_SUCCESS && list_channels(&listing, true) &&
             list_channels(&listing, false);
    }
    if (code != EXR_ERR_SUCCESS)
        ok = decode_exr_fail(file, code);
    ok = ok && (listing.count > 0 || refuse(&listing, "no channels"));
    if (ok)
        qsort(listing.layers, listing.count, sizeof *listing.layers, compare_layers);
    else
        free(listing.layers);
    *list = ok ? listing.layers : NULL;
    *count = ok ? listing.count : 0;
    return ok;
}
