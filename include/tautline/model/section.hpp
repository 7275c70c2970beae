#pragma once
/// @file
/// Section library: from dimensions and material to the stiffnesses an element needs.

#include <array>
#include <map>
#include <string>

#include <tautline/model/model.hpp>
#include <tautline/model/model_options.hpp>

namespace tautline::model {

using Materials = std::map<std::string, MaterialOptions>;

/// Which kind of element a section is for.
ElementKind kind_of(const SectionOptions& section);

/// Section of a tapered tube at `place` along it, 0 at its start and 1 at its end.
element::BeamSection tapered_section(const TaperedTube& tube, double place);

/// @brief Resultants (N11, N22, N12) in the axes of a facet's `frame` for given ones along the projection of
/// `orientation` on it and across [N/m].
Vec3 along_orientation(const Mat3& frame, const Vec3& orientation, const std::array<double, 2>& resultants);

/// Fills the section of `group` (kind and stiffnesses) from its options.
/// Rectangle: torsion constant by Roark's approximation (0.5 %), shear factor 5/6. Round bar and tube: shear
/// factors of Cowper (1966). I section: thin-walled torsion constant sum b t^3/3, shear carried by the web
/// (along axis 3) and by 5/6 of the flanges (along axis 2).
void set_section(Group& group, const SectionOptions& section, const Materials& materials);

/// Initial strains and prestress of one group's elements from the deck (`tension`, `unstressed_length`, ...);
/// elements of groups that state nothing stay as they are.
/// @param[in] thickness  of the section, for an initial stress [m]
void set_initial_state(Model& model, int group, const GroupOptions& options, double thickness = 0);

}  // namespace tautline::model
