#include "io/obj.hpp"

#include "diagnostic/error.hpp"
#include "mesh/normals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace surfgrad::io {
namespace {

// Vertex numbers must fit 32 bits.
constexpr std::size_t most_corners = std::numeric_limits<std::uint32_t>::max();

// Quoted text in a message: enough to recognise it.
constexpr std::size_t longest_quote = 60;

constexpr std::string_view blanks = " \t\r\v\f";

/// Indices into the position, texture coordinate and normal lists; -1 where a face has none.
struct Corner {
  std::int64_t position = -1;
  std::int64_t uv = -1;
  std::int64_t normal = -1;
  friend bool operator==(const Corner&, const Corner&) = default;
};

struct CornerHash {
  std::size_t operator()(const Corner& corner) const {
    std::uint64_t hash = 0;
    for (const std::int64_t index : {corner.position, corner.uv, corner.normal}) {
      // Multiplicative hashing; the shift brings the well mixed upper bits down.
      hash = (hash ^ static_cast<std::uint64_t>(index)) * 0x9E3779B97F4A7C15u;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

struct Face {
  std::int64_t line = 0;
  std::size_t first_corner = 0;
  std::size_t corner_count = 0;
  std::uint32_t material = 0;
};

/// What a file holds, not yet welded.
struct Records {
  std::vector<vec3<float>> positions{};
  std::vector<vec2<float>> uvs{};
  std::vector<vec3<float>> normals{};
  std::vector<Corner> corners{};
  std::vector<Face> faces{};
  std::vector<std::string> materials{}; ///< in the order of first use
};

/// Takes the next blank-separated word off the front; empty at the end or at a comment.
std::string_view next_word(std::string_view& text) {
  const auto begin = text.find_first_not_of(blanks);
  if (begin == text.npos || text[begin] == '#') {
    text = {};
    return {};
  }
  text.remove_prefix(begin);
  const std::string_view word = text.substr(0, text.find_first_of(blanks));
  text.remove_prefix(word.size());
  return word;
}

std::string_view trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(blanks);
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

class Parser {
 public:
  explicit Parser(const std::filesystem::path& file) : file_(&file) {}

  Records parse(std::string_view text) {
    std::string joined;
    while (!text.empty()) {
      const std::size_t end = text.find('\n');
      std::string_view line = text.substr(0, end);
      text.remove_prefix(end == text.npos ? text.size() : end + 1);
      ++line_;
      // A backslash at the end continues the statement on the next line.
      const std::string_view content = trimmed(line);
      if (content.ends_with('\\')) {
        joined.append(content.substr(0, content.size() - 1)).append(" ");
        continue;
      }
      if (!joined.empty()) {
        joined.append(line);
        line = joined;
      }
      parse_statement(line);
      joined.clear();
    }
    if (!joined.empty()) parse_statement(joined);
    if (records_.faces.empty()) {
      line_ = 0;
      fail("has no faces", "expected at least one line such as: f 1 2 3");
    }
    check_ranges();
    return std::move(records_);
  }

 private:
  [[noreturn]] void fail(std::string problem, std::string remedy) const {
    const auto line = static_cast<int>(std::min<std::int64_t>(line_, std::numeric_limits<int>::max()));
    throw InputError{
        {.file = *file_, .line = line, .problem = std::move(problem), .remedy = std::move(remedy)}};
  }

  void parse_statement(std::string_view line) {
    const std::string_view keyword = next_word(line);
    if (keyword == "v")
      records_.positions.push_back(parse_vec3(line));
    else if (keyword == "vn")
      records_.normals.push_back(parse_vec3(line));
    else if (keyword == "vt") {
      const float u = parse_float(next_word(line));
      const std::string_view v = next_word(line);
      records_.uvs.push_back({u, v.empty() ? 0.0f : parse_float(v)});
    } else if (keyword == "f")
      parse_face(line);
    else if (keyword == "usemtl")
      select_material(trimmed(line).empty() ? "default" : trimmed(line));
    // Groups, smoothing, lines, points, curves and material libraries say nothing that is read here.
  }

  vec3<float> parse_vec3(std::string_view line) const {
    const float x = parse_float(next_word(line));
    const float y = parse_float(next_word(line));
    return {x, y, parse_float(next_word(line))};
  }

  /// A finite float. Text is read as double, so that numbers too small for a float become 0.
  float parse_float(std::string_view word) const {
    std::string_view digits = word;
    if (digits.starts_with('+')) digits.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool is_float = error == std::errc{} && end == digits.data() + digits.size() &&
                          std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max());
    if (!is_float)
      fail(word.empty() ? "a number is missing" : quoted(word) + " is not a finite number",
           "expected v x y z, vt u v or vn x y z");
    return static_cast<float>(value);
  }

  void parse_face(std::string_view line) {
    Face face{line_, records_.corners.size(), 0, 0};
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line))
      records_.corners.push_back(parse_corner(word));
    face.corner_count = records_.corners.size() - face.first_corner;
    if (face.corner_count < 3)
      fail(fmt::format("the face has {} corners", face.corner_count), "expected 3 or more");
    if (records_.corners.size() > most_corners)
      fail("too many corners", fmt::format("expected at most {}", most_corners));
    if (!material_) select_material("default");
    face.material = *material_;
    records_.faces.push_back(face);
  }

  /// v, v/vt, v//vn or v/vt/vn.
  Corner parse_corner(std::string_view word) const {
    std::array<std::string_view, 3> parts{};
    std::size_t count = 0;
    for (std::string_view rest = word;; ++count) {
      if (count == parts.size()) fail_corner(word);
      const auto slash = rest.find('/');
      parts[count] = rest.substr(0, slash);
      if (slash == rest.npos) break;
      rest.remove_prefix(slash + 1);
    }
    Corner corner;
    corner.position = parse_index("v", parts[0], records_.positions.size(), word);
    if (!parts[1].empty()) corner.uv = parse_index("vt", parts[1], records_.uvs.size(), word);
    if (!parts[2].empty()) corner.normal = parse_index("vn", parts[2], records_.normals.size(), word);
    return corner;
  }

  /// From 1, or from -1 backwards for the entry last read; the result counts from 0.
  std::int64_t parse_index(std::string_view kind, std::string_view digits, std::size_t read_so_far,
                           std::string_view word) const {
    std::int64_t index = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
    if (error != std::errc{} || end != digits.data() + digits.size() || index == 0) fail_corner(word);
    if (index > 0) return index - 1;
    const auto count = static_cast<std::int64_t>(read_so_far);
    if (index < -count) fail_range(kind, index, read_so_far);
    return count + index;
  }

  [[noreturn]] void fail_corner(std::string_view word) const {
    fail(quoted(word) + " is not a corner of a face",
         "expected v, v/vt, v//vn or v/vt/vn with numbers from 1, or from -1 backwards");
  }

  [[noreturn]] void fail_range(std::string_view kind, std::int64_t index, std::size_t count) const {
    fail(fmt::format("the face names {} {}", kind, index),
         fmt::format("the file has {} {} lines here", count, kind));
  }

  /// Faces may name entries that come later, so this is known at the end only.
  void check_ranges() {
    const auto check = [this](std::string_view kind, std::int64_t index, std::size_t count) {
      if (index >= static_cast<std::int64_t>(count)) fail_range(kind, index + 1, count);
    };
    for (const Face& face : records_.faces) {
      line_ = face.line;
      for (std::size_t i = 0; i < face.corner_count; ++i) {
        const Corner& corner = records_.corners[face.first_corner + i];
        check("v", corner.position, records_.positions.size());
        check("vt", corner.uv, records_.uvs.size());
        check("vn", corner.normal, records_.normals.size());
      }
    }
  }

  void select_material(std::string_view name) {
    const auto [entry, is_new] = materials_.try_emplace(std::string(name), materials_.size());
    material_ = static_cast<std::uint32_t>(entry->second);
    if (is_new) records_.materials.push_back(entry->first);
  }

  static std::string quoted(std::string_view word) {
    return fmt::format("\"{}{}\"", word.substr(0, longest_quote), word.size() > longest_quote ? "..." : "");
  }

  const std::filesystem::path* file_;
  std::int64_t line_ = 0;
  Records records_{};
  std::map<std::string, std::size_t> materials_{};
  std::optional<std::uint32_t> material_{};
};

/// Smooth normals, one a position, over the fans of all faces.
std::vector<vec3<float>> smooth_normals(const Records& records) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  const auto position = [&](const Face& face, std::size_t corner) {
    return static_cast<std::uint32_t>(records.corners[face.first_corner + corner].position);
  };
  for (const Face& face : records.faces)
    for (std::size_t i = 1; i + 1 < face.corner_count; ++i)
      triangles.push_back({position(face, 0), position(face, i), position(face, i + 1)});
  return mesh::generate_normals(records.positions, triangles);
}

/// Makes one vertex of all corners with equal indices, in the order of their first use.
mesh::TriangleMesh weld(const Records& records) {
  bool any_uv = false;
  bool all_normals = true;
  for (const Corner& corner : records.corners) {
    any_uv = any_uv || corner.uv >= 0;
    all_normals = all_normals && corner.normal >= 0;
  }
  const std::vector<vec3<float>> generated =
      all_normals ? std::vector<vec3<float>>{} : smooth_normals(records);

  mesh::TriangleMesh mesh;
  if (any_uv) mesh.uv_sets.resize(1);
  std::unordered_map<Corner, std::uint32_t, CornerHash> vertices;
  vertices.reserve(records.positions.size());
  const auto vertex_of = [&](const Corner& corner) {
    const auto [entry, is_new] =
        vertices.try_emplace(corner, static_cast<std::uint32_t>(mesh.positions.size()));
    if (!is_new) return entry->second;
    const auto position = static_cast<std::size_t>(corner.position);
    mesh.positions.push_back(records.positions[position]);
    mesh.normals.push_back(corner.normal >= 0 ? records.normals[static_cast<std::size_t>(corner.normal)]
                                              : generated[position]);
    if (any_uv)
      mesh.uv_sets[0].push_back(corner.uv >= 0 ? records.uvs[static_cast<std::size_t>(corner.uv)]
                                               : vec2<float>{0, 0});
    return entry->second;
  };

  for (const Face& face : records.faces) {
    const auto vertex = [&](std::size_t corner) {
      return vertex_of(records.corners[face.first_corner + corner]);
    };
    const std::uint32_t apex = vertex(0);
    std::uint32_t previous = vertex(1);
    for (std::size_t i = 2; i < face.corner_count; ++i) {
      const std::uint32_t current = vertex(i);
      mesh.triangles.push_back({apex, previous, current});
      mesh.material_of_triangle.push_back(face.material);
      previous = current;
    }
  }
  return mesh;
}

} // namespace

Model read_obj(const std::filesystem::path& file, std::span<const std::byte> bytes) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF"; text.starts_with(byte_order_mark))
    text.remove_prefix(byte_order_mark.size());
  const Records records = Parser(file).parse(text);
  Model model;
  for (const std::string& name : records.materials) model.materials.push_back({.name = name});
  model.meshes.push_back(weld(records));
  model.objects.push_back(
      {file.stem().string(), 0, {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}});
  return model;
}

} // namespace surfgrad::io
