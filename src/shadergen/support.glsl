// Functions that generated code calls besides the library's, in common code (spelling.hpp). Only those that
// are called become part of it.

// Frames and spaces (engine/point.hpp, engine/layers/normal_map.hpp) ------------------------------------------

// A vertex frame of which a zero bitangent leaves nothing.
SurfgradTangentFrame stack_sound_basis(SurfgradTangentFrame vertex) {
  bool collapsed = surfgrad_max_abs(vertex.bitangent) == 0.0;
  SurfgradTangentFrame basis;
  basis.tangent = select(collapsed, vec3(0.0, 0.0, 0.0), vertex.tangent);
  basis.bitangent = vertex.bitangent;
  return basis;
}

// The vertex frame for a later pass: its tangent turned into the plane of the new base normal, its bitangent
// kept on its own side.
SurfgradTangentFrame stack_rebased_basis(SurfgradFrame frame, SurfgradTangentFrame vertex) {
  vec3 along = surfgrad_from_volume_gradient(frame.normal, vertex.tangent);
  // Removing the part along the normal leaves rounding, which points anywhere.
  float rounding = 8.0 * SURFGRAD_EPSILON * surfgrad_max_abs(vertex.tangent);
  SurfgradTangentFrame basis;
  basis.tangent =
      select(rounding < surfgrad_max_abs(along), surfgrad_normalize_or_zero(along), vec3(0.0, 0.0, 0.0));
  vec3 bitangent = cross(frame.normal, basis.tangent);
  basis.bitangent = select(dot(bitangent, vertex.bitangent) < 0.0, -1.0, 1.0) * bitangent;
  return basis;
}

bool stack_is_zero(mat3 m) {
  return max(max(surfgrad_max_abs(m[0]), surfgrad_max_abs(m[1])), surfgrad_max_abs(m[2])) == 0.0;
}

// A volume gradient of object space in world space, in units of a height along the base normal.
vec3 stack_object_gradient_in_world(mat3 world_from_object, mat3 object_from_world, vec3 normal, vec3 gradient) {
  float stretch = length(product(transpose(world_from_object), normal));
  return stretch * product(transpose(object_from_world), gradient);
}

// What a volume gradient of object space adds to the sum: N - G becomes M^-T (N - G) as a whole (Golubev,
// equation 33).
vec3 stack_from_object_gradient(mat3 world_from_object, mat3 object_from_world, vec3 normal, vec3 gradient) {
  vec3 object_normal = surfgrad_normalize_or_zero(product(transpose(world_from_object), normal));
  vec3 g = stack_object_gradient_in_world(world_from_object, object_from_world, normal, gradient);
  return g - dot(object_normal, gradient) * normal;
}

// Whether changes along the screen span nothing: parallel to rounding, or one is zero.
bool stack_collapsed(vec2 dst_dx, vec2 dst_dy, vec3 dp_dx, vec3 dp_dy) {
  vec2 s = surfgrad_reciprocal_or_zero(surfgrad_max_abs__vec2(dst_dx)) * dst_dx;
  vec2 t = surfgrad_reciprocal_or_zero(surfgrad_max_abs__vec2(dst_dy)) * dst_dy;
  vec3 x = surfgrad_reciprocal_or_zero(surfgrad_max_abs(dp_dx)) * dp_dx;
  vec3 y = surfgrad_reciprocal_or_zero(surfgrad_max_abs(dp_dy)) * dp_dy;
  return !(SURFGRAD_EPSILON < abs(s.x * t.y - s.y * t.x)) ||
         !(SURFGRAD_EPSILON < surfgrad_max_abs(cross(x, y)));
}

// Maps (engine/texture.hpp) -------------------------------------------------------------------------------------

// A coordinate from the lower left in textures that begin at the upper left, and a change of one.
vec2 stack_from_top(vec2 st) { return vec2(st.x, 1.0 - st.y); }
vec2 stack_downwards(vec2 change) { return vec2(change.x, -change.y); }

// Codes as whole ones above the middle are flat: of 8 bits 128, and code 0 counts as code 1.
vec2 stack_whole_code(vec2 code, float most, float flat_code) {
  vec2 d = (most * code - flat_code) / (flat_code - 1.0);
  return vec2(max(d.x, -1.0), max(d.y, -1.0));
}

// Sides of a map in units of the shorter.
vec2 stack_sides(vec2 size) { return size / min(size.x, size.y); }

SurfgradHexTiles stack_hex_tiles(vec2 st, float turn, vec2 sides) {
  SurfgradHexOrigin origin;
  origin.start = uint(0);
  origin.shift = vec2(0.0, 0.0);
  return surfgrad_hex_tiles(st, turn, 0.5, sides, origin);
}

// Weights of tiles by place alone: of values without a slope.
vec3 stack_hex_weights_by_place(SurfgradHexTiles tiles) {
  vec2 flat_slopes[3];
  flat_slopes[0] = vec2(0.0, 0.0);
  flat_slopes[1] = vec2(0.0, 0.0);
  flat_slopes[2] = vec2(0.0, 0.0);
  return surfgrad_hex_weights(tiles, flat_slopes, 7.0, 0.0);
}

// A change on the map's plane as one in a tile, which turns where texels are square.
vec2 stack_in_tile(vec2 change, vec2 sides, vec2 rotation) {
  return surfgrad_rotate(sides * change, rotation) / sides;
}

// A derivative by a tile's coordinate as one by the map's.
vec2 stack_from_tile(vec2 derivative, vec2 sides, vec2 rotation) {
  return sides * surfgrad_rotate_back(derivative / sides, rotation);
}

// Roughness (docs/shader-export.md) --------------------------------------------------------------------------------

float stack_square(float x) { return x * x; }

// How much of a filtered normal's shortening is minification's: none where the map is magnified and texels are
// blended, all from level 1 on.
float stack_minified(vec2 dst_dx, vec2 dst_dy, vec2 size) {
  return min(max(surfgrad_texture_lod(dst_dx, dst_dy, size), 0.0), 1.0);
}

// Variance along an axis of the slopes that an average of unit normals hides (Toksvig 2005, "Mipmapping normal
// maps"). Where slopes s, t have variance v along each axis around a flat mean, the average is as long as its
// part along the axis, E[1 / sqrt(1 + s^2 + t^2)] = 1 - E[s^2 + t^2] / 2 + ... = 1 - v + O(v^2), whose v is
// (1 - |m|) / |m| to the same order. Of Gaussian slopes it gives v - 2 v^2 + O(v^3): never too rough.
float stack_hidden_variance(vec3 m) {
  float size = length(m);
  return max(1.0 - size, 0.0) / max(size, 0.001);
}

// Roughness of slopes that scatter around those of the microfacets. Beckmann's slopes have variance alpha^2 / 2
// along each axis; those of independent slopes add up: alpha'^2 = alpha^2 + 2 v (Olano and Baker 2010, "LEAN
// Mapping"; GGX has no variance and is widened alike).
float stack_widened(float roughness, float variance) {
  SurfgradSlopeMoments hidden;
  hidden.mean = vec2(0.0, 0.0);
  hidden.square = vec2(variance, variance);
  hidden.product = 0.0;
  return sqrt(surfgrad_roughness_from_moments(roughness * roughness, hidden));
}

// Heights (engine/layers/height_map.hpp, image/bicubic.hpp) --------------------------------------------------------

// How much of a slope comes from the smooth surface: all where the map is magnified, none from half a level of
// minification on.
float stack_smooth_share(float lod) { return min(max((0.5 - lod) / 0.45, 0.0), 1.0); }

// 1 in the odd columns or rows of pixels, else 0.
float stack_odd(float raster) {
  float pixel = floor(raster);
  return pixel - 2.0 * floor(0.5 * pixel);
}

// Four neighbouring texels along an axis: the point lies `fraction` past the texel `low`.
struct StackTaps {
  float low;
  float fraction;
  float direction; // -1 on a reflected copy, where texels run against the coordinate
};

// wrap: 0 repeat, 1 mirror, 2 clamp
StackTaps stack_cubic_taps(float s, float size, int wrap) {
  StackTaps taps;
  taps.direction = 1.0;
  float x = s;
  if (wrap == 0) {
    x = (s - floor(s)) * size - 0.5;
  } else if (wrap == 1) {
    float phase = s - 2.0 * floor(0.5 * s);
    x = select(1.0 < phase, 2.0 - phase, phase) * size - 0.5;
    taps.direction = select(1.0 < phase, -1.0, 1.0);
  } else {
    // It goes on until all four texels are the border's: the spline ends level there.
    x = min(max(s * size - 0.5, -2.0), size + 1.0);
  }
  taps.low = floor(x);
  taps.fraction = x - taps.low;
  return taps;
}

// An index within a period of [0, size) brought into it.
int stack_wrapped(int i, int size, int wrap) {
  int at = i;
  if (wrap == 0) {
    at = select(at < 0, at + size, at);
    at = select(at >= size, at - size, at);
  } else if (wrap == 1) {
    at = select(at < 0, -at - 1, at);
    at = select(at >= size, 2 * size - 1 - at, at);
  }
  return min(max(at, 0), size - 1);
}

// Weights of four neighbours in a uniform cubic B-spline.
vec4 stack_spline_weights(float f) {
  float g = 1.0 - f;
  return vec4(g * g * g / 6.0, 4.0 / 6.0 - f * f * (1.0 - 0.5 * f), 4.0 / 6.0 - g * g * (1.0 - 0.5 * g),
              f * f * f / 6.0);
}

float stack_spline_value(vec4 row0, vec4 row1, vec4 row2, vec4 row3, vec2 fraction) {
  vec4 along_s = stack_spline_weights(fraction.x);
  vec4 rows = vec4(dot(row0, along_s), dot(row1, along_s), dot(row2, along_s), dot(row3, along_s));
  return dot(rows, stack_spline_weights(fraction.y));
}

// Parallax (engine/layers/parallax.hpp) --------------------------------------------------------------------------

// Share of a way over the map that a march bears: 2^16 texels of the level it is on.
float stack_way_share(vec2 way, vec2 size, float lod) {
  float shrink = exp2(-max(floor(lod + 0.5), 0.0));
  vec2 texels = vec2(max(shrink * size.x, 1.0), max(shrink * size.y, 1.0));
  float covered = surfgrad_max_abs__vec2(surfgrad_saturated__vec2(texels * way));
  return select(65536.0 < covered, 65536.0 / max(covered, 1.0), 1.0);
}

// What the change of an interpolated normal is multiplied by to be that of the unit normal on the same side.
float stack_unit_rate(vec3 normal, vec3 interpolated) {
  float size = surfgrad_reciprocal_or_zero(length(interpolated));
  return select(dot(normal, interpolated) < 0.0, -size, size);
}

// The normal reflected towards the viewer where it faces away (section 2.11).
vec3 stack_reflected(vec3 normal, vec3 to_viewer, float side) {
  float along = dot(to_viewer, normal);
  return select(side * along < 0.0, normal - (2.0 * along) * to_viewer, normal);
}

// The pixel's footprint on the plane through the point that lies in the relief.
SurfgradScreenDerivatives stack_relief_footprint(SurfgradFrame base, vec3 surfgrad, vec3 plane, vec3 position,
                                                 mat4 relative_from_screen, vec2 raster) {
  SurfgradScreenDerivatives dp;
  if (dot(abs(relative_from_screen[3]) + abs(relative_from_screen[0]), vec4(1.0, 1.0, 1.0, 1.0)) > 0.0) {
    dp = surfgrad_screen_derivatives(position, plane, relative_from_screen, raster.x, raster.y);
  } else {
    // A raster over the surface: its pixels stay over their own points, which rise as the height does.
    dp.dp_dx = base.sigma_x + dot(base.sigma_x, surfgrad) * base.normal;
    dp.dp_dy = base.sigma_y + dot(base.sigma_y, surfgrad) * base.normal;
  }
  return dp;
}

// Texture coordinates there are those of the base point below.
SurfgradTextureDerivatives stack_relief_derivatives(SurfgradFrame base, vec2 dst_dx, vec2 dst_dy,
                                                    SurfgradScreenDerivatives dp) {
  vec3 grad_s = surfgrad_from_height_derivative(base, vec2(dst_dx.x, dst_dy.x));
  vec3 grad_t = surfgrad_from_height_derivative(base, vec2(dst_dx.y, dst_dy.y));
  return surfgrad_projected_derivatives(grad_s, grad_t, dp.dp_dx, dp.dp_dy);
}

// Decals (engine/layers/decal.hpp) ---------------------------------------------------------------------------------

// A decal as five vec4 hold it.
struct StackDecal {
  SurfgradDecalFrame frame;
  vec3 outward;      // against the way it projects
  vec3 size;         // box: half its edges; cone and wedge: tangent of half the angle, depth; else radius
  float half_length; // of a capsule's or wedge's segment
  float scale;
  float opacity;
  float blend; // 0 add, 1 mix, 2 replace
};

// origin: what positions are relative to
StackDecal stack_decal(int i, vec3 origin) {
  vec4 place = stack_decals(5 * i);
  vec4 x = stack_decals(5 * i + 1);
  vec4 y = stack_decals(5 * i + 2);
  vec4 z = stack_decals(5 * i + 3);
  vec4 size = stack_decals(5 * i + 4);
  StackDecal decal;
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
vec3 stack_in_decal(SurfgradDecalFrame frame, vec3 unchanging, vec3 v) {
  vec3 across = v - dot(v, unchanging) * unchanging;
  return vec3(dot(across, frame.axis_x), dot(across, frame.axis_y), dot(across, frame.axis_z));
}
