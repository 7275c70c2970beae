#include "steps/inverse_problem.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include <tautline/assembly/influence.hpp>
#include <tautline/core/error.hpp>
#include <tautline/rod/meridian.hpp>

namespace tautline::steps {

namespace {

using assembly::CableQuantity;
using Quantity = InverseUnknownOptions::Quantity;

[[noreturn]] void refuse(const SourceLocation& where, const std::string& message) {
  throw ModelError(fmt::format("{}:{}:{}: {}", where.file, where.line, where.column, message));
}

Miss radial(const Vec3& at, double radius) {
  const double distance = at.head<2>().norm();
  const Vec3 outward = distance > 0 ? Vec3(at.x() / distance, at.y() / distance, 0) : Vec3(Vec3::UnitX());
  return {distance - radius, outward};
}

Miss from_surface(const Vec3& at, const rod::Meridian& meridian) {
  const auto [distance, outward] = radial(at, 0);
  const double angle = meridian.angle(meridian.foot(distance, at.z()));
  return {meridian.distance(distance, at.z()), std::cos(angle) * Vec3::UnitZ() - std::sin(angle) * outward};
}

class UnknownList {
 public:
  UnknownList(const model::Model& model, const InverseOptions& options) : model_(model) {
    for (const auto& entry : options.unknowns)
      for (const auto& name : entry.on) add(entry, name);
  }
  std::vector<Unknown> take() { return std::move(list_); }

 private:
  void add(const InverseUnknownOptions& entry, const std::string& name) {
    std::vector<int> cables;
    try {
      cables = model_.select(name).cables;
    } catch (const ModelError& error) {
      refuse(entry.where, error.what());
    }
    if (cables.empty()) refuse(entry.where, fmt::format("\"{}\" has no cables that could be changed", name));
    std::map<std::pair<int, int>, std::vector<int>> whole;  // parts of a cable by group and cable
    for (const int i : cables) {
      if (!taken_.insert({entry.quantity, i}).second)
        refuse(entry.where, fmt::format("cables of \"{}\" are in two unknowns of the same quantity", name));
      whole[{model_.cables[i].group, model_.cables[i].parent}].push_back(i);
    }
    if (entry.each == InverseUnknownOptions::Each::group) {
      add(entry, name, cables, static_cast<double>(whole.size()));
      return;
    }
    int number = 0;
    for (const auto& [key, parts] : whole) add(entry, fmt::format("{} {}", name, ++number), parts, 1);
  }

  void add(const InverseUnknownOptions& entry, const std::string& name, const std::vector<int>& parts,
           double n_whole) {
    Unknown unknown{name, entry.quantity, parts};
    std::map<std::pair<int, int>, double> values;  // of whole cables
    for (const int i : parts) {
      const auto& cable = model_.cables[i];
      auto& value = values[{cable.group, cable.parent}];
      if (entry.quantity == Quantity::unstressed_length)
        value += model_.unstressed_length(cable);
      else
        value = model_.axial_stiffness(cable);
    }
    for (const auto& [key, value] : values) {
      unknown.start += value / n_whole;
      if (entry.min) unknown.lower = std::max(unknown.lower, *entry.min / value);
      if (entry.max) unknown.upper = std::min(unknown.upper, *entry.max / value);
    }
    if (unknown.lower > 1 || unknown.upper < 1)
      refuse(entry.where, fmt::format("\"{}\" begins with {:.6g} {}, which its min and max do not allow",
                                      name, unknown.start, unit(entry.quantity)));
    list_.push_back(std::move(unknown));
  }

 public:
  static const char* unit(Quantity quantity) { return quantity == Quantity::unstressed_length ? "m" : "N"; }

 private:
  const model::Model& model_;
  std::vector<Unknown> list_;
  std::set<std::pair<Quantity, int>> taken_;
};

}  // namespace

std::vector<Target> list_targets(const model::Model& model, const InverseOptions& options) {
  std::vector<Target> list;
  for (std::size_t i = 0; i < options.targets.size(); ++i) {
    const auto& entry = options.targets[i];
    std::vector<std::pair<std::string, std::function<Miss(const Vec3&)>>> conditions;
    const std::array coordinates{entry.x, entry.y, entry.z};
    for (int c = 0; c < 3; ++c)
      if (const auto& wanted = coordinates[static_cast<std::size_t>(c)])
        conditions.emplace_back(std::string(1, "xyz"[c]), [c, value = *wanted](const Vec3& at) {
          return Miss{at[c] - value, Vec3::Unit(c)};
        });
    if (entry.radius)
      conditions.emplace_back("radius",
                              [value = *entry.radius](const Vec3& at) { return radial(at, value); });
    if (entry.meridian)
      conditions.emplace_back("meridian", [curve = rod::Meridian::make(*entry.meridian)](const Vec3& at) {
        return from_surface(at, curve);
      });
    std::vector<int> nodes;
    try {
      nodes = model.nodes_of(entry.on);
    } catch (const ModelError& error) {
      refuse(entry.where, error.what());
    }
    for (const auto& [quantity, miss] : conditions)
      for (const int node : nodes) list.push_back({static_cast<int>(i), quantity, node, entry.weight, miss});
  }
  return list;
}

std::vector<Unknown> list_unknowns(const model::Model& model, const InverseOptions& options) {
  return UnknownList(model, options).take();
}

CableProblem::CableProblem(Context& context, const InverseOptions& options)
    : context_(context),
      system_(context.system()),
      targets_(list_targets(system_.model(), options)),
      unknowns_(list_unknowns(system_.model(), options)),
      start_strains_(system_.strains()) {
  for (const auto& cable : system_.model().cables) {
    start_factors_.push_back(cable.stiffness_factor);
    start_length_.push_back(system_.model().unstressed_length(cable));
  }
  std::set<int> nodes;
  for (const auto& target : targets_) nodes.insert(target.node);
  nodes_.assign(nodes.begin(), nodes.end());
}

bool CableProblem::begin() {
  keep();
  return follow_to(start_strains_, start_factors_);
}

analysis::Box CableProblem::box() const {
  const auto n = static_cast<Eigen::Index>(unknowns_.size());
  analysis::Box box{VecX(n), VecX(n)};
  for (Eigen::Index j = 0; j < n; ++j) {
    box.lower[j] = unknowns_[static_cast<std::size_t>(j)].lower;
    box.upper[j] = unknowns_[static_cast<std::size_t>(j)].upper;
  }
  return box;
}

bool CableProblem::move_to(const VecX& factors) {
  restore();
  auto strains = start_strains_, stiffness = start_factors_;
  for (std::size_t j = 0; j < unknowns_.size(); ++j)
    for (const int i : unknowns_[j].cables) {
      const double factor = factors[static_cast<Eigen::Index>(j)];
      if (unknowns_[j].quantity == Quantity::unstressed_length)
        strains[i] = (1 + start_strains_[i]) / factor - 1;
      else
        stiffness[i] *= factor;
    }
  return follow_to(strains, stiffness);
}

void CableProblem::keep() {
  kept_state_ = system_.state();
  kept_strains_ = system_.strains();
  kept_factors_.clear();
  for (const auto& cable : system_.model().cables) kept_factors_.push_back(cable.stiffness_factor);
}

void CableProblem::restore() {
  system_.set_stiffness_factors(kept_factors_);
  system_.set_state(kept_state_, kept_strains_);
}

VecX CableProblem::residual() {
  VecX values(static_cast<Eigen::Index>(targets_.size()));
  for (std::size_t i = 0; i < targets_.size(); ++i)
    values[static_cast<Eigen::Index>(i)] = targets_[i].weight * miss(targets_[i]).value;
  return values;
}

MatX CableProblem::jacobian() {
  std::vector<assembly::CableParameter> parameters;
  for (const auto& unknown : unknowns_) {
    const bool length = unknown.quantity == Quantity::unstressed_length;
    auto& parameter = parameters.emplace_back();
    parameter.quantity = length ? CableQuantity::unstressed_length : CableQuantity::axial_stiffness;
    for (const int i : unknown.cables)
      parameter.parts.push_back({i, length ? start_length_[i] : start_stiffness(i)});
  }
  const MatX motion = assembly::influence(system_, context_.workspace(), parameters, nodes_);
  MatX result(static_cast<Eigen::Index>(targets_.size()), motion.cols());
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const auto place = std::lower_bound(nodes_.begin(), nodes_.end(), targets_[i].node) - nodes_.begin();
    result.row(static_cast<Eigen::Index>(i)) =
        targets_[i].weight * miss(targets_[i]).gradient.transpose() * motion.middleRows(3 * place, 3);
  }
  return result;
}

Vec3 CableProblem::position(int node) const {
  return system_.model().nodes[node] + system_.state().displacement[node];
}

double CableProblem::start_stiffness(int cable) const {
  const auto& model = system_.model();
  return model.groups[model.cables[cable].group].cable.axial_stiffness *
         start_factors_[static_cast<std::size_t>(cable)];
}

bool CableProblem::follow_to(const std::vector<double>& strains, const std::vector<double>& stiffness) {
  system_.set_target_strains(strains);
  system_.set_stiffness_factors(stiffness);
  system_.begin_stage(context_.boundary({}, true));
  auto path = follow(context_, "cables");
  newton_iterations_ += path.newton_iterations;
  const bool reached = path.reached;
  if (reached) path_ = std::move(path);
  return reached;
}

}  // namespace tautline::steps
