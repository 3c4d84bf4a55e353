/// The shaders of the scene, GLSL 1.20.
#pragma once

namespace musclesim::shaders {

inline constexpr const char* vertex = R"(#version 120
attribute vec3 position;
attribute vec3 normal;
uniform mat4 model, camera;
uniform mat3 normal_matrix;
centroid varying vec3 world_position, world_normal;
void main() {
  vec4 world = model * vec4(position, 1.0);
  world_position = world.xyz;
  world_normal = normal_matrix * normal;
  gl_Position = camera * world;
}
)";

/// Ambient light from sky and ground, a lamp at the viewer, and a highlight; with `lit` 0 only the plain colour.
inline constexpr const char* solid_fragment = R"(#version 120
uniform vec4 color;
uniform vec3 eye, lamp;
uniform float lit, shine;
centroid varying vec3 world_position, world_normal;
void main() {
  vec3 n = normalize(world_normal), v = normalize(eye - world_position);
  if (dot(n, v) < 0.0) n = -n;
  float sky = mix(0.40, 0.58, 0.5 + 0.5 * n.y);
  float direct = 0.50 * max(dot(n, lamp), 0.0);
  float highlight = shine * pow(max(dot(n, normalize(lamp + v)), 0.0), 40.0);
  vec3 seen = color.rgb * (sky + direct) + vec3(highlight);
  gl_FragColor = vec4(mix(color.rgb, seen, lit), color.a);
}
)";

/// A grid of lines, every fifth one stronger, that fades with the distance from a centre.
inline constexpr const char* floor_fragment = R"(#version 120
uniform vec3 center;
uniform float spacing, reach;
centroid varying vec3 world_position, world_normal;
float line(vec2 p, float width) {
  vec2 pixel = fwidth(p), away = abs(fract(p - 0.5) - 0.5);
  vec2 covered = 1.0 - smoothstep(pixel * width, pixel * (width + 1.0), away);
  covered *= 1.0 - smoothstep(0.3, 0.6, pixel);
  return max(covered.x, covered.y);
}
void main() {
  vec2 p = world_position.xz / spacing;
  float fade = 1.0 - smoothstep(0.2, 1.0, distance(world_position.xz, center.xz) / reach);
  float strength = max(0.30 * line(p, 0.2), 0.55 * line(p / 5.0, 0.4));
  gl_FragColor = vec4(vec3(0.52, 0.55, 0.60), strength * fade);
}
)";

}  // namespace musclesim::shaders
