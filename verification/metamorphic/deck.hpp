#pragma once
/// @file
/// Decks as trees that can be changed: what the generators make, transformations alter and the program runs.

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <tautline/core/types.hpp>

namespace tautline::metamorphic {

using Json = nlohmann::ordered_json;

/// The deck as a user would write it.
std::string yaml(const Json& deck);

Json to_json(const Vec3& v);
Vec3 to_vec3(const Json& list);

/// A deck in the making, on `model`.
class Builder {
 public:
  Builder();
  /// A new node. @return its name
  std::string node(const Vec3& at);
  void element(const std::string& group, const std::vector<std::string>& nodes);
  /// A group of elements; a section of the same name unless `state` names one.
  void group(const std::string& name, const Json& state = Json::object());
  void section(const std::string& name, const Json& section);
  void nodes(const std::string& name, const std::vector<std::string>& list);
  void support(const std::string& on, const Json& fix, const Json& more = Json::object());
  void load(const std::string& name, const Json& load);
  void step(const Json& step);

  Json deck;
};

/// All names of loads of a deck.
std::vector<std::string> load_names(const Json& deck);
/// Groups of elements, in order.
std::vector<std::string> element_groups(const Json& deck);
/// Kind of the section of a group of elements.
std::string kind_of(const Json& deck, const std::string& group);
/// The section of a group.
const Json& section_of(const Json& deck, const std::string& group);
/// Names of the nodes that supports hold.
std::vector<std::string> supported_nodes(const Json& deck);
/// Nodes of a group or selection.
std::vector<std::string> nodes_of(const Json& deck, const std::string& name);
/// Whether a node has rotations: an end of a beam or a corner of a shell.
bool has_rotations(const Json& deck, const std::string& node);
/// Place of a node as drawn.
Vec3 place_of(const Json& deck, const std::string& node);
/// Longest distance along an axis between two nodes.
double size_of(const Json& deck);

/// About the largest axial stiffness of a section [N].
double stiffness_of(const Json& deck);

/// Takes away what refers to nothing: nodes without an element, groups, supports and loads on nothing.
void tidy(Json& deck);

}  // namespace tautline::metamorphic
