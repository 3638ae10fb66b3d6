/// docs/paper-map.md is complete and names only functions and tests that exist.

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace surfgrad::test {
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Text of every file below a folder with one of the extensions.
std::string read_all(const fs::path& folder, const std::set<std::string>& extensions) {
  std::string text;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && extensions.contains(entry.path().extension().string()))
      text += read(entry.path());
  return text;
}

struct Row {
  std::string item, what, functions, proof;
};

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Rows of every table of the document whose first cell starts with the number of a source.
std::vector<Row> rows() {
  std::vector<Row> result;
  std::istringstream lines(read(fs::path(SURFGRAD_SOURCE_DIR) / "docs" / "paper-map.md"));
  for (std::string line; std::getline(lines, line);) {
    if (line.size() < 4 || line[0] != '|' || line.compare(2, 2, "00") != 0) continue;
    std::vector<std::string> cells;
    std::istringstream parts(line.substr(1));
    for (std::string cell; std::getline(parts, cell, '|');) cells.push_back(trimmed(cell));
    EXPECT_EQ(cells.size(), 4u) << line;
    cells.resize(4);
    result.push_back({cells[0], cells[1], cells[2], cells[3]});
  }
  return result;
}

/// "001 eq 9-12" stands for four items.
std::vector<std::string> expanded(const std::string& item) {
  static const std::regex range("(.* )([0-9]+)-([0-9]+)");
  std::smatch match;
  if (!std::regex_match(item, match, range)) return {item};
  std::vector<std::string> items;
  for (int i = std::stoi(match[2]); i <= std::stoi(match[3]); ++i)
    items.push_back(match[1].str() + std::to_string(i));
  return items;
}

/// The words between backticks.
std::vector<std::string> names(const std::string& cell) {
  static const std::regex quoted("`([^`]+)`");
  std::vector<std::string> found;
  for (std::sregex_iterator i(cell.begin(), cell.end(), quoted), end; i != end; ++i) found.push_back((*i)[1]);
  return found;
}

std::vector<std::string> required() {
  std::vector<std::string> items;
  const auto count = [&](const std::string& prefix, int last) {
    for (int i = 1; i <= last; ++i) items.push_back(prefix + std::to_string(i));
  };
  count("000 L", 17);
  count("000 eq ", 7);
  count("000 fig ", 4);
  count("001 eq ", 50);
  count("002 question ", 5);
  count("003 eq ", 8);
  count("004 eq ", 40);
  for (const char* claim : {"000 2.1 green",
                            "000 2.2 renormalisation",
                            "000 2.5 before displacement",
                            "000 2.6 curvature",
                            "000 2.6 search",
                            "000 2.7 noise",
                            "000 2.8 origin",
                            "000 2.8 handedness",
                            "000 2.8 separate gradients",
                            "000 2.8 post-resolve",
                            "000 2.9 accumulation",
                            "000 2.10 modes",
                            "000 2.10 reflect",
                            "000 2.11 second pass",
                            "000 2.11 analytic dP",
                            "000 2.11 facing",
                            "000 3 LOD",
                            "000 4 power",
                            "000 4 clamping",
                            "000 appendix",
                            "002 flat layer",
                            "003 finite differences"})
    items.push_back(claim);
  return items;
}

TEST(PaperMap, HasEveryItemExactlyOnce) {
  std::map<std::string, int> seen;
  for (const Row& row : rows())
    for (const std::string& item : expanded(row.item)) ++seen[item];
  for (const std::string& item : required()) {
    EXPECT_EQ(seen[item], 1) << "item '" << item << "' of docs/paper-map.md";
    seen.erase(item);
  }
  for (const auto& [item, times] : seen) ADD_FAILURE() << "item '" << item << "' is not one of the sources'";
}

TEST(PaperMap, NamesOnlyFunctionsThatExist) {
  const std::string headers = read_all(fs::path(SURFGRAD_SOURCE_DIR) / "include" / "surfgrad", {".hpp"});
  ASSERT_FALSE(headers.empty());
  for (const Row& row : rows()) {
    const auto functions = names(row.functions);
    EXPECT_FALSE(functions.empty()) << row.item << " names no function";
    for (const std::string& name : functions) {
      const std::regex declared("[^A-Za-z0-9_]" + name + "\\(");
      EXPECT_TRUE(std::regex_search(headers, declared)) << row.item << " names " << name;
    }
  }
}

TEST(PaperMap, NamesOnlyTestsThatExistAndProvesEveryRow) {
  const std::string tests = read_all(fs::path(SURFGRAD_SOURCE_DIR) / "tests", {".cpp"});
  // Every test of the project, as Suite.Name.
  std::set<std::string> existing;
  static const std::regex test("(?:^|\\n)(?:TYPED_)?TEST(?:_F|_P)?\\(\\s*(\\w+),\\s*(\\w+)\\)");
  for (std::sregex_iterator i(tests.begin(), tests.end(), test), end; i != end; ++i)
    existing.insert((*i)[1].str() + "." + (*i)[2].str());
  ASSERT_GT(existing.size(), 50u);
  static const std::regex later("issue [3-7]");
  for (const Row& row : rows()) {
    const auto proofs = names(row.proof);
    EXPECT_TRUE(!proofs.empty() || std::regex_search(row.proof, later))
        << row.item << " has neither a test nor the issue that delivers it";
    for (const std::string& name : proofs)
      EXPECT_TRUE(existing.contains(name)) << row.item << " names " << name;
  }
}

} // namespace
} // namespace surfgrad::test
