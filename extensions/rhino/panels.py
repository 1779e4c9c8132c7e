# r: kerfold
"""Makes every face a plate. Inputs: M, thickness, gap, folder. Outputs: plates, names, masses."""

from kerfold import rhino

mesh = rhino.from_rhino(M)
panels = mesh.panels("out", thickness=thickness or 10.0, gap=gap or 0.0, sheet="3210x6000")
plates = [rhino.body_to_rhino(plate.vertices, plate.triangles) for plate in panels.plates]
names = [plate.id for plate in panels.plates]
masses = [plate.mass for plate in panels.plates]
if folder:
    panels.save(folder)
