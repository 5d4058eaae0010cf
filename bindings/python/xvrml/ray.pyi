import os
from typing import Any, Iterable, Iterator, List, Mapping, Optional, Union, overload

import numpy as np
import numpy.typing as npt

from . import World

_Source = Union[str, bytes, "os.PathLike[str]", World]


@overload
def render_frames(
    world: _Source,
    times: Iterable[float],
    *,
    out: None = ...,
    fps: float = ...,
    retries: int = ...,
    in_flight: Optional[int] = ...,
    threads: int = ...,
    browser: Optional[Mapping[str, Any]] = ...,
    **options: Any,
) -> Iterator[npt.NDArray[np.float32]]:
    ...


@overload
def render_frames(
    world: _Source,
    times: Iterable[float],
    *,
    out: Union[str, "os.PathLike[str]"],
    fps: float = ...,
    retries: int = ...,
    in_flight: Optional[int] = ...,
    threads: int = ...,
    browser: Optional[Mapping[str, Any]] = ...,
    **options: Any,
) -> List[str]:
    ...
