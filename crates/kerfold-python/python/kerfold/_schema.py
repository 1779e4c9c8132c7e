"""The steps that the native half knows, and what is given to them."""

from __future__ import annotations

import keyword
import os
import sys
from typing import Any, Iterable, Optional

from . import _native
from ._errors import KerfoldKeywordError

#: How the things that are cut are called when there are many.
_MANY = {"vertex": "vertices", "edge": "edges", "face": "faces"}

#: What stands for a kind of value in docstrings.
_SAID = {
    "number": "float",
    "integer": "int",
    "length": "float (mm) or str such as '3mm'",
    "angle": "float (degrees) or str such as '30deg'",
    "switch": "bool",
    "selection": "str in the selection language, or ids as int array",
    "file": "path",
    "direction": "str such as '-z', or 3 floats",
    "point": "str such as '0,0,1cm', or 3 floats (mm)",
    "text": "str",
}

#: The same for type checkers.
_TYPES = {
    "number": "Number",
    "integer": "int",
    "length": "Length",
    "angle": "Angle",
    "switch": "bool",
    "selection": "Selection",
    "file": "Path",
    "direction": "Direction",
    "point": "Point",
    "text": "Words",
}


class Key:
    """A parameter of a step."""

    __slots__ = (
        "choices",
        "default",
        "first",
        "help",
        "is_list",
        "key",
        "kind",
        "name",
        "range",
        "required",
        "value_name",
    )

    def __init__(self, told: dict[str, Any]) -> None:
        self.key: str = told["key"]
        # `from` is a word of the language itself.
        self.name = self.key + "_" if keyword.iskeyword(self.key) else self.key
        self.help: str = told["help"]
        self.kind: str = told["kind"]
        self.value_name: str = told["value_name"]
        self.is_list: bool = told["list"]
        self.default: Optional[str] = told["default"]
        self.range: Optional[list[float]] = told["range"]
        self.choices: list[tuple[str, str]] = told["choices"]
        #: Whether it may be given without its name.
        self.first: bool = told["first"]
        self.required: bool = told["required"] and self.default is None

    def value(self) -> Any:
        """The default as a value of Python."""
        if self.default is None:
            return False if self.kind == "switch" else None
        if self.kind in ("number", "integer"):
            number = float(self.default)
            return int(number) if number == int(number) else number
        return self.default

    def said(self) -> str:
        """What it takes, for people."""
        if self.kind == "choice":
            said = "{" + ", ".join(repr(word) for word, _ in self.choices) + "}"
        else:
            said = _SAID[self.kind]
            if self.choices:
                said += " or " + ", ".join(repr(word) for word, _ in self.choices)
        if self.is_list:
            said += ", or a list of these"
        if self.required:
            return said
        value = self.value()
        return said + ", optional" if value is None else f"{said}, default {value!r}"

    def typed(self) -> str:
        """What it takes, for type checkers."""
        if self.kind == "choice":
            words = ", ".join(repr(word).replace("'", '"') for word, _ in self.choices)
            one = f"Literal[{words}]"
            typed = f"Union[{one}, Sequence[{one}], str]" if self.is_list else one
        elif self.is_list:
            typed = "Words"
        else:
            typed = _TYPES[self.kind]
        if self.required:
            return typed
        return f"Optional[{typed}]" if self.value() is None else typed


class Step:
    """A kind of step."""

    __slots__ = ("group", "help", "keys", "kind", "name", "verb")

    def __init__(self, told: dict[str, Any]) -> None:
        self.verb: str = told["verb"]
        self.kind: Optional[str] = told["kind"]
        self.group: str = told["group"]
        self.help: str = told["help"]
        self.keys = [Key(key) for key in told["keys"]]
        kind = self.kind
        # Where no verb has a value, what is needed above all may come first.
        needed = [key for key in self.keys if key.required]
        if len(needed) == 1 and not any(key.first for key in self.keys):
            needed[0].first = True
        self.name = self.verb if kind is None else f"{self.verb}_{_MANY.get(kind, kind)}"

    def bind(self, args: tuple[Any, ...], named: dict[str, Any]) -> list[tuple[str, Any]]:
        """What was given, by the names of the keys and as plain values, in the order given."""
        first = [key for key in self.keys if key.first]
        if len(args) > len(first):
            many = "one argument" if first else "no arguments"
            raise KerfoldKeywordError(
                f"{self.name} takes {many} without a keyword, {len(args)} were given; name the "
                "others"
            )
        values = {key.name: value for key, value in zip(first, args)}
        known = {key.name: key for key in self.keys}
        for name, value in named.items():
            if name in values:
                raise KerfoldKeywordError(f"{self.name} got {name!r} twice")
            if name not in known:
                raise KerfoldKeywordError(
                    f"{self.name} has no keyword {name!r}; {_advice(name, known)}", "E702"
                )
            values[name] = value
        lacking = [k.name for k in self.keys if k.required and values.get(k.name) is None]
        if lacking:
            raise KerfoldKeywordError(f"{self.name} needs {', '.join(lacking)}", "E705")
        return [
            (known[name].key, plain(value, known[name]))
            for name, value in values.items()
            if value is not None
        ]

    def doc(self, returns: str) -> str:
        """The docstring."""
        lines = [_sentence(self.help), "", "Parameters", "----------"]
        for key in self.keys:
            lines += [f"{key.name} : {key.said()}", f"    {_sentence(key.help)}"]
            lines += [f"    - {word!r}: {_sentence(help)}" for word, help in key.choices if help]
        return "\n".join([*lines, "", "Returns", "-------", returns, ""])


def _advice(name: str, known: Iterable[str]) -> str:
    near = _native.nearest(name, list(known))
    return f"did you mean {near!r}?" if near else "known are " + ", ".join(known)


def _sentence(text: str) -> str:
    text = " ".join(text.split())
    return text if not text or text.endswith((".", "!", "?")) else text + "."


def plain(value: Any, key: Optional[Key] = None) -> Any:
    """A value as text, number, truth value, or a list of these."""
    if isinstance(value, str) and key is not None and key.is_list:
        if key.kind in ("choice", "text"):
            # A list as one types it in a shell.
            return [int(word) if word.isdecimal() else word for word in value.split(",")]
    if isinstance(value, (str, bool, int, float)):
        return value
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    numpy = sys.modules.get("numpy")
    if numpy is not None and isinstance(value, (numpy.ndarray, numpy.generic)):
        # A mask names the elements at which it is true.
        if value.dtype == bool and getattr(value, "ndim", 0) == 1:
            value = numpy.flatnonzero(value)
        value = value.tolist()
    if isinstance(value, (set, frozenset, range)):
        value = sorted(value)
    if isinstance(value, (list, tuple)):
        items = [plain(item) for item in value]
        if key is not None and key.kind == "selection" and not items:
            raise KerfoldKeywordError(f"{key.name} names no element; give at least one", "E705")
        return items
    return value


#: All kinds of steps by the names of their methods.
STEPS: dict[str, Step] = {step.name: step for step in map(Step, _native.steps())}
