#include "engine/program.hpp"

#include "diagnostic/error.hpp"
#include "engine/compiler.hpp"
#include "stack/uses.hpp"

#include <algorithm>
#include <string>

namespace surfgrad::engine {
namespace {

void add_slot(const stack::Texture& use, bool tangents, std::vector<raster::UvSlot>& slots) {
  const auto found =
      std::find_if(slots.begin(), slots.end(), [&](const raster::UvSlot& s) { return s.uv_set == use.uv; });
  if (found != slots.end()) {
    found->tangents = found->tangents || tangents;
    return;
  }
  if (static_cast<int>(slots.size()) == raster::max_uv_slots)
    throw InputError(
        {.file = use.file.path,
         .line = use.uv_line,
         .place = use.file.key,
         .problem = "the scene uses more than " + std::to_string(raster::max_uv_slots) + " UV sets",
         .remedy = "use fewer at once"});
  slots.push_back({use.uv, tangents});
}

} // namespace

bool Program::reads_object_position() const {
  return std::any_of(layers.begin(), layers.end(), [](const auto& layer) {
    return std::holds_alternative<VolumeNoise>(layer) || std::holds_alternative<Planar>(layer) ||
           std::holds_alternative<Triplanar>(layer);
  });
}

bool Program::reads_normal_derivatives() const {
  return std::any_of(layers.begin(), layers.end(), [](const auto& layer) {
    const auto* parallax = std::get_if<Parallax>(&layer);
    return parallax != nullptr && parallax->curvature;
  });
}

void collect_uv_slots(const std::vector<stack::Layer>& layers, std::vector<raster::UvSlot>& slots) {
  for (const stack::Layer& layer : layers)
    for (const stack::TextureUse& use : stack::textures_of(layer))
      add_slot(*use.texture, use.vertex_frame, slots);
}

Program compile(const std::vector<stack::Layer>& layers, const std::vector<raster::UvSlot>& slots,
                MapLibrary& maps, const std::function<void(const stack::Layer&)>& done) {
  const Compiler compiler(slots, maps);
  Program program;
  for (const stack::Layer& layer : layers) {
    std::visit([&](const auto& kind) { program.layers.emplace_back(compiled(kind, compiler)); }, layer);
    if (done) done(layer);
  }
  return program;
}

} // namespace surfgrad::engine
