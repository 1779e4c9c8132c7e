# r: kerfold
"""Measures planarity, valence and more. Inputs: M, profile, require. Outputs: passes, findings, deviations."""

import warnings

from kerfold import rhino

mesh = rhino.from_rhino(M)
with warnings.catch_warnings():
    # They are an output here.
    warnings.simplefilter("ignore")
    report = mesh.check(profile or "glass", require=require or None)
passes = report.passes
findings = ["%s: %s" % (finding.code, finding.message) for finding in report.findings]
# Of each face, in mm.
deviations = [row["mm"] for row in report.data["planarity"]["faces"]]
