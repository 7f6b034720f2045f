/* Sets up a ray through a domain of gas, as lib/draw/volume/volume_packet.h does on the host. */

/* A ray on its way. */
struct ray {
    vec3 way, inverse;  /* unit, in the window; 1 / way */
    float from, to;     /* where it enters the window and where it ends; to 0: nowhere */
    float metre;        /* cells along the ray for a metre of depth */
    float first, wide;  /* phase functions of the sun's light, scattered once and more often */
    float clear, depth; /* what the gas so far leaves of light behind it; its optical depth */
    vec3 smoke, flame;  /* light so far */
    float weight, far;  /* of what is seen: its amount, and that times its distance, cells */
    float half_depth;   /* optical depth of this domain at which all gas is half opaque */
    float half_place;   /* where that is, cells from the eye; 0: nowhere */
};

/* Returns the phase function of Henyey and Greenstein in parts of an even one. */
float henyey_greenstein(float cosine, float g)
{
    float d = 1.0 + g * g - 2.0 * g * cosine;
    return (1.0 - g * g) / (d * sqrt(d));
}

float phase_of(float cosine, float g)
{
    return 0.8 * henyey_greenstein(cosine, g) + 0.2 * henyey_greenstein(cosine, -0.3 * g);
}

/* Sets up the ray of a pixel, which ends at a depth, m. */
ray make_ray(vec2 pixel, float depth)
{
    vec2 slope = (pixel + 0.5 - march.pixel.zw) * march.pixel.xy;
    vec3 way = march.right.xyz * slope.x + (march.forward.xyz - march.up.xyz * slope.y);
    ray r;
    r.metre = length(way);
    r.way = way / r.metre;
    r.way = mix(r.way, vec3(1e-6), lessThan(abs(r.way), vec3(1e-6)));
    r.inverse = 1.0 / r.way;
    vec3 a = -march.eye.xyz * r.inverse, b = (vec3(march.cells.xyz) - march.eye.xyz) * r.inverse;
    vec3 near = min(a, b), far = max(a, b);
    r.from = max(max(r.metre * march.eye.w, near.x), max(near.y, near.z));
    r.to = min(min(r.metre * depth, far.x), min(far.y, far.z));
    r.to = r.from < r.to ? r.to : 0.0;
    float cosine = dot(r.way, march.to_sun.xyz), g = march.forward.w;
    r.first = phase_of(cosine, g);
    r.wide = phase_of(cosine, 0.5 * g);
    r.clear = 1.0;
    r.depth = r.weight = r.far = r.half_depth = r.half_place = 0.0;
    r.smoke = r.flame = vec3(0.0);
    return r;
}
