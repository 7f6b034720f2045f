/* A floor that is wet, or water: what it mirrors of sky, shapes and lights, by Fresnel's law for
 * water. Waves tilt it; those too small for a pixel widen the lights' streaks instead, which a rough
 * surface seen flat draws out towards the eye (a microfacet lobe, GGX). Particles are mirrored by the
 * lights that they shed alone, and meshes not at all: their rays are rasterised from the eye. */

const int WAVES = 8;
const float GRAVITY = 9.81;

/* The tilt of the water in x and z; z: the square of what a pixel averages away. */
vec3 wave_slope(vec2 position, vec2 footprint)
{
    vec2 slope = vec2(0.0);
    float averaged = 0.0;
    float length_m = shapes.floor_gloss.z;
    float steepness = shapes.floor_gloss.w;
    float time_s = shapes.floor_map.w;
    vec2 bent = position;
    for (int i = 0; i < WAVES; i++) {
        float heading = 1.2 + 1.1 * sin(2.7 * float(i)); /* about the wind */
        vec2 way = vec2(cos(heading), sin(heading));
        float k = 2.0 * PI / length_m;
        float phase = k * dot(way, bent) - sqrt(GRAVITY * k) * time_s;
        float across = k * dot(abs(way), footprint);
        float seen = exp(-0.2 * across * across);
        slope += way * steepness * seen * cos(phase);
        averaged += 0.5 * steepness * steepness * (1.0 - seen * seen);
        /* Each wave is bent by those before it, so that crests are short. */
        bent += way * (0.1 * length_m * sin(phase));
        length_m *= 0.71;
    }
    return vec3(slope, averaged);
}

float fresnel(float cosine)
{
    float away = 1.0 - clamp(cosine, 0.0, 1.0);
    float away2 = away * away;
    return 0.02 + 0.98 * away2 * away2 * away;
}

/* Part of the irradiance along `to_light` that goes to the eye, per solid angle. */
float lobe(vec3 normal, vec3 to_eye, vec3 to_light, float spread)
{
    vec3 half_way = normalize(to_eye + to_light);
    float a2 = spread * spread;
    float nh = clamp(dot(normal, half_way), 0.0, 1.0);
    float nv = clamp(dot(normal, to_eye), 1e-3, 1.0);
    float nl = clamp(dot(normal, to_light), 0.0, 1.0);
    float d = nh * nh * (a2 - 1.0) + 1.0;
    float distribution = a2 / (PI * d * d);
    float shadowing =
        nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2);
    return fresnel(dot(to_eye, half_way)) * distribution * 0.5 * nl / max(shadowing, 1e-6);
}

vec3 mirrored_lights(vec3 point, vec3 normal, vec3 to_eye, float spread)
{
    vec3 sum = vec3(0.0);
    for (int i = 0; i < int(backdrop.counts.y); i++) {
        vec3 towards = backdrop.lights[i].position_radius2.xyz - point;
        float radius2 = backdrop.lights[i].position_radius2.w;
        float d2 = max(dot(towards, towards), 1e-6);
        float wide = min(spread + 0.25 * sqrt(radius2 / d2), 1.0);
        sum += PI * backdrop.lights[i].color.rgb / (d2 + radius2) *
               lobe(normal, to_eye, towards * inversesqrt(d2), wide);
    }
    return sum;
}

struct mirror {
    vec3 lights;  /* that it sends to the eye */
    vec3 sun;     /* the same, where no shadow is */
    vec3 onwards; /* where the ray goes, */
    float weight; /* and how much of what it finds there is seen */
};

/* Of the floor along a ray from the eye, whether or not something is before it. */
mirror floor_mirror(vec3 direction)
{
    float t = max(view.eye.y - backdrop.floor_color.w, 0.0) / max(-direction.y, 1e-6);
    vec3 point = view.eye.xyz + direction * t;
    vec3 slope = wave_slope(point.xz, floor_footprint(direction, t));
    vec3 normal = normalize(vec3(-slope.x, 1.0, -slope.y));
    vec3 way = normalize(direction);
    float rough = shapes.floor_gloss.y;
    float spread = clamp(sqrt(rough * rough + 2.0 * slope.z), 0.02, 1.0);
    vec3 onwards = reflect(way, normal);
    onwards.y = max(onwards.y, 0.01); /* what goes down would meet a wave again */

    float clear = exp(-backdrop.floor_params.z * t * length(direction));
    float part = shapes.floor_gloss.x * (backdrop.counts.z != 0u ? 1.0 : clear);
    return mirror(part * mirrored_lights(point, normal, -way, spread),
                  part * backdrop.sun_color.rgb *
                      lobe(normal, -way, backdrop.sun_direction.xyz, spread),
                  onwards, part * fresnel(dot(normal, -way)));
}
