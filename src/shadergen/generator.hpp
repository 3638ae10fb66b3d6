#pragma once

#include "shadergen/shadergen.hpp"

#include <fmt/format.h>

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace surfgrad::shadergen {

/// What the layers write their code into. All of it is common code (spelling.hpp), in which the stack's own
/// identifiers begin with `stack`.
///
/// A fragment's function is a list of values that are given once. Whatever two layers compute in the same
/// words is computed once (`shared`).
class Generator {
 public:
  /// expected        the surface's members as another run found them: what a parallax must move
  /// tangents_alone  all layers are slopes in the vertex tangents of this UV set; -1 where they are not
  Generator(const Options& options, Shader& shader, std::vector<SurfaceMember> expected, int tangents_alone);

  [[nodiscard]] const Options& options() const { return options_; }
  [[nodiscard]] Shader& shader() { return shader_; }
  [[nodiscard]] bool exact() const { return options_.access == TextureAccess::exact; }

  // The function of the fragment.

  /// A line of it.
  template <class... Parts>
  void line(fmt::format_string<Parts...> text, Parts&&... parts) {
    put("  " + fmt::format(text, std::forward<Parts>(parts)...) + "\n");
  }
  /// An empty line and what follows.
  void paragraph(const std::string& comment);
  /// A value under a name like `name`; where the same expression has one already, that.
  [[nodiscard]] std::string shared(const std::string& name, std::string_view type,
                                   const std::string& expression);
  /// A new value.
  [[nodiscard]] std::string value(const std::string& name, std::string_view type,
                                  const std::string& expression);
  /// A name that no value has.
  [[nodiscard]] std::string unused_name(const std::string& name);
  /// The surface has moved: nothing computed before counts.
  void forget_shared() {
    shared_.clear();
    told_.clear();
  }

  /// A function beside that of the fragment. `text` has @ where its name stands; where another has the same
  /// text, the name of that.
  [[nodiscard]] std::string function(const std::string& name, const std::string& text);

  [[nodiscard]] bool tangents_alone() const { return tangents_alone_ >= 0; }
  [[nodiscard]] const std::vector<SurfaceMember>& expected_surface() const { return expected_; }
  /// What a member of the surface is called in the function.
  [[nodiscard]] std::string surface(SurfaceMember::Role role, int uv = -1);
  /// The frame of the pass is to know the change of the position.
  void need_footprint();
  /// A parameter as the code names it.
  [[nodiscard]] std::string parameter(const std::string& name, const std::string& meaning, double value);
  [[nodiscard]] std::string parameter(const std::string& name, const std::string& meaning,
                                      vec2<double> value);
  [[nodiscard]] std::string parameter(const std::string& name, const std::string& meaning,
                                      vec3<double> value);

  /// What mip levels go by at a texture coordinate: its own derivatives unless a parallax left others.
  struct Footprint {
    std::string dx, dy;
  };
  [[nodiscard]] Footprint footprint(int uv);
  void set_footprint(int uv, Footprint footprint) { footprints_[uv] = std::move(footprint); }

  // The layers.

  /// Every layer begins with this. maps are the names of its files.
  void begin_layer(const std::string& key, std::string_view kind, const std::string& maps);
  /// What is no layer: parameters begin with its name.
  void begin_part(const std::string& name);
  /// `layer3`: how identifiers of the current layer begin.
  [[nodiscard]] const std::string& layer() const { return layer_; }
  /// `stack_layer3`: how functions and textures of it begin.
  [[nodiscard]] std::string global() const { return "stack_" + layer_; }
  /// Of the current layer among the layers.
  [[nodiscard]] std::size_t layer_index() const { return static_cast<std::size_t>(layer_count_ - 1); }
  [[nodiscard]] const std::string& layer_key() const { return layer_key_; }
  /// What the layer's kind is called, for the meaning of parameters: `layers[3] noise`.
  [[nodiscard]] std::string meaning(std::string_view what) const;

  /// The frame of the pass.
  [[nodiscard]] const std::string& frame() const { return frame_; }
  [[nodiscard]] bool first_pass() const { return first_pass_; }
  /// A surface gradient joins the sum. weight and scale are expressions; an empty scale is 1.
  ///
  /// variance  of the slopes along an axis that the map's filter hides; empty: none is known
  void add(const std::string& weight, const std::string& scale, bool mix, const std::string& surfgrad,
           const std::string& variance = "");
  /// The same for a slope in a tangent frame. Slopes in one frame are summed before they become vectors.
  void add_slope(const std::string& weight, const std::string& scale, bool mix, const std::string& basis,
                 const std::string& slope, const std::string& variance = "");
  /// The sum so far as a value; empty while it is zero.
  [[nodiscard]] const std::string& sum();
  /// A new value of the sum.
  void set_sum(const std::string& expression);
  /// Variance of the slopes along an axis that the pass hides so far; empty while it is zero.
  [[nodiscard]] const std::string& variance() const { return variance_; }
  void set_variance(const std::string& expression) { variance_ = value("variance", "float", expression); }
  /// Options::roughness: that of the surface with all that is hidden.
  [[nodiscard]] std::string widened_roughness();
  /// The normal that the sum makes.
  [[nodiscard]] std::string resolved();
  /// Opens a pass on a frame.
  void begin_pass(const std::string& frame, bool first);
  /// diagnostics: a condition under which a layer lacks what it needs.
  void degenerate(const std::string& condition);
  /// The same, unless the condition has been told.
  void degenerate_once(const std::string& condition);

  /// The lines without values that nothing reads. rest: what follows them in the function.
  [[nodiscard]] std::string body(const std::string& rest) const;
  [[nodiscard]] const std::string& functions() const { return functions_; }

 private:
  void put(const std::string& text) { body_ += text; }
  void flush_slopes();
  void add_variance(const std::string& weight, const std::string& scale, bool mix,
                    const std::string& variance);
  [[nodiscard]] std::string parameter(const std::string& name, Parameter::Type type,
                                      const std::string& meaning, std::vector<double> value);

  const Options& options_;
  Shader& shader_;
  std::vector<SurfaceMember> expected_;
  int tangents_alone_;
  std::string body_, functions_;
  std::map<std::string, std::string> shared_;           // expression -> name
  std::set<std::string> told_;                          // of degenerate_once
  std::map<std::string, int> names_;                    // name -> how often it was wanted
  std::map<std::string, std::string> function_of_text_; // text -> name
  std::map<int, Footprint> footprints_;                 // that are not the coordinates' own derivatives
  std::string layer_, layer_key_, layer_kind_;
  int layer_count_ = 0;
  std::string frame_ = "frame";
  bool first_pass_ = true;
  std::string sum_;
  std::string variance_;         // of the pass
  std::string earlier_variance_; // of the passes before
  struct Slopes {
    std::string basis, slope;
  };
  Slopes slopes_; // not in the sum yet; none without a basis
};

} // namespace surfgrad::shadergen
