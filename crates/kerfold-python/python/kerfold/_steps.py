"""Methods made of the steps: an operator that the native half knows is here without more work.

The signatures for type checkers are in ``_steps.pyi``, which `kerfold._stubs` writes of the same list.
"""

from __future__ import annotations

import inspect
from typing import Any, Callable

from ._schema import STEPS, Step

#: What steps return that make no mesh.
RETURNS = {
    "check": "Report",
    "dform": "Made",
    "nest": "Net",
    "panels": "Panels",
    "render": "Picture",
    "unfold": "Net",
}


def returns(step: Step) -> str:
    """The name of the class that a step returns."""
    return RETURNS.get(step.name, "Mesh")


def signature(step: Step, owner: str) -> inspect.Signature:
    """The signature of the method of a step; `owner` is its first parameter."""
    kinds = inspect.Parameter
    parameters = [kinds(owner, kinds.POSITIONAL_ONLY)] if owner else []
    for key in sorted(step.keys, key=lambda key: not key.first):
        kind = kinds.POSITIONAL_OR_KEYWORD if key.first else kinds.KEYWORD_ONLY
        default = kinds.empty if key.required else key.value()
        parameters.append(kinds(key.name, kind, default=default))
    return inspect.Signature(parameters)


def _finish(function: Any, step: Step, where: str, owner: str) -> None:
    function.__name__ = step.name
    function.__qualname__ = f"{where}{step.name}"
    function.__module__ = "kerfold"
    function.__doc__ = step.doc(returns(step))
    function.__signature__ = signature(step, owner)


def method(step: Step) -> Callable[..., Any]:
    """The method of a step that works on a mesh."""

    def call(self: Any, *args: Any, **named: Any) -> Any:
        return self._carry_out(step, step.bind(args, named))

    _finish(call, step, "Mesh.", "self")
    return call


def beginning(step: Step) -> Any:
    """The class method of a step that begins with a mesh."""

    def call(cls: Any, *args: Any, **named: Any) -> Any:
        return cls._begin(step, step.bind(args, named))

    _finish(call, step, "Mesh.", "cls")
    return classmethod(call)


class Steps:
    """The methods of a mesh that are steps."""

    __slots__ = ()


for _step in STEPS.values():
    if _step.group == "begin":
        setattr(Steps, _step.name, beginning(_step))
    elif _step.name != "nest":
        setattr(Steps, _step.name, method(_step))
