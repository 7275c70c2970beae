#include <deck/keywords.hpp>
#include <deck/scalars.hpp>
#include <deck/step_builder.hpp>
#include <tautline/core/text.hpp>

#include <fmt/format.h>

namespace tautline::deck {

namespace {

using namespace steps;

const std::vector<std::string>& target_words() {
  static const std::vector<std::string> words{"x", "y", "z", "radius", "meridian"};
  return words;
}

void check_not_empty(Reader& reader, const Node& node, const char* key, const char* what) {
  const Node* list = node.find(key);
  if (list != nullptr && list->is_sequence() && list->items.empty())
    reader.complain(list->label, fmt::format("\"{}\" is an empty list", key), reader.context(), what);
}

const BlockSet& target_blocks() {
  static const BlockSet set = [] {
    using Options = InverseTargetOptions;
    BlockBuilder<Options> b("steps.inverse.targets", "",
                            "Where nodes are wanted; what is not asked for stays free.");
    b.key("on", &Options::on)
        .required()
        .refers("group")
        .says("Groups or selections, each of whose nodes is asked for the same.");
    b.key("x", &Options::x).in("m").says("Coordinate x.");
    b.key("y", &Options::y).in("m").says("Coordinate y.");
    b.key("z", &Options::z).in("m").says("Coordinate z.");
    b.key("radius", &Options::radius).in("m").above(0).says("Distance from the z axis.");
    b.block("meridian", &Options::meridian, target_meridian_blocks())
        .says("The nodes lie on the surface z = F(distance from the z axis), anywhere.");
    b.key("weight", &Options::weight)
        .above(0)
        .says("Factor of the misses; more counts more where not all targets can be met.");
    b.check([](Reader& reader, const Node& node, Options&) {
      check_not_empty(reader, node, "on",
                      "expected the groups or selections whose nodes are wanted somewhere");
      for (const auto& word : target_words())
        if (node.find(word) != nullptr) return;
      reader.complain(node.label, "a target without a place", reader.context(),
                      "expected one or more of: " + join(target_words()));
    });
    return BlockSet{"steps.inverse.targets", "Where nodes are wanted.", {b.take()}, {}};
  }();
  return set;
}

const BlockSet& unknown_blocks() {
  static const BlockSet set = [] {
    using Options = InverseUnknownOptions;
    BlockBuilder<Options> b("steps.inverse.unknowns", "", "Cables that may be changed.");
    b.key("on", &Options::on)
        .required()
        .refers("group")
        .says("Groups or selections of cables, bars, catenaries.");
    b.choice("quantity", &Options::quantity,
             std::vector<std::pair<std::string, Options::Quantity>>{
                 {"unstressed_length", Options::Quantity::unstressed_length},
                 {"axial_stiffness", Options::Quantity::axial_stiffness}})
        .says("What of them may be changed.");
    b.choice("each", &Options::each,
             std::vector<std::pair<std::string, Options::Each>>{{"group", Options::Each::group},
                                                                {"cable", Options::Each::cable}})
        .says("group: one factor for all cables of a name in `on`; cable: one for every cable.");
    b.key("min", &Options::min)
        .in("m or N")
        .above(0)
        .by_default("a thousandth of the start")
        .says("Least value of the quantity.");
    b.key("max", &Options::max)
        .in("m or N")
        .above(0)
        .by_default("no limit")
        .says("Greatest value of the quantity.");
    b.check([](Reader& reader, const Node& node, Options& options) {
      check_not_empty(reader, node, "on", "expected the groups or selections of cables that may be changed");
      if (options.min && options.max && *options.max <= *options.min)
        reader.complain(*node.find("max"),
                        fmt::format("max = {} is not above min = {}", format_number(*options.max),
                                    format_number(*options.min)));
    });
    return BlockSet{"steps.inverse.unknowns", "Cables that may be changed.", {b.take()}, {}};
  }();
  return set;
}

}  // namespace

Block inverse_block() {
  using Options = InverseOptions;
  auto b = step_builder<Options>("inverse",
                                 "Finds unstressed lengths or stiffnesses of cables with which nodes are in "
                                 "equilibrium where they are wanted: least squares where not all can be met, "
                                 "the least change where many can meet them.");
  b.list("targets", &Options::targets, target_blocks()).required().says("Where nodes are wanted.");
  b.list("unknowns", &Options::unknowns, unknown_blocks()).required().says("Cables that may be changed.");
  b.key("tolerance", &Options::tolerance)
      .in("m")
      .above(0)
      .says("Targets are met when the largest miss, times its weight, is no larger.");
  b.key("rank_tolerance", &Options::rank_tolerance)
      .above(0)
      .below(1)
      .says("Singular values of the sensitivities below this part of the largest count as zero.");
  b.key("max_iterations", &Options::max_iterations).at_least(1).says("Most iterations.");
  b.check([](Reader& reader, const Node& node, Options&) {
    check_not_empty(reader, node, "targets", "expected one target at least");
    check_not_empty(reader, node, "unknowns", "expected one entry at least");
  });
  return b.take();
}

}  // namespace tautline::deck
