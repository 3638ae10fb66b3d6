// SPDX-License-Identifier: MIT
//
// Surface gradient based bump mapping: the functions of include/surfgrad in WGSL.
//
// One self-contained file, for any stage: join it to your source (WGSL has no #include), or import it where
// a loader such as Bevy's offers that. surfgrad_name is surfgrad::name of the C++ core; what a function means
// is said there at length and here in short.
//
//   let frame = surfgrad_make_frame_normal(normal);                             // interpolated normal
//   let tbn = surfgrad_mikktspace_basis(normal, tangent.xyz, tangent.w);
//   let slope = surfgrad_derivative_from_normal(2.0 * textureSample(map, linear_wrap, st).xyz - 1.0);
//   let n = surfgrad_resolve_normal(frame, surfgrad_from_tbn(slope, tbn.tangent, tbn.bitangent));
//
// Several maps on one texture coordinate: add their slopes, then call surfgrad_from_tbn once. Anything
// else: add the surface gradients, then resolve once. Nothing but vertex tangents:
// surfgrad_resolve_mikktspace.
//
// WGSL has no overloading and no default arguments: functions take all their arguments, and one that C++
// overloads has a suffix: _vec2, _vec3 for the type of its vector, else what it takes besides (_two_sided,
// _normal, _moved).
//
// Nothing here but the last section takes derivatives, so that everything may be called anywhere; the last
// section wants uniform control flow. In control flow that is not uniform take dpdx and dpdy before it, and
// sample with textureSampleGrad or textureSampleLevel.
//
// Conventions (docs/conventions.md)
//   texture origin  lower left, t up. Where it is upper left (t down), as in WebGPU, either sample 1 - t
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
//   matrices        times column vectors. A row of the C++ matrix is a row here: mat3x3f(a, b, c) takes
//                   columns
//   screen          derivatives per pixel; neither their rate nor which way y runs changes a result
//
// What differs from C++ (docs/shaders.md): numbers are float; what shading languages leave open (NaN, Inf,
// subnormal numbers) is left open here; directions are right for lengths from 1e-18 to 1e18, and shorter
// vectors count as zero; an operation may err by what the API allows it.

// Numbers and vectors -------------------------------------------------------------------------------------
//
// transpose, determinant, cross of vec3f, dot, length, sqrt, floor, abs, min, max and select are the
// language's own.

const SURFGRAD_EPSILON: f32 = 0x1p-23;       // from 1 to the next number
const SURFGRAD_LEAST: f32 = 0x1p-126;        // smallest normal number
const SURFGRAD_MOST: f32 = 0x1.fffffep+127; // largest number

// Signed area spanned by a and b.
fn surfgrad_cross(a: vec2f, b: vec2f) -> f32 { return a.x * b.y - a.y * b.x; }

// Matrix of the signed 2x2 minors: det(m) * transpose(inverse(m)), defined for singular m too.
fn surfgrad_cofactor(m: mat3x3f) -> mat3x3f {
  return mat3x3f(cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1]));
}

// Largest magnitude of a component: a length that needs no square root and cannot overflow.
fn surfgrad_max_abs_vec2(v: vec2f) -> f32 { return max(abs(v.x), abs(v.y)); }
fn surfgrad_max_abs(v: vec3f) -> f32 { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }

// 1 / a, or 0 where |a| is below the smallest normal number.
fn surfgrad_reciprocal_or_zero(a: f32) -> f32 { return select(1.0 / a, 0.0, abs(a) < SURFGRAD_LEAST); }

const SURFGRAD_DETAIL_SATURATED: f32 = 0x1.fffffep+123; // a sixteenth of SURFGRAD_MOST

// a within that magnitude, so that a few such numbers can be added.
fn surfgrad_saturated(a: f32) -> f32 {
  return clamp(a, -SURFGRAD_DETAIL_SATURATED, SURFGRAD_DETAIL_SATURATED);
}
fn surfgrad_saturated_vec2(v: vec2f) -> vec2f {
  return clamp(v, vec2f(-SURFGRAD_DETAIL_SATURATED), vec2f(SURFGRAD_DETAIL_SATURATED));
}
fn surfgrad_saturated_vec3(v: vec3f) -> vec3f {
  return clamp(v, vec3f(-SURFGRAD_DETAIL_SATURATED), vec3f(SURFGRAD_DETAIL_SATURATED));
}

// The length whose square is the smallest normal number.
const SURFGRAD_DETAIL_SHORTEST: f32 = 0x1p-63;

// 1 / |v|; 0 for a vector so short that its square vanishes.
fn surfgrad_detail_inverse_length(v: vec3f) -> f32 {
  let square = dot(v, v);
  return select(inverseSqrt(square), 0.0, square < SURFGRAD_LEAST);
}

// v / |v|, for lengths up to 1e18. Shorter than 1e-18 may give zero, as zero does.
fn surfgrad_normalize_or_zero(v: vec3f) -> vec3f { return surfgrad_detail_inverse_length(v) * v; }

// v in units of its magnitude: for products, whose squares may leave the range of numbers. Inf stays Inf.
fn surfgrad_detail_in_units_of_itself(v: vec3f) -> vec3f {
  return (1.0 / clamp(surfgrad_max_abs(v), SURFGRAD_LEAST, 1e30)) * v;
}

// Base-2 logarithm, from the smallest normal number's (-126) up: a finite level of detail, never -Inf.
fn surfgrad_log2(a: f32) -> f32 { return log2(clamp(a, SURFGRAD_LEAST, SURFGRAD_MOST)); }

// 2 to the power a: 0 from -126 down, the largest number from 128 up.
fn surfgrad_exp2(a: f32) -> f32 {
  return select(0.0, min(exp2(min(a, 128.0)), SURFGRAD_MOST), a > -126.0);
}

// a to the power k; 0 where a is not positive.
fn surfgrad_pow(a: f32, k: f32) -> f32 {
  return select(0.0, surfgrad_exp2(k * surfgrad_log2(a)), a > 0.0);
}

struct SurfgradSinCos {
  sin: f32,
  cos: f32,
}

// Sine and cosine of an angle in turns: 1 is a full circle. Exact at multiples of a quarter turn, as
// precise however many turns. The languages' own sine errs by up to 2^-11: tiles would jump.
fn surfgrad_sin_cos_turns(turns: f32) -> SurfgradSinCos {
  let size = abs(turns);
  var fraction = size - floor(size);
  fraction = select(0.0, fraction, fraction < 1.0); // neither where Inf - Inf was NaN
  let octant = floor(8.0 * fraction);
  let quarter = floor(0.5 * (octant + 1.0));
  let rest = 4.0 * fraction - quarter; // within half a quarter turn of 0
  // (pi/2)^n / n!, signs alternating: the series in quarter turns.
  let square = rest * rest;
  var s = -3.59884323521208534046e-6 * square;
  s = (s + 0.000160441184787359821873) * square;
  s = (s - 0.00468175413531868810069) * square;
  s = (s + 0.0796926262461670451205) * square;
  s = (s - 0.645964097506246253656) * square;
  var c = -0.0000252020423730606054811 * square;
  c = (c + 0.000919260274839426580242) * square;
  c = (c - 0.0208634807633529608731) * square;
  c = (c + 0.253669507901048013637) * square;
  c = (c - 1.23370055013616982735) * square;
  // pi/2 = 1 + 0.57: the exact `rest` carries most of the sine.
  s = rest + rest * (0.570796326794896619231 + s);
  c = 1.0 + c;
  let odd = quarter == 1.0 || quarter == 3.0;
  let sine = select(s, c, odd);
  let cosine = select(c, s, odd);
  let below = quarter == 2.0 || quarter == 3.0; // quarter 4 is 0 again
  let behind = quarter == 1.0 || quarter == 2.0;
  // Subtracted rather than negated, so that a zero stays +0.
  return SurfgradSinCos(select(sine, 0.0 - sine, below != (turns < 0.0)),
                        select(cosine, 0.0 - cosine, behind));
}

// The frame of a fragment ---------------------------------------------------------------------------------

// How a double-sided surface looks from behind (section 2.10 of the paper).
const SURFGRAD_BACK_FACES_SAME: i32 = 0;   // the perturbed normal of the front side
const SURFGRAD_BACK_FACES_MIRROR: i32 = 1; // the interpolated normal is negated, bumps stay bumps
const SURFGRAD_BACK_FACES_FLIP: i32 = 2;   // the front's perturbed normal, negated: bumps become dents

// Per-fragment state of one pass of bump mapping. What a shader does not use costs nothing.
struct SurfgradFrame {
  normal: vec3f,     // base normal: unit, or zero where nothing defines it
  dp_dx: vec3f,      // screen-space derivatives of the surface position
  dp_dy: vec3f,
  sigma_x: vec3f,    // dp_dx, dp_dy without their part along the normal
  sigma_y: vec3f,
  flip_sign: f32,    // +1 or -1: orientation of (dp_dx, dp_dy) seen against the normal
  resolve_sign: f32, // -1 on a back face in mode flip, else +1
}

// Directions in which s and t grow. Scale matters: surfgrad_from_tbn uses the vectors as they are.
struct SurfgradTangentFrame {
  tangent: vec3f,
  bitangent: vec3f,
}

fn surfgrad_detail_frame_from_unit_normal(n: vec3f, dp_dx: vec3f, dp_dy: vec3f,
                                          resolve_sign: f32) -> SurfgradFrame {
  let orientation = dot(dp_dy, cross(n, dp_dx));
  return SurfgradFrame(n, dp_dx, dp_dy, dp_dx - dot(dp_dx, n) * n, dp_dy - dot(dp_dy, n) * n,
                       select(1.0, -1.0, orientation < 0.0), resolve_sign);
}

// normalize(normal), or the direction of plane_sign * cross(dp_dx, dp_dy) where the normal is zero.
fn surfgrad_detail_unit_normal_or_plane(normal_in: vec3f, dp_dx: vec3f, dp_dy: vec3f,
                                        plane_sign: f32) -> vec3f {
  var normal = normal_in;
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
fn surfgrad_make_frame(normal: vec3f, dp_dx: vec3f, dp_dy: vec3f) -> SurfgradFrame {
  return surfgrad_detail_frame_from_unit_normal(
      surfgrad_detail_unit_normal_or_plane(normal, dp_dx, dp_dy, 1.0), dp_dx, dp_dy, 1.0);
}

// Prologue for double-sided materials.
//
// front_facing  @builtin(front_facing); inverted for an object transform with negative determinant
// back_faces    SURFGRAD_BACK_FACES_*. Tangents and bitangents never change side
// degenerate    as above, but the cross product takes the side of the normal that it stands in for
// source        Mikkelsen 2019, listing 16 and section 2.10
fn surfgrad_make_frame_two_sided(normal: vec3f, dp_dx: vec3f, dp_dy: vec3f, front_facing: bool,
                                 back_faces: i32) -> SurfgradFrame {
  let back_sign = select(-1.0, 1.0, front_facing);
  let normal_sign = select(back_sign, 1.0, back_faces == SURFGRAD_BACK_FACES_SAME);
  let resolve_sign = select(1.0, back_sign, back_faces == SURFGRAD_BACK_FACES_FLIP);
  // The cross product faces the viewer, the normal of a surface seen from behind does not.
  let front_normal = surfgrad_detail_unit_normal_or_plane(normal, dp_dx, dp_dy, back_sign);
  return surfgrad_detail_frame_from_unit_normal(normal_sign * front_normal, dp_dx, dp_dy, resolve_sign);
}

// Frame for layers that need no derivative of the position: vertex tangents, volume, object-space normal and
// decal layers.
//
// degenerate  zero normal: zero, which makes the resolved normal zero
fn surfgrad_make_frame_normal(normal: vec3f) -> SurfgradFrame {
  let zero = vec3f(0.0);
  return SurfgradFrame(surfgrad_normalize_or_zero(normal), zero, zero, zero, zero, 1.0, 1.0);
}

// Frame of the next pass: bump mapping on top of a resolved normal. resolve_sign is kept.
//
// normal      the resolved normal: unit. It already carries the side, so it is never negated again
// degenerate  zero normal: sigma is dp, flip_sign +1, and the resolved normal zero
// source      Mikkelsen 2019, listing 16 and section 2.11
fn surfgrad_rebase_frame(frame: SurfgradFrame, normal: vec3f) -> SurfgradFrame {
  return surfgrad_detail_frame_from_unit_normal(normal, frame.dp_dx, frame.dp_dy, frame.resolve_sign);
}

// The same, where the position changed too (parallax, displacement): dp from surfgrad_screen_derivatives.
fn surfgrad_rebase_frame_moved(frame: SurfgradFrame, normal: vec3f, dp_dx: vec3f,
                               dp_dy: vec3f) -> SurfgradFrame {
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
fn surfgrad_mikktspace_basis(normal: vec3f, tangent: vec3f, sign: f32) -> SurfgradTangentFrame {
  let scaled = surfgrad_detail_inverse_length(normal) * tangent;
  return SurfgradTangentFrame(scaled, select(-1.0, 1.0, sign > 0.0) * cross(normal, scaled));
}

// Tangent frame of any texture coordinate, made in place: no vertex tangents needed.
//
// dst_dx, dst_dy  screen-space derivatives of the texture coordinate
// returns         orthonormal tangent (direction of +s in the tangent plane) and bitangent (on the side of
//                 +t), right for clockwise and counter-clockwise coordinates
// degenerate      collapsed coordinates (both derivatives parallel to rounding, or zero) and zero sigma:
//                 zero vectors, hence no bump
// source          Mikkelsen 2019, listing 6 and section 2.3
fn surfgrad_tangent_basis(frame: SurfgradFrame, dst_dx: vec2f, dst_dy: vec2f) -> SurfgradTangentFrame {
  let size_x = surfgrad_max_abs_vec2(dst_dx);
  let size_y = surfgrad_max_abs_vec2(dst_dy);
  let det = surfgrad_cross(dst_dx, dst_dy);
  let collapsed = !(SURFGRAD_EPSILON * (size_x * size_y) < abs(det));
  let sign = select(1.0, -1.0, det < 0.0);
  // The position's change along s, up to a positive factor, which normalisation removes.
  let along_s = dst_dy.y * frame.sigma_x - dst_dx.y * frame.sigma_y;
  let tangent =
      select(sign * surfgrad_normalize_or_zero(surfgrad_detail_in_units_of_itself(along_s)), vec3f(0.0),
             collapsed);
  return SurfgradTangentFrame(tangent, (sign * frame.flip_sign) * cross(frame.normal, tangent));
}

// Slopes --------------------------------------------------------------------------------------------------
//
// A derivative is (dh/ds, dh/dt): the two-component form in which maps are filtered, blended and scaled.

const SURFGRAD_MAX_SLOPE: f32 = 128.0; // steeper slopes are clamped: 89.55 degrees

// Derivative of a tangent-space normal given by three channels.
//
// m           normal in [-1, 1]^3, of any length: only its direction counts
// returns     -m.xy / max(|m.z|, max(|m.x|, |m.y|) / 128)
// degenerate  (0, 0, 0) and (0, 0, z) give zero; m.z <= 0 is treated as |m.z|
// source      Mikkelsen 2019, equation 4, with the clamp of listing 4
fn surfgrad_derivative_from_normal(m: vec3f) -> vec2f {
  let steepest = max(abs(m.x), abs(m.y)) * (1.0 / SURFGRAD_MAX_SLOPE);
  return m.xy * (-1.0 / max(max(abs(m.z), SURFGRAD_LEAST), steepest));
}

// Derivative of a tangent-space normal given by two channels, the third reconstructed.
//
// m           channels x, y in [-1, 1] of a unit normal
// returns     -m / sqrt(max(1 - |m|^2, (max(|m.x|, |m.y|) / 128)^2))
// degenerate  zero gives zero; |m| >= 1 gives the steepest slope in the direction of m
// source      Mikkelsen 2019, listing 4, equation 5
fn surfgrad_derivative_from_normal_vec2(m: vec2f) -> vec2f {
  let squared = m * m;
  let z_squared = 1.0 - squared.x - squared.y;
  let least = max(squared.x, squared.y) * (1.0 / (SURFGRAD_MAX_SLOPE * SURFGRAD_MAX_SLOPE));
  return m * -inverseSqrt(max(z_squared, least));
}

// Unit tangent-space normal of a derivative: normalize(-d.x, -d.y, 1).
//
// source  Mikkelsen 2019, equation 4
fn surfgrad_normal_from_derivative(d: vec2f) -> vec3f {
  return surfgrad_normalize_or_zero(vec3f(-d, 1.0));
}

// Screen-space derivative of a height from three taps: better than differences across a pixel quad.
//
// h, h_x, h_y  heights at st, st + dst_dx, st + dst_dy
// returns      (dh/dx, dh/dy) per pixel, for surfgrad_from_height_derivative
// source       Mikkelsen 2019, listing 9
fn surfgrad_derivative_from_heights(h: f32, h_x: f32, h_y: f32) -> vec2f {
  return vec2f(h_x - h, h_y - h);
}

fn surfgrad_detail_spline_weights(f: f32) -> vec4f {
  let g = 1.0 - f;
  const sixth: f32 = 1.0 / 6.0;
  return vec4f(g * g * g * sixth, (4.0 - f * f * (6.0 - 3.0 * f)) * sixth,
               (4.0 - g * g * (6.0 - 3.0 * g)) * sixth, f * f * f * sixth);
}

fn surfgrad_detail_spline_slopes(f: f32) -> vec4f {
  let g = 1.0 - f;
  return vec4f(-(0.5 * g * g), f * (1.5 * f - 2.0), -(g * (1.5 * g - 2.0)), 0.5 * f * f);
}

// Derivative of the uniform cubic B-spline through (not interpolating) 4x4 heights: smooth where a height map
// is magnified.
//
// texels    rows along t (the first lowest), columns along s: transpose(mat4x4f(row0, row1, row2, row3)). The
//           point lies between the second and third of each
// fraction  position in [0, 1]^2 from the second texel towards the third
// returns   (dh/ds, dh/dt) per texel, for surfgrad_from_texel_derivative
fn surfgrad_derivative_from_bicubic(texels: mat4x4f, fraction: vec2f) -> vec2f {
  let along_s_slope = texels * surfgrad_detail_spline_slopes(fraction.x);
  let along_s = texels * surfgrad_detail_spline_weights(fraction.x);
  return vec2f(dot(along_s_slope, surfgrad_detail_spline_weights(fraction.y)),
               dot(along_s, surfgrad_detail_spline_slopes(fraction.y)));
}

// Bump scale applied to a derivative.
//
// source  Mikkelsen 2019, listing 3
fn surfgrad_scale_bump_vec2(scale: f32, deriv: vec2f) -> vec2f { return scale * deriv; }

// Surface gradients ---------------------------------------------------------------------------------------
//
// Every bump influence in the one form that scales, masks and adds linearly: a vector in the tangent plane.

// Surface gradient from a derivative expressed in a tangent basis.
//
// tangent, bitangent  directions of +s, +t: surfgrad_mikktspace_basis or surfgrad_tangent_basis
// degenerate          zero basis gives zero
// source              Mikkelsen 2019, listing 5, equation 6
fn surfgrad_from_tbn(deriv: vec2f, tangent: vec3f, bitangent: vec3f) -> vec3f {
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
fn surfgrad_from_perturbed_normal(normal: vec3f, v: vec3f) -> vec3f {
  let u = surfgrad_normalize_or_zero(v); // makes the clamp relative to |v|
  let along = dot(normal, u);
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
fn surfgrad_from_parametric_derivative(normal: vec3f, dp_du: vec3f, dp_dv: vec3f,
                                       dh_duv: vec2f) -> vec3f {
  // In units of each derivative's own magnitude everything below is of order one.
  let inverse_u = surfgrad_reciprocal_or_zero(surfgrad_max_abs(dp_du));
  let inverse_v = surfgrad_reciprocal_or_zero(surfgrad_max_abs(dp_dv));
  let a = inverse_u * dp_du;
  let r1 = cross(inverse_v * dp_dv, normal);
  let r2 = cross(normal, a);
  let det = dot(a, r1);
  let s = select(1.0, -1.0, det < 0.0) / max(SURFGRAD_EPSILON, abs(det));
  return surfgrad_saturated(s * (dh_duv.x * inverse_u)) * r1 +
         surfgrad_saturated(s * (dh_duv.y * inverse_v)) * r2;
}

// Surface gradient from the screen-space derivative of the height: scale-dependent bump mapping.
//
// frame   dp_dx, dp_dy of the position before displacement
// dh_dxy  (dh/dx, dh/dy) per pixel, in the units of the position: surfgrad_derivative_from_heights
// source  Mikkelsen 2019, listing 8 with isDerivScreenSpace
fn surfgrad_from_height_derivative(frame: SurfgradFrame, dh_dxy: vec2f) -> vec3f {
  return surfgrad_from_parametric_derivative(frame.normal, frame.dp_dx, frame.dp_dy, dh_dxy);
}

// Surface gradient from a height derivative per texel: scale-dependent bump mapping with a map.
//
// dh_dtexel       height change from one texel to the next along s and t, in units of the position
// size            width and height of the map in texels
// dst_dx, dst_dy  screen-space derivatives of the normalised texture coordinate
// source          Mikkelsen 2019, listing 8
fn surfgrad_from_texel_derivative(frame: SurfgradFrame, dh_dtexel: vec2f, size: vec2f, dst_dx: vec2f,
                                  dst_dy: vec2f) -> vec3f {
  let dh_dst = size * dh_dtexel;
  return surfgrad_from_height_derivative(frame, vec2f(dot(dh_dst, dst_dx), dot(dh_dst, dst_dy)));
}

// Surface gradient of a function of space: its gradient projected onto the tangent plane.
//
// normal    base normal, unit
// gradient  volume gradient (dh/dx, dh/dy, dh/dz) in the same space
// source    Mikkelsen 2019, listing 12; Golubev, equation 30
fn surfgrad_from_volume_gradient(normal: vec3f, gradient: vec3f) -> vec3f {
  return gradient - dot(normal, gradient) * normal;
}

// Bump scale applied to a surface gradient.
//
// source  Mikkelsen 2019, listing 2
fn surfgrad_scale_bump(scale: f32, surfgrad: vec3f) -> vec3f { return scale * surfgrad; }

// Resolve -------------------------------------------------------------------------------------------------

// What the v of a resolve is scaled by: 1 / |v|, or 0 where the base normal is zero. The fourth component
// keeps the root from zero and costs nothing, being one more term of a sum; it counts in a v shorter than
// 1e-15. Any normal but zero leaves the inverse, at most 1e19, as it is.
fn surfgrad_detail_resolve_scale(normal: vec3f, v: vec3f) -> f32 {
  let guarded = vec4f(v, SURFGRAD_DETAIL_SHORTEST);
  return min(inverseSqrt(dot(guarded, guarded)), 1e38 * surfgrad_max_abs(normal));
}

// The perturbed normal: normalize(normal - resolve_sign * surfgrad).
//
// surfgrad    the weighted sum of all surface gradients of the pass
// returns     unit normal. On a back face in mode flip it is the negative of the front side's
// degenerate  a zero base normal gives zero, whatever the gradient
// source      Mikkelsen 2019, listing 1, equation 1
fn surfgrad_resolve_normal(frame: SurfgradFrame, surfgrad: vec3f) -> vec3f {
  let v = frame.normal - frame.resolve_sign * surfgrad;
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
fn surfgrad_resolve_mikktspace(normal: vec3f, tangent: vec3f, sign: f32, deriv: vec2f) -> vec3f {
  let v = normal - deriv.x * tangent - select(-deriv.y, deriv.y, sign > 0.0) * cross(normal, tangent);
  return surfgrad_detail_resolve_scale(normal, v) * v;
}

// Turns the result of mode mirror into that of mode flip, after the last resolve: reflect(-resolved,
// initial).
//
// initial_normal  unit base normal (negated on back faces) as it was before the first resolve
// source          Mikkelsen 2019, section 2.10. Not equal to mode flip across a post-resolve volume layer, so
//                 prefer the mode
fn surfgrad_flip_from_mirror(resolved: vec3f, initial_normal: vec3f) -> vec3f {
  return (2.0 * dot(resolved, initial_normal)) * initial_normal - resolved;
}

// A normal through an object transform: sign(det M) * cof(M) * v.
//
// M        linear part of the transform; may scale non-uniformly or mirror
// v        a normal, or N - surfgrad as a whole; a surface gradient alone does not transform this way
// returns  not unit; points outward for mirrored objects too
// source   Golubev, equations 25, 33, 36
fn surfgrad_transform_normal(M: mat3x3f, v: vec3f) -> vec3f {
  let c = surfgrad_cofactor(M);
  return select(1.0, -1.0, dot(M[0], c[0]) < 0.0) * (c * v);
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
fn surfgrad_tangent_normal_matrix(rotation: mat3x3f, scale: mat3x3f, dp_du: vec3f, dp_dv: vec3f,
                                  normal: vec3f) -> mat3x3f {
  let inverse_u = surfgrad_reciprocal_or_zero(surfgrad_max_abs(dp_du));
  let inverse_v = surfgrad_reciprocal_or_zero(surfgrad_max_abs(dp_dv));
  let a = inverse_u * dp_du;
  let b = inverse_v * dp_dv;
  let det = dot(cross(a, b), normal);
  let s = select(1.0 / det, 0.0, abs(det) < SURFGRAD_EPSILON);
  // What +du, +dv of the height and the base normal contribute (Golubev, equation 6).
  let inverse_transpose = mat3x3f(surfgrad_saturated(s * inverse_u) * cross(b, normal),
                                  surfgrad_saturated(s * inverse_v) * cross(normal, a), normal);
  // The scale in units of its own magnitude, too: its cofactors are products of two.
  let size = max(max(surfgrad_max_abs(scale[0]), surfgrad_max_abs(scale[1])), surfgrad_max_abs(scale[2]));
  let unit = surfgrad_reciprocal_or_zero(size) * scale;
  let c = surfgrad_cofactor(unit);
  let side = select(1.0, -1.0, dot(unit[0], c[0]) < 0.0);
  let m = rotation * ((side * c) * inverse_transpose);
  let area = surfgrad_saturated(size * size);
  return mat3x3f(surfgrad_saturated_vec3(area * m[0]), surfgrad_saturated_vec3(area * m[1]),
                 surfgrad_saturated_vec3(area * m[2]));
}

// The same for a scale along the object's axes.
fn surfgrad_tangent_normal_matrix_vec3(rotation: mat3x3f, scale: vec3f, dp_du: vec3f, dp_dv: vec3f,
                                       normal: vec3f) -> mat3x3f {
  return surfgrad_tangent_normal_matrix(
      rotation, mat3x3f(scale.x, 0.0, 0.0, 0.0, scale.y, 0.0, 0.0, 0.0, scale.z), dp_du, dp_dv, normal);
}

// Derivatives without differences across pixels -----------------------------------------------------------

struct SurfgradScreenDerivatives {
  dp_dx: vec3f,
  dp_dy: vec3f,
}

struct SurfgradTextureDerivatives {
  dst_dx: vec2f,
  dst_dy: vec2f,
}

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
fn surfgrad_screen_derivatives(position: vec3f, normal: vec3f, world_from_screen: mat4x4f, x: f32,
                               y: f32) -> SurfgradScreenDerivatives {
  let n = surfgrad_normalize_or_zero(normal);
  // Plane in screen space: A x + B y + C z + D = 0, so z = -(A x + B y + D) / C.
  let on_screen = vec4f(n, -dot(position, n)) * world_from_screen;
  let size = max(max(abs(on_screen.x), abs(on_screen.y)), max(abs(on_screen.z), abs(on_screen.w)));
  let least = max(SURFGRAD_EPSILON * size, SURFGRAD_LEAST);
  let depth_slope = select(1.0, -1.0, on_screen.z < 0.0) * max(least, abs(on_screen.z));
  let v0 = world_from_screen[0] - (on_screen.x / depth_slope) * world_from_screen[2];
  let v1 = world_from_screen[1] - (on_screen.y / depth_slope) * world_from_screen[2];
  let v2 = world_from_screen[3] - (on_screen.w / depth_slope) * world_from_screen[2];
  let hit = x * v0 + y * v1 + v2; // homogeneous point of the plane under (x, y)
  // (f / w)' = (f' - (f / w) w') / w, with one division by w at a time: w * w may underflow.
  let inverse_w = surfgrad_reciprocal_or_zero(hit.w);
  let p = surfgrad_saturated_vec3(inverse_w * hit.xyz);
  return SurfgradScreenDerivatives(surfgrad_saturated_vec3(inverse_w * (v0.xyz - v0.w * p)),
                                   surfgrad_saturated_vec3(inverse_w * (v1.xyz - v1.w * p)));
}

// Screen-space derivatives of a projected texture coordinate from its volume gradients: right on displaced
// surfaces and across depth edges.
//
// source  Mikkelsen 2019, section 2.9: s and t are functions of space
fn surfgrad_projected_derivatives(grad_s: vec3f, grad_t: vec3f, dp_dx: vec3f,
                                  dp_dy: vec3f) -> SurfgradTextureDerivatives {
  return SurfgradTextureDerivatives(vec2f(dot(grad_s, dp_dx), dot(grad_t, dp_dx)),
                                    vec2f(dot(grad_s, dp_dy), dot(grad_t, dp_dy)));
}

// Mip level of an isotropic fetch: log2 of the longer footprint axis in texels. May be negative.
//
// size        width and height of the map's level 0, in texels
// degenerate  a zero footprint gives -126: level 0
// source      Mikkelsen 2019, section 3: compute it from the coordinate before a parallax correction, sample
//             with it after
fn surfgrad_texture_lod(dst_dx: vec2f, dst_dy: vec2f, size: vec2f) -> f32 {
  let x = size * dst_dx;
  let y = size * dst_dy;
  let square = max(dot(x, x), dot(y, y));
  return select(0.5 * surfgrad_log2(square), -126.0, square < SURFGRAD_LEAST);
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
fn surfgrad_project_to_texture_space(frame: SurfgradFrame, dir: vec3f, dst_dx: vec2f, dst_dy: vec2f,
                                     bump_scale: f32, skip_projection: bool) -> vec2f {
  let inverse_x = surfgrad_reciprocal_or_zero(surfgrad_max_abs(frame.dp_dx));
  let inverse_y = surfgrad_reciprocal_or_zero(surfgrad_max_abs(frame.dp_dy));
  let a = inverse_x * frame.dp_dx;
  let r1 = cross(inverse_y * frame.dp_dy, frame.normal);
  let r2 = cross(frame.normal, a);
  let det = dot(a, r1);
  let s = select(1.0, -1.0, det < 0.0) / max(SURFGRAD_EPSILON, abs(det));
  // Pixels covered per unit of dir, then texture units.
  let on_screen =
      surfgrad_saturated_vec2(vec2f(s * (inverse_x * dot(r1, dir)), s * (inverse_y * dot(r2, dir))));
  let in_texture =
      surfgrad_saturated_vec2(on_screen.x * dst_dx) + surfgrad_saturated_vec2(on_screen.y * dst_dy);
  if (skip_projection) { return surfgrad_saturated_vec2(bump_scale * in_texture); }
  let along = dot(frame.normal, dir);
  let least = max(SURFGRAD_EPSILON * surfgrad_max_abs(dir), SURFGRAD_LEAST);
  let per_height = select(1.0, -1.0, along < 0.0) / max(least, abs(along));
  return surfgrad_saturated_vec2((bump_scale * per_height) * in_texture);
}

// A texture offset in pixels: the step (vx, vy) on the screen that changes st by texture_offset.
//
// degenerate  collapsed coordinates: the determinant is clamped to eps times the derivatives' magnitudes;
//             zero derivatives give zero
// source      Mikkelsen 2019, listing 11
fn surfgrad_screen_offset(dst_dx: vec2f, dst_dy: vec2f, texture_offset: vec2f) -> vec2f {
  let inverse_x = surfgrad_reciprocal_or_zero(surfgrad_max_abs_vec2(dst_dx));
  let inverse_y = surfgrad_reciprocal_or_zero(surfgrad_max_abs_vec2(dst_dy));
  let a = inverse_x * dst_dx;
  let b = inverse_y * dst_dy;
  let det = surfgrad_cross(a, b);
  let s = select(1.0, -1.0, det < 0.0) / max(SURFGRAD_EPSILON, abs(det));
  return surfgrad_saturated_vec2(vec2f(s * (inverse_x * surfgrad_cross(texture_offset, b)),
                                       s * (inverse_y * surfgrad_cross(a, texture_offset))));
}

// A texture offset as a vector in the tangent plane; adding it and height * bump_scale * normal to the
// position gives the displaced position.
//
// source  Mikkelsen 2019, listing 11
fn surfgrad_surface_offset(frame: SurfgradFrame, dst_dx: vec2f, dst_dy: vec2f,
                           texture_offset: vec2f) -> vec3f {
  let v = surfgrad_screen_offset(dst_dx, dst_dy, texture_offset);
  return surfgrad_saturated_vec3(v.x * frame.sigma_x) + surfgrad_saturated_vec3(v.y * frame.sigma_y);
}

// The base normal at an offset position of a curved surface: normalize(n + vx dn_dx + vy dn_dy).
//
// dn_dx, dn_dy  screen-space derivatives of the unit base normal
// v             from surfgrad_screen_offset
// source        Mikkelsen 2019, section 2.6
fn surfgrad_offset_normal(frame: SurfgradFrame, dn_dx: vec3f, dn_dy: vec3f, v: vec2f) -> vec3f {
  return surfgrad_normalize_or_zero(
      surfgrad_detail_in_units_of_itself(frame.normal + v.x * dn_dx + v.y * dn_dy));
}

// Parallax occlusion mapping ------------------------------------------------------------------------------

// Halvings of the step that holds the crossing.
const SURFGRAD_PARALLAX_REFINEMENTS: i32 = 6;
// Finer steps are below the resolution of heights near 1.
const SURFGRAD_PARALLAX_MOST_STEPS: i32 = 262144;

struct SurfgradParallaxHit {
  texture_coordinate: vec2f, // where the ray meets the map
  height: f32,               // of the crossing, in [0, 1]
  hit: bool,
}

// A march under way. The bracket: the ray is above the map at `upper`, at or below it at `lower`.
struct SurfgradParallaxMarch {
  st: vec2f,
  dst: vec2f,
  ray: f32,             // height of the ray where the map is asked for next
  upper: f32,
  lower: f32,
  upper_clearance: f32, // of the map above the ray
  lower_clearance: f32,
  steps: i32,
  searched: i32,        // heights of the search so far
  refined: i32,         // heights of the refinement so far
  hit: bool,
}

// First crossing of a ray with a height map, coming from height 1 down to 0. The core's march_parallax
// calls a function for heights; here the loop is the caller's, who samples as he likes (an explicit level
// of detail or gradients: the number of rounds differs from pixel to pixel):
//
//   var march = surfgrad_march_parallax_begin(st, dst, 32);
//   while (surfgrad_march_parallax_asks(march)) {
//     let height = textureSampleLevel(heights, linear_wrap, surfgrad_march_parallax_at(march), lod).x;
//     march = surfgrad_march_parallax_answer(march, height);
//   }
//   let hit = surfgrad_march_parallax_end(march);
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
fn surfgrad_march_parallax_begin(st: vec2f, dst: vec2f, step_limit: i32) -> SurfgradParallaxMarch {
  let steps = clamp(step_limit, 1, SURFGRAD_PARALLAX_MOST_STEPS);
  return SurfgradParallaxMarch(st, dst, 1.0, 1.0, 1.0, 0.0, 0.0, steps, 0, 0, false);
}

// Whether a height is wanted: at most step_limit + 1 + SURFGRAD_PARALLAX_REFINEMENTS times.
fn surfgrad_march_parallax_asks(march: SurfgradParallaxMarch) -> bool {
  return select(march.searched <= march.steps, march.refined < SURFGRAD_PARALLAX_REFINEMENTS, march.hit);
}

// The texture coordinate where it is wanted.
fn surfgrad_march_parallax_at(march: SurfgradParallaxMarch) -> vec2f {
  return march.st + march.ray * march.dst;
}

// The march after the height there is known.
fn surfgrad_march_parallax_answer(march_in: SurfgradParallaxMarch, height: f32) -> SurfgradParallaxMarch {
  var march = march_in;
  // The bounds, outside the range of heights, keep Inf out of the interpolation.
  let clearance = min(max(height, -1.0), 2.0) - march.ray;
  let crossed = clearance >= 0.0;
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
  march.ray = select(f32(march.steps - march.searched) / f32(march.steps), 0.5 * (march.upper + march.lower),
                     march.hit);
  return march;
}

// What the march has found.
fn surfgrad_march_parallax_end(march: SurfgradParallaxMarch) -> SurfgradParallaxHit {
  // Where the straight line through the bracket's ends meets the ray; the ends of a crossing at the top
  // coincide and leave no line.
  let share =
      march.upper_clearance * surfgrad_reciprocal_or_zero(march.upper_clearance - march.lower_clearance);
  let height = select(0.0, march.upper + share * (march.lower - march.upper), march.hit);
  let st = select(march.st, march.st + height * march.dst, march.hit);
  return SurfgradParallaxHit(st, height, march.hit);
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
fn surfgrad_decal_gradient(deriv: vec2f, axis_x: vec3f, axis_y: vec3f) -> vec3f {
  return deriv.x * axis_x + deriv.y * axis_y;
}

// Surface gradient of a projected image.
//
// source  Mikkelsen 2019, listing 15
fn surfgrad_from_decal(normal: vec3f, deriv: vec2f, axis_x: vec3f, axis_y: vec3f) -> vec3f {
  return surfgrad_from_volume_gradient(normal, surfgrad_decal_gradient(deriv, axis_x, axis_y));
}

// Placement of a decal: its origin and orthonormal axes, either handedness. Sizes belong to the shapes.
struct SurfgradDecalFrame {
  origin: vec3f,
  axis_x: vec3f,
  axis_y: vec3f,
  axis_z: vec3f,
}

// An image projected by a box, cone or wedge, at one point. All zero outside the shape.
struct SurfgradDecalProjection {
  texture_coordinate: vec2f, // [0, 1]^2 over the image
  grad_s: vec3f,             // exact gradients of the texture coordinate in space
  grad_t: vec3f,
  axis_s: vec3f,             // what a unit slope along s and t adds to the volume gradient
  axis_t: vec3f,
  falloff: f32,              // 1 in the core, falling smoothly to 0 at the shape's surface
  inside: bool,
}

// A direction projected by a sphere or capsule, for a cube map of normals, at one point. All zero outside.
struct SurfgradDecalDirection {
  direction: vec3f,  // unit, in the space of the positions; zero at the centre
  lookup: vec3f,     // the same in the decal's frame: for the cube map
  unchanging: vec3f, // unit vector along which the direction does not change; zero where none
  falloff: f32,
  inside: bool,
}

// What a slope in the image of a cone or wedge adds to the volume gradient.
const SURFGRAD_CONE_GRADIENT_EXACT: i32 = 0;      // the gradient of (x/z, y/z), perspective term included
const SURFGRAD_CONE_GRADIENT_SCALE_FREE: i32 = 1; // the unit axes, as for a box

// Falloff at the fraction e of the way from the core to the surface: 1 up to 1 - fade, 0 at 1.
fn surfgrad_detail_edge_falloff(e: f32, fade: f32) -> f32 {
  let t = min(max((e - (1.0 - fade)) * surfgrad_reciprocal_or_zero(fade), 0.0), 1.0);
  return 1.0 - t * t * (3.0 - 2.0 * t);
}

fn surfgrad_detail_to_decal(frame: SurfgradDecalFrame, p: vec3f) -> vec3f {
  let d = p - frame.origin;
  return vec3f(dot(d, frame.axis_x), dot(d, frame.axis_y), dot(d, frame.axis_z));
}

// The cone of surfgrad_cone_decal for the point q in the decal's frame; dx_dx is the derivative of q.x by the
// position along axis_x (0 where a wedge's apex follows the point).
fn surfgrad_detail_cone_projection(frame: SurfgradDecalFrame, q: vec3f, dx_dx: f32, tan_half_angle: f32,
                                   range: f32, fade: f32, gradient: i32) -> SurfgradDecalProjection {
  let radius = tan_half_angle * q.z;
  let across = length(q.xy);
  let inside = SURFGRAD_LEAST < radius && SURFGRAD_LEAST < q.z && q.z < range && across < radius;
  if (!inside) {
    return SurfgradDecalProjection(vec2f(0.0), vec3f(0.0), vec3f(0.0), vec3f(0.0), vec3f(0.0), 0.0, false);
  }
  // d(x/z) = (dx - (x/z) dz) / z
  let inverse_z = surfgrad_reciprocal_or_zero(q.z);
  let along_s = dx_dx * frame.axis_x - (q.x * inverse_z) * frame.axis_z;
  let along_t = frame.axis_y - (q.y * inverse_z) * frame.axis_z;
  // The image is 2 * radius wide at this depth.
  let inverse_radius = surfgrad_reciprocal_or_zero(radius);
  let per_unit = 0.5 * inverse_radius;
  let exact = gradient == SURFGRAD_CONE_GRADIENT_EXACT;
  let falloff = surfgrad_detail_edge_falloff(across * inverse_radius, fade) *
                surfgrad_detail_edge_falloff(q.z * surfgrad_reciprocal_or_zero(range), fade);
  return SurfgradDecalProjection(0.5 + per_unit * q.xy, per_unit * along_s, per_unit * along_t,
                                 select(dx_dx * frame.axis_x, along_s, exact),
                                 select(frame.axis_y, along_t, exact), falloff, true);
}

fn surfgrad_detail_sphere_direction(frame: SurfgradDecalFrame, q: vec3f, unchanging: vec3f, radius: f32,
                                    fade: f32) -> SurfgradDecalDirection {
  let distance = length(q);
  if (!(distance < radius)) { return SurfgradDecalDirection(vec3f(0.0), vec3f(0.0), vec3f(0.0), 0.0, false); }
  let lookup = surfgrad_normalize_or_zero(q);
  return SurfgradDecalDirection(
      lookup.x * frame.axis_x + lookup.y * frame.axis_y + lookup.z * frame.axis_z, lookup, unchanging,
      surfgrad_detail_edge_falloff(distance * surfgrad_reciprocal_or_zero(radius), fade), true);
}

// Box: parallel projection along axis_z.
//
// p           point, in the space of the frame
// half_size   half the edges along the axes, positive; the image covers the xy face
// fade        fraction of the half edges over which the influence fades, in [0, 1]; 0 is a hard edge
// degenerate  a size that is not positive: outside
// source      Mikkelsen 2019, section 2.9
fn surfgrad_box_decal(frame: SurfgradDecalFrame, p: vec3f, half_size: vec3f,
                      fade: f32) -> SurfgradDecalProjection {
  let q = surfgrad_detail_to_decal(frame, p);
  if (!all(abs(q) < half_size)) {
    return SurfgradDecalProjection(vec2f(0.0), vec3f(0.0), vec3f(0.0), vec3f(0.0), vec3f(0.0), 0.0, false);
  }
  let per_half = vec3f(surfgrad_reciprocal_or_zero(half_size.x), surfgrad_reciprocal_or_zero(half_size.y),
                       surfgrad_reciprocal_or_zero(half_size.z));
  let e = abs(q) * per_half;
  let falloff = surfgrad_detail_edge_falloff(e.x, fade) * surfgrad_detail_edge_falloff(e.y, fade) *
                surfgrad_detail_edge_falloff(e.z, fade);
  return SurfgradDecalProjection(0.5 + 0.5 * per_half.xy * q.xy, (0.5 * per_half.x) * frame.axis_x,
                                 (0.5 * per_half.y) * frame.axis_y, frame.axis_x, frame.axis_y, falloff,
                                 true);
}

// Cone: perspective projection from the apex at the frame's origin along +axis_z.
//
// tan_half_angle  radius of the cone at distance 1, positive; the image encloses the circle
// range           length along axis_z, positive
// fade            fraction of the radius, and of the range at its far end, over which the influence fades
// gradient        SURFGRAD_CONE_GRADIENT_*: which axis_s, axis_t to give; grad_s and grad_t are exact in both
// degenerate      the apex and behind it, sizes that are not positive: outside
// source          Mikkelsen 2019, section 2.9, with the gradient of (x/z, y/z)
fn surfgrad_cone_decal(frame: SurfgradDecalFrame, p: vec3f, tan_half_angle: f32, range: f32, fade: f32,
                       gradient: i32) -> SurfgradDecalProjection {
  return surfgrad_detail_cone_projection(frame, surfgrad_detail_to_decal(frame, p), 1.0, tan_half_angle,
                                         range, fade, gradient);
}

// Wedge: a cone whose apex slides along a segment of axis_x, centred on the origin, to stay beside the point.
// Between the segment's ends s = 1/2 and grad_s, axis_s are zero; beyond them lie the two halves of a cone.
//
// half_length  half the segment's length, not negative; 0 is the cone
fn surfgrad_wedge_decal(frame: SurfgradDecalFrame, p: vec3f, half_length: f32, tan_half_angle: f32,
                        range: f32, fade: f32, gradient: i32) -> SurfgradDecalProjection {
  var q = surfgrad_detail_to_decal(frame, p);
  let dx_dx = select(1.0, 0.0, abs(q.x) < half_length);
  q.x -= max(-half_length, min(q.x, half_length));
  return surfgrad_detail_cone_projection(frame, q, dx_dx, tan_half_angle, range, fade, gradient);
}

// Sphere: a cube map of normals seen from its centre.
//
// returns     direction from the centre: sample the cube map at lookup, bring the normal into the space of
//             the positions, then surfgrad_decal_gradient_from_normal
// degenerate  the centre has no direction: zero, hence no bump; a radius that is not positive: outside
// source      Mikkelsen 2019, sections 2.4 and 2.9
fn surfgrad_sphere_decal(frame: SurfgradDecalFrame, p: vec3f, radius: f32,
                         fade: f32) -> SurfgradDecalDirection {
  return surfgrad_detail_sphere_direction(frame, surfgrad_detail_to_decal(frame, p), vec3f(0.0), radius,
                                          fade);
}

// Capsule: a sphere whose centre slides along a segment of axis_x, centred on the origin, to stay beside the
// point. Between the segment's ends unchanging is axis_x.
//
// half_length  half the segment's length, not negative; 0 is the sphere
fn surfgrad_capsule_decal(frame: SurfgradDecalFrame, p: vec3f, half_length: f32, radius: f32,
                          fade: f32) -> SurfgradDecalDirection {
  var q = surfgrad_detail_to_decal(frame, p);
  let unchanging = select(0.0, 1.0, abs(q.x) < half_length) * frame.axis_x;
  q.x -= max(-half_length, min(q.x, half_length));
  return surfgrad_detail_sphere_direction(frame, q, unchanging, radius, fade);
}

// Volume gradient of a sphere or capsule with a map of normals.
//
// v           perturbed normal sampled at decal.lookup, in the space of the positions, of any length
// degenerate  no direction: zero. Else as surfgrad_from_perturbed_normal
// source      Mikkelsen 2019, listing 7 and section 2.9
fn surfgrad_decal_gradient_from_normal(decal: SurfgradDecalDirection, v: vec3f) -> vec3f {
  let g = surfgrad_from_perturbed_normal(decal.direction, v);
  return select(g - dot(g, decal.unchanging) * decal.unchanging, vec3f(0.0),
                surfgrad_max_abs(decal.direction) == 0.0);
}

// Triplanar and planar projection -------------------------------------------------------------------------

const SURFGRAD_HANDEDNESS_LEFT: i32 = 0;
const SURFGRAD_HANDEDNESS_RIGHT: i32 = 1;
const SURFGRAD_TEXTURE_ORIGIN_LOWER_LEFT: i32 = 0;
const SURFGRAD_TEXTURE_ORIGIN_UPPER_LEFT: i32 = 1;
const SURFGRAD_TRIPLANAR_PLANES_MIKKELSEN: i32 =
    0; // x-plane (z, y), y-plane (x, z), z-plane (x, y): listing 13
const SURFGRAD_TRIPLANAR_PLANES_GOLUBEV: i32 =
    1; // x-plane (y, z), y-plane (z, x), z-plane (x, y): equation 46
const SURFGRAD_PLANE_AXIS_X: i32 = 0;
const SURFGRAD_PLANE_AXIS_Y: i32 = 1;
const SURFGRAD_PLANE_AXIS_Z: i32 = 2;

// One value gives coordinates and gradients, so that they cannot disagree. Right-handed spaces sample the x-
// and y-planes of listing 13 at -z; upper-left textures are sampled at -t.
struct SurfgradTriplanarConvention {
  handedness: i32,
  origin: i32,
  planes: i32,
}

// That of listing 13: left-handed, lower-left origin.
const SURFGRAD_LISTING_13: SurfgradTriplanarConvention = SurfgradTriplanarConvention(
    SURFGRAD_HANDEDNESS_LEFT, SURFGRAD_TEXTURE_ORIGIN_LOWER_LEFT, SURFGRAD_TRIPLANAR_PLANES_MIKKELSEN);

// Texture coordinates of the three planes at one point.
struct SurfgradTriplanarCoordinates {
  x_plane: vec2f,
  y_plane: vec2f,
  z_plane: vec2f,
}

// -1 where the convention negates z (x) or the second texture coordinate (y).
fn surfgrad_detail_signs(c: SurfgradTriplanarConvention) -> vec2f {
  let negate_z = c.planes == SURFGRAD_TRIPLANAR_PLANES_MIKKELSEN && c.handedness == SURFGRAD_HANDEDNESS_RIGHT;
  return vec2f(select(1.0, -1.0, negate_z),
               select(1.0, -1.0, c.origin == SURFGRAD_TEXTURE_ORIGIN_UPPER_LEFT));
}

// Blend weights from the base normal: max(0, |n| - 0.2)^k, normalised.
//
// normal      unit base normal
// k           sharpness, positive; 3 in the listing
// degenerate  zero normal gives 1/3 each. The largest term is divided out before a power that could
//             underflow: any but the third, which is a product as well and by far cheaper
// source      Mikkelsen 2019, listing 14
fn surfgrad_triplanar_weights(normal: vec3f, k: f32) -> vec3f {
  var w = saturate(abs(normal) - 0.2); // below 1 for any unit normal: hardware saturates for nothing
  var p = w * w * w;
  if (k != 3.0) {
    w *= surfgrad_reciprocal_or_zero(surfgrad_max_abs(w));
    p = vec3f(surfgrad_pow(w.x, k), surfgrad_pow(w.y, k), surfgrad_pow(w.z, k));
  }
  let sum = p.x + p.y + p.z;
  if (sum == 0.0) { return vec3f(1.0 / 3.0); }
  return p / sum;
}

// Texture coordinates that a convention samples at position p (in texture units).
//
// source  Mikkelsen 2019, section 2.8; Golubev, equation 46
fn surfgrad_triplanar_coordinates(p: vec3f,
                                  convention: SurfgradTriplanarConvention) -> SurfgradTriplanarCoordinates {
  let sign = surfgrad_detail_signs(convention);
  let st = vec2f(1.0, sign.y);
  if (convention.planes == SURFGRAD_TRIPLANAR_PLANES_GOLUBEV) {
    return SurfgradTriplanarCoordinates(st * p.yz, st * p.zx, st * p.xy);
  }
  let z = sign.x * p.z;
  return SurfgradTriplanarCoordinates(st * vec2f(z, p.y), st * vec2f(p.x, z), st * p.xy);
}

// Volume gradient of one planar projection along an axis (SURFGRAD_PLANE_AXIS_*): no normal needed.
//
// deriv    (dh/ds, dh/dt) sampled at that plane's coordinate of surfgrad_triplanar_coordinates
// returns  gradient with respect to the position; the component along the axis is zero
// source   Mikkelsen 2019, section 2.8; Golubev, equations 44, 50
fn surfgrad_planar_gradient(axis: i32, deriv: vec2f, convention: SurfgradTriplanarConvention) -> vec3f {
  let sign = surfgrad_detail_signs(convention);
  let d = vec2f(deriv.x, sign.y * deriv.y);
  let of_z = sign.x * d;
  if (axis == SURFGRAD_PLANE_AXIS_Z) { return vec3f(d, 0.0); }
  if (convention.planes == SURFGRAD_TRIPLANAR_PLANES_GOLUBEV) {
    return select(vec3f(d.y, 0.0, d.x), vec3f(0.0, d), axis == SURFGRAD_PLANE_AXIS_X);
  }
  return select(vec3f(d.x, 0.0, of_z.y), vec3f(0.0, d.y, of_z.x), axis == SURFGRAD_PLANE_AXIS_X);
}

// Volume gradient of a triplanar projection: no normal needed.
//
// weights  surfgrad_triplanar_weights
// deriv_*  derivatives sampled at surfgrad_triplanar_coordinates(p, convention)
// returns  gradient with respect to p; multiply by the texture's frequency for that of the position
// source   Mikkelsen 2019, listing 13; Golubev, equation 49
fn surfgrad_triplanar_gradient(weights: vec3f, deriv_x: vec2f, deriv_y: vec2f, deriv_z: vec2f,
                               convention: SurfgradTriplanarConvention) -> vec3f {
  return weights.x * surfgrad_planar_gradient(SURFGRAD_PLANE_AXIS_X, deriv_x, convention) +
         weights.y * surfgrad_planar_gradient(SURFGRAD_PLANE_AXIS_Y, deriv_y, convention) +
         weights.z * surfgrad_planar_gradient(SURFGRAD_PLANE_AXIS_Z, deriv_z, convention);
}

// Surface gradient of a triplanar projection.
//
// normal  unit base normal: the interpolated one, or a resolved one in a later pass
// source  Mikkelsen 2019, listing 13
fn surfgrad_from_triplanar(normal: vec3f, weights: vec3f, deriv_x: vec2f, deriv_y: vec2f,
                           deriv_z: vec2f, convention: SurfgradTriplanarConvention) -> vec3f {
  return surfgrad_from_volume_gradient(
      normal, surfgrad_triplanar_gradient(weights, deriv_x, deriv_y, deriv_z, convention));
}

// Noise ---------------------------------------------------------------------------------------------------
//
// Functions of space with exact gradients, for surfgrad_from_volume_gradient. Sampling at frequency * p
// multiplies the gradient by frequency. Integer hashes: the same pattern on every machine and in C++.

// Coordinates of noise beyond this magnitude are taken as this.
const SURFGRAD_NOISE_EXTENT: i32 = 536870912;

// A function of space at one point.
struct SurfgradNoise {
  value: f32,
  gradient: vec3f, // derivatives of the value by the coordinates of the sampling point
}

// The odd multipliers by which the hash sums a cell's indices: a neighbour's sum is one addition away.
const SURFGRAD_DETAIL_LATTICE_X: u32 = 0x5cdbcce3u;
const SURFGRAD_DETAIL_LATTICE_Y: u32 = 0x456e33c9u;
const SURFGRAD_DETAIL_LATTICE_Z: u32 = 0xe1392b77u;

// What the noises over a moved lattice start from at a cell (indices modulo 2^32): added to its own hash, it
// makes noise sampled near that cell exact however far away the cell is.
fn surfgrad_lattice_start(x: u32, y: u32, z: u32) -> u32 {
  return x * SURFGRAD_DETAIL_LATTICE_X + y * SURFGRAD_DETAIL_LATTICE_Y + z * SURFGRAD_DETAIL_LATTICE_Z;
}

fn surfgrad_detail_finalised(h_in: u32) -> u32 {
  var h = h_in;
  h = (h ^ (h >> 16u)) * 0x7feb352du;
  h = (h ^ (h >> 15u)) * 0x846ca68bu;
  return h ^ (h >> 16u);
}

fn surfgrad_detail_lattice_sum(cell: vec3i) -> u32 {
  return surfgrad_lattice_start(u32(cell.x), u32(cell.y), u32(cell.z));
}

// 32 well mixed bits for a point of the integer lattice.
//
// source  own sum of the indices; finaliser: C. Wellons, lowbias32
fn surfgrad_lattice_hash(x: i32, y: i32, z: i32) -> u32 {
  return surfgrad_detail_finalised(surfgrad_detail_lattice_sum(vec3i(x, y, z)));
}

// `count` bits from position `first` up, as a number.
fn surfgrad_detail_bit_field(word: u32, first: u32, count: u32) -> f32 {
  return f32((word << (32u - first - count)) >> (32u - count));
}

fn surfgrad_detail_saturate_to_lattice(p: vec3f) -> vec3f {
  const extent = f32(SURFGRAD_NOISE_EXTENT);
  return clamp(p, vec3f(-extent), vec3f(extent));
}

// One of the 12 directions to the edges of a cube, four of them twice: chosen by the low four bits.
fn surfgrad_detail_edge_direction(hash: u32) -> vec3f {
  let choice = hash & 15u;
  let first = select(-1.0, 1.0, (hash & 1u) == 0u);
  let second = select(-1.0, 1.0, (hash & 2u) == 0u);
  // `first` belongs to x or y, `second` to y, x or z.
  let first_is_x = choice < 8u;
  let second_is_y = choice < 4u;
  let second_is_x = choice == 12u || choice == 14u;
  return vec3f(select(select(0.0, second, second_is_x), first, first_is_x),
               select(first, select(0.0, second, second_is_y), first_is_x),
               select(second, 0.0, second_is_y || second_is_x));
}

fn surfgrad_detail_mix(a: SurfgradNoise, b: SurfgradNoise, weight: f32) -> SurfgradNoise {
  return SurfgradNoise(a.value + weight * (b.value - a.value),
                       a.gradient + weight * (b.gradient - a.gradient));
}

// sum: of the corner's indices, finalised to its hash.
fn surfgrad_detail_perlin_corner(sum: u32, offset: vec3f) -> SurfgradNoise {
  let direction = surfgrad_detail_edge_direction(surfgrad_detail_finalised(sum));
  return SurfgradNoise(dot(direction, offset), direction);
}

fn surfgrad_detail_fade(t: f32) -> f32 { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }
fn surfgrad_detail_fade_slope(t: f32) -> f32 { return 30.0 * t * t * (t - 1.0) * (t - 1.0); }

// Mixed along x. The weight depends on one coordinate: its slope adds to that component only.
fn surfgrad_detail_perlin_edge(sum: u32, offset: vec3f) -> SurfgradNoise {
  let low = surfgrad_detail_perlin_corner(sum, offset);
  let high = surfgrad_detail_perlin_corner(sum + SURFGRAD_DETAIL_LATTICE_X, offset - vec3f(1.0, 0.0, 0.0));
  var n = surfgrad_detail_mix(low, high, surfgrad_detail_fade(offset.x));
  n.gradient.x += surfgrad_detail_fade_slope(offset.x) * (high.value - low.value);
  return n;
}

// Mixed along x and y.
fn surfgrad_detail_perlin_face(sum: u32, offset: vec3f) -> SurfgradNoise {
  let low = surfgrad_detail_perlin_edge(sum, offset);
  let high = surfgrad_detail_perlin_edge(sum + SURFGRAD_DETAIL_LATTICE_Y, offset - vec3f(0.0, 1.0, 0.0));
  var n = surfgrad_detail_mix(low, high, surfgrad_detail_fade(offset.y));
  n.gradient.y += surfgrad_detail_fade_slope(offset.y) * (high.value - low.value);
  return n;
}

// Perlin's gradient noise of 2002, over a lattice moved by `start` (surfgrad_lattice_start).
//
// p           sampling point, cell size 1
// returns     value and exact gradient; 0 at lattice points. |value| <= 1.0364, |gradient| <= 3.75
// degenerate  coordinates beyond +-SURFGRAD_NOISE_EXTENT are taken as that
// source      Perlin 2002: fade 6t^5 - 15t^4 + 10t^3, 12 directions
fn surfgrad_perlin_moved(p: vec3f, start: u32) -> SurfgradNoise {
  let q = surfgrad_detail_saturate_to_lattice(p);
  let low_corner = floor(q);
  let offset = q - low_corner;
  let sum = surfgrad_detail_lattice_sum(vec3i(low_corner)) + start;
  let low = surfgrad_detail_perlin_face(sum, offset);
  let high = surfgrad_detail_perlin_face(sum + SURFGRAD_DETAIL_LATTICE_Z, offset - vec3f(0.0, 0.0, 1.0));
  var n = surfgrad_detail_mix(low, high, surfgrad_detail_fade(offset.z));
  n.gradient.z += surfgrad_detail_fade_slope(offset.z) * (high.value - low.value);
  return n;
}
fn surfgrad_perlin(p: vec3f) -> SurfgradNoise { return surfgrad_perlin_moved(p, 0u); }

// What a corner of a simplex adds to the noise at the distance r from it.
fn surfgrad_detail_simplex_corner(sum: u32, r: vec3f) -> SurfgradNoise {
  let direction = surfgrad_detail_edge_direction(surfgrad_detail_finalised(sum));
  let ramp = dot(direction, r);
  let t = max(0.5 - dot(r, r), 0.0);
  let t2 = t * t;
  let falloff = t2 * t2;
  return SurfgradNoise(falloff * ramp, falloff * direction - (8.0 * t2 * t * ramp) * r);
}

// Gradient noise over the simplicial lattice: 4 corners instead of 8.
//
// start       of the skewed lattice: where p moves by integers x, y, z whose sum is 3 n, its indices move by
//             x + n, y + n, z + n
// returns     value and exact gradient; |value| <= 1, |gradient| <= 6.97
// degenerate  coordinates beyond +-SURFGRAD_NOISE_EXTENT are taken as that
// source      Perlin 2001, with the 12 directions of Perlin 2002 and falloffs that end within the simplices
fn surfgrad_simplex_moved(p: vec3f, start: u32) -> SurfgradNoise {
  const sixth: f32 = 1.0 / 6.0;
  // The inverse of the largest sum of corner contributions, 0.01300716, rounded down.
  const scale: f32 = 76.88;
  let q = surfgrad_detail_saturate_to_lattice(p);
  let cell = floor(q + (q.x + q.y + q.z) * (1.0 / 3.0));
  let d = q - (cell - (cell.x + cell.y + cell.z) * sixth);
  let sum = surfgrad_detail_lattice_sum(vec3i(cell)) + start;
  // From the first corner along the axis of the largest component, then the middle, then the least.
  let x_from_y = !(d.x < d.y);
  let x_from_z = !(d.x < d.z);
  let y_from_z = !(d.y < d.z);
  let one = vec3i(i32(x_from_y && x_from_z), i32(!x_from_y && y_from_z), i32(!x_from_z && !y_from_z));
  let two = vec3i(i32(x_from_y || x_from_z), i32(!x_from_y || y_from_z), i32(!x_from_z || !y_from_z));
  let a = surfgrad_detail_simplex_corner(sum, d);
  let b = surfgrad_detail_simplex_corner(sum + surfgrad_detail_lattice_sum(one), d - vec3f(one) + sixth);
  let c =
      surfgrad_detail_simplex_corner(sum + surfgrad_detail_lattice_sum(two), d - vec3f(two) + 2.0 * sixth);
  let e = surfgrad_detail_simplex_corner(sum + surfgrad_detail_lattice_sum(vec3i(1)), d - 1.0 + 0.5);
  return SurfgradNoise(scale * (a.value + b.value + c.value + e.value),
                       scale * (a.gradient + b.gradient + c.gradient + e.gradient));
}
fn surfgrad_simplex(p: vec3f) -> SurfgradNoise { return surfgrad_simplex_moved(p, 0u); }

const SURFGRAD_WORLEY_KIND_F1: i32 = 0;          // distance to the nearest feature point
const SURFGRAD_WORLEY_KIND_F2_MINUS_F1: i32 = 1; // excess of that to the second nearest: 0 on cells' borders

// Worley's cellular noise with one feature point a unit cell, over a lattice moved by `start`.
//
// kind        SURFGRAD_WORLEY_KIND_*
// returns     value in [0, 1] and exact gradient. Distances count as 1 from 1 on, where their gradient is
//             zero
// kinks       the gradient of one side is given; zero at a feature point
// degenerate  coordinates beyond +-SURFGRAD_NOISE_EXTENT are taken as that
// source      Worley 1996; feature points at multiples of 1/1024 from 10 bits of surfgrad_lattice_hash an
//             axis
fn surfgrad_worley_moved(p: vec3f, kind: i32, start: u32) -> SurfgradNoise {
  let q = surfgrad_detail_saturate_to_lattice(p);
  let low_corner = floor(q);
  let fraction = q - low_corner;
  let sum = surfgrad_detail_lattice_sum(vec3i(low_corner)) + start;
  // Squared distances, and offsets from the feature points to p. Starting at the cap leaves the zero offset,
  // hence no gradient, where nothing is nearer.
  var nearest = 1.0;
  var second = 1.0;
  var from_nearest = vec3f(0.0);
  var from_second = vec3f(0.0);
  for (var z = -1; z <= 1; z++) {
    for (var y = -1; y <= 1; y++) {
      for (var x = -1; x <= 1; x++) {
        let neighbour = vec3i(x, y, z);
        let h = surfgrad_detail_finalised(sum + surfgrad_detail_lattice_sum(neighbour));
        let bits = vec3f(surfgrad_detail_bit_field(h, 0u, 10u), surfgrad_detail_bit_field(h, 10u, 10u),
                         surfgrad_detail_bit_field(h, 20u, 10u));
        let feature = (vec3f(neighbour) + 0.5 / 1024.0) + bits * (1.0 / 1024.0);
        let offset = fraction - feature;
        let squared = dot(offset, offset);
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
  let f1 = sqrt(nearest);
  let f1_gradient = surfgrad_reciprocal_or_zero(f1) * from_nearest;
  if (kind == SURFGRAD_WORLEY_KIND_F1) { return SurfgradNoise(f1, f1_gradient); }
  let f2 = sqrt(second);
  return SurfgradNoise(f2 - f1, surfgrad_reciprocal_or_zero(f2) * from_second - f1_gradient);
}
fn surfgrad_worley(p: vec3f, kind: i32) -> SurfgradNoise { return surfgrad_worley_moved(p, kind, 0u); }

// A noise raised to a power: sharpens dents, g(x) = x^k.
//
// degenerate  where the value is not positive: zero, with zero gradient
// source      Mikkelsen 2019, section 4 (after Gritz)
fn surfgrad_power(noise: SurfgradNoise, k: f32) -> SurfgradNoise {
  let less = surfgrad_pow(noise.value, k - 1.0);
  // The slope saturates before it meets a zero component, which infinity would turn into NaN.
  let slope = surfgrad_saturated(k * less);
  return SurfgradNoise(surfgrad_saturated(noise.value * less),
                       surfgrad_saturated_vec3(slope * noise.gradient));
}

fn surfgrad_detail_difference_quotient(change: f32, run: f32) -> f32 {
  return change * surfgrad_reciprocal_or_zero(run);
}

// Gradient of a function that only gives values, by central differences.
//
// step       distance to each side: about eps^(1/3) times the scale of the function's detail
// high, low  its values at p + step and p - step, along x, y and z
// source     Gustavson
fn surfgrad_gradient_by_differences(p: vec3f, step: f32, high: vec3f, low: vec3f) -> vec3f {
  let run = (p + step) - (p - step); // what rounding left of the wanted steps
  return vec3f(surfgrad_detail_difference_quotient(high.x - low.x, run.x),
               surfgrad_detail_difference_quotient(high.y - low.y, run.y),
               surfgrad_detail_difference_quotient(high.z - low.z, run.z));
}

// The same from 3 values beside the known one at p (forward differences).
//
// step    about sqrt(eps) times the scale of the function's detail
// source  Gustavson
fn surfgrad_gradient_by_forward_differences(p: vec3f, step: f32, high: vec3f, value: f32) -> vec3f {
  let run = (p + step) - p;
  return vec3f(surfgrad_detail_difference_quotient(high.x - value, run.x),
               surfgrad_detail_difference_quotient(high.y - value, run.y),
               surfgrad_detail_difference_quotient(high.z - value, run.z));
}

// Sums of octaves -----------------------------------------------------------------------------------------

// Octave i samples the basis at frequency lacunarity^i with amplitude gain^i.
struct SurfgradFractal {
  octaves: i32,    // 4 in the core's default
  lacunarity: f32, // positive; 2. A value near 2 hides the lattice, exactly 2 lets its points coincide
  gain: f32,       // 0.5
}

// The noise that a sum is made of.
const SURFGRAD_BASIS_PERLIN: i32 = 0;
const SURFGRAD_BASIS_SIMPLEX: i32 = 1;
const SURFGRAD_BASIS_WORLEY_F1: i32 = 2;
const SURFGRAD_BASIS_WORLEY_F2_MINUS_F1: i32 = 3;

// A basis at a point. A constant basis costs nothing else than its noise.
fn surfgrad_basis_noise(p: vec3f, basis: i32, start: u32) -> SurfgradNoise {
  if (basis == SURFGRAD_BASIS_PERLIN) { return surfgrad_perlin_moved(p, start); }
  if (basis == SURFGRAD_BASIS_SIMPLEX) { return surfgrad_simplex_moved(p, start); }
  return surfgrad_worley_moved(
      p, select(SURFGRAD_WORLEY_KIND_F2_MINUS_F1, SURFGRAD_WORLEY_KIND_F1, basis == SURFGRAD_BASIS_WORLEY_F1),
      start);
}

// What remains of an octave: 1 - smoothstep(0.25, 0.75, cells per pixel). From 3/4 of a cell a pixel on the
// octave would only alias.
fn surfgrad_octave_visibility(cells_per_pixel: f32) -> f32 {
  let t = min(max(2.0 * cells_per_pixel - 0.5, 0.0), 1.0);
  return 1.0 - t * t * (3.0 - 2.0 * t);
}

// The term that an octave of turbulence, or of ridges, adds for a basis' noise.
fn surfgrad_turbulence_octave(n: SurfgradNoise) -> SurfgradNoise {
  return SurfgradNoise(abs(n.value), select(1.0, -1.0, n.value < 0.0) * n.gradient);
}
fn surfgrad_ridged_octave(n: SurfgradNoise) -> SurfgradNoise {
  let crest = 1.0 - abs(n.value);
  return SurfgradNoise(crest * crest, (select(-2.0, 2.0, n.value < 0.0) * crest) * n.gradient);
}

// A sum of octaves and one more, sampled at frequency * p: for a basis of one's own.
//
//   for (var i = 0; i < octaves; i++) {
//     sum = surfgrad_add_octave(sum, my_noise(frequency * p), frequency, amplitude, width);
//     frequency *= lacunarity;
//     amplitude *= gain;
//   }
fn surfgrad_add_octave(sum: SurfgradNoise, octave: SurfgradNoise, frequency: f32, amplitude: f32,
                       width: f32) -> SurfgradNoise {
  let weight = amplitude * surfgrad_octave_visibility(frequency * width);
  return SurfgradNoise(sum.value + weight * octave.value,
                       sum.gradient + (weight * frequency) * octave.gradient);
}

const SURFGRAD_DETAIL_SUM: i32 = 0;
const SURFGRAD_DETAIL_TURBULENCE: i32 = 1;
const SURFGRAD_DETAIL_RIDGED: i32 = 2;

fn surfgrad_detail_sum_octaves(p: vec3f, fractal: SurfgradFractal, width: f32, basis: i32,
                               term: i32) -> SurfgradNoise {
  var sum = SurfgradNoise(0.0, vec3f(0.0));
  var frequency = 1.0;
  var amplitude = 1.0;
  // Past the extent even a point at distance 1 from the origin would leave the lattice.
  for (var i = 0; i < fractal.octaves && frequency < f32(SURFGRAD_NOISE_EXTENT); i++) {
    if (surfgrad_octave_visibility(frequency * width) > 0.0) {
      var n = surfgrad_basis_noise(frequency * p, basis, 0u);
      if (term == SURFGRAD_DETAIL_TURBULENCE) { n = surfgrad_turbulence_octave(n); }
      if (term == SURFGRAD_DETAIL_RIDGED) { n = surfgrad_ridged_octave(n); }
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
fn surfgrad_fractal_sum(p: vec3f, fractal: SurfgradFractal, width: f32, basis: i32) -> SurfgradNoise {
  return surfgrad_detail_sum_octaves(p, fractal, width, basis, SURFGRAD_DETAIL_SUM);
}

// Turbulence: sum of gain^i * |basis(lacunarity^i * p)|.
//
// kinks   where an octave is 0: the gradient of the positive side
// source  Perlin 1985 (gain = 1 / lacunarity)
fn surfgrad_turbulence(p: vec3f, fractal: SurfgradFractal, width: f32, basis: i32) -> SurfgradNoise {
  return surfgrad_detail_sum_octaves(p, fractal, width, basis, SURFGRAD_DETAIL_TURBULENCE);
}

// Ridges: sum of gain^i * (1 - |basis(lacunarity^i * p)|)^2, sharp crests where an octave is 0.
//
// source  Musgrave's ridged sum without its feedback between octaves
fn surfgrad_ridged(p: vec3f, fractal: SurfgradFractal, width: f32, basis: i32) -> SurfgradNoise {
  return surfgrad_detail_sum_octaves(p, fractal, width, basis, SURFGRAD_DETAIL_RIDGED);
}

// Hex tiling ----------------------------------------------------------------------------------------------
//
// A map repeated without visible repetition, by blending three randomly shifted and turned copies of it.

// A vertex of the grid that coordinates are relative to: near it they are exact however far away it is.
struct SurfgradHexOrigin {
  start: u32,   // surfgrad_lattice_start of its index (i, j, 0)
  shift: vec2f, // where it lies, whole periods left out
}

// The three tiles over a point.
struct SurfgradHexTiles {
  st: array<vec2f, 3>,       // where each tile samples the map
  weight: vec3f,             // barycentric coordinates in the triangle: within [0, 1], sum 1
  rotation: array<vec2f, 3>, // cosine and sine of each tile's turn: st[i] turns by it as st moves
}

// v turned counter-clockwise: the screen derivatives of st as those of a tile's st[i].
//
// rotation  cosine and sine
fn surfgrad_rotate(v: vec2f, rotation: vec2f) -> vec2f {
  return vec2f(rotation.x * v.x - rotation.y * v.y, rotation.y * v.x + rotation.x * v.y);
}

// The transpose of surfgrad_rotate: a derivative by a tile's st[i] as the derivative by st.
fn surfgrad_rotate_back(v: vec2f, rotation: vec2f) -> vec2f {
  return vec2f(rotation.x * v.x + rotation.y * v.y, rotation.x * v.y - rotation.y * v.x);
}

struct SurfgradDetailHexTile {
  st: vec2f,
  rotation: vec2f,
}

// The tile of a vertex. sum: of its indices; along: (i, j) from there to the point `place`.
fn surfgrad_detail_hex_tile(sum: u32, place: vec2f, side: f32, along: vec2f, strength: f32,
                            period: vec2f) -> SurfgradDetailHexTile {
  const unit: f32 = 1.0 / 65536.0;
  let d = vec2f(side * (along.x + 0.5 * along.y), side * (0.86602540378443864676 * along.y)); // sqrt(3) / 2
  let shift = surfgrad_detail_finalised(sum);
  let turn = surfgrad_detail_finalised(sum + SURFGRAD_DETAIL_LATTICE_Z);
  let r = surfgrad_sin_cos_turns(strength * (unit * surfgrad_detail_bit_field(turn, 0u, 16u) - 0.5));
  // R d + centre = p + (R - 1) d: the centre is not needed, and without a turn p stays what it is.
  let offset = period * (unit * vec2f(surfgrad_detail_bit_field(shift, 0u, 16u),
                                      surfgrad_detail_bit_field(shift, 16u, 16u)));
  return SurfgradDetailHexTile(place + surfgrad_rotate(d, vec2f(r.cos - 1.0, r.sin)) + offset,
                               vec2f(r.cos, r.sin));
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
fn surfgrad_hex_tiles(st: vec2f, rotation: f32, edge: f32, period: vec2f,
                      origin: SurfgradHexOrigin) -> SurfgradHexTiles {
  let side = select(1.0, edge, edge >= 1e-12 && edge <= 1e12);
  let strength = min(max(rotation, 0.0), 1.0);
  let bound = side * f32(SURFGRAD_NOISE_EXTENT);
  let p = clamp(st, vec2f(-bound), vec2f(bound));
  // The grid's vertices are side * (i * (1, 0) + j * (1/2, sqrt(3)/2)); p has these i and j.
  let q = (1.0 / side) * p;
  let ij = vec2f(q.x - 0.57735026918962576451 * q.y, 1.15470053837925152902 * q.y);
  let low = floor(ij);
  let f = ij - low;
  let vertex = surfgrad_detail_lattice_sum(vec3i(vec2i(low), 0)) + origin.start;
  // The diagonal from (1, 0) to (0, 1) divides a cell into two triangles.
  let sum = f.x + f.y;
  let lower = sum < 1.0;
  let corner = select(vec2f(1.0), vec2f(0.0), lower);
  let place = p + origin.shift;
  let a = surfgrad_detail_hex_tile(
      vertex + select(SURFGRAD_DETAIL_LATTICE_X + SURFGRAD_DETAIL_LATTICE_Y, 0u, lower), place, side,
      f - corner, strength, period);
  let b = surfgrad_detail_hex_tile(vertex + SURFGRAD_DETAIL_LATTICE_X, place, side, f - vec2f(1.0, 0.0),
                                   strength, period);
  let c = surfgrad_detail_hex_tile(vertex + SURFGRAD_DETAIL_LATTICE_Y, place, side, f - vec2f(0.0, 1.0),
                                   strength, period);
  var tiles: SurfgradHexTiles;
  tiles.st[0] = a.st;
  tiles.st[1] = b.st;
  tiles.st[2] = c.st;
  tiles.weight = select(vec3f(sum - 1.0, 1.0 - f.y, 1.0 - f.x), vec3f(1.0 - sum, f.x, f.y), lower);
  tiles.rotation[0] = a.rotation;
  tiles.rotation[1] = b.rotation;
  tiles.rotation[2] = c.rotation;
  return tiles;
}

// Weights for blending what the tiles show: w_i ~ weight_i^exponent * (1 + contrast * sine of the slope's
// angle).
//
// deriv     each tile's derivative, of any orientation: only its length counts
// exponent  taken into [1, 1000]; 7 confines the mixture to narrow borders
// contrast  taken into [0, 1000]; a vertical tile counts 1 + contrast times a flat one. 1.5; for values
//           without a slope use 0
// source    Mikkelsen 2022 (exponent, steeper tiles prevail); own formula
fn surfgrad_hex_weights(tiles: SurfgradHexTiles, deriv: array<vec2f, 3>, exponent: f32,
                        contrast: f32) -> vec3f {
  let k = min(max(exponent, 1.0), 1000.0);
  let gain = min(max(contrast, 0.0), 1000.0);
  // Relative to the largest weight, at least 1/3: no power underflows to 0 / 0.
  let ratio = (1.0 / max(max(tiles.weight.x, tiles.weight.y), tiles.weight.z)) * tiles.weight;
  // Beyond 1e30 the sine is 1 to rounding.
  let square =
      min(vec3f(dot(deriv[0], deriv[0]), dot(deriv[1], deriv[1]), dot(deriv[2], deriv[2])), vec3f(1e30));
  let w = vec3f(surfgrad_pow(ratio.x, k), surfgrad_pow(ratio.y, k), surfgrad_pow(ratio.z, k)) *
          (1.0 + gain * sqrt(square / (1.0 + square)));
  return (1.0 / (w.x + w.y + w.z)) * w;
}

// The tiled map's derivative by st: the tiles' derivatives turned back and blended.
//
// weights  from surfgrad_hex_weights
// deriv    derivative by st[i] that each tile samples
fn surfgrad_hex_derivative(tiles: SurfgradHexTiles, weights: vec3f, deriv: array<vec2f, 3>) -> vec2f {
  return weights.x * surfgrad_rotate_back(deriv[0], tiles.rotation[0]) +
         weights.y * surfgrad_rotate_back(deriv[1], tiles.rotation[1]) +
         weights.z * surfgrad_rotate_back(deriv[2], tiles.rotation[2]);
}

// Lost detail as roughness --------------------------------------------------------------------------------

// First and second moments of a slope (dh/ds, dh/dt). Average them component by component.
struct SurfgradSlopeMoments {
  mean: vec2f,   // E[dh/ds], E[dh/dt]
  square: vec2f, // E[(dh/ds)^2], E[(dh/dt)^2]
  product: f32,  // E[(dh/ds) (dh/dt)]
}

// Moments of a single slope: the start of all averages.
//
// source  own; the moments of Olano and Baker 2010, "LEAN Mapping", without their scale
fn surfgrad_moments_from_derivative(d: vec2f) -> SurfgradSlopeMoments {
  return SurfgradSlopeMoments(d, d * d, d.x * d.y);
}

// Roughness of a footprint whose slopes have these moments, shaded with the normal of their mean:
// sqrt(alpha^2 + var(dh/ds) + var(dh/dt)), at most 1.
//
// alpha   roughness of the surface between the bumps, in [0, 1]: that of GGX or Beckmann
// m       averaged moments; a bump scale multiplies the mean, and its square the others
// source  own; Beckmann slope statistics as in Olano and Baker 2010, equation 3, its trace alone
fn surfgrad_roughness_from_moments(alpha: f32, m: SurfgradSlopeMoments) -> f32 {
  let variance = max(m.square - m.mean * m.mean, vec2f(0.0));
  return min(sqrt(alpha * alpha + (variance.x + variance.y)), 1.0);
}

// Derivatives across pixels, in fragment shaders -----------------------------------------------------------
//
// Call these in uniform control flow.

// surfgrad_make_frame with the position's own derivatives (fine: coarse ones make blocks of 2x2 pixels).
fn surfgrad_make_frame_at(position: vec3f, normal: vec3f) -> SurfgradFrame {
  return surfgrad_make_frame(normal, dpdxFine(position), dpdyFine(position));
}
fn surfgrad_make_frame_at_two_sided(position: vec3f, normal: vec3f, front_facing: bool,
                                    back_faces: i32) -> SurfgradFrame {
  return surfgrad_make_frame_two_sided(normal, dpdxFine(position), dpdyFine(position), front_facing,
                                       back_faces);
}

// surfgrad_tangent_basis with the texture coordinate's own derivatives.
fn surfgrad_tangent_basis_at(frame: SurfgradFrame, st: vec2f) -> SurfgradTangentFrame {
  return surfgrad_tangent_basis(frame, dpdxFine(st), dpdyFine(st));
}
