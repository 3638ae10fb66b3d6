/// Functions of fragment shaders, which take derivatives of their arguments themselves: those of the frame
/// and of the tangent basis with $position and $plane in place of derivatives.

#include "conformance/rows.hpp"
#include "support/core_functions.hpp"

namespace surfgrad::test {
namespace {

void add_frame(std::vector<Row>& rows, const char* name, const char* call, BackFaces mode) {
  rows.push_back(make_row(
      name, call,
      [mode](const auto& in) {
        return flat(make_frame(in.core.raw_normal, in.core.frame.dp_dx, in.core.frame.dp_dy,
                               in.core.sign < in.core.scale, mode));
      },
      [](const ShaderInputs<double>& in) {
        return frame_bound(3, normalize_or_zero(in.core.raw_normal), in.core.frame.dp_dx,
                           in.core.frame.dp_dy);
      }));
}

} // namespace

const std::vector<Row>& fragment_rows() {
  static const std::vector<Row> all = [] {
    std::vector<Row> made;
    add_frame(made, "make_frame_at", "put_frame(surfgrad_make_frame_at($position, $raw_normal))",
              BackFaces::same);
    add_frame(made, "make_frame_at: back faces MIRROR",
              "put_frame(surfgrad_make_frame_at($position, $raw_normal, ($sign < $scale), "
              "SURFGRAD_BACK_FACES_MIRROR))",
              BackFaces::mirror);
    add_frame(made, "make_frame_at: back faces FLIP",
              "put_frame(surfgrad_make_frame_at($position, $raw_normal, ($sign < $scale), "
              "SURFGRAD_BACK_FACES_FLIP))",
              BackFaces::flip);
    made.push_back(make_row(
        "tangent_basis_at", "put_basis(surfgrad_tangent_basis_at($frame, $plane))",
        [](const auto& in) { return flat(tangent_basis(in.core.frame, in.core.dst_dx, in.core.dst_dy)); },
        [](const ShaderInputs<double>& in) { return all_within<6>(tangent_basis_bound(in.core)); }));
    loosen(made);
    return made;
  }();
  return all;
}

} // namespace surfgrad::test
