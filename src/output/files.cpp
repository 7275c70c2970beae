#include "output/detail/files.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
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

/// Whether all of `text` reached the disk cache; errno tells why not.
bool write_all(const std::string& path, std::string_view text) {
  ::unlink(path.c_str());  // of a process of this number that was killed; a link is removed, not followed
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (descriptor < 0) return false;
  std::FILE* file = fdopen(descriptor, "wb");
  if (file == nullptr) return false;
  const bool written =
      std::fwrite(text.data(), 1, text.size(), file) == text.size() && std::fflush(file) == 0;
  const int error_number = errno;
  const bool closed = std::fclose(file) == 0;
  if (!written) errno = error_number;
  return written && closed;
}

}  // namespace

std::string reason(int error_number) {
  return error_number == 0 ? "unknown error" : std::strerror(error_number);
}

void write_file(const std::string& path, std::string_view text) {
  const std::string temporary = fmt::format("{}.{}.tmp", path, getpid());
  errno = 0;
  if (!write_all(temporary, text) || std::rename(temporary.c_str(), path.c_str()) != 0) {
    const int error_number = errno;
    std::remove(temporary.c_str());
    fail("write", path, error_number);
  }
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
