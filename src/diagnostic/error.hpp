#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace surfgrad {

/// Where an input went wrong and what would put it right. Parts that do not apply stay empty or zero.
struct Fault {
  std::filesystem::path file{}; ///< the file as the user named it
  int line = 0;                 ///< 1-based line in a text document; 0 where lines mean nothing
  std::string place{};          ///< key, accessor, chunk ...: e.g. `layers[2].uv`
  std::string problem{};        ///< what is wrong, e.g. `unknown key "scal"`
  std::string remedy{};         ///< what would be right, e.g. `expected one of: scale, mask`
};

/// The input is wrong: exit status 1. `what()` is one line: `file:line: place: problem; remedy`.
class InputError : public std::runtime_error {
public:
  explicit InputError(Fault fault);
  [[nodiscard]] const Fault& fault() const noexcept { return fault_; }

private:
  Fault fault_;
};

/// The machine lacks something the job needs (memory, a writable folder, a device): exit status 3.
class MachineError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// The progress callback asked to stop.
class Cancelled : public std::runtime_error {
public:
  Cancelled() : std::runtime_error("cancelled") {}
};

} // namespace surfgrad
