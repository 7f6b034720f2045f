/* This file computes the colour of a black body. It sums, every 5 nm, Planck's spectrum times the
 * CIE 1931 colour matching functions, in the multi-lobe fit of Wyman, Sloan and Shirley, "Simple
 * Analytic Approximations to the CIE XYZ Color Matching Functions" (JCGT 2013). XYZ becomes Rec.
 * 709 by the matrix of IEC 61966-2-1. */
#include "asset/atlas/blackbody.h"

#include "shared/exact.h"

struct lobe {
    float scale, center, below, above; /* nm: widths below and above the centre */
};

static float lobe_at(const struct lobe *lobe, float nm)
{
    float t = (nm - lobe->center) * (nm < lobe->center ? lobe->below : lobe->above);
    return lobe->scale * exact_exp(-0.5f * t * t);
}

/* Planck's law up to a factor: l^-5 / (exp(c2 / (l T)) - 1), l in micrometres. */
static float planck(float nm, float kelvin)
{
    float um = nm * 0.001f;
    float exponent = 14387.77f / (um * kelvin);
    if (exponent > 80.0f)
        return 0.0f;
    return 1.0f / (um * um * um * um * um * (exact_exp(exponent) - 1.0f));
}

static float wavelength(int sample)
{
    return (float)(380 + 5 * sample);
}

void kiln_observer_fill(struct kiln_observer *observer)
{
    static const struct lobe X[] = {{0.362f, 442.0f, 0.0624f, 0.0374f},
                                    {1.056f, 599.8f, 0.0264f, 0.0323f},
                                    {-0.065f, 501.1f, 0.0490f, 0.0382f}};
    static const struct lobe Y[] = {{0.821f, 568.8f, 0.0213f, 0.0247f},
                                    {0.286f, 530.9f, 0.0613f, 0.0322f}};
    static const struct lobe Z[] = {{1.217f, 437.0f, 0.0845f, 0.0278f},
                                    {0.681f, 459.0f, 0.0385f, 0.0725f}};
    for (int i = 0; i < KILN_OBSERVER_SAMPLES; i++) {
        const float nm = wavelength(i);
        observer->xyz[i][0] = lobe_at(&X[0], nm) + lobe_at(&X[1], nm) + lobe_at(&X[2], nm);
        observer->xyz[i][1] = lobe_at(&Y[0], nm) + lobe_at(&Y[1], nm);
        observer->xyz[i][2] = lobe_at(&Z[0], nm) + lobe_at(&Z[1], nm);
    }
}

/* Sums up the spectrum of a black body in CIE XYZ, up to a factor. */
static void sum_xyz(const struct kiln_observer *observer, float kelvin, float xyz[3])
{
    xyz[0] = xyz[1] = xyz[2] = 0.0f;
    for (int i = 0; i < KILN_OBSERVER_SAMPLES; i++) {
        float power = planck(wavelength(i), kelvin);
        for (int k = 0; k < 3; k++)
            xyz[k] += power * observer->xyz[i][k];
    }
}

static void rgb_of(const float xyz[3], float scale, float rgb[3])
{
    const float x = xyz[0], y = xyz[1], z = xyz[2];
    const float r = (3.2406f * x - 1.5372f * y - 0.4986f * z) * scale;
    const float g = (-0.9689f * x + 1.8758f * y + 0.0415f * z) * scale;
    const float b = (0.0557f * x - 0.2040f * y + 1.0570f * z) * scale;
    rgb[0] = r > 0.0f ? r : 0.0f;
    rgb[1] = g > 0.0f ? g : 0.0f;
    rgb[2] = b > 0.0f ? b : 0.0f;
}

void kiln_blackbody_color(const struct kiln_observer *observer, float kelvin, float rgb[3])
{
    float xyz[3];
    rgb[0] = rgb[1] = rgb[2] = 0.0f;
    if (!(kelvin >= 400.0f))
        return;
    sum_xyz(observer, kelvin, xyz);
    if (!(xyz[1] > 0.0f))
        return;
    float relative = kelvin / 1900.0f;
    rgb_of(xyz, relative * relative * relative * relative / xyz[1], rgb);
}

float kiln_blackbody_luminance(const struct kiln_observer *observer, float kelvin)
{
    float xyz[3] = {0.0f, 0.0f, 0.0f};
    if (kelvin >= 400.0f)
        sum_xyz(observer, kelvin, xyz);
    return xyz[1];
}

void kiln_blackbody_light(const struct kiln_observer *observer, float kelvin, float luminance,
                          float rgb[3])
{
    float xyz[3] = {0.0f, 0.0f, 0.0f};
    if (kelvin >= 400.0f)
        sum_xyz(observer, kelvin, xyz);
    rgb_of(xyz, luminance > 0.0f ? 1.0f / luminance : 0.0f, rgb);
}
