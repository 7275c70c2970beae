#pragma once

namespace tautline::output {

struct OutputOptions {
  bool fields = true;        ///< ParaView files
  bool tables = true;        ///< csv
  bool pictures = true;      ///< png
  int picture_width = 1400;  ///< of views [pixel]; charts are 5/7 of it
  bool report = true;        ///< report.html
};

}  // namespace tautline::output
