#pragma once
/// @file
/// The structure as a deck states it, before it becomes a Model: named materials, sections, groups, supports,
/// loads.

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <tautline/core/error.hpp>
#include <tautline/core/types.hpp>

namespace tautline::model {

struct MaterialOptions {
  double young_modulus = 0;  ///< [Pa]
  double poisson_ratio = 0;  ///< [-]
  double density = 0;        ///< [kg/m^3]
};

/// A cable's section: axial stiffness and mass follow from material and diameter or area, or are given.
struct CableSectionOptions {
  std::string material;                   ///< empty if axial_stiffness is given
  std::optional<double> diameter, area;   ///< [m], [m^2]
  std::optional<double> axial_stiffness;  ///< E A [N]
  std::optional<double> mass_per_length;  ///< [kg/m]
};

struct RectangleSectionOptions {
  std::string material;
  double width = 0;   ///< along local axis 2 [m]
  double height = 0;  ///< along local axis 3 [m]
  bool shear_flexible = true;
};

struct RoundSectionOptions {
  std::string material;
  double diameter = 0;  ///< [m]
  bool shear_flexible = true;
};

struct TubeSectionOptions {
  std::string material;
  double diameter = 0;   ///< mean diameter [m]
  double thickness = 0;  ///< wall [m]
  bool shear_flexible = true;
};

/// Stiffnesses given directly; names as in element::BeamSection.
struct GeneralBeamSectionOptions {
  double axial_stiffness = 0, bending_stiffness_2 = 0, bending_stiffness_3 = 0, torsion_stiffness = 0;
  double shear_stiffness_2 = 0, shear_stiffness_3 = 0;  ///< 0: rigid in shear
  double mass_per_length = 0, rotary_inertia_2 = 0, rotary_inertia_3 = 0;
};

/// A membrane's section: E h and mass per area, or material and thickness.
struct MembraneSectionOptions {
  std::string material;                     ///< empty if tension_stiffness is given
  std::optional<double> thickness;          ///< [m]
  std::optional<double> tension_stiffness;  ///< E h [N/m]
  std::optional<double> poisson_ratio;      ///< [-]
  std::optional<double> mass_per_area;      ///< [kg/m^2]
};

using SectionOptions = std::variant<CableSectionOptions, RectangleSectionOptions, RoundSectionOptions,
                                    TubeSectionOptions, GeneralBeamSectionOptions, MembraneSectionOptions>;

/// What a deck says of a group of elements (by section), or a named set of nodes (by `nodes`).
struct GroupOptions {
  std::string section;             ///< empty for a pure node set
  std::vector<std::string> nodes;  ///< node set: names of inline nodes
  // A cable's initial state: at most one of the four; a group whose tension form-finding supplies has none.
  std::optional<double> tension;            ///< [N]
  std::optional<double> unstressed_length;  ///< [m]
  std::optional<double> force_density;      ///< [N/m]
  std::optional<double> prestrain;          ///< [-]
  // Membranes: initial resultant, the same in every direction, or by direction 1/2.
  std::optional<double> prestress;  ///< [N/m]
  std::optional<Vec3> orientation;  ///< beams: local axis 3 lies in the plane of the beam and this vector
  SourceLocation where;             ///< for messages
};

struct SupportOptions {
  std::string name;
  std::vector<std::string> on;  ///< groups, selections
  std::array<bool, 6> fixed{true, true, true, true, true, true};
  SourceLocation where;
};

struct LoadOptions {
  std::string name;
  std::vector<std::string> on;
  Vec3 force = Vec3::Zero();         ///< on each node [N]
  Vec3 moment = Vec3::Zero();        ///< on each node [N m]
  std::optional<Vec3> acceleration;  ///< acts on every mass [m/s^2]; needs no `on`
  SourceLocation where;
};

/// Inline structure: named nodes, and for each group the elements' node names (2 or 3 each).
struct InlineElements {
  std::string group;
  std::vector<std::vector<std::string>> connectivity;
  SourceLocation where;
};

struct ModelOptions {
  std::vector<std::pair<std::string, Vec3>> nodes;  ///< in deck order
  std::vector<InlineElements> elements;
  std::string mesh_file;  ///< gmsh .msh, resolved against the deck's folder; empty if none
  SourceLocation where, mesh_where;
};

}  // namespace tautline::model
