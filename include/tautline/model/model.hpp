#pragma once
/// @file
/// What is analysed: nodes, elements in named groups, supports and loads. Plain data, the same on every rank;
/// the structure as described and its finite-element mesh are both a Model (the second by model::subdivide).

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <tautline/core/types.hpp>
#include <tautline/element/beam.hpp>
#include <tautline/element/membrane.hpp>
#include <tautline/element/shell.hpp>
#include <tautline/element/spring.hpp>
#include <tautline/model/facet.hpp>
#include <tautline/model/model_options.hpp>

namespace tautline::model {

struct CableSection {
  double axial_stiffness = 0;  ///< E A [N]
  double mass_per_length = 0;  ///< per unstressed length [kg/m]
};

/// A round tube, whose dimensions may change from its start to its end: what a section at a place along it
/// follows from.
struct TaperedTube {
  std::array<double, 2> diameter{0, 0};   ///< mean diameter at start and end [m]
  std::array<double, 2> thickness{0, 0};  ///< [m]
  MaterialOptions material;
  bool shear_flexible = true;
};

struct PointMass {
  double mass = 0;              ///< [kg]
  Vec3 inertia = Vec3::Zero();  ///< about x, y, z [kg m^2]
};

/// Elements of one kind with one section. Every element belongs to exactly one group, by index into
/// Model::groups.
struct Group {
  std::string name;
  ElementKind kind = ElementKind::cable;
  CableSection cable;                 ///< valid where kind == cable, bar, catenary
  element::BeamSection beam;          ///< valid where kind == beam; of a tapered one, at its middle
  std::optional<TaperedTube> taper;   ///< beams that are not prismatic
  std::optional<TaperedTube> tube;    ///< beams that are round tubes, prismatic or not
  element::MembraneSection membrane;  ///< valid where kind == membrane
  element::ShellSection shell;        ///< valid where kind == shell
  element::SpringProperties spring;   ///< valid where kind == spring
  PointMass mass;                     ///< valid where kind == mass
  double thermal_expansion = 0;       ///< of cables, bars, catenaries and beams [1/K]
  Vec3 orientation = Vec3::Zero();    ///< beams: local axis 3 lies in the plane of the beam and this vector;
                                    ///< membranes and shells: axis 1 of material and prestress lies along it
  double target_tension = 0;  ///< cables: tension asked of form-finding [N]; 0 if none
};

/// Whether elements of the kind are kept in Model::cables.
constexpr bool is_cable_like(ElementKind kind) {
  return kind == ElementKind::cable || kind == ElementKind::bar || kind == ElementKind::catenary;
}

/// A cable, bar or catenary, by the kind of its group.
struct Cable {
  std::array<int, 2> nodes;
  int group = 0;
  double initial_strain = 0;      ///< l_ref / L0 - 1, see element::CableProperties
  int parent = 0;                 ///< index of the cable in the structure before subdivision
  double stiffness_factor = 1;    ///< its E A over that of the group
  double temperature_change = 0;  ///< mean, from the reference temperature, at present [K]
  Vec3 line_load = Vec3::Zero();  ///< of a catenary: dead load per drawn length at present, no weight [N/m]
};

struct Beam {
  std::array<int, 2> nodes;
  int group = 0;
  Mat3 frame = Mat3::Identity();  ///< reference frame, columns local axes
  int parent = 0;
  std::array<double, 2> span{0, 1};   ///< place of its ends along the beam before subdivision, 0 to 1
  Vec3 line_load = Vec3::Zero();      ///< distributed dead load at present, weight included [N/m]
  Vec<2> temperature_gradient{0, 0};  ///< along local axes 2 and 3, at present [K/m]
  double temperature_change = 0;      ///< mean, from the reference temperature, at present [K]
};

struct Membrane {
  FacetNodes nodes;
  int group = 0;
  Vec3 prestress = Vec3::Zero();  ///< N11, N22, N12 in element::membrane_frame [N/m]
  int parent = 0;
  double temperature_change = 0;  ///< mean, from the reference temperature, at present [K]
};

struct Shell {
  FacetNodes nodes;
  int group = 0;
  Vec3 prestress = Vec3::Zero();  ///< N11, N22, N12 in element::shell_frame [N/m]
  int parent = 0;
  std::array<Vec3, 4> director;   ///< unit normals of the mid-surface at the nodes, see find_directors
  double temperature_change = 0;  ///< mean, from the reference temperature, at present [K]
};

/// A spring between two nodes, or from the ground to one.
struct Spring {
  std::vector<int> nodes;
  int group = 0;
  bool grounded() const { return nodes.size() == 1; }
};

struct MassElement {
  std::array<int, 1> nodes;
  int group = 0;
};

/// @brief A node that follows another through a rigid arm.
///
/// The follower's displacement is that of the arm's end; its rotation is the leader's, or turned against it
/// about the axes of `hinge`, or free.
struct Link {
  int leader = 0, follower = 0;
  bool rotation_free = false;
  /// Axes of free relative rotation in the reference configuration; at most three, in order of rotation from
  /// the leader's side; none: rotation tied.
  std::vector<Vec3> hinge;
  int group = -1;  ///< of a rigid link or hinge; -1: the end of a beam
};

/// Follower = turn x leader, displacements and rotations: sectors of a cyclic structure.
struct CyclicPair {
  int leader = 0, follower = 0;
  Mat3 turn = Mat3::Identity();
};

/// Sum of coefficient x displacement component = 0; the first term's component follows from the others.
struct LinearConstraint {
  struct Term {
    int node = 0, component = 0;
    double coefficient = 0;
  };
  std::vector<Term> terms;
  SourceLocation where;  ///< in the deck, for messages
};

/// A named selection of nodes and elements; groups are selections by themselves and need none.
struct Selection {
  std::vector<int> nodes, cables, beams, membranes, shells, springs, masses;
  std::vector<std::array<int, 2>> edges;  ///< sides of facets, for supports and line loads
};

/// Degrees of freedom 0..2 are displacements along the support's axes [m], 3..5 rotations about them [rad].
struct Support {
  std::string name;
  std::vector<std::string> on;  ///< groups and selections; `nodes` are theirs
  std::vector<int> nodes;
  std::array<bool, 6> fixed{true, true, true, true, true, true};
  Mat3 axes = Mat3::Identity();  ///< columns: the directions x, y, z that `fixed` means
  bool symmetry = false;         ///< the deck says so: the structure goes on as its mirror image beyond x
};

/// "file:line:column: ", or nothing if no place in a deck is known.
std::string prefix(const SourceLocation& where);

/// What acts at full load factor. Forces and motions act on the nodes of the structure as described, whatever
/// the mesh; line, surface and temperature loads on the elements of `on`.
struct Load {
  std::string name;
  std::vector<std::string> on;  ///< groups and selections
  std::vector<int> nodes;
  Vec3 force = Vec3::Zero();          ///< dead force on each node [N]
  Vec3 moment = Vec3::Zero();         ///< dead moment on each node [N m]
  std::optional<Vec3> displacement;   ///< of the supported directions of each node [m]
  std::optional<Vec3> rotation;       ///< rotation vector of the supported directions of each node [rad]
  Vec3 line_force = Vec3::Zero();     ///< dead force per reference length of cables, beams and edges [N/m]
  Vec3 line_moment = Vec3::Zero();    ///< dead moment per reference length of beams and edges [N]
  Vec3 surface_force = Vec3::Zero();  ///< dead force per reference area of membranes and shells [Pa]
  double pressure = 0;                ///< follows the facets, along their normals [Pa]
  double temperature_change = 0;      ///< of groups [K]
  std::function<double(const Vec3&)> temperature_field;   ///< the same by place in the reference [K]; or none
  std::function<Vec3(const Vec3&)> temperature_gradient;  ///< of that field [K/m]; beams bend with it
  Vec3 acceleration = Vec3::Zero();  ///< body force per mass on the whole structure, e.g. gravity [m/s^2]
  SourceLocation where;              ///< in the deck, for messages

  bool moves() const { return displacement || rotation; }
  bool heats() const { return temperature_change != 0 || temperature_field; }
  /// 'load "name"', after its place in the deck if that is known.
  std::string title() const;
};

/// The load `factor` times as large.
Load scaled(const Load& load, double factor);

/// Where an analysis begins, if not in the reference configuration: each list is empty, or has one entry for
/// each node.
struct InitialMotion {
  Points displacement;         ///< [m]
  std::vector<Mat3> rotation;  ///< identity where the node has no rotations
  bool empty() const { return displacement.empty(); }
};

struct Model {
  Points nodes;                         ///< reference coordinates [m]
  std::vector<std::string> node_names;  ///< as in the deck, of the first nodes; of a mesh or reflector none
  InitialMotion initial;
  std::vector<Group> groups;
  std::vector<Cable> cables;
  std::vector<Beam> beams;
  std::vector<Membrane> membranes;
  std::vector<Shell> shells;
  std::vector<Spring> springs;
  std::vector<MassElement> masses;
  std::vector<Link> links;
  std::vector<CyclicPair> cyclic_pairs;
  std::vector<LinearConstraint> constraints;
  std::map<std::string, Selection> selections;
  std::vector<Support> supports;
  std::vector<Load> loads;
  Vec3 acceleration = Vec3::Zero();  ///< body force per mass at present, which catenaries feel [m/s^2]

  /// Index of the group, or -1.
  int find_group(const std::string& name) const;
  /// All elements and nodes of a group or of a selection. @throws ModelError naming the nearest known name.
  Selection select(const std::string& name) const;
  /// The same of several, every element and edge once.
  Selection select(const std::vector<std::string>& names) const;
  /// Sorted, unique nodes of the named groups and selections (their elements' nodes and their own), the end
  /// of a beam on a hinge or offset replaced by the node it hangs on.
  std::vector<int> nodes_of(const std::vector<std::string>& names) const;
  /// Sorted names of all groups and selections.
  std::vector<std::string> names() const;
  /// Whether each node carries rotations (a beam, shell, link or rotational spring is attached).
  std::vector<bool> rotational_nodes() const;

  double reference_length(const Cable& cable) const;
  double unstressed_length(const Cable& cable) const;
  /// E A [N].
  double axial_stiffness(const Cable& cable) const {
    return groups[static_cast<std::size_t>(cable.group)].cable.axial_stiffness * cable.stiffness_factor;
  }
};

/// Applies `visit` to the list of each kind of element.
template <class AnyModel, class Visit>
void for_each_kind(AnyModel&& model, const Visit& visit) {
  visit(model.cables);
  visit(model.beams);
  visit(model.membranes);
  visit(model.shells);
  visit(model.springs);
  visit(model.masses);
}

/// Indices of the links, each after the one that its leader follows. @throws ModelError for a ring of links
std::vector<int> links_in_order(const Model& model);

/// Unit normals at the nodes of every shell: the mean over all shells that go on from it there, from side to
/// side at less than 20 degrees, through planes of symmetry and cyclic faces as inside.
void find_directors(Model& model);

/// Mass of all elements [kg], and per group.
double total_mass(const Model& model);
std::map<std::string, double> mass_by_group(const Model& model);

/// @brief Checks that the structure can exist: node indices, zero-length and zero-area elements, coincident
/// and unconnected nodes, positive stiffnesses, something supported. @throws ModelError that lists every
/// fault by name.
void validate(const Model& model);

}  // namespace tautline::model
