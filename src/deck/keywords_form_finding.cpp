#include <fmt/format.h>

#include <algorithm>
#include <deck/keywords.hpp>
#include <deck/step_builder.hpp>

namespace tautline::deck {

namespace {

using namespace steps;

bool is_reaction(formfinding::ConstraintKind kind) {
  return kind >= formfinding::ConstraintKind::reaction_x;
}

void read_members(Reader& reader, const Keyword& keyword, const Node& node, FormConstraintOptions& options) {
  if (const auto names = reader.names(keyword, node)) options.on = *names;
}

bool is_length(formfinding::ConstraintKind kind) {
  return kind == formfinding::ConstraintKind::length ||
         kind == formfinding::ConstraintKind::unstressed_length;
}

/// Lengths are positive; tensions and force densities have a size, of soft bounds at least one.
void check_numbers(Reader& reader, const Node& node, const FormConstraintOptions& options) {
  if (is_reaction(options.kind)) return;
  const bool length = is_length(options.kind);
  const auto refuse = [&](const char* key, double number) {
    reader.complain(
        *node.find(key),
        fmt::format("{} = {} is not {}", key, format_number(number), length ? "positive" : "a demand"),
        length ? "expected a number > 0: lengths are"
               : "expected a number > 0, or < 0 for bars in compression");
  };
  if (node.find("value") != nullptr)
    for (const double number : options.value)
      if (length ? number <= 0 : number == 0) refuse("value", number);
  const bool sized = options.min.value_or(0) != 0 || options.max.value_or(0) != 0;
  if (options.min && (length ? *options.min <= 0 : !sized)) refuse("min", *options.min);
  if (options.max && (length ? *options.max <= 0 : !sized)) refuse("max", *options.max);
  if (options.min && options.max && *options.max < *options.min)
    reader.complain(*node.find("max"), fmt::format("max = {} is below min = {}", format_number(*options.max),
                                                   format_number(*options.min)));
}

void check_constraint(Reader& reader, const Node& node, FormConstraintOptions& options) {
  const Node* on = node.find("on");
  if (on != nullptr) {
    const std::string kind = is_reaction(options.kind) ? "group" : "cable or bar group";
    if (on->is_sequence())
      for (const auto& name : on->items) reader.refer(kind, name);
    else
      reader.refer(kind, *on);
  }
  const Node* value = node.find("value");
  const bool equal = options.kind == formfinding::ConstraintKind::equal_tension;
  const bool range = options.min || options.max;
  if (equal && (value != nullptr || range))
    reader.complain(value != nullptr ? value->label : node.label,
                    fmt::format("\"{}\" does not fit an equal tension, which is unknown",
                                value != nullptr ? "value" : "min, max"),
                    reader.context(), {}, "kind: tension prescribes it");
  if (!equal && (value == nullptr) != range)
    reader.complain(node.label, range ? "\"value\" beside \"min\" or \"max\"" : "missing key \"value\"",
                    reader.context(),
                    "expected a number for all, or a list with one for each; or, in place of it, min, max or "
                    "both");
  check_numbers(reader, node, options);
}

const BlockSet& constraint_blocks() {
  static const BlockSet set = [] {
    using enum formfinding::ConstraintKind;
    using Kind = formfinding::ConstraintKind;
    BlockBuilder<FormConstraintOptions> b("steps.form_finding.constraints", "",
                                          "One demand on cables, or on the reactions of supported nodes.");
    b.choice("kind", &FormConstraintOptions::kind,
             std::vector<std::pair<std::string, Kind>>{{"tension", tension},
                                                       {"length", length},
                                                       {"unstressed_length", unstressed_length},
                                                       {"force_density", force_density},
                                                       {"equal_tension", equal_tension},
                                                       {"reaction_x", reaction_x},
                                                       {"reaction_y", reaction_y},
                                                       {"reaction_z", reaction_z}})
        .says(
            "What is asked for. length: in the found shape; equal_tension: one tension for all, whatever it "
            "is; reaction_x, _y, _z: force of the support (or of a tie at a node on a surface) on the net.");
    b.custom("on", Type::names, read_members)
        .required()
        .says("Cable groups; for reactions groups of supported nodes.");
    b.key("value", &FormConstraintOptions::value)
        .in("N, m or N/m")
        .by_default("required but for equal_tension, or min and max")
        .says("One number for all, or a list with one for each cable or node; tensions of bars may be < 0.");
    b.key("min", &FormConstraintOptions::min)
        .in("N, m or N/m")
        .by_default("none")
        .says("In place of value, a soft bound: what is found shall not be less.");
    b.key("max", &FormConstraintOptions::max)
        .in("N, m or N/m")
        .by_default("none")
        .says("In place of value, a soft bound: what is found shall not be more.");
    b.key("weight", &FormConstraintOptions::weight)
        .above(0)
        .says(
            "How much this demand counts where not all can be met: factor of the squares of its deviations, "
            "each "
            "divided by what is asked for (reactions and equal tensions by the largest force asked for).");
    b.check(check_constraint);
    return BlockSet{"steps.form_finding.constraints", "Demands on a net.", {b.take()}, {}};
  }();
  return set;
}

const BlockSet& bounds_blocks() {
  static const BlockSet set = [] {
    BlockBuilder<FormBoundsOptions> b("steps.form_finding.bounds", "", "Limits of force densities.");
    b.key("on", &FormBoundsOptions::on).refers("cable or bar group").required().says("Cable groups.");
    b.key("min", &FormBoundsOptions::min).in("N/m").by_default("none").says("Least force density.");
    b.key("max", &FormBoundsOptions::max).in("N/m").by_default("none").says("Greatest force density.");
    b.key("weight", &FormBoundsOptions::weight)
        .above(0)
        .by_default("none: the bound is always kept")
        .says("Makes the bound a demand that others may outweigh: factor of the squares of its deviations.");
    b.check([](Reader& reader, const Node& node, FormBoundsOptions& options) {
      if (!options.min && !options.max)
        reader.complain(node.label, "bounds without min and max", reader.context(),
                        "expected at least one of: min, max");
      if (options.min && options.max && *options.max <= *options.min)
        reader.complain(*node.find("max"),
                        fmt::format("max = {} is not above min = {}", format_number(*options.max),
                                    format_number(*options.min)));
    });
    return BlockSet{"steps.form_finding.bounds", "Limits of force densities.", {b.take()}, {}};
  }();
  return set;
}

const BlockSet& guide_blocks() {
  static const BlockSet set = [] {
    using Kind = formfinding::GuideKind;
    BlockBuilder<FormGuideOptions> b("steps.form_finding.guides", "",
                                     "Nodes that slide without friction along a line or in a plane.");
    b.choice("kind", &FormGuideOptions::kind,
             std::vector<std::pair<std::string, Kind>>{{"line", Kind::line}, {"plane", Kind::plane}})
        .says("What the nodes slide on.");
    b.key("on", &FormGuideOptions::on).refers("group").required().says("Groups of nodes.");
    b.key("direction", &FormGuideOptions::direction)
        .required()
        .says("Along the line, or normal to the plane.");
    b.key("point", &FormGuideOptions::point)
        .in("m")
        .by_default("each node's own place")
        .says("A point of the line or plane.");
    b.check([](Reader& reader, const Node& node, FormGuideOptions& options) {
      if (const Node* direction = node.find("direction"); direction != nullptr && options.direction.isZero())
        reader.complain(*direction, "direction has no length", "expected a vector that is not zero");
    });
    return BlockSet{"steps.form_finding.guides", "Guides of nodes.", {b.take()}, {}};
  }();
  return set;
}

/// A list of lists of numbers.
void read_heights(Reader& reader, const Keyword& keyword, const Node& node, FormSurfaceOptions& options) {
  if (!reader.expect(Node::Kind::sequence, keyword, node)) return;
  for (const auto& row : node.items)
    if (const auto numbers = reader.numbers(keyword, row)) options.heights.push_back(*numbers);
}

void check_table(Reader& reader, const Node& node, FormSurfaceOptions& options) {
  for (const char* key : {"x", "y", "heights"})
    if (node.find(key) == nullptr)
      reader.complain(node.label, fmt::format("a table without \"{}\"", key), reader.context(),
                      "expected x, y and heights");
  for (const auto& [key, lines] : {std::pair{"x", &options.x}, {"y", &options.y}})
    for (std::size_t i = 1; i < lines->size(); ++i)
      if ((*lines)[i] <= (*lines)[i - 1])
        reader.complain(*node.find(key),
                        fmt::format("{} does not rise at {}", key, format_number((*lines)[i])));
  const Node* heights = node.find("heights");
  if (heights == nullptr || node.find("x") == nullptr || node.find("y") == nullptr) return;
  bool fits = options.heights.size() == options.x.size();
  for (const auto& row : options.heights) fits = fits && row.size() == options.y.size();
  if (!fits)
    reader.complain(*heights, "heights do not fit the grid",
                    fmt::format("expected {} rows (one for each x) of {} numbers (one for each y)",
                                options.x.size(), options.y.size()));
}

void check_surface(Reader& reader, const Node& node, FormSurfaceOptions& options) {
  static const std::vector<std::pair<std::string, FormSurfaceKind>> homes{
      {"slope", FormSurfaceKind::plane},
      {"centre", FormSurfaceKind::paraboloid},
      {"focal_length", FormSurfaceKind::paraboloid},
      {"x", FormSurfaceKind::table},
      {"y", FormSurfaceKind::table},
      {"heights", FormSurfaceKind::table}};
  for (const auto& [key, kind] : homes)
    if (const Node* value = node.find(key); value != nullptr && options.kind != kind)
      reader.complain(value->label, fmt::format("\"{}\" does not fit this kind of surface", key),
                      reader.context());
  if (options.kind == FormSurfaceKind::paraboloid && !(options.focal_length && *options.focal_length != 0))
    reader.complain(node.label, "a paraboloid without focal_length", reader.context(),
                    "expected focal_length: a number, not zero [m]");
  if (options.kind == FormSurfaceKind::table) check_table(reader, node, options);
}

const BlockSet& surface_blocks() {
  static const BlockSet set = [] {
    using enum FormSurfaceKind;
    BlockBuilder<FormSurfaceOptions> b("steps.form_finding.surface", "",
                                       "The surface z(x, y) that nodes lie on, held by vertical ties.");
    b.choice("kind", &FormSurfaceOptions::kind,
             std::vector<std::pair<std::string, FormSurfaceKind>>{
                 {"plane", plane}, {"paraboloid", paraboloid}, {"table", table}})
        .says("plane, paraboloid of revolution about a vertical axis, or table of heights.");
    b.key("height", &FormSurfaceOptions::height)
        .in("m")
        .says("Plane: z at x = y = 0; paraboloid: z of the vertex.");
    b.key("slope", &FormSurfaceOptions::slope).by_default("0").says("Plane: [dz/dx, dz/dy].");
    b.key("centre", &FormSurfaceOptions::centre)
        .in("m")
        .by_default("0")
        .says("Paraboloid: [x, y] of the vertex.");
    b.key("focal_length", &FormSurfaceOptions::focal_length)
        .in("m")
        .by_default("required for a paraboloid")
        .says("Paraboloid: z = height + r^2/(4 F); negative opens downwards.");
    b.key("x", &FormSurfaceOptions::x).in("m").says("Table: rising grid lines x.");
    b.key("y", &FormSurfaceOptions::y).in("m").says("Table: rising grid lines y.");
    b.custom("heights", Type::table, read_heights)
        .in("m")
        .says("Table: a list for each x with a height for each y; smooth in between.");
    b.check(check_surface);
    return BlockSet{"steps.form_finding.surface", "Surface of a net.", {b.take()}, {}};
  }();
  return set;
}

const BlockSet& length_error_blocks() {
  static const BlockSet set = [] {
    BlockBuilder<LengthErrorOptions> b("steps.form_finding.length_errors", "",
                                       "What errors of the cut lengths do to the shape and the tensions.");
    b.key("sigma", &LengthErrorOptions::sigma)
        .in("m")
        .above(0)
        .required()
        .says("Standard deviation of the unstressed length of every cable.");
    b.key(
         "samples", [](LengthErrorOptions & o) -> auto& { return o.sampling.n_samples; })
        .at_least(0)
        .says("Random nets for the distribution of the rms deviation; 0: its expected value only.");
    b.key(
         "seed", [](LengthErrorOptions & o) -> auto& { return o.sampling.seed; })
        .at_least(0)
        .says("Seed of the random nets.");
    return BlockSet{"steps.form_finding.length_errors", "Errors of cut lengths.", {b.take()}, {}};
  }();
  return set;
}

/// Keys that only some methods know.
struct Home {
  const char* key;
  std::vector<FormMethod> methods;
  const char* text;
};

const std::vector<Home>& homes() {
  using enum FormMethod;
  static const std::vector<Home> table{
      {"jacobian", {tension, constraints}, "methods tension and constraints"},
      {"condition_number", {tension, constraints}, "methods tension and constraints"},
      {"solver", {tension, constraints}, "methods tension and constraints"},
      {"surface", {tension, linear, constraints}, "methods tension, linear and constraints"},
      {"on_surface", {tension, linear, constraints}, "methods tension, linear and constraints"},
      {"ties", {tension, linear, constraints}, "methods tension, linear and constraints"},
      {"constraints", {constraints}, "method constraints"},
      {"hold", {constraints}, "method constraints"},
      {"bounds", {constraints}, "method constraints"},
      {"constant_tension", {dynamic_relaxation}, "method dynamic_relaxation"},
      {"damping", {dynamic_relaxation}, "method dynamic_relaxation"},
      {"damping_ratio", {dynamic_relaxation}, "method dynamic_relaxation"},
      {"mass_factor", {dynamic_relaxation}, "method dynamic_relaxation"},
      {"initial_force_density", {tension, linear, constraints, film}, "the methods of force densities"}};
  return table;
}

const std::vector<std::pair<std::string, FormMethod>>& methods() {
  using enum FormMethod;
  static const std::vector<std::pair<std::string, FormMethod>> words{
      {"tension", tension},   {"linear", linear},
      {"balanced", balanced}, {"constraints", constraints},
      {"elastic", elastic},   {"dynamic_relaxation", dynamic_relaxation},
      {"film", film},         {"self_stress", self_stress}};
  return words;
}

std::string word(FormMethod method) {
  for (const auto& [name, value] : methods())
    if (value == method) return name;
  return {};
}

void check_solver(Reader& reader, const Node& node, const FormFindingOptions& options) {
  using enum FormSolver;
  const Node* solver = node.find("solver");
  if (solver == nullptr || options.solver == automatic || options.solver == position_newton) return;
  const bool of_tension = options.solver == smallest_norm || options.solver == fixed_point;
  if (of_tension != (options.method == FormMethod::tension))
    reader.complain(*solver,
                    fmt::format("solver {} does not fit method {}", solver->text, word(options.method)),
                    options.method == FormMethod::tension
                        ? "expected one of: automatic, smallest_norm, position_newton, fixed_point"
                        : "expected one of: automatic, dense, lsqr, position_newton");
}

void check_form_finding(Reader& reader, const Node& node, FormFindingOptions& options) {
  for (const auto& home : homes()) {
    const Node* value = node.find(home.key);
    if (value == nullptr ||
        std::find(home.methods.begin(), home.methods.end(), options.method) != home.methods.end())
      continue;
    reader.complain(value->label,
                    fmt::format("\"{}\" has no effect with method {}", home.key, word(options.method)),
                    reader.context(), {}, fmt::format("it belongs to {}", home.text));
  }
  check_solver(reader, node, options);
  if (options.method == FormMethod::constraints && node.find("constraints") == nullptr)
    reader.complain(node.label, "missing key \"constraints\"", reader.context(),
                    "expected a list of demands for method constraints");
  if (const Node* cloth = node.find("cloth"); cloth != nullptr && options.method == FormMethod::elastic)
    reader.complain(cloth->label, "\"cloth\" has no effect with method elastic", reader.context(), {},
                    "dynamic_relaxation takes elastic cables and cloth");
}

using Builder = BlockBuilder<Step, FormFindingOptions>;

void add_net_keys(Builder& b) {
  using Options = FormFindingOptions;
  b.key("net", &Options::net)
      .refers("cable or bar group")
      .by_default(
          "front_... cable groups of a reflector, else all cable groups, with method self_stress bar groups, "
          "too")
      .says("Groups of cables and bars whose shape is found.");
  b.key("fixed", &Options::fixed)
      .refers("group")
      .says("Plain models: groups or selections that stay in place besides the supports.");
  b.key("cloth", &Options::cloth)
      .refers("membrane group")
      .by_default("all membrane groups with methods film and dynamic_relaxation, else none")
      .says(
          "Membranes whose prestress is a part of the balance of the nodes, one number but for methods film "
          "and "
          "dynamic_relaxation; on a reflector the rear net is given what the cloth carries in front.");
  b.choice("frame", &Options::frame,
           std::vector<std::pair<std::string, FrameKind>>{{"rigid", FrameKind::rigid},
                                                          {"elastic", FrameKind::elastic},
                                                          {"precambered", FrameKind::precambered}})
      .says(
          "All that is neither net nor cloth. rigid: the net hangs in nodes that stay; elastic: the frame, "
          "made "
          "as drawn, yields under the net until both are in balance; precambered: the drawn frame is that "
          "under "
          "the net, and the shape without stress is found. With the last two an analysis starts at rest.");
  b.choice("rear", &Options::rear,
           std::vector<std::pair<std::string, RearForm>>{{"mirrored", RearForm::mirrored},
                                                         {"tension", RearForm::tension},
                                                         {"balanced", RearForm::balanced}})
      .by_default("balanced if the rear net's pattern differs from the front net's, else mirrored")
      .says(
          "Reflectors: the rear net. mirrored: the front net's image; tension, balanced: found by itself, by "
          "the method of that name, under the pull of the ties; both nets and the inclined ties are then "
          "brought into balance together.");
  b.key("loads", &Options::loads)
      .refers("load")
      .says("Loads whose nodal forces act; let them act in the equilibrium that follows, too.");
  b.list("guides", &Options::guides, guide_blocks())
      .says(
          "Nodes that slide along lines or in planes; supports that hold one or two directions do so, too.");
  b.block("surface", &Options::surface, surface_blocks())
      .says("Plain models: the surface that free nodes lie on, held there by vertical ties.");
  b.key("on_surface", &Options::on_surface)
      .refers("group")
      .by_default("all free nodes")
      .says("Groups whose nodes lie on the surface.");
  b.key("ties", &Options::ties)
      .refers("cable group")
      .says("Plain models: vertical cables that get the tension which holds the net on the surface.");
}

void add_method_keys(Builder& b) {
  using Options = FormFindingOptions;
  using Jacobian = formfinding::SurfaceJacobian;
  using Damping = formfinding::Damping;
  b.choice("method", &Options::method, methods())
      .says(
          "tension: for the tensions of the groups, while groups that state a force density keep it; linear: "
          "for given force densities; balanced: for force densities that balance the net where it is drawn, "
          "as well as can be, with tensions near those of the groups; constraints: any "
          "mixture of demands; elastic: for unstressed lengths, by Newton's method; dynamic_relaxation: for "
          "unstressed lengths, constant tensions and films; film: films of given stress with cables; "
          "self_stress: the drawn shape stays, and of all states of self-stress of its cables and bars the "
          "most "
          "even one is taken in which cables pull and groups carry the mean tension that they state.");
  b.choice("solver", &Options::solver,
           std::vector<std::pair<std::string, FormSolver>>{{"automatic", FormSolver::automatic},
                                                           {"smallest_norm", FormSolver::smallest_norm},
                                                           {"dense", FormSolver::dense},
                                                           {"lsqr", FormSolver::lsqr},
                                                           {"position_newton", FormSolver::position_newton},
                                                           {"fixed_point", FormSolver::fixed_point}})
      .says(
          "Method tension: Newton's method on force densities with steps of smallest norm, on positions, or "
          "the accelerated fixed point q = T/L. Method constraints: steps from a dense decomposition, from "
          "LSQR, or Newton's method on positions.");
  b.choice("jacobian", &Options::jacobian,
           std::vector<std::pair<std::string, Jacobian>>{{"consistent", Jacobian::consistent},
                                                         {"as_published", Jacobian::as_published}})
      .says(
          "Derivative of heights on a surface: its slope (quadratic convergence), or vertical equilibrium as "
          "published (linear).");
  b.key("initial_force_density", &Options::initial_force_density)
      .in("N/m")
      .above(0)
      .says("Force density to start from, or of method linear, of cables without a state of their own.");
  b.key("tolerance", &Options::tolerance)
      .above(0)
      .by_default("1e-10; dynamic_relaxation 1e-9, film 1e-8, self_stress 1e-6")
      .says(
          "Largest deviation from what is asked for over its size, or force out of balance over the "
          "largest; method self_stress: singular values below this part of the largest count as zero.");
  b.key("max_iterations", &Options::max_iterations)
      .at_least(1)
      .by_default("50 to 1000 by method; dynamic_relaxation 100000")
      .says("Most iterations.");
  b.key("condition_number", &Options::condition_number)
      .says("Estimate the condition number of the equations.");
  b.key("constant_tension", &Options::constant_tension)
      .refers("cable or bar group")
      .says("Method dynamic_relaxation: groups that keep their tension whatever their length.");
  b.choice(
       "damping", [](Options & o) -> auto& { return o.relaxation.damping; },
       std::vector<std::pair<std::string, Damping>>{{"kinetic", Damping::kinetic},
                                                    {"viscous", Damping::viscous}})
      .says("kinetic: stopped at each peak of the kinetic energy; viscous: damped critically.");
  b.key(
       "damping_ratio", [](Options & o) -> auto& { return o.relaxation.damping_ratio; })
      .above(0)
      .says("Damping viscous: part of the critical damping that is estimated.");
  b.key(
       "mass_factor", [](Options & o) -> auto& { return o.relaxation.mass_factor; })
      .at_least(1)
      .says("Method dynamic_relaxation: fictitious masses over the smallest that are stable.");
}

}  // namespace

Block form_finding_block() {
  using Options = FormFindingOptions;
  Builder b = step_builder<Options>("form_finding", "Finds the shape of a net in equilibrium: stage 1.");
  add_net_keys(b);
  add_method_keys(b);
  b.list("constraints", &Options::constraints, constraint_blocks())
      .says("Method constraints: what is asked of the net, in any mixture.");
  b.key("hold", &Options::hold)
      .refers("cable or bar group")
      .says("Method constraints: groups that keep their force densities.");
  b.list("bounds", &Options::bounds, bounds_blocks()).says("Method constraints: limits of force densities.");
  b.block("length_errors", &Options::length_errors, length_error_blocks())
      .says("Also report what errors of the cut lengths do to the net.");
  b.check(check_form_finding);
  return b.take();
}

}  // namespace tautline::deck
