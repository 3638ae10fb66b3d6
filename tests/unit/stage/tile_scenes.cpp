#include "tile_scenes.hpp"

#include "render/camera.hpp"
#include "stage/tile_composer.hpp"
#include "support/scenes.hpp"
#include "unit/engine/every_kind.hpp"

#include <utility>

namespace surfgrad::stage::test {
namespace {

using surfgrad::test::Random;
namespace lab = engine::test;

/// Adds the images that the layers name.
void add_images(scene::Scene& scene) {
  Random random(4101);
  lab::Lab images;
  static_cast<void>(lab::one_of_each(images, random));
  images.add("normals", surfgrad::test::random_normal_map(random, 8, 8, 0.5));
  images.add("directions", surfgrad::test::random_image(random, 8, 8, 3));
  images.add("relief", surfgrad::test::random_image(random, 16, 8, 1));
  for (const auto& [name, image] : images.images())
    scene.images[name] = std::make_shared<image::Image>(image);
}

/// A second UV set: the first turned and repeated, as tiling detail would be unwrapped.
void add_second_set(mesh::TriangleMesh& mesh) {
  std::vector<vec2<float>> second;
  for (const vec2<float>& st : mesh.uv_sets[0])
    second.push_back({3 * st.x + 0.5f * st.y, 2 * st.y - 0.25f * st.x});
  mesh.uv_sets.push_back(second);
}

/// Some triangles between far and behind the eye; normals of half of them cancel somewhere inside.
mesh::TriangleMesh soup(Random& random, int count) {
  mesh::TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const vec3<double> c = random.vector3(-1.5, 1.5);
    const mat3<double> offsets = random.matrix3(-0.7, 0.7);
    surfgrad::test::append_triangle(mesh, c + offsets.x, c + offsets.y, c + offsets.z);
    if (i % 2 == 0) continue;
    const std::size_t last = mesh.normals.size() - 1;
    mesh.normals[last] = -mesh.normals[last - 1];
    if (i % 4 == 1) mesh.normals[last - 2] = {0, 0, 0};
  }
  return mesh;
}

void alternate_materials(mesh::TriangleMesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) mesh.material_of_triangle[t] = t % 3 == 0 ? 1 : 0;
}

stack::ParallaxLayer shadowed_parallax() {
  stack::ParallaxLayer parallax = lab::parallax_layer("relief", 0.1);
  parallax.self_shadow = true;
  return parallax;
}

stack::DecalLayer many_decals(Random& random, stack::DecalShape shape) {
  const bool round = shape == stack::DecalShape::sphere || shape == stack::DecalShape::capsule;
  stack::DecalLayer layer = lab::decal_layer(round ? "cube" : "a", shape);
  if (shape == stack::DecalShape::wedge) layer.space = stack::Space::object;
  layer.instances.assign(20, {});
  for (stack::DecalInstance& decal : layer.instances) {
    decal.position = random.vector3(-1.4, 1.4);
    decal.direction = random.unit_vector();
    decal.size = random.vector3(0.3, 1.2);
    decal.depth = random.uniform(0.3, 1.2);
    decal.radius = random.uniform(0.2, 0.6);
    decal.length = random.uniform(0.1, 0.6);
    decal.blend = stack::words_of<stack::DecalBlend>[random.bits() % 3].value;
    decal.opacity = random.uniform(0, 1);
  }
  return layer;
}

template <class Word>
Word any_word(Random& random) {
  const auto& words = stack::words_of<Word>;
  return words[random.bits() % words.size()].value;
}

/// Other numbers than the layer has, all of them valid in a document.
void vary(Random& random, stack::Layer& any_layer) {
  std::visit(
      [&](auto& layer) {
        if constexpr (requires { layer.common; }) {
          if (random.integer(2) == 0) layer.common.scale *= random.uniform(-1, 1);
          if (random.integer(3) == 0) layer.common.opacity = random.uniform(0, 1);
          if (random.integer(3) == 0) {
            layer.common.mask = lab::mask_of("mask", any_word<stack::MaskChannel>(random));
            layer.common.mask->uv = random.integer(2);
          }
        }
        if constexpr (requires { layer.common.blend; }) layer.common.blend = any_word<stack::Blend>(random);
        if constexpr (requires { layer.map.tile; }) {
          stack::Tiled& map = layer.map;
          if (random.integer(2) == 0)
            map.tile = {random.sign() * random.magnitude(0.3, 5), random.sign() * random.magnitude(0.3, 5)};
          if (random.integer(2) == 0) map.rotate_deg = random.uniform(-180, 180);
          if (random.integer(2) == 0) map.offset = random.vector2();
          map.filter = any_word<stack::Filter>(random);
          if (map.tiling == stack::Tiling::plain) map.wrap = any_word<stack::Wrap>(random);
        }
        if constexpr (requires { layer.map.uv; }) layer.map.uv = random.integer(2);
        if constexpr (requires { layer.space; }) layer.space = any_word<stack::Space>(random);
      },
      any_layer);
}

} // namespace

Composed composed_on(simd::Isa isa, const TileCase& tiles) {
  const simd::ForcedIsa forced(isa);
  const int side = tiles.side;
  const render::Pinhole camera = render::place_camera(tiles.scene, side, side);
  View view;
  if (!tiles.texture)
    view = {camera.eye, camera.relative_from_screen(side, side),
            normalize_or_zero(vec3<double>{0.5, 0.3, 0.8})};
  const Stage stage(tiles.scene, view, {{0, true}}, {});
  const std::size_t slot = stage.slot_of(0);
  const auto projection =
      tiles.texture ? raster::Projection::texture(slot, side, side)
                    : raster::Projection::camera(camera.screen_from_relative(side, side), camera.near);
  TileComposer composer(stage, projection, side, side, tiles.tile_side, tiles.tile_side,
                        {.normal = true,
                         .base_normal = true,
                         .surfgrad = true,
                         .sunlight = true,
                         .to_viewer = true,
                         .vertex_frame = true,
                         .st = true,
                         .slot = slot});
  Composed all;
  for (int row = 0; row < composer.grid().rows(); ++row)
    for (int column = 0; column < composer.grid().columns(); ++column) {
      const ComposedTile& tile = composer.compose(column, row);
      for (int i = 0; i < tile.count; ++i) {
        const int x = tile.tile.x + tile.pixel[i] % tile.tile.width;
        const int y = tile.tile.y + tile.pixel[i] / tile.tile.width;
        all.pixel.push_back(y * side + x);
      }
      const engine::TileWork::Results& r = tile.results;
      const std::array<const float*, channels.size()> arrays{
          r.normal.x,      r.normal.y,    r.normal.z,      r.base_normal.x, r.base_normal.y,
          r.base_normal.z, r.surfgrad.x,  r.surfgrad.y,    r.surfgrad.z,    r.to_viewer.x,
          r.to_viewer.y,   r.to_viewer.z, r.mesh_normal.x, r.mesh_normal.y, r.mesh_normal.z,
          r.tangent.x,     r.tangent.y,   r.tangent.z,     r.sunlight,      r.degenerate,
          r.sign,          r.st.x,        r.st.y};
      for (std::size_t c = 0; c < channels.size(); ++c)
        all.values[c].insert(all.values[c].end(), arrays[c], arrays[c] + tile.count);
    }
  return all;
}

TileCase case_of(std::vector<stack::Layer> layers, stack::BackFaces back_faces, bool texture) {
  TileCase result;
  result.texture = texture;
  result.side = 40;
  result.tile_side = 27; // no multiple of any pack: runs end within one
  scene::Scene& scene = result.scene;
  Random random(4102);
  scene.meshes = {surfgrad::test::half_mirrored_torus(10, 6), surfgrad::test::sphere_band(64, 48),
                  soup(random, 24)};
  for (mesh::TriangleMesh& mesh : scene.meshes) alternate_materials(mesh);
  add_second_set(scene.meshes[0]);
  add_second_set(scene.meshes[2]);
  scene.objects = {
      {"torus", 0, surfgrad::test::affine(random.rotation() * surfgrad::test::scaling({1, 0.7, -1.2}))},
      {"sphere", 1, surfgrad::test::affine(surfgrad::test::scaling({0.8, 0.8, 0.8}), {0.9, 0.8, -0.6})},
      {"soup", 2, surfgrad::test::affine(surfgrad::test::scaling({1, 1, 1}), {0.2, 0, 0.3})}};
  // A bake shows what comes first: the sphere's texture must not hide the other two.
  if (texture)
    for (vec2<float>& st : scene.meshes[0].uv_sets[0]) st = {0.6f * st.x, 0.5f * st.y};
  scene.materials = {{"layers", back_faces, std::move(layers)}, {"none", stack::BackFaces::flip, {}}};
  scene.camera.position = vec3<double>{0.6, 0.4, 2.6};
  scene.camera.target = vec3<double>{0.1, 0.2, 0};
  add_images(scene);
  return result;
}

std::vector<NamedLayers> every_kind_alone() {
  std::vector<NamedLayers> result;
  for (const lab::KindCase& kind : lab::every_kind()) result.push_back({kind.name, kind.layers(1)});
  Random random(4103);
  lab::Lab images;
  for (const stack::Layer& layer : lab::one_of_each(images, random))
    result.push_back({"one_of_each_" + std::to_string(result.size()), {layer}});
  stack::HeightMapLayer hex_heights = lab::height_layer("heights", 0.02);
  hex_heights.map.tiling = stack::Tiling::hex;
  hex_heights.taps = stack::Taps::bicubic;
  result.push_back({"heights_on_hex_tiles", {hex_heights}});
  stack::NormalMapLayer after = lab::normal_layer("a", 1);
  result.push_back({"parallax_with_shadows", {shadowed_parallax(), after}});
  for (const auto& kind : stack::words_of<stack::NoiseKind>) {
    stack::NoiseLayer noise;
    noise.noise.function = kind.value;
    noise.noise.frequency = 2.5;
    noise.common.scale = 0.2;
    result.push_back({"noise_" + std::string(kind.text), {noise}});
  }
  for (const auto& shape : stack::words_of<stack::DecalShape>)
    result.push_back({"many_decals_" + std::string(shape.text), {many_decals(random, shape.value)}});
  return result;
}

std::vector<stack::Layer> every_kind_together() {
  std::vector<stack::Layer> stack;
  for (const NamedLayers& kind : every_kind_alone()) {
    const bool opens_pass = std::holds_alternative<stack::ParallaxLayer>(kind.layers[0]);
    if (opens_pass || stack.size() % 8 == 7) stack.emplace_back(stack::ResolveLayer{});
    stack.insert(stack.end(), kind.layers.begin(), kind.layers.end());
  }
  return stack;
}

TileCase random_case(Random& random) {
  static const std::vector<NamedLayers> pool = every_kind_alone();
  static const scene::Scene with_images = [] {
    scene::Scene scene;
    add_images(scene);
    return scene;
  }();
  TileCase result;
  result.texture = random.integer(2) == 0;
  result.tile_side = 5 + random.integer(12);
  scene::Scene& scene = result.scene;
  scene.images = with_images.images;
  switch (random.integer(4)) {
  case 0:
    scene.meshes.push_back(surfgrad::test::torus(30, 20));
    break;
  case 1:
    scene.meshes.push_back(surfgrad::test::half_mirrored_torus(8, 5));
    break;
  case 2:
    scene.meshes.push_back(surfgrad::test::plane(1 + random.integer(12)));
    break;
  default:
    scene.meshes.push_back(soup(random, 12));
  }
  if (random.integer(4) != 0) add_second_set(scene.meshes[0]);
  alternate_materials(scene.meshes[0]);
  for (int i = 0; i <= random.integer(2); ++i)
    scene.objects.push_back(
        {"object", 0,
         surfgrad::test::affine(
             random.rotation() *
                 surfgrad::test::scaling({random.sign() * random.magnitude(0.4, 2.5),
                                          random.magnitude(0.4, 2.5), random.magnitude(0.4, 2.5)}),
             0.5 * random.vector3())});
  scene.camera.position = random.magnitude(0.5, 4) * random.unit_vector();
  scene.camera.target = 0.5 * random.vector3();
  for (int m = 0; m < 2; ++m) {
    std::vector<stack::Layer> layers;
    const int count = 1 + random.integer(6);
    for (int k = 0; k < count; ++k)
      for (stack::Layer layer : pool[random.bits() % pool.size()].layers) {
        vary(random, layer);
        if (std::holds_alternative<stack::ParallaxLayer>(layer) || random.integer(5) == 0)
          layers.emplace_back(stack::ResolveLayer{});
        layers.push_back(std::move(layer));
      }
    scene.materials.push_back({std::to_string(m), any_word<stack::BackFaces>(random), std::move(layers)});
  }
  return result;
}

} // namespace surfgrad::stage::test
