// The backdrop continued on the floor, darkened where light is missing, with a subtle grid.
in vec3 v_position;
in vec3 v_normal;
in vec3 v_extra;  // x, z: place on the ground [m]
in vec2 v_sky;

uniform vec2 u_tile_origin;   // [sample]
uniform vec2 u_picture_size;  // [sample]
uniform float u_cell;         // width of a grid cell [m]
uniform vec2 u_shift;         // of the ground's mesh on the ground [m]
uniform vec3 u_tint;          // 1 where the ground has the colour of the backdrop
uniform float u_extent;       // the grid ends here [m]

out vec4 o_color;

// Coverage of grid lines of a constant width on the screen, faded where they would flicker.
float grid(vec2 place, float width) {
  vec2 cell = place / u_cell;
  vec2 step_size = max(fwidth(cell), vec2(1e-6));
  vec2 distance = abs(fract(cell - 0.5) - 0.5) / step_size;
  vec2 line = clamp(0.5 * width + 0.5 - distance, 0.0, 1.0) * (1.0 - smoothstep(0.08, 0.35, step_size));
  return max(line.x, line.y);
}

void main() {
  vec3 color = backdrop((gl_FragCoord.xy + u_tile_origin) / u_picture_size);
  float far = length(v_extra.xz) / u_extent;
  float near_weight = 1.0 - smoothstep(0.25, 1.0, far);
  color *= mix(vec3(1.0), u_tint, near_weight);
  color *= 1.0 + 0.10 * near_weight;
  color *= 1.0 - 0.10 * near_weight * grid(v_extra.xz + u_shift, 2.0);
  float light = 0.48 * clamp(v_sky.x, 0.0, 1.0) + 0.52 * key_light(v_position, normalize(v_normal), true);
  // Shadows keep some of the sky's blue, as they do outdoors.
  o_color = vec4(color * mix(vec3(0.16, 0.18, 0.22), vec3(1.0), light), 1.0);
}
