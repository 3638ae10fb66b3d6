#include "io/gltf_uri.hpp"

#include "io/file.hpp"
#include "io/gltf_check.hpp"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <charconv>
#include <span>
#include <string_view>
#include <system_error>

namespace surfgrad::io::gltf {
namespace {

constexpr std::string_view base64_digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

// URIs may be megabytes of data: a message shows their beginning.
constexpr std::size_t longest_quote = 60;

/// A URI that is being read, with its place for messages.
class Uri {
 public:
  Uri(const std::filesystem::path& model, const std::string& owner, const std::string& text)
      : model_(&model), place_(owner + ".uri"), text_(text) {}

  /// The file that a relative reference (RFC 3986) names.
  [[nodiscard]] std::filesystem::path file() const {
    constexpr const char* remedy =
        "expected the name of a file in the model's folder or below, or a data: URI";
    if (text_.substr(0, text_.find('/')).find(':') != text_.npos) refuse("names a scheme", remedy);
    const std::string decoded = percent_decoded();
    if (decoded.empty()) fail(*model_, place_, "is empty", remedy);
    // A backslash separates folders on some systems only; a control character has no place in a name.
    for (const char c : decoded)
      if (c == '\\' || static_cast<unsigned char>(c) < 0x20)
        refuse("has a backslash or control character", remedy);
    const std::filesystem::path name(std::u8string(decoded.begin(), decoded.end()));
    if (name.has_root_path()) refuse("is an absolute path", remedy);
    for (const std::filesystem::path& part : name)
      if (part == "..") refuse("leaves the model's folder", remedy);
    std::filesystem::path result = model_->parent_path() / name;
    std::error_code ignored;
    if (!std::filesystem::exists(result, ignored))
      fail(*model_, place_, fmt::format("{} does not exist", result.string()),
           "expected a file that the model comes with");
    return result;
  }

  /// The bytes in a data: URI.
  [[nodiscard]] std::vector<std::byte> data() const {
    std::string_view digits = text_;
    const auto comma = digits.find(',');
    if (comma == digits.npos || !digits.substr(0, comma).ends_with(";base64"))
      refuse("is not base64", "expected data:<type>;base64,<data>");
    digits.remove_prefix(comma + 1);
    while (digits.ends_with('=')) digits.remove_suffix(1);
    // tinygltf would stop at a wrong digit without a word.
    if (const auto wrong = digits.find_first_not_of(base64_digits); wrong != digits.npos)
      fail(*model_, place_, fmt::format("has a wrong base64 digit at data character {}", wrong),
           "expected A-Z a-z 0-9 + /");
    // It knows few media types; what the data is shows in the data.
    std::vector<unsigned char> bytes;
    std::string ignored_type;
    if (!digits.empty())
      tinygltf::DecodeDataURI(&bytes, ignored_type,
                              fmt::format("data:application/octet-stream;base64,{}", digits), 0, false);
    const auto view = std::as_bytes(std::span(bytes));
    return {view.begin(), view.end()};
  }

 private:
  [[noreturn]] void refuse(std::string_view problem, const char* remedy) const {
    fail(*model_, place_,
         fmt::format("\"{}{}\" {}", text_.substr(0, longest_quote), text_.size() > longest_quote ? "..." : "",
                     problem),
         remedy);
  }

  /// tinygltf would turn + to a blank and take anything for a hexadecimal digit.
  [[nodiscard]] std::string percent_decoded() const {
    std::string result;
    for (std::size_t i = 0; i < text_.size(); ++i) {
      result += text_[i];
      if (text_[i] != '%') continue;
      const std::string_view digits = text_.substr(i + 1, 2);
      unsigned char code = 0;
      const char* end = std::from_chars(digits.data(), digits.data() + digits.size(), code, 16).ptr;
      if (digits.size() < 2 || end != digits.data() + 2)
        refuse("has a broken percent code", "expected % and two hexadecimal digits");
      result.back() = static_cast<char>(code);
      i += 2;
    }
    return result;
  }

  const std::filesystem::path* model_;
  std::string place_;
  std::string_view text_;
};

} // namespace

Resource read_uri(const std::filesystem::path& model, const std::string& owner, const std::string& uri) {
  const Uri reader(model, owner, uri);
  if (uri.starts_with("data:")) return {fmt::format("{}:{}", model.string(), owner), reader.data()};
  std::filesystem::path file = reader.file();
  std::vector<std::byte> bytes = read_file(file);
  return {std::move(file), std::move(bytes)};
}

std::optional<std::filesystem::path> file_of_uri(const std::filesystem::path& model, const std::string& owner,
                                                 const std::string& uri) {
  if (uri.starts_with("data:")) return {};
  return Uri(model, owner, uri).file();
}

} // namespace surfgrad::io::gltf
