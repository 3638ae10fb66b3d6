#include "conformance/spirv_calls.hpp"

#include <spirv/unified1/GLSL.std.450.h>
#include <spirv/unified1/spirv.h>

#include <span>
#include <stdexcept>
#include <vector>

namespace surfgrad::test {
namespace {

using Words = std::span<const std::uint32_t>;
using Id = std::uint32_t;

/// A string literal: four characters a word, ended by a zero.
std::string literal(Words words) {
  std::string text;
  for (const std::uint32_t word : words)
    for (unsigned shift = 0; shift < 32; shift += 8) {
      const char c = static_cast<char>(word >> shift & 0xff);
      if (c == 0) return text;
      text += c;
    }
  return text;
}

struct Body {
  Id type = 0;
  std::set<Id> calls{};
  std::set<Loose> operations{};
};

class Reader {
 public:
  explicit Reader(const gpu::Spirv& module) {
    constexpr std::size_t header = 5;
    for (std::size_t at = header; at < module.size();) {
      const std::uint32_t length = module[at] >> 16;
      if (length == 0 || at + length > module.size())
        throw std::runtime_error("a SPIR-V module is cut short");
      read(module[at] & 0xffff, Words(module).subspan(at + 1, length - 1));
      at += length;
    }
  }

  [[nodiscard]] ShaderFunctions reachable() const {
    std::set<Id> seen;
    std::vector<Id> left = entries_;
    while (!left.empty()) {
      const Id id = left.back();
      left.pop_back();
      if (!seen.insert(id).second) continue;
      const auto& calls = bodies_.at(id).calls;
      left.insert(left.end(), calls.begin(), calls.end());
    }
    ShaderFunctions functions;
    for (const Id id : seen) {
      ShaderFunction& made = functions[signature(id)];
      for (const Id called : bodies_.at(id).calls) made.calls.insert(signature(called));
      made.operations = bodies_.at(id).operations;
    }
    return functions;
  }

 private:
  void read(std::uint32_t operation, Words a) {
    switch (operation) {
    case SpvOpName:
      names_[a[0]] = literal(a.subspan(1));
      break;
    case SpvOpEntryPoint:
      entries_.push_back(a[1]);
      break;
    case SpvOpTypeBool:
      types_[a[0]] = "bool";
      break;
    case SpvOpTypeInt:
      types_[a[0]] = a[2] != 0 ? "int" : "uint";
      break;
    case SpvOpTypeFloat:
      types_[a[0]] = "float";
      break;
    case SpvOpTypeVector: {
      const std::string& of = types_.at(a[1]);
      types_[a[0]] = (of == "float" ? "" : of.substr(0, 1)) + "vec" + std::to_string(a[2]);
      break;
    }
    case SpvOpTypeMatrix:
      types_[a[0]] = "mat" + std::to_string(a[2]);
      break;
    case SpvOpConstant:
      constants_[a[1]] = a[2];
      break;
    case SpvOpTypeArray:
      types_[a[0]] = types_.at(a[1]) + "[" + std::to_string(constants_.at(a[2])) + "]";
      break;
    case SpvOpTypeStruct:
      types_[a[0]] = names_[a[0]];
      break;
    case SpvOpTypePointer:
      types_[a[0]] = types_[a[2]];
      break;
    case SpvOpTypeFunction:
      for (const Id parameter : a.subspan(2))
        parameters_[a[0]] += (parameters_[a[0]].empty() ? "" : ", ") + types_.at(parameter);
      break;
    case SpvOpFunction:
      current_ = &bodies_[a[1]];
      current_->type = a[3];
      break;
    case SpvOpFunctionCall:
      current_->calls.insert(a[2]);
      break;
    case SpvOpFDiv:
      current_->operations.insert(Loose::division);
      break;
    case SpvOpExtInst:
      read_extended(a[3]);
      break;
    default:
      break;
    }
  }

  /// Of GLSL.std.450, the only set of instructions that these compilers import.
  void read_extended(std::uint32_t instruction) {
    switch (instruction) {
    case GLSLstd450InverseSqrt:
    case GLSLstd450Normalize:
      current_->operations.insert(Loose::inverse_root);
      break;
    case GLSLstd450Sqrt:
    case GLSLstd450Length:
    case GLSLstd450Distance:
      current_->operations.insert(Loose::root);
      break;
    case GLSLstd450Pow:
    case GLSLstd450Exp:
    case GLSLstd450Exp2:
    case GLSLstd450Log:
    case GLSLstd450Log2:
      current_->operations.insert(Loose::power);
      break;
    default:
      break;
    }
  }

  /// Compilers mangle names of functions behind a parenthesis.
  [[nodiscard]] std::string signature(Id function) const {
    const auto name = names_.find(function);
    const auto parameters = parameters_.find(bodies_.at(function).type);
    return (name == names_.end() ? "" : name->second.substr(0, name->second.find('('))) + "(" +
           (parameters == parameters_.end() ? "" : parameters->second) + ")";
  }

  std::map<Id, std::string> names_, types_, parameters_;
  std::map<Id, std::uint32_t> constants_;
  std::map<Id, Body> bodies_;
  std::vector<Id> entries_;
  Body* current_ = nullptr;
};

} // namespace

ShaderFunctions functions_of(const gpu::Spirv& module) { return Reader(module).reachable(); }

std::set<Loose> operations_under(const ShaderFunctions& functions, const std::string& name) {
  std::set<Loose> operations;
  std::set<std::string> seen;
  std::vector<std::string> left{name + "()"};
  while (!left.empty()) {
    const std::string signature = left.back();
    left.pop_back();
    if (!seen.insert(signature).second) continue;
    const ShaderFunction& function = functions.at(signature);
    operations.insert(function.operations.begin(), function.operations.end());
    left.insert(left.end(), function.calls.begin(), function.calls.end());
  }
  return operations;
}

} // namespace surfgrad::test
