"""To and from the meshes of other packages, each asked for only when it is used.

``pip install kerfold[trimesh]``, ``[compas]``, ``[rhino3dm]``, ``[shapely]``, ``[ifcopenshell]`` or
``[all]`` installs them. Lengths are millimetres on our side; where the other package knows its unit, it is followed.
"""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any, Iterable, Optional, Union

from ._errors import KerfoldError
from ._mesh import Mesh
from ._net import Net, Piece
from ._panels import Panels

if TYPE_CHECKING:
    from ._types import Path

#: Millimetres in the units that trimesh and Rhino name.
_MM = {
    "mm": 1.0,
    "millimeter": 1.0,
    "millimeters": 1.0,
    "millimetres": 1.0,
    "cm": 10.0,
    "centimeter": 10.0,
    "centimeters": 10.0,
    "m": 1000.0,
    "meter": 1000.0,
    "meters": 1000.0,
    "metres": 1000.0,
    "in": 25.4,
    "inch": 25.4,
    "inches": 25.4,
    "ft": 304.8,
    "foot": 304.8,
    "feet": 304.8,
}


def _need(package: str) -> Any:
    import importlib

    try:
        return importlib.import_module(package)
    except ImportError as error:
        raise KerfoldError(
            f"{package} is not installed; `pip install kerfold[{package}]` installs it"
        ) from error


def to_trimesh(mesh: Mesh) -> Any:
    """The mesh as a `trimesh.Trimesh` in mm, its faces cut into triangles.

    ``face_attributes["face"]`` has the face of each triangle, (t,) int64.
    """
    trimesh = _need("trimesh")
    triangles, faces = mesh.triangles
    made = trimesh.Trimesh(mesh.vertices, triangles, process=False, face_attributes={"face": faces})
    made.units = "mm"
    return made


def from_trimesh(made: Any, *, mend: bool = False) -> Mesh:
    """The triangles of a `trimesh.Trimesh`, in mm where it has a unit.

    `Mesh.merge` makes polygons of triangles that lie flat beside each other.
    """
    units = getattr(made, "units", None)
    if units is not None and units not in _MM:
        raise KerfoldError(f"the unit {units!r} is not known; convert the mesh to mm")
    scale = _MM[units] if units is not None else 1.0
    vertices = made.vertices if scale == 1.0 else made.vertices * scale
    import numpy as np

    return Mesh(np.asarray(vertices), np.asarray(made.faces), mend=mend)


def to_compas(mesh: Mesh) -> Any:
    """The mesh as a `compas.datastructures.Mesh`; keys are our numbers, ``group`` an attribute."""
    made = _need("compas.datastructures").Mesh.from_vertices_and_faces(
        mesh.vertices.tolist(), mesh.faces.tolist()
    )
    for name, faces in mesh.groups.items():
        for face in faces.tolist():
            made.face_attribute(face, "group", name)
    return made


def to_compas_polyhedron(mesh: Mesh) -> Any:
    """The mesh as a `compas.geometry.Polyhedron`."""
    geometry = _need("compas.geometry")
    return geometry.Polyhedron(mesh.vertices.tolist(), mesh.faces.tolist())


def from_compas(made: Any, *, mend: bool = False) -> Mesh:
    """A `compas` `Mesh` or `Polyhedron`; its numbers are taken as mm.

    The face attribute ``group`` of a `Mesh` becomes our group.
    """
    if not hasattr(made, "to_vertices_and_faces"):
        raise KerfoldError(
            f"{type(made).__name__} has no vertices and faces; give a compas Mesh or Polyhedron"
        )
    vertices, faces = made.to_vertices_and_faces()
    groups: dict[str, list[int]] = {}
    if hasattr(made, "face_attribute"):
        for i, face in enumerate(made.faces()):
            name = made.face_attribute(face, "group")
            if name is not None:
                groups.setdefault(str(name), []).append(i)
    return Mesh([list(place) for place in vertices], faces, groups, mend=mend)


def _rhino_mesh(rhino3dm: Any, vertices: Any, triangles: Any) -> Any:
    made = rhino3dm.Mesh()
    for x, y, z in vertices.tolist():
        made.Vertices.Add(x, y, z)
    for a, b, c in triangles.tolist():
        made.Faces.AddFace(a, b, c)
    made.Normals.ComputeNormals()
    made.Compact()
    return made


def _attributes(rhino3dm: Any, name: str, layer: int, texts: dict[str, str]) -> Any:
    attributes = rhino3dm.ObjectAttributes()
    attributes.Name = name
    attributes.LayerIndex = layer
    for key, value in texts.items():
        attributes.SetUserString(key, value)
    return attributes


def to_rhino3dm(made: Union[Mesh, Net, Panels]) -> Any:
    """A `rhino3dm.File3dm` in mm.

    - `Panels`: one closed mesh for each plate, named as on the sheets (``P01``), on a layer for
      each group of the model, with user texts ``face``, ``group``, ``thickness_mm``, ``area_mm2``,
      ``mass_kg``, ``mirrored``.
    - `Net`: the outlines of the pieces as closed polylines on the layer ``pieces``, holes on
      ``holes``, beside one another, with the user text ``faces``.
    - `Mesh`: one mesh of triangles, named ``kerfold``.
    """
    rhino3dm = _need("rhino3dm")
    file = rhino3dm.File3dm()
    file.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Millimeters
    layers: dict[str, int] = {}

    def layer(name: str) -> int:
        if name not in layers:
            layers[name] = int(file.Layers.AddLayer(name, (0, 0, 0, 255)))
        return layers[name]

    if isinstance(made, Panels):
        for plate in made.plates:
            body = _rhino_mesh(rhino3dm, plate.vertices, plate.triangles)
            texts = {
                "face": str(plate.face),
                "group": f"G{plate.group + 1:03}",
                "thickness_mm": f"{plate.thickness:.6g}",
                "area_mm2": f"{plate.area:.6f}",
                "mass_kg": f"{plate.mass:.6f}",
                "mirrored": "yes" if plate.is_mirrored else "no",
            }
            attributes = _attributes(rhino3dm, plate.id, layer(plate.layer or "plates"), texts)
            file.Objects.AddMesh(body, attributes)
    elif isinstance(made, Net):
        left = 0.0
        for piece in made.pieces:
            low, high = piece.outline.min(axis=0), piece.outline.max(axis=0)
            texts = {"faces": ",".join(map(str, piece.faces.tolist()))}
            for kind, line in [("pieces", piece.outline), *(("holes", h) for h in piece.holes)]:
                curve = rhino3dm.Polyline()
                for x, y in [*line.tolist(), line[0].tolist()]:
                    curve.Add(left + x - low[0], y - low[1], 0.0)
                attributes = _attributes(rhino3dm, piece.id, layer(kind), texts)
                file.Objects.AddCurve(curve.ToPolylineCurve(), attributes)
            left += 1.1 * float(high[0] - low[0])
    else:
        body = _rhino_mesh(rhino3dm, made.vertices, made.triangles[0])
        file.Objects.AddMesh(body, _attributes(rhino3dm, "kerfold", layer("kerfold"), {}))
    return file


def from_rhino3dm(made: Any, *, mend: bool = False) -> Mesh:
    """The mesh of a `rhino3dm.Mesh`, or all meshes of a `File3dm`, in mm.

    The objects of a file become groups by their names. The vertices that a Rhino mesh has once for
    each face are welded when `mend` is true.
    """
    rhino3dm = _need("rhino3dm")
    scale, meshes = 1.0, [("", made)]
    if isinstance(made, rhino3dm.File3dm):
        units = made.Settings.ModelUnitSystem
        scale = _MM.get(str(getattr(units, "name", units)).lower(), 0.0)
        if scale == 0.0:
            raise KerfoldError(f"the unit {units} is not known; save the file in mm, cm, m or in")
        found = [(item.Attributes.Name, item.Geometry) for item in made.Objects]
        meshes = [(name, part) for name, part in found if isinstance(part, rhino3dm.Mesh)]
        if not meshes:
            raise KerfoldError("the file has no mesh; mesh its surfaces first")
    vertices: list[list[float]] = []
    faces: list[list[int]] = []
    groups: dict[str, list[int]] = {}
    for name, part in meshes:
        before, first = len(vertices), len(faces)
        for i in range(len(part.Vertices)):
            place = part.Vertices[i]
            vertices.append([place.X * scale, place.Y * scale, place.Z * scale])
        for i in range(len(part.Faces)):
            a, b, c, d = part.Faces[i]
            # A triangle names its last corner twice.
            corners = [a, b, c] if c == d else [a, b, c, d]
            faces.append([before + v for v in corners])
        if name:
            groups.setdefault(name, []).extend(range(first, len(faces)))
    return Mesh(vertices, faces, groups, mend=mend)


def to_ifc(panels: Panels, *, name: str = "panels") -> Any:
    """The plates as an `ifcopenshell.file` (IFC4, lengths in mm), the same for the same plates.

    One ``IfcCurtainWall`` of that name in a storey of a building, and for each plate an ``IfcPlate``
    (``CURTAIN_PANEL``) named as on the sheets (``P01``), its tag the group of congruent plates, its
    object type the group of the model. Its body is a closed surface of triangles in a placement of
    its own, whose plane z = 0 is the front. ``Qto_PlateBaseQuantities`` has ``Width`` (the thickness)
    and ``Perimeter`` (of the front) in mm, ``NetArea`` in m², ``NetVolume`` in m³ and ``NetWeight`` in
    kg; ``Kerfold_Plate`` has ``Face``, ``Group``, ``Mirrored`` and ``MitresDegrees``.
    """
    from ._ifc import build

    ifcopenshell = _need("ifcopenshell")
    _need("ifcopenshell.guid")
    return build(ifcopenshell, panels.plates, name)


def to_shapely(made: Union[Net, Piece]) -> Any:
    """A piece as a `shapely.Polygon` in its own frame, mm; a net as a list of these."""
    shapely = _need("shapely.geometry")
    if isinstance(made, Net):
        return [to_shapely(piece) for piece in made.pieces]
    return shapely.Polygon(made.outline, made.holes)


def from_shapely(
    polygons: Iterable[Any],
    path: Path,
    *,
    names: Optional[Iterable[str]] = None,
) -> None:
    """Writes `shapely` polygons, in mm, as a file of pieces for `kerfold.nest`.

    A `MultiPolygon` becomes several pieces. Names are ``1``, ``2``, … unless given.
    """
    parts: list[dict[str, Any]] = []
    given = list(names) if names is not None else None
    for number, polygon in enumerate(polygons):
        name = given[number] if given is not None else str(number + 1)
        several = list(getattr(polygon, "geoms", [polygon]))
        for part_number, part in enumerate(several):
            if part.geom_type != "Polygon" or part.is_empty:
                raise KerfoldError(f"piece {name} is a {part.geom_type} and no polygon with area")
            own = name if len(several) == 1 else f"{name}-{part_number + 1}"
            parts.append(
                {
                    "id": own,
                    "outline": [list(p[:2]) for p in part.exterior.coords],
                    "holes": [[list(p[:2]) for p in ring.coords] for ring in part.interiors],
                }
            )
    from . import _native

    text = json.dumps({"units": "mm", "pieces": parts}, indent=1)
    _native.write_file(os.fspath(path), text.encode())
