#pragma once
/// @file
/// What may be asked of a net in stage 1 (Belov 2021, eqs 2.62-2.72), and the answer.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <tautline/formfinding/constrained_options.hpp>
#include <tautline/formfinding/constraint_options.hpp>
#include <tautline/formfinding/net.hpp>
#include <vector>

namespace tautline::formfinding {

/// The same demand on several branches or nodes.
struct Constraint {
  ConstraintKind kind = ConstraintKind::tension;
  std::string name;          ///< as the user knows it: of a group of cables, of a set of supports
  std::vector<int> members;  ///< branches; for reactions nodes
  std::vector<double>
      value;  ///< one for all or one for each; none for equal_tension, nor beside least or most
  std::optional<double> least = {}, most = {};  ///< soft bounds in place of a value: between them all is well
  double weight = 1;                            ///< of the squares of its relative deviations

  bool is_range() const { return least || most; }
  /// What is wanted of member k where `found` is there.
  double wanted(std::size_t k, double found) const {
    if (!is_range()) return value[value.size() == 1 ? 0 : k];
    const double above = least ? std::max(found, *least) : found;
    return most ? std::min(above, *most) : above;
  }
  /// Size of what is wanted of member k, by which its deviation is divided; zero if it has none.
  double size(std::size_t k) const {
    if (!is_range()) return value.empty() ? 0 : std::abs(value[value.size() == 1 ? 0 : k]);
    return std::max(std::abs(least.value_or(0)), std::abs(most.value_or(0)));
  }
};

/// A net and what is asked of it. Vectors with one entry for each branch may be empty.
struct ConstrainedNet {
  Net net;
  const Surface* surface = nullptr;
  std::vector<Constraint> constraints;
  VecX force_density;      ///< to start from [N/m]; empty: options.initial_force_density everywhere
  std::vector<bool> held;  ///< branches that keep the force density they start with
  VecX lower, upper;       ///< bounds of the force densities [N/m]; NaN or empty: none
  VecX axial_stiffness;    ///< EA [N], for unstressed lengths
  std::vector<std::array<int, 3>> triangles = {};  ///< of cloth on the net, node indices
  VecX surface_stress = {};                        ///< of every triangle, the same in all directions [N/m]
  std::vector<bool> pulls =
      {};  ///< branches that cannot push, which a compromise keeps in mind; may be empty
};

/// One row of a constraint that is not met.
struct Deviation {
  std::string constraint;  ///< its name
  ConstraintKind kind = ConstraintKind::tension;
  int member = -1;  ///< branch, or node of a reaction
  double wanted = 0, found = 0;
  double relative = 0;  ///< (found - wanted) / scale of the row
};

/// How far the members of one constraint are from what is wanted.
struct Miss {
  std::string constraint;  ///< its name
  ConstraintKind kind = ConstraintKind::tension;
  int members = 0, missed = 0;
  double rms = 0;   ///< of the relative deviations
  Deviation worst;  ///< its largest one
};

/// "unstressed length"
const char* to_string(ConstraintKind kind);
/// "N", "m" or "N/m"
const char* unit(ConstraintKind kind);

/// "20 N wanted, 19 N found", with as many digits as tell them apart.
std::string wanted_and_found(const Deviation& deviation);
/// "length of ridge, branch 12: 1.8 m wanted, 2 m found"
std::string to_string(const Deviation& deviation);

/// Branches of prescribed length that cannot reach from one fixed node to another.
struct ShortPath {
  int from = -1, to = -1;           ///< nodes
  double length = 0, distance = 0;  ///< asked for along the branches; of the nodes [m]
};

/// @param[in] from, to  what the nodes are called
std::string to_string(const ShortPath& path, const std::string& from, const std::string& to);

struct ConstrainedResult {
  bool converged = false;
  std::string reason;                 ///< one sentence with both sides of the inequality
  std::vector<std::string> warnings;  ///< pressed branches, indefinite equations, active bounds
  std::string method;                 ///< of the steps: dense, lsqr or position_newton
  Points nodes;                       ///< all nodes [m]
  VecX force_density;                 ///< [N/m]
  VecX tension;                       ///< q L [N]
  VecX length;                        ///< [m]
  VecX unstressed_length;             ///< [m]; empty without axial_stiffness
  Points reaction;                    ///< what each node still needs to be in equilibrium [N]
  VecX cloth_force_density;           ///< pull of the cloth along each branch [N/m]; empty without cloth
  int cloth_iterations = 0;           ///< how often the shape of the cloth was renewed
  double out_of_balance = 0;          ///< largest force at a node along the directions in equilibrium [N]
  int iterations = 0;
  int inner_iterations = 0;           ///< of the linear solver, in all
  std::vector<Vec3> coordinate_norm;  ///< |x|, |y|, |z| over free nodes after each iteration [m]
  std::vector<double> residual;  ///< largest scaled residual before the first and after each iteration [-]
  std::vector<double> step_relaxation;  ///< alpha of eq. (2.25), or of a damped step 1
  int n_rows = 0;                       ///< constraints asked for
  int rank = -1;                        ///< of G^T at the end; -1 if not computed
  double condition_number = 0;  ///< cond(G^T G) of the scaled rows, rounding-level singular values apart
  bool condition_is_estimate = false;   ///< from below, by the Lanczos process of the last step
  bool least_squares_optimum = false;   ///< not converged because the constraints contradict each other here
  std::vector<Deviation> worst;         ///< rows not met, largest first, at most options.n_worst
  std::vector<Miss> misses;             ///< constraints not met, largest rms first
  std::optional<ShortPath> short_path;  ///< a reason why they cannot be met, if there is this one
  bool in_balance = false;              ///< the shape is in equilibrium, whatever it misses
  double weighted_squares = 0;          ///< sum of the squares of the relative deviations, weights included
};

/// @brief The shape in which the net meets its constraints: Newton's method on the force densities with steps
/// of smallest norm (2.14-2.26, 2.53), any mixture of constraints (2.73).
///
/// Rows are scaled by the value asked for, which makes them dimensionless. Constraints that cannot be met
/// together lead to the shape in equilibrium with the least weighted squares of the scaled rows, searched for
/// from where the iteration ends and from the given nodes; `reason`, `misses` and `worst` tell. Does not
/// throw because of the iteration.
///
/// Cloth pulls along the sides of its triangles with natural force densities, which follow from the shape:
/// the net is solved again with those of its last shape until they agree.
/// @throws ModelError if the net or a constraint makes no sense
ConstrainedResult find_form(const ConstrainedNet& problem, const ConstrainedOptions& options = {},
                            const std::function<void(int, double)>& progress = {});

}  // namespace tautline::formfinding
