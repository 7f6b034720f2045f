/* Finds the reflections on a floor that is wet, or of water, along rays from the eye
 * (shared/floor.h). backdrop.frag includes it with FLOOR_GLOSS and follows the reflected ray. */

floor_water find_water(vec2 position, floor_extent extent)
{
    floor_water water = floor_water(position.x, position.y, 0.0, 0.0, 0.0);
    int count = shapes.floor_gloss.z > 0.0 ? KILN_WAVES : 0;
    for (int i = 0; i < count; i++)
        water = floor_add_wave(water, shapes.waves[i], shapes.wave_shift[i], shapes.floor_gloss.z,
                               extent);
    return water;
}

struct reflection {
    floor_reflection at;
    float part; /* factor of the light that the floor reflects */
    vec3 sun;   /* sunlight that it reflects to the eye where it is not in shadow */
};

/* Returns the light of lamp i, without its shadows, that the floor reflects to the eye. */
vec3 reflected_lamp(int i, vec3 point, reflection m)
{
    vec4 lamp = backdrop.lights[i].position_radius2;
    vec3 towards = lamp.xyz - point;
    float share = 1.0;
    if (LAMP_IS_RECTANGLE(backdrop.lights[i]))
        share = lamp_share(backdrop.lights[i], towards);
    return backdrop.lights[i].color.rgb *
           (share * floor_reflects_lamp(towards, lamp.w, m.at.normal, m.at.to_eye, m.at.spread));
}

/* Returns the reflections where a ray from the eye meets the floor, even if an object hides the
 * floor there. */
reflection reflection_along(vec3 direction)
{
    float t = max(view.eye.y - backdrop.floor_color.w, 0.0) / max(-direction.y, 1e-6);
    vec3 point = view.eye.xyz + direction * t;
    floor_water water = find_water(point.xz, floor_extent_along(direction, t));
    floor_reflection m = floor_reflection_of(direction, water, shapes.floor_gloss.y);

    float clear = exp(-backdrop.floor_params.z * t * length(direction));
    float part = shapes.floor_gloss.x * (backdrop.counts.z != 0u ? 1.0 : clear);
    return reflection(m, part,
                      part * backdrop.sun_color.rgb *
                          floor_lobe(m.normal, m.to_eye, backdrop.sun_direction.xyz, m.spread));
}
