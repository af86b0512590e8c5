uniform int u_show_shadow;
uniform vec3 u_key_direction;  // towards the light
uniform mat4 u_key_clip_from_world;
uniform float u_key_offset;  // [m] along the normal, against shadows of a surface on itself
uniform float u_key_spread;  // radius of the filter, part of the map
uniform sampler2DShadow u_key_map;
uniform sampler2D u_key_bounds;  // smallest and largest depth that the filter can meet
// Each point is turned by the golden angle from the one before.
const float kCosGolden = -0.7373688;
const float kSinGolden = 0.6754903;

// Part of the key light that reaches a point, by percentage-closer filtering: 0 to 1. normal faces the light. is_needed: 0 where
// the answer does not matter.
float key_light(vec3 position, vec3 normal, bool is_needed) {
  if (u_show_shadow == 0) return 1.0;
  vec3 place = (u_key_clip_from_world * vec4(position + normal * u_key_offset, 1.0)).xyz * 0.5 + 0.5;
  place.z = min(place.z, 0.9999);
  ivec2 size = textureSize(u_key_bounds, 0);
  ivec2 block = clamp(ivec2(floor(place.xy * vec2(size))), ivec2(0), size - 1);
  vec2 bounds = texelFetch(u_key_bounds, block, 0).rg;
  int count = is_needed && place.z > bounds.x && place.z <= bounds.y ? kNumShadowTaps : 0;
  // Points evenly spread over a disk. Software renderers leave a loop that no pixel of a group needs, but walk through both sides
  // of an if, and write a loop over an array out as that many ifs.
  vec2 direction = vec2(u_key_spread / sqrt(float(kNumShadowTaps)), 0.0);
  float sum = 0.0;
  for (int i = 0; i < count; ++i) {
    sum += texture(u_key_map, vec3(place.xy + sqrt(float(i) + 0.5) * direction, place.z));
    direction = mat2(kCosGolden, kSinGolden, -kSinGolden, kCosGolden) * direction;
  }
  return count > 0 ? sum / float(kNumShadowTaps) : place.z <= bounds.x ? 1.0 : 0.0;
}
