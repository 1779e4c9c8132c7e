"""Names of what is given and returned, for type checkers."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Sequence, Union

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]
    Ints = NDArray[np.int64]
    #: A text in the selection language, an id, or ids in any order (or a mask of all elements).
    Selection = Union[str, int, Sequence[int], NDArray[Any]]
    #: `x`, `-z` or three numbers.
    Direction = Union[str, Sequence[float], NDArray[Any]]
    #: Three lengths; numbers are in mm.
    Point = Union[str, Sequence[float], NDArray[Any]]
else:
    ArrayLike = NDArray = Floats = Ints = Selection = Direction = Point = Any

#: A number, or a text such as `"1/3"`.
Number = Union[float, str]
#: A number in mm, or a text with a unit such as `"3mm"`, `"1/8in"`.
Length = Union[float, str]
#: A number in degrees, or a text with a unit such as `"30deg"`.
Angle = Union[float, str]
Path = Union[str, "os.PathLike[str]"]
#: Words, or one text with commas.
Words = Union[str, float, Sequence[Any]]

__all__ = [
    "Angle",
    "ArrayLike",
    "Direction",
    "Floats",
    "Ints",
    "Length",
    "NDArray",
    "Number",
    "Path",
    "Point",
    "Selection",
    "Words",
]
