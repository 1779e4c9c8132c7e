"""Other packages: what goes out comes back, and what they say of it is what we say."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import kerfold
from kerfold import KerfoldError, Mesh, convert


@pytest.fixture
def column() -> Mesh:
    cube = Mesh.solid("cube", edge=40)
    named = Mesh(cube.vertices, cube.faces, {"roof": [0], "wall": [1, 2]})
    return named.cut_edges("along=z", offset=0.25)


def test_trimesh(column: Mesh) -> None:
    trimesh = pytest.importorskip("trimesh")
    made = convert.to_trimesh(column)
    assert isinstance(made, trimesh.Trimesh) and made.is_watertight and made.units == "mm"
    corner = 40.0 * 10 * 10 / 2
    assert made.volume == pytest.approx(40**3 - 4 * corner)
    assert set(made.face_attributes["face"].tolist()) == set(range(10))
    back = convert.from_trimesh(made).merge()
    assert len(back.faces) == 10 and len(back.vertices) == 16
    made.units = "in"
    assert np.ptp(convert.from_trimesh(made).vertices[:, 0]) == pytest.approx(40 * 25.4)
    made.units = "furlong"
    with pytest.raises(KerfoldError, match="furlong"):
        convert.from_trimesh(made)


def test_trimesh_reads_our_files(column: Mesh, here: Path) -> None:
    trimesh = pytest.importorskip("trimesh")
    column.write("column.stl")
    read = trimesh.load_mesh("column.stl")
    assert read.is_watertight
    assert convert.from_trimesh(read, mend=True).merge().check().faces == 10


def test_compas(column: Mesh) -> None:
    structures = pytest.importorskip("compas.datastructures")
    made = convert.to_compas(column)
    assert isinstance(made, structures.Mesh) and made.is_manifold()
    assert made.number_of_faces() == 10 and made.number_of_edges() == 24
    assert made.face_attribute(0, "group") == "roof"
    back = convert.from_compas(made)
    assert np.array_equal(back.vertices, column.vertices)
    assert back.faces.tolist() == column.faces.tolist()
    assert back.groups.keys() == column.groups.keys()
    solid = convert.to_compas_polyhedron(column)
    assert len(solid.faces) == 10 and len(solid.vertices) == 16
    assert convert.from_compas(solid).faces.tolist() == column.faces.tolist()
    with pytest.raises(KerfoldError, match="list has no vertices"):
        convert.from_compas([])


def test_rhino(here: Path) -> None:
    rhino3dm = pytest.importorskip("rhino3dm")
    cube = Mesh.solid("cube", edge=200)
    panels = Mesh(cube.vertices, cube.faces, {"roof": [0]}).panels(thickness=10, sheet="1000x1000")
    file = convert.to_rhino3dm(panels)
    assert file.Write("plates.3dm", 7)
    read = rhino3dm.File3dm.Read("plates.3dm")
    assert read.Settings.ModelUnitSystem == rhino3dm.UnitSystem.Millimeters
    names = [item.Attributes.Name for item in read.Objects]
    assert names == [plate.id for plate in panels.plates]
    layers = {layer.Index: layer.Name for layer in read.Layers}
    assert [layers[item.Attributes.LayerIndex] for item in read.Objects] == ["roof"] + [
        "plates"
    ] * 5
    first = read.Objects[0]
    assert first.Geometry.IsClosed
    assert first.Attributes.GetUserString("thickness_mm") == "10"
    assert float(first.Attributes.GetUserString("area_mm2")) == pytest.approx(200 * 200)
    assert float(first.Attributes.GetUserString("mass_kg")) == pytest.approx(
        panels.plates[0].mass, abs=1e-6
    )

    net = convert.to_rhino3dm(cube.unfold(sheet="1000x1000"))
    assert [item.Geometry.IsClosed for item in net.Objects] == [True]

    whole = convert.to_rhino3dm(cube)
    back = convert.from_rhino3dm(whole, mend=True).merge()
    assert len(back.faces) == 6 and np.ptp(back.vertices[:, 0]) == pytest.approx(200)
    whole.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Centimeters
    assert np.ptp(convert.from_rhino3dm(whole).vertices[:, 0]) == pytest.approx(2000)
    with pytest.raises(KerfoldError, match="no mesh"):
        convert.from_rhino3dm(rhino3dm.File3dm())


def test_ifc(here: Path) -> None:
    ifcopenshell = pytest.importorskip("ifcopenshell")
    from ifcopenshell import validate

    ball = Mesh.solid("cuboctahedron", edge=300)
    panels = ball.panels(thickness=10, sheet="3000x2000")
    file = convert.to_ifc(panels, name="lobby")
    assert file.to_string() == convert.to_ifc(panels, name="lobby").to_string()
    file.write("plates.ifc")
    read = ifcopenshell.open("plates.ifc")
    log = validate.json_logger()  # type: ignore[no-untyped-call]
    validate.validate(read, log, express_rules=True)
    assert log.statements == []
    (wall,) = read.by_type("IfcCurtainWall")
    assert wall.Name == "lobby" and wall.ContainedInStructure
    plates = wall.IsDecomposedBy[0].RelatedObjects
    assert [plate.Name for plate in plates] == [plate.id for plate in panels.plates]
    for made, plate in zip(plates, panels.plates):
        told = {
            item.Name: item[3]
            for relation in made.IsDefinedBy
            for item in getattr(relation.RelatingPropertyDefinition, "Quantities", None) or []
        }
        assert told["Width"] == pytest.approx(10)
        assert told["NetArea"] == pytest.approx(plate.area / 1e6)
        assert told["NetVolume"] == pytest.approx(plate.volume / 1e9)
        assert told["NetWeight"] == pytest.approx(plate.mass)
        # The body where the file puts it is the body of the plate.
        faces = made.Representation.Representations[0].Items[0]
        axes = made.ObjectPlacement.RelativePlacement
        z = np.array(axes.Axis.DirectionRatios)
        x = np.array(axes.RefDirection.DirectionRatios)
        frame = np.array([x, np.cross(z, x), z])
        places = np.array(faces.Coordinates.CoordList) @ frame + axes.Location.Coordinates
        assert np.abs(places - plate.vertices).max() < 1e-6
        corners = places[np.array(faces.CoordIndex) - 1]
        volume = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
        assert volume == pytest.approx(plate.volume)
    assert len(read.by_type("IfcPlate")) == len(panels.plates)


def test_shapely(here: Path) -> None:
    geometry = pytest.importorskip("shapely.geometry")
    cube = Mesh.solid("cube", edge=40)
    (piece,) = convert.to_shapely(cube.unfold())
    assert piece.is_valid and piece.area == pytest.approx(6 * 1600)
    ring = geometry.box(0, 0, 50, 40).difference(geometry.box(10, 10, 20, 20))
    two = geometry.MultiPolygon([geometry.box(0, 0, 5, 5), geometry.box(10, 0, 15, 5)])
    convert.from_shapely([ring, two], "pieces.json")
    net = kerfold.nest("pieces.json", sheet="200x200")
    areas = sorted(convert.to_shapely(piece).area for piece in net.pieces)
    assert areas == pytest.approx([25, 25, 1900])
    with pytest.raises(KerfoldError, match="Point"):
        convert.from_shapely([geometry.Point(0, 0)], "none.json")
    assert not (here / "none.json").exists()


def test_what_is_not_installed_is_told() -> None:
    text = (
        "import sys\nsys.modules['trimesh'] = None\nimport kerfold\nfrom kerfold import convert\n"
        "try:\n    convert.to_trimesh(kerfold.Mesh.solid('cube'))\n"
        "except kerfold.KerfoldError as error:\n    print(error)\n"
    )
    done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, check=True)
    assert "pip install kerfold[trimesh]" in done.stdout
