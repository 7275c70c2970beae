#include "output/detail/vtu.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <tautline/core/error.hpp>
#include "output/detail/files.hpp"
#include "output/detail/markup.hpp"

namespace tautline::output::detail {

namespace {

void add_fields(vtkFieldData* data, const std::vector<Field>& fields) {
  for (const auto& field : fields) {
    vtkNew<vtkDoubleArray> array;
    array->SetName(escape_markup(field.name).c_str());  // the writer does not escape it
    array->SetNumberOfComponents(field.components);
    array->SetNumberOfTuples(static_cast<vtkIdType>(field.values.size()) / field.components);
    std::copy(field.values.begin(), field.values.end(), array->GetPointer(0));
    data->AddArray(array);
  }
}

void fill(vtkUnstructuredGrid* target, const FieldGrid& grid) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(grid.points.size()));
  for (std::size_t i = 0; i < grid.points.size(); ++i)
    points->SetPoint(static_cast<vtkIdType>(i), grid.points[i].data());
  target->SetPoints(points);
  target->Allocate(static_cast<vtkIdType>(grid.lines.size() + grid.facets.size()));
  for (const auto& line : grid.lines) {
    const vtkIdType nodes[] = {line[0], line[1]};
    target->InsertNextCell(VTK_LINE, 2, nodes);
  }
  for (const auto& facet : grid.facets) {
    const std::array<vtkIdType, 4> nodes{facet[0], facet[1], facet[2], facet[3]};
    target->InsertNextCell(facet.size() == 3 ? VTK_TRIANGLE : VTK_QUAD, facet.size(), nodes.data());
  }
  add_fields(target->GetPointData(), grid.point_fields);
  add_fields(target->GetCellData(), grid.cell_fields);
}

/// VTK prints its own complaints on stderr; while this lives it keeps them to itself, since we throw.
class QuietVtk {
 public:
  QuietVtk() : was_(vtkObject::GetGlobalWarningDisplay()) { vtkObject::GlobalWarningDisplayOff(); }
  QuietVtk(const QuietVtk&) = delete;
  QuietVtk& operator=(const QuietVtk&) = delete;
  ~QuietVtk() { vtkObject::SetGlobalWarningDisplay(was_); }

 private:
  int was_;
};

}  // namespace

void write_vtu(const std::string& path, const FieldGrid& grid) {
  vtkNew<vtkUnstructuredGrid> data;
  fill(data, grid);
  const QuietVtk quiet;
  const std::string temporary = path + ".tmp";
  ::unlink(temporary.c_str());  // a link would be followed
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetFileName(temporary.c_str());
  writer->SetInputData(data);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetCompressorTypeToZLib();
  errno = 0;
  const bool written = writer->Write() == 1 && writer->GetErrorCode() == vtkErrorCode::NoError;
  if (written && std::rename(temporary.c_str(), path.c_str()) == 0) return;
  const bool full = writer->GetErrorCode() == vtkErrorCode::OutOfDiskSpaceError;
  const std::string why = full ? reason(ENOSPC) : reason(errno);
  std::remove(temporary.c_str());
  throw LibraryError(fmt::format("cannot write the fields to {}: {}", path, why));
}

}  // namespace tautline::output::detail
