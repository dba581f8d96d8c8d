"""Reads what the vtk writer wrote with VTK's own reader and compares every number with the formulas of
tests/support/frame_files.hpp. Usage: read_back.py FOLDER BALLS CONTACTS FRAMES"""
import os
import sys
import xml.etree.ElementTree as xml

from vtkmodules.vtkCommonCore import vtkCommand
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

folder, balls, contacts, frames = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4])
failures = []


def check(what, got, expected):
    if got != expected:
        failures.append(f"{what}: got {got!r}, expected {expected!r}")


def read(name):
    reader = vtkXMLPolyDataReader()
    for event in (vtkCommand.ErrorEvent, vtkCommand.WarningEvent):
        reader.AddObserver(event, lambda *_: failures.append(f"{name}: VTK's reader complains"))
    path = os.path.join(folder, name)
    check(f"{name} can be read", reader.CanReadFile(path), 1)
    reader.SetFileName(path)
    reader.Update()
    check(f"{name} error code", reader.GetErrorCode(), 0)
    return reader.GetOutput()


def tuples(array, count):
    check("tuples", array.GetNumberOfTuples(), count)
    return [array.GetTuple(k) for k in range(array.GetNumberOfTuples())]


def compare(name, data, attribute, expected):
    array = attribute.GetArray(name)
    if array is None:
        failures.append(f"array {name} is missing")
        return
    check(name, tuples(array, len(expected)), expected)


def check_points(data, expected):
    check("points", [data.GetPoint(k) for k in range(data.GetNumberOfPoints())], expected)
    check("vertex cells", data.GetNumberOfVerts(), 1 if expected else 0)
    if expected:
        cell = data.GetCell(0)
        check("vertices", [cell.GetPointId(k) for k in range(cell.GetNumberOfPoints())], list(range(len(expected))))


def check_time(data, frame):
    compare("TimeValue", data, data.GetFieldData(), [(0.1 * frame,)])


def check_balls(data, frame):
    check_points(data, [(float(k), k / 3, -k / 7 + frame) for k in range(balls)])
    points = data.GetPointData()
    compare("id", data, points, [(2.0 * k + 1,) for k in range(balls)])
    compare("radius", data, points, [(0.1 + k,) for k in range(balls)])
    compare("velocity", data, points, [(k + 0.5, float(-k), float(frame)) for k in range(balls)])
    compare("charge", data, points, [(1 / (k + 1),) for k in range(balls)])
    check("ball arrays", points.GetNumberOfArrays(), 4)


def check_contacts(data, frame):
    check_points(data, [(k / 2, 0.0, float(frame)) for k in range(contacts)])
    points = data.GetPointData()
    compare("id1", data, points, [(k + 1.0,) for k in range(contacts)])
    compare("id2", data, points, [(0.0 if k + 1 == contacts else k + 2.0,) for k in range(contacts)])
    compare("force", data, points, [(float(k), 2.0 * k, -3.0 * k) for k in range(contacts)])


def check_wall(data, frame):
    check("faces", data.GetNumberOfPolys(), 2)
    corners = [[data.GetPoint(data.GetCell(f).GetPointId(k)) for k in range(data.GetCell(f).GetNumberOfPoints())]
               for f in range(data.GetNumberOfCells())]
    check("corners", corners, [[(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]])
    compare("force", data, data.GetCellData(), [(1.0, 2.0, 3.0)] * 2)
    compare("velocity", data, data.GetCellData(), [(0.0, 0.0, -0.5)] * 2)


collection = xml.parse(os.path.join(folder, "view.pvd")).getroot()
check("kind of the list", collection.get("type"), "Collection")
entries = collection.findall("./Collection/DataSet")
check("entries", len(entries), frames * (3 if contacts else 2))
for index, entry in enumerate(entries):
    per_frame = 3 if contacts else 2
    frame = index // per_frame
    check("time of entry", float(entry.get("timestep")), 0.1 * frame)
    data = read(entry.get("file"))
    check_time(data, frame)
    kind = entry.get("file").split("/")[0]
    {"balls": check_balls, "contacts": check_contacts, "walls": check_wall}[kind](data, frame)

for failure in failures[:20]:
    print(failure)
sys.exit(1 if failures else 0)
