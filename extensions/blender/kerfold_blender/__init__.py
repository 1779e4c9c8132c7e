"""kerfold in the sidebar of Blender: mark edges, cut, roll, check, unfold to sheets."""

from __future__ import annotations

import bpy

from . import operators, panel

CLASSES = (*operators.CLASSES, *panel.CLASSES)


def register() -> None:
    for one in CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Scene.kerfold = bpy.props.PointerProperty(type=panel.Settings)


def unregister() -> None:
    del bpy.types.Scene.kerfold
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
