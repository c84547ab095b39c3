"""Prints what a .vtp or .vtu file holds, one array a line: association/name type components unit: values."""
import sys

from vtkmodules.vtkCommonCore import vtkDataArray
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

path = sys.argv[1]
reader = vtkXMLPolyDataReader() if path.endswith(".vtp") else vtkXMLUnstructuredGridReader()
reader.SetFileName(path)
reader.Update()
data = reader.GetOutput()
print("class", data.GetClassName())
print("points", *("%g,%g,%g" % data.GetPoint(i) for i in range(data.GetNumberOfPoints())))
for i in range(data.GetNumberOfCells()):
    cell = data.GetCell(i)
    print("cell", cell.GetCellType(), *(cell.GetPointId(k) for k in range(cell.GetNumberOfPoints())))
for name, attributes in (("cell", data.GetCellData()), ("point", data.GetPointData()), ("field", data.GetFieldData())):
    for i in range(attributes.GetNumberOfArrays()):
        array = attributes.GetAbstractArray(i)
        key = vtkDataArray.UNITS_LABEL()
        unit = array.GetInformation().Get(key) if array.HasInformation() and array.GetInformation().Has(key) else ""
        channels = "".join(array.GetComponentName(k) or "?" for k in range(array.GetNumberOfComponents())) \
            if array.HasAComponentName() else "-"
        values = [array.GetVariantValue(k) for k in range(array.GetNumberOfValues())]
        text = [v.ToString() if v.IsString() else "%.17g" % v.ToDouble() for v in values]
        print("%s/%s %s %s [%s]: %s" % (name, array.GetName(), array.GetDataTypeAsString(), channels, unit, "|".join(text)))
scalars = data.GetCellData().GetScalars()
print("active", scalars.GetName() if scalars else "none")
