// The bump layers of decals.json, written by surfgrad.
//
//   DecalsSurface s; // what the layers read: fill it in
//   DecalsResult r = decals_normal(s);
//
// In fragment shaders define SURFGRAD_FRAGMENT before this: decals_with_derivatives(s) then gives s its
// derivatives.

#include "surfgrad.hlsl"

struct DecalsParameters {
  float layer0_scale; // layers[0] normal_map: scale of the bumps
  float layer0_opacity; // layers[0] normal_map: opacity, 0 to 1
  float layer1_falloff; // layers[1] decal: fraction of the shape over which decals fade
  float layer2_falloff; // layers[2] decal: fraction of the shape over which decals fade
  float layer2_height; // layers[2] decal: displacement of a height of 1
  float layer3_falloff; // layers[3] decal: fraction of the shape over which decals fade
  float layer3_range; // layers[3] decal: slope of the largest code
  float layer4_falloff; // layers[4] decal: fraction of the shape over which decals fade
  float layer5_falloff; // layers[5] decal: fraction of the shape over which decals fade
  float unused36;
  float unused40;
  float unused44;
};
cbuffer DecalsBlock : register(b0) { DecalsParameters decals_parameters; };

StructuredBuffer<float4> decals_decal_data : register(t0);
float4 decals_decals(int i) { return decals_decal_data[i]; }
Texture2D<float4> decals_layer0_map : register(t1);
Texture2D<float4> decals_layer1_map : register(t2);
Texture2D<float4> decals_layer2_mask : register(t3);
Texture2D<float4> decals_layer2_map : register(t4);
Texture2D<float4> decals_layer3_map : register(t5);
TextureCube<float4> decals_layer4_map : register(t6);
SamplerState decals_sampler0 : register(s0);
SamplerState decals_sampler1 : register(s1);
SamplerState decals_sampler2 : register(s2);

float2 decals_texture_size(Texture2D<float4> map) {
  uint width, height;
  map.GetDimensions(width, height);
  return float2(width, height);
}

// A volume gradient of object space in world space, in units of a height along the base normal.
float3 decals_object_gradient_in_world(float3x3 world_from_object, float3x3 object_from_world, float3 normal,
    float3 gradient) {
  float stretch = length(mul(transpose(world_from_object), normal));
  return stretch * (mul(transpose(object_from_world), gradient));
}

// What a volume gradient of object space adds to the sum: N - G becomes M^-T (N - G) as a whole (Golubev,
// equation 33).
float3 decals_from_object_gradient(float3x3 world_from_object, float3x3 object_from_world, float3 normal,
    float3 gradient) {
  float3 object_normal = surfgrad_normalize_or_zero(mul(transpose(world_from_object), normal));
  float3 g = decals_object_gradient_in_world(world_from_object, object_from_world, normal, gradient);
  return g - dot(object_normal, gradient) * normal;
}

// A decal as five vec4 hold it.
struct DecalsDecal {
  SurfgradDecalFrame frame;
  float3 outward;      // against the way it projects
  float3 size;         // box: half its edges; cone and wedge: tangent of half the angle, depth; else radius
  float half_length; // of a capsule's or wedge's segment
  float scale;
  float opacity;
  float blend; // 0 add, 1 mix, 2 replace
};

// origin: what positions are relative to
DecalsDecal decals_decal(int i, float3 origin) {
  float4 place = decals_decals(5 * i);
  float4 x = decals_decals(5 * i + 1);
  float4 y = decals_decals(5 * i + 2);
  float4 z = decals_decals(5 * i + 3);
  float4 size = decals_decals(5 * i + 4);
  DecalsDecal decal;
  decal.frame.origin = place.xyz - origin;
  decal.frame.axis_x = x.xyz;
  decal.frame.axis_y = y.xyz;
  decal.frame.axis_z = z.xyz;
  decal.outward = size.w * z.xyz;
  decal.size = size.xyz;
  decal.half_length = place.w;
  decal.scale = x.w;
  decal.opacity = y.w;
  decal.blend = z.w;
  return decal;
}

// A vector in the decal's own axes, without its part along what does not change the direction.
float3 decals_in_decal(SurfgradDecalFrame frame, float3 unchanging, float3 v) {
  float3 across = v - dot(v, unchanging) * unchanging;
  return float3(dot(across, frame.axis_x), dot(across, frame.axis_y), dot(across, frame.axis_z));
}

// What the stack reads of a surface.
struct DecalsSurface {
  float3 position; // world space, where the surface lies
  float3 normal; // world space, interpolated, not normalised
  float3 dp_dx; // change of position per pixel along x
  float3 dp_dy; // and along y
  float3x3 world_from_object; // linear part of the object's transform
  float3x3 object_from_world; // its inverse
  float3 object_origin; // position of the object's own origin
  float3 world_origin; // world position that position is relative to; zero if it is not
  float2 st0; // texture coordinate
  float2 dst0_dx; // its change per pixel
  float2 dst0_dy; // its change per pixel
  float4 tangent0; // vertex tangent, interpolated, not normalised; w its sign
};

struct DecalsResult {
  float3 normal; // unit, world space
};

float2 decals_layer0_map_slope(float2 st, float2 dst_dx, float2 dst_dy) {
  return surfgrad_derivative_from_normal(2.0 * decals_layer0_map.SampleGrad(decals_sampler0, st, dst_dx,
      dst_dy).xyz - 1.0);
}

float2 decals_layer1_map_slope(float2 st, float2 dst_dx, float2 dst_dy) {
  return surfgrad_derivative_from_normal(2.0 * decals_layer1_map.SampleGrad(decals_sampler1, st, dst_dx,
      dst_dy).xyz - 1.0);
}

// Volume gradients of decals are summed, then projected once.
float3 decals_layer1_decals(DecalsSurface s, SurfgradFrame frame, float3 at, float3 dp_dx, float3 dp_dy,
    float3 origin, float3 sum, float weight) {
  float3 result = sum;
  float factor = 1.0;
  float3 waiting = float3(0.0, 0.0, 0.0);
  for (int i = 0; i < 3; ++i) {
    DecalsDecal decal = decals_decal(i, origin);
    SurfgradDecalProjection place = surfgrad_box_decal(decal.frame, at, decal.size,
        decals_parameters.layer1_falloff);
    if (place.inside) {
      SurfgradTextureDerivatives d = surfgrad_projected_derivatives(place.grad_s, place.grad_t, dp_dx, dp_dy);
      float2 derivative = decals_layer1_map_slope(place.texture_coordinate, d.dst_dx, d.dst_dy);
      float3 gradient = surfgrad_decal_gradient(derivative, place.axis_s, place.axis_t);
      float w = place.falloff * weight * decal.opacity;
      if (decal.blend > 1.5) {
        float3 bent = decal.scale * surfgrad_from_volume_gradient(decal.outward, gradient);
        float3 g = surfgrad_from_perturbed_normal(frame.normal,
            surfgrad_transform_normal(s.world_from_object, decal.outward - bent));
        result = (1.0 - w) * (factor * result + decals_from_object_gradient(s.world_from_object,
            s.object_from_world, frame.normal, waiting)) + w * g;
        factor = 1.0;
        waiting = float3(0.0, 0.0, 0.0);
      } else {
        float keep = decal.blend > 0.5 ? 1.0 - w : 1.0;
        factor = keep * factor;
        waiting = keep * waiting + (w * decal.scale) * gradient;
      }
    }
  }
  return factor * result + decals_from_object_gradient(s.world_from_object, s.object_from_world,
      frame.normal, waiting);
}

float decals_layer2_mask_value(float2 st, float2 dst_dx, float2 dst_dy) {
  return decals_layer2_mask.SampleGrad(decals_sampler0, st, dst_dx, dst_dy).r;
}

// Slopes of the heights at a place of the map, by the whole map.
float2 decals_layer2_map_differences(float2 at, float2 dx, float2 dy) {
  float2 size = decals_texture_size(decals_layer2_map);
  float2 reach = exp2(max(surfgrad_texture_lod(dx, dy, size) - 1.0, 0.0)) / size;
  float2 x = float2(reach.x, 0.0);
  float2 y = float2(0.0, reach.y);
  float dh_ds = decals_layer2_map.SampleGrad(decals_sampler1, at + x, 0.5 * dx, 0.5 * dy).r
      - decals_layer2_map.SampleGrad(decals_sampler1, at - x, 0.5 * dx, 0.5 * dy).r;
  float dh_dt = decals_layer2_map.SampleGrad(decals_sampler1, at + y, 0.5 * dx, 0.5 * dy).r
      - decals_layer2_map.SampleGrad(decals_sampler1, at - y, 0.5 * dx, 0.5 * dy).r;
  return float2(dh_ds, dh_dt) / (2.0 * reach);
}

float2 decals_layer2_map_slope(float2 st, float2 dst_dx, float2 dst_dy) {
  float2 slope = decals_layer2_map_differences(st, dst_dx, dst_dy);
  return slope;
}

float2 decals_layer2_map_derivative(float2 st, float2 dst_dx, float2 dst_dy) {
  return decals_parameters.layer2_height * decals_layer2_map_slope(st, dst_dx, dst_dy);
}

// Volume gradients of decals are summed, then projected once.
float3 decals_layer2_decals(DecalsSurface s, SurfgradFrame frame, float3 at, float3 dp_dx, float3 dp_dy,
    float3 origin, float3 sum, float weight) {
  float factor = 1.0;
  float3 waiting = float3(0.0, 0.0, 0.0);
  for (int i = 3; i < 4; ++i) {
    DecalsDecal decal = decals_decal(i, origin);
    SurfgradDecalProjection place = surfgrad_cone_decal(decal.frame, at, decal.size.x, decal.size.y,
        decals_parameters.layer2_falloff, SURFGRAD_CONE_GRADIENT_EXACT);
    if (place.inside) {
      SurfgradTextureDerivatives d = surfgrad_projected_derivatives(place.grad_s, place.grad_t, dp_dx, dp_dy);
      float2 derivative = decals_layer2_map_derivative(place.texture_coordinate, d.dst_dx, d.dst_dy);
      float3 gradient = surfgrad_decal_gradient(derivative, place.grad_s, place.grad_t);
      float w = place.falloff * weight * decal.opacity;
      float keep = 1.0 - w;
      factor = keep * factor;
      waiting = keep * waiting + (w * decal.scale) * gradient;
    }
  }
  return factor * sum + surfgrad_from_volume_gradient(frame.normal, waiting);
}

float2 decals_layer3_map_slope(float2 st, float2 dst_dx, float2 dst_dy) {
  return (decals_parameters.layer3_range * (2.0 * decals_layer3_map.SampleGrad(decals_sampler1, st, dst_dx,
      dst_dy).xy - 1.0));
}

// Volume gradients of decals are summed, then projected once.
float3 decals_layer3_decals(DecalsSurface s, SurfgradFrame frame, float3 at, float3 dp_dx, float3 dp_dy,
    float3 origin, float3 sum, float weight) {
  float3 waiting = float3(0.0, 0.0, 0.0);
  for (int i = 4; i < 5; ++i) {
    DecalsDecal decal = decals_decal(i, origin);
    SurfgradDecalProjection place = surfgrad_wedge_decal(decal.frame, at, decal.half_length, decal.size.x,
        decal.size.y, decals_parameters.layer3_falloff, SURFGRAD_CONE_GRADIENT_SCALE_FREE);
    if (place.inside) {
      SurfgradTextureDerivatives d = surfgrad_projected_derivatives(place.grad_s, place.grad_t, dp_dx, dp_dy);
      float2 derivative = decals_layer3_map_slope(place.texture_coordinate, d.dst_dx, d.dst_dy);
      float3 gradient = surfgrad_decal_gradient(derivative, place.axis_s, place.axis_t);
      float w = place.falloff * weight * decal.opacity;
      waiting = waiting + (w * decal.scale) * gradient;
    }
  }
  return sum + surfgrad_from_volume_gradient(frame.normal, waiting);
}

// Volume gradients of decals are summed, then projected once.
float3 decals_layer4_decals(DecalsSurface s, SurfgradFrame frame, float3 at, float3 dp_dx, float3 dp_dy,
    float3 origin, float3 sum, float weight) {
  float3 result = sum;
  for (int i = 5; i < 6; ++i) {
    DecalsDecal decal = decals_decal(i, origin);
    SurfgradDecalDirection place = surfgrad_capsule_decal(decal.frame, at, decal.half_length, decal.size.x,
        decals_parameters.layer4_falloff);
    if (place.inside) {
      float3 q = decals_in_decal(decal.frame, place.unchanging, at - decal.frame.origin
          - clamp(dot(at - decal.frame.origin, decal.frame.axis_x), -decal.half_length, decal.half_length)
          * decal.frame.axis_x);
      float3 q_dx = decals_in_decal(decal.frame, place.unchanging, dp_dx);
      float3 q_dy = decals_in_decal(decal.frame, place.unchanging, dp_dy);
      float3 n = (2.0 * decals_layer4_map.SampleGrad(decals_sampler2, q, q_dx, q_dy).xyz - 1.0);
      float3 v = n.x * decal.frame.axis_x + n.y * decal.frame.axis_y + n.z * decal.frame.axis_z;
      float3 gradient = surfgrad_decal_gradient_from_normal(place, v);
      float w = place.falloff * weight * decal.opacity;
      float3 bent = decal.scale * surfgrad_from_volume_gradient(place.direction, gradient);
      float3 g = surfgrad_from_perturbed_normal(frame.normal, place.direction - bent);
      result = (1.0 - w) * result + w * g;
    }
  }
  return result;
}

// Volume gradients of decals are summed, then projected once.
float3 decals_layer5_decals(DecalsSurface s, SurfgradFrame frame, float3 at, float3 dp_dx, float3 dp_dy,
    float3 origin, float3 sum, float weight) {
  float3 waiting = float3(0.0, 0.0, 0.0);
  for (int i = 6; i < 7; ++i) {
    DecalsDecal decal = decals_decal(i, origin);
    SurfgradDecalDirection place = surfgrad_sphere_decal(decal.frame, at, decal.size.x,
        decals_parameters.layer5_falloff);
    if (place.inside) {
      float3 q = decals_in_decal(decal.frame, place.unchanging, at - decal.frame.origin);
      float3 q_dx = decals_in_decal(decal.frame, place.unchanging, dp_dx);
      float3 q_dy = decals_in_decal(decal.frame, place.unchanging, dp_dy);
      float3 n = (2.0 * decals_layer4_map.SampleGrad(decals_sampler2, q, q_dx, q_dy).xyz - 1.0);
      float3 v = n.x * decal.frame.axis_x + n.y * decal.frame.axis_y + n.z * decal.frame.axis_z;
      float3 gradient = surfgrad_decal_gradient_from_normal(place, v);
      float w = place.falloff * weight * decal.opacity;
      waiting = waiting + (w * decal.scale) * gradient;
    }
  }
  return sum + surfgrad_from_volume_gradient(frame.normal, waiting);
}

// The normal that the layers make of a surface's.
DecalsResult decals_normal(DecalsSurface s) {
  SurfgradFrame frame = surfgrad_make_frame(s.normal, s.dp_dx, s.dp_dy);

  // layers[0]: normal_map n.png
  SurfgradTangentFrame basis0 = surfgrad_mikktspace_basis(s.normal, s.tangent0.xyz, s.tangent0.w);
  float2 slope = (decals_parameters.layer0_opacity * decals_parameters.layer0_scale)
      * decals_layer0_map_slope(s.st0, s.dst0_dx, s.dst0_dy);

  // layers[1]: decal rivet_n.png
  float3 object_at = mul(s.object_from_world, s.position - s.object_origin);
  float3 object_dp_dx = mul(s.object_from_world, s.dp_dx);
  float3 object_dp_dy = mul(s.object_from_world, s.dp_dy);
  float3 sum = surfgrad_from_tbn(slope, basis0.tangent, basis0.bitangent);
  float3 sum_2 = decals_layer1_decals(s, frame, object_at, object_dp_dx, object_dp_dy, float3(0.0, 0.0, 0.0),
      sum, 1.0);

  // layers[2]: decal crack_h.png, m.png
  float mask = decals_layer2_mask_value(s.st0, s.dst0_dx, s.dst0_dy);
  float3 sum_3 = decals_layer2_decals(s, frame, s.position, s.dp_dx, s.dp_dy, s.world_origin, sum_2,
      (1.0 * mask));

  // layers[3]: decal crack_d.png
  float3 sum_4 = decals_layer3_decals(s, frame, s.position, s.dp_dx, s.dp_dy, s.world_origin, sum_3, 1.0);

  // layers[4]: decal crater.exr
  float3 sum_5 = decals_layer4_decals(s, frame, s.position, s.dp_dx, s.dp_dy, s.world_origin, sum_4, 1.0);

  // layers[5]: decal crater.exr
  float3 sum_6 = decals_layer5_decals(s, frame, s.position, s.dp_dx, s.dp_dy, s.world_origin, sum_5, 1.0);

  DecalsResult result;
  result.normal = surfgrad_resolve_normal(frame, sum_6);
  return result;
}

#ifdef SURFGRAD_FRAGMENT
// A fragment's surface, its derivatives filled in. Call it in uniform control flow.
DecalsSurface decals_with_derivatives(DecalsSurface s) {
  DecalsSurface t = s;
  t.dp_dx = ddx_fine(s.position);
  t.dp_dy = ddy_fine(s.position);
  t.dst0_dx = ddx_fine(s.st0);
  t.dst0_dy = ddy_fine(s.st0);
  return t;
}
#endif
