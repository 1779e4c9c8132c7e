"""The same job by shell, recipe and Python gives the same bytes."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Callable

import kerfold
from kerfold import Mesh

Shell = Callable[..., Path]


def files(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir()) if path.is_file()}


def model(folder: Path) -> None:
    Mesh.solid("soccer-ball", size="120mm").write(folder / "ball.obj")


def test_a_solid_and_a_cut(here: Path, shell: Shell) -> None:
    ball = Mesh.solid("soccer-ball", size="120mm")
    ball.write("ball.obj")
    Mesh.read("ball.obj").cut_edges("fold>30deg", offset=0.2, scope="local").write("cut.obj")
    shell("solid", "soccer-ball", "--size", "120mm", "-o", "ball.obj")
    theirs = shell(
        "cut",
        "edge",
        "ball.obj",
        "--select",
        "fold>30deg",
        "--offset",
        "0.2",
        "--scope",
        "local",
        "-o",
        "cut.obj",
    )
    for name in ("ball.obj", "cut.obj"):
        assert (here / name).read_bytes() == (theirs / name).read_bytes()


def test_sheets(here: Path, shell: Shell) -> None:
    model(here)
    net = Mesh.read("ball.obj").unfold(
        "one",
        sheet="600x400",
        kerf="0.15mm",
        format="svg,dxf,pdf",
        joint="flaps",
        assembly="pictures",
    )
    net.save("out")
    shell("solid", "soccer-ball", "--size", "120mm", "-o", "ball.obj")
    theirs = shell(
        "unfold",
        "ball.obj",
        "--pieces",
        "one",
        "--sheet",
        "600x400",
        "--kerf",
        "0.15mm",
        "--format",
        "svg,dxf,pdf",
        "--joint",
        "flaps",
        "--assembly",
        "pictures",
        "-o",
        "out",
    )
    ours = files(here / "out")
    assert ours == files(theirs / "out") and {"sheet-01.svg", "sheet-01.dxf"} <= set(ours)
    command = json.loads(ours["pieces.json"])["command"]
    assert command.startswith("kerfold unfold ball.obj --pieces one") and command.endswith("-o out")


def test_plates(here: Path, shell: Shell) -> None:
    model(here)
    Mesh.read("ball.obj").panels("in", thickness="4mm", gap="1mm").save("out")
    shell("solid", "soccer-ball", "--size", "120mm", "-o", "ball.obj")
    theirs = shell(
        "panels", "ball.obj", "--side", "in", "--thickness", "4mm", "--gap", "1mm", "-o", "out"
    )
    assert files(here / "out") == files(theirs / "out")


def test_a_d_form(here: Path, shell: Shell) -> None:
    kerfold.dform("dodecahedron", size="180mm", roll="max", strips=3).save("out")
    theirs = shell(
        "dform", "dodecahedron", "--size", "180mm", "--roll", "max", "--strips", "3", "-o", "out"
    )
    assert files(here / "out") == files(theirs / "out")


def test_reports(here: Path, shell: Shell) -> None:
    model(here)
    report = Mesh.read("ball.obj").check("exact", require="planar,closed")
    shell("solid", "soccer-ball", "--size", "120mm", "-o", "ball.obj")
    for name in ("r.json", "r.csv", "r.html", "r.pdf"):
        report.save(name)
        theirs = shell(
            "check",
            "ball.obj",
            "--profile",
            "exact",
            "--require",
            "planar,closed",
            "--report",
            name,
        )
        assert (here / name).read_bytes() == (theirs / name).read_bytes(), name


def test_a_recipe(here: Path, shell: Shell) -> None:
    text = (
        'name = "Column"\n[[step]]\nsolid = "cube"\nsize = "80mm"\n[[step]]\ncut = "edge"\n'
        'select = "along=z"\noffset = 0.25\nrepeat = 2\n[[step]]\ncheck = "exact"\n'
        '[[step]]\nunfold = "one"\nsheet = "600x400"\nkerf = "0.15mm"\n'
    )
    (here / "column.toml").write_text(text)
    (here / "shell" / "column.toml").write_text(text)
    kerfold.run("column.toml", "out", set={})
    theirs = files(shell("run", "column.toml", "-o", "out") / "out")
    assert files(here / "out") == theirs
    # The same chain as methods, but for the command that is told and the name that recipes have.
    net = Mesh.solid("cube", size="80mm").cut_edges("along=z", offset=0.25, repeat=2)
    ours = net.unfold("one", sheet="600x400", kerf="0.15mm", title="Column").files()
    told = json.loads(ours["pieces.json"])["command"].encode()
    assert (
        told == b"kerfold unfold - --pieces one --sheet 600x400 --kerf 0.15mm --title Column -o out"
    )
    for name in ("pieces.json", "layout.json", "sheet-01.svg", "sheet-01.png"):
        ran = theirs[name].replace(b"kerfold run column.toml -o out", told)
        assert ours[name] == ran, name
