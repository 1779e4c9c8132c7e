"""What all tests share."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path
from typing import Callable

import pytest

import kerfold

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture
def cube() -> kerfold.Mesh:
    return kerfold.Mesh.solid("cube", edge=40)


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A working folder of its own."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def shell(tmp_path: Path) -> Callable[..., Path]:
    """Runs the program of the command line in a folder of its own, and returns that."""
    program = os.environ.get("KERFOLD", "")
    if not program:
        pytest.skip("KERFOLD names no program of the command line")
    folder = tmp_path / "shell"
    folder.mkdir()

    def run(*words: str, code: int = 0) -> Path:
        done = subprocess.run([program, *words], cwd=folder, capture_output=True, text=True)
        assert done.returncode == code, done.stderr
        return folder

    return run
