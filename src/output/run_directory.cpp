#include <tautline/output/run_directory.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <tautline/core/error.hpp>
#include <tautline/output/results.hpp>

#include "output/detail/files.hpp"

namespace tautline::output {

namespace fs = std::filesystem;

namespace {

constexpr const char* lock_file = ".tautline_lock";
constexpr const char* list_file = ".tautline_files";
constexpr const char* probe_file = ".tautline_probe_";  // as prepare_directory names it

/// Directories below that of a run, and how the names of what is written there end.
struct Below {
  const char* name;
  std::array<const char*, 2> endings;
};
constexpr std::array<Below, 3> below{
    {{"fields", {".vtu", ".pvtu"}}, {"pictures", {".png", ".png"}}, {"checkpoints", {".bin", ".bin"}}}};

/// Opens a file of this run's own; never one that a link points to.
int open_own(const std::string& path, int flags) {
  const int descriptor = ::open(path.c_str(), flags | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
  if (descriptor < 0) throw LibraryError(fmt::format("cannot write {}: {}", path, detail::reason(errno)));
  return descriptor;
}

void put(int descriptor, const std::string& text) {
  if (::write(descriptor, text.data(), text.size()) != static_cast<ssize_t>(text.size()))
    throw LibraryError(fmt::format("cannot write the list of the files of a run: {}", detail::reason(errno)));
}

/// Removes a file or a link, but nothing else. A file that is gone already is no fault.
void remove_file(const fs::path& path) {
  std::error_code error;
  const auto status = fs::symlink_status(path, error);
  if (!fs::is_regular_file(status) && !fs::is_symlink(status)) return;
  if (!fs::remove(path, error) && error)
    throw LibraryError(
        fmt::format("cannot remove {}, which an earlier run has left: {}", path.string(), error.message()));
}

bool is_plain_name(const std::string& name) {
  return !name.empty() && name != "." && name != ".." && name.find('/') == std::string::npos;
}

bool ends_with(const std::string& text, const std::string& ending) {
  return text.size() >= ending.size() &&
         text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

bool is_of_a_run(const std::string& name, const Below& where) {
  return std::any_of(where.endings.begin(), where.endings.end(),
                     [&](const char* ending) { return ends_with(name, ending); });
}

/// NAME of NAME.<process>.tmp, under which a file is written until it is whole; nothing of another name.
std::string name_without_process(const std::string& name) {
  const std::string ending = ".tmp", digits = "0123456789";
  if (!ends_with(name, ending)) return {};
  const auto dot = name.find_last_not_of(digits, name.size() - ending.size() - 1);
  if (dot == std::string::npos || name[dot] != '.' || dot + 1 + ending.size() == name.size()) return {};
  return name.substr(0, dot);
}

template <class Choice>
void remove_files(const fs::path& folder, const Choice& is_chosen) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (is_chosen(entry.path().filename().string())) remove_file(entry.path());
}

}  // namespace

RunDirectory::~RunDirectory() {
  if (list_ >= 0) ::close(list_);
  if (lock_ >= 0) ::close(lock_);  // the lock goes with the descriptor, also of a process that is killed
}

void RunDirectory::lock() {
  const std::string path = directory_ + "/" + lock_file;
  lock_ = open_own(path, O_RDWR);
  if (flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    std::string owner;
    std::getline(std::ifstream(path), owner);
    throw LibraryError(fmt::format(
        "another run{} writes its results to {}: wait for its end, or name another directory (-o)",
        owner.empty() ? "" : " (" + owner + ")", directory_));
  }  // where the file system knows no locks there is none
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  if (ftruncate(lock_, 0) == 0) put(lock_, fmt::format("process {} on {}\n", getpid(), host.data()));
}

std::set<std::string> RunDirectory::listed() const {
  std::set<std::string> names;
  std::ifstream list(directory_ + "/" + list_file);
  for (std::string name; std::getline(list, name);)
    if (is_plain_name(name)) names.insert(name);
  return names;
}

void RunDirectory::sweep() const {
  const auto names = listed();
  remove_files(directory_, [&](const std::string& name) {
    return names.contains(name_without_process(name)) || name.starts_with(probe_file);
  });
  for (const auto& where : below)
    remove_files(fs::path(directory_) / where.name,
                 [&](const std::string& name) { return is_of_a_run(name_without_process(name), where); });
}

void RunDirectory::clear() const {
  for (const auto& name : listed()) remove_file(fs::path(directory_) / name);
  for (const auto& where : below) {
    const fs::path folder = fs::path(directory_) / where.name;
    remove_files(folder, [&](const std::string& name) { return is_of_a_run(name, where); });
    std::error_code error;
    fs::remove(folder, error);  // if it is empty now
  }
}

void RunDirectory::open(bool goes_on) {
  prepare_directory(directory_);
  lock();
  for (const auto& where : below)
    if (fs::is_symlink(fs::path(directory_) / where.name))
      throw LibraryError(fmt::format("{}/{} is a link: results are written to no other place than {}",
                                     directory_, where.name, directory_));
  if (fs::exists(fs::path(directory_) / list_file)) {
    sweep();
    if (!goes_on) clear();
  }
  list_ = open_own(directory_ + "/" + list_file, O_WRONLY | O_APPEND | (goes_on ? 0 : O_TRUNC));
}

std::string RunDirectory::path(const std::string& name) {
  const bool is_new = std::find(names_.begin(), names_.end(), name) == names_.end();
  if (list_ >= 0 && is_new && is_plain_name(name)) {
    names_.push_back(name);
    put(list_, name + "\n");
  }
  return directory_ + "/" + name;
}

}  // namespace tautline::output
