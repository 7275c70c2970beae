#pragma once
/// @file
/// The results as Markdown.

#include <string>
#include <vector>

#include "case.hpp"

namespace verify {

struct CaseResults {
  Case the_case;
  std::vector<Result> results;
};

std::string number_text(double value);
/// The reference as written, if it is written as a number; with its sign if it is a bound.
std::string reference_text(const Result& result);
std::string with_unit(const Quantity& quantity);
/// Difference from the reference: relative where that means something, else absolute.
std::string difference_text(const Result& result);
std::string tolerance_text(const Quantity& quantity);
/// ok, shown (not asserted) or FAILED.
std::string verdict(const Result& result);

/// README of the case, its table, its notes, how it was run.
std::string case_page(const CaseResults& results);
/// All cases, a table each, and what verification/mutants.md in `source` says of how much the tests notice.
std::string overview_page(const std::vector<CaseResults>& cases, const std::string& source);

}  // namespace verify
