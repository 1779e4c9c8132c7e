"""Nets and sheets."""

from __future__ import annotations

import base64
import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Optional

from . import _native
from ._errors import KerfoldError
from ._mesh import Command, Faces, Mesh, step_of, warn

if TYPE_CHECKING:
    from ._types import Floats, Ints, Path


@dataclass(frozen=True, eq=False)
class Piece:
    """A connected flat part, in a frame of its own: mm, y up, seen from outside the model."""

    #: Its name, such as ``"P01"``.
    id: str
    #: The boundary, (k, 2) float64, counter-clockwise, without joints and kerf.
    outline: Floats
    #: Boundaries of holes, each (k, 2) float64, clockwise.
    holes: list[Floats]
    #: The faces of the mesh, (f,) int64.
    faces: Ints
    #: The corners of these faces as vertices of the mesh.
    polygons: Faces
    #: Where these corners lie, (c, 2) float64, in the order of ``polygons.corners``.
    points: Floats

    def _repr_svg_(self) -> str:
        return _piece_svg([self])


@dataclass(frozen=True, eq=False)
class Folds:
    """The edges that stay together, ascending by edge; n of them."""

    #: The edges of the mesh, (n,) int64.
    edges: Ints
    #: Their two vertices, (n, 2) int64.
    vertices: Ints
    #: The piece of each by its place in `Net.pieces`, (n,) int64.
    pieces: Ints
    #: The faces on both sides, (n, 2) int64.
    faces: Ints
    #: Where they lie in the piece, (n, 2, 2) float64, mm, from the first vertex to the second.
    segments: Floats
    #: 180° less the dihedral angle, (n,) float64, degrees; positive folds are mountains.
    angles: Floats

    def __len__(self) -> int:
        return len(self.edges)


@dataclass(frozen=True, eq=False)
class Seams:
    """The edges that were opened, ascending by edge; n of them, each with two sides."""

    #: The edges of the mesh, (n,) int64.
    edges: Ints
    #: Their two vertices, (n, 2) int64.
    vertices: Ints
    #: The pieces of both sides by their places in `Net.pieces`, (n, 2) int64.
    pieces: Ints
    #: The faces of both sides, (n, 2) int64.
    faces: Ints
    #: Where both sides lie, (n, 2, 2, 2) float64, mm: seam, side, end, x and y.
    segments: Floats
    #: 180° less the dihedral angle, (n,) float64, degrees.
    angles: Floats
    #: Lengths on the mesh, (n,) float64, mm.
    lengths: Floats

    def __len__(self) -> int:
        return len(self.edges)


@dataclass(frozen=True, eq=False)
class Rims:
    """The edges with a face on one side only; n of them."""

    #: Their two vertices, (n, 2) int64.
    vertices: Ints
    #: The piece of each by its place in `Net.pieces`, (n,) int64.
    pieces: Ints
    #: The face of each, (n,) int64.
    faces: Ints
    #: Where they lie in the piece, (n, 2, 2) float64, mm.
    segments: Floats

    def __len__(self) -> int:
        return len(self.vertices)


@dataclass(frozen=True)
class Proof:
    """What code that did not unfold found when it measured the net against the mesh."""

    #: Largest difference of a distance on the mesh and in the net, mm.
    congruence_mm: float
    #: Largest distance of a corner from its vertex once the net is folded back up, mm.
    refold_mm: float
    #: Pairs of faces of one piece that overlap.
    overlaps: int


@dataclass(frozen=True)
class Placed:
    """Where a piece lies on a sheet: turned by `rotation` degrees, then moved by (`x`, `y`) mm."""

    piece: str
    x: float
    y: float
    rotation: float


class Sheet:
    """A sheet to cut, in millimetres, with its origin at the bottom left."""

    __slots__ = ("_command", "_job", "_number", "height", "id", "placed", "width")

    #: Its name, such as ``"S01"``.
    id: str
    #: Along x and y, mm.
    width: float
    height: float
    #: The pieces on it.
    placed: list[Placed]

    def __init__(self, job: _native.Job, number: int, told: Any, command: Command) -> None:
        self._job = job
        self._number = number
        self._command = command
        self.id, self.width, self.height, placed = told
        self.placed = [Placed(*piece) for piece in placed]

    def _file(self, format: str, output: Optional[str] = None) -> bytes:
        return self._job.sheet_file(self._number, format, self._command.line(output))

    @property
    def svg(self) -> str:
        """The sheet as SVG, in layers, at true size."""
        return self._file("svg").decode()

    @property
    def dxf(self) -> str:
        """The sheet as DXF R2000, in layers, mm."""
        return self._file("dxf").decode()

    @property
    def pdf(self) -> bytes:
        """The sheet as PDF, one page at true size."""
        return self._file("pdf")

    @property
    def lbrn2(self) -> str:
        """The sheet as a LightBurn project."""
        return self._file("lbrn2").decode()

    @property
    def png(self) -> bytes:
        """A picture of the sheet, 1200 pixels wide."""
        return self._job.sheet_png(self._number, 1200)

    def save(self, path: Path) -> None:
        """Writes it to a file, whole or not at all, by its ending: svg, dxf, pdf, lbrn2 or png."""
        name = os.fspath(path)
        format = os.path.splitext(name)[1].lower().lstrip(".")
        if format not in ("svg", "dxf", "pdf", "lbrn2", "png"):
            raise KerfoldError(f"{name!r} is no sheet; it ends in .svg, .dxf, .pdf, .lbrn2 or .png")
        made = self.png if format == "png" else self._file(format)
        _native.write_file(name, made)

    def _repr_svg_(self) -> str:
        return self.svg

    def __repr__(self) -> str:
        pieces = len(self.placed)
        return f"<kerfold.Sheet {self.id}: {self.width:g} × {self.height:g} mm, {pieces} pieces>"


@dataclass(frozen=True)
class Layout:
    """How well the sheets are used."""

    #: Area of the pieces over that of the sheets, 0 to 1.
    density: float
    #: Length of all cuts, mm.
    cut_length: float
    #: Length of all score lines, mm.
    score_length: float
    #: Time on the machine in seconds; None where the material does not say how fast it is cut.
    seconds: Optional[float]


def sheets_of(job: _native.Job, command: Command) -> list[Sheet]:
    """The sheets of a job."""
    return [Sheet(job, i, told, command) for i, told in enumerate(job.sheet_list())]


class Net:
    """Flat pieces of a mesh that never overlap, with their proof, on sheets."""

    __slots__ = ("_command", "_job", "_told", "mesh")

    #: The mesh that was unfolded; None for pieces that were only nested.
    mesh: Optional[Mesh]

    def __init__(
        self,
        job: _native.Job,
        mesh: Optional[Mesh],
        given: list[tuple[str, Any]],
        command: Optional[Command] = None,
    ) -> None:
        self._job = job
        self.mesh = mesh
        if command is None:
            source = "-" if mesh is None else mesh._source
            options = [] if mesh is None else mesh._options
            command = Command(step_of("unfold"), given, source, options)
        self._command = command
        self._told: Optional[dict[str, Any]] = None

    def _tell(self) -> dict[str, Any]:
        if self._told is None:
            self._told = self._job.net()
        return self._told

    @property
    def pieces(self) -> list[Piece]:
        """The connected flat parts, the largest first."""
        return [
            Piece(
                id=told["id"],
                outline=told["outline"],
                holes=told["holes"],
                faces=told["faces"],
                polygons=Faces(told["corners"], told["offsets"]),
                points=told["points"],
            )
            for told in self._tell()["pieces"]
        ]

    @property
    def folds(self) -> Folds:
        """The edges that stay together."""
        return Folds(**self._tell()["folds"])

    @property
    def seams(self) -> Seams:
        """The edges that were opened."""
        return Seams(**self._tell()["seams"])

    @property
    def rims(self) -> Rims:
        """The edges that have a face on one side only."""
        return Rims(**self._tell()["rims"])

    @property
    def proof(self) -> Proof:
        """What measuring it against the mesh found."""
        return Proof(*self._tell()["proof"])

    @property
    def layout(self) -> Optional[Layout]:
        """How well its sheets are used; None without sheets."""
        facts = self._job.layout_facts()
        return None if facts is None else Layout(*facts)

    @property
    def notes(self) -> list[str]:
        """What there is to know, in words."""
        return self._job.notes

    def sheets(self, **keys: Any) -> list[Sheet]:
        """The sheets, as `Mesh.unfold` has laid them out, or with other keys of sheets.

        With keys the same pieces are laid out again; none is divided, so give ``sheet=`` to
        `Mesh.unfold` where they have to be.

        Parameters
        ----------
        **keys
            Keys of sheets as `Mesh.unfold` takes them: ``sheet``, ``kerf``, ``margin``, …
        """
        if not keys:
            return sheets_of(self._job, self._command)
        return self.on(**keys).sheets()

    def on(self, **keys: Any) -> Net:
        """The same pieces on other sheets; keys are those of `sheets`."""
        if self.mesh is None:
            raise KerfoldError(
                "pieces that were nested are laid out by `kerfold.nest`; give it the keys of sheets"
            )
        given = step_of("unfold").bind((), keys)
        command = self._command.joined(given)
        job = self._job.laid_out(command.given, self.mesh._title or "")
        warn(job)
        return Net(job, self.mesh, command.given, command)

    def files(self, folder: str = "out") -> dict[str, bytes]:
        """The files of `save` by their names; `folder` is what they say they were written to."""
        return dict(self._job.files(self._command.line(folder)))

    def save(self, folder: Path, *, clean: bool = False) -> list[str]:
        """Writes pieces.json, layout.json and the sheets as ``kerfold unfold -o`` does: all or none.

        Returns the paths. With `clean` files of an earlier run that are no part of this one go.
        """
        return save(self.files(os.fspath(folder)), folder, clean)

    def _repr_html_(self) -> str:
        words = (
            f"{len(self.pieces)} pieces, {len(self.folds)} folds, {len(self.seams)} seams; "
            f"faces true to {self.proof.congruence_mm:.1e} mm, {self.proof.overlaps} overlaps"
        )
        sheets = self.sheets()
        shown = "".join(_image(sheet) for sheet in sheets[:4])
        rest = f"<p>and {len(sheets) - 4} more sheets</p>" if len(sheets) > 4 else ""
        return f"<p>{words}</p>{shown or _piece_svg(self.pieces)}{rest}"

    def __repr__(self) -> str:
        return f"<kerfold.Net: {len(self.pieces)} pieces, {len(self._job.sheet_list())} sheets>"


def _image(sheet: Sheet) -> str:
    data = base64.b64encode(sheet.png).decode()
    return f'<img style="max-width:480px" alt="{sheet.id}" src="data:image/png;base64,{data}">'


def _piece_svg(pieces: list[Piece]) -> str:
    """Outlines beside one another."""
    left, top, body = 0.0, 0.0, ""
    for piece in pieces:
        low, high = piece.outline.min(axis=0), piece.outline.max(axis=0)
        for line in [piece.outline, *piece.holes]:
            points = " ".join(f"{left + x - low[0]:.3f},{high[1] - y:.3f}" for x, y in line)
            body += f'<polygon points="{points}"/>'
        left += 1.05 * float(high[0] - low[0])
        top = max(top, float(high[1] - low[1]))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="480" viewBox="0 0 {left:.3f} {top:.3f}" '
        f'fill="none" stroke="black" stroke-width="1">'
        f'<g vector-effect="non-scaling-stroke">{body}</g></svg>'
    )


def save(files: dict[str, bytes], folder: Path, clean: bool) -> list[str]:
    """Writes files into a folder and warns of nothing; returns their paths."""
    written, _ = _native.write_folder(os.fspath(folder), list(files.items()), clean)
    return [os.fspath(path) for path in written]
