/* Scene-linear Rec. 709 to display-linear Rec. 709, 0 to 1. */

/* AgX by Troy Sobotka: colours are desaturated into a smaller gamut, a sigmoid acts on their
 * logarithm, and the gamut is opened again. The matrices and the polynomial that stands for the
 * sigmoid are Benjamin Wrensch's fit ("Minimal AgX implementation", 2023; mean error 1e-6); the
 * result is encoded with gamma 2.2, which is taken off here. */
vec3 tonemap_agx(vec3 color)
{
    const mat3 inset = mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051,
                            0.0784335999999992, 0.878468636469772, 0.0784336,
                            0.0792237451477643, 0.0791661274605434, 0.879142973793104);
    const mat3 outset = mat3(1.19687900512017, -0.0528968517574562, -0.0529716355144438,
                             -0.0980208811401368, 1.15190312990417, -0.0980434501171241,
                             -0.0990297440797205, -0.0989611768448433, 1.15107367264116);
    const float min_ev = -12.47393, max_ev = 4.026069;
    vec3 x = (log2(max(inset * color, vec3(1e-10))) - min_ev) / (max_ev - min_ev);
    x = clamp(x, 0.0, 1.0);
    vec3 x2 = x * x, x4 = x2 * x2;
    vec3 curve = 15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 +
                 0.1191 * x - 0.00232;
    return pow(max(outset * curve, vec3(0.0)), vec3(2.2));
}

/* ACES: Stephen Hill's fit of the RRT and the Rec. 709 ODT, in its own primaries. */
vec3 tonemap_aces(vec3 color)
{
    const mat3 to_rrt = mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823,
                             0.01566, 0.83777);
    const mat3 from_rrt = mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367,
                               -0.00605, 1.07602);
    vec3 v = to_rrt * color;
    v = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    return clamp(from_rrt * v, 0.0, 1.0);
}

/* IEC 61966-2-1. */
vec3 encode_srgb(vec3 linear)
{
    vec3 low = linear * 12.92;
    vec3 high = 1.055 * pow(max(linear, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055;
    return mix(high, low, lessThanEqual(linear, vec3(0.0031308)));
}
