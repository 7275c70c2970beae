#pragma once
/// @file
/// Sparse LDL^T by MUMPS with inertia; the pattern is analysed once. RAII over a PETSc KSP.

#include <string>

#include <tautline/core/types.hpp>
#include <tautline/la/symmetric_matrix.hpp>

struct _p_KSP;

namespace tautline::la {

/// Signs of the pivots: how many negative and (nearly) null ones the factors have.
struct Inertia {
  int negative = 0, null = 0;
};

struct SolverTimings {
  double factorisation = 0, solve = 0;  ///< wall time inside MUMPS [s]
  int factorisations = 0, solves = 0;
};

class DirectSolver {
 public:
  DirectSolver();
  ~DirectSolver();
  DirectSolver(const DirectSolver&) = delete;
  DirectSolver& operator=(const DirectSolver&) = delete;

  /// Factors `matrix`, which must outlive its use here. Memory shortage is retried with more. Collective.
  /// @return false if the matrix is singular; failure() then says why
  /// @throws LibraryError for any other failure, with MUMPS's code and what it means
  bool factor(const SymmetricMatrix& matrix);
  const std::string& failure() const noexcept { return failure_; }
  Inertia inertia() const;
  void solve(const Vector& b, Vector& x);
  /// Solves for many right-hand sides; `b` and the result hold this rank's rows. Collective.
  MatX solve_many(const MatX& b);

  const SolverTimings& timings() const noexcept { return timings_; }
  _p_KSP* handle() const noexcept { return ksp_; }
  void count_solve(double seconds);          ///< for solves made through the handle
  void add(const SolverTimings& elsewhere);  ///< for work of the same kind that another solver did

 private:
  void set_options();
  _p_KSP* ksp_ = nullptr;
  bool options_set_ = false;
  std::string failure_;
  SolverTimings timings_;
};

}  // namespace tautline::la
