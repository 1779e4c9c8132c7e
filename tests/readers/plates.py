"""Reads what `kerfold panels` writes with programs that are not ours: OpenCASCADE for STEP, trimesh for OBJ, STL and GLB.

usage: plates.py KERFOLD [FOLDER]

Makes plates of every Platonic and Archimedean solid, of a concave block, of open façades over a dome and over a saddle (whose panels
are concave), and of some models with fingers, holes and rims, and checks that
- STEP holds one solid for each panel, with its name, valid, and with the volume that panels.json says (to 1e-9);
- OBJ, STL and GLB hold closed bodies of that volume, named as the panels (round holes are polygons of 24 sides there);
- no two plates share any volume, whatever joins them.
Exits with 1 and says what is wrong.
"""

import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import trimesh
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps
from OCP.IFSelect import IFSelect_RetDone
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_SOLID
from OCP.TopExp import TopExp_Explorer
from OCP.XCAFDoc import XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

try:
    from OCP.TDF import TDF_LabelSequence
except ImportError:  # OpenCASCADE 8
    from OCP.collections import Sequence_TDF_Label as TDF_LabelSequence

PLATONIC = ["tetrahedron", "cube", "octahedron", "dodecahedron", "icosahedron"]
ARCHIMEDEAN = [
    "truncated-tetrahedron", "cuboctahedron", "truncated-cube", "truncated-octahedron", "rhombicuboctahedron",
    "truncated-cuboctahedron", "snub-cube", "icosidodecahedron", "truncated-dodecahedron", "truncated-icosahedron",
    "rhombicosidodecahedron", "truncated-icosidodecahedron", "snub-dodecahedron",
]
SPECIAL = [
    ("cube", ["--edges", "stitch", "--hole-spacing", "25mm"]),
    ("cube", ["--edges", "finger", "--cutting", "square"]),
    ("dodecahedron", ["--edges", "finger", "--gap", "0"]),
    ("soccer-ball", ["--edges", "0-140:butt,140-180:stitch", "--hole-spacing", "10mm", "--hole-diameter", "2mm"]),
    ("truncated-octahedron", ["--gap", "1mm", "--side", "mid", "--corner-relief", "2mm"]),
    ("antiprism-5", ["--edges", "butt", "--side", "mid"]),
    ("cuboctahedron", ["--edges", "butt", "--gap", "4mm"]),
    ("prism-10", ["--edges", "30-140:finger,140-180:stitch", "--hole-spacing", "20mm"]),
]
# Models that are no named solids: what is open and what is concave.
BUILT = [
    ("block", ["--side", "in"]),
    ("block", ["--edges", "0-180:finger", "--cutting", "square"]),
    ("dome", ["--gap", "2mm", "--rim", "plumb"]),
    ("saddle", ["--gap", "2mm", "--rim", "bisected", "--side", "mid"]),
    ("saddle", ["--rim", "square", "--edges", "stitch", "--hole-spacing", "10mm", "--hole-diameter", "2mm"]),
    ("reflex", ["--rim", "square"]),
    ("reflex", ["--rim", "bisected", "--side", "mid"]),
]
# Sides of the polygon for a round hole, and its area over that of the circle.
ROUND = 24
POLYGON = ROUND / (2 * math.pi) * math.sin(2 * math.pi / ROUND)

faults = []


def expect(condition, text):
    if not condition:
        faults.append(text)


def step_solids(path):
    """Names with (valid, volume)."""
    document = TDocStd_Document(TCollection_ExtendedString("doc"))
    reader = STEPCAFControl_Reader()
    reader.SetNameMode(True)
    assert reader.ReadFile(str(path)) == IFSelect_RetDone, path
    assert reader.Transfer(document), path
    tool = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    labels = TDF_LabelSequence()
    tool.GetFreeShapes(labels)
    found = []
    for i in range(1, labels.Length() + 1):
        label = labels.Value(i)
        name = TDataStd_Name()
        text = ""
        if label.FindAttribute(TDataStd_Name.GetID_s(), name):
            text = name.Get().ToExtString()
        shape = XCAFDoc_ShapeTool.GetShape_s(label)
        explorer = TopExp_Explorer(shape, TopAbs_SOLID)
        solids = 0
        while explorer.More():
            solids += 1
            explorer.Next()
        properties = GProp_GProps()
        BRepGProp.VolumeProperties_s(shape, properties, 1e-12)
        found.append((text, solids, BRepCheck_Analyzer(shape).IsValid(), properties.Mass()))
    return found


def block():
    """A prism over an L: concave faces and a concave edge, three edges at every corner."""
    corners = [(0, 0), (120, 0), (120, 50), (60, 50), (60, 110), (0, 110)]
    n = len(corners)
    vertices = [(x, y, z) for z in (0, 70) for x, y in corners]
    sides = [[i, (i + 1) % n, n + (i + 1) % n, n + i] for i in range(n)]
    return vertices, [list(range(n))[::-1], list(range(n, 2 * n))] + sides


def reflex():
    """Two faces at an edge that ends in a reflex corner of the rim."""
    vertices = [(0, 0, 0), (0, -100, 0), (200, -100, 0), (200, 60, 0), (100, 0, 0), (100, 80, -40), (0, 80, -40)]
    return vertices, [[0, 1, 2, 3, 4], [0, 4, 5, 6]]


def facade(a, b, columns=5, rows=4, pitch=60.0):
    """Planar hexagons in planes that touch z = -(x²/a + y²/b)/2 at the points of a lattice."""
    def site(i, j):
        return np.array([(i + (j % 2) / 2 - columns / 2) * pitch, (j - rows / 2) * pitch * math.sqrt(3) / 2])

    numbers, vertices, faces = {}, [], []

    def corner(sites):
        key = tuple(sorted(sites))
        if key not in numbers:
            planes = [(x / a, y / b, 1.0, (x * x / a + y * y / b) / 2) for x, y in (site(*s) for s in key)]
            numbers[key] = len(vertices)
            vertices.append(np.linalg.solve([p[:3] for p in planes], [p[3] for p in planes]))
        return numbers[key]

    for j in range(rows):
        for i in range(columns):
            s = j % 2
            around = [(i + 1, j), (i + s, j + 1), (i + s - 1, j + 1), (i - 1, j), (i + s - 1, j - 1), (i + s, j - 1)]
            faces.append([corner([(i, j), around[k], around[(k + 1) % 6]]) for k in range(6)])
    return vertices, faces


def write_obj(path, vertices, faces):
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in ([float(c) for c in v] for v in vertices)]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in faces]
    path.write_text("\n".join(lines) + "\n")


def near(a, b, part):
    return abs(a - b) <= part * max(abs(a), abs(b))


def check(folder, title):
    panels = json.loads((folder / "panels.json").read_text())["panels"]
    want = {p["id"]: p for p in panels}
    solids = step_solids(folder / "plates.step")
    expect(sorted(s[0] for s in solids) == sorted(want), f"{title}: STEP names {[s[0] for s in solids][:5]}")
    for name, count, valid, volume in solids:
        expect(count == 1, f"{title} {name}: {count} solids")
        expect(valid, f"{title} {name}: not valid in OpenCASCADE")
        expect(name in want and near(volume, want[name]["volume"], 1e-9), f"{title} {name}: STEP volume {volume}")

    def polygonal(p):
        bores = sum(math.pi * h["diameter"] ** 2 / 4 for h in p["holes"]) * p["thickness"]
        return p["volume"] + bores * (1 - POLYGON)

    scene = trimesh.load(folder / "plates.obj", split_object=False, group_material=False, process=False)
    text = (folder / "plates.obj").read_text()
    expect(sum(line.startswith("g ") for line in text.splitlines()) == len(panels), f"{title}: OBJ groups")
    total = sum(polygonal(p) for p in panels)
    for ending, part in [("obj", 1e-9), ("stl", 1e-4)]:
        body = trimesh.load(folder / f"plates.{ending}", process=False, force="mesh")
        body.merge_vertices() if ending == "stl" else None
        expect(near(body.volume, total, part), f"{title}: {ending} volume {body.volume} instead of {total}")
    del scene
    glb = trimesh.load(folder / "plates.glb", process=False)
    seen = 0
    for node in glb.graph.nodes_geometry:
        transform, geometry = glb.graph[node]
        body = glb.geometry[geometry]
        if not isinstance(body, trimesh.Trimesh):
            continue
        seen += 1
        name = next((n for n in want if str(node) == n or str(node).startswith(n + "_") or geometry == n or geometry.startswith(n + "_")), None)
        expect(name is not None, f"{title}: GLB node {node} {geometry}")
        if name:
            body = trimesh.Trimesh(body.vertices, body.faces, process=False)
            body.merge_vertices(digits_vertex=5)
            expect(body.is_watertight, f"{title} {name}: GLB not closed")
            expect(near(body.volume, polygonal(want[name]), 1e-4), f"{title} {name}: GLB volume {body.volume}")
    expect(seen == len(panels), f"{title}: {seen} bodies in the GLB")
    bodies = {}
    for name, vertices, polygons in obj_groups(text):
        body = trimesh.Trimesh(vertices, [t for p in polygons for t in fan(p)], process=False)
        expect(body.is_watertight and body.is_winding_consistent, f"{title} {name}: OBJ not closed")
        expect(near(body.volume, polygonal(want[name]), 1e-9), f"{title} {name}: OBJ volume {body.volume}")
        bodies[name] = body
    for a, b in near_pairs(bodies):
        common = abs(trimesh.boolean.intersection([bodies[a], bodies[b]], engine="manifold").volume)
        least = min(bodies[a].volume, bodies[b].volume)
        expect(common < 1e-6 * least, f"{title}: {a} and {b} share {common} mm3")


def near_pairs(bodies):
    """All pairs of bodies whose boxes meet."""
    names = sorted(bodies)
    for i, a in enumerate(names):
        for b in names[i + 1:]:
            (low, high), (bottom, top) = bodies[a].bounds, bodies[b].bounds
            if (low <= top).all() and (bottom <= high).all():
                yield a, b


def obj_groups(text):
    """Every group with its own vertices and polygons."""
    groups, first = [], 0
    count = 0
    for line in text.splitlines():
        words = line.split()
        if line.startswith("g "):
            groups.append((words[1], [], []))
            first = count
        elif line.startswith("v "):
            groups[-1][1].append([float(w) for w in words[1:]])
            count += 1
        elif line.startswith("f "):
            groups[-1][2].append([int(w) - 1 - first for w in words[1:]])
    return [(name, np.array(vertices), polygons) for name, vertices, polygons in groups]


def fan(polygon):
    return [[polygon[0], polygon[i], polygon[i + 1]] for i in range(1, len(polygon) - 1)]


def main():
    kerfold = Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as temporary:
        base = Path(sys.argv[2] if len(sys.argv) > 2 else temporary)
        base.mkdir(parents=True, exist_ok=True)
        cases = [(name, ["--side", side]) for i, name in enumerate(PLATONIC + ARCHIMEDEAN) for side in [["out", "in", "mid"][i % 3]]]
        built = {"block": block(), "reflex": reflex(), "dome": facade(600, 500), "saddle": facade(600, -500)}
        for i, (name, options) in enumerate(cases + SPECIAL + BUILT):
            model, folder = base / f"{name}.obj", base / f"{i:02}-{name}"
            if name in built:
                write_obj(model, *built[name])
            else:
                subprocess.run([kerfold, "solid", name, "--size", "150mm", "-o", model, "--quiet"], check=True)
            subprocess.run([kerfold, "panels", model, "--thickness", "3mm", "-o", folder, "--quiet", *options], check=True)
            check(folder, f"{name} {' '.join(options)}")
            print(f"{name} {' '.join(options)}: {'as it should be' if not faults else 'FAULTS'}")
    for fault in faults[:50]:
        print("fault:", fault)
    sys.exit(1 if faults else 0)


main()
