"""What the buttons do."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any, Callable

import bpy
import kerfold

from . import exchange


def told(operator: bpy.types.Operator, work: Callable[[], set[str]]) -> set[str]:
    """Does some work, and shows errors and findings as Blender does."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            result = work()
        except kerfold.KerfoldError as error:
            operator.report({"ERROR"}, str(error))
            result = {"CANCELLED"}
    for warning in caught:
        operator.report({"WARNING"}, str(warning.message))
    return result


class MeshOperator:
    """Works on the active mesh."""

    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        thing = context.active_object
        return thing is not None and thing.type == "MESH"

    def execute(self, context: bpy.types.Context) -> set[str]:
        thing = context.active_object
        # What is edited is written to the mesh when edit mode is left.
        is_edited = thing.mode == "EDIT"
        if is_edited:
            bpy.ops.object.mode_set(mode="OBJECT")
        try:
            return told(self, lambda: self.work(context, thing))  # type: ignore[arg-type]
        finally:
            if is_edited and context.active_object is thing:
                bpy.ops.object.mode_set(mode="EDIT")

    def work(self, context: bpy.types.Context, thing: bpy.types.Object) -> set[str]:
        raise NotImplementedError

    def show(self, context: bpy.types.Context, mesh: kerfold.Mesh, thing: Any, what: str) -> None:
        """Puts the result beside what it came from, which is hidden."""
        made = exchange.object_of(context, mesh, f"{thing.name} {what}", thing)
        thing.select_set(False)
        thing.hide_set(True)
        made.select_set(True)
        context.view_layer.objects.active = made


class KERFOLD_OT_cut(MeshOperator, bpy.types.Operator):
    """Cut the selected edges off; repeated, each becomes a developable strip"""

    bl_idname = "kerfold.cut"
    bl_label = "Cut selected edges"

    def work(self, context: bpy.types.Context, thing: bpy.types.Object) -> set[str]:
        settings = context.scene.kerfold
        mesh = exchange.mesh_of(context, thing)
        edges = exchange.marked(thing, mesh, "select")
        made = mesh.cut_edges(edges, offset=settings.offset, repeat=settings.repeat)
        self.show(context, made, thing, "cut")
        return {"FINISHED"}


class KERFOLD_OT_roll(MeshOperator, bpy.types.Operator):
    """Make a D-form: choose its folds, roll them into even strips"""

    bl_idname = "kerfold.roll"
    bl_label = "Roll into a D-form"

    def work(self, context: bpy.types.Context, thing: bpy.types.Object) -> set[str]:
        settings = context.scene.kerfold
        mesh = exchange.mesh_of(context, thing)
        made = mesh.dform(roll="max", strips=settings.strips, sheet="none")
        self.show(context, made.mesh, thing, "D-form")
        return {"FINISHED"}


class KERFOLD_OT_check(MeshOperator, bpy.types.Operator):
    """Colour faces by how far they are from planar: green is flat, yellow the limit, red beyond"""

    bl_idname = "kerfold.check"
    bl_label = "Check planarity"

    def work(self, context: bpy.types.Context, thing: bpy.types.Object) -> set[str]:
        mesh = exchange.mesh_of(context, thing)
        report = mesh.check(context.scene.kerfold.profile)
        rows = report.data["planarity"]["faces"]
        limits = report.data["profile"]
        names = (("mm", "max_mm"), ("permille", "max_permille"), ("degrees", "max_degrees"))

        def share(row: dict[str, Any]) -> float:
            return max((row[k] / limits[m] for k, m in names if limits.get(m)), default=0.0)

        import numpy as np

        exchange.add_values(thing, "kerfold_mm", np.array([row["mm"] for row in rows]))
        exchange.add_colours(thing, "kerfold_planarity", np.array([share(row) for row in rows]))
        words = f"{report.verdict}: out of plane by {report.planarity_mm:.3g} mm at most"
        self.report({"INFO"}, words)
        return {"FINISHED"}


class KERFOLD_OT_unfold(MeshOperator, bpy.types.Operator):
    """Unfold to sheets beside the .blend file; marked seams open, sharp edges stay folds"""

    bl_idname = "kerfold.unfold"
    bl_label = "Unfold to sheets"
    bl_options = {"REGISTER"}

    def work(self, context: bpy.types.Context, thing: bpy.types.Object) -> set[str]:
        if not bpy.data.filepath:
            raise kerfold.KerfoldError("save the .blend file first; the sheets go beside it")
        settings = context.scene.kerfold
        mesh = exchange.mesh_of(context, thing)
        marks = {
            "cut": exchange.marked(thing, mesh, "use_seam"),
            "keep": exchange.marked(thing, mesh, "use_edge_sharp"),
        }
        keys: dict[str, Any] = {name: edges for name, edges in marks.items() if len(edges)}
        net = mesh.unfold(
            settings.pieces,
            sheet=settings.sheet,
            kerf=settings.kerf,
            format="svg,dxf,pdf",
            title=thing.name,
            **keys,
        )
        stem = Path(bpy.data.filepath).stem
        folder = Path(bpy.data.filepath).with_name(f"{stem}-{bpy.path.clean_name(thing.name)}")
        net.save(folder, clean=True)
        pieces, sheets = len(net.pieces), len(net.sheets())
        self.report({"INFO"}, f"{pieces} pieces on {sheets} sheets in {folder}")
        return {"FINISHED"}


CLASSES = (KERFOLD_OT_cut, KERFOLD_OT_roll, KERFOLD_OT_check, KERFOLD_OT_unfold)
