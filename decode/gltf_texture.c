/* This file moves the texture coordinates of a primitive to where its base colour texture is looked
 * up (KHR_texture_transform), and makes them count from the bottom of a picture, as those of other
 * formats do; glTF counts from the top. Files with integers as coordinates depend on the transform,
 * which gives them their scale. */
#include <stddef.h>
#include <string.h>

#include "gltf.h"

/* Finds sine and cosine, within 1e-15 for angles of up to a thousand turns. They are sums of a
 * series, since a library's functions differ from machine to machine. */
static void find_sine(double angle, double *sine, double *cosine)
{
    const double quarter = 1.5707963267948966, rest_of_quarter = 6.123233995736766e-17;
    const double turns = angle / quarter;
    const long count =
        turns > -4000.0 && turns < 4000.0 ? (long)(turns + (turns < 0 ? -0.5 : 0.5)) : 0;
    const double x = angle - (double)count * quarter - (double)count * rest_of_quarter;
    double s = 0.0, c = 0.0, term = 1.0;
    for (int i = 0; i < 20; i++) {
        *(i % 2 ? &s : &c) += i % 4 < 2 ? term : -term;
        term *= x / (i + 1);
    }
    const long part = (count % 4 + 4) % 4;
    *sine = part == 0 ? s : part == 1 ? c : part == 2 ? -s : -c;
    *cosine = part == 0 ? c : part == 1 ? -s : part == 2 ? -c : s;
}

static double number_of(const json_t *value, double otherwise)
{
    double number = otherwise;
    return gltf_number(value, &number) ? number : otherwise;
}

/* Gets a pair of numbers. */
static void get_pair(const json_t *array, double otherwise, double pair[2])
{
    for (size_t i = 0; i < 2; i++)
        pair[i] = number_of(gltf_item(array, i), otherwise);
}

/* The struct holds what an extension says of texture coordinates. */
struct transform {
    double offset[2], scale[2], sine, cosine;
};

static struct transform get_transform(const json_t *json)
{
    struct transform t;
    get_pair(gltf_member(json, "offset"), 0.0, t.offset);
    get_pair(gltf_member(json, "scale"), 1.0, t.scale);
    find_sine(number_of(gltf_member(json, "rotation"), 0.0), &t.sine, &t.cosine);
    return t;
}

bool gltf_get_transform(const json_t *texture, double rows[2][3])
{
    const json_t *json = gltf_extension(texture, "KHR_texture_transform");
    if (!json)
        return false;
    const struct transform t = get_transform(json);
    const double x[3] = {t.cosine * t.scale[0], t.sine * t.scale[1], t.offset[0]};
    const double y[3] = {-t.sine * t.scale[0], t.cosine * t.scale[1], t.offset[1]};
    /* The extension's numbers count from the top of a picture, before and behind it. */
    const double from_bottom[2][3] = {{x[0], -x[1], x[1] + x[2]}, {-y[0], y[1], 1.0 - y[1] - y[2]}};
    memcpy(rows, from_bottom, sizeof from_bottom);
    return true;
}

static void transform(const json_t *json, struct gltf_primitive *primitive)
{
    const struct transform t = get_transform(json);
    for (size_t i = 0; i < primitive->vertex_count; i++) {
        float *uv = primitive->uvs[i];
        const double u = t.scale[0] * (double)uv[0], v = t.scale[1] * (double)uv[1];
        uv[0] = (float)(t.cosine * u + t.sine * v + t.offset[0]);
        uv[1] = (float)(t.cosine * v - t.sine * u + t.offset[1]);
    }
}

/* Makes texture coordinates count from the bottom. */
static void turn(float (*uvs)[2], size_t count)
{
    for (size_t i = 0; uvs && i < count; i++)
        uvs[i][1] = (float)(1.0 - (double)uvs[i][1]);
}

void gltf_place_uvs(const struct gltf *g, struct gltf_primitive *primitive)
{
    const json_t *material = gltf_element(g, GLTF_MATERIALS, primitive->material);
    const json_t *looks = gltf_member(material, "pbrMetallicRoughness");
    const json_t *texture = gltf_member(looks, "baseColorTexture");
    const json_t *extension = gltf_extension(texture, "KHR_texture_transform");
    const json_t *set = gltf_member(extension, "texCoord");
    if (!set)
        set = gltf_member(texture, "texCoord");
    /* a mesh that is read with its materials has the transform in them */
    if (primitive->uvs && extension && number_of(set, 0.0) == 0.0 && !g->wanted->materials)
        transform(extension, primitive);
    turn(primitive->uvs, primitive->vertex_count);
    turn(primitive->second_uvs, primitive->vertex_count);
}
