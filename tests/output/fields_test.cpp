#include <tautline/output/fields.hpp>

#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <tautline/core/error.hpp>
#include "output/temporary_directory.hpp"

namespace tautline::output {
namespace {

using test::contents;
using test::message_of;
using test::put;
using test::TemporaryDirectory;

FieldGrid square() {
  FieldGrid grid;
  grid.points = {{0, 0, 0}, {1.0 / 3, 0, 0}, {1, 1, 0}, {0, 1, 0.5}};
  grid.lines = {{0, 1}, {3, 0}};
  grid.facets = {{0, 1, 2}, {0, 2, 3}};
  grid.point_fields = {{"displacement [m]", 3, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}}};
  grid.cell_fields = {{"tension [N]", 1, {10.5, 20.5, 0, 0}},
                      {"<principal> & \"stress\"", 2, {0, 0, 0, 0, 1, 2, 3, 4}}};
  return grid;
}

template <typename Reader>
vtkSmartPointer<vtkUnstructuredGrid> read(const std::string& path) {
  vtkNew<Reader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  return reader->GetOutput();
}

TEST(Fields, OnePieceReadsBackComplete) {
  const TemporaryDirectory directory("fields_one");
  FieldSeries series(directory.path(), 0, 1);
  series.write("01 form/finding", square());
  const auto grid = read<vtkXMLUnstructuredGridReader>(directory.file("fields/01_form_finding.vtu"));
  ASSERT_EQ(grid->GetNumberOfPoints(), 4);
  ASSERT_EQ(grid->GetNumberOfCells(), 4);
  EXPECT_EQ(grid->GetCellType(0), VTK_LINE);
  EXPECT_EQ(grid->GetCellType(3), VTK_TRIANGLE);
  EXPECT_EQ(grid->GetPoint(1)[0], 1.0 / 3);
  auto* displacement = grid->GetPointData()->GetArray("displacement [m]");
  ASSERT_NE(displacement, nullptr);
  EXPECT_EQ(displacement->GetNumberOfComponents(), 3);
  EXPECT_EQ(displacement->GetComponent(2, 1), 7);
  EXPECT_EQ(grid->GetCellData()->GetArray("tension [N]")->GetComponent(1, 0), 20.5);
  auto* stress = grid->GetCellData()->GetArray("<principal> & \"stress\"");
  ASSERT_NE(stress, nullptr);
  EXPECT_EQ(stress->GetComponent(3, 1), 4);
}

TEST(Fields, PieceHoldsTheOwnersCellsAndOnlyTheirPoints) {
  const auto piece = extract_piece(square(), {0, 1, 0, 1}, 1);
  ASSERT_EQ(piece.points.size(), 3u);
  EXPECT_EQ(piece.lines, (std::vector<std::array<int, 2>>{{0, 1}}));
  EXPECT_EQ(piece.facets, (std::vector<model::FacetNodes>{{1, 2, 0}}));
  EXPECT_EQ(piece.points[0], Vec3(0, 1, 0.5));
  EXPECT_EQ(piece.point_fields[0].values, (std::vector<double>{9, 10, 11, 0, 1, 2, 6, 7, 8}));
  EXPECT_EQ(piece.cell_fields[0].values, (std::vector<double>{20.5, 0}));
  EXPECT_EQ(piece.cell_fields[1].values, (std::vector<double>{0, 0, 3, 4}));
}

TEST(Fields, PiecesOfSeveralRanksReadBackAsOneGrid) {
  const TemporaryDirectory directory("fields_parallel");
  const std::vector<int> owner{0, 2, 0, 2};  // rank 1 has nothing
  for (const int rank : {2, 1, 0}) {
    FieldSeries series(directory.path(), rank, 3);
    series.write("02_equilibrium", extract_piece(square(), owner, rank));
    series.write("03_tuning", extract_piece(square(), owner, rank));
  }
  const auto grid = read<vtkXMLPUnstructuredGridReader>(directory.file("fields/03_tuning.pvtu"));
  EXPECT_EQ(grid->GetNumberOfCells(), 4);
  ASSERT_EQ(grid->GetCellData()->GetNumberOfArrays(), 2);
  double sum = 0;
  for (vtkIdType i = 0; i < 4; ++i) sum += grid->GetCellData()->GetArray("tension [N]")->GetComponent(i, 0);
  EXPECT_EQ(sum, 31);
  EXPECT_NE(grid->GetPointData()->GetArray("displacement [m]"), nullptr);
}

TEST(Fields, CollectionListsEveryMomentInOrder) {
  const TemporaryDirectory directory("fields_collection");
  FieldSeries series(directory.path(), 0, 1);
  series.write("01_mesh", square());
  series.write("02_tuning", square());
  const auto text = contents(directory.file("fields.pvd"));
  const auto first = text.find("timestep=\"0\" group=\"\" part=\"0\" file=\"fields/01_mesh.vtu\"");
  const auto second = text.find("timestep=\"1\" group=\"\" part=\"0\" file=\"fields/02_tuning.vtu\"");
  ASSERT_NE(first, std::string::npos) << text;
  ASSERT_NE(second, std::string::npos) << text;
  EXPECT_LT(first, second);
  series.write("02 tuning", square());  // the same file name, if the other were not taken
  EXPECT_NE(contents(directory.file("fields.pvd")).find("file=\"fields/02_tuning_2.vtu\""),
            std::string::npos);
}

TEST(Fields, AnIncompleteFieldIsAnError) {
  const TemporaryDirectory directory("fields_incomplete");
  auto grid = square();
  grid.cell_fields[0].values.pop_back();
  FieldSeries series(directory.path(), 0, 1);
  const auto message = message_of<LibraryError>([&] { series.write("x", grid); });
  EXPECT_NE(message.find("tension [N]"), std::string::npos) << message;
}

TEST(Fields, AFileThatCannotBeWrittenIsNamed) {
  const TemporaryDirectory directory("fields_unwritable");
  put(directory.file("fields"), "a file where the folder should be");
  FieldSeries series(directory.path(), 0, 1);
  const auto message = message_of<LibraryError>([&] { series.write("x", square()); });
  EXPECT_NE(message.find(directory.file("fields")), std::string::npos) << message;

  std::filesystem::remove(directory.file("fields"));
  std::filesystem::create_directories(directory.file("fields/x.vtu.tmp"));
  FieldSeries again(directory.path(), 0, 1);
  const auto blocked = message_of<LibraryError>([&] { again.write("x", square()); });
  EXPECT_NE(blocked.find("fields/x.vtu"), std::string::npos) << blocked;
}

}  // namespace
}  // namespace tautline::output
