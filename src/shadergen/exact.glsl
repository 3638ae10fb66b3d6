// The engine's sampler (src/image) for `exact` access, in GLSL 450: the same texels, the same filters, in the same
// order. Only functions that are called become part of the code; NAME_maps is declared before, and the
// functions of exact_words: NAME_block_of(map) and NAME_word(block, at).

struct StackMap {
  int block; // of its words
  uint texels, levels, level_count;
  uint format; // 0 floats, 1 slope16, 2 unorm16
  uint components;
  bool encoded;
  float scale;
  uint nodes, rows, row_words;
};

StackMap stack_map_of(int map) {
  uint first = uint(8 * map);
  uint format = stack_maps[first + 3u];
  return StackMap(stack_block_of(map), stack_maps[first], stack_maps[first + 1u], stack_maps[first + 2u],
                  format & 255u, (format >> 8u) & 255u, format >= 65536u, uintBitsToFloat(stack_maps[first + 4u]),
                  stack_maps[first + 5u], stack_maps[first + 6u], stack_maps[first + 7u]);
}

// Of `count`: what a coordinate that is not a number, or a device's rounding, makes of an index stays in the buffer.
uint stack_index(float i, float count) { return 0.0 < i ? uint(min(i, count - 1.0)) : 0u; }

vec2 stack_map_size(int map) {
  int block = stack_block_of(map);
  uint levels = stack_maps[uint(8 * map) + 1u];
  return vec2(float(stack_word(block, levels)), float(stack_word(block, levels + 1u)));
}

// image/anisotropy.hpp

struct StackFootprint {
  float lod;
  vec2 axis;
  float probes;
};

StackFootprint stack_footprint(int map, vec2 dst_dx, vec2 dst_dy, int most) {
  vec2 size = stack_map_size(map);
  float lod = surfgrad_texture_lod(dst_dx, dst_dy, size);
  if (most == 1) return StackFootprint(lod, vec2(0.0), 1.0);
  vec2 x = size * dst_dx;
  vec2 y = size * dst_dy;
  float scale = max(surfgrad_max_abs(x), surfgrad_max_abs(y));
  float inverse = surfgrad_reciprocal_or_zero(scale);
  vec2 u = inverse * x;
  vec2 v = inverse * y;
  float square = max(dot(u, u), dot(v, v));
  float area = abs(u.x * v.y - u.y * v.x);
  float wanted = min(square / max(area, SURFGRAD_LEAST), max(scale * sqrt(square), 1.0));
  float ratio = min(max(wanted, 1.0), float(most));
  float probes = max(-floor(1.0 / 64.0 - ratio), 1.0);
  vec2 axis = dot(u, u) < dot(v, v) ? dst_dy : dst_dx;
  return StackFootprint(lod - surfgrad_log2(ratio), axis, min(probes, float(most)));
}

StackFootprint stack_footprint_in_tile(StackFootprint footprint, vec2 sides, vec2 rotation) {
  vec2 axis = surfgrad_rotate(sides * footprint.axis, rotation) / sides;
  return StackFootprint(footprint.lod, axis, footprint.probes);
}

// image/sampler.hpp. wrap: 0 repeat, 1 mirror, 2 clamp; filter: 0 nearest, 1 bilinear, 2 trilinear

float stack_folded(float s, int wrap) {
  if (wrap == 2) return s;
  if (wrap == 0) return s - floor(s);
  float phase = s - 2.0 * floor(0.5 * s);
  return 1.0 < phase ? 2.0 - phase : phase;
}

// The first of two neighbouring texels (x) and the weight of the second (y).
vec2 stack_linear_tap(float s, float n, int wrap) {
  if (wrap == 0) {
    float x = max(s * n - 0.5, -0.5);
    float low = floor(x);
    return vec2(low < 0.0 ? n - 1.0 : low, x - low);
  }
  float x = min(max(s * n - 0.5, 0.0), n - 1.0);
  float low = floor(x);
  return vec2(low, x - low);
}

vec3 stack_texel(StackMap map, uint word) {
  if (map.format == 1u) {
    int codes = int(stack_word(map.block, word));
    return vec3(map.scale * float((codes << 16) >> 16), map.scale * float(codes >> 16), 0.0);
  }
  if (map.format == 2u) return vec3(map.scale * float(stack_word(map.block, word) & 65535u), 0.0, 0.0);
  vec3 texel = vec3(uintBitsToFloat(stack_word(map.block, word)), 0.0, 0.0);
  if (map.components > 1u) texel.y = uintBitsToFloat(stack_word(map.block, word + 1u));
  if (map.components > 2u) texel.z = uintBitsToFloat(stack_word(map.block, word + 2u));
  return texel;
}

vec3 stack_filter_level(StackMap map, uint level, vec2 st, int wrap_s, int wrap_t) {
  uint row = map.levels + 3u * level;
  uint width = stack_word(map.block, row);
  uint words = map.format == 0u ? map.components : 1u;
  vec2 x = stack_linear_tap(st.x, float(width), wrap_s);
  uint height = stack_word(map.block, row + 1u);
  vec2 y = stack_linear_tap(st.y, float(height), wrap_t);
  uint place = stack_index(y.x, float(height)) * (width + 1u) + stack_index(x.x, float(width));
  uint word = map.texels + stack_word(map.block, row + 2u) + place * words;
  uint above = word + (width + 1u) * words;
  vec3 a = stack_texel(map, word), b = stack_texel(map, word + words);
  vec3 c = stack_texel(map, above), d = stack_texel(map, above + words);
  vec3 lower = a + x.y * (b - a);
  vec3 upper = c + x.y * (d - c);
  return lower + y.y * (upper - lower);
}

vec3 stack_map_at(int number, vec2 coordinate, float lod, int wrap_s, int wrap_t, int filter_kind) {
  StackMap map = stack_map_of(number);
  vec2 st = vec2(stack_folded(coordinate.x, wrap_s), stack_folded(coordinate.y, wrap_t));
  if (filter_kind == 0) {
    uint width = stack_word(map.block, map.levels);
    uint words = map.format == 0u ? map.components : 1u;
    vec2 n = stack_map_size(number);
    uint x = stack_index(st.x * n.x, n.x);
    uint y = stack_index(st.y * n.y, n.y);
    return stack_texel(map, map.texels + stack_word(map.block, map.levels + 2u) + (y * (width + 1u) + x) * words);
  }
  if (filter_kind == 1) return stack_filter_level(map, 0u, st, wrap_s, wrap_t);
  float clamped = 0.0 < lod ? min(lod, float(map.level_count - 1u)) : 0.0;
  float low = floor(clamped);
  float fraction = clamped - low;
  vec3 fine = stack_filter_level(map, uint(low), st, wrap_s, wrap_t);
  if (!(0.0 < fraction)) return fine;
  return fine + fraction * (stack_filter_level(map, uint(low) + 1u, st, wrap_s, wrap_t) - fine);
}

// The components of a map over a footprint around st.
vec3 stack_map(int number, vec2 st, StackFootprint footprint, int wrap_s, int wrap_t, int filter_kind) {
  if (footprint.probes <= 1.0) return stack_map_at(number, st, footprint.lod, wrap_s, wrap_t, filter_kind);
  vec3 sum = vec3(0.0);
  for (int k = 0; k < int(footprint.probes); ++k) {
    float along = (float(k) + 0.5) / footprint.probes - 0.5;
    sum += stack_map_at(number, st + along * footprint.axis, footprint.lod, wrap_s, wrap_t, filter_kind);
  }
  return sum / footprint.probes;
}

// The slope of a map of slopes, or of normals that are filtered as they are encoded.
vec2 stack_map_slope(int number, vec2 st, StackFootprint footprint, int wrap_s, int wrap_t, int filter_kind) {
  vec3 texel = stack_map(number, st, footprint, wrap_s, wrap_t, filter_kind);
  StackMap map = stack_map_of(number);
  if (!map.encoded) return texel.xy;
  if (map.components == 3u) return surfgrad_derivative_from_normal(texel);
  return surfgrad_derivative_from_normal(texel.xy);
}

// image/height_map.hpp

float stack_wrapped_slope(float coordinate, float slope, int wrap) {
  if (wrap == 1) return 1.0 < coordinate - 2.0 * floor(0.5 * coordinate) ? -slope : slope;
  if (wrap == 2) return coordinate < 0.0 || 1.0 < coordinate ? 0.0 : slope;
  return slope;
}

vec2 stack_map_height_slope_at(int number, vec2 st, float lod, int wrap_s, int wrap_t, int filter_kind) {
  vec2 slope = stack_map_at(number, st, lod, wrap_s, wrap_t, filter_kind).xy;
  return vec2(stack_wrapped_slope(st.x, slope.x, wrap_s), stack_wrapped_slope(st.y, slope.y, wrap_t));
}

// Over a footprint: of every probe the slope that shows there.
vec2 stack_map_height_slope(int number, vec2 st, StackFootprint footprint, int wrap_s, int wrap_t,
                            int filter_kind) {
  vec2 sum = vec2(0.0);
  for (int k = 0; k < int(footprint.probes); ++k) {
    float along = (float(k) + 0.5) / footprint.probes - 0.5;
    sum += stack_map_height_slope_at(number, st + along * footprint.axis, footprint.lod, wrap_s, wrap_t,
                                     filter_kind);
  }
  return sum / footprint.probes;
}

// Maps that hardware filters out of textures. Its coordinates are within one period, as the engine's are: theirs
// round alike.

// Of a map's texture: what a component is multiplied by.
float stack_unit(int number) { return uintBitsToFloat(stack_maps[uint(8 * number) + 4u]); }

vec2 stack_in_period(vec2 st, int wrap_s, int wrap_t) {
  return vec2(stack_folded(st.x, wrap_s), stack_folded(st.y, wrap_t));
}

// The texel of level 0 that holds the point.
ivec2 stack_nearest(int number, vec2 st, int wrap_s, int wrap_t) {
  vec2 size = stack_map_size(number);
  vec2 at = stack_in_period(st, wrap_s, wrap_t) * size;
  return ivec2(int(stack_index(at.x, size.x)), int(stack_index(at.y, size.y)));
}

vec2 stack_wrapped_slopes(vec2 st, vec2 slope, int wrap_s, int wrap_t) {
  return vec2(stack_wrapped_slope(st.x, slope.x, wrap_s), stack_wrapped_slope(st.y, slope.y, wrap_t));
}

// A height of level 0.
float stack_map_texel(int number, int x, int y) {
  StackMap map = stack_map_of(number);
  uint width = stack_word(map.block, map.levels);
  return stack_texel(map, map.texels + stack_word(map.block, map.levels + 2u) + uint(y) * (width + 1u) + uint(x)).x;
}

// image/cube_map.hpp

float stack_cube_lod(int number, vec3 direction, vec3 direction_dx, vec3 direction_dy) {
  float inverse = surfgrad_reciprocal_or_zero(surfgrad_max_abs(direction));
  vec3 d = inverse * direction;
  vec3 x = cross(d, inverse * direction_dx);
  vec3 y = cross(d, inverse * direction_dy);
  float scale = max(surfgrad_max_abs(x), surfgrad_max_abs(y));
  vec3 u = surfgrad_reciprocal_or_zero(scale) * x;
  vec3 v = surfgrad_reciprocal_or_zero(scale) * y;
  float most = max(0.5, max(dot(u, u), dot(v, v)));
  float size = stack_map_size(number).x - 2.0;
  return surfgrad_log2(0.5 * size) + surfgrad_log2(scale) + 0.5 * surfgrad_log2(most) -
         0.25 * surfgrad_log2(max(1.0, dot(d, d)));
}

vec3 stack_sample_cube_level(StackMap map, uint face, vec2 st, uint level) {
  uint row = map.levels + 3u * level;
  uint width = stack_word(map.block, row);
  vec2 p = (0.5 * st + 0.5) * (float(width) - 2.0) + 0.5;
  vec2 low = floor(p);
  vec2 fraction = p - low;
  uint line = face * width + stack_index(low.y, float(width - 1u));
  uint place = line * (width + 1u) + stack_index(low.x, float(width));
  uint word = map.texels + stack_word(map.block, row + 2u) + place * 3u;
  uint above = word + (width + 1u) * 3u;
  vec3 a = stack_texel(map, word), b = stack_texel(map, word + 3u);
  vec3 c = stack_texel(map, above), d = stack_texel(map, above + 3u);
  vec3 lower = a + fraction.x * (b - a);
  vec3 upper = c + fraction.x * (d - c);
  return lower + fraction.y * (upper - lower);
}

vec3 stack_sample_cube(int number, vec3 d, float lod) {
  if (surfgrad_max_abs(d) == 0.0) return vec3(0.0);
  vec3 a = abs(d);
  bool x_major = !(a.x < a.y || a.x < a.z);
  bool y_major = !(x_major || a.y < a.z);
  float major = x_major ? d.x : y_major ? d.y : d.z;
  bool negative = major < 0.0;
  float z_turned = negative ? d.z : -d.z;
  float right = x_major ? z_turned : y_major || !negative ? d.x : -d.x;
  float up = y_major ? z_turned : d.y;
  uint face = (x_major ? 0u : y_major ? 2u : 4u) + (negative ? 1u : 0u);
  vec2 st = vec2(right, up) / abs(major);
  StackMap map = stack_map_of(number);
  float clamped = 0.0 < lod ? min(lod, float(map.level_count - 1u)) : 0.0;
  float low = floor(clamped);
  float fraction = clamped - low;
  vec3 fine = stack_sample_cube_level(map, face, st, uint(low));
  if (!(0.0 < fraction)) return fine;
  return fine + fraction * (stack_sample_cube_level(map, face, st, uint(low) + 1u) - fine);
}

// image/height_march.hpp: the first crossing of a ray with a height field, over the nodes of its maxima

struct StackRayAxis {
  float start, way;
  float inverse_way; // 0 where the ray does not move
  float count;       // texels
  int wrap;
};

struct StackRay {
  StackMap field;
  uint level;
  StackRayAxis x, y;
};

// The cells from low up to, without, high that one node stands for where the ray is.
struct StackSpan {
  float low, high;
  float node;
};

// floor(a / b) of whole numbers below 2^24, 0 < b. A device's quotient may be wrong by 2.5 ulp, so that a multiple of b
// falls one too low; products of such numbers are exact and correct it.
float stack_floor_quotient(float a, float b) {
  float q = floor(a / b);
  float rest = a - q * b;
  return rest < 0.0 ? q - 1.0 : b <= rest ? q + 1.0 : q;
}

StackSpan stack_span_of(StackRayAxis axis, float cell, float size) {
  bool single = size == 1.0;
  if (axis.wrap == 2) {
    const float far = 4194304.0; // no cell number that a ray meets is as large
    float first = single ? -1.0 : 0.0;
    float node = stack_floor_quotient(min(max(cell, first), axis.count - 1.0), size);
    float low = node * size;
    return StackSpan(first < low ? low : -far, low + size < axis.count ? low + size : far, node);
  }
  float period = axis.wrap == 1 ? axis.count + axis.count : axis.count;
  float base = period * stack_floor_quotient(cell, period);
  float offset = cell - base;
  bool backwards = !(offset < axis.count);
  // Cell -1 between two mirror images shows texel 0 only, which cell 0 has as well.
  float inside = backwards ? max(period - 2.0 - offset, 0.0) : offset;
  float node = stack_floor_quotient(inside, size);
  float low = node * size;
  float high = min(low + size, axis.count);
  float mirrored_high = low == 0.0 ? period : period - 1.0 - low;
  return StackSpan(single ? cell : base + (backwards ? period - 1.0 - high : low),
                   single ? cell + 1.0 : base + (backwards ? mirrored_high : high), node);
}

// Texel that shows at an integer position of the endless lattice.
float stack_texel_at(StackRayAxis axis, float i) {
  if (axis.wrap == 2) return min(max(i, 0.0), axis.count - 1.0);
  float period = axis.wrap == 1 ? axis.count + axis.count : axis.count;
  float offset = i - period * stack_floor_quotient(i, period);
  return offset < axis.count ? offset : period - 1.0 - offset;
}

uint stack_texel_index(StackRayAxis axis, float i) { return stack_index(stack_texel_at(axis, i), axis.count); }

float stack_within(StackRayAxis axis, float cell, float height) {
  return min(max(axis.start + height * axis.way - cell, 0.0), 1.0);
}

// The ray's way through one cell: height (x), and 1 where it meets the bilinear surface (y).
vec2 stack_cross_cell(StackRay ray, vec2 cell, float from, float to) {
  uint row = ray.field.levels + 3u * ray.level;
  uint stride = stack_word(ray.field.block, row) + 1u;
  uint first = ray.field.texels + stack_word(ray.field.block, row + 2u);
  uint left = stack_texel_index(ray.x, cell.x), right = stack_texel_index(ray.x, cell.x + 1.0);
  uint below = first + stride * stack_texel_index(ray.y, cell.y);
  uint above = first + stride * stack_texel_index(ray.y, cell.y + 1.0);
  float corner = uintBitsToFloat(stack_word(ray.field.block, below + left));
  float along_x = uintBitsToFloat(stack_word(ray.field.block, below + right)) - corner;
  float above_left = uintBitsToFloat(stack_word(ray.field.block, above + left));
  float along_y = above_left - corner;
  float twist = (uintBitsToFloat(stack_word(ray.field.block, above + right)) - above_left) - along_x;
  float x0 = stack_within(ray.x, cell.x, from), x1 = stack_within(ray.x, cell.x, to);
  float y0 = stack_within(ray.y, cell.y, from), y1 = stack_within(ray.y, cell.y, to);
  // Clearance over the way u from 0 to 1: before - fall * u - bend * u^2.
  float before = from - (corner + along_x * x0 + (along_y + twist * x0) * y0);
  float after = to - (corner + along_x * x1 + (along_y + twist * x1) * y1);
  float bend = twist * ((x1 - x0) * (y1 - y0));
  float fall = before - after - bend;
  float square = fall * fall + 4.0 * bend * before;
  bool starts_below = !(0.0 < before);
  bool ends_below = !(0.0 < after);
  bool dips = bend < 0.0 && 0.0 < fall && fall < -(bend + bend) && !(square < 0.0);
  float root = sqrt(max(square, 0.0));
  bool sinks = !(fall < 0.0);
  float numerator = sinks ? before + before : root - fall;
  float denominator = sinks ? fall + root : bend + bend;
  bool level_way = !(0.0 < denominator);
  float share = numerator / (level_way ? 1.0 : denominator);
  float u = level_way || starts_below ? 0.0 : min(max(share, 0.0), 1.0);
  return vec2(from + u * (to - from), starts_below || ends_below || dips ? 1.0 : 0.0);
}

// Largest height over the cells of a node.
float stack_node_maximum(StackRay ray, float column, float line, float size, uint order) {
  uint first = stack_word(ray.field.block, ray.field.rows + ray.level * ray.field.row_words + order);
  uint width = uint(stack_floor_quotient(ray.x.count + size - 1.0, size));
  uint lines = uint(stack_floor_quotient(ray.y.count + size - 1.0, size));
  uint node = stack_index(line, float(lines)) * width + stack_index(column, float(width));
  return uintBitsToFloat(stack_word(ray.field.block, ray.field.nodes + first + node));
}

float stack_leaves_at(StackRayAxis axis, StackSpan span) {
  float border = 0.0 < axis.way ? span.low : span.high;
  return axis.inverse_way == 0.0 ? -SURFGRAD_MOST : (border - axis.start) * axis.inverse_way;
}

float stack_cell_at(StackRayAxis axis, float height) { return floor(axis.start + height * axis.way); }

float stack_next_cell(StackRayAxis axis, StackSpan span, float from, bool crosses, float lowest) {
  bool down = 0.0 < axis.way;
  float on_way = min(max(stack_cell_at(axis, lowest), span.low), span.high - 1.0);
  float passed = down ? span.low - 1.0 : span.high;
  return crosses ? passed : down ? min(on_way, from) : max(on_way, from);
}

// First crossing on the way from height 1 down to `end`: height (x), and 1 where there is one (y).
vec2 stack_first_crossing(StackRay ray, float end) {
  uint last = stack_word(ray.field.block, ray.field.rows + ray.level * ray.field.row_words);
  float height = 1.0;
  // Above the whole map nothing is met.
  if (last > 0u) height = min(stack_node_maximum(ray, 0.0, 0.0, 2097152.0, last), 1.0);
  vec2 cell = vec2(stack_cell_at(ray.x, height), stack_cell_at(ray.y, height));
  uint order = 0u;
  float size = 1.0;
  bool searching = !(height < end);
  while (searching) {
    StackSpan x = stack_span_of(ray.x, cell.x, size);
    StackSpan y = stack_span_of(ray.y, cell.y, size);
    float leaves_x = stack_leaves_at(ray.x, x);
    float leaves_y = stack_leaves_at(ray.y, y);
    float leaves = max(leaves_x, leaves_y);
    float lowest = min(max(leaves, end), height);
    bool enters = false;
    if (size == 1.0) {
      vec2 hit = stack_cross_cell(ray, cell, height, lowest);
      if (hit.y > 0.0) return hit;
    } else {
      enters = !(stack_node_maximum(ray, x.node, y.node, size, order) < lowest);
    }
    searching = enters || end < leaves;
    if (enters) {
      order -= 1u;
      size *= 0.5;
    } else if (searching) {
      bool over_x = !(leaves_x < leaves_y);
      cell = vec2(stack_next_cell(ray.x, x, cell.x, over_x, lowest),
                  stack_next_cell(ray.y, y, cell.y, !over_x, lowest));
      height = lowest;
      if (order < last) {
        order += 1u;
        size += size;
      }
    }
  }
  return vec2(end, 0.0);
}

StackRayAxis stack_ray_axis(float coordinate, float dst, float n, int wrap) {
  float s = coordinate;
  if (wrap == 0) s = s - floor(s);
  if (wrap == 1) s = s - 2.0 * floor(0.5 * s);
  float way = dst * n;
  // A clamped ray from farther out meets nothing but the border's texel, and so it does from here.
  float out_ = abs(way) + 2.0;
  return StackRayAxis(min(max(s * n - 0.5, -out_), n + n + out_), way, surfgrad_reciprocal_or_zero(way), n, wrap);
}

// A ray in texels of the level nearest to the LOD.
StackRay stack_leveled_ray(int number, vec2 st, vec2 way, float lod, int wrap_s, int wrap_t) {
  StackMap field = stack_map_of(number);
  uint level = stack_index(floor(lod + 0.5), float(field.level_count));
  uint row = field.levels + 3u * level;
  vec2 count = max(vec2(float(stack_word(field.block, row)), float(stack_word(field.block, row + 1u))), vec2(1.0));
  vec2 dst = clamp(way, -1099511627776.0, 1099511627776.0);
  float length_ = surfgrad_max_abs(dst * count);
  dst *= 65536.0 < length_ ? 65536.0 / max(length_, 1.0) : 1.0;
  return StackRay(field, level, stack_ray_axis(st.x, dst.x, count.x, wrap_s),
                  stack_ray_axis(st.y, dst.y, count.y, wrap_t));
}

float stack_march(int number, vec2 st, vec2 dst, float lod, int wrap_s, int wrap_t) {
  return stack_first_crossing(stack_leveled_ray(number, st, dst, lod, wrap_s, wrap_t), 0.0).x;
}

// Sunlight at a point of the field: 1 where the way to the light is free.
float stack_visible(int number, vec2 st, float height, vec2 dst, float lod, int wrap_s, int wrap_t) {
  StackRay ray = stack_leveled_ray(number, st, dst, lod, wrap_s, wrap_t);
  float bias = 8.0 * SURFGRAD_EPSILON *
               (1.0 + max(abs(ray.x.start), abs(ray.y.start)) + max(abs(ray.x.way), abs(ray.y.way)));
  float from = max(height + bias, 0.0);
  ray.x.start -= from * ray.x.way;
  ray.y.start -= from * ray.y.way;
  return stack_first_crossing(ray, from).y > 0.0 ? 0.0 : 1.0;
}
