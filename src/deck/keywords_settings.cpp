#include <deck/builder.hpp>
#include <deck/keywords.hpp>
#include <tautline/analysis/newton_options.hpp>
#include <tautline/output/output_options.hpp>

namespace tautline::deck {

const BlockSet& output_blocks() {
  using Options = output::OutputOptions;
  static const BlockSet set = [] {
    BlockBuilder<Options> b("output", "", "Which results are written besides results.json.");
    b.key("fields", &Options::fields).says("Fields for ParaView (.pvd, .vtu).");
    b.key("tables", &Options::tables).says("Tables (.csv).");
    b.key("pictures", &Options::pictures).says("Pictures (.png).");
    b.key("picture_width", &Options::picture_width)
        .at_least(400)
        .at_most(8000)
        .says("Width of views in pixels, at most; charts are 5/7 of it.");
    b.key("report", &Options::report).says("The report (report.html).");
    return BlockSet{"output", "Which results are written.", {b.take()}, {}};
  }();
  return set;
}

const BlockSet& solver_blocks() {
  using Options = analysis::NewtonOptions;
  static const BlockSet set = [] {
    BlockBuilder<Options> b("solver", "", "Newton's method in all steps.");
    b.key("force_tolerance", &Options::force_tolerance)
        .above(0)
        .below(1)
        .says("Residual force over reference force.");
    b.key("increment_tolerance", &Options::increment_tolerance)
        .above(0)
        .below(1)
        .says("Displacement increment over the size of the structure, looked at together with the force.");
    b.key("max_iterations", &Options::max_iterations).at_least(1).says("Most iterations in one load step.");
    b.key("min_step", &Options::min_step)
        .above(0)
        .at_most(1)
        .says("Smallest part of the load in one step before giving up.");
    return BlockSet{"solver", "Newton's method.", {b.take()}, {}};
  }();
  return set;
}

}  // namespace tautline::deck
