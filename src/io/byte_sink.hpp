#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace surfgrad::io {

/// Where encoders put bytes: one after the other, or back over bytes already written. What fails
/// throws.
class ByteSink {
 public:
  ByteSink() = default;
  ByteSink(const ByteSink&) = delete;
  ByteSink& operator=(const ByteSink&) = delete;
  virtual ~ByteSink() = default;

  virtual void write(std::span<const std::byte> bytes) = 0;
  /// The next byte goes to `position`, which lies within what was written or at its end.
  virtual void seek(std::uint64_t position) = 0;
  [[nodiscard]] virtual std::uint64_t position() const = 0;
};

} // namespace surfgrad::io
