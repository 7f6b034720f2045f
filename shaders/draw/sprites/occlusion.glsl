/* Where a view depth, m, lies in the depth buffer, from 0 for what nothing hides, of normalised device
 * coordinates: evenly by octaves, from 15 micrometres on. */
float occlusion_place(float depth)
{
    return clamp((log2(max(depth, 1e-6)) + 16.0) / 64.0, 0.0, 0.75);
}
