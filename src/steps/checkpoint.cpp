#include "steps/checkpoint.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/core/sha256.hpp>
#include <tautline/la/session.hpp>

namespace tautline::steps {

namespace {

namespace fs = std::filesystem;

constexpr const char* format_name = "tautline-checkpoint";
constexpr int format_version = 3;
constexpr const char* point_file = "point.bin";

double now_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Matrices of a fixed size one after the other, as a list of numbers.
template <class Matrix>
Json flat(const std::vector<Matrix>& list) {
  std::vector<double> values;
  for (const auto& m : list) values.insert(values.end(), m.data(), m.data() + m.size());
  return values;
}

template <class Matrix>
std::vector<Matrix> unflat(const Json& values) {
  const auto numbers = values.get<std::vector<double>>();
  std::vector<Matrix> list(numbers.size() / static_cast<std::size_t>(Matrix::SizeAtCompileTime));
  for (std::size_t i = 0; i < list.size(); ++i)
    std::copy_n(numbers.data() + i * Matrix::SizeAtCompileTime, Matrix::SizeAtCompileTime, list[i].data());
  return list;
}

Json to_json(const model::State& state) {
  return {{"displacement", flat(state.displacement)},
          {"rotation", flat(state.rotation)},
          {"hinge_angle", flat(state.hinge_angle)},
          {"turn", flat(state.turn)}};
}

model::State state_of(const Json& json) {
  return {unflat<Vec3>(json["displacement"]), unflat<Mat3>(json["rotation"]),
          unflat<Vec3>(json["hinge_angle"]), unflat<Vec3>(json["turn"])};
}

Json to_json(const assembly::Rest& rest) {
  const auto& a = rest.acting;
  return {{"state", to_json(rest.state)},
          {"force", flat(a.force)},
          {"moment", flat(a.moment)},
          {"line", flat(a.line)},
          {"pressure", a.pressure},
          {"element_temperature", a.temperature},
          {"temperature_gradient", flat(a.temperature_gradient)},
          {"strain", a.strain},
          {"acceleration", flat(std::vector<Vec3>{a.acceleration})},
          {"stiffness_factor", rest.stiffness_factor}};
}

assembly::Rest rest_of(const Json& json) {
  assembly::Acting acting{unflat<Vec3>(json["force"]),
                          unflat<Vec3>(json["moment"]),
                          unflat<Vec3>(json["line"]),
                          json["pressure"].get<std::vector<double>>(),
                          json["element_temperature"].get<std::vector<double>>(),
                          unflat<Vec3>(json["temperature_gradient"]),
                          json["strain"].get<std::vector<double>>(),
                          unflat<Vec3>(json["acceleration"]).front()};
  return {state_of(json["state"]), std::move(acting), json["stiffness_factor"].get<std::vector<double>>()};
}

Json to_json(const std::optional<analysis::ArcPlace>& arc) {
  if (!arc) return nullptr;
  return {arc->length,    arc->first_length, arc->lambda_weight, arc->rotation_weight,
          arc->direction, arc->points,       arc->critical,      arc->bifurcations};
}

std::optional<analysis::ArcPlace> arc_of(const Json& json) {
  if (json.is_null()) return std::nullopt;
  return analysis::ArcPlace{json[0], json[1], json[2], json[3], json[4], json[5], json[6], json[7]};
}

Json to_json(const StagePoint& point) {
  return {{"stage", point.stage},
          {"start", to_json(point.start)},
          {"state", to_json(point.place.state)},
          {"lambda", point.place.lambda},
          {"driven_to", point.place.driven_to},
          {"arc", to_json(point.arc)},
          {"entry", point.entry},
          {"way", point.way},
          {"critical", point.critical}};
}

StagePoint point_of(const Json& json) {
  StagePoint point;
  point.stage = json["stage"];
  point.start = rest_of(json["start"]);
  point.place.state = state_of(json["state"]);
  point.place.lambda = json["lambda"];
  point.place.driven_to = json["driven_to"];
  point.arc = arc_of(json["arc"]);
  point.entry = json["entry"];
  point.way = json["way"];
  point.critical = json["critical"];
  return point;
}

Json to_json(const Checkpoint& checkpoint, const deck::Deck& deck) {
  const std::size_t fixed = static_cast<std::size_t>(checkpoint.steps_done) + (checkpoint.point ? 1 : 0);
  Json json{{"structure", deck.fingerprint},
            {"steps", std::vector<std::string>(deck.step_fingerprints.begin(),
                                               deck.step_fingerprints.begin() + static_cast<long>(fixed))},
            {"steps_done", checkpoint.steps_done},
            {"results", checkpoint.results},
            {"acting_loads", checkpoint.acting_loads}};
  if (checkpoint.rest) json["rest"] = to_json(*checkpoint.rest);
  if (checkpoint.point) json["point"] = to_json(*checkpoint.point);
  return json;
}

Checkpoint checkpoint_of(const Json& json) {
  Checkpoint checkpoint{
      json["steps_done"], json["results"], json["acting_loads"].get<std::vector<std::string>>(), {}, {}};
  if (json.contains("rest")) checkpoint.rest = rest_of(json["rest"]);
  if (json.contains("point")) checkpoint.point = point_of(json["point"]);
  return checkpoint;
}

/// Nothing of a file that is not what a run wrote is used.
[[noreturn]] void refuse(const fs::path& path, const std::string& why) {
  throw LibraryError(fmt::format(
      "the checkpoint {} {}: run without --from, or take that file away to go on from the others beside it",
      path.string(), why));
}

/// Head, then the checksum of the rest, then the rest.
std::string sealed(const std::string& content) {
  return fmt::format("{} {}\n{}\n{}", format_name, format_version, sha256(content), content);
}

std::string unsealed(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const std::string head = fmt::format("{} {}\n", format_name, format_version);
  constexpr std::size_t digest = 64;
  if (!bytes.starts_with(format_name)) refuse(path, "is damaged, or none");
  if (!bytes.starts_with(head)) refuse(path, "is damaged, or of another version of the program");
  const std::string content = bytes.substr(std::min(bytes.size(), head.size() + digest + 1));
  if (bytes != sealed(content)) refuse(path, "is damaged: its checksum does not fit its content");
  return content;
}

Json read(const fs::path& path) {
  Json json = Json::from_cbor(unsealed(path), true, false);
  if (json.is_discarded()) refuse(path, "cannot be read");
  return json;
}

std::vector<std::size_t> sizes_of(const model::State& state) {
  return {state.displacement.size(), state.rotation.size(), state.hinge_angle.size(), state.turn.size()};
}

/// Of every list.
std::vector<std::size_t> sizes_of(const assembly::Rest& rest) {
  const auto& a = rest.acting;
  auto sizes = sizes_of(rest.state);
  sizes.insert(sizes.end(),
               {a.force.size(), a.moment.size(), a.line.size(), a.pressure.size(), a.temperature.size(),
                a.temperature_gradient.size(), a.strain.size(), rest.stiffness_factor.size()});
  return sizes;
}

/// Whether the first steps of the deck are those of the checkpoint.
bool fits(const Json& json, const deck::Deck& deck) {
  const auto steps = json["steps"].get<std::vector<std::string>>();
  return steps.size() <= deck.step_fingerprints.size() &&
         std::equal(steps.begin(), steps.end(), deck.step_fingerprints.begin());
}

std::string step_file(int steps_done) {
  return fmt::format("step_{}.bin", steps_done);
}

}  // namespace

Checkpoints::Checkpoints(const deck::Deck& deck, std::string directory)
    : deck_(deck), directory_(std::move(directory)) {}

void Checkpoints::write(const Checkpoint& checkpoint, const std::string& name) {
  la::on_root([&] {
    fs::create_directories(directory_);
    const fs::path path = fs::path(directory_) / name, fresh = path.string() + ".tmp";
    fs::remove(fresh);  // a link would be followed
    {
      std::string content;
      Json::to_cbor(to_json(checkpoint, deck_), content);
      const std::string bytes = sealed(content);
      std::ofstream file(fresh, std::ios::binary);
      file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
      if (!file.flush()) throw LibraryError(fmt::format("cannot write {}", fresh.string()));
    }
    fs::rename(fresh, path);
  });
}

void Checkpoints::save(const Checkpoint& checkpoint) {
  write(checkpoint, step_file(checkpoint.steps_done));
  la::on_root([&] { fs::remove(fs::path(directory_) / point_file); });
  latest_ = checkpoint;
  next_ = 0;
}

void Checkpoints::begin_at(const Checkpoint& checkpoint) {
  latest_ = checkpoint;
  latest_.point.reset();
}

void Checkpoints::save_point(const Checkpoint& checkpoint, bool always) {
  const double start = now_seconds();
  if (!la::true_on_any_rank(always || start >= next_)) return;
  write(checkpoint, point_file);
  const double seconds = now_seconds() - start;
  next_ = start + 20 * seconds;
}

void require_fit(const Checkpoint& checkpoint, const assembly::Rest& wanted, const std::string& from) {
  const auto sizes = sizes_of(wanted);
  const auto& point = checkpoint.point;
  if ((!checkpoint.rest || sizes_of(*checkpoint.rest) == sizes) &&
      (!point || (sizes_of(point->start) == sizes && sizes_of(point->place.state) == sizes_of(wanted.state))))
    return;
  throw LibraryError(
      fmt::format("the checkpoints in {} hold a state of another mesh than the one that form-finding and "
                  "meshing have made now: run without --from",
                  from));
}

std::optional<Checkpoint> find_checkpoint(const deck::Deck& deck, const std::string& directory) {
  const fs::path folder = fs::path(directory) / "checkpoints";
  if (!fs::is_directory(folder))
    throw LibraryError(
        fmt::format("there are no checkpoints in {}: --from wants the directory of results of an "
                    "earlier run",
                    directory));
  std::vector<std::string> names{point_file};
  for (int k = static_cast<int>(deck.steps.size()); k > 0; --k) names.push_back(step_file(k));
  std::optional<Checkpoint> best;
  for (const auto& name : names) {
    if (!fs::exists(folder / name)) continue;
    const Json json = read(folder / name);
    if (json["structure"] != deck.fingerprint)
      refuse(folder / name, fmt::format("belongs to another structure than {} (or its mesh file has changed; "
                                        "only steps, title, solver and output may differ)",
                                        deck.path));
    if (!fits(json, deck)) continue;
    auto checkpoint = checkpoint_of(json);
    const bool farther = !best || checkpoint.steps_done > best->steps_done;
    if (farther) best = std::move(checkpoint);
  }
  return best;
}

}  // namespace tautline::steps
