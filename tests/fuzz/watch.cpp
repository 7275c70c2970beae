#include "watch.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iostream>
#include <new>

#include <fmt/format.h>

#include <tautline/la/session.hpp>

namespace tautline::fuzz {

namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// What child and parent both see.
struct Board {
  volatile std::uint64_t seed;
  volatile double began_at;  ///< processor time of the child when it began with the seed [s]
  volatile bool trying;
  volatile double slowest;
  volatile std::uint64_t slowest_seed;
};

Board* new_board() {
  void* memory = mmap(nullptr, sizeof(Board), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  return new (memory) Board{};
}

double seconds_of(const timespec& time) {
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Processor time of a process [s]; of this one for 0.
double processor_seconds(pid_t process) {
  clockid_t clock = CLOCK_PROCESS_CPUTIME_ID;
  timespec time{};
  if (process != 0 && clock_getcpuclockid(process, &clock) != 0) return 0;
  clock_gettime(clock, &time);
  return seconds_of(time);
}

void limit_memory(std::size_t megabytes) {
#ifndef __SANITIZE_ADDRESS__
  std::ifstream file("/proc/self/statm");
  std::size_t pages = 0;
  file >> pages;
  const rlim_t bytes = pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + megabytes * (1UL << 20U);
  const rlimit limit{bytes, bytes};
  setrlimit(RLIMIT_AS, &limit);
#else
  (void)megabytes;
#endif
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
}

/// A line for each answer, read by the parent when the child has ended.
class Letters {
 public:
  explicit Letters(int descriptor) : descriptor_(descriptor) {}
  void write(std::uint64_t seed, const Answer& answer) const {
    const auto one_line = [](std::string text) {
      std::replace(text.begin(), text.end(), '\n', '\v');
      std::replace(text.begin(), text.end(), '\t', ' ');
      return text.substr(0, 1500);
    };
    const std::string line =
        fmt::format("{}\t{}\t{}\t{}\n", seed, answer.end, one_line(answer.fault), one_line(answer.said));
    (void)!::write(descriptor_, line.data(), line.size());
  }

 private:
  int descriptor_;
};

/// The child: tries seed after seed, and ends without the destructors of the parent's objects.
[[noreturn]] void try_all(const Campaign& campaign, std::uint64_t first, int count, const Input* only,
                          Board& board, const Letters& letters, const Limits& limits) {
  const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int descriptor : {0, 1, 2}) ::dup2(nowhere, descriptor);
  {
    const la::Session session;
    limit_memory(limits.megabytes);
    for (std::uint64_t seed = first; seed < first + static_cast<std::uint64_t>(count); ++seed) {
      const Input input = only != nullptr ? *only : campaign.make(seed);
      board.seed = seed;
      board.began_at = processor_seconds(0);
      board.trying = true;
      const Answer answer = campaign.attempt(input);
      board.trying = false;
      const double used = processor_seconds(0) - board.began_at;
      if (used > board.slowest) {
        board.slowest = used;
        board.slowest_seed = seed;
      }
      letters.write(seed, answer);
    }
  }
  ::_exit(0);
}

struct Ended {
  bool hung = false;
  int status = 0;
};

/// Waits for the child; kills it if one input takes too long, by its processor time or by a clock on the
/// wall.
Ended wait_for(pid_t child, const Board& board, const Limits& limits) {
  std::uint64_t last = 0;
  auto since_last = Clock::now();
  while (true) {
    Ended ended;
    if (waitpid(child, &ended.status, WNOHANG) == child) return ended;
    if (board.seed != last || !board.trying) {
      last = board.seed;
      since_last = Clock::now();
    }
    const bool slow =
        processor_seconds(child) - board.began_at > limits.seconds || since(since_last) > 12 * limits.seconds;
    if (board.trying && slow) {
      kill(child, SIGKILL);
      waitpid(child, &ended.status, 0);
      ended.hung = true;
      return ended;
    }
    usleep(5000);
  }
}

struct Batch {
  std::vector<std::pair<std::uint64_t, Answer>> answers;
  std::optional<Finding> end;  ///< if the child did not come to its end
  double slowest = 0, most_memory = 0;
  std::uint64_t slowest_seed = 0;
};

std::vector<std::pair<std::uint64_t, Answer>> read_letters(std::FILE* file) {
  std::rewind(file);
  std::vector<std::pair<std::uint64_t, Answer>> result;
  std::string line;
  for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) {
    if (c != '\n') {
      line += static_cast<char>(c);
      continue;
    }
    std::vector<std::string> cells(1);
    for (const char letter : line) {
      if (letter == '\t')
        cells.emplace_back();
      else
        cells.back() += letter == '\v' ? '\n' : letter;
    }
    if (cells.size() == 4) result.push_back({std::stoull(cells[0]), {cells[1], cells[2], cells[3]}});
    line.clear();
  }
  return result;
}

Batch try_batch(const Campaign& campaign, std::uint64_t first, int count, const Input* only,
                const Limits& limits) {
  Board* board = new_board();
  std::FILE* file = std::tmpfile();
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) try_all(campaign, first, count, only, *board, Letters(::fileno(file)), limits);
  Batch batch;
  const Ended ended = wait_for(child, *board, limits);
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  batch.most_memory = static_cast<double>(usage.ru_maxrss) / 1024;
  batch.answers = read_letters(file);
  batch.slowest = board->slowest;
  batch.slowest_seed = board->slowest_seed;
  if (ended.hung)
    batch.end = Finding{board->seed, "hang", fmt::format("more than {} s", limits.seconds)};
  else if (WIFSIGNALED(ended.status))
    batch.end = Finding{board->seed, "crash", strsignal(WTERMSIG(ended.status))};
  else if (WEXITSTATUS(ended.status) != 0)
    batch.end =
        Finding{board->seed, "crash", fmt::format("the process ended with {}", WEXITSTATUS(ended.status))};
  std::fclose(file);
  munmap(board, sizeof(Board));
  return batch;
}

Finding finding_of(std::uint64_t seed, const Answer& answer) {
  const auto colon = answer.fault.find(": ");
  return {seed, answer.fault.substr(0, colon),
          colon == std::string::npos ? answer.said : answer.fault.substr(colon + 2)};
}

/// Pieces of a text: lines, or stretches of characters.
std::vector<std::string> pieces(const std::string& text, std::size_t size) {
  std::vector<std::string> result;
  std::string piece;
  for (const char c : text) {
    piece += c;
    if (size == 0 ? c == '\n' : piece.size() == size) {
      result.push_back(std::move(piece));
      piece.clear();
    }
  }
  if (!piece.empty()) result.push_back(std::move(piece));
  return result;
}

std::string joined(const std::vector<std::string>& list, std::size_t skip_from, std::size_t skip_count) {
  std::string text;
  for (std::size_t i = 0; i < list.size(); ++i)
    if (i < skip_from || i >= skip_from + skip_count) text += list[i];
  return text;
}

}  // namespace

std::string sort_of(const std::string& sentence) {
  std::string result;
  bool in_quotes = false;
  const auto error = sentence.find("error: ");  // what stands before is a place
  for (const char c : sentence.substr(error == std::string::npos ? 0 : error)) {
    if (c == '\n') break;
    if (c == '"') in_quotes = !in_quotes;
    const bool number = std::string("0123456789.").find(c) != std::string::npos;
    if (in_quotes && c != '"') continue;
    if (!number)
      result += c;
    else if (result.empty() || result.back() != '#')
      result += '#';
  }
  return result.substr(0, 160);
}

Tally watch(const Campaign& campaign, std::uint64_t first, int count, double seconds, const Limits& limits,
            const std::function<void(const Finding&)>& found) {
  const auto start = Clock::now();
  Tally tally;
  while (tally.tried < count && since(start) < seconds) {
    const int n = std::min(limits.batch, count - tally.tried);
    const Batch batch =
        try_batch(campaign, first + static_cast<std::uint64_t>(tally.tried), n, nullptr, limits);
    for (const auto& [seed, answer] : batch.answers) {
      ++tally.ends[answer.end];
      if (answer.end != "done") ++tally.sentences[answer.end + ": " + sort_of(answer.said)];
      if (!answer.fault.empty()) found(finding_of(seed, answer));
    }
    if (batch.end) found(*batch.end);
    tally.tried += static_cast<int>(batch.answers.size()) + (batch.end ? 1 : 0);
    if (batch.slowest > tally.slowest) {
      tally.slowest = batch.slowest;
      tally.slowest_seed = batch.slowest_seed;
    }
    tally.most_memory = std::max(tally.most_memory, batch.most_memory);
  }
  return tally;
}

std::optional<Finding> watch_one(const Campaign& campaign, const Input& input, const Limits& limits) {
  const Batch batch = try_batch(campaign, 0, 1, &input, limits);
  if (batch.end) return batch.end;
  if (batch.answers.empty() || batch.answers[0].second.fault.empty()) return {};
  return finding_of(0, batch.answers[0].second);
}

Input smallest(const Campaign& campaign, Input input, const Finding& finding, const Limits& limits,
               double seconds) {
  const auto start = Clock::now();
  const auto still = [&](const std::string& text) {
    Input smaller = input;
    smaller.text = text;
    const auto now = watch_one(campaign, smaller, limits);
    return now && now->kind == finding.kind && sort_of(now->said) == sort_of(finding.said);
  };
  for (const std::size_t size : {0UL, 64UL, 8UL, 1UL}) {
    auto list = pieces(input.text, size);
    for (std::size_t many = list.size() / 2; many > 0; many /= 2)
      for (std::size_t at = 0; at < list.size() && since(start) < seconds;) {
        if (still(joined(list, at, many))) {
          const auto begin = list.begin() + static_cast<std::ptrdiff_t>(at);
          list.erase(begin, begin + static_cast<std::ptrdiff_t>(std::min(many, list.size() - at)));
        } else {
          at += many;
        }
      }
    input.text = joined(list, 0, 0);
  }
  return input;
}

}  // namespace tautline::fuzz
