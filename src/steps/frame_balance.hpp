#pragma once
/// @file
/// A net between nodes of a frame that yields: both in balance.

#include "steps/form_net.hpp"

namespace tautline::steps {

/// All that is not found by form-finding and does not hang on free nodes of the net: beams, shells, bars,
/// springs, and cables with a state of their own.
class Frame {
 public:
  /// @param[in] found        groups of cables and cloth whose state follows from form-finding
  /// @param[in] precambered  the drawn shape is that under the net; the shape without stress is looked for
  /// @param[in] keeps_length  by cable: form-finding keeps its unstressed length
  Frame(const Context& context, const FormNet& net, const std::vector<std::string>& found, bool precambered,
        std::vector<bool> keeps_length);

  /// Where the structure's nodes are, or shall be, under the net [m].
  Points positions() const;
  double largest_displacement() const;
  /// From the shape without stress to positions(), in a frame made as drawn.
  const model::InitialMotion& motion() const { return motion_; }
  void return_to(const model::InitialMotion& motion) { motion_ = motion; }
  /// @brief Lets the cables of the net yield less while the frame moves: the frame that buckles under a net
  /// of given force densities may stand when its cables resist.
  /// @return false if they are as stiff as they are
  bool stiffen_net();
  /// @brief Brings the frame to rest under the pull of the cables and cloth of `structure`, whose nodes are
  /// at positions().
  /// @return largest change of positions() [m]
  /// @throws ModelError if the frame finds no equilibrium
  double rest(const Context& context, const model::Model& structure);
  /// @brief Puts the frame's nodes of a structure back to where they are without stress, with the way to
  /// positions() as initial motion.
  ///
  /// Unstressed lengths stay, and the stress of cloth is such that it has its present value after the motion.
  void unload(model::Model& structure) const;

 private:
  bool is_found(int group) const { return found_[static_cast<std::size_t>(group)]; }
  /// Whether an element is neither found nor hangs on the net.
  template <class Element>
  bool is_frame(const Element& element) const {
    return !is_found(element.group) &&
           std::none_of(element.nodes.begin(), element.nodes.end(), [&](int node) { return free_[node]; });
  }
  /// Without stress, and without the cables of `left_out`.
  model::Model bare_frame(const model::Model& structure, const std::vector<bool>& left_out) const;
  /// Under dead forces of the net.
  model::Model loaded_frame(const model::Model& structure) const;
  /// By cable, for freeze().
  std::vector<double> yielding(const model::Model& structure) const;
  /// With the net of frozen force densities in place of its dead forces.
  model::Model frame_with_net(const model::Model& structure) const;
  /// Which node of the frame has moved most since the last rest, from where to where; or nothing.
  std::string moved_most(const assembly::System& system) const;
  /// @brief The frame yields under the net, whose branches keep their force densities meanwhile.
  ///
  /// Nothing is changed by that where it does not move. With dead forces it would come to rest only where it
  /// bears them without the net's own stiffness, and go too far where the net is the stiffer of the two.
  double yield(const Context& context, const model::Model& structure);
  /// @brief The shape without stress from which the frame comes to the drawn one.
  ///
  /// Position and forces being given, the stiffness without stress tells how the reference must change;
  /// whether the frame could carry the pull without the net's stiffness does not matter.
  double find_precamber(const model::Model& structure);
  /// Displacement and rotation vector of every node on the way to the drawn shape.
  void set_motion(const VecX& motion);
  void orient(model::Model& structure) const;

  Points drawn_;
  Points reference_;  ///< without stress
  bool precambered_;
  std::vector<bool> keeps_length_;  ///< by cable
  std::size_t stiffening_ = 0;      ///< see stiffen_net()
  std::vector<int> on_surface_;     ///< free nodes of the net that keep their height
  std::vector<bool> found_;         ///< by group
  std::vector<bool> pulls_;         ///< by group: found, or cables of the frame whose tension the deck states
  std::vector<bool> free_;          ///< by node: a free node of the net
  std::vector<bool> of_frame_;      ///< by node: an element of the frame meets it
  model::InitialMotion motion_;
};

}  // namespace tautline::steps
