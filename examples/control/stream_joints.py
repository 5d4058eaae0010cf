"""Streams the joints of a robot to vv, as a controller does: 100 times a second, all joints in one
step, without waiting for answers.

    vv examples/robots/arm.wrl --control 127.0.0.1:7450
    python3 stream_joints.py 127.0.0.1:7450 10
"""
import math
import sys
import time

from xvrml import control

AXES = {
    "J1": (0, 1, 0),
    "J2": (0, 0, 1),
    "J3": (0, 0, 1),
    "J4": (0, 1, 0),
    "J5": (0, 0, 1),
    "J6": (0, 1, 0)
}
RATE = 100  # steps a second


def angles(seconds: float) -> dict[str, float]:
    """Returns the joints' angles: a slow swing, each joint with a phase of its own."""
    return {name: 0.6 * math.sin(seconds + k) for k, name in enumerate(AXES)}


def main() -> None:
    address, duration = sys.argv[1], float(sys.argv[2])
    with control.connect(address) as vv:
        start = time.monotonic()
        steps = int(RATE * duration)
        for step in range(steps):
            pose = angles(step / RATE)
            vv.set_many([(name, "rotation", (*AXES[name], angle)) for name, angle in pose.items()],
                        quiet=True)
            vv.poll()  # raises what vv has refused
            time.sleep(max(0, start + (step + 1) / RATE - time.monotonic()))
        elbow = vv.get("J3", "rotation")
        print(f"{steps} steps in {time.monotonic() - start:.2f} s; J3 is at {elbow[3]:.3f} rad")


if __name__ == "__main__":
    main()
