#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkFieldData.h>
#include <vtkInformation.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <exception>
#include <type_traits>

#include "output/vtk_document.h"

namespace luxel {

namespace {

// Views, not copies: the writer only reads, though the interface of VTK takes pointers that are not const
template <class VtkType, class Value>
vtkSmartPointer<VtkType> view(std::span<const Value> values, int components = 1) {
  auto array = vtkSmartPointer<VtkType>::New();
  array->SetNumberOfComponents(components);
  array->SetArray(const_cast<Value*>(values.data()), static_cast<vtkIdType>(values.size()), 1);
  return array;
}

vtkSmartPointer<vtkAbstractArray> vtk_values(std::span<const double> values, int components) {
  return view<vtkDoubleArray>(values, components);
}

vtkSmartPointer<vtkAbstractArray> vtk_values(std::span<const int> values, int components) {
  return view<vtkIntArray>(values, components);
}

vtkSmartPointer<vtkAbstractArray> vtk_values(const std::vector<double>& values, int components) {
  return view<vtkDoubleArray>(std::span(values), components);
}

vtkSmartPointer<vtkAbstractArray> vtk_values(const std::vector<std::uint8_t>& values, int components) {
  return view<vtkUnsignedCharArray>(std::span(values), components);
}

vtkSmartPointer<vtkAbstractArray> vtk_values(const std::vector<std::string>& values, int) {
  auto array = vtkSmartPointer<vtkStringArray>::New();
  for (const std::string& text : values) array->InsertNextValue(text);
  return array;
}

vtkSmartPointer<vtkAbstractArray> vtk_array(const VtkArray& array) {
  auto result =
      std::visit([&](const auto& values) { return vtk_values(values, array.components); }, array.values);
  result->SetName(array.name.c_str());
  if (array.components == 3) {
    constexpr const char* colour[] = {"R", "G", "B"};
    constexpr const char* place[] = {"X", "Y", "Z"};
    const auto& names = array.place ? place : colour;
    for (int k = 0; k < 3; ++k) result->SetComponentName(k, names[k]);
  }
  if (!array.unit.empty()) result->GetInformation()->Set(vtkDataArray::UNITS_LABEL(), array.unit.c_str());
  return result;
}

template <class Writer, class DataSet>
std::string write(DataSet& data, const VtkDocument& document, const std::string& path) {
  for (const VtkArray& array : document.cell_arrays) data.GetCellData()->AddArray(vtk_array(array));
  for (const VtkArray& array : document.point_arrays) data.GetPointData()->AddArray(vtk_array(array));
  for (const VtkArray& array : document.field_arrays) data.GetFieldData()->AddArray(vtk_array(array));
  data.GetCellData()->SetActiveScalars(document.active_cell_scalars.c_str());
  if (!document.active_point_scalars.empty()) {
    data.GetPointData()->SetActiveScalars(document.active_point_scalars.c_str());
  }
  vtkNew<Writer> writer;
  writer->SetInputData(&data);
  writer->SetFileName(path.c_str());
  // of all that VTK offers the fastest by far and a third of the size of raw numbers
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetCompressorTypeToLZ4();
  writer->SetHeaderTypeToUInt64();
  if (writer->Write() == 1 && writer->GetErrorCode() == vtkErrorCode::NoError) return "";
  return vtkErrorCode::GetStringFromErrorCode(writer->GetErrorCode());
}

std::string write_document(const VtkDocument& document, const std::string& path) try {
  // what goes wrong is told by the return value, not on stderr
  vtkObject::GlobalWarningDisplayOff();
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  const double* coordinates = document.points.empty() ? nullptr : document.points.front().data();
  vtkNew<vtkPoints> points;
  points->SetData(view<vtkDoubleArray>(std::span(coordinates, 3 * document.points.size()), 3));
  vtkNew<vtkCellArray> cells;
  cells->SetData(view<vtkTypeInt64Array>(std::span(document.offsets)),
                 view<vtkTypeInt64Array>(std::span(document.connectivity)));
  if (!document.unstructured) {
    vtkNew<vtkPolyData> data;
    data->SetPoints(points);
    data->SetPolys(cells);
    return write<vtkXMLPolyDataWriter>(*data, document, path);
  }
  vtkNew<vtkUnsignedCharArray> types;
  for (std::size_t i = 0; i + 1 < document.offsets.size(); ++i) {
    types->InsertNextValue(document.offsets[i + 1] - document.offsets[i] == 3 ? VTK_TRIANGLE : VTK_QUAD);
  }
  vtkNew<vtkUnstructuredGrid> data;
  data->SetPoints(points);
  data->SetCells(types, cells);
  return write<vtkXMLUnstructuredGridWriter>(*data, document, path);
} catch (const std::exception& error) {
  return error.what();
}

}  // namespace

}  // namespace luxel

extern "C" [[gnu::visibility("default")]] const luxel::VtkWriter luxel_vtk_writer_1 = luxel::write_document;
