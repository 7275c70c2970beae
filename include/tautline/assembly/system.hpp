#pragma once
/// @file
/// The model as a nonlinear problem: gather -> kernel -> scatter on every rank's share of the elements. Owns
/// the parallel layout.

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <tautline/analysis/path.hpp>
#include <tautline/assembly/dof_map.hpp>
#include <tautline/assembly/kinematics.hpp>
#include <tautline/assembly/mass_options.hpp>
#include <tautline/la/symmetric_matrix.hpp>
#include <tautline/model/model.hpp>
#include <tautline/model/rounding.hpp>
#include <tautline/model/state.hpp>

namespace tautline::assembly {

/// What is held and what acts at one end of a stage.
struct Boundary {
  std::vector<model::Support> supports;
  std::vector<model::Load> loads;
  /// Nothing is held: every body is accelerated by what acts on it (inertia relief). No supports then.
  bool free = false;
};

/// Size of what the supports carried and do no longer: the start of a stage.
struct OutOfBalance {
  double force = 0;   ///< largest nodal force [N]
  double moment = 0;  ///< largest nodal moment [N m]
  int node = -1;      ///< where the largest force is
  /// Largest nodal force before anything new acts: zero if the stage starts from an equilibrium [N]
  double before = 0;
};

/// What acts on the model at one end of a stage, node by node, facet by facet, group by group.
struct Acting {
  Points force, moment;  ///< dead nodal loads, of all kinds together [N], [N m]
  Points line;  ///< along each cable (of catenaries, without weight), then beam (in `force` already) [N/m]
  std::vector<double> pressure;      ///< on membranes, then shells [Pa]
  std::vector<double> temperature;   ///< change of cables, then beams, membranes, shells [K]
  Points temperature_gradient;       ///< of each beam [K/m]
  std::vector<double> strain;        ///< initial strain of each cable
  Vec3 acceleration = Vec3::Zero();  ///< [m/s^2]

  /// (1 - t) x this + t x other.
  Acting blended(const Acting& other, double t) const;
};

struct Contribution;

/// A support that moves: unknowns and how far they go in the stage.
struct Drive {
  int block = -1;
  Vec3 way = Vec3::Zero();  ///< in the block's unknowns; zero where it is free [m] or [rad]
};

/// Where loads put a node in the course of a stage.
struct Prescribed {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< displacement [m]
  std::string load;                             ///< one that moves it
};

/// How a free body is accelerated by what acts on it.
struct BodyAcceleration {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();  ///< of its centre of mass [m/s^2]; [rad/s^2]
  Vec3 centre = Vec3::Zero();                          ///< of mass, at present [m]
  double mass = 0;                                     ///< [kg]
  int nodes = 0, first_node = 0;                       ///< how many; the first in the model's order
};

class InertiaRelief;

/// A point of a stage's path.
struct Place : analysis::PathProblem::Kept {
  model::State state;
  double lambda = 0;
  double driven_to = 0;  ///< lambda up to which supports have moved
};

/// A system at rest: all that the next stage starts from.
struct Rest {
  model::State state;
  Acting acting;
  std::vector<double> stiffness_factor;  ///< of the cables, see model::Cable
};

/// Which part of its law a cable follows: its own, or, whatever its strain, that of one side of where it goes
/// slack.
enum class Branch { own, taut, slack };

/// @brief A ray of linear response from a state at rest.
///
/// Every element gets the response without the rigid motion in it: stresses without rotations. Theory:
/// docs/theory/buckling.md
struct Ray {
  double lambda = 0;       ///< where on the ray
  const la::Vector* way;   ///< response from rest to there; none where lambda is zero
  const la::Vector* rate;  ///< response for a unit of lambda from there
  double h = 0;            ///< part of a unit over which differences are taken
};

/// Tension of a cable that only pulls, as if it could push.
struct Pull {
  int cable = 0;
  double rest = 0, rate = 0;  ///< [N]
};

/// @brief A finite-element model in motion: model, state, boundary.
///
/// The model is held whole on every rank; elements, unknowns and factors are dealt out. A stage begins with
/// `begin_stage`: what acts goes from what it was to what the boundary says as lambda goes from 0 to 1;
/// forces that are out of balance at its start (reactions of released supports, prestress) are kept as
/// external forces and ramped out; supports that move are, in every residual, where lambda has them;
/// unstressed lengths asked for by `set_target_strains` are ramped in.
class System : public analysis::PathProblem {
 public:
  explicit System(model::Model model);
  ~System() override;
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  const model::Model& model() const noexcept { return model_; }
  const model::State& state() const noexcept { return state_; }
  const DofMap& dof_map() const noexcept { return map_; }
  const Kinematics& kinematics() const noexcept { return kinematics_; }
  /// Diagonal of the box around the reference nodes [m].
  double size() const noexcept { return size_; }
  /// What rounding may leave out of balance in the present state, as norms over the nodes. Collective.
  model::Rounding rounding() const;
  int n_dofs() const noexcept { return 3 * map_.layout.total; }
  double assembly_seconds() const noexcept { return assembly_seconds_; }

  /// Moves to `state`, which must belong to this model; unstressed lengths stay as they are, or become those
  /// of `strains`.
  void set_state(const model::State& state);
  void set_state(const model::State& state, const std::vector<double>& strains);
  /// Where the system is and what acts, to be restored, also in another run on the same mesh.
  Rest rest() const;
  void restore(const Rest& rest);
  /// Back to where the model begins, with nothing acting; unstressed lengths stay.
  void reset();
  /// Present initial strain of each cable.
  std::vector<double> strains() const;
  /// Starts a stage towards `boundary` from the present state. @return what is out of balance there
  /// @throws ModelError for a moving support that holds nothing
  OutOfBalance begin_stage(const Boundary& boundary);
  /// E A of each cable over that of its group; the stage begun next ramps out what that leaves unbalanced.
  void set_stiffness_factors(const std::vector<double>& factors);
  /// New initial strains, one for each cable, reached at lambda = 1 of the stage begun next by begin_stage.
  void set_target_strains(std::vector<double> strains);

  // analysis::PathProblem
  const la::BlockLayout& layout() const override { return map_.layout; }
  void residual(const la::Vector& x, la::Vector& f) override;
  void tangent(la::SymmetricMatrix& k) override;
  bool extrapolated_tangent(la::SymmetricMatrix& k) override;
  la::SkewPart skew_part() override;
  void accept(const la::Vector& x) override;
  void restart() override;
  analysis::ResidualNorms norms(const la::Vector& f) const override;
  double relative_size(const la::Vector& increment) const override;
  void set_lambda(double lambda) override;
  bool predict(analysis::Workspace& workspace) override;
  void commit() override;
  void roll_back() override;
  std::shared_ptr<const Kept> keep() const override;
  void return_to(const Kept& kept) override;
  void load_rate(la::Vector& q) override;
  void weights(double rotation_weight, la::Vector& d) const override;
  bool taut_stiffness(la::Vector& sums) const override;
  double soften(double limit) override;
  /// The mean motion of nodes along a direction, as a function c . x of the unknowns' increments.
  la::Vector mean_motion(const std::vector<int>& nodes, const Vec3& direction) const;
  /// Moves the present state by an increment of the unknowns, e.g. along a mode. Collective.
  void move(const la::Vector& increment);
  /// Adds stiffness [N/m] by unknown, of all ranks, to the diagonal of every tangent; an empty list takes it
  /// away.
  void brace(std::vector<double> stiffness) { bracing_ = std::move(stiffness); }
  /// Holds each cable that only pulls on a branch of its law; an empty list lets all follow their own.
  void hold_branches(std::vector<Branch> branches);
  /// Whether a membrane may wrinkle, so that its stiffness depends on where a load takes it.
  bool may_wrinkle() const;
  /// Tangent in the state at rest, membranes on the side to which the ray goes from its place. Collective.
  la::SymmetricMatrix tangent_towards(const Ray& ray);
  /// The same with the stresses at the ray's place. Collective.
  la::SymmetricMatrix tangent_at(const Ray& ray);
  /// Derivative of that along the ray, times 2 h; with cables on the branches that they are held on, and
  /// membranes on the side to which the ray goes. Collective.
  la::SymmetricMatrix stress_change(const Ray& ray);
  /// Of each cable that only pulls, its tension at rest and for a unit of the ray, as if it could push.
  std::vector<Pull> pulls(const la::Vector& rate, double h);
  /// Largest strain of the members of each group for a unit of a linear response, free ones such as those of
  /// temperature taken off. Collective.
  std::vector<double> largest_strains(const la::Vector& response) const;
  /// Largest deformation of an element in a linear response, without the rigid motion: change of its nodes'
  /// places over its size, or rotation in rad; or the strain that the stage imposes, if larger. Collective.
  double largest_deformation(const la::Vector& response) const;
  /// Adds what moving supports go while lambda grows by one.
  void add_drives(la::Vector& x) const;
  void drive_rate(la::Vector& w) const override;
  double drive_size(double rotation_weight) const override;
  bool changes_at_rest() override;

  /// @brief Compares the nodes that loads move with what those loads say at the present lambda, from the
  /// boundary and the state alone: no solver may lose a prescribed motion.
  /// @throws std::logic_error naming load and node; that is a bug
  void check_prescribed() const;

  /// Mass matrix of the free unknowns in the present state; rows and columns of held ones are zero.
  la::SymmetricMatrix mass(MassKind kind = MassKind::consistent) const;
  la::SymmetricMatrix new_matrix() const { return {map_.layout, map_.pattern}; }
  /// x^T K x in the present state, summed element by element from relative motions so that it keeps its
  /// digits where a stiff frame moves almost rigidly. Collective.
  double second_variation(const la::Vector& x) const;
  /// Whether an unknown is held: index 3 * block + component.
  const std::vector<bool>& held() const noexcept { return kinematics_.held(); }
  /// Forces and moments in the global frame, one for each node [N], [N m].
  struct NodalForces {
    Points force, moment;
  };
  /// Of the supports: internal minus external force, zero where nothing is held. Collective.
  NodalForces reactions() const;
  /// Of linear constraints and of the neighbouring sectors of a cyclic structure. Collective.
  NodalForces constraint_forces() const;
  /// Of the ground on the structure through grounded springs.
  NodalForces ground_springs() const;
  /// Of everything that acts in the present state: dead loads, pressure, weight. Collective.
  NodalForces applied() const;
  /// A vector's blocks as nodal values: displacement part and rotation part. Collective.
  struct NodalField {
    Points displacement, rotation;
  };
  NodalField nodal(const la::Vector& x) const;
  NodalField nodal(const std::vector<double>& all) const;
  /// Of each body of a free structure, in the state of the last residual; empty where supports hold it.
  std::vector<BodyAcceleration> accelerations() const;

 private:
  struct Share {
    std::vector<int> cables, beams, membranes, shells, springs,
        masses;  ///< those that touch a block of this rank
  };
  /// Calls `visit(element)` for every element of this rank's share, in the model's order.
  template <class Visit>
  void for_each_own(const Visit& visit) const;
  /// What an element adds at `state`, a cable on the branch that it is held on.
  template <class Element, class Want>
  auto answer(const model::State& state, const Element& element, Want want) const;
  /// Calls `visit(nodes, pressure)` for every facet of this rank's share under pressure.
  template <class Visit>
  void for_each_pressed(const Visit& visit) const;
  /// Residual without the ramped out-of-balance at `state`: internal minus external forces, complete in this
  /// rank's own entries; the sums of their magnitudes into `magnitude`. Elements come in the model's order,
  /// so that every entry is the same number however the nodes are dealt out.
  void add_forces(const model::State& state, const Kinematics& at, std::vector<double>& force,
                  std::vector<double>& magnitude) const;
  std::vector<double> out_of_balance() const;
  /// Dead loads and pressure on every node; catenaries feel their weight themselves.
  NodalForces external() const;
  /// Dead load on a node, inertia of a free body among it: force, then moment.
  Vec<6> dead_load(int node) const;
  /// Adds the inertia of free bodies that balances these forces on the unknowns, complete in this rank's own
  /// entries, and keeps it as what acts.
  void add_inertia(const model::State& state, std::vector<double>& force);
  /// The state with each free body where its mean displacement and rotation are zero.
  model::State centred(model::State state) const;
  /// What follows from the state: derivatives of the unknowns, masses of free bodies.
  void take_state();
  /// Internal less external force on every node, what links carry put to their leaders.
  NodalForces nodal_residual() const;
  /// What acts under the loads of `boundary` with these initial strains of the cables: dead loads of the
  /// structure as drawn, wherever it is now.
  Acting acting(const Boundary& boundary, const std::vector<double>& strains) const;
  void add_element_loads(const model::Load& load, Acting& to) const;
  /// What the sum of the loads is by definition and what acts of it, if they differ; else nothing.
  std::string load_fault(const std::vector<model::Load>& loads, const std::vector<double>& strains) const;
  /// The same for the loads of each name, in few sums. @throws std::logic_error if a name's differ
  void audit_loads(const Boundary& boundary, const std::vector<double>& strains) const;
  /// The same along the axes of supports, moments about them also where rotations are held in part.
  std::vector<double> nodal_imbalance() const;
  std::set<int> turned_nodes(const Boundary& boundary) const;
  Vec3 spin_to(int node, const Vec3& target) const;
  void find_drives(const Boundary& boundary);
  void note_prescribed(const Boundary& boundary);
  /// Increments of all unknowns from the point accepted last to x; what supports prescribe is where lambda
  /// has it, whatever x says.
  std::vector<double> increments_to(const la::Vector& x) const;
  /// Residual at `state`, zero where held.
  void residual_at(const model::State& state, la::Vector& f);
  /// The linear answer to the way that supports have still to go, and to what is out of balance.
  bool step_linearly(analysis::Workspace& workspace);
  std::optional<Vec3> common_turn() const;
  bool turn_as_a_whole();
  /// What supports go while lambda grows by one, by unknown.
  std::vector<double> drive_rates() const;
  /// -d residual / d lambda with the nodes where they are, of held unknowns, too.
  std::vector<double> force_rate();
  /// K dx for an increment of all unknowns; complete in this rank's own entries.
  std::vector<double> stiffness_times(const std::vector<double>& increment);
  std::vector<double> extrapolated_stiffness_times(const std::vector<double>& increment);
  template <class ContributionOf>
  std::vector<double> product(const std::vector<double>& increment, const ContributionOf& contribution_of);
  /// With the stresses of all elements foretold.
  void wholly_extrapolated_tangent(la::SymmetricMatrix& k);
  /// What an element adds with stresses foretold by the last motion.
  template <class Element>
  Contribution foretold(const Element& element) const;
  std::span<const double> own_part(const std::vector<double>& all) const;
  std::vector<double> gathered(const std::vector<double>& own_complete) const;
  void apply(double lambda);
  /// Calls `visit(nodes, rotations, force, tangent)` for all that resists on this rank, with what each
  /// element adds given by `contribution_of(element)`.
  template <class ContributionOf, class Visit>
  void for_each_stiffness(const ContributionOf& contribution_of, const Visit& visit) const;
  model::Rounding rounding_beside(const Vec<2>& forces_and_moments) const;
  /// Norms over the nodes of forces and of moments, of `value(block, component)` in this rank's blocks.
  template <class Value>
  Vec<2> norms_by_kind(const Value& value) const;
  /// Whether a dead load on a node adds to the tangent: at the end of an arm, or on a rotation vector.
  bool load_bends(int node) const;
  /// Tangent with what each element adds given by `contribution_of(element)`.
  template <class ContributionOf>
  void assemble_tangent(la::SymmetricMatrix& k, const ContributionOf& contribution_of);
  /// Tangent with the stresses that `part` times a response adds, and with what acts at lambda = `part`;
  /// `of_wrinkling(membrane)` is what membranes that may wrinkle add.
  template <class OfWrinkling>
  la::SymmetricMatrix stressed_tangent(const la::Vector& response, double part,
                                       const OfWrinkling& of_wrinkling);
  /// Largest strain that the stage imposes on an element by itself.
  double largest_imposed_strain() const;

  model::Model model_;
  DofMap map_;
  Kinematics kinematics_;  // linearised about state_
  Share share_;
  model::State state_, committed_;
  /// The last motion accepted: from where, and what it was to first order.
  struct LastMotion {
    model::State before;
    NodalField increment;
  };
  std::optional<LastMotion> last_motion_;
  std::vector<double> origin_;  // unknowns at which `state_` was accepted
  Acting start_, end_, now_;
  std::vector<double> start_residual_;  // of all unknowns, ramped out
  std::vector<Drive> drives_;
  std::map<int, Prescribed> prescribed_;  // by node, for the check
  std::optional<std::vector<double>> wanted_strain_;
  double lambda_ = 1, driven_to_ = 0, committed_drive_ = 0, size_ = 1;
  double support_stiffness_ = 1;
  std::vector<double> bracing_;            // by unknown, or none
  mutable std::vector<double> magnitude_;  // of the last residual, all unknowns
  mutable double assembly_seconds_ = 0;
  std::vector<Branch> branches_;           // of the cables, or none: their own
  std::unique_ptr<InertiaRelief> relief_;  // of a free structure
  /// What softened elements have by themselves: factors of the cables, sections of membranes by group.
  struct Own {
    std::vector<double> factor;
    std::map<std::size_t, element::MembraneSection> sheet;
    double support = 1;
  };
  std::optional<Own> own_;  // while some are softened
};

}  // namespace tautline::assembly
