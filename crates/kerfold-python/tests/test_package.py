"""The package itself: both ways to install it say the same."""

from __future__ import annotations

import sys

import pytest

from conftest import ROOT

BELOW = "crates/kerfold-python/"


def test_both_project_files_say_the_same() -> None:
    if sys.version_info < (3, 11):
        pytest.skip("tomllib came with Python 3.11")
    import tomllib

    top, own = (
        tomllib.loads((ROOT / where / "pyproject.toml").read_text(encoding="utf-8"))
        for where in (".", BELOW)
    )
    assert top["build-system"] == own["build-system"]
    top["project"]["readme"] = top["project"]["readme"].removeprefix(BELOW)
    assert top["project"] == own["project"]
    tool = top["tool"]["maturin"]
    assert tool.pop("manifest-path") == BELOW + "Cargo.toml"
    tool["python-source"] = tool["python-source"].removeprefix(BELOW)
    assert tool == own["tool"]["maturin"]
