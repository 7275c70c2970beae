#include <tautline/output/tables.hpp>

#include <cmath>
#include <cstdlib>
#include <sstream>

#include <gtest/gtest.h>

#include <tautline/core/error.hpp>
#include "output/temporary_directory.hpp"

namespace tautline::output {
namespace {

using test::contents;
using test::message_of;
using test::TemporaryDirectory;

/// Two cables of group "net", the first in two segments, one of group "ties, front", and a beam.
model::Model small_model() {
  model::Model model;
  model.nodes = {{0, 0, 0}, {1.0 / 3, 0, 0}, {2.0 / 3, 0, 0}, {1.0 / 3, 0.7, 0}, {0, 0, 1}};
  model::Group net, ties, frame;
  net.name = "net";
  ties.name = "ties, front";
  frame.name = "frame";
  frame.kind = model::ElementKind::beam;
  model.groups = {net, ties, frame};
  model.cables = {{{0, 1}, 0, 0.001, 0}, {{1, 2}, 0, 0.001, 0}, {{1, 3}, 0, -0.01, 1}, {{0, 3}, 1, 0.002, 2}};
  model::Beam beam;
  beam.nodes = {0, 4};
  beam.group = 2;
  model.beams = {beam};
  model.selections["apex"].nodes = {3};
  return model;
}

model::Response small_response() {
  model::Response response;
  response.cables = {{0.3333, 10, false}, {0.3333, 20, false}, {0.7, 0, true}, {0.77, 1.0 / 7, false}};
  response.beams.resize(1);
  response.beams[0].axial = -12.5;
  response.beams[0].end_moment(2, 1) = 0.25;
  return response;
}

std::vector<std::string> lines_of(const std::string& path) {
  std::istringstream stream(contents(path));
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The last `n` cells of a row as numbers.
std::vector<double> last_numbers(const std::string& row, std::size_t n) {
  std::vector<double> numbers;
  std::istringstream stream(row);
  for (std::string cell; std::getline(stream, cell, ',');)
    numbers.push_back(std::strtod(cell.c_str(), nullptr));
  return {numbers.end() - static_cast<std::ptrdiff_t>(n), numbers.end()};
}

TEST(Tables, NodesKeepAllDigitsAndTheirGroup) {
  const TemporaryDirectory directory("tables_nodes");
  const auto model = small_model();
  model::State state{Points(5, Vec3(1e-3 / 7, 0, -1e-17)), std::vector<Mat3>(5, Mat3::Identity()), {}, {}};
  state.rotation[2] = Eigen::AngleAxisd(0.25, Vec3::UnitZ()).toRotationMatrix();
  write_nodes(directory.file("nodes.csv"), model, state);
  const auto rows = lines_of(directory.file("nodes.csv"));
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_EQ(rows[0], "id,group,x_ref,y_ref,z_ref,x,y,z,ux,uy,uz,rx,ry,rz");
  EXPECT_EQ(rows[2].substr(0, 6), "2,net,");
  EXPECT_EQ(rows[4].substr(0, 7), "4,apex,");
  EXPECT_EQ(rows[5].substr(0, 8), "5,frame,");
  const auto numbers = last_numbers(rows[2], 12);
  EXPECT_EQ(numbers[0], 1.0 / 3);
  EXPECT_EQ(numbers[3], 1.0 / 3 + 1e-3 / 7);
  EXPECT_EQ(numbers[6], 1e-3 / 7);
  EXPECT_EQ(numbers[8], -1e-17);
  EXPECT_DOUBLE_EQ(last_numbers(rows[3], 3)[2], 0.25) << "rotation vector";
}

TEST(Tables, FormFindingNodesComeBackBitForBit) {
  const TemporaryDirectory directory("tables_form");
  write_form_finding_nodes(directory.file("form.csv"), small_model());
  const auto rows = lines_of(directory.file("form.csv"));
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_EQ(rows[0], "id,group,x,y,z");
  EXPECT_EQ(last_numbers(rows[3], 3)[0], 2.0 / 3);
}

TEST(Tables, CablesHoldLengthTensionAndSlackness) {
  const TemporaryDirectory directory("tables_cables");
  const auto model = small_model();
  write_cables(directory.file("cables.csv"), model, small_response());
  const auto rows = lines_of(directory.file("cables.csv"));
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows[0], "id,group,node_1,node_2,length,unstressed_length,tension,slack");
  EXPECT_EQ(rows[4].substr(0, 20), "4,\"ties, front\",1,4,");
  EXPECT_EQ(last_numbers(rows[1], 4)[1], model.unstressed_length(model.cables[0]));
  EXPECT_EQ(last_numbers(rows[3], 1)[0], 1);
  EXPECT_EQ(last_numbers(rows[4], 2)[0], 1.0 / 7);
}

TEST(Tables, BeamsHoldEndForces) {
  const TemporaryDirectory directory("tables_beams");
  write_beams(directory.file("beams.csv"), small_model(), small_response());
  const auto rows = lines_of(directory.file("beams.csv"));
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1], "1,frame,1,5,-12.5,0,0,0,0,0,0,0.25,-12.5,0,0");
}

TEST(Tables, CutListJoinsTheSegmentsOfACable) {
  const TemporaryDirectory directory("tables_cut");
  const auto model = small_model();
  write_cut_list(directory.file("cut_list.csv"), model, small_response());
  const auto rows = lines_of(directory.file("cut_list.csv"));
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0], "id,group,unstressed_length,marking_tension");
  const auto joined = last_numbers(rows[1], 2);
  EXPECT_DOUBLE_EQ(joined[0],
                   model.unstressed_length(model.cables[0]) + model.unstressed_length(model.cables[1]));
  EXPECT_NEAR(joined[1], 15, 1e-12);
  EXPECT_EQ(last_numbers(rows[2], 1)[0], 0);
  EXPECT_EQ(rows[3].substr(0, 16), "3,\"ties, front\",");
}

TEST(Tables, ErrorsNameTheFile) {
  const auto message =
      message_of<LibraryError>([] { write_form_finding_nodes("/dev/null/form.csv", small_model()); });
  EXPECT_NE(message.find("/dev/null/form.csv"), std::string::npos) << message;
  const auto short_response = message_of<LibraryError>([] { write_cables("c.csv", small_model(), {}); });
  EXPECT_NE(short_response.find("c.csv"), std::string::npos) << short_response;
}

TEST(Tables, ColumnsOfNumbersComeBackBitForBit) {
  const TemporaryDirectory directory("tables_columns");
  const std::string path = directory.file("rod.csv");
  write_columns(path, {"s", "x"}, {{0, 1}, {std::nan(""), 1.0 / 3}});
  EXPECT_EQ(contents(path), "s,x\n0,\n1,0.33333333333333331\n");
}

}  // namespace
}  // namespace tautline::output
