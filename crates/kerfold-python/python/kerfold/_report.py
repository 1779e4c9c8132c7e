"""Reports of checks, and pictures."""

from __future__ import annotations

import base64
import html
import json
import os
import warnings
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Optional

from . import _native
from ._errors import KerfoldError, KerfoldWarning

if TYPE_CHECKING:
    from ._mesh import Mesh
    from ._types import Path


@dataclass(frozen=True)
class Finding:
    """Something that breaks a limit."""

    #: What was checked, such as ``"planarity"``.
    check: str
    #: Its code, such as ``"F101"``.
    code: str
    #: ``"face"``, ``"edge"``, ``"vertex"``, ``"rim"`` or ``"model"``.
    element: str
    #: Which one.
    id: int
    #: What was measured, in `unit`.
    measured: float
    #: What is allowed, in `unit`.
    limit: float
    #: The unit of both.
    unit: str
    #: The same in words.
    message: str


@dataclass(frozen=True)
class Report:
    """What `Mesh.check` measured."""

    #: ``"pass"`` or ``"fail"``.
    verdict: str
    #: What breaks a limit or a requirement.
    findings: list[Finding]
    #: Numbers of vertices, edges, faces, components, handles (``genus``) and rims.
    vertices: int
    edges: int
    faces: int
    components: int
    genus: int
    rims: int
    #: Largest distance of a corner from the plane of its face, in mm.
    planarity_mm: float
    #: How many vertices have how many edges.
    valences: dict[int, int]
    #: Whether it is convex.
    is_convex: bool
    #: The whole of report.json, as ``docs/formats.md`` describes it.
    data: dict[str, Any] = field(repr=False)
    _mesh: Any = field(repr=False, compare=False)
    _given: Any = field(repr=False, compare=False)

    @classmethod
    def _of(cls, mesh: Mesh, given: Optional[list[tuple[str, Any]]], command: str = "") -> Report:
        if given is not None:
            command = _command(mesh, given)
        data = json.loads(mesh._job.check(given, command))
        model = data["model"]
        findings = [
            Finding(**{key: told[key] for key in Finding.__dataclass_fields__})
            for told in data["findings"]
        ]
        report = cls(
            verdict=data["verdict"],
            findings=findings,
            vertices=model["vertices"],
            edges=model["edges"],
            faces=model["faces"],
            components=model["components"],
            genus=model["genus"],
            rims=model["rims"],
            planarity_mm=data["planarity"]["max_mm"],
            valences={int(k): n for k, n in data["valence"]["histogram"].items()},
            is_convex=data["convex"],
            data=data,
            _mesh=mesh,
            _given=given,
        )
        report._warn()
        return report

    def _warn(self) -> None:
        """One warning for each kind of finding."""
        kinds: dict[str, list[Finding]] = {}
        for finding in self.findings:
            kinds.setdefault(finding.code, []).append(finding)
        for code, found in kinds.items():
            more = f", and {len(found) - 1} more" if len(found) > 1 else ""
            warnings.warn(KerfoldWarning(found[0].message + more, code), stacklevel=6)

    @property
    def passes(self) -> bool:
        """Whether there is no finding."""
        return not self.findings

    def save(self, path: Path, *, all_rows: bool = False) -> None:
        """Writes it to a file, by its ending: .html (with pictures), .pdf (the same), .json, .csv.

        With `all_rows` every vertex and edge is listed, else the worst.
        """
        name = os.fspath(path)
        format = os.path.splitext(name)[1].lower().lstrip(".").replace("htm", "html", 1)
        format = "html" if format == "htmll" else format
        if format not in ("html", "pdf", "json", "csv"):
            raise KerfoldError(f"{name!r} names no report; it ends in .html, .pdf, .json or .csv")
        given = self._given or []
        tail = ["--report", name] + (["--rows", "all"] if all_rows else [])
        command = f"{_command(self._mesh, given)} {_native.shell_text(tail)}"
        source = os.path.basename(self._mesh._source)
        title = "model" if source == "-" else source
        made = self._mesh._job.report(self._given, format, all_rows, (title, command))
        _native.write_file(name, made)

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{f.code}</td><td>{html.escape(f.message)}</td></tr>"
            for f in self.findings[:20]
        )
        more = len(self.findings) - 20
        rest = f"<p>and {more} more</p>" if more > 0 else ""
        words = (
            f"<b>{self.verdict}</b>: {self.vertices} vertices, {self.edges} edges, "
            f"{self.faces} faces, genus {self.genus}, planar within {self.planarity_mm:.3g} mm"
        )
        return f"<p>{words}</p><table>{rows}</table>{rest}"


def _command(mesh: Mesh, given: list[tuple[str, Any]]) -> str:
    keys = [*mesh._options, *given]
    return _native.shell_line("check", None, keys, mesh._source, None)


class Picture:
    """A picture as PNG."""

    __slots__ = ("png",)

    #: The file, as bytes.
    png: bytes

    def __init__(self, png: bytes) -> None:
        self.png = png

    def save(self, path: Path) -> None:
        """Writes it to a .png file, whole or not at all."""
        name = os.fspath(path)
        if not name.lower().endswith(".png"):
            raise KerfoldError(f"{name!r} is no PNG; name it something.png")
        _native.write_file(name, self.png)

    def _repr_png_(self) -> bytes:
        return self.png

    def _repr_html_(self) -> str:
        return f'<img src="data:image/png;base64,{base64.b64encode(self.png).decode()}">'

    def __repr__(self) -> str:
        return f"<kerfold.Picture: {len(self.png)} bytes of PNG>"
