# Types of xvrml.figures. Classes of other packages are Any, so that the packages need not be
# installed.
from typing import Any, Optional, Sequence, Tuple

import numpy as np
import numpy.typing as npt

from . import Picture, Shape, World


def map_colors(values: npt.ArrayLike, cmap: Any = ...,
               clim: Optional[Sequence[float]] = ...) -> npt.NDArray[np.float32]:
    ...


def points(xyz: npt.ArrayLike,
           values: Optional[npt.ArrayLike] = ...,
           *,
           colors: Optional[npt.ArrayLike] = ...,
           color: Sequence[float] = ...,
           cmap: Any = ...,
           clim: Optional[Sequence[float]] = ...) -> Shape:
    ...


def height_field(z: npt.ArrayLike,
                 *,
                 spacing: Tuple[float, float] = ...,
                 values: Optional[npt.ArrayLike] = ...,
                 colors: Optional[npt.ArrayLike] = ...,
                 color: Optional[Sequence[float]] = ...,
                 cmap: Any = ...,
                 clim: Optional[Sequence[float]] = ...) -> Shape:
    ...


def to_world(thing: Any, **options: Any) -> World:
    ...


def picture(thing: Any, **options: Any) -> Picture:
    ...


def show(thing: Any, **options: Any) -> Any:
    ...
