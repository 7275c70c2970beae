#pragma once
/// @file
/// What is possible but hardly meant: slips of the pen that an analysis would take at their word. Units of
/// the deck are SI; whether a figure is far outside any structure is asked only where stiffness and mass say
/// that lengths are metres, so that decks without units or in others are left in peace. Theory and limits:
/// docs/adr/0024-doubts.md

#include <map>
#include <string>
#include <vector>

#include <tautline/model/model.hpp>
#include <tautline/model/response.hpp>

namespace tautline::model {

/// One thing to be looked at: `code` for programs, `where` a group, load or material.
struct Doubt {
  std::string code, message, where;
};

/// Materials and sections of a deck, by name.
struct Stock {
  std::map<std::string, MaterialOptions> materials;
  std::map<std::string, SectionOptions> sections;
};

/// Materials, sections, sizes, initial strains and loads.
std::vector<Doubt> input_doubts(const Model& model, const Stock& stock);

/// Sums of changes of temperature under the loads of these names that act together.
std::vector<Doubt> temperature_doubts(const Model& model, const std::vector<std::string>& loads);

/// @brief How elements lie to each other: the same nodes twice; nodes at one place, or nearly, that nothing
/// joins; members that pass through each other or through a node that they have no part in; very short
/// members; facets under one pressure that face different sides. O(n log n) for elements of like size.
std::vector<Doubt> geometry_doubts(const Model& model);

/// @brief What an equilibrium asks of members: strains that no material bears, compression beyond what a
/// beam carries between its two nodes without bowing out, which one element cannot do.
std::vector<Doubt> state_doubts(const Model& model, const Response& response);

/// Strain of each cable, bar and catenary; of each beam the larger one of stretching and of bending at the
/// radius of gyration. Absolute values.
struct LineStrains {
  std::vector<double> cables, beams;
};
LineStrains line_strains(const Model& model, const Response& response);

/// Compression of each beam over the Euler load of its own length between hinged ends, pi^2 E I / L^2; zero
/// in tension.
std::vector<double> euler_ratios(const Model& model, const Response& response);

}  // namespace tautline::model
