#pragma once
/// @file
/// The parts of the keyword table, one function and one source file (keywords_<name>.cpp) each.

#include <deck/keyword.hpp>

namespace tautline::deck {

const BlockSet& reflector_blocks();        ///< of Reflector
Block tensegrity_rim_block();              ///< of reflector::TensegrityRimOptions
Block umbrella_block();                    ///< of reflector::UmbrellaOptions
Block y_umbrella_block();                  ///< of reflector::YUmbrellaOptions
Block rod_umbrella_block();                ///< of rod::UmbrellaOptions
const BlockSet& target_meridian_blocks();  ///< of rod::MeridianOptions, in targets of an inverse
Block inverse_block();                     ///< of steps::InverseOptions
const BlockSet& model_blocks();            ///< of model::ModelOptions
const BlockSet& material_blocks();         ///< of model::MaterialOptions
const BlockSet& section_blocks();          ///< of model::SectionOptions
const BlockSet& group_blocks();            ///< of model::GroupOptions
const BlockSet& support_blocks();          ///< of model::SupportOptions
const BlockSet& load_blocks();             ///< of model::LoadOptions
Block equilibrium_block();                 ///< of steps::Step
Block buckling_block();                    ///< of steps::Step
Block collapse_block();                    ///< of steps::Step
Block form_finding_block();                ///< of steps::Step
const BlockSet& step_blocks();             ///< of steps::Step
const BlockSet& output_blocks();           ///< of output::OutputOptions
const BlockSet& solver_blocks();           ///< of analysis::NewtonOptions

/// Whether a reflector of this kind has all of its structure in its own block: no sections, groups, supports.
bool is_complete_structure(const std::string& reflector_kind);

/// The keys of a group of which a cable has one.
const std::vector<std::string>& initial_states();

}  // namespace tautline::deck
