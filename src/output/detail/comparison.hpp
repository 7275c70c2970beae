#pragma once

#include <string>
#include <vector>

#include "output/detail/story.hpp"

namespace tautline::output::detail {

/// One column for each directory, one row for each figure that at least one of them has. @throws LibraryError
Table comparison(const std::vector<std::string>& directories);

}  // namespace tautline::output::detail
