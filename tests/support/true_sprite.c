/* Draws one particle in double precision, as a reference: makes its sprite, finds which place of it
 * a pixel shows, and shades the place. */
#include "support/true_sprite.h"

#include <math.h>
#include <string.h>

#include "draw/light/smoke_shadow.h"
#include "shared/billboard_place.h"
#include "shared/derived.h"
#include "shared/heading.h"
#include "support/cmocka.h"

/* ---- light ----------------------------------------------------------------------------------- */

/* Reads a grid of the smoke's optical depth, interpolated trilinearly between the centres of its
 * cells. at: position in the grid, 0 to 1 along each axis. */
static double true_grid(const float *depth, const double at[3])
{
    int cell[3], next[3];
    double part[3], sum = 0;
    for (int i = 0; i < 3; i++) {
        double x = fmin(fmax(at[i] * KILN_SMOKE_GRID - 0.5, 0), KILN_SMOKE_GRID - 1);
        cell[i] = (int)x;
        next[i] = cell[i] + 1 < KILN_SMOKE_GRID ? cell[i] + 1 : cell[i];
        part[i] = x - cell[i];
    }
    for (int k = 0; k < 8; k++) {
        double weight = 1;
        int place[3];
        for (int i = 0; i < 3; i++) {
            bool far = (k >> i & 1) != 0;
            place[i] = far ? next[i] : cell[i];
            weight *= far ? part[i] : 1 - part[i];
        }
        sum += weight *
               (double)depth[(place[2] * KILN_SMOKE_GRID + place[1]) * KILN_SMOKE_GRID + place[0]];
    }
    return sum;
}

/* Returns the optical depth of the smoke that the light of the sun, or of the sky, crosses on its
 * way to the world position p; 0 if p is beside the smoke, or between smoke and light. depth: the
 * grid, or NULL for no smoke; to_grid: rows of the matrix from the world to the grid. */
static double true_smoke(const float *depth, const float4 to_grid[3], dvec p)
{
    if (!depth)
        return 0;
    double at[3];
    for (int i = 0; i < 3; i++)
        at[i] = dvec_row(to_grid[i], p);
    if (at[0] < 0 || at[1] < 0 || at[0] > 1 || at[1] > 1 || at[2] > 1)
        return 0;
    return true_grid(depth, at);
}

/* Returns the optical depth of the smoke that a lamp's light crosses on its way to a position. The
 * lamp's map of optical depth is a cube map with several layers by distance (shared/lamp_smoke.h);
 * it is interpolated trilinearly between the texels of one face and between two layers. from:
 * vector from the lamp to the position, m. */
static double true_lamp_smoke(const struct kiln_lighting *l, const struct kiln_draw_light *lamp,
                              dvec from)
{
    enum { EDGE = KILN_LAMP_SMOKE_FACE, LAYERS = KILN_LAMP_SMOKE_LAYERS };
    if (!l->lamp_smoke || lamp->casters.z == 0)
        return 0;
    if (lamp->smoke_ahead.w > 0)
        fail_msg("lamps far from the smoke have no reference here");
    const double v[3] = {from.x, from.y, from.z};
    int axis = fabs(v[0]) >= fabs(v[1]) && fabs(v[0]) >= fabs(v[2]) ? 0
               : fabs(v[1]) >= fabs(v[2])                           ? 1
                                                                    : 2;
    const double ahead = fmax(fabs(v[axis]), 1e-6);
    const double across[2] = {v[axis == 0 ? 2 : 0] / ahead, v[axis == 1 ? 2 : 1] / ahead};
    const double distance = sqrt(dvec_dot(from, from)) / (double)lamp->maps.y;
    const double at[3] = {
        (across[0] + 1) * 0.5 * (EDGE - 1), (across[1] + 1) * 0.5 * (EDGE - 1),
        distance < 1 ? distance : fmin(1 + (double)lamp->maps.z * log2(distance), LAYERS - 1)};
    const float *map = l->lamp_smoke + (size_t)(lamp->casters.z - 1) * KILN_LAMP_SMOKE_MAP;
    const int first_x = axis * EDGE, first_y = v[axis] < 0 ? EDGE : 0;
    double sum = 0;
    for (int k = 0; k < 8; k++) {
        double weight = 1;
        int cell[3];
        for (int i = 0; i < 3; i++) {
            const int last = (i == 2 ? LAYERS : EDGE) - 1;
            const int first = (int)fmin(floor(at[i]), last - 1);
            const double part = at[i] - first;
            cell[i] = first + (k >> i & 1);
            weight *= k >> i & 1 ? part : 1 - part;
        }
        sum +=
            weight * (double)map[cell[2] * KILN_LAMP_SMOKE_LAYER +
                                 (first_y + cell[1]) * KILN_LAMP_SMOKE_WIDTH + first_x + cell[0]];
    }
    return sum;
}

/* Returns which part of lamp i, 0 to 1, the backdrop does not hide from the particle in a slot. */
static double true_lamp_part(const struct kiln_lighting *l, uint32_t i, uint32_t slot)
{
    if (!l->lamplit)
        return 1;
    const size_t plane = kiln_lamp_shade_plane(l->slot_count);
    return (l->lamplit[i / 4 * plane + slot] >> (8 * (i % 4)) & 255) / 255.0;
}

/* Returns the attenuation coefficient of scattered light in smoke relative to the coefficient of
 * direct light, 0 to 1, as smoke_diffusion of shared/smoke_grid.h does. reflected: the part of the
 * light that thick smoke reflects, 0 to 1. */
static double true_diffusion(double reflected)
{
    const double g = 0.4, part = fmin(fmax(reflected, 0), 1);
    const double s = (1 - part) / (1 + 1.3 * part);
    const double albedo = (1 - s * s) / (1 - g * s * s);
    return fmin(sqrt(3 * (1 - albedo) * (1 - albedo * g)), 1);
}

/* Adds a light to a sprite: half of it from all sides, half by Lambert's law. all, straight:
 * factors on `color` for the two halves, after attenuation; direction: unit vector to the light,
 * world space; axes: the billboard's right, up and normal, view space. */
static void true_add_light(const struct true_scene *t, struct true_sprite *s, float4 color,
                           double all, double straight, dvec direction, const dvec axes[3])
{
    const double rgb[3] = {(double)color.x, (double)color.y, (double)color.z};
    dvec v = dvec_turn(t->view, direction);
    for (int c = 0; c < 3; c++) {
        s->light[0][c] += 0.5 * rgb[c] * all;
        for (int i = 0; i < 3; i++)
            s->light[1 + i][c] += 0.5 * rgb[c] * straight * dvec_dot(v, axes[i]);
    }
}

/* Computes s->light, the light of sky, sun and lamps on a sprite. cover: row KILN_LOOK_COVER, whose
 * last value, `lit`, is the weight of this light, 0 to 1; the rest is constant light 1; axes:
 * right, up and normal, view space. */
static void true_light(const struct true_scene *t, struct true_sprite *s, const double cover[4],
                       uint32_t slot, dvec position, const dvec axes[3])
{
    const struct kiln_draw_backdrop *b = t->backdrop;
    const struct kiln_lighting *l = t->lighting;
    const double lit = cover[3];
    for (int c = 0; c < 3; c++)
        s->light[0][c] = 1 - lit;
    if (lit <= 0)
        return;
    const double spread = true_diffusion((cover[0] + cover[1] + cover[2]) / 3);
    const double sky = true_smoke(l->smoke ? l->sky_depth : NULL, l->sky_to_grid, position);
    const double sun = true_smoke(l->smoke ? l->sun_depth : NULL, l->sun_to_grid, position);
    const double past = l->sunlit ? (double)l->sunlit[slot] : 1;
    const double horizon[3] = {(double)b->sky_horizon.x, (double)b->sky_horizon.y,
                               (double)b->sky_horizon.z};
    for (int c = 0; c < 3; c++)
        s->light[0][c] += horizon[c] * lit * exp(-fmin(spread, 0.5) * sky);
    true_add_light(t, s, b->sky_top, lit * exp(-spread * sky), lit * exp(-sky), (dvec){0, 1, 0},
                   axes);
    true_add_light(t, s, b->sun_color, lit * past * exp(-spread * sun) / M_PI,
                   lit * past * exp(-sun) / M_PI, dvec_of(b->sun_direction), axes);
    for (uint32_t i = 0; i < b->counts.y; i++) {
        dvec towards = dvec_add(dvec_of(b->lights[i].position_radius2), position, -1);
        double d2 = dvec_dot(towards, towards);
        double part =
            lit * true_lamp_part(l, i, slot) / (d2 + (double)b->lights[i].position_radius2.w);
        double smoke = true_lamp_smoke(l, &b->lights[i], dvec_scale(towards, -1));
        true_add_light(t, s, b->lights[i].color, part * exp(-spread * smoke), part * exp(-smoke),
                       dvec_scale(towards, 1 / sqrt(fmax(d2, 1e-9))), axes);
    }
}

/* ---- form ------------------------------------------------------------------------------------ */

/* Computes the unit axes of a billboard's plane in view space: right, up and towards the viewer
 * (Heinz 2019, 2.1.1). facing: LOOK_*; axis: the axis of an axial billboard, otherwise the world's
 * up, in world space; center: view space. */
static void true_plane(const struct true_scene *t, uint32_t facing, dvec axis, dvec center,
                       dvec axes[3])
{
    bool to_eye = facing == LOOK_VIEWPOINT || facing == LOOK_AXIAL;
    bool in_picture = facing == LOOK_SCREEN || facing == LOOK_VELOCITY;
    dvec normal = to_eye ? dvec_scale(dvec_unit(center), -1) : (dvec){0, 0, 1};
    dvec upward = in_picture ? (dvec){0, 1, 0} : dvec_turn(t->view, axis);
    dvec sideways = dvec_cross(upward, normal);
    if (dvec_dot(sideways, sideways) < 1e-8)
        sideways = dvec_add((dvec){1, 0, 0}, normal, -normal.x);
    axes[0] = dvec_unit(sideways);
    axes[1] = facing == LOOK_AXIAL ? upward : dvec_cross(normal, axes[0]);
    axes[2] = facing == LOOK_AXIAL ? dvec_cross(axes[0], upward) : normal;
}

/* Computes `up`, the unit direction of a billboard's length along right and up of its plane.
 * Returns by how much stretching extends half of the length, m. angle: rad; stretch: s; moving:
 * velocity along right and up, m/s. */
static double true_up(double angle, double stretch, const double moving[2], uint32_t facing,
                      double up[2])
{
    up[0] = -sin(angle);
    up[1] = cos(angle);
    if (facing == LOOK_AXIAL) {
        up[0] = 0;
        up[1] = 1;
        return 0.5 * fabs(moving[1]) * stretch;
    }
    if (!(stretch > 0) && facing != LOOK_VELOCITY)
        return 0;
    double speed = hypot(moving[0], moving[1]);
    double x = fmin(fmax((speed - 0.05) / 0.15, 0), 1), part = x * x * (3 - 2 * x);
    for (int i = 0; i < 2; i++)
        up[i] += (moving[i] / fmax(speed, 1e-4) - up[i]) * part;
    up[1] += 1e-5;
    double length = hypot(up[0], up[1]);
    up[0] /= length;
    up[1] /= length;
    return 0.5 * speed * stretch;
}

/* Chooses the texture, two adjacent cells of its flipbook with their weights for frame blending
 * (Heinz 2019, equation 3.2), and the level of detail. passes: how often the flipbook has been
 * played since birth, with a fraction. */
static void true_choose_cells(const struct true_scene *t, struct true_sprite *s,
                              const struct kiln_draw_look *look, uint32_t stream, float passes,
                              double width_px, double length_px)
{
    uint32_t number = (uint32_t)(random_unit(stream, RANDOM_TEXTURE) * (float)look->flags.w);
    uint4 texture = look->textures[number < look->flags.w ? number : look->flags.w - 1];
    float cells = (float)texture.y, position = passes * (cells - 1.0f);
    if ((look->flags.y & LOOK_RANDOM_START) != 0)
        position += random_unit(stream, RANDOM_CELL) * cells;
    uint32_t first = (uint32_t)floorf(position);
    s->layers[0] = texture.x + first % texture.y;
    s->layers[1] = texture.x + (first + 1) % texture.y;
    s->part = (double)position - first;
    s->level = (uint32_t)floor(log2(fmax(KILN_ATLAS_CELL / fmax(fmin(width_px, length_px), 1), 1)));
    s->columns = s->rows = KILN_ATLAS_CELL >> s->level;
    if (width_px <= 2 && length_px >= 4) {
        s->level = KILN_STRIP_LEVEL;
        s->columns = 1;
        s->rows = KILN_ATLAS_STRIP;
    }
    s->masks = texture.z != KILN_CELL_COLOR;
    s->motion = t->atlas->moves ? (double)BITS_FLOAT(texture.w) : 0;
}

/* Projects a position in view space to the picture. Sets `pixel` to x, y, px from the top left. */
static void true_pixel(const struct true_scene *t, dvec v, double pixel[2])
{
    const float4 f = t->view->frustum;
    pixel[0] = 0.5 * (double)f.z * (1 + v.x / (double)f.x / -v.z);
    pixel[1] = 0.5 * (double)f.w * (1 - v.y / (double)f.y / -v.z);
}

/* Turns a sprite into a point or a line, a rectangle in the picture. width: of the line, or
 * diameter of the point, px; way_m: vector from the line's head, which is the sprite's centre, to
 * its tail, view space, m. */
static void true_make_plain(const struct true_scene *t, struct true_sprite *s,
                            const struct kiln_draw_look *look, double width, dvec way_m)
{
    bool line = look->form.x == LOOK_LINE;
    double thin = fmin(width, 1), half_width = 0.5 * fmax(width, 1);
    double near = fmax((double)t->view->eye.w, 1e-3);
    dvec head = s->center, tail = line ? dvec_add(head, way_m, 1) : head;
    if (-tail.z < near)
        tail = dvec_add(head, dvec_add(tail, head, -1), (-head.z - near) / (tail.z - head.z));
    double from[2], to[2];
    true_pixel(t, tail, from);
    true_pixel(t, head, to);
    double length = hypot(to[0] - from[0], to[1] - from[1]);
    for (int i = 0; i < 2; i++) {
        s->way[i] = length > 1e-3 ? (to[i] - from[i]) / length : i == 0;
        s->middle[i] = 0.5 * (from[i] + to[i]);
        s->extent[i] = half_width + (i == 0 ? 0.5 * length : 0);
    }
    s->near[0] = 1 / -tail.z;
    s->near[1] = 1 / -head.z;
    s->opacity *= line ? thin : thin * thin;
    s->plain = true;
    s->disc = !line && look->form.z != 0;
}

/* Returns the position of corner i of a billboard, counted around its edge, in view space. */
static dvec true_corner(const struct true_sprite *s, int i)
{
    double across = i == 1 || i == 2 ? 1 : -1, along = i < 2 ? 1 : -1;
    return dvec_add(dvec_add(s->center, s->right, across), s->up, along);
}

/* Intersects the ray through the place (x, y) of the picture, px, with a billboard's plane. Returns
 * the view depth, m. Sets `place` to coordinates along right and up, in which the edges are at -1
 * and 1. */
static double true_meet(const struct true_scene *t, const struct true_sprite *s, double x, double y,
                        double place[2])
{
    const float4 f = t->view->frustum;
    dvec ray = {(2 * x / (double)f.z - 1) * (double)f.x, (1 - 2 * y / (double)f.w) * (double)f.y,
                -1};
    dvec normal = dvec_cross(s->right, s->up);
    double depth = dvec_dot(s->center, normal) / dvec_dot(ray, normal);
    dvec from_middle = dvec_add(dvec_scale(ray, depth), s->center, -1);
    place[0] = dvec_dot(dvec_cross(from_middle, s->up), normal) / dvec_dot(normal, normal);
    place[1] = dvec_dot(dvec_cross(s->right, from_middle), normal) / dvec_dot(normal, normal);
    return depth;
}

/* Prepares filtered edges, as billboard_rim_of in shared/billboard_place.h does. Widens a billboard
 * of less than one pixel to one pixel, and makes it fainter by the same factor. Filters the edges
 * if its width or length is below BILLBOARD_RIM_MOST, px. Both follow from how true_meet's
 * coordinates change around its centre. */
static void true_widen(const struct true_scene *t, struct true_sprite *s)
{
    const double step = 1e-4;
    double middle[2], a[2], b[2], width[2];
    true_pixel(t, s->center, middle);
    for (int i = 0; i < 2; i++) {
        double slope[2];
        for (int k = 0; k < 2; k++) {
            double aside[2] = {k == 0 ? step : 0, k == 1 ? step : 0};
            true_meet(t, s, middle[0] + aside[0], middle[1] + aside[1], a);
            true_meet(t, s, middle[0] - aside[0], middle[1] - aside[1], b);
            slope[k] = (a[i] - b[i]) / (2 * step);
        }
        width[i] = 2 / (fabs(slope[0]) + fabs(slope[1]));
    }
    bool small = fmin(width[0], width[1]) < BILLBOARD_RIM_MOST;
    for (int i = 0; i < 2; i++) {
        s->narrowed[i] = fmin(width[i], 1);
        s->opacity *= s->narrowed[i];
        s->rim[i] = small ? fmax(width[i], 1) : 0;
    }
}

/* Computes the bounding box of the pixels that a sprite may touch: that of its corners, with a
 * margin for filtered edges, or the whole picture if a corner of a billboard is behind the eye. */
static void true_bound(const struct true_scene *t, struct true_sprite *s)
{
    const double size[2] = {(double)t->view->frustum.z, (double)t->view->frustum.w};
    double low[2] = {1e9, 1e9}, high[2] = {-1e9, -1e9};
    bool behind = false;
    for (int i = 0; i < 4; i++) {
        double at[2];
        if (s->plain) {
            double across = (i == 1 || i == 2 ? 1 : -1) * (s->extent[0] + 0.5);
            double along = (i < 2 ? 1 : -1) * (s->extent[1] + 0.5);
            at[0] = s->middle[0] + s->way[0] * across - s->way[1] * along;
            at[1] = s->middle[1] + s->way[1] * across + s->way[0] * along;
        } else {
            behind = behind || -true_corner(s, i).z < 1e-6;
            true_pixel(t, true_corner(s, i), at);
        }
        for (int k = 0; k < 2; k++) {
            double margin = s->rim[0] > 0 ? 3 : 0;
            low[k] = fmin(low[k], at[k] - margin);
            high[k] = fmax(high[k], at[k] + margin);
        }
    }
    for (int k = 0; k < 2; k++) {
        s->box[k] = behind ? 0 : (int)fmin(fmax(floor(low[k]) - 1, 0), size[k]);
        s->box[2 + k] = behind ? (int)size[k] : (int)fmin(fmax(ceil(high[k]) + 1, 0), size[k]);
    }
}

/* ---- whole sprites --------------------------------------------------------------------------- */

/* Values of a particle from which its sprite is made. age: seconds since birth; row: the rows
 * KILN_LOOK_* at this age; scale: random factor on the size; half_size: m; position: world, m;
 * moving: velocity in view space, m/s; axes: right, up and normal of the billboard, view space. */
struct true_subject {
    const struct kiln_draw_look *look;
    uint32_t stream;
    float life; /* part of its life that has passed, 0 to 1 */
    double age, turned, row[KILN_LOOK_ROWS][4];
    double scale, half_size, diameter_px;
    dvec position, moving, heading, axes[3];
    bool rests;
};

/* Returns the particle's random number for a purpose (RANDOM_*), between `least` and `most`. */
static double true_between(const struct true_subject *p, uint32_t purpose, double least,
                           double most)
{
    return least + (most - least) * (double)random_unit(p->stream, purpose);
}

/* Computes a billboard's axes and half edges from its facing, rotation, spin and stretch. */
static void true_turn(const struct true_scene *t, struct true_subject *p, struct true_sprite *s)
{
    const double *turn = p->row[KILN_LOOK_TURN], *axis = p->row[KILN_LOOK_AXIS];
    const double *spread = p->row[KILN_LOOK_SPREAD];
    double angle = true_between(p, RANDOM_ROTATION, turn[0], turn[1]);
    double spin = true_between(p, RANDOM_SPIN, spread[2], spread[3]);
    bool backwards = random_unit(p->stream, RANDOM_SPIN + 1u) < 0.5f;
    angle += (backwards ? -spin : spin) * p->turned;
    const uint32_t facing = p->look->form.y;
    dvec upward = facing == LOOK_AXIAL ? (dvec){axis[0], axis[1], axis[2]} : (dvec){0, 1, 0};
    if (p->look->form.x == 0 && facing == LOOK_NORMAL)
        true_plane_across(t, (dvec){axis[0], axis[1], axis[2]}, s, p->axes);
    else if (p->look->form.x == 0 && facing == LOOK_SURFACE && p->rests)
        true_plane_across(t, p->heading, s, p->axes);
    else
        true_plane(t, facing == LOOK_SURFACE ? LOOK_SCREEN : facing, upward, s->center, p->axes);
    const double in_plane[2] = {dvec_dot(p->moving, p->axes[0]), dvec_dot(p->moving, p->axes[1])};
    double up[2];
    double longer = true_up(angle, p->row[KILN_LOOK_SHAPE][1], in_plane, facing, up);
    dvec upwards = dvec_add(dvec_scale(p->axes[0], up[0]), p->axes[1], up[1]);
    dvec sideways = dvec_add(dvec_scale(p->axes[0], up[1]), p->axes[1], -up[0]);
    const bool mirrors = (p->look->flags.y & LOOK_UNMIRRORED) == 0;
    p->axes[0] = backwards && mirrors ? dvec_scale(sideways, -1) : sideways;
    p->axes[1] = upwards;
    const double *form = p->row[KILN_LOOK_FORM];
    s->right = dvec_scale(p->axes[0], p->half_size * form[0]);
    s->up = dvec_scale(p->axes[1], p->half_size * form[1] + longer);
    if (p->look->form.x == 0 && p->look->form.w != 0)
        s->opacity *= p->half_size / (p->half_size + longer / form[1]);
}

static void true_read(const struct true_scene *t, uint32_t entry,
                      const struct kiln_particle *record, struct true_subject *p)
{
    const struct kiln_view *view = t->view;
    p->look = &t->looks[KILN_ENTRY_SYSTEM(entry)];
    p->stream = particle_stream(p->look->derived, *record);
    float age_s = particle_age(*record, view->clock_step.x, view->clock.y);
    p->age = (double)age_s;
    p->life = particle_progress(age_s, particle_life_s(t->scene->keys, p->look->derived, *record));
    for (uint32_t i = 0; i < KILN_LOOK_ROWS; i++)
        true_look(t, KILN_ENTRY_SYSTEM(entry), i, record, p->row[i]);
    p->position = dvec_of3(particle_position(*record));
    p->moving = dvec_turn(view, dvec_of3(particle_velocity(*record)));
    p->rests = particle_has_stopped(*record);
    p->heading = dvec_of3(particle_heading(*record));
    p->turned = (double)particle_turned_s(*record, age_s, view->clock.y);
}

bool true_sprite_make(const struct true_scene *t, uint32_t entry,
                      const struct kiln_particle *record, struct true_sprite *s)
{
    struct true_subject p;
    true_read(t, entry, record, &p);
    const struct kiln_view *view = t->view;
    const double *shape = p.row[KILN_LOOK_SHAPE], *spread = p.row[KILN_LOOK_SPREAD];
    *s = (struct true_sprite){.center = dvec_view(view, p.position),
                              .additive = p.look->flags.x != 0,
                              .literal = p.look->flags.z != 0,
                              .soft = shape[3]};
    double depth = -s->center.z, beyond = depth - (double)view->eye.w;
    s->opacity = shape[2] * fmin(fmax(beyond / fmax(p.row[KILN_LOOK_HOT][3], 1e-6), 0), 1);
    if (!(beyond > 0) || !(s->opacity > 0))
        return false;
    double pixels_per_m = (double)view->frustum.w / (2 * (double)view->frustum.y * depth);
    p.scale = true_between(&p, RANDOM_SCALE, spread[0], spread[1]);
    p.half_size = 0.5 * shape[0] * p.scale;
    p.diameter_px = 2 * p.half_size * pixels_per_m;
    const bool formed = (p.look->flags.y & LOOK_FORMED) != 0;
    s->half_size = p.half_size * (formed ? p.row[KILN_LOOK_FORM][0] : 1);
    s->slant = 1;
    true_turn(t, &p, s);
    true_color(t, s, (double const(*)[4])p.row, p.position);
    s->bulge = s->half_size * p.row[KILN_LOOK_BLOOM][3];
    s->distance = sqrt(dvec_dot(s->center, s->center));
    true_choose_cells(t, s, p.look, p.stream, p.life * (float)p.row[KILN_LOOK_COOL][3],
                      2 * s->half_size * pixels_per_m * s->slant,
                      2 * sqrt(dvec_dot(s->up, s->up)) * pixels_per_m * s->slant);
    true_light(t, s, p.row[KILN_LOOK_COVER], KILN_ENTRY_SLOT(entry), p.position, p.axes);
    if (p.look->form.x != 0) {
        bool line = p.look->form.x == LOOK_LINE;
        double width = p.row[KILN_LOOK_TURN][line ? 3 : 2] * p.scale * (double)view->clock.w;
        double back = p.look->form.w != 0 ? (double)view->clock.z : shape[1];
        true_make_plain(t, s, p.look, line || width > 0 ? width : p.diameter_px,
                        dvec_scale(p.moving, -back));
    } else {
        true_widen(t, s);
    }
    true_bound(t, s);
    return true;
}

/* ---- pixels ---------------------------------------------------------------------------------- */

static bool true_place_plain(const struct true_sprite *s, double x, double y, struct true_place *at)
{
    double dx = x - s->middle[0], dy = y - s->middle[1];
    at->u = dx * s->way[0] + dy * s->way[1];
    at->v = dy * s->way[0] - dx * s->way[1];
    double along = 0.5 + 0.5 * at->u / (s->extent[0] + 0.5);
    at->depth = 1 / (s->near[0] + (s->near[1] - s->near[0]) * along);
    return fabs(at->u) <= s->extent[0] + 0.5 && fabs(at->v) <= s->extent[1] + 0.5;
}

bool true_place_of(const struct true_scene *t, const struct true_sprite *s, double x, double y,
                   struct true_place *at)
{
    if (s->plain)
        return true_place_plain(s, x, y, at);
    double place[2];
    at->depth = true_meet(t, s, x, y, place);
    bool inside = at->depth > 0;
    for (int i = 0; i < 2; i++) {
        place[i] *= s->narrowed[i];
        inside = inside && fabs(place[i]) <= 1 + (s->rim[i] > 0 ? 1 / s->rim[i] : 0);
    }
    at->u = 0.5 + 0.5 * place[0];
    at->v = 0.5 - 0.5 * place[1];
    return inside;
}

/* Samples channel c of a texture of bytes bilinearly at (u, v), clamped at its edges. The bytes
 * stand for -1 to 1 if has_sign is set, otherwise for 0 to 1. */
static double true_bilinear(const uint8_t *texels, int columns, int rows, int channels, int c,
                            double u, double v, bool has_sign)
{
    double x = fmin(fmax(u * columns - 0.5, 0), columns - 1);
    double y = fmin(fmax(v * rows - 0.5, 0), rows - 1);
    int x0 = (int)x, y0 = (int)y;
    int x1 = x0 + 1 < columns ? x0 + 1 : x0, y1 = y0 + 1 < rows ? y0 + 1 : y0;
    const int at[4] = {y0 * columns + x0, y0 * columns + x1, y1 * columns + x0, y1 * columns + x1};
    double t[4];
    for (int i = 0; i < 4; i++) {
        uint8_t byte = texels[at[i] * channels + c];
        t[i] = has_sign ? fmax((int8_t)byte / 127.0, -1) : byte / 255.0;
    }
    double part_x = x - x0, part_y = y - y0;
    double upper = t[0] + (t[1] - t[0]) * part_x, lower = t[2] + (t[3] - t[2]) * part_x;
    return upper + (lower - upper) * part_y;
}

/* Blends two adjacent flipbook cells at a place of a sprite. Displaces each cell along the motion
 * vectors, so that a detail which moves between the cells is seen once and not twice. */
static void true_cell(const struct true_scene *t, const struct true_sprite *s,
                      const struct true_place *at, double cell[4])
{
    double way[2] = {0, 0};
    if (s->motion > 0) {
        const int8_t *moves = t->atlas->moves + (size_t)s->layers[0] * KILN_ATLAS_MOVES_BYTES;
        for (int i = 0; i < 2; i++)
            way[i] = s->motion * true_bilinear((const uint8_t *)moves, KILN_ATLAS_MOTION,
                                               KILN_ATLAS_MOTION, 2, i, at->u, at->v, true);
    }
    const uint8_t *from = kiln_atlas_level(t->atlas, s->layers[0], s->level);
    const uint8_t *to = kiln_atlas_level(t->atlas, s->layers[1], s->level);
    for (int c = 0; c < 4; c++) {
        double one = true_bilinear(from, s->columns, s->rows, 4, c, at->u - s->part * way[0],
                                   at->v - s->part * way[1], false);
        double other = true_bilinear(to, s->columns, s->rows, 4, c, at->u + (1 - s->part) * way[0],
                                     at->v + (1 - s->part) * way[1], false);
        cell[c] = one + (other - one) * s->part;
    }
}

/* Returns which part of a pixel, 0 to 1, lies within the filtered edges of a billboard. */
static double true_rim(const struct true_sprite *s, const struct true_place *at)
{
    if (s->plain || !(s->rim[0] > 0))
        return 1;
    return fmin(fmax((0.5 - fabs(at->u - 0.5)) * s->rim[0] + 0.5, 0), 1) *
           fmin(fmax((0.5 - fabs(at->v - 0.5)) * s->rim[1] + 0.5, 0), 1);
}

/* Returns which part of a pixel, 0 to 1, a point or a line covers. */
static double true_coverage(const struct true_sprite *s, const struct true_place *at)
{
    if (s->disc)
        return fmin(fmax(s->extent[0] + 0.5 - hypot(at->u, at->v), 0), 1);
    return fmin(fmax(s->extent[0] + 0.5 - fabs(at->u), 0), 1) *
           fmin(fmax(s->extent[1] + 0.5 - fabs(at->v), 0), 1);
}

void true_shade(const struct true_scene *t, const struct true_sprite *s,
                const struct true_place *at, double scene, double rgba[4])
{
    double cell[4] = {0.5, 0.5, 1, 0}, slope[2] = {0, 0}, alpha;
    bool masks = s->masks || s->plain;
    if (s->plain)
        cell[3] = true_coverage(s, at);
    else
        true_cell(t, s, at, cell);
    if (masks) {
        slope[0] = cell[0] * 2 - 1;
        slope[1] = cell[1] * 2 - 1;
    } else {
        for (int c = 0; c < 4; c++)
            cell[c] *= cell[c];
    }
    alpha = cell[3];
    double facing = sqrt(fmax(1 - slope[0] * slope[0] - slope[1] * slope[1], 0));
    double depth = s->plain || fabs(s->right.z) + fabs(s->up.z) > 0 ? at->depth : -s->center.z;
    double fade = s->opacity * true_soft(s, depth, scene);
    fade = fmin(fade, 1 / fmax(alpha, 1e-6)) * true_rim(s, at);
    for (int c = 0; c < 3; c++) {
        double light = s->light[0][c] + s->light[1][c] * slope[0] + s->light[2][c] * slope[1] +
                       s->light[3][c] * facing;
        double covering = s->color[c] * fmax(light, 0);
        double emitted = masks ? s->cool[c] + (s->hot[c] - s->cool[c]) * cell[2] : s->hot[c];
        rgba[c] =
            (emitted + covering) * (masks ? alpha : cell[c]) * fade + s->veil[c] * alpha * fade;
    }
    rgba[3] = alpha * fade;
}
