#pragma once

namespace tautline::output::render {

/// Makes the process-wide OpenGL context current, creating it at the first call.
/// @throws std::runtime_error with the remedy
void make_context_current();

}  // namespace tautline::output::render
