#pragma once
/// @file
/// The model as a nonlinear problem: gather -> kernel -> scatter on every rank's share of the elements. Owns
/// the parallel layout.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tautline/analysis/path.hpp>
#include <tautline/assembly/dof_map.hpp>
#include <tautline/la/symmetric_matrix.hpp>
#include <tautline/model/model.hpp>
#include <tautline/model/state.hpp>

namespace tautline::assembly {

/// What is held and what acts at one end of a stage.
struct Boundary {
  std::vector<model::Support> supports;
  std::vector<model::NodalLoad> loads;
  Vec3 acceleration = Vec3::Zero();  ///< [m/s^2]
};

/// Size of what the supports carried and do no longer: the start of a stage.
struct OutOfBalance {
  double force = 0;   ///< largest nodal force [N]
  double moment = 0;  ///< largest nodal moment [N m]
  int node = -1;      ///< where the largest force is
};

/// @brief A finite-element model in motion: model, state, boundary.
///
/// The model is held whole on every rank; elements, unknowns and factors are dealt out. A stage begins with
/// `begin_stage`: forces that are out of balance there (reactions of released supports, loads not yet
/// balanced, prestress) are kept as external forces and ramped out as lambda goes from 0 to 1; unstressed
/// lengths asked for by `set_target_strains` are ramped in.
class System : public analysis::PathProblem {
 public:
  explicit System(model::Model model);

  const model::Model& model() const noexcept { return model_; }
  const model::State& state() const noexcept { return state_; }
  const DofMap& dof_map() const noexcept { return map_; }
  int n_dofs() const noexcept { return 3 * map_.layout.total; }
  double assembly_seconds() const noexcept { return assembly_seconds_; }

  /// Moves to `state`, which must belong to this model; unstressed lengths stay as they are, or become those
  /// of `strains`.
  void set_state(const model::State& state);
  void set_state(const model::State& state, const std::vector<double>& strains);
  /// Present initial strain of each cable.
  std::vector<double> strains() const;
  /// Starts a stage towards `boundary` from the present state. @return what is out of balance there
  OutOfBalance begin_stage(const Boundary& boundary);
  /// New initial strains, one for each cable, reached at lambda = 1 of the stage begun next by begin_stage.
  void set_target_strains(std::vector<double> strains);

  // analysis::PathProblem
  const la::BlockLayout& layout() const override { return map_.layout; }
  void residual(const la::Vector& x, la::Vector& f) override;
  void tangent(la::SymmetricMatrix& k) override;
  void accept(const la::Vector& x) override;
  void restart() override;
  analysis::ResidualNorms norms(const la::Vector& f) const override;
  double relative_size(const la::Vector& increment) const override;
  void set_lambda(double lambda) override;
  void commit() override;
  void roll_back() override;

  /// Mass matrix of the free unknowns in the present state; rows and columns of held ones are zero.
  la::SymmetricMatrix mass() const { return assemble_mass(held_); }
  la::SymmetricMatrix new_matrix() const { return {map_.layout, map_.pattern}; }
  /// x^T K x in the present state, summed element by element from relative motions so that it keeps its
  /// digits where a stiff frame moves almost rigidly. Collective.
  double second_variation(const la::Vector& x) const;
  /// Whether an unknown is held: index 3 * block + component.
  const std::vector<bool>& held() const noexcept { return held_; }
  /// Reactions: internal minus external force at every node, zero where nothing is held [N], [N m].
  struct Reactions {
    Points force, moment;
  };
  Reactions reactions();
  /// A vector's blocks as nodal values: displacement part and rotation part. Collective.
  struct NodalField {
    Points displacement, rotation;
  };
  NodalField nodal(const la::Vector& x) const;

 private:
  struct Share {
    std::vector<int> cables, beams, membranes;  ///< those that touch a node of this rank
  };
  /// Internal forces of the elements that touch this rank's nodes added into `force`, and the sums of their
  /// magnitudes into `magnitude`; complete in the rank's own entries. Elements come in the model's order, so
  /// that every entry is the same number however the nodes are dealt out.
  void add_internal(const model::State& state, std::vector<double>& force,
                    std::vector<double>& magnitude) const;
  model::State moved(const std::vector<double>& x) const;
  std::vector<double> dead_loads(const Boundary& boundary) const;
  std::vector<double> internal_forces() const;
  std::span<const double> own_part(const std::vector<double>& all) const;
  la::SymmetricMatrix assemble_mass(const std::vector<bool>& without) const;
  void hold(const std::vector<model::Support>& supports);
  void apply_strains();

  model::Model model_;
  DofMap map_;
  Share share_;
  model::State state_, committed_;
  std::vector<double> origin_;  // unknowns at which `state_` was accepted
  std::vector<bool> held_;
  std::vector<double> start_force_, end_force_;  // external forces at lambda = 0 and 1
  std::vector<double> start_strain_, end_strain_;
  std::optional<std::vector<double>> wanted_strain_;
  double lambda_ = 1, size_ = 1;
  double support_stiffness_ = 1;
  mutable std::vector<double> magnitude_;  // of the last residual, all unknowns
  mutable double assembly_seconds_ = 0;
};

}  // namespace tautline::assembly
