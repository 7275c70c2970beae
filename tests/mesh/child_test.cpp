#include <gtest/gtest.h>

#include <csignal>
#include <new>
#include <stdexcept>
#include <vector>

#include "mesh/child.hpp"
#include "mesh/mesh_bytes.hpp"

namespace tautline::mesh {
namespace {

std::string fault_of(const std::function<std::string()>& work, const ChildLimits& limits = {}) {
  std::string fault;
  const std::string result = in_child(work, limits, fault);
  EXPECT_EQ(result, fault.empty() ? work() : "");
  return fault;
}

TEST(Child, BringsWhatItsWorkReturned) {
  EXPECT_EQ(fault_of([] { return std::string(); }), "");
  EXPECT_EQ(fault_of([] { return std::string(1'000'000, '\0'); }), "") << "more than a pipe holds at once";
}

TEST(Child, ThatBreaksDownIsTold) {
  EXPECT_EQ(fault_of([]() -> std::string {
              std::raise(SIGSEGV);
              return "";
            }),
            "it broke down (Segmentation fault)");
  EXPECT_EQ(fault_of([]() -> std::string { throw std::runtime_error("lost"); }),
            "it broke down, or memory was short");
}

TEST(Child, WithoutEndIsStopped) {
  EXPECT_EQ(fault_of(
                []() -> std::string {
                  for (volatile int i = 0;;) i = 1 - i;
                },
                {0, 1}),
            "no end of it within 1 s");
}

#ifndef __SANITIZE_ADDRESS__
TEST(Child, ThatTakesTooMuchMemoryIsTold) {
  const auto work = [] { return std::string(std::vector<char>(200U << 20U, 'x').data(), 1); };
  EXPECT_EQ(fault_of(work, {400U << 20U, 0}), "");
  EXPECT_EQ(fault_of(work, {100U << 20U, 0}), "it broke down, or memory was short");
}
#endif

Reading some_reading() {
  Reading reading;
  reading.outcome = gmsh_plugin::Outcome::read;
  reading.reason = "none";
  reading.mesh.nodes = {{0, 0, 0}, {1, 0.5, -2}};
  reading.mesh.groups["edge"].lines = {{0, 1}};
  reading.mesh.groups["corner"].points = {1};
  reading.mesh.groups["cloth"].triangles = {{0, 1, 0}};
  reading.mesh.groups["cloth"].quadrilaterals = {{1, 0, 1, 0}};
  return reading;
}

TEST(MeshBytes, HoldTheMesh) {
  const Reading there = some_reading(), back = from_bytes(to_bytes(there));
  EXPECT_EQ(back.outcome, there.outcome);
  EXPECT_EQ(back.reason, there.reason);
  EXPECT_EQ(back.mesh.nodes, there.mesh.nodes);
  ASSERT_EQ(back.mesh.groups.size(), there.mesh.groups.size());
  for (const auto& [name, group] : there.mesh.groups) {
    const auto& other = back.mesh.groups.at(name);
    EXPECT_EQ(other.points, group.points);
    EXPECT_EQ(other.lines, group.lines);
    EXPECT_EQ(other.triangles, group.triangles);
    EXPECT_EQ(other.quadrilaterals, group.quadrilaterals);
  }
}

TEST(MeshBytes, ThatAreCutOffAreNoMesh) {
  const std::string bytes = to_bytes(some_reading());
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_THROW(from_bytes(bytes.substr(0, n)), std::runtime_error) << n;
  EXPECT_THROW(from_bytes(bytes + "x"), std::runtime_error);
}

}  // namespace
}  // namespace tautline::mesh
