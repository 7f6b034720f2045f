/* This file computes paths. The curve between two points is a cubic. Its length has no closed form,
 * so that each cubic is divided into pieces whose lengths are integrated once by Gauss's rule of
 * five points. A place is found by its length: the piece by bisection among the sums of lengths,
 * the place within the piece by Newton's method, which doubles the number of correct digits each
 * time.
 *
 * The direction that is carried along as "up" turns with the curve and never about it: a rotation
 * minimising frame by double reflection (Wang, Juettler, Zheng and Liu 2008), from piece to piece.
 */
#include "scene/path.h"

#include <math.h>
#include <string.h>

#include "scene/double3.h"

enum { PIECES = 8, ROUNDS = 5 };

struct piece {
    double before;                 /* m: length of the curve before the piece */
    double at[3], ahead[3], up[3]; /* at its start */
};

struct cubic {
    double terms[4][3]; /* factors of 1, u, u^2 and u^3 for u from 0 to 1 */
};

struct kiln_path_table {
    uint32_t cubics;
    struct cubic *cubic;
    struct piece *pieces; /* PIECES for each cubic, and one for the end */
};

/* ---- vectors --------------------------------------------------------------------------------- */

static void add_scaled(double y[3], const double a[3], double factor)
{
    for (int c = 0; c < 3; c++)
        y[c] += a[c] * factor;
}

static void subtract(double y[3], const double a[3], const double b[3])
{
    for (int c = 0; c < 3; c++)
        y[c] = a[c] - b[c];
}

/* Makes a vector a unit vector; false, and no change, if it has no length. */
static bool make_unit(double a[3])
{
    const double length = sqrt(double3_dot(a, a));
    if (!(length > 1e-12))
        return false;
    for (int c = 0; c < 3; c++)
        a[c] /= length;
    return true;
}

/* Makes `up` a unit vector across the unit vector `ahead`. */
static void make_across(double up[3], const double ahead[3])
{
    add_scaled(up, ahead, -double3_dot(up, ahead));
    if (make_unit(up))
        return;
    const double other[3] = {0, fabs(ahead[1]) < 0.9 ? 1 : 0, fabs(ahead[1]) < 0.9 ? 0 : 1};
    memcpy(up, other, sizeof other);
    add_scaled(up, ahead, -double3_dot(up, ahead));
    make_unit(up);
}

/* ---- curve ----------------------------------------------------------------------------------- */

static void cubic_at(const struct cubic *cubic, double u, double y[3])
{
    const double(*k)[3] = cubic->terms;
    for (int c = 0; c < 3; c++)
        y[c] = k[0][c] + u * (k[1][c] + u * (k[2][c] + u * k[3][c]));
}

/* Computes the derivative of a cubic by u. */
static void cubic_rate(const struct cubic *cubic, double u, double y[3])
{
    const double(*k)[3] = cubic->terms;
    for (int c = 0; c < 3; c++)
        y[c] = k[1][c] + u * (2 * k[2][c] + u * 3 * k[3][c]);
}

static double cubic_speed(const struct cubic *cubic, double u)
{
    double rate[3];
    cubic_rate(cubic, u, rate);
    return sqrt(double3_dot(rate, rate));
}

/* Returns the length of a cubic from u = from to u = to. */
static double cubic_length(const struct cubic *cubic, double from, double to)
{
    static const double places[3] = {0, 0.53846931010568309, 0.90617984593866399};
    static const double weights[3] = {0.56888888888888889, 0.47862867049936647,
                                      0.23692688505618909};
    const double half = 0.5 * (to - from), middle = from + half;
    double sum = weights[0] * cubic_speed(cubic, middle);
    for (int i = 1; i < 3; i++)
        sum += weights[i] * (cubic_speed(cubic, middle - half * places[i]) +
                             cubic_speed(cubic, middle + half * places[i]));
    return sum * half;
}

/* Finds the direction of a cubic at u. Where a curve turns back in its own way, it has none, and
 * its direction is that beside the place. */
static void cubic_ahead(const struct cubic *cubic, double u, double ahead[3])
{
    cubic_rate(cubic, u, ahead);
    if (make_unit(ahead))
        return;
    cubic_rate(cubic, u < 0.5 ? u + 1e-4 : u - 1e-4, ahead);
    if (!make_unit(ahead))
        memcpy(ahead, (const double[3]){0, 0, 1}, sizeof(double[3]));
}

/* Reads a point by its number. Beyond the ends of an open curve, the neighbour of the end is
 * mirrored there. */
static void point_at(const struct kiln_path *path, int64_t number, double y[3])
{
    const int64_t count = path->points.count;
    const float(*at)[3] = path->points.at;
    if (path->closed)
        number = (number + count) % count;
    for (int c = 0; c < 3; c++) {
        if (number < 0)
            y[c] = 2 * (double)at[0][c] - (double)at[1][c];
        else if (number >= count)
            y[c] = 2 * (double)at[count - 1][c] - (double)at[count - 2][c];
        else
            y[c] = (double)at[number][c];
    }
}

/* Returns the distance of two points on the scale of the parameter: the root of their distance. */
static double knot_between(const double a[3], const double b[3])
{
    double way[3];
    subtract(way, b, a);
    return sqrt(sqrt(double3_dot(way, way)));
}

/* Computes the velocity at point b of the curve through a, b and c, for the parameter's distances
 * between them. */
static void velocity_at(const double a[3], const double b[3], const double c[3], double before,
                        double after, double y[3])
{
    for (int i = 0; i < 3; i++)
        y[i] = (b[i] - a[i]) / before - (c[i] - a[i]) / (before + after) + (c[i] - b[i]) / after;
}

/* Makes the cubic from point `number` to the next one. */
static void make_cubic(const struct kiln_path *path, uint32_t number, struct cubic *cubic)
{
    double p[4][3], knots[3], first[3], last[3];
    for (int i = 0; i < 4; i++)
        point_at(path, (int64_t)number + i - 1, p[i]);
    for (int i = 0; i < 3; i++)
        knots[i] = knot_between(p[i], p[i + 1]);
    velocity_at(p[0], p[1], p[2], knots[0], knots[1], first);
    velocity_at(p[1], p[2], p[3], knots[1], knots[2], last);
    for (int c = 0; c < 3; c++) {
        const double way = p[2][c] - p[1][c], from = first[c] * knots[1], to = last[c] * knots[1];
        cubic->terms[0][c] = p[1][c];
        cubic->terms[1][c] = from;
        cubic->terms[2][c] = 3 * way - 2 * from - to;
        cubic->terms[3][c] = from + to - 2 * way;
    }
}

/* ---- table ----------------------------------------------------------------------------------- */

/* Chooses the up of the first point: the world's, or on a vertical way that which the smallest
 * rotation from z gives. */
static void first_up(const double ahead[3], double up[3])
{
    const bool steep = fabs(ahead[1]) > 0.9999;
    up[0] = 0;
    up[1] = steep ? 0 : 1;
    up[2] = !steep ? 0 : ahead[1] > 0 ? -1 : 1;
    make_across(up, ahead);
}

/* Reflects a vector at the plane through the origin across another vector. */
static void reflect(double y[3], const double across[3])
{
    const double square = double3_dot(across, across);
    if (square > 0)
        add_scaled(y, across, -2 * double3_dot(across, y) / square);
}

/* Carries up from the start of a piece to a place on it. */
static void carry_up(const struct piece *from, const double at[3], const double ahead[3],
                     double up[3])
{
    double way[3], turned[3], rest[3];
    subtract(way, at, from->at);
    memcpy(up, from->up, sizeof from->up);
    memcpy(turned, from->ahead, sizeof turned);
    reflect(up, way);
    reflect(turned, way);
    subtract(rest, ahead, turned);
    reflect(up, rest);
    make_across(up, ahead);
}

const struct kiln_path_table *kiln_path_table_create(struct kiln_arena *arena,
                                                     const struct kiln_path *path)
{
    const uint32_t cubics = path->points.count - (path->closed ? 0 : 1);
    struct kiln_path_table *table = kiln_arena_alloc(arena, 1, sizeof *table);
    struct cubic *cubic = kiln_arena_alloc(arena, cubics, sizeof *cubic);
    struct piece *pieces = kiln_arena_alloc(arena, (size_t)cubics * PIECES + 1, sizeof *pieces);
    if (!table || !cubic || !pieces)
        return NULL;
    *table = (struct kiln_path_table){.cubics = cubics, .cubic = cubic, .pieces = pieces};
    for (uint32_t i = 0; i < cubics; i++)
        make_cubic(path, i, &cubic[i]);
    for (uint32_t i = 0; i <= cubics * PIECES; i++) {
        const bool is_end = i == cubics * PIECES;
        const struct cubic *own = &cubic[is_end ? cubics - 1 : i / PIECES];
        const double u = is_end ? 1 : (double)(i % PIECES) / PIECES;
        cubic_at(own, u, pieces[i].at);
        cubic_ahead(own, u, pieces[i].ahead);
        pieces[i].before = 0;
        if (i == 0) {
            first_up(pieces[i].ahead, pieces[i].up);
            continue;
        }
        const struct cubic *last = &cubic[(i - 1) / PIECES];
        const double from = (double)((i - 1) % PIECES) / PIECES;
        pieces[i].before = pieces[i - 1].before + cubic_length(last, from, from + 1.0 / PIECES);
        carry_up(&pieces[i - 1], pieces[i].at, pieces[i].ahead, pieces[i].up);
    }
    return table;
}

size_t kiln_path_bytes(const struct kiln_path *path)
{
    return path->points.count * (sizeof(struct cubic) + PIECES * sizeof(struct piece));
}

double kiln_path_length(const struct kiln_path *path)
{
    return path->table->pieces[(size_t)path->table->cubics * PIECES].before;
}

/* ---- places ---------------------------------------------------------------------------------- */

/* Returns the last piece that begins at or before a length. */
static uint32_t find_piece(const struct kiln_path_table *table, double length)
{
    uint32_t low = 0, high = table->cubics * PIECES;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (table->pieces[middle].before <= length)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* Returns u of the place of a piece at which the curve has a length. */
static double find_place(const struct kiln_path_table *table, uint32_t piece, double length)
{
    const struct cubic *cubic = &table->cubic[piece / PIECES];
    const struct piece *own = &table->pieces[piece];
    const double from = (double)(piece % PIECES) / PIECES, to = from + 1.0 / PIECES;
    const double whole = own[1].before - own[0].before, wanted = length - own[0].before;
    double u = whole > 0 ? from + wanted / whole / PIECES : from;
    for (int i = 0; i < ROUNDS; i++) {
        const double speed = cubic_speed(cubic, u);
        if (speed > 1e-9)
            u -= (cubic_length(cubic, from, u) - wanted) / speed;
        u = u < from ? from : u > to ? to : u;
    }
    return u;
}

/* Returns the part of the length that is behind the node after the part t of the time, and sets how
 * fast it grows with t. */
static double part_of_length(unsigned ease, double t, double *rate)
{
    switch (ease) {
    case VALUE_STEP:
        *rate = 0;
        return floor(t);
    case VALUE_SMOOTH:
        *rate = 6 * t * (1 - t);
        return t * t * (3 - 2 * t);
    case VALUE_IN:
        *rate = 2 * t;
        return t * t;
    case VALUE_OUT:
        *rate = 2 - 2 * t;
        return 2 * t - t * t;
    default:
        *rate = 1;
        return t;
    }
}

/* Returns the part of the path's time that has passed. */
static double part_of_time(const struct kiln_path *path, float time_s)
{
    const double from = (double)path->over.min.constant, to = (double)path->over.max.constant;
    const double t = ((double)time_s - from) / (to - from);
    return t < 0 ? 0 : t > 1 ? 1 : t;
}

/* Returns the speed along the curve at a time, m/s: 0 before the path begins and after its end. */
static double speed_at(const struct kiln_path *path, float time_s)
{
    const double from = (double)path->over.min.constant, to = (double)path->over.max.constant;
    double rate;
    if (!((double)time_s >= from && (double)time_s < to))
        return 0;
    part_of_length(path->ease, part_of_time(path, time_s), &rate);
    return rate * kiln_path_length(path) / (to - from);
}

struct kiln_path_place kiln_path_at(const struct kiln_path *path, float time_s, float rate_s)
{
    const struct kiln_path_table *table = path->table;
    struct kiln_path_place place;
    double unused, rate[3], bend[3], turn[3];
    const double part = part_of_length(path->ease, part_of_time(path, time_s), &unused);
    const double length = part * kiln_path_length(path);
    const uint32_t piece = find_piece(table, length);
    const struct cubic *cubic = &table->cubic[piece / PIECES];
    const double u = find_place(table, piece, length), metres_per_s = speed_at(path, rate_s);
    cubic_at(cubic, u, place.at);
    cubic_ahead(cubic, u, place.ahead);
    carry_up(&table->pieces[piece], place.at, place.ahead, place.up);
    /* `ahead` turns about the axis ahead x bend by |bend across ahead| / |rate| for each u */
    cubic_rate(cubic, u, rate);
    const double speed = sqrt(double3_dot(rate, rate)),
                 u_per_s = speed > 1e-9 ? metres_per_s / speed : 0;
    for (int c = 0; c < 3; c++) {
        bend[c] = 2 * cubic->terms[2][c] + u * 6 * cubic->terms[3][c];
        place.velocity[c] = place.ahead[c] * metres_per_s;
    }
    double3_cross(turn, place.ahead, bend);
    for (int c = 0; c < 3; c++)
        place.spin[c] = speed > 1e-9 ? turn[c] / speed * u_per_s : 0;
    return place;
}
