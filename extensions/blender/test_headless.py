"""Runs the extension without a window: with ``bpy`` of the registry and the wheel installed,
``python test_headless.py``, or in Blender itself ``blender -b -P test_headless.py``."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
import kerfold_blender  # noqa: E402
from kerfold_blender import exchange  # noqa: E402


def begin() -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.unit_settings.scale_length = 0.001


def cube(size: float) -> bpy.types.Object:
    bpy.ops.mesh.primitive_cube_add(size=size)
    return bpy.context.active_object


def mark(thing: bpy.types.Object, what: str, wanted: object) -> None:
    for edge in thing.data.edges:
        ends = [np.array(thing.data.vertices[v].co) for v in edge.vertices]
        setattr(edge, what, bool(wanted(ends)))  # type: ignore[operator]


def along_z(ends: list) -> bool:
    return abs(ends[0][2] - ends[1][2]) > 1


def test_units_places_and_groups() -> None:
    begin()
    thing = cube(80)
    thing.location = (10, 0, 0)
    thing.data.materials.append(bpy.data.materials.new("roof"))
    thing.data.polygons[0].material_index = 0
    bpy.context.view_layer.update()
    mesh = exchange.mesh_of(bpy.context, thing)
    assert np.allclose(mesh.bounds, [[-30, -40, -40], [50, 40, 40]]), mesh.bounds
    assert list(mesh.groups) == ["roof"] and len(mesh.faces) == 6
    bpy.context.scene.unit_settings.scale_length = 1.0
    assert np.allclose(exchange.mesh_of(bpy.context, thing).bounds[1], [50_000, 40_000, 40_000])
    back = exchange.object_of(bpy.context, mesh, "back", thing)
    assert len(back.data.polygons) == 6 and back.data.materials[0].name == "roof"
    assert max(v.co.z for v in back.data.vertices) < 1


def test_cut_of_selected_edges() -> None:
    begin()
    thing = cube(80)
    mark(thing, "select", along_z)
    bpy.context.scene.kerfold.offset = 0.25
    assert bpy.ops.kerfold.cut() == {"FINISHED"}
    made = bpy.context.active_object
    assert made is not thing and thing.hide_get() and len(made.data.polygons) == 10
    assert len(thing.data.polygons) == 6


def test_roll() -> None:
    begin()
    bpy.ops.mesh.primitive_cube_add(size=100)
    bpy.context.scene.kerfold.strips = 3
    assert bpy.ops.kerfold.roll() == {"FINISHED"}
    assert len(bpy.context.active_object.data.polygons) > 6


def test_check_colours() -> None:
    begin()
    thing = cube(80)
    thing.data.vertices[0].co.z -= 20
    assert bpy.ops.kerfold.check() == {"FINISHED"}
    values = np.empty(6, dtype=np.float32)
    thing.data.attributes["kerfold_mm"].data.foreach_get("value", values)
    assert (values > 1).sum() >= 1 and (values < 1e-3).sum() >= 2
    colours = np.empty(4 * 24, dtype=np.float32)
    thing.data.color_attributes["kerfold_planarity"].data.foreach_get("color", colours)
    colours = colours.reshape(6, 4, 4)[:, 0]
    bent = values > 1
    assert np.all(colours[bent, 0] > 0.9) and np.all(colours[values < 1e-3, 1] > 0.9)


def test_unfold_beside_the_file() -> None:
    begin()
    thing = cube(80)
    mark(thing, "use_seam", along_z)
    try:
        bpy.ops.kerfold.unfold()
    except RuntimeError as error:
        assert "save the .blend file first" in str(error)
    else:
        raise AssertionError("it was not saved")
    with tempfile.TemporaryDirectory() as folder:
        bpy.ops.wm.save_as_mainfile(filepath=str(Path(folder) / "box.blend"))
        assert bpy.ops.kerfold.unfold() == {"FINISHED"}
        made = Path(folder) / f"box-{bpy.path.clean_name(thing.name)}"
        names = {path.name for path in made.iterdir()}
        assert {"sheet-01.svg", "sheet-01.dxf", "sheet-01.pdf", "pieces.json"} <= names
        import json

        net = json.loads((made / "pieces.json").read_text())
        ends = [{*seam["edge"]} for seam in net["seams"]]
        for edge in thing.data.edges:
            assert not edge.use_seam or {*edge.vertices} in ends


def test_errors_are_told() -> None:
    begin()
    cube(80)
    mark(bpy.context.active_object, "select", lambda ends: False)
    try:
        bpy.ops.kerfold.cut()
    except RuntimeError as error:
        assert "names no element" in str(error)
    else:
        raise AssertionError("nothing was selected")


def main() -> None:
    kerfold_blender.register()
    passed = 0
    for name, test in list(globals().items()):
        if name.startswith("test_"):
            test()
            passed += 1
            sys.stdout.write(f"{name}: passed\n")
    kerfold_blender.unregister()
    sys.stdout.write(f"{passed} passed, 0 failed\n")


main()
