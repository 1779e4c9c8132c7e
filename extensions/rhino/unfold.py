# r: kerfold
"""Unfolds to sheets. Inputs: M, sheet, kerf, folder. Outputs: outlines, folds, placed, report."""

from kerfold import rhino

mesh = rhino.from_rhino(M)
net = mesh.unfold(sheet=sheet or "A3", kerf=kerf or "0mm", format="svg,dxf,pdf")
outlines, folds, left, shifts = [], [], 0.0, []
for piece in net.pieces:
    low, high = piece.outline.min(axis=0), piece.outline.max(axis=0)
    shift = (left - float(low[0]), -float(low[1]))
    shifts.append(shift)
    outlines.append(rhino.curve_to_rhino(piece.outline, shift=shift))
    left += 1.1 * float(high[0] - low[0])
for number, segment in zip(net.folds.pieces.tolist(), net.folds.segments):
    folds.append(rhino.line_to_rhino(segment, shift=shifts[number]))
placed = [
    "%s on %s: %.3f, %.3f, turned by %.3f" % (p.piece, one.id, p.x, p.y, p.rotation)
    for one in net.sheets()
    for p in one.placed
]
report = [
    "%d pieces on %d sheets" % (len(net.pieces), len(net.sheets())),
    str(net.proof),
] + net.notes
if folder:
    report += net.save(folder)
