#include <formfinding/deviation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace tautline::formfinding {

namespace {

constexpr int most_sources = 200;  // fixed nodes from which short paths are looked for

/// Branches with a length asked for at each node: (other node, length).
std::vector<std::vector<std::pair<int, double>>> asked_lengths(const ConstrainedNet& problem) {
  std::vector<std::vector<std::pair<int, double>>> next(problem.net.nodes.size());
  for (const Constraint& constraint : problem.constraints) {
    if (constraint.kind != ConstraintKind::length) continue;
    for (std::size_t k = 0; k < constraint.members.size(); ++k) {
      const auto [i, j] = problem.net.branches[constraint.members[k]];
      const double length = constraint.wanted(k, std::numeric_limits<double>::max());
      next[i].emplace_back(j, length);
      next[j].emplace_back(i, length);
    }
  }
  return next;
}

void add_miss(const Constraint& constraint, const ConstraintRows& rows, const VecX& missing, int first,
              double tolerance, std::vector<Deviation>& worst, std::vector<Miss>& misses) {
  Miss miss{constraint.name, constraint.kind, static_cast<int>(constraint.members.size()), 0, 0, {}};
  for (std::size_t k = 0; k < constraint.members.size(); ++k) {
    const auto row = static_cast<std::size_t>(first) + k;
    const double left = missing[static_cast<Eigen::Index>(row)];
    const double scale = rows.scale[row], found = rows.value[row] * scale;
    const Deviation deviation{constraint.name,      constraint.kind, constraint.members[k],
                              found + left * scale, found,           -left};
    miss.rms += left * left / static_cast<double>(constraint.members.size());
    if (!(std::abs(left) > tolerance)) continue;
    worst.push_back(deviation);
    ++miss.missed;
    if (std::abs(left) > std::abs(miss.worst.relative)) miss.worst = deviation;
  }
  miss.rms = std::sqrt(miss.rms);
  if (miss.missed > 0) misses.push_back(std::move(miss));
}

}  // namespace

bool is_reaction(ConstraintKind kind) {
  return kind >= ConstraintKind::reaction_x;
}

const char* to_string(ConstraintKind kind) {
  constexpr const char* words[] = {"tension",       "length",     "unstressed length", "force density",
                                   "equal tension", "reaction x", "reaction y",        "reaction z"};
  return words[static_cast<int>(kind)];
}

const char* unit(ConstraintKind kind) {
  if (kind == ConstraintKind::force_density) return "N/m";
  return kind == ConstraintKind::length || kind == ConstraintKind::unstressed_length ? "m" : "N";
}

std::string describe(const Constraint& constraint) {
  return fmt::format("{} of {}", to_string(constraint.kind), constraint.name);
}

std::string wanted_and_found(const Deviation& deviation) {
  constexpr int usual = 6, most = 17;  // digits
  const char* of = unit(deviation.kind);
  std::string wanted, found;
  for (int digits = usual; digits <= most && wanted == found; ++digits) {
    wanted = fmt::format("{:.{}g}", deviation.wanted, digits);
    found = fmt::format("{:.{}g}", deviation.found, digits);
  }
  return fmt::format("{} {} wanted, {} {} found", wanted, of, found, of);
}

std::string to_string(const Deviation& deviation) {
  return fmt::format("{} of {}, {} {}: {}", to_string(deviation.kind), deviation.constraint,
                     is_reaction(deviation.kind) ? "node" : "branch", deviation.member + 1,
                     wanted_and_found(deviation));
}

std::string to_string(const ShortPath& path, const std::string& from, const std::string& to) {
  return fmt::format(
      "the lengths asked for between two fixed nodes, {} and {}, add up to {:.6g} m, but these are {:.6g} m "
      "apart",
      from, to, path.length, path.distance);
}

double weighted_squares(const ConstraintRows& rows, const VecX& missing) {
  return missing.cwiseAbs2().dot(
      Eigen::Map<const VecX>(rows.weight.data(), static_cast<Eigen::Index>(rows.weight.size())));
}

void list_deviations(const std::vector<Constraint>& constraints, const ConstraintRows& rows,
                     const VecX& missing, const ConstrainedOptions& options, ConstrainedResult& result) {
  result.worst.clear();
  result.misses.clear();
  int first = 0;
  for (const Constraint& constraint : constraints) {
    add_miss(constraint, rows, missing, first, options.tolerance, result.worst, result.misses);
    first += static_cast<int>(constraint.members.size());
  }
  const auto larger = [](double a, double b) { return std::abs(a) > std::abs(b); };
  std::stable_sort(result.worst.begin(), result.worst.end(),
                   [&](const auto& a, const auto& b) { return larger(a.relative, b.relative); });
  std::stable_sort(result.misses.begin(), result.misses.end(),
                   [&](const auto& a, const auto& b) { return larger(a.rms, b.rms); });
  if (static_cast<int>(result.worst.size()) > options.n_worst) result.worst.resize(options.n_worst);
}

std::optional<ShortPath> find_short_path(const ConstrainedNet& problem) {
  const Net& net = problem.net;
  const auto next = asked_lengths(problem);
  int sources = 0;
  for (int from = 0; from < static_cast<int>(net.nodes.size()) && sources < most_sources; ++from) {
    if (!net.fixed[from] || next[from].empty()) continue;
    ++sources;
    std::vector<double> reach(net.nodes.size(), std::numeric_limits<double>::infinity());
    std::multimap<double, int> front{{0.0, from}};
    reach[from] = 0;
    while (!front.empty()) {
      const auto [length, node] = *front.begin();
      front.erase(front.begin());
      if (length > reach[node]) continue;
      const double distance = (net.nodes[node] - net.nodes[from]).norm();
      if (net.fixed[node] && length < distance * (1 - 1e-9)) return ShortPath{from, node, length, distance};
      for (const auto& [other, step] : next[node]) {
        if (length + step >= reach[other]) continue;
        reach[other] = length + step;
        front.emplace(reach[other], other);
      }
    }
  }
  return {};
}

}  // namespace tautline::formfinding
