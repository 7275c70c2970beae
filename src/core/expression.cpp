#include <tautline/core/expression.hpp>

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace tautline {

namespace {

/// A part of a formula, evaluated at the values of its variables.
using Node = std::function<Jet2(const Jet2*)>;

Jet2 operator+(const Jet2& a, const Jet2& b) {
  return {a.value + b.value, a.first + b.first, a.second + b.second};
}
Jet2 operator-(const Jet2& a) {
  return {-a.value, -a.first, -a.second};
}
Jet2 operator*(const Jet2& a, const Jet2& b) {
  return {a.value * b.value, a.first * b.value + a.value * b.first,
          a.second * b.value + 2 * a.first * b.first + a.value * b.second};
}

/// g(u) from g and its derivatives at u.
Jet2 chain(const Jet2& u, double g, double dg, double ddg) {
  return {g, dg * u.first, ddg * u.first * u.first + dg * u.second};
}

Jet2 exponential(const Jet2& u) {
  const double e = std::exp(u.value);
  return chain(u, e, e, e);
}

Jet2 logarithm(const Jet2& u) {
  return chain(u, std::log(u.value), 1 / u.value, -1 / (u.value * u.value));
}

Jet2 power(const Jet2& base, const Jet2& exponent) {
  if (exponent.first != 0 || exponent.second != 0) return exponential(exponent * logarithm(base));
  const double n = exponent.value, u = base.value;
  return chain(base, std::pow(u, n), n == 0 ? 0 : n * std::pow(u, n - 1),
               n == 0 || n == 1 ? 0 : n * (n - 1) * std::pow(u, n - 2));
}

using Function = Jet2 (*)(const Jet2&);

const std::map<std::string, Function>& functions() {
  static const std::map<std::string, Function> table{
      {"sqrt",
       [](const Jet2& u) {
         return power(u, {0.5, 0, 0});
       }},
      {"exp", exponential},
      {"log", logarithm},
      {"sin",
       [](const Jet2& u) { return chain(u, std::sin(u.value), std::cos(u.value), -std::sin(u.value)); }},
      {"cos",
       [](const Jet2& u) { return chain(u, std::cos(u.value), -std::sin(u.value), -std::cos(u.value)); }},
      {"tan",
       [](const Jet2& u) {
         const double t = std::tan(u.value);
         return chain(u, t, 1 + t * t, 2 * t * (1 + t * t));
       }},
      {"asin",
       [](const Jet2& u) {
         const double c = std::sqrt(1 - u.value * u.value);
         return chain(u, std::asin(u.value), 1 / c, u.value / (c * c * c));
       }},
      {"acos",
       [](const Jet2& u) {
         const double c = std::sqrt(1 - u.value * u.value);
         return chain(u, std::acos(u.value), -1 / c, -u.value / (c * c * c));
       }},
      {"atan",
       [](const Jet2& u) {
         const double d = 1 + u.value * u.value;
         return chain(u, std::atan(u.value), 1 / d, -2 * u.value / (d * d));
       }},
      {"sinh",
       [](const Jet2& u) { return chain(u, std::sinh(u.value), std::cosh(u.value), std::sinh(u.value)); }},
      {"cosh",
       [](const Jet2& u) { return chain(u, std::cosh(u.value), std::sinh(u.value), std::cosh(u.value)); }},
      {"tanh",
       [](const Jet2& u) {
         const double t = std::tanh(u.value);
         return chain(u, t, 1 - t * t, -2 * t * (1 - t * t));
       }},
      {"abs", [](const Jet2& u) { return u.value < 0 ? -u : u; }}};
  return table;
}

/// Names of variables and their places; `list` is how messages call them.
struct Variables {
  std::map<std::string, int> place;
  std::string list;
};

/// Recursive descent: sum, product, sign, power, operand.
class Parser {
 public:
  Parser(const std::string& text, const Variables& variables) : text_(text), variables_(variables) {}

  Node parse() {
    if (text_.size() > longest)
      throw std::invalid_argument(
          fmt::format("a formula of {} characters; at most {} are read", text_.size(), longest));
    Node node = sum();
    if (peek() != '\0') fail(fmt::format("\"{}\" does not fit here", text_[at_]));
    return node;
  }

 private:
  char peek() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool take(char wanted) {
    if (peek() != wanted) return false;
    ++at_;
    return true;
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw std::invalid_argument(fmt::format("{} (character {})", what, at_ + 1));
  }

  Node sum() {
    Node left = product();
    while (true) {
      const bool minus = peek() == '-';
      if (!minus && peek() != '+') return left;
      ++at_;
      Node right = product();
      left = [left = std::move(left), right = std::move(right), minus](const Jet2* x) {
        return left(x) + (minus ? -right(x) : right(x));
      };
    }
  }

  Node product() {
    Node left = signed_power();
    while (true) {
      const bool over = peek() == '/';
      if (!over && peek() != '*') return left;
      ++at_;
      Node right = signed_power();
      left = [left = std::move(left), right = std::move(right), over](const Jet2* x) {
        return left(x) * (over ? power(right(x), {-1, 0, 0}) : right(x));
      };
    }
  }

  /// All nesting comes through here.
  Node signed_power() {
    if (++depth_ > deepest)
      fail(fmt::format("more than {} parentheses, signs or powers in each other", deepest));
    Node node;
    if (take('+')) {
      node = signed_power();
    } else if (take('-')) {
      node = [inner = signed_power()](const Jet2* x) { return -inner(x); };
    } else {
      node = raised();
    }
    --depth_;
    return node;
  }

  Node raised() {
    Node base = operand();
    if (!take('^')) return base;
    Node exponent = signed_power();
    return [base, exponent](const Jet2* x) { return power(base(x), exponent(x)); };
  }

  Node operand() {
    const char next = peek();
    if (take('(')) {
      Node inner = sum();
      if (!take(')')) fail("a closing parenthesis is missing");
      return inner;
    }
    if (std::isdigit(static_cast<unsigned char>(next)) || next == '.') return number();
    if (std::isalpha(static_cast<unsigned char>(next))) return word();
    fail(next == '\0' ? fmt::format("a number, {} or a function is missing", variables_.list)
                      : fmt::format("\"{}\" does not fit here", next));
  }

  Node number() {
    double value = 0;
    const char* const end = text_.data() + text_.size();
    const auto [rest, error] = std::from_chars(text_.data() + at_, end, value);
    if (error == std::errc::result_out_of_range) fail("a number too large or too small for a computer");
    if (error != std::errc()) fail("\".\" does not fit here");
    at_ = static_cast<std::size_t>(rest - text_.data());
    return [value](const Jet2*) { return Jet2{value, 0, 0}; };
  }

  Node word() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && std::isalnum(static_cast<unsigned char>(text_[at_]))) ++at_;
    const std::string name = text_.substr(begin, at_ - begin);
    if (const auto variable = variables_.place.find(name); variable != variables_.place.end())
      return [place = variable->second](const Jet2* x) { return x[place]; };
    if (name == "pi") return [](const Jet2*) { return Jet2{std::numbers::pi, 0, 0}; };
    const auto known = functions().find(name);
    if (known == functions().end()) {
      at_ = begin;
      fail(fmt::format("\"{}\" is neither {}, pi nor a function", name, variables_.list));
    }
    if (!take('(')) fail(fmt::format("{} needs its argument in parentheses", name));
    Node inner = sum();
    if (!take(')')) fail("a closing parenthesis is missing");
    return [inner, function = known->second](const Jet2* x) { return function(inner(x)); };
  }

  static constexpr std::size_t longest = 10'000;  // characters
  static constexpr int deepest = 100;

  const std::string& text_;
  const Variables& variables_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

Expression::Expression(const std::string& text)
    : evaluate_(Parser(text, {{{"X", 0}, {"x", 0}}, "X"}).parse()) {}

SpaceFormula::SpaceFormula(const std::string& text)
    : evaluate_(Parser(text, {{{"x", 0}, {"y", 1}, {"z", 2}}, "x, y, z"}).parse()) {}

double SpaceFormula::operator()(const Vec3& x) const {
  const std::array<Jet2, 3> at{Jet2{x[0], 0, 0}, Jet2{x[1], 0, 0}, Jet2{x[2], 0, 0}};
  return evaluate_(at.data()).value;
}

Vec3 SpaceFormula::gradient(const Vec3& x) const {
  Vec3 result;
  for (int k = 0; k < 3; ++k) {
    std::array<Jet2, 3> at{Jet2{x[0], 0, 0}, Jet2{x[1], 0, 0}, Jet2{x[2], 0, 0}};
    at[static_cast<std::size_t>(k)].first = 1;
    result[k] = evaluate_(at.data()).first;
  }
  return result;
}

}  // namespace tautline
