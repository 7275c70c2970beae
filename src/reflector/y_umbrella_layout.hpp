#pragma once
/// @file
/// Where the nodes of an umbrella with Y-shaped spokes are. Theory: docs/theory/large_reflectors.md

#include <tautline/reflector/paraboloid.hpp>
#include <tautline/reflector/y_umbrella_options.hpp>

namespace tautline::reflector {

/// Spoke s at azimuth 2 pi s / spokes; place i of `parts` between it and the next, at equal angles.
class YUmbrellaLayout {
 public:
  /// @throws ModelError if the nets touch
  explicit YUmbrellaLayout(const YUmbrellaOptions& options);

  double tip_radius() const { return tip_radius_; }
  /// A point of ring k (0: the hub) of the net, `place` from spoke to spoke, 0 to 1: straight in plan.
  Vec3 tangential(int s, int k, double place) const;
  /// Parts of a tangential cord: about as long as those of the power ring.
  int parts_of(int k) const;
  /// Radius of the power ring at place i: a conic about the centre, on which equal pushes towards the centre
  /// are borne without another force [m].
  double ring_radius(int i) const;
  Vec3 on_surface(int s, int i, double radius) const;
  /// In the plane of the spokes.
  Vec3 in_plane(int s, double radius) const;

  /// What stands at place i: a beam from `ring` to `outer`, and the X under it.
  struct Braced {
    Vec3 ring, outer, rear_ring, rear_outer, crossing;
  };
  Braced braced(int s, int i) const;

 private:
  double azimuth(int s, double i) const;
  double radius_of(int k) const;
  /// In the vertical plane at place i, the straight line between two spokes at this radius, on the rear.
  Vec3 rear_chord(int s, int i, double radius) const;
  Vec3 sagging(int s, int i, double radius, double sag, const Vec3& towards) const;

  const YUmbrellaOptions& options_;
  Paraboloid surface_;
  double half_sector_, tip_radius_;
};

}  // namespace tautline::reflector
