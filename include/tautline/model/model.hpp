#pragma once
/// @file
/// What is analysed: nodes, elements in named groups, supports and loads. Plain data, the same on every rank;
/// the structure as described and its finite-element mesh are both a Model (the second by model::subdivide).

#include <array>
#include <map>
#include <string>
#include <vector>

#include <tautline/core/types.hpp>
#include <tautline/element/beam.hpp>
#include <tautline/element/membrane.hpp>

namespace tautline::model {

struct CableSection {
  double axial_stiffness = 0;  ///< E A [N]
  double mass_per_length = 0;  ///< [kg/m]
};

enum class ElementKind { cable, beam, membrane };

/// Elements of one kind with one section. Every element belongs to exactly one group, by index into
/// Model::groups.
struct Group {
  std::string name;
  ElementKind kind = ElementKind::cable;
  CableSection cable;                 ///< valid where kind == cable
  element::BeamSection beam;          ///< valid where kind == beam
  element::MembraneSection membrane;  ///< valid where kind == membrane
  Vec3 orientation = Vec3::Zero();    ///< beams: local axis 3 lies in the plane of the beam and this vector
  double target_tension = 0;          ///< cables: tension asked of form-finding [N]; 0 if none
};

struct Cable {
  std::array<int, 2> nodes;
  int group = 0;
  double initial_strain = 0;  ///< l_ref / L0 - 1, see element::CableProperties
  int parent = 0;             ///< index of the cable in the structure before subdivision
};

struct Beam {
  std::array<int, 2> nodes;
  int group = 0;
  Mat3 frame = Mat3::Identity();  ///< reference frame, columns local axes
  int parent = 0;
};

struct Membrane {
  std::array<int, 3> nodes;
  int group = 0;
  Vec3 prestress = Vec3::Zero();  ///< N11, N22, N12 in element::membrane_frame [N/m]
  int parent = 0;
};

/// A named selection of nodes and elements; groups are selections by themselves and need none.
struct Selection {
  std::vector<int> nodes, cables, beams, membranes;
};

/// Degrees of freedom 0..2 are displacements along x, y, z [m], 3..5 rotations about them [rad].
struct Support {
  std::string name;
  std::vector<std::string> on;  ///< groups and selections; `nodes` are theirs
  std::vector<int> nodes;
  std::array<bool, 6> fixed{true, true, true, true, true, true};
};

/// A dead nodal load at full load factor. It stays on the nodes of the structure as described, whatever the
/// mesh.
struct NodalLoad {
  std::string name;
  std::vector<int> nodes;
  Vec3 force = Vec3::Zero();   ///< [N], on each node
  Vec3 moment = Vec3::Zero();  ///< [N m], on each node
};

struct Model {
  Points nodes;  ///< reference coordinates [m]
  std::vector<Group> groups;
  std::vector<Cable> cables;
  std::vector<Beam> beams;
  std::vector<Membrane> membranes;
  std::map<std::string, Selection> selections;
  std::vector<Support> supports;
  std::vector<NodalLoad> loads;
  Vec3 acceleration = Vec3::Zero();  ///< body force per mass at full load factor, e.g. gravity [m/s^2]

  /// Index of the group, or -1.
  int find_group(const std::string& name) const;
  /// All elements and nodes of a group or of a selection. @throws ModelError naming the nearest known name.
  Selection select(const std::string& name) const;
  /// Sorted, unique nodes of the named groups and selections (their elements' nodes and their own).
  std::vector<int> nodes_of(const std::vector<std::string>& names) const;
  /// Sorted names of all groups and selections.
  std::vector<std::string> names() const;
  /// Whether each node carries rotations (a beam is attached).
  std::vector<bool> rotational_nodes() const;

  double reference_length(const Cable& cable) const;
  double unstressed_length(const Cable& cable) const;
};

/// Mass of all elements [kg], and per group.
double total_mass(const Model& model);
std::map<std::string, double> mass_by_group(const Model& model);

/// @brief Checks that the structure can exist: node indices, zero-length and zero-area elements, coincident
/// and unconnected nodes, positive stiffnesses, something supported. @throws ModelError that lists every
/// fault by name.
void validate(const Model& model);

}  // namespace tautline::model
