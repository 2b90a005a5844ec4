"""What `sil-harness export` writes, read by the libraries of others, and whether the layouts name what is there."""

import base64
import collections
import csv
import functools
import json
import re
import subprocess
import xml.etree.ElementTree
from pathlib import Path

import jsonschema
import pyarrow.parquet
import pytest
from mcap.reader import make_reader

EXAMPLES = Path(__file__).resolve().parents[1]
# The build with the cargo feature `formats`, which .ci/clients makes.
HARNESS = EXAMPLES.parent / "target/debug/sil-harness"


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """A log, a row file, and what export makes of them."""
    folder = tmp_path_factory.mktemp("export")

    def run(*arguments):
        subprocess.run([HARNESS, *map(str, arguments)], check=True, capture_output=True)

    run("fly", "--seed", 3, "--duration", 3, "--out", folder)
    log = next(folder.glob("*.json"))
    rows = folder / "rows.jsonl"
    run("campaign", "--trials", 2, "--duration", 2, "--seed", 2**64 - 2, "--out", rows)
    for file, form in [(log, "csv"), (log, "mcap"), (log, "parquet"), (rows, "csv"), (rows, "parquet")]:
        run("export", file, "--format", form, "--out", folder / f"{file.stem}.{form}")
    return {"log": json.loads(log.read_text()), "flight": folder / log.stem, "rows": folder / "rows"}


def messages(files):
    with open(f"{files['flight']}.mcap", "rb") as file:
        for schema, channel, message in make_reader(file, validate_crcs=True).iter_messages():
            yield channel.topic, schema, message


@functools.cache
def by(schema):
    """What validates by a schema. The schema itself is checked once, which takes longer than a message."""
    schema = json.loads(schema)
    kind = jsonschema.validators.validator_for(schema)
    kind.check_schema(schema)
    return kind(schema)


def as_text(value):
    if value is None:
        return ""
    return str(value).lower() if isinstance(value, bool) else str(value)


def test_mcap_holds_the_flight_by_its_schemas(files):
    counts = collections.Counter()
    for topic, schema, message in messages(files):
        value = json.loads(message.data)
        by(schema.data).validate(value)
        if topic == "/ticks":
            tick = message.log_time // 10_000_000
            assert value["z"] == files["log"]["ticks"]["z"][tick]
        counts[topic] += 1
    assert counts["/ticks"] == counts["/tf"] == 300
    assert counts["/scan"] == counts["/plan"] == len(files["log"]["plans"]) == 3


@pytest.fixture(scope="module")
def space(tmp_path_factory):
    """The MCAP of a flight in space."""
    folder = tmp_path_factory.mktemp("space")
    subprocess.run([HARNESS, "fly", "--preset", "space", "--density", "0.005", "--seed", "5", "--out", folder], check=True, capture_output=True)
    (log,) = folder.glob("*.json")
    subprocess.run([HARNESS, "export", log, "--format", "mcap", "--out", folder / "flight.mcap"], check=True, capture_output=True)
    return {"flight": folder / "flight"}


def test_a_flight_in_space_has_clouds_and_poses_by_their_schemas(space):
    counts = collections.Counter()
    for topic, schema, message in messages(space):
        value = json.loads(message.data)
        by(schema.data).validate(value)
        if topic == "/points":
            assert schema.name == "foxglove.PointCloud" and len(base64.b64decode(value["data"])) % value["point_stride"] == 0
        counts[topic] += 1
    assert counts["/pose"] == counts["/tf"] > 1000 and counts["/points"] == counts["/plan"] > 100 and counts["/field"] == 1


def test_parquet_and_csv_hold_the_same(files):
    for stem in (files["flight"], files["rows"]):
        table = pyarrow.parquet.read_table(f"{stem}.parquet")
        with open(f"{stem}.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        assert table.column_names == list(rows[0])
        assert table.schema.metadata[b"mpp.schema_version"] == b"1"
        for name in table.column_names:
            for value, row in zip(table[name].to_pylist(), rows, strict=True):
                same = float(row[name]) == value if isinstance(value, float) else row[name] == as_text(value)
                assert same, (name, value, row[name])
    assert pyarrow.parquet.read_table(f"{files['flight']}.parquet")["z"].to_pylist() == files["log"]["ticks"]["z"]
    seeds = pyarrow.parquet.read_table(f"{files['rows']}.parquet")["seed"].to_pylist()
    assert sorted(seeds) == [2**64 - 2, 2**64 - 1]


def test_the_layouts_name_topics_and_columns_that_are_there(files, space):
    topics = {topic for flight in (files, space) for topic, _, _ in messages(flight)}
    layout = json.loads((EXAMPLES / "foxglove/layout.json").read_text())
    text = json.dumps(layout)
    used = set(re.findall(r'"(/\w+)[."]', text))
    assert used <= topics and "/plan" in used, used - topics
    columns = set(files["log"]["ticks"])
    assert set(re.findall(r'"/ticks\.(\w+)"', text)) <= columns
    juggler = xml.etree.ElementTree.parse(EXAMPLES / "plotjuggler/layout.xml")
    curves = {curve.get("name") for curve in juggler.iter("curve")}
    assert curves and curves <= columns
