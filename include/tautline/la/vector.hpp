#pragma once
/// @file
/// Distributed vector of three-component blocks: RAII over a PETSc Vec.

#include <span>
#include <vector>

struct _p_Vec;

namespace tautline::la {

/// How the blocks of three unknowns are dealt out: each rank owns a contiguous range.
struct BlockLayout {
  int first = 0;  ///< first block owned by this rank
  int local = 0;  ///< number of blocks owned by this rank
  int total = 0;  ///< number of blocks of all ranks
};

class Vector {
 public:
  explicit Vector(const BlockLayout& layout);
  explicit Vector(_p_Vec* borrowed);  ///< a view that does not own
  static Vector like(const Vector& other);
  static Vector adopt(_p_Vec* handle);  ///< takes ownership
  ~Vector();
  Vector(Vector&& other) noexcept;
  Vector& operator=(Vector&& other) noexcept;
  Vector(const Vector&) = delete;
  Vector& operator=(const Vector&) = delete;

  _p_Vec* handle() const noexcept { return vec_; }
  int local_size() const;
  void set_zero();
  double norm() const;
  double dot(const Vector& other) const;
  void copy(const Vector& other);
  void scale(double factor);
  void add(double factor, const Vector& other);  ///< this += factor * other
  void multiply_entries(const Vector& by);       ///< entry by entry
  /// Copies the rank's own entries out of or into the vector.
  void read(std::span<double> local) const;
  void write(std::span<const double> local);
  /// All entries on every rank. Collective.
  void gather(std::vector<double>& all) const;

 private:
  _p_Vec* vec_ = nullptr;
  bool owned_ = true;
};

}  // namespace tautline::la
