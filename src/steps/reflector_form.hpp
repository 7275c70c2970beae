#pragma once
/// @file
/// What follows on a reflector from the shape of its front net: rear net and ties.

#include "steps/form_methods.hpp"

namespace tautline::steps {

/// Cable groups that are the front net, `front_...`: what form-finding takes unless it is told.
std::vector<std::string> front_net_groups(const model::Model& structure);

/// Cable groups that are the rear net, `rear_...`.
std::vector<std::string> rear_net_groups(const model::Model& structure);

/// The groups that complete_reflector gives their state: ties, and the group `rear_x` of each `front_x`.
std::vector<std::string> completed_groups(const FormNet& net);

/// @brief The rear net becomes the front net's mirror image; its cables carry also what the cloth carries in
/// front, so that it is in balance, too. Each tie carries what its front node needs along z, or its part of
/// it where several share the node.
/// @throws ModelError for a tie that would be pressed
void complete_reflector(Context& context, const FormNet& net, const Form& found);

}  // namespace tautline::steps
