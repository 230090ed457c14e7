#include "validation/parallel/child_process.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "msa/base/error.h"
#include "msa/base/index.h"

namespace deflect::parallel {
namespace {

/// A file in memory. The child reads and writes such files instead of pipes: nobody ever waits for a reader.
class MemoryFile {
 public:
  MemoryFile() : fd_(::memfd_create("deflect-child", MFD_CLOEXEC)) {
    if (fd_ < 0) fail();
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { ::close(fd_); }

  int fd() const { return fd_; }

  void write(std::string_view text) const {
    while (!text.empty()) {
      const ssize_t n = ::write(fd_, text.data(), text.size());
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) fail();
      text.remove_prefix(as_size(n));
    }
    ::lseek(fd_, 0, SEEK_SET);
  }

  std::string read() const {
    ::lseek(fd_, 0, SEEK_SET);
    std::string text;
    std::array<char, 65536> block;
    for (;;) {
      const ssize_t n = ::read(fd_, block.data(), block.size());
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return text;
      text.append(block.data(), as_size(n));
    }
  }

 private:
  [[noreturn]] static void fail() {
    throw InputError(fmt::format("no memory for a figure ({})", std::strerror(errno)));
  }

  int fd_;
};

}  // namespace

bool ChildOutcome::succeeded() const { return start_error == 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0; }

ChildOutcome run_child(std::vector<std::string> words, const std::string& input) {
  const MemoryFile in, out, errors;
  in.write(input);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, in.fd(), STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, out.fd(), STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, errors.fd(), STDERR_FILENO);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  ChildOutcome outcome;
  outcome.start_error = ::posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (outcome.start_error != 0) return outcome;
  while (::waitpid(child, &outcome.status, 0) < 0)
    if (errno != EINTR) throw std::logic_error(fmt::format("waiting for {}: {}", words.front(), std::strerror(errno)));
  outcome.output = out.read();
  outcome.errors = errors.read();
  return outcome;
}

}  // namespace deflect::parallel
