"""Nets, sheets, plates, D-forms and recipes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import kerfold
from kerfold import KerfoldError, KerfoldKeywordError, Mesh

from conftest import ROOT


def area(points: np.ndarray) -> float:
    x, y = points.T
    return float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2


def test_a_net_is_arrays(cube: Mesh) -> None:
    net = cube.unfold()
    assert (len(net.pieces), len(net.folds), len(net.seams), len(net.rims)) == (1, 5, 7, 0)
    assert net.proof.overlaps == 0 and net.proof.congruence_mm < 1e-9
    piece = net.pieces[0]
    assert piece.id == "P01" and area(piece.outline) == pytest.approx(6 * 1600)
    assert sorted(piece.faces.tolist()) == list(range(6))
    for face, corners in zip(piece.faces, piece.polygons):
        assert corners.tolist() == cube.faces[int(face)].tolist()
    assert np.allclose(net.folds.angles, 90) and np.allclose(net.seams.lengths, 40)
    assert net.seams.segments.shape == (7, 2, 2, 2)
    sides = np.linalg.norm(net.seams.segments[:, :, 0] - net.seams.segments[:, :, 1], axis=-1)
    assert np.allclose(sides, 40)
    assert np.array_equal(cube.edges[net.folds.edges], net.folds.vertices)
    both = sorted([*net.folds.edges.tolist(), *net.seams.edges.tolist()])
    assert both == list(range(12))
    assert "1 pieces" in net._repr_html_() and piece._repr_svg_().startswith("<svg")


def test_rims_of_an_open_mesh() -> None:
    points = np.array([[0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0], [5, 5, 5]], float)
    tent = Mesh(points, [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
    net = tent.unfold()
    assert len(net.rims) == 4 and net.rims.segments.shape == (4, 2, 2)


def test_sheets(cube: Mesh, here: Path) -> None:
    net = cube.unfold(sheet="300x200", kerf=0.2)
    (sheet,) = net.sheets()
    assert (sheet.width, sheet.height, sheet.id) == (300, 200, "S01")
    assert [p.piece for p in sheet.placed] == ["P01"]
    assert sheet.svg.lstrip().startswith("<") and "<svg" in sheet.svg and sheet._repr_svg_()
    assert "SECTION" in sheet.dxf and sheet.pdf.startswith(b"%PDF")
    assert sheet.png.startswith(b"\x89PNG") and "LightBurn" in sheet.lbrn2
    for ending in ("svg", "dxf", "pdf", "lbrn2", "png"):
        sheet.save(f"sheet.{ending}")
    assert (here / "sheet.svg").read_text(encoding="utf-8") == sheet.svg
    with pytest.raises(KerfoldError, match="is no sheet"):
        sheet.save("sheet.dwg")
    layout = net.layout
    assert layout is not None and 0 < layout.density < 1 and layout.cut_length > 400


def test_the_same_pieces_on_other_sheets(cube: Mesh) -> None:
    net = cube.unfold()
    (small,) = net.sheets(sheet="200x180", kerf="0.1mm")
    assert (small.width, small.height) == (200, 180)
    at_once = cube.unfold(sheet="200x180", kerf="0.1mm")
    assert net.on(sheet="200x180", kerf="0.1mm").files() == at_once.files()
    with pytest.raises(KerfoldError, match="too large|do not fit|room") as caught:
        net.sheets(sheet="90x90")
    assert caught.value.code is not None
    assert len(cube.unfold(sheet="90x90").pieces) > 1
    with pytest.raises(KerfoldKeywordError, match="did you mean 'kerf'"):
        net.sheets(kerff=1)


def test_plates(here: Path) -> None:
    cube = Mesh.solid("cube", edge=200)
    panels = cube.panels(thickness="10mm", sheet="1000x1000")
    assert [plate.id for plate in panels.plates] == [f"P{i:02}" for i in range(1, 7)]
    plate = panels.plates[0]
    assert plate.thickness == 10 and np.allclose(np.abs(plate.bevels), 45)
    assert area(plate.front) == pytest.approx(200 * 200) and plate.triangles.shape[1] == 3
    a, b, c = (plate.vertices[plate.triangles[:, i]] for i in range(3))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
    assert volume == pytest.approx(plate.volume)
    assert panels.schedule["totals"]["panels"] == 6 and len(panels.sheets()) == 1
    paths = panels.save("plates")
    assert {Path(path).name for path in paths} >= {"panels.json", "plates.step", "schedule.xlsx"}
    assert "6 plates" in panels._repr_html_()


def test_a_d_form_of_a_solid_and_of_outlines(here: Path) -> None:
    made = kerfold.dform("dodecahedron", size="180mm", roll="max", strips=3)
    assert made.net is not None and made.net.proof.overlaps == 0 and made.net.pieces
    assert made.report.faces == len(made.mesh.faces)
    same = Mesh.solid("dodecahedron", size="180mm").dform(roll="max", strips=3)
    assert np.array_equal(same.mesh.vertices, made.mesh.vertices)
    two = kerfold.dform(outlines=["ellipse-2x1@180mm", "ellipse-2x1@180mm"], start=0.125)
    assert two.net is not None and len(two.net.pieces) == 2
    assert "model.obj" in two.files() and two._repr_html_()
    with pytest.raises(KerfoldKeywordError, match="did you mean 'strips'"):
        kerfold.dform("cube", stripes=3)
    with pytest.raises(KerfoldError):
        kerfold.dform("kube")


def test_recipes(here: Path) -> None:
    text = (
        'name = "Box"\n[parameters]\nsize = "80mm"\n[[step]]\nsolid = "cube"\n'
        'size = "{size}"\n[[step]]\nunfold = "one"\n'
    )
    made = kerfold.run(text, set={"size": 50})
    assert made.name == "Box" and np.ptp(made.mesh.vertices[:, 0]) == pytest.approx(50)
    (here / "box.toml").write_text(text)
    kerfold.run(here / "box.toml", "out")
    assert (here / "out" / "sheet-01.svg").exists()
    with pytest.raises(KerfoldError, match="did you mean `size`") as caught:
        kerfold.run(text, set={"sise": 50})
    assert caught.value.code == "E707"
    with pytest.raises(KerfoldError, match="line 3") as caught:
        kerfold.run('[[step]]\nsolid = "cube"\nszie = 3\n')
    assert caught.value.code == "E702"
    with pytest.raises(KerfoldError) as caught:
        kerfold.run("nowhere.toml")
    assert caught.value.code == "E101"


def test_nesting_of_anybody_s_pieces(here: Path) -> None:
    (here / "lid.json").write_text('{"pieces": [{"id": "lid", "outline": [[0,0],[30,0],[30,20]]}]}')
    net = kerfold.nest("lid.json", quantity=4, sheet="100x100")
    assert len(net.pieces) == 4 and len(net.sheets()) == 1
    net.save("out")
    assert (here / "out" / "layout.json").exists()
    with pytest.raises(KerfoldError, match="nested"):
        net.sheets(sheet="200x200")


def test_nothing_is_half_written(here: Path, cube: Mesh) -> None:
    (here / "file").write_text("x")
    with pytest.raises(KerfoldError):
        cube.unfold().save(here / "file")
    assert (here / "file").read_text() == "x"
    cube.unfold(sheet="90x90").save("out")
    many = len(list((here / "out").glob("sheet-*.svg")))
    cube.unfold(sheet="600x400").save("out")
    assert len(list((here / "out").glob("sheet-*.svg"))) == many > 1
    cube.unfold(sheet="600x400").save("out", clean=True)
    assert len(list((here / "out").glob("sheet-*.svg"))) == 1


def test_bundled_recipes_run() -> None:
    made = kerfold.run("two-piece-d-form")
    assert made.net is not None and len(made.net.pieces) == 2
    assert (ROOT / "fixtures" / "recipes" / "two-piece-d-form.toml").exists()
