#include "engine/layers/resolve.hpp"

#include "engine/compiler.hpp"

namespace surfgrad::engine {

Resolve compiled(const stack::ResolveLayer&, const Compiler&) { return {}; }

} // namespace surfgrad::engine
