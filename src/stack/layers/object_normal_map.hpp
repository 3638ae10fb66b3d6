#pragma once

#include "stack/layers/common.hpp"

namespace surfgrad::stack {

/// A map of whole normals in the object's or the world's space.
struct ObjectNormalMapLayer {
  static constexpr std::string_view type = "object_normal_map";
  LayerCommon common{};
  Map map{};
  Space space = Space::object;

  static const Fields<ObjectNormalMapLayer>& fields();
};

} // namespace surfgrad::stack
