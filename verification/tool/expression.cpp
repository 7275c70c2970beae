#include "expression.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

namespace verify {

namespace {

using Binary = double (*)(double, double);
using Elementwise = double (*)(double);
using Reduction = double (*)(const Values&);

double mean(const Values& v) {
  return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
}

const std::map<std::string, Elementwise> elementwise{
    {"abs", std::fabs},  {"sqrt", std::sqrt}, {"sin", std::sin},     {"cos", std::cos}, {"tan", std::tan},
    {"sinh", std::sinh}, {"cosh", std::cosh}, {"asinh", std::asinh}, {"log", std::log}};

const std::map<std::string, Reduction> reductions{
    {"min", [](const Values& v) { return *std::min_element(v.begin(), v.end()); }},
    {"max", [](const Values& v) { return *std::max_element(v.begin(), v.end()); }},
    {"sum", [](const Values& v) { return std::accumulate(v.begin(), v.end(), 0.0); }},
    {"mean", mean},
    {"rms",
     [](const Values& v) {
       return std::sqrt(std::inner_product(v.begin(), v.end(), v.begin(), 0.0) /
                        static_cast<double>(v.size()));
     }},
    {"size", [](const Values& v) { return static_cast<double>(v.size()); }},
    {"first", [](const Values& v) { return v.front(); }},
    {"last", [](const Values& v) { return v.back(); }}};

/// Recursive descent; one function for each level of precedence.
class Parser {
 public:
  Parser(const std::string& text, const Lookup& lookup) : text_(text), lookup_(lookup) {}

  Values parse() {
    Values value = sum();
    if (peek() != '\0') fail("does not belong here");
    return value;
  }

 private:
  Values sum() {
    Values value = product();
    while (true) {
      if (take('+'))
        value = combine(value, product(), [](double a, double b) { return a + b; });
      else if (take('-'))
        value = combine(value, product(), [](double a, double b) { return a - b; });
      else
        return value;
    }
  }

  Values product() {
    Values value = power();
    while (true) {
      if (take('*'))
        value = combine(value, power(), [](double a, double b) { return a * b; });
      else if (take('/'))
        value = combine(value, power(), [](double a, double b) { return a / b; });
      else
        return value;
    }
  }

  Values power() {
    if (take('-')) return combine({0.0}, power(), [](double a, double b) { return a - b; });
    Values value = primary();
    if (take('^')) value = combine(value, power(), [](double a, double b) { return std::pow(a, b); });
    return value;
  }

  Values primary() {
    const char next = peek();
    if (take('(')) {
      Values value = sum();
      demand(')');
      return value;
    }
    if (next == '{') return lookup_(between_braces());
    if (std::isdigit(static_cast<unsigned char>(next)) || next == '.') return {number()};
    const std::string name = word();
    if (name == "pi") return {std::numbers::pi};
    return call(name);
  }

  Values call(const std::string& name) {
    demand('(');
    std::vector<Values> arguments{sum()};
    while (take(',')) arguments.push_back(sum());
    demand(')');
    if (const auto found = elementwise.find(name); found != elementwise.end() && arguments.size() == 1) {
      std::transform(arguments[0].begin(), arguments[0].end(), arguments[0].begin(), found->second);
      return arguments[0];
    }
    if (name == "at" && arguments.size() == 2)
      return {arguments[0].at(static_cast<std::size_t>(arguments[1].at(0)))};
    if (name == "above" && arguments.size() == 2)
      return {static_cast<double>(std::count_if(arguments[0].begin(), arguments[0].end(),
                                                [&](double v) { return v > arguments[1].at(0); }))};
    const auto found = reductions.find(name);
    if (found == reductions.end())
      fail(fmt::format("unknown function \"{}\" of {} arguments", name, arguments.size()));
    Values all;
    for (const auto& argument : arguments) all.insert(all.end(), argument.begin(), argument.end());
    if (all.empty() && name != "size") fail(name + " of an empty list");
    return {found->second(all)};
  }

  Values combine(const Values& a, const Values& b, Binary operation) const {
    if (a.empty() || b.empty()) fail("nothing fits the reference: an empty list");
    if (a.size() != b.size() && a.size() != 1 && b.size() != 1)
      fail(fmt::format("lists of {} and {} entries", a.size(), b.size()));
    Values result(std::max(a.size(), b.size()));
    for (std::size_t i = 0; i < result.size(); ++i)
      result[i] = operation(a[a.size() == 1 ? 0 : i], b[b.size() == 1 ? 0 : i]);
    return result;
  }

  std::string between_braces() {
    const auto end = text_.find('}', at_);
    if (end == std::string::npos) fail("\"{\" without \"}\"");
    const std::string reference = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    return reference;
  }

  double number() {
    char* end = nullptr;
    const double value = std::strtod(text_.c_str() + at_, &end);
    at_ = static_cast<std::size_t>(end - text_.c_str());
    return value;
  }

  std::string word() {
    const std::size_t start = at_;
    while (at_ < text_.size() && std::isalpha(static_cast<unsigned char>(text_[at_]))) ++at_;
    if (at_ == start) fail("a number, a reference in braces or a function is expected");
    return text_.substr(start, at_ - start);
  }

  char peek() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }

  bool take(char c) {
    if (peek() != c) return false;
    ++at_;
    return true;
  }

  void demand(char c) {
    if (!take(c)) fail(fmt::format("\"{}\" is expected", c));
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(fmt::format("expression {}\n  at \"{}\": {}", text_,
                                         text_.substr(std::min(at_, text_.size())), what));
  }

  const std::string& text_;
  const Lookup& lookup_;
  std::size_t at_ = 0;
};

}  // namespace

Values evaluate(const std::string& text, const Lookup& lookup) {
  return Parser(text, lookup).parse();
}

double evaluate_number(const std::string& text, const Lookup& lookup) {
  const Values values = evaluate(text, lookup);
  if (values.size() != 1)
    throw std::runtime_error(fmt::format("expression {} has {} values, one is wanted", text, values.size()));
  return values[0];
}

}  // namespace verify
