/* Computes colours of the map magma, by Nathaniel J. Smith and Stefan van der Walt (published under
 * CC0 with matplotlib 1.5, as 256 colours of six digits). The table has every fifth entry; colours
 * between them are interpolated linearly. */
#include "compare/magma.h"

enum { STEP = 5, POINTS = 52 };

static const float points[POINTS][3] = {
    {0.0015f, 0.0005f, 0.0139f}, {0.0076f, 0.0064f, 0.0450f}, {0.0188f, 0.0160f, 0.0846f},
    {0.0355f, 0.0284f, 0.1252f}, {0.0566f, 0.0422f, 0.1674f}, {0.0788f, 0.0542f, 0.2117f},
    {0.1028f, 0.0630f, 0.2579f}, {0.1294f, 0.0679f, 0.3054f}, {0.1590f, 0.0684f, 0.3527f},
    {0.1915f, 0.0648f, 0.3962f}, {0.2253f, 0.0604f, 0.4317f}, {0.2589f, 0.0597f, 0.4577f},
    {0.2914f, 0.0646f, 0.4755f}, {0.3229f, 0.0738f, 0.4874f}, {0.3538f, 0.0854f, 0.4955f},
    {0.3843f, 0.0979f, 0.5010f}, {0.4147f, 0.1104f, 0.5047f}, {0.4452f, 0.1227f, 0.5069f},
    {0.4758f, 0.1346f, 0.5079f}, {0.5066f, 0.1460f, 0.5078f}, {0.5378f, 0.1569f, 0.5066f},
    {0.5692f, 0.1675f, 0.5041f}, {0.6009f, 0.1777f, 0.5004f}, {0.6328f, 0.1879f, 0.4953f},
    {0.6649f, 0.1981f, 0.4888f}, {0.6971f, 0.2085f, 0.4808f}, {0.7292f, 0.2194f, 0.4713f},
    {0.7611f, 0.2312f, 0.4602f}, {0.7924f, 0.2442f, 0.4475f}, {0.8229f, 0.2590f, 0.4336f},
    {0.8521f, 0.2761f, 0.4186f}, {0.8795f, 0.2961f, 0.4031f}, {0.9043f, 0.3196f, 0.3881f},
    {0.9259f, 0.3468f, 0.3750f}, {0.9440f, 0.3776f, 0.3651f}, {0.9585f, 0.4113f, 0.3600f},
    {0.9697f, 0.4469f, 0.3603f}, {0.9782f, 0.4836f, 0.3660f}, {0.9846f, 0.5207f, 0.3767f},
    {0.9894f, 0.5579f, 0.3917f}, {0.9928f, 0.5949f, 0.4103f}, {0.9951f, 0.6317f, 0.4320f},
    {0.9966f, 0.6683f, 0.4562f}, {0.9973f, 0.7046f, 0.4826f}, {0.9973f, 0.7408f, 0.5110f},
    {0.9967f, 0.7768f, 0.5410f}, {0.9957f, 0.8127f, 0.5726f}, {0.9942f, 0.8485f, 0.6057f},
    {0.9924f, 0.8843f, 0.6401f}, {0.9906f, 0.9200f, 0.6757f}, {0.9887f, 0.9557f, 0.7122f},
    {0.9871f, 0.9914f, 0.7495f},
};

void kiln_magma_color(float error, uint8_t rgb[3])
{
    int index = error > 0.0f ? error < 1.0f ? (int)(255.0f * error + 0.5f) : 255 : 0;
    int low = index / STEP;
    int high = low + 1 < POINTS ? low + 1 : low;
    float part = (float)(index % STEP) / (float)STEP;
    for (int c = 0; c < 3; c++) {
        float value = points[low][c] + part * (points[high][c] - points[low][c]);
        rgb[c] = (uint8_t)(255.0f * value + 0.5f);
    }
}
