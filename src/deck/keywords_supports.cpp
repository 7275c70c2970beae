#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <deck/builder.hpp>
#include <deck/keywords.hpp>
#include <tautline/core/expression.hpp>
#include <tautline/core/text.hpp>
#include <tautline/model/model_options.hpp>

namespace tautline::deck {

namespace {

constexpr std::array<const char*, 6> directions{"x", "y", "z", "rx", "ry", "rz"};

/// all, pinned, symmetry, or a list of directions.
void read_fix(Reader& reader, const Keyword& keyword, const Node& node, model::SupportOptions& options) {
  if (node.is_scalar() && (node.text == "all" || node.text == "pinned")) {
    for (std::size_t i = 0; i < 6; ++i) options.fixed[i] = i < 3 || node.text == "all";
    return;
  }
  if (node.is_scalar() && node.text == "symmetry") {
    options.fixed = {true, false, false, false, true, true};
    options.symmetry = true;
    return;
  }
  if (node.is_scalar())
    return reader.wrong_value(keyword, node, "is no known support",
                              did_you_mean(node.text, {"all", "pinned", "symmetry"}));
  if (!reader.expect(Node::Kind::sequence, keyword, node)) return;
  if (node.items.empty()) return reader.wrong_value(keyword, node, "is an empty list");
  options.fixed.fill(false);
  for (const auto& item : node.items) {
    const auto* found =
        std::find_if(directions.begin(), directions.end(), [&](const char* d) { return item.text == d; });
    if (found == directions.end())
      reader.complain(item, fmt::format("unknown direction \"{}\"", item.text),
                      "expected any of: x, y, z, rx, ry, rz");
    else
      options.fixed[static_cast<std::size_t>(found - directions.begin())] = true;
  }
}

void check_not_empty(Reader& reader, const Node& node) {
  if (const Node* on = node.find("on"); on != nullptr && on->is_sequence() && on->items.empty())
    reader.complain(*on, "\"on\" is an empty list", "expected at least one group or selection");
}

/// Unit vector normal to a unit vector and horizontal; [0, 1, 0] where that is vertical but for rounding.
Vec3 horizontal_normal(const Vec3& e1) {
  constexpr double rounding = 1e-10;
  if (std::hypot(e1.x(), e1.y()) < rounding) return Vec3::UnitY();
  return Vec3::UnitZ().cross(e1).normalized();
}

/// Axes from a first direction and a second in the plane of the first two.
void set_axes(Reader& reader, const Node& node, model::SupportOptions& options) {
  const Node *x = node.find("x_axis"), *y = node.find("y_axis");
  if (x == nullptr) {
    if (y != nullptr) reader.complain(y->label, "\"y_axis\" needs \"x_axis\"", reader.context());
    return;
  }
  const Vec3 first = options.axes.col(0), second = options.axes.col(1);
  if (first.isZero(0))
    return reader.complain(*x, "x_axis has no direction", "expected a vector that is not zero");
  const Vec3 e1 = first.normalized();
  Vec3 across = y != nullptr ? second : horizontal_normal(e1);
  across -= e1 * e1.dot(across);
  if (across.norm() <= 1e-9 * second.norm())
    return reader.complain(*y, "y_axis is parallel to x_axis", "expected another direction");
  const Vec3 e2 = across.normalized();
  options.axes << e1, e2, e1.cross(e2);
}

Block make_support() {
  using Options = model::SupportOptions;
  BlockBuilder<Options> b("supports", "", "Nodes that cannot move.");
  b.key("name", &Options::name).by_default("support and its number").says("Name for messages and results.");
  b.key("on", &Options::on).required().refers("group").says("Groups or selections whose nodes are fixed.");
  b.custom("fix", Type::directions, read_fix)
      .by_default("all")
      .says(
          "Fixed directions: all (displacements and rotations), pinned (x, y, z), symmetry (x, ry, rz: a "
          "plane of symmetry normal to x, beyond which shells go on as their mirror image, normals "
          "included), or a list. Of rotations those components of the node's rotation vector are held: what "
          "is left free is a rotation vector along the other axes.");
  b.custom("x_axis", Type::vector,
           [](Reader& reader, const Keyword& keyword, const Node& node, Options& options) {
             if (const auto v = reader.vector(keyword, node)) options.axes.col(0) = *v;
           })
      .by_default("[1, 0, 0]")
      .says("Direction that x means in `fix`.");
  b.custom("y_axis", Type::vector,
           [](Reader& reader, const Keyword& keyword, const Node& node, Options& options) {
             if (const auto v = reader.vector(keyword, node)) options.axes.col(1) = *v;
           })
      .by_default("horizontal and normal to x_axis (z x x_axis); [0, 1, 0] if that is vertical")
      .says("A direction in the plane of x and y; needs `x_axis`.");
  b.check([](Reader& reader, const Node& node, Options& options) {
    check_not_empty(reader, node);
    set_axes(reader, node, options);
  });
  return b.take();
}

constexpr double most_rotation = 1e4;  // a thousand turns and more: they are followed in parts

/// What a load can be, in the order of the table.
const std::vector<std::string>& load_kinds() {
  static const std::vector<std::string> words{
      "force",         "moment",   "displacement",       "rotation",          "line_force",  "line_moment",
      "surface_force", "pressure", "temperature_change", "temperature_field", "acceleration"};
  return words;
}

void check_temperature_field(Reader& reader, const Node& node, const model::LoadOptions& options) {
  if (options.temperature_field.empty()) return;
  try {
    const SpaceFormula checked(options.temperature_field);
  } catch (const std::invalid_argument& error) {
    reader.complain(
        *node.find("temperature_field"),
        fmt::format("\"{}\" is no formula: {}", options.temperature_field, error.what()),
        "expected a formula of x, y, z with + - * / ^, parentheses, pi and functions as sqrt or cos");
  }
}

void check_load(Reader& reader, const Node& node, model::LoadOptions& options) {
  check_not_empty(reader, node);
  check_temperature_field(reader, node, options);
  const Node* acceleration = node.find("acceleration");
  int given = 0;
  for (const auto& word : load_kinds()) given += node.find(word) != nullptr;
  if (given == 0)
    reader.complain(node.label, "a load of nothing", reader.context(),
                    "expected one of: " + join(load_kinds()));
  const bool needs_place = given > (acceleration != nullptr ? 1 : 0);
  if (needs_place && node.find("on") == nullptr)
    reader.complain(node.label, "missing key \"on\"", reader.context(),
                    "expected the groups or selections that are loaded");
  if (acceleration != nullptr && !needs_place && node.find("on") != nullptr)
    reader.complain(*node.find("on"), "\"on\" has no effect: an acceleration acts on every mass");
}

Block make_load() {
  using Options = model::LoadOptions;
  BlockBuilder<Options> b("loads", "", "A load, ramped up from zero; all but pressure keep their direction.");
  b.key("name", &Options::name).required().says("Name; steps refer to it.");
  b.key("on", &Options::on).refers("group").says("Groups or selections whose nodes or elements are loaded.");
  b.key("force", &Options::force).in("N").by_default("[0, 0, 0]").says("Force on each node.");
  b.key("moment", &Options::moment).in("N m").by_default("[0, 0, 0]").says("Moment on each node.");
  b.key("displacement", &Options::displacement)
      .in("m")
      .says(
          "How far each node is moved from its place in the reference configuration; a support must hold it "
          "in every "
          "direction that is not 0. It stays there until another motion.");
  b.key("rotation", &Options::rotation)
      .in("rad")
      .at_least(-most_rotation)
      .at_most(most_rotation)
      .says(
          "Rotation vector by which each node is turned from its reference, any number of turns about an "
          "axis; a support must hold it. It takes the place of an earlier one and stays there until another. "
          "Where the support leaves rotations free, they come after it.");
  b.key("line_force", &Options::line_force)
      .in("N/m")
      .says("Force per drawn length of beams, cables, bars and edges.");
  b.key("line_moment", &Options::line_moment).in("N").says("Moment per drawn length of beams and edges.");
  b.key("surface_force", &Options::surface_force)
      .in("Pa")
      .says("Force per drawn area of membranes and shells, of constant direction.");
  b.key("pressure", &Options::pressure)
      .in("Pa")
      .says(
          "Pressure on membranes and shells: along their normal by the order of their nodes, which it "
          "follows.");
  b.key("temperature_change", &Options::temperature_change)
      .in("K")
      .also_called({"temperature"})
      .says("Change of temperature of the groups in `on`.");
  b.key("temperature_field", &Options::temperature_field)
      .in("K")
      .by_default("none")
      .says(
          "Change of temperature of the groups in `on` by place: a formula of the drawn coordinates x, y, z "
          "[m], e.g. \"20 + 10*x\". Every element of the mesh takes the mean over itself; over the section "
          "of a "
          "beam it goes linearly, with the slope of the formula in the beam's middle; through a shell it is "
          "even.");
  b.key("acceleration", &Options::acceleration)
      .in("m/s^2")
      .says("Acceleration that acts on every mass, e.g. gravity [0, 0, -9.81]; needs no `on`.");
  b.check(check_load);
  return b.take();
}

}  // namespace

const BlockSet& support_blocks() {
  static const BlockSet set{"supports", "Supports.", {make_support()}, {}};
  return set;
}

const BlockSet& load_blocks() {
  static const BlockSet set{"loads", "Loads.", {make_load()}, {}};
  return set;
}

}  // namespace tautline::deck
