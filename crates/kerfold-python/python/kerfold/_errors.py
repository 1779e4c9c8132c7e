"""What goes wrong, with the codes that the command line prints."""

from __future__ import annotations

from typing import Optional


class KerfoldError(Exception):
    """Something that the caller can mend; the text says what, where, and what to do.

    ``code`` is that of the command line, such as ``"E211"``; `kerfold.explain` tells more.
    """

    code: Optional[str]

    def __init__(self, message: str, code: Optional[str] = None) -> None:
        super().__init__(message)
        self.code = code

    def __str__(self) -> str:
        text = str(self.args[0])
        return f"{text} ({self.code})" if self.code else text

    def __reduce__(self) -> tuple[type, tuple[object, ...]]:
        return (type(self), (self.args[0], self.code))


class KerfoldKeywordError(KerfoldError, TypeError):
    """A keyword that a method does not take, or one that it cannot do without."""


class KerfoldWarning(UserWarning):
    """A finding: the work was done, but the result breaks a limit.

    ``code`` is that of the command line, such as ``"F501"``; `kerfold.explain` tells more.
    """

    code: str

    def __init__(self, message: str, code: str = "") -> None:
        super().__init__(message)
        self.code = code

    def __str__(self) -> str:
        text = str(self.args[0])
        return f"{text} ({self.code})" if self.code else text
