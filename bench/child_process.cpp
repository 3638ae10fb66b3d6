#include "child_process.hpp"

#include <csignal>
#include <fcntl.h>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

namespace surfgrad::bench {

ChildProcess::ChildProcess(const std::vector<std::string>& words, std::string prefix)
    : prefix_(std::move(prefix)) {
  std::signal(SIGPIPE, SIG_IGN); // a child that is gone shows in its answers
  int in[2];
  int out[2];
  if (pipe2(in, O_CLOEXEC) != 0 || pipe2(out, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  pid_ = fork();
  if (pid_ == 0) {
    dup2(in[0], STDIN_FILENO);
    dup2(out[1], STDOUT_FILENO);
    dup2(open("/dev/null", O_WRONLY), STDERR_FILENO);
    execvp(arguments[0], arguments.data());
    _exit(127);
  }
  close(in[0]);
  close(out[1]);
  to_ = in[1];
  from_ = out[0];
}

ChildProcess::~ChildProcess() {
  close(to_);
  close(from_);
  waitpid(pid_, nullptr, 0);
}

void ChildProcess::tell(const std::string& line) {
  const std::string text = line + "\n";
  // What a dead child does not read, its missing answer tells.
  [[maybe_unused]] const ssize_t written = write(to_, text.data(), text.size());
}

std::optional<std::string> ChildProcess::answer() {
  for (;;) {
    for (std::size_t end = read_.find('\n'); end != std::string::npos; end = read_.find('\n')) {
      const std::string line = read_.substr(0, end);
      read_.erase(0, end + 1);
      if (line.starts_with(prefix_)) return line.substr(prefix_.size());
    }
    char buffer[4096];
    const ssize_t count = read(from_, buffer, sizeof buffer);
    if (count <= 0) return std::nullopt;
    read_.append(buffer, static_cast<std::size_t>(count));
  }
}

} // namespace surfgrad::bench
