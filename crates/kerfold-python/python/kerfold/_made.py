"""What recipes and D-forms make: a model with everything that belongs to it."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Mapping, Optional, Sequence

from . import _native
from ._errors import KerfoldKeywordError
from ._mesh import Command, Mesh, step_of, warn
from ._net import Net, save
from ._panels import Panels
from ._report import Report
from ._schema import plain

if TYPE_CHECKING:
    from ._types import Path


class _Run(Command):
    """`kerfold run`."""

    __slots__ = ("recipe", "settings")

    def __init__(self, recipe: str, settings: Sequence[tuple[str, str]]) -> None:
        super().__init__(step_of("unfold"), [], None)
        self.recipe = recipe
        self.settings = settings

    def line(self, output: Optional[str] = None) -> str:
        words = ["kerfold", "run", self.recipe]
        for name, value in self.settings:
            words += ["--set", f"{name}={value}"]
        return _native.shell_text(words + (["-o", output] if output is not None else []))


class Made:
    """A model with its report, and where there are some its pieces or plates."""

    __slots__ = ("_command", "_job", "_mesh", "name")

    #: The name of the recipe.
    name: Optional[str]

    def __init__(self, job: _native.Job, command: Command, name: Optional[str] = None) -> None:
        self._job = job
        self._command = command
        self._mesh: Optional[Mesh] = None
        self.name = name

    @property
    def mesh(self) -> Mesh:
        """The model."""
        if self._mesh is None:
            self._mesh = Mesh._of(self._job.bare())
        return self._mesh

    @property
    def net(self) -> Optional[Net]:
        """Its pieces and sheets; None when nothing was unfolded or nested."""
        if not self._job.has_net:
            return None
        mesh = self.mesh if self._job.has_mesh else None
        return Net(self._job, mesh, [], self._command)

    @property
    def panels(self) -> Optional[Panels]:
        """Its plates; None when there are none."""
        return Panels(self._job, self.mesh, [], self._command) if self._job.has_panels else None

    @property
    def report(self) -> Report:
        """The report on the model, by the limits that the recipe has set."""
        return Report._of(self.mesh, None, self._command.line())

    @property
    def notes(self) -> list[str]:
        """What there is to know, in words."""
        return self._job.notes

    def files(self, folder: str = "out") -> dict[str, bytes]:
        """The files of `save` by their names; `folder` is what they say they were written to."""
        return dict(self._job.all_files(self._command.line(folder)))

    def save(self, folder: Path, *, clean: bool = False) -> list[str]:
        """Writes model, picture, report, pieces and sheets as ``kerfold run -o`` does: all or none.

        Returns the paths. With `clean` files of an earlier run that are no part of this one go.
        """
        return save(self.files(os.fspath(folder)), folder, clean)

    def _repr_html_(self) -> str:
        shown = [part for part in (self.mesh if self._job.has_mesh else None, self.net) if part]
        return "".join(part._repr_html_() for part in shown)

    def __repr__(self) -> str:
        parts = [repr(part) for part in (self.net, self.panels) if part is not None]
        model = [repr(self.mesh)] if self._job.has_mesh else []
        return f"<kerfold.Made: {', '.join(model + parts)}>"


def run(
    recipe: Path,
    out: Optional[Path] = None,
    *,
    set: Optional[Mapping[str, Any]] = None,
    clean: bool = False,
) -> Made:
    """Runs a recipe, and writes everything that it makes into a folder when one is given.

    Parameters
    ----------
    recipe : path or str
        A TOML file, the name of a recipe that comes with kerfold (``"two-piece-d-form"``), or the
        TOML text itself, which has more than one line.
    out : path, optional
        The folder; the files are those of ``kerfold run RECIPE -o OUT``, to the byte.
    set : mapping, optional
        Other values for parameters of the recipe, such as ``{"size": "200mm"}``.
    clean : bool, default False
        Whether files of an earlier run that are no part of this one go.

    Returns
    -------
    Made
    """
    text = os.fspath(recipe)
    is_text = "\n" in text
    settings = [(str(name), str(plain(value))) for name, value in (set or {}).items()]
    job, name = _native.run_recipe(text, is_text, settings)
    warn(job)
    made = Made(job, _Run("-" if is_text else text, settings), name)
    if out is not None:
        made.save(out, clean=clean)
    return made


def dform(solid: Optional[Path] = None, **keys: Any) -> Made:
    """Makes a D-form of a solid, a mesh file or flat outlines, and unfolds it.

    Parameters
    ----------
    solid : path or str, optional
        A solid by name (``"dodecahedron"``) or a mesh file; not with ``outlines`` or ``glue``.
    **keys
        Those of `Mesh.dform`, and of the solid or file (``size``; ``units``, ``weld``, …).

    Returns
    -------
    Made
    """
    step = step_of("dform")
    if solid is None:
        given = step.bind((), keys)
        job = _native.Job().step(step.verb, step.kind, given, None)
        warn(job)
        return Made(job, Command(step, given, None))
    name = os.fspath(solid)
    own = {key.name for key in step.keys}
    others = {key: value for key, value in keys.items() if key not in own}
    # A word without dots and slashes is meant as a name, unless there is such a file.
    is_name = not any(sign in name for sign in "./\\") and not os.path.isfile(name)
    begin = step_of("solid" if is_name else "read")
    known = {"size"} if is_name else {key.name for key in begin.keys if not key.first}
    for key in others:
        if key not in known:
            near = _native.nearest(key, sorted(own | known))
            advice = f"; did you mean {near!r}?" if near else ""
            raise KerfoldKeywordError(f"dform has no keyword {key!r}{advice}", "E702")
    mesh = Mesh._begin(begin, begin.bind((name,), others))
    # On sheets it is called as what was typed.
    mesh._source = name
    mesh._options = begin.bind((name,), others)[1:]
    made: Made = mesh._carry_out(step, step.bind((), {k: v for k, v in keys.items() if k in own}))
    return made


def nest(pieces: Any, **keys: Any) -> Net:
    """Lays anybody's flat pieces out on sheets.

    Parameters
    ----------
    pieces : path, or list of paths
        Files like pieces.json, or drawings (SVG, DXF) whose closed cuts are outlines and holes.
    **keys
        ``quantity`` and the keys of sheets as `Mesh.unfold` takes them.

    Returns
    -------
    Net
    """
    step = step_of("nest")
    given = step.bind((pieces,), keys)
    job = _native.Job().step(step.verb, step.kind, given, None)
    warn(job)
    return Net(job, None, given, Command(step, given, None))
