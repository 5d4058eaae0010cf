"""The program of a Script (waves.wrl): computes the heights of a sea and of a buoy that floats on
it."""
from math import atan, cos, sin
from typing import Any

script: Any  # the Script node; set before the program starts

# Each wave has wave numbers along x and z, a frequency and a height.
WAVES = ((0.9, 0.4, 1.3, 1.0), (-0.7, 1.1, 1.7, 0.5), (2.1, -0.6, 2.3, 0.2))


def level(x: float, z: float, time: float) -> float:
    return float(script.height) * sum(h * sin(kx * x + kz * z + w * time) for kx, kz, w, h in WAVES)


def slope(x: float, z: float, time: float) -> float:
    return float(script.height) * sum(
        h * kx * cos(kx * x + kz * z + w * time) for kx, kz, w, h in WAVES)


def set_time(time: float) -> None:
    sea, step = script.sea, script.sea.xSpacing
    columns = [step * i - 5 for i in range(sea.xDimension)]
    rows = [sea.zSpacing * i - 5 for i in range(sea.zDimension)]
    script.heights = [level(x, z, time) for z in rows for x in columns]
    # Assignments to another node send events, which needs directOutput TRUE.
    script.buoy.translation = 0, level(0, 2, time) + 0.1, 2
    script.buoy.rotation = 0, 0, 1, atan(slope(0, 2, time))
