#pragma once
/// @file
/// Small arithmetic on numbers and lists of numbers, for the quantities of expected.yaml.

#include <functional>
#include <string>
#include <vector>

namespace verify {

using Values = std::vector<double>;

/// Finds what stands between braces, e.g. the "s4:/steps/tuning/surface/rms" of
/// {s4:/steps/tuning/surface/rms}.
using Lookup = std::function<Values(const std::string& reference)>;

/// @brief The value of an expression: + - * / ^, parentheses, pi, references in braces, and functions.
///
/// Everything is a list; a list of one is a number and goes with a list of any length. Elementwise: abs sqrt
/// sin cos tan sinh cosh asinh log. To one number: min max sum mean rms size first last (with several
/// arguments: of all of them), at(list, index from 0), above(list, limit): how many are greater.
/// @throws std::runtime_error that shows the expression and what is wrong
Values evaluate(const std::string& text, const Lookup& lookup);

/// As evaluate, for what must be one number.
double evaluate_number(const std::string& text, const Lookup& lookup);

}  // namespace verify
