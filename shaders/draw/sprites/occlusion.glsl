/* Maps view depths into the depth buffer that rejects hidden particles
 * (lib/draw/sprites/occlusion.h). corner.glsl gives particles this z. occlusion.frag writes the z
 * of the scene, pushed a little farther away, so that rounding never rejects a visible particle. */

/* Returns the z, in normalised device coordinates, of a view depth in m. A depth of 2^-16 m (15
 * micrometres) or less has z 0, and each doubling of the depth adds 1/64, up to 0.75. z must never
 * decrease with the depth. It stays between -1 and 1, so that no particle is clipped. It is a
 * logarithm, so that what occlusion.frag adds is the same fraction of every depth. */
float occlusion_z(float depth)
{
    return clamp((log2(max(depth, 1e-6)) + 16.0) / 64.0, 0.0, 0.75);
}
