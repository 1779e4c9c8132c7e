"""The panel in the sidebar of the 3D view (N), and what is set there."""

from __future__ import annotations

import bpy

PROFILES = [
    (name, name, about)
    for name, about in (
        ("exact", "1e-9 of the diameter of a face"),
        ("glass", "2 per mille and 1 mm"),
        ("plywood", "1 mm"),
        ("paper", "0.5 degrees"),
    )
]


class Settings(bpy.types.PropertyGroup):
    offset: bpy.props.FloatProperty(  # type: ignore[valid-type]
        name="Offset",
        default=0.25,
        min=0.001,
        max=1.0,
        description="Where the cut meets the other edges: 0 at the edge, 1 at their far ends",
    )
    repeat: bpy.props.IntProperty(  # type: ignore[valid-type]
        name="Rounds",
        default=1,
        min=1,
        max=12,
        description="How often; every further round cuts the long edges of the strips",
    )
    strips: bpy.props.IntProperty(  # type: ignore[valid-type]
        name="Strips",
        default=5,
        min=1,
        max=64,
        description="Faces across every rolled edge",
    )
    profile: bpy.props.EnumProperty(  # type: ignore[valid-type]
        name="Profile",
        items=PROFILES,
        default="paper",
        description="How planar faces must be",
    )
    pieces: bpy.props.StringProperty(  # type: ignore[valid-type]
        name="Pieces",
        default="auto",
        description="auto, one, faces, strips, or a number",
    )
    sheet: bpy.props.StringProperty(  # type: ignore[valid-type]
        name="Sheet",
        default="A3",
        description="A4, A3, 600x400 or 24inx12in",
    )
    kerf: bpy.props.StringProperty(  # type: ignore[valid-type]
        name="Kerf",
        default="0mm",
        description="Width of the cut, such as 0.15mm",
    )


class KERFOLD_PT_panel(bpy.types.Panel):
    bl_label = "kerfold"
    bl_idname = "KERFOLD_PT_panel"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "kerfold"

    def draw(self, context: bpy.types.Context) -> None:
        layout, settings = self.layout, context.scene.kerfold
        if context.mode == "EDIT_MESH":
            marks = layout.column(align=True)
            marks.label(text="Selected edges")
            marks.operator("mesh.mark_seam", text="Open (seam)").clear = False
            marks.operator("mesh.mark_sharp", text="Keep as fold (sharp)").clear = False
            clear = marks.row(align=True)
            clear.operator("mesh.mark_seam", text="Clear seam").clear = True
            clear.operator("mesh.mark_sharp", text="Clear fold").clear = True
        for title, names, action in (
            ("Carve", ("offset", "repeat"), "kerfold.cut"),
            ("D-form", ("strips",), "kerfold.roll"),
            ("Check", ("profile",), "kerfold.check"),
            ("Sheets", ("pieces", "sheet", "kerf"), "kerfold.unfold"),
        ):
            box = layout.box()
            box.label(text=title)
            for name in names:
                box.prop(settings, name)
            box.operator(action)


CLASSES = (Settings, KERFOLD_PT_panel)
