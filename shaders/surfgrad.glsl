// Surface gradient based bump mapping: the functions of include/surfgrad in GLSL.
//
// One self-contained file, for GLSL 450 and newer (any stage, Vulkan or OpenGL) and for GLSL ES 3.00
// and newer (WebGL2): paste it or #include it after the #version line. surfgrad_name is
// surfgrad::name of the C++ core; what a function means is said there at length and here in short.
//
//   SurfgradFrame frame = surfgrad_make_frame(normal);                          // interpolated normal
//   SurfgradTangentFrame tbn = surfgrad_mikktspace_basis(normal, tangent.xyz, tangent.w);
//   vec2 slope = surfgrad_derivative_from_normal(2.0 * texture(map, st).xyz - 1.0);
//   vec3 n = surfgrad_resolve_normal(frame, surfgrad_from_tbn(slope, tbn.tangent, tbn.bitangent));
//
// Several maps on one texture coordinate: add their slopes, then call surfgrad_from_tbn once. Anything
// else: add the surface gradients, then resolve once.
//
// Conventions (docs/conventions.md)
//   texture origin  lower left, t up. Where it is upper left (t down), either sample 1 - t everywhere, or
//                   keep t and count green down as +t
//   green           along +t: "green up" with t up. A map of the other sign negates slope.y
//   slopes          (dh/ds, dh/dt), dimensionless, within +-128 from a normal
//   spaces          all vectors of one frame are in one space, usually world space; positions may be
//                   relative to the camera, and no result depends on the scale of the scene
//   tangents        interpolated and not normalised; bitangent = sign * cross(normal, tangent)
//   resolve         n' = normalize(n - resolve_sign * surfgrad)
//   back faces      SURFGRAD_BACK_FACES_SAME (nothing turns), _MIRROR (the interpolated normal is negated,
//                   bumps stay bumps), _FLIP (the front's perturbed normal negated: bumps become dents).
//                   Tangents never change side. For a mirroring object transform negate front_facing
//   matrices        times column vectors. A row of the C++ matrix is a row here: mat3(a, b, c) of GLSL
//                   takes columns
//   screen          derivatives per pixel; neither their rate nor which way y runs changes a result
//
// What differs from C++ (docs/shaders.md): numbers are float; what shading languages leave open (NaN, Inf,
// subnormal numbers) is left open here; directions are right for lengths from 1e-18 to 1e18, and shorter
// vectors count as zero; an operation may err by what the API allows it.
//
// SURFGRAD_FRAGMENT, defined before this file in a fragment shader, adds the functions that take
// derivatives across pixels (the last section).

#ifndef SURFGRAD_GLSL
#define SURFGRAD_GLSL

#ifdef GL_ES
precision highp float;
precision highp int;
#endif

// Numbers -----------------------------------------------------------------------------------------------

const float SURFGRAD_EPSILON = 1.1920928955078125e-7; // from 1 to the next number
const float SURFGRAD_LEAST = 1.17549435e-38;          // smallest normal number
const float SURFGRAD_MOST = 3.40282347e38;            // largest number

// Largest magnitude of a component: a length that needs no square root and cannot overflow.
float surfgrad_max_abs(vec2 v) { return max(abs(v.x), abs(v.y)); }
float surfgrad_max_abs(vec3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }

// 1 / a, or 0 where |a| is below the smallest normal number.
float surfgrad_reciprocal_or_zero(float a) { return abs(a) < SURFGRAD_LEAST ? 0.0 : 1.0 / a; }

// Parallax occlusion mapping -----------------------------------------------------------------------------

// Halvings of the step that holds the crossing.
const int SURFGRAD_PARALLAX_REFINEMENTS = 6;
// Finer steps are below the resolution of heights near 1.
const int SURFGRAD_PARALLAX_MOST_STEPS = 262144;

struct SurfgradParallaxHit {
  vec2 texture_coordinate; // where the ray meets the map
  float height;            // of the crossing, in [0, 1]
  bool hit;
};

// A march under way. The bracket: the ray is above the map at `upper`, at or below it at `lower`.
struct SurfgradParallaxMarch {
  vec2 st, dst;
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
//     float height = textureLod(heights, surfgrad_march_parallax_at(march), lod).x;
//     march = surfgrad_march_parallax_answer(march, height);
//   }
//   SurfgradParallaxHit hit = surfgrad_march_parallax_end(march);
//
// st          texture coordinate of the fragment, where the ray reaches height 0
// dst         surfgrad_project_to_texture_space towards the viewer: at height h the ray is over st + h * dst
// step_limit  steps of the search, within [1, SURFGRAD_PARALLAX_MOST_STEPS]. A feature narrower than
//             |dst| / step_limit can be stepped over
// height      in [0, 1]; the level of detail comes from the coordinate before correction (surfgrad_texture_lod)
// returns     (end) first height h, searched downwards, where the map reaches the ray, and st + h * dst
// degenerate  no crossing (every height below the ray): hit false, height 0, st unchanged. Heights of 1 and
//             more at the top: height 1. Zero dst gives the height at st
// source      Mikkelsen 2019, section 2.6; linear search, bisection and one interpolation
SurfgradParallaxMarch surfgrad_march_parallax_begin(vec2 st, vec2 dst, int step_limit) {
  int steps = clamp(step_limit, 1, SURFGRAD_PARALLAX_MOST_STEPS);
  return SurfgradParallaxMarch(st, dst, 1.0, 1.0, 1.0, 0.0, 0.0, steps, 0, 0, false);
}

// Whether a height is wanted: at most step_limit + 1 + SURFGRAD_PARALLAX_REFINEMENTS times.
bool surfgrad_march_parallax_asks(SurfgradParallaxMarch march) {
  return march.hit ? march.refined < SURFGRAD_PARALLAX_REFINEMENTS : march.searched <= march.steps;
}

// The texture coordinate where it is wanted.
vec2 surfgrad_march_parallax_at(SurfgradParallaxMarch march) { return march.st + march.ray * march.dst; }

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
  float share = march.upper_clearance *
                surfgrad_reciprocal_or_zero(march.upper_clearance - march.lower_clearance);
  float height = march.hit ? march.upper + share * (march.lower - march.upper) : 0.0;
  vec2 st = march.hit ? march.st + height * march.dst : march.st;
  return SurfgradParallaxHit(st, height, march.hit);
}

// The whole march in one statement: HEIGHT_AT(st) is a function or a macro.
#define SURFGRAD_MARCH_PARALLAX(hit, HEIGHT_AT, st, dst, step_limit)                                        \
  {                                                                                                         \
    SurfgradParallaxMarch march_ = surfgrad_march_parallax_begin(st, dst, step_limit);                      \
    while (surfgrad_march_parallax_asks(march_))                                                            \
      march_ = surfgrad_march_parallax_answer(march_, HEIGHT_AT(surfgrad_march_parallax_at(march_)));       \
    hit = surfgrad_march_parallax_end(march_);                                                              \
  }

#endif
