"""Writes ``_steps.pyi``: ``python -m kerfold._stubs`` prints it. A test compares the two."""

from __future__ import annotations

from ._schema import STEPS, Step
from ._steps import returns

_HEAD = """\
# Written by `python -m kerfold._stubs` of what the native half tells; do not edit.

from typing import Literal, Optional, Sequence, Union

from ._mesh import Mesh
from ._net import Net
from ._panels import Panels
from ._report import Picture, Report
from ._made import Made
from ._schema import Step
from ._types import Angle, Direction, Length, Number, Path, Point, Selection, Words

def returns(step: Step) -> str: ...

class Steps:
"""


def _default(value: object) -> str:
    return '"' + value.replace('"', '\\"') + '"' if isinstance(value, str) else repr(value)


def _lines(step: Step) -> list[str]:
    is_begin = step.group == "begin"
    lines = ["    @classmethod"] if is_begin else []
    lines.append(f"    def {step.name}(")
    lines.append("        cls," if is_begin else "        self,")
    keys = sorted(step.keys, key=lambda key: not key.first)
    seen_star = False
    for key in keys:
        if not key.first and not seen_star:
            lines.append("        *,")
            seen_star = True
        default = "" if key.required else f" = {_default(key.value())}"
        lines.append(f"        {key.name}: {key.typed()}{default},")
    lines.append(f"    ) -> {returns(step)}: ...")
    return lines


def stub() -> str:
    """The text of ``_steps.pyi``."""
    text = _HEAD
    for step in STEPS.values():
        if step.name != "nest":
            text += "\n".join(_lines(step)) + "\n"
    return text


if __name__ == "__main__":
    print(stub(), end="")
