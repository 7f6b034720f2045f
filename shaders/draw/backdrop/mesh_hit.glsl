/* Packs a ray's hit on a mesh into two words: the depth, and the mesh's number with the normal,
 * which is unfolded from an octahedron into 2 x 14 bits, or 2 x 12 with MANY_MESHES.
 * meshes.frag packs hits, and mesh_trace.glsl unpacks them for backdrop.frag. */
#ifdef MANY_MESHES
#define NORMAL_BITS 12
#else
#define NORMAL_BITS 14
#endif
const uint NORMAL_MOST = (1u << NORMAL_BITS) - 1u;

uvec2 pack_mesh_hit(float depth, int mesh, vec3 normal)
{
    vec3 n = normal / (abs(normal.x) + abs(normal.y) + abs(normal.z));
    vec2 folded = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
    vec2 flat_normal = n.z < 0.0 ? folded : n.xy;
    uvec2 bits = uvec2(clamp(flat_normal * 0.5 + 0.5, 0.0, 1.0) * float(NORMAL_MOST) + 0.5);
    return uvec2(floatBitsToUint(depth),
                 uint(mesh + 1) << 2 * NORMAL_BITS | bits.x << NORMAL_BITS | bits.y);
}

float mesh_hit_depth(uvec2 packed_hit)
{
    return uintBitsToFloat(packed_hit.x);
}

/* Returns the mesh's number, or -1 where no mesh was hit. */
int mesh_hit_index(uvec2 packed_hit)
{
    return int(packed_hit.y >> 2 * NORMAL_BITS) - 1;
}

vec3 mesh_hit_normal(uvec2 packed_hit)
{
    vec2 p = vec2(packed_hit.y >> NORMAL_BITS & NORMAL_MOST, packed_hit.y & NORMAL_MOST) /
             float(NORMAL_MOST) * 2.0 - 1.0;
    float z = 1.0 - abs(p.x) - abs(p.y);
    float fold = max(-z, 0.0);
    vec2 xy = p - vec2(p.x < 0.0 ? -fold : fold, p.y < 0.0 ? -fold : fold);
    return normalize(vec3(xy, z));
}
