#include <tautline/steps/run.hpp>

#include <chrono>
#include <filesystem>
#include <iostream>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/core/interrupt.hpp>
#include <tautline/core/out_of_memory.hpp>
#include <tautline/la/session.hpp>
#include <tautline/output/report.hpp>
#include <tautline/output/results.hpp>
#include <tautline/output/tables.hpp>
#include <tautline/steps/version.hpp>

#include "steps/balance.hpp"
#include "steps/context.hpp"
#include "steps/summaries.hpp"

namespace tautline::steps {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Counters of the system at one moment, for the difference that a step makes.
struct Counters {
  la::SolverTimings solver;
  double assembly = 0, output = 0;

  static Counters of(Context& context) {
    if (!context.has_system()) return {{}, 0, context.output_seconds()};
    return {context.workspace().solver.timings(), context.system().assembly_seconds(),
            context.output_seconds()};
  }
};

void add_performance(Json& entry, const Counters& before, const Counters& after, double wall) {
  const bool renewed =
      after.solver.factorisations < before.solver.factorisations || after.assembly < before.assembly;
  const Counters base = renewed ? Counters{{}, 0, before.output} : before;
  const double factorisation = after.solver.factorisation - base.solver.factorisation;
  const double solve = after.solver.solve - base.solver.solve, assembly = after.assembly - base.assembly;
  const double output = after.output - base.output;
  entry["wall_seconds"] = wall;
  entry["timings"] = {{"assembly", assembly},
                      {"factorisation", factorisation},
                      {"solve", solve},
                      {"output", output},
                      {"other", std::max(0.0, wall - factorisation - solve - assembly - output)}};
  entry["factorisations"] = after.solver.factorisations - base.solver.factorisations;
  entry["peak_memory_bytes"] = la::peak_memory_bytes();
}

Json start_results(const deck::Deck& deck) {
  const auto versions = la::library_versions();
  Json results{{"format", "tautline-results"}, {"version", 1}};
  results["program"] = {{"version", version()},
                        {"petsc", versions.petsc},
                        {"slepc", versions.slepc},
                        {"mumps", versions.mumps},
                        {"ranks", la::size()}};
  if (la::takes_petsc_options()) results["program"]["petsc_options"] = "taken from files and the environment";
  results["deck"] = {
      {"path", deck.path}, {"sha256", deck.sha256}, {"title", deck.title}, {"parameters", deck.parameters}};
  results["status"] = "interrupted";
  results["reason"] = "the run has not come to its end";
  results["steps"] = Json::array();
  results["pictures"] = Json::array();
  results["warnings"] = Json::array();
  return results;
}

/// How a run stands that an exception ends: one that was stopped, by the user, a full disk or for want of
/// memory, is not one whose solvers found nothing.
const char* status_after(const std::exception& error) {
  const bool stopped = dynamic_cast<const Interrupted*>(&error) != nullptr ||
                       dynamic_cast<const LibraryError*>(&error) != nullptr || is_out_of_memory(error);
  return stopped ? "interrupted" : "not_converged";
}

/// Whether a step makes what the steps behind it stand on, so that it is done anew when a run is taken up.
bool builds(const Step& step) {
  return std::holds_alternative<FormFindingOptions>(step.options) ||
         std::holds_alternative<MeshOptions>(step.options) ||
         std::holds_alternative<RodShapingOptions>(step.options);
}

/// Adds the balance of loads and reactions. A step that found an equilibrium is not done without it; one that
/// stands where another left it warns.
void judge_balance(Context& context, const Step& step, Json& entry) {
  const auto rounding = context.system().rounding();
  entry["balance"] = balance_json(context.system());
  entry["rounding"] = {{"force", rounding.force},
                       {"moment", rounding.moment + rounding.force * context.system().size()}};
  const std::string reason = imbalance(entry["balance"]);
  if (reason.empty() || entry["status"] != "done") return;
  if (std::holds_alternative<ModalOptions>(step.options)) return context.warn("no_equilibrium", reason);
  entry["status"] = "not_converged";
  entry["reason"] = reason + ". Try a smaller solver.force_tolerance";
}

/// Leaves word of the step that is running, for whoever finds the results of a run that was killed in it.
void announce(Context& context, Json entry) {
  entry["status"] = "interrupted";
  entry["reason"] = "the run ended within this step";
  auto& steps = context.results["steps"];
  steps.push_back(std::move(entry));
  context.save();
  steps.erase(steps.size() - 1);
}

/// Leaves word of the step that failed.
void record_failure(Context& context, Json entry, const std::exception& error) {
  entry["status"] = status_after(error);
  entry["reason"] = text_of(error);
  context.results["steps"].push_back(std::move(entry));
}

/// Runs one step and appends its entry. @return its status
std::string run_and_record(Context& context, const Step& step) {
  context.step_name = step.name;
  if (!finds_shape(step.options)) context.warn_of_geometry();
  context.progress.say(fmt::format("step {} ({})", step.name, step.kind));
  const auto start = Clock::now();
  const Counters before = Counters::of(context);
  Json entry{{"name", step.name}, {"kind", step.kind}};
  announce(context, entry);
  try {
    entry.update(std::visit([&](const auto& options) { return run_step(context, options); }, step.options));
  } catch (const std::exception& error) {
    record_failure(context, std::move(entry), error);
    throw;
  }
  if (!builds(step) && context.has_system()) judge_balance(context, step, entry);
  add_performance(entry, before, Counters::of(context), seconds_since(start));
  const std::string status = entry["status"];
  if (status != "done")
    context.results["reason"] = fmt::format("step \"{}\": {}", step.name, entry["reason"].get<std::string>());
  context.results["steps"].push_back(std::move(entry));
  return status;
}

void write_tables(Context& context, const assembly::System::NodalForces& reactions) {
  if (!context.deck.output.tables || (context.umbrella && !context.has_system()))
    return;  // an umbrella's tables are written by its steps
  if (!context.umbrella)
    output::write_form_finding_nodes(context.path("form_finding_nodes.csv"), context.structure);
  if (!context.has_system()) return;
  const auto& system = context.system();
  const auto& model = system.model();
  const auto response = model::evaluate_response(model, system.state());
  if (!model.membranes.empty()) output::write_membranes(context.path("membranes.csv"), model, response);
  if (!model.springs.empty()) output::write_springs(context.path("springs.csv"), model, response);
  if (!model.shells.empty()) output::write_shells(context.path("shells.csv"), model, response);
  output::write_reactions(context.path("reactions.csv"), model, reactions.force, reactions.moment);
  output::write_nodes(context.path("nodes.csv"), system.model(), system.state());
  output::write_cables(context.path("cables.csv"), system.model(), response);
  output::write_beams(context.path("beams.csv"), system.model(), response);
  output::write_cut_list(context.path("cut_list.csv"), system.model(), response);
}

/// Brings the run to where the checkpoint was written: structure and mesh are made again, all else is read.
/// @return the number of steps done
int take_up(Context& context, const Checkpoint& checkpoint, const std::string& from) {
  context.progress.say(fmt::format(
      "going on from {}: {} step{} done{}", from, checkpoint.steps_done,
      checkpoint.steps_done == 1 ? "" : "s",
      checkpoint.point ? fmt::format(", the next one at lambda = {:.4g}", checkpoint.point->place.lambda)
                       : ""));
  for (int k = 0; k < checkpoint.steps_done; ++k) {
    const Step& step = context.deck.steps[static_cast<std::size_t>(k)];
    context.step_name = step.name;
    if (builds(step))
      std::visit([&](const auto& options) { return run_step(context, options); }, step.options);
  }
  context.results["steps"] = checkpoint.results["steps"];
  context.results["warnings"] = checkpoint.results["warnings"];
  context.results["resumed"] = {{"from", from}, {"steps", checkpoint.steps_done}};
  if (checkpoint.point) context.results["resumed"]["lambda"] = checkpoint.point->place.lambda;
  context.acting_loads = checkpoint.acting_loads;
  if (checkpoint.rest || checkpoint.point) require_fit(checkpoint, context.system().rest(), from);
  if (checkpoint.rest) context.system().restore(*checkpoint.rest);
  context.resume = checkpoint.point;
  context.checkpoints.begin_at(checkpoint);
  return checkpoint.steps_done;
}

void leave_checkpoint(Context& context, int steps_done) {
  Checkpoint checkpoint{steps_done,
                        {{"steps", context.results["steps"]}, {"warnings", context.results["warnings"]}},
                        context.acting_loads,
                        {},
                        {}};
  if (context.has_system()) checkpoint.rest = context.system().rest();
  context.checkpoints.save(checkpoint);
}

/// Closes the books: tables, results.json, report, and the summary on stdout.
void finish(Context& context, const RunSettings& settings, Clock::time_point start) {
  context.progress.finish();
  assembly::System::NodalForces reactions;
  if (context.has_system()) reactions = context.system().reactions();
  la::on_root([&] { write_tables(context, reactions); });
  context.note_model();
  context.results["wall_seconds"] = seconds_since(start);
  context.results["checkpoint_seconds"] = context.checkpoints.seconds();
  context.save();
  la::on_root([&] {
    if (context.deck.output.report) output::write_report({settings.directory});
    std::cout << output::summary_text(context.results, settings.directory) << std::flush;
  });
}

}  // namespace

ExitCode run(const deck::Deck& deck, const RunSettings& settings, Progress& progress) {
  const auto start = Clock::now();
  const auto checkpoint = settings.from.empty() ? std::nullopt : find_checkpoint(deck, settings.from);
  Context context(deck, settings.directory, settings.pictures && deck.output.pictures, progress);
  std::error_code unknown;  // e.g. that there is no such directory yet
  const bool goes_on = checkpoint && std::filesystem::equivalent(settings.from, settings.directory, unknown);
  la::on_root([&] { context.open_directory(goes_on); });
  watch_for_interrupt();
  context.results = start_results(deck);
  if (la::takes_petsc_options())
    progress.say(
        "TAUTLINE_PETSC_OPTIONS=1: PETSc's options come from .petscrc files and PETSC_OPTIONS as well");
  context.note_model();
  context.save();
  ExitCode code = ExitCode::done;
  std::string status = "done";
  try {
    int done = checkpoint ? take_up(context, *checkpoint, settings.from) : 0;
    context.warn_of_inputs();
    for (; done < static_cast<int>(deck.steps.size()); ++done) {
      if (la::true_on_any_rank(interrupt_requested())) throw Interrupted();
      status = run_and_record(context, deck.steps[static_cast<std::size_t>(done)]);
      context.save();
      if (status != "done") break;
      leave_checkpoint(context, done + 1);
    }
    context.warn_of_geometry();
    if (status != "done") code = ExitCode::not_converged;
  } catch (const Interrupted& error) {
    status = "interrupted";
    context.results["reason"] = error.what();
    code = ExitCode::interrupted;
    context.save();  // the tables may take longer than the user waits
  } catch (const std::exception& error) {
    context.results["status"] = status_after(error);
    context.results["reason"] = text_of(error);
    context.save();
    throw;
  }
  context.results["status"] = status;
  if (status == "done") context.results["reason"] = "every step came to its end";
  finish(context, settings, start);
  return code;
}

}  // namespace tautline::steps
