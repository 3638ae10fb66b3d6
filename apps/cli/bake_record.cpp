#include "bake_record.hpp"

#include "diagnostic/error.hpp"
#include "interrupt.hpp"
#include "io/file.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <set>
#include <span>
#include <system_error>

namespace surfgrad::cli {
namespace {

namespace fs = std::filesystem;

/// Whether each of these files holds what it held.
bool hold_the_same(const nlohmann::json& digests) {
  for (const auto& [file, digest] : digests.items()) {
    std::error_code gone;
    if (!fs::is_regular_file(file, gone) || io::digest_of_file(file) != digest.get<std::string>())
      return false;
  }
  return true;
}

/// File names may hold any bytes: those that are not UTF-8 are replaced, and no file has the name.
std::string text_of(const nlohmann::json& record) {
  return record.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

} // namespace

fs::path BakeRecord::file_for(const fs::path& output) { return output.string() + ".bake-record"; }

BakeRecord::BakeRecord(const fs::path& output, nlohmann::json job)
    : file_(file_for(output)), job_(std::move(job)) {}

bool BakeRecord::is_up_to_date(const std::function<void(std::string_view)>& warn) const {
  std::error_code none;
  if (!fs::exists(file_, none)) return false;
  try {
    const std::vector<std::byte> bytes = io::read_file(file_);
    const nlohmann::json record = nlohmann::json::parse(bytes.begin(), bytes.end());
    return record.at("job") == nlohmann::json::parse(text_of(job_)) && hold_the_same(record.at("inputs")) &&
           hold_the_same(record.at("outputs"));
  } catch (const nlohmann::json::exception&) {
    warn(fmt::format("{}: is no record of a bake; baking anew", file_.string()));
  } catch (const InputError& error) {
    warn(fmt::format("{}; baking anew", error.what()));
  }
  return false;
}

void BakeRecord::write(const std::map<fs::path, std::string>& inputs,
                       const std::vector<fs::path>& outputs) const {
  nlohmann::json record{
      {"job", job_}, {"inputs", nlohmann::json::object()}, {"outputs", nlohmann::json::object()}};
  for (const fs::path& output : outputs)
    record["outputs"][fs::absolute(output).string()] = io::digest_of_file(output);
  for (const auto& [file, digest] : inputs)
    if (!record["outputs"].contains(file.string())) record["inputs"][file.string()] = digest;
  const std::string text = text_of(record);
  const Unbroken whole_file;
  io::write_file(file_, std::as_bytes(std::span(text)));
}

} // namespace surfgrad::cli
