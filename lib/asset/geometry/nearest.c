/* This file finds how far a point is from the triangles of a mesh, by a tree of bounding boxes. The
 * tree is built by halving boxes at the middle of their longest edge. */
#include "asset/geometry/nearest.h"

#include <stdlib.h>
#include <string.h>

/* LEAF: most triangles of a leaf, except at DEPTH, where a leaf has all that are left. */
enum { LEAF = 4, STACK = 128, DEPTH = 48 };

struct node {
    float min[3], max[3];
    /* of a leaf: its first triangle; else the second child; the first child follows the node */
    uint32_t first;
    uint32_t count; /* triangles of a leaf; 0: the node is no leaf */
};

struct kiln_nearest {
    const struct kiln_mesh *mesh;
    uint32_t *order; /* triangles, in the order of the leaves */
    struct node *nodes;
    uint32_t node_count;
};

/* ---- vectors and boxes ----------------------------------------------------------------------- */

struct vec {
    double x, y, z;
};

static struct vec corner(const struct kiln_mesh *mesh, uint32_t triangle, int c)
{
    const float *v = mesh->vertices[mesh->triangles[triangle][c]];
    return (struct vec){(double)v[0], (double)v[1], (double)v[2]};
}

static struct vec sub(struct vec a, struct vec b)
{
    return (struct vec){a.x - b.x, a.y - b.y, a.z - b.z};
}

static double dot(struct vec a, struct vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static struct vec cross(struct vec a, struct vec b)
{
    return (struct vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static double least(double a, double b)
{
    return a < b ? a : b;
}

static double segment_square(struct vec p, struct vec a, struct vec b)
{
    const struct vec way = sub(b, a), from = sub(p, a);
    const double length2 = dot(way, way);
    double part = length2 > 0.0 ? dot(from, way) / length2 : 0.0;
    part = part < 0.0 ? 0.0 : part > 1.0 ? 1.0 : part;
    const struct vec off = {from.x - part * way.x, from.y - part * way.y, from.z - part * way.z};
    return dot(off, off);
}

static double triangle_square(const struct kiln_mesh *mesh, uint32_t triangle, struct vec p)
{
    const struct vec a = corner(mesh, triangle, 0), b = corner(mesh, triangle, 1);
    const struct vec c = corner(mesh, triangle, 2);
    const struct vec normal = cross(sub(b, a), sub(c, a));
    const double length2 = dot(normal, normal);
    const bool above = length2 > 0.0 && dot(cross(sub(b, a), sub(p, a)), normal) >= 0.0 &&
                       dot(cross(sub(c, b), sub(p, b)), normal) >= 0.0 &&
                       dot(cross(sub(a, c), sub(p, c)), normal) >= 0.0;
    if (above) {
        const double height = dot(sub(p, a), normal);
        return height * height / length2;
    }
    return least(segment_square(p, a, b), least(segment_square(p, b, c), segment_square(p, c, a)));
}

static double box_square(const struct node *node, const double p[3])
{
    double sum = 0.0;
    for (int c = 0; c < 3; c++) {
        const double below = (double)node->min[c] - p[c], above = p[c] - (double)node->max[c];
        const double off = below > 0.0 ? below : above > 0.0 ? above : 0.0;
        sum += off * off;
    }
    return sum;
}

/* Returns where a ray enters a box, or `most` if it is not before that. */
static double box_along(const struct node *node, const struct kiln_nearest_ray *ray, double most)
{
    double in = 0.0, out = most;
    for (int c = 0; c < 3; c++) {
        const double below = (double)node->min[c] - ray->from[c];
        const double above = (double)node->max[c] - ray->from[c];
        if (ray->way[c] == 0.0) {
            if (below > 0.0 || above < 0.0)
                return most;
            continue;
        }
        const double a = below / ray->way[c], b = above / ray->way[c];
        in = (a < b ? a : b) > in ? least(a, b) : in;
        out = least(out, a < b ? b : a);
    }
    return in <= out ? in : most;
}

/* Returns where a ray hits a triangle from behind, or `most` (Moeller and Trumbore 1997). */
static double triangle_along(const struct kiln_mesh *mesh, uint32_t triangle,
                             const struct kiln_nearest_ray *ray, double most)
{
    const struct vec a = corner(mesh, triangle, 0), way = {ray->way[0], ray->way[1], ray->way[2]};
    const struct vec ab = sub(corner(mesh, triangle, 1), a);
    const struct vec ac = sub(corner(mesh, triangle, 2), a);
    const struct vec across = cross(way, ac);
    const double turn = dot(ab, across);
    if (triangle == ray->start || turn >= 0.0) /* above 0: it is seen from the front */
        return most;
    const struct vec off = sub((struct vec){ray->from[0], ray->from[1], ray->from[2]}, a);
    const struct vec up = cross(off, ab);
    const double u = dot(off, across) / turn, v = dot(way, up) / turn, t = dot(ac, up) / turn;
    return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= 0.0 ? least(t, most) : most;
}

/* ---- building the tree ----------------------------------------------------------------------- */

static void bound(const struct kiln_nearest *tree, struct node *node, uint32_t first,
                  uint32_t count)
{
    for (uint32_t i = 0; i < 3 * count; i++) {
        const uint32_t triangle = tree->order[first + i / 3];
        const float *v = tree->mesh->vertices[tree->mesh->triangles[triangle][i % 3]];
        for (int c = 0; c < 3; c++) {
            node->min[c] = i == 0 || v[c] < node->min[c] ? v[c] : node->min[c];
            node->max[c] = i == 0 || v[c] > node->max[c] ? v[c] : node->max[c];
        }
    }
}

/* Brings the triangles whose middle is in the lower half of the box to the front; returns their
 * number. */
static uint32_t part(const struct kiln_nearest *tree, const struct node *node, uint32_t first,
                     uint32_t count)
{
    int axis = 0;
    for (int c = 1; c < 3; c++)
        axis = node->max[c] - node->min[c] > node->max[axis] - node->min[axis] ? c : axis;
    /* three times the middle, to compare with sums of three corners */
    const float middle = 1.5f * (node->min[axis] + node->max[axis]);
    uint32_t below = 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t triangle = tree->order[first + i];
        float sum = 0.0f;
        for (int c = 0; c < 3; c++)
            sum += tree->mesh->vertices[tree->mesh->triangles[triangle][c]][axis];
        if (sum >= middle)
            continue;
        tree->order[first + i] = tree->order[first + below];
        tree->order[first + below++] = triangle;
    }
    return below;
}

/* A range of the order that becomes a node; `parent` is used for a second child only. */
struct work {
    uint32_t first, count, parent, depth;
    bool second;
};

static void build(struct kiln_nearest *tree)
{
    struct work stack[STACK] = {{.count = tree->mesh->triangle_count}};
    uint32_t left = 1;
    while (left > 0) {
        const struct work now = stack[--left];
        const uint32_t number = tree->node_count++;
        struct node *node = &tree->nodes[number];
        if (now.second)
            tree->nodes[now.parent].first = number;
        bound(tree, node, now.first, now.count);
        uint32_t below = 0;
        if (now.count > LEAF && now.depth < DEPTH) {
            below = part(tree, node, now.first, now.count);
            below = below == 0 || below == now.count ? now.count / 2 : below;
        }
        if (below == 0) {
            node->first = now.first;
            node->count = now.count;
            continue;
        }
        stack[left++] =
            (struct work){now.first + below, now.count - below, number, now.depth + 1, true};
        stack[left++] = (struct work){now.first, below, number, now.depth + 1, false};
    }
}

struct kiln_nearest *kiln_nearest_create(const struct kiln_mesh *mesh)
{
    struct kiln_nearest *tree = calloc(1, sizeof *tree);
    if (!tree)
        return NULL;
    tree->mesh = mesh;
    tree->order = malloc(mesh->triangle_count * sizeof *tree->order);
    tree->nodes = calloc((size_t)mesh->triangle_count * 2, sizeof *tree->nodes);
    if (!tree->order || !tree->nodes) {
        kiln_nearest_destroy(&tree);
        return NULL;
    }
    for (uint32_t i = 0; i < mesh->triangle_count; i++)
        tree->order[i] = i;
    build(tree);
    return tree;
}

uint64_t kiln_nearest_bytes(const struct kiln_mesh *mesh)
{
    const struct kiln_nearest *n = NULL;
    return (uint64_t)mesh->triangle_count * (sizeof *n->order + 2 * sizeof *n->nodes);
}

void kiln_nearest_destroy(struct kiln_nearest **nearest)
{
    if (!*nearest)
        return;
    free((*nearest)->order);
    free((*nearest)->nodes);
    free(*nearest);
    *nearest = NULL;
}

double kiln_nearest_square(const struct kiln_nearest *nearest, const double p[3], double most)
{
    const struct vec place = {p[0], p[1], p[2]};
    uint32_t stack[STACK], left = 1;
    double square = most;
    stack[0] = 0;
    while (left > 0) {
        const uint32_t number = stack[--left];
        const struct node *node = &nearest->nodes[number];
        if (box_square(node, p) >= square)
            continue;
        for (uint32_t i = 0; i < node->count; i++)
            square = least(square,
                           triangle_square(nearest->mesh, nearest->order[node->first + i], place));
        if (node->count > 0)
            continue;
        const uint32_t first = number + 1, second = node->first;
        const bool first_is_nearer =
            box_square(&nearest->nodes[first], p) <= box_square(&nearest->nodes[second], p);
        stack[left++] = first_is_nearer ? second : first;
        stack[left++] = first_is_nearer ? first : second;
    }
    return square;
}

double kiln_nearest_along(const struct kiln_nearest *nearest, const struct kiln_nearest_ray *ray,
                          double most)
{
    uint32_t stack[STACK], left = 1;
    double found = most;
    stack[0] = 0;
    while (left > 0) {
        const uint32_t number = stack[--left];
        const struct node *node = &nearest->nodes[number];
        if (box_along(node, ray, found) >= found)
            continue;
        for (uint32_t i = 0; i < node->count; i++)
            found = triangle_along(nearest->mesh, nearest->order[node->first + i], ray, found);
        if (node->count > 0)
            continue;
        const uint32_t first = number + 1, second = node->first;
        const bool first_is_nearer = box_along(&nearest->nodes[first], ray, found) <=
                                     box_along(&nearest->nodes[second], ray, found);
        stack[left++] = first_is_nearer ? second : first;
        stack[left++] = first_is_nearer ? first : second;
    }
    return found;
}
