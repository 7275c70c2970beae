#pragma once
/// @file
/// What the steps of a run share: the structure as it becomes clearer, the finite-element system, and where
/// results go.

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include <tautline/analysis/arc_length.hpp>
#include <tautline/assembly/system.hpp>
#include <tautline/core/progress.hpp>
#include <tautline/deck/deck.hpp>
#include <tautline/model/doubts.hpp>
#include <tautline/output/fields.hpp>
#include <tautline/output/file_names.hpp>
#include <tautline/output/pictures.hpp>
#include <tautline/output/run_directory.hpp>
#include <tautline/reflector/paraboloid.hpp>
#include <tautline/reflector/surface_error.hpp>
#include <tautline/rod/umbrella.hpp>

#include "steps/checkpoint.hpp"

namespace tautline::steps {

class Context {
 public:
  Context(const deck::Deck& deck, std::string directory, bool pictures, Progress& progress);

  const deck::Deck& deck;
  Progress& progress;
  model::Model structure;  ///< as described; after form-finding, as found; of an umbrella, by rod_shaping
  model::SubdivideOptions subdivide;             ///< by which the system's mesh was made of `structure`
  std::optional<reflector::Paraboloid> surface;  ///< of a reflector
  std::optional<rod::Umbrella> umbrella;         ///< of a rod-umbrella
  std::vector<output::Curve> rod_shapes;         ///< of the rod_shaping steps so far, for pictures
  std::string step_name;                         ///< of the step in hand
  std::vector<std::string> acting_loads;         ///< by name, since the last equilibrium
  Json results;                                  ///< the whole results.json
  Checkpoints checkpoints;                       ///< written as the run goes
  bool equilibrium_known = false;                ///< whether the system stands in one or has come from one
  std::optional<StagePoint> resume;              ///< where the step in hand goes on, if it was begun before

  /// Time spent on pictures and files so far [s].
  double output_seconds() const { return output_seconds_; }
  bool is_root() const { return root_; }
  bool draws() const { return pictures_; }

  /// The finite-element system; made from `structure` without subdivision if no step has made one.
  assembly::System& system();
  analysis::Workspace& workspace();
  bool has_system() const { return system_ != nullptr; }
  void set_system(model::Model mesh);
  /// Whether a stage begins where no equilibrium is known, and not because of the loads that it brings: what
  /// is out of balance without them is half or more of what is with them.
  bool is_lost(const assembly::OutOfBalance& start) const;
  /// Another structure, or none and why; what was made of the one before is forgotten.
  void set_structure(model::Model structure, std::string why_none = {});
  /// The structure. @throws ModelError if there is none
  const model::Model& described() const;

  /// Writes the present model's numbers into results.
  void note_model();

  /// Takes the directory of results; on rank 0. @param goes_on the run takes up the one that wrote there
  void open_directory(bool goes_on);
  /// DIR/name of a file to be written
  std::string path(const std::string& name) { return files_.path(name); }
  /// DIR/<step><ending>, with a file name made of the name of the step in hand
  std::string step_path(const std::string& ending) { return path(step_files_.of(step_name) + ending); }
  /// Writes results.json (rank 0).
  void save();
  /// Notes in results.json what the user must not overlook, and tells it, once: `code` for programs, `where`
  /// the step in hand or what is named. Told alike by every rank.
  void warn(const std::string& code, const std::string& message, const std::string& where = {});
  /// Warns of what is possible but hardly meant: in the deck's figures; and, once, in how the elements of the
  /// structure lie to each other.
  void warn_of_inputs();
  void warn_of_geometry();
  /// Warns of what the present state asks of members.
  void warn_of_state(const model::Response& response);
  /// Draws DIR/pictures/<step>_<name>.png (rank 0) and notes it with its caption; a failure to draw is told
  /// once and noted.
  void draw(const std::string& name, const std::string& caption, const output::View& view);
  void draw(const std::string& name, const std::string& caption, const output::Chart& chart);
  /// Writes a moment of fields (all ranks, each its piece).
  void write_fields(const std::string& name, const output::FieldGrid& grid);
  /// Boundary with the deck's supports, all of `hold` clamped, and the loads that act if `loaded`.
  /// @throws ModelError if that supports nothing
  assembly::Boundary boundary(const std::vector<std::string>& hold, bool loaded) const;
  /// Whether supports of the deck, `hold` or springs to the ground hold the system anywhere.
  bool is_supported(const std::vector<std::string>& hold) const;
  /// Boundary of a free structure, whatever supports the deck has.
  assembly::Boundary free_boundary(bool loaded) const;
  /// Boundary of vibrations: with the deck's supports, if it has any, unless the structure is free.
  assembly::Boundary vibration_boundary(Ground ground) const;

 private:
  std::vector<model::Load> loads_in_action(bool loaded) const;
  void warn(const std::vector<model::Doubt>& doubts);
  template <class Picture>
  void draw_any(const std::string& name, const std::string& caption, const Picture& picture);

  std::string why_none_;
  output::RunDirectory files_;
  output::FileNames step_files_;
  bool pictures_, root_, geometry_looked_at_ = false;
  double output_seconds_ = 0;
  std::unique_ptr<assembly::System> system_;
  std::unique_ptr<analysis::Workspace> workspace_;
  output::FieldSeries fields_;
};

/// Whether a step lays nodes where they were not drawn.
bool finds_shape(const AnyStep& options);

/// The structure of a deck: reflector or model, with sections, initial states, supports and loads. @throws
/// ModelError
model::Model build_structure(const deck::Deck& deck);
/// The loads of the deck, on groups of the model. @throws ModelError
void add_loads(model::Model& model, const deck::Deck& deck);

// One function for each step kind, in the file of that name. Each returns its entry of results.json without
// name, kind and times; `status` is "done" or "not_converged".
Json run_step(Context& context, const FormFindingOptions& options);
Json run_step(Context& context, const MeshOptions& options);
Json run_step(Context& context, const EquilibriumOptions& options);
Json run_step(Context& context, const TuningStepOptions& options);
Json run_step(Context& context, const ModalOptions& options);
Json run_step(Context& context, const BucklingOptions& options);
Json run_step(Context& context, const CollapseOptions& options);
Json run_step(Context& context, const RodShapingOptions& options);
Json run_step(Context& context, const InverseOptions& options);

/// @brief Follows the path of a stage that was begun, with progress on the live line; stops at lambda = k /
/// increments at least and tells `callback` wherever it comes to rest and what critical points it passes.
/// @throws std::logic_error if what loads move is not where they put it
analysis::PathSummary follow(Context& context, const std::string& what, int increments = 1,
                             analysis::PathCallback callback = {}, const analysis::PathStart& start = {});

/// The same with options other than the deck's.
analysis::PathSummary follow(Context& context, const std::string& what,
                             const analysis::NewtonOptions& options, analysis::PathCallback callback = {},
                             const analysis::PathStart& start = {});

/// Follows such a stage by the length of its path.
analysis::PathSummary follow_arc(Context& context, const std::string& what,
                                 const analysis::ArcLengthOptions& options,
                                 const std::optional<analysis::Watch>& watch = {},
                                 analysis::PathCallback callback = {}, const analysis::PathStart& start = {});

}  // namespace tautline::steps
