/* As shaders/draw/particle.glsl and corner.glsl do it, but in arithmetic of our own, so that
 * pictures do not depend on the machine's mathematics either.
 */
#include "draw/sprite_light.h"

#include "base/vector.h"
#include "shared/derived.h"

enum { MAKE_AHEAD = 8 }; /* particles that are fetched beforehand */

/* The plane of a billboard: unit vectors in view space. */
struct plane {
    float3 right, up, normal;
};

/* A particle on its way to a sprite. */
struct subject {
    const struct kiln_sprite_pass *pass;
    const struct kiln_draw_look *look;
    const float4 *rows; /* of its system in the table */
    uint32_t slot;
    struct kiln_particle record;
    uint32_t stream;
    float progress, age_s;
    float3 center; /* view space */
    float depth;
    float4 shape, spread, turn, hot, cool, cover;
    float half_size;
    struct plane plane; /* turned as the particle is */
    float half_length;  /* of the billboard along plane.up */
    const struct kiln_cell_hull *hull;
};

static float4 look_at(const struct subject *p, uint32_t row)
{
    float x = p->progress * (float)(KILN_LOOK_SAMPLES - 1);
    uint32_t i = (uint32_t)x;
    if (i > KILN_LOOK_SAMPLES - 2)
        i = KILN_LOOK_SAMPLES - 2;
    const float4 *a = p->rows + (size_t)row * KILN_LOOK_SAMPLES + i, *b = a + 1;
    float t = x - (float)i;
    return (float4){a->x + (b->x - a->x) * t, a->y + (b->y - a->y) * t, a->z + (b->z - a->z) * t,
                    a->w + (b->w - a->w) * t};
}

static float3 to_view(const struct kiln_view *view, float3 v)
{
    const float4 *rows = view->world_to_view;
    return (float3){rows[0].x * v.x + rows[0].y * v.y + rows[0].z * v.z,
                    rows[1].x * v.x + rows[1].y * v.y + rows[1].z * v.z,
                    rows[2].x * v.x + rows[2].y * v.y + rows[2].z * v.z};
}

static float3 to_view_point(const struct kiln_view *view, float3 v)
{
    float3 at = to_view(view, v);
    const float4 *rows = view->world_to_view;
    return (float3){at.x + rows[0].w, at.y + rows[1].w, at.z + rows[2].w};
}

static float lerp(float a, float b, float t)
{
    return a + (b - a) * t;
}

static float clamp01(float x)
{
    return exact_clamp(x, 0.0f, 1.0f);
}

/* ---- form ------------------------------------------------------------------------------------ */

/* The plane that a billboard turns in (Heinz 2019, 2.1.1). Where the direction that says what is up
 * points at the eye, the picture's right is the billboard's. */
static struct plane facing_plane(const struct subject *p)
{
    uint32_t facing = p->look->form.y;
    if (facing == LOOK_SCREEN || facing == LOOK_VELOCITY)
        return (struct plane){{1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
    bool to_eye = facing == LOOK_VIEWPOINT || facing == LOOK_AXIAL;
    float3 towards = {0.0f, 0.0f, 1.0f}, axis = {0.0f, 1.0f, 0.0f};
    if (to_eye)
        towards = float3_normalize(float3_scale(p->center, -1.0f), towards);
    if (facing == LOOK_AXIAL) {
        float4 row = look_at(p, KILN_LOOK_AXIS);
        axis = (float3){row.x, row.y, row.z};
    }
    float3 upward = to_view(p->pass->view, axis);
    float3 sideways = float3_cross(upward, towards);
    if (float3_dot(sideways, sideways) < 1e-8f)
        sideways = float3_add_scaled((float3){1.0f, 0.0f, 0.0f}, towards, -towards.x);
    sideways = float3_normalize(sideways, (float3){1.0f, 0.0f, 0.0f});
    if (facing != LOOK_AXIAL)
        return (struct plane){sideways, float3_cross(towards, sideways), towards};
    return (struct plane){sideways, upward, float3_cross(sideways, upward)};
}

static float smoothstep(float from, float to, float x)
{
    float t = clamp01((x - from) / (to - from));
    return t * t * (3.0f - 2.0f * t);
}

/* Turns the billboard in its plane: by its angle, or along its velocity when it is stretched. Slow
 * ones keep their turn; half of all are mirrored. */
static void turn_billboard(struct subject *p)
{
    const struct plane plane = facing_plane(p);
    uint32_t facing = p->look->form.y;
    float angle = lerp(p->turn.x, p->turn.y, random_unit(p->stream, RANDOM_ROTATION));
    float spin = lerp(p->spread.z, p->spread.w, random_unit(p->stream, RANDOM_SPIN));
    bool backwards = random_unit(p->stream, RANDOM_SPIN + 1u) < 0.5f;
    angle += (backwards ? -spin : spin) * p->age_s;
    struct exact_angle turned = exact_sincos(angle);
    float up_x = -turned.sine, up_y = turned.cosine;

    float stretch = p->shape.y;
    p->half_length = p->half_size;
    bool along_axis = facing == LOOK_AXIAL;
    if (along_axis || stretch > 0.0f || facing == LOOK_VELOCITY) {
        float3 moving = to_view(p->pass->view, particle_velocity(p->record));
        float x = float3_dot(moving, plane.right), y = float3_dot(moving, plane.up);
        if (along_axis) {
            up_x = 0.0f;
            up_y = 1.0f;
            p->half_length += 0.5f * exact_abs(y) * stretch;
        } else {
            float speed = exact_sqrt(x * x + y * y);
            float part = smoothstep(0.05f, 0.2f, speed), scale = 1.0f / exact_max(speed, 1e-4f);
            up_x = lerp(up_x, x * scale, part);
            up_y = lerp(up_y, y * scale, part) + 1e-5f;
            float shorter = exact_rsqrt(up_x * up_x + up_y * up_y);
            up_x *= shorter;
            up_y *= shorter;
            p->half_length += 0.5f * speed * stretch;
        }
    }
    float right_x = backwards ? -up_y : up_y, right_y = backwards ? up_x : -up_x;
    p->plane = (struct plane){
        float3_add_scaled(float3_scale(plane.right, right_x), plane.up, right_y),
        float3_add_scaled(float3_scale(plane.right, up_x), plane.up, up_y), plane.normal};
}

/* In a picture smaller than the frame, a billboard has a least size, and what is less becomes as
 * much fainter: else it would flicker. */
static void widen(struct subject *p, float pixels_per_m, struct kiln_sprite *s)
{
    if (!(p->pass->view->clock.w < 1.0f) || p->look->form.x != 0)
        return;
    float least = 0.5f * KILN_COARSE_LEAST / pixels_per_m;
    float area = p->half_size * p->half_length;
    p->half_size = exact_max(p->half_size, least);
    p->half_length = exact_max(p->half_length, least);
    s->opacity *= area / (p->half_size * p->half_length);
}

/* ---- colour ------------------------------------------------------------------------------------
 */

static float3 to_world(const struct kiln_view *view, float3 v)
{
    const float4 *rows = view->world_to_view;
    return (float3){rows[0].x * v.x + rows[1].x * v.y + rows[2].x * v.z,
                    rows[0].y * v.x + rows[1].y * v.y + rows[2].y * v.z,
                    rows[0].z * v.x + rows[1].z * v.y + rows[2].z * v.z};
}

static void shade(const struct subject *p, float3 position, struct kiln_sprite *s)
{
    const struct kiln_view *view = p->pass->view;
    const struct kiln_sprite_axes axes = {to_world(view, p->plane.right),
                                          to_world(view, p->plane.up),
                                          to_world(view, p->plane.normal)};
    const struct kiln_sprite_light light =
        kiln_sprite_light(p->pass, p->slot, p->cover.w, &axes, position);
    const float albedo[3] = {p->cover.x, p->cover.y, p->cover.z};
    const float hot[3] = {p->hot.x, p->hot.y, p->hot.z};
    const float cool[3] = {p->cool.x, p->cool.y, p->cool.z};
    for (int c = 0; c < 3; c++) {
        float flat = exact_max(light.parts[0][c] + light.parts[3][c], 0.0f) * albedo[c];
        switch ((enum kiln_sprite_shade)s->shade) {
        case KILN_SHADE_LIT:
            for (int i = 0; i < 4; i++)
                s->light[i][c] = light.parts[i][c] * albedo[c];
            s->base[c] = cool[c];
            s->slope[c] = hot[c] - cool[c];
            break;
        case KILN_SHADE_GLOW: /* nothing changes along the axes */
            s->base[c] = cool[c] + flat;
            s->slope[c] = hot[c] - cool[c];
            break;
        default:
            s->base[c] = hot[c] + flat;
            s->slope[c] = 0.0f;
            break;
        }
    }
    for (int c = 0; c < 3; c++) {
        if (s->base[c] != 0.0f || s->slope[c] != 0.0f)
            s->flags |= KILN_SPRITE_EMITS;
    }
    float4 bloom = look_at(p, KILN_LOOK_BLOOM);
    s->bulge = p->look->form.x == 0 ? p->half_size * bloom.w : 0.0f;
    s->bloom[0] = bloom.x;
    s->bloom[1] = bloom.y;
    s->bloom[2] = bloom.z;
}

/* ---- cells ----------------------------------------------------------------------------------- */

/* floor(log2(x)) of a positive number. */
static uint32_t log2_floor(float x)
{
    return (FLOAT_BITS(x) >> 23) - 127;
}

/* The level with one to two texels a pixel. */
static uint32_t level_of(float diameter_px)
{
    return log2_floor(exact_max((float)KILN_ATLAS_CELL / exact_max(diameter_px, 1.0f), 1.0f));
}

/* Equation 3.2: the two adjacent cells and the way between them, by the progress through life.
 * False where nothing can be seen of them. */
static bool choose_cells(struct subject *p, uint4 texture, uint32_t level, struct kiln_sprite *s)
{
    float position = p->progress * p->cool.w * ((float)texture.y - 1.0f);
    if (p->look->flags.y != 0)
        position += random_unit(p->stream, RANDOM_CELL) * (float)texture.y;
    position = exact_clamp(position, 0.0f, 1e6f);
    struct kiln_cell_name name = {.level = level, .motion = BITS_FLOAT(texture.w)};
    bool mixed = level >= KILN_CELL_MIXED_LEVEL && name.motion * s->edge_u <= KILN_CELL_MIXED_MOVE;
    uint32_t step = level > KILN_CELL_MIXED_LEVEL ? 1 : KILN_CELL_LARGE_STEP;
    uint32_t phase = step * (uint32_t)(position * (float)(KILN_CELL_PHASES / step) + 0.5f);
    uint32_t number = mixed ? phase / KILN_CELL_PHASES : (uint32_t)position;
    uint32_t cell = number % texture.y;
    name.layer = texture.x + cell;
    name.next_layer = texture.x + (cell + 1) % texture.y;
    if (mixed) {
        name.phase = phase % KILN_CELL_PHASES;
        s->cell = kiln_cells_want(p->pass->cells, &name);
        s->flags |= KILN_SPRITE_MIXED;
    } else {
        s->part = position - (float)number;
        s->motion = name.motion * s->edge_u;
        s->cell = kiln_cells_want(p->pass->cells, &name);
        name.layer = name.next_layer;
        s->next_cell = kiln_cells_want(p->pass->cells, &name);
    }
    p->hull = kiln_cells_hull(&p->pass->content, s->cell);
    return p->hull->from[0] < p->hull->to[0];
}

static uint4 choose_texture(const struct subject *p)
{
    uint32_t count = p->look->flags.w;
    uint32_t chosen = (uint32_t)(random_unit(p->stream, RANDOM_TEXTURE) * (float)count);
    return p->look->textures[chosen < count ? chosen : count - 1];
}

/* ---- places in the picture ------------------------------------------------------------------- */

/* Pixels from low to high, within 0 to size. */
static void limit_range(float low, float high, float size, int16_t *from, int16_t *to)
{
    low = exact_clamp(low, 0.0f, size);
    high = exact_clamp(high + 1.0f, 0.0f, size);
    *from = (int16_t)low;
    *to = (int16_t)high;
}

static bool limit_box(const struct kiln_view *view, const float low[2], const float high[2],
                      struct kiln_sprite *s)
{
    limit_range(low[0], high[0], view->frustum.z, &s->x_from, &s->x_to);
    limit_range(low[1], high[1], view->frustum.w, &s->y_from, &s->y_to);
    return s->x_from < s->x_to && s->y_from < s->y_to;
}

struct point2 {
    float x, y;
};

/* One of more is too thin to be seen: its texels at a pixel would not be found in 32 bits. */
#define MOST_TEXELS_A_PIXEL 4096.0f

static struct point2 to_pixels(const struct kiln_view *view, float3 v)
{
    float near = 0.5f / -v.z;
    return (struct point2){
        view->frustum.z * (0.5f + v.x / view->frustum.x * near),
        view->frustum.w * (0.5f - v.y / view->frustum.y * near),
    };
}

/* A billboard parallel to the picture. */
static bool place_flat(const struct subject *p, struct kiln_sprite *s)
{
    const struct kiln_view *view = p->pass->view;
    struct point2 middle = to_pixels(view, p->center);
    float scale_x = 0.5f * view->frustum.z / (view->frustum.x * p->depth);
    float scale_y = 0.5f * view->frustum.w / (view->frustum.y * p->depth);
    /* Half edges in pixels, y down. */
    float right_x = p->plane.right.x * p->half_size * scale_x;
    float right_y = p->plane.right.y * p->half_size * -scale_y;
    float up_x = p->plane.up.x * p->half_length * scale_x;
    float up_y = p->plane.up.y * p->half_length * -scale_y;
    float det = right_x * up_y - up_x * right_y;
    if (!(exact_abs(det) > 1e-12f))
        return false;
    float half_edge = 0.5f * s->edge_u / det;
    s->x = middle.x;
    s->y = middle.y;
    s->u = s->v = 0.5f * s->edge_u;
    s->u_x = up_y * half_edge;
    s->u_y = -up_x * half_edge;
    s->v_x = right_y * half_edge; /* v grows downwards */
    s->v_y = -right_x * half_edge;
    if (!(exact_abs(s->u_x) + exact_abs(s->u_y) + exact_abs(s->v_x) + exact_abs(s->v_y) <
          MOST_TEXELS_A_PIXEL))
        return false;
    s->depth = p->depth;
    const struct kiln_cell_hull *hull = p->hull;
    /* The middle and the half edges of the part that shows. */
    float u_from = hull->from[0], v_from = hull->from[1];
    float width = hull->to[0] - u_from, height = hull->to[1] - v_from;
    float across = u_from + hull->to[0] - 1.0f, along = 1.0f - (v_from + hull->to[1]);
    float x = middle.x + right_x * across + up_x * along;
    float y = middle.y + right_y * across + up_y * along;
    float reach_x = exact_abs(right_x) * width + exact_abs(up_x) * height;
    float reach_y = exact_abs(right_y) * width + exact_abs(up_y) * height;
    const float low[2] = {x - reach_x, y - reach_y}, high[2] = {x + reach_x, y + reach_y};
    return limit_box(view, low, high, s);
}

/* A linear function of view space, as one of the pixels about the anchor: constant, x and y. */
static void to_plane(const struct kiln_view *view, const struct kiln_sprite *s, float3 row,
                     float *constant, float *x, float *y)
{
    float tan_x = view->frustum.x, tan_y = view->frustum.y;
    *x = row.x * 2.0f * tan_x / view->frustum.z;
    *y = -row.y * 2.0f * tan_y / view->frustum.w;
    *constant = *x * (s->x - 0.5f * view->frustum.z) + *y * (s->y - 0.5f * view->frustum.w) - row.z;
}

/* A billboard in any plane: a point of the picture is a direction d, and with the inverse of the
 * matrix of right, up and centre, (a, b, 1) / depth = inverse * d. */
static bool place_deep(const struct subject *p, struct kiln_sprite *s)
{
    const struct kiln_view *view = p->pass->view;
    float3 right = float3_scale(p->plane.right, p->half_size);
    float3 up = float3_scale(p->plane.up, p->half_length);
    float3 normal = float3_cross(right, up);
    float det = float3_dot(normal, p->center);
    if (!(exact_abs(det) > 1e-12f))
        return false;
    struct point2 middle = to_pixels(view, p->center);
    s->x = middle.x;
    s->y = middle.y;
    float scale = 1.0f / det, half_edge = 0.5f * s->edge_u;
    float3 a = float3_scale(float3_cross(up, p->center), scale);
    float3 b = float3_scale(float3_cross(p->center, right), scale);
    float3 q = float3_scale(normal, scale);
    /* u = edge (1 + a) / 2, v = edge (1 - b) / 2, all over the depth. */
    float3 u = float3_scale(float3_add(q, a), half_edge);
    float3 v = float3_scale(float3_sub(q, b), half_edge);
    to_plane(view, s, u, &s->u, &s->u_x, &s->u_y);
    to_plane(view, s, v, &s->v, &s->v_x, &s->v_y);
    to_plane(view, s, q, &s->q, &s->q_x, &s->q_y);
    s->flags |= KILN_SPRITE_DEEP;

    float low[2] = {view->frustum.z, view->frustum.w}, high[2] = {0.0f, 0.0f};
    for (int i = 0; i < 4; i++) {
        float across = i & 1 ? p->hull->to[0] : p->hull->from[0];
        float down = i & 2 ? p->hull->to[1] : p->hull->from[1];
        float3 corner = float3_add_scaled(p->center, right, 2.0f * across - 1.0f);
        corner = float3_add_scaled(corner, up, 1.0f - 2.0f * down);
        if (-corner.z < 1e-3f * p->depth) { /* reaches behind the eye: anywhere */
            static const float everywhere[2] = {-1e6f, -1e6f};
            return limit_box(view, everywhere, (const float[2]){1e6f, 1e6f}, s);
        }
        struct point2 at = to_pixels(view, corner);
        low[0] = exact_min(low[0], at.x);
        low[1] = exact_min(low[1], at.y);
        high[0] = exact_max(high[0], at.x);
        high[1] = exact_max(high[1], at.y);
    }
    return limit_box(view, low, high, s);
}

/* A line, or a point as a line of no length: its ends reach out by half of its width, and what is
 * narrower than a pixel is drawn as wide as one, and the fainter. */
static bool place_plain(const struct subject *p, float diameter_px, float scale,
                        struct kiln_sprite *s)
{
    const struct kiln_view *view = p->pass->view;
    bool is_line = p->look->form.x == LOOK_LINE;
    scale *= view->clock.w;
    float width = is_line ? p->turn.w * scale : p->turn.z > 0.0f ? p->turn.z * scale : diameter_px;
    float thin = exact_min(width, 1.0f), half_width = 0.5f * exact_max(width, 1.0f);
    s->opacity *= is_line ? thin : thin * thin;
    float3 head = p->center, tail = head;
    if (is_line) {
        float back = p->look->form.w != 0 ? view->clock.z : p->shape.y;
        tail = float3_add_scaled(head, to_view(view, particle_velocity(p->record)), -back);
    } else if (p->look->form.z != 0) {
        s->flags |= KILN_SPRITE_DISC;
    }
    float near = exact_max(view->eye.w, 1e-3f);
    if (-tail.z < near) {
        float part = (-head.z - near) / (tail.z - head.z);
        tail = float3_add_scaled(head, float3_sub(tail, head), part);
    }
    struct point2 to = to_pixels(view, head), from = to_pixels(view, tail);
    float way_x = to.x - from.x, way_y = to.y - from.y;
    float way = exact_sqrt(way_x * way_x + way_y * way_y);
    float x = 1.0f, y = 0.0f;
    if (way > 1e-3f) {
        x = way_x / way;
        y = way_y / way;
    } else {
        way = 0.0f;
    }
    s->x = 0.5f * (from.x + to.x);
    s->y = 0.5f * (from.y + to.y);
    s->edge_u = 0.5f * way + half_width;
    s->edge_v = half_width;
    s->u = s->v = 0.0f;
    s->u_x = x;
    s->u_y = y;
    s->v_x = -y;
    s->v_y = x;
    float q_head = 1.0f / -head.z, q_tail = 1.0f / -tail.z;
    /* From end to end of the quad, as the shaders interpolate it. */
    float along = 0.5f * (q_head - q_tail) / (s->edge_u + 0.5f);
    s->q = 0.5f * (q_head + q_tail);
    s->q_x = along * x;
    s->q_y = along * y;
    s->depth = p->depth;
    if (is_line)
        s->flags |= KILN_SPRITE_DEEP;
    float reach_u = s->edge_u + 0.5f, reach_v = s->edge_v + 0.5f;
    float reach_x = exact_abs(x) * reach_u + exact_abs(y) * reach_v;
    float reach_y = exact_abs(y) * reach_u + exact_abs(x) * reach_v;
    const float low[2] = {s->x - reach_x, s->y - reach_y};
    const float high[2] = {s->x + reach_x, s->y + reach_y};
    return limit_box(view, low, high, s);
}

/* ---- all of it ------------------------------------------------------------------------------- */

static void read_particle(const struct kiln_sprite_pass *pass, uint32_t entry, struct subject *p)
{
    uint32_t system = KILN_ENTRY_SYSTEM(entry);
    const struct kiln_view *view = pass->view;
    p->pass = pass;
    p->look = &pass->looks[system];
    p->rows = pass->table + (size_t)system * KILN_LOOK_ROWS * KILN_LOOK_SAMPLES;
    p->slot = KILN_ENTRY_SLOT(entry);
    p->record = pass->records[p->slot];
    p->stream = particle_stream(p->look->derived, p->record);
    p->age_s = particle_age(p->record, view->clock_step.x, view->clock.y);
    p->progress = particle_progress(
        p->age_s, particle_life_s(pass->scene->keys, p->look->derived, p->record));
    p->center = to_view_point(view, particle_position(p->record));
    p->depth = -p->center.z;
}

static enum kiln_sprite_shade choose_shade(const struct subject *p, uint32_t kind)
{
    if (p->look->form.x != 0)
        return KILN_SHADE_PLAIN;
    if (kind == KILN_CELL_COLOR)
        return KILN_SHADE_COLOR;
    bool albedo = p->cover.x > 0.0f || p->cover.y > 0.0f || p->cover.z > 0.0f;
    return p->cover.w > 0.0f && albedo ? KILN_SHADE_LIT : KILN_SHADE_GLOW;
}

static bool make_sprite(const struct kiln_sprite_pass *pass, uint32_t entry, struct kiln_sprite *s)
{
    struct subject p;
    read_particle(pass, entry, &p);
    const struct kiln_view *view = pass->view;
    if (!(p.depth > view->eye.w))
        return false;
    p.shape = look_at(&p, KILN_LOOK_SHAPE);
    p.hot = look_at(&p, KILN_LOOK_HOT);
    float near_fade = clamp01((p.depth - view->eye.w) / exact_max(p.hot.w, 1e-6f));
    *s = (struct kiln_sprite){.opacity = p.shape.z * near_fade, .soft = p.shape.w};
    if (!(s->opacity > 0.0f))
        return false;
    p.spread = look_at(&p, KILN_LOOK_SPREAD);
    p.turn = look_at(&p, KILN_LOOK_TURN);
    p.cool = look_at(&p, KILN_LOOK_COOL);
    p.cover = look_at(&p, KILN_LOOK_COVER);
    float scale = lerp(p.spread.x, p.spread.y, random_unit(p.stream, RANDOM_SCALE));
    p.half_size = 0.5f * p.shape.x * scale;
    turn_billboard(&p);

    uint4 texture = choose_texture(&p);
    float pixels_per_m = view->frustum.w / (2.0f * view->frustum.y * exact_max(p.depth, 1e-3f));
    widen(&p, pixels_per_m, s);
    float diameter_px = 2.0f * p.half_size * pixels_per_m;
    s->shade = (uint8_t)choose_shade(&p, texture.z);
    if (p.look->flags.x == 0 || pass->fire_covers)
        s->flags |= KILN_SPRITE_COVERS;
    if (p.look->flags.z != 0)
        s->flags |= KILN_SPRITE_LITERAL;
    s->distance = float3_length(p.center);

    bool seen;
    uint32_t level = level_of(diameter_px);
    if (s->shade == KILN_SHADE_PLAIN) {
        seen = place_plain(&p, diameter_px, scale, s);
    } else {
        uint32_t edge = (uint32_t)KILN_ATLAS_CELL >> level;
        uint32_t facing = p.look->form.y;
        s->edge_u = s->edge_v = (float)edge;
        s->pitch = (uint16_t)(edge + KILN_CELL_MARGIN);
        bool flat = facing == LOOK_SCREEN || facing == LOOK_VELOCITY;
        seen =
            choose_cells(&p, texture, level, s) && (flat ? place_flat(&p, s) : place_deep(&p, s));
    }
    if (!seen)
        return false;
    shade(&p, particle_position(p.record), s);
    return true;
}

KILN_WIDE_VECTORS
void kiln_sprites_make(const struct kiln_sprite_pass *pass, const uint32_t *entries, size_t count,
                       struct kiln_sprite *sprites)
{
    for (size_t i = 0; i < count; i++) {
        if (i + MAKE_AHEAD < count) /* neighbours in depth are far apart in memory */
            __builtin_prefetch(&pass->records[KILN_ENTRY_SLOT(entries[i + MAKE_AHEAD])]);
        if (!make_sprite(pass, entries[i], &sprites[i]))
            sprites[i].x_from = sprites[i].x_to = 0;
    }
}
