// Averages the samples of a pixel in linear light, then encodes it as sRGB.
uniform sampler2D u_samples;
uniform int u_num_samples;  // per axis

out vec4 o_color;

void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * u_num_samples;
  vec3 light = vec3(0.0);
  for (int j = 0; j < u_num_samples; ++j) {
    for (int i = 0; i < u_num_samples; ++i) {
      // Clamped first: one bright sample must not undo the smooth edge of its pixel.
      light += clamp(texelFetch(u_samples, first + ivec2(i, j), 0).rgb, 0.0, 1.0);
    }
  }
  light /= float(u_num_samples * u_num_samples);
  vec3 curved = 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055;
  o_color = vec4(mix(curved, 12.92 * light, lessThanEqual(light, vec3(0.0031308))), 1.0);
}
