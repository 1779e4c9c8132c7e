"""Runs notebooks in a folder that goes again; with --write they keep what they show."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import nbformat
from nbclient import NotebookClient


def main(words: list[str]) -> None:
    is_kept = "--write" in words
    for name in (word for word in words if not word.startswith("--")):
        notebook = nbformat.read(name, as_version=4)
        with tempfile.TemporaryDirectory() as folder:
            resources = {"metadata": {"path": folder}}
            NotebookClient(notebook, timeout=600, resources=resources).execute()
        shown = sum(len(cell.get("outputs", [])) for cell in notebook.cells)
        print(f"{Path(name).name}: {len(notebook.cells)} cells, {shown} outputs")
        if is_kept:
            for cell in notebook.cells:
                # When it ran is nobody's concern.
                cell.metadata.pop("execution", None)
            nbformat.write(notebook, name)


main(sys.argv[1:])
