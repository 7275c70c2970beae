#include "steps/form_frame.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include <tautline/core/anderson.hpp>
#include <tautline/core/error.hpp>

#include "steps/frame_balance.hpp"

namespace tautline::steps {

namespace {

constexpr int most_rounds = 100;
constexpr std::size_t anderson_depth = 60;
constexpr double settled_frame = 1e-10;  // distance of the frame from where the net was found, over the size
constexpr double diverging = 30;         // times the least distance: the net yields too much
constexpr int impatience = 8;            // rounds in which the frame comes no nearer: likewise
constexpr int patience = 12;             // rounds in which the frame comes no nearer

/// Places of the net's fixed nodes.
VecX edge_of(const FormNet& net, const Points& nodes) {
  VecX edge(3 * static_cast<Eigen::Index>(net.nodes.size()));
  Eigen::Index n = 0;
  for (std::size_t i = 0; i < net.nodes.size(); ++i)
    if (net.net.fixed[i]) edge.segment<3>(3 * n++) = nodes[static_cast<std::size_t>(net.nodes[i])];
  return edge.head(3 * n);
}

void put_edge(const VecX& edge, FormNet& net, Points& nodes) {
  Eigen::Index n = 0;
  for (std::size_t i = 0; i < net.nodes.size(); ++i)
    if (net.net.fixed[i])
      net.net.nodes[i] = nodes[static_cast<std::size_t>(net.nodes[i])] = edge.segment<3>(3 * n++);
}

double largest_motion(const VecX& from, const VecX& to) {
  double largest = 0;
  for (Eigen::Index i = 0; i + 2 < from.size(); i += 3)
    largest = std::max(largest, (to - from).segment<3>(i).norm());
  return largest;
}

double size_of(const Points& nodes) {
  double size = 0;
  for (const Vec3& node : nodes) size = std::max(size, (node - nodes.front()).norm());
  return size;
}

/// By cable of the structure: form-finding keeps its unstressed length, or prescribes its length.
std::vector<bool> lengths_kept(const Context& context, const FormFindingOptions& options,
                               const FormNet& net) {
  std::vector<bool> kept(context.structure.cables.size(), false);
  const auto set = [&](const std::vector<std::string>& groups, bool value) {
    for (const int b : net.branches_of(context.structure, groups))
      kept[static_cast<std::size_t>(net.cables[b])] = value;
  };
  if (options.method == FormMethod::elastic || options.method == FormMethod::dynamic_relaxation)
    set(net.groups, true);
  if (options.method == FormMethod::dynamic_relaxation) set(options.constant_tension, false);
  if (options.method != FormMethod::constraints) return kept;
  for (const auto& wish : options.constraints)
    if (wish.kind == formfinding::ConstraintKind::length ||
        wish.kind == formfinding::ConstraintKind::unstressed_length)
      set(wish.on, true);
  return kept;
}

/// The rounds and what they leave.
class Rounds {
 public:
  Rounds(Context& context, const FormFindingOptions& options, const std::vector<std::string>& settled,
         FormNet& net, const HandOver& hand_over)
      : context_(context),
        options_(options),
        net_(net),
        hand_over_(hand_over),
        frame_(context, net, settled, options.frame == FrameKind::precambered,
               lengths_kept(context, options, net)),
        size_(size_of(context.structure.nodes)) {}

  Form run(Json& entry);

 private:
  /// The net between edges there, handed over. @return false, with a reason, if there is none
  bool find_net(const VecX& edge);
  void start_next_from(const Form& found);
  /// The frame under the net. @return false, with a reason, if it finds no equilibrium
  bool rest();
  bool settled(double distance);
  void fail(const std::string& reason);

  Context& context_;
  const FormFindingOptions& options_;
  FormNet& net_;
  const HandOver& hand_over_;
  Frame frame_;
  double size_;
  Form last_;         ///< handed over
  bool any_ = false;  ///< a net has been handed over
  std::string why_;   ///< the last round failed
  Json changes_ = Json::array();
  double nearest_ = std::numeric_limits<double>::infinity();
  int since_ = 0;  ///< rounds since the nearest
};

bool Rounds::find_net(const VecX& edge) {
  const Points before = context_.structure.nodes;
  context_.structure.nodes = frame_.positions();
  put_edge(edge, net_, context_.structure.nodes);
  std::string reason;
  try {
    if (!any_ || options_.frame != FrameKind::precambered) {
      Form found = find_form(context_, options_, net_);
      if (!any_) last_ = found;
      if (found.converged || found.compromise) {
        hand_over_(found);
        last_ = std::move(found);
        any_ = true;
        start_next_from(last_);
        return true;
      }
      reason = found.reason;
    } else {
      hand_over_(last_);
      return true;
    }
  } catch (const ModelError& error) {
    if (!any_) throw;
    reason = error.what();
  }
  context_.structure.nodes = before;
  why_ = fmt::format("between the places where the frame goes the net is not found: {}", reason);
  return false;
}

void Rounds::start_next_from(const Form& found) {
  net_.start_density.resize(found.tension.size());
  for (std::size_t b = 0; b < net_.net.branches.size(); ++b) {
    const auto [i, j] = net_.net.branches[b];
    const auto k = static_cast<Eigen::Index>(b);
    net_.start_density[k] = found.tension[k] / (found.nodes[j] - found.nodes[i]).norm();
  }
  for (std::size_t i = 0; i < net_.nodes.size(); ++i)
    if (!net_.net.fixed[i]) net_.net.nodes[i] = found.nodes[i];
}

bool Rounds::rest() {
  try {
    frame_.rest(context_, context_.structure);
    return true;
  } catch (const ModelError& error) {
    why_ = error.what();
    return false;
  }
}

bool Rounds::settled(double distance) {
  changes_.push_back(distance);
  context_.progress.say(fmt::format("{} | round {}, the frame is {:.2e} m from where the net was found",
                                    context_.step_name, changes_.size(), distance));
  since_ = distance < nearest_ / 2 ? 0 : since_ + 1;
  nearest_ = std::min(nearest_, distance);
  return distance == 0 || (distance <= settled_frame * size_ && since_ > 0);
}

void Rounds::fail(const std::string& reason) {
  last_.reason = last_.compromise ? last_.reason + "; and " + reason : reason;
  last_.compromise = any_;
  last_.converged = false;
}

Form Rounds::run(Json& entry) {
  Anderson acceleration(anderson_depth);
  VecX edge = edge_of(net_, frame_.positions()), plain = edge, nearest_edge = edge;
  auto nearest_motion = frame_.motion();
  double at_restart = 0;  // of the acceleration: the least distance by then
  bool accelerated = false, there = false;
  while (static_cast<int>(changes_.size()) < most_rounds && since_ < patience) {
    const auto before = frame_.motion();
    const bool found = find_net(edge);
    if (found && last_.compromise) break;  // no more than this net is to be had of the drawn frame
    if (!found || !rest()) {
      // The acceleration led astray, or the frame went too far under a net that yields too much.
      if (!accelerated && !frame_.stiffen_net()) break;
      if (!any_) break;
      edge = accelerated ? plain : nearest_edge;
      frame_.return_to(accelerated ? before : nearest_motion);
      acceleration.restart();
      accelerated = false;
      why_.clear();
      continue;
    }
    plain = edge_of(net_, frame_.positions());
    const double distance = largest_motion(edge, plain);
    if (distance < nearest_) {
      nearest_edge = edge;
      nearest_motion = before;
    }
    if (changes_.empty()) at_restart = distance;
    const bool farther = distance > diverging * nearest_ || since_ >= impatience;
    there = settled(distance);
    if (there) break;
    if (farther && (nearest_ < at_restart / 2 || frame_.stiffen_net())) {
      edge = nearest_edge;
      frame_.return_to(nearest_motion);
      acceleration.restart();
      accelerated = false;
      at_restart = nearest_;
      since_ = 0;
      continue;
    }
    const VecX next = acceleration.next(edge, plain);
    accelerated = !next.isApprox(plain, 1e-15);
    edge = next;
  }
  if (!any_) return last_;
  if (!why_.empty())
    fail(why_);
  else if (!there && !last_.compromise)
    fail(fmt::format("net and frame still move each other by {:.3g} m > {:.3g} m after {} rounds",
                     changes_.back().get<double>(), settled_frame * size_, changes_.size()));
  // Where net and frame do not meet, the tables hold the net between the places where it was found.
  if (there) frame_.unload(context_.structure);
  entry["frame"] = {{"rounds", changes_.size()},
                    {"last_change", changes_.empty() ? Json() : changes_.back()},
                    {"largest_displacement", frame_.largest_displacement()}};
  return last_;
}

}  // namespace

Form find_with_frame(Context& context, const FormFindingOptions& options,
                     const std::vector<std::string>& settled, FormNet& net, const HandOver& hand_over,
                     Json& entry) {
  return Rounds(context, options, settled, net, hand_over).run(entry);
}

}  // namespace tautline::steps
