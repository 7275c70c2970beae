#include <tautline/steps/version.hpp>

namespace tautline::steps {

const char* version() {
  return TAUTLINE_VERSION;
}

}  // namespace tautline::steps
