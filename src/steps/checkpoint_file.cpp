#include "steps/checkpoint_file.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include <tautline/core/sha256.hpp>

namespace tautline::steps {

namespace {

constexpr const char* format_name = "tautline-checkpoint";
constexpr int format_version = 4;
constexpr int deepest_text = 64;  // levels of JSON; results have about ten

std::string head() {
  return fmt::format("{} {}\n", format_name, format_version);
}

/// How many doubles an entry of a list has.
template <class Entry>
constexpr std::size_t width_of = static_cast<std::size_t>(Entry::SizeAtCompileTime);
template <>
constexpr std::size_t width_of<double> = 1;

template <class Entry>
auto* doubles_of(Entry& entry) {
  return entry.data();
}
double* doubles_of(double& number) {
  return &number;
}
const double* doubles_of(const double& number) {
  return &number;
}

class Writer {
 public:
  void number(std::uint64_t value) {
    char bytes[8];
    for (std::size_t i = 0; i < 8; ++i) bytes[i] = static_cast<char>(value >> 8 * i & 0xffU);
    bytes_.append(bytes, 8);
  }
  void text(std::string_view value) {
    number(value.size());
    bytes_ += value;
  }
  template <class Entry>
  void operator()(const std::vector<Entry>& list) {
    number(list.size() * width_of<Entry>);
    for (const auto& entry : list)
      for (std::size_t i = 0; i < width_of<Entry>; ++i)
        number(std::bit_cast<std::uint64_t>(doubles_of(entry)[i]));
  }
  void operator()(const assembly::Rest& rest) {
    each_list(rest, [this](const auto& list) { (*this)(list); });
    (*this)(std::vector<Vec3>{rest.acting.acceleration});
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

[[noreturn]] void foreign(const std::string& what) {
  throw BadCheckpoint(
      fmt::format("has the checksum of a checkpoint, but holds what no run writes ({})", what));
}

void demand_rotations(const model::State& state) {
  for (const auto& rotation : state.rotation)
    if (!rotation.isUnitary(1e-6) || rotation.determinant() < 0) foreign("a rotation that is none");
}

/// Takes a content apart; every size is compared with what is left before anything is made of it.
class Reader {
 public:
  explicit Reader(std::string_view content) : left_(content) {}

  std::uint64_t number() {
    std::uint64_t value = 0;
    const auto bytes = take(8);
    for (std::size_t i = 8; i-- > 0;) value = value << 8U | static_cast<unsigned char>(bytes[i]);
    return value;
  }
  std::string_view text() { return take(number()); }
  template <class Entry>
  void operator()(std::vector<Entry>& list) {
    const std::uint64_t count = number();
    if (count > left_.size() / 8) foreign("a list is longer than the file");
    if (count % width_of<Entry> != 0) foreign("a list of vectors or matrices ends within one");
    list.resize(count / width_of<Entry>);
    for (auto& entry : list)
      for (std::size_t i = 0; i < width_of<Entry>; ++i) {
        const double value = std::bit_cast<double>(number());
        if (!std::isfinite(value)) foreign("a number that is not finite");
        doubles_of(entry)[i] = value;
      }
  }
  void operator()(model::State& state) {
    each_list_of_state(state, [this](auto& list) { (*this)(list); });
    demand_rotations(state);
  }
  void operator()(assembly::Rest& rest) {
    each_list(rest, [this](auto& list) { (*this)(list); });
    demand_rotations(rest.state);
    std::vector<Vec3> acceleration;
    (*this)(acceleration);
    if (acceleration.size() != 1) foreign("not one acceleration");
    rest.acting.acceleration = acceleration.front();
  }
  void end() const {
    if (!left_.empty()) foreign("more than its lists");
  }

 private:
  std::string_view take(std::uint64_t count) {
    if (count > left_.size()) foreign("it ends within a list or text");
    const auto taken = left_.substr(0, count);
    left_.remove_prefix(count);
    return taken;
  }

  std::string_view left_;
};

const Json& member(const Json& object, const char* key) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  if (!object.is_object() || found == object.end()) foreign(fmt::format("no \"{}\"", key));
  return *found;
}

std::string string_at(const Json& object, const char* key) {
  const Json& value = member(object, key);
  if (!value.is_string()) foreign(fmt::format("\"{}\" is no text", key));
  return value.get<std::string>();
}

int integer(const Json& value, int least, int most) {
  if (!value.is_number_integer() || value < least || value > most)
    foreign(fmt::format("a whole number between {} and {} is something else", least, most));
  return value.get<int>();
}

double real(const Json& value) {
  if (!value.is_number() || !std::isfinite(value.get<double>())) foreign("a number is something else");
  return value.get<double>();
}

const Json& list_at(const Json& object, const char* key) {
  const Json& value = member(object, key);
  if (!value.is_array()) foreign(fmt::format("\"{}\" is no list", key));
  return value;
}

std::vector<std::string> strings_at(const Json& object, const char* key) {
  std::vector<std::string> strings;
  for (const auto& entry : list_at(object, key)) {
    if (!entry.is_string()) foreign(fmt::format("\"{}\" has an entry that is no text", key));
    strings.push_back(entry.get<std::string>());
  }
  return strings;
}

/// Every entry of a list has texts of these names.
void demand_texts(const Json& list, std::initializer_list<const char*> keys) {
  for (const auto& entry : list)
    for (const char* key : keys) string_at(entry, key);
}

constexpr int most = 1'000'000'000;

Json to_json(const std::optional<analysis::ArcPlace>& arc) {
  if (!arc) return nullptr;
  return {arc->length,    arc->first_length, arc->lambda_weight, arc->rotation_weight,
          arc->direction, arc->points,       arc->critical,      arc->bifurcations};
}

std::optional<analysis::ArcPlace> arc_of(const Json& json) {
  if (json.is_null()) return std::nullopt;
  if (!json.is_array() || json.size() != 8) foreign("no place on a path");
  analysis::ArcPlace arc{real(json[0]),
                         real(json[1]),
                         real(json[2]),
                         real(json[3]),
                         integer(json[4], -1, 1),
                         integer(json[5], 0, most),
                         integer(json[6], 0, most),
                         integer(json[7], 0, most)};
  if (arc.direction == 0) foreign("no direction of a path");
  return arc;
}

Json to_json(const StagePoint& point) {
  return {{"stage", point.stage},      {"lambda", point.place.lambda}, {"driven_to", point.place.driven_to},
          {"arc", to_json(point.arc)}, {"entry", point.entry},         {"way", point.way},
          {"critical", point.critical}};
}

StagePoint point_of(const Json& json) {
  StagePoint point;
  point.entry = list_at(json, "entry");
  point.way = list_at(json, "way");
  point.critical = list_at(json, "critical");
  const int stages = static_cast<int>(point.entry.size());
  point.stage = integer(member(json, "stage"), stages, stages);
  point.place.lambda = real(member(json, "lambda"));
  point.place.driven_to = real(member(json, "driven_to"));
  point.arc = arc_of(member(json, "arc"));
  return point;
}

Json text_of(const CheckpointFile& file) {
  const auto& checkpoint = file.checkpoint;
  return {{"structure", file.structure},
          {"steps", file.steps},
          {"steps_done", checkpoint.steps_done},
          {"results", checkpoint.results},
          {"acting_loads", checkpoint.acting_loads},
          {"rest", checkpoint.rest.has_value()},
          {"point", checkpoint.point ? to_json(*checkpoint.point) : Json(nullptr)}};
}

Json parse(std::string_view text) {
  const auto shallow = [](int depth, Json::parse_event_t, const Json&) {
    if (depth > deepest_text) foreign("lists in lists without end");
    return true;
  };
  try {
    return Json::parse(text, shallow);
  } catch (const Json::parse_error&) {
    foreign("no JSON");
  }
}

/// The results so far: an entry for each step done.
Json results_of(const Json& text, int steps_done) {
  const Json& results = member(text, "results");
  demand_texts(list_at(results, "steps"), {"name", "kind", "status"});
  demand_texts(list_at(results, "warnings"), {"code", "message", "where"});
  if (list_at(results, "steps").size() != static_cast<std::size_t>(steps_done))
    foreign("not one result for each step done");
  return {{"steps", results.at("steps")}, {"warnings", results.at("warnings")}};
}

/// All but the lists of numbers.
CheckpointFile file_of(const Json& text) {
  CheckpointFile file{string_at(text, "structure"), strings_at(text, "steps"), {}};
  auto& checkpoint = file.checkpoint;
  checkpoint.steps_done = integer(member(text, "steps_done"), 0, most);
  checkpoint.results = results_of(text, checkpoint.steps_done);
  checkpoint.acting_loads = strings_at(text, "acting_loads");
  const Json& rest = member(text, "rest");
  if (!rest.is_boolean()) foreign("\"rest\" is neither true nor false");
  if (rest.get<bool>()) checkpoint.rest.emplace();
  const Json& point = member(text, "point");
  if (!point.is_null()) checkpoint.point = point_of(point);
  if (file.steps.size() != static_cast<std::size_t>(checkpoint.steps_done) + (checkpoint.point ? 1 : 0))
    foreign("not one fingerprint for each step");
  return file;
}

std::string_view unsealed(std::string_view bytes) {
  constexpr std::size_t digest = 64;
  if (!bytes.starts_with(format_name)) throw BadCheckpoint("is damaged, or none");
  if (!bytes.starts_with(head())) throw BadCheckpoint("is damaged, or of another version of the program");
  const auto content = bytes.substr(std::min(bytes.size(), head().size() + digest + 1));
  if (bytes.substr(head().size(), bytes.size() - head().size() - content.size()) != sha256(content) + "\n")
    throw BadCheckpoint("is damaged: its checksum does not fit its content");
  return content;
}

}  // namespace

std::string sealed(std::string_view content) {
  std::string bytes = head() + sha256(content) + "\n";
  return bytes.append(content);
}

std::string encode(const CheckpointFile& file) {
  Writer writer;
  writer.text(text_of(file).dump(-1, ' ', false, Json::error_handler_t::replace));
  if (file.checkpoint.rest) writer(*file.checkpoint.rest);
  if (const auto& point = file.checkpoint.point) {
    writer(point->start);
    each_list_of_state(point->place.state, [&](const auto& list) { writer(list); });
  }
  return sealed(writer.bytes());
}

CheckpointFile decode(std::string_view bytes) {
  Reader reader(unsealed(bytes));
  auto file = file_of(parse(reader.text()));
  if (file.checkpoint.rest) reader(*file.checkpoint.rest);
  if (auto& point = file.checkpoint.point) {
    reader(point->start);
    reader(point->place.state);
  }
  reader.end();
  return file;
}

}  // namespace tautline::steps
