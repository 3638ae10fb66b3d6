#include "shadergen/generator.hpp"

#include "shadergen/parameters.hpp"
#include "shadergen/tokens.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace surfgrad::shadergen {
namespace {

using Role = SurfaceMember::Role;

/// Members of the surface as they are declared: `N` stands for the UV set.
struct Member {
  Role role;
  std::string_view type, name;
  bool of_object = false;
};

constexpr Member members[] = {{Role::position, "vec3", "position"},
                              {Role::normal, "vec3", "normal"},
                              {Role::dp_dx, "vec3", "dp_dx"},
                              {Role::dp_dy, "vec3", "dp_dy"},
                              {Role::front_facing, "bool", "front_facing"},
                              {Role::normal_is_absent, "bool", "normal_is_absent"},
                              {Role::st, "vec2", "stN"},
                              {Role::dst_dx, "vec2", "dstN_dx"},
                              {Role::dst_dy, "vec2", "dstN_dy"},
                              {Role::tangent, "vec4", "tangentN"},
                              {Role::object_position, "vec3", "object_position"},
                              {Role::world_position, "vec3", "world_position"},
                              {Role::world_from_object, "mat3", "world_from_object", true},
                              {Role::object_from_world, "mat3", "object_from_world", true},
                              {Role::object_origin, "vec3", "object_origin", true},
                              {Role::world_origin, "vec3", "world_origin", true},
                              {Role::to_viewer, "vec3", "to_viewer"},
                              {Role::to_sun, "vec3", "to_sun", true},
                              {Role::raster, "vec2", "raster"},
                              {Role::dn_dx, "vec3", "dn_dx"},
                              {Role::dn_dy, "vec3", "dn_dy"},
                              {Role::relative_from_screen, "mat4", "relative_from_screen", true},
                              {Role::roughness, "float", "roughness"}};

SurfaceMember member_of(Role role, int uv) {
  const Member& m = *std::find_if(std::begin(members), std::end(members),
                                  [&](const Member& candidate) { return candidate.role == role; });
  std::string name(m.name);
  if (const std::size_t place = name.find('N'); place != std::string::npos)
    name.replace(place, 1, std::to_string(uv));
  return {role, std::string(m.type), std::move(name), uv, m.of_object};
}

} // namespace

Generator::Generator(const Options& options, Shader& shader, std::vector<SurfaceMember> expected,
                     int tangents_alone)
    : options_(options), shader_(shader), expected_(std::move(expected)), tangents_alone_(tangents_alone) {}

void Generator::paragraph(const std::string& comment) { put("\n  // " + comment + "\n"); }

std::string Generator::unused_name(const std::string& name) {
  const int count = ++names_[name];
  return count == 1 ? name : unused_name(fmt::format("{}_{}", name, count));
}

std::string Generator::value(const std::string& name, std::string_view type, const std::string& expression) {
  std::string result = unused_name(name);
  line("{} {} = {};", type, result, expression);
  return result;
}

std::string Generator::shared(const std::string& name, std::string_view type, const std::string& expression) {
  const auto found = shared_.find(expression);
  if (found != shared_.end()) return found->second;
  return shared_[expression] = value(name, type, expression);
}

std::string Generator::function(const std::string& name, const std::string& text) {
  const auto found = function_of_text_.find(text);
  if (found != function_of_text_.end()) return found->second;
  const std::string own = unused_name(name);
  std::string code = text;
  code.replace(code.find('@'), 1, own);
  functions_ += code + "\n";
  return function_of_text_[text] = own;
}

std::string Generator::body(const std::string& rest) const {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < body_.size();) {
    const std::size_t end = body_.find('\n', begin) + 1;
    lines.push_back(body_.substr(begin, end - begin));
    begin = end;
  }
  std::map<std::string, int, std::less<>> counts;
  const auto count_words = [&](const std::string& text, int sign) {
    for (const Token& t : tokens_of(text))
      if (t.kind == Token::Kind::word) counts[std::string(t.text)] += sign;
  };
  count_words(body_ + rest, 1);
  // Values read only earlier ones: from the last on, each knows who is left to read it.
  for (std::size_t i = lines.size(); i-- > 0;) {
    const std::vector<Token> tokens = tokens_of(lines[i]);
    const bool declares = tokens.size() > 5 && tokens[1].kind == Token::Kind::word &&
                          tokens[3].kind == Token::Kind::word && tokens[5].text == "=";
    if (!declares || counts.at(std::string(tokens[3].text)) > 1) continue;
    count_words(lines[i], -1);
    lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(i));
  }
  std::string text;
  for (const std::string& line : lines) text += line;
  return text;
}

std::string Generator::surface(Role role, int uv) {
  // A footprint is the change of a position, and what takes derivatives across pixels needs that.
  if (role == Role::dp_dx || role == Role::dp_dy) static_cast<void>(surface(Role::position));
  const SurfaceMember member = member_of(role, uv);
  const auto key = [](const SurfaceMember& m) { return std::tuple(m.uv, m.role); };
  auto& list = shader_.surface;
  const auto place =
      std::find_if(list.begin(), list.end(), [&](const SurfaceMember& m) { return !(key(m) < key(member)); });
  if (place == list.end() || key(*place) != key(member)) list.insert(place, member);
  return "s." + member.name;
}

void Generator::need_footprint() {
  static_cast<void>(surface(Role::dp_dx));
  static_cast<void>(surface(Role::dp_dy));
}

std::string Generator::parameter(const std::string& name, Parameter::Type type, const std::string& what,
                                 std::vector<double> value) {
  add_parameter(shader_, layer_ + "_" + name, type, meaning(what), std::move(value));
  return fmt::format("stack_parameters.{}", shader_.parameters.back().name);
}

std::string Generator::parameter(const std::string& name, const std::string& what, double value) {
  return parameter(name, Parameter::Type::number, what, {value});
}
std::string Generator::parameter(const std::string& name, const std::string& what, vec2<double> value) {
  return parameter(name, Parameter::Type::vec2, what, {value.x, value.y});
}
std::string Generator::parameter(const std::string& name, const std::string& what, vec3<double> value) {
  return parameter(name, Parameter::Type::vec4, what, {value.x, value.y, value.z, 0.0}) + ".xyz";
}

Generator::Footprint Generator::footprint(int uv) {
  const auto other = footprints_.find(uv);
  if (other != footprints_.end()) return other->second;
  return {surface(Role::dst_dx, uv), surface(Role::dst_dy, uv)};
}

void Generator::begin_layer(const std::string& key, std::string_view kind, const std::string& maps) {
  layer_ = fmt::format("layer{}", layer_count_++);
  layer_key_ = key;
  layer_kind_ = kind;
  paragraph(fmt::format("{}: {}{}{}", key.empty() ? layer_ : key, kind, maps.empty() ? "" : " ", maps));
}

void Generator::begin_part(const std::string& name) {
  layer_ = name;
  layer_key_ = name;
  layer_kind_ = "";
}

std::string Generator::meaning(std::string_view what) const {
  return fmt::format("{}{}{}: {}", layer_key_.empty() ? layer_ : layer_key_, layer_kind_.empty() ? "" : " ",
                     layer_kind_, what);
}

void Generator::flush_slopes() {
  if (slopes_.basis.empty()) return;
  const Slopes slopes = std::exchange(slopes_, {});
  const std::string g = fmt::format("surfgrad_from_tbn({}, {}.tangent, {}.bitangent)", slopes.slope,
                                    slopes.basis, slopes.basis);
  set_sum(sum_.empty() ? g : fmt::format("{} + {}", sum_, g));
}

const std::string& Generator::sum() {
  flush_slopes();
  return sum_;
}

void Generator::set_sum(const std::string& expression) { sum_ = value("sum", "vec3", expression); }

namespace {

std::string product_of(const std::string& weight, const std::string& scale, const std::string& what) {
  return scale.empty() ? fmt::format("{} * {}", weight, what)
                       : fmt::format("({} * {}) * {}", weight, scale, what);
}

} // namespace

// Variances of independent slopes add up, each by the square of what scales its slopes.
void Generator::add_variance(const std::string& weight, const std::string& scale, bool mix,
                             const std::string& variance) {
  const bool yields = mix && !variance_.empty();
  if (variance.empty() && !yields) return;
  std::string all = yields ? fmt::format("stack_square(1.0 - {}) * {}", weight, variance_) : variance_;
  if (!variance.empty())
    all += fmt::format("{}stack_square({}{}{}) * {}", all.empty() ? "" : " + ", weight,
                       scale.empty() ? "" : " * ", scale, variance);
  set_variance(all);
}

std::string Generator::widened_roughness() {
  const std::string roughness = surface(Role::roughness);
  const std::string both = earlier_variance_.empty() || variance_.empty() ? "" : " + ";
  const std::string all = earlier_variance_ + both + variance_;
  return all.empty() ? roughness : fmt::format("stack_widened({}, {})", roughness, all);
}

void Generator::add(const std::string& weight, const std::string& scale, bool mix, const std::string& g,
                    const std::string& variance) {
  flush_slopes();
  add_variance(weight, scale, mix, variance);
  const std::string scaled = product_of(weight, scale, g);
  if (sum_.empty())
    set_sum(scaled);
  else if (mix)
    set_sum(fmt::format("(1.0 - {}) * {} + {}", weight, sum_, scaled));
  else
    set_sum(fmt::format("{} + {}", sum_, scaled));
}

void Generator::add_slope(const std::string& weight, const std::string& scale, bool mix,
                          const std::string& basis, const std::string& slope, const std::string& variance) {
  const std::string scaled = product_of(weight, scale, slope);
  if (mix && (!sum_.empty() || !slopes_.basis.empty())) {
    const std::string own = variance.empty() ? value("slope", "vec2", slope) : slope; // part of a value
    add(weight, scale, mix, fmt::format("surfgrad_from_tbn({}, {}.tangent, {}.bitangent)", own, basis, basis),
        variance);
    return;
  }
  add_variance(weight, scale, false, variance);
  if (slopes_.basis == basis) {
    slopes_.slope = value("slope", "vec2", fmt::format("{} + {}", slopes_.slope, scaled));
    return;
  }
  flush_slopes();
  slopes_ = {basis, value("slope", "vec2", scaled)};
}

std::string Generator::resolved() {
  if (tangents_alone()) {
    const std::string tangent = surface(Role::tangent, tangents_alone_);
    const std::string normal = surface(Role::normal);
    const std::string slope = std::exchange(slopes_, {}).slope;
    const auto turned = [&](const char* sign) {
      return options_.back_faces == stack::BackFaces::mirror
                 ? fmt::format("select({}, 1.0, -1.0) * {}", surface(Role::front_facing), sign)
                 : std::string(sign);
    };
    const std::string result =
        fmt::format("surfgrad_resolve_mikktspace({}, {}.xyz, {}, {})", turned(normal.c_str()), tangent,
                    turned((tangent + ".w").c_str()), slope);
    return options_.back_faces == stack::BackFaces::flip
               ? fmt::format("select({}, 1.0, -1.0) * {}", surface(Role::front_facing), result)
               : result;
  }
  const std::string& all = sum();
  return fmt::format("surfgrad_resolve_normal({}, {})", frame_, all.empty() ? "vec3(0.0, 0.0, 0.0)" : all);
}

void Generator::begin_pass(const std::string& frame, bool first) {
  frame_ = frame;
  first_pass_ = first;
  if (!variance_.empty() && !earlier_variance_.empty())
    earlier_variance_ = value("variance", "float", earlier_variance_ + " + " + variance_);
  else if (!variance_.empty())
    earlier_variance_ = variance_;
  variance_.clear();
  sum_.clear();
  slopes_ = {};
}

void Generator::degenerate(const std::string& condition) {
  if (options_.diagnostics) line("degenerate = degenerate || {};", condition);
}

void Generator::degenerate_once(const std::string& condition) {
  if (told_.insert(condition).second) degenerate(condition);
}

} // namespace surfgrad::shadergen
