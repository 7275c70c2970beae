#pragma once
/// @file
/// A formula of one variable, as a user writes it, with its derivatives.

#include <functional>
#include <string>

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

  Jet2 operator()(double x) const { return evaluate_({x, 1, 0}); }

 private:
  std::function<Jet2(const Jet2&)> evaluate_;
};

}  // namespace tautline
