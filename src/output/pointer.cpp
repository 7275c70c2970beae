#include <tautline/output/pointer.hpp>

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tautline::output {

namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> tokens_of(const std::string& path) {
  std::vector<std::string> tokens;
  std::istringstream stream(path);
  for (std::string token; std::getline(stream, token, '/');)
    if (!token.empty()) tokens.push_back(token);
  return tokens;
}

bool is_index(const std::string& token) {
  return token.find_first_not_of("0123456789") == std::string::npos;
}

/// The entry of a list that a token of a path means, or null.
const Json* entry(const Json& list, const std::string& token) {
  if (list.empty()) return nullptr;
  if (token == "first") return &list.front();
  if (token == "last") return &list.back();
  if (is_index(token)) return std::stoul(token) < list.size() ? &list[std::stoul(token)] : nullptr;
  const auto found = std::find_if(
      list.begin(), list.end(), [&](const Json& e) { return e.is_object() && e.value("name", "") == token; });
  return found == list.end() ? nullptr : &*found;
}

/// What could have stood in a path in place of what was not found.
std::string choices(const Json& value) {
  std::string text;
  const auto add = [&](const std::string& name) { text += (text.empty() ? "" : ", ") + name; };
  if (value.is_object())
    for (const auto& item : value.items()) add(item.key());
  if (value.is_array() && !value.empty() && value.front().is_object())
    for (const auto& e : value) add(e.value("name", ""));
  else if (value.is_array())
    add(fmt::format("a list of {}", value.size()));
  return text.empty() ? "nothing below it" : text;
}

void collect(const Json& value, std::vector<double>& numbers) {
  if (value.is_number())
    numbers.push_back(value.get<double>());
  else if (value.is_array())
    for (const auto& e : value) collect(e, numbers);
  else
    throw std::runtime_error(fmt::format("is no number; there is {}", choices(value)));
}

void walk(const Json& value, const std::vector<std::string>& tokens, std::size_t i,
          std::vector<double>& numbers) {
  if (i == tokens.size()) return collect(value, numbers);
  const std::string& token = tokens[i];
  if (value.is_array() && token == "*") {
    for (const auto& e : value) walk(e, tokens, i + 1, numbers);
    return;
  }
  const Json* next = nullptr;
  if (value.is_array())
    next = entry(value, token);
  else if (value.is_object() && value.contains(token))
    next = &value[token];
  if (next == nullptr)
    throw std::runtime_error(fmt::format("there is no \"{}\"; there is {}", token, choices(value)));
  walk(*next, tokens, i + 1, numbers);
}

}  // namespace

std::vector<double> numbers_at(const Json& results, const std::string& path) {
  std::vector<double> numbers;
  walk(results, tokens_of(path), 0, numbers);
  return numbers;
}

}  // namespace tautline::output
