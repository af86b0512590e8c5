// Smallest and largest value of a square of texels.
uniform sampler2D u_map;
uniform int u_stride;    // texels of the map for one of the result, along each side
uniform int u_margin;    // texels more on each side
uniform int u_is_depth;  // the map has one value, not the two of an earlier pass

out vec4 o_color;

void main() {
  ivec2 last = textureSize(u_map, 0) - 1;
  ivec2 first = ivec2(gl_FragCoord.xy) * u_stride - u_margin;
  int side = u_stride + 2 * u_margin;
  vec2 bounds = vec2(1.0, 0.0);
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      vec2 value = texelFetch(u_map, clamp(first + ivec2(i, j), ivec2(0), last), 0).rg;
      bounds = vec2(min(bounds.x, value.x), max(bounds.y, u_is_depth != 0 ? value.x : value.y));
    }
  }
  o_color = vec4(bounds, 0.0, 1.0);
}
