#include "steps/context.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/core/stopwatch.hpp>
#include <tautline/la/session.hpp>
#include <tautline/output/results.hpp>

#include "steps/summaries.hpp"

namespace tautline::steps {

namespace {

/// Every element is its own parent: the mesh is the structure.
void number_elements(model::Model& mesh) {
  const auto number = [](auto& elements) {
    for (std::size_t i = 0; i < elements.size(); ++i) elements[i].parent = static_cast<int>(i);
  };
  number(mesh.cables);
  number(mesh.beams);
  number(mesh.membranes);
  number(mesh.shells);
}

}  // namespace

Context::Context(const deck::Deck& the_deck, std::string directory, bool pictures, Progress& the_progress)
    : deck(the_deck),
      progress(the_progress),
      checkpoints(the_deck, directory + "/checkpoints"),
      files_(directory),
      pictures_(pictures),
      root_(la::rank() == 0),
      fields_(directory, la::rank(), la::size()) {
  for (const auto& step : deck.steps) step_files_.of(step.name);  // the same ones wherever a run is taken up
  if (deck.rod_umbrella() != nullptr) {
    umbrella = rod::make_umbrella(*deck.rod_umbrella());
    why_none_ = "the rod-umbrella has no cables yet: a rod_shaping step finds them";
    return;
  }
  structure = build_structure(deck);
  model::validate(structure);
  model::find_directors(structure);
  if (deck.dish()) surface = reflector::make_paraboloid(*deck.dish());
}

assembly::System& Context::system() {
  if (!system_) {
    model::Model mesh = described();
    number_elements(mesh);
    set_system(std::move(mesh));
  }
  return *system_;
}

analysis::Workspace& Context::workspace() {
  system();
  return *workspace_;
}

const model::Model& Context::described() const {
  if (structure.nodes.empty()) throw ModelError(why_none_);
  return structure;
}

void Context::set_structure(model::Model the_structure, std::string why_none) {
  structure = std::move(the_structure);
  why_none_ = std::move(why_none);
  workspace_.reset();
  system_.reset();
}

void Context::set_system(model::Model mesh) {
  model::validate(mesh);
  system_ = std::make_unique<assembly::System>(std::move(mesh));
  workspace_ = std::make_unique<analysis::Workspace>(system_->new_matrix());
  equilibrium_known = false;
}

bool Context::is_lost(const assembly::OutOfBalance& start) const {
  return !equilibrium_known && start.before >= start.force / 2 &&
         start.before > 10 * system_->rounding().force;
}

void Context::note_model() {
  if (umbrella && !has_system()) {
    results["model"] = umbrella_json(*umbrella);
    return;
  }
  const auto& model = has_system() ? system_->model() : structure;
  results["model"] = model_json(model, has_system() ? system_->n_dofs() : 0);
  results["model"]["mass_by_group"] = model::mass_by_group(model);
}

void Context::open_directory(bool goes_on) {
  files_.open(goes_on);
  for (const char* name : {"fields.pvd", "report.html"}) files_.path(name);  // written by others
}

void Context::save() {
  la::on_root([&] { output::write_results(path("results.json"), results); });
}

void Context::warn(const std::string& code, const std::string& message, const std::string& where) {
  const std::string place = where.empty() ? fmt::format("step \"{}\"", step_name) : where;
  const Json warning{{"code", code}, {"message", message}, {"where", place}};
  auto& warnings = results["warnings"];
  if (std::find(warnings.begin(), warnings.end(), warning) != warnings.end()) return;
  warnings.push_back(warning);
  progress.say(fmt::format("warning: {}: {}", place, message));
}

void Context::warn(const std::vector<model::Doubt>& doubts) {
  for (const auto& doubt : doubts) warn(doubt.code, doubt.message, doubt.where);
}

void Context::warn_of_inputs() {
  warn(model::input_doubts(structure, {deck.materials, deck.sections}));
  std::set<std::string> told;
  for (const auto& step : deck.steps) {
    const auto* equilibrium = std::get_if<EquilibriumOptions>(&step.options);
    if (equilibrium == nullptr) continue;
    std::vector<std::string> loads;
    for (const auto& load : structure.loads) loads.push_back(load.name);
    for (const auto& doubt : model::temperature_doubts(structure, equilibrium->loads.value_or(loads)))
      if (told.insert(doubt.where + doubt.message).second) warn(doubt.code, doubt.message, doubt.where);
  }
}

void Context::warn_of_geometry() {
  if (std::exchange(geometry_looked_at_, true) || !deck.model)
    return;  // reflectors are made as they are meant
  warn(model::geometry_doubts(structure));
}

bool finds_shape(const AnyStep& options) {
  return std::holds_alternative<FormFindingOptions>(options) ||
         std::holds_alternative<RodShapingOptions>(options);
}

void Context::warn_of_state(const model::Response& response) {
  for (const auto& doubt : model::state_doubts(system().model(), response))
    warn(doubt.code, doubt.message, fmt::format("step \"{}\", {}", step_name, doubt.where));
}

template <class Picture>
void Context::draw_any(const std::string& name, const std::string& caption, const Picture& picture) {
  if (!pictures_ || !root_) return;
  const Stopwatch watch(output_seconds_);
  const std::string file = fmt::format("pictures/{}_{}.png", step_files_.of(step_name), name);
  Picture sized = picture;
  const double scale = deck.output.picture_width / double{output::OutputOptions{}.picture_width};
  sized.width = static_cast<int>(std::lround(scale * picture.width));
  sized.height = static_cast<int>(std::lround(scale * picture.height));
  try {
    std::filesystem::create_directories(path("pictures"));
    output::draw(sized, path(file));
    results["pictures"].push_back({{"file", file}, {"caption", caption}, {"step", step_name}});
  } catch (const LibraryError& error) {
    warn("no_pictures", error.what());
    pictures_ = false;
  }
}

void Context::draw(const std::string& name, const std::string& caption, const output::View& view) {
  draw_any(name, caption, view);
}

void Context::draw(const std::string& name, const std::string& caption, const output::Chart& chart) {
  draw_any(name, caption, chart);
}

void Context::write_fields(const std::string& name, const output::FieldGrid& grid) {
  if (!deck.output.fields) return;
  const Stopwatch watch(output_seconds_);
  const auto& ranks = system().dof_map().node_rank;
  std::vector<int> owner;
  for (const auto& line : grid.lines) owner.push_back(ranks[line[0]]);
  for (const auto& facet : grid.facets) owner.push_back(ranks[facet[0]]);
  fields_.write(name, output::extract_piece(grid, owner, la::rank()));
}

std::vector<model::Load> Context::loads_in_action(bool loaded) const {
  std::vector<model::Load> loads;
  if (!loaded) return loads;
  const auto acts = [&](const std::string& name) {
    return std::find(acting_loads.begin(), acting_loads.end(), name) != acting_loads.end();
  };
  for (const auto& load : system_->model().loads)
    if (acts(load.name)) loads.push_back(load);
  return loads;
}

bool Context::is_supported(const std::vector<std::string>& hold) const {
  const auto& model = system_->model();
  return !hold.empty() || !model.supports.empty() ||
         std::any_of(model.springs.begin(), model.springs.end(),
                     [](const model::Spring& spring) { return spring.grounded(); });
}

assembly::Boundary Context::boundary(const std::vector<std::string>& hold, bool loaded) const {
  const auto& model = system_->model();
  assembly::Boundary boundary;
  boundary.supports = model.supports;
  if (!hold.empty()) {
    auto& held = boundary.supports.emplace_back();
    held.name = "held";
    held.on = hold;
    held.nodes = model.nodes_of(hold);
  }
  if (!is_supported(hold))
    throw ModelError(
        "nothing is supported: the structure can move as a rigid body. Add an entry to \"supports\"; or, for "
        "a structure that floats, give the equilibrium step `support: free` (its loads accelerate it; modal "
        "steps need no support)");
  boundary.loads = loads_in_action(loaded);
  return boundary;
}

assembly::Boundary Context::free_boundary(bool loaded) const {
  return {{}, loads_in_action(loaded), true};
}

assembly::Boundary Context::vibration_boundary(Ground ground) const {
  return {ground == Ground::free ? std::vector<model::Support>{} : system_->model().supports,
          loads_in_action(true)};
}

namespace {

/// Iterations on the live line.
std::function<void(double, int, double)> teller(Context& context, const std::string& what) {
  return [&context, what](double lambda, int iteration, double residual) {
    context.progress.update(fmt::format("{} | {}: lambda {:.4g}, iteration {}, residual {:.1e}",
                                        context.step_name, what, lambda, iteration, residual));
  };
}

}  // namespace

analysis::PathSummary follow(Context& context, const std::string& what, int increments,
                             analysis::PathCallback callback, const analysis::PathStart& start) {
  auto options = context.deck.solver;
  options.increments = increments;
  return follow(context, what, options, std::move(callback), start);
}

analysis::PathSummary follow(Context& context, const std::string& what,
                             const analysis::NewtonOptions& options, analysis::PathCallback callback,
                             const analysis::PathStart& start) {
  callback.iteration = teller(context, what);
  auto path = analysis::follow_path(context.system(), context.workspace(), options, callback, start);
  context.system().check_prescribed();
  return path;
}

analysis::PathSummary follow_arc(Context& context, const std::string& what,
                                 const analysis::ArcLengthOptions& options,
                                 const std::optional<analysis::Watch>& watch, analysis::PathCallback callback,
                                 const analysis::PathStart& start) {
  callback.iteration = teller(context, what);
  auto path = analysis::follow_arc(context.system(), context.workspace(), context.deck.solver, options, watch,
                                   callback, start);
  context.system().check_prescribed();
  return path;
}

}  // namespace tautline::steps
