#pragma once
/// @file
/// What concerns several blocks of a deck: names that must exist, groups that must fit their sections and
/// steps.

#include <deck/node.hpp>
#include <deck/reader.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tautline/deck/deck.hpp>
#include <tautline/model/model_options.hpp>
#include <vector>

namespace tautline::deck {

using Member = model::ElementKind;
/// "cables", "beams", ...
std::string to_string(Member member);
/// Cable, bar or catenary.
bool is_line_with_state(Member member);

/// The names of a deck, as far as they can be known without building the structure.
class Names {
 public:
  Names(const Deck& deck, const Node& root);

  /// Whether the element groups are unknown here (they are in a mesh file, or in a faulty block).
  bool open() const { return open_; }
  /// Element groups the reflector or the model defines.
  const std::vector<std::string>& element_groups() const { return element_groups_; }
  bool defines(const std::string& group) const;
  /// Whether the deck must give the group a section.
  bool needs_section(const std::string& group) const { return optional_groups_.count(group) == 0; }
  /// What the reflector's group is made of; nothing for other structures.
  std::optional<Member> required_member(const std::string& group) const;
  /// What a group is made of by the kind of its section; nothing if that cannot be told.
  std::optional<Member> member(const std::string& group) const;
  /// The names a reference of this kind (material, section, group, cable group, ...) can mean.
  const std::vector<std::string>& known(const std::string& kind) const { return known_.at(kind); }
  /// Where those names stand, e.g. "materials, line 12".
  std::string home(const std::string& kind) const;
  bool is_known(const std::string& kind, const std::string& name) const;
  /// What the user may have meant by an unknown name, or "".
  std::string remedy(const std::string& kind, const std::string& name) const;

 private:
  void describe_reflector(const Deck& deck);
  void collect();
  /// The number k of "strut_<k>" or "spoke_<k>" of a reflector, or -1.
  int number_of(const std::string& name) const;
  bool contains(const std::string& kind, const std::string& name) const;

  const Node& root_;
  bool is_reflector_ = false;  ///< a dish with nets
  const rod::UmbrellaOptions* umbrella_ = nullptr;
  std::map<std::string, Member> reflector_groups_;
  std::vector<std::string> selections_;  ///< of a reflector
  std::string numbered_;  ///< strut_ or spoke_: selections strut_0, strut_1, ... of a reflector
  int n_numbered_ = 0;
  bool open_ = false;
  std::set<std::string> optional_groups_;
  std::vector<std::string> element_groups_;
  std::map<std::string, std::vector<std::string>> known_;             ///< kind -> names in deck order
  std::map<std::string, std::set<std::string, std::less<>>> lookup_;  ///< the same, for finding
};

/// Unknown names. A name in the wrong place is left to check_groups and check_steps.
void check_references(const Names& names, Reader& reader);
/// Groups: defined, with fitting section and initial state.
void check_groups(const Deck& deck, const Names& names, const Node& root, Reader& reader);
/// Steps: nets, ties, names; fills in names left out.
void check_steps(Deck& deck, const Names& names, const Node& root, Reader& reader);
/// Inline elements and the mesh file.
void check_model(Deck& deck, const Names& names, const Node& root, Reader& reader);

}  // namespace tautline::deck
