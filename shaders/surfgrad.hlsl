// SPDX-License-Identifier: MIT
//
// Surface gradient based bump mapping: the functions of include/surfgrad in HLSL.
//
// One self-contained file, for shader model 5.0 and newer (any stage; the tests compile it by glslang): #include it.
// surfgrad_name is surfgrad::name of the C++ core; what a function means is said there at length and here
// in short.
//
//   SurfgradFrame frame = surfgrad_make_frame(normal);                          // interpolated normal
//   SurfgradTangentFrame tbn = surfgrad_mikktspace_basis(normal, tangent.xyz, tangent.w);
//   float2 slope = surfgrad_derivative_from_normal(2.0 * map.Sample(linear_wrap, st).xyz - 1.0);
//   float3 n = surfgrad_resolve_normal(frame, surfgrad_from_tbn(slope, tbn.tangent, tbn.bitangent));
//
// Several maps on one texture coordinate: add their slopes, then call surfgrad_from_tbn once. Anything
// else: add the surface gradients, then resolve once. Nothing but vertex tangents:
// surfgrad_resolve_mikktspace.
//
// Conventions (docs/conventions.md)
//   texture origin  lower left, t up. Where it is upper left (t down), as in Direct3D, either sample 1 - t
//                   everywhere, or keep t and count green down as +t
//   green           along +t: "green up" with t up. A map of the other sign negates slope.y
//   slopes          (dh/ds, dh/dt), dimensionless, within +-128 from a normal
//   spaces          all vectors of one frame are in one space, usually world space; positions may be
//                   relative to the camera, and no result depends on the scale of the scene
//   tangents        interpolated and not normalised; bitangent = sign * cross(normal, tangent)
//   resolve         n' = normalize(n - resolve_sign * surfgrad)
//   back faces      SURFGRAD_BACK_FACES_SAME (nothing turns), _MIRROR (the interpolated normal is negated,
//                   bumps stay bumps), _FLIP (the front's perturbed normal negated: bumps become dents).
//                   Tangents never change side. For a mirroring object transform negate front_facing
//   matrices        times column vectors, mul(m, v), whatever the packing: a row of the C++ matrix is a row
//                   here, as in float3x3(row, row, row)
//   screen          derivatives per pixel; neither their rate nor which way y runs changes a result
//
// What differs from C++ (docs/shaders.md): numbers are float; what shading languages leave open (NaN, Inf,
// subnormal numbers) is left open here; directions are right for lengths from 1e-18 to 1e18, and shorter
// vectors count as zero; an operation may err by what the API allows it.
//
// SURFGRAD_FRAGMENT, defined before this file in a pixel shader, adds the functions that take derivatives
// across pixels (the last section).

#ifndef SURFGRAD_HLSL
#define SURFGRAD_HLSL

// Numbers and vectors -------------------------------------------------------------------------------------
//
// transpose, determinant, cross of float3, dot, length, sqrt, floor, abs, min, max and select (?:) are the
// language's own.

static const float SURFGRAD_EPSILON = 1.1920928955078125e-7; // from 1 to the next number
static const float SURFGRAD_LEAST = 1.17549435e-38;          // smallest normal number
static const float SURFGRAD_MOST = 3.40282347e38;            // largest number

// Signed area spanned by a and b.
float surfgrad_cross(float2 a, float2 b) { return a.x * b.y - a.y * b.x; }

// Matrix of the signed 2x2 minors: det(m) * transpose(inverse(m)), defined for singular m too.
float3x3 surfgrad_cofactor(float3x3 m) {
  return float3x3(cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1]));
}

// Largest magnitude of a component: a length that needs no square root and cannot overflow.
float surfgrad_max_abs(float2 v) { return max(abs(v.x), abs(v.y)); }
float surfgrad_max_abs(float3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }

// 1 / a, or 0 where |a| is below the smallest normal number.
float surfgrad_reciprocal_or_zero(float a) { return abs(a) < SURFGRAD_LEAST ? 0.0 : 1.0 / a; }

static const float SURFGRAD_DETAIL_SATURATED = 2.12676466e37; // a sixteenth of SURFGRAD_MOST

// a within that magnitude, so that a few such numbers can be added.
float surfgrad_saturated(float a) { return clamp(a, -SURFGRAD_DETAIL_SATURATED, SURFGRAD_DETAIL_SATURATED); }
float2 surfgrad_saturated(float2 v) {
  return clamp(v, -SURFGRAD_DETAIL_SATURATED, SURFGRAD_DETAIL_SATURATED);
}
float3 surfgrad_saturated(float3 v) {
  return clamp(v, -SURFGRAD_DETAIL_SATURATED, SURFGRAD_DETAIL_SATURATED);
}

// The length whose square is the smallest normal number.
static const float SURFGRAD_DETAIL_SHORTEST = 1.08420217e-19;

// 1 / |v|; 0 for a vector so short that its square vanishes.
float surfgrad_detail_inverse_length(float3 v) {
  float square = dot(v, v);
  return square < SURFGRAD_LEAST ? 0.0 : rsqrt(square);
}

// v / |v|, for lengths up to 1e18. Shorter than 1e-18 may give zero, as zero does.
float3 surfgrad_normalize_or_zero(float3 v) { return surfgrad_detail_inverse_length(v) * v; }

// v in units of its magnitude: for products, whose squares may leave the range of numbers. Inf stays Inf.
float3 surfgrad_detail_in_units_of_itself(float3 v) {
  return (1.0 / clamp(surfgrad_max_abs(v), SURFGRAD_LEAST, 1e30)) * v;
}

// Base-2 logarithm, from the smallest normal number's (-126) up: a finite level of detail, never -Inf.
float surfgrad_log2(float a) { return log2(clamp(a, SURFGRAD_LEAST, SURFGRAD_MOST)); }

// 2 to the power a: 0 from -126 down, the largest number from 128 up.
float surfgrad_exp2(float a) { return a > -126.0 ? min(exp2(min(a, 128.0)), SURFGRAD_MOST) : 0.0; }

// a to the power k; 0 where a is not positive.
float surfgrad_pow(float a, float k) { return a > 0.0 ? surfgrad_exp2(k * surfgrad_log2(a)) : 0.0; }

struct SurfgradSinCos {
  float sin, cos;
};

// Sine and cosine of an angle in turns: 1 is a full circle. Exact at multiples of a quarter turn, as
// precise however many turns. The languages' own sine errs by up to 2^-11: tiles would jump.
SurfgradSinCos surfgrad_sin_cos_turns(float turns) {
  float size = abs(turns);
  float fraction = size - floor(size);
  fraction = fraction < 1.0 ? fraction : 0.0; // neither where Inf - Inf was NaN
  float octant = floor(8.0 * fraction);
  float quarter = floor(0.5 * (octant + 1.0));
  float rest = 4.0 * fraction - quarter; // within half a quarter turn of 0
  // (pi/2)^n / n!, signs alternating: the series in quarter turns.
  float square = rest * rest;
  float s = -3.59884323521208534046e-6 * square;
  s = (s + 0.000160441184787359821873) * square;
  s = (s - 0.00468175413531868810069) * square;
  s = (s + 0.0796926262461670451205) * square;
  s = (s - 0.645964097506246253656) * square;
  float c = -0.0000252020423730606054811 * square;
  c = (c + 0.000919260274839426580242) * square;
  c = (c - 0.0208634807633529608731) * square;
  c = (c + 0.253669507901048013637) * square;
  c = (c - 1.23370055013616982735) * square;
  // pi/2 = 1 + 0.57: the exact `rest` carries most of the sine.
  s = rest + rest * (0.570796326794896619231 + s);
  c = 1.0 + c;
  bool odd = quarter == 1.0 || quarter == 3.0;
  float sine = odd ? c : s;
  float cosine = odd ? s : c;
  bool below = quarter == 2.0 || quarter == 3.0; // quarter 4 is 0 again
  bool behind = quarter == 1.0 || quarter == 2.0;
  // Subtracted rather than negated, so that a zero stays +0.
  SurfgradSinCos result = {below != (turns < 0.0) ? 0.0 - sine : sine, behind ? 0.0 - cosine : cosine};
  return result;
}

// The frame of a fragment ---------------------------------------------------------------------------------

// How a double-sided surface looks from behind (section 2.10 of the paper).
static const int SURFGRAD_BACK_FACES_SAME = 0;   // the perturbed normal of the front side
static const int SURFGRAD_BACK_FACES_MIRROR = 1; // the interpolated normal is negated, bumps stay bumps
static const int SURFGRAD_BACK_FACES_FLIP = 2;   // the front's perturbed normal, negated: bumps become dents

// Per-fragment state of one pass of bump mapping. What a shader does not use costs nothing.
struct SurfgradFrame {
  float3 normal;           // base normal: unit, or zero where nothing defines it
  float3 dp_dx, dp_dy;     // screen-space derivatives of the surface position
  float3 sigma_x, sigma_y; // dp_dx, dp_dy without their part along the normal
  float flip_sign;         // +1 or -1: orientation of (dp_dx, dp_dy) seen against the normal
  float resolve_sign;      // -1 on a back face in mode flip, else +1
};

// Directions in which s and t grow. Scale matters: surfgrad_from_tbn uses the vectors as they are.
struct SurfgradTangentFrame {
  float3 tangent, bitangent;
};

SurfgradFrame surfgrad_detail_frame_from_unit_normal(float3 n, float3 dp_dx, float3 dp_dy,
                                                     float resolve_sign) {
  float orientation = dot(dp_dy, cross(n, dp_dx));
  SurfgradFrame result = {n,
                          dp_dx,
                          dp_dy,
                          dp_dx - dot(dp_dx, n) * n,
                          dp_dy - dot(dp_dy, n) * n,
                          orientation < 0.0 ? -1.0 : 1.0,
                          resolve_sign};
  return result;
}

// normalize(normal), or the direction of plane_sign * cross(dp_dx, dp_dy) where the normal is zero.
float3 surfgrad_detail_unit_normal_or_plane(float3 normal, float3 dp_dx, float3 dp_dy, float plane_sign) {
  if (surfgrad_max_abs(normal) < SURFGRAD_DETAIL_SHORTEST) {
    normal = surfgrad_detail_in_units_of_itself(plane_sign * cross(dp_dx, dp_dy));
  }
  return surfgrad_normalize_or_zero(normal);
}

// Prologue for a fragment whose back side needs no special care.
//
// normal        interpolated vertex normal, of any length
// dp_dx, dp_dy  change of the surface position over one pixel to the right and one along +y of the screen
// degenerate    zero normal: normalize(cross(dp_dx, dp_dy)), which faces the viewer in a right-handed space
//               where screen y runs up (negate dp_dy, then the normal, where it runs down)
// source        Mikkelsen 2019, listing 16
SurfgradFrame surfgrad_make_frame(float3 normal, float3 dp_dx, float3 dp_dy) {
  return surfgrad_detail_frame_from_unit_normal(
      surfgrad_detail_unit_normal_or_plane(normal, dp_dx, dp_dy, 1.0), dp_dx, dp_dy, 1.0);
}

// Prologue for double-sided materials.
//
// front_facing  SV_IsFrontFace; inverted for an object transform with negative determinant
// back_faces    SURFGRAD_BACK_FACES_*. Tangents and bitangents never change side
// degenerate    as above, but the cross product takes the side of the normal that it stands in for
// source        Mikkelsen 2019, listing 16 and section 2.10
SurfgradFrame surfgrad_make_frame(float3 normal, float3 dp_dx, float3 dp_dy, bool front_facing,
                                  int back_faces) {
  float back_sign = front_facing ? 1.0 : -1.0;
  float normal_sign = back_faces == SURFGRAD_BACK_FACES_SAME ? 1.0 : back_sign;
  float resolve_sign = back_faces == SURFGRAD_BACK_FACES_FLIP ? back_sign : 1.0;
  // The cross product faces the viewer, the normal of a surface seen from behind does not.
  float3 front_normal = surfgrad_detail_unit_normal_or_plane(normal, dp_dx, dp_dy, back_sign);
  return surfgrad_detail_frame_from_unit_normal(normal_sign * front_normal, dp_dx, dp_dy, resolve_sign);
}

// Frame for layers that need no derivative of the position: vertex tangents, volume, object-space normal and
// decal layers.
//
// degenerate  zero normal: zero, which makes the resolved normal zero
SurfgradFrame surfgrad_make_frame(float3 normal) {
  float3 zero = float3(0.0, 0.0, 0.0);
  SurfgradFrame result = {surfgrad_normalize_or_zero(normal), zero, zero, zero, zero, 1.0, 1.0};
  return result;
}

// Frame of the next pass: bump mapping on top of a resolved normal. resolve_sign is kept.
//
// normal      the resolved normal: unit. It already carries the side, so it is never negated again
// degenerate  zero normal: sigma is dp, flip_sign +1, and the resolved normal zero
// source      Mikkelsen 2019, listing 16 and section 2.11
SurfgradFrame surfgrad_rebase_frame(SurfgradFrame frame, float3 normal) {
  return surfgrad_detail_frame_from_unit_normal(normal, frame.dp_dx, frame.dp_dy, frame.resolve_sign);
}

// The same, where the position changed too (parallax, displacement): dp from surfgrad_screen_derivatives.
SurfgradFrame surfgrad_rebase_frame(SurfgradFrame frame, float3 normal, float3 dp_dx, float3 dp_dy) {
  return surfgrad_detail_frame_from_unit_normal(normal, dp_dx, dp_dy, frame.resolve_sign);
}

// Vertex tangent space in the form that surface gradients need, still compliant with MikkTSpace: the resolve
// then equals normalize(x * tangent + y * bitangent + z * normal) of the raw vectors.
//
// normal      interpolated vertex normal, neither normalised nor negated: not frame.normal
// tangent     interpolated vertex tangent, not normalised
// sign        handedness (tangent.w): positive means bitangent = cross(normal, tangent), else its negative
// degenerate  zero normal: zero vectors, hence no bump
// source      Mikkelsen 2019, listing 16 and section 2.2
SurfgradTangentFrame surfgrad_mikktspace_basis(float3 normal, float3 tangent, float sign) {
  float3 scaled = surfgrad_detail_inverse_length(normal) * tangent;
  SurfgradTangentFrame result = {scaled, (sign > 0.0 ? 1.0 : -1.0) * cross(normal, scaled)};
  return result;
}

// Tangent frame of any texture coordinate, made in place: no vertex tangents needed.
//
// dst_dx, dst_dy  screen-space derivatives of the texture coordinate
// returns         orthonormal tangent (direction of +s in the tangent plane) and bitangent (on the side of
//                 +t), right for clockwise and counter-clockwise coordinates
// degenerate      collapsed coordinates (both derivatives parallel to rounding, or zero) and zero sigma:
//                 zero vectors, hence no bump
// source          Mikkelsen 2019, listing 6 and section 2.3
SurfgradTangentFrame surfgrad_tangent_basis(SurfgradFrame frame, float2 dst_dx, float2 dst_dy) {
  float size_x = surfgrad_max_abs(dst_dx);
  float size_y = surfgrad_max_abs(dst_dy);
  float det = surfgrad_cross(dst_dx, dst_dy);
  bool collapsed = !(SURFGRAD_EPSILON * (size_x * size_y) < abs(det));
  float sign = det < 0.0 ? -1.0 : 1.0;
  // The position's change along s, up to a positive factor, which normalisation removes.
  float3 along_s = dst_dy.y * frame.sigma_x - dst_dx.y * frame.sigma_y;
  float3 tangent =
      collapsed ? float3(0.0, 0.0, 0.0)
                : sign * surfgrad_normalize_or_zero(surfgrad_detail_in_units_of_itself(along_s));
  SurfgradTangentFrame result = {tangent, (sign * frame.flip_sign) * cross(frame.normal, tangent)};
  return result;
}

// Slopes --------------------------------------------------------------------------------------------------
//
// A derivative is (dh/ds, dh/dt): the two-component form in which maps are filtered, blended and scaled.

static const float SURFGRAD_MAX_SLOPE = 128.0; // steeper slopes are clamped: 89.55 degrees

// Derivative of a tangent-space normal given by three channels.
//
// m           normal in [-1, 1]^3, of any length: only its direction counts
// returns     -m.xy / max(|m.z|, max(|m.x|, |m.y|) / 128)
// degenerate  (0, 0, 0) and (0, 0, z) give zero; m.z <= 0 is treated as |m.z|
// source      Mikkelsen 2019, equation 4, with the clamp of listing 4
float2 surfgrad_derivative_from_normal(float3 m) {
  float steepest = max(abs(m.x), abs(m.y)) * (1.0 / SURFGRAD_MAX_SLOPE);
  return m.xy * (-1.0 / max(max(abs(m.z), SURFGRAD_LEAST), steepest));
}

// Derivative of a tangent-space normal given by two channels, the third reconstructed.
//
// m           channels x, y in [-1, 1] of a unit normal
// returns     -m / sqrt(max(1 - |m|^2, (max(|m.x|, |m.y|) / 128)^2))
// degenerate  zero gives zero; |m| >= 1 gives the steepest slope in the direction of m
// source      Mikkelsen 2019, listing 4, equation 5
float2 surfgrad_derivative_from_normal(float2 m) {
  float2 squared = m * m;
  float z_squared = 1.0 - squared.x - squared.y;
  float least = max(squared.x, squared.y) * (1.0 / (SURFGRAD_MAX_SLOPE * SURFGRAD_MAX_SLOPE));
  return m * -rsqrt(max(z_squared, least));
}

// Unit tangent-space normal of a derivative: normalize(-d.x, -d.y, 1).
//
// source  Mikkelsen 2019, equation 4
float3 surfgrad_normal_from_derivative(float2 d) { return surfgrad_normalize_or_zero(float3(-d, 1.0)); }

// Screen-space derivative of a height from three taps: better than differences across a pixel quad.
//
// h, h_x, h_y  heights at st, st + dst_dx, st + dst_dy
// returns      (dh/dx, dh/dy) per pixel, for surfgrad_from_height_derivative
// source       Mikkelsen 2019, listing 9
float2 surfgrad_derivative_from_heights(float h, float h_x, float h_y) { return float2(h_x - h, h_y - h); }

float4 surfgrad_detail_spline_weights(float f) {
  float g = 1.0 - f;
  const float sixth = 1.0 / 6.0;
  return float4(g * g * g * sixth, (4.0 - f * f * (6.0 - 3.0 * f)) * sixth,
                (4.0 - g * g * (6.0 - 3.0 * g)) * sixth, f * f * f * sixth);
}

float4 surfgrad_detail_spline_slopes(float f) {
  float g = 1.0 - f;
  return float4(-(0.5 * g * g), f * (1.5 * f - 2.0), -(g * (1.5 * g - 2.0)), 0.5 * f * f);
}

// Derivative of the uniform cubic B-spline through (not interpolating) 4x4 heights: smooth where a height map
// is magnified.
//
// texels    rows along t (the first lowest), columns along s: float4x4(row0, row1, row2, row3). The
//           point lies between the second and third of each
// fraction  position in [0, 1]^2 from the second texel towards the third
// returns   (dh/ds, dh/dt) per texel, for surfgrad_from_texel_derivative
float2 surfgrad_derivative_from_bicubic(float4x4 texels, float2 fraction) {
  float4 along_s_slope = mul(texels, surfgrad_detail_spline_slopes(fraction.x));
  float4 along_s = mul(texels, surfgrad_detail_spline_weights(fraction.x));
  return float2(dot(along_s_slope, surfgrad_detail_spline_weights(fraction.y)),
                dot(along_s, surfgrad_detail_spline_slopes(fraction.y)));
}

// Bump scale applied to a derivative.
//
// source  Mikkelsen 2019, listing 3
float2 surfgrad_scale_bump(float scale, float2 deriv) { return scale * deriv; }

// Surface gradients ---------------------------------------------------------------------------------------
//
// Every bump influence in the one form that scales, masks and adds linearly: a vector in the tangent plane.

// Surface gradient from a derivative expressed in a tangent basis.
//
// tangent, bitangent  directions of +s, +t: surfgrad_mikktspace_basis or surfgrad_tangent_basis
// degenerate          zero basis gives zero
// source              Mikkelsen 2019, listing 5, equation 6
float3 surfgrad_from_tbn(float2 deriv, float3 tangent, float3 bitangent) {
  return deriv.x * tangent + deriv.y * bitangent;
}

// Surface gradient that leads from a base normal to a known perturbed one, such as an object-space normal map
// gives.
//
// normal      base normal, unit
// v           perturbed direction in the same space, of any length
// returns     g with normalize(normal - g) = normalize(v) where dot(normal, v) > 0. Where it is negative the
//             result perturbs towards v, mirrored at the tangent plane
// degenerate  v = 0 gives zero. |dot(normal, v)| is clamped to eps * |v|, so |g| <= 1 / eps
// source      Mikkelsen 2019, listing 7
float3 surfgrad_from_perturbed_normal(float3 normal, float3 v) {
  float3 u = surfgrad_normalize_or_zero(v); // makes the clamp relative to |v|
  float along = dot(normal, u);
  return (1.0 / max(SURFGRAD_EPSILON, abs(along))) * (along * normal - u);
}

// Surface gradient from the derivatives of the height by any two parameters of the surface.
//
// normal        base normal, unit
// dp_du, dp_dv  derivatives of the position, of any length and angle
// dh_duv        derivatives of the height by the same parameters, in the units of the position
// degenerate    the area that dp_du and dp_dv span is clamped to eps times the product of their magnitudes:
//               bounded when they are parallel, zero when one is zero
// source        Mikkelsen 2010, equation 3 (listing 8 of 2019); Golubev, equations 6 and 31
float3 surfgrad_from_parametric_derivative(float3 normal, float3 dp_du, float3 dp_dv, float2 dh_duv) {
  // In units of each derivative's own magnitude everything below is of order one.
  float inverse_u = surfgrad_reciprocal_or_zero(surfgrad_max_abs(dp_du));
  float inverse_v = surfgrad_reciprocal_or_zero(surfgrad_max_abs(dp_dv));
  float3 a = inverse_u * dp_du;
  float3 r1 = cross(inverse_v * dp_dv, normal);
  float3 r2 = cross(normal, a);
  float det = dot(a, r1);
  float s = (det < 0.0 ? -1.0 : 1.0) / max(SURFGRAD_EPSILON, abs(det));
  return surfgrad_saturated(s * (dh_duv.x * inverse_u)) * r1 +
         surfgrad_saturated(s * (dh_duv.y * inverse_v)) * r2;
}

// Surface gradient from the screen-space derivative of the height: scale-dependent bump mapping.
//
// frame   dp_dx, dp_dy of the position before displacement
// dh_dxy  (dh/dx, dh/dy) per pixel, in the units of the position: surfgrad_derivative_from_heights
// source  Mikkelsen 2019, listing 8 with isDerivScreenSpace
float3 surfgrad_from_height_derivative(SurfgradFrame frame, float2 dh_dxy) {
  return surfgrad_from_parametric_derivative(frame.normal, frame.dp_dx, frame.dp_dy, dh_dxy);
}

// Surface gradient from a height derivative per texel: scale-dependent bump mapping with a map.
//
// dh_dtexel       height change from one texel to the next along s and t, in units of the position
// size            width and height of the map in texels
// dst_dx, dst_dy  screen-space derivatives of the normalised texture coordinate
// source          Mikkelsen 2019, listing 8
float3 surfgrad_from_texel_derivative(SurfgradFrame frame, float2 dh_dtexel, float2 size, float2 dst_dx,
                                      float2 dst_dy) {
  float2 dh_dst = size * dh_dtexel;
  return surfgrad_from_height_derivative(frame, float2(dot(dh_dst, dst_dx), dot(dh_dst, dst_dy)));
}

// Surface gradient of a function of space: its gradient projected onto the tangent plane.
//
// normal    base normal, unit
// gradient  volume gradient (dh/dx, dh/dy, dh/dz) in the same space
// source    Mikkelsen 2019, listing 12; Golubev, equation 30
float3 surfgrad_from_volume_gradient(float3 normal, float3 gradient) {
  return gradient - dot(normal, gradient) * normal;
}

// Bump scale applied to a surface gradient.
//
// source  Mikkelsen 2019, listing 2
float3 surfgrad_scale_bump(float scale, float3 surfgrad) { return scale * surfgrad; }

// Resolve -------------------------------------------------------------------------------------------------

// What the v of a resolve is scaled by: 1 / |v|, or 0 where the base normal is zero. The fourth component
// keeps the root from zero and costs nothing, being one more term of a sum; it counts in a v shorter than
// 1e-15. Any normal but zero leaves the inverse, at most 1e19, as it is.
float surfgrad_detail_resolve_scale(float3 normal, float3 v) {
  float4 guarded = float4(v, SURFGRAD_DETAIL_SHORTEST);
  return min(rsqrt(dot(guarded, guarded)), 1e38 * surfgrad_max_abs(normal));
}

// The perturbed normal: normalize(normal - resolve_sign * surfgrad).
//
// surfgrad    the weighted sum of all surface gradients of the pass
// returns     unit normal. On a back face in mode flip it is the negative of the front side's
// degenerate  a zero base normal gives zero, whatever the gradient
// source      Mikkelsen 2019, listing 1, equation 1
float3 surfgrad_resolve_normal(SurfgradFrame frame, float3 surfgrad) {
  float3 v = frame.normal - frame.resolve_sign * surfgrad;
  return surfgrad_detail_resolve_scale(frame.normal, v) * v;
}

// The perturbed normal of a surface that is bumped through its vertex tangents alone: the cheapest way, with
// one normalisation. Equals surfgrad_resolve_normal(surfgrad_make_frame(normal), g), where g is
// surfgrad_from_tbn of deriv with surfgrad_mikktspace_basis(normal, tangent, sign).
//
// normal, tangent  interpolated, not normalised
// sign             handedness (tangent.w)
// deriv            the sum of all slopes on the texture coordinate of the tangents
// back faces       mode flip: negate the result. Mode mirror: pass -normal and -sign
// degenerate       a zero normal gives zero
float3 surfgrad_resolve_mikktspace(float3 normal, float3 tangent, float sign, float2 deriv) {
  float3 v = normal - deriv.x * tangent - (sign > 0.0 ? deriv.y : -deriv.y) * cross(normal, tangent);
  return surfgrad_detail_resolve_scale(normal, v) * v;
}

// Turns the result of mode mirror into that of mode flip, after the last resolve: reflect(-resolved,
// initial).
//
// initial_normal  unit base normal (negated on back faces) as it was before the first resolve
// source          Mikkelsen 2019, section 2.10. Not equal to mode flip across a post-resolve volume layer, so
//                 prefer the mode
float3 surfgrad_flip_from_mirror(float3 resolved, float3 initial_normal) {
  return (2.0 * dot(resolved, initial_normal)) * initial_normal - resolved;
}

// A normal through an object transform: sign(det M) * cof(M) * v.
//
// M        linear part of the transform; may scale non-uniformly or mirror
// v        a normal, or N - surfgrad as a whole; a surface gradient alone does not transform this way
// returns  not unit; points outward for mirrored objects too
// source   Golubev, equations 25, 33, 36
float3 surfgrad_transform_normal(float3x3 M, float3 v) {
  float3x3 c = surfgrad_cofactor(M);
  return (dot(M[0], c[0]) < 0.0 ? -1.0 : 1.0) * mul(c, v);
}

// Matrix that takes implicit gradients (-dh/du, -dh/dv, 1) to world space, with the object's scale and
// rotation folded in: constant over a surface point, so it can be precomputed.
//
// rotation      world from scaled object, a proper rotation
// scale         the object's scale matrix, applied before the rotation; may mirror
// dp_du, dp_dv  object-space derivatives of the position by the texture coordinate
// normal        object-space unit normal
// degenerate    parallel dp_du, dp_dv: the first two columns are zero (no bump)
// source        Golubev, equations 6, 28, 29
float3x3 surfgrad_tangent_normal_matrix(float3x3 rotation, float3x3 scale, float3 dp_du, float3 dp_dv,
                                        float3 normal) {
  float inverse_u = surfgrad_reciprocal_or_zero(surfgrad_max_abs(dp_du));
  float inverse_v = surfgrad_reciprocal_or_zero(surfgrad_max_abs(dp_dv));
  float3 a = inverse_u * dp_du;
  float3 b = inverse_v * dp_dv;
  float det = dot(cross(a, b), normal);
  float s = abs(det) < SURFGRAD_EPSILON ? 0.0 : 1.0 / det;
  // What +du, +dv of the height and the base normal contribute (Golubev, equation 6).
  float3x3 inverse = float3x3(surfgrad_saturated(s * inverse_u) * cross(b, normal),
                              surfgrad_saturated(s * inverse_v) * cross(normal, a), normal);
  // The scale in units of its own magnitude, too: its cofactors are products of two.
  float size = max(max(surfgrad_max_abs(scale[0]), surfgrad_max_abs(scale[1])), surfgrad_max_abs(scale[2]));
  float3x3 unit = surfgrad_reciprocal_or_zero(size) * scale;
  float3x3 c = surfgrad_cofactor(unit);
  float side = dot(unit[0], c[0]) < 0.0 ? -1.0 : 1.0;
  float3x3 m = mul(rotation, mul(side * c, transpose(inverse)));
  float area = surfgrad_saturated(size * size);
  return float3x3(surfgrad_saturated(area * m[0]), surfgrad_saturated(area * m[1]),
                  surfgrad_saturated(area * m[2]));
}

// The same for a scale along the object's axes.
float3x3 surfgrad_tangent_normal_matrix(float3x3 rotation, float3 scale, float3 dp_du, float3 dp_dv,
                                        float3 normal) {
  return surfgrad_tangent_normal_matrix(
      rotation, float3x3(scale.x, 0.0, 0.0, 0.0, scale.y, 0.0, 0.0, 0.0, scale.z), dp_du, dp_dv, normal);
}

// Derivatives without differences across pixels -----------------------------------------------------------

struct SurfgradScreenDerivatives {
  float3 dp_dx, dp_dy;
};

struct SurfgradTextureDerivatives {
  float2 dst_dx, dst_dy;
};

// Screen-space derivatives of the position on the tangent plane at a fragment, analytically: for
// parallax-displaced surfaces and depth edges, where differences between pixels mean nothing.
//
// normal             of the plane, any length. Where it faces away from the viewer in direction v,
//                    n - 2 dot(v, n) v may serve better
// world_from_screen  takes (x, y, depth, 1) in pixels to the space of position and normal, before the
//                    division by w
// x, y               fragment coordinate (pixel centres at .5)
// degenerate         plane seen edge-on: its depth coefficient is clamped to eps of the plane's largest,
//                    which bounds the result. w = 0 gives zero
// source             Mikkelsen 2019, listing 17
SurfgradScreenDerivatives surfgrad_screen_derivatives(float3 position, float3 normal,
                                                      float4x4 world_from_screen, float x, float y) {
  float3 n = surfgrad_normalize_or_zero(normal);
  float4x4 columns = transpose(world_from_screen);
  // Plane in screen space: A x + B y + C z + D = 0, so z = -(A x + B y + D) / C.
  float4 on_screen = mul(columns, float4(n, -dot(position, n)));
  float size = max(max(abs(on_screen.x), abs(on_screen.y)), max(abs(on_screen.z), abs(on_screen.w)));
  float least = max(SURFGRAD_EPSILON * size, SURFGRAD_LEAST);
  float depth_slope = (on_screen.z < 0.0 ? -1.0 : 1.0) * max(least, abs(on_screen.z));
  float4 v0 = columns[0] - (on_screen.x / depth_slope) * columns[2];
  float4 v1 = columns[1] - (on_screen.y / depth_slope) * columns[2];
  float4 v2 = columns[3] - (on_screen.w / depth_slope) * columns[2];
  float4 hit = x * v0 + y * v1 + v2; // homogeneous point of the plane under (x, y)
  // (f / w)' = (f' - (f / w) w') / w, with one division by w at a time: w * w may underflow.
  float inverse_w = surfgrad_reciprocal_or_zero(hit.w);
  float3 p = surfgrad_saturated(inverse_w * hit.xyz);
  SurfgradScreenDerivatives result = {surfgrad_saturated(inverse_w * (v0.xyz - v0.w * p)),
                                      surfgrad_saturated(inverse_w * (v1.xyz - v1.w * p))};
  return result;
}

// Screen-space derivatives of a projected texture coordinate from its volume gradients: right on displaced
// surfaces and across depth edges.
//
// source  Mikkelsen 2019, section 2.9: s and t are functions of space
SurfgradTextureDerivatives surfgrad_projected_derivatives(float3 grad_s, float3 grad_t, float3 dp_dx,
                                                          float3 dp_dy) {
  SurfgradTextureDerivatives result = {float2(dot(grad_s, dp_dx), dot(grad_t, dp_dx)),
                                       float2(dot(grad_s, dp_dy), dot(grad_t, dp_dy))};
  return result;
}

// Mip level of an isotropic fetch: log2 of the longer footprint axis in texels. May be negative.
//
// size        width and height of the map's level 0, in texels
// degenerate  a zero footprint gives -126: level 0
// source      Mikkelsen 2019, section 3: compute it from the coordinate before a parallax correction, sample
//             with it after
float surfgrad_texture_lod(float2 dst_dx, float2 dst_dy, float2 size) {
  float2 x = size * dst_dx;
  float2 y = size * dst_dy;
  float square = max(dot(x, x), dot(y, y));
  return square < SURFGRAD_LEAST ? -126.0 : 0.5 * surfgrad_log2(square);
}

// Parallax mapping ----------------------------------------------------------------------------------------

// Line segment in texture space that a ray covers while it crosses the height range: the search vector of
// parallax mapping.
//
// dir              unit direction in the frame's space, e.g. towards the viewer
// bump_scale       displacement of height 1 along the normal, in units of the position
// skip_projection  true leaves out the division by dot(normal, dir) (offset limiting)
// returns          change of st while the height changes by 1 (by dot(normal, dir) when skipped)
// degenerate       |dot(normal, dir)| and the pixel's area are clamped to eps times the magnitudes involved
// source           Mikkelsen 2019, listing 10
float2 surfgrad_project_to_texture_space(SurfgradFrame frame, float3 dir, float2 dst_dx, float2 dst_dy,
                                         float bump_scale, bool skip_projection) {
  float inverse_x = surfgrad_reciprocal_or_zero(surfgrad_max_abs(frame.dp_dx));
  float inverse_y = surfgrad_reciprocal_or_zero(surfgrad_max_abs(frame.dp_dy));
  float3 a = inverse_x * frame.dp_dx;
  float3 r1 = cross(inverse_y * frame.dp_dy, frame.normal);
  float3 r2 = cross(frame.normal, a);
  float det = dot(a, r1);
  float s = (det < 0.0 ? -1.0 : 1.0) / max(SURFGRAD_EPSILON, abs(det));
  // Pixels covered per unit of dir, then texture units.
  float2 on_screen =
      surfgrad_saturated(float2(s * (inverse_x * dot(r1, dir)), s * (inverse_y * dot(r2, dir))));
  float2 in_texture = surfgrad_saturated(on_screen.x * dst_dx) + surfgrad_saturated(on_screen.y * dst_dy);
  if (skip_projection) return surfgrad_saturated(bump_scale * in_texture);
  float along = dot(frame.normal, dir);
  float least = max(SURFGRAD_EPSILON * surfgrad_max_abs(dir), SURFGRAD_LEAST);
  float per_height = (along < 0.0 ? -1.0 : 1.0) / max(least, abs(along));
  return surfgrad_saturated((bump_scale * per_height) * in_texture);
}
float2 surfgrad_project_to_texture_space(SurfgradFrame frame, float3 dir, float2 dst_dx, float2 dst_dy,
                                         float bump_scale) {
  return surfgrad_project_to_texture_space(frame, dir, dst_dx, dst_dy, bump_scale, false);
}

// A texture offset in pixels: the step (vx, vy) on the screen that changes st by texture_offset.
//
// degenerate  collapsed coordinates: the determinant is clamped to eps times the derivatives' magnitudes;
//             zero derivatives give zero
// source      Mikkelsen 2019, listing 11
float2 surfgrad_screen_offset(float2 dst_dx, float2 dst_dy, float2 texture_offset) {
  float inverse_x = surfgrad_reciprocal_or_zero(surfgrad_max_abs(dst_dx));
  float inverse_y = surfgrad_reciprocal_or_zero(surfgrad_max_abs(dst_dy));
  float2 a = inverse_x * dst_dx;
  float2 b = inverse_y * dst_dy;
  float det = surfgrad_cross(a, b);
  float s = (det < 0.0 ? -1.0 : 1.0) / max(SURFGRAD_EPSILON, abs(det));
  return surfgrad_saturated(float2(s * (inverse_x * surfgrad_cross(texture_offset, b)),
                                   s * (inverse_y * surfgrad_cross(a, texture_offset))));
}

// A texture offset as a vector in the tangent plane; adding it and height * bump_scale * normal to the
// position gives the displaced position.
//
// source  Mikkelsen 2019, listing 11
float3 surfgrad_surface_offset(SurfgradFrame frame, float2 dst_dx, float2 dst_dy, float2 texture_offset) {
  float2 v = surfgrad_screen_offset(dst_dx, dst_dy, texture_offset);
  return surfgrad_saturated(v.x * frame.sigma_x) + surfgrad_saturated(v.y * frame.sigma_y);
}

// The base normal at an offset position of a curved surface: normalize(n + vx dn_dx + vy dn_dy).
//
// dn_dx, dn_dy  screen-space derivatives of the unit base normal
// v             from surfgrad_screen_offset
// source        Mikkelsen 2019, section 2.6
float3 surfgrad_offset_normal(SurfgradFrame frame, float3 dn_dx, float3 dn_dy, float2 v) {
  return surfgrad_normalize_or_zero(
      surfgrad_detail_in_units_of_itself(frame.normal + v.x * dn_dx + v.y * dn_dy));
}

// Parallax occlusion mapping ------------------------------------------------------------------------------

// Halvings of the step that holds the crossing.
static const int SURFGRAD_PARALLAX_REFINEMENTS = 6;
// Finer steps are below the resolution of heights near 1.
static const int SURFGRAD_PARALLAX_MOST_STEPS = 262144;

struct SurfgradParallaxHit {
  float2 texture_coordinate; // where the ray meets the map
  float height;              // of the crossing, in [0, 1]
  bool hit;
};

// A march under way. The bracket: the ray is above the map at `upper`, at or below it at `lower`.
struct SurfgradParallaxMarch {
  float2 st, dst;
  float ray; // height of the ray where the map is asked for next
  float upper, lower;
  float upper_clearance, lower_clearance; // of the map above the ray
  int steps;
  int searched; // heights of the search so far
  int refined;  // heights of the refinement so far
  bool hit;
};

// First crossing of a ray with a height map, coming from height 1 down to 0. The core's march_parallax
// calls a function for heights; here the loop is the caller's, who samples as he likes (an explicit level
// of detail or gradients: the number of rounds differs from pixel to pixel):
//
//   SurfgradParallaxMarch march = surfgrad_march_parallax_begin(st, dst, 32);
//   while (surfgrad_march_parallax_asks(march)) {
//     float height = heights.SampleLevel(linear_wrap, surfgrad_march_parallax_at(march), lod).x;
//     march = surfgrad_march_parallax_answer(march, height);
//   }
//   SurfgradParallaxHit hit = surfgrad_march_parallax_end(march);
//
// st          texture coordinate of the fragment, where the ray reaches height 0
// dst         surfgrad_project_to_texture_space towards the viewer: at height h the ray is over st + h * dst
// step_limit  steps of the search, within [1, SURFGRAD_PARALLAX_MOST_STEPS]. A feature narrower than
//             |dst| / step_limit can be stepped over
// height      in [0, 1]; the level of detail comes from the coordinate before correction
//             (surfgrad_texture_lod)
// returns     (end) first height h, searched downwards, where the map reaches the ray, and st + h * dst
// degenerate  no crossing (every height below the ray): hit false, height 0, st unchanged. Heights of 1 and
//             more at the top: height 1. Zero dst gives the height at st
// source      Mikkelsen 2019, section 2.6; linear search, bisection and one interpolation
SurfgradParallaxMarch surfgrad_march_parallax_begin(float2 st, float2 dst, int step_limit) {
  int steps = clamp(step_limit, 1, SURFGRAD_PARALLAX_MOST_STEPS);
  SurfgradParallaxMarch result = {st, dst, 1.0, 1.0, 1.0, 0.0, 0.0, steps, 0, 0, false};
  return result;
}

// Whether a height is wanted: at most step_limit + 1 + SURFGRAD_PARALLAX_REFINEMENTS times.
bool surfgrad_march_parallax_asks(SurfgradParallaxMarch march) {
  return march.hit ? march.refined < SURFGRAD_PARALLAX_REFINEMENTS : march.searched <= march.steps;
}

// The texture coordinate where it is wanted.
float2 surfgrad_march_parallax_at(SurfgradParallaxMarch march) { return march.st + march.ray * march.dst; }

// The march after the height there is known.
SurfgradParallaxMarch surfgrad_march_parallax_answer(SurfgradParallaxMarch march, float height) {
  // The bounds, outside the range of heights, keep Inf out of the interpolation.
  float clearance = min(max(height, -1.0), 2.0) - march.ray;
  bool crossed = clearance >= 0.0;
  if (crossed || !march.hit) {
    march.lower = march.ray;
    march.lower_clearance = clearance;
  }
  if (!crossed) {
    march.upper = march.ray;
    march.upper_clearance = clearance;
  }
  if (march.hit) {
    march.refined += 1;
  } else {
    march.searched += 1;
    march.hit = crossed;
  }
  march.ray = march.hit ? 0.5 * (march.upper + march.lower)
                        : float(march.steps - march.searched) / float(march.steps);
  return march;
}

// What the march has found.
SurfgradParallaxHit surfgrad_march_parallax_end(SurfgradParallaxMarch march) {
  // Where the straight line through the bracket's ends meets the ray; the ends of a crossing at the top
  // coincide and leave no line.
  float share =
      march.upper_clearance * surfgrad_reciprocal_or_zero(march.upper_clearance - march.lower_clearance);
  float height = march.hit ? march.upper + share * (march.lower - march.upper) : 0.0;
  float2 st = march.hit ? march.st + height * march.dst : march.st;
  SurfgradParallaxHit result = {st, height, march.hit};
  return result;
}

// The whole march in one statement: HEIGHT_AT(st) is a function or a macro.
#define SURFGRAD_MARCH_PARALLAX(hit, HEIGHT_AT, st, dst, step_limit)                                         \
  {                                                                                                          \
    SurfgradParallaxMarch march_ = surfgrad_march_parallax_begin(st, dst, step_limit);                       \
    while (surfgrad_march_parallax_asks(march_))                                                             \
      march_ = surfgrad_march_parallax_answer(march_, HEIGHT_AT(surfgrad_march_parallax_at(march_)));        \
    hit = surfgrad_march_parallax_end(march_);                                                               \
  }

// Decals --------------------------------------------------------------------------------------------------
//
// A shape answers, for a point in space, where its image lies there and how strongly it acts. Volume
// gradients of many decals are summed, then projected once with surfgrad_from_volume_gradient; falloff *
// opacity scales the gradient as a bump scale. Slopes go with axis_s, axis_t; dh/ds, dh/dt of heights with
// grad_s, grad_t; mip levels with surfgrad_projected_derivatives(grad_s, grad_t, dp_dx, dp_dy).

// Volume gradient of a projected image: deriv.x * axis_x + deriv.y * axis_y.
//
// source  Mikkelsen 2019, listing 15
float3 surfgrad_decal_gradient(float2 deriv, float3 axis_x, float3 axis_y) {
  return deriv.x * axis_x + deriv.y * axis_y;
}

// Surface gradient of a projected image.
//
// source  Mikkelsen 2019, listing 15
float3 surfgrad_from_decal(float3 normal, float2 deriv, float3 axis_x, float3 axis_y) {
  return surfgrad_from_volume_gradient(normal, surfgrad_decal_gradient(deriv, axis_x, axis_y));
}

// Placement of a decal: its origin and orthonormal axes, either handedness. Sizes belong to the shapes.
struct SurfgradDecalFrame {
  float3 origin;
  float3 axis_x, axis_y, axis_z;
};

// An image projected by a box, cone or wedge, at one point. All zero outside the shape.
struct SurfgradDecalProjection {
  float2 texture_coordinate; // [0, 1]^2 over the image
  float3 grad_s, grad_t;     // exact gradients of the texture coordinate in space
  float3 axis_s, axis_t;     // what a unit slope along s and t adds to the volume gradient
  float falloff;             // 1 in the core, falling smoothly to 0 at the shape's surface
  bool inside;
};

// A direction projected by a sphere or capsule, for a cube map of normals, at one point. All zero outside.
struct SurfgradDecalDirection {
  float3 direction;  // unit, in the space of the positions; zero at the centre
  float3 lookup;     // the same in the decal's frame: for the cube map
  float3 unchanging; // unit vector along which the direction does not change; zero where none
  float falloff;
  bool inside;
};

// What a slope in the image of a cone or wedge adds to the volume gradient.
static const int SURFGRAD_CONE_GRADIENT_EXACT = 0; // the gradient of (x/z, y/z), perspective term included
static const int SURFGRAD_CONE_GRADIENT_SCALE_FREE = 1; // the unit axes, as for a box

// Falloff at the fraction e of the way from the core to the surface: 1 up to 1 - fade, 0 at 1.
float surfgrad_detail_edge_falloff(float e, float fade) {
  float t = min(max((e - (1.0 - fade)) * surfgrad_reciprocal_or_zero(fade), 0.0), 1.0);
  return 1.0 - t * t * (3.0 - 2.0 * t);
}

float3 surfgrad_detail_to_decal(SurfgradDecalFrame frame, float3 p) {
  float3 d = p - frame.origin;
  return float3(dot(d, frame.axis_x), dot(d, frame.axis_y), dot(d, frame.axis_z));
}

// The cone of surfgrad_cone_decal for the point q in the decal's frame; dx_dx is the derivative of q.x by the
// position along axis_x (0 where a wedge's apex follows the point).
SurfgradDecalProjection surfgrad_detail_cone_projection(SurfgradDecalFrame frame, float3 q, float dx_dx,
                                                        float tan_half_angle, float range, float fade,
                                                        int gradient) {
  float radius = tan_half_angle * q.z;
  float across = length(q.xy);
  bool inside = SURFGRAD_LEAST < radius && SURFGRAD_LEAST < q.z && q.z < range && across < radius;
  if (!inside) {
    return (SurfgradDecalProjection)0;
  }
  // d(x/z) = (dx - (x/z) dz) / z
  float inverse_z = surfgrad_reciprocal_or_zero(q.z);
  float3 along_s = dx_dx * frame.axis_x - (q.x * inverse_z) * frame.axis_z;
  float3 along_t = frame.axis_y - (q.y * inverse_z) * frame.axis_z;
  // The image is 2 * radius wide at this depth.
  float inverse_radius = surfgrad_reciprocal_or_zero(radius);
  float per_unit = 0.5 * inverse_radius;
  bool exact = gradient == SURFGRAD_CONE_GRADIENT_EXACT;
  float falloff = surfgrad_detail_edge_falloff(across * inverse_radius, fade) *
                  surfgrad_detail_edge_falloff(q.z * surfgrad_reciprocal_or_zero(range), fade);
  SurfgradDecalProjection result = {0.5 + per_unit * q.xy,
                                    per_unit * along_s,
                                    per_unit * along_t,
                                    exact ? along_s : dx_dx * frame.axis_x,
                                    exact ? along_t : frame.axis_y,
                                    falloff,
                                    true};
  return result;
}

SurfgradDecalDirection surfgrad_detail_sphere_direction(SurfgradDecalFrame frame, float3 q, float3 unchanging,
                                                        float radius, float fade) {
  float distance = length(q);
  if (!(distance < radius)) {
    return (SurfgradDecalDirection)0;
  }
  float3 lookup = surfgrad_normalize_or_zero(q);
  SurfgradDecalDirection result = {
      lookup.x * frame.axis_x + lookup.y * frame.axis_y + lookup.z * frame.axis_z, lookup, unchanging,
      surfgrad_detail_edge_falloff(distance * surfgrad_reciprocal_or_zero(radius), fade), true};
  return result;
}

// Box: parallel projection along axis_z.
//
// p           point, in the space of the frame
// half_size   half the edges along the axes, positive; the image covers the xy face
// fade        fraction of the half edges over which the influence fades, in [0, 1]; 0 is a hard edge
// degenerate  a size that is not positive: outside
// source      Mikkelsen 2019, section 2.9
SurfgradDecalProjection surfgrad_box_decal(SurfgradDecalFrame frame, float3 p, float3 half_size, float fade) {
  float3 q = surfgrad_detail_to_decal(frame, p);
  if (!all(abs(q) < half_size)) {
    return (SurfgradDecalProjection)0;
  }
  float3 per_half = float3(surfgrad_reciprocal_or_zero(half_size.x), surfgrad_reciprocal_or_zero(half_size.y),
                           surfgrad_reciprocal_or_zero(half_size.z));
  float3 e = abs(q) * per_half;
  float falloff = surfgrad_detail_edge_falloff(e.x, fade) * surfgrad_detail_edge_falloff(e.y, fade) *
                  surfgrad_detail_edge_falloff(e.z, fade);
  SurfgradDecalProjection result = {0.5 + 0.5 * per_half.xy * q.xy,
                                    (0.5 * per_half.x) * frame.axis_x,
                                    (0.5 * per_half.y) * frame.axis_y,
                                    frame.axis_x,
                                    frame.axis_y,
                                    falloff,
                                    true};
  return result;
}

// Cone: perspective projection from the apex at the frame's origin along +axis_z.
//
// tan_half_angle  radius of the cone at distance 1, positive; the image encloses the circle
// range           length along axis_z, positive
// fade            fraction of the radius, and of the range at its far end, over which the influence fades
// gradient        SURFGRAD_CONE_GRADIENT_*: which axis_s, axis_t to give; grad_s and grad_t are exact in both
// degenerate      the apex and behind it, sizes that are not positive: outside
// source          Mikkelsen 2019, section 2.9, with the gradient of (x/z, y/z)
SurfgradDecalProjection surfgrad_cone_decal(SurfgradDecalFrame frame, float3 p, float tan_half_angle,
                                            float range, float fade, int gradient) {
  return surfgrad_detail_cone_projection(frame, surfgrad_detail_to_decal(frame, p), 1.0, tan_half_angle,
                                         range, fade, gradient);
}
SurfgradDecalProjection surfgrad_cone_decal(SurfgradDecalFrame frame, float3 p, float tan_half_angle,
                                            float range, float fade) {
  return surfgrad_cone_decal(frame, p, tan_half_angle, range, fade, SURFGRAD_CONE_GRADIENT_EXACT);
}

// Wedge: a cone whose apex slides along a segment of axis_x, centred on the origin, to stay beside the point.
// Between the segment's ends s = 1/2 and grad_s, axis_s are zero; beyond them lie the two halves of a cone.
//
// half_length  half the segment's length, not negative; 0 is the cone
SurfgradDecalProjection surfgrad_wedge_decal(SurfgradDecalFrame frame, float3 p, float half_length,
                                             float tan_half_angle, float range, float fade, int gradient) {
  float3 q = surfgrad_detail_to_decal(frame, p);
  float dx_dx = abs(q.x) < half_length ? 0.0 : 1.0;
  q.x -= max(-half_length, min(q.x, half_length));
  return surfgrad_detail_cone_projection(frame, q, dx_dx, tan_half_angle, range, fade, gradient);
}
SurfgradDecalProjection surfgrad_wedge_decal(SurfgradDecalFrame frame, float3 p, float half_length,
                                             float tan_half_angle, float range, float fade) {
  return surfgrad_wedge_decal(frame, p, half_length, tan_half_angle, range, fade,
                              SURFGRAD_CONE_GRADIENT_EXACT);
}

// Sphere: a cube map of normals seen from its centre.
//
// returns     direction from the centre: sample the cube map at lookup, bring the normal into the space of
//             the positions, then surfgrad_decal_gradient_from_normal
// degenerate  the centre has no direction: zero, hence no bump; a radius that is not positive: outside
// source      Mikkelsen 2019, sections 2.4 and 2.9
SurfgradDecalDirection surfgrad_sphere_decal(SurfgradDecalFrame frame, float3 p, float radius, float fade) {
  return surfgrad_detail_sphere_direction(frame, surfgrad_detail_to_decal(frame, p), float3(0.0, 0.0, 0.0),
                                          radius, fade);
}

// Capsule: a sphere whose centre slides along a segment of axis_x, centred on the origin, to stay beside the
// point. Between the segment's ends unchanging is axis_x.
//
// half_length  half the segment's length, not negative; 0 is the sphere
SurfgradDecalDirection surfgrad_capsule_decal(SurfgradDecalFrame frame, float3 p, float half_length,
                                              float radius, float fade) {
  float3 q = surfgrad_detail_to_decal(frame, p);
  float3 unchanging = (abs(q.x) < half_length ? 1.0 : 0.0) * frame.axis_x;
  q.x -= max(-half_length, min(q.x, half_length));
  return surfgrad_detail_sphere_direction(frame, q, unchanging, radius, fade);
}

// Volume gradient of a sphere or capsule with a map of normals.
//
// v           perturbed normal sampled at decal.lookup, in the space of the positions, of any length
// degenerate  no direction: zero. Else as surfgrad_from_perturbed_normal
// source      Mikkelsen 2019, listing 7 and section 2.9
float3 surfgrad_decal_gradient_from_normal(SurfgradDecalDirection decal, float3 v) {
  float3 g = surfgrad_from_perturbed_normal(decal.direction, v);
  return surfgrad_max_abs(decal.direction) == 0.0 ? 0.0 : g - dot(g, decal.unchanging) * decal.unchanging;
}

// Triplanar and planar projection -------------------------------------------------------------------------

static const int SURFGRAD_HANDEDNESS_LEFT = 0;
static const int SURFGRAD_HANDEDNESS_RIGHT = 1;
static const int SURFGRAD_TEXTURE_ORIGIN_LOWER_LEFT = 0;
static const int SURFGRAD_TEXTURE_ORIGIN_UPPER_LEFT = 1;
static const int SURFGRAD_TRIPLANAR_PLANES_MIKKELSEN =
    0; // x-plane (z, y), y-plane (x, z), z-plane (x, y): listing 13
static const int SURFGRAD_TRIPLANAR_PLANES_GOLUBEV =
    1; // x-plane (y, z), y-plane (z, x), z-plane (x, y): equation 46
static const int SURFGRAD_PLANE_AXIS_X = 0;
static const int SURFGRAD_PLANE_AXIS_Y = 1;
static const int SURFGRAD_PLANE_AXIS_Z = 2;

// One value gives coordinates and gradients, so that they cannot disagree. Right-handed spaces sample the x-
// and y-planes of listing 13 at -z; upper-left textures are sampled at -t.
struct SurfgradTriplanarConvention {
  int handedness, origin, planes;
};

// That of listing 13: left-handed, lower-left origin.
static const SurfgradTriplanarConvention SURFGRAD_LISTING_13 = {
    SURFGRAD_HANDEDNESS_LEFT, SURFGRAD_TEXTURE_ORIGIN_LOWER_LEFT, SURFGRAD_TRIPLANAR_PLANES_MIKKELSEN};

// Texture coordinates of the three planes at one point.
struct SurfgradTriplanarCoordinates {
  float2 x_plane, y_plane, z_plane;
};

// -1 where the convention negates z (x) or the second texture coordinate (y).
float2 surfgrad_detail_signs(SurfgradTriplanarConvention c) {
  bool negate_z =
      c.planes == SURFGRAD_TRIPLANAR_PLANES_MIKKELSEN && c.handedness == SURFGRAD_HANDEDNESS_RIGHT;
  return float2(negate_z ? -1.0 : 1.0, c.origin == SURFGRAD_TEXTURE_ORIGIN_UPPER_LEFT ? -1.0 : 1.0);
}

// Blend weights from the base normal: max(0, |n| - 0.2)^k, normalised.
//
// normal      unit base normal
// k           sharpness, positive; 3 in the listing
// degenerate  zero normal gives 1/3 each. The largest term is divided out before a power that could
//             underflow: any but the third, which is a product as well and by far cheaper
// source      Mikkelsen 2019, listing 14
float3 surfgrad_triplanar_weights(float3 normal, float k) {
  float3 w = saturate(abs(normal) - 0.2); // below 1 for any unit normal: hardware saturates for nothing
  float3 p = w * w * w;
  if (k != 3.0) {
    w *= surfgrad_reciprocal_or_zero(surfgrad_max_abs(w));
    p = float3(surfgrad_pow(w.x, k), surfgrad_pow(w.y, k), surfgrad_pow(w.z, k));
  }
  float sum = p.x + p.y + p.z;
  return sum == 0.0 ? float3(1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0) : p / sum;
}
float3 surfgrad_triplanar_weights(float3 normal) { return surfgrad_triplanar_weights(normal, 3.0); }

// Texture coordinates that a convention samples at position p (in texture units).
//
// source  Mikkelsen 2019, section 2.8; Golubev, equation 46
SurfgradTriplanarCoordinates surfgrad_triplanar_coordinates(float3 p,
                                                            SurfgradTriplanarConvention convention) {
  float2 sign = surfgrad_detail_signs(convention);
  float2 st = float2(1.0, sign.y);
  if (convention.planes == SURFGRAD_TRIPLANAR_PLANES_GOLUBEV) {
    SurfgradTriplanarCoordinates result = {st * p.yz, st * p.zx, st * p.xy};
    return result;
  }
  float z = sign.x * p.z;
  SurfgradTriplanarCoordinates result = {st * float2(z, p.y), st * float2(p.x, z), st * p.xy};
  return result;
}
SurfgradTriplanarCoordinates surfgrad_triplanar_coordinates(float3 p) {
  return surfgrad_triplanar_coordinates(p, SURFGRAD_LISTING_13);
}

// Volume gradient of one planar projection along an axis (SURFGRAD_PLANE_AXIS_*): no normal needed.
//
// deriv    (dh/ds, dh/dt) sampled at that plane's coordinate of surfgrad_triplanar_coordinates
// returns  gradient with respect to the position; the component along the axis is zero
// source   Mikkelsen 2019, section 2.8; Golubev, equations 44, 50
float3 surfgrad_planar_gradient(int axis, float2 deriv, SurfgradTriplanarConvention convention) {
  float2 sign = surfgrad_detail_signs(convention);
  float2 d = float2(deriv.x, sign.y * deriv.y);
  float2 of_z = sign.x * d;
  if (axis == SURFGRAD_PLANE_AXIS_Z) return float3(d, 0.0);
  if (convention.planes == SURFGRAD_TRIPLANAR_PLANES_GOLUBEV) {
    return axis == SURFGRAD_PLANE_AXIS_X ? float3(0.0, d) : float3(d.y, 0.0, d.x);
  }
  return axis == SURFGRAD_PLANE_AXIS_X ? float3(0.0, d.y, of_z.x) : float3(d.x, 0.0, of_z.y);
}
float3 surfgrad_planar_gradient(int axis, float2 deriv) {
  return surfgrad_planar_gradient(axis, deriv, SURFGRAD_LISTING_13);
}

// Volume gradient of a triplanar projection: no normal needed.
//
// weights  surfgrad_triplanar_weights
// deriv_*  derivatives sampled at surfgrad_triplanar_coordinates(p, convention)
// returns  gradient with respect to p; multiply by the texture's frequency for that of the position
// source   Mikkelsen 2019, listing 13; Golubev, equation 49
float3 surfgrad_triplanar_gradient(float3 weights, float2 deriv_x, float2 deriv_y, float2 deriv_z,
                                   SurfgradTriplanarConvention convention) {
  return weights.x * surfgrad_planar_gradient(SURFGRAD_PLANE_AXIS_X, deriv_x, convention) +
         weights.y * surfgrad_planar_gradient(SURFGRAD_PLANE_AXIS_Y, deriv_y, convention) +
         weights.z * surfgrad_planar_gradient(SURFGRAD_PLANE_AXIS_Z, deriv_z, convention);
}
float3 surfgrad_triplanar_gradient(float3 weights, float2 deriv_x, float2 deriv_y, float2 deriv_z) {
  return surfgrad_triplanar_gradient(weights, deriv_x, deriv_y, deriv_z, SURFGRAD_LISTING_13);
}

// Surface gradient of a triplanar projection.
//
// normal  unit base normal: the interpolated one, or a resolved one in a later pass
// source  Mikkelsen 2019, listing 13
float3 surfgrad_from_triplanar(float3 normal, float3 weights, float2 deriv_x, float2 deriv_y, float2 deriv_z,
                               SurfgradTriplanarConvention convention) {
  return surfgrad_from_volume_gradient(
      normal, surfgrad_triplanar_gradient(weights, deriv_x, deriv_y, deriv_z, convention));
}
float3 surfgrad_from_triplanar(float3 normal, float3 weights, float2 deriv_x, float2 deriv_y,
                               float2 deriv_z) {
  return surfgrad_from_triplanar(normal, weights, deriv_x, deriv_y, deriv_z, SURFGRAD_LISTING_13);
}

// Noise ---------------------------------------------------------------------------------------------------
//
// Functions of space with exact gradients, for surfgrad_from_volume_gradient. Sampling at frequency * p
// multiplies the gradient by frequency. Integer hashes: the same pattern on every machine and in C++.

// Coordinates of noise beyond this magnitude are taken as this.
static const int SURFGRAD_NOISE_EXTENT = 536870912;

// A function of space at one point.
struct SurfgradNoise {
  float value;
  float3 gradient; // derivatives of the value by the coordinates of the sampling point
};

// The odd multipliers by which the hash sums a cell's indices: a neighbour's sum is one addition away.
static const uint SURFGRAD_DETAIL_LATTICE_X = 0x5cdbcce3u;
static const uint SURFGRAD_DETAIL_LATTICE_Y = 0x456e33c9u;
static const uint SURFGRAD_DETAIL_LATTICE_Z = 0xe1392b77u;

// What the noises over a moved lattice start from at a cell (indices modulo 2^32): added to its own hash, it
// makes noise sampled near that cell exact however far away the cell is.
uint surfgrad_lattice_start(uint x, uint y, uint z) {
  return x * SURFGRAD_DETAIL_LATTICE_X + y * SURFGRAD_DETAIL_LATTICE_Y + z * SURFGRAD_DETAIL_LATTICE_Z;
}

uint surfgrad_detail_finalised(uint h) {
  h = (h ^ (h >> 16u)) * 0x7feb352du;
  h = (h ^ (h >> 15u)) * 0x846ca68bu;
  return h ^ (h >> 16u);
}

uint surfgrad_detail_lattice_sum(int3 cell) {
  return surfgrad_lattice_start(uint(cell.x), uint(cell.y), uint(cell.z));
}

// 32 well mixed bits for a point of the integer lattice.
//
// source  own sum of the indices; finaliser: C. Wellons, lowbias32
uint surfgrad_lattice_hash(int x, int y, int z) {
  return surfgrad_detail_finalised(surfgrad_detail_lattice_sum(int3(x, y, z)));
}

// `count` bits from position `first` up, as a number.
float surfgrad_detail_bit_field(uint word, uint first, uint count) {
  return float((word << (32u - first - count)) >> (32u - count));
}

float3 surfgrad_detail_saturate_to_lattice(float3 p) {
  float extent = float(SURFGRAD_NOISE_EXTENT);
  return clamp(p, -extent, extent);
}

// One of the 12 directions to the edges of a cube, four of them twice: chosen by the low four bits.
float3 surfgrad_detail_edge_direction(uint hash) {
  uint choice = hash & 15u;
  float first = (hash & 1u) == 0u ? 1.0 : -1.0;
  float second = (hash & 2u) == 0u ? 1.0 : -1.0;
  // `first` belongs to x or y, `second` to y, x or z.
  bool first_is_x = choice < 8u;
  bool second_is_y = choice < 4u;
  bool second_is_x = choice == 12u || choice == 14u;
  return float3(first_is_x ? first : (second_is_x ? second : 0.0),
                first_is_x ? (second_is_y ? second : 0.0) : first, second_is_y || second_is_x ? 0.0 : second);
}

SurfgradNoise surfgrad_detail_mix(SurfgradNoise a, SurfgradNoise b, float weight) {
  SurfgradNoise result = {a.value + weight * (b.value - a.value),
                          a.gradient + weight * (b.gradient - a.gradient)};
  return result;
}

// sum: of the corner's indices, finalised to its hash.
SurfgradNoise surfgrad_detail_perlin_corner(uint sum, float3 offset) {
  float3 direction = surfgrad_detail_edge_direction(surfgrad_detail_finalised(sum));
  SurfgradNoise result = {dot(direction, offset), direction};
  return result;
}

float surfgrad_detail_fade(float t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }
float surfgrad_detail_fade_slope(float t) { return 30.0 * t * t * (t - 1.0) * (t - 1.0); }

// Mixed along x. The weight depends on one coordinate: its slope adds to that component only.
SurfgradNoise surfgrad_detail_perlin_edge(uint sum, float3 offset) {
  SurfgradNoise low = surfgrad_detail_perlin_corner(sum, offset);
  SurfgradNoise high =
      surfgrad_detail_perlin_corner(sum + SURFGRAD_DETAIL_LATTICE_X, offset - float3(1.0, 0.0, 0.0));
  SurfgradNoise n = surfgrad_detail_mix(low, high, surfgrad_detail_fade(offset.x));
  n.gradient.x += surfgrad_detail_fade_slope(offset.x) * (high.value - low.value);
  return n;
}

// Mixed along x and y.
SurfgradNoise surfgrad_detail_perlin_face(uint sum, float3 offset) {
  SurfgradNoise low = surfgrad_detail_perlin_edge(sum, offset);
  SurfgradNoise high =
      surfgrad_detail_perlin_edge(sum + SURFGRAD_DETAIL_LATTICE_Y, offset - float3(0.0, 1.0, 0.0));
  SurfgradNoise n = surfgrad_detail_mix(low, high, surfgrad_detail_fade(offset.y));
  n.gradient.y += surfgrad_detail_fade_slope(offset.y) * (high.value - low.value);
  return n;
}

// Perlin's gradient noise of 2002, over a lattice moved by `start` (surfgrad_lattice_start).
//
// p           sampling point, cell size 1
// returns     value and exact gradient; 0 at lattice points. |value| <= 1.0364, |gradient| <= 3.75
// degenerate  coordinates beyond +-SURFGRAD_NOISE_EXTENT are taken as that
// source      Perlin 2002: fade 6t^5 - 15t^4 + 10t^3, 12 directions
SurfgradNoise surfgrad_perlin(float3 p, uint start) {
  float3 q = surfgrad_detail_saturate_to_lattice(p);
  float3 low_corner = floor(q);
  float3 offset = q - low_corner;
  uint sum = surfgrad_detail_lattice_sum(int3(low_corner)) + start;
  SurfgradNoise low = surfgrad_detail_perlin_face(sum, offset);
  SurfgradNoise high =
      surfgrad_detail_perlin_face(sum + SURFGRAD_DETAIL_LATTICE_Z, offset - float3(0.0, 0.0, 1.0));
  SurfgradNoise n = surfgrad_detail_mix(low, high, surfgrad_detail_fade(offset.z));
  n.gradient.z += surfgrad_detail_fade_slope(offset.z) * (high.value - low.value);
  return n;
}
SurfgradNoise surfgrad_perlin(float3 p) { return surfgrad_perlin(p, 0u); }

// What a corner of a simplex adds to the noise at the distance r from it.
SurfgradNoise surfgrad_detail_simplex_corner(uint sum, float3 r) {
  float3 direction = surfgrad_detail_edge_direction(surfgrad_detail_finalised(sum));
  float ramp = dot(direction, r);
  float t = max(0.5 - dot(r, r), 0.0);
  float t2 = t * t;
  float falloff = t2 * t2;
  SurfgradNoise result = {falloff * ramp, falloff * direction - (8.0 * t2 * t * ramp) * r};
  return result;
}

// Gradient noise over the simplicial lattice: 4 corners instead of 8.
//
// start       of the skewed lattice: where p moves by integers x, y, z whose sum is 3 n, its indices move by
//             x + n, y + n, z + n
// returns     value and exact gradient; |value| <= 1, |gradient| <= 6.97
// degenerate  coordinates beyond +-SURFGRAD_NOISE_EXTENT are taken as that
// source      Perlin 2001, with the 12 directions of Perlin 2002 and falloffs that end within the simplices
SurfgradNoise surfgrad_simplex(float3 p, uint start) {
  const float sixth = 1.0 / 6.0;
  // The inverse of the largest sum of corner contributions, 0.01300716, rounded down.
  const float scale = 76.88;
  float3 q = surfgrad_detail_saturate_to_lattice(p);
  float3 cell = floor(q + (q.x + q.y + q.z) * (1.0 / 3.0));
  float3 d = q - (cell - (cell.x + cell.y + cell.z) * sixth);
  uint sum = surfgrad_detail_lattice_sum(int3(cell)) + start;
  // From the first corner along the axis of the largest component, then the middle, then the least.
  bool x_from_y = !(d.x < d.y);
  bool x_from_z = !(d.x < d.z);
  bool y_from_z = !(d.y < d.z);
  int3 one = int3(x_from_y && x_from_z, !x_from_y && y_from_z, !x_from_z && !y_from_z);
  int3 two = int3(x_from_y || x_from_z, !x_from_y || y_from_z, !x_from_z || !y_from_z);
  SurfgradNoise a = surfgrad_detail_simplex_corner(sum, d);
  SurfgradNoise b =
      surfgrad_detail_simplex_corner(sum + surfgrad_detail_lattice_sum(one), d - float3(one) + sixth);
  SurfgradNoise c =
      surfgrad_detail_simplex_corner(sum + surfgrad_detail_lattice_sum(two), d - float3(two) + 2.0 * sixth);
  SurfgradNoise e =
      surfgrad_detail_simplex_corner(sum + surfgrad_detail_lattice_sum(int3(1, 1, 1)), d - 1.0 + 0.5);
  SurfgradNoise result = {scale * (a.value + b.value + c.value + e.value),
                          scale * (a.gradient + b.gradient + c.gradient + e.gradient)};
  return result;
}
SurfgradNoise surfgrad_simplex(float3 p) { return surfgrad_simplex(p, 0u); }

static const int SURFGRAD_WORLEY_KIND_F1 = 0; // distance to the nearest feature point
static const int SURFGRAD_WORLEY_KIND_F2_MINUS_F1 =
    1; // excess of that to the second nearest: 0 on cells' borders

// Worley's cellular noise with one feature point a unit cell, over a lattice moved by `start`.
//
// kind        SURFGRAD_WORLEY_KIND_*
// returns     value in [0, 1] and exact gradient. Distances count as 1 from 1 on, where their gradient is
//             zero
// kinks       the gradient of one side is given; zero at a feature point
// degenerate  coordinates beyond +-SURFGRAD_NOISE_EXTENT are taken as that
// source      Worley 1996; feature points at multiples of 1/1024 from 10 bits of surfgrad_lattice_hash an
//             axis
SurfgradNoise surfgrad_worley(float3 p, int kind, uint start) {
  float3 q = surfgrad_detail_saturate_to_lattice(p);
  float3 low_corner = floor(q);
  float3 fraction = q - low_corner;
  uint sum = surfgrad_detail_lattice_sum(int3(low_corner)) + start;
  // Squared distances, and offsets from the feature points to p. Starting at the cap leaves the zero offset,
  // hence no gradient, where nothing is nearer.
  float nearest = 1.0;
  float second = 1.0;
  float3 from_nearest = float3(0.0, 0.0, 0.0);
  float3 from_second = float3(0.0, 0.0, 0.0);
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        int3 neighbour = int3(x, y, z);
        uint h = surfgrad_detail_finalised(sum + surfgrad_detail_lattice_sum(neighbour));
        float3 bits = float3(surfgrad_detail_bit_field(h, 0u, 10u), surfgrad_detail_bit_field(h, 10u, 10u),
                             surfgrad_detail_bit_field(h, 20u, 10u));
        float3 feature = (float3(neighbour) + 0.5 / 1024.0) + bits * (1.0 / 1024.0);
        float3 offset = fraction - feature;
        float squared = dot(offset, offset);
        if (squared < nearest) {
          second = nearest;
          from_second = from_nearest;
          nearest = squared;
          from_nearest = offset;
        } else if (squared < second) {
          second = squared;
          from_second = offset;
        }
      }
    }
  }
  float f1 = sqrt(nearest);
  float3 f1_gradient = surfgrad_reciprocal_or_zero(f1) * from_nearest;
  if (kind == SURFGRAD_WORLEY_KIND_F1) {
    SurfgradNoise result = {f1, f1_gradient};
    return result;
  }
  float f2 = sqrt(second);
  SurfgradNoise result = {f2 - f1, surfgrad_reciprocal_or_zero(f2) * from_second - f1_gradient};
  return result;
}
SurfgradNoise surfgrad_worley(float3 p, int kind) { return surfgrad_worley(p, kind, 0u); }
SurfgradNoise surfgrad_worley(float3 p) { return surfgrad_worley(p, SURFGRAD_WORLEY_KIND_F1, 0u); }

// A noise raised to a power: sharpens dents, g(x) = x^k.
//
// degenerate  where the value is not positive: zero, with zero gradient
// source      Mikkelsen 2019, section 4 (after Gritz)
SurfgradNoise surfgrad_power(SurfgradNoise noise, float k) {
  float less = surfgrad_pow(noise.value, k - 1.0);
  // The slope saturates before it meets a zero component, which infinity would turn into NaN.
  float slope = surfgrad_saturated(k * less);
  SurfgradNoise result = {surfgrad_saturated(noise.value * less), surfgrad_saturated(slope * noise.gradient)};
  return result;
}

float surfgrad_detail_difference_quotient(float change, float run) {
  return change * surfgrad_reciprocal_or_zero(run);
}

// Gradient of a function that only gives values, by central differences.
//
// step       distance to each side: about eps^(1/3) times the scale of the function's detail
// high, low  its values at p + step and p - step, along x, y and z
// source     Gustavson
float3 surfgrad_gradient_by_differences(float3 p, float step, float3 high, float3 low) {
  precise float3 run = (p + step) - (p - step); // what rounding left of the wanted steps
  return float3(surfgrad_detail_difference_quotient(high.x - low.x, run.x),
                surfgrad_detail_difference_quotient(high.y - low.y, run.y),
                surfgrad_detail_difference_quotient(high.z - low.z, run.z));
}

// The same from 3 values beside the known one at p (forward differences).
//
// step    about sqrt(eps) times the scale of the function's detail
// source  Gustavson
float3 surfgrad_gradient_by_forward_differences(float3 p, float step, float3 high, float value) {
  precise float3 run = (p + step) - p;
  return float3(surfgrad_detail_difference_quotient(high.x - value, run.x),
                surfgrad_detail_difference_quotient(high.y - value, run.y),
                surfgrad_detail_difference_quotient(high.z - value, run.z));
}

// Both for a function float F(float3).
#define SURFGRAD_GRADIENT_BY_DIFFERENCES(F, p, step)                                                         \
  surfgrad_gradient_by_differences(                                                                          \
      p, step,                                                                                               \
      float3(F((p) + float3(step, 0, 0)), F((p) + float3(0, step, 0)), F((p) + float3(0, 0, step))),         \
      float3(F((p)-float3(step, 0, 0)), F((p)-float3(0, step, 0)), F((p)-float3(0, 0, step))))
#define SURFGRAD_GRADIENT_BY_FORWARD_DIFFERENCES(F, p, value, step)                                          \
  surfgrad_gradient_by_forward_differences(                                                                  \
      p, step,                                                                                               \
      float3(F((p) + float3(step, 0, 0)), F((p) + float3(0, step, 0)), F((p) + float3(0, 0, step))), value)

// Sums of octaves -----------------------------------------------------------------------------------------

// Octave i samples the basis at frequency lacunarity^i with amplitude gain^i.
struct SurfgradFractal {
  int octaves;      // 4 in the core's default
  float lacunarity; // positive; 2. A value near 2 hides the lattice, exactly 2 lets its points coincide
  float gain;       // 0.5
};

// The noise that a sum is made of.
static const int SURFGRAD_BASIS_PERLIN = 0;
static const int SURFGRAD_BASIS_SIMPLEX = 1;
static const int SURFGRAD_BASIS_WORLEY_F1 = 2;
static const int SURFGRAD_BASIS_WORLEY_F2_MINUS_F1 = 3;

// A basis at a point. A constant basis costs nothing else than its noise.
SurfgradNoise surfgrad_basis_noise(float3 p, int basis, uint start) {
  if (basis == SURFGRAD_BASIS_PERLIN) return surfgrad_perlin(p, start);
  if (basis == SURFGRAD_BASIS_SIMPLEX) return surfgrad_simplex(p, start);
  return surfgrad_worley(
      p, basis == SURFGRAD_BASIS_WORLEY_F1 ? SURFGRAD_WORLEY_KIND_F1 : SURFGRAD_WORLEY_KIND_F2_MINUS_F1,
      start);
}

// What remains of an octave: 1 - smoothstep(0.25, 0.75, cells per pixel). From 3/4 of a cell a pixel on the
// octave would only alias.
float surfgrad_octave_visibility(float cells_per_pixel) {
  float t = min(max(2.0 * cells_per_pixel - 0.5, 0.0), 1.0);
  return 1.0 - t * t * (3.0 - 2.0 * t);
}

// The term that an octave of turbulence, or of ridges, adds for a basis' noise.
SurfgradNoise surfgrad_turbulence_octave(SurfgradNoise n) {
  SurfgradNoise result = {abs(n.value), (n.value < 0.0 ? -1.0 : 1.0) * n.gradient};
  return result;
}
SurfgradNoise surfgrad_ridged_octave(SurfgradNoise n) {
  float crest = 1.0 - abs(n.value);
  SurfgradNoise result = {crest * crest, ((n.value < 0.0 ? 2.0 : -2.0) * crest) * n.gradient};
  return result;
}

// A sum of octaves and one more, sampled at frequency * p: for a basis of one's own.
//
//   for (int i = 0; i < octaves; ++i) {
//     sum = surfgrad_add_octave(sum, my_noise(frequency * p), frequency, amplitude, width);
//     frequency *= lacunarity;
//     amplitude *= gain;
//   }
SurfgradNoise surfgrad_add_octave(SurfgradNoise sum, SurfgradNoise octave, float frequency, float amplitude,
                                  float width) {
  float weight = amplitude * surfgrad_octave_visibility(frequency * width);
  SurfgradNoise result = {sum.value + weight * octave.value,
                          sum.gradient + (weight * frequency) * octave.gradient};
  return result;
}

static const int SURFGRAD_DETAIL_SUM = 0;
static const int SURFGRAD_DETAIL_TURBULENCE = 1;
static const int SURFGRAD_DETAIL_RIDGED = 2;

SurfgradNoise surfgrad_detail_sum_octaves(float3 p, SurfgradFractal fractal, float width, int basis,
                                          int term) {
  SurfgradNoise sum = (SurfgradNoise)0;
  float frequency = 1.0;
  float amplitude = 1.0;
  // Past the extent even a point at distance 1 from the origin would leave the lattice.
  for (int i = 0; i < fractal.octaves && frequency < float(SURFGRAD_NOISE_EXTENT); ++i) {
    if (surfgrad_octave_visibility(frequency * width) > 0.0) {
      SurfgradNoise n = surfgrad_basis_noise(frequency * p, basis, 0u);
      if (term == SURFGRAD_DETAIL_TURBULENCE) n = surfgrad_turbulence_octave(n);
      if (term == SURFGRAD_DETAIL_RIDGED) n = surfgrad_ridged_octave(n);
      sum = surfgrad_add_octave(sum, n, frequency, amplitude, width);
    }
    frequency *= fractal.lacunarity;
    amplitude *= fractal.gain;
  }
  return sum;
}

// Fractal sum: sum of gain^i * basis(lacunarity^i * p).
//
// fractal  octaves <= 0 gives zero; octaves at SURFGRAD_NOISE_EXTENT cells a unit and above are left out
// width    size of a pixel in units of p: octaves fade out as their cells near it. 0 leaves all whole
// basis    SURFGRAD_BASIS_*
// returns  value, and the exact gradient of this filtered function for the given width
// source   Mikkelsen 2019, section 4; Perlin 1985
SurfgradNoise surfgrad_fractal_sum(float3 p, SurfgradFractal fractal, float width, int basis) {
  return surfgrad_detail_sum_octaves(p, fractal, width, basis, SURFGRAD_DETAIL_SUM);
}
SurfgradNoise surfgrad_fractal_sum(float3 p, SurfgradFractal fractal, float width) {
  return surfgrad_fractal_sum(p, fractal, width, SURFGRAD_BASIS_PERLIN);
}

// Turbulence: sum of gain^i * |basis(lacunarity^i * p)|.
//
// kinks   where an octave is 0: the gradient of the positive side
// source  Perlin 1985 (gain = 1 / lacunarity)
SurfgradNoise surfgrad_turbulence(float3 p, SurfgradFractal fractal, float width, int basis) {
  return surfgrad_detail_sum_octaves(p, fractal, width, basis, SURFGRAD_DETAIL_TURBULENCE);
}
SurfgradNoise surfgrad_turbulence(float3 p, SurfgradFractal fractal, float width) {
  return surfgrad_turbulence(p, fractal, width, SURFGRAD_BASIS_PERLIN);
}

// Ridges: sum of gain^i * (1 - |basis(lacunarity^i * p)|)^2, sharp crests where an octave is 0.
//
// source  Musgrave's ridged sum without its feedback between octaves
SurfgradNoise surfgrad_ridged(float3 p, SurfgradFractal fractal, float width, int basis) {
  return surfgrad_detail_sum_octaves(p, fractal, width, basis, SURFGRAD_DETAIL_RIDGED);
}
SurfgradNoise surfgrad_ridged(float3 p, SurfgradFractal fractal, float width) {
  return surfgrad_ridged(p, fractal, width, SURFGRAD_BASIS_PERLIN);
}

// Hex tiling ----------------------------------------------------------------------------------------------
//
// A map repeated without visible repetition, by blending three randomly shifted and turned copies of it.

// A vertex of the grid that coordinates are relative to: near it they are exact however far away it is.
struct SurfgradHexOrigin {
  uint start;   // surfgrad_lattice_start of its index (i, j, 0)
  float2 shift; // where it lies, whole periods left out
};

// The three tiles over a point.
struct SurfgradHexTiles {
  float2 st[3];       // where each tile samples the map
  float3 weight;      // barycentric coordinates in the triangle: within [0, 1], sum 1
  float2 rotation[3]; // cosine and sine of each tile's turn: st[i] turns by it as st moves
};

// v turned counter-clockwise: the screen derivatives of st as those of a tile's st[i].
//
// rotation  cosine and sine
float2 surfgrad_rotate(float2 v, float2 rotation) {
  return float2(rotation.x * v.x - rotation.y * v.y, rotation.y * v.x + rotation.x * v.y);
}

// The transpose of surfgrad_rotate: a derivative by a tile's st[i] as the derivative by st.
float2 surfgrad_rotate_back(float2 v, float2 rotation) {
  return float2(rotation.x * v.x + rotation.y * v.y, rotation.x * v.y - rotation.y * v.x);
}

struct SurfgradDetailHexTile {
  float2 st, rotation;
};

// The tile of a vertex. sum: of its indices; along: (i, j) from there to the point `place`.
SurfgradDetailHexTile surfgrad_detail_hex_tile(uint sum, float2 place, float side, float2 along,
                                               float strength, float2 period) {
  const float unit = 1.0 / 65536.0;
  float2 d =
      float2(side * (along.x + 0.5 * along.y), side * (0.86602540378443864676 * along.y)); // sqrt(3) / 2
  uint shift = surfgrad_detail_finalised(sum);
  uint turn = surfgrad_detail_finalised(sum + SURFGRAD_DETAIL_LATTICE_Z);
  SurfgradSinCos r =
      surfgrad_sin_cos_turns(strength * (unit * surfgrad_detail_bit_field(turn, 0u, 16u) - 0.5));
  // R d + centre = p + (R - 1) d: the centre is not needed, and without a turn p stays what it is.
  float2 offset = period * (unit * float2(surfgrad_detail_bit_field(shift, 0u, 16u),
                                          surfgrad_detail_bit_field(shift, 16u, 16u)));
  SurfgradDetailHexTile result = {place + surfgrad_rotate(d, float2(r.cos - 1.0, r.sin)) + offset,
                                  float2(r.cos, r.sin)};
  return result;
}

// The tiles over a texture coordinate.
//
// st          texture coordinate in which the tiles turn; the map must wrap around
// rotation    how far tiles are turned: 0 not at all, 1 by any angle
// edge        side of the triangles: a tile is 2 * edge across. 0.5 shows no point of the map twice in a tile
// period      of the map along each axis, positive; (1, 1), or the sides of an image that is not square in
//             units of the shorter
// origin      that st is relative to
// degenerate  st beyond +-SURFGRAD_NOISE_EXTENT * edge is taken as that. An edge outside [1e-12, 1e12] is 1
// source      Heitz and Neyret 2018, Mikkelsen 2022 (the method); own grid, hash and turn
SurfgradHexTiles surfgrad_hex_tiles(float2 st, float rotation, float edge, float2 period,
                                    SurfgradHexOrigin origin) {
  float side = edge >= 1e-12 && edge <= 1e12 ? edge : 1.0;
  float strength = min(max(rotation, 0.0), 1.0);
  float bound = side * float(SURFGRAD_NOISE_EXTENT);
  float2 p = clamp(st, -bound, bound);
  // The grid's vertices are side * (i * (1, 0) + j * (1/2, sqrt(3)/2)); p has these i and j.
  float2 q = (1.0 / side) * p;
  float2 ij = float2(q.x - 0.57735026918962576451 * q.y, 1.15470053837925152902 * q.y);
  float2 low = floor(ij);
  float2 f = ij - low;
  uint vertex = surfgrad_detail_lattice_sum(int3(low, 0)) + origin.start;
  // The diagonal from (1, 0) to (0, 1) divides a cell into two triangles.
  float sum = f.x + f.y;
  bool lower = sum < 1.0;
  float2 corner = lower ? 0.0 : 1.0;
  float2 place = p + origin.shift;
  SurfgradDetailHexTile a =
      surfgrad_detail_hex_tile(vertex + (lower ? 0u : SURFGRAD_DETAIL_LATTICE_X + SURFGRAD_DETAIL_LATTICE_Y),
                               place, side, f - corner, strength, period);
  SurfgradDetailHexTile b = surfgrad_detail_hex_tile(vertex + SURFGRAD_DETAIL_LATTICE_X, place, side,
                                                     f - float2(1.0, 0.0), strength, period);
  SurfgradDetailHexTile c = surfgrad_detail_hex_tile(vertex + SURFGRAD_DETAIL_LATTICE_Y, place, side,
                                                     f - float2(0.0, 1.0), strength, period);
  SurfgradHexTiles tiles;
  tiles.st[0] = a.st;
  tiles.st[1] = b.st;
  tiles.st[2] = c.st;
  tiles.weight = lower ? float3(1.0 - sum, f.x, f.y) : float3(sum - 1.0, 1.0 - f.y, 1.0 - f.x);
  tiles.rotation[0] = a.rotation;
  tiles.rotation[1] = b.rotation;
  tiles.rotation[2] = c.rotation;
  return tiles;
}
SurfgradHexTiles surfgrad_hex_tiles(float2 st, float rotation) {
  return surfgrad_hex_tiles(st, rotation, 0.5, float2(1.0, 1.0), (SurfgradHexOrigin)0);
}
SurfgradHexTiles surfgrad_hex_tiles(float2 st) { return surfgrad_hex_tiles(st, 1.0); }

// Weights for blending what the tiles show: w_i ~ weight_i^exponent * (1 + contrast * sine of the slope's
// angle).
//
// deriv     each tile's derivative, of any orientation: only its length counts
// exponent  taken into [1, 1000]; 7 confines the mixture to narrow borders
// contrast  taken into [0, 1000]; a vertical tile counts 1 + contrast times a flat one. 1.5; for values
//           without a slope use 0
// source    Mikkelsen 2022 (exponent, steeper tiles prevail); own formula
float3 surfgrad_hex_weights(SurfgradHexTiles tiles, float2 deriv[3], float exponent, float contrast) {
  float k = min(max(exponent, 1.0), 1000.0);
  float gain = min(max(contrast, 0.0), 1000.0);
  // Relative to the largest weight, at least 1/3: no power underflows to 0 / 0.
  float3 ratio = (1.0 / max(max(tiles.weight.x, tiles.weight.y), tiles.weight.z)) * tiles.weight;
  // Beyond 1e30 the sine is 1 to rounding.
  float3 square =
      min(float3(dot(deriv[0], deriv[0]), dot(deriv[1], deriv[1]), dot(deriv[2], deriv[2])), 1e30);
  float3 w = float3(surfgrad_pow(ratio.x, k), surfgrad_pow(ratio.y, k), surfgrad_pow(ratio.z, k)) *
             (1.0 + gain * sqrt(square / (1.0 + square)));
  return (1.0 / (w.x + w.y + w.z)) * w;
}
float3 surfgrad_hex_weights(SurfgradHexTiles tiles, float2 deriv[3]) {
  return surfgrad_hex_weights(tiles, deriv, 7.0, 1.5);
}

// The tiled map's derivative by st: the tiles' derivatives turned back and blended.
//
// weights  from surfgrad_hex_weights
// deriv    derivative by st[i] that each tile samples
float2 surfgrad_hex_derivative(SurfgradHexTiles tiles, float3 weights, float2 deriv[3]) {
  return weights.x * surfgrad_rotate_back(deriv[0], tiles.rotation[0]) +
         weights.y * surfgrad_rotate_back(deriv[1], tiles.rotation[1]) +
         weights.z * surfgrad_rotate_back(deriv[2], tiles.rotation[2]);
}

// Lost detail as roughness --------------------------------------------------------------------------------

// First and second moments of a slope (dh/ds, dh/dt). Average them component by component.
struct SurfgradSlopeMoments {
  float2 mean;   // E[dh/ds], E[dh/dt]
  float2 square; // E[(dh/ds)^2], E[(dh/dt)^2]
  float product; // E[(dh/ds) (dh/dt)]
};

// Moments of a single slope: the start of all averages.
//
// source  own; the moments of Olano and Baker 2010, "LEAN Mapping", without their scale
SurfgradSlopeMoments surfgrad_moments_from_derivative(float2 d) {
  SurfgradSlopeMoments result = {d, d * d, d.x * d.y};
  return result;
}

// Roughness of a footprint whose slopes have these moments, shaded with the normal of their mean:
// sqrt(alpha^2 + var(dh/ds) + var(dh/dt)), at most 1.
//
// alpha   roughness of the surface between the bumps, in [0, 1]: that of GGX or Beckmann
// m       averaged moments; a bump scale multiplies the mean, and its square the others
// source  own; Beckmann slope statistics as in Olano and Baker 2010, equation 3, its trace alone
float surfgrad_roughness_from_moments(float alpha, SurfgradSlopeMoments m) {
  float2 variance = max(m.square - m.mean * m.mean, 0.0);
  return min(sqrt(alpha * alpha + (variance.x + variance.y)), 1.0);
}

// Derivatives across pixels, in pixel shaders ------------------------------------------------------------

#ifdef SURFGRAD_FRAGMENT

// surfgrad_make_frame with the position's own derivatives (fine: coarse ones make blocks of 2x2 pixels).
SurfgradFrame surfgrad_make_frame_at(float3 position, float3 normal) {
  return surfgrad_make_frame(normal, ddx_fine(position), ddy_fine(position));
}
SurfgradFrame surfgrad_make_frame_at(float3 position, float3 normal, bool front_facing, int back_faces) {
  return surfgrad_make_frame(normal, ddx_fine(position), ddy_fine(position), front_facing, back_faces);
}

// surfgrad_tangent_basis with the texture coordinate's own derivatives.
SurfgradTangentFrame surfgrad_tangent_basis_at(SurfgradFrame frame, float2 st) {
  return surfgrad_tangent_basis(frame, ddx_fine(st), ddy_fine(st));
}

#endif

#endif
