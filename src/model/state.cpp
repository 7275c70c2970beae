#include <tautline/model/state.hpp>

namespace tautline::model {

State State::reference(const Model& model) {
  return {Points(model.nodes.size(), Vec3::Zero()), std::vector<Mat3>(model.nodes.size(), Mat3::Identity()),
          Points(model.links.size(), Vec3::Zero()), Points(model.nodes.size(), Vec3::Zero())};
}

State State::initial(const Model& model) {
  State state = reference(model);
  if (model.initial.empty()) return state;
  state.displacement = model.initial.displacement;
  state.rotation = model.initial.rotation;
  return state;
}

Points positions(const Model& model, const State& state) {
  Points result(model.nodes.size());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = model.nodes[i] + state.displacement[i];
  return result;
}

}  // namespace tautline::model
