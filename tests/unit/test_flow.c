/* Optical flow against motions that are known. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "output/flow.h"
#include "support/cmocka.h"

enum { EDGE = 96, PIXELS = EDGE * EDGE };

/* Smooth noise: sums of waves that never repeat within the picture. */
static double texture(double x, double y)
{
    return 0.5 + 0.14 * sin(0.31 * x + 0.17 * y) + 0.12 * sin(0.11 * x - 0.29 * y + 1) +
           0.1 * sin(0.53 * x + 0.47 * y + 2) + 0.1 * sin(-0.61 * x + 0.37 * y + 3);
}

/* A soft puff with a texture inside, premultiplied, and its cover. */
static void draw_puff(float *pixels, double cx, double cy)
{
    for (int i = 0; i < PIXELS; i++) {
        double x = i % EDGE - cx, y = i / EDGE - cy;
        double cover = exp(-(x * x + y * y) / 200);
        pixels[2 * i] = (float)(cover * texture(2 * x, 2 * y));
        pixels[2 * i + 1] = (float)cover;
    }
}

struct motion {
    double a, b, c, d, x, y; /* p -> center + (a b; c d) (p - center) + (x, y) */
};

static void move(const struct motion *motion, double x, double y, double out[2])
{
    double dx = x - EDGE / 2.0, dy = y - EDGE / 2.0;
    out[0] = EDGE / 2.0 + motion->a * dx + motion->b * dy + motion->x;
    out[1] = EDGE / 2.0 + motion->c * dx + motion->d * dy + motion->y;
}

static void motions_of_a_texture_are_found(void **state)
{
    (void)state;
    static const struct motion motions[] = {
        {1, 0, 0, 1, 0, 0},
        {1, 0, 0, 1, 0.5, 0},
        {1, 0, 0, 1, -3.25, 1.5},
        {1, 0, 0, 1, 7.3, -4.6},
        {0.998, 0.06, -0.06, 0.998, 0, 0}, /* turns */
        {1.05, 0, 0, 1.05, 1, 0.5},        /* grows */
    };
    static float from[PIXELS], to[PIXELS], flow[2 * PIXELS];
    for (size_t m = 0; m < sizeof motions / sizeof *motions; m++) {
        const struct motion *motion = &motions[m];
        double det = motion->a * motion->d - motion->b * motion->c;
        for (int i = 0; i < PIXELS; i++) {
            double x = i % EDGE, y = i / EDGE;
            to[i] = (float)texture(x, y);
            double moved[2];
            move(motion, x, y, moved);
            from[i] = (float)texture(moved[0], moved[1]);
        }
        assert_true(det > 0);
        assert_true(kiln_flow_estimate(from, to, EDGE, EDGE, 1, flow));
        double sum = 0, worst = 0;
        int count = 0;
        for (int i = 0; i < PIXELS; i++) {
            int x = i % EDGE, y = i / EDGE;
            if (x < 12 || y < 12 || x >= EDGE - 12 || y >= EDGE - 12)
                continue;
            double moved[2];
            move(motion, x, y, moved);
            double error = hypot(flow[2 * i] - (moved[0] - x), flow[2 * i + 1] - (moved[1] - y));
            sum += error;
            worst = error > worst ? error : worst;
            count++;
        }
        print_message("motion %zu: mean error %.3f, worst %.3f pixels\n", m, sum / count, worst);
        assert_true(sum / count < 0.1 && worst < 0.6);
        assert_true(m > 0 || worst < 1e-6);
    }
}

static double bilinear(const float *pixels, double x, double y, int channel)
{
    x = fmin(fmax(x, 0), EDGE - 1.001);
    y = fmin(fmax(y, 0), EDGE - 1.001);
    int ix = (int)x, iy = (int)y;
    const float *at = pixels + 2 * (iy * EDGE + ix) + channel;
    double top = at[0] + (x - ix) * (at[2] - at[0]);
    double bottom = at[2 * EDGE] + (x - ix) * (at[2 * EDGE + 2] - at[2 * EDGE]);
    return top + (y - iy) * (bottom - top);
}

/* What a flipbook's motion vectors are for: the picture half-way, as an engine makes it of both
 * cells, against the true one. */
static void half_way_beats_a_cross_fade(void **state)
{
    (void)state;
    static float from[2 * PIXELS], to[2 * PIXELS], middle[2 * PIXELS], flow[2 * PIXELS];
    draw_puff(from, 40, 44);
    draw_puff(middle, 45, 41);
    draw_puff(to, 50, 38);
    assert_true(kiln_flow_estimate(from, to, EDGE, EDGE, 2, flow));
    double faded = 0, bent = 0, still = 0;
    for (int i = 0; i < PIXELS; i++) {
        double x = i % EDGE, y = i / EDGE, u = flow[2 * i], v = flow[2 * i + 1];
        for (int c = 0; c < 2; c++) {
            double truth = middle[2 * i + c];
            double mix = 0.5 * (from[2 * i + c] + to[2 * i + c]);
            double warped = 0.5 * (bilinear(from, x - 0.5 * u, y - 0.5 * v, c) +
                                   bilinear(to, x + 0.5 * u, y + 0.5 * v, c));
            faded += fabs(mix - truth);
            bent += fabs(warped - truth);
            still += fabs(from[2 * i + c] - truth);
        }
    }
    print_message("error half-way: still %.1f, faded %.1f, by motion %.1f\n", still, faded, bent);
    assert_true(bent < 0.2 * faded);
    int center = 44 * EDGE + 40;
    assert_true(hypot((double)flow[2 * center] - 10, (double)flow[2 * center + 1] + 6) < 0.5);
}

/* Something new must not drag what stands beside it. */
static void what_appears_pulls_nothing_along(void **state)
{
    (void)state;
    static float from[PIXELS], to[PIXELS], flow[2 * PIXELS];
    for (int i = 0; i < PIXELS; i++) {
        double x = i % EDGE, y = i / EDGE;
        from[i] = to[i] = (float)texture(x, y);
        if (hypot(x - 70, y - 30) < 8)
            to[i] = 1.5f;
    }
    assert_true(kiln_flow_estimate(from, to, EDGE, EDGE, 1, flow));
    for (int i = 0; i < PIXELS; i++) {
        int x = i % EDGE, y = i / EDGE;
        if (hypot(x - 70, y - 30) > 24)
            assert_true(hypot((double)flow[2 * i], (double)flow[2 * i + 1]) < 0.3);
    }
}

static void any_size_will_do(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{1, 1}, {1, 9}, {2, 2}, {17, 3}, {64, 1}, {31, 45}};
    float from[31 * 45 * 4], to[31 * 45 * 4], flow[31 * 45 * 2];
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        uint32_t width = sizes[i][0], height = sizes[i][1];
        for (uint32_t j = 0; j < width * height * 4; j++) {
            from[j] = (float)texture(j % 5, j);
            to[j] = (float)texture(j % 7, j);
        }
        assert_true(kiln_flow_estimate(from, to, width, height, 4, flow));
        for (uint32_t j = 0; j < 2 * width * height; j++)
            assert_true(isfinite(flow[j]));
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(motions_of_a_texture_are_found),
        cmocka_unit_test(half_way_beats_a_cross_fade),
        cmocka_unit_test(what_appears_pulls_nothing_along),
        cmocka_unit_test(any_size_will_do),
    };
    return cmocka_run_group_tests_name("flow", tests, NULL, NULL);
}
