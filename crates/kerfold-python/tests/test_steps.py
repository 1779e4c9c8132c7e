"""Methods made of steps: names, keywords, docs, stubs, errors and warnings."""

from __future__ import annotations

import inspect
import warnings
from pathlib import Path

import numpy as np
import pytest

import kerfold
from kerfold import KerfoldError, KerfoldKeywordError, KerfoldWarning, Mesh
from kerfold._schema import STEPS
from kerfold._stubs import stub


def test_every_step_is_a_method_and_says_what_it_takes() -> None:
    assert {
        "cut_edges",
        "cut_vertices",
        "cut_faces",
        "cut_plane",
        "planarize",
        "unfold",
        "panels",
        "dform",
        "check",
        "solid",
        "read",
        "height",
        "planes",
        "hull",
    } <= set(STEPS)
    for step in STEPS.values():
        if step.name == "nest":
            continue
        method = getattr(Mesh, step.name)
        names = [name for name in inspect.signature(method).parameters if name != "self"]
        assert names and sorted(names) == sorted(key.name for key in step.keys)
        doc = inspect.getdoc(method) or ""
        assert doc.startswith(step.help[:20])
        for key in step.keys:
            assert f"{key.name} : " in doc and key.help[:30] in " ".join(doc.split())
        assert "Returns" in doc


def test_the_stubs_are_those_of_the_steps() -> None:
    written = Path(kerfold.__file__).with_name("_steps.pyi").read_text(encoding="utf-8")
    assert written == stub(), "python -m kerfold._stubs > python/kerfold/_steps.pyi"


def test_signatures_have_units_and_defaults() -> None:
    signature = inspect.signature(Mesh.cut_edges)
    assert signature.parameters["scope"].default == "global"
    assert signature.parameters["repeat"].default == 1
    assert signature.parameters["offset"].default is None
    assert signature.parameters["select"].default is inspect.Parameter.empty
    doc = Mesh.unfold.__doc__ or ""
    assert "kerf : float (mm) or str such as '3mm'" in doc
    assert "sharp : float (degrees) or str such as '30deg'" in doc


def test_wrong_keywords_are_told_with_the_nearest(cube: Mesh) -> None:
    with pytest.raises(KerfoldKeywordError, match="did you mean 'offset'") as caught:
        cube.cut_edges("all", ofset=0.2)  # type: ignore[call-arg]
    assert isinstance(caught.value, TypeError) and caught.value.code == "E702"
    with pytest.raises(KerfoldKeywordError, match="needs select"):
        cube.cut_edges(offset=0.2)  # type: ignore[call-arg]
    with pytest.raises(KerfoldKeywordError, match="without a keyword"):
        cube.planarize("exact", "fixed")  # type: ignore[call-arg]
    with pytest.raises(KerfoldError) as error:
        cube.cut_edges("along=w")
    assert "line 1" not in str(error.value)
    with pytest.raises(KerfoldError, match="cube"):
        Mesh.solid("kube")
    with pytest.raises(TypeError, match="`offset` is a dict"):
        cube.cut_edges("all", offset={})  # type: ignore[arg-type]


@pytest.mark.filterwarnings("ignore::kerfold.KerfoldWarning")
def test_words_of_the_language_get_a_stroke() -> None:
    ball = Mesh.solid("soccer-ball", edge=10)
    mug = ball.handle(2, to=5, segments=4)
    again = ball.handle(from_="2", to="5", segments=4)
    assert np.array_equal(mug.vertices, again.vertices)
    assert len(mug.vertices) - len(mug.edges) + len(mug.faces) == 0


@pytest.mark.filterwarnings("ignore::kerfold.KerfoldWarning")
def test_every_operator_works(cube: Mesh) -> None:
    ball = Mesh.solid("soccer-ball", edge=20)
    octahedron = Mesh.solid("octahedron", edge=40)
    assert len(cube.cut_vertices("all").faces) == 14
    assert len(cube.cut_faces([0], offset=0.2).faces) == 6
    assert len(cube.cut_plane(normal="-z", point=(0, 0, 5)).faces) == 6
    assert len(octahedron.hull("dual", no_box=True).faces) == 6
    assert len(octahedron.hull("convex").faces) == len(octahedron.hull().faces) == 8
    assert len(octahedron.resolve().vertices) > 6
    assert len(cube.planarize("exact").faces) == 6
    assert len(cube.subdivide("doo-sabin", rounds=2).faces) > 50
    triangles = cube.subdivide("triangulate")
    assert len(triangles.merge().faces) == 6
    assert len(triangles.repair().faces) == len(triangles.faces)
    scan = Mesh.solid("geodesic-4", edge=10)
    assert len(scan.simplify(100).faces) <= 104
    assert len(scan.simplify(deviation="1mm").faces) < len(scan.faces)
    assert Mesh.solid("tetrahedron", edge=50).sierpinski(2).check().genus > 0
    assert ball.rind(2, peel="sides=5").check().genus == 11
    assert cube.menger(1).check().genus == 5
    roof = Mesh.height("x*x/400+y*y/500", domain="100x80")
    assert len(roof.panelize(size=20).faces) > 10


def test_a_check_is_a_report(cube: Mesh, here: Path) -> None:
    report = cube.check("exact", require=["planar", "valence3", "closed"])
    assert report.passes and report.verdict == "pass"
    assert (report.vertices, report.edges, report.faces, report.genus) == (8, 12, 6, 0)
    assert report.valences == {3: 8} and report.is_convex and report.planarity_mm < 1e-12
    with pytest.warns(KerfoldWarning) as caught:
        failed = Mesh.solid("octahedron", edge=20).check(require="valence3,closed")
    assert len(caught) == 1 and "and 5 more" in str(caught[0].message)
    assert isinstance(caught[0].message, KerfoldWarning)
    assert caught[0].message.code == failed.findings[0].code
    assert [f.id for f in failed.findings] == list(range(6)) and not failed.passes
    title, text = kerfold.explain(failed.findings[0].code) or ("", "")
    assert title and text and kerfold.explain("E999") is None
    for name in ("r.html", "r.pdf", "r.json", "r.csv"):
        report.save(name)
        assert (here / name).stat().st_size > 100
    with pytest.raises(KerfoldError, match="names no report"):
        report.save("r.txt")
    assert "genus 0" in report._repr_html_()


def test_what_an_operator_did_not_reach_is_a_warning(cube: Mesh) -> None:
    rough = cube.subdivide("honeycomb", rounds=2)
    with pytest.warns(KerfoldWarning) as caught:
        rough.planarize("exact", rounds=1)
    codes = {w.message.code for w in caught if isinstance(w.message, KerfoldWarning)}
    assert "F501" in codes
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        cube.planarize("exact")
