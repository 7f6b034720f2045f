/* Returns where a view depth, in m, lies in the depth buffer that rejects hidden particles
 * (lib/draw/sprites/occlusion.h), as z in normalised device coordinates. A depth of 2^-16 m (15
 * micrometres) or less lies at 0, and each doubling of the depth lies 1/64 farther, up to 0.75.
 *
 * corner.glsl places particles by it, and occlusion.frag the scene, with some slack; so both must
 * use this function. It must not fall as the depth grows. Its values stay between -1 and 1, so that
 * no particle is clipped. It is a logarithm, so that the slack is the same part of every depth. */
float occlusion_place(float depth)
{
    return clamp((log2(max(depth, 1e-6)) + 16.0) / 64.0, 0.0, 0.75);
}
