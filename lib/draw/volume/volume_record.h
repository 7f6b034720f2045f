/* This header records how rays of a packet are dimmed and lit on their way, and makes profiles of
 * it (volume_profile.h). Records begin where the packet meets gas, a step apart. Each time that
 * there are too many, every second one is dropped, and from then on they lie twice as far apart.
 *
 * A profile has those of the recorded places between which straight lines stay close to all records
 * (Bristol, "Swinging door trending", 1990): the slopes of the lines from a place that are close to
 * all records so far are a range, which each record narrows, until it is empty. */
#ifndef KILN_DRAW_VOLUME_VOLUME_RECORD_H
#define KILN_DRAW_VOLUME_VOLUME_RECORD_H

#include "draw/volume/volume_profile.h"

enum {
    RECORDED = VOLUME_NODE_FLAME + 3, /* numbers that are recorded at a place */
    RECORDS = 64,                     /* most records of a packet */
    RECORD_CURVES = 3                 /* optical depth; luminance of smoke and of flames */
};

/* How far a profile may lie from the records: optical depth; a part of the light at a place, and of
 * all light of the ray. */
#define RECORD_DEPTH_ERROR 0.006f
#define RECORD_LIGHT_ERROR 0.006f
#define RECORD_ALL_ERROR   0.001f

struct record {
    struct eight nodes[RECORDS][RECORDED];
    uint32_t count; /* of nodes */
    float first;    /* step at whose begin the first one lies */
    float stride;   /* steps from one to the next */
};

/* Adds records up to the begin of a step, at which all have the same numbers: nothing has been seen
 * since the last one of them. */
SIMD void record_until(struct record *r, float step, const struct eight now[RECORDED])
{
    if (r->count == 0) {
        r->first = step;
        r->stride = 1.0f;
    }
    while (r->first + (float)r->count * r->stride <= step) {
        if (r->count == RECORDS) {
            for (uint32_t i = 1; i < RECORDS / 2; i++)
                memcpy(r->nodes[i], r->nodes[(size_t)2 * i], sizeof r->nodes[i]);
            r->count = RECORDS / 2;
            r->stride *= 2.0f;
            continue;
        }
        memcpy(r->nodes[r->count++], now, sizeof r->nodes[0]);
    }
}

/* Adds a last record behind all that was seen. step: the end of the last one that was drawn. */
SIMD void record_end(struct record *r, float step, const struct eight now[RECORDED])
{
    record_until(r, step, now);
    const float last = r->first + (float)(r->count - 1) * r->stride;
    if (last < step)
        record_until(r, last + r->stride, now);
}

/* Returns a number of a curve at a record. */
SIMD vf record_curve(const struct record *r, uint32_t at, int curve, int part)
{
    const struct eight *n = r->nodes[at];
    if (curve == 0)
        return n[VOLUME_NODE_DEPTH].part[part];
    n += curve == 1 ? VOLUME_NODE_SMOKE : VOLUME_NODE_FLAME;
    return 0.25f * n[0].part[part] + 0.5f * n[1].part[part] + 0.25f * n[2].part[part];
}

/* The slopes that lines from a place may have. */
struct slopes {
    struct eight least[RECORD_CURVES], most[RECORD_CURVES];
};

SIMD void any_slopes(struct slopes *s)
{
    for (int c = 0; c < RECORD_CURVES; c++)
        EIGHT_EACH(k)
        {
            s->least[c].part[k] = vf_all(-1e30f);
            s->most[c].part[k] = vf_all(1e30f);
        }
}

/* Narrows slopes by a record. error: a factor on the errors that are allowed. Returns whether no
 * slope is left. */
SIMD bool narrow_slopes(struct slopes *s, const struct record *r, uint32_t from, uint32_t to,
                        float error)
{
    const float inverse = 1.0f / (float)(to - from);
    vi none = vi_all(0);
    for (int c = 0; c < RECORD_CURVES; c++)
        EIGHT_EACH(k)
        {
            const vf here = record_curve(r, to, c, k), rise = here - record_curve(r, from, c, k);
            const vf all = record_curve(r, r->count - 1, c, k);
            const vf most = c == 0 ? vf_all(error * RECORD_DEPTH_ERROR)
                                   : error * (RECORD_LIGHT_ERROR * here + RECORD_ALL_ERROR * all);
            s->least[c].part[k] = vf_max(s->least[c].part[k], (rise - most) * inverse);
            s->most[c].part[k] = vf_min(s->most[c].part[k], (rise + most) * inverse);
            none |= s->least[c].part[k] > s->most[c].part[k];
        }
    return any(none);
}

/* Chooses the records that become the places of a profile. Returns their number, or 0 if that is
 * too large. */
SIMD uint32_t choose_places(const struct record *r, float error, uint8_t chosen[VOLUME_NODES])
{
    struct slopes slopes;
    uint32_t count = 1, from = 0;
    chosen[0] = 0;
    any_slopes(&slopes);
    for (uint32_t i = 1; i < r->count; i++) {
        if (!narrow_slopes(&slopes, r, from, i, error))
            continue;
        if (count + 1 >= VOLUME_NODES)
            return 0;
        from = i - 1 > from ? i - 1 : i;
        chosen[count++] = (uint8_t)from;
        any_slopes(&slopes);
        if (from < i)
            narrow_slopes(&slopes, r, from, i, error);
    }
    if (from < r->count - 1)
        chosen[count++] = (uint8_t)(r->count - 1);
    return count;
}

/* Writes numbers of a packet in the form that profiles have. */
SIMD void write_node(const struct eight numbers[RECORDED], uint16_t *to)
{
    _Alignas(32) int32_t columns[RECORDED][8];
    for (int i = 0; i < RECORDED; i++)
        EIGHT_EACH(k)
        {
            const vf x = numbers[i].part[k];
            vi bits = ((vi)x + 0x8000) >> 16; /* x is not negative */
            if (i == VOLUME_NODE_DEPTH)
                bits = vi_of(vf_min(x * (1.0f / VOLUME_DEPTH_UNIT) + 0.5f, vf_all(65535.0f)));
            memcpy(columns[i] + (ptrdiff_t)k * LANES, &bits, sizeof bits);
        }
    for (int lane = 0; lane < VOLUME_PACKET; lane++, to += VOLUME_NODE) {
        for (int i = 0; i < RECORDED; i++)
            to[i] = (uint16_t)columns[i][lane];
        to[RECORDED] = 0;
    }
}

/* Makes the profiles of a packet. */
SIMD struct kiln_volume_profile *write_record(const struct record *r,
                                              struct kiln_volume_domain *domain)
{
    uint8_t chosen[VOLUME_NODES];
    float error = 1.0f;
    uint32_t count = choose_places(r, error, chosen);
    while (count == 0) {
        error *= 1.25f;
        count = choose_places(r, error, chosen);
    }
    struct kiln_volume_profile *to = kiln_volume_profile_take(domain, count);
    for (uint32_t i = 0; i < count; i++) {
        kiln_volume_places(to)[i] = r->first + (float)chosen[i] * r->stride;
        write_node(r->nodes[chosen[i]], kiln_volume_node(to, i));
    }
    return to;
}

#endif
