#include "steps/processes.hpp"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <map>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <tautline/core/error.hpp>
#include <tautline/core/interrupt.hpp>

namespace tautline::steps {

namespace {

pid_t start(const Command& command) {
  std::vector<char*> words;
  for (const auto& word : command.words) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, command.log.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                   0644);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t id = 0;
  const int code = posix_spawn(&id, words.front(), &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (code != 0)
    throw LibraryError(fmt::format("starting {} failed: {}", command.words.front(), std::strerror(code)));
  return id;
}

int exit_code(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

std::vector<int> run_side_by_side(const std::vector<Command>& commands, int jobs,
                                  const std::function<void(std::size_t)>& ended) {
  std::vector<int> codes(commands.size(), static_cast<int>(ExitCode::interrupted));
  std::map<pid_t, std::size_t> running;
  std::size_t next = 0;
  bool told = false;  // those that run, to stop
  while (true) {
    while (next < commands.size() && static_cast<int>(running.size()) < jobs && !interrupt_requested()) {
      running.emplace(start(commands[next]), next);
      ++next;
    }
    if (running.empty()) return codes;
    if (interrupt_requested() && !told) {
      for (const auto& [id, index] : running) kill(id, SIGTERM);
      told = true;
    }
    int status = 0;
    const pid_t id = waitpid(-1, &status, WNOHANG);
    if (id == 0 || (id < 0 && errno == EINTR)) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      continue;
    }
    if (id < 0) throw LibraryError(fmt::format("waiting for a run failed: {}", std::strerror(errno)));
    const auto found = running.find(id);
    if (found == running.end()) continue;
    codes[found->second] = exit_code(status);
    ended(found->second);
    running.erase(found);
  }
}

std::string own_program() {
  return std::filesystem::read_symlink("/proc/self/exe").string();
}

}  // namespace tautline::steps
