#include <deck/keywords.hpp>
#include <deck/step_builder.hpp>

namespace tautline::deck {

namespace {

using namespace steps;

const BlockSet& stage_blocks() {
  static const BlockSet set = [] {
    BlockBuilder<StageOptions> b("steps.equilibrium.stages", "",
                                 "One stage: the supports and `hold` are kept, all else is free.");
    b.key("name", &StageOptions::name).by_default("stage and its number").says("Name for results.");
    b.key("hold", &StageOptions::hold)
        .refers("group")
        .says("Groups or selections held besides the supports.");
    return BlockSet{"steps.equilibrium.stages", "Stages of an equilibrium.", {b.take()}, {}};
  }();
  return set;
}

/// Keys that every walk along a path has.
template <class Builder, class Reach>
void add_arc_keys(Builder& b, Reach arc) {
  b.choice(
       "constraint", [=](auto& o) -> auto& { return arc(o).constraint; },
       std::vector<std::pair<std::string, analysis::ArcConstraint>>{
           {"cylindrical", analysis::ArcConstraint::cylindrical},
           {"spherical", analysis::ArcConstraint::spherical}})
      .says("What a step's length is measured in: cylindrical: motions alone; spherical: motions and load.");
  b.key(
       "first_step", [=](auto& o) -> auto& { return arc(o).first_step; })
      .above(0)
      .says("Load factor that the first step would reach if the path were straight.");
  b.key(
       "largest_step", [=](auto& o) -> auto& { return arc(o).largest_step; })
      .above(0)
      .says("Longest step over the first.");
  b.key(
       "smallest_step", [=](auto& o) -> auto& { return arc(o).smallest_step; })
      .above(0)
      .says("Shortest step over the first before giving up.");
  b.key(
       "rotation_weight", [=](auto& o) -> auto& { return arc(o).rotation_weight; })
      .at_least(0)
      .says("Weight of squares of rotations in rad beside those of motions over the structure's size.");
  b.key(
       "target_iterations", [=](auto& o) -> auto& { return arc(o).target_iterations; })
      .at_least(1)
      .says("Steps grow while they take fewer iterations and shrink when they take more.");
  b.key(
       "max_points", [=](auto& o) -> auto& { return arc(o).max_points; })
      .at_least(1)
      .says("Most points; the path may end there.");
}

const BlockSet& arc_blocks() {
  using Options = analysis::ArcLengthOptions;
  static const BlockSet set = [] {
    BlockBuilder<Options> b("steps.equilibrium.arc_length", "",
                            "How a path is followed by its length, with control: arc_length.");
    add_arc_keys(
        b, [](Options & o) -> auto& { return o; });
    b.key("branch", &Options::branch)
        .at_least(0)
        .says("Leave the path at its n-th bifurcation along the critical mode; 0: stay on it.");
    b.key("branch_step", &Options::branch_step)
        .says(
            "Largest motion in the first step on the branch over the size of the structure; negative: to the "
            "other side. Later steps are measured by it.");
    b.key("stop_at_critical", &Options::stop_at_critical)
        .at_least(0)
        .says("The path ends at its n-th critical point; 0: it goes on.");
    return BlockSet{"steps.equilibrium.arc_length", "A path followed by its length.", {b.take()}, {}};
  }();
  return set;
}

void check_until(Reader& reader, const Node& node, UntilOptions& options) {
  if (node.find("displacement") != nullptr && node.find("on") == nullptr)
    reader.complain(node.find("displacement")->label, "\"displacement\" without \"on\"", reader.context(),
                    "expected on: a group or selection whose mean displacement is meant");
  if (const Node* low = node.find("least_load_factor");
      low != nullptr && options.least_load_factor && *options.least_load_factor >= options.load_factor)
    reader.complain(
        *low, fmt::format("least_load_factor = {} is not below load_factor = {}",
                          format_number(*options.least_load_factor), format_number(options.load_factor)));
}

const BlockSet& until_blocks() {
  using Options = UntilOptions;
  static const BlockSet set = [] {
    BlockBuilder<Options> b("steps.equilibrium.until", "",
                            "Where a path with control: arc_length ends, at whichever comes first.");
    b.key("load_factor", &Options::load_factor)
        .says("Load factor: 1 is where the loads that acted before have given way to `loads`.");
    b.key("least_load_factor", &Options::least_load_factor)
        .by_default("no limit")
        .says("Load factor that ends the path from above.");
    b.key("on", &Options::on)
        .refers("group")
        .says("Groups or selections whose mean displacement is watched.");
    b.choice("direction", &Options::direction,
             std::vector<std::pair<std::string, Axis>>{{"x", Axis::x}, {"y", Axis::y}, {"z", Axis::z}})
        .says("Direction of the displacement watched.");
    b.key("displacement", &Options::displacement)
        .in("m")
        .by_default("no limit")
        .says("Mean displacement from the reference configuration that ends the path; it is met exactly.");
    b.check(check_until);
    return BlockSet{"steps.equilibrium.until", "Where a path ends.", {b.take()}, {}};
  }();
  return set;
}

const BlockSet& scatter_blocks() {
  static const BlockSet set = [] {
    BlockBuilder<ScatterOptions> b("steps.equilibrium.scatter", "",
                                   "Random changes at the start of the step, to see whether the equilibrium "
                                   "depends on where the search begins.");
    b.key("position", &ScatterOptions::position)
        .in("m")
        .at_least(0)
        .says(
            "Each coordinate of each free node of the structure is displaced by a random amount up to this "
            "one, either way, and the mesh with it; rotations stay.");
    b.key("tension", &ScatterOptions::tension)
        .at_least(0)
        .says(
            "The initial strain of each cable is changed by a random part of it, up to this one, either way; "
            "at the end of the first stage it is again what it was.");
    b.key("seed", &ScatterOptions::seed).at_least(0).says("Another seed gives another start.");
    return BlockSet{
        "steps.equilibrium.scatter", "A start that is not quite where it should be.", {b.take()}, {}};
  }();
  return set;
}

const BlockSet& imperfection_blocks() {
  static const BlockSet set = [] {
    BlockBuilder<ImperfectionOptions> b(
        "steps.collapse.imperfection", "",
        "A shape without stress that is a little wrong, in the form of a mode of linear buckling.");
    b.key("mode", &ImperfectionOptions::mode)
        .at_least(1)
        .says("Number of the mode, by positive factors, the least first.");
    b.key("amplitude", &ImperfectionOptions::amplitude)
        .in("m")
        .says(
            "Displacement of the node that is displaced most. Both sides are tried, the one where the mode's "
            "largest component is positive first, with a negative amplitude the other one; the smaller "
            "critical load counts.");
    return BlockSet{"steps.collapse.imperfection", "A structure that is not quite straight.", {b.take()}, {}};
  }();
  return set;
}

void check_free(Reader& reader, const Node& node, const EquilibriumOptions& options) {
  if (options.support != Ground::free) return;
  const auto refuse = [&](const char* key, bool given, const std::string& what, const std::string& hint) {
    if (const Node* value = node.find(key); value != nullptr && given)
      reader.complain(value->label, what + " does not go with support free", reader.context(), {}, hint);
  };
  refuse("stages", true, "\"stages\"", "hold parts in a step before, with the deck's supports");
  refuse("release", options.release == Release::automatic, "release automatic", "nothing is held");
  refuse("control", options.control == Control::arc_length, "control arc_length",
         "follow the path with supports that hold statically determinate");
  refuse("scatter", true, "\"scatter\"", "scatter in a step with supports");
}

void check_equilibrium(Reader& reader, const Node& node, EquilibriumOptions& options) {
  check_free(reader, node, options);
  if (options.release == Release::automatic) {
    if (const Node* value = node.find("stages"))
      reader.complain(value->label, "\"stages\" has no effect with release automatic", reader.context(), {},
                      "the program looks for the stages itself");
    if (const Node* value = node.find("scatter"); value != nullptr && options.scatter.tension > 0)
      reader.complain(value->label, "scatter.tension has no effect with release automatic", reader.context(),
                      {}, "give the stages, or scatter positions only");
    if (const Node* value = node.find("control"); value != nullptr && options.control == Control::arc_length)
      reader.complain(value->label, "control arc_length does not go with release automatic", reader.context(),
                      {}, "release first, and follow the path in a step of its own");
  }
  if (options.control == Control::arc_length) {
    if (const Node* value = node.find("increments"))
      reader.complain(value->label, "\"increments\" has no effect with control arc_length", reader.context(),
                      {}, "arc_length.first_step tells how fine the path is");
    return;
  }
  for (const char* key : {"arc_length", "until"})
    if (const Node* value = node.find(key))
      reader.complain(value->label, fmt::format("\"{}\" has no effect with control load", key),
                      reader.context(), {}, "it belongs to control: arc_length");
}

}  // namespace

Block equilibrium_block() {
  using Options = EquilibriumOptions;
  auto b = step_builder<Options>("equilibrium", "Finds the equilibrium under the supports and loads.");
  b.list("stages", &Options::stages, stage_blocks())
      .says(
          "Stages one after the other, e.g. to release parts that were held; without it one stage with the "
          "supports only.");
  b.key("loads", &Options::loads)
      .refers("load")
      .by_default("all loads of the deck")
      .says(
          "All loads that act at the end of this step and from then on, ramped up in its last stage; others "
          "that acted "
          "before are ramped out. An empty list: none.");
  b.key("reset", &Options::reset).says("Start again from the reference configuration.");
  b.key("increments", &Options::increments)
      .at_least(1)
      .says("The loads of the last stage come on in at least so many equal parts.");
  b.key("monitor", &Options::monitor)
      .refers("group")
      .says("Groups or selections whose mean displacement and rotation are reported after each part.");
  b.choice("control", &Options::control,
           std::vector<std::pair<std::string, Control>>{{"load", Control::load},
                                                        {"arc_length", Control::arc_length}})
      .says(
          "How the last stage is followed: load: the load factor grows to 1; arc_length: the path is "
          "followed by "
          "its length, round limit points.");
  b.block("arc_length", &Options::arc_length, arc_blocks()).says("Steps of a path with control: arc_length.");
  b.block("until", &Options::until, until_blocks()).says("Where a path with control: arc_length ends.");
  b.choice("release", &Options::release,
           std::vector<std::pair<std::string, Release>>{{"as_given", Release::as_given},
                                                        {"automatic", Release::automatic}})
      .says(
          "as_given: in `stages`; automatic: the program looks for groups of beams and shells to hold at "
          "first, and "
          "reports the stages that it found as text for a deck.");
  b.choice(
       "fallback", &Options::fallback,
       std::vector<std::pair<std::string, Fallback>>{{"automatic", Fallback::automatic},
                                                     {"none", Fallback::none},
                                                     {"descent", Fallback::descent},
                                                     {"dynamic_relaxation", Fallback::dynamic_relaxation}})
      .says(
          "What is tried where Newton's method gives up; Newton's method then polishes what was found. "
          "descent: "
          "steps downhill in the potential energy to a stable equilibrium, also beyond a limit; "
          "dynamic_relaxation: the same with inertia, slower; automatic: descent from a start that is not in "
          "balance by itself, as long as no equilibrium is known.");
  b.key("allow_unstable", &Options::allow_unstable)
      .says(
          "An unstable equilibrium at the end counts as done. Without it the run ends with it (exit code 4), "
          "except "
          "on a path with control: arc_length, which may be unstable by nature.");
  b.choice("support", &Options::support,
           std::vector<std::pair<std::string, Ground>>{{"deck", Ground::deck}, {"free", Ground::free}})
      .says(
          "deck: the deck's supports; free: nothing is held, as in orbit, whatever the deck supports. Each "
          "body is accelerated by what acts on it and the inertia of its own mass balances that; its mean "
          "displacement and rotation, weighed by mass, are zero.");
  b.block("scatter", &Options::scatter, scatter_blocks())
      .says("Random displacements and tensions at the start of the step.");
  b.check(check_equilibrium);
  return b.take();
}

Block buckling_block() {
  using Options = BucklingOptions;
  auto b = step_builder<Options>(
      "buckling", "Linear buckling of the present state: factors on loads that come beside what acts.");
  b.key("loads", &Options::loads)
      .refers("load")
      .by_default("all loads of the deck that do not act yet")
      .says("Loads that are scaled; what acts already stays as it is. A load that acts may be scaled, too.");
  b.key("modes", &Options::modes).at_least(1).says("Number of factors, nearest to zero first.");
  b.choice("sign", &Options::sign,
           std::vector<std::pair<std::string, Options::Sign>>{{"both", Options::Sign::both},
                                                              {"positive", Options::Sign::positive},
                                                              {"negative", Options::Sign::negative}})
      .says("Which factors: of the loads as given, of the loads reversed, or both.");
  return b.take();
}

Block collapse_block() {
  using Options = CollapseOptions;
  auto b = step_builder<Options>(
      "collapse",
      "How far loads can grow: by steps until a displacement grows too fast, and the first "
      "limit or bifurcation of the undisturbed structure beside it.");
  b.key("loads", &Options::loads)
      .refers("load")
      .by_default("all loads of the deck that do not act yet and do not disturb")
      .says("Loads that grow; what acts already stays as it is.");
  b.key("disturbance", &Options::disturbance)
      .refers("load")
      .says(
          "Loads that act in full while the others grow step by step, e.g. a lateral force of 1 N; as given "
          "and "
          "reversed, and the smaller critical load counts.");
  b.block("imperfection", &Options::imperfection, imperfection_blocks())
      .says("Shape of the structure that is followed step by step, in place of or beside a disturbance.");
  b.key("monitor", &Options::monitor)
      .refers("group")
      .required()
      .says("Groups or selections whose mean displacement tells.");
  b.key("step", &Options::step).above(0).at_most(1).says("Load step over the linear buckling load.");
  b.key("growth", &Options::growth)
      .above(1)
      .says(
          "A step in which the monitored displacement grows more than so many times, and by more than a "
          "quarter "
          "beyond what goes on in proportion to the load, is past the critical load.");
  b.key("linear_factor", &Options::linear_factor)
      .above(0)
      .by_default("the first positive factor of linear buckling")
      .says("Load factor that `step` is a part of.");
  b.key("last", &Options::last).above(0).says("The loads grow no farther, over the linear buckling load.");
  b.key("working_forces", &Options::working_forces)
      .in("N")
      .above(0)
      .says(
          "Compressions of members in service; the critical load over each is a safety factor. The loads "
          "that grow "
          "must be nodal forces.");
  add_arc_keys(
      b, [](Options & o) -> auto& { return o.arc_length; });
  return b.take();
}

}  // namespace tautline::deck
