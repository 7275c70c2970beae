#pragma once

namespace tautline::output {

struct OutputOptions {
  bool fields = true;    ///< ParaView files
  bool tables = true;    ///< csv
  bool pictures = true;  ///< png
  bool report = true;    ///< report.html
};

}  // namespace tautline::output
