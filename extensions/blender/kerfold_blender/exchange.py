"""Meshes between Blender and kerfold.

Blender's own marks mean: an edge marked as a seam opens, one marked sharp stays a fold. Material
slots are groups of faces. Lengths are the scene's, in millimetres.
"""

from __future__ import annotations

import bpy
import kerfold
import numpy as np


def scale_of(context: bpy.types.Context) -> float:
    """Millimetres in a unit of Blender."""
    return 1000.0 * context.scene.unit_settings.scale_length


def mesh_of(
    context: bpy.types.Context, thing: bpy.types.Object, *, mend: bool = False
) -> kerfold.Mesh:
    """The mesh of an object as it stands in the world, in mm."""
    data = thing.data
    places = np.empty(3 * len(data.vertices))
    data.vertices.foreach_get("co", places)
    matrix = np.array(thing.matrix_world)
    places = (places.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]) * scale_of(context)
    corners = np.empty(len(data.loops), dtype=np.int32)
    data.loops.foreach_get("vertex_index", corners)
    offsets = np.empty(len(data.polygons) + 1, dtype=np.int64)
    starts = np.empty(len(data.polygons), dtype=np.int32)
    data.polygons.foreach_get("loop_start", starts)
    offsets[:-1], offsets[-1] = starts, len(corners)
    slots = np.empty(len(data.polygons), dtype=np.int32)
    data.polygons.foreach_get("material_index", slots)
    groups = {
        slot.material.name: np.flatnonzero(slots == number)
        for number, slot in enumerate(thing.material_slots)
        if slot.material is not None and np.any(slots == number)
    }
    faces = [corners[a:b] for a, b in zip(offsets, offsets[1:])] if mend else (corners, offsets)
    return kerfold.Mesh(places, faces, groups, mend=mend)


def marked(thing: bpy.types.Object, mesh: kerfold.Mesh, what: str) -> np.ndarray:
    """The edges of our mesh that are marked in Blender: `use_seam`, `use_edge_sharp` or `select`.

    An edge is known by its ends, which both meshes number alike.
    """
    edges = thing.data.edges
    ends = np.empty(2 * len(edges), dtype=np.int32)
    edges.foreach_get("vertices", ends)
    is_marked = np.empty(len(edges), dtype=bool)
    edges.foreach_get(what, is_marked)
    wanted = np.sort(ends.reshape(-1, 2)[is_marked], axis=1)
    ours = np.sort(mesh.edges, axis=1)
    count = len(mesh.vertices)
    return np.flatnonzero(np.isin(ours @ (count, 1), wanted.astype(np.int64) @ (count, 1)))


def object_of(
    context: bpy.types.Context, mesh: kerfold.Mesh, name: str, like: bpy.types.Object
) -> bpy.types.Object:
    """A new object of a mesh, in the collection of another one, with its materials as groups."""
    data = bpy.data.meshes.new(name)
    places = mesh.vertices / scale_of(context)
    data.from_pydata(places.tolist(), [], mesh.faces.tolist())
    for number, (group, faces) in enumerate(mesh.groups.items()):
        material = bpy.data.materials.get(group) or bpy.data.materials.new(group)
        data.materials.append(material)
        for face in faces.tolist():
            data.polygons[face].material_index = number
    data.validate()
    data.update()
    made = bpy.data.objects.new(name, data)
    collections = like.users_collection or (context.scene.collection,)
    collections[0].objects.link(made)
    return made


def add_values(thing: bpy.types.Object, name: str, values: np.ndarray) -> None:
    """A number for each face as an attribute that shaders and geometry nodes can read."""
    attributes = thing.data.attributes
    if name in attributes:
        attributes.remove(attributes[name])
    attribute = attributes.new(name, "FLOAT", "FACE")
    attribute.data.foreach_set("value", np.asarray(values, dtype=np.float32))


def add_colours(thing: bpy.types.Object, name: str, shares: np.ndarray) -> None:
    """A colour for each corner, from green (0) over yellow (1, the limit) to red (2 and more)."""
    attributes = thing.data.color_attributes
    if name in attributes:
        attributes.remove(attributes[name])
    attribute = attributes.new(name, "BYTE_COLOR", "CORNER")
    share = np.clip(shares, 0.0, 2.0)
    colour = np.ones((len(share), 4), dtype=np.float32)
    colour[:, 0] = np.clip(share, 0.0, 1.0)
    colour[:, 1] = np.clip(2.0 - share, 0.0, 1.0)
    colour[:, 2] = 0.1
    totals = np.empty(len(thing.data.polygons), dtype=np.int32)
    thing.data.polygons.foreach_get("loop_total", totals)
    attribute.data.foreach_set("color", np.repeat(colour, totals, axis=0).reshape(-1))
    attributes.active_color = attribute
