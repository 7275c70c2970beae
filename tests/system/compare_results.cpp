/// @file
/// Compares two results.json: same structure, same texts, each kind of number by its own tolerance. What
/// depends on the machine (times, memory) or on the number of processes is left out.
///
/// usage: compare_results A B [relative tolerance of numbers of no special kind, default 1e-9]
/// exit code 0: equal, 1: different, 2: unreadable

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace {

using Json = nlohmann::ordered_json;

const std::set<std::string> left_out{"wall_seconds", "checkpoint_seconds", "timings", "peak_memory_bytes",
                                     "ranks"};

/// How far two numbers of one kind may lie apart: beside the larger one, or at all.
struct Tolerance {
  double relative = 0, absolute = 0;
};

constexpr Tolerance seven_digits{1e-6, 0}, below_the_tolerance{0, 1e-8}, a_count{0.02, 1}, a_level{1e-3, 0};

/// By name, or by the name above and the name where one does not tell.
const std::map<std::string, Tolerance> tolerances{
    // how far below its tolerance a solve ended is no result
    {"balance/force", below_the_tolerance},
    {"balance/moment", below_the_tolerance},
    {"residuals", below_the_tolerance},
    {"dynamic_relaxation/residual", below_the_tolerance},
    {"descent/residual", below_the_tolerance},
    {"miss_max", {1e-2, 1e-6}},
    {"miss_rms", {1e-2, 1e-6}},
    {"change", {1e-2, 1e-6}},
    // lengths that follow from the inverse of what ties do to tensions: a thousandth of what cutters keep
    {"max_change", {1e-9, 1e-10}},
    {"condition", {1e-2, 0}},
    {"asymmetry", below_the_tolerance},
    // whether the last iteration is needed may hang on the last digit
    {"newton_iterations", a_count},
    {"factorisations", {0.02, 3}},
    // the difference of two tangents leaves seven digits, and so does the search for a critical point; there
    // the
    // motion changes with the square root of the load
    {"factors", seven_digits},
    {"critical_loads", seven_digits},
    {"critical_load", seven_digits},
    {"critical_lambda", seven_digits},
    {"linear_lambda", seven_digits},
    {"limit_lambda", seven_digits},
    {"bifurcation_lambda", seven_digits},
    {"safety_factors", seven_digits},
    {"critical_points/lambda", seven_digits},
    {"load_share", {1e-3, 1e-3}},
    {"monitor", seven_digits},
    {"displacement", {0, 1e-10}},
    {"rotation", {0, 1e-10}},
    // of free bodies: what balances exactly leaves rounding alone
    {"acceleration", {1e-8, 1e-9}},
    {"angular_acceleration", {1e-8, 1e-8}},
    {"centre", {1e-9, 1e-10}},
    // levels of rounding
    {"rounding", a_level},
    {"rounding_moment", a_level},
    {"rounding/force", a_level},
    {"rounding/moment", a_level},
    {"effective_mass_rounding", {1, 0}}};

/// Forces and moments, which mean nothing below the level of rounding that stands beside or above them.
const std::set<std::string> forces{"tension_min", "tension_max", "tension_mean",  "tension_rms_from_target",
                                   "axial_min",   "axial_max",   "principal_min", "principal_max",
                                   "force_max",   "force",       "applied_force", "step0_out_of_balance"};
const std::set<std::string> moments{"moment_max", "moment", "step0_out_of_balance_moment"};

/// The names on the way to a number, without the indices of lists.
std::vector<std::string> names_of(const std::string& path) {
  std::vector<std::string> names;
  std::istringstream stream(path);
  for (std::string name; std::getline(stream, name, '/');)
    if (!name.empty() && name.find_first_not_of("0123456789") != std::string::npos) names.push_back(name);
  return names;
}

/// Levels of rounding that hold for an object and all below it.
struct Levels {
  double force = 0, moment = 0;

  /// Those of an object that states its own.
  static Levels of(const Json& object, const Levels& above) {
    if (!object.contains("rounding") || object.contains("applied_force")) return above;
    const Json& own = object["rounding"];
    if (own.is_number()) return {own, object.value("rounding_moment", own.get<double>())};
    return own.contains("force") ? Levels{own["force"], own["moment"]} : above;
  }
};

/// Walks through both files side by side and keeps what differs.
class Comparison {
 public:
  explicit Comparison(double tolerance) : tolerance_(tolerance) {}

  void compare(const Json& a, const Json& b, const std::string& path, const Levels& levels = {}) {
    if (a.is_number() && b.is_number())
      return compare_numbers(a.get<double>(), b.get<double>(), path, tolerance_of(path, levels));
    if (a.type() != b.type()) return other(path, a, b);
    if (a.is_object()) return compare_objects(a, b, path, Levels::of(a, levels));
    if (a.is_array()) return compare_arrays(a, b, path, levels);
    if (a != b) other(path, a, b);
  }

  bool equal() const { return others_.empty() && n_beyond() == 0; }

  void print() {
    fmt::print("{} numbers compared, {} beyond their tolerance, at most {:.3g} of it\n", n_numbers_,
               n_beyond(), worst());
    for (const auto& text : others_) fmt::print("  {}\n", text);
    std::sort(numbers_.begin(), numbers_.end(),
              [](const auto& x, const auto& y) { return x.of_tolerance > y.of_tolerance; });
    constexpr std::size_t most = 20;
    for (std::size_t i = 0; i < std::min(numbers_.size(), most); ++i) {
      const auto& d = numbers_[i];
      if (i < 3 || d.of_tolerance > 1)
        fmt::print("  {:<60} {:.17g}  {:.17g}  ({:.2e} of the tolerance)\n", d.path, d.a, d.b,
                   d.of_tolerance);
    }
  }

 private:
  struct Difference {
    std::string path;
    double a, b, of_tolerance;
  };

  Tolerance tolerance_of(const std::string& path, const Levels& levels) const {
    constexpr double some = 10;  // of the levels, where errors add up
    const auto names = names_of(path);
    if (names.empty()) return {tolerance_, 0};
    for (std::size_t above = 0; above + 1 < names.size(); ++above)
      if (const auto found = tolerances.find(names[above] + '/' + names.back()); found != tolerances.end())
        return found->second;
    if (const auto found = tolerances.find(names.back()); found != tolerances.end()) return found->second;
    if (forces.count(names.back()) > 0) return {tolerance_, some * levels.force};
    if (moments.count(names.back()) > 0) return {tolerance_, some * levels.moment};
    return {tolerance_, 0};
  }

  void compare_numbers(double a, double b, const std::string& path, const Tolerance& tolerance) {
    compare_beside(a, b, std::max(std::abs(a), std::abs(b)), path, tolerance);
  }

  /// Numbers that belong to something of `size`.
  void compare_beside(double a, double b, double size, const std::string& path, const Tolerance& tolerance) {
    ++n_numbers_;
    if (a == b) return;
    const double share = std::abs(a - b) / std::max(tolerance.relative * size, tolerance.absolute);
    numbers_.push_back({path, a, b, std::isnan(share) ? INFINITY : share});
  }

  void compare_objects(const Json& a, const Json& b, const std::string& path, const Levels& levels) {
    for (const auto& [key, value] : a.items()) {
      if (left_out.count(key) > 0) continue;
      if (!b.contains(key))
        others_.push_back(fmt::format("{}/{} is missing in the second file", path, key));
      else if (key == "effective_mass")
        compare_masses(a, b, path);
      else if (key != "balance" || !is_noise(value) || !is_noise(b[key]))
        compare(value, b[key], path + "/" + key, levels);
    }
    for (const auto& [key, value] : b.items())
      if (!a.contains(key)) others_.push_back(fmt::format("{}/{} is missing in the first file", path, key));
  }

  /// A balance of forces that are rounding themselves.
  static bool is_noise(const Json& balance) {
    return balance.is_object() && balance.value("rounding", 0.0) > 1e-3;
  }

  /// Shares of mass: the square of a component, which errs by `level`; none is compared more closely than to
  /// ten digits of the largest of its kind, translations or rotations.
  void compare_masses(const Json& a, const Json& b, const std::string& path) {
    const char *name = "effective_mass", *levels = "effective_mass_rounding";
    if (a[name].size() != b[name].size() || !a.contains(levels)) return other(path, a[name], b[name]);
    double largest[2] = {0, 0};
    for (const auto& mode : a[name])
      for (std::size_t k = 0; k < mode.size(); ++k)
        largest[k / 3 % 2] = std::max(largest[k / 3 % 2], mode[k].get<double>());
    for (std::size_t i = 0; i < a[name].size(); ++i)
      for (std::size_t k = 0; k < a[name][i].size(); ++k) {
        const double x = a[name][i][k], y = b[name][i][k];
        const double level = std::max({a[levels][i][k].get<double>(), b[levels][i][k].get<double>(),
                                       1e-24 * std::max(largest[0], largest[1])});
        compare_numbers(x, y, fmt::format("{}/{}/{}/{}", path, name, i, k),
                        {tolerance_, std::max(10 * (level + 2 * std::sqrt(level * std::max(x, y))),
                                              1e-10 * largest[k / 3 % 2])});
      }
  }

  /// Components of a vector in space, which are compared beside the whole vector's length.
  static bool is_vector(const Json& list, const std::string& path) {
    static const std::set<std::string> names{"force", "moment", "displacement", "rotation", "applied_force"};
    return list.size() == 3 && list[0].is_number() && names.count(path.substr(path.rfind('/') + 1)) > 0;
  }

  void compare_vectors(const Json& a, const Json& b, const std::string& path, const Levels& levels) {
    const auto length = [](const Json& v) {
      return std::hypot(v[0].get<double>(), v[1].get<double>(), v[2].get<double>());
    };
    const bool critical = path.find("/critical_points/") != std::string::npos;
    auto tolerance = tolerance_of(path, levels);
    tolerance.relative = critical ? 1e-4 : tolerance_;
    const double size = std::max(length(a), length(b));
    for (std::size_t i = 0; i < 3; ++i)
      compare_beside(a[i], b[i], size, fmt::format("{}/{}", path, i), tolerance);
  }

  /// Out-of-balance and increment by iteration: each follows from the one before, of which the solver leaves
  /// some digits; the last one may be needed or not.
  void compare_histories(const Json& a, const Json& b, const std::string& path, const Levels& levels) {
    constexpr double digits = 1e-3, digits_left = 1e-4, increment_level = 1e-9;
    const std::size_t n = std::min(a.size(), b.size());
    if (std::max(a.size(), b.size()) > n + 1) other(path, a.size(), b.size());
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < 2; ++k) {
        const double before = i > 0 ? std::max(a[i - 1][k].get<double>(), b[i - 1][k].get<double>()) : 0;
        const double level = k == 0 ? 100 * levels.force : increment_level;
        compare_numbers(a[i][k], b[i][k], fmt::format("{}/{}/{}", path, i, k),
                        {digits, std::max(level, digits_left * before)});
      }
  }

  /// Lists that tell of one thing, whose entries are compared beside the largest.
  void compare_lists(const Json& a, const Json& b, const std::string& path) {
    double size = 0;
    for (const auto& value : a) size = std::max(size, std::abs(value.get<double>()));
    for (std::size_t i = 0; i < a.size(); ++i)
      compare_beside(a[i], b[i], size, fmt::format("{}/{}", path, i), {tolerance_, 0});
  }

  void compare_arrays(const Json& a, const Json& b, const std::string& path, const Levels& levels) {
    if (is_vector(a, path) && is_vector(b, path)) return compare_vectors(a, b, path, levels);
    if (path.ends_with("/force_and_increment")) return compare_histories(a, b, path, levels);
    if (path.ends_with("/moments") && a.size() == b.size()) return compare_lists(a, b, path);
    if (a.size() != b.size())
      others_.push_back(fmt::format("{} has {} entries and {} entries", path, a.size(), b.size()));
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
      compare(a[i], b[i], fmt::format("{}/{}", path, i), levels);
  }

  void other(const std::string& path, const Json& a, const Json& b) {
    others_.push_back(fmt::format("{}: {} and {}", path, a.dump(), b.dump()));
  }

  double worst() const {
    double worst = 0;
    for (const auto& d : numbers_) worst = std::max(worst, d.of_tolerance);
    return worst;
  }

  std::size_t n_beyond() const {
    return static_cast<std::size_t>(
        std::count_if(numbers_.begin(), numbers_.end(), [](const auto& d) { return d.of_tolerance > 1; }));
  }

  double tolerance_;
  std::size_t n_numbers_ = 0;
  std::vector<Difference> numbers_;
  std::vector<std::string> others_;
};

Json read(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + ": cannot be read");
  return Json::parse(file);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3 && argc != 4) {
    std::cerr << "usage: compare_results A B [relative tolerance]\n";
    return 2;
  }
  try {
    Comparison comparison(argc == 4 ? std::stod(argv[3]) : 1e-9);
    comparison.compare(read(argv[1]), read(argv[2]), "");
    comparison.print();
    return comparison.equal() ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
