#include "io/read_log.hpp"

#include "io/digest.hpp"

#include <atomic>
#include <stdexcept>

namespace surfgrad::io {
namespace {

std::atomic<ReadLog*> current{nullptr};

} // namespace

ReadLog::ReadLog() {
  ReadLog* none = nullptr;
  if (!current.compare_exchange_strong(none, this)) throw std::logic_error("two logs of what is read");
}

ReadLog::~ReadLog() { current = nullptr; }

std::map<std::filesystem::path, std::string> ReadLog::files() const {
  const std::lock_guard lock(mutex_);
  return files_;
}

void note_read(const std::filesystem::path& file, std::span<const std::byte> bytes) {
  ReadLog* const log = current;
  if (log == nullptr) return;
  const std::filesystem::path name = std::filesystem::absolute(file);
  std::string held = digest(bytes);
  const std::lock_guard lock(log->mutex_);
  log->files_.try_emplace(name, std::move(held));
}

} // namespace surfgrad::io
