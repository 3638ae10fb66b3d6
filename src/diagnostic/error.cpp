#include "diagnostic/error.hpp"

#include <fmt/format.h>

#include <utility>

namespace surfgrad {
namespace {

std::string one_line(const Fault& fault) {
  std::string text = fault.file.string();
  if (fault.line > 0) text += fmt::format(":{}", fault.line);
  if (!text.empty()) text += ": ";
  if (!fault.place.empty()) text += fault.place + ": ";
  text += fault.problem;
  if (!fault.remedy.empty()) text += "; " + fault.remedy;
  // Names and values come from untrusted files: a control character must not break the line
  // or drive the terminal.
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  return text;
}

} // namespace

InputError::InputError(Fault fault) : std::runtime_error(one_line(fault)), fault_(std::move(fault)) {}

} // namespace surfgrad
