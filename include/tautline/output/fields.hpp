#pragma once
/// @file
/// Fields for ParaView: one unstructured grid of lines and facets with named arrays, written in parallel
/// pieces.

#include <array>
#include <string>
#include <vector>

#include <tautline/core/types.hpp>
#include <tautline/model/facet.hpp>
#include <tautline/output/file_names.hpp>

namespace tautline::output {

/// A named array; `values` holds components() values for each point or cell, interleaved.
struct Field {
  std::string name;  ///< with unit, e.g. "tension [N]"
  int components = 1;
  std::vector<double> values;
};

/// Geometry and arrays of one moment (a step, a stage, a mode).
struct FieldGrid {
  Points points;                                 ///< reference coordinates [m]
  std::vector<std::array<int, 2>> lines;         ///< cells first
  std::vector<model::FacetNodes> facets;         ///< cells after the lines
  std::vector<Field> point_fields, cell_fields;  ///< cell arrays in the order lines, facets
};

/// The part of `grid` whose cells have owner[cell] == rank; points are those the cells use.
FieldGrid extract_piece(const FieldGrid& grid, const std::vector<int>& owner, int rank);

/// @brief Writes the series DIR/fields.pvd with one .pvtu of one .vtu per rank (a single .vtu when size == 1)
/// per moment.
class FieldSeries {
 public:
  /// @param directory exists already; files go to directory/fields/, the collection to directory/fields.pvd
  FieldSeries(std::string directory, int rank, int size);
  /// Collective without communication: every rank writes its piece; rank 0 also the .pvtu and the updated
  /// .pvd. All ranks must give the same arrays in the same order.
  /// @param name made a file name by FileNames, e.g. "03_tuning"
  /// @throws LibraryError naming the file that could not be written
  void write(const std::string& name, const FieldGrid& piece);

 private:
  std::string directory_;
  int rank_, size_;
  FileNames names_;
  std::vector<std::string> written_;
};

}  // namespace tautline::output
