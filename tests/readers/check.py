"""Judges the sheets of every recipe by the eyes of other programs. Usage: check.py KERFOLD OUT"""

import itertools
import json
import math
import os
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import ezdxf
import vpype
import vpype_cli
from ezdxf.audit import Auditor
from shapely import unary_union
from shapely.geometry import LineString, Polygon
from shapely.ops import polygonize
from svgpathtools import parse_path

SVG = "{http://www.w3.org/2000/svg}"
INKSCAPE = "{http://www.inkscape.org/namespaces/inkscape}"
LAYERS = ["engrave", "score", "cut-inner", "cut-outer", "info"]
DXF_LAYERS = {"engrave": "ENGRAVE", "score": "SCORE", "cut-inner": "CUT_INNER", "cut-outer": "CUT_OUTER", "info": "INFO"}
PX = 96 / 25.4
PT = 72 / 25.4
# Four decimals in the files.
ROUNDING = 1e-3

faults = []
counts = {}


def check(holds, reader, place, words):
    counts[reader] = counts.get(reader, 0) + 1
    if not holds:
        faults.append(f"{place}: {reader}: {words}")


def run(command, seconds=120, **more):
    environment = dict(os.environ, QT_QPA_PLATFORM="offscreen", **more)
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=seconds, env=environment)
    except subprocess.TimeoutExpired:
        return None, f"no answer after {seconds} s"
    return done.returncode, done.stdout + done.stderr


def make(kerfold, recipe, folder):
    """Runs a recipe with all formats asked for; the recipe's own text is not changed."""
    text = recipe.read_text()
    lines = [line for line in text.splitlines() if not re.match(r"format\s*=", line)]
    at = next(i for i, line in reversed(list(enumerate(lines))) if re.match(r"(unfold|dform)\s*=", line))
    lines.insert(at + 1, 'format = "svg,dxf,pdf,lbrn2"')
    copy = folder / "recipes" / recipe.name
    copy.write_text("\n".join(lines) + "\n")
    out = folder / recipe.stem
    code, said = run([kerfold, "run", str(copy), "-o", str(out)], 300)
    if code != 0:
        sys.exit(f"{recipe}: kerfold: {said}")
    spacing = re.search(r'^spacing\s*=\s*"?([0-9.]+)', text, re.M)
    return out, float(spacing.group(1)) if spacing else 3.0


def page_size(pdf):
    code, said = run(["pdfinfo", str(pdf)])
    found = re.search(r"Page size:\s+([0-9.]+) x ([0-9.]+) pts", said)
    return (float(found.group(1)), float(found.group(2))) if code == 0 and found else None


def same(a, b, tolerance):
    return a is not None and b is not None and all(abs(x - y) <= tolerance for x, y in zip(a, b))


def read_svg(path):
    """Size in mm, and for every layer the paths with id, class and data."""
    root = ElementTree.parse(path).getroot()
    size = tuple(float(root.get(side).removesuffix("mm")) for side in ("width", "height"))
    layers = {}
    for group in root.iter(SVG + "g"):
        if group.get(INKSCAPE + "groupmode") == "layer":
            layers[group.get(INKSCAPE + "label")] = [
                (p.get("id"), p.get("class"), parse_path(p.get("d"))) for p in group.iter(SVG + "path")
            ]
    return size, layers


def check_svg(path, spacing):
    size, layers = read_svg(path)
    code, said = run(["xmllint", "--noout", str(path)])
    check(code == 0, "xmllint", path, said)
    check(list(layers) == LAYERS, "layers", path, f"{list(layers)}")

    # Whole contours are closed, and what is cut of them does not come near its neighbours.
    parts, holes = {}, {}
    for layer in ("cut-inner", "cut-outer"):
        for name, kind, drawn in layers[layer]:
            if kind in ("outline", "hole"):
                check(drawn.isclosed() and len(drawn.continuous_subpaths()) == 1, "svgpathtools", path, f"{name} is open")
            ring = [(segment.start.real, segment.start.imag) for segment in drawn]
            if kind == "outline":
                parts[name] = ring
            elif kind == "hole":
                holes.setdefault(name.split("-hole-")[0], []).append(ring)
    shapes = {name: Polygon(ring, holes.get(name, [])) for name, ring in parts.items()}
    for name, shape in shapes.items():
        check(shape.is_valid and shape.area > 0, "shapely", path, f"{name} is no sound polygon")
        low_x, low_y, high_x, high_y = shape.bounds
        inside = min(low_x, low_y, size[0] - high_x, size[1] - high_y)
        check(inside >= 0, "shapely", path, f"{name} is off the sheet by {-inside}")
    for (a, first), (b, second) in itertools.combinations(shapes.items(), 2):
        check(first.intersection(second).area < 1e-6, "shapely", path, f"{a} and {b} overlap")
        apart = first.distance(second)
        check(apart >= spacing - ROUNDING, "shapely", path, f"{a} and {b} are {apart} mm apart, not {spacing}")

    check_inkscape(path, shapes)
    converted = path.with_suffix(".rsvg.pdf")
    code, said = run(["rsvg-convert", "-f", "pdf", "-o", str(converted), str(path)])
    check(code == 0, "rsvg-convert", path, said)
    check(same(page_size(converted), [side * PT for side in size], 0.02), "rsvg-convert", path, f"{page_size(converted)}")
    check_vpype(path, layers)
    return size, layers


def check_inkscape(path, shapes):
    code, said = run(["inkscape", "--query-all", str(path)], 180)
    check(code == 0, "inkscape", path, said)
    boxes = {}
    for line in said.splitlines():
        fields = line.split(",")
        if len(fields) == 5:
            boxes[fields[0]] = [float(value) for value in fields[1:]]
    for name, shape in shapes.items():
        low_x, low_y, high_x, high_y = (side * PX for side in shape.bounds)
        box = boxes.get(name)
        # With half the stroke around, which is 0.2 mm wide; sharp corners stand out a bit farther.
        half, stroke = 0.1 * PX, 0.2 * PX
        around = (low_x - half, low_y - half, high_x - low_x + stroke, high_y - low_y + stroke)
        check(
            same(box, around, 0.2 * PX),
            "inkscape",
            path,
            f"{name} is {box}",
        )


def check_vpype(path, layers):
    document = vpype_cli.execute(f'read --quantization 0.01mm --no-crop "{path}"')
    filled = [name for name in LAYERS if layers[name]]
    names = [document.layers[i].property(vpype.METADATA_FIELD_NAME) for i in sorted(document.layers)]
    check(names == filled, "vpype", path, f"layers are {names} instead of {filled}")
    for i, name in zip(sorted(document.layers), filled):
        ours = sum(drawn.length() for _, _, drawn in layers[name]) * PX
        theirs = document.layers[i].length()
        check(abs(ours - theirs) <= 1e-6 * ours, "vpype", path, f"{name} is {theirs} px long, not {ours}")
    single = vpype_cli.execute(f'read --quantization 0.01mm --no-crop "{path}" deduplicate --tolerance 0.005mm')
    before, after = document.length(), single.length()
    check(abs(before - after) <= 1e-9 * before, "vpype", path, f"deduplicate leaves {after} of {before} px")


def check_dxf(path, layers):
    drawing = ezdxf.readfile(path)
    auditor: Auditor = drawing.audit()
    check(not auditor.has_errors, "ezdxf", path, f"errors: {[e.message for e in auditor.errors]}")
    check(not auditor.has_fixes, "ezdxf", path, f"fixes: {[e.message for e in auditor.fixes]}")
    header = {name: drawing.header.get(name) for name in ("$ACADVER", "$INSUNITS", "$MEASUREMENT")}
    check(list(header.values()) == ["AC1015", 4, 1], "ezdxf", path, f"{header}")
    check(drawing.layers.get("SCORE").dxf.linetype == "DASHED", "ezdxf", path, "SCORE is not dashed")
    lengths = {}
    for entity in drawing.modelspace():
        check(entity.dxftype() == "LWPOLYLINE", "ezdxf", path, entity.dxftype())
        points = [(x, y) for x, y, *_ in entity.get_points()]
        if entity.closed:
            points.append(points[0])
        length = sum(((a - c) ** 2 + (b - d) ** 2) ** 0.5 for (a, b), (c, d) in itertools.pairwise(points))
        lengths[entity.dxf.layer] = lengths.get(entity.dxf.layer, 0) + length
    for layer, name in DXF_LAYERS.items():
        ours = sum(drawn.length() for _, _, drawn in layers[layer])
        check(abs(ours - lengths.get(name, 0)) <= 1e-6 * max(ours, 1), "ezdxf", path, f"{name} is {lengths.get(name)} mm long")

    # It writes beside its input, under the same name.
    folder = path.parent / "librecad"
    folder.mkdir(exist_ok=True)
    shutil.copy(path, folder)
    runtime = folder / "runtime"
    runtime.mkdir(mode=0o700, exist_ok=True)
    code, said = run(["librecad", "dxf2pdf", str(folder / path.name)], 60, XDG_RUNTIME_DIR=str(runtime))
    drawn = folder / path.with_suffix(".pdf").name
    check(code == 0 and drawn.exists() and page_size(drawn), "librecad", path, said)


def check_pdf(path, size):
    # pdfinfo shows about six digits.
    check(same(page_size(path), [side * PT for side in size], 0.01), "pdfinfo", path, f"{page_size(path)}")


def check_shared(kerfold, out):
    """Lines that two parts share are there once, and what they bound are the parts."""
    corners = [[(30 * math.cos(a), 30 * math.sin(a)) for a in (i * 2 * math.pi / n for i in range(n))] for n in (3, 4, 6)]
    parts = out / "shared.json"
    parts.write_text(json.dumps({"pieces": [{"outline": ring, "quantity": 8} for ring in corners]}))
    folder = out / "shared"
    code, said = run([kerfold, "nest", str(parts), "--common-line", "--format", "svg,dxf", "--tile", "a4", "-o", str(folder)])
    check(code == 0, "kerfold", folder, said)
    areas = []
    for sheet in sorted(folder.glob("sheet-??.svg")):
        size, layers = read_svg(sheet)
        check_vpype(sheet, layers)
        check_dxf(sheet.with_suffix(".dxf"), layers)
        tiles = page_size(sheet.with_name(f"{sheet.stem}-a4.pdf"))
        a4 = (210 * PT, 297 * PT)
        check(same(tiles, a4, 0.01) or same(tiles, a4[::-1], 0.01), "pdfinfo", sheet, f"tiles of {tiles}")
        lines = []
        for _, _, drawn in layers["cut-outer"]:
            lines += [LineString([(s.start.real, s.start.imag), (s.end.real, s.end.imag)]) for s in drawn]
        # Ends that lie on other lines are rounded to four decimals: on the grid they meet.
        united = unary_union(lines, grid_size=ROUNDING)
        drawn = sum(line.length for line in lines)
        check(abs(united.length - drawn) < ROUNDING * len(lines), "shapely", sheet, f"{drawn} mm drawn, {united.length} apart")
        areas += [cell.area for cell in polygonize(united)]
    whole = [Polygon(ring).area for ring in corners]
    for area in whole:
        found = sum(abs(cell - area) < 0.2 for cell in areas)
        check(found >= 8, "shapely", folder, f"{found} parts of {area} mm² instead of 8")


def main():
    kerfold, out = sys.argv[1], Path(sys.argv[2])
    shutil.rmtree(out, ignore_errors=True)
    (out / "recipes").mkdir(parents=True)
    (out / "meshes").symlink_to(Path("fixtures/meshes").resolve())
    recipes = sorted(Path("fixtures/recipes").glob("*.toml"))
    for recipe in recipes:
        if not re.search(r"^(unfold|dform)\s*=", recipe.read_text(), re.M):
            continue
        folder, spacing = make(kerfold, recipe, out)
        sheets = sorted(folder.glob("sheet-??.svg"))
        check(bool(sheets), "kerfold", folder, "no sheets")
        for sheet in sheets:
            size, layers = check_svg(sheet, spacing)
            check_dxf(sheet.with_suffix(".dxf"), layers)
            check_pdf(sheet.with_suffix(".pdf"), size)
            code, said = run(["xmllint", "--noout", str(sheet.with_suffix(".lbrn2"))])
            check(code == 0, "xmllint", sheet.with_suffix(".lbrn2"), said)
    check_shared(kerfold, out)
    print(", ".join(f"{reader} {count}" for reader, count in sorted(counts.items())))
    for fault in faults:
        print(fault)
    sys.exit(f"{len(faults)} faults" if faults else 0)


main()
