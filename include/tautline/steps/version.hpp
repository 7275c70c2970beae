#pragma once

namespace tautline::steps {

/// Version of the program, e.g. "0.1.0".
const char* version();

}  // namespace tautline::steps
