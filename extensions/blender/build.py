"""Makes the extension to install: ``python build.py WHEEL... -o kerfold-blender.zip``.

The wheels go into the zip and into its manifest, one for each platform that is to be served.
"""

from __future__ import annotations

import argparse
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent / "kerfold_blender"
#: What all entries are dated, so that the same sources give the same bytes.
WHEN = (1980, 1, 1, 0, 0, 0)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("wheels", nargs="+", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True)
    words = parser.parse_args()
    wheels = sorted(words.wheels, key=lambda wheel: wheel.name)
    listed = ", ".join(f'"./wheels/{wheel.name}"' for wheel in wheels)
    manifest = (HERE / "blender_manifest.toml").read_text(encoding="utf-8")
    head, permissions = manifest.split("\n[permissions]", 1)
    manifest = f"{head}\nwheels = [{listed}]\n\n[permissions]{permissions}"
    with zipfile.ZipFile(words.output, "w", zipfile.ZIP_DEFLATED) as made:

        def add(name: str, data: bytes) -> None:
            entry = zipfile.ZipInfo(name, WHEN)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            made.writestr(entry, data)

        add("blender_manifest.toml", manifest.encode())
        for source in sorted(HERE.glob("*.py")):
            add(source.name, source.read_bytes())
        for wheel in wheels:
            add(f"wheels/{wheel.name}", wheel.read_bytes())
    print(f"{words.output}: {words.output.stat().st_size / 1e6:.1f} MB")


main()
