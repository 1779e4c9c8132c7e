# r: kerfold
"""Cuts corners, edges or faces off. Inputs: M, what, select, offset, repeat. Outputs: out_mesh, notes."""

import warnings

from kerfold import rhino

mesh = rhino.from_rhino(M)
keys = {"offset": offset} if offset else {}
with warnings.catch_warnings(record=True) as caught:
    warnings.simplefilter("always")
    if what in (None, "", "edges"):
        made = mesh.cut_edges(select or "all", repeat=int(repeat or 1), **keys)
    elif what == "vertices":
        made = mesh.cut_vertices(select or "all", repeat=int(repeat or 1), **keys)
    elif what == "faces":
        made = mesh.cut_faces(select or "all", **keys)
    else:
        raise ValueError("what is vertices, edges or faces")
out_mesh = rhino.to_rhino(made)
notes = [*made.notes, *(str(w.message) for w in caught)]
