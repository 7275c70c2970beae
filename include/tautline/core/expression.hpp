#pragma once
/// @file
/// Formulas as a user writes them: of one variable with its derivatives, and of a place.

#include <functional>
#include <string>

#include <tautline/core/types.hpp>

namespace tautline {

/// A value with its first and second derivative.
struct Jet2 {
  double value = 0, first = 0, second = 0;
};

/// @brief Formula of the variable X: numbers, + - * / ^, parentheses, pi, and sqrt, exp, log, sin, cos, tan,
/// asin, acos, atan, sinh, cosh, tanh, abs.
///
/// Derivatives are exact: every operation carries them along. ^ binds more tightly than a sign before it, and
/// to the right. Outside the domain of a function the result is NaN.
class Expression {
 public:
  /// @throws std::invalid_argument with the place of the fault, counted from 1
  explicit Expression(const std::string& text);

  Jet2 operator()(double x) const {
    const Jet2 at{x, 1, 0};
    return evaluate_(&at);
  }

 private:
  std::function<Jet2(const Jet2*)> evaluate_;
};

/// A formula of the coordinates x, y, z [m], written as an Expression is.
class SpaceFormula {
 public:
  /// @throws std::invalid_argument with the place of the fault, counted from 1
  explicit SpaceFormula(const std::string& text);

  double operator()(const Vec3& x) const;
  Vec3 gradient(const Vec3& x) const;

 private:
  std::function<Jet2(const Jet2*)> evaluate_;
};

}  // namespace tautline
