#include <deck/keywords.hpp>
#include <deck/step_builder.hpp>

namespace tautline::deck {

namespace {

using namespace steps;

void read_counts(Reader& reader, const Keyword& keyword, const Node& node, MeshOptions& options) {
  if (!reader.expect(Node::Kind::mapping, keyword, node)) return;
  const Reader::Step path(reader, keyword.name);
  reader.check_duplicates(node);
  Keyword count = keyword;
  count.type = Type::integer;
  for (const auto& entry : node.entries) {
    count.name = entry.key;
    reader.refer_key("line group", entry);
    if (const auto value = reader.integer(count, entry.value))
      options.subdivide.group_subdivisions[entry.key] = *value;
  }
}

void check_mesh(Reader& reader, const Node& node, MeshOptions& options) {
  const auto& subdivide = options.subdivide;
  const Node* parts = node.find("subdivisions");
  if (subdivide.pattern != model::FacetPattern::mapped || subdivide.subdivisions % 2 == 0) return;
  const Node& place = parts != nullptr ? *parts : *node.find("pattern");
  reader.complain(place, fmt::format("subdivisions = {} is odd", subdivide.subdivisions),
                  "expected an even number for pattern mapped");
}

const BlockSet& tube_blocks() {
  static const BlockSet set = [] {
    using Options = model::TubeShellOptions;
    BlockBuilder<Options> b(
        "steps.mesh.tubes_as_shells", "",
        "Thin tubes as shells in place of beams, joined by rigid rings at the beams' ends.");
    b.key("groups", &Options::groups)
        .refers("beam group")
        .required()
        .says("Groups of beams with a section of kind tube or tapered_tube.");
    b.key("around", &Options::around).at_least(20).says("Shell elements round each tube.");
    b.key("along", &Options::along).at_least(1).says("Shell elements along each beam.");
    return BlockSet{"steps.mesh.tubes_as_shells", "Thin tubes as shells.", {b.take()}, {}};
  }();
  return set;
}

Block make_mesh() {
  using Pattern = model::FacetPattern;
  auto b = step_builder<MeshOptions>("mesh",
                                     "Divides facets, the cables along them and beams into finite elements.");
  b.key(
       "subdivisions", [](MeshOptions & o) -> auto& { return o.subdivide.subdivisions; })
      .at_least(1)
      .says(
          "Parts of each facet side, of the cables on it and of the beams; of other cables if they are "
          "longer "
          "than drawn, or if there are neither facets nor beams.");
  b.choice(
       "pattern", [](MeshOptions & o) -> auto& { return o.subdivide.pattern; },
       std::vector<std::pair<std::string, Pattern>>{{"structured", Pattern::structured},
                                                    {"mapped", Pattern::mapped}})
      .says(
          "structured: similar triangles; mapped: three mapped patches around the centroid, for even "
          "subdivisions.");
  b.custom("group_subdivisions", Type::counts, read_counts)
      .at_least(1)
      .says("Other numbers of parts for cable or beam groups.");
  b.block(
       "tubes_as_shells", [](MeshOptions & o) -> auto& { return o.subdivide.tubes; }, tube_blocks())
      .says("Models thin round tubes by shells; the beams of these groups are then no more.");
  b.check(check_mesh);
  return b.take();
}

void check_tuning(Reader& reader, const Node& node, TuningStepOptions& options) {
  const auto& tuning = options.tuning;
  if (tuning.method == reflector::TuningMethod::rule)
    for (const char* key : {"objective", "tension_min", "tension_max", "regularisation"})
      if (const Node* value = node.find(key))
        reader.complain(value->label, fmt::format("\"{}\" has no effect with method rule", key),
                        reader.context(), {}, "it belongs to method: sensitivity");
  if (const Node* high = node.find("tension_max");
      high != nullptr && tuning.tension_max <= tuning.tension_min)
    reader.complain(*high, fmt::format("tension_max = {} is not above tension_min = {}",
                                       format_number(tuning.tension_max), format_number(tuning.tension_min)));
}

Block make_tuning() {
  using Method = reflector::TuningMethod;
  using Objective = reflector::TuningObjective;
  auto b = step_builder<TuningStepOptions>(
      "tuning",
      "Changes the unstressed lengths of ties, or of other cables, until the surface is as good as it gets.");
  b.choice(
       "method", [](TuningStepOptions & o) -> auto& { return o.tuning.method; },
       std::vector<std::pair<std::string, Method>>{{"rule", Method::rule},
                                                   {"sensitivity", Method::sensitivity}})
      .says(
          "rule: each tie shortened by the deviation of its front node; sensitivity: least squares with the "
          "influence of every tie.");
  b.choice(
       "objective", [](TuningStepOptions & o) -> auto& { return o.tuning.objective; },
       std::vector<std::pair<std::string, Objective>>{{"nodes", Objective::nodes}, {"area", Objective::area}})
      .says("Method sensitivity: surface error over nodes or weighted by area.");
  b.key(
       "ties", [](TuningStepOptions & o) -> auto& { return o.tuning.ties; })
      .refers("cable group")
      .by_default("ties")
      .says(
          "Cable groups that are tuned: with rule those of which each cable begins at a front node, with "
          "sensitivity any.");
  b.key(
       "max_passes", [](TuningStepOptions & o) -> auto& { return o.tuning.max_passes; })
      .at_least(1)
      .says("Most passes.");
  b.key(
       "tolerance", [](TuningStepOptions & o) -> auto& { return o.tuning.tolerance; })
      .above(0)
      .says("Stop when the error changes by less than this part of itself.");
  b.key(
       "tension_min", [](TuningStepOptions & o) -> auto& { return o.tuning.tension_min; })
      .in("N")
      .at_least(0)
      .by_default("half of the least tie tension when the tuning begins")
      .says("Method sensitivity: least tension of a tie.");
  b.key(
       "tension_max", [](TuningStepOptions & o) -> auto& { return o.tuning.tension_max; })
      .in("N")
      .above(0)
      .by_default("no limit")
      .says("Method sensitivity: greatest tension of a tie.");
  b.key(
       "regularisation", [](TuningStepOptions & o) -> auto& { return o.tuning.regularisation; })
      .at_least(0)
      .says(
          "Method sensitivity: weight of tie-tension changes beside the surface error; less reaches a "
          "smaller "
          "error by larger and less even tensions.");
  b.key(
       "max_change", [](TuningStepOptions & o) -> auto& { return o.tuning.max_change; })
      .in("m")
      .above(0)
      .by_default("no limit")
      .says("Largest change of an unstressed length in one pass.");
  b.check(check_tuning);
  return b.take();
}

Block make_modal() {
  auto b = step_builder<ModalOptions>(
      "modal", "Natural frequencies and modes about the present state, with its prestress.");
  b.key("modes", &ModalOptions::modes).at_least(1).says("Number of modes, from the lowest frequency.");
  b.choice("mass", &ModalOptions::mass,
           std::vector<std::pair<std::string, assembly::MassKind>>{
               {"consistent", assembly::MassKind::consistent}, {"lumped", assembly::MassKind::lumped}})
      .says("Mass matrix: consistent with the shape functions, or lumped at the nodes.");
  return b.take();
}

void check_rod_shaping(Reader& reader, const Node& node, RodShapingOptions& options) {
  const auto useless = [&](const char* key, const std::string& with, const std::string& home) {
    if (const Node* value = node.find(key))
      reader.complain(value->label, fmt::format("\"{}\" has no effect with {}", key, with), reader.context(),
                      {}, "it belongs to " + home);
  };
  const bool exact = options.method == RodShapingOptions::Method::exact;
  if (exact)
    for (const char* key : {"shortening", "solver"}) useless(key, "method exact", "method: cantilevers");
  else
    for (const char* key : {"form", "min_step"}) useless(key, "method cantilevers", "method: exact");
  const Node* reaction = node.find("reaction");
  if (reaction != nullptr && node.find("stiffness") != nullptr)
    reader.complain(reaction->label, "both \"stiffness\" and \"reaction\" are given", reader.context(),
                    "expected one of them: cables that stretch, or constant forces");
  if (reaction == nullptr) useless("start_angle", "cables", "a step with reaction");
  if (reaction != nullptr) {
    for (const char* key : {"form", "min_step", "solver"}) useless(key, "given forces", "a step with cables");
  } else if (node.find("stiffness") != nullptr) {
    if (exact) useless("form", "given stiffnesses", "a step that looks for them");
    if (!exact) useless("solver", "given stiffnesses", "a step that looks for them");
  } else if (exact) {
    useless("min_step", "stiffnesses to be found", "a step with stiffness");
  }
}

Block make_rod_shaping() {
  using Options = RodShapingOptions;
  auto b = step_builder<Options>(
      "rod_shaping",
      "On a rod-umbrella: finds the cables that bend the rods to the meridian; or, with "
      "`stiffness`, the shape "
      "that given cables bend them to.");
  b.choice("method", &Options::method,
           std::vector<std::pair<std::string, Options::Method>>{
               {"exact", Options::Method::exact}, {"cantilevers", Options::Method::cantilevers}})
      .says(
          "exact: inextensible rod; cantilevers: one element for each link, Russkikh & Shklyarchuk (2021).");
  b.choice(
       "form", [](Options & o) -> auto& { return o.exact.form; },
       std::vector<std::pair<std::string, rod::ExactForm>>{{"a", rod::ExactForm::nodes_on_surface},
                                                           {"b", rod::ExactForm::nodes_on_target}})
      .says(
          "Method exact: a: lengths as given, nodes anywhere on the surface; b: nodes where the meridian has "
          "them, lengths found.");
  b.choice(
       "shortening", [](Options & o) -> auto& { return o.cantilevers.shortening; },
       std::vector<std::pair<std::string, rod::Shortening>>{{"consistent", rod::Shortening::consistent},
                                                            {"as_published", rod::Shortening::as_published}})
      .says("Method cantilevers: shortening of a bent link as integrated, or with the printed coefficients.");
  b.choice(
       "solver", [](Options & o) -> auto& { return o.cantilevers.method; },
       std::vector<std::pair<std::string, rod::CantileverMethod>>{
           {"newton", rod::CantileverMethod::newton}, {"successive", rod::CantileverMethod::successive}})
      .says(
          "Method cantilevers: Newton's method, or the published iteration, which diverges for many links.");
  b.key("stiffness", &Options::stiffness)
      .in("N")
      .at_least(0)
      .by_default("none: they are found")
      .says(
          "Stiffness E F of the cables, from the root outwards; the rods are turned to the stop with them.");
  b.key("reaction", &Options::reaction)
      .in("N")
      .by_default("none: cables pull")
      .says(
          "Constant forces on the nodes towards the axis, from the root outwards, in place of cables; the "
          "root is "
          "at the stop.");
  b.key("start_angle", &Options::start_angle)
      .in("degree")
      .at_least(-360)
      .at_most(360)
      .says(
          "With `reaction`: by how much the rod bends from root to tip in the shape from which the search "
          "begins; "
          "a buckled shape needs it.");
  b.key("tolerance", &Options::tolerance)
      .above(0)
      .by_default("1e-10 (exact), 1e-9 (cantilevers)")
      .says("Largest change in the last iteration, relative (exact), of an angle in rad (cantilevers).");
  b.key("max_iterations", &Options::max_iterations)
      .at_least(1)
      .by_default("50 (exact), 2000 (cantilevers)")
      .says("Most iterations; Newton's method stops after 50 at most.");
  b.key(
       "min_step", [](Options & o) -> auto& { return o.exact.min_step; })
      .above(0)
      .below(1)
      .says("Method exact with `stiffness`: smallest step on the way to the stop.");
  b.check(check_rod_shaping);
  return b.take();
}

}  // namespace

const BlockSet& step_blocks() {
  static const BlockSet set{
      "steps",
      "Steps in order; `kind` says what is done.",
      {form_finding_block(), make_mesh(), equilibrium_block(), make_tuning(), make_modal(), buckling_block(),
       collapse_block(), make_rod_shaping(), inverse_block()},
      {}};
  return set;
}

}  // namespace tautline::deck
