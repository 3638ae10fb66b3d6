#pragma once

#include "stack/layers/common.hpp"

namespace surfgrad::stack {

/// Ends a pass: the normal perturbed so far is the base normal of the layers that follow.
struct ResolveLayer {
  static constexpr std::string_view type = "resolve";
  int line = 0;
  std::string key{};

  static const Fields<ResolveLayer>& fields();
};

} // namespace surfgrad::stack
