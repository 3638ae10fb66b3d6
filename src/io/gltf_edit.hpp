#pragma once

#include "diagnostic/report.hpp"
#include "io/gltf_document.hpp"
#include "io/gltf_scene.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace surfgrad::io::gltf {

/// Takes an extension away from a value, and the list of its extensions where none is left.
void erase_extension(nlohmann::ordered_json& value, const char* name);

/// Numbers for a new accessor.
struct AccessorData {
  int type = 0;           ///< TINYGLTF_TYPE_*
  int component_type = 0; ///< TINYGLTF_COMPONENT_TYPE_*
  bool is_index = false;
  bool is_bounded = false;           ///< carries min and max
  std::vector<std::uint32_t> bits{}; ///< of each component, in order
};

/// A glTF document that is changed here and there and becomes a .glb. What nobody touches, known here or
/// not, stays as it was: extensions, extras, names, the order of all arrays.
class Edit {
 public:
  /// Throws as read_document and read_json do.
  Edit(const std::filesystem::path& file, std::span<const std::byte> bytes);

  /// The document as it was read.
  [[nodiscard]] const Document& document() const { return document_; }
  /// The document as it will be. Of the part that is described in Document the types are right.
  [[nodiscard]] nlohmann::ordered_json& json() { return json_; }
  [[nodiscard]] nlohmann::ordered_json& primitive(PrimitivePlace place);

  /// The accessors of these primitives are no longer used there: add() writes over those that nothing else
  /// uses.
  void give_up(const std::vector<PrimitivePlace>& primitives);
  /// The index of a new accessor. `like` is one of the document whose properties it takes over (its name,
  /// whether it is normalized), or -1.
  [[nodiscard]] int add(const AccessorData& data, int like);

  /// The index of a new image in the file.
  [[nodiscard]] int add_image(std::vector<std::byte> bytes, const std::string& media_type,
                              const std::string& name);

  /// The whole file. All buffers become one, and images that lie in files or in the document move into it;
  /// a warning tells which cannot, because what they are is not known. Once.
  [[nodiscard]] std::vector<std::byte> glb(const Report& report);

 private:
  struct View {
    std::vector<std::byte> bytes{};
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
  };

  void embed_images(const Report& report);
  void place_views();
  [[nodiscard]] std::set<int> views_to_write_over() const;

  Document document_;
  nlohmann::ordered_json json_;
  nlohmann::ordered_json originals_; ///< its accessors, before any was written over
  std::set<std::size_t>
      pinned_{};                ///< accessors or views that something may name which is not understood here
  std::set<int> free_{};        ///< accessors to write over
  std::map<int, View> views_{}; ///< by the accessor that needs it; for images -1 - index
  std::set<int> replaced_{};    ///< accessors of the document that were written over
  std::vector<std::byte> binary_{};
};

} // namespace surfgrad::io::gltf
