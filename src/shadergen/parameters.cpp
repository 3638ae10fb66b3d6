#include "shadergen/parameters.hpp"

#include <fmt/format.h>

#include <cstring>

namespace surfgrad::shadergen {
namespace {

/// Size of a member, which is its alignment too.
int size_of(Parameter::Type type) {
  switch (type) {
  case Parameter::Type::vec2:
    return 8;
  case Parameter::Type::vec4:
    return 16;
  case Parameter::Type::number:
    break;
  }
  return 4;
}

std::string_view word_of(Parameter::Type type) {
  switch (type) {
  case Parameter::Type::vec2:
    return "vec2";
  case Parameter::Type::vec4:
    return "vec4";
  case Parameter::Type::number:
    break;
  }
  return "float";
}

int end_of(const Shader& shader) {
  if (shader.parameters.empty()) return 0;
  const Parameter& last = shader.parameters.back();
  return last.offset + size_of(last.type);
}

int aligned(int offset, int to) { return (offset + to - 1) / to * to; }

} // namespace

void add_parameter(Shader& shader, std::string name, Parameter::Type type, std::string meaning,
                   std::vector<double> value) {
  const int offset = aligned(end_of(shader), size_of(type));
  shader.parameters.push_back({std::move(name), type, offset, std::move(meaning), std::move(value)});
}

std::vector<BlockMember> block_members(const Shader& shader) {
  std::vector<BlockMember> members;
  int end = 0;
  const auto fill_up_to = [&](int offset) {
    for (; end < offset; end += 4) members.push_back({"float", fmt::format("unused{}", end), ""});
  };
  for (const Parameter& p : shader.parameters) {
    fill_up_to(p.offset);
    members.push_back({word_of(p.type), p.name, p.meaning});
    end += size_of(p.type);
  }
  fill_up_to(aligned(end, 16));
  return members;
}

std::vector<std::byte> block_data(const Shader& shader) {
  std::vector<std::byte> data(static_cast<std::size_t>(aligned(end_of(shader), 16)));
  for (const Parameter& p : shader.parameters)
    for (std::size_t i = 0; i < p.value.size(); ++i) {
      const float value = static_cast<float>(p.value[i]);
      std::memcpy(data.data() + static_cast<std::size_t>(p.offset) + 4 * i, &value, sizeof value);
    }
  return data;
}

} // namespace surfgrad::shadergen
