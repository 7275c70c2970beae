// Normals of shells at their nodes. Theory: docs/theory/shell.md#director
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/LU>

#include <tautline/model/model.hpp>

namespace tautline::model {

namespace {

constexpr double smooth = 0.9397;    // cosine of 20 degrees: beyond, an edge is a fold
constexpr double same_place = 1e-5;  // over the length of an edge
constexpr std::size_t most_images = 128;

/// A facet at one of its nodes: its normal, weighted, and its two sides there.
struct Corner {
  std::size_t shell;
  int at;        ///< which of the shell's nodes
  Vec3 normal;   ///< by the right-hand rule of the node order
  Vec3 out, in;  ///< to the next node of the order and to the previous one
  int next, previous;
};

/// Where the shells at another node, or at the same, appear once more by symmetry: turned or mirrored.
struct Image {
  int node;
  Mat3 map;
};

/// A corner seen in one image.
struct Facet {
  Vec3 normal, out, in;
  int next, previous;
  std::size_t image;
  double sign = 0;  ///< of its normal in its patch; 0: not met yet
};

/// The weight makes the sum over the corners at a node exact on a sphere (Max 1999, Weights for computing
/// vertex normals from facet normals, J. Graphics Tools 4(2), 1-6).
Corner corner_of(const Model& model, std::size_t shell, int at) {
  const auto& nodes = model.shells[shell].nodes;
  const int n = nodes.size(), next = nodes[(at + 1) % n], previous = nodes[(at + n - 1) % n];
  const Vec3& here = model.nodes[static_cast<std::size_t>(nodes[at])];
  const Vec3 out = model.nodes[static_cast<std::size_t>(next)] - here;
  const Vec3 in = model.nodes[static_cast<std::size_t>(previous)] - here;
  return {shell, at, out.cross(in) / (out.squaredNorm() * in.squaredNorm()), out, in, next, previous};
}

/// The maps that a symmetry of the deck makes from the surroundings of one node to those of another.
class Symmetries {
 public:
  explicit Symmetries(const Model& model) : maps_(model.nodes.size()) {
    for (const auto& support : model.supports) {
      if (!support.symmetry) continue;
      const Vec3 normal = support.axes.col(0);
      for (const int node : support.nodes)
        at(node).push_back({node, Mat3::Identity() - 2 * normal * normal.transpose()});
    }
    for (const auto& pair : model.cyclic_pairs) {
      at(pair.leader).push_back({pair.follower, pair.turn.transpose()});
      at(pair.follower).push_back({pair.leader, pair.turn});
    }
    add_axes(model);
  }

  /// All images of shells that meet at a node; itself is the first.
  std::vector<Image> images_at(int node) const {
    std::vector<Image> images{{node, Mat3::Identity()}};
    for (std::size_t i = 0; i < images.size() && images.size() < most_images; ++i)
      for (const auto& [to, map] : maps_[static_cast<std::size_t>(images[i].node)]) {
        const Image found{to, images[i].map * map};
        bool known = false;
        for (const auto& image : images)
          known = known || (image.node == to && (image.map - found.map).norm() < 1e-6);
        if (!known) images.push_back(found);
      }
    return images;
  }

 private:
  std::vector<Image>& at(int node) { return maps_[static_cast<std::size_t>(node)]; }

  /// A node on the axis of a turn is its own image.
  void add_axes(const Model& model) {
    std::vector<CyclicPair> turns;  // one pair of each turn
    for (const auto& pair : model.cyclic_pairs) {
      bool known = false;
      for (const auto& other : turns) known = known || (other.turn - pair.turn).norm() < 1e-9;
      if (!known) turns.push_back(pair);
    }
    for (const auto& [leader, follower, turn] : turns)
      for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        const Vec3 from = model.nodes[static_cast<std::size_t>(leader)] - model.nodes[i];
        const Vec3 to = model.nodes[static_cast<std::size_t>(follower)] - model.nodes[i];
        if ((turn * from - to).norm() > same_place * from.norm()) continue;
        const int node = static_cast<int>(i);
        at(node).push_back({node, turn});
        at(node).push_back({node, turn.transpose()});
      }
  }

  std::vector<std::vector<Image>> maps_;  // by node
};

/// All facets that meet at one node, images included.
class Meeting {
 public:
  Meeting(const std::vector<std::vector<Corner>>& corners, const std::vector<Image>& images) {
    for (std::size_t k = 0; k < images.size(); ++k) {
      const Mat3& map = images[k].map;
      const double hand = map.determinant() < 0 ? -1 : 1;  // a mirror image is ordered the other way round
      for (const auto& c : corners[static_cast<std::size_t>(images[k].node)])
        facets_.push_back({hand * (map * c.normal), map * c.out, map * c.in, c.next, c.previous, k});
    }
  }

  /// Unit normal of the smooth patch of the facet `index`, on that facet's side.
  Vec3 normal_at(std::size_t index) {
    for (auto& facet : facets_) facet.sign = 0;
    std::vector<std::size_t> patch{index};
    facets_[index].sign = 1;
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < patch.size(); ++i) {
      const Facet& known = facets_[patch[i]];
      sum += known.sign * known.normal;
      for (std::size_t j = 0; j < facets_.size(); ++j)
        if (facets_[j].sign == 0)
          if (const double sign = continues(known, facets_[j]); sign != 0) {
            facets_[j].sign = known.sign * sign;
            patch.push_back(j);
          }
    }
    return sum.normalized();
  }

 private:
  static bool same_side(const Facet& a, const Vec3& side_a, int node_a, const Facet& b, const Vec3& side_b,
                        int node_b) {
    if (a.image == b.image) return node_a == node_b;
    return (side_a - side_b).norm() <= same_place * side_a.norm();
  }

  /// +1 where facets share a side at less than 20 degrees, -1 if in addition their nodes run round them in
  /// opposite senses, 0 if they do not or meet at a fold.
  static double continues(const Facet& a, const Facet& b) {
    const auto across = [&](double sign) {
      return sign * a.normal.dot(b.normal) >= smooth * a.normal.norm() * b.normal.norm();
    };
    const bool alike =
        same_side(a, a.out, a.next, b, b.in, b.previous) || same_side(a, a.in, a.previous, b, b.out, b.next);
    if (alike && across(1)) return 1;
    const bool reversed =
        same_side(a, a.out, a.next, b, b.out, b.next) || same_side(a, a.in, a.previous, b, b.in, b.previous);
    return reversed && across(-1) ? -1 : 0;
  }

  std::vector<Facet> facets_;
};

}  // namespace

void find_directors(Model& model) {
  if (model.shells.empty()) return;
  std::vector<std::vector<Corner>> corners(model.nodes.size());
  for (std::size_t i = 0; i < model.shells.size(); ++i)
    for (int k = 0; k < model.shells[i].nodes.size(); ++k)
      corners[static_cast<std::size_t>(model.shells[i].nodes[k])].push_back(corner_of(model, i, k));
  const Symmetries symmetries(model);
  for (std::size_t node = 0; node < corners.size(); ++node) {
    if (corners[node].empty()) continue;
    Meeting meeting(corners, symmetries.images_at(static_cast<int>(node)));
    for (std::size_t i = 0; i < corners[node].size(); ++i) {
      const auto& corner = corners[node][i];
      model.shells[corner.shell].director[static_cast<std::size_t>(corner.at)] = meeting.normal_at(i);
    }
  }
}

}  // namespace tautline::model
