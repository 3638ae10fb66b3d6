// Three projections of one normal map along the axes of the world.
#version 450
#include "surface.glsl"
#define SURFGRAD_FRAGMENT
#include "surfgrad.glsl"

void main() {
  SurfgradFrame frame = surfgrad_make_frame(normal);
  vec3 weights = surfgrad_triplanar_weights(frame.normal);
  SurfgradTriplanarCoordinates at = surfgrad_triplanar_coordinates(position);
  vec2 slope_x = surfgrad_derivative_from_normal(decoded(texture(map, at.x_plane)));
  vec2 slope_y = surfgrad_derivative_from_normal(decoded(texture(map, at.y_plane)));
  vec2 slope_z = surfgrad_derivative_from_normal(decoded(texture(map, at.z_plane)));
  vec3 surfgrad = surfgrad_from_triplanar(frame.normal, weights, slope_x, slope_y, slope_z);
  result = vec4(surfgrad_resolve_normal(frame, surfgrad), 1.0);
}
