#include "cli/program.hpp"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

namespace surfgrad {
std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

int run_commands_of(const std::filesystem::path& page, const Folder& folder) {
  std::ifstream lines(SURFGRAD_SOURCE_DIR / page);
  const std::string program = "build/bin/surfgrad ";
  int commands = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(program)) continue;
    std::istringstream words(line.substr(program.size()));
    std::vector<std::string> arguments;
    for (std::string word; words >> word;) arguments.push_back(word);
    const Outcome run = run_program(arguments, folder.path());
    EXPECT_EQ(run.status, 0) << line << "\n" << run.error;
    ++commands;
  }
  return commands;
}

Running::Running(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                 const Streams& streams)
    : out_(streams.out.empty() ? (outputs_.path() / "out").string() : streams.out),
      error_(streams.error.empty() ? (outputs_.path() / "error").string() : streams.error) {
  std::vector<std::string> words{SURFGRAD_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, error_.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                   0600);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  // Shells start background jobs, so perhaps these tests, with interrupts ignored.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t interrupts;
  sigemptyset(&interrupts);
  sigaddset(&interrupts, SIGINT);
  sigaddset(&interrupts, SIGTERM);
  posix_spawnattr_setsigdefault(&attributes, &interrupts);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  if (posix_spawn(&child_, SURFGRAD_PROGRAM, &actions, &attributes, argv.data(), environ) != 0) child_ = 0;
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
}

void Running::send(int signal) const {
  if (child_ > 0) kill(child_, signal);
}

bool Running::ended() const {
  siginfo_t info{};
  return child_ <= 0 || (waitid(P_PID, static_cast<id_t>(child_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
                         info.si_pid != 0);
}

Outcome Running::wait() {
  Outcome run;
  int status = 0;
  if (child_ > 0 && waitpid(child_, &status, 0) == child_) {
    if (WIFEXITED(status)) run.status = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) run.signal = WTERMSIG(status);
  }
  const auto written_here = [&](const std::string& file) {
    return file.starts_with(outputs_.path().string()) ? text_of(file) : std::string();
  };
  run.out = written_here(out_);
  run.error = written_here(error_);
  return run;
}

Outcome run_program(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                    const Streams& streams) {
  return Running(arguments, folder, streams).wait();
}

Folder::Folder() {
  std::string pattern = (std::filesystem::path(testing::TempDir()) / "surfgrad_XXXXXX").string();
  path_ = mkdtemp(pattern.data());
}

Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path Folder::write(const std::string& name, std::string_view bytes) const {
  const std::filesystem::path file = path_ / name;
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return file;
}

std::vector<std::string> Folder::files() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(path_))
    names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

} // namespace surfgrad
