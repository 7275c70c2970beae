/// @file
/// Compares two results.json: same structure, same texts, numbers equal to a relative tolerance. What depends
/// on the machine (times, memory) or on the number of processes is left out.
///
/// usage: compare_results A B [relative tolerance, default 1e-9]     exit code 0: equal, 1: different, 2:
/// unreadable

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace {

using Json = nlohmann::ordered_json;

const std::set<std::string> left_out{"wall_seconds", "timings", "peak_memory_bytes", "ranks"};

/// Walks through both files side by side and keeps what differs.
class Comparison {
 public:
  explicit Comparison(double tolerance) : tolerance_(tolerance) {}

  void compare(const Json& a, const Json& b, const std::string& path) {
    if (a.is_number() && b.is_number()) return compare_numbers(a.get<double>(), b.get<double>(), path);
    if (a.type() != b.type()) return other(path, a, b);
    if (a.is_object()) return compare_objects(a, b, path);
    if (a.is_array()) return compare_arrays(a, b, path);
    if (a != b) other(path, a, b);
  }

  bool equal() const { return others_.empty() && worst() <= tolerance_; }

  void print() {
    fmt::print("{} numbers compared, {} beyond {:g} relative, largest difference {:.3g}\n", n_numbers_,
               n_beyond(), tolerance_, worst());
    for (const auto& text : others_) fmt::print("  {}\n", text);
    std::sort(numbers_.begin(), numbers_.end(),
              [](const auto& x, const auto& y) { return x.relative > y.relative; });
    constexpr std::size_t most = 20;
    for (std::size_t i = 0; i < std::min(numbers_.size(), most); ++i) {
      const auto& d = numbers_[i];
      if (i < 3 || d.relative > tolerance_)
        fmt::print("  {:<60} {:.17g}  {:.17g}  ({:.2e})\n", d.path, d.a, d.b, d.relative);
    }
  }

 private:
  struct Difference {
    std::string path;
    double a, b, relative;
  };

  void compare_numbers(double a, double b, const std::string& path) {
    ++n_numbers_;
    if (a == b) return;
    const double relative = std::abs(a - b) / std::max(std::abs(a), std::abs(b));
    numbers_.push_back({path, a, b, std::isnan(relative) ? INFINITY : relative});
  }

  void compare_objects(const Json& a, const Json& b, const std::string& path) {
    for (const auto& [key, value] : a.items()) {
      if (left_out.count(key) > 0) continue;
      if (b.contains(key))
        compare(value, b[key], path + "/" + key);
      else
        others_.push_back(fmt::format("{}/{} is missing in the second file", path, key));
    }
    for (const auto& [key, value] : b.items())
      if (!a.contains(key)) others_.push_back(fmt::format("{}/{} is missing in the first file", path, key));
  }

  /// Components of a vector in space, which are compared beside the whole vector's length.
  static bool is_vector(const Json& list, const std::string& path) {
    static const std::set<std::string> names{"force", "moment", "displacement", "rotation", "applied_force"};
    return list.size() == 3 && list[0].is_number() && names.count(path.substr(path.rfind('/') + 1)) > 0;
  }

  void compare_vectors(const Json& a, const Json& b, const std::string& path) {
    const auto length = [](const Json& v) {
      return std::hypot(v[0].get<double>(), v[1].get<double>(), v[2].get<double>());
    };
    const double size = std::max(length(a), length(b));
    for (std::size_t i = 0; i < 3; ++i) {
      ++n_numbers_;
      const double x = a[i].get<double>(), y = b[i].get<double>();
      if (x != y) numbers_.push_back({fmt::format("{}/{}", path, i), x, y, std::abs(x - y) / size});
    }
  }

  void compare_arrays(const Json& a, const Json& b, const std::string& path) {
    if (is_vector(a, path) && is_vector(b, path)) return compare_vectors(a, b, path);
    if (a.size() != b.size())
      others_.push_back(fmt::format("{} has {} entries and {} entries", path, a.size(), b.size()));
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
      compare(a[i], b[i], fmt::format("{}/{}", path, i));
  }

  void other(const std::string& path, const Json& a, const Json& b) {
    others_.push_back(fmt::format("{}: {} and {}", path, a.dump(), b.dump()));
  }

  double worst() const {
    double worst = 0;
    for (const auto& d : numbers_) worst = std::max(worst, d.relative);
    return worst;
  }

  std::size_t n_beyond() const {
    return static_cast<std::size_t>(std::count_if(numbers_.begin(), numbers_.end(),
                                                  [&](const auto& d) { return d.relative > tolerance_; }));
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
