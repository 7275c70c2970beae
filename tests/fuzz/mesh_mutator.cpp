#include "mesh_mutator.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tautline::fuzz {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// The word about a place: begin and size.
std::pair<std::size_t, std::size_t> word_at(const std::string& text, std::size_t at) {
  const std::string space = " \n\r\t";
  std::size_t begin = std::min(at, text.size()), end = begin;
  while (begin > 0 && space.find(text[begin - 1]) == std::string::npos) --begin;
  while (end < text.size() && space.find(text[end]) == std::string::npos) ++end;
  return {begin, end - begin};
}

/// Another number in the place of one: a count, a tag, a coordinate.
void change_word(std::string& text, Random& random) {
  const auto [begin, size] = word_at(text, place_in(text, random));
  if (size == 0 || size > 40) return;
  const std::string word = text.substr(begin, size);
  char* end = nullptr;
  const long value = std::strtol(word.c_str(), &end, 10);
  std::string other = strange_number(random);
  if (*end == '\0' && random.chance(0.6)) other = std::to_string(value + random.whole(-3, 3));
  if (random.chance(0.2)) {
    const auto [from, length] = word_at(text, place_in(text, random));
    other = text.substr(from, std::min<std::size_t>(length, 40));
  }
  text.replace(begin, size, other);
}

/// A section ($Name ... $EndName) left out, doubled or moved to the end.
void change_section(std::string& text, Random& random) {
  std::vector<std::size_t> begins;
  for (auto at = text.find("\n$"); at != std::string::npos; at = text.find("\n$", at + 1))
    begins.push_back(at + 1);
  if (begins.size() < 2) return;
  const auto i = static_cast<std::size_t>(random.whole(0, static_cast<int>(begins.size()) - 2));
  const std::string section = text.substr(begins[i], begins[i + 1] - begins[i]);
  if (random.chance(0.6)) text.erase(begins[i], section.size());
  if (random.chance(0.5)) text += section;
}

void collect(Json& value, std::vector<Json*>& list) {
  list.push_back(&value);
  for (auto& below : value)
    if (&below != &value) collect(below, list);
}

Json strange_value(Random& random) {
  static const std::vector<Json> list{nullptr,
                                      true,
                                      false,
                                      0,
                                      -1,
                                      1e308,
                                      1e-308,
                                      18446744073709551615ULL,
                                      "",
                                      "text",
                                      Json::array(),
                                      Json::object(),
                                      Json::array({1, "a", nullptr}),
                                      Json::object({{"rms", "x"}}),
                                      Json::array({Json::array()})};
  if (random.chance(0.3)) return "<script>" + std::string(static_cast<std::size_t>(random.whole(0, 50)), 'x');
  return random.one_of(list);
}

void change(Json& root, Random& random) {
  std::vector<Json*> all;
  collect(root, all);
  Json& value = *random.one_of(all);
  switch (random.whole(0, 4)) {
    case 0:
      if (value.is_object() && !value.empty()) {
        auto entry = value.begin();
        std::advance(entry, random.whole(0, static_cast<int>(value.size()) - 1));
        value.erase(entry);
        return;
      }
      break;
    case 1:
      if (value.is_array() && !value.empty()) {
        value.erase(static_cast<std::size_t>(random.whole(0, static_cast<int>(value.size()) - 1)));
        return;
      }
      break;
    case 2: {
      const Json other = *random.one_of(all);
      value = other;
      return;
    }
    default:
      break;
  }
  value = strange_value(random);
}

void collect(const deck::Node& node, const std::string& path, std::vector<std::string>& list) {
  const std::string before = path.empty() ? "" : path + ".";
  list.push_back(path);
  for (std::size_t i = 0; i < std::min<std::size_t>(node.items.size(), 5); ++i) {
    collect(node.items[i], before + std::to_string(i), list);
    if (const auto* name = node.items[i].find("name")) list.push_back(before + name->text);
  }
  for (const auto& entry : node.entries) collect(entry.value, before + entry.key, list);
}

}  // namespace

MeshMutator::MeshMutator(const std::string& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".msh") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const auto& file : files) {
    const std::string name = file.filename().string();
    seeds_.push_back({read(file), folder + "/" + name.substr(0, name.find('.')) + ".yaml"});
  }
}

Input MeshMutator::make(Random& random) const {
  const Seed& seed = random.one_of(seeds_);
  std::string bytes = seed.bytes;
  const int changes = static_cast<int>(random.magnitude(1, 6));
  for (int i = 0; i < changes; ++i) {
    const double which = random.between(0, 1);
    if (which < 0.5)
      change_word(bytes, random);
    else if (which < 0.6)
      change_section(bytes, random);
    else if (which < 0.85)
      damage_bytes(bytes, random);
    else
      damage_text(bytes, random);
  }
  return {std::move(bytes), seed.deck};
}

std::string some_overrides(const deck::Node& deck, Random& random) {
  std::vector<std::string> paths;
  collect(deck, "", paths);
  std::string text;
  for (int i = random.whole(1, 3); i > 0; --i) {
    std::string path = random.one_of(paths);
    if (random.chance(0.2)) damage_text(path, random);
    if (random.chance(0.1)) path += "." + strange_word(random);
    std::string value = random.chance(0.6) ? strange_number(random) : strange_word(random);
    if (random.chance(0.2))
      value = fmt::format("[{}, {}, {}]", value, strange_number(random), strange_number(random));
    std::string line = path + (random.chance(0.97) ? "=" : "") + value;
    std::replace(line.begin(), line.end(), '\n', ' ');
    std::replace(line.begin(), line.end(), '\0', ' ');
    text += (text.empty() ? "" : "\n") + line;
  }
  return text;
}

std::string damaged_results(const std::string& json, Random& random) {
  Json root = Json::parse(json);
  const int changes = static_cast<int>(random.magnitude(1, 6));
  for (int i = 0; i < changes; ++i) change(root, random);
  std::string text = root.dump(random.whole(0, 1));
  for (int i = random.chance(0.1) ? random.whole(1, 3) : 0; i > 0; --i) damage_text(text, random);
  return text;
}

}  // namespace tautline::fuzz
