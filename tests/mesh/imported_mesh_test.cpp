#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <tautline/core/error.hpp>
#include <tautline/mesh/imported_mesh.hpp>

#include "messages.hpp"

namespace tautline::mesh {
namespace {

using testing_messages::mentions;
using testing_messages::message_of;

/// A file that lives as long as the test.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text)
      : path_(std::filesystem::temp_directory_path() /
              ("tautline_mesh_" + std::to_string(getpid()) + ".msh")) {
    std::ofstream(path_) << text;
  }
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

/// A mesh in the second version of the format, as other programs write it.
std::string msh2(const std::string& names, const std::string& nodes, const std::string& elements) {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + names + "$Nodes\n" + nodes + "$EndNodes\n$Elements\n" +
         elements + "$EndElements\n";
}

TEST(ImportedMesh, OfAFileThatDoesNotExistIsRefusedBeforeGmshIsAsked) {
  const auto message = message_of<LibraryError>([] { import_gmsh("/nowhere/at_all.msh"); });
  EXPECT_TRUE(mentions(message, "/nowhere/at_all.msh"));
  EXPECT_TRUE(mentions(message, "no such file"));
}

#if TAUTLINE_TEST_GMSH

ImportedMesh square_membrane() {
  return import_gmsh(TAUTLINE_SOURCE_DIR "/meshes/square_membrane.msh");
}

TEST(ImportedMesh, HasTheNodesAndTheCellsOfEachPhysicalGroup) {
  const auto mesh = square_membrane();
  EXPECT_EQ(mesh.nodes.size(), 25u);
  ASSERT_EQ(mesh.groups.size(), 3u);
  EXPECT_EQ(mesh.groups.at("cloth").triangles.size(), 32u);
  EXPECT_EQ(mesh.groups.at("edge").lines.size(), 16u);
  EXPECT_EQ(mesh.groups.at("corners").points.size(), 4u);
  EXPECT_TRUE(mesh.groups.at("cloth").lines.empty());
  EXPECT_TRUE(mesh.groups.at("edge").triangles.empty());
}

TEST(ImportedMesh, HasTheAreaAndTheEdgeLengthOfTheSquare) {
  const auto mesh = square_membrane();
  double area = 0, edge = 0;
  for (const auto& [a, b, c] : mesh.groups.at("cloth").triangles)
    area += 0.5 * (mesh.nodes[b] - mesh.nodes[a]).cross(mesh.nodes[c] - mesh.nodes[a]).z();
  for (const auto& [a, b] : mesh.groups.at("edge").lines) edge += (mesh.nodes[b] - mesh.nodes[a]).norm();
  EXPECT_NEAR(area, 1, 1e-12);
  EXPECT_NEAR(edge, 4, 1e-12);
}

TEST(ImportedMesh, HasItsPointGroupInTheCorners) {
  const auto mesh = square_membrane();
  std::set<std::pair<double, double>> corners;
  for (const int node : mesh.groups.at("corners").points)
    corners.insert({mesh.nodes[node].x(), mesh.nodes[node].y()});
  EXPECT_EQ(corners, (std::set<std::pair<double, double>>{{0, 0}, {0, 1}, {1, 0}, {1, 1}}));
}

TEST(ImportedMesh, IsTheSameWhenReadAgain) {
  const auto first = square_membrane(), second = square_membrane();
  ASSERT_EQ(first.nodes.size(), second.nodes.size());
  for (std::size_t i = 0; i < first.nodes.size(); ++i) EXPECT_EQ(first.nodes[i], second.nodes[i]);
  EXPECT_EQ(first.groups.at("cloth").triangles, second.groups.at("cloth").triangles);
}

constexpr auto one_surface = "$PhysicalNames\n1\n2 7 \"cloth\"\n$EndPhysicalNames\n";

TEST(ImportedMesh, KeepsQuadrilateralsInTheirOrder) {
  const TemporaryFile file(
      msh2(one_surface, "4\n1 0 0 0\n2 2 0 0\n3 3 1 0\n4 1 1 0\n", "1\n1 3 2 7 1 1 2 3 4\n"));
  const auto mesh = import_gmsh(file.path());
  const auto& cloth = mesh.groups.at("cloth");
  EXPECT_TRUE(cloth.triangles.empty());
  ASSERT_EQ(cloth.quadrilaterals.size(), 1u);
  const Points corners{{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {1, 1, 0}};
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(mesh.nodes[static_cast<std::size_t>(cloth.quadrilaterals[0][i])], corners[i]);
}

TEST(ImportedMesh, DropsNodesThatNoNamedGroupUses) {
  const TemporaryFile file(msh2(one_surface, "5\n1 9 9 9\n2 0 0 0\n3 1 0 0\n4 8 8 8\n5 0 1 0\n",
                                "2\n1 2 2 7 1 2 3 5\n2 1 2 3 2 1 4\n"));
  const auto mesh = import_gmsh(file.path());
  ASSERT_EQ(mesh.nodes.size(), 3u);
  EXPECT_EQ(mesh.nodes[0], Vec3(0, 0, 0));
  EXPECT_EQ(mesh.nodes[1], Vec3(1, 0, 0));
  EXPECT_EQ(mesh.nodes[2], Vec3(0, 1, 0));
  EXPECT_EQ(mesh.groups.at("cloth").triangles.front(), (std::array<int, 3>{0, 1, 2}));
}

TEST(ImportedMesh, OfSecondOrderIsRefusedWithTheNameOfTheCell) {
  const TemporaryFile file(msh2(one_surface, "6\n1 0 0 0\n2 2 0 0\n3 0 2 0\n4 1 0 0\n5 1 1 0\n6 0 1 0\n",
                                "1\n1 9 2 7 1 1 2 3 4 5 6\n"));
  const auto message = message_of<ModelError>([&] { import_gmsh(file.path()); });
  for (const char* part : {"\"Triangle 6\"", "order 2", "\"cloth\"", "Mesh.ElementOrder = 1"})
    EXPECT_TRUE(mentions(message, part));
}

TEST(ImportedMesh, WithSolidsIsRefusedWithTheNameOfTheCell) {
  const TemporaryFile file(msh2("$PhysicalNames\n1\n3 1 \"rock\"\n$EndPhysicalNames\n",
                                "4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n", "1\n1 4 2 1 1 1 2 3 4\n"));
  const auto message = message_of<ModelError>([&] { import_gmsh(file.path()); });
  EXPECT_TRUE(mentions(message, "Tetrahedron 4"));
  EXPECT_TRUE(mentions(message, "dimension 3"));
}

TEST(ImportedMesh, WithoutANamedGroupIsRefused) {
  const TemporaryFile file(msh2("", "3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n", "1\n1 2 2 7 1 1 2 3\n"));
  const auto message = message_of<ModelError>([&] { import_gmsh(file.path()); });
  EXPECT_TRUE(mentions(message, "named physical group"));
}

/// A script that leaves a file when gmsh runs it.
std::string script_that_makes(const std::string& path) {
  return "SystemCall \"touch " + path + "\";\nPoint(1) = {0, 0, 0, 1};\n";
}

TEST(ImportedMesh, OfAScriptIsRefusedAndTheScriptNotRun) {
  const std::string mark =
      (std::filesystem::temp_directory_path() / ("ran_" + std::to_string(getpid()))).string();
  for (const std::string before : {"", "// $MeshFormat\n", " $MeshFormat\n", "$Comments\n$EndComments\n"}) {
    const TemporaryFile file(before + script_that_makes(mark));
    const auto message = message_of<ModelError>([&] { import_gmsh(file.path()); });
    EXPECT_TRUE(mentions(message, "is not a gmsh mesh"));
    EXPECT_FALSE(std::filesystem::exists(mark));
  }
  std::filesystem::remove(mark);
}

TEST(ImportedMesh, RunsNoScriptThatLiesBesideTheFile) {
  const std::string mark =
      (std::filesystem::temp_directory_path() / ("ran_" + std::to_string(getpid()))).string();
  const TemporaryFile file(msh2(one_surface, "3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n", "1\n1 2 2 7 1 1 2 3\n"));
  std::ofstream(file.path() + ".opt") << script_that_makes(mark);
  EXPECT_EQ(import_gmsh(file.path()).nodes.size(), 3u);
  EXPECT_FALSE(std::filesystem::exists(mark));
  std::filesystem::remove(file.path() + ".opt");
  std::filesystem::remove(mark);
}

/// A text with the first occurrence of a part replaced, which must be there.
std::string with(std::string text, const std::string& part, const std::string& other) {
  const auto at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return at == std::string::npos ? text : text.replace(at, part.size(), other);
}

/// gmsh would read as many as the file says and leave out the others.
TEST(ImportedMesh, ThatSaysLessThanItHoldsIsRefused) {
  const std::string two =
      msh2(one_surface, "4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 1 1 0\n", "2\n1 2 2 7 1 1 2 3\n2 2 2 7 1 2 4 3\n");
  const std::string four =
      with(with(msh2(one_surface, "1 4 1 4\n2 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n",
                     "1 2 1 2\n2 1 2 2\n1 1 2 3\n2 2 4 3\n"),
                "2.2", "4.1"),
           "$Nodes", "$Entities\n0 0 1 0\n1 0 0 0 1 1 0 1 7 0\n$EndEntities\n$Nodes");
  EXPECT_EQ(import_gmsh(TemporaryFile(two).path()).groups.at("cloth").triangles.size(), 2u);
  EXPECT_EQ(import_gmsh(TemporaryFile(four).path()).groups.at("cloth").triangles.size(), 2u);
  for (const std::string& damaged :
       {with(two, "$Elements\n2", "$Elements\n1"), with(two, "$Nodes\n4", "$Nodes\n3"),
        with(four, "1 2 1 2\n2 1 2 2", "1 1 1 2\n2 1 2 1"),
        with(four, "1 2 1 2\n2 1 2 2", "1 1 1 2\n2 1 2 2"), with(four, "1 4 1 4", "1 3 1 4"),
        with(four, "1 4 1 4", "2 4 1 4")}) {
    const TemporaryFile file(damaged);
    EXPECT_TRUE(mentions(message_of<ModelError>([&] { import_gmsh(file.path()); }), "is damaged: it "))
        << damaged;
  }
}

TEST(ImportedMesh, WithANodeThatIsNoNumberIsRefused) {
  for (const std::string bad : {"nan", "inf", "-inf"}) {
    const TemporaryFile file(
        msh2(one_surface, "3\n1 0 0 0\n2 1 0 " + bad + "\n3 0 1 0\n", "1\n1 2 2 7 1 1 2 3\n"));
    EXPECT_TRUE(mentions(message_of<ModelError>([&] { import_gmsh(file.path()); }), "no finite numbers"));
  }
}

TEST(ImportedMesh, OfAFileThatGmshCannotParseIsALibraryError) {
  const TemporaryFile file("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\nthis is no number\n$EndNodes\n");
  const auto message = message_of<LibraryError>([&] { import_gmsh(file.path()); });
  EXPECT_TRUE(mentions(message, file.path()));
}

#else

TEST(ImportedMesh, WithoutThePluginSaysHowToGetIt) {
  const TemporaryFile file("");
  const auto message = message_of<LibraryError>([&] { import_gmsh(file.path()); });
  EXPECT_TRUE(mentions(message, "TAUTLINE_WITH_GMSH=ON"));
}

#endif

}  // namespace
}  // namespace tautline::mesh
