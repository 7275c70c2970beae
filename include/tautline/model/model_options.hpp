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

/// What an element is. `link` stands for rigid links and hinges, which have no stiffness of their own.
enum class ElementKind { cable, bar, catenary, beam, membrane, shell, spring, mass, link };

struct MaterialOptions {
  double young_modulus = 0;      ///< [Pa]
  double poisson_ratio = 0;      ///< [-]
  double density = 0;            ///< [kg/m^3]
  double thermal_expansion = 0;  ///< [1/K]
};

/// Section of a cable, bar or catenary: axial stiffness and mass follow from material and diameter or area,
/// or are given.
struct AxialSectionOptions {
  std::string material;                     ///< empty if axial_stiffness is given
  std::optional<double> diameter, area;     ///< [m], [m^2]
  std::optional<double> axial_stiffness;    ///< E A [N]
  std::optional<double> mass_per_length;    ///< [kg/m]
  std::optional<double> thermal_expansion;  ///< of the material, if not given [1/K]
};
struct CableSectionOptions : AxialSectionOptions {};
struct BarSectionOptions : AxialSectionOptions {};
struct CatenarySectionOptions : AxialSectionOptions {};

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

/// A thin-walled square tube, sides along local axes 2 and 3.
struct SquareTubeSectionOptions {
  std::string material;
  double side = 0;       ///< between the middles of opposite walls [m]
  double thickness = 0;  ///< wall [m]
  bool shear_flexible = true;
};

/// A tube whose diameter and wall change linearly from its first to its second node.
struct TaperedTubeSectionOptions {
  std::string material;
  double diameter_start = 0, diameter_end = 0;    ///< mean diameter [m]
  double thickness_start = 0, thickness_end = 0;  ///< wall [m]
  bool shear_flexible = true;
};

/// I section of equal flanges: web along local axis 3, flanges along local axis 2.
struct ISectionOptions {
  std::string material;
  double height = 0;            ///< over both flanges [m]
  double width = 0;             ///< of the flanges [m]
  double web_thickness = 0;     ///< [m]
  double flange_thickness = 0;  ///< [m]
  bool shear_flexible = true;
};

/// Areas and second moments with a material.
struct GeneralSectionOptions {
  std::string material;
  double area = 0;                                   ///< [m^2]
  double inertia_2 = 0, inertia_3 = 0, torsion = 0;  ///< second moments about 2 and 3, torsion constant [m^4]
  double shear_factor_2 = 0, shear_factor_3 = 0;     ///< k along 2 and 3; 0: rigid in shear
};

/// Stiffnesses given directly; names as in element::BeamSection.
struct GeneralBeamSectionOptions {
  double axial_stiffness = 0, bending_stiffness_2 = 0, bending_stiffness_3 = 0, torsion_stiffness = 0;
  double shear_stiffness_2 = 0, shear_stiffness_3 = 0;  ///< 0: rigid in shear
  double mass_per_length = 0, rotary_inertia_2 = 0, rotary_inertia_3 = 0;
  double thermal_expansion = 0;  ///< [1/K]
};

/// A membrane's section: E h and mass per area, or material and thickness. Orthotropic where stiffness along
/// axis 2 and in shear are given.
struct MembraneSectionOptions {
  std::string material;                       ///< empty if tension_stiffness is given
  std::optional<double> thickness;            ///< [m]
  std::optional<double> tension_stiffness;    ///< E h, along axis 1 [N/m]
  std::optional<double> tension_stiffness_2;  ///< E2 h [N/m]
  std::optional<double> shear_stiffness;      ///< G12 h [N/m]
  std::optional<double> poisson_ratio;        ///< nu12 [-]
  std::optional<double> mass_per_area;        ///< [kg/m^2]
  std::optional<double> thermal_expansion;    ///< along axis 1, or of the material [1/K]
  std::optional<double> thermal_expansion_2;  ///< along axis 2; default as along axis 1 [1/K]
  bool wrinkling = false;
};

struct ShellSectionOptions {
  std::string material;
  double thickness = 0;             ///< [m]
  double shear_factor = 5.0 / 6.0;  ///< [-]
};

struct SpringSectionOptions {
  Vec3 stiffness = Vec3::Zero();             ///< along x, y, z [N/m]
  Vec3 rotational_stiffness = Vec3::Zero();  ///< about x, y, z [N m/rad]
};

struct MassSectionOptions {
  double mass = 0;              ///< [kg]
  Vec3 inertia = Vec3::Zero();  ///< about x, y, z [kg m^2]
};

/// The second node follows the first as if on a rigid arm.
struct RigidLinkSectionOptions {
  bool rotation = true;  ///< whether its rotation follows, too
};

/// The second node is where the first is (or at the end of a rigid arm) and turns freely about `axis`, or at
/// all.
struct HingeSectionOptions {
  std::optional<Vec3> axis;  ///< absent: a ball joint
};

using SectionOptions =
    std::variant<CableSectionOptions, BarSectionOptions, CatenarySectionOptions, RectangleSectionOptions,
                 RoundSectionOptions, TubeSectionOptions, SquareTubeSectionOptions, TaperedTubeSectionOptions,
                 ISectionOptions, GeneralSectionOptions, GeneralBeamSectionOptions, MembraneSectionOptions,
                 ShellSectionOptions, SpringSectionOptions, MassSectionOptions, RigidLinkSectionOptions,
                 HingeSectionOptions>;

/// Releases of a beam's end: which relative rotations are free, local axes 1 (torsion), 2, 3.
struct EndRelease {
  std::array<bool, 3> free{false, false, false};
  bool any() const { return free[0] || free[1] || free[2]; }
};

/// What a deck says of a group of elements (by section), or a named set of nodes (by `nodes`).
struct GroupOptions {
  std::string section;                            ///< empty for a pure node set
  std::vector<std::string> nodes;                 ///< node set: names of inline nodes
  std::vector<std::array<std::string, 2>> edges;  ///< or sides of facets, by their nodes
  // A cable's initial state: at most one of the four; a group whose tension form-finding supplies has none.
  std::optional<double> tension;            ///< [N]
  std::optional<double> unstressed_length;  ///< [m]
  std::optional<double> force_density;      ///< [N/m]
  std::optional<double> prestrain;          ///< [-]
  // Membranes and shells: initial resultant along axes 1 and 2, or the stress it comes from.
  std::optional<std::array<double, 2>> prestress;       ///< [N/m]
  std::optional<std::array<double, 2>> initial_stress;  ///< [Pa], times the section's thickness
  /// Beams: local axis 3 lies in the plane of the beam and this vector. Membranes, shells: axis 1 of material
  /// and prestress is its projection.
  std::optional<Vec3> orientation;
  EndRelease release_start, release_end;  ///< beams
  Vec3 offset_start = Vec3::Zero(),
       offset_end = Vec3::Zero();  ///< beams: from the node to the beam's end [m]
  SourceLocation where;            ///< for messages
};

struct SupportOptions {
  std::string name;
  std::vector<std::string> on;  ///< groups, selections
  std::array<bool, 6> fixed{true, true, true, true, true, true};
  Mat3 axes = Mat3::Identity();  ///< columns: directions that x, y, z of `fixed` mean
  bool symmetry = false;         ///< `fix: symmetry`
  SourceLocation where;
};

struct LoadOptions {
  std::string name;
  std::vector<std::string> on;
  // On each node.
  Vec3 force = Vec3::Zero();         ///< [N]
  Vec3 moment = Vec3::Zero();        ///< [N m]
  std::optional<Vec3> displacement;  ///< of supported directions [m]
  std::optional<Vec3> rotation;      ///< rotation vector of supported directions [rad]
  // On elements.
  std::optional<Vec3> line_force;            ///< per reference length [N/m]
  std::optional<Vec3> line_moment;           ///< per reference length [N]
  std::optional<Vec3> surface_force;         ///< per reference area [Pa]
  std::optional<double> pressure;            ///< follows the facets [Pa]
  std::optional<double> temperature_change;  ///< of groups [K]
  std::string temperature_field;             ///< the same as a formula of x, y, z; may be empty
  std::optional<Vec3> acceleration;          ///< acts on every mass [m/s^2]; needs no `on`
  SourceLocation where;

  bool nodal() const { return !force.isZero(0) || !moment.isZero(0) || displacement || rotation; }
};

/// One displacement or rotation component in a linear constraint.
struct ConstraintTermOptions {
  std::string node;
  int component = 0;  ///< 0..2: x, y, z
  double coefficient = 1;
};

/// Sum of the terms = 0.
struct ConstraintOptions {
  std::vector<ConstraintTermOptions> terms;
  SourceLocation where;
};

/// Nodes of `to` move as those of `from`, turned by `angle` about the z axis through `centre` or `axis`.
struct CyclicOptions {
  std::vector<std::string> from, to;
  double angle = 0;  ///< [degree]
  Vec3 axis = Vec3::UnitZ();
  Vec3 centre = Vec3::Zero();  ///< a point of the axis [m]
  SourceLocation where;
};

/// Inline structure: named nodes, and for each group the elements' node names (1 to 4 each).
struct InlineElements {
  std::string group;
  std::vector<std::vector<std::string>> connectivity;
  SourceLocation where;
};

struct ModelOptions {
  std::vector<std::pair<std::string, Vec3>> nodes;  ///< in deck order
  std::vector<InlineElements> elements;
  std::string mesh_file;  ///< gmsh .msh, resolved against the deck's folder; empty if none
  std::vector<ConstraintOptions> constraints;
  std::vector<CyclicOptions> cyclic;
  SourceLocation where, mesh_where;
};

}  // namespace tautline::model
