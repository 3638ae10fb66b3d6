#include "io/model_tangents.hpp"

#include "diagnostic/error.hpp"
#include "io/extension.hpp"
#include "io/file.hpp"
#include "io/gltf_accessor.hpp"
#include "io/gltf_edit.hpp"
#include "io/gltf_primitive.hpp"
#include "io/in_parallel.hpp"
#include "io/model_bytes.hpp"
#include "io/model_file.hpp"
#include "io/obj.hpp"
#include "mesh/mikktspace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <utility>

namespace surfgrad::io {
namespace {

using gltf::Document;
using gltf::Edit;
using gltf::PrimitivePlace;
using Bits3 = std::array<std::uint32_t, 3>;
using Bits4 = std::array<std::uint32_t, 4>;

/// A primitive that gets tangents.
struct Job {
  PrimitivePlace place{};
  std::size_t uv_set = 0;
};

/// Its new vertices and triangles.
struct Result {
  std::vector<std::uint32_t> source{};  ///< [vertex] vertex of the primitive as it was
  std::vector<vec4<float>> tangents{};  ///< [vertex]
  std::vector<vec3<float>> normals{};   ///< [vertex]; empty where the primitive has its own
  std::vector<std::uint32_t> indices{}; ///< three a triangle
  std::size_t split = 0;
  std::size_t arbitrary = 0;
};

const tinygltf::Primitive& primitive_of(const Document& document, PrimitivePlace place) {
  return document.model.meshes[place.mesh].primitives[place.primitive];
}

/// The UV set that the primitive's normal texture uses, else the first: what the format says TANGENT is for.
std::size_t own_uv_set(const Document& document, const tinygltf::Primitive& primitive) {
  if (primitive.material < 0) return 0;
  const tinygltf::NormalTextureInfo& normal =
      document.model.materials[static_cast<std::size_t>(primitive.material)].normalTexture;
  if (normal.index < 0) return 0;
  const auto transform = normal.extensions.find("KHR_texture_transform");
  const bool has_another = transform != normal.extensions.end() && transform->second.Has("texCoord");
  return static_cast<std::size_t>(has_another ? transform->second.Get("texCoord").GetNumberAsInt()
                                              : normal.texCoord);
}

/// `meshes[3].primitives[0] ("Wheel")`
std::string named(const Document& document, PrimitivePlace place) {
  const std::string& name = document.model.meshes[place.mesh].name;
  return name.empty() ? place.text() : fmt::format("{} (\"{}\")", place.text(), name);
}

[[noreturn]] void fail_without_uv(const Document& document, const Job& job) {
  std::size_t sets = 0;
  while (primitive_of(document, job.place).attributes.contains(fmt::format("TEXCOORD_{}", sets))) ++sets;
  document.fail(named(document, job.place), fmt::format("has no UV set {}", job.uv_set),
                sets == 0   ? "unwrap it, or name no set to pass over it"
                : sets == 1 ? "it has set 0 only"
                            : fmt::format("it has the sets 0 to {}", sets - 1));
}

/// Some unit vector perpendicular to a unit vector.
vec3<float> perpendicular(vec3<float> n) {
  const vec3<float> axis = std::abs(n.x) < 0.5f ? vec3<float>{1, 0, 0} : vec3<float>{0, 1, 0};
  const vec3<float> t = normalize_or_zero(axis - dot(axis, n) * n);
  return max_abs(t) > 0 ? t : vec3<float>{1, 0, 0};
}

/// The mesh that tangents are made of: unmorphed, with unit normals where the file gives none.
mesh::TriangleMesh read_mesh(const Document& document, PrimitivePlace place) {
  tinygltf::Primitive primitive = primitive_of(document, place);
  primitive.targets.clear();
  primitive.attributes.erase("TANGENT");
  mesh::TriangleMesh mesh = gltf::read_primitive(document, primitive, place.text(), 0, 0, {});
  if (!primitive.attributes.contains(
          "NORMAL")) // those of triangles without area are zero: the format wants unit ones
    for (vec3<float>& n : mesh.normals)
      if (max_abs(n) == 0) n = {0, 0, 1};
  return mesh;
}

/// Vertices for the corners: one for each vertex of the file that is used, in its order, and behind them one
/// for each further tangent or normal that it has in another corner.
Result make(const Document& document, const Job& job) {
  const tinygltf::Primitive& primitive = primitive_of(document, job.place);
  const mesh::TriangleMesh mesh = read_mesh(document, job.place);
  const auto triangles = gltf::read_triangles(document, primitive, job.place.text());
  std::vector<vec4<float>> tangents = mesh::generate_tangents(mesh, job.uv_set).corners;
  const bool makes_normals = !primitive.attributes.contains("NORMAL");

  const std::size_t corners = tangents.size();
  const auto normal_of = [&](std::size_t corner) {
    return mesh.normals[mesh.triangles[corner / 3][corner % 3]];
  };
  const auto vertex_of = [&](std::size_t corner) { return triangles[corner / 3][corner % 3]; };
  Result result;
  for (std::size_t corner = 0; corner < corners; ++corner) {
    vec4<float>& t = tangents[corner];
    if (t.x != 0 || t.y != 0 || t.z != 0) continue;
    const vec3<float> any = perpendicular(normal_of(corner));
    t = {any.x, any.y, any.z, t.w};
    ++result.arbitrary;
  }

  constexpr std::uint32_t none = 0xFFFFFFFF; // no vertex: there are fewer
  std::uint32_t largest = 0;
  for (const auto& triangle : triangles) largest = std::max(largest, std::ranges::max(triangle));
  std::vector<std::uint32_t> first_corner(std::size_t{largest} + 1, none);
  for (std::size_t corner = corners; corner-- > 0;)
    first_corner[vertex_of(corner)] = static_cast<std::uint32_t>(corner);

  const auto add = [&](std::size_t corner) {
    result.source.push_back(vertex_of(corner));
    result.tangents.push_back(tangents[corner]);
    if (makes_normals) result.normals.push_back(normal_of(corner));
    return static_cast<std::uint32_t>(result.source.size() - 1);
  };
  std::vector<std::uint32_t> first_vertex(first_corner.size(), none);
  for (std::size_t vertex = 0; vertex < first_corner.size(); ++vertex)
    if (first_corner[vertex] != none) first_vertex[vertex] = add(first_corner[vertex]);
  const std::size_t used = result.source.size();

  using Key = std::pair<Bits4, Bits3>;
  const auto key_of = [&](std::size_t corner) {
    return Key{std::bit_cast<Bits4>(tangents[corner]),
               makes_normals ? std::bit_cast<Bits3>(normal_of(corner)) : Bits3{}};
  };
  std::map<std::pair<std::uint32_t, Key>, std::uint32_t> further;
  result.indices.reserve(corners);
  for (std::size_t corner = 0; corner < corners; ++corner) {
    const std::uint32_t vertex = vertex_of(corner);
    const Key key = key_of(corner);
    if (key == key_of(first_corner[vertex])) {
      result.indices.push_back(first_vertex[vertex]);
      continue;
    }
    const auto [entry, is_new] = further.try_emplace({vertex, key}, 0);
    if (is_new) entry->second = add(corner);
    result.indices.push_back(entry->second);
  }
  result.split = result.source.size() - used;
  return result;
}

template <class Vector>
std::vector<std::uint32_t> bits_of(const std::vector<Vector>& vectors) {
  std::vector<std::uint32_t> bits;
  for (const Vector& v : vectors) {
    const auto components = std::bit_cast<std::array<std::uint32_t, sizeof(Vector) / 4>>(v);
    bits.insert(bits.end(), components.begin(), components.end());
  }
  return bits;
}

/// Puts the vertices and triangles into the document.
class Installer {
 public:
  Installer(Edit& edit, const Job& job, const Result& result)
      : edit_(&edit), place_(job.place), result_(&result),
        source_(&primitive_of(edit.document(), job.place)) {}

  void install() {
    nlohmann::ordered_json& written = edit_->primitive(place_);
    for (const auto& [name, accessor] : source_->attributes)
      if (name != "TANGENT") written["attributes"][name] = moved(name, accessor);
    if (!result_->normals.empty())
      written["attributes"]["NORMAL"] = added(bits_of(result_->normals), TINYGLTF_TYPE_VEC3);
    written["attributes"]["TANGENT"] = added(bits_of(result_->tangents), TINYGLTF_TYPE_VEC4);
    for (std::size_t i = 0; i < source_->targets.size(); ++i) {
      nlohmann::ordered_json& target = written["targets"][i];
      for (const auto& [name, accessor] : source_->targets[i]) {
        const bool has_base = name != "NORMAL" || result_->normals.empty();
        if (name == "TANGENT" || !has_base)
          target.erase(name);
        else
          target[name] = moved(name, accessor);
      }
    }
    // Shorts hold indices below their largest, which may mean a restart.
    const bool is_short = result_->source.size() <= 0xFFFF;
    written["indices"] = edit_->add({.type = TINYGLTF_TYPE_SCALAR,
                                     .component_type = is_short ? TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT
                                                                : TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                                     .is_index = true,
                                     .bits = result_->indices},
                                    source_->indices);
    written.erase("mode"); // a list of triangles
    gltf::erase_extension(written, "KHR_draco_mesh_compression");
  }

 private:
  int added(std::vector<std::uint32_t> bits, int type) {
    return edit_->add(
        {.type = type, .component_type = TINYGLTF_COMPONENT_TYPE_FLOAT, .bits = std::move(bits)}, -1);
  }

  /// The accessor's elements for the new vertices.
  int moved(const std::string& name, int index) {
    const Document& document = edit_->document();
    const auto& accessors = document.model.accessors;
    const tinygltf::Accessor& accessor = accessors[static_cast<std::size_t>(index)];
    const std::size_t count = accessors[static_cast<std::size_t>(source_->attributes.at("POSITION"))].count;
    if (accessor.count != count)
      document.fail(fmt::format("{}.{}", place_.text(), name),
                    fmt::format("has {} elements but POSITION has {}", accessor.count, count),
                    "expected one a vertex");
    const std::vector<std::uint32_t> bits = gltf::read_bits(document, index);
    const std::size_t n = bits.size() / count;
    gltf::AccessorData data{.type = accessor.type,
                            .component_type = accessor.componentType,
                            .is_bounded = name == "POSITION" || !accessor.minValues.empty()};
    data.bits.reserve(result_->source.size() * n);
    for (const std::uint32_t vertex : result_->source)
      data.bits.insert(data.bits.end(), bits.begin() + static_cast<std::ptrdiff_t>(vertex * n),
                       bits.begin() + static_cast<std::ptrdiff_t>((vertex + 1) * n));
    return edit_->add(data, index);
  }

  Edit* edit_;
  PrimitivePlace place_;
  const Result* result_;
  const tinygltf::Primitive* source_;
};

/// The primitives of triangles that have the UV set they need; the others are counted and named, or fail.
std::vector<Job> jobs_of(const Document& document, const TangentOptions& options, ModelWithTangents& model) {
  std::vector<Job> jobs;
  std::vector<Job> left_out;
  for (std::size_t m = 0; m < document.model.meshes.size(); ++m)
    for (std::size_t p = 0; p < document.model.meshes[m].primitives.size(); ++p) {
      const Job job{{m, p}, 0};
      const tinygltf::Primitive& primitive = primitive_of(document, job.place);
      if (primitive.mode < TINYGLTF_MODE_TRIANGLES) continue; // points and lines
      const std::size_t set = options.uv_set.value_or(own_uv_set(document, primitive));
      if (primitive.attributes.contains(fmt::format("TEXCOORD_{}", set))) {
        jobs.push_back({job.place, set});
        if (primitive.attributes.contains("TANGENT")) ++model.replaced;
        continue;
      }
      if (options.uv_set) fail_without_uv(document, {job.place, set});
      left_out.push_back({job.place, set});
    }
  model.without_uv = left_out.size();
  if (!jobs.empty()) {
    for (const Job& job : left_out)
      options.report.warn(fmt::format("{}: {} has no UV set {}: it gets no tangents", document.file.string(),
                                      named(document, job.place), job.uv_set));
    return jobs;
  }
  if (!left_out.empty())
    document.fail("",
                  fmt::format("no mesh has the UV set that its tangents need ({} has no UV set {})",
                              named(document, left_out[0].place), left_out[0].uv_set),
                  "unwrap the model, or name a set that it has");
  document.fail("", "has no mesh of triangles", "expected at least one");
}

std::vector<std::byte> as_gltf(const std::filesystem::path& file) {
  std::vector<std::byte> bytes = read_model_bytes(file);
  return lower_extension(file) == ".obj" ? encode_model(read_obj(file, bytes), ModelFormat::glb) : bytes;
}

} // namespace

ModelWithTangents add_tangents(const std::filesystem::path& file, const TangentOptions& options) {
  const std::vector<std::byte> bytes = as_gltf(file);
  Edit edit(file, bytes);
  ModelWithTangents model;
  const std::vector<Job> jobs = jobs_of(edit.document(), options, model);
  std::vector<Result> results(jobs.size());
  std::vector<std::function<void()>> making;
  for (std::size_t i = 0; i < jobs.size(); ++i)
    making.emplace_back([&, i] { results[i] = make(edit.document(), jobs[i]); });
  for (const std::exception_ptr& error : run_in_parallel(making, options.report))
    if (error) std::rethrow_exception(error);

  std::vector<PrimitivePlace> places;
  for (const Job& job : jobs) places.push_back(job.place);
  edit.give_up(places);
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    if (options.report.progress &&
        !options.report.progress(static_cast<double>(i) / static_cast<double>(jobs.size())))
      throw Cancelled();
    Installer(edit, jobs[i], results[i]).install();
    ++model.meshes;
    model.triangles += results[i].indices.size() / 3;
    model.vertices += results[i].source.size();
    model.split_vertices += results[i].split;
    model.arbitrary_tangents += results[i].arbitrary;
    results[i] = {};
  }
  model.glb = edit.glb(options.report);
  return model;
}

void check_glb_output(const std::filesystem::path& file) {
  if (const std::string extension = lower_extension(file); extension != ".glb")
    throw InputError{{.file = file,
                      .problem = fmt::format("tangents are not written for the extension \"{}\"", extension),
                      .remedy = "expected .glb"}};
  check_writable(file);
}

} // namespace surfgrad::io
