// Four box decals over a normal map on the vertex tangents.
#version 450
#include "surface.glsl"
#define SURFGRAD_FRAGMENT
#include "surfgrad.glsl"

struct Decal {
  SurfgradDecalFrame frame;
  vec4 half_size; // w is the fade
};

layout(set = 0, binding = 3) uniform Decals { Decal decals[4]; };

vec3 gradient_of(SurfgradFrame frame, Decal decal) {
  SurfgradDecalProjection at =
      surfgrad_box_decal(decal.frame, position, decal.half_size.xyz, decal.half_size.w);
  if (!at.inside) return vec3(0.0);
  SurfgradTextureDerivatives d =
      surfgrad_projected_derivatives(at.grad_s, at.grad_t, frame.dp_dx, frame.dp_dy);
  vec2 slope =
      surfgrad_derivative_from_normal(decoded(textureGrad(map_2, at.texture_coordinate, d.dst_dx, d.dst_dy)));
  return at.falloff * surfgrad_decal_gradient(slope, at.axis_s, at.axis_t);
}

void main() {
  SurfgradFrame frame = surfgrad_make_frame_at(position, normal);
  SurfgradTangentFrame vertex = surfgrad_mikktspace_basis(normal, tangent.xyz, tangent.w);
  vec2 slope = surfgrad_derivative_from_normal(decoded(texture(map, st)));
  vec3 gradient = gradient_of(frame, decals[0]) + gradient_of(frame, decals[1]) +
                  gradient_of(frame, decals[2]) + gradient_of(frame, decals[3]);
  vec3 surfgrad = surfgrad_from_tbn(slope, vertex.tangent, vertex.bitangent) +
                  surfgrad_from_volume_gradient(frame.normal, gradient);
  result = vec4(surfgrad_resolve_normal(frame, surfgrad), 1.0);
}
