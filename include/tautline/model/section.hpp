#pragma once
/// @file
/// Section library: from dimensions and material to the stiffnesses an element needs.

#include <map>
#include <string>

#include <tautline/model/model.hpp>
#include <tautline/model/model_options.hpp>

namespace tautline::model {

using Materials = std::map<std::string, MaterialOptions>;

/// Which kind of element a section is for.
ElementKind kind_of(const SectionOptions& section);

/// Fills the section of `group` (kind and stiffnesses) from its options.
/// Rectangle: torsion constant by Roark's approximation (0.5 %), shear factor 5/6. Round bar and tube: shear
/// factors of Cowper (1966).
void set_section(Group& group, const SectionOptions& section, const Materials& materials);

/// Initial strains and prestress of one group's elements from the deck (`tension`, `unstressed_length`, ...);
/// elements of groups that state nothing stay as they are.
void set_initial_state(Model& model, int group, const GroupOptions& options);

}  // namespace tautline::model
