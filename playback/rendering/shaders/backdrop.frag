uniform vec2 u_tile_origin;   // [sample]
uniform vec2 u_picture_size;  // [sample]

out vec4 o_color;

void main() { o_color = vec4(backdrop((gl_FragCoord.xy + u_tile_origin) / u_picture_size), 1.0); }
