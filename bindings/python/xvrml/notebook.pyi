from typing import Any, Dict, Optional, Tuple

import numpy as np
import numpy.typing as npt

from . import LiveView, World


class View:
    """Also a jupyter_rfb.RemoteFrameBuffer, which has no types."""

    live: LiveView

    def __init__(self, world: World, size: Tuple[int, int] = ..., **options: Any) -> None:
        ...

    def update(self) -> None:
        ...

    def get_frame(self) -> Optional[npt.NDArray[np.uint8]]:
        ...

    def handle_event(self, event: Dict[str, Any]) -> None:
        ...

    def close(self, *arguments: Any, **options: Any) -> None:
        ...
