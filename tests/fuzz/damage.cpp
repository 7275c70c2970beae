#include "damage.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

namespace tautline::fuzz {

namespace {

const std::vector<std::string>& numbers() {
  static const std::vector<std::string> list{"0",
                                             "-0",
                                             "0.0",
                                             "-1",
                                             "1",
                                             "2",
                                             "3",
                                             "1e308",
                                             "-1e308",
                                             "1e309",
                                             "1e999",
                                             "-1e999",
                                             "5e-324",
                                             "1e-310",
                                             "1e-300",
                                             "1e-30",
                                             "1e-12",
                                             "1e12",
                                             "1e16",
                                             "1e30",
                                             "1e150",
                                             "1e200",
                                             "-1e30",
                                             "nan",
                                             ".nan",
                                             "-.inf",
                                             ".inf",
                                             "inf",
                                             "infinity",
                                             "NaN(7)",
                                             "0x10",
                                             "010",
                                             "1_000",
                                             "1e",
                                             "e5",
                                             "1e+",
                                             "--1",
                                             "+1",
                                             "+-1",
                                             "1.2.3",
                                             "1,5",
                                             "1.",
                                             ".5",
                                             ".",
                                             "-",
                                             "2147483647",
                                             "2147483648",
                                             "-2147483648",
                                             "4294967296",
                                             "9223372036854775807",
                                             "99999999999999999999999",
                                             "1000000",
                                             "100000",
                                             "10000",
                                             "1000",
                                             "0.1",
                                             "0.3333333",
                                             "1e-9",
                                             "12:30:00",
                                             "2026-12-01",
                                             "true",
                                             "~",
                                             "null",
                                             "1 m",
                                             "5 mm",
                                             "3 kN",
                                             "20 GPa",
                                             "1e9Pa",
                                             "1/0",
                                             "sqrt(-1)",
                                             "1+1",
                                             "pi",
                                             "π",
                                             "１",
                                             "∞",
                                             "1e5 ",
                                             "0.5%",
                                             "1e0000000000000000005",
                                             "0.00000000000000000001"};
  return list;
}

const std::vector<std::string>& words() {
  static const std::vector<std::string> list{"",
                                             " ",
                                             "a",
                                             "x",
                                             "all",
                                             "pinned",
                                             "symmetry",
                                             "none",
                                             "yes",
                                             "no",
                                             "on",
                                             "off",
                                             "null",
                                             "~",
                                             "true",
                                             "kind",
                                             "name",
                                             "../../../../tmp/escaped",
                                             "/etc/passwd",
                                             "/dev/zero",
                                             "/dev/stdin",
                                             ".",
                                             "..",
                                             "con",
                                             "a/b",
                                             "a\\b",
                                             "<script>alert(1)</script>",
                                             "</title>\"'&<img src=x onerror=alert(2)>",
                                             "=cmd|' /C calc'!A0",
                                             "+1+1",
                                             "-2",
                                             "@SUM(1)",
                                             "\t=1+1",
                                             "a,b",
                                             "a\"b",
                                             "a'b",
                                             "line\nbreak",
                                             "line\r\nbreak",
                                             "\x1b]0;title\x07",
                                             "\x1b[31mred",
                                             "\xc2\x9b"
                                             "31m",
                                             "nul\x01",
                                             "\x7f",
                                             "\xe2\x80\xaegnp.exe",
                                             "\xef\xbb\xbf",
                                             "\xe2\x80\xa8",
                                             "é",
                                             "e\xcc\x81",
                                             "日本語",
                                             "🙂",
                                             "\xed\xa0\x80",
                                             "\xff\xfe",
                                             "\xc3",
                                             "${",
                                             "${}",
                                             "${p}",
                                             "${${p}}",
                                             "*a",
                                             "&a",
                                             "!!binary x",
                                             "%TAG",
                                             "- - -",
                                             "? ",
                                             "| ",
                                             "#",
                                             "%s%n%s",
                                             "{0}",
                                             "{}",
                                             "$(id)",
                                             "`id`",
                                             "steps",
                                             "front_net",
                                             "strut_0",
                                             "strut_999999999999",
                                             "spoke_-1",
                                             "rod_0",
                                             "stage 1",
                                             "support 1"};
  return list;
}

const std::vector<std::string>& insertions() {
  static const std::vector<std::string> list{"[",
                                             "]",
                                             "{",
                                             "}",
                                             ":",
                                             ": ",
                                             "- ",
                                             "-",
                                             "\"",
                                             "'",
                                             "#",
                                             " #",
                                             "&a ",
                                             "*a",
                                             "*b ",
                                             "!",
                                             "!!str ",
                                             "|",
                                             ">",
                                             "%",
                                             "@",
                                             "`",
                                             ",",
                                             ", ",
                                             "\t",
                                             " ",
                                             "\n",
                                             "\r",
                                             "\r\n",
                                             "\n\n",
                                             "---\n",
                                             "...\n",
                                             "\n--- ",
                                             "? ",
                                             "<<: *a\n",
                                             std::string(1, '\0'),
                                             "\x01",
                                             "\x1b",
                                             "\x7f",
                                             "\xc3",
                                             "\xff",
                                             "\xc2\x85",
                                             "\xe2\x80\xa8",
                                             "\xef\xbb\xbf",
                                             "\\",
                                             "\\x",
                                             "\"\\u0000\"",
                                             "\"\\x1b\"",
                                             "${p}",
                                             "$",
                                             "é",
                                             "🙂"};
  return list;
}

std::string repeated(const std::string& part, std::size_t count) {
  std::string result;
  for (std::size_t i = 0; i < count; ++i) result += part;
  return result;
}

struct Span {
  std::size_t begin = 0, size = 0;
};

/// A stretch of a text, most of them short.
Span span_in(const std::string& text, Random& random) {
  const std::size_t begin = place_in(text, random);
  const auto most = static_cast<double>(text.size() - begin) + 1;
  return {begin, static_cast<std::size_t>(random.magnitude(1, most + 1)) % static_cast<std::size_t>(most)};
}

/// A line with its end.
Span line_in(const std::string& text, Random& random) {
  const std::size_t at = place_in(text, random);
  const auto before = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  const auto end = text.find('\n', at);
  return {begin, (end == std::string::npos ? text.size() : end + 1) - begin};
}

void change_line(std::string& text, Random& random) {
  const Span line = line_in(text, random);
  const std::string what = text.substr(line.begin, line.size);
  switch (random.whole(0, 4)) {
    case 0:
      text.erase(line.begin, line.size);
      break;
    case 1:
      text.insert(line.begin, what);
      break;
    case 2:
      text.erase(line.begin, line.size);
      text.insert(line_in(text, random).begin, what);
      break;
    case 3:
      text.insert(line.begin, static_cast<std::size_t>(random.whole(1, 4)), ' ');
      break;
    default:
      if (what.size() > 1 && what[0] == ' ') text.erase(line.begin, 1);
  }
}

void change_span(std::string& text, Random& random) {
  const Span span = span_in(text, random);
  const std::string what = text.substr(span.begin, span.size);
  switch (random.whole(0, 3)) {
    case 0:
      text.erase(span.begin, span.size);
      break;
    case 1:
      text.insert(span.begin, what);
      break;
    case 2:
      text.insert(place_in(text, random), what);
      break;
    default:
      text.resize(span.begin);
  }
}

}  // namespace

std::size_t place_in(const std::string& text, Random& random) {
  return static_cast<std::size_t>(random.between(0, static_cast<double>(text.size()) + 0.999));
}

std::string strange_number(Random& random) {
  if (random.chance(0.6)) return random.one_of(numbers());
  const double value = (random.chance(0.3) ? -1 : 1) * random.magnitude(1e-20, 1e20);
  if (random.chance(0.3)) return std::to_string(static_cast<long long>(std::clamp(value, -1e15, 1e15)));
  return fmt::format("{:.{}g}", value, random.whole(1, 17));
}

std::string strange_word(Random& random) {
  if (random.chance(0.03))
    return repeated(random.one_of(words()) + "x", static_cast<std::size_t>(random.magnitude(10, 20000)));
  if (random.chance(0.02)) return repeated("(", static_cast<std::size_t>(random.magnitude(10, 20000))) + "x";
  return random.one_of(words());
}

void damage_text(std::string& text, Random& random) {
  switch (random.whole(0, 5)) {
    case 0:
      change_line(text, random);
      break;
    case 1:
      change_span(text, random);
      break;
    case 2:
      if (random.chance(0.05))
        text.insert(place_in(text, random), repeated(random.one_of(insertions()),
                                                     static_cast<std::size_t>(random.magnitude(2, 5000))));
      else
        text.insert(place_in(text, random), random.one_of(insertions()));
      break;
    case 3:
      if (!text.empty()) text[place_in(text, random) % text.size()] = static_cast<char>(random.whole(1, 255));
      break;
    case 4:
      if (!text.empty()) text[place_in(text, random) % text.size()] = random.one_of(insertions())[0];
      break;
    default:
      if (!text.empty()) text.erase(place_in(text, random) % text.size(), 1);
  }
}

void damage_bytes(std::string& bytes, Random& random) {
  if (bytes.empty()) return;
  const std::size_t at = place_in(bytes, random) % bytes.size();
  switch (random.whole(0, 4)) {
    case 0:
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.whole(0, 7)));
      break;
    case 1:
      bytes[at] = static_cast<char>(random.whole(0, 255));
      break;
    case 2: {
      static const std::vector<std::uint64_t> counts{
          0, 1, 0x7fffffff, 0x80000000, 0xffffffff, 0x7fffffffffffffff, 1000000000};
      const std::uint64_t value = random.one_of(counts);
      std::memcpy(bytes.data() + at, &value,
                  std::min<std::size_t>(random.chance(0.5) ? 4 : 8, bytes.size() - at));
      break;
    }
    default:
      change_span(bytes, random);
  }
}

}  // namespace tautline::fuzz
