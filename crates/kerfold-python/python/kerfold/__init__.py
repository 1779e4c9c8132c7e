"""kerfold carves planar 3-valence meshes, proves that they are so, and unfolds them into sheets.

>>> import kerfold
>>> cube = kerfold.Mesh.solid("cube", size="80mm")
>>> column = cube.cut_edges("along=z", offset=0.25)
>>> net = column.unfold(sheet="600x400", kerf="0.15mm")
>>> paths = net.save("out")

Lengths are millimetres and angles degrees unless a text says otherwise (``"1/8in"``). A method does
what the verb of the same name does on the command line, and writes the same bytes.
"""

from __future__ import annotations

from . import _native
from ._errors import KerfoldError, KerfoldKeywordError, KerfoldWarning
from ._made import Made, dform, nest, run
from ._mesh import Faces, Mesh
from ._net import Folds, Layout, Net, Piece, Placed, Proof, Rims, Seams, Sheet
from ._panels import Panels, Plate
from ._report import Finding, Picture, Report

__version__: str = _native.__version__
explain = _native.explain
on_progress = _native.on_progress
solid_names = _native.solid_names

__all__ = [
    "Faces",
    "Finding",
    "Folds",
    "KerfoldError",
    "KerfoldKeywordError",
    "KerfoldWarning",
    "Layout",
    "Made",
    "Mesh",
    "Net",
    "Panels",
    "Picture",
    "Piece",
    "Placed",
    "Plate",
    "Proof",
    "Report",
    "Rims",
    "Seams",
    "Sheet",
    "__version__",
    "dform",
    "explain",
    "nest",
    "on_progress",
    "run",
    "solid_names",
]
