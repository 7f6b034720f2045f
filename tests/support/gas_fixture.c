/* Fills windows of gas with smooth or lumpy balls of smoke and fire, or evenly. */
#include "support/gas_fixture.h"

#include <math.h>

#include "support/cmocka.h"

/* Makes a domain whose window is all of it. */
static void open_window(struct kiln_gas *gas, int32_t n, float cell)
{
    const float edge = (float)n * cell;
    const struct kiln_gas_shape shape = {
        .cells = {n, n, n}, .cell = cell, .corner = FLOAT3(-0.5f * edge, 0.0f, -0.5f * edge)};
    kiln_gas_init(gas, &shape);
    assert_true(kiln_gas_set_window(gas, (struct kiln_gas_place){0, 0, 0}, shape.cells));
}

void gas_fixture_full(struct kiln_gas *gas, int32_t n, float cell, float smoke, float temperature,
                      float flame)
{
    open_window(gas, n, cell);
    for (size_t i = 0; i < (size_t)n / 8 * ((size_t)n / 8) * ((size_t)n / 8); i++) {
        assert_true(kiln_gas_brick_take(gas, &gas->brick[i]));
        gas->has_gas[i] = 1;
        for (int k = 0; k < GAS_BRICK_CELLS; k++) {
            float *q = gas->brick[i].now + k * GAS_CARRIED;
            q[GAS_SMOKE] = smoke;
            q[GAS_TEMPERATURE] = temperature;
            q[GAS_FLAME] = flame;
        }
    }
}

void gas_fixture_ball(struct kiln_gas *gas, int32_t n, float cell, float radius, float smoke,
                      float heat)
{
    open_window(gas, n, cell);
    for (int32_t z = 0; z < n; z++)
        for (int32_t y = 0; y < n; y++)
            for (int32_t x = 0; x < n; x++) {
                gas->faces[1][z * gas->plane + y * gas->row + x] = 1.0f;
                const float dx = (float)x + 0.5f - 0.5f * (float)n;
                const float dy = (float)y + 0.5f - 0.5f * (float)n;
                const float dz = (float)z + 0.5f - 0.5f * (float)n;
                const float inside = radius * (float)n - sqrtf(dx * dx + dy * dy + dz * dz);
                const float part = fminf(fmaxf(0.5f * inside + 0.5f, 0.0f), 1.0f);
                const size_t at = kiln_gas_brick_index(gas, x / 8, y / 8, z / 8);
                if (part == 0.0f)
                    continue;
                assert_true(kiln_gas_brick_take(gas, &gas->brick[at]));
                gas->has_gas[at] = 1;
                float *q = gas->brick[at].now + ((z % 8 * 8 + y % 8) * 8 + x % 8) * GAS_CARRIED;
                q[GAS_SMOKE] = part * smoke;
                q[GAS_TEMPERATURE] = q[GAS_FLAME] = dy > 0.0f ? part * heat : 0.0f;
            }
}

void gas_fixture_lumps(struct kiln_gas *gas, int32_t cells)
{
    const float middle = 0.5f * (float)(cells - 1), scale = 64.0f / (float)cells;
    gas_fixture_ball(gas, cells, 2.0f / (float)cells, 0.45f, 1.0f, 1.0f);
    for (int32_t z = 0; z < cells; z++)
        for (int32_t y = 0; y < cells; y++)
            for (int32_t x = 0; x < cells; x++) {
                const size_t number =
                    kiln_gas_brick_index(gas, x / GAS_BRICK, y / GAS_BRICK, z / GAS_BRICK);
                const int32_t in =
                    (z % GAS_BRICK * GAS_BRICK + y % GAS_BRICK) * GAS_BRICK + x % GAS_BRICK;
                if (!gas->brick[number].now)
                    continue;
                float *cell = gas->brick[number].now + (ptrdiff_t)in * GAS_CARRIED;
                const float a = scale * ((float)x - middle), b = scale * ((float)y - middle);
                const float c = scale * ((float)z - middle);
                const float radius = sqrtf(a * a + b * b + c * c);
                cell[GAS_SMOKE] *= 0.55f + 0.45f * sinf(0.5f * a) * sinf(0.4f * b) * sinf(0.6f * c);
                cell[GAS_FLAME] *= fabsf(radius - 22.0f) < 2.0f ? 1.0f : 0.0f;
            }
}
