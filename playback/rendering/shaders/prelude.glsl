#version 330 core
// Put before every shader. World coordinates are relative to the centre of the scene; all colours are linear light.

const int kNumSkyLights = 24;
const int kNumSkyTaps = 6;
const int kNumShadowTaps = 32;

// A seamless studio backdrop; place is 0 to 1 in the picture, from the lower left corner.
vec3 backdrop(vec2 place) {
  vec3 low = vec3(0.850, 0.856, 0.862);
  vec3 high = vec3(0.640, 0.705, 0.775);
  vec3 color = mix(low, high, smoothstep(0.15, 1.25, place.y));
  float corner = length((place - vec2(0.5, 0.45)) * vec2(1.0, 0.9));
  return color * (1.06 - 0.28 * corner * corner);
}
