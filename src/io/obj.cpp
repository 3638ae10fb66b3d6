#include "io/obj.hpp"

#include "diagnostic/error.hpp"
#include "mesh/normals.hpp"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace surfgrad::io {
namespace {

// tinyobjloader numbers corners in an int.
constexpr std::size_t most_corners = std::numeric_limits<int>::max();

// Quoted text in a message: enough to recognise it.
constexpr std::size_t longest_quote = 60;

constexpr std::string_view blanks = " \t\r\v\f";

/// Indices into the position, texture coordinate and normal lists; -1 where a face has none.
struct Corner {
  int position = -1;
  int uv = -1;
  int normal = -1;
  friend bool operator==(const Corner&, const Corner&) = default;
};

struct CornerHash {
  std::size_t operator()(const Corner& corner) const {
    std::uint64_t hash = 0;
    for (const int index : {corner.position, corner.uv, corner.normal}) {
      // Multiplicative hashing; the shift brings the well mixed upper bits down.
      hash = (hash ^ static_cast<std::uint64_t>(index)) * 0x9E3779B97F4A7C15u;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

struct Face {
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

std::string quoted(std::string_view word) {
  return fmt::format("\"{}{}\"", word.substr(0, longest_quote), word.size() > longest_quote ? "..." : "");
}

std::string_view trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(blanks);
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

/// Takes the next blank-separated word off the front; empty at the end or at a comment.
std::string_view next_word(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  if (text.starts_with('#')) text = {};
  const std::string_view word = text.substr(0, text.find_first_of(blanks));
  text.remove_prefix(word.size());
  return word;
}

/// Whether all of the word is a number of this type.
template <class Number>
bool read_number(std::string_view word, Number& value) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc{} && end == word.data() + word.size();
}

/// Whether the word is v, v/vt, v//vn or v/vt/vn.
bool is_corner(std::string_view word) {
  for (int part = 0; part < 3; ++part) {
    const auto slash = word.find('/');
    const std::string_view digits = word.substr(0, slash);
    int index = 0;
    const bool is_index = read_number(digits, index) && index != 0;
    if (!is_index && (part == 0 || !digits.empty())) return false;
    if (slash == word.npos) return true;
    word.remove_prefix(slash + 1);
  }
  return false;
}

/// tinyobjloader takes what is not a number for 0, overlooks what follows a number, wraps large
/// indices, and knows neither comments behind a face nor lines that go on after a backslash. So
/// each statement that is read here is checked first and handed on in a plain form. Whether what
/// a face names exists shows in the end, for it may come later.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(&file) {}

  Records read(std::string_view text) {
    check_statements(text);
    line_ = 0;
    if (face_lines_.empty()) fail("has no faces", "expected at least one line such as: f 1 2 3");
    tinyobj::callback_t callbacks;
    callbacks.vertex_cb = [](void* reader, float x, float y, float z, float) {
      static_cast<Reader*>(reader)->records_.positions.push_back({x, y, z});
    };
    callbacks.normal_cb = [](void* reader, float x, float y, float z) {
      static_cast<Reader*>(reader)->records_.normals.push_back({x, y, z});
    };
    callbacks.texcoord_cb = [](void* reader, float x, float y, float) {
      static_cast<Reader*>(reader)->records_.uvs.push_back({x, y});
    };
    callbacks.index_cb = [](void* reader, tinyobj::index_t* indices, int count) {
      static_cast<Reader*>(reader)->add_face(indices, static_cast<std::size_t>(count));
    };
    callbacks.usemtl_cb = [](void* reader, const char* name, int) {
      static_cast<Reader*>(reader)->select_material(name);
    };
    std::istringstream stream(std::move(plain_));
    tinyobj::LoadObjWithCallback(stream, callbacks, this);
    check_ranges();
    return std::move(records_);
  }

 private:
  [[noreturn]] void fail(std::string problem, std::string remedy) const {
    const auto line = static_cast<int>(std::min<std::int64_t>(line_, std::numeric_limits<int>::max()));
    throw InputError{
        {.file = *file_, .line = line, .problem = std::move(problem), .remedy = std::move(remedy)}};
  }

  void check_statements(std::string_view text) {
    std::string joined;
    while (!text.empty()) {
      const std::size_t end = text.find('\n');
      const std::string_view line = trimmed(text.substr(0, end));
      text.remove_prefix(end == text.npos ? text.size() : end + 1);
      ++line_;
      // A backslash at the end continues the statement on the next line.
      if (line.ends_with('\\')) {
        joined.append(line.substr(0, line.size() - 1)).append(" ");
        continue;
      }
      check_statement(joined.empty() ? line : std::string_view(joined.append(line)));
      joined.clear();
    }
    check_statement(joined);
  }

  void check_statement(std::string_view line) {
    const std::string_view keyword = next_word(line);
    if (keyword == "v" || keyword == "vn")
      check_numbers(keyword, line, 3, 3);
    else if (keyword == "vt")
      check_numbers(keyword, line, 1, 2);
    else if (keyword == "f")
      check_face(line);
    else if (keyword == "usemtl")
      plain_ += fmt::format("usemtl {}\n", trimmed(line).empty() ? "default" : trimmed(line));
    // Groups, smoothing, lines, points, curves and material libraries say nothing that is read here.
  }

  void check_numbers(std::string_view keyword, std::string_view line, int least, int most) {
    plain_ += keyword;
    for (int i = 0; i < most; ++i) {
      const std::string_view word = next_word(line);
      if (word.empty() && i >= least) break;
      double value = 0;
      if (!read_number(word.substr(word.starts_with('+') ? 1 : 0), value) ||
          !(std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max())))
        fail(word.empty() ? "a number is missing" : quoted(word) + " is not a finite number",
             "expected v x y z, vt u v or vn x y z");
      // The library's arithmetic loses long numbers and overflows for some: it gets the shortest form.
      fmt::format_to(std::back_inserter(plain_), " {}", static_cast<float>(value));
    }
    plain_ += '\n';
  }

  void check_face(std::string_view line) {
    plain_ += 'f';
    std::size_t corners = 0;
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line), ++corners) {
      if (!is_corner(word))
        fail(quoted(word) + " is not a corner of a face",
             "expected v, v/vt, v//vn or v/vt/vn with numbers from 1, or from -1 backwards");
      plain_.append(" ").append(word);
    }
    if (corners < 3) fail(fmt::format("the face has {} corners", corners), "expected 3 or more");
    corner_count_ += corners;
    if (corner_count_ > most_corners)
      fail("too many corners", fmt::format("expected at most {}", most_corners));
    plain_ += '\n';
    face_lines_.push_back(line_);
  }

  void add_face(const tinyobj::index_t* indices, std::size_t count) {
    line_ = face_lines_[records_.faces.size()];
    if (records_.materials.empty()) select_material("default");
    records_.faces.push_back({records_.corners.size(), count, material_});
    for (std::size_t i = 0; i < count; ++i)
      records_.corners.push_back({resolved("v", indices[i].vertex_index, records_.positions.size()),
                                  resolved("vt", indices[i].texcoord_index, records_.uvs.size()),
                                  resolved("vn", indices[i].normal_index, records_.normals.size())});
  }

  /// From 1, or from -1 backwards for the entry last read, 0 for none; the result counts from 0.
  int resolved(std::string_view kind, int index, std::size_t read_so_far) const {
    if (index >= 0) return index - 1;
    const auto count = static_cast<std::int64_t>(read_so_far);
    if (index < -count) fail_range(kind, index, read_so_far);
    return static_cast<int>(count + index);
  }

  [[noreturn]] void fail_range(std::string_view kind, std::int64_t index, std::size_t count) const {
    fail(fmt::format("the face names {} {}", kind, index),
         fmt::format("the file has {} {} lines here", count, kind));
  }

  void check_ranges() {
    const auto check = [this](std::string_view kind, int index, std::size_t count) {
      if (index >= 0 && static_cast<std::size_t>(index) >= count)
        fail_range(kind, std::int64_t{index} + 1, count);
    };
    for (std::size_t face = 0; face < records_.faces.size(); ++face) {
      line_ = face_lines_[face];
      for (std::size_t i = 0; i < records_.faces[face].corner_count; ++i) {
        const Corner& corner = records_.corners[records_.faces[face].first_corner + i];
        check("v", corner.position, records_.positions.size());
        check("vt", corner.uv, records_.uvs.size());
        check("vn", corner.normal, records_.normals.size());
      }
    }
  }

  void select_material(const std::string& name) {
    const auto [entry, is_new] = material_numbers_.try_emplace(name, records_.materials.size());
    material_ = static_cast<std::uint32_t>(entry->second);
    if (is_new) records_.materials.push_back(name);
  }

  const std::filesystem::path* file_;
  std::int64_t line_ = 0;
  std::string plain_{}; ///< the checked statements
  std::vector<std::int64_t> face_lines_{};
  std::size_t corner_count_ = 0;
  Records records_{};
  std::map<std::string, std::size_t> material_numbers_{};
  std::uint32_t material_ = 0;
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
  const Records records = Reader(file).read(text);
  Model model;
  for (const std::string& name : records.materials)
    model.materials.push_back({.name = name, .double_sided = true});
  model.meshes.push_back(weld(records));
  model.objects.push_back(
      {file.stem().string(), 0, {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}});
  return model;
}

} // namespace surfgrad::io
