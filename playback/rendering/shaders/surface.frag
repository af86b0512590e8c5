// Cloth and colliders.
in vec3 v_position;
in vec3 v_normal;
in vec2 v_value;
in vec3 v_extra;
in vec2 v_sky;

const int kCloth = 0;
const int kScalar = 1;
const int kWireframe = 2;
const int kSolid = 3;
const int kTwoTone = 4;
const int kMark = 5;

// As TextureMapping.
const int kNoTexture = 0;
const int kByCoordinates = 1;
const int kByDirection = 2;
const int kFromFront = 3;

uniform int u_mode;
uniform vec3 u_eye;
uniform vec3 u_front_color;
uniform vec3 u_back_color;
uniform vec3 u_no_value_color;
uniform vec3 u_fill_direction;
uniform vec3 u_rim_direction;
uniform float u_line_width;  // [sample]
uniform sampler2D u_scale;
uniform sampler2D u_texture;
uniform int u_mapping;
uniform vec2 u_repeat;
uniform int u_texture_on_back;
uniform int u_is_thin;  // light comes through from the other side
uniform float u_opacity;  // below 1: a part of the samples is left out
uniform int u_is_flat;  // triangles without smooth normals

out vec4 o_color;

const float kPi = 3.14159265;

// The picture of the body at this place. On balls it is taken from the direction at rest, so that the surface needs
// no seam.
vec3 texture_color() {
  if (u_mapping == kByCoordinates) return texture(u_texture, v_value * u_repeat).rgb;
  vec3 direction = normalize(v_extra);
  if (u_mapping == kFromFront) {
    float across = length(direction.xy);
    vec2 place = direction.xy / max(across, 1e-6) * acos(clamp(direction.z, -1.0, 1.0)) / kPi;
    // The far side is one point spread over the picture's rim: the slope of the place means nothing there.
    return textureGrad(u_texture, 0.5 + 0.5 * place, 0.5 * dFdx(place), 0.5 * dFdy(place)).rgb;
  }
  vec2 place = vec2(atan(direction.x, direction.z) / (2.0 * kPi) + 0.5, asin(clamp(direction.y, -1.0, 1.0)) / kPi + 0.5);
  // Where the angle jumps by a whole turn, its slope does not.
  vec2 along_x = dFdx(place);
  vec2 along_y = dFdy(place);
  along_x.x -= round(along_x.x);
  along_y.x -= round(along_y.x);
  return textureGrad(u_texture, place * u_repeat, along_x * u_repeat, along_y * u_repeat).rgb;
}

vec3 albedo(bool front) {
  if (u_mode == kScalar) {
    if (v_value.y < 0.999) return u_no_value_color;
    return texture(u_scale, vec2((v_value.x * 255.0 + 0.5) / 256.0, 0.5)).rgb;
  }
  if (u_mode == kTwoTone) {
    // Eight octants of the body: shows every rotation. Widths from derivatives keep the borders smooth.
    vec3 width = max(fwidth(v_extra), vec3(1e-6));
    vec3 side = clamp(v_extra / width, -1.0, 1.0);
    return mix(u_front_color, u_back_color, 0.5 + 0.5 * side.x * side.y * side.z);
  }
  if (u_mode == kWireframe) return vec3(0.88);
  if (u_mapping != kNoTexture && (front || u_texture_on_back != 0)) {
    vec3 color = texture_color();
    // Dye does not go through all the way.
    return front ? color : mix(color, vec3(dot(color, vec3(0.33))) + 0.12, 0.35);
  }
  return front ? u_front_color : u_back_color;
}

float wire() {
  vec3 distance = v_extra / max(fwidth(v_extra), vec3(1e-6));
  float nearest = min(distance.x, min(distance.y, distance.z));
  return clamp(0.5 * u_line_width + 0.5 - nearest, 0.0, 1.0);
}

// Bayer's matrix of 4 x 4: translucent without sorting triangles, and smooth once samples are averaged.
float threshold() {
  ivec2 place = ivec2(gl_FragCoord.xy);
  const float kBayer[16] = float[16](0.0, 8.0, 2.0, 10.0, 12.0, 4.0, 14.0, 6.0, 3.0, 11.0, 1.0, 9.0, 15.0, 7.0, 13.0, 5.0);
  return (kBayer[(place.x & 3) + 4 * (place.y & 3)] + 0.5) / 16.0;
}

void main() {
  if (u_opacity < 1.0 && threshold() > u_opacity) discard;
  bool front = gl_FrontFacing;
  vec3 normal = u_is_flat != 0 ? normalize(cross(dFdx(v_position), dFdy(v_position)))
                               : normalize(front ? v_normal : -v_normal);
  vec3 view = normalize(u_eye - v_position);
  if (u_mode == kMark) {
    // What stands in the shadow of a cloth, or half inside of it, must be seen too.
    o_color = vec4(u_front_color * (0.6 + 0.4 * clamp(dot(normal, view), 0.0, 1.0)), 1.0);
    return;
  }
  float sky = front ? v_sky.x : v_sky.y;
  vec3 color = albedo(front);

  float key_facing = dot(normal, u_key_direction);
  // Behind a body it is dark, whatever stands in the way.
  float reached = key_light(v_position, key_facing < 0.0 ? -normal : normal, key_facing > 0.0 || u_is_thin != 0);
  float key = max(key_facing, 0.0) * reached * smoothstep(0.0, 0.12, key_facing);
  // Cloth is thin: some light comes through from the other side.
  float through = u_is_thin != 0 ? 0.38 * max(-key_facing, 0.0) * reached : 0.0;
  float fill = max(0.35 + 0.65 * dot(normal, u_fill_direction), 0.0);
  // Light from the floor reaches what looks down, less where the sky is hidden too.
  float bounce = (0.5 - 0.5 * normal.y) * 0.6 + 0.1 * sky;
  float glance = 1.0 - clamp(dot(normal, view), 0.0, 1.0);
  float rim = max(dot(normal, u_rim_direction), 0.0);

  vec3 light = vec3(0.34, 0.365, 0.40) * sky + vec3(1.10, 1.06, 1.00) * (key + through) +
               vec3(0.10, 0.11, 0.13) * fill + vec3(0.26, 0.25, 0.24) * bounce +
               vec3(0.20) * rim;
  if (u_mode == kScalar) {
    // Less contrast: the colour carries the number, the light only the shape.
    light = mix(vec3(0.95), light, 0.60);
    o_color = vec4(color * light, 1.0);
    return;
  }
  if (u_mode == kWireframe) {
    vec3 paper = color * mix(vec3(1.0), light, 0.45);
    o_color = vec4(mix(paper, front ? u_front_color : u_back_color, wire()), 1.0);
    return;
  }
  vec3 lit = color * light;
  vec3 halfway = normalize(view + u_key_direction);
  float shine = pow(max(dot(normal, halfway), 0.0), u_mode == kCloth ? 18.0 : 60.0);
  lit += (u_mode == kCloth ? 0.045 : 0.16) * shine * key;
  // Fibres that stand up catch light at grazing view: what makes cloth look like cloth.
  float sheen = pow(glance, 4.0) * (u_mode == kCloth ? 0.16 : 0.06);
  lit += sheen * mix(vec3(1.0), color, 0.4) * (0.5 * sky + 0.5 * rim + 0.3 * key);
  o_color = vec4(lit, 1.0);
}
