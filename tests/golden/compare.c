/* compare GOLDEN TEST: exit 0 when two pictures look the same.
 *
 * Pixels are exact per driver only, so goldens allow what another driver's rounding gives: few
 * pixels off by more than STEP levels, and a small mean difference. */
#include <inttypes.h>
#include <stdlib.h>

#include "asset/image.h"

static const int STEP = 10;            /* levels of 255 */
static const double MAX_SHARE = 0.005; /* of the pixels may differ by more than STEP */
static const double MAX_MEAN_LEVELS = 0.5;

struct difference {
    double mean;  /* levels */
    double share; /* of pixels beyond STEP */
    int largest;
    uint32_t x, y; /* where */
};

static struct difference measure(const struct kiln_asset_image *a, const struct kiln_asset_image *b)
{
    struct difference d = {0};
    const uint8_t *p = a->pixels, *q = b->pixels;
    uint64_t sum = 0, beyond = 0;
    for (uint32_t y = 0; y < a->height; y++) {
        for (uint32_t x = 0; x < a->width; x++, p += 4, q += 4) {
            int worst = 0;
            for (int c = 0; c < 4; c++) {
                int delta = abs(p[c] - q[c]);
                sum += (uint64_t)delta;
                worst = delta > worst ? delta : worst;
            }
            beyond += worst > STEP;
            if (worst > d.largest) {
                d.largest = worst;
                d.x = x;
                d.y = y;
            }
        }
    }
    double pixels = (double)a->width * a->height;
    d.mean = (double)sum / (4.0 * pixels);
    d.share = (double)beyond / pixels;
    return d;
}

static bool same(const char *golden, const char *test)
{
    struct kiln_error error = {0};
    struct kiln_asset_image *a = kiln_asset_image_load(golden, &error);
    struct kiln_asset_image *b = a ? kiln_asset_image_load(test, &error) : NULL;
    bool ok = false;
    if (!b) {
        fprintf(stderr, "%s\n", error.message);
    } else if (a->width != b->width || a->height != b->height || a->type != KILN_IMAGE_U8 ||
               b->type != KILN_IMAGE_U8) {
        fprintf(stderr, "%s is %ux%u, %s is %ux%u; both must be 8-bit and of one size\n", golden,
                a->width, a->height, test, b->width, b->height);
    } else {
        struct difference d = measure(a, b);
        ok = d.share <= MAX_SHARE && d.mean <= MAX_MEAN_LEVELS;
        printf("%s: mean %.4f levels (limit %g), %.3f %% of pixels beyond %d levels (limit %g %%), "
               "largest %d at %u,%u: %s\n",
               test, d.mean, MAX_MEAN_LEVELS, 100.0 * d.share, STEP, 100.0 * MAX_SHARE, d.largest,
               d.x, d.y, ok ? "same" : "different");
    }
    kiln_asset_image_destroy(&a);
    kiln_asset_image_destroy(&b);
    return ok;
}

int main(int argc, char **argv)
{
    if (argc != 3) {
        fprintf(stderr, "usage: compare GOLDEN TEST\n");
        return 2;
    }
    return same(argv[1], argv[2]) ? 0 : 1;
}
