#include "shadergen/line_breaks.hpp"

#include <algorithm>
#include <array>

namespace surfgrad::shadergen {
namespace {

/// Where the first part of a line that is too long best ends: at a comma or before an operator outside as
/// many brackets as possible, and as late as possible. 0 where there is no such place.
std::size_t best_end(std::string_view line, std::size_t indent) {
  static constexpr std::array<std::string_view, 7> operators{" + ",  " - ", " * ", " && ",
                                                             " || ", " ? ", " : "};
  std::size_t best = 0;
  int least_depth = 1 << 20, depth = 0;
  for (std::size_t i = indent; i < std::min(line.size(), most_columns); ++i) {
    const char c = line[i];
    if (c == '(' || c == '{') ++depth;
    if (c == ')' || c == '}') --depth;
    const bool comma = c == ' ' && line[i - 1] == ',';
    const bool before_operator = std::any_of(operators.begin(), operators.end(), [&](std::string_view o) {
      return line.substr(i).starts_with(o);
    });
    if (i < most_columns / 2 || (!comma && !before_operator) || depth > least_depth) continue;
    least_depth = depth;
    best = i;
  }
  return best;
}

std::string next_line(std::string_view& code) {
  const std::size_t end = std::min(code.find('\n'), code.size());
  const std::string line(code.substr(0, end));
  code.remove_prefix(std::min(end + 1, code.size()));
  return line;
}

/// Whether a statement goes on in the next line.
bool continues(const std::string& line) {
  if (line.empty() || line.find("//") != std::string::npos || line.find('#') != std::string::npos)
    return false;
  if (std::string_view("{};").find(line.back()) != std::string_view::npos) return false;
  // Members of a struct end in a comma in WGSL.
  return line.back() != ',' ||
         std::count(line.begin(), line.end(), '(') > std::count(line.begin(), line.end(), ')');
}

} // namespace

std::string with_line_breaks(std::string_view code) {
  std::string result;
  while (!code.empty()) {
    std::string line = next_line(code);
    while (continues(line) && !code.empty()) {
      const std::string rest = next_line(code);
      line += ' ' + rest.substr(std::min(rest.find_first_not_of(' '), rest.size()));
    }
    const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
    const std::size_t remark = line.find("//");
    const bool is_code = remark == std::string::npos && line.find('#') == std::string::npos;
    std::size_t own_indent = indent;
    while (is_code && line.size() > most_columns) {
      const std::size_t place = best_end(line, own_indent);
      if (place == 0) break;
      result += line.substr(0, place) + "\n";
      own_indent = indent + 4;
      line = std::string(own_indent, ' ') + line.substr(place + 1);
    }
    result += line + "\n";
  }
  return result;
}

} // namespace surfgrad::shadergen
