"""Plates."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Optional

from . import _native
from ._mesh import Command, Mesh, step_of
from ._net import Layout, Sheet, save, sheets_of

if TYPE_CHECKING:
    from ._types import Floats, Ints, Path


@dataclass(frozen=True, eq=False)
class Plate:
    """A face as a plate of constant thickness."""

    #: Its name, such as ``"P01"``.
    id: str
    #: The face of the mesh.
    face: int
    #: The group of the face in the mesh.
    layer: Optional[str]
    #: The number of its group of congruent plates, from 0.
    group: int
    #: Whether it is a mirror image of the first plate of that group.
    is_mirrored: bool
    #: In mm.
    thickness: float
    #: Of the front, mm².
    area: float
    #: In mm³.
    volume: float
    #: In kg.
    mass: float
    #: The edges of the mesh along its sides, (k,) int64.
    edges: Ints
    #: The cut of each side off square, (k,) float64, degrees.
    bevels: Floats
    #: Origin, x axis, y axis and normal of its front in space, (4, 3) float64, mm.
    frame: Floats
    #: The outline of the front in that frame, (c, 2) float64, mm.
    front: Floats
    #: That of the back, (c, 2) float64, mm; corner i belongs to corner i of the front.
    back: Floats
    #: What is cut out of the sheet, (b, 2) float64, mm.
    blank: Floats
    #: Round holes: middle and radius, (h, 3) float64, mm.
    holes: Floats
    #: The corners of its body in space, (n, 3) float64, mm.
    vertices: Floats
    #: The closed surface of its body, (t, 3) int64, counter-clockwise from outside.
    triangles: Ints


class Panels:
    """A mesh of which every face is a plate: plates, schedule, sheets."""

    __slots__ = ("_command", "_job", "_plates", "_schedule", "mesh")

    #: The mesh.
    mesh: Mesh

    def __init__(
        self,
        job: _native.Job,
        mesh: Mesh,
        given: list[tuple[str, Any]],
        command: Optional[Command] = None,
    ) -> None:
        self._job = job
        self.mesh = mesh
        own = Command(step_of("panels"), given, mesh._source, mesh._options)
        self._command = command or own
        self._plates: Optional[list[Plate]] = None
        self._schedule: Optional[dict[str, Any]] = None

    @property
    def plates(self) -> list[Plate]:
        """One plate for each face, in their order."""
        if self._plates is None:
            self._plates = [Plate(**told) for told in self._job.plates()]
        return self._plates

    @property
    def schedule(self) -> dict[str, Any]:
        """Panels, edges, nodes, groups, totals and findings: panels.json (``docs/formats.md``)."""
        if self._schedule is None:
            self._schedule = json.loads(self._job.schedule(self._command.line()))
        return self._schedule

    @property
    def notes(self) -> list[str]:
        """What there is to know, in words."""
        return self._job.notes

    @property
    def layout(self) -> Optional[Layout]:
        """How well its sheets are used; None without sheets."""
        facts = self._job.layout_facts()
        return None if facts is None else Layout(*facts)

    def sheets(self) -> list[Sheet]:
        """The sheets with the plates."""
        return sheets_of(self._job, self._command)

    def files(self, folder: str = "out") -> dict[str, bytes]:
        """The files of `save` by their names; `folder` is what they say they were written to."""
        return dict(self._job.files(self._command.line(folder)))

    def save(self, folder: Path, *, clean: bool = False) -> list[str]:
        """Writes schedule, map, 3D files and sheets as ``kerfold panels -o`` does: all or none.

        Returns the paths. With `clean` files of an earlier run that are no part of this one go.
        """
        return save(self.files(os.fspath(folder)), folder, clean)

    def _repr_html_(self) -> str:
        totals = self.schedule["totals"]
        words = (
            f"{totals['panels']} plates, {totals['groups']} different, {totals['mass_kg']:.3g} kg"
        )
        return f"{self.mesh._repr_html_()}<p>{words}</p>"

    def __repr__(self) -> str:
        return f"<kerfold.Panels: {len(self.plates)} plates>"
