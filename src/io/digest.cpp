#include "io/digest.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <new>

namespace surfgrad::io {
namespace {

std::string text_of(const XXH128_hash_t& hash) {
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

} // namespace

std::string digest(std::span<const std::byte> bytes) {
  return text_of(XXH3_128bits(bytes.data(), bytes.size()));
}

struct Digest::State {
  XXH3_state_t* xxh = XXH3_createState(); // aligned as it wants to be
  State() {
    if (xxh == nullptr) throw std::bad_alloc();
    XXH3_128bits_reset(xxh);
  }
  ~State() { XXH3_freeState(xxh); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
};

Digest::Digest() : state_(std::make_unique<State>()) {}
Digest::~Digest() = default;

void Digest::add(std::span<const std::byte> piece) {
  XXH3_128bits_update(state_->xxh, piece.data(), piece.size());
}

std::string Digest::text() const { return text_of(XXH3_128bits_digest(state_->xxh)); }

} // namespace surfgrad::io
