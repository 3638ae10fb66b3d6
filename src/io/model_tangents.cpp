#include "io/model_tangents.hpp"

#include "diagnostic/error.hpp"
#include "io/extension.hpp"
#include "io/file.hpp"
#include "io/gltf_edit.hpp"
#include "io/gltf_tangents.hpp"
#include "io/in_parallel.hpp"
#include "io/model_bytes.hpp"
#include "io/model_file.hpp"
#include "io/obj.hpp"

#include <fmt/format.h>

#include <functional>
#include <string>
#include <utility>

namespace surfgrad::io {
namespace {

using gltf::Document;
using gltf::Edit;
using gltf::primitive_of;
using gltf::PrimitivePlace;

/// A primitive that gets tangents.
struct Job {
  PrimitivePlace place{};
  std::size_t uv_set = 0;
};

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
  std::vector<gltf::TangentVertices> results(jobs.size());
  std::vector<std::function<void()>> making;
  for (std::size_t i = 0; i < jobs.size(); ++i)
    making.emplace_back(
        [&, i] { results[i] = gltf::make_tangents(edit.document(), jobs[i].place, jobs[i].uv_set); });
  for (const std::exception_ptr& error : run_in_parallel(making, options.report))
    if (error) std::rethrow_exception(error);

  std::vector<PrimitivePlace> places;
  for (const Job& job : jobs) places.push_back(job.place);
  edit.give_up(places);
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    if (options.report.progress &&
        !options.report.progress(static_cast<double>(i) / static_cast<double>(jobs.size())))
      throw Cancelled();
    gltf::install(edit, jobs[i].place, results[i]);
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
    throw InputError{
        {.file = file,
         .problem = fmt::format("models are not written here for the extension \"{}\"", extension),
         .remedy = "expected .glb"}};
  check_writable(file);
}

} // namespace surfgrad::io
