#include <tautline/la/vector.hpp>

#include <algorithm>
#include <utility>

#include <petscvec.h>

#include "la/check.hpp"

namespace tautline::la {

Vector::Vector(const BlockLayout& layout) {
  check(VecCreate(PETSC_COMM_WORLD, &vec_), "VecCreate");
  check(VecSetSizes(vec_, 3 * layout.local, 3 * layout.total), "VecSetSizes");
  check(VecSetBlockSize(vec_, 3), "VecSetBlockSize");
  check(VecSetType(vec_, VECSTANDARD), "VecSetType");
  set_zero();
}

Vector::Vector(_p_Vec* borrowed) : vec_(borrowed), owned_(false) {}

Vector Vector::like(const Vector& other) {
  ::Vec copy = nullptr;
  check(VecDuplicate(other.vec_, &copy), "VecDuplicate");
  return adopt(copy);
}

Vector Vector::adopt(_p_Vec* handle) {
  Vector result(handle);
  result.owned_ = true;
  return result;
}

Vector::~Vector() {
  if (owned_ && vec_ != nullptr) VecDestroy(&vec_);
}

Vector::Vector(Vector&& other) noexcept
    : vec_(std::exchange(other.vec_, nullptr)), owned_(std::exchange(other.owned_, true)) {}

Vector& Vector::operator=(Vector&& other) noexcept {
  std::swap(vec_, other.vec_);
  std::swap(owned_, other.owned_);
  return *this;
}

int Vector::local_size() const {
  PetscInt n = 0;
  check(VecGetLocalSize(vec_, &n), "VecGetLocalSize");
  return n;
}

void Vector::set_zero() {
  check(VecZeroEntries(vec_), "VecZeroEntries");
}

double Vector::norm() const {
  PetscReal value = 0;
  check(VecNorm(vec_, NORM_2, &value), "VecNorm");
  return value;
}

double Vector::dot(const Vector& other) const {
  PetscScalar value = 0;
  check(VecDot(vec_, other.vec_, &value), "VecDot");
  return value;
}

void Vector::copy(const Vector& other) {
  check(VecCopy(other.vec_, vec_), "VecCopy");
}

void Vector::scale(double factor) {
  check(VecScale(vec_, factor), "VecScale");
}

void Vector::add(double factor, const Vector& other) {
  check(VecAXPY(vec_, factor, other.vec_), "VecAXPY");
}

void Vector::multiply_entries(const Vector& by) {
  check(VecPointwiseMult(vec_, vec_, by.vec_), "VecPointwiseMult");
}

void Vector::read(std::span<double> local) const {
  const PetscScalar* array = nullptr;
  check(VecGetArrayRead(vec_, &array), "VecGetArrayRead");
  std::copy_n(array, local.size(), local.begin());
  check(VecRestoreArrayRead(vec_, &array), "VecRestoreArrayRead");
}

void Vector::write(std::span<const double> local) {
  PetscScalar* array = nullptr;
  check(VecGetArrayWrite(vec_, &array), "VecGetArrayWrite");
  std::copy(local.begin(), local.end(), array);
  check(VecRestoreArrayWrite(vec_, &array), "VecRestoreArrayWrite");
}

namespace {

struct Shares {
  std::vector<int> counts, starts;
};

Shares shares_of(::Vec vec) {
  const PetscInt* ranges = nullptr;
  check(VecGetOwnershipRanges(vec, &ranges), "VecGetOwnershipRanges");
  int size = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &size);
  Shares shares;
  for (int r = 0; r < size; ++r) {
    shares.starts.push_back(ranges[r]);
    shares.counts.push_back(ranges[r + 1] - ranges[r]);
  }
  return shares;
}

}  // namespace

void Vector::gather(std::vector<double>& all) const {
  const Shares shares = shares_of(vec_);
  all.resize(static_cast<std::size_t>(shares.starts.back() + shares.counts.back()));
  const PetscScalar* array = nullptr;
  check(VecGetArrayRead(vec_, &array), "VecGetArrayRead");
  MPI_Allgatherv(array, local_size(), MPI_DOUBLE, all.data(), shares.counts.data(), shares.starts.data(),
                 MPI_DOUBLE, PETSC_COMM_WORLD);
  check(VecRestoreArrayRead(vec_, &array), "VecRestoreArrayRead");
}

}  // namespace tautline::la
