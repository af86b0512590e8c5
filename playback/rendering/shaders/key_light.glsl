uniform int u_show_shadow;
uniform vec3 u_key_direction;  // towards the light
uniform mat4 u_key_clip_from_world;
uniform float u_key_offset;  // [m] along the normal, against shadows of a surface on itself
uniform float u_key_spread;  // radius of the filter, part of the map
uniform vec3 u_key_taps[kNumShadowTaps];
uniform sampler2DShadow u_key_map;

// Part of the key light that reaches a point, by percentage-closer filtering: 0 to 1. normal faces the light.
float key_light(vec3 position, vec3 normal) {
  if (u_show_shadow == 0) return 1.0;
  vec3 place = (u_key_clip_from_world * vec4(position + normal * u_key_offset, 1.0)).xyz * 0.5 + 0.5;
  place.z = min(place.z, 0.9999);
  float sum = 0.0;
  for (int i = 0; i < kNumShadowTaps; ++i) {
    sum += texture(u_key_map, vec3(place.xy + u_key_spread * u_key_taps[i].xy, place.z));
  }
  return sum / float(kNumShadowTaps);
}
