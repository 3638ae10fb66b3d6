// The bump layers of relief.json, written by surfgrad.
//
//   ReliefSurface s; // what the layers read: fill it in
//   ReliefResult r = relief_normal(s);
//
// In fragment shaders define SURFGRAD_FRAGMENT before this: relief_with_derivatives(s) then gives s its
// derivatives.

#include "surfgrad.hlsl"

struct ReliefParameters {
  float layer0_height; // layers[0] parallax: displacement of the value 1, scale included
  float layer0_opacity; // layers[0] parallax: opacity, 0 to 1
  float2 layer0_tile; // layers[0] parallax: repetitions of the map
  float layer0_level; // layers[0] parallax: the height that lies on the mesh
  float layer1_scale; // layers[1] normal_map: scale of the bumps
  float layer1_opacity; // layers[1] normal_map: opacity, 0 to 1
  float layer2_scale; // layers[2] noise: height of the function
  float layer2_opacity; // layers[2] noise: opacity, 0 to 1
  float layer2_frequency; // layers[2] noise: cells per unit of the space
  float displace_height; // displace: object units by which a value of 1 moves
  float displace_level; // displace: the value that stays on the mesh
  float displace_frequency; // displace: cells per unit of the space
  float displace_lacunarity; // displace: frequency of an octave by that of the one before
  float displace_gain; // displace: amplitude of an octave by that of the one before
  float unused60;
};
cbuffer ReliefBlock : register(b0) { ReliefParameters relief_parameters; };

Texture2D<float4> relief_layer0_map : register(t0);
Texture2D<float4> relief_layer1_map : register(t1);
SamplerState relief_sampler0 : register(s0);

float2 relief_texture_size(Texture2D<float4> map) {
  uint width, height;
  map.GetDimensions(width, height);
  return float2(width, height);
}

// The vertex frame for a later pass: its tangent turned into the plane of the new base normal, its bitangent
// kept on its own side.
SurfgradTangentFrame relief_rebased_basis(SurfgradFrame frame, SurfgradTangentFrame vertex) {
  float3 along = surfgrad_from_volume_gradient(frame.normal, vertex.tangent);
  // Removing the part along the normal leaves rounding, which points anywhere.
  float rounding = 8.0 * SURFGRAD_EPSILON * surfgrad_max_abs(vertex.tangent);
  SurfgradTangentFrame basis;
  basis.tangent = rounding < surfgrad_max_abs(along) ? surfgrad_normalize_or_zero(along)
      : float3(0.0, 0.0, 0.0);
  float3 bitangent = cross(frame.normal, basis.tangent);
  basis.bitangent = (dot(bitangent, vertex.bitangent) < 0.0 ? -1.0 : 1.0) * bitangent;
  return basis;
}

// Whether changes along the screen span nothing: parallel to rounding, or one is zero.
bool relief_collapsed(float2 dst_dx, float2 dst_dy, float3 dp_dx, float3 dp_dy) {
  float2 s = surfgrad_reciprocal_or_zero(surfgrad_max_abs(dst_dx)) * dst_dx;
  float2 t = surfgrad_reciprocal_or_zero(surfgrad_max_abs(dst_dy)) * dst_dy;
  float3 x = surfgrad_reciprocal_or_zero(surfgrad_max_abs(dp_dx)) * dp_dx;
  float3 y = surfgrad_reciprocal_or_zero(surfgrad_max_abs(dp_dy)) * dp_dy;
  return !(SURFGRAD_EPSILON < abs(s.x * t.y - s.y * t.x))
      || !(SURFGRAD_EPSILON < surfgrad_max_abs(cross(x, y)));
}

// How much of a slope comes from the smooth surface: all where the map is magnified, none from half a level of
// minification on.
float relief_smooth_share(float lod) { return min(max((0.5 - lod) / 0.45, 0.0), 1.0); }

// Four neighbouring texels along an axis: the point lies `fraction` past the texel `low`.
struct ReliefTaps {
  float low;
  float fraction;
  float direction; // -1 on a reflected copy, where texels run against the coordinate
};

// wrap: 0 repeat, 1 mirror, 2 clamp
ReliefTaps relief_cubic_taps(float s, float size, int wrap) {
  ReliefTaps taps;
  taps.direction = 1.0;
  float x = s;
  if (wrap == 0) {
    x = (s - floor(s)) * size - 0.5;
  } else if (wrap == 1) {
    float phase = s - 2.0 * floor(0.5 * s);
    x = (1.0 < phase ? 2.0 - phase : phase) * size - 0.5;
    taps.direction = 1.0 < phase ? -1.0 : 1.0;
  } else {
    // It goes on until all four texels are the border's: the spline ends level there.
    x = min(max(s * size - 0.5, -2.0), size + 1.0);
  }
  taps.low = floor(x);
  taps.fraction = x - taps.low;
  return taps;
}

// An index within a period of [0, size) brought into it.
int relief_wrapped(int i, int size, int wrap) {
  int at = i;
  if (wrap == 0) {
    at = at < 0 ? at + size : at;
    at = at >= size ? at - size : at;
  } else if (wrap == 1) {
    at = at < 0 ? -at - 1 : at;
    at = at >= size ? 2 * size - 1 - at : at;
  }
  return min(max(at, 0), size - 1);
}

// Share of a way over the map that a march bears: 2^16 texels of the level it is on.
float relief_way_share(float2 way, float2 size, float lod) {
  float shrink = exp2(-max(floor(lod + 0.5), 0.0));
  float2 texels = float2(max(shrink * size.x, 1.0), max(shrink * size.y, 1.0));
  float covered = surfgrad_max_abs(surfgrad_saturated(texels * way));
  return 65536.0 < covered ? 65536.0 / max(covered, 1.0) : 1.0;
}

// What the change of an interpolated normal is multiplied by to be that of the unit normal on the same side.
float relief_unit_rate(float3 normal, float3 interpolated) {
  float size = surfgrad_reciprocal_or_zero(length(interpolated));
  return dot(normal, interpolated) < 0.0 ? -size : size;
}

// The normal reflected towards the viewer where it faces away (section 2.11).
float3 relief_reflected(float3 normal, float3 to_viewer, float side) {
  float along = dot(to_viewer, normal);
  return side * along < 0.0 ? normal - (2.0 * along) * to_viewer : normal;
}

// The pixel's footprint on the plane through the point that lies in the relief.
SurfgradScreenDerivatives relief_relief_footprint(SurfgradFrame base, float3 surfgrad, float3 plane,
    float3 position, float4x4 relative_from_screen, float2 raster) {
  SurfgradScreenDerivatives dp;
  if (dot(abs(relative_from_screen[3]) + abs(relative_from_screen[0]), float4(1.0, 1.0, 1.0, 1.0)) > 0.0) {
    dp = surfgrad_screen_derivatives(position, plane, relative_from_screen, raster.x, raster.y);
  } else {
    // A raster over the surface: its pixels stay over their own points, which rise as the height does.
    dp.dp_dx = base.sigma_x + dot(base.sigma_x, surfgrad) * base.normal;
    dp.dp_dy = base.sigma_y + dot(base.sigma_y, surfgrad) * base.normal;
  }
  return dp;
}

// Texture coordinates there are those of the base point below.
SurfgradTextureDerivatives relief_relief_derivatives(SurfgradFrame base, float2 dst_dx, float2 dst_dy,
    SurfgradScreenDerivatives dp) {
  float3 grad_s = surfgrad_from_height_derivative(base, float2(dst_dx.x, dst_dy.x));
  float3 grad_t = surfgrad_from_height_derivative(base, float2(dst_dx.y, dst_dy.y));
  return surfgrad_projected_derivatives(grad_s, grad_t, dp.dp_dx, dp.dp_dy);
}

// What the stack reads of a surface.
struct ReliefSurface {
  float3 position; // world space, where the surface lies
  float3 normal; // world space, interpolated, not normalised
  float3 dp_dx; // change of position per pixel along x
  float3 dp_dy; // and along y
  bool front_facing; // of an object whose transform mirrors: the opposite
  float3 world_position; // world space, before any displacement
  float3 to_viewer; // unit; zero where nobody looks
  float3 to_sun; // unit; zero without a sun
  float2 raster; // pixel coordinate, centres at .5
  float3 dn_dx; // change of normal per pixel along x
  float3 dn_dy; // and along y
  float4x4 relative_from_screen; // takes (x, y, depth, 1) in pixels to position; zero if no screen
  float2 st0; // texture coordinate
  float2 dst0_dx; // its change per pixel
  float2 dst0_dy; // its change per pixel
  float2 st1; // texture coordinate
  float2 dst1_dx; // its change per pixel
  float2 dst1_dy; // its change per pixel
  float4 tangent1; // vertex tangent, interpolated, not normalised; w its sign
};

struct ReliefResult {
  float3 normal; // unit, world space
  float3 position; // where the parallax has moved it
  float2 st0; // where the parallax has moved it
  float2 st1; // where the parallax has moved it
  float sunlight; // share of the sun that reaches the point
};

// Height at which the view first meets the relief.
float relief_layer0_map_first_height(float2 at, float2 way, float level, bool from_below, float2 dx,
    float2 dy) {
  float2 start = from_below ? at + (1.0 - level) * way : at - level * way;
  float2 ray = from_below ? -way : way;
  SurfgradParallaxMarch march = surfgrad_march_parallax_begin(start, ray, 64);
  while (surfgrad_march_parallax_asks(march)) {
    float2 there = surfgrad_march_parallax_at(march);
    float value = relief_layer0_map.SampleGrad(relief_sampler0, there, dx, dy).r;
    march = surfgrad_march_parallax_answer(march, from_below ? 1.0 - value : value);
  }
  SurfgradParallaxHit hit = surfgrad_march_parallax_end(march);
  float met = hit.height;
  return from_below ? 1.0 - met : met;
}

// 1 where no relief is in the way to the sun.
float relief_layer0_map_visible(float2 at, float height, float2 way, bool from_below, float2 dx, float2 dy) {
  float start = from_below ? 1.0 - height : height;
  float2 ray = from_below ? -way : way;
  float sun = 1.0;
  for (int i = 1; i < 64; ++i) {
    float rise = (1.0 - start) * float(i) / 64.0;
    float2 there = at + rise * ray;
    float value = relief_layer0_map.SampleGrad(relief_sampler0, there, dx, dy).r;
    if ((from_below ? 1.0 - value : value) > start + rise) {
      sun = 0.0;
      break;
    }
  }
  return sun;
}

float relief_layer0_map_texel(int x, int y) { return relief_layer0_map.Load(int3(x, y, 0)).r; }

// Slope of the cubic B-spline of the texels at a place of the map, by the whole map.
float2 relief_layer0_map_smooth_slope(float2 at) {
  float2 size = relief_texture_size(relief_layer0_map);
  ReliefTaps x = relief_cubic_taps(at.x, size.x, 0);
  int x0 = relief_wrapped(int(x.low) - 1, int(size.x), 0);
  int x1 = relief_wrapped(int(x.low), int(size.x), 0);
  int x2 = relief_wrapped(int(x.low) + 1, int(size.x), 0);
  int x3 = relief_wrapped(int(x.low) + 2, int(size.x), 0);
  ReliefTaps y = relief_cubic_taps(at.y, size.y, 0);
  int y0 = relief_wrapped(int(y.low) - 1, int(size.y), 0);
  int y1 = relief_wrapped(int(y.low), int(size.y), 0);
  int y2 = relief_wrapped(int(y.low) + 1, int(size.y), 0);
  int y3 = relief_wrapped(int(y.low) + 2, int(size.y), 0);
  float pivot = relief_layer0_map_texel(x1, y1);
  float4 row0 = float4(relief_layer0_map_texel(x0, y0) - pivot, relief_layer0_map_texel(x1, y0) - pivot,
      relief_layer0_map_texel(x2, y0) - pivot, relief_layer0_map_texel(x3, y0) - pivot);
  float4 row1 = float4(relief_layer0_map_texel(x0, y1) - pivot, relief_layer0_map_texel(x1, y1) - pivot,
      relief_layer0_map_texel(x2, y1) - pivot, relief_layer0_map_texel(x3, y1) - pivot);
  float4 row2 = float4(relief_layer0_map_texel(x0, y2) - pivot, relief_layer0_map_texel(x1, y2) - pivot,
      relief_layer0_map_texel(x2, y2) - pivot, relief_layer0_map_texel(x3, y2) - pivot);
  float4 row3 = float4(relief_layer0_map_texel(x0, y3) - pivot, relief_layer0_map_texel(x1, y3) - pivot,
      relief_layer0_map_texel(x2, y3) - pivot, relief_layer0_map_texel(x3, y3) - pivot);
  float2 fraction = float2(x.fraction, y.fraction);
  float2 direction = float2(x.direction, y.direction);
  float2 slope = direction * surfgrad_derivative_from_bicubic(float4x4(row0, row1, row2, row3), fraction);
  return size * slope;
}

// Differences of the heights at a place of the map.
float2 relief_layer0_map_taps(float2 at, float2 first, float2 step_x, float2 step_y, float2 dx, float2 dy,
    float lod) {
  float2 dh_dxy = surfgrad_derivative_from_heights(relief_layer0_map.SampleGrad(relief_sampler0, first, dx,
      dy).r, relief_layer0_map.SampleGrad(relief_sampler0, first + step_x, dx, dy).r,
      relief_layer0_map.SampleGrad(relief_sampler0, first + step_y, dx, dy).r);
  float share = relief_smooth_share(lod);
  if (share > 0.0) {
    float2 dh = relief_layer0_map_smooth_slope(at);
    dh_dxy = dh_dxy + share * (float2(dot(dh, step_x), dot(dh, step_y)) - dh_dxy);
  }
  return dh_dxy;
}

float2 relief_layer0_map_per_pixel(float2 st, float2 dst_dx, float2 dst_dy, float2 step_x, float2 step_y) {
  float2 at = relief_parameters.layer0_tile * st;
  float2 dx = relief_parameters.layer0_tile * dst_dx;
  float2 dy = relief_parameters.layer0_tile * dst_dy;
  float2 x = relief_parameters.layer0_tile * step_x;
  float2 y = relief_parameters.layer0_tile * step_y;
  float lod = surfgrad_texture_lod(relief_parameters.layer0_tile * dst_dx, relief_parameters.layer0_tile
      * dst_dy, relief_texture_size(relief_layer0_map));
  return relief_layer0_map_taps(at, at, x, y, dx, dy, lod);
}

float2 relief_layer1_map_slope(float2 st, float2 dst_dx, float2 dst_dy) {
  return surfgrad_derivative_from_normal(2.0 * relief_layer1_map.SampleGrad(relief_sampler0, st, dst_dx,
      dst_dy).xyz - 1.0);
}

SurfgradNoise relief_layer2_noise(float3 position, float width) {
  float3 p = relief_parameters.layer2_frequency * position;
  float visibility = surfgrad_octave_visibility(relief_parameters.layer2_frequency * width);
  SurfgradNoise noise = surfgrad_simplex(p);
  noise.value = visibility * noise.value;
  noise.gradient = visibility * noise.gradient;
  noise.gradient = relief_parameters.layer2_frequency * noise.gradient;
  return noise;
}

SurfgradNoise relief_displace_noise(float3 position, float width) {
  float3 p = relief_parameters.displace_frequency * position;
  SurfgradNoise noise;
  noise.value = 0.0;
  noise.gradient = float3(0.0, 0.0, 0.0);
  float frequency = 1.0;
  float amplitude = 1.0;
  float cells = relief_parameters.displace_frequency * width;
  for (int i = 0; i < 4; ++i) {
    if (surfgrad_octave_visibility(frequency * cells) > 0.0 && frequency < float(SURFGRAD_NOISE_EXTENT)) {
      SurfgradNoise octave = surfgrad_perlin(frequency * p);
      noise = surfgrad_add_octave(noise, octave, frequency, amplitude, cells);
    }
    frequency = frequency * relief_parameters.displace_lacunarity;
    amplitude = amplitude * relief_parameters.displace_gain;
  }
  noise.gradient = relief_parameters.displace_frequency * noise.gradient;
  return noise;
}

// The normal that the layers make of a surface's.
ReliefResult relief_normal(ReliefSurface surface) {
  ReliefSurface s = surface;
  SurfgradFrame frame = surfgrad_make_frame(s.normal, s.dp_dx, s.dp_dy, s.front_facing,
      SURFGRAD_BACK_FACES_FLIP);
  float sunlight = 1.0;

  // layers[0]: parallax h.png
  float displacement = frame.resolve_sign * (relief_parameters.layer0_height
      * relief_parameters.layer0_opacity);
  float side = s.front_facing || dot(frame.normal, s.normal) < 0.0 ? 1.0 : -1.0;
  bool sound = surfgrad_max_abs(frame.normal) > 0.0 && !relief_collapsed(s.dst0_dx, s.dst0_dy, frame.dp_dx,
      frame.dp_dy);
  float2 footprint_dx = relief_parameters.layer0_tile * s.dst0_dx;
  float2 footprint_dy = relief_parameters.layer0_tile * s.dst0_dy;
  float lod = surfgrad_texture_lod(footprint_dx, footprint_dy, relief_texture_size(relief_layer0_map));
  float along = side * dot(frame.normal, s.to_viewer);
  bool seen = sound && 0.0 < along;
  float2 dst = surfgrad_project_to_texture_space(frame, s.to_viewer, s.dst0_dx, s.dst0_dy, displacement,
      false);
  float2 seen_dst = seen ? relief_way_share(relief_parameters.layer0_tile * dst,
      relief_texture_size(relief_layer0_map), lod) * dst : float2(0.0, 0.0);
  bool from_below = seen && displacement * side < 0.0;
  float height = relief_layer0_map_first_height(relief_parameters.layer0_tile * s.st0,
      relief_parameters.layer0_tile * seen_dst, relief_parameters.layer0_level, from_below, footprint_dx,
      footprint_dy);
  float2 way = (height - relief_parameters.layer0_level) * seen_dst;
  float2 pixels = surfgrad_screen_offset(s.dst0_dx, s.dst0_dy, way);
  float3 displaced = surfgrad_surface_offset(frame, s.dst0_dx, s.dst0_dy, way)
      + ((height - relief_parameters.layer0_level) * displacement) * frame.normal;
  float3 shift = seen || (sound && surfgrad_max_abs(s.to_viewer) == 0.0) ? displaced : float3(0.0, 0.0, 0.0);
  float2 moved_st = s.st0 + way;
  s.position = s.position + shift;
  s.world_position = s.world_position + shift;
  s.st1 = seen ? s.st1 + pixels.x * s.dst1_dx + pixels.y * s.dst1_dy : s.st1;
  s.st0 = moved_st;
  float rate = relief_unit_rate(frame.normal, s.normal);
  SurfgradFrame base = surfgrad_rebase_frame(frame, seen
      ? surfgrad_offset_normal(frame, surfgrad_from_volume_gradient(frame.normal, rate * s.dn_dx),
      surfgrad_from_volume_gradient(frame.normal, rate * s.dn_dy), pixels) : frame.normal);
  float sun_along = dot(base.normal, s.to_sun);
  bool searched = sound && surfgrad_max_abs(s.to_sun) > 0.0;
  bool lit = searched && 0.0 < sun_along;
  float2 dst_2 = surfgrad_project_to_texture_space(base, s.to_sun, s.dst0_dx, s.dst0_dy, displacement, false);
  float2 sun_dst = lit ? relief_way_share(relief_parameters.layer0_tile * dst_2,
      relief_texture_size(relief_layer0_map), lod) * dst_2 : float2(0.0, 0.0);
  bool sun_below = displacement * sun_along < 0.0;
  float2 here = relief_parameters.layer0_tile * s.st0;
  float sun = relief_layer0_map_visible(here, height, relief_parameters.layer0_tile * sun_dst, sun_below,
      footprint_dx, footprint_dy);
  sunlight = sunlight * (lit ? sun : searched ? 0.0 : 1.0);
  float2 dh = displacement * relief_layer0_map_per_pixel(s.st0, s.dst0_dx, s.dst0_dy, s.dst0_dx, s.dst0_dy);
  float3 relief = sound ? surfgrad_from_height_derivative(base, dh) : float3(0.0, 0.0, 0.0);
  float3 relief_normal = surfgrad_normalize_or_zero(base.normal - relief);
  float3 plane = relief_reflected(relief_normal, s.to_viewer, side);
  SurfgradScreenDerivatives dp = relief_relief_footprint(base, relief, plane, s.position,
      s.relative_from_screen, s.raster);
  SurfgradTextureDerivatives moved = relief_relief_derivatives(base, s.dst0_dx, s.dst0_dy, dp);
  s.dst0_dx = sound ? moved.dst_dx : s.dst0_dx;
  s.dst0_dy = sound ? moved.dst_dy : s.dst0_dy;
  float2 footprint1_dx = s.dst1_dx;
  float2 footprint1_dy = s.dst1_dy;
  SurfgradTextureDerivatives moved_2 = relief_relief_derivatives(base, s.dst1_dx, s.dst1_dy, dp);
  s.dst1_dx = sound ? moved_2.dst_dx : s.dst1_dx;
  s.dst1_dy = sound ? moved_2.dst_dy : s.dst1_dy;
  s.dp_dx = sound ? dp.dp_dx : s.dp_dx;
  s.dp_dy = sound ? dp.dp_dy : s.dp_dy;
  SurfgradFrame frame_2 = surfgrad_rebase_frame(frame, relief_normal, s.dp_dx, s.dp_dy);

  // layers[1]: normal_map n.png
  SurfgradTangentFrame basis1 = surfgrad_mikktspace_basis(s.normal, s.tangent1.xyz, s.tangent1.w);
  SurfgradTangentFrame basis1_2 = relief_rebased_basis(frame_2, basis1);
  float2 slope = (relief_parameters.layer1_opacity * relief_parameters.layer1_scale)
      * relief_layer1_map_slope(s.st1, footprint1_dx, footprint1_dy);

  // layers[2]: noise
  float width = max(length(s.dp_dx), length(s.dp_dy));
  float3 gradient = relief_parameters.layer2_scale * relief_layer2_noise(s.world_position, width).gradient;
  float3 sum = surfgrad_from_tbn(slope, basis1_2.tangent, basis1_2.bitangent);
  float3 sum_2 = sum + relief_parameters.layer2_opacity
      * surfgrad_from_volume_gradient(frame_2.normal, gradient);

  ReliefResult result;
  result.normal = surfgrad_resolve_normal(frame_2, sum_2);
  result.position = s.position;
  result.st0 = s.st0;
  result.st1 = s.st1;
  result.sunlight = sunlight;
  return result;
}

// A vertex where the relief has moved it.
struct ReliefVertex {
  float3 position;
  float3 normal; // unit
};

// A vertex displaced along its normal, in the object's space. Noise, planar and triplanar layers take the
// position from before.
ReliefVertex relief_displaced(float3 position, float3 normal) {
  float3 n = surfgrad_normalize_or_zero(normal);
  SurfgradNoise noise = relief_displace_noise(position, 0.0);
  float3 surfgrad = relief_parameters.displace_height * surfgrad_from_volume_gradient(n, noise.gradient);
  ReliefVertex v;
  v.position = position + (relief_parameters.displace_height
      * (noise.value - relief_parameters.displace_level)) * n;
  v.normal = surfgrad_normalize_or_zero(n - surfgrad);
  return v;
}

#ifdef SURFGRAD_FRAGMENT
// A fragment's surface, its derivatives filled in. Call it in uniform control flow.
ReliefSurface relief_with_derivatives(ReliefSurface s) {
  ReliefSurface t = s;
  t.dp_dx = ddx_fine(s.position);
  t.dp_dy = ddy_fine(s.position);
  t.dn_dx = ddx_fine(s.normal);
  t.dn_dy = ddy_fine(s.normal);
  t.dst0_dx = ddx_fine(s.st0);
  t.dst0_dy = ddy_fine(s.st0);
  t.dst1_dx = ddx_fine(s.st1);
  t.dst1_dy = ddy_fine(s.st1);
  return t;
}
#endif
