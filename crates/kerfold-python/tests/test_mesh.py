"""Meshes: arrays in and out, files, groups, selections."""

from __future__ import annotations

import copy
import pickle
from pathlib import Path

import numpy as np
import pytest

import kerfold
from kerfold import Faces, KerfoldError, Mesh

VERTICES = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float) * 10
SIDES = np.array(
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
)


def same(a: Mesh, b: Mesh) -> bool:
    return (
        np.array_equal(a.vertices, b.vertices)
        and np.array_equal(a.faces.corners, b.faces.corners)
        and np.array_equal(a.faces.offsets, b.faces.offsets)
    )


@pytest.mark.parametrize(
    "faces",
    [
        SIDES,
        SIDES.astype(np.int32),
        SIDES.astype(np.uint32),
        SIDES.astype(np.uint64),
        SIDES.astype(np.int16),
        SIDES.astype(">i8"),
        np.asfortranarray(SIDES),
        SIDES.tolist(),
        [tuple(face) for face in SIDES],
        iter(SIDES.tolist()),
        (SIDES.reshape(-1), np.arange(0, 25, 4)),
        Faces(SIDES.reshape(-1).copy(), np.arange(0, 25, 4)),
    ],
)
def test_faces_may_come_in_many_forms(faces: object) -> None:
    mesh = Mesh(VERTICES, faces)
    assert np.array_equal(mesh.vertices, VERTICES)
    assert np.array_equal(np.asarray(mesh.faces), SIDES)
    assert mesh.is_closed and len(mesh.edges) == 12
    assert mesh.vertices.dtype == np.dtype("f8") and mesh.faces.corners.dtype == np.dtype("i8")


@pytest.mark.parametrize(
    "vertices", [VERTICES, VERTICES.tolist(), VERTICES.astype("f4"), np.asfortranarray(VERTICES)]
)
def test_vertices_may_come_in_many_forms(vertices: object) -> None:
    assert np.array_equal(Mesh(vertices, SIDES).vertices, VERTICES)  # type: ignore[arg-type]


def test_polygons_of_different_sides() -> None:
    prism = Mesh.solid("prism-6", edge=10)
    assert prism.faces.sides is None and len(prism.faces) == 8
    assert sorted(len(face) for face in prism.faces) == [4] * 6 + [6] * 2
    assert same(Mesh(prism.vertices, prism.faces), prism)
    assert same(Mesh(prism.vertices, prism.faces.tolist()), prism)
    assert prism.faces[-1].tolist() == prism.faces.tolist()[-1]
    assert [face.tolist() for face in prism.faces[1:3]] == prism.faces.tolist()[1:3]
    with pytest.raises(IndexError):
        prism.faces[8]
    with pytest.raises(KerfoldError, match="different numbers of sides"):
        np.asarray(prism.faces)
    triangles, faces = prism.triangles
    assert len(triangles) == 6 * 2 + 2 * 4 and set(faces.tolist()) == set(range(8))


def test_triangles_of_a_concave_face_stay_inside() -> None:
    ell = np.array([[0, 0, 0], [3, 0, 0], [3, 1, 0], [1, 1, 0], [1, 3, 0], [0, 3, 0]], float)
    triangles, _ = Mesh(ell, [range(6)]).triangles
    a, b, c = (ell[triangles[:, i]] for i in range(3))
    areas = np.cross(b - a, c - a)[:, 2] / 2
    assert np.all(areas > 0) and areas.sum() == pytest.approx(5)


def test_nothing_changes(cube: Mesh) -> None:
    before = cube.vertices.copy()
    cut = cube.cut_edges("along=z", offset=0.25)
    assert len(cut.faces) == 10 and len(cube.faces) == 6
    assert np.array_equal(cube.vertices, before)
    for array in (cube.vertices, cube.faces.corners, cube.faces.offsets):
        with pytest.raises(ValueError):
            array[0] = 7
    assert cube.vertices is cube.vertices
    given = VERTICES.copy()
    mesh = Mesh(given, SIDES)
    given[:] = 0
    assert np.array_equal(mesh.vertices, VERTICES)


def test_groups_in_and_out(here: Path) -> None:
    mesh = Mesh(VERTICES, SIDES, {"roof": [1], "wall": np.array([2, 3, 4, 5])})
    assert {name: ids.tolist() for name, ids in mesh.groups.items()} == {
        "roof": [1],
        "wall": [2, 3, 4, 5],
    }
    mesh.write("house.obj")
    again = Mesh.read("house.obj")
    assert same(again, mesh) and list(again.groups) == ["roof", "wall"]
    assert mesh.find("group=roof").tolist() == [1]
    with pytest.raises(KerfoldError, match="face 9"):
        Mesh(VERTICES, SIDES, {"roof": [9]})


@pytest.mark.parametrize(
    "vertices, faces, code",
    [
        (VERTICES, [[0, 1, 99]], "E233"),
        (VERTICES, [[0, 1, -1]], "E233"),
        (VERTICES, [[0, 1]], "E234"),
        (VERTICES * np.nan, SIDES, "E232"),
        (VERTICES, [], "E231"),
        (VERTICES[:, :2], SIDES, "E232"),
        (VERTICES, [*SIDES.tolist(), [0, 2, 3]], "E238"),
    ],
)
def test_what_is_no_surface_is_refused(vertices: object, faces: object, code: str) -> None:
    with pytest.raises(KerfoldError) as caught:
        Mesh(vertices, faces)  # type: ignore[arg-type]
    assert caught.value.code == code and code in str(caught.value)


def test_bad_offsets_are_refused() -> None:
    for offsets in ([0, 4, 99], [0, -4], [4, 0]):
        with pytest.raises(KerfoldError, match="no corners"):
            Mesh(VERTICES, (SIDES.reshape(-1), np.array(offsets)))


def test_soup_is_mended_when_that_is_asked_for() -> None:
    # Each face has its own corners, one looks inwards, one is there twice.
    soup = VERTICES[SIDES].reshape(-1, 3)
    faces = np.arange(24).reshape(6, 4)
    faces[2] = faces[2][::-1]
    rows = [*faces.tolist(), faces[0].tolist()]
    mesh = Mesh(soup, rows, {"roof": [1]}, mend=True)
    assert mesh.is_closed and len(mesh.vertices) == 8 and len(mesh.faces) == 6
    assert len(mesh.notes) >= 3
    roof = mesh.groups["roof"]
    assert len(roof) == 1 and np.all(mesh.vertices[mesh.faces[int(roof[0])], 2] == 10)


def test_copies_and_other_processes() -> None:
    mesh = Mesh(VERTICES, SIDES, {"roof": [1]})
    for again in (pickle.loads(pickle.dumps(mesh)), copy.deepcopy(mesh)):
        assert same(again, mesh) and list(again.groups) == ["roof"]


def test_files_keep_every_digit(here: Path, cube: Mesh) -> None:
    cut = cube.cut_vertices("all", offset=1 / 3)
    for name in ("a.obj", "a.ply", "a.off"):
        cut.write(name)
        assert same(Mesh.read(name), cut), name
    inches = Mesh.read(here / "a.obj", units="in")
    assert np.allclose(inches.vertices, cut.vertices * 25.4)
    with pytest.raises(KerfoldError) as caught:
        cut.write("a.docx")
    assert caught.value.code == "E104" and not (here / "a.docx").exists()
    with pytest.raises(KerfoldError) as caught:
        Mesh.read("nowhere.obj")
    assert caught.value.code == "E101"


def test_ids_of_open_meshes_are_those_of_arrays() -> None:
    box = Mesh(VERTICES, SIDES[:5])
    for mesh in (
        box,
        box.cut_edges("along=z", offset=0.25),
        box.cut_plane(normal="x", point="5,0,0"),
    ):
        assert not mesh.is_closed
        for axis in "xyz":
            for sign in ("", "-"):
                try:
                    found = mesh.find(f"normal={sign}{axis}")
                except KerfoldError:
                    continue
                for face in found.tolist():
                    a, b, c = (mesh.vertices[mesh.faces[face][i]] for i in range(3))
                    normal = np.cross(b - a, c - b)
                    normal /= np.linalg.norm(normal)
                    assert normal["xyz".index(axis)] == pytest.approx(-1 if sign else 1)


def test_selections_find_ids(cube: Mesh) -> None:
    ids = cube.find("along=z", "edges")
    ends = cube.vertices[cube.edges[ids]]
    assert len(ids) == 4 and np.allclose(np.abs(ends[:, 0] - ends[:, 1]), [0, 0, 40])
    same_cut = [
        cube.cut_edges(select, offset=0.25)  # type: ignore[arg-type]
        for select in ("along=z", ids, ids.tolist(), tuple(ids), set(ids.tolist()))
    ]
    mask = np.zeros(12, bool)
    mask[ids] = True
    same_cut.append(cube.cut_edges(mask, offset=0.25))
    assert all(same(mesh, same_cut[0]) for mesh in same_cut)
    assert same(cube.cut_edges(int(ids[0])), cube.cut_edges(str(ids[0])))
    with pytest.raises(KerfoldError, match="names no element"):
        cube.cut_edges([])
    with pytest.raises(KerfoldError) as caught:
        cube.find("valense=3")
    assert caught.value.code is not None
    with pytest.raises(KerfoldError, match="no elements"):
        cube.find("all", "corners")  # type: ignore[arg-type]


def test_made_and_strip_are_what_the_last_step_made(cube: Mesh) -> None:
    once = cube.cut_edges([0], offset=0.2)
    twice = once.cut_edges("strip", offset=0.2)
    assert len(once.faces) == 7 and len(twice.faces) == 9
    assert twice.find("made").size == 2


def test_pictures_for_notebooks(cube: Mesh) -> None:
    assert "8 vertices" in cube._repr_html_() and "data:image/png" in cube._repr_html_()
    picture = cube.render("front", width=200)
    assert picture.png.startswith(b"\x89PNG") and picture.png[16:20] == (200).to_bytes(4, "big")
    assert repr(cube) == "<kerfold.Mesh: 8 vertices, 12 edges, 6 faces>"
    assert kerfold.__version__ and "cube" in kerfold.solid_names()
