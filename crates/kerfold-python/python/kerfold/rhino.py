"""Meshes of Rhino itself (RhinoCommon), for scripts that run in Rhino 8 or Grasshopper.

Files of Rhino are read and written by `kerfold.convert`, which needs no Rhino.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from ._errors import KerfoldError
from ._mesh import Mesh

if TYPE_CHECKING:
    from ._types import Floats


def _rhino() -> Any:
    try:
        return importlib.import_module("Rhino")
    except ImportError as error:
        raise KerfoldError("this runs in Rhino; elsewhere use kerfold.convert") from error


def from_rhino(mesh: Any) -> Mesh:
    """A `Rhino.Geometry.Mesh`: n-gons are one face, corners at one place one vertex.

    The document's unit must be millimetres.
    """
    rhino = _rhino()
    document = rhino.RhinoDoc.ActiveDoc
    if document is not None and document.ModelUnitSystem != rhino.UnitSystem.Millimeters:
        raise KerfoldError("the document is not in millimetres; set its units to them")
    vertices = [[p.X, p.Y, p.Z] for p in mesh.Vertices.ToPoint3dArray()]
    faces = [
        [int(i) for i in face.BoundaryVertexIndexList()]
        for face in mesh.GetNgonAndFacesEnumerable()
    ]
    return Mesh(vertices, faces, mend=True)


def to_rhino(mesh: Mesh) -> Any:
    """A `Rhino.Geometry.Mesh` with an n-gon for every face of more than three sides."""
    geometry = _rhino().Geometry
    made = geometry.Mesh()
    for x, y, z in mesh.vertices.tolist():
        made.Vertices.Add(x, y, z)
    triangles, of_face = mesh.triangles
    parts: dict[int, list[int]] = {}
    for corners, face in zip(triangles.tolist(), of_face.tolist()):
        parts.setdefault(face, []).append(made.Faces.AddFace(*corners))
    for face, several in parts.items():
        if len(several) > 1:
            made.Ngons.AddNgon(geometry.MeshNgon.Create(mesh.faces[face].tolist(), several))
    made.Normals.ComputeNormals()
    return made


def body_to_rhino(vertices: Floats, triangles: Any) -> Any:
    """A closed `Rhino.Geometry.Mesh` of a plate's `vertices` and `triangles`."""
    made = _rhino().Geometry.Mesh()
    for x, y, z in vertices.tolist():
        made.Vertices.Add(x, y, z)
    for corners in triangles.tolist():
        made.Faces.AddFace(*corners)
    made.Normals.ComputeNormals()
    return made


def curve_to_rhino(points: Floats, *, shift: tuple[float, float] = (0.0, 0.0)) -> Any:
    """A closed polyline curve of flat points, (k, 2), moved by `shift`."""
    line = _rhino().Geometry.Polyline()
    flat = points.tolist()
    for x, y in [*flat, flat[0]]:
        line.Add(x + shift[0], y + shift[1], 0.0)
    return line.ToPolylineCurve()


def line_to_rhino(segment: Floats, *, shift: tuple[float, float] = (0.0, 0.0)) -> Any:
    """A line curve of two flat points, (2, 2), moved by `shift`."""
    geometry = _rhino().Geometry
    ends = [geometry.Point3d(x + shift[0], y + shift[1], 0.0) for x, y in segment.tolist()]
    return geometry.LineCurve(*ends)
