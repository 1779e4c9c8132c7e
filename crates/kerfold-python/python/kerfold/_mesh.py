"""Meshes."""

from __future__ import annotations

import base64
import html
import os
import warnings
from typing import (
    TYPE_CHECKING,
    Any,
    Iterator,
    Literal,
    Mapping,
    Optional,
    Sequence,
    Union,
    overload,
)

from . import _native
from ._errors import KerfoldError, KerfoldWarning
from ._schema import STEPS, Step
from ._steps import Steps

if TYPE_CHECKING:
    from ._types import ArrayLike, Floats, Ints, Path


class Faces(Sequence["Ints"]):
    """The faces of a mesh: each the numbers of its vertices, counter-clockwise from outside.

    ``faces[i]`` is the i-th face, (k,) int64; nothing is copied. All corners in a row are
    `corners`; face i has those from ``offsets[i]`` to ``offsets[i + 1]``. Where all faces have the
    same number of sides ``numpy.asarray(faces)`` is their (m, k) array.
    """

    __slots__ = ("corners", "offsets")

    #: All corners in a row, (c,) int64.
    corners: Ints
    #: Where each face begins in `corners`, and where the last one ends, (m + 1,) int64.
    offsets: Ints

    def __init__(self, corners: Ints, offsets: Ints) -> None:
        for array in (corners, offsets):
            array.flags.writeable = False
        self.corners = corners
        self.offsets = offsets

    def __len__(self) -> int:
        return len(self.offsets) - 1

    @overload
    def __getitem__(self, index: int) -> Ints: ...
    @overload
    def __getitem__(self, index: slice) -> list[Ints]: ...
    def __getitem__(self, index: Union[int, slice]) -> Union[Ints, list[Ints]]:
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        count = len(self)
        if not -count <= index < count:
            raise IndexError(f"there is no face {index}; there are {count}")
        index %= count
        return self.corners[self.offsets[index] : self.offsets[index + 1]]

    def __iter__(self) -> Iterator[Ints]:
        bounds = self.offsets.tolist()
        for start, end in zip(bounds, bounds[1:]):
            yield self.corners[start:end]

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> Any:
        import numpy as np

        sides = self.sides
        if sides is None:
            raise KerfoldError(
                "the faces have different numbers of sides, so they are no single array; take "
                "`corners` and `offsets`, or `Mesh.triangles`"
            )
        table = self.corners.reshape(-1, sides)
        if dtype is not None and table.dtype != dtype:
            return table.astype(dtype)
        return np.array(table) if copy else table

    @property
    def sides(self) -> Optional[int]:
        """The number of sides of every face, or None where they differ."""
        count = len(self)
        if count == 0:
            return None
        sides = int(self.offsets[1])
        import numpy as np

        is_even = self.offsets[-1] == sides * count and bool(np.all(np.diff(self.offsets) == sides))
        return sides if is_even else None

    def tolist(self) -> list[list[int]]:
        """The faces as lists."""
        corners, bounds = self.corners.tolist(), self.offsets.tolist()
        return [corners[start:end] for start, end in zip(bounds, bounds[1:])]

    def __repr__(self) -> str:
        return f"<{len(self)} faces, {len(self.corners)} corners>"


def _faces_of(faces: Any) -> tuple[Any, Optional[Any]]:
    """Faces as the native half takes them: a table, or corners and offsets."""
    import numpy as np

    if isinstance(faces, Faces):
        return faces.corners, faces.offsets
    if (
        isinstance(faces, tuple)
        and len(faces) == 2
        and all(isinstance(part, np.ndarray) and part.ndim == 1 for part in faces)
    ):
        return faces[0], np.ascontiguousarray(faces[1], dtype=np.int64)
    if isinstance(faces, np.ndarray) and faces.ndim == 2 and faces.dtype.kind in "iu":
        is_usual = faces.dtype.isnative and faces.dtype.itemsize >= 4
        return (faces if is_usual else faces.astype(np.int64)), None
    rows = [list(face) for face in faces]
    offsets = np.zeros(len(rows) + 1, dtype=np.int64)
    np.cumsum([len(face) for face in rows], out=offsets[1:])
    corners = np.fromiter((v for face in rows for v in face), np.int64, int(offsets[-1]))
    return corners, offsets


class Mesh(Steps):
    """A surface of planar or other polygons, in millimetres. Nothing of it changes.

    Every operator is a method that returns a new mesh: ``m.cut_edges("along=z", offset=0.3)``. A
    selection is a text in the selection language (``"fold>30deg"``), ids, or a mask. What the last
    operator made is selected by ``"made"`` and ``"strip"``.

    Parameters
    ----------
    vertices : (n, 3) array of float
        Positions in mm; read once, not kept.
    faces : (m, k) array of int, list of lists, `Faces`, or a pair of corners and offsets
        Numbers of vertices, counter-clockwise seen from outside.
    groups : mapping of names to arrays of face numbers, optional
        Groups of faces, as in OBJ files.
    mend : bool, default False
        Weld, orient and mend faces that are no surface, as `repair` does; `notes` say what was
        done.
    """

    __slots__ = ("_faces", "_job", "_made_by", "_options", "_source", "_vertices", "__weakref__")

    _job: _native.Job
    #: The file that it was read from, as it was typed; `-` for all others.
    _source: str
    #: How that file was read.
    _options: list[tuple[str, Any]]
    #: The step that made it, with what was given, and the file and options it began with.
    _made_by: Optional[tuple[Step, list[tuple[str, Any]], Optional[str], list[tuple[str, Any]]]]

    def __init__(
        self,
        vertices: ArrayLike,
        faces: Any,
        groups: Optional[Mapping[str, ArrayLike]] = None,
        *,
        mend: bool = False,
    ) -> None:
        import numpy as np

        places = np.asarray(vertices, dtype=np.float64)
        if places.ndim != 2:
            raise KerfoldError(f"vertices have {places.ndim} dimensions; they are n × 3, in mm")
        named = [
            (str(name), np.ascontiguousarray(ids, dtype=np.int64).reshape(-1))
            for name, ids in (groups or {}).items()
        ]
        if mend:
            job = _native.Job.mended(places, [[int(v) for v in face] for face in faces], named)
        else:
            table, offsets = _faces_of(faces)
            job = _native.Job.of_arrays(places, table, offsets, named)
        self._take(job)

    def _take(
        self,
        job: _native.Job,
        source: str = "-",
        options: Optional[list[tuple[str, Any]]] = None,
    ) -> None:
        self._job = job
        self._source = source
        self._options = options or []
        self._made_by = None
        self._vertices: Optional[Floats] = None
        self._faces: Optional[Faces] = None

    @classmethod
    def _of(cls, job: _native.Job) -> Mesh:
        mesh = cls.__new__(cls)
        mesh._take(job)
        return mesh

    @classmethod
    def _begin(cls, step: Step, given: list[tuple[str, Any]]) -> Mesh:
        mesh = cls._of(_native.Job().step(step.verb, step.kind, given, None))
        mesh._made_by = (step, given, None, [])
        if step.name == "read":
            values = dict(given)
            mesh._source = str(values.pop("path"))
            mesh._options = list(values.items())
            mesh._made_by = None
        return mesh

    def _carry_out(self, step: Step, given: list[tuple[str, Any]]) -> Any:
        from ._made import Made
        from ._net import Net
        from ._panels import Panels
        from ._report import Picture, Report

        if step.name == "check":
            return Report._of(self, given)
        if step.name == "render":
            return Picture(self._job.render(given))
        if step.group != "make":
            made = Mesh._of(self._job.step(step.verb, step.kind, given, None))
            made._made_by = (step, given, self._source, self._options)
            warn(made._job)
            return made
        job = self._job.step(step.verb, step.kind, given, self._title)
        warn(job)
        if step.name == "unfold":
            return Net(job, self, given)
        if step.name == "panels":
            return Panels(job, self, given)
        return Made(job, Command(step, given, self._source, self._options))

    @property
    def _title(self) -> Optional[str]:
        """The name of the project on sheets: that of the file."""
        if self._source == "-":
            return None
        return os.path.splitext(os.path.basename(self._source))[0]

    @property
    def vertices(self) -> Floats:
        """Positions, (n, 3) float64, in mm. Not to be written to."""
        if self._vertices is None:
            self._vertices = self._job.vertices()
            self._vertices.flags.writeable = False
        return self._vertices

    @property
    def faces(self) -> Faces:
        """The faces, each the numbers of its vertices, counter-clockwise from outside."""
        if self._faces is None:
            self._faces = Faces(*self._job.corners())
        return self._faces

    @property
    def edges(self) -> Ints:
        """The two vertices of every edge, (e, 2) int64; row i is the edge with the id i."""
        return self._job.edges()

    @property
    def triangles(self) -> tuple[Ints, Ints]:
        """The faces cut into triangles: vertices, (t, 3) int64, and the face of each, (t,) int64."""
        return self._job.triangles()

    @property
    def groups(self) -> dict[str, Ints]:
        """The faces of each group by its name, (k,) int64."""
        return dict(self._job.groups())

    @property
    def bounds(self) -> Floats:
        """The lowest and the highest corner of the box around it, (2, 3) float64, in mm."""
        import numpy as np

        return np.array(self._job.bounds or ((0.0,) * 3, (0.0,) * 3))

    @property
    def notes(self) -> list[str]:
        """What there is to know of the last step, in words."""
        return self._job.notes

    @property
    def is_closed(self) -> bool:
        """Whether it has no rim."""
        return self._job.counts[3] == 0

    def find(
        self,
        selection: Any,
        elements: Literal["vertices", "edges", "faces"] = "faces",
    ) -> Ints:
        """The ids of the elements that a selection finds, (k,) int64, ascending."""
        if elements not in ("vertices", "edges", "faces"):
            raise KerfoldError(f"{elements!r} are no elements; take vertices, edges or faces")
        return self._job.find(str(selection), elements)

    def write(self, path: Path) -> None:
        """Writes it to a file, whole or not at all: OBJ, PLY, STL, OFF, 3MF or DXF, by its ending.

        OBJ keeps every digit, groups, and what the last step made.
        """
        name = os.fspath(path)
        command = None
        if self._made_by is not None:
            step, given, source, options = self._made_by
            command = Command(step, given, source, options).line(name)
        _native.write_file(name, self._job.model(name, command))

    def __repr__(self) -> str:
        vertices, edges, faces, _ = self._job.counts
        return f"<kerfold.Mesh: {vertices} vertices, {edges} edges, {faces} faces>"

    def __reduce__(self) -> Any:
        """Copies and other processes get positions, faces and groups."""
        faces = (self.faces.corners, self.faces.offsets)
        return (Mesh, (self.vertices, faces, self.groups))

    def _repr_html_(self) -> str:
        """The picture that notebooks show."""
        vertices, edges, faces, rims = self._job.counts
        low, high = self.bounds
        size = " × ".join(f"{x:.6g}" for x in high - low)
        rim = f", {rims} rims" if rims else ""
        picture = base64.b64encode(self._job.render([("width", 480)])).decode()
        words = html.escape(f"{vertices} vertices, {edges} edges, {faces} faces{rim}; {size} mm")
        return (
            f'<figure style="margin:0;max-width:480px"><img alt="{words}" '
            f'src="data:image/png;base64,{picture}"><figcaption>{words}</figcaption></figure>'
        )


class Command:
    """What was done, as one would type it in a shell."""

    __slots__ = ("given", "options", "source", "step")

    def __init__(
        self,
        step: Step,
        given: list[tuple[str, Any]],
        source: Optional[str],
        options: Sequence[tuple[str, Any]] = (),
    ) -> None:
        self.step = step
        self.given = given
        self.source = source
        self.options = list(options)

    def line(self, output: Optional[str] = None) -> str:
        """The command line that writes to a file or folder."""
        given = [*self.options, *self.given]
        return _native.shell_line(self.step.verb, self.step.kind, given, self.source, output)

    def joined(self, given: list[tuple[str, Any]]) -> Command:
        """The same with other values for some keys."""
        keys = {key for key, _ in given}
        old = [pair for pair in self.given if pair[0] not in keys]
        return Command(self.step, old + given, self.source, self.options)


def step_of(name: str) -> Step:
    """The step of a name."""
    return STEPS[name]


def warn(job: _native.Job) -> None:
    """Warns of what breaks a limit."""
    for code, text in job.findings():
        warnings.warn(KerfoldWarning(text, code), stacklevel=5)
