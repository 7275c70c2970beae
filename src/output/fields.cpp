#include <tautline/output/fields.hpp>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <stdexcept>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include "output/detail/files.hpp"
#include "output/detail/markup.hpp"
#include "output/detail/vtu.hpp"

namespace tautline::output {

namespace {

constexpr auto byte_order = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";

void check_fields(const std::vector<Field>& fields, std::size_t count, const char* where,
                  const std::string& name) {
  for (const auto& field : fields) {
    const std::size_t want = count * static_cast<std::size_t>(std::max(field.components, 0));
    if (field.components < 1 || field.values.size() != want)
      throw LibraryError(
          fmt::format("cannot write the field \"{}\" of {}: {} values for {} {} of {} components", field.name,
                      name, field.values.size(), count, where, field.components));
  }
}

std::string parallel_arrays(const std::vector<Field>& fields) {
  std::string text;
  for (const auto& field : fields)
    text += fmt::format("      <PDataArray type=\"Float64\" Name=\"{}\" NumberOfComponents=\"{}\"/>\n",
                        detail::escape_markup(field.name), field.components);
  return text;
}

/// The .pvtu that ties the pieces together.
std::string parallel_file(const FieldGrid& piece, const std::vector<std::string>& sources) {
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PUnstructuredGrid\" version=\"0.1\" byte_order=\"{}\" header_type=\"UInt32\" "
      "compressor=\"vtkZLibDataCompressor\">\n"
      "  <PUnstructuredGrid GhostLevel=\"0\">\n"
      "    <PPointData>\n{}    </PPointData>\n"
      "    <PCellData>\n{}    </PCellData>\n"
      "    <PPoints>\n      <PDataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"/>\n    "
      "</PPoints>\n",
      byte_order, parallel_arrays(piece.point_fields), parallel_arrays(piece.cell_fields));
  for (const auto& source : sources)
    text += fmt::format("    <Piece Source=\"{}\"/>\n", detail::escape_markup(source));
  return text + "  </PUnstructuredGrid>\n</VTKFile>\n";
}

std::string collection_file(const std::vector<std::string>& files) {
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"{}\">\n  "
      "<Collection>\n",
      byte_order);
  for (std::size_t i = 0; i < files.size(); ++i)
    text += fmt::format("    <DataSet timestep=\"{}\" group=\"\" part=\"0\" file=\"fields/{}\"/>\n", i,
                        detail::escape_markup(files[i]));
  return text + "  </Collection>\n</VTKFile>\n";
}

/// Rows of `field` picked by `index`.
Field pick(const Field& field, const std::vector<int>& index) {
  Field result{field.name, field.components, {}};
  const auto n = static_cast<std::size_t>(field.components);
  result.values.reserve(index.size() * n);
  for (const int row : index) {
    const auto begin = field.values.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(row) * n);
    result.values.insert(result.values.end(), begin, begin + field.components);
  }
  return result;
}

}  // namespace

FieldGrid extract_piece(const FieldGrid& grid, const std::vector<int>& owner, int rank) {
  if (owner.size() != grid.lines.size() + grid.facets.size())
    throw std::invalid_argument("extract_piece: one owner for each cell is needed");
  check_fields(grid.point_fields, grid.points.size(), "points", "a piece");
  check_fields(grid.cell_fields, owner.size(), "cells", "a piece");
  FieldGrid piece;
  std::vector<int> local(grid.points.size(), -1), points, cells;
  const auto localise = [&](int node) {
    int& index = local.at(static_cast<std::size_t>(node));
    if (index < 0) {
      index = static_cast<int>(points.size());
      points.push_back(node);
      piece.points.push_back(grid.points[static_cast<std::size_t>(node)]);
    }
    return index;
  };
  for (std::size_t cell = 0; cell < owner.size(); ++cell) {
    if (owner[cell] != rank) continue;
    cells.push_back(static_cast<int>(cell));
    if (cell < grid.lines.size()) {
      const auto& line = grid.lines[cell];
      piece.lines.push_back({localise(line[0]), localise(line[1])});
    } else {
      const auto& facet = grid.facets[cell - grid.lines.size()];
      const int a = localise(facet[0]), b = localise(facet[1]), c = localise(facet[2]);
      piece.facets.push_back(facet.size() == 3 ? model::FacetNodes(a, b, c)
                                               : model::FacetNodes(a, b, c, localise(facet[3])));
    }
  }
  for (const auto& field : grid.point_fields) piece.point_fields.push_back(pick(field, points));
  for (const auto& field : grid.cell_fields) piece.cell_fields.push_back(pick(field, cells));
  return piece;
}

FieldSeries::FieldSeries(std::string directory, int rank, int size)
    : directory_(std::move(directory)), rank_(rank), size_(size) {}

void FieldSeries::write(const std::string& name, const FieldGrid& piece) {
  check_fields(piece.point_fields, piece.points.size(), "points", name);
  check_fields(piece.cell_fields, piece.lines.size() + piece.facets.size(), "cells", name);
  const std::string stem = names_.next(name), folder = directory_ + "/fields";
  const std::string file = stem + (size_ == 1 ? ".vtu" : ".pvtu");
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw LibraryError(fmt::format("cannot create the directory {}: {}", folder, error.message()));

  const auto piece_file = [&](int rank) {
    return size_ == 1 ? file : fmt::format("{}_{:04d}.vtu", stem, rank);
  };
  detail::write_vtu(fmt::format("{}/{}", folder, piece_file(rank_)), piece);
  written_.push_back(file);
  if (rank_ != 0) return;
  if (size_ > 1) {
    std::vector<std::string> sources;
    for (int rank = 0; rank < size_; ++rank) sources.push_back(piece_file(rank));
    detail::write_file(fmt::format("{}/{}", folder, file), parallel_file(piece, sources));
  }
  detail::write_file(directory_ + "/fields.pvd", collection_file(written_));
}

}  // namespace tautline::output
