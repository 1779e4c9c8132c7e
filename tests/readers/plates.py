"""Reads what `kerfold panels` writes with programs that are not ours: OpenCASCADE for STEP, trimesh for OBJ, STL and GLB.

usage: plates.py KERFOLD [FOLDER]

Makes plates of every Platonic and Archimedean solid and of some models with fingers, holes and rims, and checks that
- STEP holds one solid for each panel, with its name, valid, and with the volume that panels.json says (to 1e-9);
- OBJ, STL and GLB hold closed bodies of that volume, named as the panels (round holes are polygons of 24 sides there);
- neighbours share no volume, whatever joins them.
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
    edges = json.loads((folder / "panels.json").read_text())["edges"]
    for a, b in {tuple(edge["panels"]) for edge in edges[:40]}:
        common = abs(trimesh.boolean.intersection([bodies[a], bodies[b]], engine="manifold").volume)
        expect(common < 1e-6 * bodies[a].volume, f"{title}: {a} and {b} share {common} mm3")


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
        for i, (name, options) in enumerate(cases + SPECIAL):
            model, folder = base / f"{name}.obj", base / f"{i:02}-{name}"
            subprocess.run([kerfold, "solid", name, "--size", "150mm", "-o", model, "--quiet"], check=True)
            subprocess.run([kerfold, "panels", model, "--thickness", "3mm", "-o", folder, "--quiet", *options], check=True)
            check(folder, f"{name} {' '.join(options)}")
            print(f"{name} {' '.join(options)}: {'as it should be' if not faults else 'FAULTS'}")
    for fault in faults[:50]:
        print("fault:", fault)
    sys.exit(1 if faults else 0)


main()
