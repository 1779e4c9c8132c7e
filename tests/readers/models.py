"""Reads model files that kerfold writes with programs that are not ours, and lets kerfold read theirs.

usage: models.py KERFOLD [FOLDER]

- 3MF: lib3mf (of the 3MF Consortium) in its strict mode, and trimesh; volume, unit, groups as materials.
- DXF: ezdxf audits it; faces, layers, and the visible edges.
- GLB of plates: the extras of every node are those of panels.json.
- OBJ of plates with plates.mtl: trimesh finds as many colours as there are groups of congruent panels.
- FOLD: the rules of its schema and of its specification, and that folding the crease pattern by its angles gives the closed form.
- GLB and 3MF that trimesh and lib3mf wrote are read by kerfold with their size, volume and names.
Exits with 1 and says what is wrong.
"""

import json
import math
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

import ezdxf
import lib3mf
import numpy as np
import openpyxl
import trimesh
from ezdxf.audit import Auditor
from ezdxf.lldxf.encoding import decode_dxf_unicode

SOLIDS = ["tetrahedron", "cube", "soccer-ball", "snub-cube", "prism-10", "antiprism-5", "geodesic-4"]
faults = []


def expect(condition, text):
    if not condition:
        faults.append(text)


def near(a, b, part=1e-9):
    return abs(a - b) <= part * max(abs(a), abs(b), 1e-300)


def run(kerfold, *arguments):
    subprocess.run([kerfold, *map(str, arguments), "--quiet"], check=True, stdout=subprocess.DEVNULL)


def info(kerfold, path):
    ran = subprocess.run([kerfold, "info", path, "--json"], check=True, capture_output=True, text=True)
    return json.loads(ran.stdout)


def polygons(path):
    """Vertices and faces of an OBJ with their groups."""
    vertices, faces, groups, group = [], [], [], None
    for line in path.read_text().splitlines():
        words = line.split()
        if line.startswith("v "):
            vertices.append([float(w) for w in words[1:4]])
        elif line.startswith("g "):
            group = None if words[1] == "default" else " ".join(words[1:])
        elif line.startswith("f "):
            faces.append([int(w) - 1 for w in words[1:]])
            groups.append(group)
    return np.array(vertices), faces, groups


def volume(vertices, faces):
    fan = [(face[0], face[i - 1], face[i]) for face in faces for i in range(2, len(face))]
    return sum(np.dot(vertices[a], np.cross(vertices[b], vertices[c])) for a, b, c in fan) / 6


def check_3mf(path, vertices, faces, groups, title):
    wrapper = lib3mf.get_wrapper() if hasattr(lib3mf, "get_wrapper") else lib3mf.Wrapper()
    model = wrapper.CreateModel()
    reader = model.QueryReader("3mf")
    reader.SetStrictModeActive(True)
    reader.ReadFromFile(str(path))
    warnings = [reader.GetWarning(i) for i in range(reader.GetWarningCount())]
    expect(not warnings, f"{title}: lib3mf warns {warnings}")
    expect(model.GetUnit() == lib3mf.ModelUnit.MilliMeter, f"{title}: unit {model.GetUnit()}")
    objects = model.GetMeshObjects()
    expect(objects.Count() == 1 and objects.MoveNext(), f"{title}: {objects.Count()} objects")
    mesh = objects.GetCurrentMeshObject()
    expect(mesh.GetVertexCount() == len(vertices), f"{title}: lib3mf counts {mesh.GetVertexCount()} vertices")
    expect(mesh.IsManifoldAndOriented(), f"{title}: not manifold for lib3mf")
    names = {group or "default" for group in groups}
    materials = set()
    found = model.GetBaseMaterialGroups()
    while found.MoveNext():
        group = found.GetCurrentBaseMaterialGroup()
        materials |= {group.GetName(i) for i in group.GetAllPropertyIDs()}
    expect(materials == (names if names != {"default"} else set()), f"{title}: materials {materials} for {names}")
    scene = trimesh.load(path, process=False, force="mesh")
    expect(near(scene.volume, volume(vertices, faces), 1e-6), f"{title}: trimesh finds volume {scene.volume}")


def check_dxf(path, vertices, faces, groups, title):
    document = ezdxf.readfile(path)
    auditor = Auditor(document)
    auditor.run_all_tests() if hasattr(auditor, "run_all_tests") else document.audit()
    expect(not auditor.errors and not auditor.fixes, f"{title}: ezdxf finds {auditor.errors[:3]} {auditor.fixes[:3]}")
    expect(document.units == 4, f"{title}: units {document.units}")
    found = list(document.modelspace().query("3DFACE"))
    layers = {face.dxf.layer for face in found}
    wanted = {group or "0" for group in groups}
    shown = {decode_dxf_unicode(layer) for layer in layers}
    expect(shown == wanted, f"{title}: layers {layers} for {wanted}")
    expect(layers <= {layer.dxf.name for layer in document.layers}, f"{title}: a layer is not in the table")
    seen = set()
    total = 0.0
    for face in found:
        corners = [np.array(corner) for corner in face.wcs_vertices()]
        total += sum(np.dot(corners[0], np.cross(corners[i - 1], corners[i])) for i in range(2, len(corners))) / 6
        shown = face.get_edges_visibility()
        quad = [tuple(face.dxf.get(f"vtx{i}")) for i in range(4)]
        for i in range(4):
            a, b = quad[i], quad[(i + 1) % 4]
            if shown[i] and a != b:
                seen.add(frozenset((a, b)))
    edges = {frozenset((f[i], f[(i + 1) % len(f)])) for f in faces for i in range(len(f))}
    expect(len(seen) == len(edges), f"{title}: {len(seen)} edges are to be seen, the model has {len(edges)}")
    expect(near(total, volume(vertices, faces)), f"{title}: ezdxf's faces enclose {total}")


def check_fold(path, vertices, faces, title):
    fold = json.loads(path.read_text())
    closed = fold["file_frames"][0]
    expect(fold["file_spec"] == 1.1 and fold["frame_classes"] == ["creasePattern"], f"{title}: frames")
    expect(closed["frame_classes"] == ["foldedForm"] and closed["frame_inherit"] and closed["frame_parent"] == 0, f"{title}: frames")
    flat, space = np.array(fold["vertices_coords"]), np.array(closed["vertices_coords"])
    expect(flat.shape == (len(space), 2) and space.shape == (len(flat), 3), f"{title}: coordinates {flat.shape} {space.shape}")
    lists = {key: value for key, value in fold.items() if isinstance(value, list)}
    for kind in ["vertices", "edges", "faces"]:
        lengths = {len(value) for key, value in lists.items() if key.startswith(kind + "_")}
        expect(len(lengths) == 1, f"{title}: lists of {kind} of lengths {lengths}")
    expect([len(f) for f in fold["faces_vertices"]] == [len(f) for f in faces], f"{title}: sides of faces")
    size = np.ptp(vertices, axis=0).max()
    for mine, theirs in zip(fold["faces_vertices"], faces):
        expect(np.abs(space[mine] - vertices[theirs]).max() < 1e-9 * size, f"{title}: a face is not where the model has it")
    normals = []
    for face in fold["faces_vertices"]:
        p = space[face]
        n = sum(np.cross(p[i - 1] - p[0], p[i] - p[0]) for i in range(2, len(p)))
        normals.append(n / np.linalg.norm(n))
    for (a, b), sides, letter, angle in zip(
        fold["edges_vertices"], fold["edges_faces"], fold["edges_assignment"], fold["edges_foldAngle"]
    ):
        long, wide = np.linalg.norm(flat[a] - flat[b]), np.linalg.norm(space[a] - space[b])
        expect(abs(long - wide) < 1e-9 * size, f"{title}: edge {a} {b} is {long} and {wide} long")
        expect(letter in "BMVFU" and -180 <= angle <= 180, f"{title}: {letter} {angle}")
        expect(len(sides) == (1 if letter == "B" else 2), f"{title}: {letter} between {sides}")
        expect((angle < 0) == (letter == "M") and (angle > 0) == (letter == "V"), f"{title}: {letter} {angle}")
        if len(sides) == 2:
            left, right = normals[sides[0]], normals[sides[1]]
            turn = math.atan2(np.dot(np.cross(left, right), space[b] - space[a]) / wide, np.dot(left, right))
            expect(abs(math.degrees(turn) + angle) < 1e-6, f"{title}: {angle} degrees, measured {math.degrees(turn)}")


def check_plates(folder, title):
    panels = {p["id"]: p for p in json.loads((folder / "panels.json").read_text())["panels"]}
    data = (folder / "plates.glb").read_bytes()
    nodes = json.loads(data[20:20 + struct.unpack("<I", data[12:16])[0]])["nodes"]
    plates = [node for node in nodes if "mesh" in node]
    expect(len(plates) == len(panels), f"{title}: {len(plates)} plates")
    for node in plates:
        extras, panel = node["extras"], panels[node["name"]]
        for key in ["id", "face", "thickness", "area", "volume", "mass", "mitres", "side_lengths"]:
            expect(np.allclose(extras[key], panel[key], rtol=1e-12) if key != "id" else extras[key] == panel[key], f"{title} {node['name']}: {key} {extras[key]}")
    book = openpyxl.load_workbook(folder / "schedule.xlsx")
    listed = [row[0] for row in book.worksheets[0].iter_rows(values_only=True)]
    expect(set(panels) <= {str(cell) for cell in listed}, f"{title}: panels of the workbook {listed[:9]}")
    scene = trimesh.load(folder / "plates.obj", split_object=True, group_material=True, process=False)
    meshes = scene.geometry.values() if isinstance(scene, trimesh.Scene) else [scene]
    colours = {tuple(mesh.visual.material.diffuse) for mesh in meshes}
    groups = len({p["group"] for p in panels.values()})
    expect(len(colours) == min(groups, 12), f"{title}: {len(colours)} colours for {groups} groups")


def check_reading(kerfold, base):
    """Files of others."""
    box = trimesh.creation.box((0.3, 0.2, 0.1))
    ball = trimesh.creation.icosphere(subdivisions=2, radius=0.05)
    scene = trimesh.Scene()
    scene.add_geometry(box, node_name="chest", geom_name="chest")
    place = trimesh.transformations.translation_matrix([1, 0, 0]) @ trimesh.transformations.scale_matrix(2)
    scene.add_geometry(ball, node_name="globe", geom_name="globe", transform=place)
    path = base / "theirs.glb"
    scene.export(path)
    run(kerfold, "repair", path, "-o", base / "theirs-glb.obj")
    vertices, faces, groups = polygons(base / "theirs-glb.obj")
    wanted = 1e9 * (box.volume + 8 * ball.volume)
    expect(near(volume(vertices, faces), wanted, 1e-6), f"GLB of trimesh: volume {volume(vertices, faces)} instead of {wanted}")
    expect(set(groups) == {"chest", "globe"}, f"GLB of trimesh: groups {set(groups)}")
    # y up there is z up here.
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    expect(np.allclose(high - low, [1250, 200, 200], atol=1e-3), f"GLB of trimesh: size {high - low}")
    wrapper = lib3mf.get_wrapper() if hasattr(lib3mf, "get_wrapper") else lib3mf.Wrapper()
    model = wrapper.CreateModel()
    model.SetUnit(lib3mf.ModelUnit.Inch)
    mesh = model.AddMeshObject()
    mesh.SetName("chest")
    points = []
    for point in box.vertices:
        position = lib3mf.Position()
        for i in range(3):
            position.Coordinates[i] = point[i] * 10
        points.append(position)
    triangles = []
    for face in box.faces:
        triangle = lib3mf.Triangle()
        for i in range(3):
            triangle.Indices[i] = int(face[i])
        triangles.append(triangle)
    mesh.SetGeometry(points, triangles)
    model.AddBuildItem(mesh, wrapper.GetTranslationTransform(5, 0, 0))
    path = base / "theirs.3mf"
    model.QueryWriter("3mf").WriteToFile(str(path))
    run(kerfold, "repair", path, "-o", base / "theirs-3mf.obj")
    vertices, faces, groups = polygons(base / "theirs-3mf.obj")
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    expect(np.allclose(high - low, [76.2, 50.8, 25.4], rtol=1e-5) and near(low[0] + high[0], 2 * 5 * 25.4, 1e-5), f"3MF of lib3mf: {low} to {high}")
    expect(set(groups) == {"chest"}, f"3MF of lib3mf: groups {set(groups)}")


def main():
    kerfold = Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as temporary:
        base = Path(sys.argv[2] if len(sys.argv) > 2 else temporary)
        base.mkdir(parents=True, exist_ok=True)
        for name in SOLIDS:
            model = base / f"{name}.obj"
            run(kerfold, "solid", name, "--size", "150mm", "-o", model)
            vertices, faces, groups = polygons(model)
            if name in ["cube", "soccer-ball"]:
                groups = ["lower & \u00e4u\u00dfere" if i % 2 else None for i in range(len(faces))]
                lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
                for face, group in zip(faces, groups):
                    lines += [f"g {group or 'default'}", "f " + " ".join(str(c + 1) for c in face)]
                model.write_text("\n".join(lines) + "\n")
            for ending, check in [("3mf", check_3mf), ("dxf", check_dxf)]:
                path = base / f"{name}.{ending}"
                run(kerfold, "repair", model, "-o", path)
                check(path, vertices, faces, groups, f"{name} as {ending}")
            run(kerfold, "unfold", model, "--sheet", "600x400", "--animate", base / f"{name}.fold", "-o", base / f"{name}-flat")
            check_fold(base / f"{name}.fold", vertices, faces, f"{name} as FOLD")
            run(kerfold, "unfold", model, "--sheet", "600x400", "--animate", base / f"{name}.glb", "-o", base / f"{name}-flat")
            print(f"{name}: {'as it should be' if not faults else 'FAULTS'}")
        for name in ["soccer-ball", "cuboctahedron"]:
            run(kerfold, "solid", name, "--size", "150mm", "-o", base / f"{name}.obj")
            run(kerfold, "panels", base / f"{name}.obj", "--thickness", "3mm", "-o", base / f"{name}-plates")
            check_plates(base / f"{name}-plates", f"plates of {name}")
        check_reading(kerfold, base)
        print(f"plates and files of others: {'as it should be' if not faults else 'FAULTS'}")
    for fault in faults[:50]:
        print("fault:", fault)
    sys.exit(1 if faults else 0)


main()
