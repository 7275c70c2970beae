#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iostream>
#include <tautline/core/error.hpp>

#include "mesh/child.hpp"

namespace tautline::mesh {

namespace {

void limit(int resource, rlim_t most) {
  rlimit now{};
  getrlimit(static_cast<__rlimit_resource>(resource), &now);
  now.rlim_cur = std::min(most, now.rlim_max);
  setrlimit(static_cast<__rlimit_resource>(resource), &now);
}

/// Address space in use [bytes].
rlim_t size_now() {
  std::ifstream file("/proc/self/statm");
  rlim_t pages = 0;
  file >> pages;
  return pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

void apply(const ChildLimits& limits) {
  limit(RLIMIT_CORE, 0);
  if (limits.seconds > 0) limit(RLIMIT_CPU, static_cast<rlim_t>(limits.seconds));
#ifndef __SANITIZE_ADDRESS__  // which reserves more than there is
  if (limits.bytes > 0) limit(RLIMIT_AS, size_now() + limits.bytes);
#else
  (void)size_now;
#endif
}

void write_all(int to, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t n = ::write(to, text.data() + done, text.size() - done);
    if (n < 0 && errno != EINTR) ::_exit(1);
    if (n > 0) done += static_cast<std::size_t>(n);
  }
}

[[noreturn]] void be_child(const std::function<std::string()>& work, const ChildLimits& limits, int to) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL})
    std::signal(signal, SIG_DFL);
  const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int descriptor : {0, 1, 2}) ::dup2(nowhere, descriptor);
  apply(limits);
  try {
    write_all(to, work());
  } catch (...) {
    ::_exit(1);
  }
  ::_exit(0);
}

std::string read_all(int from) {
  std::string text;
  std::array<char, 65536> part{};
  while (true) {
    const ssize_t n = ::read(from, part.data(), part.size());
    if (n == 0 || (n < 0 && errno != EINTR)) return text;
    if (n > 0) text.append(part.data(), static_cast<std::size_t>(n));
  }
}

std::string words_for(int status, const ChildLimits& limits) {
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
    return fmt::format("no end of it within {} s", limits.seconds);
  if (WIFSIGNALED(status)) return fmt::format("it broke down ({})", strsignal(WTERMSIG(status)));
  return WEXITSTATUS(status) == 0 ? "" : "it broke down, or memory was short";
}

}  // namespace

std::string in_child(const std::function<std::string()>& work, const ChildLimits& limits,
                     std::string& fault) {
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0)
    throw LibraryError(fmt::format("cannot open a pipe: {}", std::strerror(errno)));
  std::cout.flush();
  const pid_t child = ::fork();
  if (child == 0) be_child(work, limits, pipe[1]);
  ::close(pipe[1]);
  if (child < 0) {
    ::close(pipe[0]);
    throw LibraryError(fmt::format("cannot start a process: {}", std::strerror(errno)));
  }
  std::string result = read_all(pipe[0]);
  ::close(pipe[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  fault = words_for(status, limits);
  return fault.empty() ? result : std::string();
}

}  // namespace tautline::mesh
