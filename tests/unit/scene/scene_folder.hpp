#pragma once

/// A folder with a model, maps and documents, removed at the end.

#include "io/image_file.hpp"
#include "support/images.hpp"

#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <string_view>

namespace surfgrad::scene::test {

class SceneFolder {
 public:
  SceneFolder() {
    std::random_device random;
    path_ = std::filesystem::temp_directory_path() / ("surfgrad_scene_" + std::to_string(random()));
    std::filesystem::create_directories(path_ / "maps");
    surfgrad::test::Random texels(231);
    for (const char* name : {"maps/a.png", "maps/b.png", "maps/own.png"})
      io::write_image(path_ / name, surfgrad::test::random_normal_map(texels, 8, 8), image::Depth::unorm16);
    write("quad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                      "usemtl skin\nf 1/1 2/2 3/3\nusemtl cloth\nf 1/1 3/3 4/4\n");
    write("bare.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  }
  ~SceneFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  SceneFolder(const SceneFolder&) = delete;
  SceneFolder& operator=(const SceneFolder&) = delete;

  std::filesystem::path write(std::string_view name, std::string_view content) const {
    const std::filesystem::path file = path_ / name;
    std::ofstream(file, std::ios::binary).write(content.data(), static_cast<std::streamsize>(content.size()));
    return file;
  }

  /// A glTF quad whose material has a normal texture of its own, maps/own.png.
  std::filesystem::path write_gltf(int uv_set) const {
    const float positions[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    const float uvs[] = {0, 1, 1, 1, 1, 0, 0, 0};
    std::string bytes(reinterpret_cast<const char*>(positions), sizeof positions);
    bytes.append(reinterpret_cast<const char*>(uvs), sizeof uvs);
    const unsigned char triangles[] = {0, 1, 2, 0, 2, 3};
    bytes.append(reinterpret_cast<const char*>(triangles), sizeof triangles);
    write("quad.bin", bytes);
    return write("quad.gltf",
                 R"({ "asset": { "version": "2.0" }, "buffers": [{ "uri": "quad.bin", "byteLength": 86 }],
      "bufferViews": [{ "buffer": 0, "byteLength": 48 }, { "buffer": 0, "byteOffset": 48, "byteLength": 32 },
                      { "buffer": 0, "byteOffset": 80, "byteLength": 6 }],
      "accessors": [
        { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0] },
        { "bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2" },
        { "bufferView": 2, "componentType": 5121, "count": 6, "type": "SCALAR" }],
      "images": [{ "uri": "maps/own.png" }], "textures": [{ "source": 0 }],
      "extensionsUsed": ["KHR_texture_transform"],
      "materials": [{ "name": "own", "doubleSided": true, "normalTexture": { "index": 0, "scale": 0.5, "texCoord": )" +
                     std::to_string(uv_set) + R"(,
        "extensions": { "KHR_texture_transform": { "scale": [2, 3], "offset": [0.25, 0] } } } }],
      "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "indices": 2, "material": 0 }] }],
      "nodes": [{ "mesh": 0, "name": "quad" }], "scenes": [{ "nodes": [0] }], "scene": 0 })");
  }

 private:
  std::filesystem::path path_{};
};

} // namespace surfgrad::scene::test
