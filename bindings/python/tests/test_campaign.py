"""Campaigns: rows of the command line's format, the same for any number of threads."""

import json
import os
import pickle
import subprocess

import mppflight
import numpy as np
import pytest

GRID = {"obstacles": [10, 30], "paths": [5, 25], "trials": 3, "seed": 70, "duration": 6}


@pytest.fixture(scope="module")
def rows():
    return mppflight.campaign(**GRID)


def test_rows_do_not_depend_on_threads(rows):
    assert len(rows) == 12
    assert mppflight.campaign(**GRID, workers=1) == rows
    assert [row["seed"] for row in rows[:3]] == [70, 71, 72]
    assert rows.to_pandas()["obstacles"].tolist() == [10] * 3 + [30] * 3 + [10] * 3 + [30] * 3


def test_a_row_is_flown_again_by_fly(rows):
    row = rows[4]
    keys = {key: row[key] for key in ("obstacles", "paths", "seed", "preset", "replan_hz")}
    assert mppflight.fly(**keys, duration=6).log_hash == row["log_hash"]


def test_rows_are_those_of_the_command_line(rows, tmp_path):
    """CI says where the program is (`.ci/python`)."""
    if "SIL_HARNESS" not in os.environ:
        pytest.skip("SIL_HARNESS does not name the program sil-harness")
    file, (scenario, own) = tmp_path / "rows.jsonl", (tmp_path / "short.toml", tmp_path / "own.jsonl")
    scenario.write_text("duration = 6\n")
    grid = ["--obstacles", "10,30", "--paths", "5,25", "--trials", "3", "--seed", "70"]
    command = [os.environ["SIL_HARNESS"], "campaign", "--scenario", scenario, *grid, "--out", file]
    subprocess.run(command, check=True, capture_output=True)
    header, *lines = file.read_bytes().splitlines(keepends=True)
    rows.save(own)
    own_header, *own_lines = own.read_bytes().splitlines(keepends=True)
    assert own_header == header
    assert sorted(own_lines) == sorted(lines)
    # The program reports the rows of Python, and flies those that are missing.
    rows[:-1].save(own)
    report = [os.environ["SIL_HARNESS"], "campaign", "--json", "--report"]
    told = [json.loads(subprocess.check_output([*report, one])) for one in (own, file)]
    assert [one["flown"] for one in told] == [11, 12]
    subprocess.run([*command[:-1], own], check=True, capture_output=True)
    assert json.loads(subprocess.check_output([*report, own])) == told[1]


def test_a_number_of_numpy_is_a_single_value():
    keys = {"trials": np.int64(1), "seed": 3, "duration": 1}
    one = mppflight.campaign(**keys, obstacles=np.int64(10), replan_hz=np.float64(10.0))
    assert one == mppflight.campaign(**keys, obstacles=10, replan_hz=10.0)


def test_rows_show_their_number_their_successes_and_the_interval(rows):
    assert all(row["strict"] for row in rows)
    assert repr(rows) == "<Rows: 12 flights, 12 strict successes, 100.0 % [75.8, 100.0]>"
    assert repr(rows[:0]) == "<Rows: no flights>"


def test_progress_is_told(rows):
    told = []
    mppflight.campaign(**GRID, progress=lambda done, total: told.append((done, total)))
    assert told == [(done, 12) for done in range(1, 13)]


def test_ctrl_c_keeps_what_was_flown(rows):
    def press(done, total):
        if done == 5:
            raise KeyboardInterrupt

    with pytest.raises(mppflight.Interrupted) as caught:
        mppflight.campaign(**GRID, workers=1, progress=press)
    kept = caught.value.rows
    assert 5 <= len(kept) < 12 and set(kept.lines) <= set(rows.lines)


def test_fields_are_cells_and_campaigns_travel():
    fields = {"gate": mppflight.Field.of_arrays(circles=[[60.0, 45.0, 3.0], [60.0, 56.0, 3.0]])}
    rows = mppflight.campaign(fields=fields, trials=2, duration=8)
    assert [row["field"] for row in rows] == ["gate", "gate"]
    flights = mppflight.Campaign({}, trials=2, fields=fields)
    assert pickle.loads(pickle.dumps(flights)).to_json() == flights.to_json()
    with pytest.raises(mppflight.InputError, match="index: give 0 to 1"):
        flights.fly(2)
    # A campaign takes no more room than its description.
    assert len(mppflight.Campaign({}, trials=2**32 - 1)) == 2**32 - 1


def test_a_campaign_that_makes_no_sense():
    with pytest.raises(mppflight.InputError, match="replan_hz"):
        mppflight.campaign(trials=1, replan_hz=3.0)
    for key, value, message in (
        ("preset", "best", "preset: there is no `best`"),
        ("obstacles", "x", "obstacles: give a whole number from 0 .*, not 'x'"),
        ("obstacles", b"x", "obstacles: give a whole number from 0 .*, not b'x'"),
        ("obstacles", {1: 2}, "obstacles: give a whole number from 0 "),
        ("obstacles", [20, 20.5], "obstacles: give a whole number from 0 .*, not 20.5"),
        ("replan_hz", "fast", "replan_hz: give a number, not 'fast'"),
        ("seed", "x", "seed: give a whole number from 0 .*, not 'x'"),
        ("trials", 0, "trials: give 1 or more, not 0"),
        ("trials", 2.5, "trials: give a whole number from 0 .*, not 2.5"),
    ):
        with pytest.raises(mppflight.InputError, match=f"^{message}"):
            mppflight.campaign(**{"trials": 1, key: value})
    with pytest.raises(mppflight.InputError, match="workers: give 1 to"):
        mppflight.campaign(trials=1, workers=-1)
    with pytest.raises(mppflight.InputError, match="index: give"):
        mppflight.Campaign({}, trials=1).fly(-1)
    with pytest.raises(mppflight.InputError, match="no_key"):
        mppflight.campaign(trials=1, no_key=1)
