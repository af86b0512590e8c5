// Everything that stands in the scene. Soft light of the sky is gathered here, per vertex, separately for both sides
// of a surface: a depth map per sky direction says which of them reach the vertex.
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec2 a_value;
layout(location = 3) in vec3 a_extra;

uniform mat4 u_world_from_body;
uniform mat4 u_clip_from_world;
uniform int u_show_shadow;
uniform float u_sky_offset;  // [m] along the normal, against shadows of a surface on itself
uniform vec3 u_sky_directions[kNumSkyLights];
uniform mat4 u_sky_clip_from_world[kNumSkyLights];
uniform float u_sky_spread;  // radius of the filter, part of the map
uniform vec3 u_sky_taps[kNumSkyTaps];
uniform sampler2DArrayShadow u_sky_maps;

out vec3 v_position;
out vec3 v_normal;
out vec2 v_value;
out vec3 v_extra;
out vec2 v_sky;  // light of the sky on the front and on the back, 1 on open ground

void main() {
  vec4 world = u_world_from_body * vec4(a_position, 1.0);
  v_position = world.xyz;
  v_normal = mat3(u_world_from_body) * a_normal;
  v_value = a_value;
  v_extra = a_extra;
  vec2 gathered = vec2(0.0);
  float open = 0.0;
  for (int i = 0; i < kNumSkyLights; ++i) {
    float facing = dot(v_normal, u_sky_directions[i]);
    float visible = 1.0;
    if (u_show_shadow != 0) {
      vec3 lifted = world.xyz + v_normal * (facing < 0.0 ? -u_sky_offset : u_sky_offset);
      vec3 place = (u_sky_clip_from_world[i] * vec4(lifted, 1.0)).xyz * 0.5 + 0.5;
      place.z = min(place.z, 0.9999);
      visible = 0.0;
      for (int k = 0; k < kNumSkyTaps; ++k) {
        vec2 tap = place.xy + u_sky_spread * u_sky_taps[k].xy;
        visible += texture(u_sky_maps, vec4(tap, float(i), place.z)) / float(kNumSkyTaps);
      }
    }
    gathered += visible * vec2(max(facing, 0.0), max(-facing, 0.0));
    open += u_sky_directions[i].y;
  }
  v_sky = gathered / open;
  gl_Position = u_clip_from_world * world;
}
