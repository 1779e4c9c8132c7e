"""The components for Grasshopper, with stand-ins for Rhino's own classes: there is no Rhino here.

This shows that they call kerfold as it is. Whether Rhino's classes behave as the stand-ins is not
shown by anything.
"""

from __future__ import annotations

import sys
import types
from pathlib import Path
from typing import Any

import pytest

from conftest import ROOT
from kerfold import KerfoldError, Mesh, rhino

FOLDER = ROOT / "extensions" / "rhino"


class _Many(list):  # type: ignore[type-arg]
    def Add(self, *values: float) -> None:
        self.append(values)

    def AddFace(self, *corners: int) -> int:
        self.append(corners)
        return len(self) - 1

    def AddNgon(self, ngon: Any) -> None:
        self.append(ngon)

    def ToPoint3dArray(self) -> list[Any]:
        return [types.SimpleNamespace(X=x, Y=y, Z=z) for x, y, z in self]

    def ComputeNormals(self) -> None:
        pass

    def ToPolylineCurve(self) -> list[Any]:
        return list(self)


class _Ngon:
    def __init__(self, corners: list[int], faces: list[int]) -> None:
        self.corners, self.faces = corners, faces

    @staticmethod
    def Create(corners: list[int], faces: list[int]) -> _Ngon:
        return _Ngon(corners, faces)

    def BoundaryVertexIndexList(self) -> list[int]:
        return self.corners


class _Mesh:
    def __init__(self) -> None:
        self.Vertices, self.Faces, self.Ngons, self.Normals = (_Many() for _ in range(4))

    def GetNgonAndFacesEnumerable(self) -> list[_Ngon]:
        inside = {face for ngon in self.Ngons for face in ngon.faces}
        alone = [_Ngon(list(f), [i]) for i, f in enumerate(self.Faces) if i not in inside]
        return [*self.Ngons, *alone]


@pytest.fixture
def document(monkeypatch: pytest.MonkeyPatch) -> types.SimpleNamespace:
    """The document of a Rhino that is not there."""
    document = types.SimpleNamespace(ModelUnitSystem="mm")
    made = types.ModuleType("Rhino")
    made.UnitSystem = types.SimpleNamespace(Millimeters="mm")  # type: ignore[attr-defined]
    made.RhinoDoc = types.SimpleNamespace(ActiveDoc=document)  # type: ignore[attr-defined]
    made.Geometry = types.SimpleNamespace(  # type: ignore[attr-defined]
        Mesh=_Mesh,
        MeshNgon=_Ngon,
        Polyline=_Many,
        Point3d=lambda x, y, z: (x, y, z),
        LineCurve=lambda a, b: (a, b),
    )
    monkeypatch.setitem(sys.modules, "Rhino", made)
    return document


def run(name: str, **inputs: Any) -> dict[str, Any]:
    values: dict[str, Any] = dict(inputs)
    exec(compile((FOLDER / name).read_text(encoding="utf-8"), name, "exec"), values)
    return values


def test_meshes_go_there_and_back(document: types.SimpleNamespace) -> None:
    ball = Mesh.solid("soccer-ball", edge=20)
    again = rhino.from_rhino(rhino.to_rhino(ball))
    assert sorted(map(len, again.faces.tolist())) == sorted(map(len, ball.faces.tolist()))
    assert again.is_closed and len(again.vertices) == 60
    document.ModelUnitSystem = "m"
    with pytest.raises(KerfoldError, match="millimetres"):
        rhino.from_rhino(rhino.to_rhino(ball))


def test_components(document: types.SimpleNamespace, here: Path) -> None:
    model = rhino.to_rhino(Mesh.solid("cube", edge=200))
    cut = run("cut.py", M=model, what="edges", select="along=z", offset=0.25, repeat=1)
    assert len(rhino.from_rhino(cut["out_mesh"]).faces) == 10
    for what in ("vertices", "faces"):
        run("cut.py", M=model, what=what, select="all", offset=0.2, repeat=None)
    check = run("check.py", M=model, profile=None, require="planar,convex")
    assert check["passes"] and not check["findings"] and len(check["deviations"]) == 6
    net = run("unfold.py", M=model, sheet="1000x1000", kerf=None, folder=str(here / "out"))
    assert len(net["outlines"]) == 1 and len(net["folds"]) == 5 and (here / "out").is_dir()
    plates = run("panels.py", M=model, thickness=10.0, gap=None, folder="")
    assert plates["names"] == [f"P{i:02}" for i in range(1, 7)] and len(plates["plates"]) == 6


def test_elsewhere_it_is_told() -> None:
    with pytest.raises(KerfoldError, match="kerfold.convert"):
        rhino.from_rhino(None)
