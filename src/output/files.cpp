#include "output/detail/files.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <tautline/core/error.hpp>

namespace tautline::output::detail {

namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

[[noreturn]] void fail(const std::string& doing, const std::string& path, int error_number) {
  throw LibraryError(fmt::format("cannot {} {}: {}", doing, path, reason(error_number)));
}

/// Whether what was written to a file or directory is on the disk now; file systems that cannot say are
/// believed.
bool reached_disk(int descriptor) {
  return ::fsync(descriptor) == 0 || errno == EINVAL || errno == ENOSYS || errno == ENOTSUP;
}

/// Puts a rename on the disk.
void keep_name(const std::string& path) {
  const auto folder = std::filesystem::path(path).parent_path();
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;  // a directory that may be written to but not read
  const bool kept = reached_disk(descriptor);
  const int error_number = errno;
  ::close(descriptor);
  if (!kept) fail("write", path, error_number);
}

/// Whether all of `text` reached the disk cache, or, if `durable`, the disk; errno tells why not.
bool write_all(const std::string& path, std::string_view text, bool durable) {
  ::unlink(path.c_str());  // of a process of this number that was killed; a link is removed, not followed
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (descriptor < 0) return false;
  std::FILE* file = fdopen(descriptor, "wb");
  if (file == nullptr) return false;
  const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size() &&
                       std::fflush(file) == 0 && (!durable || reached_disk(descriptor));
  const int error_number = errno;
  const bool closed = std::fclose(file) == 0;
  if (!written) errno = error_number;
  return written && closed;
}

}  // namespace

std::string reason(int error_number) {
  return error_number == 0 ? "unknown error" : std::strerror(error_number);
}

void write_file(const std::string& path, std::string_view text, bool durable) {
  const std::string temporary = fmt::format("{}.{}.tmp", path, getpid());
  errno = 0;
  if (!write_all(temporary, text, durable) || std::rename(temporary.c_str(), path.c_str()) != 0) {
    const int error_number = errno;
    std::remove(temporary.c_str());
    fail("write", path, error_number);
  }
  if (durable) keep_name(path);
}

std::string read_file(const std::string& path) {
  errno = 0;
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) fail("read", path, errno);
  std::string text;
  char block[1 << 16];
  while (const std::size_t n = std::fread(block, 1, sizeof block, file.get())) text.append(block, n);
  if (std::ferror(file.get()) != 0) fail("read", path, errno);
  return text;
}

}  // namespace tautline::output::detail
