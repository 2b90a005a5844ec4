"""A live table of the vehicle's messages."""

import math
import time

from .link import downrange, mavlink

MODES = {10: "AUTO", 7: "CRUISE"}
OUTCOMES = ["adopted", "least violating", "kept previous", "trim hold", "pursuit", "reserve", "latest"]


def monitor(vehicle, out, seconds=None, once=False):
    """Prints a table each second. On a terminal each table replaces the last one."""
    end = math.inf if seconds is None else time.monotonic() + seconds
    latest, counts, texts = {}, {}, []
    begin = shown = time.monotonic()
    while time.monotonic() < end:
        message = vehicle.receive(timeout=0.2)
        if message is not None:
            kind = message.get_type()
            latest[kind] = message
            counts[kind] = counts.get(kind, 0) + 1
            if kind == "STATUSTEXT":
                texts = (texts + [message.text])[-5:]
        now = time.monotonic()
        # A single table waits for the heartbeat, which comes once a second.
        if now - shown >= 1.0 and not (once and "HEARTBEAT" not in latest):
            shown = now
            rates = {kind: count / (now - begin) for kind, count in counts.items()}
            clear = "\x1b[H\x1b[J" if out.isatty() else ""
            print(clear + table(vehicle.system, latest, rates, texts), file=out, flush=True)
            if once:
                return


def table(system, latest, rates, texts):
    rows = [("system", f"{system}")]
    if heartbeat := latest.get("HEARTBEAT"):
        armed = heartbeat.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED
        mode = MODES.get(heartbeat.custom_mode, heartbeat.custom_mode)
        rows.append(("state", f"{mode}, {'armed' if armed else 'disarmed'}"))
    if position := latest.get("LOCAL_POSITION_NED"):
        rows.append(("time", f"{position.time_boot_ms / 1e3:.2f} s"))
        rows.append(("position", f"{downrange(position):.1f} m downrange, {-position.z:.1f} m high"))
    if hud := latest.get("VFR_HUD"):
        rows.append(("air", f"{hud.airspeed:.1f} m/s, climb {hud.climb:+.1f} m/s, throttle {hud.throttle} %"))
    if attitude := latest.get("ATTITUDE"):
        rows.append(("pitch", f"{math.degrees(attitude.pitch):+.1f} deg"))
    if distance := latest.get("DISTANCE_SENSOR"):
        near = distance.current_distance
        what = f"{near / 100:.1f} m" if near <= distance.max_distance else "nothing in reach"
        rows.append(("nearest", what))
    if plan := latest.get("MPP_PLAN_STATUS"):
        outcome = OUTCOMES[plan.outcome] if plan.outcome < len(OUTCOMES) else plan.outcome
        rows.append(("plan", f"{outcome}, {plan.feasible} of {plan.candidates} feasible, cost {plan.cost:.1f}"))
    if status := latest.get("SYS_STATUS"):
        rows.append(("errors", f"{status.errors_count1} inputs, {status.errors_count2} signatures, "
                               f"{status.errors_comm} frames"))
    lines = [f"{name:10}{value}" for name, value in rows]
    lines += [f"  {kind:24}{rate:6.1f} Hz" for kind, rate in sorted(rates.items())]
    return "\n".join(lines + [f"> {text}" for text in texts]) + "\n"
