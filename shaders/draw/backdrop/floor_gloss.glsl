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

vec3 reflected_lights(vec3 point, floor_reflection m)
{
    vec3 sum = vec3(0.0);
    for (int i = 0; i < int(backdrop.counts.y); i++) {
        vec4 lamp = backdrop.lights[i].position_radius2;
        sum += backdrop.lights[i].color.rgb *
               floor_reflects_lamp(lamp.xyz - point, lamp.w, m.normal, m.to_eye, m.spread);
    }
    return sum;
}

struct reflection {
    vec3 lights;    /* light of the lamps that the floor sends to the eye */
    vec3 sun;       /* the same of the sun, where the floor is not in shadow */
    vec3 direction; /* of the reflected ray */
    float weight;   /* part of the light along the reflected ray that the eye sees */
};

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
    return reflection(part * reflected_lights(point, m),
                      part * backdrop.sun_color.rgb *
                          floor_lobe(m.normal, m.to_eye, backdrop.sun_direction.xyz, m.spread),
                      m.direction, part * m.reflectance);
}
