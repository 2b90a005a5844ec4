"""Recording of all messages that come from the vehicle."""

import math
import time


def record(vehicle, path, seconds=None):
    """Writes frames with their times of arrival until the time is over. Returns the number of frames."""
    end = math.inf if seconds is None else time.monotonic() + seconds
    count = 0
    with open(path, "wb") as file:
        try:
            while time.monotonic() < end:
                message = vehicle.receive(timeout=0.2)
                if message is not None:
                    file.write((time.time_ns() // 1000).to_bytes(8, "big"))
                    file.write(message.get_msgbuf())
                    count += 1
        except KeyboardInterrupt:
            pass
    return count
